"""Uncertain parameters of a drawing: the wood, the bore, the tip; each with a prior.

The prior of a positive number is lognormal about the drawing's value. Its spread, the standard deviation of the
logarithm, is that of `PARAMETERS` (of wood: from the range in the table of materials, which spans one standard
deviation either way), or that of a prior in the file of a measured cue.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any

from cuefem.cue import Material
from cuefem.measurements.measurement_types import (
    CLOTH_FRICTION,
    CLOTH_SPREAD,
    ELEVATION,
    ELEVATION_SPREAD,
    SPEED_SPREAD,
    UNKNOWN_SPEED_SPREAD,
    BallDirection,
    Measurement,
    Setup,
    Squirt,
    StatedElevation,
)
from cuefem.parameters.field_paths import Path
from cuefem.parameters.scene_changes import with_values_at
from cuefem.parameters.scene_paths import parameter
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.fields import Quantity, check_fields
from cuefem.results.uncertainty import model_error
from cuefem.scene import Scene

ZERO, SQUIRT_MODEL = "zero", "squirt model"


@dataclass(frozen=True)
class UncertainParameter:
    """An uncertain parameter: its value in the drawing, and its prior.

    median: its value in the drawing. spread: standard deviation of its logarithm; of the number itself, in its unit, if
    ``normal``. apply: the setup with another value.
    """

    name: str
    label: str
    unit: str
    median: float
    spread: float
    apply: Callable[[Setup, float], Setup] = field(repr=False)
    normal: bool = False

    def value(self, z: float) -> float:
        """Its value ``z`` standard deviations of the prior from the drawing's."""
        return self.median + z * self.spread if self.normal else self.median * math.exp(z * self.spread)

    def setup(self, setup: Setup, z: float) -> Setup:
        """The setup with that value."""
        return self.apply(setup, self.value(z))


@dataclass(frozen=True)
class Prior:
    """A prior in a file: the spread (of the logarithm), or the values one standard deviation below and above."""

    name: str
    spread: Annotated[float | None, Quantity("", "[0, 3]")] = None
    low: Annotated[float | None, Quantity("", "(0, inf)")] = None
    high: Annotated[float | None, Quantity("", "(0, inf)")] = None

    def __post_init__(self) -> None:
        check_fields(self)
        if not isinstance(self.name, str) or _key(self.name) not in map(_key, names()):
            raise ValueError(f"Prior.name must be one of {', '.join(names())}; got {self.name!r}")
        ends = (self.low is None) + (self.high is None)
        if ends == 1 or (ends == 0) == (self.spread is not None):
            raise ValueError("Prior.spread must be given, a relative one, or low and high without it")
        if self.low is not None and self.high is not None and not self.low < self.high:
            raise ValueError(f"Prior.low must be in (0, high); got low {self.low:g} and high {self.high:g}")


def names() -> tuple[str, ...]:
    """Names of possible uncertain parameters: the numerical parameters of a scene, and the model error."""
    return (*(entry.name for entry in PARAMETERS.values() if not entry.materials), SQUIRT_MODEL)


def _key(name: str) -> str:
    """The key of the parameter that a prior names; the name itself if there is no such parameter."""
    entry = parameter(name)
    return entry.key if entry else name


def parameters_of(
    scene: Scene, measurements: Sequence[Measurement], priors: Sequence[Prior] = ()
) -> tuple[UncertainParameter, ...]:
    """The uncertain parameters of a measured cue: the default ones, those of the file, and those of its measurements.

    ValueError if a prior is of something that the scene does not have.
    """
    by_key: dict[str, Prior] = {}
    for each in priors:
        if _key(each.name) in by_key:
            raise ValueError(f"uncertain parameters must have one prior for each parameter; got two of {each.name!r}")
        by_key[_key(each.name)] = each
    parameters = []
    for key, entry in PARAMETERS.items():
        default_spread = entry.spread_in(scene)
        if default_spread is None and key not in by_key:
            continue
        value, prior = entry.value(scene), by_key.get(key)
        if value is None or isinstance(value, Material):
            if prior:
                raise ValueError(
                    f"uncertain parameters must be of this cue; got {prior.name!r}, which it does not have"
                )
            continue
        if not value > 0:
            raise ValueError(
                f"uncertain parameters must be above 0, since their logarithm is estimated; got {key}, {value:g}"
            )
        median, spread = _prior(prior, value, default_spread)
        unit = entry.quantity(scene).unit
        parameters.append(UncertainParameter(entry.name, entry.label, unit, median, spread, _on_scene(entry.steps())))
    squirts = [measurement for measurement in measurements if isinstance(measurement, Squirt)]
    _, spread = _prior(by_key.get(SQUIRT_MODEL), 1.0, model_error(scene))
    label = "true squirt over the model's"
    parameters.append(UncertainParameter(SQUIRT_MODEL, label, "", 1.0, spread, _on("squirt_factor")))
    parameters += _of_strokes(measurements)
    series: dict[str, float] = {}
    for measurement in squirts:
        if measurement.zero_error is not None:
            series[measurement.series] = max(measurement.zero_error, series.get(measurement.series, 0.0))
    for name, error in series.items():
        label = f"zero of the offset{', ' + name if name else ''}"
        parameters.append(
            UncertainParameter(f"{ZERO} {name}".strip(), label, "m", 0.0, error, _zero(name), normal=True)
        )
    return tuple(parameter for parameter in parameters if parameter.spread > 0)


def _of_strokes(measurements: Sequence[Measurement]) -> list[UncertainParameter]:
    """Uncertain parameters of strokes: the contact's offset; of readings at a distance elevation, speed and cloth."""
    directions = [each for each in measurements if isinstance(each, BallDirection)]
    error = max((each.offset_error or 0.0 for each in directions), default=0.0)
    contact = UncertainParameter(
        "contact", "true less stated offset of the contact", "m", 0.0, error, _on("contact_shift"), normal=True
    )
    read = [each for each in directions if each.distance is not None]
    if not read:
        return [contact]
    spread = SPEED_SPREAD if all(each.speed is not None for each in read) else UNKNOWN_SPEED_SPREAD
    elevations = dict.fromkeys(each.stated_elevation for each in read)
    return [
        contact,
        *(_elevation(stated, number) for number, stated in enumerate(elevations, start=1)),
        UncertainParameter("ball speed", "true ball speed over the computed", "", 1.0, spread, _on("speed_factor")),
        UncertainParameter(
            "cloth",
            "friction of the sliding ball on the cloth",
            "",
            CLOTH_FRICTION,
            CLOTH_SPREAD,
            _on("cloth_friction"),
        ),
    ]


def _elevation(stated: StatedElevation, number: int) -> UncertainParameter:
    """A stated elevation with its error, or that of a cue over a rail; shots with the same statement share it."""

    def apply(setup: Setup, value: float) -> Setup:
        return setup._replace(elevations={**setup.elevations, stated: value})

    name = "elevation" if number == 1 else f"elevation {number}"
    if stated.value is None or stated.error is None:
        label = "elevation of the cue, assumed"
        return UncertainParameter(name, label, "rad", ELEVATION, ELEVATION_SPREAD, apply)
    return UncertainParameter(name, "elevation of the cue", "rad", stated.value, stated.error, apply, normal=True)


def _prior(prior: Prior | None, median: float, spread: float | None) -> tuple[float, float]:
    """Middle and spread, of the prior if there is one."""
    if prior is None:
        assert spread is not None
        return median, spread
    if prior.low is not None and prior.high is not None:
        return math.sqrt(prior.low * prior.high), math.log(prior.high / prior.low) / 2
    assert prior.spread is not None
    return median, prior.spread


def _on(name: str) -> Callable[[Setup, float], Setup]:
    """What changes the field of a setup."""

    def apply(setup: Setup, value: float) -> Setup:
        field: Any = {name: value}
        return setup._replace(**field)

    return apply


def _on_scene(path: Path) -> Callable[[Setup, float], Setup]:
    return lambda setup, value: setup._replace(scene=with_values_at(setup.scene, {path: value}))


def _zero(name: str) -> Callable[[Setup, float], Setup]:
    return lambda setup, value: setup._replace(zeros={**setup.zeros, name: value})
