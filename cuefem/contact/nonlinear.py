"""The contact where its laws are not linear: the effects PowerLawTip and RollingContact, stepped in time.

The state is that of `cuefem.contact.linear`, except that the ball's velocities stand in the frame of the first touch
and the tip's force is replaced by its compression; the angle that the contact has turned through and the energies lost
follow as states of their own, so that the energy account closes to the solver's tolerance.

While the contact turns by an angle a, n and t turn with it: dn/da = -t, dt/da = n. On a dome of radius r (0: a sharp
point) tied to the cue's end, the contact is at r n from the dome's centre D; on the ball it is at -R n from its centre
C. The line of centres gives (C - D)' = (R + r) n' - d' n, so that

    a' = (V_D - V_C) . t/(R + r),    d' = -v_n,

with the compression d left out beside R + r. v_n and v_t are ball less tip at the contact's own points; for these
dc_t/da = c_n, and c_n' = dc_n/da reads (V_D - V_C) . t. In stick v_t stays zero: c_t z' + a' v_n = 0; on a rigid tip
v_n does: c_n z' + (R + r) a'^2 = 0. Forces act through the same c_t and c_n, so no energy is made or lost by turning.
"""

from __future__ import annotations

import math

from cuefem.beam.tip import TipModes
from cuefem.contact.law import TipLaw, slowed
from cuefem.contact.linear import Laws
from cuefem.contact.stepped import SteppedContact, Turning
from cuefem.contact.stepped_shear import SteppedShearContact
from cuefem.effects import PowerLawTip, RollingContact, TipDome, TipShear
from cuefem.quantity import scalar
from cuefem.scene import Scene

__all__ = ["SteppedContact", "TipLaw", "law_of", "stepped_contact"]


def law_of(scene: Scene, laws: Laws) -> tuple[TipLaw, float]:
    """The tip's law, and about how long a contact takes, s."""
    for power in (effect for effect in scene.effects if isinstance(effect, PowerLawTip)):
        n = power.exponent
        law = TipLaw.timed(n, laws.restitution, mass=scene.head_on_mass, speed=power.speed, time=laws.time)
        return law, laws.time * slowed(n, laws.speed / power.speed)
    return TipLaw(laws.stiffness, 1.0, laws.restitution), laws.time


def stepped_contact(scene: Scene, tip: TipModes, laws: Laws) -> SteppedContact:
    """The contact that the scene's PowerLawTip and RollingContact ask for, with its TipShear."""
    law, clock = law_of(scene, laws)
    turning = None
    if any(isinstance(effect, RollingContact) for effect in scene.effects):
        turning = Turning(scalar("Ball.radius", scene.ball.radius), TipDome(scene.dome_radius))
    shears = [effect.ratio for effect in scene.effects if isinstance(effect, TipShear)]
    if not shears:
        return SteppedContact(tip, laws, law=law, turning=turning, clock=clock)
    compliance = math.fsum(1 / ratio for ratio in shears) / laws.stiffness
    return SteppedShearContact(tip, laws, law=law, turning=turning, clock=clock, compliance=compliance)
