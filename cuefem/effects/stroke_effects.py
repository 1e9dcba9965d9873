"""Effects on the stroke as a whole: a second hit, a raised cue."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

from cuefem.effects.contact_terms import BilliardTable, ContactTerms
from cuefem.effects.effect import Effect, TrialValues
from cuefem.quantity.fields import Quantity


@dataclass(frozen=True)
class SecondHit(Effect):
    """Double hit: the tip catches up with the ball and strikes it again. It acts once.

    Parameters
    ----------
    window : float, default 5e-3
        Time after the first separation, s, within which a further contact is computed.

    Notes
    -----
    Adds: After each separation cue and ball move freely in their plane, and a new contact begins wherever they touch
    again within the window. Its phases follow a phase ("separated", "free") in `Outcome.phases`. The tip retains its
    residual indentation and reloads on its unloading curve.

    Matters when: The tip is soft or of low restitution on a shaft that vibrates, or the cue is heavy.

    Wrong when: The leather recovers its shape between the hits, or the player's hand accelerates or holds the cue.
    Gravity and the table are neglected, and the direction of the contact is that of the first touch unless
    `RollingContact` turns it.

    Limit: The effect vanishes as the window goes to zero; it changes nothing if the tip does not reach the ball again.

    Source: handbook: Effects.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue, stroke = cf.LumpedCue(mass=0.54, end_mass=0.006), cf.Stroke(1.0, 0.3)
    >>> again = cf.strike(cf.Scene(cue, stroke=stroke, effects=(cf.SecondHit(),)))
    >>> abs(again.squirt - cf.strike(cf.Scene(cue, stroke=stroke)).squirt) < 1e-12
    True
    """

    once: ClassVar[bool] = True

    window: Annotated[float, Quantity("s", "(0, 1]").with_typical_range(1e-3, 0.1)] = 5e-3

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The simulated time after the first separation."""
        terms.window = self.window


@dataclass(frozen=True)
class Elevation(Effect):
    """A raised cue: it points downwards, and the table supports the ball during the contact.

    Parameters
    ----------
    angle : float
        Angle of the cue's axis below the horizontal, rad, in [0, pi/2).
    friction : float, default 0.2
        Coulomb friction of the ball on the cloth. Measured values are 0.15 to 0.4.

    Notes
    -----
    Adds: The third dimension. The stroke's offset is sideways, and the plane of the cue's axis and the ball's centre is
    tilted by the angle; in that plane the contact is the level one. The rigid table stops the ball's downward motion
    without restitution, with Coulomb friction at its lowest point. The tip's friction therefore acts in two directions,
    and the cue bends in two planes with the same modes and without twist. Squirt, speed and `ball_velocity` are then in
    the plane of the table and spin is about the vertical; `Outcome.history` has all components (`velocity` and `spin`,
    x right, y forward, z up).

    Matters when: The cue is raised by even a few degrees. The ball then spins about horizontal axes too, friction on
    the cloth reduces its speed in proportion to the angle, and squirt changes with the square of the angle. The curve
    of the ball after the stroke (swerve) is not included.

    Wrong when: The stroke is a jump shot, which needs the bounce of cloth and slate, or the ball is frozen to another
    one. It cannot be used with TipShear, RollingContact or SecondHit.

    Limit: The effect vanishes as the angle goes to zero, in proportion to the angle with friction on the cloth and to
    its square without.

    Source: handbook: Effects; friction of a ball on cloth 0.15 to 0.4, typically 0.2: Alciatore,
    billiards.colostate.edu, physical properties.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue, stroke = cf.LumpedCue(mass=0.54, end_mass=0.006), cf.Stroke(1.0, 0.3)
    >>> raised = cf.strike(cf.Scene(cue, stroke=stroke, effects=(cf.Elevation(0.1),)))
    >>> raised.ball_speed < cf.strike(cf.Scene(cue, stroke=stroke)).ball_speed
    True
    """

    once: ClassVar[bool] = True
    excludes: ClassVar[tuple[str, ...]] = ("TipShear", "RollingContact", "SecondHit")
    trial_values: ClassVar[TrialValues | None] = TrialValues(
        {"angle": math.radians(5)}, "5 degrees, a cue over a rail (assumed)"
    )

    angle: Annotated[float, Quantity("rad", "[0, 1.5707963267948966)")]
    friction: Annotated[float, Quantity("", "[0, inf)")] = 0.2

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The table under the ball."""
        terms.table = BilliardTable(self.angle, self.friction)
