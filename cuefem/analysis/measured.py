"""A measured cue: measured values beside computed ones, and the estimate of its uncertain parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from cuefem.cue import Array
from cuefem.measurements import estimate as estimation
from cuefem.measurements import measured_cue
from cuefem.measurements.calibration import Calibration
from cuefem.measurements.estimate import STEP_TOLERANCE, Estimate, InformationGain, predicted_squirt
from cuefem.measurements.measured_cue import MeasuredCue, OffsetZero, Residual, offset_zeros
from cuefem.measurements.measured_folder import load_measured
from cuefem.quantity.display_units import format_change, with_unit
from cuefem.results.progress import Progress
from cuefem.results.quantities import DASH
from cuefem.results.records import ColumnEntry, Record, Table, tabulate
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.charts import Axis, Chart, Curve, chart

LARGE_RESIDUAL = 3.0  # a larger one is a contradiction
MIN_CHART_ROWS, MIN_AXIS = 3, 6.0  # fewer residuals are read in the table; a shorter axis has ticks between the rows
MIN_OUTLIER_PROBABILITY = 0.2  # of a measurement with a note
UNITS = {"residual": "", "normalized_residual": "", "zero_error": "m", "squirt_error": "rad"}


@dataclass(frozen=True)
class MeasuredComparison(Rows, Analysis):
    """Measured values of a cue beside computed ones; nothing is fitted.

    Parameters
    ----------
    scene : Scene
        The drawn cue, with its stroke.
    name, source : str
        Name of the cue, and source of the numbers.
    rows : list of dict
        For each measurement its "kind", "label", "unit" and "source"; "measured_value" with its "error" and
        "computed_value" with its "spread", 1 sigma each, in SI; "residual", measured less computed over the error, and
        "normalized_residual", over both together.
    rms_normalized_residual : float or None
        Root mean square of the normalized residuals; None without measurements.
    zero_errors : list of dict
        For each squirt that was measured on both sides its "label", and the "zero_error" of the offset with its
        "error", m.
    uncertain_parameters : list of str
        The parameters that cause the spread.
    missing : list of str
        Missing measurements and their consequences.
    """

    name: str
    source: str
    rows: list[Record]
    rms_normalized_residual: float | None
    zero_errors: list[Record]
    uncertain_parameters: list[str]
    missing: list[str]
    own_units: ClassVar = UNITS

    def frame_rows(self) -> list[Record]:
        """A row for each measurement."""
        return self.rows

    def heading(self) -> str:
        """The name of the cue."""
        return self.name

    def tables(self) -> list[Table | str]:
        """Measured and computed values, contradictions, the zero error of the offset, and missing measurements."""
        more: dict[str, ColumnEntry] = {
            "normalized residual": lambda row: format_change(row["normalized_residual"], 1),
        }
        if any(row["source"] for row in self.rows):
            more["source"] = "{source}"
        blocks: list[Table | str] = []
        if self.rows:
            blocks.append(_tabulate_fit("Measured and computed", self.rows, more, *self.captions()))
        blocks += [*contradictions(self.rows), *self.zero_lines()]
        if self.missing:
            blocks += ["Missing measurements and their consequences:", *(f"  {line}" for line in self.missing)]
        return blocks

    def charts(self) -> list[Chart]:
        """The normalized residual of each measurement."""
        return residual_chart(self.rows, "normalized_residual", "over both 1σ combined, σ")

    def captions(self) -> list[str]:
        """Definitions of the table's columns."""
        return [
            "±: 1σ; that of a computed value comes from the uncertain parameters of the drawing: "
            f"{', '.join(self.uncertain_parameters)}.",
            f"{RESIDUAL}; normalized residual: over both 1σ combined (RMS {self.rms_normalized_residual:.2f}).",
        ]

    def zero_lines(self) -> list[str]:
        """The zero error of the offset, from strokes on the left and on the right; empty without them."""
        if not self.zero_errors:
            return []
        weights = np.array([1 / zero["error"] ** 2 for zero in self.zero_errors])
        mean = float(weights @ [zero["zero_error"] for zero in self.zero_errors] / weights.sum())
        zero, side = with_unit(abs(mean), "m", error=float(weights.sum() ** -0.5)), "left" if mean > 0 else "right"
        return [f"The strokes hit {zero} to the {side} of their aim; the mean of left and right is free of it"]


@dataclass(frozen=True)
class MeasuredEstimate(Rows, Analysis):
    """The uncertain parameters of a cue, estimated from all its measurements.

    Parameters
    ----------
    scene : Scene
        The drawn cue, with its stroke.
    name : str
        Name of the cue.
    parameters : list of dict
        For each uncertain parameter its "name", "label" and "unit"; its value in the "drawing", its estimated "value",
        and "low" and "high", the limits of the 68 % interval, in SI; "error_ratio", the width of that interval over
        that before any measurement.
    correlations : list of list of float
        Correlation of each parameter with each.
    rows : list of dict
        The measurements with the values computed with the estimate, as of `MeasuredComparison`.
    misfit : float
        The least sum of squares of the residuals and of the parameters in standard deviations of their priors.
    measurement_count : int
        Number of measurements.
    outlier_probability : list of float
        Probability that the error of a measurement is far larger than stated.
    unchecked_measurements : list of dict
        Measurements that no other checks: the "label" of each, and ``"without"``, the parameter that depends on it most
        as estimated without it.
    converged : bool
        Whether the search converged.
    squirt, squirt_error : float
        Squirt with the estimated parameters and its uncertainty (1 sigma) with the model error, rad.
    offset : float
        Offset b/R of that squirt.
    recommended_measurements : list of dict
        Further measurements, the one with the least error of squirt first: "kind", "label", "unit", "error"; "bits" of
        information; the "parameter" whose error it reduces most, and its "error_ratio", after over before; and
        "relative_squirt_error" after it.
    found : Estimate
        The posterior: mean, covariance and derivatives.
    """

    name: str
    parameters: list[Record]
    correlations: list[list[float]]
    rows: list[Record]
    misfit: float
    measurement_count: int
    outlier_probability: list[float]
    unchecked_measurements: list[Record]
    converged: bool
    squirt: float
    squirt_error: float
    offset: float
    recommended_measurements: list[Record]
    found: Estimate = field(repr=False, compare=False)
    own_units: ClassVar = UNITS

    def frame_rows(self) -> list[Record]:
        """A row for each measurement."""
        return self.rows

    def heading(self) -> str:
        """The name of the cue."""
        return self.name

    def tables(self) -> list[Table | str]:
        """The estimated parameters, the fit of the measurements, squirt, and recommended measurements."""
        return [
            tabulate(
                "Estimated parameters",
                {"uncertain parameter": "{label}", "drawing": _value("drawing"), "estimate": _value("value")}
                | _INTERVAL,
                self.parameters,
                *self.notes(),
            ),
            _tabulate_fit("Measured and computed with the estimate", self.rows, {}, FITTED),
            "",
            self.squirt_line(),
            "",
            tabulate(
                "Recommended measurements",
                {
                    "measurement": "{label}",
                    "1σ": lambda gain: with_unit(gain["error"], str(gain["unit"])) if gain["unit"] else DASH,
                    "parameter improved most": "{parameter}",
                    "its σ, after/before": "{error_ratio:.0 %}",
                    "σ of squirt after": "{relative_squirt_error:.1 %}",
                },
                self.recommended_measurements,
                "Sorted by the relative uncertainty (1σ) of squirt after the measurement, with the model error.",
            ),
        ]

    def charts(self) -> list[Chart]:
        """The residual of each measurement with the estimate."""
        return residual_chart(self.rows, "residual", "over the measurement's 1σ, σ")

    def squirt_line(self) -> str:
        """Squirt with the estimated parameters."""
        squirt = with_unit(self.squirt, "rad", error=self.squirt_error)
        return f"squirt at b/R {self.offset:.4g} with these parameters and the model error: {squirt}"

    def calibration(self) -> Calibration:
        """What it says about the squirt of the next shaft with the same tip: ``calibration().save("c.toml")``.

        ValueError if no squirt was measured, or it is beyond a factor of 1.6 of the computed one.
        """
        return Calibration.of(self.found)

    def notes(self) -> list[str]:
        """The misfit, contradictory and unchecked measurements, and whether the search converged."""
        misfit, count = self.misfit, self.measurement_count
        notes = [f"Misfit {misfit:.1f} (chi-square of {count} measurements and the priors); expected about {count}."]
        if misfit > count + 3 * math.sqrt(2 * count):
            notes.append("That is too large: a measurement, a stated error or the model is wrong.")
        for row, probability in zip(self.rows, self.outlier_probability, strict=True):
            if probability > MIN_OUTLIER_PROBABILITY:
                notes.append(
                    f"{row['label']} contradicts the others: outlier with a probability of {100 * probability:.0f} %, "
                    "and its weight is reduced."
                )
        for each in self.unchecked_measurements:
            without = each["without"]
            low, high = (with_unit(without[end], without["unit"]) for end in ("low", "high"))
            notes.append(
                f"No other measurement checks {each['label']}; the intervals assume that it is right. Without it, "
                f"{without['label']} is {low} to {high} (68 %)."
            )
        if not self.converged:
            notes.append(
                f"The estimate did not converge (last step above {STEP_TOLERANCE:g}σ): the intervals may be too "
                "narrow. Check for contradictory measurements."
            )
        return [*notes, "68 %: interval of ±1σ; remaining: its width over that before any measurement."]


def compare_measured(cue: MeasuredCue, *, progress: Progress = iter) -> MeasuredComparison:
    """Every measurement of a cue with its computed value; progress: wraps the list of parameters."""
    rows = measured_cue.compare(cue, progress=progress)
    squares = [row.normalized_residual**2 for row in rows]
    return MeasuredComparison(
        cue.scene,
        name=cue.name,
        source=cue.source,
        rows=[_row_record(row) for row in rows],
        rms_normalized_residual=float(np.sqrt(np.mean(squares))) if rows else None,
        zero_errors=[_zero_record(zero) for zero in offset_zeros(cue, rows)],
        uncertain_parameters=[parameter.label for parameter in cue.parameters],
        missing=cue.missing,
    )


def estimate(cue: MeasuredCue | str | Path, *, progress: Progress = iter) -> MeasuredEstimate:
    """Estimate the uncertain parameters of a measured cue from all its measurements (maximum a posteriori).

    Parameters
    ----------
    cue : str, path or MeasuredCue
        The folder of a measured cue (`cuefem guide measuring` has the format), or what it holds.
    progress : callable, optional
        Wraps the list of steps, to show progress.

    Returns
    -------
    MeasuredEstimate
        The parameters with their errors, the fit of the measurements, squirt, and which measurement to make next.
        Show it with ``print``, in a notebook, or by ``.save("estimate.html")``.

    Raises
    ------
    ValueError
        If a file is invalid, nothing was measured, or nothing is uncertain.

    Examples
    --------
    >>> import cuefem as cf
    >>> from cuefem.measurements.measured_cue import MeasuredCue
    >>> from cuefem.measurements.measurement_types import Weight
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> found = cf.estimate(MeasuredCue("a cue", scene, (Weight(value=0.115, error=0.5e-3),)))
    >>> density = next(each for each in found.parameters if each["name"] == "rho")
    >>> round(density["value"]), round(density["high"] - density["low"])  # kg/m3
    (716, 7)
    """
    measured = cue if isinstance(cue, MeasuredCue) else load_measured(Path(cue))[0]
    found, target = estimation.estimate(measured, progress=progress), predicted_squirt(measured)
    squirt, squirt_error = found.predict(target)
    sd = np.sqrt(np.diag(found.covariance))
    return MeasuredEstimate(
        measured.scene,
        name=measured.name,
        parameters=[value._asdict() for value in found.values],
        correlations=(found.covariance / np.outer(sd, sd)).tolist(),
        rows=[_row_record(row) for row in found.residuals],
        misfit=found.misfit,
        measurement_count=len(measured.measurements),
        outlier_probability=found.outlier_probability.tolist(),
        unchecked_measurements=[
            {"label": each.measurement.label, "without": each.without._asdict()}
            for each in found.unchecked_measurements
        ],
        converged=found.converged,
        squirt=squirt,
        squirt_error=squirt_error,
        offset=target.offset,
        recommended_measurements=[_gain_record(gain) for gain in found.next_measurements()],
        found=found,
    )


def residual_chart(rows: Sequence[Record], residual: str, label: str) -> list[Chart]:
    """A line from zero to the residual of each measurement, by its row of the table; none of few measurements.

    residual: its name in a row. label: of the axis.
    """
    if len(rows) < MIN_CHART_ROWS:
        return []
    numbers = np.arange(1.0, len(rows) + 1)
    values = [row[residual] for row in rows]
    stems = np.repeat(numbers, 3), np.column_stack([np.zeros(len(rows)), values, np.full(len(rows), np.nan)]).ravel()
    reach = max(LARGE_RESIDUAL, float(np.ceil(np.abs(values).max())))
    ends = np.array([0.0, max(len(rows) + 1.0, MIN_AXIS)])
    limit = Curve(f"limit of a contradiction, ±{LARGE_RESIDUAL:g}σ", *_both_sides(ends, LARGE_RESIDUAL), "c2")
    return [
        chart(
            "Measured minus computed",
            [Curve("measured minus computed", *stems, "c1 stem"), limit],
            x=Axis("row of the table", 0.0, ends[1]),
            y=Axis(label, -reach, reach),
        )
    ]


def _both_sides(ends: Array, height: float) -> tuple[Array, Array]:
    """Two level lines, at plus and minus a height."""
    return np.concatenate([ends, [np.nan], ends]), np.array([height, height, np.nan, -height, -height])


def _row_record(row: Residual) -> Record:
    """A measurement with the model's value, both SI with 1 sigma; see `Residual`."""
    measurement = row.measurement
    names = ("measured_value", "error", "computed_value", "spread", "residual", "normalized_residual")
    return {
        "kind": measurement.key,
        "label": measurement.label,
        "unit": measurement.unit,
        "source": measurement.source,
    } | {name: getattr(row, name) for name in names}


def _zero_record(zero: OffsetZero) -> Record:
    """The zero error of the offset by a measurement."""
    return {"label": zero.measurement.label, "zero_error": zero.zero_error, "error": zero.error}


def _gain_record(gain: InformationGain) -> Record:
    """A further measurement, and the uncertainty that would remain after it; see `InformationGain`."""
    measurement = gain.measurement
    about = {"kind": measurement.key, "label": measurement.label, "unit": measurement.unit, "error": measurement.sd}
    return about | {name: value for name, value in gain._asdict().items() if name != "measurement"}


RESIDUAL = "Residual: measured minus computed, over the measurement's 1σ"
FITTED = f"±: 1σ; that of a computed value comes from the estimated parameters. {RESIDUAL}."


def _tabulate_fit(title: str, rows: Sequence[Record], more: Mapping[str, ColumnEntry], *notes: str) -> Table:
    """A row for each measurement with its computed value. more: further columns."""
    columns: dict[str, ColumnEntry] = {
        "measurement": "{label}",
        "measured": _measured,
        "computed": _computed,
        "residual": lambda row: format_change(row["residual"], 1),
    }
    return tabulate(title, columns | dict(more), rows, *notes, texts=(0, 5))


def _measured(row: Mapping[str, Any]) -> str:
    return with_unit(row["measured_value"], row["unit"], error=row["error"])


def _computed(row: Mapping[str, Any]) -> str:
    return with_unit(row["computed_value"], row["unit"], error=row["spread"])


def contradictions(rows: Sequence[Record]) -> list[str]:
    """The measurements with a large normalized residual, as text."""
    return [
        f"{row['label']} contradicts the drawing: measured {_measured(row)}, computed {_computed(row)}, a difference "
        f"of {abs(row['normalized_residual']):.1f} combined σ"
        for row in rows
        if abs(row["normalized_residual"]) > LARGE_RESIDUAL
    ]


def _value(name: str) -> ColumnEntry:
    return lambda value: with_unit(value[name], value["unit"])


_INTERVAL: dict[str, ColumnEntry] = {
    "68 %": lambda value: " to ".join(with_unit(value[end], value["unit"]) for end in ("low", "high")),
    "remaining": "{error_ratio:.0 %}",
}
