"""The types of measurements of a measured cue, one class each, listed in `MEASUREMENT_TYPES`."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, NamedTuple

from cuefem.measurements.predictions import N_FREQUENCIES, Predictions, predictions_of
from cuefem.measurements.swerve import reading_angle
from cuefem.quantity.display_units import END_MASS, with_unit
from cuefem.quantity.fields import CONTACT_TIME, LENGTH, Quantity, check_count, check_fields
from cuefem.quantity.units import parse_number
from cuefem.results.closed_forms import pivot_length
from cuefem.results.quantities import balance_point, drawn_mass
from cuefem.scene import Scene

MASS = Quantity("kg", "(0, inf)")
ANGLE = Quantity("rad", "(-1.5, 1.5)")
DISTANCE = Quantity("m", "[0.1, 3]")  # nearer, the reading error is all; farther, the cloth is no plane
ELEVATION_BOUNDS = Quantity("rad", f"[0, {math.radians(15)}]")  # higher, the tip does not strike as a level one
POSITIVE = "(0, inf)"
PARTS = ("shaft", "cue")
NEAR_TIP = parse_number("8 in", "m")  # free length of a second stiffness
FREQUENCY_MODEL_ERROR = 2e-3  # relative, of a natural frequency: diameters to 0.1 %, uneven grain, the beam
# Errors (1 sigma) of simple instruments: of the candidates for the next measurement.
SCALE_ERROR = 0.5e-3  # kg, of a kitchen scale
STIFFNESS_ERROR = 0.02  # relative, of a static stiffness: a kitchen scale and a dial gauge
BALANCE_ERROR = 1e-3  # m, of a balance point
SQUIRT_ERROR = 8.7e-4  # rad, 0.05 degrees: the mean of some shots on either side
PIVOT_ERROR = 0.05  # relative, of a pivot length: both sides, the bridge to half an inch
# Of readings at a distance: what is assumed of the stroke, and how well it is known (1 sigma).
ELEVATION, ELEVATION_SPREAD = math.radians(3.0), 0.5  # of a cue over a rail: 1.8 to 4.9 degrees, lognormal
ELEVATION_ERROR = math.radians(1.0)  # of a stated elevation
CLOTH_FRICTION, CLOTH_SPREAD = 0.2, 0.2  # of a sliding ball; the spread is relative, as the next two
SPEED_SPREAD, UNKNOWN_SPEED_SPREAD = 0.1, 0.5  # of a stated cue speed, and of the scene's in its place
CONTACT_TIME_ERROR = 0.05  # relative, of a contact time


class StatedElevation(NamedTuple):
    """An elevation of the cue, rad, and its error (1 sigma); both None if it was not measured."""

    value: float | None
    error: float | None


class Setup(NamedTuple):
    """A scene with the systematic errors of its measurements.

    zeros: zero error of the offset of each series, m, by its name. squirt_factor: true squirt over that of the model.
    elevations: of the cue, rad, by the stated value and its error. speed_factor: true over computed ball speed.
    cloth_friction: of the sliding ball. contact_shift: true less stated offset, m, of readings with an offset_error.
    """

    scene: Scene
    zeros: Mapping[str, float] = MappingProxyType({})
    squirt_factor: float = 1.0
    elevations: Mapping[StatedElevation, float] = MappingProxyType({})
    speed_factor: float = 1.0
    cloth_friction: float = CLOTH_FRICTION
    contact_shift: float = 0.0

    @property
    def predictions(self) -> Predictions:
        """Computed values of its cue."""
        return predictions_of(self.scene)


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """A measurement: its value, and its error, one standard deviation in the unit of the value."""

    # Its key in a file; the SI unit of its value; its title; the consequence if it is missing.
    key: ClassVar[str] = ""
    unit: ClassVar[str] = ""
    title: ClassVar[str] = ""
    consequence: ClassVar[str] = ""

    source: str = ""

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def measured_value(self) -> float:
        """The measured value."""
        return float(self.value)  # type: ignore[attr-defined]

    @property
    def sd(self) -> float:
        """Its error, one standard deviation."""
        return float(self.error)  # type: ignore[attr-defined]

    @property
    def label(self) -> str:
        """Label of the measurement."""
        return self.title

    def compute(self, setup: Setup) -> float:
        """The value by the model, SI."""
        raise NotImplementedError

    @classmethod
    def missing(cls, measurements: Sequence[Any]) -> str:
        """Missing measurements of this type in a data set, and the consequence; empty if none is missing."""
        return "" if measurements else f"{cls.title}: {cls.consequence}"

    @classmethod
    def candidates(cls, scene: Scene) -> tuple[Measurement, ...]:
        """Further measurements of this kind that are possible on the cue, with the model's values."""
        return ()


@dataclass(frozen=True, kw_only=True)
class Weight(Measurement):
    """A weight: of the shaft in the drawing with its tip, or of the whole cue."""

    key: ClassVar[str] = "weight"
    unit: ClassVar[str] = "kg"
    title: ClassVar[str] = "weight"
    consequence: ClassVar[str] = "the density of the wood remains uncertain by 10 %, which is 4 % of the squirt"

    part: str = "shaft"
    value: Annotated[float, MASS]
    error: Annotated[float, Quantity("kg", POSITIVE)]

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.part not in PARTS:
            raise ValueError(f"Weight.part must be one of {', '.join(PARTS)}; got {self.part!r}")

    @property
    def label(self) -> str:
        """Of which part."""
        return f"weight of the {self.part}"

    def compute(self, setup: Setup) -> float:
        """That of the drawing."""
        return drawn_mass(setup.scene) + (setup.scene.shaft.body_mass if self.part == "cue" else 0.0)

    @classmethod
    def candidates(cls, scene: Scene) -> tuple[Measurement, ...]:
        """The shaft on a kitchen scale."""
        return (cls(value=drawn_mass(scene), error=SCALE_ERROR),)


@dataclass(frozen=True, kw_only=True)
class Balance(Measurement):
    """The balance point of the shaft, from the end of the tip."""

    key: ClassVar[str] = "balance"
    unit: ClassVar[str] = "m"
    title: ClassVar[str] = "balance point of the shaft"
    consequence: ClassVar[str] = "heavy parts that the drawing omits (an insert, a pin) remain undetected"

    value: Annotated[float, LENGTH]
    error: Annotated[float, Quantity("m", POSITIVE)]

    def compute(self, setup: Setup) -> float:
        """That of the drawing."""
        return balance_point(setup.scene)

    @classmethod
    def candidates(cls, scene: Scene) -> tuple[Measurement, ...]:
        """The shaft on an edge."""
        return (cls(value=balance_point(scene), error=BALANCE_ERROR),)


@dataclass(frozen=True, kw_only=True)
class Tone(Measurement):
    """A natural frequency of the freely suspended shaft, from tapping; mode 1 is the lowest."""

    key: ClassVar[str] = "tone"
    unit: ClassVar[str] = "Hz"
    title: ClassVar[str] = "natural frequencies of the freely suspended shaft"
    consequence: ClassVar[str] = "E and G of the wood stay those of a table, uncertain by 20 % and more"

    mode: int
    value: Annotated[float, Quantity("Hz", "(0, inf)")]
    error: Annotated[float, Quantity("Hz", POSITIVE)]

    def __post_init__(self) -> None:
        super().__post_init__()
        check_count("Tone.mode", self.mode, 1, N_FREQUENCIES)

    @property
    def sd(self) -> float:
        """Including `FREQUENCY_MODEL_ERROR`, the error of beam theory and drawing."""
        return float((self.error**2 + (FREQUENCY_MODEL_ERROR * self.value) ** 2) ** 0.5)

    @property
    def label(self) -> str:
        """Which one."""
        return f"natural frequency {self.mode}"

    def compute(self, setup: Setup) -> float:
        """Of the beam."""
        return float(setup.predictions.frequencies[self.mode - 1])

    @classmethod
    def candidates(cls, scene: Scene) -> tuple[Measurement, ...]:
        """The four lowest, recorded by a telephone."""
        frequencies = predictions_of(scene).frequencies[:4]
        return tuple(cls(mode=i + 1, value=float(f), error=0.1) for i, f in enumerate(frequencies))


@dataclass(frozen=True, kw_only=True)
class Stiffness(Measurement):
    """A static stiffness: a transverse force at the ferrule's end over its deflection, the shaft clamped behind it.

    free_length: from the force to the clamp; without it, the whole shaft, clamped at its joint.
    """

    key: ClassVar[str] = "stiffness"
    unit: ClassVar[str] = "N/m"
    title: ClassVar[str] = "static stiffness, at two free lengths"
    consequence: ClassVar[str] = "a bore and the wood's E cannot be distinguished; a hidden bore remains undetected"

    free_length: Annotated[float | None, LENGTH] = None
    value: Annotated[float, Quantity("N/m", "(0, inf)")]
    error: Annotated[float, Quantity("N/m", POSITIVE)]

    @property
    def label(self) -> str:
        """Over which length."""
        return "stiffness, whole" if self.free_length is None else f"stiffness, {with_unit(self.free_length, 'm')} free"

    def compute(self, setup: Setup) -> float:
        """One linear solution of the beam."""
        wood = setup.scene.shaft.length - setup.scene.shaft.leather_height
        return setup.predictions.stiffness(wood if self.free_length is None else self.free_length)

    @classmethod
    def missing(cls, measurements: Sequence[Any]) -> str:
        """One length determines E; the second, near the tip, the bore."""
        if len({measurement.free_length for measurement in measurements}) == 1:
            return "static stiffness at a second free length: a bore and the wood's E cannot be distinguished"
        return super().missing(measurements)

    @classmethod
    def candidates(cls, scene: Scene) -> tuple[Measurement, ...]:
        """The whole shaft, and its last 8 in."""
        lengths = (None, NEAR_TIP)
        results = []
        for length in lengths:
            if length is None or length < scene.shaft.length:
                value = cls(free_length=length, value=1.0, error=1.0).compute(Setup(scene))
                results.append(cls(free_length=length, value=value, error=STIFFNESS_ERROR * value))
        return tuple(results)


@dataclass(frozen=True, kw_only=True)
class BallDirection(Measurement):
    """A measurement of the ball's direction at an offset b/R of the contact, read where the ball crosses a distance.

    speed: of the cue, by default the scene's. distance: from the ball's start, m; without it the value is the initial
    direction, as in published data. elevation: of the cue, rad, by default that of a cue over a rail, with its error.
    offset_error: of the contact, m; all readings of a cue share it.
    """

    offset: Annotated[float, Quantity("", "(0, 1)")]
    speed: Annotated[float | None, Quantity("m/s", "(0, inf)")] = None
    distance: Annotated[float | None, DISTANCE] = None
    elevation: Annotated[float | None, ELEVATION_BOUNDS] = None
    elevation_error: Annotated[float | None, ELEVATION_BOUNDS] = None
    offset_error: Annotated[float | None, LENGTH] = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.distance is None and self.elevation is not None:
            raise ValueError(f"{type(self).__name__}.distance must be given beside an elevation, which matters by it")
        if self.elevation is None and self.elevation_error is not None:
            raise ValueError(f"{type(self).__name__}.elevation must be given beside elevation_error")

    @property
    def stated_elevation(self) -> StatedElevation:
        """What is known of the elevation."""
        if self.elevation is None:
            return StatedElevation(None, None)
        return StatedElevation(self.elevation, self.elevation_error or ELEVATION_ERROR)

    @property
    def circumstances(self) -> str:
        """Offset, speed and distance for its label."""
        speed = "" if self.speed is None else f", {with_unit(self.speed, 'm/s', digits=3)}"
        distance = "" if self.distance is None else f", read at {with_unit(self.distance, 'm')}"
        return f"at b/R {self.offset:.4g}{speed}{distance}"

    def direction(self, setup: Setup, offset: float) -> float:
        """The angle that is read of a contact at b/R ``offset``, rad; ValueError if the ball does not get there."""
        squirt = setup.squirt_factor * setup.predictions.squirt(offset, self.speed)
        if self.distance is None:
            return squirt
        return reading_angle(
            squirt,
            offset,
            elevation=setup.elevations.get(self.stated_elevation, self.elevation or ELEVATION),
            speed=setup.speed_factor * setup.predictions.ball_speed(offset, self.speed),
            distance=self.distance,
            friction=setup.cloth_friction,
        )

    def shifted(self, setup: Setup, zero: float = 0.0) -> float:
        """b/R of the contact with its systematic errors. zero: error of the offset of its series, m."""
        shift = zero + (setup.contact_shift if self.offset_error else 0.0)
        return min(max(self.offset + shift / float(setup.scene.ball.radius), -0.99), 0.99)


@dataclass(frozen=True, kw_only=True)
class Squirt(BallDirection):
    """Squirt at an offset b/R: one value, or left and right, whose mean is free of the zero error of the offset.

    All count away from the struck side. error: of each value. series: strokes with the same aim have one zero error of
    the offset, zero_error, one standard deviation, where only one side was measured.
    """

    key: ClassVar[str] = "squirt"
    unit: ClassVar[str] = "rad"
    title: ClassVar[str] = "squirt, left and right, at three offsets and two speeds"
    consequence: ClassVar[str] = "no measurement tests the tip or the contact"

    value: Annotated[float | None, ANGLE] = None
    left: Annotated[float | None, ANGLE] = None
    right: Annotated[float | None, ANGLE] = None
    error: Annotated[float, Quantity("rad", POSITIVE)]
    series: str = ""
    zero_error: Annotated[float | None, Quantity("m", "(0, inf)")] = None

    def __post_init__(self) -> None:
        super().__post_init__()
        sides = (self.left is None) + (self.right is None)
        if sides == 1 or (sides == 0) == (self.value is not None):
            raise ValueError("Squirt.value must be given, or left and right without it; got " + self._present())
        if sides == 0 and self.zero_error is not None:
            raise ValueError(
                f"Squirt.zero_error must be absent beside left and right, whose mean has none; got {self.zero_error} m"
            )
        for name in ("value", "left", "right"):
            value = getattr(self, name)
            if value is not None and value < 0:
                raise ValueError(
                    f"Squirt.{name} must be at least 0: squirt counts away from the struck side, left or right; got "
                    f"{with_unit(value, 'rad')}"
                )

    def _present(self) -> str:
        present = [name for name in ("value", "left", "right") if getattr(self, name) is not None]
        return " and ".join(present) or "none of them"

    @property
    def measured_value(self) -> float:
        """The mean of both sides."""
        if self.left is not None and self.right is not None:
            return (self.left + self.right) / 2
        assert self.value is not None
        return self.value

    @property
    def sd(self) -> float:
        """Of the mean."""
        return self.error / (1.0 if self.left is None else 2**0.5)

    @property
    def label(self) -> str:
        """At which offset and speed."""
        return f"squirt {self.circumstances}{', ' + self.series if self.series else ''}"

    def compute(self, setup: Setup) -> float:
        """Of the coupled strike; the mean of both sides, to first order, if both were measured."""
        zero = 0.0 if self.left is not None else setup.zeros.get(self.series, 0.0)
        return self.direction(setup, self.shifted(setup, zero))

    @classmethod
    def missing(cls, measurements: Sequence[Any]) -> str:
        """Which part of the full set is missing."""
        if not measurements:
            return super().missing(measurements)
        offsets, speeds = ({getattr(measurement, name) for measurement in measurements} for name in ("offset", "speed"))
        parts = []
        if any(measurement.left is None for measurement in measurements):
            parts.append("the other side (the values include a zero error of the offset)")
        if len(offsets) < 3:
            parts.append(f"three offsets, here {len(offsets)} (the increase with the offset tests the tip)")
        if len(speeds) < 2:
            parts.append("a second speed (it tests the effect of the contact time)")
        return f"squirt: {'; '.join(parts)}" if parts else ""

    @classmethod
    def candidates(cls, scene: Scene) -> tuple[Measurement, ...]:
        """Left and right at a medium offset."""
        return (cls(offset=0.3, left=0.03, right=0.03, error=SQUIRT_ERROR * 2**0.5),)


@dataclass(frozen=True, kw_only=True)
class PivotLength(BallDirection):
    """The natural pivot length at an offset b/R: pivoted about it, the cue sends the ball along the original aim.

    Zero errors of angle and offset cancel in it.
    """

    key: ClassVar[str] = "pivot_length"
    unit: ClassVar[str] = "m"
    title: ClassVar[str] = "natural pivot length"
    consequence: ClassVar[str] = "no value of squirt is free of the zero errors of angle and offset"

    value: Annotated[float, Quantity("m", "(0, inf)")]
    error: Annotated[float, Quantity("m", POSITIVE)]

    @property
    def label(self) -> str:
        """At which offset and speed."""
        return f"{self.title} {self.circumstances}"

    def compute(self, setup: Setup) -> float:
        """Of the coupled strike's squirt and the radii of ball and dome [B.1]; ValueError without squirt."""
        offset = self.shifted(setup)
        squirt = self.direction(setup, offset)
        if not squirt > 0:
            raise ValueError(
                f"pivot_length must be of a stroke with squirt above 0 rad; got {squirt:.3g} rad at b/R {self.offset:g}"
            )
        return float(pivot_length(setup.scene, squirt, offset))

    @classmethod
    def candidates(cls, scene: Scene) -> tuple[Measurement, ...]:
        """Left and right, by several bridges, at a medium offset; none of a stroke without squirt."""
        blank = cls(offset=0.3, value=1.0, error=1.0)
        try:
            value = blank.compute(Setup(scene))
        except ValueError:
            return ()
        return (replace(blank, value=value, error=PIVOT_ERROR * value),)


@dataclass(frozen=True, kw_only=True)
class AddedMass(Measurement):
    """Squirt with a mass on the shaft, over that without it; position: from the end of the tip.

    value, baseline: squirt with and without the mass at the same stroke; error: of each of them.
    """

    key: ClassVar[str] = "added_mass"
    unit: ClassVar[str] = ""
    title: ClassVar[str] = "squirt with masses added near the tip"
    consequence: ClassVar[str] = "the end-mass distribution along the shaft is not tested"

    mass: Annotated[float, MASS]
    position: Annotated[float, LENGTH]
    value: Annotated[float, ANGLE]
    baseline: Annotated[float, ANGLE]
    error: Annotated[float, Quantity("rad", POSITIVE)]
    offset: Annotated[float, Quantity("", "(0, 1)")]
    speed: Annotated[float | None, Quantity("m/s", "(0, inf)")] = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.baseline:
            raise ValueError("AddedMass.baseline must be a squirt other than 0 rad, over which the other is; got 0")

    @property
    def measured_value(self) -> float:
        """The ratio."""
        return self.value / self.baseline

    @property
    def sd(self) -> float:
        """Of the ratio, from the value's error alone: the baseline's is one for the whole series."""
        return self.error / abs(self.baseline)

    @property
    def label(self) -> str:
        """Which mass, where."""
        return f"squirt ratio, {with_unit(self.mass, END_MASS, 3)} at {with_unit(self.position, 'm')}"

    def compute(self, setup: Setup) -> float:
        """Two coupled strikes."""
        with_mass = setup.predictions.squirt(self.offset, self.speed, (self.mass, self.position))
        return with_mass / setup.predictions.squirt(self.offset, self.speed)


@dataclass(frozen=True, kw_only=True)
class ContactTime(Measurement):
    """Contact time of a central impact; speed: of the cue, by default the scene's."""

    key: ClassVar[str] = "contact_time"
    unit: ClassVar[str] = "s"
    title: ClassVar[str] = "contact time of a central impact"
    consequence: ClassVar[str] = "the leather's E stays that of a table, uncertain by a factor of two"

    value: Annotated[float, CONTACT_TIME]
    error: Annotated[float, Quantity("s", POSITIVE)]
    speed: Annotated[float | None, Quantity("m/s", "(0, inf)")] = None

    @property
    def label(self) -> str:
        """At which speed."""
        return self.title if self.speed is None else f"contact time at {with_unit(self.speed, 'm/s', 3)}"

    def compute(self, setup: Setup) -> float:
        """Of the coupled strike."""
        return setup.predictions.duration(self.speed)

    @classmethod
    def candidates(cls, scene: Scene) -> tuple[Measurement, ...]:
        """By a circuit of foil, or on video."""
        return (cls(value=float(scene.contact_time), error=CONTACT_TIME_ERROR * float(scene.contact_time)),)


_TYPES: tuple[type[Measurement], ...] = (
    *(Weight, Balance, Tone, Stiffness, ContactTime, Squirt, PivotLength, AddedMass),
)
MEASUREMENT_TYPES: dict[str, type[Measurement]] = {kind.key: kind for kind in _TYPES}
