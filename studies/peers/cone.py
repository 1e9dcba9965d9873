"""The cone that every peer computes, the shaft of meshes/kim.toml as numbers; numerics for peers that bring none."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla

import cuefem as cf

MODES = 5  # flexible modes asked for; f3 to f5 are compared
CONTACT_TIME = 2e-3  # s, of the half-sine force pulse
DENSE = 200  # unknowns below which a dense eigenproblem is the faster one

KIM = Path(__file__).parents[2] / "meshes" / "kim.toml"


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


CONE = _read()


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
    dt = CONTACT_TIME / steps
    solve = sla.splu(sp.csc_matrix(M + dt**2 / 4 * K)).solve
    u, v, a, force = (np.zeros(K.shape[0]) for _ in range(4))
    for step in range(1, steps + 1):
        force[tip] = np.sin(np.pi * step / steps)
        ahead = u + dt * v + dt**2 / 4 * a
        new = solve(force - K @ ahead)
        u, v, a = ahead + dt**2 / 4 * new, v + dt / 2 * (a + new), new
    return 2 * CONTACT_TIME / np.pi / v[tip]
