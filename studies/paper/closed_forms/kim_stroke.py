"""[Kim]'s closed form of a stroke whose slip ends while the tip is still being compressed."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from cuefem.quantity.fields import sine_cosine
from studies.paper.closed_forms.arguments import checked, first_failure
from studies.paper.closed_forms.coefficients import Coefficients, critical_friction, lumped


def initial_impulse(beta: Coefficients, offset: Any) -> Any:
    """[Kim] eq. pc:ui: p_0/(M U) = m cos(phi)/(M (1 - gamma) beta_perp)."""
    (offset,) = checked(offset=offset)
    return beta.reduced_mass * sine_cosine(offset)[1] * beta.parallel / beta.determinant


def slip_impulse(beta: Coefficients, offset: Any, friction: Any) -> Any:
    """[Kim] eq. ps:v: p_s/(M U), the normal impulse when slip ends; inf where friction <= mu_c. Offsets >= 0."""
    offset, friction = checked(offset=offset, friction=friction)
    slowing = friction * beta.parallel - beta.cross
    usable = slowing > 0
    ends = beta.reduced_mass * offset / np.where(usable, slowing, 1.0)
    return np.where(offset == 0, 0.0, np.where(usable, ends, np.inf))[()]


def compression_impulse(beta: Coefficients, offset: Any) -> Any:
    """[Kim] eq. pc2: p_c/(M U), the normal impulse when compression ends, the tip sticking by then."""
    (offset,) = checked(offset=offset)
    s, c = sine_cosine(offset)
    return beta.reduced_mass * (c * beta.parallel + s * beta.cross) / beta.determinant


def restitution_factor(beta: Coefficients, offset: Any, friction: Any) -> Any:
    """[Kim] eq. G:res: G of v_perp(p_f) = -e G v_perp(0); nan if slip never ends.

    At least 1 where the closed form holds and m_e <= m_a. Written without 1/gamma, so that it is 1 head on and at m_e =
    m_a, where beta_x = 0.
    """
    offset, friction = checked(offset=offset, friction=friction)
    s, c = sine_cosine(offset)
    slowing = friction * beta.parallel - beta.cross
    lost = beta.determinant * beta.cross * (s / c) ** 2
    lost = lost / (beta.parallel**2 * np.where(slowing > 0, slowing, 1.0))
    square = (1 + critical_friction(beta) * s / c) ** 2 - lost
    holds = ((slowing > 0) | (s == 0)) & (square >= 0)
    return np.where(holds, np.sqrt(np.where(holds, square, 0.0)), np.nan)[()]


def restitution_bounds(beta: Coefficients, offset: Any) -> tuple[Any, Any]:
    """The derived bounds of G: sqrt(1 + mu_c tan phi) where p_s = p_c, 1 + mu_c tan phi where gamma = 1.

    [Kim] after eq. bound1 prints them for a rigid cue with nu_c set to nu. For m_e <= m_a; else they swap.
    """
    (offset,) = checked(offset=offset)
    s, c = sine_cosine(offset)
    upper = 1 + critical_friction(beta) * s / c
    return np.sqrt(upper), upper


def final_impulse(beta: Coefficients, offset: Any, *, restitution: Any, factor: Any) -> tuple[Any, Any]:
    """[Kim] eqs. pf parl2, pfpc3: (p_par, p_perp)/(M U) at separation, from e and G (``factor``)."""
    offset, restitution = checked(offset=offset, restitution=restitution)
    s, c = sine_cosine(offset)
    scale = beta.reduced_mass / beta.determinant
    rebound = c * (1 + restitution * factor)
    normal = scale * (rebound * beta.parallel + s * beta.cross)
    return scale * (rebound * beta.cross + s * beta.perpendicular), normal


def leaving_tangent(beta: Coefficients, offset: Any, *, restitution: Any, factor: Any) -> Any:
    """[Kim] eq. V:angle: tan theta = V_par/V_perp, theta between the ball's path and the normal of the contact."""
    tangential, normal = final_impulse(beta, offset, restitution=restitution, factor=factor)
    return tangential / normal


def squirt_tangent(
    offset: Any, *, cue_mass_ratio: Any, end_mass_ratio: Any, restitution: Any, factor: Any, inertia: Any = 0.4
) -> Any:
    """Tan(psi), psi = phi - theta ([Kim] eq. squirt:psi), as a ratio of sums of positive terms.

    The cross and dot products of cue line and impulse, simplified: nothing cancels as m_e -> 0, and friction enters
    through G (``factor``) alone. At e = 0 this is [A.31].
    """
    offset, cue, end, restitution, nu = checked(
        offset=offset,
        cue_mass_ratio=cue_mass_ratio,
        end_mass_ratio=end_mass_ratio,
        restitution=restitution,
        inertia=inertia,
    )
    s, c = sine_cosine(offset)
    rebound = restitution * factor
    above = s * c * (1 / nu + rebound * (1 + 1 / nu + 1 / cue))
    return above / ((1 + rebound) * c**2 * (1 + 1 / nu + 1 / end) + s**2 * (1 + 1 / end))


class Impulses(NamedTuple):
    """Impulses per unit cue speed, kg (N s per m/s): normal when slip ends (p_s), when compression ends (p_c) and at
    separation (p_f), and the tangential one at separation."""

    slip: Any
    compression: Any
    final: Any
    tangential: Any


class ClosedForm(NamedTuple):
    """A stroke by [Kim]'s closed form, per unit cue speed U.

    squirt: rad. velocity: (t, n) of the ball over U, on the last axis. spin: R Omega/U. cue_speed: along the cue, over
    U. impulses: kg. restitution_factor: G. critical_friction: mu_c of the struck side. Squirt, spin, V_t and the
    tangential impulse are odd in the offset, the rest even.
    """

    squirt: Any
    velocity: Any
    spin: Any
    cue_speed: Any
    impulses: Impulses
    restitution_factor: Any
    critical_friction: Any


def closed_form(
    offset: Any,
    *,
    mass: Any,
    end_mass: Any,
    ball_mass: Any = 0.210,
    inertia: Any = 0.4,
    restitution: Any = 0.75,
    friction: Any = 0.7,
) -> ClosedForm:
    """[Kim]'s stroke of a lumped cue ([Kim] secs. 3 and 4, derived forms).

    offset: b/R in (-1, 1), negative ones mirror. mass: of the cue along its axis, kg. end_mass: the effective end mass
    m_e, kg ([Kim]'s m_c enters as m_e = m_c nu_c/(1 + nu_c)). restitution: energetic e. friction: mu, inf allowed. All
    broadcast. Raises ValueError where the closed form is not valid: friction <= mu_c, slip that outlasts compression
    (p_s > p_c), or slip that reverses (mu_c < -mu, needs end_mass > mass).
    """
    offset, mass, end_mass, ball_mass, inertia, restitution, friction = checked(
        offset=offset,
        mass=mass,
        end_mass=end_mass,
        ball_mass=ball_mass,
        inertia=inertia,
        restitution=restitution,
        friction=friction,
    )
    side, distance = np.copysign(1.0, offset), np.abs(offset)
    ratios = {"cue_mass_ratio": mass / ball_mass, "end_mass_ratio": end_mass / ball_mass, "inertia": inertia}
    beta = lumped(distance, **ratios)
    slip, compression = slip_impulse(beta, distance, friction), compression_impulse(beta, distance)
    _refuse(beta, offset, friction, slip=slip, compression=compression)
    factor = restitution_factor(beta, distance, friction)
    tangential, final = final_impulse(beta, distance, restitution=restitution, factor=factor)
    tangent = squirt_tangent(distance, restitution=restitution, factor=factor, **ratios)
    s, c = sine_cosine(distance)
    return ClosedForm(
        side * np.arctan(tangent),
        np.stack(np.broadcast_arrays(side * tangential, final), axis=-1),
        side * tangential / inertia,
        1 - (c * final + s * tangential) * ball_mass / mass,
        Impulses(*(p * ball_mass for p in (slip, compression, final, side * tangential))),
        factor,
        critical_friction(beta),
    )


def closed_form_holds(
    offset: Any, *, mass: Any, end_mass: Any, ball_mass: Any = 0.210, inertia: Any = 0.4, friction: Any = 0.7
) -> Any:
    """Whether `closed_form` is valid, elementwise: slip ends, no later than compression, and does not reverse."""
    offset, mass, end_mass, ball_mass, inertia, friction = checked(
        offset=offset, mass=mass, end_mass=end_mass, ball_mass=ball_mass, inertia=inertia, friction=friction
    )
    distance = np.abs(offset)
    beta = lumped(distance, cue_mass_ratio=mass / ball_mass, end_mass_ratio=end_mass / ball_mass, inertia=inertia)
    in_time = slip_impulse(beta, distance, friction) <= compression_impulse(beta, distance)
    return in_time & (-critical_friction(beta) <= friction)


def _refuse(beta: Coefficients, offset: Any, friction: Any, *, slip: Any, compression: Any) -> None:
    limit = critical_friction(beta)
    if not np.all(finite := np.isfinite(slip)):
        where, (mu, low, b) = first_failure(finite, friction, limit, offset)
        raise ValueError(
            f"closed_form: friction must be > mu_c = {low:.6g} for slip to end at offset {b:.6g}; got {mu:.6g}{where}"
        )
    if not np.all(in_time := slip <= compression):
        where, (late, most, mu, b) = first_failure(in_time, slip, compression, friction, offset)
        raise ValueError(
            f"closed_form: slip must end in compression, p_s <= p_c = {most:.6g} M U; got p_s = {late:.6g} M U "
            f"with friction {mu:.6g} at offset {b:.6g}{where}"
        )
    if not np.all(grips := -limit <= friction):
        where, (mu, low, b) = first_failure(grips, friction, limit, offset)
        raise ValueError(
            f"closed_form: friction must be >= -mu_c = {-low:.6g} or slip reverses at offset {b:.6g}; "
            f"got {mu:.6g}{where}"
        )
