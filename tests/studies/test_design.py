"""What the studies of design claim: low_squirt.py and scatter.py."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cuefem import strike
from cuefem.materials import MATERIALS
from studies import pages
from studies.design import low_squirt, scatter
from studies.strokes import cue, scene
from tests.helpers.study_tables import after, row


def test_hollow_front_against_solid() -> None:
    """Measured low-deflection against regular shafts: 0.69 to 0.72 (meshes/README.md). At T = 1 ms the stick limit
    gives 0.62, the coupled strike at b/R 0.3 0.62, and with dome and shear of the tip 0.79."""
    scenes = [scene(cue(name), 1e-3, 0.3) for name in ("pool_hollow", "pool_maple")]
    domed = [replace(struck, effects=low_squirt.TIP) for struck in scenes]
    small = [low_squirt.measures(struck.cue)[1] for struck in scenes]
    for hollow, solid in (small, *([strike(one).squirt for one in pair] for pair in (scenes, domed))):
        assert 0.6 < hollow / solid < 0.8


def test_low_squirt() -> None:
    """The optimum of the bare model gains little with a real tip."""
    page = after(low_squirt.STUDY.committed, pages.LEATHER)
    shafts_there = {"hollow front": low_squirt.cue("pool_hollow"), "solid pro taper": low_squirt.cue("pool_maple")}
    for words, shaft in shafts_there.items():
        cells = row(page, words)
        assert [cells[1], cells[3], cells[5]] == [f"{squirt:.2f}" for squirt in low_squirt.leather_squirt(shaft)]
    cells = row(page, low_squirt.OPTIMUM)
    assert float(cells[2]) < 0.45
    assert float(cells[6]) > 0.65


def test_the_wood_is_that_of_the_materials_table() -> None:
    """Two standard deviations of G, one of E and of density, are the ranges that materials.py gives for hard maple."""
    maple = MATERIALS["hard maple"]
    for vary, name, width in zip(scatter.FULL.study.vary, ("E", "G", "rho"), (1, 2, 1), strict=False):
        low, high = maple.ranges[name]
        middle = getattr(maple.material, name)
        assert middle * vary.range.quantile(0.5 - (0.3413, 0.4772)[width - 1]) == pytest.approx(low, rel=0.1)
        assert middle * vary.range.quantile(0.5 + (0.3413, 0.4772)[width - 1]) == pytest.approx(high, rel=0.1)
