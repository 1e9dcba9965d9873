"""Surface compliance of any leather tip with its layers, from 3-D elasticity of a domed cylinder.

The weak forms are those of `cuefem.solid.elasticity`, in every harmonic. The mesh is a square (y, x), mapped onto the
section by r = sin(pi x/2) D/2 and z = y H(r), with z from the clamped base to the apex; flat layers under the leather
have z = y H(0), and the leather's map begins on top of them. The result is the compliance of the top surface; the
compliance of a loaded patch is a quadratic form of it. The unit of length is the diameter, that of stress Young's
modulus of the leather.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from skfem import Basis, ElementQuadP, MeshQuad, MeshQuad2

from cuefem.cue import Array
from cuefem.solid import elasticity
from cuefem.solid import tip_table as tt

COMPUTED_HARMONICS = (10, 12, 15, 18, 22, 26, 31)  # harmonics above 8 that are computed; the others are interpolated
LAYER_ROWS = (0.0, 0.25, 0.75, 1.0)  # ends of the elements within a layer
GAUSS_POINTS = 48  # Gauss points along a ray of a patch, and over each part of the half circle of rays
N_POSITIONS, N_RADII, N_HEAD_ON = 13, 11, 8  # numbers of nodes of the table


class TipFineness(NamedTuple):
    """Element sizes of a tip.

    order: of the polynomials. radial, axial: ends of the elements along the radius and, within the leather, along the
    axis, from 0 to 1. harmonics: the highest m.
    """

    order: int
    radial: tuple[float, ...]
    axial: tuple[float, ...]
    harmonics: int


def graded_fineness(order: int = 4, radial: int = 6, axial: int = 5, harmonics: int = 30) -> TipFineness:
    """Elements graded towards the rim, the base and the top."""
    x, y = np.linspace(0, 1, radial + 1), np.linspace(0, 1, axial + 1)
    y = 0.5 * y + 0.25 * (1 - np.cos(np.pi * y))
    return TipFineness(order, tuple(x.tolist()), tuple(y.tolist()), harmonics)


TABLE_FINENESS = graded_fineness(5, 6, 5, 36)


def contact_fineness(height: float, radius: float, order: int = 5) -> TipFineness:
    """Elements for an axisymmetric contact of a radius, over D, graded towards its edge and the top."""
    edge = 2 * radius
    outer = [edge]
    step = 0.15 * edge
    while outer[-1] + 1.6 * step < 1:
        outer.append(outer[-1] + step)
        step *= 2
    ends = (0.0, 0.5 * edge, 0.85 * edge, *outer, *((1.0,) if edge < 1 else ()))
    depth, step = [0.0], 0.3 * radius
    while depth[-1] + 1.6 * step < height:
        depth.append(depth[-1] + step)
        step *= 2
    axial = tuple(1 - d / height for d in (height, *depth[::-1]))
    return TipFineness(order, tuple(_square_coordinate(np.array(ends) / 2).tolist()), axial, 0)


class Shape(NamedTuple):
    """A domed cylinder of unit diameter.

    height: with the layers. curvature: of the dome, D/r in [0, 2]. layers: flat, under the leather, from the base up;
    their sum is below the dome's rim.
    """

    height: float
    curvature: float
    layers: tuple[tt.Layer, ...] = ()

    @property
    def leather(self) -> float:
        """Height of the leather over D, with the dome."""
        return self.height - sum(height for height, _, _ in self.layers)


def dome_depth(radius: Array | float, curvature: float) -> Array | float:
    """Depth of a sphere's surface below its apex at a distance ``radius`` from the axis."""
    return curvature * np.square(radius) / (1 + np.sqrt(np.maximum(1 - np.square(curvature * np.asarray(radius)), 0)))


def _square_coordinate(radius: Array | float) -> Array:
    """x of the square at a radius over D: r = sin(pi x/2)/2, in which a hemisphere is smooth at its rim."""
    return np.asarray(np.arcsin(np.minimum(2 * np.asarray(radius), 1.0)) * 2 / np.pi)


def surface_nodes(fineness: TipFineness) -> Array:
    """x of the surface's nodes: the Chebyshev nodes of every element."""
    return np.append([tt.chebyshev_nodes(a, b, fineness.order + 1)[:-1] for a, b in pairwise(fineness.radial)], 1.0)


def lagrange(radius: Array, fineness: TipFineness) -> Array:
    """Values of the Lagrange polynomials of the surface's nodes at ``radius``, over D; (points, nodes)."""
    x, order = _square_coordinate(radius), fineness.order
    cell = np.clip(np.searchsorted(fineness.radial, x, side="right") - 1, 0, len(fineness.radial) - 2)
    values = np.zeros((len(x), (len(fineness.radial) - 1) * order + 1))
    for k, (a, b) in enumerate(pairwise(fineness.radial)):
        values[cell == k, k * order : (k + 1) * order + 1] = tt.node_weights(x[cell == k], a, b, order + 1)
    return values


class TipSolid:
    """A meshed domed cylinder on a clamped base: rows of elements within the leather, three rows within every layer."""

    def __init__(self, shape: Shape, fineness: TipFineness) -> None:
        ends = np.append(0.0, np.cumsum([height for height, _, _ in shape.layers]) / shape.height)
        spans = [(a + np.array(LAYER_ROWS[:-1]) * (b - a)) for a, b in pairwise(ends)]
        rows = np.concatenate([*spans, ends[-1] + (1 - ends[-1]) * np.array(fineness.axial)])
        square = MeshQuad.init_tensor(rows, np.array(fineness.radial))
        curved = MeshQuad2.from_mesh(square)
        y, x = curved.doflocs
        r, leather_height = np.sin(np.pi / 2 * x) / 2, np.maximum(y - ends[-1], 0.0) / (1 - ends[-1])
        mesh = MeshQuad2(np.array([shape.height * y - leather_height * dome_depth(r, shape.curvature), r]), curved.t)
        element, nodes = ElementQuadP(fineness.order), surface_nodes(fineness)
        self.shape, self.fineness, self.basis = shape, fineness, Basis(mesh, element, intorder=2 * fineness.order + 2)
        self.trace = Basis(square, element).probes(np.array([np.ones_like(nodes), nodes])).tocsr()
        self.layer = np.searchsorted(ends[1:], square.p[0, square.t].mean(axis=0))

    def surface(self, nu: float, m: int) -> Array:
        """Compliance of the surface in harmonic m with E = 1, (3 nodes, 3 nodes).

        Displacements (U, V, W) of the nodes per unit load on them.
        """
        basis, trace, zero = self.basis, self.trace, 0 * self.trace
        bodies = [*((E, ratio) for _, E, ratio in self.shape.layers), (1.0, nu)]
        stiff = [elasticity.stiffness(E, ratio, E / (2 * (1 + ratio)), E, ratio) for E, ratio in bodies]
        K, _ = elasticity.matrices(basis, m, [stiff[i] for i in self.layer], [1.0] * len(self.layer))
        base = elasticity.boundary_dofs(basis, 0, 0.0)
        free = elasticity.free_dofs(basis, m, base, basis.N + base, 2 * basis.N + base)
        hoop = -trace if m == 1 else zero  # V = S - U
        top = sp.bmat([[trace, zero, zero], [hoop, trace, zero], [zero, zero, trace]]).tocsc()[:, free]
        symmetric = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
        return np.asarray(top @ sla.splu(K[free][:, free], **symmetric).solve(top.T.toarray()))


def surface_compliances(solid: TipSolid, nu: float) -> list[Array]:
    """`TipSolid.surface` for all harmonics.

    High harmonics contribute little to a patch, and m times the compliance varies slowly with m: it is interpolated.
    """
    highest = solid.fineness.harmonics
    harmonics = sorted({m for m in (*range(9), *COMPUTED_HARMONICS, highest) if m <= highest})
    surfaces = {m: solid.surface(nu, m) for m in harmonics}
    for low, high in pairwise(harmonics):
        for m in range(low + 1, high):
            weight = (m - low) / (high - low)
            surfaces[m] = ((1 - weight) * low * surfaces[low] + weight * high * surfaces[high]) / m
    return [surfaces[m] for m in range(highest + 1)]


class Patch(NamedTuple):
    """A loaded patch: distance of its centre from the axis, over the tip's radius, and its radius over D."""

    position: float
    radius: float


def patch_loads(shape: Shape, patch: Patch, fineness: TipFineness) -> Array:
    """Unit loads of a patch on the surface's nodes along n and t, in every harmonic; (m, 2, 3 nodes).

    The traction is Hertz's, (1 - q^2/a^2)^(1/2) with q the distance from the patch's centre in the tangent plane there.
    The part beyond the rim is cut off and the rest scaled up. n points into the leather, t away from the axis.
    """
    k, a, centre = shape.curvature, patch.radius, patch.position / 2
    sin, rim = k * centre, k / 2
    cos, cos_rim = math.sqrt(1 - sin * sin), math.sqrt(max(1 - rim * rim, 0.0))

    def rim_distance(angle: Array) -> Array:
        """Distance from the centre to the rim along rays of the tangent plane."""
        c = np.cos(angle)
        b, square = centre * cos_rim * c, (c * sin) ** 2 + cos**2
        return np.asarray((np.sqrt(b * b + square * max(0.25 - centre**2, 0.0)) - b) / square)

    knots = [0.0, np.pi]
    if centre > 0 and rim_distance(np.array([0.0]))[0] < a < rim_distance(np.array([np.pi]))[0]:
        low, high = 0.0, np.pi
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if rim_distance(np.array([middle]))[0] < a else (low, middle)
        knots.insert(1, low)
    g, w = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    angle = np.concatenate([(q - p) / 2 * g + (p + q) / 2 for p, q in pairwise(knots)])
    ray_weights = np.concatenate([(q - p) / 2 * w for p, q in pairwise(knots)])
    max_beta = np.arcsin(np.minimum(rim_distance(angle) / a, 1.0))  # q = a sin(beta)
    beta = max_beta[:, None] * (g + 1) / 2
    q = a * np.sin(beta)
    cosine = np.sqrt(1 - np.square(k * q))  # divides, because the area is that of the dome, not of the tangent plane
    area = ray_weights[:, None] * (max_beta[:, None] * w / 2) * q / cosine
    x = centre + q * np.cos(angle)[:, None] * cos - k * q * q / (1 + cosine) * sin
    y = q * np.sin(angle)[:, None]
    x, y = x.ravel(), y.ravel()
    weight = (area * np.cos(beta) ** 2).ravel()
    weight /= weight.sum()
    radius, azimuth = np.hypot(x, y), np.arctan2(y, x)
    functions = lagrange(radius, fineness)
    m = np.arange(fineness.harmonics + 1)[:, None]
    even, odd = np.cos(m * azimuth) * weight, np.sin(m * azimuth) * weight
    # of a load along x, x and z
    radial, hoop, axial = (f @ functions for f in (even * np.cos(azimuth), -odd * np.sin(azimuth), even))
    zero = np.zeros_like(axial)
    lateral = np.concatenate([radial, hoop, zero], axis=-1)
    axial = np.concatenate([zero, zero, axial], axis=-1)
    return np.stack([-(sin * lateral + cos * axial), cos * lateral - sin * axial], axis=1)


def compliance(surfaces: Sequence[Array], load: Array) -> Array:
    """E D times the load-weighted mean displacement per unit load; surfaces: of the harmonics 0, 1, ..."""
    return np.asarray(sum(f @ S @ f.T for f, S in zip(load, surfaces, strict=True)))


def central_contact(shape: Shape, surface: Array, radius: float, fineness: TipFineness) -> Array:
    """Forces and depths, (2, 3), of a central contact of ``radius``, over D, with a rigid ball, for three unit gaps.

    The gaps between undeformed ball and tip at the distance p from the axis are the depth of the dome over its
    curvature, p^2/2 and p^4/8. surface: that of harmonic 0. The pressure is (1 - p^2/a^2)^(1/2) times a polynomial in
    p^2/a^2, which vanishes at the edge as between smooth bodies; force and depth are linear in the gap. It acts along
    the axis, between the normals of dome and ball. Galerkin's method, tested with these
    pressures and with a punch's.
    """
    g, w = np.polynomial.legendre.leggauss(160)
    beta = np.pi / 4 * (g + 1)
    x = np.sin(beta)
    p = radius * x
    area = np.pi / 4 * w * 2 * np.pi * p * radius * np.cos(beta)
    degree = 5
    shapes = np.polynomial.legendre.legvander(2 * x * x - 1, degree).T * np.cos(beta) * area
    nodes = surface.shape[0] // 3
    axial = surface[2 * nodes :, 2 * nodes :]
    load = shapes @ lagrange(p, fineness)
    matrix = np.hstack([load @ axial @ load[:-1].T, -shapes.sum(axis=1)[:, None]])
    k = shape.curvature
    gaps = np.array([p * p / (1 + np.sqrt(np.maximum(1 - np.square(k * p), 0))), p * p / 2, p**4 / 8])
    solution = np.linalg.solve(matrix, -(shapes @ gaps.T))
    return np.array([shapes[:-1].sum(axis=1) @ solution[:-1], solution[-1]])


def tip_table(shape: Shape, nu: float) -> tt.TipTable:
    """The table of one tip with its layers."""
    positions, radii = table_patches(shape.curvature)
    solid = TipSolid(shape, TABLE_FINENESS)
    surface = surface_compliances(solid, nu)
    compliances = [compliance(surface, load) for load in table_loads(shape.curvature)]
    C = np.reshape(compliances, (N_POSITIONS, N_RADII, 2, 2))
    diagonal = np.diagonal(C, axis1=2, axis2=3)
    coupling = C[..., 0, 1] / positions[:, None] / np.sqrt(diagonal.prod(axis=-1))
    patches = np.concatenate([np.log(diagonal / tt.half_space(nu, radii)), coupling[..., None]], -1)
    head_on = np.zeros((N_HEAD_ON, 2, 3))
    for i, a in enumerate(np.exp(tt.chebyshev_nodes(*tt.LOG_HEAD_ON, N_HEAD_ON))):
        solid = TipSolid(shape, contact_fineness(shape.leather, a))
        forces = central_contact(shape, solid.surface(nu, 0), a, solid.fineness)
        head_on[i] = np.log(forces / tt.half_space_head_on(nu, a))
    return tt.TipTable(shape.curvature, nu, patches, head_on)


def table_patches(curvature: float) -> tuple[Array, Array]:
    """Positions and radii of the patches in the table of a tip."""
    positions = np.sqrt(tt.chebyshev_nodes(tt.MIN_POSITION**2, tt.max_position(curvature) ** 2, N_POSITIONS))
    return positions, np.exp(tt.chebyshev_nodes(*tt.LOG_RADIUS, N_RADII))


@lru_cache(maxsize=1)
def table_loads(curvature: float) -> list[Array]:
    """Loads of these patches at `TABLE_FINENESS`; they do not depend on the tip's height."""
    positions, radii = table_patches(curvature)
    return [patch_loads(Shape(1.0, curvature), Patch(s, a), TABLE_FINENESS) for s in positions for a in radii]


def compute_tip_table(tip: tt.UntabulatedTip) -> tt.TipTable:
    """The table of a tip that the package's table does not cover."""
    height = max(tip.height, tt.dome_height(tip.curvature) + tt.MIN_SIDE)
    return tip_table(Shape(height, tip.curvature, tip.layers), tip.nu)
