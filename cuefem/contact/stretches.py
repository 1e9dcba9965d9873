"""Stretches of a motion that is known at any time: linear courses, and phases that were stepped."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple, Protocol

import numpy as np

from cuefem.contact.state import Contact
from cuefem.cue import Array

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(8)  # exact for the interpolants of DOP853, of degree 7


class Course(NamedTuple):
    """From a start, s, on the state z moves by z' = A z, with |A| <= rate, 1/s; ``matrix`` makes A."""

    start: float
    matrix: Callable[[], Array]
    rate: float
    state: Array

    def states(self, rows: Array, spans: Array) -> Iterator[Array]:
        """States ``spans`` s after the start, ascending, and below them the integrals of ``rows``: exponentials."""
        from scipy.linalg import expm  # loaded when used: a strike alone needs no scipy

        size, scale = len(self.state), self.rate / float(np.linalg.norm(rows))
        A = np.zeros((size + len(rows),) * 2)
        A[:size, :size], A[size:, :size] = self.matrix(), scale * rows  # the integrals change as fast as the rest
        z, before = np.concatenate([self.state, np.zeros(len(rows))]), 0.0
        taken, onward = 0.0, np.eye(len(A))
        for span in spans:
            if abs(span - before - taken) > 1e-13 * taken:  # even times are so but for rounding: one will do
                taken = span - before
                onward = expm(A * taken)
            z, before = onward @ z, span
            state = z.copy()
            state[size:] /= scale
            yield state


class Solution(Protocol):
    """scipy's interpolant of a stepped phase, over time in units of a clock."""

    ts: Array

    def __call__(self, t: float | Array) -> Array:
        """States at a time, or at times (states, n)."""


class Stepping(NamedTuple):
    """A phase that was stepped: start and end, s; the solver's interpolant in units of ``clock``; what reads a state.

    reading: a state's (v_t, v_n, F_t, F_n).
    """

    start: float
    end: float
    clock: float
    solution: Solution
    reading: Callable[[Array], tuple[float, float, float, float]]

    def outputs(self, time: float) -> tuple[float, float, float, float]:
        """(v_t, v_n, F_n, F_t) at a time of the phase, the order of a history's outputs."""
        v_t, v_n, F_t, F_n = self.reading(self.solution(min(time, self.end) / self.clock))
        return v_t, v_n, F_n, F_t

    def states(self, rows: Array, spans: Array) -> Iterator[Array]:
        """What `Course.states` gives, read off the interpolant."""
        steps = np.asarray(self.solution.ts) * self.clock - self.start
        before, gone = 0.0, np.zeros(len(rows))
        for span in spans:
            knots = np.unique([before, *steps[(steps > before) & (steps < span)], span])
            if len(knots) > 1:
                half = np.diff(knots)[:, None] / 2
                places = (self.start + knots[:-1, None] + half * (1 + _GAUSS)).ravel()
                states = self.solution(np.minimum(places, self.end) / self.clock)
                gone = gone + rows @ states @ (half * _WEIGHTS).ravel()
            before = span
            yield np.concatenate([self.solution(min(self.start + span, self.end) / self.clock), gone])


def free_course(contact: Contact) -> Course:
    """The motion of cue and ball from now on, without a contact."""
    return Course(contact.time, lambda: contact.free, max(contact.fastest, 1 / contact.laws.time), contact.z)
