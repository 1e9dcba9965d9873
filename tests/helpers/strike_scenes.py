"""Scenes and hypothesis strategies that the tests of the coupled strike share; no tests."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import pi

import numpy as np
from hypothesis import strategies as st

from cuefem import Cue, Material, Outcome, Resolution, Scene, Segment, Stroke, Tip
from cuefem.beam.tip_modes import TipModes
from tests.helpers.cues import kim

# Bound on the relative energy residual at the default steps.
ENERGY_TOLERANCE = 1e-6


def maple(E: float = 12.6e9, rho: float = 700.0) -> Material:
    return Material(E, E / 15, rho)


KIM = kim()
KIM_TIP = Tip(restitution=0.75, friction=0.7, contact_time=1e-3)
KIM_AT = Resolution(4, 20, 22)


def kim_scene(offset: float = 0.3, **tip: float) -> Scene:
    return Scene(KIM, tip=replace(KIM_TIP, **tip), stroke=Stroke(offset=offset))


def stepped_cue() -> Cue:
    """Radius steps of 5 to 1 and back."""
    return Cue(tuple(Segment(0.15, d, d, maple()) for d in (0.010, 0.050, 0.010, 0.050)), body_mass=0.2)


def weighted_cue() -> Cue:
    """A shaft with 0.3 kg on its last 4 mm: a point mass at the butt, as a dense short segment."""
    heavy = Material(200e9, 80e9, 0.3 / (pi / 4 * 0.021**2 * 0.004))
    return Cue((*KIM.segments, Segment(0.004, 0.021, 0.021, heavy)))


def custom_tip_modes(omega: list[float], lateral: list[float], *, mass: float = 0.54, rigid: float = 4.0) -> TipModes:
    """Tip modes of a rigid axial motion, a rigid transverse one, and vibrating modes of amplitude ``lateral``."""
    amplitude = np.zeros((2 + len(omega), 2))
    amplitude[0, 0], amplitude[1, 1], amplitude[2:, 1] = mass**-0.5, rigid, lateral
    approach = np.zeros(len(amplitude))
    approach[0] = mass**0.5
    return TipModes(np.r_[0.0, 0.0, omega], amplitude, approach, np.zeros(len(amplitude)))


def rotating_modes() -> TipModes:
    """Three vibrating modes that rotate the end section."""
    tip = custom_tip_modes([500.0, 3000.0, 9000.0], [5.0, 8.0, 7.0], rigid=9.0)
    return replace(tip, rotation=np.array([0, -50.0, -60.0, -80.0, -120.0]))


def energy_residual(outcome: Outcome) -> float:
    """Energy residual relative to the initial energy."""
    energies = dict(outcome.energy)
    initial = energies.pop("initial")
    return abs(sum(energies.values()) - initial) / initial


def outcome_vector(outcome: Outcome) -> np.ndarray:
    """All numbers of an outcome: angles, speeds, impulses, energies."""
    return np.array(
        [
            outcome.squirt,
            *outcome.ball_velocity,
            outcome.ball_speed,
            outcome.spin,
            outcome.cue_speed,
            *outcome.impulse,
            *outcome.energy.values(),
        ],
        float,
    )


def assert_valid_outcome(outcome: Outcome, within: float = ENERGY_TOLERANCE) -> None:
    """Finite numbers, nonnegative losses, a small energy residual and contiguous phases."""
    assert np.all(np.isfinite(outcome_vector(outcome)))
    initial = outcome.energy["initial"]
    assert all(value >= -ENERGY_TOLERANCE * initial for value in outcome.energy.values())
    assert energy_residual(outcome) < within
    is_instant = [phase.state for phase in outcome.phases] == ["impulse"]  # separated by infinite friction alone
    assert outcome.impulse[1] == 0 if is_instant else outcome.impulse[1] > 0
    assert abs(outcome.impulse[0]) >= 0
    times = [(phase.start, phase.end) for phase in outcome.phases]
    assert times[0][0] == 0
    assert times[-1][1] == outcome.duration
    assert all(first[1] == second[0] for first, second in pairwise(times))
    assert all(start <= end for start, end in times)


def assert_mirrored(right: Outcome, left: Outcome) -> None:
    """The stroke on the other side is the exact mirror image, its history too."""
    mirrored = outcome_vector(left)
    mirrored[[0, 1, 4, 6]] *= -1  # squirt, V_t, spin, impulse along t
    assert np.array_equal(outcome_vector(right), mirrored)
    assert left.duration == right.duration
    mirrored_phases = [phase._replace(impulse=(-phase.impulse[0], phase.impulse[1])) for phase in left.phases]
    assert mirrored_phases == list(right.phases)
    times = np.linspace(0, right.duration, 7)
    for name, values in right.history(times).items():
        assert np.array_equal(left.history(times)[name], -values if name[-1] == "t" else values)
    if right.history.velocity is not None:
        assert np.array_equal(right.history.velocity, left.history.velocity * [-1, 1, 1])
        assert np.array_equal(right.history.spin, left.history.spin * [1, -1, -1])


def logarithmic(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(np.log10(low), np.log10(high)).map(lambda x: float(10**x))


RESTITUTION = st.one_of(st.sampled_from([0.05, 1.0, 0.75]), st.floats(0.05, 1.0))
FRICTION = st.one_of(st.sampled_from([0.0, 1e-6, float("inf"), 0.7]), st.floats(0.02, 2.0))
OFFSET = st.one_of(st.sampled_from([0.0, 1e-9, 0.3, 0.999]), st.floats(1e-4, 0.95))
SIGN = st.sampled_from([1.0, -1.0])
