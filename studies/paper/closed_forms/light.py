"""A light cue end: [Kim]'s expansions to first order in epsilon = m_c/M, and the limits epsilon -> 0.

Throughout: offset b/R in (-1, 1), cue_mass_ratio Q0 = M_c/M, cue_end_ratio epsilon = m_c/M, inertia nu of the ball,
nu_c of the cue end, restitution e; all broadcast.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from cuefem.quantity.fields import first_failure, sine_cosine
from studies.paper.closed_forms.arguments import checked


class Expansion(NamedTuple):
    """One number for each of beta_par, beta_perp, beta_x."""

    parallel: Any
    perpendicular: Any
    cross: Any


def light_coefficients(offset: Any, *, nu_c: Any = 1 / 3) -> Expansion:
    """[Kim] eq. epsilon0 1: the betas at epsilon = 0, (1 + nu_c)/nu_c times cos^2, sin^2 and sin cos of phi."""
    offset, nu_c = checked(offset=offset, nu_c=nu_c)
    s, c = sine_cosine(offset)
    scale = (1 + nu_c) / nu_c
    return Expansion(scale * c**2, scale * s**2, scale * s * c)


def first_order_coefficients(offset: Any, *, cue_mass_ratio: Any, inertia: Any = 0.4, nu_c: Any = 1 / 3) -> Expansion:
    """[Kim] after eq. psi=0: the A of beta' = beta0 (1 - epsilon A). ValueError at offset 0, a pole of A_perp."""
    offset, cue, nu, nu_c = checked(offset=offset, cue_mass_ratio=cue_mass_ratio, inertia=inertia, nu_c=nu_c)
    _not_head_on(offset)
    s, c = sine_cosine(offset)
    part = nu_c / (1 + nu_c)
    return Expansion(
        1 - part * (1 + 1 / nu + (s**2) / cue) / c**2,
        1 - part * (1 + c**2 / cue) / s**2,
        1 + part / cue,
    )


def first_order_critical_friction(
    offset: Any, *, cue_end_ratio: Any, cue_mass_ratio: Any, inertia: Any = 0.4, nu_c: Any = 1 / 3
) -> Any:
    """[Kim] after eq. psi=0: mu_c = tan(phi) [1 - epsilon nu_c (1/Q0 + 1 + 1/nu)/((1 + nu_c) cos^2 phi)]."""
    offset, end, cue, nu, nu_c = checked(
        offset=offset, cue_end_ratio=cue_end_ratio, cue_mass_ratio=cue_mass_ratio, inertia=inertia, nu_c=nu_c
    )
    s, c = sine_cosine(offset)
    return s / c * (1 - end * nu_c / (1 + nu_c) * (1 / cue + 1 + 1 / nu) / c**2)


def first_order_gamma(
    offset: Any, *, cue_end_ratio: Any, cue_mass_ratio: Any, inertia: Any = 0.4, nu_c: Any = 1 / 3
) -> Any:
    """[Kim] after eq. psi=0: gamma = 1 - epsilon nu_c [1 + 1/Q0 + sin^2/nu]/((1 + nu_c) sin^2 cos^2); not at 0."""
    offset, end, cue, nu, nu_c = checked(
        offset=offset, cue_end_ratio=cue_end_ratio, cue_mass_ratio=cue_mass_ratio, inertia=inertia, nu_c=nu_c
    )
    _not_head_on(offset)
    s, c = sine_cosine(offset)
    return 1 - end * nu_c / (1 + nu_c) * resistance(offset, cue_mass_ratio=cue, inertia=nu) / (s * c) ** 2


def first_order_leaving_tangent(
    offset: Any,
    *,
    cue_end_ratio: Any,
    cue_mass_ratio: Any,
    restitution: Any = 0.75,
    inertia: Any = 0.4,
    nu_c: Any = 1 / 3,
) -> Any:
    """[Kim] eq. theta f: 1: tan(theta) to first order, tan(phi) less epsilon times the slope of squirt over cos^2."""
    offset, end = checked(offset=offset, cue_end_ratio=cue_end_ratio)
    s, c = sine_cosine(offset)
    slope = squirt_slope(offset, cue_mass_ratio=cue_mass_ratio, restitution=restitution, inertia=inertia, nu_c=nu_c)
    return s / c - end * slope / c**2


def squirt_slope(
    offset: Any, *, cue_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4, nu_c: Any = 1 / 3
) -> Any:
    """[Kim] eq. psi squirt: d(psi)/d(epsilon) at epsilon = 0, rad; independent of friction."""
    offset, cue, restitution, nu, nu_c = checked(
        offset=offset, cue_mass_ratio=cue_mass_ratio, restitution=restitution, inertia=inertia, nu_c=nu_c
    )
    s, c = sine_cosine(offset)
    bracket = 1 / nu + (1 / nu + 1 + 1 / cue) * restitution / c**2
    return nu_c / (1 + nu_c) * s * c / (1 + restitution) * bracket


def first_order_squirt(
    offset: Any,
    *,
    cue_end_ratio: Any,
    cue_mass_ratio: Any,
    restitution: Any = 0.75,
    inertia: Any = 0.4,
    nu_c: Any = 1 / 3,
) -> Any:
    """[Kim] eq. psi squirt: psi = epsilon times `squirt_slope`, rad."""
    (end,) = checked(cue_end_ratio=cue_end_ratio)
    return end * squirt_slope(
        offset, cue_mass_ratio=cue_mass_ratio, restitution=restitution, inertia=inertia, nu_c=nu_c
    )


def light_restitution_factor(offset: Any) -> Any:
    """[Kim] eq. G 0th: G -> 1/cos^2(phi)."""
    (offset,) = checked(offset=offset)
    return 1 / sine_cosine(offset)[1] ** 2


def resistance(offset: Any, *, cue_mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """D = 1 + 1/Q0 + sin^2(phi)/nu, the denominator of the limits of speed and spin ([Kim] eq. Vf: 0)."""
    offset, cue, nu = checked(offset=offset, cue_mass_ratio=cue_mass_ratio, inertia=inertia)
    return 1 + 1 / cue + offset**2 / nu


def light_initial_impulse(offset: Any, *, cue_mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """[Kim] before eq. Vf: 0: p_0/(M U) -> cos^3(phi)/D."""
    (offset,) = checked(offset=offset)
    return sine_cosine(offset)[1] ** 3 / resistance(offset, cue_mass_ratio=cue_mass_ratio, inertia=inertia)


def ball_speed(offset: Any, *, cue_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4) -> Any:
    """[Kim] eq. Vf: 0: V/U = (1 + e)/D, along the cue."""
    (restitution,) = checked(restitution=restitution)
    return (1 + restitution) / resistance(offset, cue_mass_ratio=cue_mass_ratio, inertia=inertia)


def ball_spin(offset: Any, *, cue_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4) -> Any:
    """[Kim] eq. ROmega: 0: R Omega/U = sin(phi) (1 + e)/(nu D)."""
    offset, nu = checked(offset=offset, inertia=inertia)
    return offset / nu * ball_speed(offset, cue_mass_ratio=cue_mass_ratio, restitution=restitution, inertia=nu)


def largest_spin(*, cue_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4) -> Any:
    """[Kim] eq. Omega max: R Omega_max/U = (1 + e)/(2 sqrt(nu (1 + 1/Q0)))."""
    cue, restitution, nu = checked(cue_mass_ratio=cue_mass_ratio, restitution=restitution, inertia=inertia)
    return (1 + restitution) / (2 * np.sqrt(nu * (1 + 1 / cue)))


def offset_of_largest_spin(*, cue_mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """[Kim] after eq. Omega max: sin(phi_M) = sqrt(nu (1 + 1/Q0)); above 1 spin grows up to the edge."""
    cue, nu = checked(cue_mass_ratio=cue_mass_ratio, inertia=inertia)
    return np.sqrt(nu * (1 + 1 / cue))


def kinetic_energy(offset: Any, *, cue_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4) -> Any:
    """[Kim] sec. 5: the ball's energy over M U^2/2, ((1 + e)/D)^2 (1 + sin^2(phi)/nu)."""
    offset, nu = checked(offset=offset, inertia=inertia)
    speed = ball_speed(offset, cue_mass_ratio=cue_mass_ratio, restitution=restitution, inertia=nu)
    return speed**2 * (1 + offset**2 / nu)


def cue_speed(offset: Any, *, cue_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4) -> Any:
    """Derived from [Kim] eq. Vf: cue, first line: the cue's speed after the stroke over U, 1 - (1 + e)/(Q0 D)."""
    (cue,) = checked(cue_mass_ratio=cue_mass_ratio)
    return 1 - ball_speed(offset, cue_mass_ratio=cue, restitution=restitution, inertia=inertia) / cue


def light_cue_end_rotation(
    offset: Any, *, cue_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4, nu_c: Any = 1 / 3
) -> Any:
    """Derived from [Kim]'s omega_z, first line: r_c omega_z/U of the cue end as epsilon -> 0.

    [Kim]'s third line prints tan(phi) (1 + 1/Q0) where 1 + 1/Q0 belongs.
    """
    (nu_c,) = checked(nu_c=nu_c)
    cue_line = {"cue_mass_ratio": cue_mass_ratio, "inertia": inertia}
    slope = squirt_slope(offset, restitution=restitution, nu_c=nu_c, **cue_line)
    return -slope * ball_speed(offset, restitution=restitution, **cue_line) / nu_c


def cue_end_rotation(offset: Any, velocity: Any, *, cue_end_ratio: Any, nu_c: Any = 1 / 3) -> Any:
    """[Kim] omega_z, first line: r_c omega_z/U = (cos V_t - sin V_n)/(nu_c epsilon), velocity (t, n) over U."""
    offset, end, nu_c = checked(offset=offset, cue_end_ratio=cue_end_ratio, nu_c=nu_c)
    s, c = sine_cosine(offset)
    velocity = np.asarray(velocity, float)
    return (c * velocity[..., 0] - s * velocity[..., 1]) / (nu_c * end)


def _not_head_on(offset: Any) -> None:
    if not np.all(beside := np.not_equal(offset, 0)):
        where, _ = first_failure(beside)
        raise ValueError(f"offset must be in (-1, 1) without 0, a pole of this expansion; got 0{where}")
