"""Modal propagation: the exact response of a cue's modes to loads at its tip.

An undamped mode of angular frequency omega is one complex coordinate xi = v + i omega q, with xi' = i omega xi + input.
Modes that a damper couples are replaced by the eigenvectors of their group. The velocities of ports and slopes are
Re(output_rows xi). All of it depends on the cue alone: strikes at other speeds and offsets share it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.geometric_stiffness import half_octave, slope_rows
from cuefem.cue import Array

Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
# Above MAX_CONDITION the eigenvectors of coupled modes lose accuracy. The diagonal is then shifted by up to
# DIAGONAL_SHIFT of the norm, which separates equal eigenvalues.
MAX_CONDITION, DIAGONAL_SHIFT = 1e7, 1e-9


class ModalPropagator:
    """Tip modes and their ports in the complex coordinates that the compiled kernel propagates.

    rows: (ports, modes), output and input matrix of the ports, 1/sqrt(kg). slopes: (slopes, modes), the same for the
    slopes of the bent cue (`cuefem.contact.geometric_stiffness`); empty without geometric stiffness. omega, approach:
    of the tip modes. eigenvalues: (coordinates,), 1/s, i omega of an undamped mode. displacements, velocities: (modes,
    coordinates), from the coordinates to omega q and the modal velocities. modal_inputs: (coordinates, modes), from
    modal velocities to coordinates. dampers: (rows, modes), rows r of the damping and then of the radiation, whose
    (r v)^2 add up to the power, W, at the modal velocities v. n_dissipative: number of the first of these, whose energy
    is dissipated; the others radiate it.
    """

    def __init__(self, tip: TipModes, rows: Array, slopes: Array) -> None:
        self.rows, self.slopes, self.omega, self.approach = rows, slopes, tip.omega, tip.approach
        omega, count = tip.omega, len(tip.omega)
        resistance = np.zeros((count, count)) if tip.total_damping is None else tip.total_damping
        coupled = resistance != 0
        groups = [_uncoupled_modes(omega, np.flatnonzero(~coupled.any(axis=1)))]
        groups += [_couple(omega, resistance, group) for group in _coupled_groups(coupled)]
        self.eigenvalues = np.concatenate([group.eigenvalues for group in groups])
        self.displacements, self.velocities = (np.zeros((count, len(self.eigenvalues)), complex) for _ in range(2))
        self.modal_inputs = np.zeros((len(self.eigenvalues), count), complex)
        first = 0
        for group in groups:
            columns = slice(first, first + len(group.eigenvalues))
            self.displacements[group.modes, columns], self.velocities[group.modes, columns] = (
                group.displacements,
                group.velocities,
            )
            self.modal_inputs[columns, group.modes] = group.modal_inputs
            first = columns.stop
        dampers = [_power_rows(damping) for damping in (tip.damping, tip.radiation) if damping is not None]
        self.n_dissipative = len(dampers[0]) if tip.damping is not None else 0
        self.dampers = np.concatenate([np.zeros((0, count)), *dampers])

    @property
    def loaded_rows(self) -> Array:
        """Input rows of the ports, then of the slopes, (ports + slopes, modes)."""
        return np.concatenate([self.rows, self.slopes])

    @cached_property
    def approach_state(self) -> Complex:
        """Coordinates of a cue that moves along its axis at 1 m/s."""
        return np.asarray(self.modal_inputs @ self.approach, complex)

    @property
    def mobility(self) -> Array:
        """Inverse masses of the ports, (ports, ports), 1/kg."""
        return np.asarray(self.rows @ self.rows.T)

    @cached_property
    def output_rows(self) -> Complex:
        """From the coordinates to the velocities of ports and slopes, (ports + slopes, coordinates), as real parts."""
        return np.ascontiguousarray(self.loaded_rows @ self.velocities)

    @cached_property
    def input_rows(self) -> Complex:
        """Change of the coordinates per unit impulse on ports and slopes, (ports + slopes, coordinates)."""
        return np.ascontiguousarray((self.modal_inputs @ self.loaded_rows.T).T)

    @cached_property
    def _damper_rows(self) -> Complex:
        return np.asarray((self.dampers @ self.velocities).T)

    def dissipated(self, xi: Complex, lengths: Array) -> Array:
        """Energy dissipated and radiated in each of n steps, (n, 2), J; xi: (n + 1, coordinates), at their ends.

        The dampers' velocities are parabolas with the values v, w at the ends of a step and the mean m over it, whose
        squares have the mean (4 v^2 + 4 w^2 - 2 v w)/30 + m (6 m - v - w)/5. Under constant loads the mean of xi is
        (phi_1 - exp(z) phi_2/phi_1) xi_0 + phi_2/phi_1 xi_1.
        """
        ends, means = (xi @ self._damper_rows).real, np.zeros((len(lengths), len(self.dampers)))
        for length in np.unique(lengths[lengths > 0]):
            steps = np.flatnonzero(lengths == length)
            exp_z, phi_1, phi_2 = phi_functions(self.eigenvalues * length)
            before, after = (phi_1 - exp_z * phi_2 / phi_1)[:, None], (phi_2 / phi_1)[:, None]
            means[steps] = (xi[steps] @ (before * self._damper_rows) + xi[steps + 1] @ (after * self._damper_rows)).real
        v, w = ends[:-1], ends[1:]
        squares = (4 * v**2 + 4 * w**2 - 2 * v * w) / 30 + means * (6 * means - v - w) / 5
        squares *= lengths[:, None]
        dissipated, radiated = np.split(squares, [self.n_dissipative], axis=1)
        return np.column_stack([dissipated.sum(axis=1), radiated.sum(axis=1)])


def phi_functions(z: Complex) -> tuple[Complex, Complex, Complex]:
    """exp(z), phi_1 = (exp(z) - 1)/z and phi_2 = (phi_1 - 1)/z, of a mode's response to a constant load."""
    large = np.abs(z) > 0.5
    nonzero = np.where(large, z, 1.0)
    phi_2 = np.where(
        large, (np.exp(nonzero) - 1 - nonzero) / nonzero**2, sum(z ** (n - 2) / math.factorial(n) for n in range(2, 16))
    )
    return 1 + z * (1 + z * phi_2), 1 + z * phi_2, phi_2


class _Group(NamedTuple):
    """Uncoupled modes, or a group coupled by dampers, in uncoupled coordinates (`ModalPropagator`)."""

    modes: Index
    eigenvalues: Complex
    displacements: Complex
    velocities: Complex
    modal_inputs: Complex


def _uncoupled_modes(omega: Array, modes: Index) -> _Group:
    """Each mode is a coordinate v + i omega q, a rigid one its velocity."""
    one = np.eye(len(modes), dtype=complex)
    return _Group(modes, np.asarray(1j * omega[modes], complex), -1j * one * (omega[modes] > 0), one, one)


def _couple(omega: Array, resistance: Array, modes: Index) -> _Group:
    """The eigenvectors of (omega q, v)' = (omega v, -omega (omega q) - C v); one of each conjugate pair, doubled."""
    vibrating = np.flatnonzero(omega[modes])  # a rigid mode has no displacement among the states
    count, rates = len(vibrating), omega[modes[vibrating]]
    states = np.zeros((count + len(modes), count + len(modes)))
    states[count:, count:] = -resistance[modes[:, None], modes]
    states[np.arange(count), count + vibrating], states[count + vibrating, np.arange(count)] = rates, -rates
    eigenvalues, right = np.linalg.eig(states)
    if np.linalg.cond(right, "fro") > MAX_CONDITION:  # equal eigenvalues, as of a critically damped mode
        perturbation = DIAGONAL_SHIFT * np.linalg.norm(states) * np.diag(np.linspace(-1.0, 0.0, len(states)))
        eigenvalues, right = np.linalg.eig(states + perturbation)
    left = np.linalg.inv(right).astype(complex)
    upper = np.flatnonzero(eigenvalues.imag >= 0)
    right = (right[:, upper] * np.where(eigenvalues[upper].imag > 0, 2.0, 1.0)).astype(complex)
    displacements = np.zeros((len(modes), len(upper)), complex)
    displacements[vibrating] = right[:count]
    velocities, modal_inputs = np.asarray(right[count:], complex), np.asarray(left[upper][:, count:], complex)
    return _Group(modes, eigenvalues[upper].astype(complex), displacements, velocities, modal_inputs)


def _coupled_groups(coupled: Any) -> Iterator[Index]:
    """The groups of modes that damping couples with each other."""
    remaining = coupled.any(axis=1)
    while remaining.any():
        group = coupled[np.argmax(remaining)]
        while (extended := coupled[group].any(axis=0) | group).sum() > group.sum():
            group = extended
        yield np.flatnonzero(group)
        remaining &= ~group


def _power_rows(damping: Array) -> Array:
    """Rows r over the modes, with the power of a damping matrix as the sum of (r v)^2, v the modal velocities."""
    modes = np.flatnonzero(damping.any(axis=1))
    rates, directions = np.linalg.eigh(damping[np.ix_(modes, modes)])
    positive = rates > 1e-14 * rates.max(initial=0.0)
    rows = np.zeros((int(positive.sum()), len(damping)))
    rows[:, modes] = (directions[:, positive] * np.sqrt(rates[positive])).T
    return rows


def propagator_of(tip: TipModes, ports: str = "straight", time: float = 0.0, window: float = 0.0) -> ModalPropagator:
    """The propagator of tip modes at the ports "straight" (u, w), "turning" (u, w, rotation) or "raised" (u, w, p).

    time: approximate contact time, s; window: the time simulated after it, s. The slopes of a bent cue depend on both
    (`slope_rows`). Strikes with the same tip modes share the propagator.
    """
    has_slopes = tip.geometric is not None
    return _propagator(tip, ports, *((half_octave(time), half_octave(time) + window) if has_slopes else (0.0, 0.0)))


@lru_cache(maxsize=32)
def _propagator(tip: TipModes, ports: str, time: float, end: float) -> ModalPropagator:
    rows, slopes = tip.amplitude.T, slope_rows(tip, time, end)
    if ports == "turning":
        rows = np.concatenate([rows, tip.rotation[None]])
    return ModalPropagator(*(_in_two_planes(tip, slopes) if ports == "raised" else (tip, rows, slopes)))


def _in_two_planes(tip: TipModes, slopes: Array) -> tuple[TipModes, Array, Array]:
    """Modes, rows of the ports (u, w, p) and slopes: each bending mode a second time, in the plane out of (u, w)."""
    bending = np.flatnonzero(tip.amplitude[:, 1] != 0)
    count, n_bending = len(tip.omega), len(bending)
    indices = np.append(np.arange(count), bending)
    one_plane = np.equal.outer(np.arange(len(indices)) < count, np.arange(len(indices)) < count)
    amplitude, zeros = np.pad(tip.amplitude, ((0, n_bending), (0, 0))), np.zeros(n_bending)
    damping, radiation = (
        None if matrix is None else matrix[np.ix_(indices, indices)] * one_plane
        for matrix in (tip.damping, tip.radiation)
    )
    approach, rotation = np.append(tip.approach, zeros), np.append(tip.rotation, zeros)
    modes = TipModes(tip.omega[indices], amplitude, approach, rotation, damping, radiation)
    rows = np.concatenate([amplitude.T, np.append(np.zeros(count), tip.amplitude[bending, 1])[None]])
    out_of_plane = np.pad(slopes[:, bending], ((0, 0), (count, 0)))
    return modes, rows, np.concatenate([np.pad(slopes, ((0, 0), (0, n_bending))), out_of_plane])
