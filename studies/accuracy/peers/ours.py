"""cuefem through its public calls, and the bare LAPACK call on matrices of the size that it solves."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np
import scipy.linalg as la

import cuefem as cf
from cuefem.beam.spectrum import ended
from cuefem.beam.system import assemble
from cuefem.beam.waves import ended_mesh_for
from cuefem.endmass.drives import force
from cuefem.tip_modes import tip_modes_from
from studies.accuracy.peers.cone import CASES, CONE, CONES, MODES

MANY = 300  # modes of the reference

VERSION = cf.__version__


def cue() -> cf.Cue:
    """The cone, made anew from its numbers in every call that is timed."""
    wood = cf.Material(CONE.E, CONE.G, CONE.rho)
    return cf.Cue((cf.Segment(CONE.length, 2 * CONE.tip_radius, 2 * CONE.butt_radius, wood, kappa=CONE.kappa),))


def _scene() -> cf.Scene:
    return cf.Scene(cue(), tip=cf.Tip(contact_time=CONE.contact_time))


def modes(at: cf.Resolution | None = None) -> np.ndarray:
    """f1 to f5, Hz."""
    return cf.modes(cue(), MODES, at=at).frequencies


def end_mass(at: cf.Resolution | None = None) -> float:
    """Force end mass, kg."""
    return float(cf.end_mass(_scene(), "force", at=at))


def end_mass_resolved(rtol: float) -> float:
    """Force end mass, kg, by the least work that reaches an accuracy, with an estimate of its error."""
    return float(cf.resolve_end_mass(_scene(), "force", rtol=rtol)[0])


@cache
def matrices() -> tuple[np.ndarray, np.ndarray, float]:
    """What `cuefem.modes` solves: M, K + shift M, and the shift."""
    system = cf.modes(cue(), MODES).system
    return system.M, system.K + system.shift * system.M, system.shift


def bare(solver: Callable[..., Any]) -> np.ndarray:
    """f1 to f5, Hz, by a LAPACK routine from matrices that are there already."""
    M, shifted, shift = matrices()
    mu = solver(M, shifted)[0]
    return np.sqrt(1 / mu[::-1][2 : 2 + MODES] - shift) / (2 * np.pi)


CONTESTANTS = {
    "modes": {
        "cuefem": modes,
        **{f"cuefem, {n} x {p}": partial(modes, cf.Resolution(n, p, MODES)) for n, p in ((1, 8), (1, 12), (1, 15))},
        "LAPACK dsygvd alone": partial(bare, la.lapack.dsygvd),
        "scipy.linalg.eigh alone": partial(bare, la.eigh),
    },
    "end_mass": {
        "cuefem": end_mass,
        **{f"cuefem, resolve_end_mass {rtol:.0e}": partial(end_mass_resolved, rtol) for rtol in (1e-3, 1e-4)},
        **{
            f"cuefem, {n} x {p}, {kept} modes": partial(end_mass, cf.Resolution(n, p, kept))
            for n, p, kept in ((2, 14, 12), (4, 14, 40), (8, 16, 100))
        },
    },
}


def reference() -> dict[str, Any]:
    """f1 to f5 of the first cone, and the end masses of all cases, from more elements and modes than any contestant.

    End masses are of `MANY` modes with a tail, on a mesh that holds them to 1e-8; two thirds of them change the median
    by less than 2e-6 (tests/studies/test_peers.py).
    """
    return {"modes": modes(cf.Resolution(11, 9, MODES)), "end_mass": end_masses(MANY)}


def end_masses(count: int) -> np.ndarray:
    """The force end masses of all cases by ``count`` modes with a tail, kg."""
    found = {}
    for number in range(len(CONES)):
        CONE.take(number)
        scene = _scene()
        elements, orders = ended_mesh_for(scene.shaft, count, spare=8)
        family = ended(assemble(scene.shaft, elements=elements, order=orders, count=count), count, turning=False)
        found[number] = tip_modes_from(family(count), scene)
    values = []
    for number, T in CASES:
        CONE.take(number, T)
        values.append(force(found[number], _scene()))
    CONE.take()
    return np.array(values)
