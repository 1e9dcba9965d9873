"""The units in which quantities are displayed, and every quantity as text: the one place where SI numbers get units.

A process displays metric units or those of the United States; files (TOML, CSV, JSON) are metric or SI in both.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from functools import lru_cache, wraps
from types import MappingProxyType
from typing import Any, NamedTuple, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from cuefem.quantity.units import conversion_factor

P = ParamSpec("P")
R = TypeVar("R")


class DisplayUnit(NamedTuple):
    """A display unit: its numbers per SI unit, its name, and its decimals, or None for those of the quantity."""

    factor: float
    name: str
    decimals: int | None = None

    @classmethod
    def of(cls, unit: str, name: str, decimals: int | None = None) -> DisplayUnit:
        """The display unit of an SI unit, by the table of units."""
        return cls(1 / float(conversion_factor(name, unit)), name, decimals)


# Keys beside the SI units. Makers weigh cues in ounces, and state end masses and tips in grams everywhere; a distance
# off the line of aim grows with the distance to the ball aimed at. A wave runs at ft/s, a cue at mph;
# a computed distance, such as a pivot length, is known to a tenth of an inch at best, a drawn one to a thousandth.
END_MASS, OFF_LINE, WAVE_SPEED, DISTANCE = "kg of end mass", "m/m", "m/s of waves", "m of distance"
SHAFT_STIFFNESS = "N/m of a shaft"
POUND_FORCE = 4.4482216152605  # N
PSI = POUND_FORCE / 0.0254**2  # Pa
POUND_PER_CUBIC_FOOT = 0.45359237 / 0.3048**3  # kg/m3
_METRIC_NAMES = {"kg": "g", "m": "mm", "m/s": "m/s", "s": "ms", "rad": "°", "Pa": "GPa", "kg/m^3": "kg/m³"}
_US_NAMES = {"kg": ("oz", 2), "m": ("in", 3), "m/s": ("mph", 1)}
METRIC = MappingProxyType(
    {unit: DisplayUnit.of(unit, name) for unit, name in _METRIC_NAMES.items()}
    | {
        END_MASS: DisplayUnit.of("kg", "g"),
        OFF_LINE: DisplayUnit.of("m/m", "mm/m"),
        WAVE_SPEED: DisplayUnit.of("m/s", "m/s", 0),
        DISTANCE: DisplayUnit.of("m", "mm", 0),
        SHAFT_STIFFNESS: DisplayUnit(1.0, "N/m"),
        "J": DisplayUnit(1e3, "mJ"),
        "1/sqrt(kg)": DisplayUnit(1.0, "/√kg"),
    }
)
US = METRIC | {unit: DisplayUnit.of(unit, *name) for unit, name in _US_NAMES.items()}
US |= {
    OFF_LINE: DisplayUnit(48.0, "in/4 ft", 1),  # a usual shot
    WAVE_SPEED: DisplayUnit.of("m/s", "ft/s", -2),
    DISTANCE: DisplayUnit.of("m", "in", 1),
    "N/m": DisplayUnit(0.0254 / POUND_FORCE, "lbf/in"),
    SHAFT_STIFFNESS: DisplayUnit(0.0254 / POUND_FORCE, "lbf/in", 2),
    "N": DisplayUnit(1 / POUND_FORCE, "lbf", 0),
    "Pa": DisplayUnit(1e-6 / PSI, "×10⁶ psi"),
    "kg/m^3": DisplayUnit(1 / POUND_PER_CUBIC_FOOT, "lb/ft³", 1),
    "J": DisplayUnit(1 / (POUND_FORCE * 0.0254), "in·lbf"),
    "m/N": DisplayUnit(POUND_FORCE / 0.0254, "in/lbf"),
    "N s": DisplayUnit(1 / POUND_FORCE, "lbf·s"),
    "rad/s": DisplayUnit(30 / math.pi, "rpm", 0),
}
SYSTEMS = MappingProxyType({"metric": METRIC, "us": US})
_displayed = "metric"  # of this process: threads that compute a page's results write its texts too


def displayed_system() -> str:
    """The name of the units displayed: "metric" or "us"."""
    return _displayed


def display(system: str) -> None:
    """Display these units, "metric" or "us", from now on."""
    global _displayed
    SYSTEMS[system]
    _displayed = system


@contextmanager
def displayed_in(system: str) -> Iterator[None]:
    """Display these units, "metric" or "us", within a block."""
    before = _displayed
    display(system)
    try:
        yield
    finally:
        display(before)


def cached_by_units(maxsize: int) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """A cache of calls whose results have texts with units: a call in other display units is computed anew."""

    def decorated(call: Callable[P, R]) -> Callable[P, R]:
        @lru_cache(maxsize)
        def cached(system: str, *arguments: Any, **named: Any) -> R:
            return call(*arguments, **named)

        @wraps(call)
        def as_displayed(*arguments: P.args, **named: P.kwargs) -> R:
            return cached(_displayed, *arguments, **named)  # type: ignore[arg-type]  # of no known type

        as_displayed.cache_clear = cached.cache_clear  # type: ignore[attr-defined]
        return as_displayed

    return decorated


def display_unit(unit: str) -> DisplayUnit:
    """The display unit of an SI unit; the SI unit itself if it has none."""
    return SYSTEMS[_displayed].get(unit) or DisplayUnit(1.0, unit)


def to_display(values: Any, unit: str) -> NDArray[np.float64]:
    """SI numbers in their display unit."""
    return np.asarray(values) * display_unit(unit).factor


def with_heading(label: str, unit: str) -> str:
    """The name of a column or an axis with its display unit."""
    name = display_unit(unit).name
    return f"{label}, {name}" if name else label


def off_line(squirt: float, error: float | None = None) -> tuple[str, str]:
    """How far off the line of aim squirt, rad, carries a ball, and after which distance: ("35 mm", "1 m").

    error: of squirt, rad, 1 sigma.

    >>> import math
    >>> off_line(math.radians(2.0)), off_line(math.radians(2.0), math.radians(0.3))
    (('35 mm', '1 m'), ('34.9 ± 5.2 mm', '1 m'))
    """
    aside = None if error is None else error / math.cos(squirt) ** 2
    size, _, per = with_unit(math.tan(squirt), OFF_LINE, error=aside, decimals=0).partition("/")
    return size, per if per[0].isdigit() else f"1 {per}"


def number_text(value: float, unit: str, digits: int = 4, *, decimals: int | None = None) -> str:
    """An SI number in its display unit, without the unit: to decimals, or to digits where they are decimals.

    What rounds to zero has no sign, as everywhere here:

    >>> number_text(-1e-20, "rad", decimals=2), number_text(-0.01, "rad", decimals=2)
    ('0.00', '-0.57')
    """
    shown = display_unit(unit)
    decimals = decimals if shown.decimals is None else shown.decimals
    if decimals is None:
        return significant(shown.factor * value, digits)
    return _fixed(value, shown, decimals)


def with_unit(
    value: float, unit: str, digits: int = 4, *, error: float | None = None, decimals: int | None = None
) -> str:
    """An SI number in its display unit, to some digits or decimals; with an error, to the error's second digit.

    >>> with_unit(0.0125, "m"), with_unit(0.0125, "m", error=3e-5)
    ('12.5 mm', '12.500 ± 0.030 mm')
    >>> with displayed_in("us"):
    ...     with_unit(0.0125, "m"), with_unit(0.538, "kg"), with_unit(0.012, END_MASS)
    ('.492 in', '18.98 oz', '12 g')
    """
    if error is not None and math.isfinite(error) and error > 0:
        factor = display_unit(unit).factor
        decimals = max(0, 1 - math.floor(math.log10(factor * error)))
        return f"{factor * value:z.{decimals}f} ± {factor * error:.{decimals}f}{unit_suffix(unit)}"
    return short_number(value, unit, digits, decimals=decimals) + unit_suffix(unit)


def span_text(low: float, high: float, unit: str, digits: int = 4) -> str:
    """Two SI numbers and their display unit: "26 to 31 mm"."""
    return f"{short_number(low, unit, digits)} to {with_unit(high, unit, digits)}"


def short_number(value: float, unit: str, digits: int = 4, *, decimals: int | None = None) -> str:
    """An SI number in its display unit, without the unit: to decimals, or to at most so many digits."""
    shown = display_unit(unit)
    if decimals is None and shown.decimals is not None:
        return trimmed(_fixed(value, shown, shown.decimals))
    decimals = decimals if shown.decimals is None else shown.decimals
    return f"{shown.factor * value:z.{digits}g}" if decimals is None else _fixed(value, shown, decimals)


def _fixed(value: float, shown: DisplayUnit, decimals: int) -> str:
    """A number to decimals, of which negative ones are zeros before the point; a length in inches as on a drawing.

    >>> with displayed_in("us"):
    ...     with_unit(4430.0, WAVE_SPEED), with_unit(0.505 * 0.0254, "m"), with_unit(0.0, "m")
    ('14500 ft/s', '.505 in', '0 in')
    """
    number = shown.factor * value
    text = f"{number:z.{decimals}f}" if decimals >= 0 else f"{round(number, decimals):z.0f}"
    return re.sub(r"^(-?)0(?=\.\d*[1-9])", r"\1", text) if shown is US["m"] else text


def inch_fraction(length: float) -> str:
    """A length, m, as a shop says it, in 1/64 in: "17/64", "1 1/4".

    >>> inch_fraction(0.25 * 0.0254), inch_fraction(1.25 * 0.0254)
    ('1/4', '1 1/4')
    """
    sixty_fourths = round(length / 0.0254 * 64)
    whole, rest = divmod(sixty_fourths, 64)
    fraction = f"{Fraction(rest, 64)}" if rest else ""
    return " ".join(filter(None, (str(whole) if whole or not rest else "", fraction)))


def trimmed(number: str) -> str:
    """The text of a number without zeros at the end of its decimals: "58" for "58.000"."""
    return number.rstrip("0").rstrip(".") if "." in number else number


def change_with_unit(change: float, unit: str, decimals: int) -> str:
    """A change of an SI number with its sign and display unit; nothing that rounds to zero has a sign."""
    shown = display_unit(unit)
    return format_change(shown.factor * change, decimals if shown.decimals is None else shown.decimals, shown.name)


def format_change(change: float, decimals: int, unit: str = "") -> str:
    """A change with its sign and unit, if it has one; nothing that rounds to zero has a sign."""
    text = f"{change:+.{decimals}f}"
    number = (text if float(text) else text[1:]).replace("-", "−")
    return f"{number}\u00a0{unit}" if unit else number


def significant(value: float, digits: int = 4) -> str:
    """A number to so many digits where they are decimals."""
    if value == 0 or not math.isfinite(value):
        return f"{value:.0f}"
    rounded = float(f"{abs(value):.{digits - 1}e}")  # 0.99999 has the digits of 1
    decimals = max(0, digits - 1 - math.floor(math.log10(rounded)))
    return f"{value:.{decimals}f}"


def unit_suffix(unit: str) -> str:
    """What follows a number of an SI unit: its display unit behind a blank, a degree sign without."""
    name = display_unit(unit).name
    return f" {name}" if name not in ("", "°") else name


def modulus_text(value: float) -> str:
    """A modulus, Pa, of leather in MPa or thousands of psi, of wood in GPa or 10⁶ psi."""
    if _displayed == "us":
        psi = float(f"{value / PSI:.3g}")
        return f"{psi:.0f} psi" if psi < 1e6 else f"{psi / 1e6:.3g} ×10⁶ psi"
    return f"{1e-6 * value:.4g} MPa" if value < 1e9 else f"{1e-9 * value:.4g} GPa"
