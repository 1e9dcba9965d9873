"""A measured cue: measured values beside computed ones, and the estimate of its uncertain parameters."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cuefem.measurements.estimate import STEP_TOLERANCE, Estimate, InformationGain
from cuefem.measurements.measured_cue import MeasuredCue, OffsetZero, Residual
from cuefem.measurements.uncertain_parameters import SQUIRT_MODEL
from cuefem.results.quantities import DASH, with_unit
from cuefem.results.records import ColumnEntry, Record, Table, tabulate
from cuefem.results.uncertainty import model_error

LARGE_RESIDUAL = 3.0  # a larger one is a contradiction
UNITS = {"model_error": "", "residual": "", "normalized_residual": "", "zero_error": "m", "squirt_error": "rad"}
MIN_OUTLIER_PROBABILITY = 0.2  # of a measurement with a note


def row_record(row: Residual) -> Record:
    """A measurement with the model's value, both SI with 1 sigma; see `Residual`."""
    measurement = row.measurement
    names = ("measured_value", "error", "computed_value", "spread", "residual", "normalized_residual")
    return {
        "kind": measurement.key,
        "label": measurement.label,
        "unit": measurement.unit,
        "source": measurement.source,
    } | {name: getattr(row, name) for name in names}


def measured_record(cue: MeasuredCue, rows: Sequence[Residual], zeros: Sequence[OffsetZero]) -> Record:
    """Every measurement with its computed value, the zero errors of the offset, and the missing measurements."""
    return {
        "name": cue.name,
        "source": cue.source,
        "rows": [row_record(row) for row in rows],
        "rms_normalized_residual": float(np.sqrt(np.mean([r.normalized_residual**2 for r in rows]))) if rows else None,
        "zero_errors": [{"label": z.measurement.label, "zero_error": z.zero_error, "error": z.error} for z in zeros],
        "uncertain_parameters": [parameter.label for parameter in cue.parameters],
        "missing": cue.missing,
        "units": UNITS,
    }


def tabulate_measured(record: Record) -> list[Table | str]:
    """Measured and computed values, contradictions, the zero error of the offset, and missing measurements."""
    sourced = ["source"] if any(row["source"] for row in record["rows"]) else []
    blocks: list[Table | str] = []
    if record["rows"]:
        blocks.append(_tabulate_fit("Measured and computed", record, "normalized residual", *sourced))
    blocks += [*contradictions(record), *zero_lines(record)]
    if record["missing"]:
        blocks += ["Missing measurements and their consequences:", *(f"  {line}" for line in record["missing"])]
    return blocks


def _tabulate_fit(title: str, record: Record, *optional: str) -> Table:
    """A row for each measurement with its computed value. optional: names of `OPTIONAL_COLUMNS`."""
    columns: dict[str, ColumnEntry] = {"measurement": "{label}"}
    columns |= {heading: _with_error(*names) for heading, names in VALUES_WITH_ERRORS.items()}
    columns["residual"] = "{residual:+.1f}"
    columns |= {heading: entry for heading, entry in OPTIONAL_COLUMNS.items() if heading in optional}
    return tabulate(title, columns, record["rows"], *captions(record), texts=(0, 5))


def _with_error(value: str, error: str) -> ColumnEntry:
    return lambda row: with_unit(row[value], row["unit"], error=row[error])


OPTIONAL_COLUMNS = {"normalized residual": "{normalized_residual:+.1f}", "source": "{source}"}
VALUES_WITH_ERRORS = {"measured": ("measured_value", "error"), "computed": ("computed_value", "spread")}


def captions(record: Record) -> list[str]:
    """Definitions of the table's columns; an estimate's table has no normalized residual."""
    residual = "Residual: measured minus computed, over the measurement's 1σ"
    if "rms_normalized_residual" not in record:
        return [f"±: 1σ; that of a computed value comes from the estimated parameters. {residual}."]
    return [
        "±: 1σ; that of a computed value comes from the uncertain parameters of the drawing: "
        f"{', '.join(record['uncertain_parameters'])}.",
        f"{residual}; normalized residual: over both 1σ combined (RMS {record['rms_normalized_residual']:.2f}).",
    ]


def contradictions(record: Record) -> list[str]:
    """The measurements with a large normalized residual, as text."""
    lines = []
    for row in record["rows"]:
        if (sigmas := abs(row["normalized_residual"])) > LARGE_RESIDUAL:
            measured, computed = (
                with_unit(row[value], row["unit"], error=row[error]) for value, error in VALUES_WITH_ERRORS.values()
            )
            difference = f"measured {measured}, computed {computed}, a difference of {sigmas:.1f} combined σ"
            lines.append(f"{row['label']} contradicts the drawing: {difference}")
    return lines


def zero_lines(record: Record) -> list[str]:
    """The zero error of the offset, from strokes on the left and on the right; empty without them."""
    if not record["zero_errors"]:
        return []
    weights = np.array([1 / zero["error"] ** 2 for zero in record["zero_errors"]])
    mean = float(weights @ [zero["zero_error"] for zero in record["zero_errors"]] / weights.sum())
    zero, side = with_unit(abs(mean), "m", error=float(weights.sum() ** -0.5)), "left" if mean > 0 else "right"
    return [f"The strokes hit {zero} to the {side} of their aim; the mean of left and right is free of it"]


def gain_record(gain: InformationGain) -> Record:
    """A further measurement, and the uncertainty that would remain after it; see `InformationGain`."""
    measurement = gain.measurement
    about = {"kind": measurement.key, "label": measurement.label, "unit": measurement.unit, "error": measurement.sd}
    return about | {name: value for name, value in gain._asdict().items() if name != "measurement"}


def estimate_record(
    estimate: Estimate, gains: Sequence[InformationGain], squirt: tuple[float, float], offset: float
) -> Record:
    """The estimated parameters, the fit, squirt and recommended measurements.

    squirt: value and 1σ, rad, at ``offset``, b/R, with the model error only if squirt was measured. gains: of the
    recommended measurements.
    """
    sd = np.sqrt(np.diag(estimate.covariance))
    measured_squirt = any(value.name == SQUIRT_MODEL for value in estimate.values)
    return {
        "name": estimate.cue.name,
        "values": [value._asdict() for value in estimate.values],
        "correlations": (estimate.covariance / np.outer(sd, sd)).tolist(),
        "rows": [row_record(row) for row in estimate.residuals],
        "misfit": estimate.misfit,
        "measurement_count": len(estimate.cue.measurements),
        "outlier_probability": estimate.outlier_probability.tolist(),
        "unchecked_measurements": [
            {"label": each.measurement.label, "without": each.without._asdict()}
            for each in estimate.unchecked_measurements
        ],
        "converged": estimate.converged,
        "squirt": squirt[0],
        "squirt_error": squirt[1],
        "model_error": None if measured_squirt else model_error(estimate.cue.scene),
        "offset": offset,
        "recommended_measurements": [gain_record(gain) for gain in gains],
        "units": UNITS,
    }


def tabulate_estimate(record: Record) -> list[Table | str]:
    """The estimated parameters, the fit of the measurements, squirt, and recommended measurements."""
    squirt, model = with_unit(record["squirt"], "rad", error=record["squirt_error"]), record["model_error"]
    return [
        tabulate(
            "Estimated parameters",
            {"uncertain parameter": "{label}", "drawing": _value("drawing"), "estimate": _value("value")} | _INTERVAL,
            record["values"],
            *_estimate_notes(record),
        ),
        _tabulate_fit("Measured and computed with the estimate", record),
        "",
        f"squirt at b/R {record['offset']:.4g} by the model with these parameters: {squirt} "
        + (
            f"(parameters only; the model error of {100 * model:.0f} % comes on top)" if model else "(with model error)"
        ),
        "",
        tabulate(
            "Recommended measurements",
            {
                "measurement": "{label}",
                "1σ": lambda gain: with_unit(gain["error"], gain["unit"]) if gain["unit"] else DASH,
                "parameter improved most": "{parameter}",
                "its σ, after/before": "{error_ratio:.0 %}",
                "σ of squirt after": "{relative_squirt_error:.1 %}",
            },
            record["recommended_measurements"],
            "Sorted by the relative uncertainty (1σ) of squirt after the measurement.",
        ),
    ]


def _value(name: str) -> ColumnEntry:
    return lambda value: with_unit(value[name], value["unit"])


_INTERVAL: dict[str, ColumnEntry] = {
    "68 %": lambda value: " to ".join(with_unit(value[end], value["unit"]) for end in ("low", "high")),
    "remaining": "{error_ratio:.0 %}",
}


def _estimate_notes(record: Record) -> list[str]:
    misfit, count = record["misfit"], record["measurement_count"]
    notes = [f"Misfit {misfit:.1f} (chi-square of {count} measurements and the priors); expected about {count}."]
    if misfit > count + 3 * math.sqrt(2 * count):
        notes.append("That is too large: a measurement, a stated error or the model is wrong.")
    for row, probability in zip(record["rows"], record["outlier_probability"], strict=True):
        if probability > MIN_OUTLIER_PROBABILITY:
            notes.append(
                f"{row['label']} contradicts the others: outlier with a probability of {100 * probability:.0f} %, and "
                "its weight is reduced."
            )
    for each in record["unchecked_measurements"]:
        without = each["without"]
        low, high = (with_unit(without[end], without["unit"]) for end in ("low", "high"))
        notes.append(
            f"No other measurement checks {each['label']}; the intervals assume that it is right. Without it, "
            f"{without['label']} is {low} to {high} (68 %)."
        )
    if not record["converged"]:
        notes.append(
            f"The estimate did not converge (last step above {STEP_TOLERANCE:g}σ): the intervals may be too narrow. "
            "Check for contradictory measurements."
        )
    return [*notes, "68 %: interval of ±1σ; remaining: its width over that before any measurement."]
