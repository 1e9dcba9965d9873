"""The static compliance of a leather tip, from the table beside this file, which studies/beam/leather.py makes.

A tip outside the table, or with layers, is computed and stored by `cuefem.solid.tip_cache`.

Lengths here are over the tip's diameter D, moduli over Young's modulus E. A tip has a height, a curvature of the dome
D/r (0: flat) and Poisson's ratio nu; a patch has a position, the distance of its centre from the axis over D/2, and a
radius. The table is a grid of Chebyshev nodes in `CURVATURE_PANELS`, height, nu, position and radius, with the
logarithms of the compliance over that of a half-space, which have no singularity.

studies/beam/leather.md has the error of a compliance against the solid on a finer mesh. It is largest for patches over
the rim that are smaller than the table's.
"""

from __future__ import annotations

import math
from functools import cache, lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array

# What the table covers: height over D, D over the dome's radius, Poisson's ratio, radius of the patch over D.
HEIGHT, CURVATURE, POISSON, RADIUS = (2 / 15, 1.5), (0.0, 2.0), (0.2, 0.45), (0.06, 0.5)
HEAD_ON_RADIUS = (0.04, 0.45)
# Curvatures between which the table is smooth: above 1 the lowest tip has no side below its dome; above 1.5 the
# positions end where sin(phi) is 0.75.
CURVATURE_PANELS = (0.0, 1.0, 1.5, 2.0)
MIN_SIDE = 0.002  # over D: the least height of the side below the dome; lower ones count as this
HEIGHT_SHIFT = 0.1  # over D: the coordinate of the height is log(side + this)
MIN_POSITION = 0.01  # the innermost node, not 0, because C_nt is stored over the position


def chebyshev_nodes(low: float, high: float, count: int) -> Array:
    """Chebyshev nodes of an interval, with both ends."""
    return np.asarray((low + high) / 2 - (high - low) / 2 * np.cos(np.pi * np.arange(count) / (count - 1)))


def node_weights(x: Array | float, low: float, high: float, count: int) -> Array:
    """Weights of the values at `chebyshev_nodes` in their interpolating polynomial at ``x``, (..., count)."""
    sign = (-1.0) ** np.arange(count)
    sign[[0, -1]] /= 2
    gap = np.clip(x, low, high)[..., None] - chebyshev_nodes(low, high, count)
    at_node = gap == 0
    terms = np.where(at_node.any(axis=-1, keepdims=True), at_node, sign / np.where(at_node, 1.0, gap))
    return np.asarray(terms / terms.sum(axis=-1, keepdims=True))


def dome_height(curvature: float) -> float:
    """Height of the dome over D."""
    return curvature / 4 / (1 + math.sqrt(1 - curvature**2 / 4))


def rim_angle(curvature: float) -> float:
    """The coordinate of the curvature: the dome's angle at its rim, rad."""
    return math.asin(min(curvature / 2, 1.0))


def panel_of(curvature: float) -> int:
    """Index of the panel of a curvature."""
    return sum(curvature > end for end in CURVATURE_PANELS[1:-1])


def max_position(curvature: float) -> float:
    """The outermost position in the table: the rim, or on a steep dome that where sin(phi) is 0.75."""
    return min(1.0, CURVATURE_PANELS[2] / max(curvature, 1e-9))


def heights(curvature: float) -> tuple[float, float]:
    """Range of the coordinate of the height."""
    return height_coordinate(HEIGHT[0], curvature), height_coordinate(HEIGHT[1], curvature)


def height_coordinate(height: float, curvature: float) -> float:
    """The coordinate of a height."""
    return math.log(max(height - dome_height(curvature), MIN_SIDE) + HEIGHT_SHIFT)


def poisson_coordinate(nu: float) -> float:
    """The coordinate of Poisson's ratio, infinite for an incompressible material."""
    return -math.log1p(-2 * nu)


NU = (poisson_coordinate(POISSON[0]), poisson_coordinate(POISSON[1]))
LOG_RADIUS = (math.log(RADIUS[0]), math.log(RADIUS[1]))
LOG_HEAD_ON = (math.log(HEAD_ON_RADIUS[0]), math.log(HEAD_ON_RADIUS[1]))


def half_space(nu: float, radius: Array) -> Array:
    """E D times the normal and the tangential compliance of a Hertz-weighted patch on a half-space; (..., 2)."""
    normalized = np.array([0.6 * (1 - nu**2), 0.3 * (1 - nu / 2) * 2 * (1 + nu)])
    return np.asarray(normalized / np.asarray(radius)[..., None])


def half_space_head_on(nu: float, radius: Array) -> Array:
    """Force over E D^2 and depth over D of contacts on a half-space with the gaps p^2/2, p^2/2 and p^4/8; (..., 2, 3).

    A gap B p^n has the depth k B a^n and the force 2 E/(1 - nu^2) n/(n + 1) k B a^(n + 1); k is 2 for n = 2 and 8/3
    for n = 4.
    """
    a = np.asarray(radius)[..., None]
    gap, power = np.array([1.0, 1.0, 1 / 3]), np.array([2, 2, 4])
    depth = gap * a**power
    force = 2 / (1 - nu**2) * power / (power + 1) * depth * a
    return np.stack([force, depth], axis=-2)


class LeatherTable(NamedTuple):
    """The table's values; the first axes are the panel of the curvature, curvature, height and Poisson's ratio.

    patches: (..., position, radius, 3), the logarithms of C_nn and C_tt over a half-space's, and C_nt over the position
    and over the root of C_nn C_tt. head_on: (..., radius, 2, 3), the logarithms of force and depth over a half-space's
    for the three gaps.
    """

    patches: Array
    head_on: Array


@cache
def table() -> LeatherTable:
    """The package's table."""
    with np.load(Path(__file__).with_suffix(".npz")) as file:
        return LeatherTable(*(file[name].astype(float) for name in LeatherTable._fields))


class TipTable(NamedTuple):
    """The table of one tip: its curvature and Poisson's ratio, and `LeatherTable` without its first axes."""

    curvature: float
    nu: float
    patches: Array
    head_on: Array


Layer = tuple[float, float, float]  # a layer's height over D, Young's modulus over that of the leather, Poisson's ratio


class UntabulatedTip(NamedTuple):
    """A tip that the table does not cover, lengths over its diameter.

    height: of leather and layers. curvature: of the dome. nu: of the leather. layers: from the ferrule up.
    """

    height: float
    curvature: float
    nu: float
    layers: tuple[Layer, ...]


def is_tabulated(height: float, nu: float) -> bool:
    """Whether the table covers the height, over D, and Poisson's ratio of a tip."""
    return HEIGHT[0] * (1 - 1e-9) <= height <= HEIGHT[1] * (1 + 1e-9) and POISSON[0] <= nu <= POISSON[1]


@lru_cache(maxsize=64)
def table_of_tip(height: float, curvature: float, nu: float) -> TipTable:
    """The table of one tip, interpolated."""
    panel, (patches, head) = panel_of(curvature), table()
    low, high = (rim_angle(end) for end in CURVATURE_PANELS[panel : panel + 2])
    coordinates = (
        (rim_angle(curvature), low, high),
        (height_coordinate(height, curvature), *heights(curvature)),
        (poisson_coordinate(nu), *NU),
    )
    arrays = [patches[panel], head[panel]]
    for x, low, high in coordinates:
        arrays = [np.tensordot(node_weights(x, low, high, len(array)), array, 1) for array in arrays]
    return TipTable(curvature, nu, *arrays)


def distance_to_rim(curvature: float, position: float) -> float:
    """Distance from ``position`` to the rim, over D, in the tangent plane there."""
    sine, rim_sine = curvature * position / 2, curvature / 2
    return (0.25 - position**2 / 4) / (0.5 * math.sqrt(1 - sine**2) + position / 2 * math.sqrt(1 - rim_sine**2))


def compliance(tip: TipTable, position: float, radius: Array) -> Array:
    """E D times the compliance in (n, t) of Hertz-weighted patches of radii up to 1/2; (radii, 2, 2).

    Below the table's radii the difference of a half-space's compliance is added; for patches over the rim a part in
    proportion to 1/radius, extrapolated from the two smallest radii.
    """
    covered = np.maximum(radius, RADIUS[0])
    matrices = _interpolate(tip, position, covered)
    if distance_to_rim(tip.curvature, position) >= RADIUS[0]:
        correction = half_space(tip.nu, radius) - half_space(tip.nu, covered)
        return np.asarray(matrices + correction[:, None] * np.eye(2))
    first, second = _interpolate(tip, position, np.array([1.0, 1.5]) * RADIUS[0])
    return np.asarray(matrices + 3 * (first - second) * (RADIUS[0] / radius - RADIUS[0] / covered)[:, None, None])


def _interpolate(tip: TipTable, position: float, radius: Array) -> Array:
    """E D times the compliance at radii within the table."""
    n_positions, n_radii, _ = tip.patches.shape
    weights = node_weights(position**2, MIN_POSITION**2, max_position(tip.curvature) ** 2, n_positions)
    logarithms = node_weights(np.log(radius), *LOG_RADIUS, n_radii) @ np.tensordot(weights, tip.patches, 1)
    normal, shear = (np.exp(logarithms[:, :2]) * half_space(tip.nu, radius)).T
    coupling = logarithms[:, 2] * position * np.sqrt(normal * shear)
    return np.array([[normal, coupling], [coupling, shear]]).transpose(2, 0, 1)


def rigid_patch_gain(nu: float, curvature: float, height: float, radius: Array) -> Array:
    """E D times the difference in compliance along t between a Hertz-weighted patch and a rigid sticking one.

    On a half-space it is 1/6 of the compliance. It is less for a patch that is wide relative to the tip or to the
    leather's ``height`` there, and more on a dome, where the patch's edge moves less than its middle as the tip bends.
    Fitted to the solid on the axis (studies/beam/leather.md) for pool tips: dome flat to dime, heights 0.3 to 0.7, nu
    0.3 to 0.45, radii 0.08 to 0.25.
    """
    wide, thin = (2 * radius) ** 3, (radius / height) ** 2
    flat = (1 - (1.09 - 0.57 * nu) * wide) * (1 - 0.11 * thin / (1 + 0.26 * thin))
    dome = curvature * radius * (1 + 33 * radius**2 * (height - 0.2)) * (0.72 + 0.7 * nu)
    return np.asarray(half_space(nu, radius)[..., 1] / 6 * (flat + dome))


def head_on(tip: TipTable, radius: Array, ball: float) -> Array:
    """Force over E D^2 and depth over D of a central contact with a ball of radius ``ball``, by radius; (radii, 2)."""
    covered = np.maximum(radius, HEAD_ON_RADIUS[0])
    ratio = np.tensordot(node_weights(np.log(covered), *LOG_HEAD_ON, len(tip.head_on)), tip.head_on, 1)
    ratio = ratio * (radius / covered)[:, None, None]  # vanishes with the radius
    gaps = np.array([tip.curvature, 1 / ball, 1 / ball**3])
    return np.asarray((half_space_head_on(tip.nu, radius) * np.exp(ratio)) @ gaps)
