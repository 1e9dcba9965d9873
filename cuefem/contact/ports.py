r"""The ports at which the contact acts on cue and ball, and the matrix C of handbook: The contact.

The frame, from above; the cue moves along u, and w is on the struck side:

```text
      w                t
      ^               /
      |              /   . - - - .
      |    cue      / .             .
      |  ==========P                 .     P  first touch of tip and ball
      |            .\                .     O  the ball's centre
      |            . \ n             .     n  from P to O
      |            .  v   phi        .     t  across it, to the struck side
      |             .  O - - - - -  .
      |               .           .        phi: from u to n; sin(phi) is the offset b/R
      +----> u            ' - - '
```

In (u, w), t = (sin(phi), cos(phi)) and n = (cos(phi), -sin(phi)). The velocities of the contact are those of the ball
against the tip at P, its forces act on the ball. Above a table p = t x n is the third axis. C maps the velocities y of
the ports of the cue, then of the ball, to those of the contact; its transpose maps forces to loads:

    v = C y, loads = C' F.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.modal_response import ModalPropagator, level_propagator, raised_propagator
from cuefem.cue import Array
from cuefem.scene import Scene


@dataclass(frozen=True)
class FirstTouch:
    """Where tip and ball touch first.

    phi: angle of the contact, rad. arm: displacement (u, w) of the contact per unit rotation of the cue's end section,
    m. dome: radius of the tip's dome, m. rim: the contact's angle at which the dome ends, rad.
    """

    phi: float
    arm: tuple[float, float] = (0.0, 0.0)
    dome: float = 0.0
    rim: float = math.inf

    @property
    def ahead(self) -> float:
        """Distance from the end section forwards to the centre of the dome, or to the edge beyond its rim, m."""
        return -self.arm[1] - (self.dome * math.cos(self.phi) if self.phi < self.rim else 0.0)


# From (t, n) of the velocity of the ball's centre and R times its spin to (t, n) of the contact.
_FROM_LEVEL_BALL = np.array([[1.0, 0.0, 1.0], [0.0, 1.0, 0.0]])


def _from_tip(phi: float) -> Array:
    """From (u, w) of the tip's velocity to (t, n) of the contact's, (2, 2)."""
    s, c = math.sin(phi), math.cos(phi)
    return np.array([[-s, -c], [-c, s]])


@dataclass(frozen=True)
class LevelPorts:
    """Ports (u, w) of a level cue, and the rotation rate of its end section if the contact has a moment arm about it.

    The ball's velocities are (t, n) of its centre and R times its spin. rolls: whether the contact rolls over ball and
    dome, which turns t and n.
    """

    touch: FirstTouch
    rolls: bool = False
    planes: ClassVar[int] = 1

    @property
    def has_arm(self) -> bool:
        """Whether the contact has a moment arm, now or when it has rolled."""
        return any(self.touch.arm) or (self.rolls and self.touch.dome > 0)

    @cached_property
    def kinematics(self) -> Array:
        """C at the first touch, (2, 5), or (2, 6) with a moment arm."""
        from_rotation = -np.array([self.arms]).T[:, : int(self.has_arm)]
        return np.hstack([_from_tip(self.touch.phi), from_rotation, _FROM_LEVEL_BALL])

    @property
    def arms(self) -> tuple[float, float]:
        """Moment arms of (t, n) about the end section, m."""
        s, c, (u, w) = math.sin(self.touch.phi), math.cos(self.touch.phi), self.touch.arm
        return s * u + c * w, c * u - s * w

    @property
    def unknowns(self) -> int:
        """State variables of ball and tip: the ball's velocities, with rolling the angle and the arc."""
        return 3 + 2 * self.rolls

    def propagator(self, tip: TipModes) -> ModalPropagator:
        """The cue's modes with these ports."""
        return level_propagator(tip, turns=self.has_arm)

    def inverse_masses(self, mass: float, inertia: float) -> Array:
        """Of the ball's velocities, 1/kg."""
        return np.array([1 / mass, 1 / mass, 1 / (inertia * mass)])

    @property
    def fields(self) -> dict[str, Any]:
        """Rolling over ball and dome in the kernel's input."""
        arm_t, arm_n = self.arms
        return dict(
            rolling=self.rolls,
            dome=self.touch.dome,
            rim=min(self.touch.rim, math.pi),
            arm_t=arm_t,
            arm_n=arm_n,
        )

    def horizontal(self, ball: Array) -> Array:
        """(t, n) of the velocity of the ball's centre, m/s, (..., 2), from its velocities, (..., 3)."""
        return ball[..., :2]

    def vertical_spin(self, ball: Array) -> float:
        """R times the ball's spin about the vertical, m/s."""
        return float(ball[2])


@dataclass(frozen=True)
class Raised:
    """Ports (u, w, p) of a cue that points down by ``angle``, rad, above a table (handbook: Effects).

    The contact has the three velocities (t, n, p) of the ball against the tip, and those of the ball's lowest point
    upwards, laterally and forwards; the ball's velocities are (t, n, p) of its centre and R times its spin.
    """

    touch: FirstTouch
    angle: float
    table_friction: float
    planes: ClassVar[int] = 2
    unknowns: ClassVar[int] = 8

    @cached_property
    def axes(self) -> Array:
        """Right, forward and up in (t, n, p), (3, 3)."""
        s, c = math.sin(self.touch.phi), math.cos(self.touch.phi)
        sin_a, cos_a = math.sin(self.angle), math.cos(self.angle)
        return np.array([[c, -s, 0], [cos_a * s, cos_a * c, sin_a], [-sin_a * s, -sin_a * c, cos_a]])

    @cached_property
    def kinematics(self) -> Array:
        """C at the first touch, (6, 9)."""
        right, forward, up = self.axes
        kinematics = np.zeros((6, 9))
        tip, table = kinematics[:3], kinematics[3:]
        tip[:2, :2] = _from_tip(self.touch.phi)
        tip[2, 2] = -1.0
        tip[:, 3:6] = np.eye(3)
        tip[0, 8] = 1.0
        tip[2, 6] = -1.0
        table[:, 3:6] = up, right, forward
        table[1, 6:] = -np.cross(up, right)
        table[2, 6:] = -np.cross(up, forward)
        return kinematics

    def propagator(self, tip: TipModes) -> ModalPropagator:
        """The cue's modes with these ports; the moment arm moves them to the contact."""
        if any(self.touch.arm):
            tip = replace(tip, amplitude=tip.amplitude + np.outer(tip.rotation, self.touch.arm))
        return raised_propagator(tip)

    def inverse_masses(self, mass: float, inertia: float) -> Array:
        """Of the ball's velocities, 1/kg."""
        return np.array([1 / mass] * 3 + [1 / (inertia * mass)] * 3)

    @property
    def fields(self) -> dict[str, Any]:
        """The table in the kernel's input; the contact does not roll."""
        return dict(table_friction=self.table_friction)

    def horizontal(self, ball: Array) -> Array:
        """(t, n) of the horizontal velocity of the ball's centre, m/s, (..., 2), from its velocities, (..., 6)."""
        s, c, (right, forward, _) = math.sin(self.touch.phi), math.cos(self.touch.phi), self.axes
        return np.asarray(ball[..., :3] @ np.array([s * forward + c * right, c * forward - s * right]).T)

    def on_table(self, ball: Array) -> tuple[Array, Array]:
        """Right, forward and up: velocity of the ball's centre, and R times its spin, m/s."""
        return self.axes @ ball[:3], self.axes @ ball[3:]

    def vertical_spin(self, ball: Array) -> float:
        """R times the ball's spin about the vertical, m/s."""
        return float(self.axes[2] @ ball[3:])


Ports = LevelPorts | Raised


def ports_of(scene: Scene) -> Ports:
    """The ports of a scene at an offset >= 0, its mirror image for a negative one.

    ValueError for effects that exclude each other.
    """
    terms, phi = scene.contact_terms, math.asin(abs(scene.stroke.offset))
    touch = FirstTouch(phi, arm=terms.moment_arm(phi), dome=terms.dome_radius, rim=terms.rim)
    if terms.table is not None:
        if terms.compliance or terms.turns or terms.window is not None or terms.tip is not None:
            raise ValueError("Elevation takes a tip without tangential compliance, a fixed normal and a single hit")
        return Raised(touch, angle=terms.table.angle, table_friction=terms.table.friction)
    return LevelPorts(touch, rolls=terms.turns)
