"""Warnings for numbers in the wrong unit: implausible in SI units, plausible in mm, g or ms.

A field with a typical range is checked when its object is made. Other implausible numbers cause no warning: scenes may
be scaled, and limits taken (a dome of one metre is nearly flat).
"""

from __future__ import annotations

import math
import sys
import traceback
import warnings
from pathlib import Path
from typing import Any

from cuefem.quantity.units import conversion_factor


class PlausibilityWarning(UserWarning):
    """Warning for a number that looks like one in another unit: all numbers in Python are in SI units.

    If warnings are errors, `warnings.filterwarnings("ignore", category=cuefem.PlausibilityWarning)` accepts such
    numbers.

    Examples
    --------
    >>> import warnings
    >>> import cuefem as cf
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     dome = cf.TipDome(9.5)
    >>> print(caught[0].message)
    TipDome.radius is 9.5 m, which no cue has: is it 9.5 mm? Write 0.0095 (m)
    """


class DrawingWarning(PlausibilityWarning):
    """Warning for a drawing's file that may not say what it means, such as a column that is not used."""


CUE_LENGTH, CUE_DIAMETER = (0.3, 1.6), (0.0075, 0.04)  # m, of drawings of real cues
# Common units by the SI unit of a field.
COMMON_UNITS = {"m": ("mm", "in"), "kg": ("g", "oz"), "s": ("ms", "us"), "Pa": ("GPa", "MPa"), "kg/m^3": ("g/cm^3",)}
# Of `numpy.errstate` where results are computed: an overflow, as by a wrong unit, is an error and never a number.
FLOAT_ERRORS: Any = {"over": "raise", "divide": "raise", "invalid": "raise"}
IMPLAUSIBLE_FACTOR = 5.0  # factor beyond the typical range from which a number is implausible
MIN_CUE_MASS = 0.25  # kg, of a whole cue: a child's
SHAFT_LENGTH = (0.3, 1.2)  # m, of a shaft in real size: a scale model causes no warning
_PACKAGE = str(Path(__file__).parents[1])


def unit_hint(name: str, value: float, unit: str, typical_range: tuple[float, float]) -> str:
    """The warning for a number outside its typical range that lies inside it in another unit; "" otherwise."""
    least, most = typical_range
    if least / IMPLAUSIBLE_FACTOR <= value <= IMPLAUSIBLE_FACTOR * most or not math.isfinite(value):
        return ""
    scales = ((other, float(conversion_factor(other, unit))) for other in COMMON_UNITS.get(unit, ()))
    readings = {other: value * per for other, per in scales if least <= value * per <= most}
    units = " or ".join(f"{value:g} {other}" for other in readings)
    numbers = " or ".join(f"{number:.4g}" for number in readings.values())
    return f"{name} is {value:g} {unit}, which no cue has: is it {units}? Write {numbers} ({unit})" if readings else ""


def warn(message: str, category: type[PlausibilityWarning] = PlausibilityWarning) -> None:
    """Warn with a message, unless it is empty, at the line outside this package."""
    if message:
        warnings.warn(message, category, _level())


def warn_light_cue(mass: float, length: float) -> None:
    """Warn if a shaft in real size is struck without the rest of its cue."""
    if mass < MIN_CUE_MASS and SHAFT_LENGTH[0] <= length <= SHAFT_LENGTH[1]:
        text = f"Cue.body_mass is 0 kg, so the whole cue weighs {mass:.3g} kg; expected 0.4 to 0.7 kg: add the rest of "
        warn(f"{text}the cue (dataclasses.replace(cue, body_mass=0.43))")


def _level() -> int:
    """The stack level, for `warnings.warn` in `warn`, of the line that calls this package."""
    files = [frame.f_code.co_filename for frame, _ in traceback.walk_stack(sys._getframe())]
    last = max(i for i, file in enumerate(files) if file.startswith(_PACKAGE))
    is_generated = files[last + 1 : last + 2] == ["<string>"]  # a dataclass's own __init__
    return last + 1 + is_generated
