"""The impulse solver: exact impact of a lumped cue on a ball in impulse space ([Stronge] ch. 8).

In the tangent-normal frame (t, n) the contact velocity changes by dv = B dp. Over the normal impulse p it has at most
three straight pieces, so every event is the root of a line or a parabola:

- slip: dp_t = mu dp (the tip slides towards -t at first touch, so friction on the ball points to +t), for mu > 1 as
  dp = dp_t/mu, which holds for infinite friction, too;
- then, from p_s on, stick: dp_t = mu_c dp, mu_c = -B_tn/B_tt, where |mu_c| <= mu; or reversed slip: dp_t = -mu dp;
- compression lasts until v_n = 0; at separation the returned normal work is e^2 times the work of compression.

One formula serves all strokes; negative offsets are the mirror image of positive ones. The stroke is solved at unit
cue speed and scaled. The lateral momentum follows from the lateral velocity at separation, a sum without cancellation,
so that squirt has no round-off error at small end masses.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array, LumpedCue
from cuefem.quantity.fields import sine_cosine
from cuefem.scene import Outcome, Outcomes, Scene

REGIMES = np.array(["stick", "late stick", "miscue", "slip reversal"])
SLIPPING = 2  # from this index on, the tip slips at separation


class ImpulseInputs(NamedTuple):
    """Numbers of strokes of lumped cues on balls, SI; each a number or an array, (n,)."""

    mass: Any
    end_mass: Any
    coupling: Any
    ball_mass: Any
    inertia: Any
    radius: Any
    restitution: Any
    friction: Any
    speed: Any
    offset: Any


class InverseMass(NamedTuple):
    """The contact's inverse mass B in (t, n), 1/kg, and sums of its entries without cancellation.

    det: the determinant, a sum of positive terms, 1/kg2. cross_t = s B_nn - c B_tn and cross_n = c B_tt - s B_tn, 1/kg,
    s and c the sine and cosine of the contact's angle: they do not depend on the cue's axial mass.
    """

    tt: Array
    nn: Array
    tn: Array
    det: Array
    cross_t: Array
    cross_n: Array


class Event(NamedTuple):
    """An event of the contact: its name and the normal impulse until then, N s; inf if it does not occur."""

    name: str
    impulse: Any


def inverse_mass(offset: Any, *, mass: Any, end_mass: Any, coupling: Any, ball_mass: Any, inertia: Any) -> InverseMass:
    """B = B_ball + B_cue of handbook: Inverse mass at ``offset`` b/R = sin(phi) >= 0."""
    s, c = sine_cosine(offset)
    axial, lateral = 1 / mass, 1 / end_mass
    ball_tt, ball_nn = (1 + 1 / inertia) / ball_mass, 1 / ball_mass
    cue_tt = axial * s**2 + lateral * c**2 + 2 * coupling * s * c
    cue_nn = axial * c**2 + lateral * s**2 - 2 * coupling * s * c
    tn = (axial - lateral) * s * c + coupling * (c**2 - s**2)
    det = ball_tt * ball_nn + ball_nn * cue_tt + ball_tt * cue_nn + (axial * lateral - coupling**2)
    cross_t, cross_n = s * (ball_nn + lateral) - coupling * c, c * (ball_tt + lateral) + coupling * s
    return InverseMass(ball_tt + cue_tt, ball_nn + cue_nn, tn, det, cross_t, cross_n)


class _Impact(NamedTuple):
    """An impact in one regime, at unit cue speed.

    compression, separation: normal impulse until then, N s. tangential: impulse, N s. v_t, v_n: velocity at separation,
    m/s. work: normal work of compression on ball and cue, J. friction_loss: J.
    """

    compression: Array
    separation: Array
    tangential: Array
    v_t: Array
    v_n: Array
    work: Array
    friction_loss: Array


class _Contact(NamedTuple):
    """A contact that starts with v_t = -s <= 0 and v_n = -c < 0, its rates over the impulse, and its first slip.

    Slip adds (slip_t, slip_n) dq to the impulse (t, n): (mu, 1) dp up to mu = 1, (1, 1/mu) dp_t above. rate_t, rate_n:
    dv_t/dq and dv_n/dq during slip; rate_n is negative in a jam. mu_c: dp_t/dp during stick. deficit: dp_t/dp that
    friction lacks to stick once slip has ended. after_t, after_n: dp_t/dp and dv_n/dp then. p_s, t_s, v_s: normal and
    tangential impulse, N s, and v_n, m/s, at the end of slip; infinite if it does not end.
    """

    B: InverseMass
    v_t: Array
    v_n: Array
    e: Array
    slip_t: Array
    slip_n: Array
    rate_t: Array
    rate_n: Array
    mu_c: Array
    deficit: Array
    after_t: Array
    after_n: Array
    p_s: Array
    t_s: Array
    v_s: Array

    @classmethod
    def of(cls, B: InverseMass, v_t: Array, v_n: Array, *, mu: Array, e: Array) -> _Contact:
        mu_c, stick_n = -B.tn / B.tt, B.det / B.tt
        slip_t, slip_n = np.minimum(mu, 1.0), 1 / np.maximum(mu, 1.0)
        excess = slip_t - mu_c * slip_n
        rate_t, rate_n = B.tt * excess, stick_n * slip_n + B.tn * excess
        q_s = -v_t / rate_t
        p_s, t_s, v_s = slip_n * q_s, slip_t * q_s, (slip_n * B.cross_t - slip_t * B.cross_n) / rate_t
        always_slips, sticks_at_touch = mu <= mu_c, v_t == 0
        for end in (p_s, t_s, v_s):
            end[always_slips] = np.inf
        p_s[sticks_at_touch] = 0.0
        t_s[sticks_at_touch] = 0.0
        v_s[sticks_at_touch] = v_n[sticks_at_touch]
        deficit = np.maximum(-mu_c - mu, 0)
        after_t, after_n = mu_c + deficit, stick_n + B.tn * deficit
        return cls(B, v_t, v_n, e, slip_t, slip_n, rate_t, rate_n, mu_c, deficit, after_t, after_n, p_s, t_s, v_s)

    def from_slip_end(self, *, compression: Array, separation: Array, v_n: Array, work: Array) -> _Impact:
        """An impact that slips until p_s, and then sticks or slips back; friction dissipates -v_t dp_t."""
        p = separation - self.p_s
        v_t = self.B.tt * self.deficit * p
        loss = (v_t * self.slip_t * p - self.v_t * self.t_s) / 2
        return _Impact(compression, separation, self.t_s + self.after_t * p, v_t, v_n, work, loss)

    @property
    def work_after_slip(self) -> Array:
        """Work until greatest compression that comes after the end of slip, J."""
        return (self.v_n + self.v_s) / 2 * self.p_s - self.v_s**2 / (2 * self.after_n)

    @property
    def compression_in_slip(self) -> Array:
        """The impulse q, N s, until greatest compression before the end of slip; its work is slip_n v_n q/2."""
        return -self.v_n / self.rate_n

    @property
    def work_left_after_slip(self) -> Array:
        """Work over slip_n, J, that is returned after the end of slip in restitution; negative if slip goes on."""
        work = self.v_n * self.compression_in_slip / 2
        return self.e**2 * -work - self.v_s**2 / (2 * self.rate_n)


def _stick(c: _Contact) -> _Impact:
    """Slip ends in compression, and the tip sticks: at greatest compression v_t = v_n = 0, where B p = -v."""
    p_c, work = c.B.cross_n / c.B.det, c.work_after_slip
    v_n = np.sqrt(2 * c.after_n * c.e**2 * -work)
    p_f = p_c + v_n / c.after_n
    sticking = c.from_slip_end(compression=p_c, separation=p_f, v_n=v_n, work=work)
    return sticking._replace(tangential=c.B.cross_t / c.B.det + c.mu_c * (p_f - p_c))


def _reversal(c: _Contact) -> _Impact:
    """Slip ends in compression, and the tip slips back."""
    p_c, work = c.p_s - c.v_s / c.after_n, c.work_after_slip
    v_n = np.sqrt(2 * c.after_n * c.e**2 * -work)
    return c.from_slip_end(compression=p_c, separation=p_c + v_n / c.after_n, v_n=v_n, work=work)


def _late(c: _Contact) -> _Impact:
    """Slip ends in restitution, and the tip sticks or slips back."""
    p_c, later = c.slip_n * c.compression_in_slip, c.slip_n * np.maximum(c.work_left_after_slip, 0)
    v_n = np.sqrt(c.v_s**2 + 2 * c.after_n * later)
    p_f = c.p_s + 2 * later / (c.v_s + v_n)
    return c.from_slip_end(compression=p_c, separation=p_f, v_n=v_n, work=c.v_n * p_c / 2)


def _miscue(c: _Contact) -> _Impact:
    """The tip slips until separation."""
    q_c = c.compression_in_slip
    q_f = q_c * (1 + c.e)
    v_t, t_f = c.v_t + c.rate_t * q_f, c.slip_t * q_f
    loss = -(c.v_t + v_t) / 2 * t_f
    return _Impact(c.slip_n * q_c, c.slip_n * q_f, t_f, v_t, -c.e * c.v_n, c.slip_n * c.v_n * q_c / 2, loss)


def _impact(contact: _Contact) -> tuple[_Impact, NDArray[np.intp]]:
    """The impact, and the index of its regime."""
    late, reverses = contact.v_s >= 0, contact.deficit > 0  # greatest compression in slip; slip back after it
    slips = late & (contact.work_left_after_slip <= 0)
    cases = ((slips, _miscue), (late & ~slips, _late), (reverses & ~late, _reversal), (~reverses & ~late, _stick))
    occurring = [(strokes, np.array(regime(contact))) for strokes, regime in cases if strokes.any()]
    impact = _Impact(*np.select([strokes for strokes, _ in occurring], [numbers for _, numbers in occurring]))
    return impact, np.where(slips, SLIPPING, np.where(reverses, 3, late.astype(int)))


def impulse_inputs(scene: Scene, cue: LumpedCue) -> ImpulseInputs:
    """Those of a scene, struck with a lumped cue."""
    return ImpulseInputs(
        mass=cue.mass,
        end_mass=cue.end_mass,
        coupling=cue.coupling,
        ball_mass=scene.ball.mass,
        inertia=scene.ball.inertia,
        radius=scene.ball.radius,
        restitution=scene.tip.restitution,
        friction=scene.tip.friction,
        speed=scene.stroke.speed,
        offset=scene.stroke.offset,
    )


def impact(inputs: ImpulseInputs) -> Outcome:
    """Outcome of a lumped cue's stroke by `impulse_inputs`, in every regime, as in `impacts`."""
    one = impacts(inputs)
    return replace(one[0], phases=tuple(Event(event.name, event.impulse.item()) for event in one.phases))


def impacts(inputs: ImpulseInputs) -> Outcomes:
    """Outcomes of strokes of lumped cues.

    phases: the events "slip ends", "greatest compression", "separation" with the normal impulse until then. energy:
    "ball translation", "ball rotation", "cue", "tip loss", "friction loss", which add up to "initial". The coupling of
    a LumpedCue is meant for positive offsets and changes sign with them, so that all is odd in the offset.
    """
    m, m_e, coupling, M, nu, R, e, mu, U, offset = np.broadcast_arrays(*(np.atleast_1d(value) for value in inputs))
    side, distance = np.sign(offset), np.abs(offset)
    coupling = np.where(side == 0, 0.0, coupling)
    B = inverse_mass(distance, mass=m, end_mass=m_e, coupling=coupling, ball_mass=M, inertia=nu)
    s, c = sine_cosine(distance)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        contact = _Contact.of(B, -s, -c, mu=mu, e=e)  # at unit speed
        struck, regime = _impact(contact)
    p_t, p_n = U * struck.tangential, U * struck.separation
    p_u = s * p_t + c * p_n
    # lateral velocity of the contact at separation: (1/M + 1/m_e) p_w + p_t c/(nu M) + coupling p_u
    v_w = U * (c * struck.v_t - s * struck.v_n)
    p_w = (v_w - c * p_t / (nu * M) - coupling * p_u) / (1 / M + 1 / m_e)
    # its round-off error is relative to m_e, that of c p_t - s p_n to m; during slip the latter is as accurate as mu
    p_w = np.where(np.less(m_e, m) & (regime < SLIPPING), p_w, c * p_t - s * p_n)
    # the cue's tip velocity after the impact in (u, w), and kinetic energies with the inverse of B_cue
    tip_u, tip_w = U - p_u / m - coupling * p_w, -coupling * p_u - p_w / m_e
    axial_factor = 1 - coupling**2 * m * m_e  # m/axial_factor: the inertia of a cue that moves axially as a rigid body
    slip_end = np.where(regime == SLIPPING, np.inf, contact.p_s)
    return Outcomes(
        squirt=side * np.arctan2(-p_w, p_u) + 0.0,
        ball_velocity=np.stack([side * p_t / M, p_n / M], axis=-1),
        ball_speed=np.hypot(p_t, p_n) / M,
        spin=side * p_t / (nu * M * R),
        cue_speed=U - p_u * axial_factor / m,
        impulse=np.stack([side * p_t, p_n], axis=-1),
        duration=None,
        regime=REGIMES[regime],
        jam=(contact.rate_n < 0) & (contact.p_s > 0),
        phases=(
            Event("slip ends", U * slip_end),
            Event("greatest compression", U * struck.compression),
            Event("separation", p_n),
        ),
        energy={
            "initial": m * U**2 / (2 * axial_factor),
            "ball translation": (p_t**2 + p_n**2) / (2 * M),
            "ball rotation": p_t**2 / (2 * nu * M),
            "cue": (m * tip_u**2 + m_e * tip_w**2 - 2 * coupling * m * m_e * tip_u * tip_w) / (2 * axial_factor),
            "tip loss": U**2 * (1 - e**2) * -struck.work,
            "friction loss": U**2 * struck.friction_loss,
        },
        unknowns=2,
    )
