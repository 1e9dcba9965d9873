"""Effects on the stroke as a whole: a second hit, a raised cue."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from cuefem.effects.base import Effect
from cuefem.effects.terms import ContactTerms, Table
from cuefem.quantity import Quantity


@dataclass(frozen=True)
class SecondHit(Effect):
    """The tip catches up with the ball and strikes it again.

    Adds: after each separation the free motion of cue and ball in their plane, and a further contact wherever tip and
    ball touch again within ``window``, s, of the first separation; its phases follow a phase ("apart", "free") in
    Outcome.phases, and `cuefem.contact.second_hit.hits` lists them. A tip keeps the set that it had as the ball left,
    and is pressed anew on the curve it was unloaded on. Matters: a soft or dead tip on a shaft that vibrates, a heavy
    cue. Wrong: where the leather recovers its shape meanwhile, or the player's hand pushes or holds the cue; no
    gravity, no table, and the normal stays that of the first touch unless `RollingContact` turns it. Source: physics.md
    section 8.
    """

    once: ClassVar[bool] = True

    window: Annotated[float, Quantity("s", "(0, inf)")] = 5e-3

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The time in which tip and ball may touch again."""
        terms.set_window(self.window)


@dataclass(frozen=True)
class Elevation(Effect):
    """A raised cue: it points down by ``angle`` rad, and the table pushes back while the tip presses the ball onto it.

    Adds: the third dimension. The stroke's offset is to the side, and the plane of the cue's axis and the ball's centre
    is tilted by the angle; in it the contact is the level one. The table is rigid and keeps the ball from going down,
    gives it no bounce, and rubs at its lowest point with Coulomb friction (``friction``, ball on cloth); so the tip's
    friction acts in two directions, and the cue bends in two planes, with the same modes and no twist. Squirt, speed
    and ball_velocity are then along the table, spin is about the vertical; the rest is in Outcome.history (`velocity`
    and `spin`, x right, y forward, z up). Matters: already at a few degrees for the spin about level axes and, by the
    cloth's friction, in proportion to the angle, for the speed; for squirt with the angle's square. The ball's curve
    after the stroke is none of it. Wrong: for jump shots, which need the bounce of cloth and slate; for a ball frozen
    to another; where endless tip friction begins with a blow, in which the table does not rub. Not with TipShear,
    RollingContact, SecondHit, nor a dead tip. angle: in [0, pi/2). Source: rigid-body mechanics, written out in
    `cuefem.contact.elevation`; ball on cloth 0.15 to 0.4, typically 0.2: Alciatore, billiards.colostate.edu, physical
    properties.
    """

    once: ClassVar[bool] = True
    excludes: ClassVar[tuple[str, ...]] = ("TipShear", "RollingContact", "SecondHit")

    angle: Annotated[float, Quantity("rad", "[0, 1.5707963267948966)")]
    friction: Annotated[float, Quantity("", "[0, inf)")] = 0.2

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The table under the ball."""
        terms.set_table(Table(self.angle, self.friction))
