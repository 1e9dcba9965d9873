"""Every cue becomes tip modes through one door, and each eigenproblem of a scene is solved once (properties)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import cuefem as cf
from cuefem.beam import modes as bending
from cuefem.beam import spectrum
from cuefem.contact.strike import strike_modes
from cuefem.endmass.drives import DEFINITIONS, formula_of
from cuefem.tip_modes import Solved, default_resolution, tip_modes_of
from tests.helpers.strike_scenes import kim_scene

LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.006, 3.0), stroke=cf.Stroke(offset=0.3))


@pytest.fixture
def solutions(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The numbers of modes that were solved for, one entry an eigenproblem."""
    found: list[int] = []
    solve, ended = bending.solve, spectrum.ended
    monkeypatch.setattr(spectrum, "ended", lambda system, most, **how: found.append(most) or ended(system, most, **how))
    monkeypatch.setattr(bending, "solve", lambda system, count: found.append(count) or solve(system, count))
    return found


def test_a_solved_scene_solves_each_eigenproblem_once(solutions: list[int]) -> None:
    scene = kim_scene(0.3)
    solved = Solved(scene)
    assert solutions == []
    for _ in range(2):
        assert solved.modes is not None
        assert solved.tip.radiation is not None
        assert solved.tip_stuck.radiation is not None
        assert solved.tip_plain.radiation is None
    wanted = [default_resolution(scene), default_resolution(scene, least=120), default_resolution(scene, periods=60)]
    assert sorted(solutions) == sorted({at.modes for at in wanted})


@pytest.mark.parametrize("drive", ["force", "velocity"])
def test_a_drive_that_begins_smoothly_takes_the_modes_of_a_strike(solutions: list[int], drive: str) -> None:
    """A third of the modes of a tip that sticks; what they hold: tests/test_default_verification.py."""
    scene = replace(kim_scene(0.3), tip=cf.Tip(contact_time=2e-3))
    cf.end_mass(scene, "stick")
    cf.end_mass(scene, drive)
    assert solutions == [120, 40]
    solved = Solved(scene)
    assert cf.end_mass(scene, drive) == formula_of(drive)(solved.tip, scene)
    assert DEFINITIONS[drive].tip_of(solved) is solved.tip
    assert DEFINITIONS["squirt"].tip_of(solved) is solved.tip_stuck  # near the centre line it is the stick one


def test_tip_modes_stay_without_their_spectra(solutions: list[int]) -> None:
    solved = Solved(kim_scene(0.3))
    tip, stuck = solved.tip, solved.tip_stuck
    solutions.clear()
    small = solved.without_spectra()
    assert small.tip.amplitude is tip.amplitude
    assert small.tip_stuck.amplitude is stuck.amplitude
    assert not solutions
    assert np.array_equal(small.modes.frequencies, solved.modes.frequencies)  # solved again, since asked for


def test_a_lumped_cue_goes_the_same_way() -> None:
    tip = tip_modes_of(LUMPED)
    assert not tip.omega.any()
    assert strike_modes(LUMPED, tip).squirt == cf.strike(LUMPED).squirt
    inverse = tip.amplitude.T @ tip.amplitude
    assert inverse == pytest.approx(np.array([[1 / 0.54, 3.0], [3.0, 1 / 0.006]]), rel=1e-12)


def test_what_needs_segments_says_so() -> None:
    for ask in (lambda: LUMPED.shaft, lambda: Solved(LUMPED).modes, lambda: default_resolution(LUMPED)):
        with pytest.raises(ValueError, match=r"must be a Cue of segments: .* got a LumpedCue"):
            ask()
    assert LUMPED.lumped is LUMPED.cue
    assert kim_scene(0.3).lumped is None
