"""How compliant is a leather tip, from its geometry? The table of cuefem's LeatherTip, and its errors.

A tip is a domed cylinder of linear, isotropic leather on a rigid ferrule, solved by cuefem/solid/tip_compliance.py.
Two things are tabulated, over height, dome, Poisson's ratio and the radius of the contact area: the normal and the
tangential compliance under Hertz's pressure anywhere on the dome, and force and indentation of a ball that is pressed
on it head-on. `cuefem.solid.tip_table` holds the coordinates and reads the table. The page compares the solid
with exact solutions, and the table with the solid at random tips. python -m studies.beam.leather computes the table in
half an hour and the page in four minutes; with the word page only the page.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array
from cuefem.solid import tip_table as tt
from cuefem.solid.tip_compliance import (
    TABLE_FINENESS,
    Patch,
    Shape,
    TipFineness,
    TipSolid,
    central_contact,
    compliance,
    contact_fineness,
    graded_fineness,
    lagrange,
    patch_loads,
    surface_compliances,
    tip_table,
)
from studies import pages
from studies.pages import table

STORE = Path(tt.__file__).with_suffix(".npz")
# Nodes of the table along the axes that one tip does not have, per panel for the curvature.
COUNTS = {"curvature": 6, "height": 8, "nu": 4}


def shape_at(curvature: float, coordinate: float) -> Shape:
    return Shape(np.exp(coordinate) - tt.HEIGHT_SHIFT + tt.dome_height(curvature), curvature)


def curvatures(panel: int, count: int) -> Array:
    return 2 * np.sin(tt.chebyshev_nodes(*(tt.rim_angle(end) for end in tt.CURVATURE_PANELS[panel : panel + 2]), count))


def build() -> tt.LeatherTable:
    """The whole table."""
    nus = (1 - np.exp(-tt.chebyshev_nodes(*tt.NU, COUNTS["nu"]))) / 2
    panels = []
    for panel in range(len(tt.CURVATURE_PANELS) - 1):
        domes = []
        for k in curvatures(panel, COUNTS["curvature"]):
            shapes = [shape_at(k, v) for v in tt.chebyshev_nodes(*tt.heights(k), COUNTS["height"])]
            tips = [[tip_table(shape, nu) for nu in nus] for shape in shapes]
            domes.append([[[tip[part] for tip in row] for row in tips] for part in (2, 3)])
            print(f"curvature {k:.3f} done", file=sys.stderr, flush=True)
        panels.append(domes)
    return tt.LeatherTable(*(np.array([[dome[part] for dome in domes] for domes in panels]) for part in (0, 1)))


# The page


def by_solid(shape: Shape, nu: float, patch: Patch, how: TipFineness = TABLE_FINENESS) -> Array:
    """E D times the compliance of one Hertz-weighted patch, by the solid itself."""
    return compliance(surface_compliances(TipSolid(shape, how), nu), patch_loads(shape, patch, how))


def exact() -> Iterator[list[str | float]]:
    """The solid over exact solutions, less 1."""
    how = graded_fineness(4, 4, 6, 1)
    short, long, slender = (by_solid(Shape(h, 0.0), 0.3, Patch(0.0, 0.45), how) for h in (4.0, 6.0, 30.0))
    yield ["rod, EA/h, from the difference of two lengths", (long - short)[0, 0] * np.pi / 8 - 1]
    case = "cantilever 30 diameters long, 3EI/h^3 (shear and local compliance: 0.001)"
    yield [case, slender[1, 1] * np.pi / 64 / 9e3 - 1]
    for part in (16, 32, 64):
        radius = 0.5 / part
        C = by_solid(Shape(0.5, 0.0), 0.4, Patch(0.0, radius), contact_fineness(0.5, radius)._replace(harmonics=1))
        n, t = np.diagonal(C) / tt.half_space(0.4, np.array(radius)) - 1
        yield [f"half-space, contact radius 1/{part} of the height, normal", n]
        yield [f"half-space, contact radius 1/{part} of the height, tangential", t]


def stuck(shape: Shape, nu: float, radius: float) -> tuple[float, float]:
    """E D times the compliance along t of a patch on the axis: Hertz-weighted, and rigid.

    The rigid patch's traction is the sum of Hertz's and a punch's that gives least (least complementary energy). On a
    mesh that ends at its edge: on the table's, a punch's compliance is 3 % too low.
    """
    how = contact_fineness(shape.height, radius)
    g, w = np.polynomial.legendre.leggauss(200)
    beta = np.pi / 4 * (g + 1)
    q = radius * np.sin(beta)
    weight = w * q * np.cos(beta) ** np.array([[2], [0]]) / np.sqrt(1 - (shape.curvature * q) ** 2)
    radial = weight / weight.sum(axis=1)[:, None] @ lagrange(q, how) / 2
    load = np.hstack([radial, -radial, 0 * radial])
    C = load @ TipSolid(shape, how).surface(nu, 1) @ load.T
    return float(C[0, 0]), float(1 / np.linalg.inv(C).sum())


def sticking() -> Iterator[list[str | float]]:
    """What `cuefem.solid.tip_table.rigid_patch_gain` makes of the compliance of a patch that sticks, over the solid's,
    less 1, %: the smallest and the largest over heights and radii."""
    for name, curvature in (("flat", 0.0), ("nickel", 12.75 / 10.605), ("dime", 12.75 / 8.955)):
        for nu in (0.3, 0.4):
            off = []
            for height, radius in product((0.3, 0.47, 0.7), (0.1, 0.15, 0.2, 0.25)):
                hertz, rigid = stuck(Shape(height, curvature), nu, radius)
                ours = hertz - tt.rigid_patch_gain(nu, curvature, height, np.array(radius))
                off.append(100 * (float(ours) / rigid - 1))
            yield [name, f"{nu:g}", f"{min(off):+.2f}", f"{max(off):+.2f}"]


MESHES = (graded_fineness(4, 5, 4, 24), graded_fineness(4, 6, 5, 36), TABLE_FINENESS, graded_fineness(6, 8, 6, 48))


def refined() -> Iterator[list[str | float]]:
    """The compliance of one tip, h 6, D 12.75, r 9.5 mm, nu 0.4, E 100 MPa, b/R 0.375, a 2 mm, um/N."""
    shape, patch = Shape(6 / 12.75, 12.75 / 9.5), Patch(2 * 0.375 * 9.5 / 12.75, 2 / 12.75)
    for how in MESHES:
        C = by_solid(shape, 0.4, patch, how) * 1e6 / (100e6 * 12.75e-3)
        mesh = f"{len(how.radial) - 1} x {len(how.axial) - 1} of order {how.order}, {how.harmonics} harmonics"
        yield [mesh + (", the table's" if how is TABLE_FINENESS else ""), C[0, 0], C[1, 1], C[0, 1]]


class Errors(NamedTuple):
    """Relative errors of the table: nn, tt and nt (over the root of C_nn C_tt) of patches within the rim, and of those
    that it cuts; force and depth head on, at a radius."""

    within: Array
    cut: Array
    head_on: Array


def errors(tips: int = 20, seed: int = 1) -> Errors:
    """The table against the solid, on a finer mesh, over random tips within the table's bounds."""
    rng, found = np.random.default_rng(seed), Errors(*(np.zeros((0, n)) for n in (3, 3, 2)))
    while len(found.head_on) < tips:
        h, D, r, nu = rng.uniform((2.0, 8.0, 6.0, 0.2), (12.0, 15.0, 15.0, 0.45))
        k = D / r if rng.random() < 0.9 else 0.0
        shape, a = Shape(h / D, k), rng.uniform(0.05, 0.44)
        if k > 2 or shape.height < max(tt.dome_height(k), tt.HEIGHT[0]):
            continue
        tip, how = tt.table_of_tip(shape.height, k, nu), graded_fineness(6, 7, 6, 44)
        solution = surface_compliances(TipSolid(shape, how), nu)
        for _ in range(60):
            place, radius = tt.max_position(k) * rng.random(), rng.uniform(0.06, 0.5)
            direct = compliance(solution, patch_loads(shape, Patch(place, radius), how))
            read = tt.compliance(tip, place, np.array([radius]))[0]
            scale = np.sqrt(np.outer(np.diagonal(direct), np.diagonal(direct)))
            off = ((read - direct) / scale)[[0, 1, 0], [0, 1, 1]]
            part = "within" if radius <= tt.distance_to_rim(k, place) else "cut"
            found = found._replace(**{part: np.vstack([getattr(found, part), off])})
        how = contact_fineness(shape.height, a, 6)
        gaps, ball = np.array([k, D / 28.575, (D / 28.575) ** 3]), 28.575 / D
        direct = central_contact(shape, TipSolid(shape, how).surface(nu, 0), a, how) @ gaps
        off = tt.head_on(tip, np.array([a]), ball)[0] / direct - 1
        found = found._replace(head_on=np.vstack([found.head_on, off]))
    return found


def measured(errors: Errors) -> Iterator[list[str | float]]:
    for group, values, names in (
        ("area within the rim", errors.within, ("C_nn", "C_tt", "C_nt")),
        ("area cut by the rim", errors.cut, ("C_nn", "C_tt", "C_nt")),
        ("head-on", errors.head_on, ("force", "indentation")),
    ):
        for name, column in zip(names, 100 * np.abs(values).T, strict=True):
            yield [group, name, str(len(column)), *(f"{q:.2f}" for q in np.quantile(column, (0.5, 0.95, 1.0)))]


def text() -> str:
    result = errors()
    middle, high = (np.quantile(100 * np.abs(result.within[:, :2]), q) for q in (0.5, 0.95))
    return pages.page(
        "Compliance of a leather tip",
        "How compliant is a leather tip, from its geometry, and what are the errors of LeatherTip's table?",
        "A typical tip (6 mm high, 12.75 mm wide, dome 9.5 mm, 100 MPa, b/R 0.375, contact radius 2 mm) has a normal "
        f"compliance of 1.94 µm/N and a tangential one of 4.60, converged to 0.02 %. The error of the table is "
        f"{middle:.1f} % (median) and {high:.1f} % (95th percentile) over random tips.",
        "## The solid over exact solutions, less 1",
        table(["case", "solid over exact, less 1"], exact(), 2),
        "## Mesh convergence for this tip, µm/N",
        "An earlier solution with quadratic elements, 16 x 10, and 14 harmonics had 1.938, 4.597 and -0.129.",
        table(["mesh", "C_nn", "C_tt", "C_nt"], refined(), 4),
        "## The table against the solid at random tips, %",
        "h 2 to 12, D 8 to 15, r 6 to 15 mm or flat, nu 0.2 to 0.45, contact areas of 0.06 to 0.5 diameters anywhere "
        "up to the rim (b/R 0.75 on steep domes); C_nt over the root of C_nn C_tt.",
        table(["contact", "quantity", "points", "median", "95th percentile", "maximum"], measured(result)),
        "## The compliance of a patch that sticks, against the solid, %",
        "12.75 mm wide, on the axis, heights of 0.3 to 0.7 and radii of 0.1 to 0.25 diameters; along the surface, by "
        "the table's compliance of the Hertz-weighted patch less `rigid_patch_gain`, that compliance being exact here.",
        table(["dome", "nu", "smallest", "largest"], sticking()),
    )


EXAMPLE = """\
import numpy as np
import cuefem as cf

tip = cf.LeatherTip(height=6e-3, dome_radius=9.5e-3, E=100e6)
radius, depth, force = tip.head_on(diameter=12.75e-3, ball_radius=28.575e-3)
for pressed in (0.1e-3, 0.2e-3, 0.4e-3):
    print(f"{1e3 * pressed:.1f} mm deep: {np.interp(pressed, depth, force):.0f} N")
"""
STUDY = pages.Study(__file__, text, example=EXAMPLE)


if __name__ == "__main__":
    if sys.argv[1:] != ["page"]:
        np.savez_compressed(STORE, **{name: part.astype(np.float32) for name, part in build()._asdict().items()})
        tt.table.cache_clear()
    STUDY.write()
