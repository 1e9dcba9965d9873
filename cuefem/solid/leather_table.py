"""The static give of a leather tip, from the table beside this file, which studies/beam/leather.py makes.

A tip outside the table, with layers, or on a ferrule that gives, has a `TipTable` of its own (`cuefem.solid.own_tip`).

Lengths are over the tip's diameter D and moduli over Young's modulus E here. A tip is its height, its dome's curvature
D/r (0: flat) and Poisson's ratio nu; a patch is the place of its centre, the distance from the axis over D/2, and its
radius. The table holds, at Chebyshev's nodes, logarithms of the compliance over a half-space's, in which nothing is
singular. `Coordinates` says where the nodes are.
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
# Curvatures between which everything is smooth: at the first the lowest tip becomes one without a side below its dome,
# at the second patches are no longer asked for near the rim, where sin(phi) is far above 0.6.
PANELS = (0.0, 1.0, 1.5, 2.0)
WALL = 0.002  # over D: the least height of the side below the dome; lower ones are taken for it
SOFTENED = 0.1  # over D: heights enter as log(wall + this)
NEAR_RIM = 0.1  # over D: patches are near the rim if it cuts them at this radius
AXIS = 0.01  # place: C_nt over the place is wanted on the axis as well


def nodes(low: float, high: float, count: int) -> Array:
    """Chebyshev's nodes of an interval, both ends among them."""
    return np.asarray((low + high) / 2 - (high - low) / 2 * np.cos(np.pi * np.arange(count) / (count - 1)))


def weights(x: Array | float, low: float, high: float, count: int) -> Array:
    """What the values at `nodes` weigh in the polynomial through them at ``x``, (..., count)."""
    at = nodes(low, high, count)
    sign = (-1.0) ** np.arange(count)
    sign[[0, -1]] /= 2
    gap = np.clip(x, low, high)[..., None] - at if isinstance(x, np.ndarray) else np.clip(x, low, high) - at
    hit = gap == 0
    terms = sign / np.where(hit, 1.0, gap)
    terms = np.where(hit.any(axis=-1, keepdims=True), hit, terms)
    return np.asarray(terms / terms.sum(axis=-1, keepdims=True))


def sag(curvature: float) -> float:
    """Depth of the dome."""
    return curvature / 4 / (1 + math.sqrt(1 - curvature**2 / 4))


def steepness(curvature: float) -> float:
    """The coordinate that stands for the curvature: the angle of the dome at its rim."""
    return math.asin(min(curvature / 2, 1.0))


def panel_of(curvature: float) -> int:
    """Which of the PANELS a curvature is in."""
    return sum(curvature > end for end in PANELS[1:-1])


def inner(curvature: float) -> float:
    """The place up to which patches are not near the rim; of steep domes, where sin(phi) is 0.64."""
    k = min(curvature, PANELS[2])
    return (
        (math.sqrt(1 - (NEAR_RIM * k) ** 2) - 2 * NEAR_RIM * math.sqrt(1 - k**2 / 4)) * k / max(curvature, k)
        if k
        else 0.8
    )


def farthest(curvature: float) -> float:
    """The outermost place in the table."""
    return 1.0 if curvature <= PANELS[2] else inner(curvature)


def heights(curvature: float) -> tuple[float, float]:
    """Range of the coordinate that stands for the height, log(side + SOFTENED)."""
    low, high = (max(h - sag(curvature), WALL) for h in HEIGHT)
    return math.log(low + SOFTENED), math.log(high + SOFTENED)


def height_coordinate(height: float, curvature: float) -> float:
    """The coordinate that stands for a height."""
    return math.log(max(height - sag(curvature), WALL) + SOFTENED)


def poisson_coordinate(nu: float) -> float:
    """The coordinate that stands for Poisson's ratio: leather that does not change its volume is infinitely far off."""
    return -math.log1p(-2 * nu)


NU = (poisson_coordinate(POISSON[0]), poisson_coordinate(POISSON[1]))
LOG_HEAD_ON = (math.log(HEAD_ON_RADIUS[0]), math.log(HEAD_ON_RADIUS[1]))


def edge(curvature: float, place: float) -> float:
    """Radius of the patch around ``place`` that reaches the rim, in the tangent plane of its centre."""
    here, rim = curvature * place / 2, curvature / 2
    return (0.25 - place**2 / 4) / (0.5 * math.sqrt(1 - here**2) + place / 2 * math.sqrt(1 - rim**2))


def half_space(nu: float, radius: Array) -> Array:
    """E D times the normal and the tangential compliance of a Hertz-weighted patch on a half-space, (..., 2)."""
    parts = np.array([0.6 * (1 - nu**2), 0.3 * (1 - nu / 2) * 2 * (1 + nu)])
    return np.asarray(parts / np.asarray(radius)[..., None])


def half_space_head_on(nu: float, radius: Array) -> Array:
    """Force, over E D^2, and depth of contacts on a half-space with gaps p^2/2, p^2/2 and p^4/8; (..., 2, 3).

    A gap B p^n gives the depth k B a^n and the force 2 E/(1 - nu^2) n/(n + 1) k B a^(n + 1); k is 2 for n = 2 and 8/3
    for n = 4.
    """
    a = np.asarray(radius)[..., None]
    gap, power = np.array([1.0, 1.0, 1 / 3]), np.array([2, 2, 4])
    depth = gap * a**power
    force = 2 / (1 - nu**2) * power / (power + 1) * depth * a
    return np.stack([force, depth], axis=-2)


class LeatherTable(NamedTuple):
    """The table's values; the first axes are the panel of the curvature, curvature, height and Poisson's ratio.

    whole, cut, rim: (..., place, radius, 3), the logarithms of C_nn and C_tt over a half-space's, and C_nt over the
    place and over the root of C_nn C_tt: of patches away from the rim, those that it cuts, and those near it (in all
    panels but the last). head_on: (..., radius, 2, 3), the logarithms of force and depth over a half-space's for the
    three gaps. punch: (height, nu, radius, 2), by how much a rigid patch that sticks is stiffer than a Hertz-weighted
    one, on a flat tip and on its axis, over the same difference on a half-space.
    """

    whole: Array
    cut: Array
    rim: Array
    head_on: Array
    punch: Array


@cache
def table() -> LeatherTable:
    """The table that belongs to cuefem."""
    with np.load(Path(__file__).with_name("leather_table.npz")) as file:
        return LeatherTable(*(file[name].astype(float) for name in LeatherTable._fields))


class TipTable(NamedTuple):
    """The table of one tip: `LeatherTable` without its first axes; rim is None on steep domes.

    punch: (height, radius, 2), of flat tips at the nodes of ``heights``, the range of the coordinate of the height.
    """

    curvature: float
    nu: float
    whole: Array
    cut: Array
    rim: Array | None
    head_on: Array
    punch: Array
    heights: tuple[float, float]


FLAT_HEIGHTS = 4  # flat tips of an `OwnTip`'s table, from the side of its dome up to its apex
Flat = tuple[float, float, float]  # a layer's height over D, Young's modulus over that of the leather, Poisson's ratio


class OwnTip(NamedTuple):
    """A tip that the table does not hold, lengths over its diameter: the height of leather and layers, the dome's
    curvature, the leather's Poisson's ratio, the layers from the ferrule up, and the ferrule if it gives."""

    height: float
    curvature: float
    nu: float
    layers: tuple[Flat, ...]
    ferrule: Flat | None


def covers(height: float, nu: float) -> bool:
    """Whether the table has the height, over D, and Poisson's ratio of a tip."""
    return HEIGHT[0] * (1 - 1e-9) <= height <= HEIGHT[1] * (1 + 1e-9) and POISSON[0] <= nu <= POISSON[1]


@lru_cache(maxsize=64)
def of_tip(height: float, curvature: float, nu: float) -> TipTable:
    """The table of one tip."""
    all_tips = table()
    panel = panel_of(curvature)
    counts = all_tips.whole.shape[1:4]
    low, high = (steepness(end) for end in PANELS[panel : panel + 2])
    k = weights(steepness(curvature), low, high, counts[0])
    h = weights(height_coordinate(height, curvature), *heights(curvature), counts[1])
    u = weights(poisson_coordinate(nu), *NU, counts[2])

    def mixed(part: Array) -> Array:
        for weight in (k, h, u):
            part = np.tensordot(weight, part, 1)
        return part

    whole, cut, straight = (mixed(part[panel]) for part in (all_tips.whole, all_tips.cut, all_tips.head_on))
    rim = mixed(all_tips.rim[panel]) if panel < len(all_tips.rim) else None
    punch = np.tensordot(u, all_tips.punch, (0, 1))
    return TipTable(curvature, nu, whole, cut, rim, straight, punch, heights(0.0))


def radii(sheet: str, curvature: float, place: float) -> tuple[float, float]:
    """Range of the logarithm of the patch's radius in one of the sheets of the table: whole, cut or rim."""
    ends = {"whole": (RADIUS[0], 0.0), "cut": (0.0, RADIUS[1]), "rim": RADIUS}[sheet]
    low, high = (math.log(end or edge(curvature, place)) for end in ends)
    return low, high


def compliance(tip: TipTable, place: float, radius: Array) -> Array:
    """E D times the compliance in (n, t) of Hertz-weighted patches, at radii up to 1/2; (radii, 2, 2).

    Patches smaller than the table's have the rest beyond the half-space's compliance of the smallest one. If that
    reaches over the rim, they go on as a constant and a part in proportion to 1/radius, from the two smallest ones.
    """
    at = np.maximum(radius, RADIUS[0])
    matrices = _read(tip, place, at)
    if np.all(at == radius):
        return matrices
    if edge(tip.curvature, place) >= RADIUS[0]:
        more = half_space(tip.nu, radius) - half_space(tip.nu, at)
        return np.asarray(matrices + more[:, None] * np.eye(2))
    first, second = _read(tip, place, np.array([1.0, 1.5]) * RADIUS[0])
    return np.asarray(matrices + 3 * (first - second) * (RADIUS[0] / radius - RADIUS[0] / at)[:, None, None])


def _read(tip: TipTable, place: float, radius: Array) -> Array:
    """E D times the compliance at radii that the table has."""
    k, limit = tip.curvature, inner(tip.curvature)

    def sheet(name: str, values: Array, low: float, high: float) -> Array:
        s = np.tensordot(weights(place, low, high, len(values)), values, 1)
        ends = radii(name, k, min(max(place, low), high))
        if ends[0] >= ends[1]:  # on the axis no patch of the table is cut
            return np.broadcast_to(s[0], (len(radius), 3))
        return np.asarray(weights(np.log(radius), *ends, len(s)) @ s)

    if place > limit and tip.rim is not None:
        logarithms = sheet("rim", tip.rim, limit, 1.0)
    else:
        whole, cut = sheet("whole", tip.whole, AXIS, limit), sheet("cut", tip.cut, AXIS, limit)
        logarithms = np.where((radius <= edge(k, min(place, limit)))[:, None], whole, cut)
    normal, shear = (np.exp(logarithms[:, :2]) * half_space(tip.nu, radius)).T
    across = logarithms[:, 2] * place * np.sqrt(normal * shear)
    return np.array([[normal, across], [across, shear]]).transpose(2, 0, 1)


def punch_gain(tip: TipTable, height: float, radius: Array) -> Array:
    """E D times what a rigid patch that sticks gives less than a Hertz-weighted one along n and t; (radii, 2).

    On a half-space a sixth of the compliance; on a leather as thick as the one below the patch, from the table.
    """
    h = weights(height_coordinate(height, 0.0), *tip.heights, tip.punch.shape[0])
    a = weights(np.log(np.maximum(radius, RADIUS[0])), *radii("rim", 0.0, 0.0), tip.punch.shape[1])
    return np.asarray(half_space(tip.nu, radius) / 6 * (a @ np.tensordot(h, tip.punch, 1)))


def head_on(tip: TipTable, radius: Array, ball: float) -> Array:
    """Force over E D^2 and depth over D of the contact with a ball of radius ``ball``, at the radii; (radii, 2)."""
    at = np.maximum(radius, HEAD_ON_RADIUS[0])
    count = tip.head_on.shape[0]
    ratio = np.tensordot(weights(np.log(at), *LOG_HEAD_ON, count), tip.head_on, 1)
    ratio = ratio * (radius / at)[:, None, None]  # it goes to zero with the radius
    gaps = np.array([tip.curvature, 1 / ball, 1 / ball**3])
    return np.asarray((half_space_head_on(tip.nu, radius) * np.exp(ratio)) @ gaps)
