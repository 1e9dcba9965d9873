"""A light cue end: [Kim]'s expansions to first order in epsilon = m_c/M, and the limits epsilon -> 0.

Throughout: offset b/R in (-1, 1), cue_mass_ratio Q0 = M_c/M, cue_end_ratio epsilon = m_c/M, inertia nu of the ball,
nu_c of the cue end, restitution e; all broadcast.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cuefem.quantity.fields import sine_cosine
from studies.paper.closed_forms.arguments import checked


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


def resistance(offset: Any, *, cue_mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """D = 1 + 1/Q0 + sin^2(phi)/nu, the denominator of the limits of speed and spin ([Kim] eq. Vf: 0)."""
    offset, cue, nu = checked(offset=offset, cue_mass_ratio=cue_mass_ratio, inertia=inertia)
    return 1 + 1 / cue + offset**2 / nu


def ball_speed(offset: Any, *, cue_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4) -> Any:
    """[Kim] eq. Vf: 0: V/U = (1 + e)/D, along the cue."""
    (restitution,) = checked(restitution=restitution)
    return (1 + restitution) / resistance(offset, cue_mass_ratio=cue_mass_ratio, inertia=inertia)


def largest_spin(*, cue_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4) -> Any:
    """[Kim] eq. Omega max: R Omega_max/U = (1 + e)/(2 sqrt(nu (1 + 1/Q0)))."""
    cue, restitution, nu = checked(cue_mass_ratio=cue_mass_ratio, restitution=restitution, inertia=inertia)
    return (1 + restitution) / (2 * np.sqrt(nu * (1 + 1 / cue)))


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
