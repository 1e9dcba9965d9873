"""A measured cue: its drawing, stroke and measurements, and the table of measured and computed values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array
from cuefem.measurements.measurement_types import MEASUREMENT_TYPES, Measurement, Setup, Squirt
from cuefem.measurements.uncertain_parameters import Prior, UncertainParameter, parameters_of
from cuefem.quantity.fields import check_kind
from cuefem.results.progress import Progress
from cuefem.scene import Scene

STEP = 0.1  # of differences, in standard deviations of a prior
MAX_HALVINGS = 8  # of that step, where the cue would be invalid


@dataclass(frozen=True)
class MeasuredCue:
    """A cue that was measured.

    Parameters
    ----------
    name : str
        Its name.
    scene : Scene
        Its drawing with ball, tip and stroke; the stroke's speed is the default of measurements.
    measurements : tuple
        The measurements, of the classes in `cuefem.measurements.measurement_types.MEASUREMENT_TYPES`.
    priors : tuple of Prior, optional
        Priors of uncertain parameters that replace the defaults.
    source : str, optional
        Source of the numbers.

    Raises
    ------
    TypeError
        If a field is of another kind.
    ValueError
        If a prior is of something that the cue does not have.
    """

    name: str
    scene: Scene
    measurements: tuple[Measurement, ...]
    priors: tuple[Prior, ...] = ()
    source: str = ""

    def __post_init__(self) -> None:
        check_kind("MeasuredCue.scene", self.scene, Scene)
        for i, measurement in enumerate(self.measurements):
            check_kind(f"MeasuredCue.measurements[{i}]", measurement, Measurement)
        _ = self.scene.shaft, self.parameters

    @cached_property
    def parameters(self) -> tuple[UncertainParameter, ...]:
        """Its uncertain parameters."""
        return parameters_of(self.scene, self.measurements, self.priors)

    def setup(self, z: Array | None = None) -> Setup:
        """The scene with its uncertain parameters ``z`` standard deviations of their priors from the drawing."""
        setup = Setup(self.scene)
        for parameter, each in zip(self.parameters, np.zeros(len(self.parameters)) if z is None else z, strict=True):
            setup = parameter.setup(setup, float(each))
        return setup

    def compute(self, z: Array | None = None, extra: Sequence[Measurement] = ()) -> Array:
        """The values of its measurements by the model, SI, and of others ``extra``."""
        setup = self.setup(z)
        return np.array([measurement.compute(setup) for measurement in (*self.measurements, *extra)])

    def jacobian(
        self, z: Array, extra: Sequence[Measurement] = (), *, step: float = STEP, progress: Progress = iter
    ) -> Array:
        """Derivatives of the values with respect to the parameters, (values, parameters), by central differences."""
        columns = []
        for move in progress(list(step * np.eye(len(z)))):
            columns.append(self._slope(z, move, extra) / step)
        return np.array(columns).T.reshape(-1, len(z))

    def _slope(self, z: Array, move: Array, extra: Sequence[Measurement]) -> Array:
        """Change of the values over ``move``, from a smaller move or one side only where the cue would be invalid."""
        for share in 0.5 ** np.arange(MAX_HALVINGS):
            above = self.compute_or_none(z + share * move, extra)
            below = self.compute_or_none(z - share * move, extra)
            if above is not None and below is not None:
                return (above - below) / (2 * share)
        middle = self.compute(z, extra)
        if below is not None:
            return (middle - below) / share
        return (self.compute(z + share * move, extra) - middle) / share

    def compute_or_none(self, z: Array, extra: Sequence[Measurement] = ()) -> Array | None:
        """The values of `compute`; None for an invalid cue, such as one with a bore wider than itself."""
        try:
            return self.compute(z, extra)
        except ValueError:
            return None

    @property
    def missing(self) -> list[str]:
        """Missing measurements of a useful data set, and the consequence of each."""
        texts = (
            kind.missing([measurement for measurement in self.measurements if isinstance(measurement, kind)])
            for kind in MEASUREMENT_TYPES.values()
        )
        return [text for text in texts if text]


class Residual(NamedTuple):
    """A measured and a computed value, both with one standard deviation, SI.

    spread: of the computed value, from the priors of the uncertain parameters. residual: measured less computed, in
    units of the measurement's error. normalized_residual: the same in units of both errors together.
    """

    measurement: Measurement
    measured_value: float
    error: float
    computed_value: float
    spread: float
    residual: float
    normalized_residual: float


def compare(cue: MeasuredCue, *, progress: Progress = iter) -> tuple[Residual, ...]:
    """Compare every measurement of a measured cue with the model's value; nothing is fitted.

    The spread is that of `cuefem.results.uncertainty`: half the difference between one standard deviation up and down.
    Cost: two strikes for each squirt and parameter. progress: wraps the list of parameters.
    """
    z = np.zeros(len(cue.parameters))
    spread = np.sqrt(np.sum(cue.jacobian(z, step=1.0, progress=progress) ** 2, axis=1))
    return residuals_of(cue, cue.compute(z), spread)


def residuals_of(cue: MeasuredCue, computed: Array, spread: Array) -> tuple[Residual, ...]:
    """The table of computed values with their standard deviations."""
    rows = []
    for measurement, value, error in zip(cue.measurements, computed.tolist(), spread.tolist(), strict=True):
        difference = measurement.measured_value - value
        rows.append(
            Residual(
                measurement,
                measurement.measured_value,
                measurement.sd,
                value,
                error,
                difference / measurement.sd,
                difference / float(np.hypot(measurement.sd, error)),
            )
        )
    return tuple(rows)


class OffsetZero(NamedTuple):
    """The zero error of the offset by a squirt measured on both sides, m, with its error.

    Positive if squirt is larger on the left: every stroke is that far to the left of its aim.
    """

    measurement: Squirt
    zero_error: float
    error: float


def offset_zeros(cue: MeasuredCue, rows: Sequence[Residual]) -> tuple[OffsetZero, ...]:
    """The zero of the offset by each squirt that was measured on both sides.

    It assumes that squirt is proportional to the offset; there is none where the mean of both sides is 0.
    """
    radius = float(cue.scene.ball.radius)
    zeros = []
    for row in rows:
        measurement = row.measurement
        if not isinstance(measurement, Squirt) or measurement.left is None or measurement.right is None:
            continue
        if row.measured_value:  # else squirt has no slope
            slope = row.measured_value / (measurement.offset * radius)
            zeros.append(
                OffsetZero(measurement, (measurement.left - measurement.right) / 2 / slope, abs(measurement.sd / slope))
            )
    return tuple(zeros)
