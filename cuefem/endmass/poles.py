"""The motion of a held tip as a sum of decaying vibrations, where each mode is damped by itself and a tail radiates.

In Laplace's terms a tip that moves at V(s) against the ball's inertia 1/c takes the force V(s)/Y(s), and s Y(s) = c +
rigid + sum of s (alpha s + delta)/(s^2 + beta s + gamma) over the modes, the tail's vibrations among them. So
1/(s Y(s)) = direct + sum of residue/(s - rate): the rates are the zeros of Y, which the method of Ehrlich and Aberth
finds all at once (Aberth, Math. Comp. 27 (1973) 339). With the rates known every drive has a closed form.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.cue import Array

# Rounds of the method, which takes about eight from starts between the poles, and the relative change that ends it.
MOST_ROUNDS, SETTLED = 40, 1e-13
# How far, relative to their sum, the zeros may be from what the coefficients of Y say it is.
SUM = 1e-9
# The modes of a tail are coupled by its damping, and a small eigenproblem parts them. With more coupled modes than this
# the closed form is not used.
COUPLED = 8
# The response of a vibration to a drive of nearly its own frequency would be 0/0: where their phases part by less than
# this over the span, it is computed from expm1.
NEAR = 0.5


class Admittance(NamedTuple):
    """Y of modes across the cue: poles in the upper half plane, (n,), and their residues, (n,); rigid, 1/kg."""

    poles: Array
    residues: Array
    rigid: float


class HeldTip(NamedTuple):
    """1/(s Y(s)), the force that a unit velocity step of the tip takes: rates and residues of the upper half plane."""

    direct: float
    rates: Array
    residues: Array

    def impulse(self, end: Any, swing: Any) -> Any:
        """Impulse that makes the tip follow a velocity which is ``end`` at last; swing: `response` to it, (..., n)."""
        return self.direct * end + 2 * np.real(swing @ self.residues)


def admittance(tip: TipModes) -> Admittance | None:
    """Y of the tip modes; None if they are damped in a way that it does not cover: coupled or critically damped."""
    omega, phi, resistance = tip.omega, tip.amplitude[:, 1], tip.resistance
    moving = phi != 0
    assert resistance is not None
    if resistance[np.ix_(moving, ~moving)].any():
        return None
    omega, phi, resistance = omega[moving], phi[moving], resistance[np.ix_(moving, moving)]
    damping = resistance.diagonal()
    coupled = (resistance - np.diag(damping)).any(axis=1)
    still = ~coupled & (omega == 0)
    if coupled.sum() > COUPLED or damping[still].any() or (omega[coupled] == 0).any():
        return None
    alone = ~coupled & (omega > 0)
    free, rate = omega[alone], damping[alone] / 2
    if np.any(rate >= free):
        return None
    poles = -rate + 1j * np.sqrt(free**2 - rate**2)
    residues = phi[alone] ** 2 * poles / (2 * (poles + rate))
    if coupled.any():
        row = np.concatenate([np.zeros(coupled.sum()), phi[coupled]])
        eigenvalues, vectors = np.linalg.eig(_motion(omega[coupled], resistance[np.ix_(coupled, coupled)]))
        upper = eigenvalues.imag > 0
        if 2 * upper.sum() < len(eigenvalues):
            return None
        poles = np.concatenate([poles, eigenvalues[upper]])
        residues = np.concatenate([residues, ((row @ vectors) * np.linalg.solve(vectors, row))[upper]])
    order = np.argsort(poles.imag)
    return Admittance(poles[order], residues[order], float(np.sum(phi[still] ** 2)))


def _motion(omega: Array, resistance: Array) -> Array:
    n = len(omega)
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:], A[n:, :n], A[n:, n:] = np.diag(omega), -np.diag(omega), -resistance
    return A


def held_tip(tip: TipModes, c: float) -> HeldTip | None:
    """The tip of damped modes held by a ball of inertia 1/c; None if `admittance` is, or if a rate is real."""
    Y = admittance(tip)
    return None if Y is None else _held_tip(Y, c)


def _held_tip(Y: Admittance, c: float) -> HeldTip | None:
    poles, residues = Y.poles, Y.residues
    still = Y.rigid + c
    if still <= 0 or len(poles) == 0:
        return None
    beta, gamma = -2 * poles.real, np.abs(poles) ** 2
    alpha, delta = 2 * residues.real, -2 * np.real(residues * poles.conj())
    sums = np.column_stack([alpha, delta, beta, np.ones(len(poles))])
    slopes = np.column_stack([alpha, delta, alpha * beta, delta * beta])

    def sampled(s: Array) -> tuple[Array, Array, Array]:
        """(s Y, its derivative, the sum of 1/(s - pole)) at s."""
        over = 1 / (s[:, None] * (s[:, None] + beta) + gamma)
        a, d, b, inverse = (over @ sums).T
        a2, d2, ab2, db2 = ((over * over) @ slopes).T
        value = still + s * (s * a + d)
        slope = 2 * s * a + d - s * (s * (2 * s * a2 + ab2) + 2 * s * d2 + db2)
        return value, slope, 2 * s * inverse + b

    # a held tip's frequencies lie below and between the free ones
    z = (poles + np.concatenate([[0.0], poles[:-1]])) / 2
    active = np.arange(len(z))
    for _ in range(MOST_ROUNDS):
        s = z[active]
        value, slope, near = sampled(s)
        apart = s[:, None] - z
        apart[np.arange(len(s)), active] = np.inf
        others = (1 / apart + 1 / (s[:, None] - z.conj())).sum(axis=1)
        step = 1 / (slope / value + near - others)
        z[active] = s - step
        active = active[~(np.abs(step) <= SETTLED * np.abs(s))]
        if len(active) == 0:
            break
    z = np.where(z.imag < 0, z.conj(), z)  # of a pair either may be found
    total = still + float(alpha.sum())
    moved = float(np.sum(beta * alpha - delta)) / total  # the sum of all poles less that of all zeros
    wanted = -float(beta.sum()) + moved
    if len(active) or np.any(z.imag <= 0) or abs(2 * z.real.sum() - wanted) > SUM * np.abs(z).sum():
        return None
    return HeldTip(1 / total, z, 1 / sampled(z)[1])


def response(z: Array, T: Any, span: tuple[Any, Any], *, a: Any = 0.0, b: Any = 0.0) -> Array:
    """Integral of exp(z (T - s)) cos(a s + b) ds over a span that ends at T at the latest."""
    return (_turning(z, T, span, a, b) + _turning(z, T, span, -a, -b)) / 2


def _turning(z: Array, T: Any, span: tuple[Any, Any], a: Any, b: Any) -> Array:
    """Integral of exp(z (T - s)) exp(i (a s + b)) ds over a span."""
    first, last = span
    rate, length = 1j * a - z, last - first
    begun, ended = np.exp(z * (T - first) + 1j * (a * first + b)), np.exp(z * (T - last) + 1j * (a * last + b))
    close = np.abs(rate * length) < NEAR
    phase = np.where(close, rate * length, 1.0)
    grown = np.where(np.abs(phase) > 0, np.expm1(phase) / np.where(phase == 0, 1.0, phase), 1.0)
    return np.asarray(np.where(close, begun * length * grown, (ended - begun) / np.where(close, 1.0, rate)))
