"""A stroke in the table's frame: where on the ball, in which direction, and what comes out in three dimensions.

The frame is [Kim]'s (end of sec. 5): z points up, and a cue that points along +y strikes with its right along +x. The
impact stays planar, in the plane of the cue's axis and the ball's centre (handbook: The impulse solver); the table's
reaction to a ball that is driven downwards is not part of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cuefem.cue import Array
from cuefem.quantity.display import said
from cuefem.quantity.fields import Quantity, first_failure
from cuefem.scene import Ball, Outcome

# How far the offset of an outcome may lie from that of the point it is placed at.
SAME_OFFSET = 1e-9

_COORDINATE, _COMPONENT = Quantity("m"), Quantity("")


@dataclass(frozen=True)
class Placed:
    """The ball after a stroke, in the table's frame.

    Attributes
    ----------
    velocity : array
        x, y, z on the last axis, m/s.
    spin : array
        x, y, z on the last axis, rad/s.
    """

    velocity: Array
    spin: Array

    def __repr__(self) -> str:
        return said("Placed", vars(self).items())


def place(outcome: Outcome, point: ArrayLike, direction: ArrayLike, *, ball: Ball | None = None) -> Placed:
    """Turn an outcome into the table's frame.

    Parameters
    ----------
    outcome : Outcome
        Of a stroke at the offset `offset_of(point, direction)`, of either sign. Arrays broadcast.
    point : array_like
        (h, l), m: the contact lies h to the right of the ball's centre as the player looks along the cue, and l above
        the table, on the half of the ball that faces the player.
    direction : array_like
        Direction of the cue's motion (x, y, z), of any length.
    ball : Ball, optional
        The ball of the outcome's scene; by default `Ball()`.

    Returns
    -------
    Placed
        Velocity and spin of the ball as vectors.

    Raises
    ------
    ValueError
        If the point is not on the ball, if the cue does not meet the ball there, or if the outcome has another offset.

    Notes
    -----
    The ball leaves at the squirt angle from ``direction``, away from the side that is struck, and spins about R_I x u
    ([Kim] end of sec. 5), R_I from the centre to the contact. For a level cue along +y: struck right (h > 0), it spins
    along +z (right english) and squirts to -x; struck high (l > R), it spins along -x (follow) and squirts into the
    table; struck low, it spins along +x (draw).

    Examples
    --------
    >>> import cuefem as cf
    >>> outcome = cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01), stroke=cf.Stroke(offset=0.3)))
    >>> R = cf.Ball().radius
    >>> placed = cf.place(outcome, (0.3 * R, R), (0, 1, 0))
    >>> bool(placed.velocity[0] < 0), bool(placed.spin[2] > 0)
    (True, True)
    """
    ball = Ball() if ball is None else ball
    offset, axis, along = _geometry(point, direction, ball)
    along_contact = np.arctan2(*np.moveaxis(outcome.ball_velocity, -1, 0))
    angle = outcome.squirt + along_contact  # phi, as the outcome was computed
    _same_offset(offset, np.sin(angle))
    side = np.where(angle < 0, -1.0, 1.0)
    turn = (side * outcome.squirt)[..., None]
    speed = np.asarray(outcome.ball_speed)[..., None]
    velocity = speed * (np.cos(turn) * along + np.sin(turn) * np.cross(axis, along))
    return Placed(velocity, (side * outcome.spin)[..., None] * axis)


def offset_of(point: ArrayLike, direction: ArrayLike, *, ball: Ball | None = None) -> Any:
    """Offset b/R >= 0 of a stroke at a point of the ball, in a direction: the `Stroke.offset` to compute.

    Parameters
    ----------
    point, direction : array_like
        As in `place`; they broadcast.
    ball : Ball, optional
        By default `Ball()`.

    Returns
    -------
    float or array
        b is the distance of the ball's centre from the line through the contact along the cue's motion; for a level cue
        b^2 = h^2 + (l - R)^2.

    Examples
    --------
    >>> import cuefem as cf
    >>> from cuefem.contact.table_frame import offset_of
    >>> R = cf.Ball().radius
    >>> float(round(offset_of((0.3 * R, R), (0, 1, 0)), 12))
    0.3
    """
    return _geometry(point, direction, Ball() if ball is None else ball)[0][()]


def _geometry(point: ArrayLike, direction: ArrayLike, ball: Ball) -> tuple[Array, Array, Array]:
    """Offset b/R, the axis of the spin (zero head on), and the unit vector along the cue."""
    contact, along = _contact(point, direction, np.asarray(ball.radius))
    axis = np.cross(contact, along)
    offset = np.linalg.norm(axis, axis=-1)
    facing = -np.sum(contact * along, axis=-1)
    if not np.all(faces := facing > 0):
        where, (sine, cosine) = first_failure(faces, offset, facing)
        raise ValueError(
            "point must be on the side of the ball that the direction meets, less than 90 degrees between direction "
            f"and inward normal; got {np.degrees(np.arctan2(sine, cosine)):.6g} degrees{where}"
        )
    return offset, axis / np.where(offset > 0, offset, 1.0)[..., None], along


def _contact(point: ArrayLike, direction: ArrayLike, radius: Array) -> tuple[Array, Array]:
    """R_I/R, from the ball's centre to the contact, and the unit vector along the cue."""
    point = _vectors("point", point, 2, _COORDINATE)
    along = _vectors("direction", direction, 3, _COMPONENT)
    length = np.linalg.norm(along, axis=-1, keepdims=True)
    if not np.all(moves := length[..., 0] > 0):
        where, _ = first_failure(moves)
        raise ValueError(f"direction must have a length; got (0, 0, 0){where}")
    along = along / length
    # a cue straight up or down is taken to stand on the player's side, towards +y
    ahead = np.where(np.hypot(along[..., 0], along[..., 1]) > 0, along[..., 0] + 1j * along[..., 1], 1j)
    ahead = ahead / np.abs(ahead)
    aside, height = point[..., 0] / radius, point[..., 1] / radius - 1
    depth = (1 - aside) * (1 + aside) - height**2
    if not np.all(on := depth >= 0):
        where, (R, h, height_got) = first_failure(on, radius, point[..., 0], point[..., 1])
        raise ValueError(
            f"point must be on the ball, h^2 + (l - R)^2 <= R^2 with R = {R} m; got ({h}, {height_got}) m{where}"
        )
    level = -(np.sqrt(depth) + 1j * aside) * ahead  # x + iy, behind the centre and to its right
    x, y, z = np.broadcast_arrays(level.real, level.imag, height)
    contact = np.stack([x, y, z], axis=-1)
    return contact, np.broadcast_to(along, np.broadcast_shapes(contact.shape, along.shape))


def _vectors(name: str, value: ArrayLike, size: int, quantity: Quantity) -> Array:
    vectors = np.asarray(quantity.check(name, value))
    if vectors.ndim == 0 or vectors.shape[-1] != size:
        raise ValueError(f"{name} must have {size} components on its last axis; got an array of shape {vectors.shape}")
    return vectors


def _same_offset(offset: Array, computed: Any) -> None:
    if not np.all(same := np.abs(offset - np.abs(computed)) <= SAME_OFFSET):
        where, (placed, got) = first_failure(same, offset, computed)
        raise ValueError(
            f"outcome must be that of a stroke at the offset of point and direction, {placed:.10g} or {-placed:.10g}; "
            f"got one at {got:.10g}{where}"
        )
