"""The give of tips as `cuefem.solid.leather_table` reads it, computed from the solid (`cuefem.solid.tip`).

The table in the package and a single tip that it does not hold, with layers or out of its bounds, are made by the same
functions: `of_shape`, and `gains` of flat tips.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np

from cuefem.solid import leather_table as lt
from cuefem.solid.tip import (
    Array,
    Patch,
    Shape,
    TipFineness,
    TipSolid,
    compliance,
    fitted,
    head_on,
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


def of_shape(shape: Shape, nus: Sequence[float], load: Array) -> list[lt.TipTable]:
    """The sheets of one tip, with whatever layers it has, for every Poisson's ratio of its leather.

    load: `all_loads` of its curvature.
    """
    where = sheets(shape.curvature)
    places, radii = np.array(list(chain(*where.values()))).T
    ends = np.cumsum([len(each) for each in where.values()])[:-1]
    off, straight = TipSolid(shape, layered(TABLE, shape)), _head_on(shape, nus)
    tips = []
    for nu, head in zip(nus, straight, strict=True):
        C = np.zeros((len(load), 2, 2))
        for m, surface in enumerate(surfaces(off, nu)):
            C += (load[:, m] @ surface) @ load[:, m].transpose(0, 2, 1)
        direct = np.stack([C[:, 0, 0], C[:, 1, 1]], -1)
        across = C[:, 0, 1] / places / np.sqrt(direct.prod(axis=-1))
        values = np.concatenate([np.log(direct / lt.half_space(nu, radii)), across[:, None]], -1)
        parts = dict.fromkeys(SHEETS) | {
            name: part.reshape(*SHEETS[name], 3) for name, part in zip(where, np.split(values, ends), strict=True)
        }
        tips.append(lt.TipTable(shape.curvature, nu, **parts, head_on=head))
    return tips


def _head_on(shape: Shape, nus: Sequence[float]) -> Array:
    """Logarithms of force and depth of a ball pressed on it head on, over a half-space's; (nu, radius, 2, 3)."""
    head = np.zeros((len(nus), HEAD_ON, 2, 3))
    for i, a in enumerate(np.exp(lt.nodes(*lt.LOG_HEAD_ON, HEAD_ON))):
        how = layered(fitted(shape.leather, a), shape)
        solid = TipSolid(shape, how)
        for k, nu in enumerate(nus):
            head[k, i] = np.log(head_on(shape, solid.surface(nu, 0), a, how) / lt.half_space_head_on(nu, a))
    return head


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
