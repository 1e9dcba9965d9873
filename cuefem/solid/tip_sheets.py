"""The give of tips as `cuefem.solid.leather_table` reads it, computed from the solid (`cuefem.solid.tip_solid`).

The table in the package and a single tip that it does not hold, with layers or out of its bounds, are made by the same
functions: `sheets_of`, and `gains` of flat tips. Where the ferrule below gives too, it is the lowest layer, and what
its end section moves is taken out of the surface's compliance: that the beam has already. Both are solids, so that the
ferrule's held base cancels, and what is left is what leather and ferrule give beyond a section that moves as a whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from cuefem.solid import leather_table as lt
from cuefem.solid.tip_solid import (
    ROWS,
    Array,
    Layer,
    Patch,
    Shape,
    TipFineness,
    TipSolid,
    compliance,
    drop,
    fitted,
    grid,
    head_on,
    lagrange,
    layered,
    loads,
    punch,
    surfaces,
    usual,
)

TABLE = usual(5, 6, 5, 36)
# Nodes per panel of the curvature: (places, radii) of the three sheets.
SHEETS = {"whole": (8, 9), "cut": (8, 8), "rim": (5, 9)}
HEAD_ON, PUNCH = 8, 10


def patches(sheet: str, curvature: float) -> list[list[Patch]]:
    """Places and radii of the nodes of a sheet."""
    count, each = SHEETS[sheet]
    limit = lt.inner(curvature)
    places = lt.nodes(*((limit, 1.0) if sheet == "rim" else (lt.AXIS, limit)), count)
    return [[Patch(s, a) for a in np.exp(lt.nodes(*lt.radii(sheet, curvature, s), each))] for s in places]


def sheets(curvature: float) -> dict[str, list[Patch]]:
    """The patches of all sheets that a tip of this curvature has; a steep dome has none near its rim."""
    names = [name for name in SHEETS if name != "rim" or curvature <= lt.PANELS[-2]]
    return {name: list(chain(*patches(name, curvature))) for name in names}


def all_loads(curvature: float) -> Array:
    """The loads of all these patches on `TABLE`, which are the same for tips of all heights."""
    return np.array([loads(Shape(1.0, curvature), patch, TABLE) for patch in chain(*sheets(curvature).values())])


class Sheets(NamedTuple):
    """The sheets of one tip, as `lt.TipTable` has them."""

    whole: Array
    cut: Array
    rim: Array | None
    head_on: Array


def sheets_of(shape: Shape, nus: Sequence[float], load: Array, *, on_ferrule: bool = False) -> list[Sheets]:
    """The sheets of one tip, with whatever layers it has, for every Poisson's ratio of its leather.

    load: `all_loads` of its curvature. on_ferrule: whether the lowest layer is the ferrule.
    """
    where = sheets(shape.curvature)
    places, radii = np.array(list(chain(*where.values()))).T
    ends = np.cumsum([len(each) for each in where.values()])[:-1]
    section = _section(shape.layers[0]) if on_ferrule else None
    off, straight = TipSolid(shape, layered(TABLE, shape)), _head_on(shape, nus, section)
    tips = []
    for nu, head in zip(nus, straight, strict=True):
        C = np.zeros((len(load), 2, 2))
        for m, surface in enumerate(surfaces(off, nu)):
            local = surface if section is None else surface - _carried(shape, off.how, section, m)
            C += (load[:, m] @ local) @ load[:, m].transpose(0, 2, 1)
        direct = np.stack([C[:, 0, 0], C[:, 1, 1]], -1)
        across = C[:, 0, 1] / places / np.sqrt(direct.prod(axis=-1))
        values = np.concatenate([np.log(direct / lt.half_space(nu, radii)), across[:, None]], -1)
        parts = dict.fromkeys(SHEETS) | {
            name: part.reshape(*SHEETS[name], 3) for name, part in zip(where, np.split(values, ends), strict=True)
        }
        tips.append(Sheets(**parts, head_on=head))
    return tips


def _head_on(shape: Shape, nus: Sequence[float], section: Array | None) -> Array:
    """Logarithms of force and depth of a ball pressed on it head on, over a half-space's; (nu, radius, 2, 3)."""
    head = np.zeros((len(nus), HEAD_ON, 2, 3))
    for i, a in enumerate(np.exp(lt.nodes(*lt.LOG_HEAD_ON, HEAD_ON))):
        how = layered(fitted(shape.leather, a), shape)
        solid = TipSolid(shape, how)
        for k, nu in enumerate(nus):
            surface = solid.surface(nu, 0)
            if section is not None:
                surface = surface - _carried(shape, how, section, 0)
            head[k, i] = np.log(head_on(shape, surface, a, how) / lt.half_space_head_on(nu, a))
    return head


def _section(ferrule: Layer) -> Array:
    """Displacements (u_z, u_x, turn about y) of the end section of a ferrule alone, held at its base, per unit force
    along z and along x and unit moment about y there; (3, 3).

    They come as the tractions of a long beam (de Saint-Venant's), so that nothing is local at the end: with the radius
    R, 1/A along z, and for the force along x and the moment, over the second moment I,
    t_r = (3 + 2 nu)/(8 (1 + nu)) (R^2 - r^2) cos t, t_t = -((3 + 2 nu) R^2 - (1 - 2 nu) r^2)/(8 (1 + nu)) sin t, and
    t_z = -r cos t.
    """
    shape, how = Shape(ferrule.height, 0.0), TABLE._replace(up=ROWS, harmonics=1)  # the base's corner on one mesh
    solid, nu = TipSolid(shape, how), ferrule.nu
    g, w = np.polynomial.legendre.leggauss(60)
    r, weight = (g + 1) / 4, w / 4
    functions = lagrange(r, how) * (weight * r)[:, None]
    area, second = np.pi / 4, np.pi / 64
    a, b = (3 + 2 * nu) / (8 * (1 + nu)), (1 - 2 * nu) / (8 * (1 + nu))
    none = np.zeros(functions.shape[1])
    along = np.concatenate([none, none, 2 * np.pi * functions.sum(axis=0) / area])
    pushed = [np.pi / second * (t @ functions) for t in (a * (0.25 - r * r), -(a * 0.25 - b * r * r), -r)]
    across = np.array([np.concatenate([pushed[0], pushed[1], none]), np.concatenate([none, none, pushed[2]])])
    moved = np.zeros((3, 3))
    moved[0, 0] = along @ solid.surface(nu, 0) @ along
    moved[1:, 1:] = across @ solid.surface(nu, 1) @ across.T
    return moved / ferrule.modulus


def _carried(shape: Shape, how: TipFineness, section: Array, m: int) -> Array:
    """The compliance of the surface's nodes in harmonic m that comes of the ferrule's end section alone, which carries
    the tip as a rigid body; (3 nodes, 3 nodes)."""
    x = grid(how).nodes
    zeros, ones = np.zeros_like(x), np.ones_like(x)
    if m > 1:
        return np.zeros((3 * len(x), 3 * len(x)))
    if m == 0:
        moved = np.concatenate([zeros, zeros, ones])[None]
        return np.asarray(moved.T @ section[:1, :1] @ moved)
    r = np.sin(np.pi / 2 * x) / 2
    z = shape.height - drop(r, shape.curvature) - shape.layers[0].height
    moved = np.array([np.concatenate([ones, -ones, zeros]), np.concatenate([z, -z, -r])])
    return np.asarray(moved.T @ section[1:, 1:] @ moved)


def gains(shape: Shape, nus: Sequence[float], how: TipFineness = TABLE) -> Array:
    """Of a flat tip: what a patch that sticks gives less than a Hertz-weighted one, over that on a half-space;
    (nu, radius, 2)."""
    how = layered(how._replace(harmonics=1), shape)
    radii = np.exp(lt.nodes(*lt.radii("rim", 0.0, 0.0), PUNCH))
    load = [loads(shape, Patch(0.0, a), how, (0.5, -0.5)) for a in radii]
    solid = TipSolid(shape, how)
    less = np.zeros((len(nus), PUNCH, 2))
    for k, nu in enumerate(nus):
        surface = [solid.surface(nu, m) for m in (0, 1)]
        both = [compliance(surface, f) for f in load]
        less[k] = [np.diagonal(C[:2, :2] - punch(C)) for C in both] / (lt.half_space(nu, radii) / 6)
    return less


def own_tip(tip: lt.OwnTip) -> lt.TipTable:
    """The table of one tip, by itself."""
    under = tuple(Layer(*layer) for layer in tip.layers)
    if tip.ferrule is not None:
        under = (Layer(*tip.ferrule), *under)
    below = 0.0 if tip.ferrule is None else tip.ferrule[0]

    def shape(height: float, curvature: float) -> Shape:
        return Shape(below + height, curvature, under)

    whole = shape(max(tip.height, lt.sag(tip.curvature) + lt.WALL), tip.curvature)
    (own,) = sheets_of(whole, [tip.nu], all_loads(tip.curvature), on_ferrule=tip.ferrule is not None)
    side = lt.height_coordinate(whole.height - below, tip.curvature)
    heights = side, max(lt.height_coordinate(tip.height, 0.0), side + 0.05)
    flat = [shape(float(np.exp(v)) - lt.SOFTENED, 0.0) for v in lt.nodes(*heights, lt.FLAT_HEIGHTS)]
    punch = np.array([gains(each, [tip.nu])[0] for each in flat])
    return lt.TipTable(tip.curvature, tip.nu, *own, punch=punch, heights=heights)
