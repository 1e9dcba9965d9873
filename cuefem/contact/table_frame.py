"""A stroke in the table's frame: its offset from a point and a direction, and the ball's velocity and spin vectors.

The frame is [Kim]'s (end of sec. 5): z points up, and a cue that points along +y strikes with its right along +x. The
impact is planar, in the plane of the cue's axis and the ball's centre (handbook: The impulse solver), and excludes the
table's reaction to a ball that is driven downwards (the effect `Elevation`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cuefem.cue import Array
from cuefem.quantity.display import brief_repr
from cuefem.quantity.equality import equal_fields
from cuefem.quantity.fields import Quantity, check_kind
from cuefem.scene import Ball, Outcome

# Largest difference of the offset of an outcome from that of point and direction.
OFFSET_TOLERANCE = 1e-9

_COORDINATE, _COMPONENT = Quantity("m"), Quantity("")


@dataclass(frozen=True, eq=False)
class BallMotion:
    """The ball after a stroke, in the table's frame.

    Attributes
    ----------
    velocity : (3,) array
        x, y, z, m/s.
    spin : (3,) array
        x, y, z, rad/s.
    """

    velocity: Array
    spin: Array

    __eq__ = equal_fields

    def __repr__(self) -> str:
        return brief_repr("BallMotion", vars(self).items())


def place(outcome: Outcome, point: ArrayLike, direction: ArrayLike, *, ball: Ball | None = None) -> BallMotion:
    """Turn an outcome into the table's frame.

    Parameters
    ----------
    outcome : Outcome
        Of a planar stroke at the offset `offset_of(point, direction)`, of either sign.
    point : (float, float)
        (h, l), m: the contact lies h to the right of the ball's centre as the player looks along the cue, and l above
        the table, on the half of the ball that faces the player.
    direction : (float, float, float)
        Direction of the cue's motion (x, y, z), of any non-zero length.
    ball : Ball, optional
        The ball of the outcome's scene; by default `Ball()`.

    Returns
    -------
    BallMotion
        Velocity and spin of the ball as vectors.

    Raises
    ------
    ValueError
        If the point is not on the ball, if the cue does not meet the ball there, if the outcome has another offset, or
        after `Elevation`: the outcome's ``history`` then has velocity and spin.

    Notes
    -----
    The ball leaves at the squirt angle from ``direction``, away from the side that is struck, and spins about R_I x u
    ([Kim] end of sec. 5), R_I from the centre to the contact and u the direction. For a level cue along +y: struck
    right (h > 0), it spins along +z (right english) and squirts to -x; struck high (l > R), it spins along -x (follow)
    and squirts into the table; struck low, it spins along +x (draw).

    Examples
    --------
    >>> import cuefem as cf
    >>> outcome = cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01), stroke=cf.Stroke(offset=0.3)))
    >>> R = cf.Ball().radius
    >>> ball = cf.place(outcome, (0.3 * R, R), (0, 1, 0))
    >>> bool(ball.velocity[0] < 0), bool(ball.spin[2] > 0)
    (True, True)
    """
    check_kind("place outcome", outcome, Outcome)
    if getattr(outcome.history, "velocity", None) is not None:
        raise ValueError("place takes planar outcomes; after Elevation use outcome.history.velocity and .spin")
    ball = Ball() if ball is None else ball
    offset, axis, forward = _geometry(point, direction, ball)
    angle = outcome.squirt + math.atan2(*outcome.ball_velocity)  # phi, as the outcome was computed
    if not abs(offset - abs(math.sin(angle))) <= OFFSET_TOLERANCE:
        raise ValueError(
            f"outcome must be that of a stroke at the offset of point and direction, {offset:.10g} or {-offset:.10g}; "
            f"got one at {math.sin(angle):.10g}"
        )
    angle_out = math.copysign(1.0, angle) * outcome.squirt
    velocity = outcome.ball_speed * (math.cos(angle_out) * forward + math.sin(angle_out) * np.cross(axis, forward))
    return BallMotion(velocity, math.copysign(1.0, angle) * outcome.spin * axis)


def offset_of(point: ArrayLike, direction: ArrayLike, *, ball: Ball | None = None) -> float:
    """Offset b/R >= 0 of a stroke at a point of the ball, in a direction: the `Stroke.offset` to compute.

    Parameters
    ----------
    point, direction : sequence of float
        As in `place`.
    ball : Ball, optional
        By default `Ball()`.

    Returns
    -------
    float
        b/R, dimensionless, in [0, 1). b is the distance of the ball's centre from the line through the contact along
        the cue's motion; for a level cue b^2 = h^2 + (l - R)^2.

    Raises
    ------
    ValueError
        If the point is not on the ball, or if the cue does not meet the ball there.

    Examples
    --------
    >>> import cuefem as cf
    >>> from cuefem.contact.table_frame import offset_of
    >>> R = cf.Ball().radius
    >>> round(offset_of((0.3 * R, R), (0, 1, 0)), 12)
    0.3
    """
    return _geometry(point, direction, Ball() if ball is None else ball)[0]


def _geometry(point: ArrayLike, direction: ArrayLike, ball: Ball) -> tuple[float, Array, Array]:
    """Offset b/R, the axis of the spin (zero head-on), and the unit vector along the cue."""
    contact, unit = _contact(point, direction, ball.radius)
    axis, cosine = np.cross(contact, unit), -float(contact @ unit)
    offset = float(np.linalg.norm(axis))
    if not cosine > 0:
        raise ValueError(
            "point must be on the side of the ball that the direction meets, less than 90 degrees between direction "
            f"and inward normal; got {math.degrees(math.atan2(offset, cosine)):.6g} degrees"
        )
    return offset, axis / (offset or 1.0), unit


def _contact(point: ArrayLike, direction: ArrayLike, radius: float) -> tuple[Array, Array]:
    """R_I/R, from the ball's centre to the contact, and the unit vector along the cue."""
    h, contact_height = _vector("point", point, 2, _COORDINATE)
    unit = _vector("direction", direction, 3, _COMPONENT)
    if not unit.any():
        raise ValueError("direction must have a non-zero length; got (0, 0, 0)")
    unit = unit / np.linalg.norm(unit)
    # the player of a vertical cue looks towards +y
    forward = complex(unit[0], unit[1]) or 1j
    right, height = h / radius, contact_height / radius - 1
    depth_squared = (1 - right) * (1 + right) - height**2
    if not depth_squared >= 0:
        raise ValueError(
            f"point must be on the ball, h^2 + (l - R)^2 <= R^2 with R = {radius} m; got ({h}, {contact_height}) m"
        )
    horizontal = -complex(math.sqrt(depth_squared), right) * forward / abs(forward)  # x + iy, behind and to the right
    return np.array([horizontal.real, horizontal.imag, height]), unit


def _vector(name: str, value: ArrayLike, size: int, quantity: Quantity) -> Array:
    if np.shape(value) != (size,):
        raise ValueError(f"{name} must have {size} components; got an array of shape {np.shape(value)}")
    return np.array([quantity.check(f"{name}[{i}]", component) for i, component in enumerate(np.asarray(value))])
