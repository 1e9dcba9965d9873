"""The registry of results: every quantity of a scene, defined in one place.

A new quantity is one entry of `RESULTS`. It then appears in `report`, its JSON and the designer's numbers, and is a
response of sweeps, scatters and optima, with their tables, pages and pandas frames.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, Any

from cuefem.quantity.display_units import DISTANCE, END_MASS, SHAFT_STIFFNESS, number_text, unit_suffix
from cuefem.results.closed_forms import pivot_length
from cuefem.results.verdict import MISCUE_DEFINITION
from cuefem.scene import Outcome, Scene

if TYPE_CHECKING:  # at work every command that writes a number would pay for it
    from cuefem.results.solved_design import SolvedDesign

DASH = "–"
_METRIC_UNIT = r"[cmµ]?m|k?g|%|m?s|k?Hz|k?N(?:/m?m)?|[MG]Pa|m/s|m?J"
_US_UNIT = r"in|oz|mph|ft/s|lbf(?:/in)?|psi|in·lbf|lb/ft³|rpm"
_NUMBER_UNIT = re.compile(rf'(?<=\d) (?=(?:{_METRIC_UNIT}|{_US_UNIT})(?![\w/"`]))')


@dataclass(frozen=True)
class Result:
    """A quantity of a scene: its label, its SI unit ("" for a pure number or a text), and how it is computed.

    label: in texts. decimals: in the display unit; None for ``digits`` significant digits. heading: its column heading,
    by default the label. about: a one-line definition. of: its value for a solved design, at an argument (None: at the
    scene's own offset), or a ValueError with the reason why it is undefined; without it, only records have it and
    compute it. argument: its argument in brackets, "", "mode" or "offset". segments: whether it needs cue segments.
    limit: whether without an offset it is the limit of small offsets. better: "lower" or "higher", the direction in
    which a summary ranks designs. odd: whether it changes its sign with the offset b/R, so that designs are compared by
    its size. has_model_error: whether it follows from squirt, of which the model's error is measured. is_listed:
    whether a report and the designer list it (not if it has its own table). displayed: the key of its display unit, by
    default ``unit``.
    """

    label: str
    unit: str = ""
    decimals: int | None = None
    _: KW_ONLY
    digits: int = 4
    heading: str = ""
    about: str = ""
    of: Callable[[SolvedDesign, Any], float] | None = None
    argument: str = ""
    segments: bool = False
    limit: bool = False
    better: str = ""
    odd: bool = False
    has_model_error: bool = False
    is_listed: bool = True
    displayed: str = ""

    @property
    def column_heading(self) -> str:
        """Its name over a column."""
        return self.heading or self.label

    @property
    def display_key(self) -> str:
        """The key of its display unit (`cuefem.quantity.display_units.display_unit`)."""
        return self.displayed or self.unit

    def number(self, value: float) -> str:
        """A value in the display unit, without the unit."""
        return number_text(value, self.display_key, self.digits, decimals=self.decimals)

    def format(self, value: Any) -> str:
        """A value with its unit; a dash if there is no value; text unchanged."""
        if isinstance(value, str):
            return value
        if value is None or not math.isfinite(value):
            return DASH
        return self.number(float(value)) + unit_suffix(self.display_key)


def unbroken(text: str) -> str:
    """A text for a page with no line break between a number and its unit; values in quotes, to be copied, unchanged."""
    return _NUMBER_UNIT.sub("\u00a0", text)


# Represents the limit b -> 0 in formulas; the error is of its square.
SMALL_OFFSET = 1e-6


def _pivot_length(design: SolvedDesign, offset: float | None) -> float:
    if offset is None:
        return float(pivot_length(design.scene, design.coupled_slope * math.asin(SMALL_OFFSET), SMALL_OFFSET))
    return float(pivot_length(design.scene, design.squirt(offset), offset))


def of_strike(value: Callable[[Outcome], float]) -> Callable[[SolvedDesign, Any], float]:
    """A result of the coupled strike at an offset; by default at the scene's own."""
    return lambda design, offset: value(design.strike(offset))


def of_drawing(value: Callable[[Scene], Any]) -> Callable[[SolvedDesign, Any], float]:
    """A number that follows from the drawing."""
    return lambda design, _: float(value(design.scene))


def tip_height(scene: Scene) -> float:
    """Height of a LeatherTip, which is in front of the first segment, m; 0 if the drawing has the tip."""
    return 0.0 if scene.contact_terms.tip is None else float(scene.leather_tip.height)


def drawn_mass(scene: Scene) -> float:
    """Mass of the drawn part with its tip, kg, as on a scale."""
    return float(scene.shaft.shaft_mass + sum(mass for _, mass in _added_masses(scene)))


def balance_point(scene: Scene) -> float:
    """Centre of mass of the drawn part with its tip, m from the end of the tip; a LeatherTip's mass is at its base."""
    cue = scene.shaft
    moment = cue.shaft_mass * cue.balance_point + sum(x * mass for x, mass in _added_masses(scene))
    return float(tip_height(scene) + moment / drawn_mass(scene))


def _added_masses(scene: Scene) -> list[tuple[float, float]]:
    """Position and mass, m and kg, of the tip and of masses on the cue."""
    masses = ((effect, effect.mass_on(scene.shaft)) for effect in scene.cue_effects if effect.part_of_cue)
    return [(effect.positions[0], mass) for effect, mass in masses if mass]


def _thinnest_wall(scene: Scene) -> float:
    ends = ((s.tip_diameter - s.tip_bore, s.butt_diameter - s.butt_bore) for s in scene.shaft.segments)
    return min(map(min, ends)) / 2


RESULTS = {
    "shaft_mass": Result(
        label="mass of the drawn part, without an added tip",
        unit="kg",
        heading="shaft mass",
        about="mass of the segments",
        of=of_drawing(lambda scene: scene.shaft.shaft_mass),
        segments=True,
    ),
    "mass": Result("mass of the cue", "kg", heading="cue mass", of=of_drawing(lambda scene: scene.cue.mass)),
    "body_mass": Result("mass of the butt", "kg"),
    "end_mass": Result(
        label="end mass",
        unit="kg",
        about="stick definition, small offsets; at an offset: of a tip that sticks",
        of=lambda design, offset: design.end_mass("stick" if offset is None else "offset", offset),
        argument="offset",
        limit=True,
        better="lower",
        is_listed=False,
        displayed=END_MASS,
        has_model_error=True,
    ),
    "cue_end_mass": Result("mass of the cue's end", "kg", displayed=END_MASS),
    "length": Result("length", "m", 0),
    "rigid_length": Result("rigid length", "m", 0),
    "balance_point": Result(
        label="balance point of the drawn part, from the end of the tip",
        unit="m",
        decimals=1,
        heading="balance point",
        displayed=DISTANCE,
        about="centre of mass of the drawn part with its tip, from the end of the tip",
        of=of_drawing(balance_point),
        segments=True,
    ),
    "radius": Result("radius", "m", 2),
    "squirt": Result(
        label="squirt",
        unit="rad",
        decimals=2,
        about="of the coupled strike; a miscue has none",
        of=lambda design, offset: design.squirt(offset),
        argument="offset",
        better="lower",
        odd=True,
        has_model_error=True,
    ),
    "squirt_slope": Result(
        "squirt slope",
        about="squirt over phi = asin(b/R), rad/rad, in the limit of small offsets",
        of=lambda design, _: design.squirt_slope,
        better="lower",
        is_listed=False,
        has_model_error=True,
    ),
    "pivot_length": Result(
        label="natural pivot length",
        unit="m",
        decimals=0,
        displayed=DISTANCE,
        about="of small offsets, or of the coupled strike at an offset",
        of=_pivot_length,
        argument="offset",
        limit=True,
        better="higher",
        is_listed=False,
        has_model_error=True,
    ),
    "speed": Result("speed", "m/s", 2),
    "ball_speed": Result(
        label="ball speed",
        unit="m/s",
        decimals=2,
        about="after the coupled strike",
        of=of_strike(lambda outcome: outcome.ball_speed),
        argument="offset",
        better="higher",
    ),
    "ball_velocity": Result("ball velocity", "m/s", 2),
    "spin": Result("spin", "rad/s", 1),
    "cue_speed": Result("cue speed after", "m/s", 2),
    "contact_time": Result("contact time, rigid cue head-on", "s"),
    "duration": Result("contact time of this stroke", "s", 3),
    "regime": Result("contact"),
    "error": Result("estimated error", digits=2),
    "energy": Result("energy", "J", digits=3),
    "vibration_energy": Result(
        label="energy of vibration",
        unit="J",
        digits=3,
        about="energy of the cue's free vibration after the coupled strike",
        of=of_strike(lambda outcome: outcome.energy["cue vibration"]),
        argument="offset",
        better="lower",
    ),
    "impulse": Result("impulse", "N s"),
    "coupling": Result("coupling", "1/kg"),
    "position": Result("distance from the tip", "m", 1),
    "tip_stiffness": Result(
        label="shaft stiffness at the tip, static, joint end clamped",
        unit="N/m",
        heading="stiffness at the tip",
        displayed=SHAFT_STIFFNESS,
        about="static: force across the tip over its deflection, the joint end clamped",
        of=lambda design, _: design.tip_stiffness,
        segments=True,
        better="higher",
    ),
    "tip_diameter": Result(
        label="diameter of the tip",
        unit="m",
        decimals=2,
        heading="tip diameter",
        of=of_drawing(lambda scene: scene.tip_diameter),
        segments=True,
    ),
    "butt_diameter": Result("diameter of the butt", "m", 2),
    "wall": Result(
        label="thinnest wall (where solid, the radius)",
        unit="m",
        decimals=2,
        heading="thinnest wall",
        about="of the segments, at their ends; where solid, the radius",
        of=of_drawing(_thinnest_wall),
        segments=True,
        better="higher",
    ),
    "frequency": Result(
        label="natural frequency",
        unit="Hz",
        about="of a bending mode",
        of=lambda design, mode: design.frequency(mode),
        argument="mode",
        segments=True,
        is_listed=False,
    ),
    "frequencies": Result("frequency", "Hz"),
    "requested_frequency": Result("requested frequency", "Hz"),
    "nearest_frequency": Result("nearest frequency", "Hz"),
    "tip_amplitudes": Result("tip amplitude", "1/sqrt(kg)", 3),
    "force": Result("force", "N"),
    "indentation": Result("indentation", "m", 2),
    "stiffness": Result("stiffness of the tip", "N/m"),
    "patch": Result("contact diameter", "m", 1),
    "tip_mass": Result("mass of the tip", "kg", displayed=END_MASS),
    "E": Result("E", "Pa"),
    "G": Result("G", "Pa"),
    "rho": Result("rho", "kg/m^3"),
    "seconds": Result("seconds", "s"),
}
UNITS = {name: result.unit for name, result in RESULTS.items() if result.unit}
# The states of the contact (`Outcome.regime`) in full.
REGIMES = {
    "stick": "the tip sticks to the ball; no miscue",
    "late stick": "the tip slips first and sticks late; close to a miscue",
    "slip reversal": "the tip slips, then slips back",
    "partial slip": "partial slip that costs over 5 % of the ball's energy: squirt rises fast, close to a miscue",
    "gross slip": "gross slip: for more than a quarter of the normal impulse; close to a miscue",
    "miscue": f"miscue: {MISCUE_DEFINITION}",
}


def format_value(name: str, value: Any) -> str:
    """A value of the quantity of that name, with its unit."""
    return RESULTS[name].format(value)
