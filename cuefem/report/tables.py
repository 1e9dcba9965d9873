"""Records as tables for people: numbers in the units of the trade, captions that say what they rest on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields
from typing import Any

from rich.console import Group
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from cuefem.cue import Cue, LumpedCue
from cuefem.effects import Effect
from cuefem.io.schema import table as file_table
from cuefem.report.records import Record, cue_record
from cuefem.report.whole import WholeTable
from cuefem.validation import NOISE, number

NONE = "–"


def table_of(title: str, columns: Sequence[str], *, text_columns: int = 1) -> Table:
    """An empty table: text to the left, numbers to the right; no cell of it is ever cut."""
    return WholeTable(title, columns, text_columns=text_columns)


def with_caption(table: Table, *lines: str) -> Group:
    """A table and, below it in its own width, what it rests on."""
    return Group(table, *(Padding(Text(line, style="dim"), (0, 0, 0, 2), expand=False) for line in lines), "")


def grams(mass: float) -> str:
    """A mass in grams, to four digits where they are decimals."""
    return significant(1e3 * mass) + " g"


def degrees(angle: float) -> str:
    """An angle in degrees, to a thousandth."""
    return f"{math.degrees(angle):.3f}°" if math.isfinite(angle) else NONE


def millimetres(length: float | None) -> str:
    """A length in whole millimetres."""
    return NONE if length is None or not math.isfinite(length) else f"{1e3 * length:.0f} mm"


def significant(value: float, digits: int = 4) -> str:
    """A number to so many digits where they are decimals."""
    if value == 0 or not math.isfinite(value):
        return f"{value:.0f}"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"


def assumptions(scene: Record) -> str:
    """Ball, tip and stroke in one line."""
    ball, tip, stroke = scene["ball"], scene["tip"], scene["stroke"]
    return ", ".join(
        [
            f"ball {grams(ball['mass'])}, {2e3 * ball['radius']:.4g} mm",
            f"contact time {1e3 * tip['contact_time']:.4g} ms",
            f"e {tip['restitution']:g}",
            f"mu {tip['friction']:g}".replace("inf", "∞"),
            f"stroke {stroke['speed']:g} m/s",
        ]
    )


def cue_line(cue: Record) -> str:
    """A cue in one line."""
    if "length" not in cue:
        return f"lumped cue, {grams(cue['mass'])}, end mass {grams(cue['end_mass'])}"
    pieces = f"{cue['segments']} segment" + ("s" if cue["segments"] > 1 else "")
    masses = f"segments {grams(cue['shaft_mass'])} + body {grams(cue['body_mass'])}"
    return f"{1e3 * cue['length']:.4g} mm modelled in {pieces}, cue {grams(cue['mass'])} ({masses})"


def plain_cue_line(cue: Cue | LumpedCue) -> str:
    """A cue in one line."""
    return cue_line(cue_record(cue))


def effect_words(effect: Effect) -> str:
    """An effect in a few words, what is as by default left out: "PointMass (position 100 mm, mass 5 g)"."""
    usual = {field.name: field.default for field in fields(effect)}
    given = {name: value for name, value in file_table(effect).items() if getattr(effect, name) != usual[name]}
    entries = [f"{name} {_short(value)}" for name, value in given.items()]
    return type(effect).__name__ + (f" ({', '.join(entries)})" if entries else "")


def _short(value: Any) -> str:
    """A number, with its unit if it has one, to six digits."""
    number_text, _, unit = str(value).partition(" ")
    return f"{float(number_text):.6g} {unit}".rstrip()


def modes_table(record: Record) -> Group:
    """Modes of a free cue (or of one held by the scene's effects)."""
    near = record["near"]
    title = "Bending modes" if near is None else f"Bending modes nearest {near:g} Hz"
    marked = [] if near is None else [""]
    table = table_of(title, ["frequency", "period", "tip amplitude", *marked], text_columns=0)
    for frequency, amplitude in zip(record["frequencies"], record["tip_amplitudes"], strict=True):
        period = f"{1e3 / frequency:.4g} ms"
        mark = ["nearest" if frequency == record["nearest"] else "" for _ in marked]
        table.add_row(f"{frequency:.2f} Hz", period, f"{amplitude:.3f} /√kg", *mark)
    motions = "1 rigid motion" if record["rigid"] == 1 else f"{record['rigid']} rigid motions"
    caption = f"{motions} at 0 Hz not listed; amplitudes of the mass-normalised modes"
    return with_caption(table, caption)


def end_mass_table(record: Record, scene: Record) -> Group:
    """The end masses by definition."""
    columns = ["definition", "m_e", "spread over modes", "m_c", "eps"]
    table = table_of("Effective end mass", columns)
    refused = []
    for drive, values in record["drives"].items():
        name = f"{drive}, at b/R {record['offset']:g}" if drive in ("offset", "squirt") else drive
        if values["end_mass"] is None:
            table.add_row(name, *[NONE] * 4)
            refused.append(f"{drive}: {values['reason']}")
            continue
        spread = f"{significant(1e3 * values['lowest'])}–{grams(values['highest'])}"
        row = (grams(values["end_mass"]), spread, grams(values["cue_end_mass"]), f"{values['eps']:.4f}")
        table.add_row(name, *row)
    return with_caption(
        table,
        assumptions(scene),
        *refused,
        "m_e: felt across the cue at the tip (offset: what lumped models take); spread: a quarter of the modes to all",
        "m_c = 4 m_e: cue end of the paper's two-part cue (nu_c 1/3); eps: m_c as a part of the ball's mass",
        *_tip_effects(scene, "stick, offset and squirt take effects at the tip for end mass; velocity, force do not"),
    )


def _tip_effects(scene: Record, words: str) -> list[str]:
    """A line about effects at the tip, where a scene has any."""
    return [words] if scene["effects_at_tip"] else []


_ROWS: tuple[tuple[str, str, Any], ...] = (
    ("squirt", "squirt", degrees),
    ("natural pivot length", "pivot_length", millimetres),
    ("ball speed", "ball_speed", lambda v: f"{v:.4f} m/s"),
    ("ball velocity, normal", "ball_velocity", lambda v: f"{v[1]:.4f} m/s"),
    ("ball velocity, tangent", "ball_velocity", lambda v: f"{v[0]:.4f} m/s"),
    ("spin", "spin", lambda v: f"{v:.3f} rad/s"),
    ("cue speed after", "cue_speed", lambda v: f"{v:.4f} m/s"),
    ("contact time", "duration", lambda v: f"{1e3 * v:.4f} ms"),
    ("how it went", "regime", str),
    ("estimated error", "error", lambda v: f"{v:.1e}"),
)


MISCUE = "this stroke miscues: the tip slips on the ball to the end; its squirt and pivot length are no shot's"


def strike_table(record: Record, scene: Record) -> Group:
    """One strike, a column for each model."""
    models = record["models"]
    offset = scene["stroke"]["offset"]
    table = table_of(f"Strike at offset b/R = {offset:g}", ["", *models])
    for label, key, written in _ROWS:
        values = [model.get(key) for model in models.values()]
        if any(value is not None for value in values):
            table.add_row(label, *(NONE if value is None else written(value) for value in values))
    felt = NONE if record["end_mass"] is None else grams(record["end_mass"])
    coupled = record["models"].get("coupled", {})
    missed = [MISCUE] if coupled.get("regime") == "miscue" else []
    exact = ", modes kept for 0.5 % of squirt" if "length" in scene["cue"] and coupled.get("error") is None else ""
    models = [f"coupled: vibrating shaft in time{exact}; two-part and A.31: end mass m_e {felt} (offset)"]
    return with_caption(table, *missed, assumptions(scene), *models, *_left_out(scene, record, "/kg"))


def _left_out(scene: Record, record: Record, unit: str) -> list[str]:
    """What the lumped models make of the effects at the tip."""
    lumped = (
        f"; lumped has them as a coupling of {record['coupling']:.4g} {unit}, the tip's "
        "speed across the cue by a unit of impulse along it"
        if record["coupling"]
        else ""
    )
    return _tip_effects(scene, f"two-part and A.31 leave the effects at the tip out{lumped}")


def _by_offset(title: str, record: Record, *, key: str, written: Any) -> Table:
    models = record["models"]
    table = table_of(title, ["b/R", *models], text_columns=0)
    for i, offset in enumerate(record["offsets"]):
        cells = (written(model[key][i]) + _missed(model, i) for model in models.values())
        table.add_row(f"{offset:g}", *cells)
    return table


def _missed(model: Record, i: int) -> str:
    """A word beside the number of a stroke that miscues, where a model tells."""
    return ", miscue" if "miscue" in model.get("regime", ())[i : i + 1] else ""


def squirt_table(record: Record, scene: Record) -> Group:
    """Squirt against the offset."""
    known = [mass for mass in record["end_mass"] if mass is not None]
    felt = f"{significant(1e3 * known[0])} to {grams(known[-1])}" if known else NONE
    models = (
        f"coupled: in time; two-part: m_e {felt} (offset); 12 g: the paper's m_c, m_e 3 g; A.31: Alciatore's formula"
    )
    table = _by_offset("Squirt", record, key="squirt", written=degrees)
    return with_caption(table, assumptions(scene), models, *_left_out(scene, record, "b/R /kg"))


def pivot_table(record: Record) -> Group:
    """Natural pivot length against the offset."""
    caption = "from the tip to the bridge about which turning the cue undoes squirt"
    table = _by_offset("Natural pivot length", record, key="pivot_length", written=millimetres)
    return with_caption(table, caption)


VERDICT_WORDS = (
    "agrees: ours rounds to the printed digits (formulas: the same to 1e-8; a statement without a number, printed –, "
    "holds; a number that hangs on what the source leaves open lies in the range of that, as the cause says); "
    "rounding: its own digits or stated approximation explain the difference; slip: a slip in the paper; "
    "not derivable: it gives too little to derive it"
)


def claims_table(record: Sequence[Record]) -> Table:
    """Claims of sources beside what follows from their equations."""
    columns = ["source: what, unit", "verdict", "printed", "ours", "difference"]
    table = table_of("Claims of the sources, checked", columns, text_columns=2)
    for claim in record:
        gap = claim["difference"]
        shown = NONE if gap is None else f"< {NOISE:g}" if abs(gap) < NOISE else f"{gap:.2g}"
        unit = f", {claim['unit']}" if claim["unit"] else ""
        numbers = (number(claim["printed"], 6), number(claim["derived"], 6), shown)
        table.add_row(f"{claim['source']}: {claim['what']}{unit}", claim["verdict"], *numbers)
    return table


def materials_table(record: Record) -> Group:
    """Materials: modulus, shear modulus and density with their ranges, loss factor; sources."""
    table = table_of("Materials", ["name", "E, GPa", "G, GPa", "rho, kg/m³", "loss"])
    for name, values in record["materials"].items():
        cells = (_with_range(values, key, scale=scale) for key, scale in (("E", 1e9), ("G", 1e9), ("rho", 1.0)))
        table.add_row(name, *cells, f"{values['loss']:g}")
    sources = (f"{name}: {values['source']}" for name, values in record["materials"].items())
    return with_caption(table, "with the ranges in which real pieces lie; `cuefem materials --json` has more", *sources)


def _with_range(values: Record, key: str, *, scale: float) -> str:
    low, high = values["ranges"][key]
    return f"{values[key] / scale:.4g} ({low / scale:.4g}–{high / scale:.4g})"
