"""The first screen of a design, which begins the page of `cuefem report` and is always visible in the designer.

Its parts are the headline, the scale of reference cues, five numbers that a maker can check, and the drawings; each
calls a macro of first_screen.html.j2.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import NamedTuple

from cuefem.analysis.verdict import Verdict, squirt_difference
from cuefem.files.cue_names import INSIDE_ASSUMED
from cuefem.files.reference_cues import inside_mark
from cuefem.parameters.parts import shaft_word
from cuefem.quantity.display_units import (
    DISTANCE,
    SHAFT_STIFFNESS,
    display_unit,
    displayed_system,
    short_number,
    to_display,
    unit_suffix,
    with_unit,
)
from cuefem.results.quantities import DASH, balance_point, drawn_mass
from cuefem.results.records import Record
from cuefem.scene import Scene
from cuefem.show.analysis import DESIGN_STYLES
from cuefem.show.drawings import DIAMETER_SCALE, FRONT_LENGTH, cue_drawing, lathe_drawing, leather_ahead, legend
from cuefem.show.templates import environment

STANDARD_GRAVITY = 9.80665  # m/s2
UNIT_WORDS = {"mm": "mm", "in": "inches"}
BENT = {"metric": 0.010, "us": 0.0254}  # m, by which a weight at the tip bends the shaft


@dataclass(frozen=True)
class HeadlineCue:
    """A design with its computed numbers, SI, by name, and its verdict if computed."""

    name: str
    scene: Scene
    numbers: Mapping[str, float | None]
    verdict: Verdict | None = None


class OtherValue(NamedTuple):
    """What another design has: its name, a text, and its CSS class."""

    name: str
    text: str
    style: str


class TileKind(NamedTuple):
    """A number of the first screen: label, key of the display unit, decimals, tooltip, and a note below it."""

    label: str
    unit: str
    decimals: int
    hint: str
    note: Callable[[Scene, float], str]


def _whole_cue(scene: Scene, _: float) -> str:
    return f"whole cue {with_unit(scene.cue.mass, 'kg', decimals=0)}"


def _weight_that_bends(_: Scene, stiffness: float) -> str:
    bent = BENT[displayed_system()]
    weight = f"{to_display(stiffness * bent / STANDARD_GRAVITY, 'kg'):.0f}{unit_suffix('kg')}"
    return f"{weight} at the tip bend it {with_unit(bent, 'm')}"


def _offset(scene: Scene, _: float) -> str:
    return f"back-hand English, b/R {abs(scene.stroke.offset):.4g}"


TILES = {
    "drawn_mass": TileKind("Weight", "kg", 1, "Mass of the drawn part with its tip, as on a scale", _whole_cue),
    "balance_point": TileKind(
        "Balance", DISTANCE, 0, "Centre of mass of the drawn part with its tip", lambda *_: "from the end of the tip"
    ),
    "tip_stiffness": TileKind(
        "Stiffness",
        SHAFT_STIFFNESS,
        0,
        "Static, transverse, at the tip; joint end clamped",
        _weight_that_bends,
    ),
    "frequency_1": TileKind(
        "Tap tone", "Hz", 0, "First natural frequency of bending, both ends free", lambda *_: "hung free, tapped"
    ),
    "pivot_length": TileKind(
        "Pivot length",
        DISTANCE,
        0,
        "Distance from the end of the tip to the point about which pivoting the cue cancels squirt",
        _offset,
    ),
}


DRAWN = {"drawn_mass": drawn_mass, "balance_point": balance_point}  # of the drawing alone


class Tile(NamedTuple):
    """A number of the first screen, a note on it, and what the other designs have."""

    key: str
    label: str
    hint: str
    text: str
    value: float | None
    note: str
    more: list[OtherValue]


Line = Sequence[tuple[str, str]]  # pieces of a line, each with the CSS class of a design or ""


def screen_markup(
    own: HeadlineCue, others: Sequence[HeadlineCue], lines: Sequence[Line], *, with_values: bool = False
) -> dict[str, str]:
    """The parts of the first screen of a page, by their names in page.html.j2.

    own: a design with a verdict. lines: below its squirt. with_values: whether the five numbers show those of the
    others, or only the differences from them.
    """
    assert own.verdict is not None
    designs = {each.name: each.scene for each in (own, *others)}
    return {
        "headline": headline_markup(own, lines, with_name=bool(others)),
        "scale": scale_markup(own, others),
        "tiles": tiles_markup(own, others, with_values=with_values),
        "drawings": drawings_markup(designs) if own.scene.cue.segments else "",
        "parts": parts_line(own.verdict),
    }


def cue_names(own: HeadlineCue, others: Sequence[HeadlineCue]) -> list[str]:
    """The names of the cues on a screen, those of the reference cues too."""
    return [*(each.name for each in (own, *others)), *(own.verdict.references if own.verdict else ())]


def headline_markup(own: HeadlineCue, lines: Sequence[Line] = (), warning: str = "", *, with_name: bool = False) -> str:
    """Squirt with its uncertainty, and lines below it.

    warning: about the contact state. with_name: whether it says of which design, as beside others.
    """
    verdict = own.verdict
    squirt, where = own.numbers["squirt"], f"{verdict.offset if verdict else own.scene.stroke.offset:.2f}"
    if verdict:
        text, error = verdict.squirt_text()
        where += " (default; this stroke is head-on)" if verdict.head_on else ""
    else:
        text, error = DASH if squirt is None else with_unit(abs(squirt), "rad", decimals=2), ""
    return _macro("headline", own.name if with_name else "", squirt, text, error, where, lines, warning)


def comparison_lines(
    own: HeadlineCue, other: HeadlineCue | None = None, difference: Record | None = None
) -> list[Line]:
    """The calibration of squirt, the difference of squirt from another design's and from a reference cue's, and how far
    off line the ball is.

    difference: of `cuefem.analysis.comparison`, from the other design.
    """
    verdict = own.verdict
    lines: list[Line] = []
    if verdict and verdict.calibrated:
        lines.append([(verdict.calibrated.origin(), "")])
    if other is not None and own.numbers["squirt"] is not None and (not verdict or verdict.references):
        text = "compared with" if difference is None else squirt_difference(**difference)
        lines.append([(f"{text} ", ""), (other.name, DESIGN_STYLES[1])])
    for first, among in [*(verdict.references.items() if verdict else ())][:1]:
        if other is None or other.name != first:
            text = squirt_difference(among["difference"], among["error"], among["distinct"])
            lines.append([(f"{text} {first}", "")])
    if verdict:
        lines.append([(verdict.off_line_text(), "")])
    return lines


def tiles(own: HeadlineCue, others: Sequence[HeadlineCue] = (), *, with_values: bool = False) -> list[Tile]:
    """The five numbers with their differences from other designs', or with those of the others and their differences
    from this design's. A difference is that of the shown values, so that it adds up."""
    made = []
    for key, kind in TILES.items():
        value = _value(own, key)
        more = []
        for style, other in zip(DESIGN_STYLES[1:], others, strict=False):
            beside = _value(other, key)
            if value is None or beside is None:
                continue
            if with_values:
                from_own = _difference(beside, value, kind.unit, kind.decimals)
                shown = f"{with_unit(beside, kind.unit, decimals=kind.decimals)} ({from_own})"
            else:
                shown = _difference(value, beside, kind.unit, kind.decimals)
            more.append(OtherValue(other.name, shown, style))
        note = "" if value is None or with_values else kind.note(own.scene, value)
        made.append(Tile(key, kind.label, kind.hint, _tile_text(own, key, value), value, note, more))
    return made


def _tile_text(own: HeadlineCue, key: str, value: float | None) -> str:
    """The value of a tile; of a pivot length with the uncertainty that it has by squirt."""
    kind = TILES[key]
    if value is None:
        return DASH
    if key == "pivot_length" and own.verdict:
        return with_unit(value, kind.unit, error=own.verdict.uncertainty["total"] * abs(value))
    return with_unit(value, kind.unit, decimals=kind.decimals)


def _difference(value: float, other: float, unit: str, decimals: int) -> str:
    """The difference of two values as shown, with its sign, without its unit."""
    shown, beside = (Decimal(short_number(each, unit, decimals=decimals)) for each in (value, other))
    return f"{shown - beside:+}".replace("-", "−") if shown != beside else "±0"


def _value(design: HeadlineCue, key: str) -> float | None:
    if key in DRAWN:
        value = DRAWN[key](design.scene) if design.scene.cue.segments else None
    else:
        value = design.numbers.get(key)
    return value if value is not None and math.isfinite(value) else None


def scale_markup(own: HeadlineCue, others: Sequence[HeadlineCue] = ()) -> str:
    """The reference cues, this design with its uncertainty, and the other ones, sorted by squirt."""
    squirts = {other.name: other.numbers["squirt"] for other in others}
    styled = {other.name: (style, squirts[other.name]) for style, other in zip(DESIGN_STYLES[1:], others, strict=False)}
    rows = own.verdict.scale(own.name, squirts) if own.verdict else []
    marks = {each.name: inside_mark(each.name, each.scene) for each in (own, *others)}
    marked = [row._replace(mark=marks.get(row.name, row.mark)) for row in rows]
    return _macro("scale", marked, styled, INSIDE_ASSUMED)


def tiles_markup(own: HeadlineCue, others: Sequence[HeadlineCue] = (), *, with_values: bool = False) -> str:
    """The five numbers as markup."""
    return _macro("tiles", tiles(own, others, with_values=with_values), with_values)


def drawings_markup(designs: Mapping[str, Scene]) -> str:
    """The tip ends of designs, true to scale, and the whole ones with enlarged diameters, each at one scale."""
    length = min([FRONT_LENGTH, *(scene.shaft.length for scene in designs.values())])
    title = f"first {with_unit(length, 'm', decimals=0)}, true to scale"
    ahead = max(map(leather_ahead, designs.values()))
    longest = max(scene.shaft.length for scene in designs.values())
    fronts, wholes = [], []
    for style, (name, scene) in zip(DESIGN_STYLES, designs.items(), strict=False):
        front = cue_drawing(scene, f"Tip end of {name}, {title}", length, diameter_scale=1.0, ahead=ahead)
        enlarged = f"{name}, diameters {DIAMETER_SCALE:g} times enlarged"
        whole = (
            lathe_drawing(scene, enlarged) if len(designs) == 1 else cue_drawing(scene, enlarged, longest, ahead=ahead)
        )
        fronts.append((name, style, front))
        wholes.append((name, style, whole))
    return _macro(
        "drawings", fronts, wholes, DIAMETER_SCALE, UNIT_WORDS[display_unit("m").name], legend(designs.values())
    )


def parts_line(verdict: Verdict) -> str:
    """The parts of the uncertainty: "± 0.35° (1σ) is 24 %: model 16 %, wood and tip 18 %"."""
    _, error = verdict.squirt_text()
    parts = verdict.uncertainty
    model, inputs = f"{100 * parts['model']:.0f} %", f"{100 * parts['inputs']:.0f} %"
    shaft = shaft_word(verdict.scene)
    if verdict.calibrated:
        model, inputs = f"calibrated model and tip {model}", f"{shaft} {inputs}"
    else:
        model, inputs = f"model {model}", f"{shaft} and tip {inputs}"
    return f"± {error} (1σ) is {100 * parts['total']:.0f} %: {model}, {inputs}"


def _macro(name: str, *values: object) -> str:
    return str(getattr(environment().get_template("first_screen.html.j2").module, name)(*values))
