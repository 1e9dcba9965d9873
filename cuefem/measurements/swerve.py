"""Swerve: the path of a ball that a raised cue struck off centre, and where it crosses a line at a distance.

Axes: x along the aim, y to the side of squirt, z up. A raised cue strikes as a level one in the plane through y and its
own axis, inclined by the elevation a. With squirt psi, b/R = sin(phi) and ball speed V the ball leaves with

    v = V (cos a cos psi, sin psi)           w = V sin a cos psi, downwards, which the table stops
    u = v + 5/2 V (0, sin a sin(phi - psi))  slip of the ball's lowest point

Friction mu N against u changes v by -mu N/M e dt and u by 7/2 of that, e = u/|u|: the direction e is constant. Twice
integrated, with z'' = N/M - g and z'(0) = -w,

    x(t) = v t - mu e (z + w t + g t^2/2)

so that a hop has no effect on a ball that is read on the cloth, z = 0, whatever its restitution. Slip ends when
w + g t = 2 |u|/(7 mu); then the ball rolls straight on with v - 2/7 u (Coriolis' final direction).
"""

from __future__ import annotations

import math

import numpy as np

from cuefem.quantity.display_units import with_unit

GRAVITY = 9.81  # m/s2
ROLLING_RESISTANCE = 0.01  # of a ball on cloth, deceleration over g (Alciatore, TP B.8: 0.005 to 0.015)


def reading_angle(
    squirt: float, offset: float, *, elevation: float, speed: float, distance: float, friction: float
) -> float:
    """The angle between the aim and the line from the ball's start to where it crosses a distance.

    Parameters
    ----------
    squirt : float
        Initial direction of the ball in the tilted plane of the strike, rad, away from the struck side.
    offset : float
        b/R of the contact, in (-1, 1).
    elevation : float
        Of the cue, rad.
    speed : float
        Of the ball, m/s.
    distance : float
        Along the aim, m.
    friction : float
        Of the sliding ball on the cloth.

    Returns
    -------
    float
        Rad, positive away from the struck side.

    Raises
    ------
    ValueError
        If the cloth stops the ball before the distance.

    Examples
    --------
    A ball of 2.5 m/s from a cue raised by 4 degrees shows 60 % of its squirt of 2.2 degrees after 1.2 m:

    >>> import math
    >>> from cuefem.measurements.swerve import reading_angle
    >>> stroke = dict(elevation=math.radians(4), speed=2.5, distance=1.2, friction=0.2)
    >>> round(math.degrees(reading_angle(math.radians(2.2), 0.375, **stroke)), 2)
    1.31
    """
    sine, cosine = math.sin(elevation), math.cos(elevation)
    velocity = speed * np.array([cosine * math.cos(squirt), math.sin(squirt)])
    down = speed * sine * math.cos(squirt)
    spin = 2.5 * speed * sine * math.sin(math.asin(offset) - squirt)
    slip = velocity + np.array([0.0, spin])
    slip_speed = float(np.hypot(*slip))
    direction = slip / slip_speed

    def position(time: float) -> np.ndarray:
        pressed = down * time + GRAVITY * time**2 / 2
        moved: np.ndarray = velocity * time - friction * direction * pressed
        return moved

    slides_until = max(2 * slip_speed / (7 * friction) - down, 0.0) / GRAVITY
    end = position(slides_until)
    if end[0] >= distance:
        at = position(_time_to(distance, velocity[0], down, friction * direction[0]))
        return math.atan2(at[1], distance)
    rolling = velocity - 2 / 7 * slip
    reach = end[0] + float(rolling @ rolling) / (2 * ROLLING_RESISTANCE * GRAVITY)
    if reach < distance:
        raise ValueError(
            f"a ball of {with_unit(speed, 'm/s')} must reach the distance of its reading, {with_unit(distance, 'm')}; "
            f"the cloth stops it after {with_unit(reach, 'm')}: strike harder, or read it nearer"
        )
    side = end[1] + rolling[1] / rolling[0] * (distance - end[0])
    return math.atan2(side, distance)


def _time_to(distance: float, speed: float, down: float, friction: float) -> float:
    """When a sliding ball is at a distance, s: distance = (speed - friction down) t - friction g t^2/2."""
    forward, half_deceleration = speed - friction * down, friction * GRAVITY / 2
    return 2 * distance / (forward + math.sqrt(forward**2 - 4 * half_deceleration * distance))
