"""The nodes of a step, which are Radau's, and the tables by which the kernel integrates polynomials through them.

Forces are polynomials through the nodes, of which the last is the step's end. Velocities are known at its start too.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre

from cuefem.cue import Array

# As in kernel/contact.h: nodes, and terms of the series of a mode's response.
NODES, TERMS = 14, 112
_roots = legendre.legroots(np.eye(NODES + 1)[NODES - 1] - np.eye(NODES + 1)[NODES]).real
PLACES = np.append(np.sort((1 + _roots) / 2)[:-1], 1.0)
WITH_START = np.append(0.0, PLACES)
FORCE_WAVES = np.linalg.inv(legendre.legvander(2 * PLACES - 1, NODES - 1))
WAVES = np.linalg.inv(legendre.legvander(2 * WITH_START - 1, NODES))
GAUSS, WEIGHTS = (part / 2 for part in legendre.leggauss(NODES + 2))
GAUSS = GAUSS + 0.5


def values_at(parts: Array, waves: Array = WAVES) -> Array:
    """From values at the start and the nodes (``FORCE_WAVES``: at the nodes) to those at parts of the step."""
    parts = np.asarray(parts, float)
    vandermonde = legendre.legvander(2 * parts - 1, len(waves) - 1).reshape(*parts.shape, len(waves))
    return np.asarray(vandermonde @ waves)


def sums_to(part: float, waves: Array = WAVES) -> Array:
    """From those values to their integral up to a part of the step, over the step."""
    return np.asarray(part * WEIGHTS @ values_at(part * GAUSS, waves))


def waves_over(part: float) -> Array:
    """From forces at the nodes to Legendre coefficients over the first part of the step."""
    onto = (2 * np.arange(NODES)[:, None] + 1) * WEIGHTS * legendre.legvander(2 * GAUSS - 1, NODES - 1).T
    return np.asarray(onto @ values_at(part * GAUSS, FORCE_WAVES))


def tables() -> Array:
    """All that kernel/contact.h calls a Rule, one table after the other, matrices by columns."""
    sums = np.array([sums_to(place) for place in PLACES])
    force_sums = np.array([sums_to(place, FORCE_WAVES) for place in PLACES])
    extend = values_at(WITH_START, FORCE_WAVES)
    slopes = extend @ np.linalg.solve(force_sums, extend[1:] - extend[0])
    x, weights = legendre.leggauss((TERMS + NODES) // 2 + 2)
    convolved = np.empty((TERMS, NODES, NODES))
    for i, place in enumerate(PLACES):
        s = place * (1 + x) / 2
        modes = legendre.legvander(2 * (place - s) - 1, TERMS - 1).T * (weights * place / 2)
        convolved[:, :, i] = modes @ values_at(s, FORCE_WAVES)
    shortened = np.array([waves_over(place) for place in PLACES])
    looks = np.sort(np.concatenate([np.linspace(0, 1, 3 * NODES + 1), PLACES[-3:-1]]))
    parts = [PLACES, sums.T, force_sums.T, WAVES.T, FORCE_WAVES.T, extend[0], slopes.T, convolved, shortened]
    return np.concatenate([part.ravel() for part in (*parts, looks, values_at(looks).T, GAUSS, WEIGHTS)])
