"""Effects on the stroke as a whole: a second hit, a raised cue."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from cuefem.effects.base import Effect
from cuefem.effects.terms import ContactTerms, Table
from cuefem.quantity import Quantity


@dataclass(frozen=True)
class SecondHit(Effect):
    """The tip catches up with the ball and strikes it again. It acts once.

    window: how long after the first separation a further contact may begin, s.

    Adds: after each separation, the free motion of cue and ball in their plane, and a further contact wherever tip and
    ball touch again within the window. Its phases follow a phase ("apart", "free") in Outcome.phases;
    `cuefem.contact.second_hit.hits` lists the contacts. The tip keeps the set that it had as the ball left, and is
    pressed again on the curve on which it was unloaded.
    Matters when: a soft or dead tip meets a shaft that vibrates, or the cue is heavy.
    Wrong when: the leather recovers its shape meanwhile, or the player's hand pushes or holds the cue. Gravity and
    table are left out, and the normal stays that of the first touch unless `RollingContact` turns it.
    Limit: a window that ends before the second touch is the bare strike.
    Source: physics.md section 8.
    """

    once: ClassVar[bool] = True

    window: Annotated[float, Quantity("s", "(0, inf)")] = 5e-3

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The time in which tip and ball may touch again."""
        terms.set_window(self.window)


@dataclass(frozen=True)
class Elevation(Effect):
    """A raised cue: it points down, and the table pushes back while the tip presses the ball onto it. It acts once.

    angle: of the cue above the table, rad, in [0, pi/2). friction: of the ball on the cloth, 0.15 to 0.4, usually 0.2.

    Adds: the third dimension. The stroke's offset is to the side, and the plane of the cue's axis and the ball's centre
    is tilted by the angle; within it the contact is that of a level cue. The table is rigid and keeps the ball from
    going down, without a bounce; Coulomb friction acts at the ball's lowest point. The tip's friction acts in two
    directions, and the cue bends in two planes, with the same modes and without twist. Squirt, speed and ball_velocity
    are then along the table, and spin is about the vertical; Outcome.history has the vectors `velocity` and `spin` (x
    right, y forward, z up). The contact is stepped in time.
    Matters when: the cue is raised by a few degrees, for the spin about level axes and, in proportion to the angle, for
    the speed, by the friction of the cloth; squirt changes with the angle's square. The curve of the ball after the
    stroke is not computed.
    Wrong when: the ball jumps, which needs the bounce of cloth and slate; it is frozen to another ball; or tip friction
    is endless, which begins with a blow in which the table does not rub. Refused with TipShear, RollingContact,
    SecondHit and a dead tip.
    Limit: angle -> 0 is the level stroke.
    Source: rigid-body mechanics, written out in `cuefem.contact.elevation`; friction of ball on cloth: Alciatore,
    billiards.colostate.edu, physical properties.
    """

    once: ClassVar[bool] = True
    excludes: ClassVar[tuple[str, ...]] = ("TipShear", "RollingContact", "SecondHit")

    angle: Annotated[float, Quantity("rad", "[0, 1.5707963267948966)")]
    friction: Annotated[float, Quantity("", "[0, inf)")] = 0.2

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The table under the ball."""
        terms.set_table(Table(self.angle, self.friction))
