"""The tail of the modes against sums over all of them, and the errors that `resolve` promises against references
(verification)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import cuefem as cf
from cuefem.accuracy import DECAY, MOST, Rung, end_mass_ladder, estimated_error, ladder
from cuefem.beam.modes import Modes, solve
from cuefem.beam.system import assemble
from cuefem.beam.tail import tail
from cuefem.beam.waves import mesh_for
from cuefem.contact.strike import strike_modes
from cuefem.endmass.drives import formula_of
from cuefem.tip_modes import tip_modes_from, turning
from tests.helpers.accuracy_scenes import NAMES, endless_friction, family, scene


def all_modes(scene: cf.Scene, count: int, *, order: int = 0) -> Modes:
    """Every mode of a mesh that holds ``count``, of ``order`` more than `resolve` would take."""
    assert isinstance(scene.cue, cf.Cue)
    elements, p = mesh_for(scene.cue, count)
    system = assemble(scene.cue, elements=elements, order=p + order, effects=scene.cue_effects)
    held = system.mesh.unknowns if system.free is None else system.free.shape[1]
    return solve(system, held - system.rigid.shape[1])


def lowest(found: Modes, count: int) -> Modes:
    return replace(found, frequencies=found.frequencies[:count], vectors=found.vectors[:, :count])


def judged(outcome: cf.Outcome) -> np.ndarray:
    return np.array([outcome.squirt, outcome.ball_speed, outcome.spin])


def reference(scene: cf.Scene, modes: int) -> np.ndarray:
    """Squirt, ball speed and spin from far more modes, on another mesh of another order."""
    assert isinstance(scene.cue, cf.Cue)
    elements, p = mesh_for(scene.cue, modes)
    more = elements + 1 if isinstance(elements, int) else tuple(count + 1 for count in elements)
    found = solve(assemble(scene.cue, elements=more, order=p - 2, effects=scene.cue_effects), modes)
    return judged(strike_modes(scene, tip_modes_from(tail(found, turning=turning(scene)), scene)))


def true_error(outcome: cf.Outcome, best: np.ndarray, scene: cf.Scene) -> float:
    size = np.maximum(np.abs(best), [0.01 * abs(scene.stroke.offset), 0, 0])
    return float((np.abs(judged(outcome) - best) / size).max())


def moment(found: Modes, power: int, *, past: int) -> np.ndarray:
    """Sum of [w, theta][w, theta]' / (omega^2 + shift)^power over the modes from number ``past`` on."""
    w, theta = found.system.tip_displacement(found.vectors[:, past:])
    rows = np.array([w, theta]) / (found.omega[past:] ** 2 + found.system.shift) ** (power / 2)
    return np.asarray(rows @ rows.T)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("effects", [(), (cf.Support(0.2, stiffness=np.inf),), (cf.Joint(0.3, 1e-3),)], ids=str)
def test_tail_holds_the_moments_of_every_mode_left_out(name: str, effects: tuple) -> None:
    """Two steps of Lanczos hold four moments; with a force alone, those of the deflection alone."""
    whole = all_modes(scene(name, 1e-3, 0.3, effects=effects), 40)
    for turns, part in ((True, slice(None)), (False, slice(1))):
        ended = tail(lowest(whole, 20), turning=turns)
        assert len(ended.omega) == 20 + (4 if turns else 2)
        for power in (1, 2, 3, 4):
            found, wanted = (moment(each, power, past=20)[part, part] for each in (ended, whole))
            scale = np.sqrt(np.outer(wanted.diagonal(), wanted.diagonal()))
            np.testing.assert_allclose(found / scale, wanted / scale, rtol=0, atol=1e-7)


@pytest.mark.parametrize(("decay", "most"), [(DECAY, 1.0), (1.0, 1.5), (1.5, 2.9), (2.0, 4.8), (3.0, 12.0)])
def test_an_error_that_falls_as_fast_as_supposed_is_not_underestimated(decay: float, most: float) -> None:
    counts = [20, 26, 34, 44, 57, 74]
    values = 1 + 0.3 * np.array(counts, float)[:, None] ** -decay
    over = estimated_error(counts, values) / (values[-1, 0] - 1)
    assert 1 - 1e-9 <= over <= most + 1e-9


def test_a_contact_that_nearly_parts_says_so() -> None:
    """All rungs below 112 modes miss a parting that the force comes within 1e-3 of: they agree, and are 19 % off."""
    here = scene("whole_cue", 3e-3, 0.35, 0.0)
    climbed: list[Rung] = []
    for rung in ladder(here):
        climbed.append(rung)
        if rung.at.modes > 40:
            break
    squirts = [rung.outcome.squirt for rung in climbed[-3:]]
    assert np.ptp(squirts) < 2e-3 * squirts[0]
    assert 0.1 < climbed[-1].outcome.error < 0.3


def test_end_masses_to_an_accuracy() -> None:
    here = scene("kim", 1e-3, 0.3)
    tip = tip_modes_from(tail(lowest(all_modes(here, 130, order=2), 130)), here)
    for drive in ("stick", "velocity", "force"):
        value, error = cf.resolve_end_mass(here, drive, 1e-3)
        assert error <= 1e-3
        assert abs(value / formula_of(drive)(tip, here) - 1) <= 3 * error


@pytest.mark.nightly
@pytest.mark.parametrize("number", range(0, 41, 3))
def test_the_estimated_error_holds_on_the_family(number: int) -> None:
    """The true error is known no better than two references agree; where that is coarser, it cannot contradict."""
    here = [*family(), endless_friction()][number]
    best, rougher = reference(here, 300), reference(here, 230)
    known = float((np.abs(rougher - best) / np.abs(best)).max())
    asked = [1e-2, 1e-3, 1e-4]
    for rung in ladder(here):
        error = rung.outcome.error
        if error is None:
            continue
        assert true_error(rung.outcome, best, here) <= 3 * error + known
        asked = [rtol for rtol in asked if error > rtol]
        if not asked or rung.at.modes > MOST / 2:
            break


def flips() -> cf.Scene:
    """A low, stiff blow on a cue with soft leather, whose contact nearly parts: rungs part at one number of modes and
    go on at the next, and end 5 % apart."""
    leather, wood = cf.Material(6e7, 2e7, 1000.0), cf.Material(9.57e9, 9.337e8, 711.6)
    cue = cf.Cue((cf.Segment(0.006, 0.0106, 0.0106, leather), cf.Segment(1.09965, 0.0106, 0.02376, wood)), 0.21651)
    return cf.Scene(
        cue, cf.Ball(0.17, 0.03), cf.Tip(0.75, 0.1, contact_time=7e-4), cf.Stroke(1.0, 0.61), (cf.AxialWaves(),)
    )


def test_the_error_of_a_contact_that_flips_from_rung_to_rung_holds() -> None:
    """By the differences of the rungs alone 23 to 29 modes agree to 2e-3, and are 5 % off."""
    here = flips()
    climbed: list[Rung] = []
    for rung in ladder(here):
        climbed.append(rung)
        if rung.at.modes > 80:
            break
    assert np.ptp([rung.outcome.ball_speed for rung in climbed[1:3]]) < 2e-3 * climbed[1].outcome.ball_speed
    best = climbed[-1].outcome
    for rung in climbed:
        if rung.outcome.error is not None:
            assert true_error(rung.outcome, judged(best), here) <= rung.outcome.error + best.error


def test_a_false_plateau_below_the_resonance_of_the_leather_is_charged() -> None:
    """Up to 31 modes the stick end masses agree to 6e-4, all 1 % off: the leather's turning resonance, at 10 kHz, lies
    above the modes that they keep."""
    leather, wood = cf.Material(5.6e7, 1.87e7, 1017.0), cf.Material(1.06e10, 7.2e8, 900.0)
    cue = cf.Cue((cf.Segment(0.00926, 0.0121, 0.0121, leather), cf.Segment(1.45, 0.0121, 0.029, wood)))
    tip, effects = (
        cf.Tip(0.44, 1.07, contact_time=1.6e-3),
        (cf.TipDome(0.0058), cf.Support(0.243, stiffness=1e9, dashpot=20.0)),
    )
    rungs = []
    for rung in end_mass_ladder(
        cf.Scene(cue, cf.Ball(0.184, 0.02517), tip, cf.Stroke(1.0, 0.3), effects), formula_of("stick")
    ):
        rungs.append(rung)
        if rung[0] > 80:
            break
    best = rungs[-1][1]
    plateau = np.array([value for modes, value, _ in rungs if modes < 35])
    assert len(plateau) == 4
    assert np.ptp(plateau) < 7e-4 * best
    assert np.all(np.abs(plateau / best - 1) > 8e-3)
    for _, value, error in rungs[3:]:
        assert abs(value / best - 1) <= 1.5 * error
