"""The pendulum test: a light ball on a thread swings against the side of a shaft, freely suspended and clamped.

The ball rebounds from the free shaft with e_A times its speed, and from the clamped one with e times its speed. A
free mass with the same rebound is m_e = m (1 + e_A)/(e - e_A): the end mass at that position, for an
impact of that duration (handbook: Measuring a cue).
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
TIME_ERROR = 0.1  # relative, of a contact time that is stated without an error
SWING = Quantity("m", "(-100, 100)")
SIZE = Quantity("m", "(0, 100)")
MASS = Quantity("kg", "(0, inf)")


class Ratio(NamedTuple):
    """Speed after a rebound over the speed before, and its error."""

    value: float
    error: float


@dataclass(frozen=True, kw_only=True)
class Pendulum:
    """A pendulum test by its readings from a ruler; `end_mass` is the result.

    Parameters
    ----------
    ball_mass, ball_mass_error : float
        Of the light ball, kg.
    thread_length : float
        Of its thread, m.
    release, rebound : tuple of float
        Displacement of the ball before and after rebounds from the freely suspended shaft, m: one reading before,
        or one for each rebound; negative after a rebound where the ball continues forwards.
    clamped_rebound, clamped_release : tuple of float
        The same from the clamped shaft; by default the first reading before.
    reading_error : float
        Of one reading, m.
    position : float
        Of the impact, m from the end of the tip.
    contact_time, contact_time_error : float, optional
        Of the ball on the clamped shaft, s; 10 % by default. Or
    force, indentation : float, optional
        A force, N, and the indentation of the ball under it, m: the contact time follows from Hertz's law.
    source : str

    Raises
    ------
    ValueError
        If a number is out of bounds, or the readings contradict each other.

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
    thread_length: Annotated[float, SIZE]
    release: tuple[Annotated[float, SIZE], ...]
    rebound: tuple[Annotated[float, SWING], ...]
    clamped_release: tuple[Annotated[float, SIZE], ...] = ()
    clamped_rebound: tuple[Annotated[float, SIZE], ...]
    reading_error: Annotated[float, SIZE] = 1e-3
    position: Annotated[float, LENGTH]
    contact_time: Annotated[float | None, CONTACT_TIME] = None
    contact_time_error: Annotated[float | None, Quantity("s", "(0, inf)")] = None
    force: Annotated[float | None, Quantity("N", "(0, inf)")] = None
    indentation: Annotated[float | None, SIZE] = None
    source: str = ""

    def __post_init__(self) -> None:
        check_fields(self)
        if not self.clamped_release:
            object.__setattr__(self, "clamped_release", self.release[:1])
        for name, bounds in (
            ("release", SIZE),
            ("rebound", SWING),
            ("clamped_release", SIZE),
            ("clamped_rebound", SIZE),
        ):
            readings = tuple(bounds.check(f"Pendulum.{name}", value) for value in getattr(self, name))
            object.__setattr__(self, name, readings)
            if not 0 < max(map(abs, readings), default=0.0) < self.thread_length:
                got = f"{max(map(abs, readings))} m" if readings else "no reading"
                raise ValueError(
                    f"Pendulum.{name} must be swings shorter than the thread, {self.thread_length} m; got {got}"
                )
        for release, rebound in (("release", "rebound"), ("clamped_release", "clamped_rebound")):
            one, many = len(getattr(self, release)), len(getattr(self, rebound))
            if one not in (1, many):
                raise ValueError(f"Pendulum.{release} must be one reading, or {many} as {rebound}; got {one}")
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
            raise ValueError(f"Pendulum.clamped_rebound must be (0, 1] of the speed before; got {e:.4g} of it")
        if not -1 < a < e:
            raise ValueError(f"Pendulum.rebound must be between -1 and {e:.4g} of the speed before; got {a:.4g} of it")
        by_free, by_clamped = (1 + e) / ((1 + a) * (e - a)) * free.error, clamped.error / (e - a)
        relative = math.hypot(self.ball_mass_error / m, by_free, by_clamped)
        if relative > 1:
            raise ValueError(
                "Pendulum.rebound must differ more from clamped_rebound, for an end mass uncertain by at most 100 %; "
                f"got {100 * relative:.3g} %"
            )
        value, time = m * (1 + a) / (e - a), self._time(min(e, 1.0))
        later = self.contact_time_error or TIME_ERROR * time
        ball = {"ball_mass": m, "restitution": min(e, 1.0), "contact_time": time, "contact_time_error": later}
        return EndMass(value=value, error=relative * value, position=self.position, source=self.source, **ball)

    def _time(self, restitution: float) -> float:
        """The contact time on the clamped shaft, s."""
        if self.contact_time is not None:
            return self.contact_time
        assert self.force is not None
        assert self.indentation is not None
        speed = 2 * math.sqrt(GRAVITY * self.thread_length) * float(np.mean(self._speeds(self.release)[0]))
        modulus = 0.75 * self.force / self.indentation**1.5  # with R = 1 m: K = 4/3 E* sqrt(R)
        return Striker(self.ball_mass, restitution, modulus=modulus, radius=1.0).wall_time(speed)

    def _ratio(self, release: Sequence[float], rebound: Sequence[float]) -> Ratio:
        """The mean of all rebounds; its error is that of readings, or the scatter if that is larger."""
        (v0, d0), (v1, d1) = self._speeds(release), self._speeds(rebound)
        ratios = v1 / v0
        n = len(ratios)
        by_release = float(np.sqrt(np.mean((ratios * d0 / v0) ** 2) / len(release)))
        by_rebound = float(np.sqrt(np.mean((d1 / v0) ** 2) / n))
        scatter = float(np.std(ratios, ddof=1)) / math.sqrt(n) if n > 1 else 0.0
        return Ratio(float(np.mean(ratios)), max(math.hypot(by_release, by_rebound), scatter))

    def _speeds(self, swings: Sequence[float]) -> tuple[Array, Array]:
        """sin of half the thread's angle, which is proportional to the speed at its lowest point, and its error."""
        aside = np.array(swings) / self.thread_length
        angle = np.arcsin(aside)
        return np.sin(angle / 2), np.cos(angle / 2) / (2 * np.cos(angle)) * self.reading_error / self.thread_length
