"""The quantities that the closed forms take, checked in one place."""

from __future__ import annotations

from typing import Any

import numpy as np

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
    for name, value in values.items():
        bounds = _QUANTITIES[name]
        if not np.all(inside := bounds.contains(np.asarray(value, float))):
            where, (found,) = first_failure(inside, value)
            raise ValueError(f"{name} must be in {bounds.bounds}; got {found}{where}")
    return tuple(np.array(value, dtype=float) for value in values.values())


def first_failure(holds: Any, *values: Any) -> tuple[str, tuple[float, ...]]:
    """Where ``holds`` is false first (" at index 3", "" for a single stroke), and the values there."""
    holds, *spread = np.broadcast_arrays(holds, *values)
    index = tuple(int(i) for i in np.argwhere(~holds)[0])
    where = f" at index {index if len(index) > 1 else index[0]}" if index else ""
    return where, tuple(float(v[index]) for v in spread)
