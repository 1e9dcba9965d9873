"""Density of the end mass along the cue: exact derivatives of the stick end mass to the section properties.

The end mass is a function of lambda_k = omega_k^2 and the tip amplitudes phi_k of the retained modes. A change of
stiffness and mass changes those by first-order perturbation over *all* modes of the mesh (retained, truncated and
rigid-body modes j):

    d lambda_k = dK_kk - lambda_k dM_kk
    d phi_k = -phi_k dM_kk/2 + sum over j != k of phi_j (dK_jk - lambda_k dM_jk)/(lambda_k - lambda_j)

so dm is a quadratic form in the modes' curvatures, shears, deflections and rotations at each point: the densities.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg

from cuefem.beam.assembly import System, assemble
from cuefem.beam.modes import solve
from cuefem.cue import Array
from cuefem.endmass.impulse_response import PULSE_STEPS
from cuefem.endmass.sticking_contact import StickLimit
from cuefem.quantity.equality import equal_fields
from cuefem.scene import Resolution, Scene
from cuefem.scene.solved_scene import TRUNCATED_SUM_PERIODS, default_mode_count


@dataclass(frozen=True, eq=False)
class EndMassDensity:
    """Derivatives of an end mass, kg.

    x: Gauss points of the mesh, m from the tip, (points,). weights: their lengths, m. rhoA, rhoI, EI, kGA: densities of
    the derivatives per unit length: dm = integral of density times the change of the property; rhoA is a pure number,
    kg of end mass per kg of added mass. ball_mass, axial_mass: derivatives to M and m_a, pure numbers. end_mass: kg.
    """

    x: Array
    weights: Array
    rhoA: Array
    rhoI: Array
    EI: Array
    kGA: Array
    ball_mass: float
    axial_mass: float
    end_mass: float

    __eq__ = equal_fields


@dataclass(frozen=True, eq=False)
class _Gradient:
    """An end mass and its derivatives to lambda_k, phi_k of the retained modes, the rigid-body sum, M and m_a."""

    value: float
    squares: Array
    amplitudes: Array
    rigid: float
    ball_mass: float
    axial_mass: float


def end_mass_density(scene: Scene, at: Resolution | int | None = None) -> EndMassDensity:
    """Derivatives of a bare cue's stick end mass to the section properties along it.

    Parameters
    ----------
    scene : Scene
        With a finite-element cue and without effects.
    at : Resolution or int, optional
        A resolution, or a number of modes. The default is that of `end_mass` without a truncation correction.

    Returns
    -------
    EndMassDensity
        Exact for the retained modes of the mesh.

    Raises
    ------
    ValueError
        If the cue is lumped or the scene has effects.

    Notes
    -----
    See the top of `cuefem.endmass.end_mass_density` for the formulas. The densities times their properties integrate to
    m_e - M dm/dM - m_a dm/dm_a: m_e scales with all masses and stiffnesses together. The cost is one dense eigenproblem
    for all modes of the mesh.
    """
    if scene.effects:
        raise ValueError(f"end_mass_density scene must have no effects; got {len(scene.effects)}")
    at = at or default_mode_count(scene, periods=TRUNCATED_SUM_PERIODS)
    system, count = assemble(scene.shaft, at), at if isinstance(at, int) else at.modes
    bending = solve(system, system.size - system.rigid_basis.shape[1])
    squares, phi = bending.omega**2, bending.vectors[0]
    rigid_phi = bending.rigid_vectors[0]
    gradient = _stick(squares[:count], phi[:count], float(rigid_phi @ rigid_phi), scene)
    to_K, to_M = _forms(gradient, squares, phi, rigid_phi)
    return _densities(system, np.concatenate([bending.rigid_vectors, bending.vectors], axis=1), to_K, to_M, gradient)


def _forms(gradient: _Gradient, squares: Array, phi: Array, rigid_phi: Array) -> tuple[Array, Array]:
    """The quadratic forms of dm in the modes (rigid-body modes first), for dK and for dM."""
    rigid, modes = len(rigid_phi), len(gradient.squares)
    all_squares, all_phi = np.concatenate([np.zeros(rigid), squares]), np.concatenate([rigid_phi, phi])
    size = len(all_phi)
    to_K, to_M = np.zeros((size, size)), np.zeros((size, size))
    rows = rigid + np.arange(modes)
    differences = squares[:modes, None] - all_squares
    differences[np.arange(modes), rows] = np.inf
    to_K[rows] = gradient.amplitudes[:, None] * all_phi / differences
    to_K[rows, rows] = gradient.squares
    to_M[rows] = -squares[:modes, None] * to_K[rows]
    to_M[rows, rows] -= gradient.amplitudes * phi[:modes] / 2
    to_M[:rigid, :rigid] -= gradient.rigid * np.outer(rigid_phi, rigid_phi)
    return (to_K + to_K.T) / 2, (to_M + to_M.T) / 2


def _densities(system: System, vectors: Array, to_K: Array, to_M: Array, gradient: _Gradient) -> EndMassDensity:
    fields, points = system.fields(vectors), system.points

    def density(form: Array, fields: Array) -> Array:
        return np.asarray(((fields @ form) * fields).sum(axis=1))

    return EndMassDensity(
        x=points.x,
        weights=points.weights,
        rhoA=density(to_M, fields.w),
        rhoI=density(to_M, fields.theta),
        EI=density(to_K, fields.dtheta),
        kGA=density(to_K, fields.dw - fields.theta),
        ball_mass=gradient.ball_mass,
        axial_mass=gradient.axial_mass,
        end_mass=gradient.value,
    )


def _stick(squares: Array, phi: Array, rigid: float, scene: Scene) -> _Gradient:
    """Derivatives of the stick end mass, by the adjoint of the linear solve for its J.

    The solve is that of `cuefem.endmass.impulse_response.imposed_velocity_impulse`: after the first impulse the
    forces, constant over steps, follow from the mean velocities by a lower triangular Toeplitz matrix. All of it is
    linear in the modes' phi^2; a response R(omega) is the derivative of J to the phi^2 of a mode of this frequency.
    """
    limit, omega = StickLimit.of(scene), np.sqrt(squares)
    T, c, K = limit.T, limit.c, limit.K
    h, t = T / PULSE_STEPS, T / PULSE_STEPS * np.arange(PULSE_STEPS)

    def mean_velocities(omega: Any) -> tuple[Array, Array]:
        """Of modes of phi = 1, (steps, modes): after an impulse at the start, and after a force over the first step."""
        half = omega * h / 2
        mean = np.sin(half) / half
        after_force = h * mean**2 * np.cos(omega * t[:, None])
        after_force[0] /= 2
        return mean * np.cos(omega * (t[:, None] + h / 2)), after_force

    of_impulse, of_force = mean_velocities(omega)
    after_impulse, column = of_impulse @ phi**2 + rigid + c, of_force @ phi**2 + h * (rigid + c)
    column[0] -= h * (rigid + c) / 2
    P = limit.normal_impulse(np.append(t, T))
    mean_P = (P[1:] + P[:-1]) / 2
    first = -1 / (float(phi @ phi) + rigid + c)  # the velocity K P - 1 begins with -1
    matrix = scipy.linalg.toeplitz(column, np.zeros(PULSE_STEPS))
    force = scipy.linalg.solve_triangular(matrix, K * mean_P - 1 - first * after_impulse, lower=True)
    adjoint = scipy.linalg.solve_triangular(matrix, np.full(PULSE_STEPS, h), trans="T", lower=True)
    of_column = -np.correlate(adjoint, force, "full")[PULSE_STEPS - 1 :]

    def R(omega: Any) -> Array:
        of_impulse, of_force = mean_velocities(omega)
        return np.asarray(
            first**2 * (1 - float(adjoint @ after_impulse)) - first * (adjoint @ of_impulse) + of_column @ of_force
        )

    J, to_K, to_rigid = first + h * float(force.sum()), float(adjoint @ mean_P), float(R(np.full(1, 1e-9 / T))[0])
    m = limit.end_mass(J)
    scale = m**2 * (K - 1) / J**2  # dm/dJ at fixed c and K
    M, m_a, head_on = scene.ball.mass, scene.axial_mass, limit.reduced_mass
    # K = (1 + e)(c + 1/m_a)/(1/M + 1/m_a), c proportional to 1/M
    dc_dM = -c / M
    dK_dM = (1 + limit.e) * head_on * dc_dM + K * head_on / M**2
    dK_dma = (-(1 + limit.e) * head_on + K * head_on) / m_a**2
    per_c, per_K = scale * to_rigid + m**2, scale * to_K - m**2 / J
    response, step = R(omega), 1e-30
    slope = np.imag(R(omega * (1 + 1j * step))) / (step * omega)  # by a complex step, exact to rounding
    return _Gradient(
        m,
        scale * phi**2 * slope / (2 * omega),
        scale * response * 2 * phi,
        scale * to_rigid,
        ball_mass=float(per_c * dc_dM + per_K * dK_dM),
        axial_mass=float(per_K * dK_dma),
    )
