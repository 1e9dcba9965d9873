"""The quantities that records, tables and pages hold: what each is called, its SI unit, and how it is written.

One entry here is all that a new quantity takes: the units of the records, the rows of every table, the page's and the
designer's numbers are made of these.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

NONE = "–"
# The units in which a cue maker reads what a record holds in SI: how many of them one SI unit is, and their name.
TRADE = {
    "kg": (1e3, "g"),
    "m": (1e3, "mm"),
    "s": (1e3, "ms"),
    "rad": (math.degrees(1), "°"),
    "Pa": (1e-9, "GPa"),
    "kg/m^3": (1.0, "kg/m³"),
    "1/sqrt(kg)": (1.0, "/√kg"),
}
# The same for who measures in inches and ounces, and the decimals that each of these units takes more.
IMPERIAL = TRADE | {"kg": (1e3 / 28.349523125, "oz"), "m": (1e3 / 25.4, "in")}
_FINER = {"in": 2, "oz": 0}
Units = Mapping[str, tuple[float, str]]


class Known(NamedTuple):
    """A quantity: its name for people, its SI unit ("" for a pure number or a word), and its decimals in trade units.

    decimals: None for four digits in all.
    """

    label: str
    unit: str = ""
    decimals: int | None = None

    @property
    def shown_unit(self) -> str:
        """The unit that people read it in."""
        return self.shown_in()[1]

    @property
    def scale(self) -> float:
        """How many of the units that people read one SI unit is."""
        return self.shown_in()[0]

    def shown_in(self, units: Units = TRADE) -> tuple[float, str]:
        """How many of the units that people read one SI unit is, and the name of that unit."""
        return units.get(self.unit, (1.0, self.unit))

    def number(self, value: float, *, brief: bool = False, units: Units = TRADE) -> str:
        """A value in the unit that people read, without it; brief: three decimals at most."""
        scale, unit = self.shown_in(units)
        if self.decimals is None:
            return significant(scale * value)
        decimals = self.decimals + _FINER.get(unit, 0)
        return f"{scale * value:.{min(decimals, 3) if brief else decimals}f}"

    def written(self, value: Any, *, brief: bool = False, units: Units = TRADE) -> str:
        """A value with its unit; a dash if there is no value; words unchanged."""
        if isinstance(value, str):
            return value
        if value is None or not math.isfinite(value):
            return NONE
        unit = self.shown_in(units)[1]
        space = "" if unit in ("°", "") else " "
        return f"{self.number(float(value), brief=brief, units=units)}{space}{unit}"


class _Error(Known):
    """A relative error, of which only the size means anything."""

    def number(self, value: float, *, brief: bool = False, units: Units = TRADE) -> str:
        """Two digits and a power of ten."""
        return f"{value:.1e}"


def significant(value: float, digits: int = 4) -> str:
    """A number to so many digits where they are decimals."""
    if value == 0 or not math.isfinite(value):
        return f"{value:.0f}"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"


QUANTITIES = {
    "mass": Known("mass of the cue", "kg"),
    "shaft_mass": Known("mass of the drawn part", "kg"),
    "body_mass": Known("mass behind the drawn part", "kg"),
    "end_mass": Known("end mass", "kg"),
    "cue_end_mass": Known("mass of the cue's end", "kg"),
    "lowest": Known("lowest", "kg"),
    "highest": Known("highest", "kg"),
    "length": Known("length", "m", 0),
    "balance_point": Known("balance point of the drawn part, from the tip", "m", 1),
    "radius": Known("radius", "m", 2),
    "squirt": Known("squirt", "rad", 3),
    "pivot_length": Known("natural pivot length", "m", 0),
    "speed": Known("speed", "m/s", 4),
    "ball_speed": Known("ball speed", "m/s", 4),
    "ball_velocity": Known("ball velocity", "m/s", 4),
    "spin": Known("spin", "rad/s", 3),
    "cue_speed": Known("cue speed after", "m/s", 4),
    "contact_time": Known("head-on contact time", "s"),
    "duration": Known("time in contact", "s", 4),
    "regime": Known("grip"),
    "grip": Known("grip"),
    "error": _Error("estimated error"),
    "energy": Known("energy", "J"),
    "impulse": Known("impulse", "N s"),
    "coupling": Known("coupling", "1/kg"),
    "position": Known("distance from the tip", "m", 1),
    "rebound_speed": Known("rebound speed", "m/s", 4),
    "apparent_restitution": Known("apparent restitution e_A", "", 4),
    "effective_mass": Known("effective mass", "kg"),
    "rigid_mass": Known("effective mass of a rigid beam", "kg"),
    "place_speed": Known("speed of the place at the end", "m/s", 4),
    "tip_stiffness": Known("shaft stiffness at the tip", "N/m"),
    "frequencies": Known("frequency", "Hz", 2),
    "near": Known("frequency asked for", "Hz"),
    "nearest": Known("nearest frequency", "Hz", 2),
    "tip_amplitudes": Known("tip amplitude", "1/sqrt(kg)", 3),
    "force": Known("force", "N"),
    "depth": Known("depth", "m", 2),
    "patch": Known("diameter of the patch", "m", 1),
    "tip_mass": Known("mass of the leather", "kg"),
    "E": Known("E", "Pa"),
    "G": Known("G", "Pa"),
    "rho": Known("rho", "kg/m^3"),
    "seconds": Known("seconds", "s"),
}
UNITS = {name: known.unit for name, known in QUANTITIES.items() if known.unit}
# How the tip gripped the ball, by what `cuefem.contact.outcome.grip_of` tells: a word for tables, and the same in full.
GRIPS = {
    "stick": ("held", "the tip held the ball, at once or after a short slip"),
    "late stick": ("held late", "slipped first, then held late, near a miscue"),
    "slip reversal": ("slipped back", "slipped first, then slipped back"),
    "miscue": ("miscue", "slipped to the end, a miscue"),
    "slides": ("let go", "held at first, then slid through more than a quarter of the push, near a miscue"),
    "lets go": ("miscue", "held at first, then slid through more than half of the push, a miscue"),
}


def units_of(*names: str) -> dict[str, str]:
    """The SI units of some quantities."""
    return {name: UNITS[name] for name in names}


def written(name: str, value: Any, *, brief: bool = False) -> str:
    """A value of the quantity of that name, with its unit."""
    return QUANTITIES[name].written(GRIPS[value][0] if name in ("regime", "grip") and value else value, brief=brief)


def grams(mass: float | None) -> str:
    """A mass in grams, to four digits where they are decimals."""
    return QUANTITIES["mass"].written(mass)


def degrees(angle: float | None) -> str:
    """An angle in degrees, to a thousandth."""
    return QUANTITIES["squirt"].written(angle)


def millimetres(length: float | None) -> str:
    """A length in whole millimetres."""
    return QUANTITIES["length"].written(length)
