"""scikit-fem's hierarchical line basis, tabulated once for each order.

Loading scikit-fem takes longer than solving a beam; a test compares this basis with it.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from cuefem.cue import Array

# Gauss points beyond the order. order + 3 are exact for solid cones, whose integrands have degree 2 order + 4.
EXTRA_POINTS = 4

# A basis of an element of length 1, from its order and points in [0, 1].
Basis = Callable[[int, Array], Array]


def line_basis(order: int, points: Array) -> Array:
    """scikit-fem's hierarchical basis of degree ``order`` + 1 and its derivative at ``points`` in [0, 1].

    (2, order + 2, q) at q points.

    1 - x and x, then the integrals of the Legendre polynomials, which vanish at both ends, each with a derivative of
    unit norm on [-1, 1].
    """
    x = 2 * points - 1
    legendre = [np.ones_like(x), x]
    for n in range(1, order + 1):
        legendre.append(((2 * n + 1) * x * legendre[n] - n * legendre[n - 1]) / (n + 1))
    values, slopes = [1 - points, points], [-np.ones_like(x), np.ones_like(x)]
    for n in range(2, order + 2):
        values.append((legendre[n] - legendre[n - 2]) / (2 * (2 * n - 1)) ** 0.5)
        slopes.append(legendre[n - 1] * (2 * (2 * n - 1)) ** 0.5)
    return np.array([values, slopes])


@functools.cache
def element_rows(order: int) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Indices of w and theta among an element's degrees of freedom, and the line-basis function of each."""
    last = 2 * order + 1
    w, theta = np.r_[0, 2 : 2 + order, last], np.r_[1, 2 + order : last, last + 1]
    return w, np.r_[0, 2 : order + 2, 1], theta, np.r_[0, 2 : order + 1, 1]


def element_basis(order: int, points: Array) -> Array:
    """w, w', theta, theta' per degree of freedom of an element of length 1 at ``points`` in [0, 1]: (4, dof, q)."""
    values, slopes = line_basis(order, points)
    out = np.zeros((4, 2 * order + 3, len(points)))
    w, w_functions, theta, theta_functions = element_rows(order)
    out[0, w], out[1, w] = values[w_functions], slopes[w_functions]
    out[2, theta], out[3, theta] = values[theta_functions], slopes[theta_functions]
    return out


@functools.cache
def gauss_rule(count: int) -> tuple[Array, Array]:
    """Gauss points and weights on [0, 1], (count,)."""
    points, weights = leggauss(count)
    return (points + 1) / 2, weights / 2


@functools.cache
def tabulated(basis: Basis, order: int) -> Array:
    """A basis at Gauss points of one segment."""
    return basis(order, gauss_rule(order + EXTRA_POINTS)[0])
