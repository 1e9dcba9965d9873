"""sfepy in one dimension: P2 by its weak terms of two scalar fields; eigensolver of scipy."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import sfepy
from sfepy.base.base import output
from sfepy.discrete import Equation, Equations, FieldVariable, Integral, Material, Problem
from sfepy.discrete.fem import FEDomain, Field, Mesh
from sfepy.terms.terms import Term

from studies.accuracy.peers.cone import CONE, lowest

VERSION = sfepy.__version__
output.set_output(quiet=True)

STIFFNESS = (
    "dw_laplace(cone.EI, s, t)",
    "dw_laplace(cone.kGA, v, w)",
    "dw_dot(cone.kGA, s, t)",
    "dw_s_dot_mgrad_s(cone.less, s, w)",
    "dw_s_dot_mgrad_s(cone.less, t, v)",
)
MASS = ("dw_dot(cone.rhoA, v, w)", "dw_dot(cone.rhoI, s, t)")


def _section(_: Any, points: np.ndarray, mode: str | None = None, **__: Any) -> dict[str, np.ndarray] | None:
    if mode != "qp":
        return None
    A, inertia = (part(points[:, 0])[:, None, None] for part in (CONE.area, CONE.inertia))
    shear = CONE.kappa * CONE.G * A
    return {"EI": CONE.E * inertia, "kGA": shear, "less": -shear, "rhoA": CONE.rho * A, "rhoI": CONE.rho * inertia}


def matrices(order: int, elements: int) -> tuple[Any, Any]:
    """K and M of deflection w (tested by v) and rotation t (by s)."""
    x = np.linspace(0, CONE.length, elements + 1)[:, None]
    ends = np.arange(elements, dtype=np.int32)[:, None] + np.array([0, 1], dtype=np.int32)
    mesh = Mesh.from_data("cone", x, None, [ends], [np.zeros(elements, dtype=np.int32)], ["1_2"])
    beam = FEDomain("domain", mesh).create_region("beam", "all")
    fields = {name: Field.from_args(name, np.float64, "scalar", beam, approx_order=order) for name in "wt"}
    parts = {name: FieldVariable(name, "unknown", field) for name, field in fields.items()}
    parts["v"] = FieldVariable("v", "test", fields["w"], primary_var_name="w")
    parts["s"] = FieldVariable("s", "test", fields["t"], primary_var_name="t")
    points = Integral("i", 2 * order + 4)
    cone = Material("cone", function=_section)

    def equation(name: str, texts: tuple[str, ...]) -> Equation:
        terms = [
            Term.new(text, points, beam, cone=cone, **{n: parts[n] for n in text[:-1].split(", ")[1:]})
            for text in texts
        ]
        return Equation(name, sum(terms[1:], terms[0]))

    stiffness, mass = equation("stiffness", STIFFNESS), equation("mass", MASS)
    problem = Problem("beam", equations=Equations([stiffness, mass]))
    problem.time_update()
    problem.update_materials()
    K = stiffness.evaluate(mode="weak", dw_mode="matrix", asm_obj=problem.mtx_a)
    M = K.copy()
    M.data[:] = 0
    return K, mass.evaluate(mode="weak", dw_mode="matrix", asm_obj=M)


def modes(order: int, elements: int) -> np.ndarray:
    """f1 to f5, Hz."""
    return lowest(*matrices(order, elements))


CONTESTANTS = {"modes": {f"sfepy P2 x {n}": partial(modes, 2, n) for n in (20, 50, 150)}, "end_mass": {}}
