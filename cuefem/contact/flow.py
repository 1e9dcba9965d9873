"""Exact motion of a linear system z' = A z, cell by cell, and the first moment one of its outputs changes sign.

A cell is so short (|A| h <= 3) that the Taylor series of degree 27 is exact to rounding, so the scalar outputs are
known as polynomials on every cell: their roots, integrals and values in between carry no time-stepping error. From
cell to cell the state moves by exp(A h). (The compiled kernel, which makes the series anew in every cell, lets a cell
be as long as the state's own series allows: a fast mode that hardly moves, or dies away, does not shorten it.) No
eigenvectors of A are used: a slipping contact can be defective or growing, and there a matrix exponential does not
fail. Where A is oscillators that a few outputs drive, exp(A h) is their free rotation and their response to those
outputs' Taylor series (`Drive`), one product instead of nine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import factorial
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from cuefem.contact.kernel import library
from cuefem.contact.kernel import linear as compiled
from cuefem.cue import Array

REACH, DEGREE = 3.0, 27  # 3^28/28! = 8e-17
# With more pushes than this, the response to them costs more than the exponential of a matrix.
FEW = 8
CELLS = 24  # of a block, after the first cell: many phases end in that
ORDERS = np.arange(DEGREE + 1)
FACTORIALS = np.array([float(factorial(j)) for j in ORDERS])
# Places inside a cell (its end included) at which guards are sampled.
SAMPLES = (np.array([0.15, 0.35, 0.6, 0.8, 1.0]) + np.arange(3)[:, None]).ravel() / 3
_PLACES = np.r_[0.0, SAMPLES]
_LOOKS = np.concatenate([_PLACES[:, None] ** ORDERS, ORDERS * _PLACES[:, None] ** np.maximum(ORDERS - 1, 0)])
# A guard that dips below zero between two samples counts if the dip is this deep, relative to its size.
DEEP = 1e-13
# Integrals over 0..1 of u^(i + j), and of (1 - u)^i/i! u^j.
_MOMENTS = 1 / (np.add.outer(ORDERS, ORDERS) + 1.0)
_DELAYED = np.array([[factorial(j) / factorial(i + j + 1) for i in ORDERS] for j in ORDERS])
_SINES = _DELAYED * np.array([0.0, 1.0, 0.0, -1.0])[ORDERS % 4]  # weights of the terms of exp(i x) in the sine,
_COSINES = _DELAYED * np.array([1.0, 0.0, -1.0, 0.0])[ORDERS % 4]  # and in the cosine


def exponential(X: Array) -> Array:
    """exp(X) for a matrix of norm up to 1: Taylor of degree 18 in seven products (Paterson and Stockmeyer)."""
    second = X @ X
    third, fourth = second @ X, second @ second
    powers = np.array([np.eye(len(X)), X, second, third, fourth, third @ second])
    sixth = third @ third
    low, middle, high = np.tensordot(1 / FACTORIALS[:18].reshape(3, 6), powers, axes=1)
    return np.asarray(low + sixth @ (middle + sixth @ (high + sixth / FACTORIALS[18])))


# Terms of a motion: directions the state is pushed in, and the rows of what pushes.
Pushes = list[tuple[Array, Array]]


def pushed(free: Array, pushes: Pushes, held: Array | None = None) -> tuple[Callable[[], Array], Array, Array]:
    """(makes A, rows, directions): a free motion and what pushes it, A = free + directions' rows where held' z is zero.

    held: (n, k) orthonormal columns; forces along them keep held' z at zero: A is P A P, P orthogonal to them. Each
    term is projected by itself: with a light end mass the contact's directions are nearly parallel, and what remains of
    them would be lost in the rounding of the whole.
    """
    directions, rows = (np.array([push[i] for push in pushes]).reshape(-1, len(free)) for i in (0, 1))
    if held is not None:
        for _ in range(2):
            directions, rows = (part - (part @ held) @ held.T for part in (directions, rows))
        across = free @ held
        of_held = held.T @ free - (held.T @ across) @ held.T
        directions, rows = np.concatenate([directions, -held.T]), np.concatenate([rows, of_held])

    def whole() -> Array:
        return (free if held is None else free - across @ held.T) + directions.T @ rows

    return whole, rows, directions


class Drive(NamedTuple):
    """A motion as oscillators that are pushed: A = rotation + pushes' rows.

    omega: (k,) rad/s. The first k states x and those of index ``turning``, y, turn: x' = omega y, y' = -omega x; the
    others stay. rows: (r, n), what pushes; pushes: (r, n), the directions it pushes the state in, none of it in x.
    """

    omega: Array
    turning: slice
    rows: Array
    pushes: Array

    def exponential(self, step: float, taylor: Array) -> Array:
        """exp(A step), from the Taylor rows of what pushes, (r, degree + 1, n): the free turn, and the response.

        A push F(u) = sum F_j u^j, u = t/step, moves the state by the sum of F_j step integral of the free turn over
        step (1 - u) of its direction u^j du.
        """
        k, size, angle = len(self.omega), self.rows.shape[1], self.omega * step
        powers = np.ones((DEGREE + 1, k))
        np.cumprod(np.broadcast_to(angle, (DEGREE, k)), axis=0, out=powers[1:])
        response = step * self.pushes[:, None] / (ORDERS[:, None] + 1.0)
        turned = step * self.pushes[:, None, self.turning]
        response[:, :, :k], response[:, :, self.turning] = (_SINES @ powers) * turned, (_COSINES @ powers) * turned
        out = response.reshape(-1, size).T @ taylor.reshape(-1, size)
        diagonal, across = np.ones(size), np.sin(angle)
        diagonal[:k] = diagonal[self.turning] = np.cos(angle)
        out.ravel()[:: size + 1] += diagonal
        out.ravel()[self.turning.start : k * size : size + 1] += across
        out.ravel()[self.turning.start * size :: size + 1][:k] -= across
        return np.asarray(out)


@dataclass(frozen=True)
class Flow:
    """The motion of z' = A z and of its outputs rows @ z; rate: a bound on |A|, 1/s; drive: A's form, if it has one.

    own: A, or what makes it when it is asked for, which the compiled kernel never does.
    """

    own: Array | Callable[[], Array]
    rows: Array
    rate: float
    drive: Drive | None = None

    @cached_property
    def A(self) -> Array:
        """The matrix of the motion."""
        return self.own() if callable(self.own) else self.own

    @cached_property
    def few(self) -> Drive | None:
        """The drive, if it has so few pushes that the response to them is cheap."""
        return self.drive if self.drive is not None and len(self.drive.rows) <= FEW else None

    @property
    def step(self) -> float:
        """Length of a cell, s."""
        return REACH / self.rate

    @cached_property
    def per_cell(self) -> Array:
        """A h."""
        return self.A * self.step

    @cached_property
    def advance(self) -> Array:
        """exp(A h)."""
        if self.few is not None:
            return self.few.exponential(self.step, self.taylor[len(self.rows) :])
        quarter = exponential(self.per_cell / 4)
        half = quarter @ quarter
        return np.asarray(half @ half)

    @cached_property
    def taylor(self) -> Array:
        """Rows that give Taylor coefficients in the fraction of a cell: outputs' and drive's, (m + r, 28, n)."""
        rows = self.rows if self.few is None else np.concatenate([self.rows, self.few.rows])
        out = np.empty((DEGREE + 1, *rows.shape))
        out[0] = rows
        for before, after in pairwise(out):
            np.dot(before, self.per_cell, out=after)
        return np.ascontiguousarray((out / FACTORIALS[:, None, None]).transpose(1, 0, 2))

    def series(self, z: Array) -> Array:
        """Taylor coefficients of the state in the fraction of a cell, (degree + 1, n)."""
        out = np.empty((DEGREE + 1, len(z)))
        out[0] = z
        for before, after in pairwise(out):
            np.dot(self.per_cell, before, out=after)
        return out / FACTORIALS[:, None]

    def blocks(self, z: Array) -> Iterator[tuple[Array, Array]]:
        """Stretches of cells one after the other: states at the starts of their cells (n, cells), and `polynomials`.

        The first is of one cell, for which the series of its state is cheaper than exp(A h).
        """
        series = self.series(z)
        yield z[:, None], (self.rows @ series.T)[:, :, None]
        z, advance = series.sum(axis=0), self.advance
        while True:
            states = np.empty((CELLS + 1, len(z)))
            states[0] = z
            for before, after in pairwise(states):
                np.dot(advance, before, out=after)
            yield states[:-1].T, self.polynomials(states[:-1].T)
            z = states[-1]

    def polynomials(self, states: Array) -> Array:
        """Taylor coefficients of the outputs on the cells that start in ``states``: (m, degree + 1, cells)."""
        outputs = self.taylor[: len(self.rows)]
        shape = (*outputs.shape[:2], states.shape[1])
        return np.asarray(outputs.reshape(-1, outputs.shape[2]) @ states).reshape(shape)

    def state(self, z: Array, fraction: float) -> Array:
        """State after a fraction of a cell, by the Taylor series."""
        return np.asarray(fraction**ORDERS @ self.series(z))


class Guards(NamedTuple):
    """Combinations of the outputs that stay positive during a phase: weights (g, m) @ outputs + constants (g,)."""

    weights: Array
    constants: Array


# A guard by name: the weights of outputs, and a constant.
Guard = tuple[str, dict[int, float], float]


def guards_of(found: list[Guard], outputs: int) -> tuple[list[str], Guards]:
    """The names of guards, and the guards, from one entry each."""
    weights = np.zeros((len(found), outputs))
    for row, (_, terms, _) in zip(weights, found, strict=True):
        row[list(terms)] = list(terms.values())
    return [name for name, _, _ in found], Guards(weights, np.array([constant for _, _, constant in found]))


class Piece(NamedTuple):
    """A stretch of a phase: start, s; lengths of its cells, s; Taylor coefficients in these (m, degree + 1, cells)."""

    start: float
    lengths: Array
    coefficients: Array

    @classmethod
    def even(cls, start: float, length: float, coefficients: Array) -> Self:
        """One of cells that are equally long, s."""
        return cls(start, np.full(coefficients.shape[2], length), coefficients)

    @property
    def ends(self) -> Array:
        """Where its cells end, s."""
        return np.asarray(self.start + np.cumsum(self.lengths))

    @property
    def end(self) -> float:
        """End of the stretch, s."""
        return float(self.ends[-1])


class Arrival(NamedTuple):
    """The end of a phase: its time, the state, the index of the guard that changed sign, and the way there."""

    time: float
    state: Array
    guard: int
    pieces: list[Piece]


def march(flow: Flow, z: Array, guards: Guards, *, start: float, limit: float) -> Arrival | None:
    """Follow the flow from state ``z`` at ``start`` to the first sign change of a guard; None if none by ``limit``."""
    kernel = library()
    if kernel is not None and flow.drive is not None:
        found = compiled.march(kernel, flow, z, guards, start=start, limit=limit, block=CELLS, terms=len(ORDERS))
        if found.status == compiled.FOUND:
            return Arrival(found.time, found.state, found.guard, [Piece.even(*each) for each in found.stretches])
        if found.status == compiled.LATE:
            return None
        # numbers overflowed: what that leads to is for the code below to say
    pieces: list[Piece] = []
    time = start
    for states, polynomials in flow.blocks(z):
        if time >= limit:
            break
        values = (guards.weights @ polynomials.reshape(len(polynomials), -1)).reshape(-1, *polynomials.shape[1:])
        values[:, 0] += guards.constants[:, None]
        arrival = _first_sign_change(values)
        if arrival is not None:
            cell, guard, fraction = arrival
            if cell:
                pieces.append(Piece.even(time, flow.step, polynomials[:, :, :cell]))
            if fraction:
                shorter = polynomials[:, :, cell : cell + 1] * fraction ** ORDERS[:, None]
                pieces.append(Piece.even(time + cell * flow.step, flow.step * fraction, shorter))
            end = time + (cell + fraction) * flow.step
            return Arrival(end, flow.state(states[:, cell], fraction), guard, pieces)
        pieces.append(Piece.even(time, flow.step, polynomials))
        time += states.shape[1] * flow.step
    return None


def _first_sign_change(values: Array) -> tuple[int, int, float] | None:
    """The cell, the guard and the fraction of the cell where a guard (guards, degree + 1, cells) first turns negative.

    Between two samples a guard is convex or concave, except for rare wiggles of no depth. So it may dip below zero
    where it falls at the first sample, rises at the second, and the tangents meet below zero.
    """
    looks = _LOOKS @ values  # (guards, places and slopes there, cells)
    at, slope = looks[:, : len(_PLACES)], looks[:, len(_PLACES) :]
    negative, turns = at[:, 1:] < 0, (slope[:, :-1] < 0) & (slope[:, 1:] > 0)
    if turns.any():
        turns &= _dips(values, at, slope)
    suspect = (negative | turns).any(axis=0)
    if not suspect.any():
        return None
    for cell, gap in np.argwhere(suspect.T):
        roots = [
            (fraction, int(guard))
            for guard in np.flatnonzero(negative[:, gap, cell] | turns[:, gap, cell])
            for fraction in _roots(values[guard, :, cell], _PLACES[gap], _PLACES[gap + 1])
        ]
        if roots:
            return int(cell), min(roots)[1], min(roots)[0]
    return None


def _dips(values: Array, at: Array, slope: Array) -> NDArray[np.bool_]:
    """Where the tangents at two neighbouring places meet below zero, by more than rounding."""
    falls, rises, above, width = slope[:, :-1], slope[:, 1:], at[:, :-1], np.diff(_PLACES)[:, None]
    meet = above * rises - at[:, 1:] * falls + width * falls * rises  # (rises - falls) > 0 times the height
    deep = DEEP * np.abs(values).max(axis=(1, 2))[:, None, None]
    return np.asarray((above > 0) & (meet < -deep * (rises - falls)))


def _roots(coefficients: Array, low: float, high: float) -> list[float]:
    """The first root of a guard that is negative at ``high``, or below its lowest point before it; or none."""
    falling = _polynomial(coefficients)
    if falling(high) < 0:
        return [first_fall(falling, low, high)]
    lowest = zero(_polynomial(ORDERS[1:] * coefficients[1:]), low, high)
    return [first_fall(falling, low, lowest)] if falling(lowest) < -DEEP * np.abs(coefficients).max() else []


def _polynomial(coefficients: Array) -> Callable[[float], float]:
    """The polynomial as a function of one number: Horner's rule, which on plain floats takes a microsecond."""
    descending = coefficients[::-1].tolist()

    def value(x: float) -> float:
        total = 0.0
        for coefficient in descending:
            total = total * x + coefficient
        return total

    return value


def first_fall(falling: Callable[[float], float], low: float, high: float) -> float:
    """Where a function that is negative at ``high`` falls through zero after ``low``, where it may be zero itself."""
    if falling(low) > 0:
        return zero(falling, low, high)
    # zero at the start of a phase by its nature: it may still rise before it falls
    for k in range(1, 40):
        if falling(high * 0.5**k) > 0:
            return zero(falling, high * 0.5**k, high)
    return low


def zero(function: Callable[[float], float], low: float, high: float) -> float:
    """The zero of a continuous function between two places of opposite sign, to 1e-15 and to rounding.

    Chandrupatla's method (Adv. Eng. Software 28 (1997) 145): inverse quadratic interpolation where it is safe, else
    bisection. scipy.optimize has it too, but loading that would take a fifth of a cold start.
    """
    a, b = low, high
    at_a, at_b, part = function(a), function(b), 0.5
    if at_a == 0 or at_b == 0:
        return a if at_a == 0 else b
    while True:
        x = a + part * (b - a)
        at_x = function(x)
        c, at_c = a, at_a  # the place before, at the far side of x or behind it
        if (at_x > 0) != (at_a > 0):
            c, at_c, b, at_b = b, at_b, a, at_a
        a, at_a = x, at_x
        best = a if abs(at_a) < abs(at_b) else b
        least = (1e-15 + 2e-15 * abs(best)) / abs(b - a)
        if at_a == 0 or least > 0.5:
            return best
        xi, phi = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        part = 0.5
        if phi**2 < xi and (1 - phi) ** 2 < 1 - xi:
            part = at_a / (at_b - at_a) * at_c / (at_b - at_c)
            part += (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        part = min(1 - least, max(least, part))


def integral_of_product(piece: Piece, first: int, second: int) -> float:
    """Integral over a stretch of the product of two outputs, exact."""
    a, b = piece.coefficients[first], piece.coefficients[second]
    return float(np.vdot(a * piece.lengths, _MOMENTS @ b))
