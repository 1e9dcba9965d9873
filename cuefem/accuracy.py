"""An accuracy asked for, and the least work that reaches it: `resolve` and `resolve_end_mass`.

`ladder` climbs the number of modes, each rung ended by a tail (`cuefem.beam.tail`), and judges every rung by those
within an octave below it. What that costs: studies/accuracy/accuracy.md, and
`cuefem cost` for a scene of one's own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cuefem.beam.spectrum import Ended, ended
from cuefem.beam.system import assemble
from cuefem.beam.tip import TipModes
from cuefem.beam.waves import SPARE, ended_mesh_for, modes_below, wave_phase
from cuefem.contact.laws import LEAST_RESTITUTION
from cuefem.contact.outcome import FLIGHT
from cuefem.contact.strike import strike, strike_modes
from cuefem.cue import Array, Cue
from cuefem.effects import SecondHit
from cuefem.endmass.drives import end_mass, formula_of
from cuefem.quantity.fields import Quantity, check_kind, scalar
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.tip_modes import MOST, tip_modes_from, turning

# Rungs of the ladder: the first number of modes, the ratio of one rung to the next. Errors are first
# estimated at rung `JUDGED`, an octave above the first.
FIRST, RATIO, JUDGED = 8, 1.3, 3
# Errors are taken to fall at least like n^-DECAY; each is judged by the WINDOW rungs below it, an octave. Most fall
# faster; the slowest are those of a tip that never slips under a dome, and of soft leather: the blow of the first touch
# falls like 1/n, and the wave fronts that it sends out come back from every joint before the contact ends. On 280
# random scenes with every effect true errors were above the estimates in 0.9 % of 1086 levels (version 0.1).
# Rungs may agree and yet be wrong where the cue's first segment has a resonance of its own above all modes kept, as the
# leather of a tip has between 5 and 100 kHz. The tail stands for that resonance by its flexibility and a dashpot, as if
# what rings there left for good; the leather keeps it. The truth lies between a tail that radiates and one that
# rings without loss, so until the modes are a rung past the resonance the difference of the two is a bound of the
# error too: modes that just reach it render it no better.
DECAY, WINDOW = 0.75, 3
# What meshes and rounding leave, relative; of a lumped cue rounding alone.
FLOOR, ROUNDING = 1e-8, 1e-12
# Squirt is judged against no less than this part of sin(phi), rad: where it vanishes a relative error means nothing.
LEAST_SQUIRT = 0.01
# Tip and ball nearly part where their normal force falls below NEARLY_APART of its peak, or below what rungs differ by
# there, and rises again. With more modes they may part there: the error is then the difference that parting makes.
# Of rungs whose contact times differ by more than COURSE one parted and another did not.
NEARLY_APART, COURSE, LOOKS = 5e-3, 0.05, 1001
# The same dip of the force comes earlier or later in another rung, by this part of the contact at most.
SHIFT = 0.01
# A tip that leaves the ball with less than SLOWLY times the normal speed after a head-on blow may catch up with it at
# once: `ladder` looks whether it nearly did. That is so if a tip glued to the ball would have pulled on it, until they
# touch again, with no more than GRAZED times the peak force.
SLOWLY = 0.3
GRAZED = 0.03
# Of the dips of the normal force the lowest few are looked at.
FEW_DIPS = 3
# A joint at which the impedance of waves jumps by this throws a third of them back.
REFLECTS = 2.0
FORCES = ("force_t", "force_n")

RTOL = Quantity("", "(0, 1)")


class Rung(NamedTuple):
    """One rung of a ladder: how finely it was computed, and what came out, with its error where it can be judged."""

    at: Resolution
    outcome: Outcome
    tip: TipModes


def resolve(scene: Scene, rtol: float) -> Outcome:
    """Outcome of the coupled strike to a relative accuracy, at the least resolution that reaches it.

    Parameters
    ----------
    scene
        As `cuefem.strike` takes it. A lumped cue is exact but for rounding.
    rtol
        The accuracy wanted, in (0, 1): the largest relative error of squirt, ball speed and spin.

    Returns
    -------
    Outcome
        ``.error`` is the estimated error. If even 400 modes do not reach ``rtol``, the best outcome found is returned,
        and its error is above ``rtol``.

    Raises
    ------
    ValueError
        If rtol is out of bounds.

    Notes
    -----
    Squirt is taken relative to itself, but to no less than 0.01 sin(phi) rad, since it may pass through zero. A contact
    that nearly parts and goes on has the error of parting there; one that parts and nearly goes on has the error of
    going on (except for a dead or nearly dead tip, e <= 1e-4, and a raised cue). A leather tip, or another first
    segment that reflects waves, is also charged what a tail that rings without loss would change, until the modes are
    well past the segment's own turning resonance. On 280 random scenes with every effect true errors were above the
    estimate in 0.9 % of 1086 levels, by at most 2.3 times. Cost: cubic in the modes; all steps together take about
    twice the last.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.Scene(cue, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
    >>> cf.resolve(scene, rtol=1e-2).error < 1e-2
    True
    """
    check_kind("resolve scene", scene, Scene)
    rtol = RTOL.check("resolve rtol", rtol)
    if scene.lumped is not None:
        return replace(strike(scene), error=ROUNDING)
    *_, last = climb(scene, rtol)
    return last.outcome


def climb(scene: Scene, rtol: float) -> Iterator[Rung]:
    """The rungs of `ladder` up to the first whose error is within ``rtol``, or up to the last there is."""
    for rung in ladder(scene):
        yield rung
        if rung.outcome.error is not None and rung.outcome.error <= rtol:
            return


def ladder(scene: Scene) -> Iterator[Rung]:
    """Strikes at ever more modes, with a tail, from a few to `MOST`; Outcome.error from rung `JUDGED` on."""
    counts: list[int] = []
    outcomes: list[Outcome] = []
    swings: list[float] = []
    for rung in _tips(scene):
        tip = rung.tip
        outcome = strike_modes(scene, tip)
        counts, outcomes = [*counts[-WINDOW:], rung.at.modes], [*outcomes[-WINDOW:], outcome]
        if rung.end_unheard:
            swings.append(relative_error(strike_modes(scene, _ringing(tip)), outcome, scene))
        if len(counts) > JUDGED:
            values = np.array([_judged(each) for each in outcomes]) / _scale(outcome, scene)
            error = estimated_error(counts, values)
            courses = (_rungs_apart(outcomes, values), _other_course(outcomes, scene))
            error = max(error, *courses, _caught_up(outcome, scene, tip))
            if rung.end_unheard:
                error = max(error, *swings[-1 - WINDOW :])
            outcome = replace(outcome, error=error)
        yield Rung(rung.at, outcome, tip)


def resolve_end_mass(scene: Scene, drive: str = "stick", rtol: float = 1e-4) -> tuple[float, float]:
    """Effective end mass to a relative accuracy, at the least resolution that reaches it.

    Parameters
    ----------
    scene, drive
        As `cuefem.end_mass` takes them.
    rtol
        The relative accuracy wanted, in (0, 1).

    Returns
    -------
    (float, float)
        The end mass, kg, and its estimated relative error, which is above ``rtol`` if even 400 modes do not reach it.

    Raises
    ------
    ValueError
        If rtol is out of bounds, or the definition is unknown or has no answer for this scene.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> felt, error = cf.resolve_end_mass(cf.Scene(cue, tip=cf.Tip(contact_time=1e-3)), "stick", rtol=1e-2)
    >>> round(1e3 * felt, 1), error < 1e-2  # g
    (4.8, True)
    """
    check_kind("resolve_end_mass scene", scene, Scene)
    rtol, formula = RTOL.check("resolve_end_mass rtol", rtol), formula_of(drive)
    if scene.lumped is not None:
        return float(end_mass(scene, drive)), ROUNDING
    rung = None
    for rung in end_mass_ladder(scene, formula):
        if rung[2] <= rtol:
            break
    assert rung is not None
    return rung[1:]


def end_mass_ladder(scene: Scene, formula: Callable[[TipModes, Scene], float]) -> Iterator[tuple[int, float, float]]:
    """(modes, end mass in kg, its estimated relative error) of ever more modes; infinite below rung `JUDGED`."""
    counts: list[int] = []
    values: list[float] = []
    swings: list[float] = []
    for rung in _tips(scene):
        counts.append(rung.at.modes)
        values.append(float(formula(rung.tip, scene)))
        if rung.end_unheard:
            swings.append(abs(float(formula(_ringing(rung.tip), scene)) / values[-1] - 1))
        error = math.inf
        if len(counts) > JUDGED:
            error = estimated_error(counts, np.array(values)[:, None] / values[-1])
            if rung.end_unheard:
                error = max(error, *swings[-1 - WINDOW :])
        yield counts[-1], values[-1], error


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


def _ringing(tip: TipModes) -> TipModes:
    """The tip modes with a tail that radiates nothing: the vibration that the blow gives it goes on."""
    return replace(tip, radiation=None)


def _end_rings(cue: Cue) -> float:
    """Angular frequency, rad/s, from which on the cue's first segment has a turning resonance of its own; or zero.

    There the second kind of Timoshenko's waves, in which sections turn against their shear, is a quarter wave long in
    that segment. It is held there where its butt differs from the next segment by `REFLECTS` or more in the impedance
    of such waves, sqrt(EI rhoI), as leather does on anything and metal on wood; otherwise it runs on into the cue.
    """
    if len(cue.segments) == 1:
        return 0.0
    sides = cue.section_in(np.arange(2), np.array([cue.nodes[1], 0.0]))  # of the first segment's butt
    impedances = np.sqrt(sides.EI * sides.rhoI)
    if impedances.max() < REFLECTS * impedances.min():
        return 0.0
    omega = np.geomspace(1e3, 1e9, 600)
    return float(omega[np.argmax(wave_phase(cue, omega)[1, 0] > np.pi / 2)])


def _rungs_apart(outcomes: list[Outcome], values: Array) -> float:
    """Difference of the last outcome from rungs whose contact took another course; zero if all took the same."""
    lasted = np.array([float(outcome.duration) for outcome in outcomes])
    other = np.abs(lasted / lasted[-1] - 1) > COURSE
    return float(np.abs(values - values[-1])[other].max(initial=0.0))


def _other_course(outcomes: list[Outcome], scene: Scene) -> float:
    """Difference of the last outcome from one whose contact parts where it nearly does; zero if it nowhere does.

    It may where its normal force dips to less than what the rungs below differ by in that dip.
    """
    outcome = outcomes[-1]
    if not outcome.duration or scene.contact_terms.window is not None:
        return 0.0  # a blow alone; or the tip comes back by itself, and the two courses end alike
    time = np.linspace(0, float(outcome.duration), LOOKS)
    seen = outcome.history(time)
    force = seen["force_n"]
    dips = 1 + np.flatnonzero((force[1:-1] < force[:-2]) & (force[1:-1] <= force[2:]))
    edge = [int(dip) for dip in dips if 0 < force[dip] < NEARLY_APART * force.max()]  # 0 is apart, before a second hit
    for dip in dips[np.argsort(force[dips])][:FEW_DIPS]:
        near = np.clip(time[dip] + SHIFT * time[-1] * np.linspace(-1, 1, 21), 0, time[-1])
        depths = [*(_lowest_force(each, near) for each in outcomes[:-1]), float(force[dip])]
        if depths[-1] < max(abs(depth - depths[-1]) for depth in depths):
            edge.append(int(dip))
    return max((_apart_at(dip, time, seen, outcome, scene) for dip in edge), default=0.0)


def _lowest_force(outcome: Outcome, time: Array) -> float:
    """Lowest normal force at those times, N; a ball that has left takes none."""
    if float(outcome.duration) < time[-1]:
        return 0.0
    return float(outcome.history(time)["force_n"].min())


def _apart_at(dip: int, time: Array, seen: dict[str, Array], outcome: Outcome, scene: Scene) -> float:
    """How far the outcome is from that of a contact that ends at ``dip``, an index of the times."""
    p_t, p_n = (float((seen[name][:dip] + seen[name][1 : dip + 1]).sum() / 2 * time[1]) for name in FORCES)
    whole_t, whole_n = outcome.impulse
    turned = math.atan2(p_t, p_n) - math.atan2(whole_t, whole_n)  # the squirt's difference
    speed = (math.hypot(p_t, p_n) / math.hypot(whole_t, whole_n) - 1) * outcome.ball_speed
    spin = (p_t / whole_t - 1) * outcome.spin if whole_t else 0.0
    return float((np.abs([turned, speed, spin]) / _scale(outcome, scene)).max())


def _caught_up(outcome: Outcome, scene: Scene, tip: TipModes) -> float:
    """How far the outcome is from that of a contact which goes on where it hardly parted; zero where it parted well.

    Where ball and tip drift apart slowly and touch again, one that never quite parted ends like one with a second hit.
    """
    terms = scene.contact_terms
    if terms.table is not None or terms.window is not None or not outcome.duration:
        return 0.0
    restitution, end = float(scene.tip.restitution), float(outcome.duration)
    head_on = restitution * float(scene.stroke.speed) * math.cos(scene.stroke.angle)
    if restitution < LEAST_RESTITUTION or outcome.history(end)["velocity_n"] > SLOWLY * head_on:
        return 0.0
    again = strike_modes(replace(scene, effects=(*scene.effects, SecondHit(end / 2))), tip)
    flight = next((phase for phase in again.phases if phase[:2] == FLIGHT), None)
    if flight is None:
        return 0.0
    time = np.linspace(flight.start, flight.end, LOOKS)
    gap = np.cumsum(again.history(time)["velocity_n"]).max() * (time[1] - time[0])
    peak = again.history(np.linspace(0, end, LOOKS))["force_n"].max()
    if gap * scene.stiffness > GRAZED * restitution**2 * peak:
        return 0.0
    return relative_error(outcome, again, scene)


class _Tips(NamedTuple):
    """Tip modes of one rung, before what the effects add to them."""

    at: Resolution
    scene: Scene
    bending: Ended
    end_rings: float

    @property
    def end_unheard(self) -> bool:
        """Whether the modes kept stop short of a rung past the turning resonance of the cue's first segment."""
        return self.bending.highest < RATIO * self.end_rings

    @property
    def tip(self) -> TipModes:
        """Those of the rung, with their tail."""
        return tip_modes_from(self.bending, self.scene)


def _tips(scene: Scene) -> Iterator[_Tips]:
    """Rungs of the ladder: each group of them on one mesh, with one eigenproblem."""
    end_rings = _end_rings(scene.shaft)
    for group in rung_counts(scene.shaft, scene.contact_time):
        elements, orders = ended_mesh_for(scene.shaft, group[-1], spare=SPARE)
        system = assemble(scene.shaft, elements=elements, order=orders, effects=scene.cue_effects, count=group[-1])
        family = ended(system, group[-1], turning=turning(scene))
        for count in group:
            yield _Tips(Resolution(elements, max(orders), count), scene, family(count), end_rings)


def rung_counts(cue: Cue, time: float) -> list[list[int]]:
    """Numbers of modes of the rungs for a contact that takes ``time``, s; those of one mesh stand together.

    The first group goes up to `JUDGED`; then each stands by itself.
    """
    first = min(max(FIRST, modes_below(cue, 2 * np.pi * 3 / time)), MOST // 4)
    counts = [round(first * math.pow(RATIO, k)) for k in range(20)]
    counts = [*(count for count in counts if count < MOST / RATIO**0.5), MOST]
    return [counts[: JUDGED + 1], *([count] for count in counts[JUDGED + 1 :])]
