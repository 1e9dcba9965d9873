"""What measured cues tell: measured beside computed, and what the measurements together say of uncertain parameters."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cuefem.measurements.estimate import Estimate, Worth
from cuefem.measurements.measured_cue import MeasuredCue, Residual, Zero
from cuefem.results.quantities import NONE, with_unit
from cuefem.results.records import Entry, Record, Sheet, sheet

FAR = 3.0  # residuals that deserve a word
UNITS = {"residual": "", "pull": "", "zero": "m", "squirt_error": "rad"}
DOUBTED = 0.2  # chance of a measurement to be wrong that deserves one


def row_record(row: Residual) -> Record:
    """A measurement beside the model's value."""
    measurement = row.measurement
    names = ("measured", "error", "computed", "spread", "residual", "pull")
    return {
        "kind": measurement.key,
        "what": measurement.label,
        "unit": measurement.unit,
        "source": measurement.source,
    } | {name: getattr(row, name) for name in names}


def compare_record(cue: MeasuredCue, rows: Sequence[Residual], zeros: Sequence[Zero]) -> Record:
    """Everything measured beside everything computed, and what is missing."""
    return {
        "name": cue.name,
        "source": cue.source,
        "rows": [row_record(row) for row in rows],
        "rms_pull": float(np.sqrt(np.mean([row.pull**2 for row in rows]))) if rows else None,
        "zeros": [{"what": zero.measurement.label, "zero": zero.zero, "error": zero.error} for zero in zeros],
        "open": [parameter.words for parameter in cue.parameters],
        "lacking": cue.lacking,
        "units": UNITS,
    }


def compare_sheets(record: Record) -> list[Sheet | str]:
    """For people: the table, the zeros, what is missing."""
    sourced = ["source"] if any(row["source"] for row in record["rows"]) else []
    made: list[Sheet | str] = []
    if record["rows"]:
        made.append(_fit_sheet("Measured and computed", record, "of both", *sourced))
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
        "measurements": len(estimate.cue.measurements),
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
    """For people: the uncertain parameters, how the measurements fit then, and what to measure next."""
    squirt = with_unit(record["squirt"], "rad", error=record["squirt_error"])
    return [
        sheet(
            "What the measurements tell",
            {"uncertain parameter": "{words}", "drawing": _value("before"), "estimate": _value("value")} | _INTERVAL,
            record["values"],
            *_estimate_notes(record),
        ),
        _fit_sheet("Measured and computed with the estimate", record),
        "",
        f"squirt at b/R {record['offset']:.4g} by the model with these parameters: {squirt}",
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
