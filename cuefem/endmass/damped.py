"""The drives of `cuefem.endmass.undamped` on modes that are damped or radiate, as the default modes of any cue do.

Where each mode is damped by itself and the tail (what the modes left out add, `cuefem.beam.tail`) radiates, they have
a closed form (`cuefem.endmass.poles`). Where dashpots couple the modes, each smooth stretch takes a matrix exponential:

z = (omega q, q') of all modes; the tip's transverse velocity is row . z. A tip that must follow a velocity V(t)
against the ball's inertia 1/c takes the force g with row . z + c J = V, J the integral of g.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.cue import Array
from cuefem.endmass import undamped
from cuefem.endmass.poles import held_tip, response
from cuefem.endmass.undamped import StickLimit, loading

# Coefficients of the diagonal Padé approximant of exp of degree 13, and the norm up to which it is exact to rounding.
_PADE = [float(math.comb(13, j) * math.factorial(26 - j) // math.factorial(13)) for j in range(14)]
_REACH = 4.25


def expm(X: Array) -> Array:
    """exp(X) by scaling and squaring (Al-Mohy & Higham, SIAM J. Matrix Anal. Appl. 31 (2009) 970).

    scipy has it too, but would take half of a cold `cuefem end-mass` to load.
    """
    identity, second = np.eye(len(X)), X @ X
    fourth = second @ second
    sixth = fourth @ second
    norm = max(np.linalg.norm(power, 1) ** (1 / n) for n, power in ((4, fourth), (6, sixth)))
    halvings = max(0, math.ceil(math.log2(norm / _REACH))) if norm > 0 else 0
    X, second, fourth, sixth = (
        power / 2.0 ** (n * halvings) for n, power in ((1, X), (2, second), (4, fourth), (6, sixth))
    )

    def half(c: list[float]) -> Array:
        low = c[3] * sixth + c[2] * fourth + c[1] * second + c[0] * identity
        return np.asarray(sixth @ (c[6] * sixth + c[5] * fourth + c[4] * second) + low)

    odd, even = X @ half(_PADE[1::2]), half(_PADE[0::2])
    exponential = np.linalg.solve(even - odd, even + odd)
    for _ in range(halvings):
        exponential = exponential @ exponential
    return np.asarray(exponential)


def _motion(tip: TipModes) -> tuple[Array, Array]:
    n = len(tip.omega)
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:], A[n:, :n] = np.diag(tip.omega), -np.diag(tip.omega)
    if tip.resistance is not None:
        A[n:, n:] = -tip.resistance
    return A, np.concatenate([np.zeros(n), tip.amplitude[:, 1]])


def half_sine_velocity(tip: TipModes, T: float) -> float:
    """Tip velocity at the end of a half-sine force of unit height and length T, m/s per N.

    Modes that neither damping nor radiation touches, all but the tail's in a cue without damping, have a closed form.
    """
    assert tip.resistance is not None
    touched = tip.resistance.any(axis=1)
    alone, rigid = ~touched & (tip.omega > 0), ~touched & (tip.omega == 0)
    phi, still = tip.amplitude[alone, 1], float(np.sum(tip.amplitude[rigid, 1] ** 2))
    free = float(undamped.half_sine_velocity(tip.omega[alone], phi, still, T=T))
    return free + _half_sine_velocity(tip.those(np.flatnonzero(touched)), T)


def _half_sine_velocity(tip: TipModes, T: float) -> float:
    A, row = _motion(tip)
    size, a = len(A), np.pi / T
    whole = np.zeros((size + 2, size + 2))  # beside z: the force and its quadrature
    whole[:size, :size], whole[:size, size] = A, row
    whole[size, size + 1], whole[size + 1, size] = a, -a
    return float(row @ expm(whole * T)[:size, size + 1])


def smooth_start_impulse(tip: TipModes, T: float) -> float:
    """Impulse that makes the tip follow the velocity (1 - cos(pi t/T))/2 from 0 to T, N s per m/s."""
    alone = held_tip(tip, 0.0)  # against no ball
    if alone is not None:
        return float(alone.impulse(1.0, undamped.smooth_start_swing(alone.rates, T, response)))
    start = np.zeros(2 * len(tip.omega) + 3)
    start[-2] = np.pi / T / 2  # V' = (a/2) sin(a t)
    return float((expm(_following(tip, 0.0, np.pi / T) * T) @ start)[-1])


def stick_impulse(tip: TipModes, limit: StickLimit) -> Any:
    """J of the limit b -> 0 of the coupled strike (`StickLimit`), kg: the tip follows V = K P(t) - 1.

    limit: its K and T may be arrays, for contacts at many offsets.
    """
    stuck = held_tip(tip, limit.c)
    if stuck is not None:
        return stuck.impulse(limit.K - 1, limit.swing(stuck.rates, response))
    if np.ndim(limit.K) or np.ndim(limit.T):
        pairs = np.broadcast(limit.K, limit.T)
        impulses = [stick_impulse_in_time(tip, replace(limit, K=float(K), T=float(T))) for K, T in pairs]
        return np.reshape(impulses, pairs.shape)
    return stick_impulse_in_time(tip, limit)


def stick_impulse_in_time(tip: TipModes, limit: StickLimit) -> float:
    """As `stick_impulse` for one contact, however the modes are damped, by two matrix exponentials."""
    _, row = _motion(tip)
    peak, a = loading(limit.e, limit.T)
    jump = -1 / (float(row @ row) + limit.c)  # at the first touch V goes from 0 to -1
    height = limit.K * a / (1 + limit.e)  # of V' = K P'
    state = np.concatenate([row * jump, [0.0, height, jump]])
    state = expm(_following(tip, limit.c, a) * peak) @ state
    if limit.e > 0:
        state[-3:-1] = height, 0.0
        state = expm(_following(tip, limit.c, a / limit.e) * (limit.T - peak)) @ state
    return float(state[-1])


def _following(tip: TipModes, c: float, a: float) -> Array:
    """Motion of (z, V', its quadrature, J) of a tip that follows V, where V' swings with the angular frequency
    ``a``."""
    A, row = _motion(tip)
    size, total = len(A), float(row @ row) + c
    pull = -(row @ A) / total
    whole = np.zeros((size + 3, size + 3))
    whole[:size, :size], whole[:size, size] = A + np.outer(row, pull), row / total
    whole[size, size + 1], whole[size + 1, size] = a, -a
    whole[-1, :size], whole[-1, size] = pull, 1 / total
    return whole
