"""Geometry of the cue end ([Kim] sec. 4): the first piece of a cone, its mass, centre of mass and inertia factor."""

from __future__ import annotations

from typing import Any

from studies.paper.closed_forms.arguments import checked


def base_radius(end_length: Any, *, length: Any, tip_radius: Any, butt_radius: Any) -> Any:
    """Radius a of a conical shaft at ``end_length`` from the tip, m ([Kim] after eq. cue end)."""
    part, length, tip, butt = checked(
        end_length=end_length, length=length, tip_radius=tip_radius, butt_radius=butt_radius
    )
    return tip + (butt - tip) * part / length


def full_cone_length(end_length: Any, *, tip_radius: Any, base_radius: Any) -> Any:
    """Length of the pointed cone that the cue end is cut from, m ([Kim] after eq. cue end); base wider than tip."""
    part, tip, base = checked(end_length=end_length, tip_radius=tip_radius, base_radius=base_radius)
    if not (tip < base):
        raise ValueError(f"tip_radius must be in [0, {base}) m, the base's; got {tip}")
    return part * base / (base - tip)


def volume_ratio(end_length: Any, *, length: Any, tip_radius: Any, butt_radius: Any) -> Any:
    """Volume of the cue end over that of the conical shaft ([Kim] before eq. cue end)."""
    part, length, tip, butt = checked(
        end_length=end_length, length=length, tip_radius=tip_radius, butt_radius=butt_radius
    )
    base = base_radius(part, length=length, tip_radius=tip, butt_radius=butt)
    return part / length * _moment(0, tip, base) / _moment(0, tip, butt)


def cone_end_mass(end_length: Any, *, shaft_mass: Any, length: Any, tip_radius: Any, butt_radius: Any) -> Any:
    """[Kim] eq. cue end: m_c, kg, the shaft's mass times the volume ratio."""
    (shaft_mass,) = checked(shaft_mass=shaft_mass)
    return shaft_mass * volume_ratio(end_length, length=length, tip_radius=tip_radius, butt_radius=butt_radius)


def centre_of_mass(*, tip_radius: Any, base_radius: Any) -> Any:
    """[Kim] after eq. cue end: distance of the cue end's centre of mass from its base, over its length.

    (a^2 + 2 a b + 3 b^2)/(4 (a^2 + a b + b^2)), base radius a, tip radius b; the tip lies 1 minus this away (r_c/l).
    """
    tip, base = checked(tip_radius=tip_radius, base_radius=base_radius)
    return _moment(1, base, tip) / _moment(0, base, tip)


def inertia_factor(*, tip_radius: Any, base_radius: Any, end_length: Any = None) -> Any:
    """nu_c = I_c/(m_c r_c^2) of a cone, r_c from the tip to its centre of mass ([Kim] after eq. cue end: 1/3, a rod).

    With ``end_length`` (m) the rotary inertia of its sections counts too.
    """
    tip, base = checked(tip_radius=tip_radius, base_radius=base_radius)
    volume, first, second = (_moment(k, tip, base) for k in range(3))
    centre = first / volume
    spread = second / volume - centre**2
    if end_length is not None:
        (end_length,) = checked(end_length=end_length)
        taper = base - tip
        fourth = tip**4 + 2 * tip**3 * taper + 2 * tip**2 * taper**2 + tip * taper**3 + taper**4 / 5
        spread = spread + fourth / (4 * volume * end_length**2)
    return spread / centre**2


def _moment(power: int, first: Any, last: Any) -> Any:
    """Integral over x in (0, 1) of x^power times the square of a radius that runs linearly from first to last."""
    step = last - first
    return first**2 / (power + 1) + 2 * first * step / (power + 2) + step**2 / (power + 3)
