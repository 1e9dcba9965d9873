"""How the patch of the tip that touches the ball gives way sideways: not at all, or on a spring (the effect TipShear).

The patch is massless. In stick it moves with the ball; in slip friction pulls at it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

import numpy as np

from cuefem.contact.flow import Flow, Pushes
from cuefem.contact.history import F_T, V_T
from cuefem.contact.phases import Kind, held_or_sliding
from cuefem.contact.state import SIDE, Contact, Grip, Phase, Press
from cuefem.cue import Array

if TYPE_CHECKING:
    from cuefem.contact.linear import Exact
    from cuefem.contact.stepped import Directions, Hold, Stepped

# Of the phases and cells that a contact may take, those of a nearly dead tip on a spring: a second or so.
HASTE = 0.02


class Patch(Protocol):
    """The tangential part of a contact; an exact one asks for flows, a stepped one for forces."""

    haste: float  # of a nearly dead tip: the part of what a contact may take in phases before it is given up
    spring: tuple[float, float]  # its compliance, m/N, and its state's unit per newton; zeros if it does not give
    slide: int  # of an exact phase: the output that is the velocity at which the patch slides,
    outputs: int  # and how many outputs stand before those of the dampers

    def first_grip(self, kind: Kind, press: Press, stiffness: float) -> Grip:
        """How a touch grips; stiffness: the tip's along the normal then, N/m."""

    def grip_at_rest(self, kind: Kind, press: Press) -> Grip:
        """How a patch goes on that has stopped sliding."""

    def stored(self, contact: Contact) -> float:
        """Energy that the patch's spring holds, J."""

    def let_go(self, contact: Contact) -> None:
        """Ball and tip part: the spring loses what it holds."""

    def losses(self, contact: Contact) -> dict[str, float]:
        """Energy lost in the spring, J by name."""

    def held(self, exact: Exact, pushes: Pushes, normal: Array, rate: float) -> Flow:
        """Stick on a springy tip; normal: the row that reads F_n; rate: a bound on the motion without patch, 1/s."""

    def rigidly_held(self, exact: Exact) -> Flow:
        """Stick on a rigid tip."""

    def sliding(self, exact: Exact, grip: Grip, pushes: Pushes, normal: Array, rate: float) -> Flow:
        """Slip."""

    def begin(self, exact: Exact, grip: Grip, press: Press) -> None:
        """What the start of an exact phase changes in the state."""

    def end(self, exact: Exact, grip: Grip, press: Press) -> None:
        """What the end of an exact phase changes in the state."""

    def held_forces(self, stepped: Stepped, z: Array, hold: Hold, at: Directions, free: Array) -> tuple[float, float]:
        """(F_t, F_n) in stick, N."""

    def wind(self, stepped: Stepped, rate: Array, z: Array, c_t: Array) -> None:
        """Put the rate of the spring's state in stick into that of the whole."""

    def slides(self, stepped: Stepped, z: Array, hold: Hold) -> float:
        """Velocity at which the patch slides on the ball, m/s."""

    def ended(self, stepped: Stepped, hold: Hold) -> None:
        """What the end of a stepped phase changes in the state."""


class RigidPatch:
    """A patch that does not give: stick keeps v_t at zero."""

    haste, slide, outputs, spring = 1.0, V_T, 4, (0.0, 0.0)

    def first_grip(self, kind: Kind, press: Press, stiffness: float) -> Grip:
        """The tip slips unless it does not move aside or friction is endless, which begins with a blow."""
        contact, laws = kind.contact, kind.contact.laws
        c_t, c_n = kind.facing()
        sliding, closing = float(c_t @ contact.z), float(c_n @ contact.z)
        if sliding == 0:
            return "stick"
        if np.isinf(laws.friction):
            blow, turn = -sliding / float(c_t @ c_t), float(c_n @ c_t)
            if closing + turn * blow > 0:  # the limit of great friction: the blow alone throws the two apart
                blow = math.copysign(min(abs(blow), (1 + laws.restitution) * abs(closing / turn)), blow)
                contact.parted = True
            contact.z = contact.z + c_t * blow
            contact.friction_loss -= blow * (sliding + float(c_t @ contact.z)) / 2
            contact.phases.append(Phase("blow", "load", contact.time, contact.time, (blow, 0.0)))
            return "stick"
        return "slip" if sliding < 0 else "slip back"

    def grip_at_rest(self, kind: Kind, press: Press) -> Grip:
        """Stick where friction can hold the contact, else the way it starts to slip."""
        return held_or_sliding(kind, press)

    def stored(self, contact: Contact) -> float:
        """Nothing."""
        return 0.0

    def let_go(self, contact: Contact) -> None:
        """Nothing is held."""

    def losses(self, contact: Contact) -> dict[str, float]:
        """None."""
        return {}

    def held(self, exact: Exact, pushes: Pushes, normal: Array, rate: float) -> Flow:
        """The tangential force keeps v_t at zero."""
        c_t = exact.contact.c_t
        square = float(c_t @ c_t)
        tangent = exact.slope(c_t, pushes) / -square
        return exact.motion(pushes, [normal, tangent], rate=rate, held=c_t[:, None] / math.sqrt(square))

    def rigidly_held(self, exact: Exact) -> Flow:
        """Both forces keep both velocities at zero."""
        contact = exact.contact
        rows = np.array([contact.c_t, contact.c_n])
        tangent, normal = -np.linalg.solve(rows @ rows.T, rows @ contact.free)
        return exact.motion([], [normal, tangent], held=np.linalg.qr(rows.T)[0])

    def sliding(self, exact: Exact, grip: Grip, pushes: Pushes, normal: Array, rate: float) -> Flow:
        """Both forces are known combinations of the state; the patch slides with v_t."""
        return exact.motion(pushes, [normal, SIDE[grip] * exact.contact.laws.friction * normal], rate=rate)

    def begin(self, exact: Exact, grip: Grip, press: Press) -> None:
        """Nothing."""

    def end(self, exact: Exact, grip: Grip, press: Press) -> None:
        """Remove the rounding along the direction that stick has held."""
        if grip == "stick":
            _remove(exact.contact, exact.contact.c_t)

    def held_forces(self, stepped: Stepped, z: Array, hold: Hold, at: Directions, free: Array) -> tuple[float, float]:
        """Forces that keep v_t, and on a rigid tip v_n, at zero."""
        free_t, free_n = stepped.falling(z, at, free)
        tt, tn, nn = float(at.c_t @ at.c_t), float(at.c_t @ at.c_n), float(at.c_n @ at.c_n)
        if hold.press == "rigid":
            whole = tt * nn - tn**2
            return (tn * free_n - nn * free_t) / whole, (tn * free_t - tt * free_n) / whole
        F_n = stepped.pressing(z, hold)
        return -(free_t + tn * F_n) / tt, F_n

    def wind(self, stepped: Stepped, rate: Array, z: Array, c_t: Array) -> None:
        """Nothing is wound up."""

    def slides(self, stepped: Stepped, z: Array, hold: Hold) -> float:
        """The patch slides with v_t."""
        return float(stepped.directions(z).c_t @ z)

    def ended(self, stepped: Stepped, hold: Hold) -> None:
        """Remove the rounding along the direction that stick has held."""
        if hold.grip == "stick":
            _remove(stepped.contact, stepped.facing()[0])


def _remove(contact: Contact, row: Array) -> None:
    contact.z = contact.z - row * (row @ contact.z / (row @ row))


class SpringPatch:
    """A patch on a spring of ``compliance``, m/N: in stick the spring gives F_t, in slip friction does.

    The spring's force has a slot, "shear"; unit: of that state per newton. lost: energy that it held at partings, J.
    """

    haste, slide, outputs = HASTE, 4, 5  # one output behind v_t, v_n, F_n and F_t

    def __init__(self, compliance: float, unit: float) -> None:
        self.compliance, self.unit, self.lost = compliance, unit, 0.0
        self.spring = compliance, unit

    def first_grip(self, kind: Kind, press: Press, stiffness: float) -> Grip:
        """The patch sticks from a touch on where the spring's force grows more slowly than friction's bound."""
        contact, friction = kind.contact, kind.contact.laws.friction
        c_t, c_n = kind.facing()
        pull = -float(c_t @ contact.z) / self.compliance
        if math.isinf(friction) or abs(pull) <= -friction * float(c_n @ contact.z) * stiffness:
            return "stick"
        return "slip" if pull > 0 else "slip back"

    def grip_at_rest(self, kind: Kind, press: Press) -> Grip:
        """A patch that stops sliding holds: the spring's force is continuous."""
        return "stick"

    def force(self, contact: Contact, z: Array) -> float:
        """The spring's force in a state, N."""
        return float(z[contact.slots["shear"]]) / self.unit

    def stored(self, contact: Contact) -> float:
        """Energy that the spring holds, J."""
        return self.compliance * self.force(contact, contact.z) ** 2 / 2

    def let_go(self, contact: Contact) -> None:
        """Ball and tip part: the spring loses what it holds."""
        self.lost += self.stored(contact)
        contact.put(shear=0.0)

    def losses(self, contact: Contact) -> dict[str, float]:
        """What is left in the spring when the ball leaves (only endless friction leaves anything) is lost."""
        return {"tip shear": self.lost + self.stored(contact)}

    def _sheared(self, contact: Contact) -> tuple[Array, Pushes]:
        """The row that reads the spring's force, and how the spring pushes and is wound up."""
        tangent = np.zeros_like(contact.c_t)
        tangent[contact.slots["shear"]] = 1 / self.unit
        return tangent, [(contact.c_t, tangent), (-tangent, contact.c_t)]

    def held(self, exact: Exact, pushes: Pushes, normal: Array, rate: float) -> Flow:
        """The spring is wound up, and nothing is held."""
        tangent, sheared = self._sheared(exact.contact)
        rate += float(np.linalg.norm(exact.contact.c_t)) / self.unit
        return exact.motion(pushes + sheared, [normal, tangent, np.zeros_like(normal)], rate=rate)

    def rigidly_held(self, exact: Exact) -> Flow:
        """The spring is wound up, and v_n held."""
        tangent, sheared = self._sheared(exact.contact)
        c_n = exact.contact.c_n
        normal = exact.slope(c_n, sheared) / -float(c_n @ c_n)
        return exact.motion([*sheared, (c_n, normal)], [normal, tangent, np.zeros_like(normal)])

    def sliding(self, exact: Exact, grip: Grip, pushes: Pushes, normal: Array, rate: float) -> Flow:
        """Nothing winds the spring, it follows friction: its state is set when the patch grips again."""
        tangent = SIDE[grip] * exact.contact.laws.friction * normal
        slide = exact.contact.c_t + self.compliance * exact.slope(tangent, pushes)
        return exact.motion(pushes, [normal, tangent, slide], rate=rate)

    def begin(self, exact: Exact, grip: Grip, press: Press) -> None:
        """A sliding patch's spring follows friction; where the tip's force jumps (e = 0), the patch slides at once."""
        if grip != "stick":
            contact = exact.contact
            contact.friction_loss += self.stored(contact)
            self.end(exact, grip, press)
            contact.friction_loss -= self.stored(contact)

    def end(self, exact: Exact, grip: Grip, press: Press) -> None:
        """After a slip the spring is where friction left it."""
        if grip != "stick":
            force = float(exact.flow(grip, press).rows[F_T] @ exact.contact.z)
            exact.contact.put(shear=self.unit * force)

    def held_forces(self, stepped: Stepped, z: Array, hold: Hold, at: Directions, free: Array) -> tuple[float, float]:
        """The spring's force; on a rigid tip F_n keeps v_n at zero beside it."""
        F_t = self.force(stepped.contact, z)
        if hold.press != "rigid":
            return F_t, stepped.pressing(z, hold)
        _, free_n = stepped.falling(z, at, free)
        return F_t, -(free_n + float(at.c_t @ at.c_n) * F_t) / float(at.c_n @ at.c_n)

    def wind(self, stepped: Stepped, rate: Array, z: Array, c_t: Array) -> None:
        """The spring is wound up by v_t."""
        rate[stepped.contact.slots["shear"]] = -self.unit * float(c_t @ z) / self.compliance

    def slides(self, stepped: Stepped, z: Array, hold: Hold) -> float:
        """The contact's v_t, and what the spring adds as it follows friction."""
        v_t, v_n, _, _ = stepped.reading(z, hold)
        if hold.press == "rigid":  # F_n follows the motion; a central difference along it is enough to find an end
            step = 1e-5 * stepped.clock * stepped.change(z, hold)
            rise = (stepped.reading(z + step, hold)[3] - stepped.reading(z - step, hold)[3]) / (2e-5 * stepped.clock)
        else:
            rise = -stepped.stiffness(z, hold) * v_n
        return v_t + self.compliance * SIDE[hold.grip] * stepped.contact.laws.friction * rise

    def ended(self, stepped: Stepped, hold: Hold) -> None:
        """After a slip the spring is where friction left it."""
        if hold.grip != "stick":
            stepped.contact.put(shear=self.unit * stepped.reading(stepped.contact.z, hold)[2])


def losses_of(contact: Contact, patch: Patch) -> dict[str, float]:
    """Energy that went into the cue's damping, J by name, and into the patch's spring."""
    return ({"damping loss": contact.damping_loss} if contact.lossy else {}) | patch.losses(contact)
