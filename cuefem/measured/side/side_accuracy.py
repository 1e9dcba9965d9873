"""A strike from the side to an accuracy that is asked for: the ladder of `cuefem.accuracy`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from cuefem.accuracy import (
    COURSE,
    FEW_DIPS,
    JUDGED,
    LOOKS,
    NEARLY_APART,
    RTOL,
    WINDOW,
    estimated_error,
    rung_counts,
)
from cuefem.beam.modes import solve
from cuefem.beam.system import assemble
from cuefem.beam.tail import flexibility, tail
from cuefem.beam.waves import mesh_for
from cuefem.cue import Array
from cuefem.measured.side.side_scene import SideStrike
from cuefem.measured.side.side_strike import SideOutcome, acting, checked_time, outcome_of, place_modes, solved_side
from cuefem.quantity.fields import check_kind


def resolve_side_strike(scene: SideStrike, rtol: float) -> SideOutcome:
    """Outcome of a strike from the side to an accuracy, at the least resolution that reaches it.

    Parameters
    ----------
    scene : SideStrike
        As `cuefem.side_strike` takes it.
    rtol : float
        The accuracy wanted, in (0, 1): the largest error of the apparent restitution e_A, and of the impulse
        relative to itself.

    Returns
    -------
    SideOutcome
        ``.error`` is the estimated error. If even 400 modes do not reach ``rtol``, the best outcome found is returned,
        and its error is above ``rtol``.

    Raises
    ------
    ValueError
        If rtol is out of bounds.

    Notes
    -----
    Each rung has 1.3 times the modes of the one below and ends in a tail; it is judged by those within an octave below
    it, as in `cuefem.resolve`. A contact that nearly parts and goes on has the error of parting there.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),))
    >>> scene = cf.SideStrike(shaft, cf.Striker(mass=0.005, restitution=0.8, contact_time=1e-3))
    >>> cf.resolve_side_strike(scene, rtol=1e-3).error < 1e-3
    True
    """
    check_kind("resolve_side_strike scene", scene, SideStrike)
    rtol = RTOL.check("resolve_side_strike rtol", rtol)
    rung = None
    for rung in side_ladder(scene):
        if rung.error is not None and rung.error <= rtol:
            break
    assert rung is not None
    return rung


def side_ladder(scene: SideStrike) -> Iterator[SideOutcome]:
    """Outcomes at ever more modes, with a tail; their error from rung `JUDGED` on."""
    counts: list[int] = []
    outcomes: list[SideOutcome] = []
    for group in rung_counts(scene.cue, checked_time(scene)):
        elements, order = mesh_for(scene.cue, group[-1])
        system = assemble(scene.cue, elements=elements, order=order, effects=acting(scene))
        whole, deflect = solve(system, group[-1]), flexibility(system)
        for n in group:
            lowest = replace(whole, frequencies=whole.frequencies[:n], vectors=whole.vectors[:, :n])
            place = place_modes(tail(lowest, deflect=deflect, position=scene.position), scene)
            outcome = outcome_of(solved_side(scene, place), scene)
            counts, outcomes = [*counts[-WINDOW:], n], [*outcomes[-WINDOW:], outcome]
            if len(counts) > JUDGED:
                values = np.array([[each.apparent_restitution, np.log(each.impulse)] for each in outcomes])
                error = max(estimated_error(counts, values), _other_courses(outcomes, values, scene))
                outcome = replace(outcome, error=error)
            yield outcome


def _other_courses(outcomes: list[SideOutcome], values: Array, scene: SideStrike) -> float:
    """Difference of the last outcome from rungs that took another course, and from parting where it nearly does."""
    last = outcomes[-1]
    lasted = np.array([each.duration for each in outcomes])
    other = np.abs(lasted / lasted[-1] - 1) > COURSE
    error = float(np.abs(values - values[-1])[other].max(initial=0.0))
    if scene.window is not None or not last.duration:
        return error  # the striker comes back by itself, and the two courses end alike
    time = np.linspace(0, last.duration, LOOKS)
    force = last.history(time)["force_n"]
    dips = 1 + np.flatnonzero((force[1:-1] < force[:-2]) & (force[1:-1] <= force[2:]))
    for dip in dips[np.argsort(force[dips])][:FEW_DIPS]:
        if 0 < force[dip] < NEARLY_APART * force.max():
            missed = float(force[dip:].sum() * time[1])  # the impulse after the dip
            error = max(error, missed / (scene.striker.mass * scene.speed), missed / last.impulse)
    return error
