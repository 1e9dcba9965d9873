"""Declaration of fields with unit and bounds, for the checks of dataclasses, units in files and the schema of files."""

from __future__ import annotations

import dataclasses
import difflib
import functools
import math
import re
import typing
from collections.abc import Iterable
from typing import Any

import numpy as np

from cuefem.quantity.unit_checks import unit_hint, warn
from cuefem.quantity.units import (
    UNITS,
    UnknownUnit,
    conversion_factor,
    dimension_of,
    examples_of,
    format_number,
    parse_number,
    split_quantity,
    units_of_dimension,
)


@dataclasses.dataclass(frozen=True)
class Quantity:
    """The SI unit of a field ("" for a pure number) and the interval in which its value must lie.

    ``interval`` is written as in mathematics, "(0, inf)" or "[0, 1]". A round bracket excludes its end, so infinity is
    allowed only by an interval that closes with "inf]". NaN lies in no interval. ``names``: names of values in files or
    options, each with its value. ``typical_range``: the range of real cues.
    """

    unit: str
    interval: str = "(-inf, inf)"
    names: tuple[tuple[str, float], ...] = ()
    typical_range: tuple[float, float] | None = None

    def with_typical_range(self, least: float, most: float) -> Quantity:
        """The same quantity with the range of real cues."""
        return dataclasses.replace(self, typical_range=(least, most))

    @functools.cached_property
    def ends(self) -> tuple[float, float]:
        """The two ends of the interval, as numbers in ``unit``."""
        low, high = self.interval[1:-1].split(",")
        return float(low), float(high)

    def contains(self, value: Any) -> Any:
        """Whether ``value`` (a number or an array) lies in the interval, elementwise."""
        low, high = self.ends
        above = value >= low if self.interval[0] == "[" else value > low
        below = value <= high if self.interval[-1] == "]" else value < high
        return above & below

    @property
    def bounds(self) -> str:
        """The interval and its unit as messages write them: "(0, inf) m"."""
        return f"{self.interval} {self.unit}".rstrip()

    @property
    def example(self) -> str:
        """What the unit measures, with an example: 'a length with its unit, such as "12 mm"'."""
        noun, example, *_ = self._examples
        return f'{noun} with its unit, such as "{example}"{self._name_list}'

    @property
    def _examples(self) -> tuple[str, ...]:
        noun, *examples = examples_of(self.unit)
        return (noun, "200 MPa") if self.unit == "Pa" and self.names else (noun, *examples)  # of leather, not of wood

    @property
    def _name_list(self) -> str:
        return ", or " + ", ".join(f'"{name}"' for name, _ in self.names[:3]) if self.names else ""

    @property
    def expected(self) -> str:
        """The value that a file or an option must have: a number with its unit, or a bare one within its bounds."""
        return self.example if self.unit else f"a bare number, {self.bounds_in('')}"

    def bounds_in(self, unit: str) -> str:
        """The bounds as text in a unit of their dimension, or in SI if they are too large or too small in it."""
        per = float(conversion_factor(unit, self.unit)) if self.unit else 1.0
        if any(end and math.isfinite(end) and not 1e-4 <= abs(end) / per < 1e6 for end in self.ends):
            unit, per = self.unit, 1.0
        low, high = (f"{end / per:.6g}".replace("e-0", "e-") for end in self.ends)
        unit = f" {unit}" if unit else ""
        if high == "inf":
            if low == "-inf":
                return f"a finite number{unit and ' of'}{unit}"
            return f"more than {low}{unit}" if self.interval[0] == "(" else f"{low}{unit} or more"
        return _BOUND_TEXTS[self.interval[0] + self.interval[-1]].format(low, high) + unit

    def read(self, value: Any) -> float:
        """The value of a file or an option as a checked SI number; ValueError in the units of the file."""
        if self.unit == "":
            return self._pure_number(value)
        named_values = dict(self.names) | ({"inf": math.inf} if self.interval.endswith("inf]") else {})
        word = str(value).strip().lower()
        if word in named_values:
            return named_values[word]
        digits, unit = split_quantity(str(value)) if isinstance(value, str | int | float) else ("", "")
        if digits and not unit and digits[-3:].lower() not in ("inf", "nan"):
            examples = " or ".join(f'"{text}"' for text in self._examples[1:])
            raise ValueError(f"needs a unit: {examples}{self._name_list}; got {quote(value)}")
        try:
            result = parse_number(str(value), self.unit)
        except ValueError as error:
            raise ValueError(f"must be {self.example}; got {quote(value)}{self._reason(error, value, unit)}") from None
        if not self.contains(result):
            raise ValueError(f"must be {self.bounds_in(unit)}; got {digits} {unit}")
        return result

    def _reason(self, error: ValueError, value: Any, unit: str) -> str:
        """The reason why a text is no quantity of this unit, for the end of a message; "" if unknown."""
        if not unit or comma_hint(value):
            return comma_hint(value)
        if not isinstance(error, UnknownUnit):
            return f", which is {dimension_of(unit)}"
        valid = units_of_dimension(self.unit)
        hint = suggestion(error.name, valid) or suggestion(error.name, UNITS) or f"; valid: {', '.join(valid)}"
        return f": unknown unit {quote(error.name)}{hint}"

    def _pure_number(self, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"must be {self.expected}; got {quote(value)}{comma_hint(value)}")
        try:
            result = float(value)
        except OverflowError:
            result = math.nan
        if not self.contains(result):
            raise ValueError(f"must be {self.bounds_in('')}; got {quote(value)}")
        return result

    def as_text(self, value: float) -> str | float:
        """A number as written in a file: text with a unit, or a bare number without one."""
        if self.unit:
            return format_number(value, self.unit)
        rounded = float(f"{value:.13g}")
        return rounded if self.contains(rounded) else value

    def check(self, name: str, value: Any) -> float:
        """``value`` as a float; the errors name field, bound, unit and value."""
        try:
            if not isinstance(value, float) and (isinstance(value, bool | str) or np.ndim(value)):
                raise TypeError
            number = float(value)
        except (TypeError, ValueError):
            raise TypeError(f"{name} must be a number in {self.bounds}; got {quote(value)}") from None
        if not self.contains(number):
            raise ValueError(f"{name} must be in {self.bounds}; got {value}")
        return number


_BOUND_TEXTS = {
    "()": "between {} and {}",
    "[]": "{} to {}",
    "(]": "more than {} and at most {}",
    "[)": "at least {} and less than {}",
}
_COMMA = re.compile(r"\s*[-+]?[0-9]+,[0-9]")


def comma_hint(value: Any) -> str:
    """A hint for a number with a decimal comma."""
    return "; use a decimal point" if isinstance(value, str) and _COMMA.match(value) else ""


class OutOfBounds(ValueError):
    """A number outside bounds that depend on other fields; the message is in SI, `file_message` in units of files."""

    def __init__(self, name: str, bounds: Quantity, value: float, reason: str = "") -> None:
        self.name, self.bounds, self.value, self.reason = name, bounds, value, reason
        super().__init__(f"{name} must be in {bounds.bounds}{reason}; got {value}")

    @property
    def file_message(self) -> str:
        """The message without the name, in the units of files."""
        got = str(self.bounds.as_text(self.value))
        return f"must be {self.bounds.bounds_in(got.partition(' ')[2])}{self.reason}; got {got}"


# Bounds of a cue and an impact reject wrong units before they cost hours. Each bound is far from real values, so that
# scaled and extreme scenes can be computed.
LENGTH = Quantity("m", "(0, 1000]")  # of a segment: a cue is 1.5 m long
DIAMETER = Quantity("m", "(0, 10]")  # a cue is 0.03 m wide
CONTACT_TIME = Quantity("s", "[1e-6, 10]")  # leather: 1e-3 s; in 1e-6 s sound travels through 4 mm of wood
MAX_SEGMENTS = 2000  # of a drawing: one every 0.7 mm
MAX_DOF = 50_000  # of a beam: a cue of 30 segments takes 10,000 for the modes of the shortest contact


def quantity_of(hint: Any) -> Quantity | None:
    """Unit and bounds of a numeric field, from its annotation; None for other fields."""
    return next((quantity for quantity in getattr(hint, "__metadata__", ()) if isinstance(quantity, Quantity)), None)


@functools.cache
def quantity_fields(kind: type) -> tuple[tuple[str, Quantity, bool], ...]:
    """The dimensioned fields of a dataclass: (name, quantity, whether None is allowed)."""
    hints = typing.get_type_hints(kind, include_extras=True)
    declared = []
    for field in dataclasses.fields(kind):
        hint = hints[field.name]
        quantity = quantity_of(hint)
        if quantity is not None:
            declared.append((field.name, quantity, type(None) in typing.get_args(hint.__origin__)))
    return tuple(declared)


def field_quantity(owner: Any, name: str | int) -> Quantity | None:
    """Unit and bounds of a field of a dataclass's instance; None if it is no number."""
    if not dataclasses.is_dataclass(owner):
        return None
    return next((quantity for field, quantity, *_ in quantity_fields(type(owner)) if field == name), None)  # type: ignore[arg-type]


def check_fields(instance: Any) -> None:
    """Check every dimensioned field of a frozen dataclass; store it as float (in __post_init__)."""
    kind = type(instance)
    for name, quantity, optional in quantity_fields(kind):  # type: ignore[arg-type]
        value = getattr(instance, name)
        if value is None and optional:
            continue
        checked = quantity.check(f"{kind.__name__}.{name}", value)
        if quantity.typical_range and isinstance(checked, float):
            warn(unit_hint(f"{kind.__name__}.{name}", checked, quantity.unit, quantity.typical_range))
        if checked is not value:
            object.__setattr__(instance, name, checked)


def check_kind(name: str, value: Any, kind: type | tuple[type, ...]) -> None:
    """TypeError unless ``value`` is an instance of ``kind``; the message names a field of it that is one."""
    if not isinstance(value, kind):
        expected = " or ".join(k.__name__ for k in (kind if isinstance(kind, tuple) else (kind,)))
        raise TypeError(f"{name} must be {_a(expected)}; got {brief_value(value, kind)}")


def _a(noun: str) -> str:
    return f"{'an' if noun[0] in 'AEIOUaeiou' else 'a'} {noun}"


def brief_value(value: Any, kind: type | tuple[type, ...] = ()) -> str:
    """A value for a message: numbers and texts by value, others by type; of a dataclass also the field to pass."""
    if not dataclasses.is_dataclass(value) or isinstance(value, type):
        return quote(value)
    matching = [field.name for field in dataclasses.fields(value) if isinstance(getattr(value, field.name), kind)]
    return _a(type(value).__name__) + (f": pass its {matching[0]}" if matching else "")


def quote(value: Any) -> str:
    """A value for a message, cut if it is long."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def suggestion(name: str, names: Iterable[str]) -> str:
    """A hint at the most similar valid name, or "" if none is similar."""
    spellings = {each.casefold(): each for each in names}
    close = difflib.get_close_matches(name.casefold(), spellings, n=1)
    return f"; did you mean {spellings[close[0]]!r}?" if close else ""


def check_count(name: str, value: Any, least: int, most: int | None = None) -> None:
    """TypeError or ValueError unless ``value`` is a whole number of at least ``least``, and at most ``most``."""
    bounds = f">= {least}" if most is None else f"in [{least}, {most}]"
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise TypeError(f"{name} must be a whole number {bounds}; got {quote(value)}")
    if value < least or (most is not None and value > most):
        raise ValueError(f"{name} must be a whole number {bounds}; got {value}")


def sine_cosine(offset: Any) -> tuple[Any, Any]:
    """(sin phi, cos phi) of an offset b/R = sin phi, without cancellation as |offset| -> 1."""
    return offset, np.sqrt((1 - offset) * (1 + offset))
