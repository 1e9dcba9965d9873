"""A leather tip as a solid: 3-D elasticity of a domed cylinder by Fourier harmonics on an (r, z) mesh.

With t the angle about the axis, u_r = U(r, z) cos mt, u_t = V(r, z) sin mt, u_z = W(r, z) cos mt, and every strain is a
function of (r, z) times cos mt or sin mt (`TipSolid._parts`). z runs from the base, which is held, to the apex. The
unit square (x, y) is mapped exactly onto the section, r = sin(pi x/2) D/2 and z = y H(r), so that one scikit-fem basis
serves every tip; flat layers under the leather keep z = y H(0), and the leather is mapped from there on. Rows of
elements are eliminated from the base upwards; what is left is the compliance of the top surface alone
(`TipSolid.surface`), on which each patch of load is a quadratic form. The unit of length is the diameter, that of
stress is Young's modulus of the leather on top.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Annotated, NamedTuple

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray
from skfem import Basis, ElementQuadP, MeshQuad

from cuefem.quantity.fields import Quantity, check_fields

Array = NDArray[np.float64]
SOLVED = (10, 12, 15, 18, 22, 26, 31)  # harmonics above 8 that are computed; the others are interpolated
ROWS = (0.0, 0.25, 0.75, 1.0)  # where elements end within a layer
POINTS = 48  # Gauss points along a ray of a patch, and over each part of the half circle of rays


class TipFineness(NamedTuple):
    """order: of the polynomials; across, up: where elements end along the radius and the axis, from 0 to 1; harmonics:
    the highest m."""

    order: int
    across: tuple[float, ...]
    up: tuple[float, ...]
    harmonics: int


def usual(order: int = 4, radial: int = 6, up: int = 5, harmonics: int = 30) -> TipFineness:
    """Elements that shrink towards the rim, and towards base and top."""
    x, y = np.linspace(0, 1, radial + 1), np.linspace(0, 1, up + 1)
    y = 0.5 * y + 0.25 * (1 - np.cos(np.pi * y))
    return TipFineness(order, tuple(x.tolist()), tuple(y.tolist()), harmonics)


def fitted(height: float, radius: float, order: int = 5) -> TipFineness:
    """For the axisymmetric contact of a radius over D: elements end at its edge, shrink towards it and to the top."""
    edge = 2 * radius
    out = [edge]
    step = 0.15 * edge
    while out[-1] + 1.6 * step < 1:
        out.append(out[-1] + step)
        step *= 2
    ends = (0.0, 0.5 * edge, 0.85 * edge, *out, *((1.0,) if edge < 1 else ()))
    depth, step = [0.0], 0.3 * radius
    while depth[-1] + 1.6 * step < height:
        depth.append(depth[-1] + step)
        step *= 2
    return TipFineness(
        order, tuple(across(np.array(ends) / 2).tolist()), tuple(1 - d / height for d in (height, *depth[::-1])), 0
    )


@dataclass(frozen=True)
class Layer:
    """A flat layer under the leather, a pad or a ferrule that gives: height over D, Young's modulus over that of the
    leather, Poisson's ratio."""

    height: Annotated[float, Quantity("", "(0, inf)")]
    modulus: Annotated[float, Quantity("", "(0, inf)")]
    nu: Annotated[float, Quantity("", "(-1, 0.5)")]

    def __post_init__(self) -> None:
        check_fields(self)


@dataclass(frozen=True)
class Shape:
    """A domed cylinder of unit diameter: its whole height, the dome's curvature D/r in [0, 2], and the layers under the
    leather, from the base up."""

    height: float
    curvature: float
    layers: tuple[Layer, ...] = ()

    def __post_init__(self) -> None:
        side, below = self.height - self.sag, sum(layer.height for layer in self.layers)
        if self.layers and below >= side:
            raise ValueError(
                f"Shape.layers must end below the dome, together less than {side:.4g} diameters high; got {below:.4g}"
            )

    @property
    def ends(self) -> Array:
        """Upper ends of the layers, over the whole height."""
        return np.cumsum([layer.height for layer in self.layers]) / self.height

    @property
    def leather(self) -> float:
        """Height of the leather over D, the dome included."""
        return self.height - sum(layer.height for layer in self.layers)

    @property
    def sag(self) -> float:
        """Depth of the dome, over D."""
        return float(drop(0.5, self.curvature))


def layered(how: TipFineness, shape: Shape) -> TipFineness:
    """Rows for a tip with layers: those of ``how`` within the leather, and three within every layer."""
    rows, start = [0.0], 0.0
    for end in shape.ends:
        rows += [start + part * (end - start) for part in ROWS[1:]]
        start = float(end)
    return how._replace(up=(*rows, *(start + y * (1 - start) for y in how.up[1:])))


def drop(radius: Array | float, curvature: float) -> Array | float:
    """Depth of a sphere's surface below its apex at a distance ``radius`` from the axis."""
    return curvature * np.square(radius) / (1 + np.sqrt(np.maximum(1 - np.square(curvature * np.asarray(radius)), 0)))


# The mesh


class Grid(NamedTuple):
    """Of the reference square: basis; values and slopes of its functions at quadrature points, (functions, cells,
    points); the points themselves and their weights, (cells, points); nodes: x of the surface's nodes; trace: (nodes,
    unknowns of one field), the values at the nodes."""

    basis: Basis
    value: Array
    slope_x: Array
    slope_y: Array
    x: Array
    y: Array
    weight: Array
    nodes: Array
    trace: Array


@lru_cache(maxsize=4)
def grid(how: TipFineness) -> Grid:
    """The reference square's mesh and basis."""
    ends = np.array(how.across)
    mesh = MeshQuad.init_tensor(ends, np.array(how.up))
    basis = Basis(mesh, ElementQuadP(how.order), intorder=2 * how.order + 2)
    value = np.array([np.broadcast_to(np.asarray(f[0]), basis.dx.shape) for f in basis.basis])
    slope_x, slope_y = np.moveaxis(np.array([f[0].grad for f in basis.basis]), 1, 0)
    x, y = np.asarray(basis.global_coordinates())
    local = lobatto(how.order)
    nodes = np.append((ends[:-1, None] + np.diff(ends)[:, None] * local[:-1]).ravel(), 1.0)
    trace = basis.probes(np.array([nodes, np.ones_like(nodes)])).toarray()
    return Grid(basis, value, slope_x, slope_y, x, y, basis.dx, nodes, trace)


def across(radius: Array | float) -> Array:
    """x of the reference square at a radius over D: r = sin(pi x/2)/2, in which a hemisphere is smooth at its rim."""
    return np.asarray(np.arcsin(np.minimum(2 * np.asarray(radius), 1.0)) * 2 / np.pi)


def lobatto(order: int) -> Array:
    """The ``order`` + 1 Chebyshev points of [0, 1], ends included."""
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * np.arange(order + 1) / order))


def lagrange(radius: Array, how: TipFineness) -> Array:
    """Values at ``radius``, over D, of the functions that are 1 at one node and 0 at the others, (points, nodes)."""
    x = across(radius)
    ends, local = np.array(how.across), lobatto(how.order)
    cell = np.clip(np.searchsorted(ends, x, side="right") - 1, 0, len(ends) - 2)
    place = (x - ends[cell]) / np.diff(ends)[cell]
    factors = np.array(
        [np.prod([(place - b) / (a - b) for j, b in enumerate(local) if j != i], axis=0) for i, a in enumerate(local)]
    )
    values = np.zeros((len(x), (len(ends) - 1) * how.order + 1))
    values[np.arange(len(x))[:, None], cell[:, None] * how.order + np.arange(how.order + 1)] = factors.T
    return values


# The body


class TipSolid:
    """The stiffness of a domed cylinder, for every Poisson's ratio of the leather and harmonic.

    ``how.up`` must have the ends of the shape's layers (`layered`).
    """

    def __init__(self, shape: Shape, how: TipFineness) -> None:
        if any(min(abs(end - y) for y in how.up) > 1e-9 for end in shape.ends):
            raise ValueError(f"TipFineness.up must have the ends of all layers, {shape.ends}; got {how.up}")
        self.shape, self.how, self.grid = shape, how, grid(how)

    def _parts(self) -> tuple[Array, Array, Array, Array]:
        """Volume strain and the scaled strains (rr, tt, zz, rz, rt, tz) of the three fields' functions: the part
        without m and the part in proportion to m; (cells, strains x points, 3 functions)."""
        g, shape = self.grid, self.shape
        r, stretch = np.sin(np.pi / 2 * g.x) / 2, np.pi / 4 * np.cos(np.pi / 2 * g.x)
        start = float(shape.ends[-1]) if shape.layers else 0.0  # the leather's base
        within = np.maximum(g.y - start, 0.0) / (1 - start)
        below = g.y < start
        rise = np.where(below, shape.height, shape.height - drop(r, shape.curvature) / (1 - start))
        slope = -shape.curvature * r / np.sqrt(1 - np.square(shape.curvature * r))
        f, fz = g.value, g.slope_y / rise
        fr = g.slope_x / stretch - g.slope_y * (within * slope / rise)
        root = np.sqrt(r * g.weight * rise * stretch)
        none, fa = np.zeros_like(f), f / r
        two = math.sqrt(2)
        plain = [
            [two * fr, none, none],
            [two * fa, none, none],
            [none, none, two * fz],
            [fz, none, fr],
            [none, fr - fa, none],
            [none, fz, none],
        ]
        wound = [[none] * 3, [none, two * fa, none], [none] * 3, [none] * 3, [-fa, none, none], [none, none, -fa]]

        def stacked(rows: list[list[Array]]) -> Array:
            all_rows = np.array(rows) * root  # (strains, fields, functions, cells, points)
            s, k, n, c, q = all_rows.shape
            return all_rows.transpose(3, 0, 4, 1, 2).reshape(c, s * q, k * n)

        return stacked([[fr + fa, none, fz]]), stacked([[none, fa, none]]), stacked(plain), stacked(wound)

    @cached_property
    def rows(self) -> list[tuple[NDArray[np.intp], Array]]:
        """For every row of elements, from the base up: its unknowns; matrices of lambda and G times 1, m, m^2."""
        v0, v1, s0, s1 = self._parts()
        blocks = []
        for a, b in ((v0, v1), (s0, s1)):
            blocks.append(a.transpose(0, 2, 1) @ a)
            if self.how.harmonics > 0:
                cross = a.transpose(0, 2, 1) @ b
                blocks += [cross + cross.transpose(0, 2, 1), b.transpose(0, 2, 1) @ b]
        basis, rows = self.grid.basis, []
        own = (basis.N * np.arange(3)[:, None, None] + basis.element_dofs).transpose(2, 0, 1)
        own = own.reshape(own.shape[0], -1)
        level = np.round(self.grid.y.mean(axis=1), 9)
        for at in np.unique(level):
            cells = np.flatnonzero(level == at)
            unknowns, places = np.unique(own[cells], return_inverse=True)
            places = places.reshape(len(cells), -1)
            whole = np.zeros((len(blocks), len(unknowns), len(unknowns)))
            for cell, place in zip(cells, places, strict=True):
                for k, block in enumerate(blocks):
                    whole[k][np.ix_(place, place)] += block[cell]
            rows.append((unknowns, whole))
        return rows

    @cached_property
    def _sides(self) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
        """Unknowns of one field on the axis, on the base and on the top."""
        basis = self.grid.basis

        def side(coordinate: int, at: float) -> NDArray[np.intp]:
            facets = basis.mesh.facets_satisfying(lambda p: np.abs(p[coordinate] - at) < 1e-9, boundaries_only=True)
            return np.asarray(basis.get_dofs(facets).all())

        return side(0, 0.0), side(1, 0.0), side(1, 1.0)

    def surface(self, nu: float, m: int) -> Array:
        """Displacements (U, V, W) of the surface's nodes per unit load on them, E = 1, (3 nodes, 3 nodes)."""
        N, nodes = self.grid.basis.N, len(self.grid.nodes)
        bodies = [*((layer.modulus, layer.nu) for layer in self.shape.layers), (1.0, nu)]
        middles = (np.array(self.how.up[1:]) + self.how.up[:-1]) / 2
        of_row = np.searchsorted(self.shape.ends, middles)
        powers = [1.0, m, m * m] if self.how.harmonics > 0 else [1.0]
        turn = np.pi * (2 if m == 0 else 1)
        axis, base, top = self._sides
        clamped = [base, N + base, 2 * N + base]
        if m == 0:
            clamped += [axis, N + np.arange(N)]
        elif m == 1:
            clamped += [N + axis, 2 * N + axis]  # V = -U there: see below
        else:
            clamped += [axis, N + axis, 2 * N + axis]
        stopped = np.zeros(3 * N, dtype=bool)
        stopped[np.concatenate(clamped)] = True
        carried, passed = np.zeros((0, 0)), np.zeros(0, dtype=np.intp)
        for i, (unknowns, parts) in enumerate(self.rows):
            E, ratio = bodies[of_row[i]]
            moduli = E * ratio / ((1 + ratio) * (1 - 2 * ratio)), E / (2 * (1 + ratio))
            K = np.tensordot(np.outer(moduli, powers).ravel() * turn, parts, 1)
            if m == 1:  # the axis moves as one point: U = -V
                u = np.flatnonzero(np.isin(unknowns, axis))
                v = np.searchsorted(unknowns, unknowns[u] + N)
                K[u] -= K[v]
                K[:, u] -= K[:, v]
            there = np.searchsorted(unknowns, passed)
            K[np.ix_(there, there)] += carried
            above = self.rows[i + 1][0] if i + 1 < len(self.rows) else np.concatenate([top, N + top, 2 * N + top])
            free = ~stopped[unknowns]
            up = np.isin(unknowns, above)
            inner, outer = np.flatnonzero(free & ~up), np.flatnonzero(free & up)
            solved = la.cho_solve(la.cho_factor(K[np.ix_(inner, inner)], check_finite=False), K[np.ix_(inner, outer)])
            carried = K[np.ix_(outer, outer)] - K[np.ix_(outer, inner)] @ solved
            passed = unknowns[outer]
        values = np.zeros((3 * nodes, 3 * N))
        for k in range(3):
            values[k * nodes : (k + 1) * nodes, k * N : (k + 1) * N] = self.grid.trace
        if m == 1:
            values[:, axis] -= values[:, N + axis]
        values = values[:, passed]
        return np.asarray(values @ la.cho_solve(la.cho_factor(carried), values.T))


def surfaces(solid: TipSolid, nu: float, *, every: bool = False) -> list[Array]:
    """`TipSolid.surface` for all harmonics; every: computed for each of them, not for some of the higher ones.

    m times it hardly changes from one high m to the next, so it is interpolated; patches get little from those.
    """
    highest = solid.how.harmonics
    solved = [m for m in range(highest + 1) if every or m <= 8 or m == highest or m in SOLVED]
    known = {m: solid.surface(nu, m) for m in solved}
    matrices = []
    for m in range(highest + 1):
        if m not in known:
            low, high = max(k for k in solved if k < m), min(k for k in solved if k > m)
            part = (m - low) / (high - low)
            matrices.append(((1 - part) * low * known[low] + part * high * known[high]) / m)
        else:
            matrices.append(known[m])
    return matrices


# Patches


class Patch(NamedTuple):
    """Where a patch is: distance of its centre from the axis, over the tip's radius, and its radius over D."""

    place: float
    radius: float


def loads(shape: Shape, patch: Patch, how: TipFineness, powers: Sequence[float] = (0.5,)) -> Array:
    """Loads of one newton on the surface's nodes along n and along t, of every harmonic; (m, 2 per power, 3 nodes).

    The traction falls over the patch as (1 - q^2/a^2)^power, q the distance from its centre in the tangent plane there:
    1/2 for Hertz's pressure, -1/2 for a rigid punch's. What lies beyond the rim is cut off and the rest scaled up.
    n points into the leather, t away from the axis.
    """
    k, a, centre = shape.curvature, patch.radius, patch.place / 2
    sin, rim = k * centre, k / 2
    cos, cos_rim = math.sqrt(1 - sin * sin), math.sqrt(max(1 - rim * rim, 0.0))

    def reach(angle: Array) -> Array:
        """Distance from the centre to the rim along rays of the tangent plane."""
        c = np.cos(angle)
        b, square = centre * cos_rim * c, (c * sin) ** 2 + cos**2
        return np.asarray((np.sqrt(b * b + square * max(0.25 - centre**2, 0.0)) - b) / square)

    knots = [0.0, np.pi]
    if centre > 0 and reach(np.array([0.0]))[0] < a < reach(np.array([np.pi]))[0]:
        low, high = 0.0, np.pi
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if reach(np.array([middle]))[0] < a else (low, middle)
        knots.insert(1, low)
    g, w = np.polynomial.legendre.leggauss(POINTS)
    angle = np.concatenate([(q - p) / 2 * g + (p + q) / 2 for p, q in pairwise(knots)])
    turn = np.concatenate([(q - p) / 2 * w for p, q in pairwise(knots)])
    last = np.arcsin(np.minimum(reach(angle) / a, 1.0))  # q = a sin(beta)
    beta = last[:, None] * (g + 1) / 2
    q = a * np.sin(beta)
    level = np.sqrt(1 - np.square(k * q))  # over it, for the dome's surface is meant, not the tangent plane
    flat = turn[:, None] * (last[:, None] * w / 2) * q / level
    x = centre + q * np.cos(angle)[:, None] * cos - k * q * q / (1 + level) * sin
    y = q * np.sin(angle)[:, None]
    x, y = x.ravel(), y.ravel()
    weight = np.array([(flat * np.cos(beta) ** (2 * power + 1)).ravel() for power in powers])
    weight /= weight.sum(axis=1)[:, None]
    radius, turned = np.hypot(x, y), np.arctan2(y, x)
    functions = lagrange(radius, how)
    m = np.arange(how.harmonics + 1)[:, None, None]
    even, odd = np.cos(m * turned) * weight, np.sin(m * turned) * weight
    along = [f @ functions for f in (even * np.cos(turned), -odd * np.sin(turned), even)]  # of a load along x, x and z
    none = np.zeros_like(along[0])
    lateral = np.concatenate([along[0], along[1], none], axis=-1)
    axial = np.concatenate([none, none, along[2]], axis=-1)
    both = np.stack([-(sin * lateral + cos * axial), cos * lateral - sin * axial], axis=2)
    return both.reshape(len(m), -1, both.shape[-1])


def compliance(surfaces: Sequence[Array], load: Array) -> Array:
    """E D times the mean displacement, weighted with the loads, per load; surfaces: of the harmonics 0, 1, ..."""
    return np.asarray(sum(f @ S @ f.T for f, S in zip(load, surfaces, strict=True)))


def punch(pair: Array) -> Array:
    """The compliance in (n, t) of a rigid patch that sticks, from that of the loads with powers 1/2 and -1/2.

    It is the least that a sum of such tractions reaches: the theorem of least complementary energy. The patch is held
    in its directions n and t, and free to tilt.
    """
    force = np.vstack([np.eye(2), np.eye(2)])
    return np.asarray(np.linalg.inv(force.T @ np.linalg.solve(pair, force)))


# Head on


def head_on(shape: Shape, surface: Array, radius: float, how: TipFineness, terms: int = 5) -> Array:
    """Of the contact of radius ``radius``, over D, with a rigid ball: forces and depths, (2, 3), for unit gaps.

    The gaps between undeformed ball and tip are, at the distance p from the axis: the depth of the dome over its
    curvature, p^2/2 and p^4/8. surface: that of harmonic 0. The pressure is (1 - p^2/a^2)^(1/2) times a polynomial in
    p^2/a^2, so it vanishes at the edge as that of two smooth bodies does; force and depth are linear in the gap.
    It acts along the axis, between the normal of the dome and that of the ball. Galerkin's method, tested with these
    pressures and with a punch's.
    """
    g, w = np.polynomial.legendre.leggauss(160)
    beta = np.pi / 4 * (g + 1)
    x = np.sin(beta)
    p = radius * x
    area = np.pi / 4 * w * 2 * np.pi * p * radius * np.cos(beta)
    shapes = np.polynomial.legendre.legvander(2 * x * x - 1, terms).T * np.cos(beta) * area
    nodes = surface.shape[0] // 3
    axial = surface[2 * nodes :, 2 * nodes :]
    load = shapes @ lagrange(p, how)
    matrix = np.hstack([load @ axial @ load[:-1].T, -shapes.sum(axis=1)[:, None]])
    k = shape.curvature
    gaps = np.array([p * p / (1 + np.sqrt(np.maximum(1 - np.square(k * p), 0))), p * p / 2, p**4 / 8])
    solution = np.linalg.solve(matrix, -(shapes @ gaps.T))
    return np.array([shapes[:-1].sum(axis=1) @ solution[:-1], solution[-1]])
