"""An accuracy asked for, and the least work that reaches it: `resolve` and `resolve_end_mass`.

`ladder` climbs the number of modes, each rung ended by a tail (`cuefem.tail`), and judges every rung by those within
an octave below it. What that costs: studies/accuracy_cost.md, and `cuefem cost` for a scene of one's own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cuefem.beam import assemble
from cuefem.cue import Array, Cue, LumpedCue
from cuefem.endmass import Drive, end_mass, formula_of
from cuefem.modes import Modes, TipModes, mesh_for, modes_below, solve
from cuefem.quantity import Quantity, scalar
from cuefem.resolution import MOST, tip_modes_from, turning
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.strike import strike, strike_modes
from cuefem.tail import Deflect, flexibility, tail

# Rungs of the ladder: the first number of modes, the ratio of one rung to the next. Errors are first
# estimated at rung `JUDGED`, an octave above the first.
FIRST, RATIO, JUDGED = 8, 1.3, 3
# Errors are taken to fall at least like n^-DECAY; each is judged by the WINDOW rungs below it, an octave. On the forty
# scenes of tests/accuracy_scenes.py the true error is at most 2.7 times the estimate, at the median 0.16 times; with
# two rungs it is up to 6 times, two octaves ask for a quarter more modes.
DECAY, WINDOW = 1.25, 3
# What meshes and rounding leave, relative; of a lumped cue rounding alone.
FLOOR, ROUNDING = 1e-8, 1e-12
# Squirt is judged against no less than this part of sin(phi), rad: where it vanishes a relative error means nothing.
LEAST_SQUIRT = 0.01
# A contact whose normal force falls to this part of its peak and rises again may as well have parted there, as far as
# any number of modes can tell (seen on one of the forty scenes, by 3e-4; on the others above 1.5e-2).
NEARLY_APART, LOOKS = 5e-3, 1001
FORCES = ("force_t", "force_n")

RTOL = Quantity("", "(0, 1)")


class Rung(NamedTuple):
    """One rung of a ladder: how finely it was computed, and what came out, with its error where it can be judged."""

    at: Resolution
    outcome: Outcome


def resolve(scene: Scene, rtol: float) -> Outcome:
    """Outcome of the coupled strike to relative accuracy ``rtol``, in (0, 1), at the least resolution that holds it.

    Outcome.error is the estimate of the largest relative error of squirt, ball speed and spin; the true one is within
    3 times of it on a family of forty scenes. Squirt and spin are taken relative to themselves, squirt to no less than
    0.01 sin(phi) rad (where it passes through zero). An accuracy that `MOST` modes do not reach gives the best found:
    its error is above rtol then. A contact that nearly parts and goes on has the
    error of parting there. A lumped cue is exact but for rounding. Cost: cubic in the modes; all
    rungs together take about twice the last.
    """
    rtol = RTOL.check("resolve rtol", rtol)
    if isinstance(scene.cue, LumpedCue):
        return replace(strike(scene), error=ROUNDING)
    found = None
    for rung in ladder(scene):
        found = rung.outcome
        if found.error is not None and found.error <= rtol:
            break
    assert found is not None
    return found


def ladder(scene: Scene) -> Iterator[Rung]:
    """Strikes at ever more modes, with a tail, from a few to `MOST`; Outcome.error from rung `JUDGED` on."""
    counts: list[int] = []
    values: list[Array] = []
    for rung in _tips(scene):
        outcome = strike_modes(scene, rung.tip)
        counts.append(rung.at.modes)
        values.append(_judged(outcome))
        if len(counts) > JUDGED:
            error = estimated_error(counts, np.array(values) / _scale(outcome, scene))
            outcome = replace(outcome, error=max(error, _other_course(outcome, scene)))
        yield Rung(rung.at, outcome)


def resolve_end_mass(scene: Scene, drive: Drive = "stick", rtol: float = 1e-4) -> tuple[float, float]:
    """(end mass, kg, its estimated relative error) to relative accuracy ``rtol``; see `cuefem.end_mass`, `resolve`."""
    rtol, formula = RTOL.check("resolve_end_mass rtol", rtol), formula_of(drive)
    if isinstance(scene.cue, LumpedCue):
        return float(end_mass(scene, drive)), ROUNDING
    counts: list[int] = []
    values: list[float] = []
    error = math.inf
    for rung in _tips(scene):
        counts.append(rung.at.modes)
        values.append(float(formula(rung.tip, scene)))
        if len(counts) > JUDGED:
            error = estimated_error(counts, np.array(values)[:, None] / values[-1])
        if error <= rtol:
            break
    return values[-1], error


def estimated_error(counts: list[int], values: Array) -> float:
    """Error of the last of ``values`` (rungs, quantities), from those at fewer modes.

    Were every error A n^-p, the last would be |y_i - y| / ((n/n_i)^p - 1) for every i; the largest of them is taken,
    over an octave, because errors swing: wave fronts that just return make false plateaus.
    """
    n, y = np.array(counts[-1 - WINDOW :], float), values[-1 - WINDOW :]
    apart = np.abs(y[:-1] - y[-1]).max(axis=1)
    return max(float((apart / ((n[-1] / n[:-1]) ** DECAY - 1)).max()), FLOOR)


def relative_error(outcome: Outcome, best: Outcome, scene: Scene) -> float:
    """Largest relative difference of squirt, ball speed and spin from those of ``best``, as `resolve` counts them."""
    return float((np.abs(_judged(outcome) - _judged(best)) / _scale(best, scene)).max())


def _judged(outcome: Outcome) -> Array:
    return np.array([outcome.squirt, outcome.ball_speed, outcome.spin], float)


def _scale(outcome: Outcome, scene: Scene) -> Array:
    """What errors of squirt, ball speed and spin are relative to."""
    least = np.array([LEAST_SQUIRT * abs(scalar("Stroke.offset", scene.stroke.offset)), 0.0, 0.0])
    size = np.maximum(np.abs(_judged(outcome)), least)
    return np.where(size > 0, size, 1.0)  # head on: squirt and spin are zero at every resolution


def _other_course(outcome: Outcome, scene: Scene) -> float:
    """How far the outcome is from that of a contact which parts where it is nearly apart; zero where it never is."""
    time = np.linspace(0, float(outcome.duration or 0.0), LOOKS)
    seen = outcome.history(time)
    force = seen["force_n"]
    dips = 1 + np.flatnonzero((force[1:-1] < force[:-2]) & (force[1:-1] <= force[2:]))
    near = dips[(force[dips] > 0) & (force[dips] < NEARLY_APART * force.max())]  # 0 is apart, before a second hit
    if len(near) == 0:
        return 0.0
    p_t, p_n = (float((seen[name][: near[0]] + seen[name][1 : near[0] + 1]).sum() / 2 * time[1]) for name in FORCES)
    whole_t, whole_n = outcome.impulse
    turned = math.atan2(p_t, p_n) - math.atan2(whole_t, whole_n)  # the squirt's difference
    speed = (math.hypot(p_t, p_n) / math.hypot(whole_t, whole_n) - 1) * outcome.ball_speed
    spin = (p_t / whole_t - 1) * outcome.spin if whole_t else 0.0
    return float((np.abs([turned, speed, spin]) / _scale(outcome, scene)).max())


class _Tips(NamedTuple):
    """Tip modes of one rung; rungs of one mesh share its modes and its flexibility."""

    at: Resolution
    scene: Scene
    whole: Modes
    deflect: Deflect

    @property
    def tip(self) -> TipModes:
        """Those of the rung, with their tail."""
        n = self.at.modes
        kept = replace(self.whole, frequencies=self.whole.frequencies[:n], vectors=self.whole.vectors[:, :n])
        return tip_modes_from(tail(kept, turning=turning(self.scene), deflect=self.deflect), self.scene)


def _tips(scene: Scene) -> Iterator[_Tips]:
    """Rungs of the ladder: each group of them on one mesh, with one eigenproblem and one factorisation."""
    assert isinstance(scene.cue, Cue)
    for group in _groups(scene):
        elements, order = mesh_for(scene.cue, group[-1])
        system = assemble(scene.cue, elements=elements, order=order, effects=scene.cue_effects)
        whole, deflect = solve(system, group[-1]), flexibility(system)
        for count in group:
            yield _Tips(Resolution(elements, order, count), scene, whole, deflect)


def _groups(scene: Scene) -> list[list[int]]:
    """Numbers of modes of the rungs, those of one mesh together: the first up to `JUDGED`, then each by itself."""
    assert isinstance(scene.cue, Cue)
    first = min(max(FIRST, modes_below(scene.cue, 2 * np.pi * 3 / scene.contact_time)), MOST // 4)
    counts = [round(first * math.pow(RATIO, k)) for k in range(20)]
    counts = [*(count for count in counts if count < MOST / RATIO**0.5), MOST]
    return [counts[: JUDGED + 1], *([count] for count in counts[JUDGED + 1 :])]
