"""Effects that make the contact between tip and ball nonlinear, or follow what comes after it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from cuefem.effects.base import Effect, TipEffect
from cuefem.quantity import Quantity


@dataclass(frozen=True)
class PowerLawTip(TipEffect):
    """A tip that stiffens as it is compressed: force over compression is a power law, not a line.

    Adds: F = k' d^exponent while loaded, for the base model's k d; 3/2 is Hertz's contact of round bodies, 1 the base
    model. k' gives a head-on blow at ``speed``, m/s, the tip's contact time. The unloading curve is the loading curve
    with its compression scaled by e^2, F = F_peak ((d - d0)/(e^2 d_peak))^exponent from d0 = (1 - e^2) d_peak, so that
    the work given back is exactly e^2; below the old peak the tip is reloaded on it. Matters: contact time then falls
    with speed as U^((1 - n)/(1 + n)), and squirt with it. Wrong: where e itself falls with speed, and at speeds at
    which the leather bottoms out. exponent: in [1, inf). A `TipShear` beside it keeps its constant spring, ratio times
    the base model's k. Source: Hertz 1882; [Stronge] ch. 6; physics.md section 8. Cost: stepped in time to about 1e-10.
    """

    once: ClassVar[bool] = True
    exponent: Annotated[float, Quantity("", "[1, inf)")] = 1.5
    speed: Annotated[float, Quantity("m/s", "(0, inf)")] = 1.0


@dataclass(frozen=True)
class RollingContact(TipEffect):
    """The contact moves over ball and tip while they touch, and its normal turns with it.

    Adds: the angle of the contact as a state; it grows as the tip passes the ball's centre: its rate is the tip's
    velocity along t less the ball's, over R + r, r the dome's radius (`TipDome`; none: a sharp point). Matters: little;
    squirt and spin change by a part of first order in U T/R (about 1 % at 1 m/s and 1 ms), so they grow with speed.
    Wrong: where the leather gives so far, or is so wide, that its contact is no point; the compression beside R + r
    (which changes the effect itself by a part of that order again) and the cue's turning are left out. Source: rigid
    kinematics of two spheres, written out in `cuefem.nonlinear`. Cost: stepped in time to about 1e-10.
    """

    once: ClassVar[bool] = True


@dataclass(frozen=True)
class SecondHit(Effect):
    """The tip catches up with the ball and strikes it again.

    Adds: after each separation the free motion of cue and ball in their plane, and a further contact wherever tip and
    ball touch again within ``window``, s, of the first separation; its phases follow a phase ("apart", "free") in
    Outcome.phases, and `cuefem.second_hit.hits` lists them. A tip keeps the set that it had as the ball left, and is
    pressed anew on the curve it was unloaded on. Matters: a soft or dead tip on a shaft that vibrates, a heavy cue.
    Wrong: where the leather recovers its shape meanwhile, or the player's hand pushes or holds the cue; no gravity, no
    table, and the normal stays that of the first touch unless `RollingContact` turns it. Source: physics.md section 8.
    """

    once: ClassVar[bool] = True

    window: Annotated[float, Quantity("s", "(0, inf)")] = 5e-3


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
    `cuefem.elevation`; ball on cloth 0.15 to 0.4, typically 0.2: Alciatore, billiards.colostate.edu, physical
    properties.
    """

    once: ClassVar[bool] = True
    excludes: ClassVar[tuple[str, ...]] = ("TipShear", "RollingContact", "SecondHit")

    angle: Annotated[float, Quantity("rad", "[0, 1.5707963267948966)")]
    friction: Annotated[float, Quantity("", "[0, inf)")] = 0.2
