"""The units that a person reads and types: millimetres and grams, or inches and ounces."""

from __future__ import annotations

import re
from typing import NamedTuple

from cuefem.quantity.units import UnknownUnit, kind_of, number
from cuefem.results.quantities import IMPERIAL, TRADE, Units, significant

MM_PER_INCH, GRAMS_PER_OUNCE = 25.4, 28.349523125


class UnitSystem(NamedTuple):
    """A system of units: the word on its switch, and its units by those of SI."""

    name: str
    units: Units

    def length(self, metres: float, digits: int = 4) -> str:
        """A length with its unit."""
        return self._written(metres, "m", digits)

    def mass(self, kilograms: float, digits: int = 4) -> str:
        """A mass with its unit."""
        return self._written(kilograms, "kg", digits)

    def _written(self, value: float, unit: str, digits: int) -> str:
        scale, name = self.units[unit]
        return f"{scale * value:.{digits}g} {name}"

    def said(self, sentence: str) -> str:
        """A sentence with its lengths and masses in these units."""
        return _METRIC.sub(_in_inches, sentence) if self.units is IMPERIAL else sentence


METRIC = UnitSystem("mm, g", TRADE)
INCHES = UnitSystem("in, oz", IMPERIAL)
SYSTEMS = {system.name: system for system in (METRIC, INCHES)}

_METRIC = re.compile(r"(?<![\w.])([0-9]+(?:\.[0-9]+)?)(?:( to | → )([0-9]+(?:\.[0-9]+)?))?([ \u00a0])(mm|g)(?![\w/])")


def _in_inches(match: re.Match[str]) -> str:
    first, between, last, space, metric = match.groups()
    per, unit = {"mm": (MM_PER_INCH, "in"), "g": (GRAMS_PER_OUNCE, "oz")}[metric]
    values = [significant(float(text) / per) for text in (first, last) if text]
    return f"{(between or '').join(values)}{space}{unit}"


_NUMBER = r"[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+"
_FRACTION = r"(?:(?P<whole>[0-9]+)[ -]+)?(?P<top>[0-9]+)\s*/\s*(?P<bottom>[0-9]+)"
_UNIT = r"[^\d\s.,+/-].*?"
_TYPED = re.compile(rf"\s*(?P<sign>[-+−]?)\s*(?:{_FRACTION}|(?P<number>{_NUMBER}))\s*(?P<unit>{_UNIT})?\s*")
LONGEST = 40


def typed(text: str, unit: str) -> float:
    """The number in ``unit`` that a person typed: "11,8", "11.8", "29/64", "1 1/8 in", "12 mm"; ValueError in words.

    A comma is a decimal comma. A unit of its own is taken, whatever ``unit`` is.
    """
    match = _TYPED.fullmatch(text) if len(text) <= LONGEST else None
    if match is None:
        many = len(re.findall("[.,]", text)) > 1
        hint = ": no separators between thousands" if many else ""
        raise ValueError(f"must be a number, such as 11.8 or 11,8{hint}")
    if match["number"]:
        value = float(match["number"].replace(",", "."))
    elif int(match["bottom"]) == 0:
        raise ValueError("must be a number, such as 29/64; got a division by 0")
    else:
        value = int(match["whole"] or 0) + int(match["top"]) / int(match["bottom"])
    value = -value if match["sign"] in ("-", "−") else value
    own = match["unit"] or unit
    if own == unit:
        return value
    if not unit:
        raise ValueError("must be a bare number, without a unit")
    try:
        return number(f"{value!r} {own}", unit)
    except UnknownUnit as error:
        raise ValueError(f"must be a number, such as 11.8 or 11,8: no unit is called {error.name!r}") from None
    except ValueError:
        raise ValueError(f"must be {kind_of(unit)}, in {unit} or a unit of its own; got {kind_of(own)}") from None
