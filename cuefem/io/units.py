"""Text with units to SI numbers and back, exactly: "29 in" is 0.7366 m, and what is written reads back identical."""

from __future__ import annotations

import functools
import math
import re
import tokenize
from decimal import Decimal, DecimalException
from typing import Any

from cuefem.io.errors import shown
from cuefem.quantity import EXAMPLES, Quantity

_TEXT = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[+-]?[0-9]+)?|[+-]?inf|nan)\s*(.*?)\s*", re.IGNORECASE)
LONGEST_TEXT = 200  # letters of a number and its unit: beyond it matching takes the square of them
# Names, each with a one-digit power, multiplied and divided: all that pint gets to evaluate.
_FACTOR = r"(?:[A-Za-zµμ°]{1,30}(?:(?:\^|\*\*)-?[0-9]|[²³])?|1)"
_PRODUCT = rf"\({_FACTOR}(?:(?:\s*\*\s*|\s){_FACTOR}){{1,3}}\)"  # below a stroke: rad/(N m)
_UNIT = re.compile(rf"{_FACTOR}(?:(?:\s*[*/]\s*|\s){_FACTOR}){{0,6}}(?:\s*/\s*{_PRODUCT})?")
_POWER = re.compile(r"m([23])\b")  # g/cm3 as people write it


# How many SI units one of the units that cues are drawn in is, exactly as pint has it: a test compares them all. pint
# knows every other unit, and takes longer to load than all of a command's work.
USUAL = {
    "m": {"m": "1", "mm": "0.001", "cm": "0.01", "in": "0.0254", "inch": "0.0254", "ft": "0.3048"},
    "kg": {"kg": "1", "g": "0.001", "oz": "0.028349523125", "lb": "0.45359237"},
    "s": {"s": "1", "ms": "0.001", "us": "0.000001", "µs": "0.000001"},
    "m/s": {"m/s": "1", "km/h": "0.2777777777777777777777777778", "mph": "0.44704", "ft/s": "0.3048"},
    "Pa": {"Pa": "1", "MPa": "1E+6", "GPa": "1E+9"},
    "kg/m^3": dict.fromkeys(("kg/m^3", "kg/m3", "kg/m³"), "1") | dict.fromkeys(("g/cm^3", "g/cm3", "g/cm³"), "1000"),
    "N/m": {"N/m": "1", "N/mm": "1000", "kN/m": "1000"},
    "N m/rad": {"N m/rad": "1"},
    "rad/(N m)": {"rad/(N m)": "1"},
    "m/N": {"m/N": "1"},
    "N m": {"N m": "1"},
    "N s/m": {"N s/m": "1"},
    "kg m^2": {"kg m^2": "1", "g mm^2": "1E-9"},
    "rad": {"rad": "1", "deg": "0.01745329251994329576923690768"},
    "Hz": {"Hz": "1", "kHz": "1000"},
}


@functools.cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(non_int_type=Decimal)  # exact decimals: floats make 0.7365999999999999 m of 29 in


@functools.cache
def _scale(unit: str, wanted: str) -> Decimal | None:
    """How many ``wanted`` one ``unit`` is; None if pint knows no such unit or it is of another kind."""
    usual = USUAL.get(wanted, {}).get(unit)
    return scale_by_pint(unit, wanted) if usual is None else Decimal(usual)


def scale_by_pint(unit: str, wanted: str) -> Decimal | None:
    """As `_scale`, for units that are not `USUAL`."""
    import pint

    unit = _POWER.sub(r"m^\1", unit)
    if not _UNIT.fullmatch(unit):
        return None
    try:
        return Decimal(_registry().Quantity(Decimal(1), _registry().parse_units(unit)).to(wanted).magnitude)
    except (pint.errors.PintError, ValueError, TypeError, ArithmeticError, AssertionError, SyntaxError, KeyError):
        return None
    except tokenize.TokenError:
        return None


def _known(unit: str) -> bool:
    """Whether pint knows the unit."""
    import pint

    unit = _POWER.sub(r"m^\1", unit)
    if not _UNIT.fullmatch(unit):
        return False
    try:
        _registry().parse_units(unit)
    except (pint.errors.PintError, ValueError, TypeError, ArithmeticError, AssertionError, SyntaxError, KeyError):
        return False
    except tokenize.TokenError:
        return False
    return True


COMMA = "; a decimal point, no comma"
_COMMA = re.compile(r"\s*[-+]?[0-9]+,[0-9]")


def number(text: str, unit: str) -> float:
    """The number of ``unit`` that ``text`` ("12 mm") says; ValueError if its unit is missing, wrong or unknown."""
    found = _TEXT.fullmatch(text) if len(text) <= LONGEST_TEXT else None
    if not found or not found[2]:
        raise ValueError("a number and a unit")
    scale = _scale(found[2], unit)
    if scale is None:
        raise ValueError("a unit of another kind")
    try:
        return float(Decimal(found[1]) * scale)
    except (DecimalException, OverflowError):
        return math.nan  # beyond every decimal: in no interval


def quantity(wanted: Quantity, value: Any) -> float:
    """What stands in a file as a checked SI number; ValueError names bound, unit and the value got."""
    if wanted.unit == "":
        return _bare(wanted, value)
    known = dict(wanted.words) | ({"inf": math.inf} if wanted.endless else {})
    word = str(value).strip().lower() if isinstance(value, str | float) else ""
    if word in known:
        return known[word]
    refused = ValueError(f"must be in {wanted.bounds}, {wanted.example}; got {shown(value)}")
    if not isinstance(value, str):
        raise refused
    try:
        result = number(value, wanted.unit)
    except ValueError:
        raise ValueError(f"{refused}{_why(value)}") from None
    beyond = math.isinf(result) and "inf" not in value.lower()
    if beyond or not wanted.holds(result):
        raise ValueError(f"must be in {wanted.bounds}; got {shown(value)}")
    return result


def _why(value: str) -> str:
    """What is wrong with a text that `number` refused; empty if it has no unit."""
    if len(value) > LONGEST_TEXT:
        return f", of {len(value)} letters"
    if _COMMA.match(value):
        return COMMA
    found = _TEXT.fullmatch(value)
    if not found or not found[2]:
        return ""
    return f", of another kind ({shown(found[2])})" if _known(found[2]) else f", an unknown unit ({shown(found[2])})"


def _bare(wanted: Quantity, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        comma = COMMA if isinstance(value, str) and _COMMA.match(value) else ""
        raise ValueError(f"must be a bare number in {wanted.bounds}; got {shown(value)}{comma}")
    try:
        result = float(value)
    except OverflowError:
        result = math.nan
    if not wanted.holds(result):
        raise ValueError(f"must be in {wanted.bounds}; got {shown(value)}")
    return result


def text(value: float, unit: str) -> str:
    """A number in a unit that reads well ("12 mm"), with the fewest digits that `number` takes for the same float.

    Where those are more than in SI (0.1 rad), it is written in SI.
    """
    _, example = EXAMPLES.get(unit, ("", f"1 {unit}"))
    friendly = example.split(" ", 1)[1]
    scale = _scale(friendly, unit) if math.isfinite(value) else None
    if scale is not None:
        exact = Decimal(repr(value))
        for digits in range(len(exact.normalize().as_tuple().digits)):
            written = f"{_plain(Decimal(f'{exact / scale:.{digits}e}'))} {friendly}"
            if number(written, unit) == value:
                return written
    return f"{value!r} {unit}"


def _plain(value: Decimal) -> str:
    value = value.normalize()
    return format(value, "f") if value == 0 or -5 <= value.adjusted() < 12 else str(value)
