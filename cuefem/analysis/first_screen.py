"""The first screen of a design, which begins the page of `cuefem report` and is always visible in the designer.

Its parts are the headline, the scale of reference cues, four numbers and the drawings; each calls a macro of
first_screen.html.j2.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from cuefem.analysis.verdict import Verdict, squirt_difference
from cuefem.parameters.parts import shaft_word
from cuefem.quantity.display_units import END_MASS, OFF_LINE, short_number, with_unit
from cuefem.results.quantities import DASH
from cuefem.results.records import Record
from cuefem.scene import Scene
from cuefem.show.drawings import DIAMETER_SCALE, FRONT_LENGTH, cue_drawing, legend
from cuefem.show.templates import environment

# The four numbers: label, key of the display unit, decimals, tooltip.
TILES = {
    "off_line": ("Off line", OFF_LINE, 0, "Distance of the ball from the line of aim over its path"),
    "end_mass_squirt": ("End mass", END_MASS, 2, "Squirt-equivalent: mass at the tip of a lumped cue with this squirt"),
    "pivot_length": (
        "Pivot length",
        "m",
        0,
        "Distance from the end of the tip to the point about which pivoting the cue cancels squirt",
    ),
    "tip_stiffness": ("Stiffness", "N/m", 0, "Static, transverse, at the tip; joint end clamped"),
}


@dataclass(frozen=True)
class HeadlineCue:
    """A design with its computed numbers, SI, by name, and its verdict if computed."""

    name: str
    scene: Scene
    numbers: Mapping[str, float | None]
    verdict: Verdict | None = None


class Tile(NamedTuple):
    """A number of the first screen, and its difference from the other design's."""

    key: str
    label: str
    hint: str
    text: str
    value: float | None
    more: str


def headline_markup(
    own: HeadlineCue, other: HeadlineCue | None = None, difference: Record | None = None, warning: str = ""
) -> str:
    """Squirt with its uncertainty, and its difference from another design's and from a reference cue's.

    difference: of `cuefem.analysis.comparison`, from the other design. warning: about the contact state.
    """
    verdict = own.verdict
    squirt, where = own.numbers["squirt"], f"{verdict.offset if verdict else own.scene.stroke.offset:.2f}"
    if verdict:
        text, error = verdict.squirt_text()
        where += " (default; this stroke is head-on)" if verdict.head_on else ""
    else:
        text, error = DASH if squirt is None else with_unit(abs(squirt), "rad", decimals=2), ""
    lines = []
    if verdict and verdict.calibrated:
        lines.append((verdict.calibrated.headline(), ""))
    if other is not None and squirt is not None and (not verdict or verdict.references):
        lines.append(("compared with" if difference is None else squirt_difference(**difference), other.name))
    for first, among in [*(verdict.references.items() if verdict else ())][:1]:
        if other is None or other.name != first:
            line = squirt_difference(among["difference"], among["error"], among["distinct"])
            lines.append((line, first))
    return _macro("headline", squirt, text, error, where, lines, warning)


def tiles(own: HeadlineCue, other: HeadlineCue | None = None) -> list[Tile]:
    """The four numbers, each with its difference from the other design's."""
    made = []
    for key, (label, unit, decimals, hint) in TILES.items():
        value, beside = _value(own, key), None if other is None else _value(other, key)
        text = DASH if value is None else with_unit(value, unit, decimals=decimals)
        more = "" if value is None or beside is None else _difference(value - beside, unit, decimals)
        made.append(Tile(key, label, hint, text, value, more))
    return made


def _difference(difference: float, unit: str, decimals: int) -> str:
    """A difference with its sign, without its unit."""
    text = short_number(difference, unit, decimals=decimals)
    if not float(text):
        return "±0"
    return text.replace("-", "−") if difference < 0 else f"+{text}"


def _value(design: HeadlineCue, key: str) -> float | None:
    squirt = design.numbers.get("squirt")
    value = (math.tan(abs(squirt)) if squirt else None) if key == "off_line" else design.numbers.get(key)
    return value if value is not None and math.isfinite(value) else None


def scale_markup(own: HeadlineCue, other: HeadlineCue | None = None) -> str:
    """The reference cues, this design with its uncertainty, and the other one, sorted by squirt."""
    beside = None if other is None else (other.name, other.numbers["squirt"])
    return _macro("scale", own.verdict.scale(own.name, beside) if own.verdict else [], other)


def tiles_markup(own: HeadlineCue, other: HeadlineCue | None = None) -> str:
    """The four numbers as markup."""
    return _macro("tiles", tiles(own, other))


def drawings_markup(designs: Mapping[str, Scene]) -> str:
    """The tip ends of one or two designs, true to scale, and the whole first one with enlarged diameters."""
    first = next(iter(designs.values()))
    length = min([FRONT_LENGTH, *(scene.shaft.length for scene in designs.values())])
    title = f"first {with_unit(length, 'm', decimals=0)}, true to scale"
    fronts = [
        (name, cue_drawing(scene, f"Tip end of {name}, {title}", length, diameter_scale=1.0))
        for name, scene in designs.items()
    ]
    whole = cue_drawing(first, f"Whole drawing, diameters {DIAMETER_SCALE:g} times enlarged")
    return _macro("drawings", fronts, whole, DIAMETER_SCALE, legend(designs.values()))


def parts_line(verdict: Verdict) -> str:
    """The parts of the uncertainty: "± 0.35° (1σ) is 24 %: model 16 %, wood and tip 18 %"."""
    _, error = verdict.squirt_text()
    parts = verdict.uncertainty
    model, inputs = f"{100 * parts['model']:.0f} %", f"{100 * parts['inputs']:.0f} %"
    return (
        f"± {error} (1σ) is {100 * parts['total']:.0f} %: model {model}, {shaft_word(verdict.scene)} and tip {inputs}"
    )


def _macro(name: str, *values: object) -> str:
    return str(getattr(environment().get_template("first_screen.html.j2").module, name)(*values))
