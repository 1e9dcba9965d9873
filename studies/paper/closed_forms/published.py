"""Formulas of other authors: [Shepard], Alciatore's [A.30], [A.31], [B.1]; and what "b" each of them means."""

from __future__ import annotations

from typing import Any

import numpy as np

from cuefem.quantity.fields import sine_cosine
from studies.paper.closed_forms.arguments import checked


def alciatore_a30(offset: Any, *, mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """[A.30]: ball speed over cue speed of an elastic stroke, 2/(1 + M/M_c + (b/R)^2/nu); mass_ratio M/M_c."""
    offset, ratio, nu = checked(offset=offset, mass_ratio=mass_ratio, inertia=inertia)
    return 2 / (1 + ratio + offset**2 / nu)


def shepard(offset: Any, *, mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """[Shepard] as [Kim] prints it: squirt, rad, with b/R measured to the force's line; mass_ratio M/m_e.

    tan psi = (sin cos/nu)/(1 + M/m_e + sin^2/nu): [A.31] exactly, once `contact_offset` has turned b into the
    contact's.
    """
    offset, ratio, nu = checked(offset=offset, mass_ratio=mass_ratio, inertia=inertia)
    s, c = sine_cosine(offset)
    return np.arctan(s * c / nu / (1 + ratio + s**2 / nu))


def force_line_offset(offset: Any, squirt: Any) -> Any:
    """b'/R = sin(phi - psi): how far the line of the force, the ball's path, passes from the ball's centre."""
    offset, squirt = checked(offset=offset, squirt=squirt)
    return np.sin(np.arcsin(offset) - squirt)


def contact_offset(force_line_offset: Any, squirt: Any) -> Any:
    """b/R = sin(phi' + psi) of the contact, from the offset b'/R = sin(phi') of the line of the force."""
    offset, squirt = checked(force_line_offset=force_line_offset, squirt=squirt)
    return np.sin(np.arcsin(offset) + squirt)
