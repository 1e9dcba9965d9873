"""The pendulum test of the effective end mass: a light ball on a thread hits the side of a hanging shaft.

A ball of mass m comes back from the shaft with e_A times its speed, and from the same shaft held firm with e times its
speed. A free mass from which it would bounce in the same way is m_e = m (1 + e_A)/(e - e_A): the end mass at the place
of the blow, for a blow that lasts that long (handbook: Measuring a cue).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np

from cuefem.contact.side_strike import Striker
from cuefem.cue import Array, LumpedCue
from cuefem.endmass.lumped import impulse
from cuefem.measured.documented import DocumentedCue
from cuefem.measured.estimate import Estimate, estimate, squirt_of
from cuefem.measured.kinds import EndMass
from cuefem.measured.outliers import middle_of
from cuefem.measured.unknowns import MODEL_OF_SQUIRT
from cuefem.quantity.fields import CONTACT_TIME, Quantity, check_fields, check_kind
from cuefem.scene import Ball, Scene, Stroke, Tip

GRAVITY = 9.81  # m/s2
TIMES = (0.5e-3, 2e-3)  # contact times that say something of a stroke, s
USUAL = 7e-3  # kg, an end mass to plan for


def swing_speed(aside: float, thread: float) -> float:
    """Speed at the lowest point, m/s, of a ball that began so far aside."""
    return 2 * math.sqrt(GRAVITY * thread) * abs(_swing(aside, thread))


def _height(value: float, thread: float) -> float:
    """The root of a height: proportional to the speed below."""
    return math.copysign(math.sqrt(abs(value)), value)


def _swing(value: float, thread: float) -> float:
    """The sine of half the angle of a thread that hangs ``value`` aside at its end."""
    angle = math.asin(min(abs(value) / thread, 1.0))
    return math.copysign(math.sin(angle / 2), value)


class Way(NamedTuple):
    """A way of reading a speed: the unit of a reading, words, what is proportional to the speed, and the speed itself.

    speed: m/s by the reading and the thread; None where it does not follow from them.
    """

    unit: str
    words: str
    of: Callable[[float, float], float]
    speed: Callable[[float, float], float] | None


WAYS = {
    "swing": Way(
        "m",
        "how far aside the ball swings",
        _swing,
        swing_speed,
    ),
    "height": Way("m", "how high it swings", _height, lambda h, _: math.sqrt(2 * GRAVITY * abs(h))),
    "speed": Way("m/s", "its speed", lambda v, _: v, lambda v, _: abs(v)),
    "frames": Way("", "frames of a film over one distance", lambda n, _: 1 / n, None),
}


@dataclass(frozen=True)
class Bounces:
    """Readings before and after some bounces.

    way: of `WAYS`. before: m, m/s or frames. after: negative where the ball goes on in its old direction. error: of one
    reading, in its unit, one standard deviation. thread: its length, m, which swings need.
    """

    way: str
    before: tuple[float, ...]
    after: tuple[float, ...]
    error: float
    thread: float = math.inf

    def __post_init__(self) -> None:
        if self.way not in WAYS:
            raise ValueError(f"Bounces.way must be one of {', '.join(WAYS)}; got {self.way!r}")
        unit = WAYS[self.way].unit
        Quantity(unit, "(0, inf)").check("Bounces.error", self.error)
        before, after = (tuple(float(x) for x in each) for each in (self.before, self.after))
        if not after or len(before) not in (1, len(after)):
            raise ValueError(
                f"Bounces.before must be one reading or as many as after; got {len(before)} and {len(after)}"
            )
        object.__setattr__(self, "before", before)
        object.__setattr__(self, "after", after)
        for value in before:
            Quantity(unit, "(0, inf)").check("Bounces.before", value)
        for value in after:
            Quantity(unit, "(-inf, inf)").check("Bounces.after", value)
        if self.way == "frames" and 0 in after:
            raise ValueError("Bounces.after must be frames, not 0; a ball that stops has no count: got 0")
        if self.way == "swing" and not max(map(abs, (*before, *after))) < self.thread < math.inf:
            raise ValueError(
                f"Bounces.thread must be longer than every swing; got {self.thread:g} m for "
                f"{max(map(abs, (*before, *after))):g} m"
            )

    @property
    def ratio(self) -> tuple[float, float, float]:
        """Speed after over speed before, of all bounces; its error from readings before, and from those after.

        A bounce that contradicts the others counts little (`middle_of`); what the error grows by where they disagree
        counts as error of the readings after.
        """
        v0, d0 = self._speeds(self.before)
        v1, d1 = self._speeds(self.after)
        ratios = v1 / v0
        n = len(ratios)
        each_before, each_after = np.abs(ratios) * d0 / v0, d1 / v0
        alone = len(v0) == 1  # one reading for all: its error does not average out
        middle, error = middle_of(ratios, each_after if alone else np.hypot(each_before, each_after))
        by_before = float(np.mean(each_before) if alone else np.sqrt(np.sum(each_before**2)) / n)
        by_after = float(np.sqrt(np.sum(each_after**2))) / n
        return middle, by_before, error if alone else max(math.sqrt(max(error**2 - by_before**2, 0.0)), by_after)

    @property
    def impact_speed(self) -> float | None:
        """Mean speed of the ball at the blow, m/s; None if the readings do not tell it."""
        speed = WAYS[self.way].speed
        return None if speed is None else float(np.mean([speed(x, self.thread) for x in self.before]))

    def _speeds(self, readings: Sequence[float]) -> tuple[Array, Array]:
        of = WAYS[self.way].of
        values = [of(x, self.thread) for x in readings]
        if self.way == "frames":
            errors = [self.error / x**2 for x in readings]
        else:
            errors = [abs(of(x + self.error, self.thread) - of(x - self.error, self.thread)) / 2 for x in readings]
        return np.array(values), np.array(errors)


@dataclass(frozen=True)
class PendulumTest:
    """A pendulum test.

    Parameters
    ----------
    ball_mass, ball_mass_error : float
        Of the light ball, kg.
    free : Bounces
        Off the shaft, hung free.
    contact_time : float
        How long the ball touches the shaft that is held firm, s.
    wall : Bounces, optional
        Off the same place of the shaft, held firm; or
    restitution, restitution_error : float, optional
        e of these bounces, if it is known.
    contact_time_error : float, default 0
        s.

    Raises
    ------
    ValueError
        If a number is out of bounds, or not exactly one of wall and restitution is given.

    Examples
    --------
    >>> from cuefem.measured.pendulum import Bounces, PendulumTest
    >>> free = Bounces("speed", (1.0,), (-0.1,), error=0.005)
    >>> test = PendulumTest(8e-3, 5e-5, free, contact_time=1e-3, restitution=0.8, restitution_error=0.01)
    >>> weighed = test.weighed()
    >>> round(1e3 * weighed.end_mass, 3), round(weighed.relative_error, 3)  # g
    (8.0, 0.016)
    """

    ball_mass: Annotated[float, Quantity("kg", "(0, inf)")]
    ball_mass_error: Annotated[float, Quantity("kg", "[0, inf)")]
    free: Bounces
    contact_time: Annotated[float, CONTACT_TIME]
    wall: Bounces | None = None
    restitution: Annotated[float | None, Quantity("", "(0, 1]")] = None
    restitution_error: Annotated[float, Quantity("", "[0, 1)")] = 0.0
    contact_time_error: Annotated[float, Quantity("s", "[0, inf)")] = 0.0

    def __post_init__(self) -> None:
        check_fields(self)
        check_kind("PendulumTest.free", self.free, Bounces)
        check_kind("PendulumTest.wall", self.wall, (Bounces, type(None)))
        if (self.wall is None) == (self.restitution is None):
            got = "neither" if self.wall is None else "both"
            raise ValueError(f"PendulumTest takes wall or restitution, bounces off the shaft held firm; got {got}")

    def weighed(self) -> Weighed:
        """The end mass with its error; ValueError if the readings cannot be."""
        a, *by_free = self.free.ratio
        if self.wall is None:
            assert self.restitution is not None
            e, by_wall = self.restitution, [0.0, self.restitution_error]
        else:
            e, *by_wall = self.wall.ratio
        if not 0 < e <= 1 + 3 * math.hypot(*by_wall):
            raise ValueError(f"the ball must come back from the shaft held firm with (0, 1] of its speed; got {e:.4g}")
        if not -1 < a < e:
            bound = f"(-1, {e:.4g}) of its speed, less than from the shaft held firm"
            raise ValueError(f"the ball must come back from the free shaft with {bound}; got {a:.4g}")
        per_a, per_e = (1 + e) / ((1 + a) * (e - a)), 1 / (e - a)
        budget = {
            "mass of the ball": self.ball_mass_error / self.ball_mass,
            "free shaft, before": per_a * by_free[0],
            "free shaft, after": per_a * by_free[1],
            "held shaft, before": per_e * by_wall[0],
            "held shaft, after": per_e * by_wall[1],
        }
        if self.wall is None:
            budget["restitution"] = budget.pop("held shaft, after")
            del budget["held shaft, before"]
        weighed = Weighed(self, self.ball_mass * (1 + a) / (e - a), a, e, budget)
        if weighed.relative_error > 1:
            raise ValueError(
                "the readings must tell the end mass to within its own size: the ball came back from the free shaft "
                f"nearly as from the held one; got an error of {100 * weighed.relative_error:.3g} %"
            )
        return weighed

    def as_measured(self, weighed: Weighed, position: float) -> EndMass:
        """The result as a measurement of a documented cue; position: of the blow, m from the end of the tip."""
        error = weighed.relative_error * weighed.end_mass
        about: dict[str, Any] = {
            "ball_mass": self.ball_mass,
            "restitution": min(weighed.restitution, 1.0),
            "position": position,
        }
        return EndMass(value=weighed.end_mass, error=error, contact_time=self.contact_time, **about)


@dataclass(frozen=True, eq=False)
class Weighed:
    """What a pendulum test found.

    end_mass: kg. bounce: e_A. restitution: e. budget: relative error of the end mass that each reading makes.
    """

    test: PendulumTest
    end_mass: float
    bounce: float
    restitution: float
    budget: dict[str, float]

    @property
    def relative_error(self) -> float:
        """Of the end mass, one standard deviation."""
        return math.sqrt(math.fsum(x**2 for x in self.budget.values()))

    def interval(self, wide: float = 1.0) -> tuple[float, float]:
        """The end mass ``wide`` standard deviations of its logarithm either way, kg: 1 holds 68 %, `HOLDS_95` 95 %."""
        f = math.exp(wide * self.relative_error)
        return self.end_mass / f, self.end_mass * f


@dataclass(frozen=True)
class Told:
    """What an end mass says about squirt.

    drawn, measured: end mass of the drawing in the same test, and as it was measured, kg. before, after: squirt, rad,
    and its error, by the drawing alone, and with the end mass. estimate: the unknowns of the drawing after the test.
    """

    drawn: float
    measured: float
    before: tuple[float, float]
    after: tuple[float, float]
    offset: float
    estimate: Estimate


def squirt_told(test: PendulumTest, weighed: Weighed, scene: Scene, position: float) -> Told:
    """What the test says about the squirt of a scene's stroke.

    The wood, the bore and the tip of the drawing take the values that explain the end mass, each within what is known
    of it; the squirt is that of the coupled strike with them, so that its own contact time, dome and tip count. Its
    error holds what stays open, and a tenth for the model. position: of the blow, m from the end of the tip.
    """
    measurement = test.as_measured(weighed, position)
    blank = DocumentedCue("pendulum", scene, (measurement,))
    zero = np.zeros(len(blank.unknowns))
    drawn = float(blank.computed(zero)[0])
    if test.contact_time_error:
        later = EndMass(**{**_fields(measurement), "contact_time": 1.02 * measurement.contact_time})
        slope = math.log(later.computed(blank.setup()) / drawn) / math.log(1.02)
        more = abs(slope) * test.contact_time_error / test.contact_time * measurement.value
        measurement = EndMass(**{**_fields(measurement), "error": math.hypot(measurement.error, more)})
    cue = DocumentedCue("pendulum", scene, (measurement,))
    target = squirt_of(cue)
    free = Estimate(cue, zero, np.eye(len(zero)), np.array([drawn]), np.zeros((1, len(zero))), 0.0, True, np.zeros(1))
    estimated = estimate(cue)
    before, after = free.predicted(target), estimated.predicted(target)
    return Told(drawn, measurement.value, _with_model(before), _with_model(after), target.offset, estimated)


def _fields(end_mass: EndMass) -> dict[str, Any]:
    names = ("value", "error", "ball_mass", "restitution", "contact_time", "position")
    return {name: getattr(end_mass, name) for name in names}


def _with_model(value: tuple[float, float]) -> tuple[float, float]:
    return value[0], math.hypot(value[1], MODEL_OF_SQUIRT * value[0])


def lumped_squirt(end_mass: float, mass: float, ball: Ball, tip: Tip, stroke: Stroke) -> float:
    """Squirt of a lumped cue of that end mass, rad: of a flat tip that does not give along the ball."""
    return float(impulse(Scene(LumpedCue(mass, end_mass), ball, tip, stroke)).squirt)


class BallChoice(NamedTuple):
    """A ball to take: its mass, kg; how it would bounce off the free shaft; the error of the end mass that a ratio of
    speeds good to a hundredth leaves."""

    ball_mass: float
    bounce: float
    error: float


def choices(end_mass: float = USUAL, restitution: float = 0.8, error: float = 0.01) -> tuple[BallChoice, ...]:
    """Balls of a quarter to four times the end mass: the best is as heavy as it. error: of both ratios of speeds."""
    made = []
    for factor in (0.25, 0.5, 1.0, 2.0, 4.0):
        m, e = factor * end_mass, restitution
        a = (e * end_mass - m) / (end_mass + m)
        made.append(BallChoice(m, a, error * math.hypot((1 + e) / ((1 + a) * (e - a)), 1 / (e - a))))
    return tuple(made)


class Softness(NamedTuple):
    """How soft a ball must be: its contact time, s, and the force, N, that presses it half a millimetre into a flat."""

    contact_time: float
    force: float


PRESSED = 0.5e-3  # m


def softness(ball_mass: float, speed: float, restitution: float = 0.8) -> tuple[Softness, ...]:
    """What to press a ball with, in order to find one of a contact time of 0.5, 1 or 2 ms by Hertz's law."""
    made = []
    for time in (TIMES[0], 1e-3, TIMES[1]):
        unit = pressed_time(1.0, PRESSED, ball_mass, speed, restitution)
        made.append(Softness(time, (unit / time) ** 2.5))  # T falls like K^-0.4
    return tuple(made)


def pressed_time(force: float, depth: float, ball_mass: float, speed: float, restitution: float = 0.8) -> float:
    """Contact time on the shaft held firm, s, of a ball that ``force``, N, presses by ``depth``, m, by Hertz's law."""
    modulus = 0.75 * force / depth**1.5  # with R = 1 m: K = 4/3 E* sqrt(R)
    return Striker(ball_mass, restitution, modulus=modulus, radius=1.0).wall_time(speed)
