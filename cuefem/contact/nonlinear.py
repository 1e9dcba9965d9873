"""The contact where its laws are not linear: the effects PowerLawTip and RollingContact, stepped in time.

The state is that of `cuefem.contact.state`, except that the ball's velocities stand in the frame of the first touch
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

from cuefem.beam.tip import TipModes
from cuefem.contact.state import Laws
from cuefem.contact.stepped import Stepped, Turning
from cuefem.effects.law import NormalLaw, TipLaw
from cuefem.effects.terms import ContactTerms, HeadOn
from cuefem.scene import Scene


def law_of(scene: Scene, laws: Laws) -> tuple[NormalLaw, float]:
    """The tip's law along the normal, the scene's own or the linear one, and about how long a contact takes, s."""
    law = scene.contact_terms.law
    if law is None:
        return TipLaw(laws.stiffness, 1.0, laws.restitution), laws.time
    return law(HeadOn(scene.head_on_mass, laws.restitution, laws.time, laws.speed))


def stepped_contact(
    terms: ContactTerms, tip: TipModes, laws: Laws, *, law: NormalLaw, clock: float, radius: float
) -> Stepped:
    """The contact with a nonlinear law, a turning normal or both, and what gives sideways; radius: of the ball, m."""
    turning = Turning(radius, terms) if terms.turns else None
    compliance = terms.compliance / laws.stiffness
    return Stepped.of(tip, laws, law=law, clock=clock, turning=turning, compliance=compliance)
