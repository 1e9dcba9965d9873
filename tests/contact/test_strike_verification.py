"""The default modes of a strike against many."""

from dataclasses import replace
from pathlib import Path

import pytest

from cuefem import load, strike
from cuefem.beam.modes import solve
from cuefem.beam.system import assemble
from cuefem.contact.strike import strike_modes
from cuefem.tip_modes import default_modes, tip_modes_from
from tests.helpers.strike_scenes import (
    hollow_cue,
    kim_scene,
    pool_cue,
    uniform_rod,
)

MESHES = sorted((Path(__file__).parents[2] / "meshes").glob("*.toml"))


def shipped() -> list:
    built = [("leather", pool_cue()), ("bored", hollow_cue()), ("rod", uniform_rod(120))]
    return [*built, *((path.stem, load(path)) for path in MESHES)]


@pytest.mark.nightly
@pytest.mark.parametrize("time", [0.7e-3, 1e-3, 2e-3, 3.2e-3, 4e-3])
@pytest.mark.parametrize(("name", "cue"), shipped(), ids=[name for name, _ in shipped()])
def test_the_default_keeps_squirt_within_half_a_percent_of_many_modes(name, cue, time):
    """Many: three times the modes on a mesh of their own, ended by a tail as well."""
    base = replace(kim_scene(0.1, contact_time=time), cue=cue)
    count = 3 * default_modes(base)
    many = tip_modes_from(solve(assemble(cue, count), count, ended=1), base)
    for offset in (0.1, 0.3, 0.5):
        scene = replace(base, stroke=replace(base.stroke, offset=offset))
        assert abs(strike(scene).squirt / strike_modes(scene, many).squirt - 1) < 5e-3, offset
