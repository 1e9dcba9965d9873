"""The exact response of cue and ball to forces at the contact that are polynomials of time over a step.

Between the forces the state moves by z' = A z (`cuefem.contact.state`). With A = V diag(lambda) U the coordinates
xi = U z turn by themselves, mode by mode, so that over a step of any length

    xi(t) = exp(lambda t) xi(0) + integral of exp(lambda (t - s)) U B f(s) over s from 0 to t,

which is known in closed form where the forces f are polynomials: what is left to find are their values at the nodes of
a step. The modes are so turned exactly, however fast they are; a step is only as short as the forces ask for. At a
first touch forces grow with the root of time, and there the polynomials are those of that root (`OPENING`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from cuefem.contact.state import Contact
from cuefem.cue import Array

Complex = NDArray[np.complex128]
# Nodes of a step, its two ends among them: Lobatto's, and the Legendre polynomials through them.
NODES = 18
# Gauss points between two nodes, of the integrals over a step; a mode may turn by a radian for each of them.
POINTS = NODES // 2 + 3
# Groups of modes whose eigenvectors have a larger condition number lose digits; by how much they are then changed.
DEFECTIVE, NUDGE = 1e7, 1e-9
# Terms of the series with which the forces of a step are guessed from those of the one before.
TAYLOR = 4
MANY, MANY_WEIGHTS = np.polynomial.legendre.leggauss(3 * NODES)
FEW, FEW_WEIGHTS = np.polynomial.legendre.leggauss(3 * NODES // 2)  # enough where modes turn slowly; the kernel's


class Rule(NamedTuple):
    """Where the nodes of a step lie, and integration over it.

    places: (NODES,) in [0, 1] of the step's own variable. times: (NODES,), the parts of the step's time there.
    integral: (NODES, NODES), from values at the nodes to their integrals up to each node over the step's time. waves:
    from values at the nodes to Legendre coefficients. between, values, weights: of Gauss points between the nodes
    (NODES - 1, POINTS): part of the step's time, the Lagrange polynomials (..., NODES), and weights in that time.
    slopes: (TAYLOR, NODES), from values at the nodes to the terms of Taylor's series at the end.
    """

    power: int
    places: Array
    times: Array
    integral: Array
    waves: Array
    between: Array
    values: Array
    weights: Array
    slopes: Array

    def polynomials(self, part: Any) -> Array:
        """The Lagrange polynomials at parts of the step's time, (..., NODES)."""
        place = np.asarray(part, float) ** (1 / self.power)
        waves = np.polynomial.legendre.legvander(2 * place - 1, NODES - 1).reshape(*place.shape, NODES)
        return np.asarray(waves @ self.waves)

    def function(self, values: Array) -> Callable[[float], float]:
        """The polynomial through values at the nodes, as a function of the part of the step's time."""
        terms: list[float] = (self.waves @ values).tolist()

        def value(part: float) -> float:
            x, after, total = 2 * part ** (1 / self.power) - 1, 0.0, 0.0
            for k in range(NODES - 1, -1, -1):  # Clenshaw's sum
                total, after = terms[k] + (2 * k + 1) / (k + 1) * x * total - (k + 1) / (k + 2) * after, total
            return total

        return value

    def weighted(self, part: float) -> tuple[Array, Array]:
        """(times, weights times the Lagrange polynomials) of many Gauss points up to a part of the step's time.

        Shapes (points,) and (points, NODES).
        """
        half = part ** (1 / self.power) / 2
        place = half * (1 + MANY)
        weights = half * MANY_WEIGHTS * self.power * place ** (self.power - 1)
        return place**self.power, weights[:, None] * self.polynomials(place**self.power)

    def sums(self, part: float) -> Array:
        """From values at the nodes to the integral up to a part of the step's time, (NODES,)."""
        if part == 1.0:
            return self.integral[-1]
        return np.asarray(self.weighted(part)[1].sum(axis=0))


def _rule(power: int) -> Rule:
    inner = np.polynomial.legendre.Legendre.basis(NODES - 1).deriv().roots().real
    x = np.concatenate([[-1.0], np.sort(inner), [1.0]])
    places = (1 + x) / 2
    waves = np.linalg.inv(np.polynomial.legendre.legvander(x, NODES - 1))
    gauss, weights = np.polynomial.legendre.leggauss(POINTS)
    half = np.diff(places)[:, None] / 2
    between = places[:-1, None] + half * (1 + gauss)
    values = np.polynomial.legendre.legvander(2 * between - 1, NODES - 1) @ waves
    in_time = half * weights * power * between ** (power - 1)
    pieces = np.einsum("ig,igj->ij", in_time, values)
    integral = np.concatenate([np.zeros((1, NODES)), np.cumsum(pieces, axis=0)])
    slopes = np.array([_slopes_at_end(order) for order in range(TAYLOR)]) @ waves
    return Rule(power, places, places**power, integral, waves, between**power, values, in_time, slopes)


def _slopes_at_end(order: int) -> Array:
    """Derivatives of the Legendre polynomials over [0, 1] at its end, over the order's factorial: (NODES,)."""
    found = np.zeros(NODES)
    for k in range(order, NODES):
        ends = [(k + j) * (k - j + 1) / (2 * j) for j in range(1, order + 1)]
        found[k] = 2.0**order * math.prod(ends) / math.factorial(order)
    return found


EVEN, OPENING = _rule(1), _rule(2)


@dataclass(frozen=True, eq=False)
class FreeMotion:
    """The motion without forces at the contact, z = Re(V xi), xi' = rates xi, and how forces drive it.

    rates: (k,) 1/s. vectors: V, (size, k). onto: U, (k, size). rows: (m, size), the velocities on which m forces act,
    and through which they push.
    """

    rates: Complex
    vectors: Complex
    onto: Complex
    rows: Array

    @classmethod
    def of(cls, contact: Contact, rows: Array) -> Self:
        """The free motion of a contact's states."""
        A, slots = contact.free, contact.slots
        coupled = A[slots.velocities, slots.velocities] != 0  # by what damps or radiates
        damped = coupled.any(axis=1)
        still = np.flatnonzero(~damped)
        swinging = still[still >= contact.quiet] - contact.quiet  # undamped modes: (omega q, velocity)
        alone = np.concatenate(
            [slots.velocities.start + still[still < contact.quiet], np.arange(slots.velocities.stop, len(A))]
        )
        rates = [1j * contact.omega[swinging], np.zeros(len(alone), complex)]
        first = len(swinging) + len(alone)
        vectors, onto = np.zeros((len(A), first), complex), np.zeros((first, len(A)), complex)
        k = np.arange(len(swinging))
        vectors[swinging, k], onto[k, swinging] = -1j, 1j
        vectors[slots.swinging.start + swinging, k], onto[k, slots.swinging.start + swinging] = 1.0, 1.0
        vectors[alone, len(swinging) + np.arange(len(alone))] = 1.0
        onto[len(swinging) + np.arange(len(alone)), alone] = 1.0
        for group in _groups(coupled, np.flatnonzero(damped).tolist()):
            of_swing = [mode - contact.quiet for mode in group if mode >= contact.quiet]
            places = np.array(of_swing + [slots.velocities.start + mode for mode in group])
            found, right, left = _turning(A[np.ix_(places, places)])
            wide, high = np.zeros((len(A), len(found)), complex), np.zeros((len(found), len(A)), complex)
            wide[places], high[:, places] = right, left
            rates.append(found)
            vectors, onto = np.concatenate([vectors, wide], axis=1), np.concatenate([onto, high])
        return cls(np.concatenate(rates), vectors, onto, rows)

    @cached_property
    def readings(self) -> Complex:
        """V read by the rows."""
        return np.asarray(self.rows @ self.vectors)

    @cached_property
    def drives(self) -> Complex:
        """What a unit of each force does to the coordinates."""
        return np.asarray(self.onto @ self.rows.T)

    def place(self, slot: int) -> int:
        """Of the coordinate that is a slot of the state by itself."""
        return int(np.argmax(np.abs(self.vectors[slot])))

    def state(self, xi: Complex) -> Array:
        """The state of coordinates."""
        return np.asarray((self.vectors @ xi).real)

    def shift(self, xi: Complex, step: float, rule: Rule, forces: Array, part: float) -> Complex:
        """The coordinates after a ``part`` of a step, s, whose forces are (m, NODES) at its nodes."""
        time, weighted = rule.weighted(part)
        loads = forces @ weighted.T
        onward = _turns(self.rates, step * (part - time))
        driven = (onward * (self.drives @ loads)).sum(axis=1)
        return np.asarray(_turns(self.rates, np.array(step * part)) * xi + step * driven)


def _turns(rates: Complex, times: Array) -> Complex:
    """exp(rates times), (k, *times.shape): real functions are ten times faster than complex ones."""
    phases = np.multiply.outer(rates.imag, times)
    found = np.empty(phases.shape, complex)
    found.real, found.imag = np.cos(phases), np.sin(phases)
    decaying = np.flatnonzero(rates.real)
    if len(decaying):
        found[decaying] *= np.exp(np.multiply.outer(rates.real[decaying], times))
    return found


def _groups(coupled: Array, left: list[int]) -> list[list[int]]:
    """The groups of modes that damping couples with each other."""
    groups: list[list[int]] = []
    while left:
        group, fresh = {left[0]}, [left[0]]
        while fresh:
            found = set(np.flatnonzero(coupled[fresh].any(axis=0)).tolist()) - group
            group, fresh = group | found, sorted(found)
        groups.append(sorted(group))
        left = [mode for mode in left if mode not in group]
    return groups


def _turning(own: Array) -> tuple[Complex, Complex, Complex]:
    """(rates, vectors, left vectors) of a group of states; of a pair of conjugates one, which counts twice."""
    rates, vectors = np.linalg.eig(own)
    if np.linalg.cond(vectors) > DEFECTIVE:  # two rates are one, as of a critically damped mode: take them apart
        own = own + NUDGE * np.linalg.norm(own) * np.diag(np.linspace(-1.0, 0.0, len(own)))
        rates, vectors = np.linalg.eig(own)
    left = np.linalg.inv(vectors)
    kept = np.flatnonzero(rates.imag >= 0)
    twice = np.where(rates[kept].imag > 0, 2.0, 1.0)
    return rates[kept].astype(complex), vectors[:, kept] * twice, left[kept].astype(complex)


# The row and the node of each entry of what is read in a step.
_ORDER = np.concatenate([np.tile([0, 1], NODES), np.repeat([2, 3], NODES)])
_NODE = np.concatenate([np.repeat(np.arange(NODES), 2), np.tile(np.arange(NODES), 2)])


class Response(NamedTuple):
    """What a step of one length does: to what is read at its nodes, and to the coordinates at its end.

    turned: (NODES, k), the coordinates' own turns up to the nodes. driven: (NODES, NODES, k), what a force at a node,
    the second, makes of a coordinate at the first. own: (m NODES, k), from the coordinates at the start to the rows at
    the nodes (the real part counts). answer: (m NODES, m NODES), from the forces at the nodes to the rows there. In
    both, the first two rows take turns, so that they are read as one complex number a node. integral: over the step's
    own time, s.
    """

    step: float
    rule: Rule
    free: FreeMotion
    turned: Complex
    driven: Complex
    own: Complex
    answer: Array
    integral: Array

    @classmethod
    def of(cls, free: FreeMotion, step: float, rule: Rule) -> Self:
        """The response of a free motion over a step, s."""
        rates, count, m = free.rates, len(free.rates), len(free.rows)
        ahead = (rule.times[1:, None] - rule.between) * step  # of a Gauss point to the next node
        if rule.power == 1:  # the nodes lie evenly about the middle
            onward = _turns(rates, ahead[: NODES // 2])
            onward = np.concatenate([onward, onward[:, (NODES - 1) // 2 - 1 :: -1]], axis=1)
        else:
            onward = _turns(rates, ahead)
        onward = onward.transpose(1, 2, 0).copy().view(float)  # (NODES - 1, POINTS, 2 k)
        pieces = rule.values.transpose(0, 2, 1) * (step * rule.weights)[:, None, :] @ onward
        pieces = pieces.view(complex)  # (NODES - 1, NODES, k)
        hops = _turns(rates, np.diff(rule.times) * step).T
        driven = np.zeros((NODES, NODES, count), complex)
        for i in range(1, NODES):
            np.multiply(driven[i - 1], hops[i - 1], out=driven[i])
            driven[i] += pieces[i - 1]
        turned = _turns(rates, rule.times * step).T
        own = (free.readings[_ORDER] * turned[_NODE]).reshape(m * NODES, count)
        pairs = (free.readings[:, None, :] * free.drives.T).conj().reshape(m * m, count)  # read, pushed
        # the real part of a product of complex numbers is the scalar product of one and the other's conjugate
        flat = pairs.view(float) @ driven.reshape(NODES * NODES, count).view(float).T
        answer = flat.reshape(m, m, NODES, NODES)[_ORDER[:, None], _ORDER, _NODE[:, None], _NODE]
        return cls(step, rule, free, turned, driven, own, answer, step * rule.integral)

    def coordinates(self, xi: Complex, forces: Array) -> Complex:
        """The coordinates at the end, (k,), from those at the start and the forces (m, NODES)."""
        pushed = (self.free.drives @ forces).T  # (NODES, k)
        return np.asarray(self.turned[-1] * xi + (self.driven[-1] * pushed).sum(axis=0))

    def all_coordinates(self, xi: Complex, forces: Array) -> Complex:
        """The coordinates at the nodes, (k, NODES)."""
        pushed = (self.free.drives @ forces).T
        return np.asarray(self.turned * xi + np.einsum("ijk,jk->ik", self.driven, pushed)).T
