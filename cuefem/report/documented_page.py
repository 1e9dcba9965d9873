"""What documented cues tell: measured beside computed, and what the measurements together say of the unknowns."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from cuefem.measured.documented import DocumentedCue, Row, Zero
from cuefem.measured.estimate import Estimate, Worth
from cuefem.measured.kinds import AddedMass, Squirt
from cuefem.report.charts import WIDE, Axis, Chart, Curve, Tick, chart
from cuefem.report.drawings import cue_drawing, front_drawing
from cuefem.report.glossary import with_words
from cuefem.report.scene_words import effect_words, plain_cue_line
from cuefem.report.templates import environment
from cuefem.results.quantities import NONE, scaled, with_unit
from cuefem.results.records import Entry, Record, Sheet, sheet

COMPARED_OFFSETS = tuple(round(0.05 * i, 2) for i in range(1, 11))  # b/R of the computed curve
EDGE = 5.0  # residuals beyond this are drawn at the edge
FAR = 3.0  # residuals that deserve a word
UNITS = {"residual": "", "pull": "", "zero": "m", "squirt_error": "rad"}
DOUBTED = 0.2  # chance of a measurement to be wrong that deserves one


def row_record(row: Row) -> Record:
    """A measurement beside the model's value."""
    measurement = row.measurement
    names = ("measured", "error", "computed", "spread", "residual", "pull")
    return {
        "kind": measurement.key,
        "what": measurement.label,
        "unit": measurement.unit,
        "source": measurement.source,
    } | {name: getattr(row, name) for name in names}


def compare_record(cue: DocumentedCue, rows: Sequence[Row], zeros: Sequence[Zero]) -> Record:
    """Everything measured beside everything computed, and what is missing."""
    return {
        "name": cue.name,
        "source": cue.source,
        "rows": [row_record(row) for row in rows],
        "rms_pull": float(np.sqrt(np.mean([row.pull**2 for row in rows]))) if rows else None,
        "zeros": [{"what": zero.measurement.label, "zero": zero.zero, "error": zero.error} for zero in zeros],
        "open": [unknown.words for unknown in cue.unknowns],
        "lacking": cue.lacking,
        "units": UNITS,
    }


def compare_sheets(record: Record) -> list[Sheet | str]:
    """For people: the table, the zeros, what is missing."""
    made: list[Sheet | str] = [_fit_sheet("Measured and computed", record, "of both")] if record["rows"] else []
    made += [*contradictions(record), *zero_lines(record)]
    if record["lacking"]:
        made += ["not measured, and what that costs:", *(f"  {words}" for words in record["lacking"])]
    return made


def _fit_sheet(title: str, record: Record, *more: str) -> Sheet:
    """What was measured beside what is computed; more: "of both", "source"."""
    columns: dict[str, Entry] = {"what": "{what}", **{value: _with_error(value, error) for value, error in PAIRS}}
    columns["residual"] = "{residual:+.1f}"
    columns |= {heading: entry for heading, entry in MORE.items() if heading in more}
    return sheet(title, columns, record["rows"], *(captions(record) if more else ()), texts=(0, 5))


def _with_error(value: str, error: str) -> Entry:
    return lambda row: with_unit(row[value], row["unit"], error=row[error])


MORE = {"of both": "{pull:+.1f}", "source": "{source}"}
PAIRS = (("measured", "error"), ("computed", "spread"))


def captions(record: Record) -> list[str]:
    """What the columns of the table are."""
    return [
        "Every ± is one standard deviation; that of a computed value comes from what the drawing leaves open: "
        f"{', '.join(record['open'])}.",
        "Residual: measured less computed, in units of the measurement's error; of both: of both errors together "
        f"(root mean square {record['rms_pull']:.2f}).",
    ]


def contradictions(record: Record) -> list[str]:
    """The measurements that neither their errors nor what the drawing leaves open explain."""
    made = []
    for row in record["rows"]:
        if abs(row["pull"]) > FAR:
            measured, computed = (with_unit(row[value], row["unit"], error=row[error]) for value, error in PAIRS)
            apart = f"measured {measured}, computed {computed}, {abs(row['pull']):.1f} errors of both apart"
            made.append(f"{row['what']} contradicts the drawing: {apart}")
    return made


def zero_lines(record: Record) -> list[str]:
    """What the two sides say of the zero of the offset."""
    if not record["zeros"]:
        return []
    weights = np.array([1 / zero["error"] ** 2 for zero in record["zeros"]])
    mean = float(weights @ [zero["zero"] for zero in record["zeros"]] / weights.sum())
    told, side = with_unit(abs(mean), "m", error=float(weights.sum() ** -0.5)), "left" if mean > 0 else "right"
    return [f"The strokes hit {told} to the {side} of their aim; the mean of left and right is free of it"]


class ResidualBar(NamedTuple):
    """A residual on the page: its words, its places for both errors together and for the measurement's alone."""

    what: str
    at: float
    alone: float
    text: str
    style: str


def compare_page(cue: DocumentedCue, rows: Sequence[Row], record: Record, notes: Sequence[str]) -> str:
    """The comparison as a page."""
    scene = cue.scene
    left, right = 210.0, WIDE - 44
    across = Axis("", -EDGE, EDGE).over([[0.0]])

    def place(value: float) -> float:
        return float(across.place(min(max(value, -EDGE), EDGE), left, right))

    bars = [
        ResidualBar(row.measurement.label, place(row.pull), place(row.residual), f"{row.pull:+.1f}", _style(row.pull))
        for row in rows
    ]
    drawings = [cue_drawing(scene, across=1.0), cue_drawing(scene, across=8.0), front_drawing(scene)]
    sourced = ["source"] if any(row["source"] for row in record["rows"]) else []
    template = environment().get_template("documented.html.j2")
    facts = [plain_cue_line(scene.cue), *(f"with {effect_words(effect)}" for effect in scene.effects)]
    facts += [cue.source] if cue.source else []
    figures = _figures(rows, record)
    text = template.render(
        name=cue.name,
        facts=facts,
        notes=list(notes),
        figures=figures,
        bars=bars,
        ticks=[Tick(place(tick), f"{tick:g}") for tick in (-4, -2, 0, 2, 4)],
        ends=(left, right),
        band=(place(-2), place(2)),
        height=22.0 * len(bars) + 44,
        table=_fit_sheet("Measured and computed", record, "of both", *sourced) if rows else None,
        zeros=[*contradictions(record), *zero_lines(record)],
        lacking=record["lacking"],
        drawings=drawings,
        charts=[*_squirt_charts(cue, rows), *_mass_charts(rows)],
    )
    return with_words(text) + "\n"


def _style(pull: float) -> str:
    return "c2" if abs(pull) > FAR else "c1"


def _figures(rows: Sequence[Row], record: Record) -> list[tuple[str, str, str]]:
    if not rows:
        return [("measurements", "0", "nothing was measured")]
    near = sum(abs(row.pull) <= 2 for row in rows)
    kinds = len({row.measurement.key for row in rows})
    return [
        ("measurements", f"{len(rows)}", f"of {kinds} kind{'s' if kinds > 1 else ''}"),
        ("within two errors", f"{near}", "of both measurement and drawing"),
        ("root mean square", f"{record['rms_pull']:.2f}", "of the residuals, in errors; 1 is what errors alone make"),
        ("kinds missing", f"{len(record['lacking'])}", "in part or whole, listed below"),
    ]


def _crosses(x: Any, y: Any, error: Any, width: float) -> tuple[Any, Any]:
    """Points with error bars as one broken line."""
    gap = np.full(len(x), np.nan)
    across = np.column_stack([x - width, x + width, gap, x, x, gap])
    up = np.column_stack([y, y, gap, y - error, y + error, gap])
    return across.ravel(), up.ravel()


def _squirt_charts(cue: DocumentedCue, rows: Sequence[Row]) -> list[Chart]:
    """Squirt against offset, if it was measured."""
    strokes = [(row, row.measurement) for row in rows if isinstance(row.measurement, Squirt)]
    if not strokes:
        return []
    setup = cue.setup()
    x = np.array([stroke.offset for _, stroke in strokes])
    y, error = (np.degrees([getattr(row, name) for row, _ in strokes]) for name in ("measured", "error"))
    top = max([*COMPARED_OFFSETS[:1], *(each for each in COMPARED_OFFSETS if each <= x.max() + 0.05)])
    offsets = [each for each in COMPARED_OFFSETS if each <= top]
    curve = np.degrees([setup.numbers.squirt(each) for each in offsets])
    speed = f"{float(cue.scene.stroke.speed):.3g} m/s"
    curves = [
        Curve("measured", *_crosses(x, y, error, 0.006), "c1"),
        Curve(f"computed, {speed}", [0.0, *offsets], [0.0, *curve], "c2"),
    ]
    return [chart("Squirt against the offset", curves, x=Axis("offset b/R", 0.0), y=Axis("squirt, °", 0.0))]


def _mass_charts(rows: Sequence[Row]) -> list[Chart]:
    """Squirt with masses over that without, a chart for each mass."""
    masses = sorted({row.measurement.mass for row in rows if isinstance(row.measurement, AddedMass)})
    made = []
    for mass in masses:
        own = [row for row in rows if isinstance(row.measurement, AddedMass) and row.measurement.mass == mass]
        own.sort(key=lambda row: row.measurement.position)  # type: ignore[attr-defined]
        x = scaled([row.measurement.position for row in own], "m")  # type: ignore[attr-defined]
        y, error, computed = (
            np.array([getattr(row, name) for row in own]) for name in ("measured", "error", "computed")
        )
        curves = [Curve("measured", *_crosses(x, y, error, 2.0), "c1"), Curve("computed", x, computed, "c2")]
        title = f"Squirt with {with_unit(mass, 'kg', 3)} on the shaft, over that without"
        low = 0.1 * math.floor(10 * min((y - error).min(), computed.min()))
        ends = Axis("distance from the end of the tip, mm", 0.0), Axis("ratio", low)
        made.append(chart(title, curves, x=ends[0], y=ends[1]))
    return made


def worth_record(worth: Worth) -> Record:
    """What a further measurement would tell."""
    measurement = worth.measurement
    about = {"kind": measurement.key, "what": measurement.label, "unit": measurement.unit, "error": measurement.sd}
    return about | {name: value for name, value in worth._asdict().items() if name != "measurement"}


def estimate_record(estimate: Estimate, worths: Sequence[Worth], squirt: tuple[float, float], offset: float) -> Record:
    """What all measurements together say."""
    sd = np.sqrt(np.diag(estimate.covariance))
    return {
        "name": estimate.cue.name,
        "values": [value._asdict() for value in estimate.values],
        "correlations": (estimate.covariance / np.outer(sd, sd)).tolist(),
        "rows": [row_record(row) for row in estimate.rows],
        "misfit": estimate.misfit,
        "measurements": len(estimate.cue.found),
        "wrong": estimate.wrong.tolist(),
        "unchecked": [{"what": each.measurement.label, "without": each.value._asdict()} for each in estimate.unchecked],
        "converged": estimate.converged,
        "squirt": squirt[0],
        "squirt_error": squirt[1],
        "offset": offset,
        "next": [worth_record(worth) for worth in worths],
        "units": UNITS,
    }


def estimate_sheets(record: Record) -> list[Sheet | str]:
    """For people: the unknowns, how the measurements fit then, and what to measure next."""
    squirt = with_unit(record["squirt"], "rad", error=record["squirt_error"])
    return [
        sheet(
            "What the measurements tell",
            {"unknown": "{words}", "drawing": _value("before"), "estimate": _value("value")} | _INTERVAL,
            record["values"],
            *_estimate_notes(record),
        ),
        _fit_sheet("Measured and computed with the estimate", record),
        "",
        f"squirt at b/R {record['offset']:g} by the model with these unknowns: {squirt}",
        "",
        sheet(
            "What to measure next",
            {
                "measurement": "{what}",
                "with an error of": lambda worth: with_unit(worth["error"], worth["unit"]) if worth["unit"] else NONE,
                "narrows most": "{narrows}",
                "to": "{left:.0 %}",
                "squirt then": "± {squirt_left:.1 %}",
            },
            record["next"],
            "The most telling about squirt first; squirt then: the relative error of the squirt above that is left.",
        ),
    ]


def _value(name: str) -> Entry:
    return lambda value: with_unit(value[name], value["unit"])


_INTERVAL: dict[str, Entry] = {
    "68 %": lambda value: " to ".join(with_unit(value[end], value["unit"]) for end in ("low", "high")),
    "error left": "{narrowed:.0 %}",
}


def _estimate_notes(record: Record) -> list[str]:
    misfit, count = record["misfit"], record["measurements"]
    notes = [f"Misfit {misfit:.1f} of {count} measurements and the priors: about {count} is what errors alone make."]
    if misfit > count + 3 * math.sqrt(2 * count):
        notes.append("It is too large: a measurement, an error or the model is wrong.")
    for row, chance in zip(record["rows"], record["wrong"], strict=True):
        if chance > DOUBTED:
            notes.append(
                f"{row['what']} contradicts the others and hardly counts (chance of being wrong {100 * chance:.0f} %)."
            )
    for each in record["unchecked"]:
        without = each["without"]
        low, high = (with_unit(without[end], without["unit"]) for end in ("low", "high"))
        notes.append(
            f"Nothing here checks {each['what']}, and the intervals hold no mistake in it: without it, "
            f"{without['words']} is {low} to {high} (68 %)."
        )
    if not record["converged"]:
        notes.append(
            "The search did not settle: the measurements contradict each other, and the intervals are too narrow."
        )
    return [*notes, "Error left: the width of the interval over that before any measurement."]
