"""Where a stroke slips to its end: friction needed at an offset, and the largest offset at a friction."""

from __future__ import annotations

from typing import Any

import numpy as np

from cuefem.quantity.fields import sine_cosine
from studies.paper.closed_forms.arguments import checked
from studies.paper.closed_forms.coefficients import Coefficients


def miscue_friction(beta: Coefficients, offset: Any, *, restitution: Any) -> Any:
    """Friction at or below which the tip slips to the end: a miscue. Offsets >= 0.

    Slip that lasts meets separation at (1 + e) times its own compression impulse, so mu = (tan beta_perp + (1 + e)
    beta_x)/((1 + e) beta_par + tan beta_x). Refines [Kim] sec. 1 (mu >= tan phi), which it becomes as m_e -> 0.
    """
    offset, restitution = checked(offset=offset, restitution=restitution)
    s, c = sine_cosine(offset)
    rebound = 1 + restitution
    above = s * beta.perpendicular + rebound * c * beta.cross
    return above / (rebound * c * beta.parallel + s * beta.cross)


def compression_stick_friction(offset: Any, *, end_mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """Friction from which slip ends in compression (p_s <= p_c): tan(phi) (1 + M/m_e)/(1 + 1/nu + M/m_e).

    [Kim] eq. cond:stick, which has the wrong sense in a jam, solved for friction; independent of e and Q0.
    """
    offset, end, nu = checked(offset=offset, end_mass_ratio=end_mass_ratio, inertia=inertia)
    s, c = sine_cosine(offset)
    return s / c * (1 + 1 / end) / (1 + 1 / nu + 1 / end)


def miscue_offset(
    friction: Any, *, cue_mass_ratio: Any, end_mass_ratio: Any, restitution: Any = 0.75, inertia: Any = 0.4
) -> Any:
    """Largest b/R before the first miscue at a finite ``friction``; [Kim]'s own limit is sin(atan(mu)).

    The condition of `miscue_friction` is a cubic in tan(phi); its least positive root, as an eigenvalue of the
    companion matrix, is good to 1e-13. Broadcasts.
    """
    friction, cue, end, restitution, nu = checked(
        friction=friction,
        cue_mass_ratio=cue_mass_ratio,
        end_mass_ratio=end_mass_ratio,
        restitution=restitution,
        inertia=inertia,
    )
    if not np.all(np.isfinite(friction)):
        raise ValueError("friction must be in [0, inf) here; got inf, with which no stroke is a miscue")
    ball, along, across = 1 + 1 / nu, 1 / cue, 1 / end
    third = 1 + across
    second = -friction * (ball * (1 + restitution) + across + restitution * along)
    first = 1 + across + restitution * (across - along)
    constant = -friction * (1 + restitution) * (ball + across)
    tangent = _least_positive_root(*np.broadcast_arrays(third, second, first, constant))
    return (tangent / np.sqrt(1 + tangent**2))[()]


def _least_positive_root(a: Any, b: Any, c: Any, d: Any) -> Any:
    companion = np.zeros((*np.shape(a), 3, 3))
    companion[..., 1, 0] = companion[..., 2, 1] = 1
    companion[..., 0, 2], companion[..., 1, 2], companion[..., 2, 2] = -d / a, -c / a, -b / a
    roots = np.linalg.eigvals(companion)
    real = np.abs(roots.imag) <= 1e-7 * np.abs(roots)
    least = np.where(real & (roots.real >= 0), roots.real, np.inf).min(axis=-1)
    return np.where(d == 0, 0.0, least)
