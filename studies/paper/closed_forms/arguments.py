"""The quantities that the closed forms take, checked in one place."""

from __future__ import annotations

from typing import Any

from cuefem.quantity.fields import Quantity

_OFFSET, _RATIO = Quantity("", "(-1, 1)"), Quantity("", "(0, inf)")
_QUANTITIES = {
    "offset": _OFFSET,
    "mass": Quantity("kg", "(0, inf)"),
    "end_mass": Quantity("kg", "(0, inf)"),
    "ball_mass": Quantity("kg", "(0, inf)"),
    "shaft_mass": Quantity("kg", "(0, inf)"),
    "cue_mass_ratio": _RATIO,
    "end_mass_ratio": _RATIO,
    "cue_end_ratio": _RATIO,
    "mass_ratio": Quantity("", "[0, inf)"),
    "inertia": Quantity("", "(0, 1]"),
    "nu_c": _RATIO,
    "restitution": Quantity("", "[0, 1]"),
    "friction": Quantity("", "[0, inf]"),
    "squirt": Quantity("rad", "(-1.5707963267948966, 1.5707963267948966)"),
    "radius": Quantity("m", "(0, inf)"),
    "dome_radius": Quantity("m", "[0, inf)"),
    "tip_radius": Quantity("m", "[0, inf)"),
    "base_radius": Quantity("m", "(0, inf)"),
    "butt_radius": Quantity("m", "(0, inf)"),
    "end_length": Quantity("m", "(0, inf)"),
    "length": Quantity("m", "(0, inf)"),
}


def checked(**values: Any) -> tuple[Any, ...]:
    """The values as floats or float arrays, in the order given; ValueError names field, bound, unit and value."""
    return tuple(_QUANTITIES[name].check_all(name, value) for name, value in values.items())
