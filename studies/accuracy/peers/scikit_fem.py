"""scikit-fem through its own `BilinearForm`s: P1 (shear at one point), P2, hierarchical Pp; eigensolvers of scipy."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import skfem
from skfem import Basis, BilinearForm, ElementLineP1, ElementLineP2, ElementLinePp, MeshLine

from studies.accuracy.peers.cone import CONE, lowest, newmark_end_mass

VERSION = skfem.__version__


@BilinearForm
def bending(w: Any, turn: Any, v: Any, other: Any, x: Any) -> Any:
    return CONE.E * CONE.inertia(x.x[0]) * turn.grad[0] * other.grad[0]


@BilinearForm
def shear(w: Any, turn: Any, v: Any, other: Any, x: Any) -> Any:
    return CONE.kappa * CONE.G * CONE.area(x.x[0]) * (w.grad[0] - turn) * (v.grad[0] - other)


@BilinearForm
def mass(w: Any, turn: Any, v: Any, other: Any, x: Any) -> Any:
    return CONE.rho * (CONE.area(x.x[0]) * w * v + CONE.inertia(x.x[0]) * turn * other)


def matrices(order: int, elements: int) -> tuple[Any, Any, int]:
    """K, M and the unknown that is the deflection of the tip."""
    line = {1: ElementLineP1, 2: ElementLineP2}.get(order, lambda: ElementLinePp(order))
    mesh = MeshLine(np.linspace(0, CONE.length, elements + 1))
    full = Basis(mesh, line() * line(), intorder=2 * order + 4)
    # linear elements lock unless shear is taken at one point, which intorder does not give
    sheared = Basis(mesh, full.elem, quadrature=(np.array([[0.5]]), np.array([1.0]))) if order == 1 else full
    tip = full.get_dofs(lambda x: x[0] == 0).nodal["u^1"][0]
    return bending.assemble(full) + shear.assemble(sheared), mass.assemble(full), int(tip)


def modes(order: int, elements: int) -> np.ndarray:
    """f1 to f5, Hz."""
    return lowest(*matrices(order, elements)[:2])


def end_mass(order: int, elements: int, steps: int) -> float:
    """Force end mass, kg, by Newmark steps."""
    return newmark_end_mass(*matrices(order, elements), steps)


def _name(order: int) -> str:
    return "scikit-fem P" + (str(order) if order <= 2 else f"p, p = {order},")


CONTESTANTS = {
    "modes": {
        f"{_name(p)} x {n}": partial(modes, p, n)
        for p, n in ((1, 50), (1, 200), (1, 800), (2, 20), (2, 50), (2, 150), (8, 2), (10, 2), (12, 2))
    },
    "end_mass": {
        f"{_name(p)} x {n}, {steps} steps": partial(end_mass, p, n, steps)
        for p, n, steps in ((1, 160, 800), (2, 20, 200), (2, 40, 400), (2, 80, 800), (8, 10, 800))
    },
}
