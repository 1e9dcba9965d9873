"""Closed forms of the papers that results need: squirt [A.31], natural pivot length [B.1], mass of [Kim]'s cue end.

All others are in studies/paper/closed_forms.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cuefem.quantity.fields import sine_cosine
from cuefem.scene import Scene


def cue_end_mass(end_mass: Any, nu_c: Any = 1 / 3) -> Any:
    """[Kim]'s m_c = m_e (1 + nu_c)/nu_c, kg. end_mass: m_e, kg. nu_c: inertia factor of the cue end."""
    return end_mass * (1 + nu_c) / nu_c


def alciatore_a31(offset: Any, *, mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """[A.31]: squirt psi, rad, of a tip that sticks and separates at the ball's transverse speed; mass_ratio: M/m_e.

    tan psi = (s c/nu)/(1 + M/m_e + c^2/nu), s = sin phi = b/R and c = cos phi: [Kim]'s law at e = 0.
    """
    s, c = sine_cosine(offset)
    return np.arctan(s * c / inertia / (1 + mass_ratio + c**2 / inertia))


def alciatore_a31_mass_ratio(offset: Any, squirt: Any, *, inertia: Any = 0.4) -> Any:
    """The M/m_e at which `alciatore_a31` is ``squirt``, rad, for simulators that use [A.31].

    ValueError if no end mass in (0, inf) has it: head-on, and at or beyond the squirt of an infinite end mass.
    """
    s, c = sine_cosine(offset)
    tangent = np.tan(squirt)
    ratio = s * c / inertia / np.where(tangent == 0, np.nan, tangent) - 1 - c**2 / inertia
    if not np.all(ratio > 0):
        raise ValueError(
            "squirt must be of its offset's sign and less than that of an infinite end mass in [A.31]; "
            f"got {squirt} rad at offset {offset}"
        )
    return ratio[()]


def natural_pivot_length(offset: Any, squirt: Any, *, radius: Any, dome_radius: Any = 0.0) -> Any:
    """[B.1]: distance from the end of the tip to the bridge about which pivoting the cue cancels squirt, m.

    p = (R + r) b/(R sin psi) - R; radius R of the ball, dome_radius r of the tip (0: its curvature is neglected), both
    in m. Infinite without squirt; negative for squirt towards the struck side.
    """
    sin_squirt = np.copysign(1.0, offset) * np.sin(squirt)  # positive away from the struck side
    no_squirt = sin_squirt == 0
    axis = (radius + dome_radius) * np.abs(offset)  # distance of the cue's axis from the ball's centre
    return np.where(no_squirt, np.inf, axis / np.where(no_squirt, 1.0, sin_squirt) - radius)[()]


def pivot_length(scene: Scene, squirt: Any, offset: Any = None) -> Any:
    """The natural pivot length of a squirt, m, at an offset b/R or at the scene's own.

    A head-on stroke has none: None at one offset, nan in an array of them.
    """
    offset = scene.stroke.offset if offset is None else offset
    if np.ndim(offset) == 0 and offset == 0:
        return None
    length = natural_pivot_length(offset, squirt, radius=scene.ball.radius, dome_radius=scene.dome_radius)
    return np.where(np.equal(offset, 0.0), np.nan, length)[()]
