"""scikit-fem's hierarchical line basis, tabulated once for each order; element matrices are contracted from it.

It is written out here, since loading scikit-fem takes longer than solving a beam; a test compares the two.
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss

from cuefem.cue import Array


class BasisTable(NamedTuple):
    """scikit-fem's hierarchical line basis on the reference element [0, 1], tabulated at Gauss points.

    Local unknowns: w and theta of the left node, the bubbles of w, the bubbles of theta, w and theta of the right node.
    points, weights: (q,). w, dw, theta, dtheta: (unknowns, q).
    """

    points: Array
    weights: Array
    w: Array
    dw: Array
    theta: Array
    dtheta: Array


def line_basis(degree: int, points: Array) -> tuple[Array, Array]:
    """scikit-fem's hierarchical basis of ``degree`` and its derivative at reference ``points``: two (degree + 1, q).

    1 - x and x, then the integrals of the Legendre polynomials, which vanish at both ends, each with a derivative of
    unit norm on [-1, 1].
    """
    x = 2 * points - 1
    legendre = [np.ones_like(x), x]
    for n in range(1, degree):
        legendre.append(((2 * n + 1) * x * legendre[n] - n * legendre[n - 1]) / (n + 1))
    values, slopes = [1 - points, points], [-np.ones_like(x), np.ones_like(x)]
    for n in range(2, degree + 1):
        values.append((legendre[n] - legendre[n - 2]) / (2 * (2 * n - 1)) ** 0.5)
        slopes.append(legendre[n - 1] * (2 * (2 * n - 1)) ** 0.5)
    return np.array(values), np.array(slopes)


def local_basis(order: int, points: Array) -> tuple[Array, Array, Array, Array]:
    """(w, w', theta, theta') of an element's unknowns at reference ``points``: four (unknowns, q)."""
    (w, dw), (t, dt) = line_basis(order + 1, points), line_basis(order, points)
    unknowns = 2 * order + 3
    out = tuple(np.zeros((unknowns, len(points))) for _ in range(4))
    w_rows = np.r_[0, 2 : 2 + order, unknowns - 2]
    t_rows = np.r_[1, 2 + order : unknowns - 2, unknowns - 1]
    for rows, first, values, slopes in ((w_rows, 0, w, dw), (t_rows, 2, t, dt)):
        bubbles_between = np.r_[0, 2 : len(values), 1]
        out[first][rows], out[first + 1][rows] = values[bubbles_between], slopes[bubbles_between]
    return out  # type: ignore[return-value]


@functools.cache
def table(order: int) -> BasisTable:
    """The tabulated basis of one polynomial order, made once; Gauss points exact for cones (degree 2 order + 4)."""
    points, weights = leggauss(order + 4)
    points, weights = (points + 1) / 2, weights / 2
    return BasisTable(points, weights, *local_basis(order, points))


@functools.cache
def products(order: int) -> tuple[Array, Array]:
    """What stacks of element matrices are contracted from: stiffness (4 q, unknowns^2), mass (2 q, unknowns^2)."""
    points, _, w, dw, t, dt = table(order)

    def product(a: Array, b: Array) -> Array:
        both = np.einsum("iq,jq->qij", a, b)
        return (both + both.transpose(0, 2, 1)).reshape(len(points), -1) / 2

    stiffness = np.concatenate([product(dt, dt), product(dw, dw), -2 * product(dw, t), product(t, t)])
    mass = np.concatenate([product(w, w), product(t, t)])
    return stiffness, mass
