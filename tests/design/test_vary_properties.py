"""What varies, and how: normal ranges, shifts, and lengths taken from a neighbour (properties)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from statistics import NormalDist

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cuefem import Resolution, Scene, Tip, load
from cuefem.design import Levels, Normal, Response, Sample, Span, Study, Vary
from cuefem.io.study_files import load_study
from tests.helpers.sweeps import SCENE, STRUCK, written

HOLLOW = load(Path(__file__).parents[2] / "meshes" / "pool_hollow.toml")
BASE = Scene(HOLLOW, tip=Tip(contact_time=1e-3))
DEPTH = Vary(("cue.segments[2].length",), Span(0.05, 0.25), "bore depth", taken_from=("cue.segments[3].length",))


def study(*vary: Vary, count: int = 64) -> Study:
    return Study(BASE, vary, (Response.of("mass"),), Sample("sobol", count, 3), Resolution(1, 6, 4))


@given(st.floats(0.05, 0.25))
def test_a_length_taken_from_the_neighbour_keeps_the_cue_as_long(depth: float) -> None:
    made = study(DEPTH).scene((depth,)).cue
    assert made.segments[2].length == depth
    assert made.length == pytest.approx(HOLLOW.length, rel=1e-15)
    rest = HOLLOW.segments[:2] + HOLLOW.segments[4:]
    assert made.segments[:2] + made.segments[4:] == rest


def test_two_takers_of_one_giver_and_a_shift_in_either_order() -> None:
    """Ferrule and bored wood both grow, the one into the other, the other into the solid wood; numbers come before."""
    ferrule = Vary(("cue.segments[1].length",), Span(-0.005, 0.01), "ferrule", False, True, ("cue.segments[2].length",))
    for order in (1, -1):
        values = (0.004, 0.1)[::order]
        made = study(*(ferrule, DEPTH)[::order]).scene(values).cue
        lengths = [segment.length for segment in made.segments[1:4]]
        assert lengths == pytest.approx([0.017, 0.096, 0.127 + 0.1842 - 0.1], rel=1e-14)


def test_factors_and_shifts_of_what_was_set() -> None:
    path = ("tip.contact_time",)
    numbers = (Levels((1e-3, 2e-3)), Levels((1.5,)), Levels((1e-4,)))
    set_, factor, shift = (replace(Vary(path, range), name=name) for name, range in zip("abc", numbers, strict=True))
    moved = study(replace(shift, shift=True), replace(factor, factor=True), set_)
    assert moved.scene((1e-4, 1.5, 2e-3)).tip.contact_time == pytest.approx(3.1e-3, rel=1e-15)
    with pytest.raises(ValueError, match="a field varies once"):
        study(set_, replace(set_, name="d"))


@given(st.floats(-5, 5), st.floats(0.01, 3), st.floats(0, 1))
def test_normal_ranges_are_normal_and_cut(middle: float, sd: float, u: float) -> None:
    drawn = Normal(middle, sd)
    low, high = drawn.ends
    assert (low, high) == (middle - 4 * sd, middle + 4 * sd)
    assert low <= drawn.quantile(u) <= high
    assert drawn.quantile(0.5) == pytest.approx(middle, abs=1e-12)
    # between the cuts as without them, but for the 6e-5 that lies beyond
    assert NormalDist(middle, sd).cdf(drawn.quantile(u)) == pytest.approx(u, abs=6.4e-5)
    logarithmic = Normal(np.exp(middle), sd, logarithmic=True)
    assert np.log(logarithmic.quantile(u)) == pytest.approx(drawn.quantile(u), rel=1e-9, abs=1e-9)


def test_a_file_says_all_that(tmp_path: Path) -> None:
    text = STRUCK.replace('low = "0 mm"\nhigh = "13 mm"', 'middle = "5 mm"\nsd = "1 mm"').replace(
        "low = 0.7\nhigh = 1.3", 'middle = 1\nsd = 0.2\nspacing = "logarithmic"'
    )
    text += (
        '[[vary]]\npath = "cue.segments[0].length"\nlow = "-5 mm"\nhigh = "5 mm"\nshift = true\n'
        'taken_from = "cue.segments[1].length"\n'
    )
    two = SCENE.replace("[tip]", SCENE[SCENE.index("[[") : SCENE.index("[tip]")] + "[tip]")
    found = load_study(written(tmp_path, text, two))
    bore, modulus, length = found.vary
    assert bore.range == Normal(5e-3, 1e-3)
    assert modulus.range == Normal(1, 0.2, logarithmic=True)
    assert (length.range, length.shift, length.taken_from) == (Span(-5e-3, 5e-3), True, ("cue.segments[1].length",))
    assert found.units[:3] == ("m", "", "m")
