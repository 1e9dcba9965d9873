"""The table of units, and the conversion of text with a unit to a number and back: "29 in" is exactly 0.7366 m."""

from __future__ import annotations

import functools
import math
import re
import unicodedata
from decimal import Decimal, DecimalException
from typing import NamedTuple

# By SI unit: its dimension, and example quantities. Files are written in the unit of the first example.
EXAMPLES = {
    "m": ("a length", "12 mm", "0.5 in"),
    "kg": ("a mass", "150 g", "15 oz"),
    "s": ("a time", "1.2 ms"),
    "m/s": ("a speed", "2 m/s", "4.5 mph"),
    "Pa": ("a modulus or stress", "12.6 GPa", "1.8 Msi"),
    "kg/m^3": ("a density", "700 kg/m^3", "0.025 lb/in^3"),
    "N/m": ("a stiffness", "5000 N/m"),
    "N m/rad": ("a rotational stiffness", "20 N m/rad"),
    "rad/(N m)": ("a rotational compliance", "2e-4 rad/(N m)"),
    "m/N": ("a compliance", "1e-8 m/N"),
    "N m": ("a torque", "20 N m"),
    "N s/m": ("a damping coefficient", "3 N s/m"),
    "kg m^2": ("a rotary inertia", "40 g mm^2"),
    "rad": ("an angle", "3 deg"),
    "Hz": ("a frequency", "250 Hz"),
}

Powers = tuple[int, ...]  # of the base units


class Unit(NamedTuple):
    """A unit: its scale, in SI units, and its dimension as powers of the base units."""

    scale: Decimal
    powers: Powers


# All units without powers or products, by SI unit: scale in it, and names, first the preferred one. An SI unit consists
# of base units, which come first. Products, powers and quotients ("lb/in^3", "N mm/rad") need no entry.
_BASE_UNITS = ("m", "kg", "s", "rad")
_TABLE = {
    "m": """0.001 mm millimetre millimetres millimeter millimeters мм 毫米 ミリ 밀리미터;
        1 m metre metres meter meters; 0.01 cm centimetre centimetres centimeter centimeters см 厘米 公分 センチ;
        0.0254 in inch inches zoll " ″ ” ''; 0.3048 ft foot feet;
        0.0000254 thou mil mils; 0.000001 um µm μm micron microns micrometre micrometres micrometer micrometers;
        0.9144 yd yard yards; 1000 km; 1609.344 mile miles mi""",
    "kg": """0.001 g gram grams gramme grammes; 1 kg kilogram kilograms kilo kilos; 1000 t tonne tonnes;
        0.028349523125 oz ounce ounces; 0.45359237 lb lbs pound pounds; 0.000001 mg milligram milligrams;
        0.00006479891 grain grains""",
    "s": """0.001 ms msec millisecond milliseconds; 1 s sec second seconds; 60 min minute minutes;
        0.000001 us µs μs usec microsecond microseconds; 3600 h hr hour hours""",
    "rad": """0.01745329251994329576923690768 deg degree degrees °; 1 rad radian radians;
        0.001 mrad milliradian milliradians; 0.0002908882086657215961539484614 arcmin arcminute arcminutes;
        0.000004848136811095359935899141023 arcsec arcsecond arcseconds""",
    "m/s": """0.44704 mph; 0.2777777777777777777777777778 kph kmh; 0.3048 fps;
        0.5144444444444444444444444444 knot knots kt kts""",
    "kg m/s^2": """1 N newton newtons; 1000 kN; 4.4482216152605 lbf; 9.80665 kgf kp; 0.00980665 gf;
        0.27801385095378125 ozf""",
    "kg/(m s^2)": """1E+9 GPa gigapascal gigapascals; 1E+6 MPa megapascal megapascals; 1 Pa pascal pascals;
        1000 kPa kilopascal kilopascals; 6894.757293168361336722673445 psi; 6894757.293168361336722673445 ksi;
        6894757293.168361336722673445 Msi; 100000 bar""",
    "1/s": "1 Hz hz hertz; 1000 kHz kilohertz; 1E+6 MHz megahertz",
    "m^3": "0.000001 cc ml mL; 0.001 l L litre litres liter liters",
}

FRACTION = re.compile(r"(?:([0-9]+)(?:\s+|-))?([0-9]+)\s*/\s*([1-9][0-9]*)")  # 5/16, 1 1/4 and 1-1/4
_VULGAR_FRACTION = re.compile("[¼-¾⅐-⅞]")
_TEXT = re.compile(
    rf"\s*({FRACTION.pattern}|[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[+-]?[0-9]+)?|[+-]?inf|nan)\s*(.*?)\s*",
    re.IGNORECASE,
)
ROUND_TRIP_TOLERANCE = 1e-12  # relative: numbers closer than this are equal in files
MAX_QUANTITY_CHARACTERS = 200  # characters of a number and its unit: the cost of matching grows like the square
_OPERATORS = re.compile(r"\s*([*/·])\s*|\s+")
_FACTOR = re.compile(r"([^\W\d_]+|[°\"″”']+)(?:\^(-?[0-9])|([23]))?")
_FRACTION_BAR = re.compile(r"(.*?)(?:/\s*\(([^/()]*)\))?", re.DOTALL)  # numerator, denominator in brackets: rad/(N m)
_NO_UNIT = Unit(Decimal("1"), (0,) * len(_BASE_UNITS))
_POWERS = str.maketrans({"²": "^2", "³": "^3"})


class UnknownUnit(ValueError):
    """A unit with a name, ``name``, that is not in the table."""

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(f"an unknown unit, {name!r}")


@functools.lru_cache(maxsize=1024)
def unit_of(text: str) -> Unit:
    """The unit of a text such as "g/cm^3"; UnknownUnit if it is not in the table."""
    numerator, denominator = _FRACTION_BAR.fullmatch(text.strip().translate(_POWERS).replace("**", "^")).groups()  # type: ignore[union-attr]
    scale, powers = _NO_UNIT
    for side, sign in ((numerator, 1), (denominator, -1)):
        parts = _OPERATORS.split(side.strip()) if side is not None else []
        for operator, word in zip(["*", *parts[1::2]], parts[::2], strict=False):
            factor = _factor(word)
            power = -sign if operator == "/" else sign
            scale = scale * factor.scale if power > 0 else scale / factor.scale
            powers = tuple(p + power * q for p, q in zip(powers, factor.powers, strict=True))
    return Unit(scale, powers)


def _factor(text: str) -> Unit:
    """A single unit with its power; a name that is not in the table is tried in small letters."""
    if text == "1":
        return _NO_UNIT
    match = _FACTOR.fullmatch(text)
    entry = match and (UNITS.get(match[1]) or UNITS.get(match[1].lower()))
    if not match or not entry:
        raise UnknownUnit(match[1] if match else text)
    power = int(match[2] or match[3] or 1)
    return Unit(entry.scale**power, tuple(power * p for p in entry.powers))


def _dimension(si: str) -> Powers:
    """The powers of an SI unit of the table."""
    return tuple(int(si == base) for base in _BASE_UNITS) if si in _BASE_UNITS else unit_of(si).powers


UNITS: dict[str, Unit] = {}
for _si, _units in _TABLE.items():
    for _scale, *_names in map(str.split, _units.split(";")):
        UNITS |= dict.fromkeys(_names, Unit(Decimal(_scale), _dimension(_si)))


def conversion_factor(unit: str, target: str) -> Decimal:
    """The factor from ``unit`` to ``target``; ValueError if a unit is unknown or the dimensions differ.

    ``unit`` may omit an angle of ``target`` (N m for N m/rad), but not add one: 1 rad/s is not 1 Hz.
    """
    source, goal = unit_of(unit), unit_of(target)
    if source.powers != goal.powers and (source.powers != (*goal.powers[:3], 0) or not any(source.powers)):
        raise ValueError(f"a unit of another kind, {unit!r}")
    return source.scale / goal.scale


def examples_of(unit: str) -> tuple[str, ...]:
    """The dimension of an SI unit, and example quantities, the first in a convenient unit."""
    return EXAMPLES.get(unit, ("a quantity", f"3 {unit}"))


def dimension_of(unit: str) -> str:
    """The dimension of a unit, such as "a mass"; UnknownUnit if it is not in the table."""
    powers = unit_of(unit).powers
    return next((noun for si, (noun, *_) in EXAMPLES.items() if unit_of(si).powers == powers), "something else")


def preferred_name(unit: str) -> str:
    """The first name of a unit in the table ("in" of inch), compound units unchanged; UnknownUnit if it is unknown."""
    return next((name for name in UNITS if UNITS[name] == unit_of(unit)), unit)


def units_of_dimension(unit: str) -> list[str]:
    """The preferred names of the units with the dimension of ``unit``; of a compound unit, the unit of its example."""
    names = {UNITS[name]: name for name in reversed(UNITS) if UNITS[name].powers == unit_of(unit).powers}
    return [*reversed(names.values())] or [examples_of(unit)[1].split(" ", 1)[1]]


def plain_fractions(text: str) -> str:
    """The text with 1/2 for ½, behind a blank: "13½" is "13 1/2"."""
    return _VULGAR_FRACTION.sub(lambda match: " " + unicodedata.normalize("NFKC", match[0]).replace("⁄", "/"), text)


def split_quantity(text: str) -> tuple[str, str]:
    """The number and the unit of a text, each "" if missing; both "" if it is no quantity or too long."""
    parts = _TEXT.fullmatch(plain_fractions(text)) if len(text) <= MAX_QUANTITY_CHARACTERS else None
    return (parts[1], parts[5]) if parts else ("", "")


def parse_decimal(digits: str) -> Decimal:
    """The value of a decimal number, a fraction (5/16) or a mixed number (1 1/4, 1-1/4)."""
    if fraction := FRACTION.fullmatch(digits):
        whole, numerator, denominator = fraction.groups(default="0")
        return Decimal(whole) + Decimal(numerator) / Decimal(denominator)
    return Decimal(digits)


def parse_number(text: str, unit: str) -> float:
    """The value of ``text`` ("12 mm", "5/16 in") in ``unit``.

    inf beyond the range of floats, nan beyond that of decimals. ValueError if the number or its unit is missing, or the
    unit is unknown (UnknownUnit) or of another dimension.
    """
    digits, source = split_quantity(text)
    if not source:
        raise ValueError("a number and a unit")
    try:
        return float(parse_decimal(digits) * conversion_factor(source, unit))
    except (DecimalException, OverflowError):
        return math.nan  # in no interval


def format_number(value: float, unit: str) -> str:
    """A number in the convenient unit ("12 mm"), with the fewest digits that are exact to `ROUND_TRIP_TOLERANCE`.

    In ``unit``, SI, if that needs fewer digits (0.1 rad).
    """
    convenient = examples_of(unit)[1].split(" ", 1)[1]
    if math.isfinite(value):
        exact, per = Decimal(repr(value)), conversion_factor(convenient, unit)
        for digits in range(len(exact.normalize().as_tuple().digits)):
            text = f"{_plain(Decimal(f'{exact / per:.{digits}e}'))} {convenient}"
            if math.isclose(parse_number(text, unit), value, rel_tol=ROUND_TRIP_TOLERANCE):
                return text
    return f"{value!r} {unit}"


def _plain(value: Decimal) -> str:
    """A number without exponent from 1e-5 to 1e12, with one beyond."""
    value = value.normalize()
    return format(value, "f") if value == 0 or -5 <= value.adjusted() < 12 else str(value)
