"""A measured cue: its drawing, the stroke, what was measured on it, and the table of measured and computed values."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from cuefem.cue import Array
from cuefem.measurements.measurement_types import MEASUREMENT_TYPES, Measurement, Setup, Squirt
from cuefem.measurements.uncertain_parameters import Prior, UncertainParameter, parameters_of
from cuefem.quantity.fields import check_kind
from cuefem.scene import Scene

STEP = 0.1  # of differences, in standard deviations of a prior
NEARER = 8  # of that step, towards the limit of what can be

Track = Callable[[Sequence[Any]], Iterable[Any]]


@dataclass(frozen=True)
class MeasuredCue:
    """A cue that was measured.

    Parameters
    ----------
    name : str
        What it is called.
    scene : Scene
        Its drawing with the ball and the tip; the stroke's speed holds where a measurement gives none.
    measurements : tuple
        The measurements, of the classes in `cuefem.measurements.measurement_types.MEASUREMENT_TYPES`.
    priors : tuple of Prior, optional
        What is known of uncertain parameters, beyond the usual.
    source : str, optional
        Where the numbers come from.

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
        """What its drawing leaves open."""
        return parameters_of(self.scene, self.measurements, self.priors)

    def setup(self, z: Array | None = None) -> Setup:
        """The scene with its uncertain parameters ``z`` standard deviations of their priors off the usual values."""
        made = Setup(self.scene)
        for parameter, each in zip(self.parameters, np.zeros(len(self.parameters)) if z is None else z, strict=True):
            made = parameter.setup(made, float(each))
        return made

    def computed(self, z: Array | None = None, also: Sequence[Measurement] = ()) -> Array:
        """The values of its measurements by the model, SI, and of others ``also``."""
        setup = self.setup(z)
        return np.array([measurement.computed(setup) for measurement in (*self.measurements, *also)])

    def slopes(
        self, z: Array, also: Sequence[Measurement] = (), *, at: Array | None = None, track: Track = iter
    ) -> Array:
        """Derivatives of the values with respect to the parameters, (values, parameters), by central differences.

        By one-sided ones from the values ``at`` that point, if these are given.
        """
        columns = []
        for move in track(list(STEP * np.eye(len(z)))):
            columns.append(self._slope(z, move, also, at) / STEP)
        return np.array(columns).T.reshape(-1, len(z))

    def _slope(self, z: Array, move: Array, also: Sequence[Measurement], at: Array | None) -> Array:
        """Change of the values over ``move``, from a smaller move or one side only where no cue can be farther out."""
        for part in 0.5 ** np.arange(NEARER):
            above = self.possible(z + part * move, also)
            if above is not None and at is not None:
                return (above - at) / part
            below = self.possible(z - part * move, also)
            if above is not None and below is not None:
                return (above - below) / (2 * part)
        here = self.computed(z, also) if at is None else at
        if below is not None:
            return (here - below) / part
        return (self.computed(z + part * move, also) - here) / part

    def possible(self, z: Array, also: Sequence[Measurement] = ()) -> Array | None:
        """What `computed` gives; None where no cue can be, such as one with a bore wider than itself."""
        try:
            return self.computed(z, also)
        except ValueError:
            return None

    @property
    def lacking(self) -> list[str]:
        """What a useful data set has and this one does not, and what that costs."""
        said = (
            kind.lacking([measurement for measurement in self.measurements if isinstance(measurement, kind)])
            for kind in MEASUREMENT_TYPES.values()
        )
        return [words for words in said if words]


class Residual(NamedTuple):
    """A measurement beside the model's value, both with one standard deviation, SI.

    spread: of the computed value, from the priors of what the drawing leaves open. residual: measured less computed, in
    units of the measurement's error. pull: the same in units of both errors together.
    """

    measurement: Measurement
    measured: float
    error: float
    computed: float
    spread: float
    residual: float
    pull: float


def compare(cue: MeasuredCue, *, track: Track = iter) -> tuple[Residual, ...]:
    """Every measurement of a measured cue beside the model's value, nothing fitted.

    Cost: one strike for each squirt, times one more than there are parameters. track: follows these steps.
    """
    z = np.zeros(len(cue.parameters))
    at = cue.computed(z)
    spread = np.sqrt(np.sum(cue.slopes(z, at=at, track=track) ** 2, axis=1))
    return rows_of(cue, at, spread)


def rows_of(cue: MeasuredCue, computed: Array, spread: Array) -> tuple[Residual, ...]:
    """The table of computed values with their standard deviations."""
    made = []
    for measurement, value, error in zip(cue.measurements, computed.tolist(), spread.tolist(), strict=True):
        gap = measurement.measured - value
        made.append(
            Residual(
                measurement,
                measurement.measured,
                measurement.sd,
                value,
                error,
                gap / measurement.sd,
                gap / float(np.hypot(measurement.sd, error)),
            )
        )
    return tuple(made)


class Zero(NamedTuple):
    """What the two sides of a squirt tell of the zero of the offset, m, with its error.

    It is how far every stroke hit to the left of its aim: positive if squirt is larger on the left.
    """

    measurement: Squirt
    zero: float
    error: float


def zeros(cue: MeasuredCue, rows: Sequence[Residual]) -> tuple[Zero, ...]:
    """The zero of the offset by each squirt that was measured on both sides.

    Squirt is taken to be proportional to the offset there, which is right to a fifth.
    """
    radius = float(cue.scene.ball.radius)
    made = []
    for row in rows:
        measurement = row.measurement
        if isinstance(measurement, Squirt) and measurement.left is not None and measurement.right is not None:
            slope = row.measured / (measurement.offset * radius)
            made.append(
                Zero(measurement, (measurement.left - measurement.right) / 2 / slope, abs(measurement.sd / slope))
            )
    return tuple(made)
