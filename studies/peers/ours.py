"""cuefem through its public calls, and the bare LAPACK call on matrices of the size that it solves."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np
import scipy.linalg as la

import cuefem as cf
from cuefem.endmass.drives import force
from cuefem.tip_modes import tip_modes_of
from studies.peers.cone import CONE, CONTACT_TIME, MODES

VERSION = cf.__version__


def cue() -> cf.Cue:
    """The cone, made anew from its numbers in every call that is timed."""
    wood = cf.Material(CONE.E, CONE.G, CONE.rho)
    return cf.Cue((cf.Segment(CONE.length, 2 * CONE.tip_radius, 2 * CONE.butt_radius, wood, kappa=CONE.kappa),))


def _scene() -> cf.Scene:
    return cf.Scene(cue(), tip=cf.Tip(contact_time=CONTACT_TIME))


def modes(at: cf.Resolution | None = None) -> np.ndarray:
    """f1 to f5, Hz."""
    return cf.modes(cue(), MODES, at=at).frequencies


def end_mass(at: cf.Resolution | None = None) -> float:
    """Force end mass, kg."""
    return float(cf.end_mass(_scene(), "force", at=at))


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
        **{
            f"cuefem, {n} x {p}, {kept} modes": partial(end_mass, cf.Resolution(n, p, kept))
            for n, p, kept in ((2, 14, 12), (4, 14, 40), (8, 16, 100))
        },
    },
}


def reference() -> dict[str, Any]:
    """f1 to f5 and end mass that everyone is compared with, from more elements and more modes than any contestant.

    A sum over n modes leaves an error like 1/n (shear waves carry the kinks of the pulse): a parabola in 1/n through
    the sums of 130 to 400 modes gives the limit, 1.3e-6 from that of sums of up to 800.
    """
    scene = _scene()
    tip = tip_modes_of(scene, cf.Resolution(40, 16, 400))
    kept = np.arange(130, 401, 5)
    sums = [force(tip.lowest(n + 3), scene) for n in kept]  # 3 rigid motions stand before the others
    limit = np.polynomial.polynomial.polyfit(1 / kept, sums, 2)[0]
    return {"modes": modes(cf.Resolution(11, 9, MODES)), "end_mass": float(limit)}
