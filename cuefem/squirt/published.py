"""Formulas of other authors: [Shepard], Alciatore's [A.30], [A.31], [B.1]; and what "b" each of them means."""

from __future__ import annotations

from typing import Any

import numpy as np

from cuefem.squirt.arguments import checked, first_failure, sine_cosine


def alciatore_a30(offset: Any, *, mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """[A.30]: ball speed over cue speed of an elastic stroke, 2/(1 + M/M_c + (b/R)^2/nu); mass_ratio M/M_c."""
    offset, ratio, nu = checked(offset=offset, mass_ratio=mass_ratio, inertia=inertia)
    return 2 / (1 + ratio + offset**2 / nu)


def alciatore_a31(offset: Any, *, mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """[A.31]: squirt, rad, of a tip that sticks and keeps the ball's transverse speed; mass_ratio M/m_e.

    tan psi = (sin cos/nu)/(1 + M/m_e + cos^2/nu), b/R = sin(phi) of the contact: [Kim]'s law at e = 0.
    """
    offset, ratio, nu = checked(offset=offset, mass_ratio=mass_ratio, inertia=inertia)
    s, c = sine_cosine(offset)
    return np.arctan(s * c / nu / (1 + ratio + c**2 / nu))


def alciatore_a31_mass_ratio(offset: Any, squirt: Any, *, inertia: Any = 0.4) -> Any:
    """The M/m_e with which `alciatore_a31` gives the squirt ``squirt``, rad: simulators that use [A.31] need it.

    ValueError if no end mass in (0, inf) has it: head on, and at or beyond the squirt of an infinite end mass.
    """
    offset, squirt, nu = checked(offset=offset, squirt=squirt, inertia=inertia)
    s, c = sine_cosine(offset)
    tangent = np.tan(squirt)
    ratio = s * c / nu / np.where(tangent == 0, np.nan, tangent) - 1 - c**2 / nu
    if not np.all(positive := ratio > 0):
        where, (b, psi) = first_failure(positive, offset, squirt)
        raise ValueError(
            "squirt must be of its offset's sign and less than that of an endless end mass in [A.31]; "
            f"got {psi:.6g} rad at offset {b:.6g}{where}"
        )
    return ratio[()]


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


def axis_offset(offset: Any, *, radius: Any, dome_radius: Any) -> Any:
    """[B.1]: distance of the cue's axis from the ball's centre, m, of a contact at ``offset``: (R + r) b/R."""
    offset, radius, dome_radius = checked(offset=offset, radius=radius, dome_radius=dome_radius)
    return (radius + dome_radius) * offset


def natural_pivot_length(offset: Any, squirt: Any, *, radius: Any, dome_radius: Any = 0.0) -> Any:
    """[B.1]: distance from tip to the bridge about which turning the cue undoes squirt, m.

    p = (R + r) b/(R sin psi) - R; radius R of the ball, dome_radius r of the tip (0: its curvature is left out).
    Infinite without squirt; ValueError at offset 0, where every bridge will do.
    """
    offset, squirt, radius, dome_radius = checked(offset=offset, squirt=squirt, radius=radius, dome_radius=dome_radius)
    if not np.all(beside := np.not_equal(offset, 0)):
        where, _ = first_failure(beside)
        raise ValueError(f"offset must be in (-1, 1) without 0, where no pivot is defined; got 0{where}")
    aside = np.abs(axis_offset(offset, radius=radius, dome_radius=dome_radius))
    turned = np.copysign(1.0, offset) * np.sin(squirt)
    straight = turned == 0
    return np.where(straight, np.inf, aside / np.where(straight, 1.0, turned) - radius)[()]
