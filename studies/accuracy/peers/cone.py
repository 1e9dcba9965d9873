"""The cones that every peer computes, as numbers, the shaft of meshes/kim.toml first; numerics for peers without."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla

import cuefem as cf

MODES = 5  # flexible modes asked for; f3 to f5 are compared
CONTACT_TIMES = np.linspace(0.5e-3, 3e-3, 24)  # s, of the half-sine force pulse
DENSE = 200  # unknowns below which a dense eigenproblem is the faster one

KIM = Path(__file__).parents[3] / "meshes" / "kim.toml"


@dataclass(frozen=True)
class Cone:
    """A solid cone as a Timoshenko beam: SI, x from the tip."""

    length: float
    tip_radius: float
    butt_radius: float
    E: float
    G: float
    rho: float
    kappa: float

    def radius(self, x: Any) -> Any:
        return self.tip_radius + (self.butt_radius - self.tip_radius) * x / self.length

    def area(self, x: Any) -> Any:
        return np.pi * self.radius(x) ** 2

    def inertia(self, x: Any) -> Any:
        return np.pi / 4 * self.radius(x) ** 4

    @property
    def shift(self) -> float:
        """A square frequency of the order of the lowest mode's, rad2/s2: K + shift M has no rigid motion."""
        middle = self.length / 2
        stiffness, mass = self.E * self.inertia(middle), self.rho * self.area(middle)
        return float(500 * stiffness / mass / self.length**4)


def _read() -> Cone:
    cue = cf.load(KIM)
    (piece,) = cue.segments
    wood = piece.material
    radii = piece.tip_diameter / 2, piece.butt_diameter / 2
    return Cone(piece.length, *radii, wood.E, wood.G, wood.rho, piece.kappa)


# [Kim]'s shaft; a slim one of a pool cue; the rod of a whole snooker cue
CONES = (
    _read(),
    Cone(0.74, 0.00575, 0.01075, 14e9, 0.95e9, 690.0, 0.9),
    Cone(1.45, 0.0048, 0.0145, 15e9, 1.0e9, 720.0, 0.9),
)
CASES = tuple((i, float(T)) for i in range(len(CONES)) for T in CONTACT_TIMES)  # cone by number, contact time


class Case:
    """What the call that is timed computes: a cone's numbers, and the contact time.

    Every call has a cone of its own, 1e-13 of its length longer than the last one's, so that no peer, cuefem among
    them, can keep anything of an equal cone from call to call.
    """

    def __init__(self) -> None:
        self.calls = 0
        self.take()

    def take(self, cone: int = 0, contact_time: float = 2e-3) -> None:
        """Make it cone number ``cone`` and that contact time, s."""
        self.calls += 1
        self.cone, self.contact_time = CONES[cone], contact_time
        self.cone = replace(self.cone, length=self.cone.length * (1 + 1e-13 * self.calls))

    def __getattr__(self, name: str) -> Any:
        return getattr(self.cone, name)


CONE = Case()


def lowest(K: Any, M: Any) -> np.ndarray:
    """The flexible frequencies f1 to f5, Hz, of a free beam's sparse matrices: dense when small, else Lanczos.

    The mode shapes are computed too, as `cuefem.modes` does, and thrown away.
    """
    shifted = K + CONE.shift * M
    if K.shape[0] < DENSE:
        inverse = la.eigh(M.toarray(), shifted.toarray())[0][::-1][2 : 2 + MODES]
        squares = 1 / inverse - CONE.shift
    else:
        squares = np.sort(sla.eigsh(K, MODES + 2, M, sigma=-CONE.shift, v0=np.ones(K.shape[0]))[0])[2:]
    return np.sqrt(squares) / (2 * np.pi)


def newmark_end_mass(K: Any, M: Any, tip: int, steps: int) -> float:
    """Impulse of a half-sine force at unknown ``tip`` over its velocity at the end, kg.

    Newmark's average acceleration, the matrix factored once.
    """
    T = CONE.contact_time
    dt = T / steps
    solve = sla.splu(sp.csc_matrix(M + dt**2 / 4 * K)).solve
    u, v, a, force = (np.zeros(K.shape[0]) for _ in range(4))
    for step in range(1, steps + 1):
        force[tip] = np.sin(np.pi * step / steps)
        ahead = u + dt * v + dt**2 / 4 * a
        new = solve(force - K @ ahead)
        u, v, a = ahead + dt**2 / 4 * new, v + dt / 2 * (a + new), new
    return float(2 * T / np.pi / v[tip])
