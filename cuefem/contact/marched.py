"""The steps of a contact that was stepped with the exact turns of the modes (`cuefem.contact.response`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cuefem.contact.response import Complex, Response, Rule
from cuefem.cue import Array


class Motion(NamedTuple):
    """What moves in a step, at its nodes: velocities, m/s, forces, N, compression, m, angle, rad."""

    v_t: Array
    v_n: Array
    F_t: Array
    F_n: Array
    depth: Array
    angle: Array


@dataclass(frozen=True)
class Piece:
    """A step that was taken, from ``start``, s, up to ``part`` of it.

    step: length of the whole, s. key: of its response, by which ``responds`` makes it or knows it. coordinates: at its
    start. forces: on the rows, (m, NODES). slots: those of compression and angle in the state.
    """

    start: float
    part: float
    step: float
    rule: Rule
    key: tuple[int, bool]
    responds: Callable[[int, bool], Response]
    coordinates: Complex
    forces: Array
    motion: Motion
    slots: list[int]

    @property
    def response(self) -> Response:
        """Of the whole step."""
        return self.responds(*self.key)

    @property
    def end(self) -> float:
        """Where it ends, s."""
        return self.start + self.part * self.step

    def outputs(self, time: Array) -> Array:
        """(v_t, v_n, F_n, F_t) at times, s, (4, n)."""
        part = np.minimum((time - self.start) / self.step, self.part)
        values = np.stack([self.motion.v_t, self.motion.v_n, self.motion.F_n, self.motion.F_t])
        return np.asarray(values @ self.rule.polynomials(part).T)

    def sums(self, part: float) -> Array:
        """From values at the nodes to their integral up to a part of the step, (NODES,), s."""
        return self.step * self.rule.sums(part)

    def _states(self) -> Array:
        """The states at the nodes, (size, NODES)."""
        free = self.response.free
        states = (free.vectors @ self.response.all_coordinates(self.coordinates, self.forces)).real
        states[self.slots] = self.motion.depth, self.motion.angle
        return np.asarray(states)

    def _state(self, part: float) -> Array:
        """The state at a part of the step."""
        rule, free = self.rule, self.response.free
        state = free.state(free.shift(self.coordinates, self.step, rule, self.forces, part))
        values = rule.polynomials(part)
        state[self.slots] = values @ self.motion.depth, values @ self.motion.angle
        return state

    def states(self, rows: Array, times: Array) -> tuple[list[Array], Array]:
        """States at times, s, each with the integrals of ``rows`` since the start; and these up to the end."""
        nodes = rows @ self._states()
        parts = [min((float(time) - self.start) / self.step, self.part) for time in times]
        found = [np.concatenate([self._state(part), nodes @ self.sums(part)]) for part in parts]
        return found, nodes @ self.sums(self.part)


class Marched(NamedTuple):
    """A phase, or a flight, by its steps; start, s."""

    start: float
    pieces: tuple[Piece, ...]

    def states(self, rows: Array, spans: Array) -> Iterator[Array]:
        """What `cuefem.contact.stretches.Course.states` gives."""
        gone, size = np.zeros(len(rows)), -len(rows)
        times = self.start + np.asarray(spans)
        for piece in self.pieces:
            last = piece is self.pieces[-1]
            own = times[(times >= piece.start) & (last | (times < piece.end))]
            states, whole = piece.states(rows, own)
            for state in states:
                state[size:] += gone
                yield state
            gone = gone + whole
