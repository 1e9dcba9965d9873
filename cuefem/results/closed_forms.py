"""The papers' formulas that results need: Alciatore's [A.31], the natural pivot length [B.1] and [Kim]'s cue end.

The other closed forms are in studies/paper/closed_forms.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cuefem.quantity.fields import Quantity, first_failure, sine_cosine
from cuefem.scene import Scene

_OFFSET, _POSITIVE = Quantity("", "(-1, 1)"), "(0, inf)"
_QUANTITIES = {
    "offset": _OFFSET,
    "mass_ratio": Quantity("", "[0, inf)"),
    "inertia": Quantity("", "(0, 1]"),
    "squirt": Quantity("rad", "(-1.5707963267948966, 1.5707963267948966)"),
    "radius": Quantity("m", _POSITIVE),
    "dome_radius": Quantity("m", "[0, inf)"),
    "end_mass": Quantity("kg", _POSITIVE),
    "nu_c": Quantity("", _POSITIVE),
}


def _checked(**values: Any) -> tuple[Any, ...]:
    """The values as floats or float arrays, in the order given; ValueError names field, bound, unit and value."""
    return tuple(_QUANTITIES[name].check_all(name, value) for name, value in values.items())


def cue_end_mass(end_mass: Any, nu_c: Any = 1 / 3) -> Any:
    """[Kim]'s m_c = m_e (1 + nu_c)/nu_c, kg, of the effective end mass m_e."""
    end_mass, nu_c = _checked(end_mass=end_mass, nu_c=nu_c)
    return end_mass * (1 + nu_c) / nu_c


def alciatore_a31(offset: Any, *, mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """[A.31]: squirt, rad, of a tip that sticks and leaves with the ball's transverse speed; mass_ratio M/m_e.

    tan psi = (sin cos/nu)/(1 + M/m_e + cos^2/nu), b/R = sin(phi) of the contact: [Kim]'s law at e = 0.
    """
    offset, ratio, nu = _checked(offset=offset, mass_ratio=mass_ratio, inertia=inertia)
    s, c = sine_cosine(offset)
    return np.arctan(s * c / nu / (1 + ratio + c**2 / nu))


def alciatore_a31_mass_ratio(offset: Any, squirt: Any, *, inertia: Any = 0.4) -> Any:
    """The M/m_e with which `alciatore_a31` gives the squirt ``squirt``, rad: simulators that use [A.31] need it.

    ValueError if no end mass in (0, inf) has it: head-on, and at or beyond the squirt of an infinite end mass.
    """
    offset, squirt, nu = _checked(offset=offset, squirt=squirt, inertia=inertia)
    s, c = sine_cosine(offset)
    tangent = np.tan(squirt)
    ratio = s * c / nu / np.where(tangent == 0, np.nan, tangent) - 1 - c**2 / nu
    if not np.all(positive := ratio > 0):
        where, (b, psi) = first_failure(positive, offset, squirt)
        raise ValueError(
            "squirt must be of its offset's sign and less than that of an infinite end mass in [A.31]; "
            f"got {psi:.6g} rad at offset {b:.6g}{where}"
        )
    return ratio[()]


def axis_offset(offset: Any, *, radius: Any, dome_radius: Any) -> Any:
    """[B.1]: distance of the cue's axis from the ball's centre, m, of a contact at ``offset``: (R + r) b/R."""
    offset, radius, dome_radius = _checked(offset=offset, radius=radius, dome_radius=dome_radius)
    return (radius + dome_radius) * offset


def natural_pivot_length(offset: Any, squirt: Any, *, radius: Any, dome_radius: Any = 0.0) -> Any:
    """[B.1]: distance from the tip to the bridge about which pivoting the cue cancels squirt, m.

    p = (R + r) b/(R sin psi) - R; radius R of the ball, dome_radius r of the tip (0: its curvature is neglected).
    Infinite without squirt; ValueError at offset 0, where no pivot is defined.
    """
    offset, squirt, radius, dome_radius = _checked(offset=offset, squirt=squirt, radius=radius, dome_radius=dome_radius)
    if not np.all(beside := np.not_equal(offset, 0)):
        where, _ = first_failure(beside)
        raise ValueError(f"offset must be in (-1, 1) without 0, where no pivot is defined; got 0{where}")
    aside = np.abs(axis_offset(offset, radius=radius, dome_radius=dome_radius))
    turned = np.copysign(1.0, offset) * np.sin(squirt)
    straight = turned == 0
    return np.where(straight, np.inf, aside / np.where(straight, 1.0, turned) - radius)[()]


def pivot_length(scene: Scene, squirt: Any) -> Any:
    """The natural pivot length of a squirt, m; None for a head-on stroke, which has none."""
    if not np.all(scene.stroke.offset):
        return None
    return pivot_at(scene, scene.stroke.offset, squirt)


def pivot_at(scene: Scene, offset: Any, squirt: Any) -> Any:
    """The same at another offset b/R than the scene's own."""
    return natural_pivot_length(offset, squirt, radius=scene.ball.radius, dome_radius=scene.dome_radius)
