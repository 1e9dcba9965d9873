"""Exact motion of a linear system z' = A z, cell by cell, and the first moment one of its outputs changes sign.

A cell is so short (|A| h <= 1) that the Taylor series of degree 18 is exact to rounding, so the scalar outputs are
known as polynomials on every cell: their roots, integrals and values in between carry no time-stepping error. From
cell to cell the state moves by exp(A h), and 32 cells at a time by its repeated squares. No eigenvectors are used: a
slipping contact can be defective or growing, and there a matrix exponential does not fail.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array

DEGREE = 18  # 1/19! = 8e-18
DOUBLINGS = 5
# Where guards are looked at inside a cell (its end included), and the moments needed to integrate products.
SAMPLES = np.array([0.15, 0.35, 0.6, 0.8, 1.0])
_PLACES = np.r_[0.0, SAMPLES]
_POWERS = _PLACES[:, None] ** np.arange(DEGREE + 1)
_SLOPES = np.arange(DEGREE + 1) * _PLACES[:, None] ** np.maximum(np.arange(DEGREE + 1) - 1, 0)
# A guard that dips below zero and is back between two samples counts from this depth on, relative to its size.
DEEP = 1e-13
_MOMENTS = 1 / (np.add.outer(np.arange(DEGREE + 1), np.arange(DEGREE + 1)) + 1.0)


_COEFFICIENTS = 1 / np.cumprod(np.r_[1.0, np.arange(1.0, DEGREE + 1)])


def exponential(X: Array) -> Array:
    """exp(X) for a matrix of norm up to 1: Taylor of degree 18 in seven products (Paterson and Stockmeyer)."""
    second = X @ X
    third, fourth = second @ X, second @ second
    powers = np.array([np.eye(len(X)), X, second, third, fourth, third @ second])
    sixth = third @ third
    low, middle, high = np.tensordot(_COEFFICIENTS[:DEGREE].reshape(3, 6), powers, axes=1)
    return np.asarray(low + sixth @ (middle + sixth @ (high + _COEFFICIENTS[DEGREE] * sixth)))


@dataclass(frozen=True)
class Flow:
    """The motion of z' = A z and of its outputs rows @ z; rate: a bound on |A|, 1/s."""

    A: Array
    rows: Array
    rate: float

    @property
    def step(self) -> float:
        """Length of a cell, s."""
        return 1 / self.rate

    @cached_property
    def powers(self) -> list[Array]:
        """exp(A h), its square, ... up to that of a whole block of cells."""
        out = [exponential(self.A * self.step)]
        for _ in range(DOUBLINGS):
            out.append(out[-1] @ out[-1])
        return out

    @cached_property
    def taylor(self) -> Array:
        """Rows that give each output's Taylor coefficients in the fraction of a cell: (degree + 1, m, n)."""
        out = [self.rows]
        for j in range(1, DEGREE + 1):
            out.append(out[-1] @ self.A * (self.step / j))
        return np.array(out)

    def block(self, z: Array) -> Array:
        """States at the starts of the next 32 cells, (n, 32)."""
        states = z[:, None]
        for power in self.powers[:DOUBLINGS]:
            states = np.concatenate([states, power @ states], axis=1)
        return states

    def polynomials(self, states: Array) -> Array:
        """Taylor coefficients of the outputs on the cells that start in ``states``: (degree + 1, m, cells)."""
        shape = (*self.taylor.shape[:2], states.shape[1])
        return np.asarray(self.taylor.reshape(-1, self.taylor.shape[2]) @ states).reshape(shape)

    def state(self, z: Array, fraction: float) -> Array:
        """State after a fraction of a cell, by the Taylor series."""
        term = total = z
        for j in range(1, DEGREE + 1):
            term = self.A @ term * (self.step * fraction / j)
            total = total + term
        return total


class Guards(NamedTuple):
    """Combinations of the outputs that stay positive during a phase: weights (g, m) @ outputs + constants (g,)."""

    weights: Array
    constants: Array


class Piece(NamedTuple):
    """A stretch of a phase: start, s; cell length, s; Taylor coefficients (degree + 1, m, cells)."""

    start: float
    step: float
    coefficients: Array

    @property
    def end(self) -> float:
        """End of the stretch, s."""
        return self.start + self.step * self.coefficients.shape[2]


class Arrival(NamedTuple):
    """The end of a phase: its time, the state, the index of the guard that changed sign, and the way there."""

    time: float
    state: Array
    guard: int
    pieces: list[Piece]


def march(flow: Flow, z: Array, guards: Guards, *, start: float, limit: float) -> Arrival | None:
    """Follow the flow from state ``z`` at ``start`` to the first sign change of a guard; None if none by ``limit``."""
    pieces: list[Piece] = []
    states, time = flow.block(z), start
    while time < limit:
        polynomials = flow.polynomials(states)
        values = np.einsum("gm,dmc->gdc", guards.weights, polynomials)
        values[:, 0] += guards.constants[:, None]
        arrival = _first_sign_change(values)
        if arrival is not None:
            cell, guard, fraction = arrival
            if cell:
                pieces.append(Piece(time, flow.step, polynomials[:, :, :cell]))
            if fraction:
                shorter = polynomials[:, :, cell : cell + 1] * fraction ** np.arange(DEGREE + 1)[:, None, None]
                pieces.append(Piece(time + cell * flow.step, flow.step * fraction, shorter))
            end = time + (cell + fraction) * flow.step
            return Arrival(end, flow.state(states[:, cell], fraction), guard, pieces)
        pieces.append(Piece(time, flow.step, polynomials))
        time += states.shape[1] * flow.step
        states = flow.powers[DOUBLINGS] @ states
    return None


def _first_sign_change(values: Array) -> tuple[int, int, float] | None:
    """The cell, the guard and the fraction of the cell where a guard (guards, degree + 1, cells) first turns negative.

    Between two samples a guard is convex or concave but for rare wiggles of no depth, so that where it falls at the
    first, rises at the second and the tangents meet below zero, it may dip there.
    """
    at, slope = _POWERS @ values, _SLOPES @ values  # (guards, places, cells)
    negative = at[:, 1:] < 0
    falls, rises = slope[:, :-1], slope[:, 1:]
    turns = (falls < 0) & (rises > 0) & (at[:, :-1] > 0)
    below = np.zeros_like(negative)
    if turns.any():
        width = np.diff(_PLACES)[:, None]
        meet = at[:, :-1] * rises - at[:, 1:] * falls + width * falls * rises  # (rises - falls) > 0 times the height
        deep = DEEP * np.abs(values).max(axis=(1, 2))[:, None, None]
        below = turns & (meet < -deep * (rises - falls))
    for cell, gap in np.argwhere((negative | below).any(axis=0).T):
        roots = [
            (fraction, guard)
            for guard, coefficients in enumerate(values[:, :, cell])
            if negative[guard, gap, cell] or below[guard, gap, cell]
            for fraction in _roots(coefficients, _PLACES[gap], _PLACES[gap + 1])
        ]
        if roots:
            fraction, guard = min(roots)
            return int(cell), guard, fraction
    return None


def _roots(coefficients: Array, low: float, high: float) -> list[float]:
    """The first root of a guard that is negative at ``high``, or below its lowest point before it; or none."""
    falling = np.polynomial.Polynomial(coefficients)
    if falling(high) < 0:
        return [_root(falling, low, high)]
    lowest = _zero(falling.deriv(), low, high)
    return [_root(falling, low, lowest)] if falling(lowest) < -DEEP * np.abs(coefficients).max() else []


def _root(falling: np.polynomial.Polynomial, low: float, high: float) -> float:
    if falling(low) > 0:
        return _zero(falling, low, high)
    # zero at the start of a phase by its nature: it may still rise before it falls
    for fraction in high * 0.5 ** np.arange(1, 40):
        if falling(fraction) > 0:
            return _zero(falling, fraction, high)
    return low


def _zero(function: np.polynomial.Polynomial, low: float, high: float) -> float:
    from scipy.optimize import brentq  # loaded when used: a fifth of a cold start

    return float(brentq(function, low, high, xtol=1e-15, rtol=1e-14))


def integral_of_product(piece: Piece, first: int, second: int) -> float:
    """Integral over a stretch of the product of two outputs, exact."""
    a, b = piece.coefficients[:, first], piece.coefficients[:, second]
    return float(np.einsum("ic,ij,jc->", a, _MOMENTS, b)) * piece.step
