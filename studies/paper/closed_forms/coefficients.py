"""What the contact feels: [Kim]'s betas of a rigid, a two-part and any lumped cue, and the numbers made of them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from cuefem.quantity.fields import sine_cosine
from studies.paper.closed_forms.arguments import checked


class Coefficients(NamedTuple):
    """[Kim]'s betas: relative velocity of the contact over impulse, times m ([Kim] eq. dvdv).

    parallel, perpendicular, cross: beta_par = m B_tt, beta_perp = m B_nn, beta_x = -m B_tn. determinant: beta_par
    beta_perp - beta_x^2, added up from positive terms so that nothing cancels as the end mass falls. reduced_mass: the
    m of these betas over the ball's mass M. All broadcast.
    """

    parallel: Any
    perpendicular: Any
    cross: Any
    determinant: Any
    reduced_mass: Any


def lumped(offset: Any, *, cue_mass_ratio: Any, end_mass_ratio: Any, inertia: Any = 0.4) -> Coefficients:
    """Coefficients of any lumped cue, with m the ball's mass.

    offset: b/R in (-1, 1); cue_mass_ratio: m_a/M, the cue's mass along its axis; end_mass_ratio: m_e/M, its effective
    end mass; inertia: nu of the ball. Source: handbook: Inverse mass (B = B_ball + u u/m_a + w w/m_e).
    """
    offset, cue, end, nu = checked(
        offset=offset, cue_mass_ratio=cue_mass_ratio, end_mass_ratio=end_mass_ratio, inertia=inertia
    )
    s, c = sine_cosine(offset)
    along, across = 1 / cue, 1 / end
    ball = 1 + 1 / nu  # the ball's inverse mass along t; along n it is 1
    seen_t, seen_n = s**2 * along + c**2 * across, c**2 * along + s**2 * across
    determinant = ball + ball * seen_n + seen_t + along * across
    return Coefficients(ball + seen_t, 1 + seen_n, s * c * (across - along), determinant, 1.0)


def rigid(offset: Any, *, cue_mass_ratio: Any, inertia: Any = 0.4, nu_c: Any = 0.136) -> Coefficients:
    """[Kim] eq. beta:r: coefficients of a rigid cue, Q0 = M_c/M, I_c = nu_c M_c r_c^2; m = M M_c/(M + M_c)."""
    cue, nu_c = checked(cue_mass_ratio=cue_mass_ratio, nu_c=nu_c)
    free = lumped(offset, cue_mass_ratio=cue, end_mass_ratio=cue * nu_c / (1 + nu_c), inertia=inertia)
    return _scaled(free, cue / (1 + cue))


def two_part(
    offset: Any, *, cue_mass_ratio: Any, cue_end_ratio: Any, inertia: Any = 0.4, nu_c: Any = 1 / 3
) -> Coefficients:
    """[Kim] sec. 4, beta': a cue end of mass m_c = epsilon M on a body that only pushes; m = M m_c/(M + m_c).

    cue_mass_ratio: Q0 = M_c/M, whole cue; cue_end_ratio: epsilon = m_c/M (not the m_e = m_c nu_c/(1 + nu_c) felt at
    the tip); nu_c: inertia factor of the cue end.
    """
    end, nu_c = checked(cue_end_ratio=cue_end_ratio, nu_c=nu_c)
    felt = end * nu_c / (1 + nu_c)
    free = lumped(offset, cue_mass_ratio=cue_mass_ratio, end_mass_ratio=felt, inertia=inertia)
    return _scaled(free, end / (1 + end))


def _scaled(free: Coefficients, m: Any) -> Coefficients:
    return Coefficients(free.parallel * m, free.perpendicular * m, free.cross * m, free.determinant * m**2, m)


def gamma(beta: Coefficients) -> Any:
    """[Kim] eq. gamma:beta: gamma = beta_x^2/(beta_par beta_perp), in [0, 1)."""
    return beta.cross**2 / (beta.parallel * beta.perpendicular)


def one_minus_gamma(beta: Coefficients) -> Any:
    """1 - gamma = det B/(B_tt B_nn), accurate however light the cue end is ([Kim] eq. gamma:beta)."""
    return beta.determinant / (beta.parallel * beta.perpendicular)


def critical_friction(beta: Coefficients) -> Any:
    """[Kim] eq. mu:cond1: mu_c = beta_x/beta_par, the ratio of the forces while the tip sticks."""
    return beta.cross / beta.parallel


def jam_friction(beta: Coefficients) -> Any:
    """[Kim] eq. mu:cond: mu_c/gamma = beta_perp/beta_x, above which slip presses the tip in (jam); inf if it cannot.

    Stated for offsets >= 0; a cue that can jam there has m_e < m_a.
    """
    cross = np.asarray(beta.cross, float)
    safe = np.where(cross > 0, cross, 1.0)
    return np.where(cross > 0, beta.perpendicular / safe, np.inf)[()]
