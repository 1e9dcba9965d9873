"""Shots as a maker reads them: how far the ball is off the line of aim at a distance, struck on either side."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from cuefem.measurements.measurement_types import DISTANCE, ELEVATION_BOUNDS, Squirt
from cuefem.quantity.display_units import with_unit
from cuefem.quantity.fields import Quantity, check_fields
from cuefem.scene import Scene

MISS = Quantity("m", "(-10, 10)")  # wider than what is accepted: a negative one is refused in words of its own
LENGTH = Quantity("m", "(0, 1)")
MAX_OFFSET = 0.7  # b/R, beyond any tip's miscue limit
ADVICE = (
    "Strike hard (ball over 4 m/s: 1 m in a quarter of a second) with the cue as low as the rail allows, read the ball "
    "within 1 m, ten shots a side. Give the distance, the cue's speed, and how far the cue's centre line (or the chalk "
    "mark) is from the ball's centre; if you cannot strike hard, give the elevation, or a second speed."
)
WAYS = {
    "cue_offset": "how far the cue's centre line passes beside the ball's centre",
    "chalk_mark": "how far the middle of the chalk mark on the ball is from its centre, seen along the cue",
}


@dataclass(frozen=True, kw_only=True)
class Shot:
    """Shots on both sides of a ball; `squirt` is the measurement. All errors are 1 sigma.

    Parameters
    ----------
    left, right : float
        How far the ball passes beside the line of aim at ``distance``, m, struck left and right of its centre; both
        count away from the struck side, so that squirt is positive.
    distance : float
        From the ball's start to where it is read, m.
    cue_offset, chalk_mark : float
        One of them: distance of the cue's centre line from the ball's centre, m; or of the chalk mark on the ball.
    speed : float, optional
        Of the cue, m/s; without it that of the scene, with a large error.
    elevation, elevation_error : float, optional
        Of the cue, rad; without it that of a cue over a rail, 1.8 to 4.9 degrees.
    reading_error, offset_error : float
        Of one side, m.
    source : str
        Where the readings come from.

    Raises
    ------
    ValueError
        If a number is out of bounds, a side is negative, or not exactly one of cue_offset and chalk_mark is given.

    Examples
    --------
    >>> from cuefem.measurements.shot import Shot
    >>> shot = Shot(cue_offset=14.3e-3, left=40.6e-3, right=38.1e-3, distance=1.22)
    >>> round(shot.contact(radius=28.575e-3, dome_radius=9.5e-3), 3)  # b/R
    0.376
    """

    left: Annotated[float, MISS]
    right: Annotated[float, MISS]
    distance: Annotated[float, DISTANCE]
    cue_offset: Annotated[float | None, LENGTH] = None
    chalk_mark: Annotated[float | None, LENGTH] = None
    speed: Annotated[float | None, Quantity("m/s", "(0, inf)")] = None
    elevation: Annotated[float | None, ELEVATION_BOUNDS] = None
    elevation_error: Annotated[float | None, ELEVATION_BOUNDS] = None
    reading_error: Annotated[float, LENGTH] = 2e-3
    offset_error: Annotated[float, LENGTH] = 1e-3
    source: str = ""

    def __post_init__(self) -> None:
        check_fields(self)
        given = [way for way in WAYS if getattr(self, way) is not None]
        if len(given) != 1:
            ways = " or ".join(f"{way} ({meaning})" for way, meaning in WAYS.items())
            raise ValueError(f"Shot must have {ways}; got {'both' if given else 'neither'}")
        if min(self.left, self.right) < 0 or not self.left + self.right > 0:
            sides = f"left {with_unit(self.left, 'm')} and right {with_unit(self.right, 'm')}"
            raise ValueError(
                "Shot.left and right must be positive: both count from the line of aim away from the struck side; got "
                f"{sides} (a ball that curves back over the line: strike harder, or hold the cue lower)"
            )

    def contact(self, radius: float, dome_radius: float) -> float:
        """b/R of the contact; radius, dome_radius: of the ball and of the tip's dome, m.

        The cue's centre line is (R + r) b/R from the ball's centre.
        """
        if self.chalk_mark is not None:
            return self.chalk_mark / radius
        assert self.cue_offset is not None
        return self.cue_offset / (radius + dome_radius)

    def squirt(self, scene: Scene) -> Squirt:
        """The measurement of squirt by the ball and tip of a scene; ValueError beyond any miscue limit."""
        radius = float(scene.ball.radius)
        offset = self.contact(radius, scene.dome_radius)
        if not offset < MAX_OFFSET:
            way = "chalk_mark" if self.cue_offset is None else "cue_offset"
            limit = with_unit(MAX_OFFSET * (getattr(self, way) / offset), "m")
            raise ValueError(
                f"Shot.{way} must be below {limit}, b/R {MAX_OFFSET:g}, beyond which every tip slips off; got "
                f"{with_unit(getattr(self, way), 'm')}, b/R {offset:.2f}"
            )
        per_side = self.offset_error * (1.0 if self.cue_offset is None else radius / (radius + scene.dome_radius))
        left, right = (math.atan(miss / self.distance) for miss in (self.left, self.right))
        return Squirt(
            offset=offset,
            left=left,
            right=right,
            error=self.reading_error / self.distance,
            speed=self.speed,
            distance=self.distance,
            elevation=self.elevation,
            elevation_error=self.elevation_error,
            offset_error=per_side / math.sqrt(2),  # either side is set anew
            source=self.source,
        )
