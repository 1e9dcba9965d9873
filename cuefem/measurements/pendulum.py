"""The pendulum test: a light ball on a thread swings against the side of a shaft, freely suspended and clamped.

The ball, of mass m, rebounds from the free shaft with e_A times its speed, and from the clamped one with e times its
speed. A free mass with the same rebound is m_e = m (1 + e_A)/(e - e_A): the end mass at that position, for an impact of
that duration (handbook: Measuring a cue).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from cuefem.contact.side_strike import Striker
from cuefem.cue import Array
from cuefem.measurements.measurement_types import EndMass
from cuefem.quantity.fields import CONTACT_TIME, LENGTH, Quantity, check_fields

GRAVITY = 9.81  # m/s2
DEFAULT_TIME_ERROR = 0.1  # relative, 1 sigma, if contact_time_error is omitted
DISPLACEMENT = Quantity("m", "(-100, 100)")
POSITIVE_LENGTH = Quantity("m", "(0, 100)")
MASS = Quantity("kg", "(0, inf)")


class Ratio(NamedTuple):
    """Speed after a rebound over the speed before, and its error (1 sigma)."""

    value: float
    error: float


@dataclass(frozen=True, kw_only=True)
class Pendulum:
    """A pendulum test by its readings from a ruler; `end_mass` is the result. All errors are 1 sigma.

    Parameters
    ----------
    ball_mass, ball_mass_error : float
        Mass of the ball, kg, and its error, by default 1e-4 kg.
    thread_length : float
        From the suspension to the ball's centre, m.
    release, rebound : tuple of float
        Horizontal displacement of the ball before and after each rebound from the freely suspended shaft, m: one
        release for all rebounds, or one for each. A rebound is negative if the ball continues forwards.
    clamped_release, clamped_rebound : tuple of float
        The same with the clamped shaft; clamped_release is by default the first release.
    reading_error : float
        Of one displacement, m, by default 1e-3 m.
    position : float
        Of the impact, m from the end of the tip.
    contact_time, contact_time_error : float, optional
        For which the ball touches the clamped shaft, s; the error is by default 10 %. Instead of contact_time:
    force, indentation : float, optional
        A static force on the ball, N, and its indentation, m: they determine the contact time by Hertz's law.
    source : str
        Where the readings come from.

    Raises
    ------
    ValueError
        If a number is out of bounds, the readings contradict each other, or the end mass would be uncertain by more
        than 100 %.

    Examples
    --------
    >>> from cuefem.measurements.pendulum import Pendulum
    >>> swings = {"release": (0.2,), "rebound": (-0.034,), "clamped_rebound": (0.162,)}
    >>> measured = Pendulum(ball_mass=8e-3, thread_length=1.0, position=0.016, contact_time=1e-3, **swings).end_mass
    >>> round(1e3 * measured.value, 2), round(1e3 * measured.error, 2)  # g
    (6.8, 0.12)
    """

    ball_mass: Annotated[float, MASS]
    ball_mass_error: Annotated[float, MASS] = 1e-4
    thread_length: Annotated[float, POSITIVE_LENGTH]
    release: tuple[Annotated[float, POSITIVE_LENGTH], ...]
    rebound: tuple[Annotated[float, DISPLACEMENT], ...]
    clamped_release: tuple[Annotated[float, POSITIVE_LENGTH], ...] = ()
    clamped_rebound: tuple[Annotated[float, POSITIVE_LENGTH], ...]
    reading_error: Annotated[float, POSITIVE_LENGTH] = 1e-3
    position: Annotated[float, LENGTH]
    contact_time: Annotated[float | None, CONTACT_TIME] = None
    contact_time_error: Annotated[float | None, Quantity("s", "(0, inf)")] = None
    force: Annotated[float | None, Quantity("N", "(0, inf)")] = None
    indentation: Annotated[float | None, POSITIVE_LENGTH] = None
    source: str = ""

    def __post_init__(self) -> None:
        check_fields(self)
        if not self.clamped_release:
            object.__setattr__(self, "clamped_release", self.release[:1])
        for name, bounds in (
            ("release", POSITIVE_LENGTH),
            ("rebound", DISPLACEMENT),
            ("clamped_release", POSITIVE_LENGTH),
            ("clamped_rebound", POSITIVE_LENGTH),
        ):
            readings = tuple(bounds.check(f"Pendulum.{name}", value) for value in getattr(self, name))
            object.__setattr__(self, name, readings)
            if not readings or max(map(abs, readings)) >= self.thread_length:
                got = f"{max(map(abs, readings))} m" if readings else "no reading"
                raise ValueError(
                    f"Pendulum.{name} must be displacements less than thread_length, {self.thread_length} m; got {got}"
                )
        for release, rebound in (("release", "rebound"), ("clamped_release", "clamped_rebound")):
            n_release, n_rebound = len(getattr(self, release)), len(getattr(self, rebound))
            if n_release not in (1, n_rebound):
                raise ValueError(
                    f"Pendulum.{release} must be one reading, or one for each {rebound} ({n_rebound}); got {n_release}"
                )
        stated = [name for name in ("contact_time", "force", "indentation") if getattr(self, name) is not None]
        if stated not in (["contact_time"], ["force", "indentation"]):
            got = " and ".join(stated) or "none of them"
            raise ValueError(f"Pendulum.contact_time must be given, or force and indentation without it; got {got}")
        _ = self.end_mass

    @property
    def end_mass(self) -> EndMass:
        """The end mass with its error; ValueError for contradictory readings."""
        m, free = self.ball_mass, self._ratio(self.release, self.rebound)
        clamped = self._ratio(self.clamped_release, self.clamped_rebound)
        a, e = free.value, clamped.value
        if not 0 < e <= 1 + 3 * clamped.error:
            raise ValueError(
                f"Pendulum.clamped_rebound must have a speed in (0, 1] times that of clamped_release; got {e:.4g} times"
            )
        if not -1 < a < e:
            raise ValueError(
                f"Pendulum.rebound must have a speed between -1 and {e:.4g} times that of release; got {a:.4g} times"
            )
        by_free, by_clamped = (1 + e) / ((1 + a) * (e - a)) * free.error, clamped.error / (e - a)
        relative = math.hypot(self.ball_mass_error / m, by_free, by_clamped)
        if relative > 1:
            raise ValueError(
                "Pendulum.rebound must differ more from clamped_rebound for an error of the end mass below 100 %; "
                f"got {100 * relative:.3g} %"
            )
        value, time = m * (1 + a) / (e - a), self._time(min(e, 1.0))
        time_error = self.contact_time_error or DEFAULT_TIME_ERROR * time
        ball = {"ball_mass": m, "restitution": min(e, 1.0), "contact_time": time, "contact_time_error": time_error}
        return EndMass(value=value, error=relative * value, position=self.position, source=self.source, **ball)

    def _time(self, restitution: float) -> float:
        """The contact time on a clamped shaft, s, at the speed of the free test, which it represents."""
        if self.contact_time is not None:
            return self.contact_time
        assert self.force is not None
        assert self.indentation is not None
        speed = 2 * math.sqrt(GRAVITY * self.thread_length) * float(np.mean(self._half_angle_sines(self.release)[0]))
        modulus = 0.75 * self.force / self.indentation**1.5  # K = 4/3 E* sqrt(R), with R = 1 m
        return Striker(self.ball_mass, restitution, modulus=modulus, radius=1.0).wall_time(speed)

    def _ratio(self, release: Sequence[float], rebound: Sequence[float]) -> Ratio:
        """The mean ratio of all rebounds; its error is that of the readings, or the scatter of the mean if larger."""
        (s0, d0), (s1, d1) = self._half_angle_sines(release), self._half_angle_sines(rebound)
        ratios = s1 / s0
        n = len(ratios)
        by_release = float(np.sqrt(np.mean((ratios * d0 / s0) ** 2) / len(release)))
        by_rebound = float(np.sqrt(np.mean((d1 / s0) ** 2) / n))
        scatter = float(np.std(ratios, ddof=1)) / math.sqrt(n) if n > 1 else 0.0
        return Ratio(float(np.mean(ratios)), max(math.hypot(by_release, by_rebound), scatter))

    def _half_angle_sines(self, displacements: Sequence[float]) -> tuple[Array, Array]:
        """sin(theta/2) of the thread's angle, which is proportional to the speed at the lowest point, and its error."""
        angle = np.arcsin(np.array(displacements) / self.thread_length)
        return np.sin(angle / 2), np.cos(angle / 2) / (2 * np.cos(angle)) * self.reading_error / self.thread_length
