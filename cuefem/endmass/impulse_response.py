"""The cue's tip under a half-sine force, or with a prescribed transverse velocity."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.coupled_modes import CoupledModes
from cuefem.contact.kernel.declarations import KernelInput, KernelState
from cuefem.contact.kernel.library import library, new_contact
from cuefem.contact.modal_response import level_propagator, repeated_tables
from cuefem.cue import Array

# Steps of a contact. Against closed forms at the same 120 modes (100 random cues, 0.5 to 3 ms, free and damped, "stick"
# and "offset"): relative error 1e-6 (median), 9e-5 (maximum); with half the steps 1e-3 (maximum).
PULSE_STEPS = 2048


def half_sine_velocity(tip: TipModes, T: float) -> float:
    """Velocity of the tip at the end of a half-sine force of amplitude 1 N and duration T, s, m/s per N; exact."""
    check_moves(tip)
    is_coupled = tip.dashpots.any(axis=0) | tip.radiation.any(axis=1)
    velocity = _half_sine_response(tip, T)[~is_coupled].sum()
    return float(velocity + _coupled_half_sine_velocity(tip.subset(np.flatnonzero(is_coupled)), T))


def check_moves(tip: TipModes) -> None:
    """ValueError if the tip is clamped."""
    if not tip.amplitude[:, 1].any():
        raise ValueError("end_mass: the tip is clamped transversely, so its end mass is infinite")


def _half_sine_response(tip: TipModes, T: float) -> Array:
    """The velocity that each mode contributes, (n,), m/s per N, without radiation and dashpots.

    The tip's impulse response in a mode is the real part of weight exp(rate t), with the rate omega (i root - loss/2);
    it is integrated over the half-sine.
    """
    ratio = tip.loss / 2
    root = np.sqrt(1 - ratio**2)
    rate, weight = tip.omega * (1j * root - ratio), tip.amplitude[:, 1] ** 2 * (1 + 1j * ratio / root)
    upper, lower = (_mean_of_exponential(rate * T + side * 1j * np.pi) for side in (1, -1))
    return np.asarray((weight * T * (upper - lower) / 2j).real)


def _mean_of_exponential(z: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Mean of exp(z s) over s from 0 to 1."""
    return np.where(z == 0, 1.0, np.expm1(z) / np.where(z == 0, 1.0, z))


def _coupled_half_sine_velocity(tip: TipModes, T: float) -> float:
    """As `half_sine_velocity`, of modes that radiation or dashpots couple: an exponential of their system."""
    n, rate = len(tip.omega), np.pi / T
    system = np.zeros((2 * n + 2, 2 * n + 2))  # of v, a, the force, and its derivative over the rate
    system[: 2 * n, : 2 * n] = CoupledModes(tip.omega, tip.damping).system[: 2 * n, : 2 * n]
    system[:n, -2], system[-2, -1], system[-1, -2] = tip.amplitude[:, 1], rate, -rate
    return float(tip.amplitude[:, 1] @ expm(system * T)[:n, -1])


def imposed_velocity_impulse(tip: TipModes, T: float, velocity: Array, ball_inverse_mass: float = 0.0) -> float:
    """Impulse on the tip, N s, for a transverse velocity from rest, m/s, (`PULSE_STEPS` + 1,) from 0 to T.

    It may begin with a jump. Forces are constant over the steps. ball_inverse_mass: of a ball that the impulse moves,
    too, 1/kg: the velocity is then relative to it.
    """
    check_moves(tip)
    tip = tip.lateral
    propagator = level_propagator(tip, turns=False)
    tables, means = repeated_tables(propagator, T / PULSE_STEPS), (velocity[1:] + velocity[:-1]) / 2
    first_impulse = velocity[0] / (float(propagator.mobility[1, 1]) + ball_inverse_mass)
    velocities = first_impulse * propagator.ports[1]
    state = KernelState(modes=np.array([velocities, np.zeros_like(velocities)]))
    with new_contact(KernelInput(**propagator.fields), state) as contact:
        impulse = library().imposed_velocity_impulse(
            contact, tables, PULSE_STEPS, means.ctypes.data, ball_inverse_mass, first_impulse
        )
    return float(impulse)
