"""The general impulse solver's kernel: a lumped cue strikes a ball, exactly, in impulse space ([Stronge] ch. 8).

In the tangent-normal frame (t, n) the contact velocity changes by dv = B dp. The course of the normal impulse p has at
most three straight pieces, so every event is the root of a line or a parabola:

- slip: dp_t = mu dp (the tip slides towards -t at first touch, so friction on the ball points to +t);
- then, from p_s on, stick: dp_t = mu_c dp, mu_c = -B_tn/B_tt, where |mu_c| <= mu; or reversed slip: dp_t = -mu dp;
- compression lasts until v_n = 0; separation is where the normal work regained is e^2 times that spent.

One formula serves all strokes; negative offsets are the mirror image of positive ones. The stroke is solved at unit
cue speed and scaled. What crosses the cue's line comes from the velocity there at separation, a sum in which nothing
cancels, so that squirt keeps its digits however light the end mass is.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from cuefem.cue import Array, LumpedCue
from cuefem.quantity.fields import sine_cosine
from cuefem.scene import Outcome, Scene

# Replaces infinite friction: slip then ends after 1e-100 of the normal impulse, and the square is still finite.
INFINITE_FRICTION = 1e100

REGIMES = np.array(["stick", "late stick", "miscue", "slip reversal"])
SLIPPING = 2  # from this index on, the tip slips at separation


class InverseMass(NamedTuple):
    """The contact's inverse mass B in (t, n), 1/kg, and sums of its entries, written so that no digits cancel.

    det: the determinant, a sum of positive terms, 1/kg2. cross_t = s B_nn - c B_tn and cross_n = c B_tt - s B_tn, 1/kg,
    s and c the sine and cosine of the contact's angle: the cue's mass along its axis drops out of them.
    """

    tt: Array
    nn: Array
    tn: Array
    det: Array
    cross_t: Array
    cross_n: Array


class Event(NamedTuple):
    """A moment of the contact: its name and the normal impulse given until then, N s (inf: it never comes)."""

    name: str
    impulse: Any


def inverse_mass(offset: Any, *, mass: Any, end_mass: Any, coupling: Any, ball_mass: Any, inertia: Any) -> InverseMass:
    """B = B_ball + B_cue of handbook: Inverse mass at ``offset`` b/R = sin(phi) >= 0."""
    s, c = sine_cosine(offset)
    along, across, both = 1 / mass, 1 / end_mass, coupling
    ball_tt, ball_nn = (1 + 1 / inertia) / ball_mass, 1 / ball_mass
    cue_tt = along * s**2 + across * c**2 + 2 * both * s * c
    cue_nn = along * c**2 + across * s**2 - 2 * both * s * c
    tn = (along - across) * s * c + both * (c**2 - s**2)
    det = ball_tt * ball_nn + ball_nn * cue_tt + ball_tt * cue_nn + (along * across - both**2)
    cross_t, cross_n = s * (ball_nn + across) - both * c, c * (ball_tt + across) + both * s
    return InverseMass(ball_tt + cue_tt, ball_nn + cue_nn, tn, det, cross_t, cross_n)


class _Course(NamedTuple):
    """Where the contact went: impulses at the events, the tangential impulse, the velocity (t, n) of the contact at
    separation, losses, the regime's index, jam."""

    slip_end: Array
    compressed: Array
    final: Array
    tangential: Array
    leaving_t: Array
    leaving_n: Array
    tip_loss: Array
    friction_loss: Array
    regime: Array
    jam: Any


def _course(B: InverseMass, v_t: Array, v_n: Array, *, mu: Array, e: Array) -> _Course:
    """The course of contacts that start with v_t = -s <= 0 and v_n = -c < 0, unit speed along the cue."""
    endless, mu = np.isinf(mu), np.minimum(mu, INFINITE_FRICTION)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        mu_c = -B.tn / B.tt
        stuck = B.det / B.tt  # dv_n/dp in stick
        closing = B.tt * (mu - mu_c)  # dv_t/dp while slipping
        slows = stuck + B.tn * (mu - mu_c)  # dv_n/dp while slipping; negative in a jam
        beyond = np.maximum(-mu_c - mu, 0)  # what friction lacks to hold the tip once slip has ended
        reverses = beyond > 0
        then_t, then_n = mu_c + beyond, stuck + B.tn * beyond  # dp_t/dp, dv_n/dp after slip
        grips, never = v_t == 0, mu <= mu_c
        p_s = np.where(grips, 0.0, np.where(never, np.inf, -v_t / closing))
        t_s = np.where(grips, 0.0, np.where(never, np.inf, mu * -v_t / closing))
        v_s = np.where(grips, v_n, np.where(never, np.inf, (B.cross_t - mu * B.cross_n) / closing))
        early = v_s >= 0  # fully compressed while still slipping
        # compression, and the work done on the tip
        in_slip = early | reverses  # else v_t = v_n = 0 at greatest compression, where B p = -v
        p_c = np.where(early, -v_n / slows, np.where(reverses, p_s - v_s / then_n, B.cross_n / B.det))
        work = np.where(early, v_n * p_c / 2, (v_n + v_s) / 2 * p_s - v_s**2 / (2 * then_n))
        regained = -(e**2) * work
        # restitution: in the slip alone, or slip and then the rest, or after it
        slip_regains = v_s**2 / (2 * slows)
        miscue = early & (slip_regains >= regained)
        rest = np.maximum(regained - slip_regains, 0)
        leaving_late = np.sqrt(v_s**2 + 2 * then_n * rest)
        leaving_early = np.sqrt(2 * then_n * regained)
        p_f = np.where(early, p_s + 2 * rest / (v_s + leaving_late), p_c + leaving_early / then_n)
        p_f = np.where(miscue, p_c * (1 + e), p_f)
        tail = np.where(miscue, 0.0, p_f - p_s)
        tangential = np.where(in_slip, t_s + then_t * tail, B.cross_t / B.det + mu_c * (p_f - p_c))
        tangential = np.where(miscue, mu * p_f, tangential)
        leaving_t = np.where(miscue, v_t + closing * p_f, B.tt * beyond * tail)
        leaving_n = np.where(miscue, -e * v_n, np.where(early, leaving_late, leaving_early))
        # friction takes -v_t dp_t; v_t is linear in p, zero at p_s
        slipped = np.where(miscue, -(v_t + leaving_t) / 2 * mu * p_f, (leaving_t * mu * tail - v_t * t_s) / 2)
    jam = (slows < 0) & (p_s > 0) & ~endless
    slip_end = np.where(miscue, np.inf, np.where(endless & ~early, 0.0, p_s))
    regime = np.select([miscue, reverses, early], [2, 3, 1], 0)
    return _Course(slip_end, p_c, p_f, tangential, leaving_t, leaving_n, -work - regained, slipped, regime, jam)


def impulse_inputs(scene: Scene, cue: LumpedCue) -> dict[str, float]:
    """What `impact` takes of a scene that a lumped cue strikes."""
    ball, tip, stroke = scene.ball, scene.tip, scene.stroke
    return {
        **{"mass": cue.mass, "end_mass": cue.end_mass, "coupling": cue.coupling},
        **{"ball_mass": ball.mass, "inertia": ball.inertia, "radius": ball.radius},
        **{"restitution": tip.restitution, "friction": tip.friction, "speed": stroke.speed, "offset": stroke.offset},
    }


def impact(numbers: Mapping[str, Any]) -> Outcome:
    """Outcome of a lumped cue's stroke by `impulse_inputs`, every regime; of many strokes where some are arrays, (n,).

    phases: the events "slip ends", "greatest compression", "separation" with the normal impulse until then. energy:
    "ball translation", "ball rotation", "cue", "tip loss", "friction loss", which add up to "initial". The coupling of
    a LumpedCue is meant for positive offsets and changes sign with them, so that all is odd in the offset.
    """
    flat, many = _strokes(**numbers), any(np.ndim(number) for number in numbers.values())
    return _outcome(flat if many else {name: values[0].item() for name, values in flat.items()})


def _strokes(
    *,
    mass: Any,
    end_mass: Any,
    coupling: Any,
    ball_mass: Any,
    inertia: Any,
    radius: Any,
    restitution: Any,
    friction: Any,
    speed: Any,
    offset: Any,
) -> dict[str, Array]:
    """Flat arrays by name."""
    m, m_e, M, nu, R, U = mass, end_mass, ball_mass, inertia, radius, speed
    offset = np.atleast_1d(offset)
    side, distance = np.sign(offset), np.abs(offset)
    coupling = np.where(side == 0, 0.0, coupling)
    B = inverse_mass(distance, mass=m, end_mass=m_e, coupling=coupling, ball_mass=M, inertia=nu)
    s, c = sine_cosine(distance)
    course = _course(B, -s, -c, mu=friction, e=restitution)  # at unit speed
    p_t, p_n = U * course.tangential, U * course.final
    p_u = s * p_t + c * p_n
    # across the cue: (1/M + 1/m_e) p_w + p_t c/(nu M) + coupling p_u is the contact's velocity at separation
    v_w = U * (c * course.leaving_t - s * course.leaving_n)
    p_w = (v_w - c * p_t / (nu * M) - coupling * p_u) / (1 / M + 1 / m_e)
    # which rounds like m_e; c p_t - s p_n rounds like m, and is as good as mu itself while the tip slips
    p_w = np.where(np.less(m_e, m) & (course.regime < SLIPPING), p_w, c * p_t - s * p_n)
    # the cue's tip velocity after the impact in (u, w), and kinetic energies with the inverse of B_cue
    tip_u, tip_w = U - p_u / m - coupling * p_w, -coupling * p_u - p_w / m_e
    free = 1 - coupling**2 * m * m_e  # m/free: the axial inertia of a cue that moves as one along its axis
    cue_energy = (m * tip_u**2 + m_e * tip_w**2 - 2 * coupling * m * m_e * tip_u * tip_w) / (2 * free)
    out = {
        "squirt": side * np.arctan2(-p_w, p_u) + 0.0,
        "p_t": side * p_t,
        "p_n": p_n,
        "v_t": side * p_t / M,
        "v_n": p_n / M,
        "ball_speed": np.hypot(p_t, p_n) / M,
        "spin": side * p_t / (nu * M * R),
        "cue_speed": U - p_u * free / m,
        "regime": REGIMES[course.regime],
        "jam": course.jam,
        "slip ends": U * course.slip_end,
        "greatest compression": U * course.compressed,
        "separation": p_n,
        "initial": m * U**2 / (2 * free),
        "ball translation": (p_t**2 + p_n**2) / (2 * M),
        "ball rotation": p_t**2 / (2 * nu * M),
        "cue": cue_energy,
        "tip loss": U**2 * course.tip_loss,
        "friction loss": U**2 * course.friction_loss,
    }
    return dict(zip(out, np.broadcast_arrays(*out.values()), strict=True))


EVENTS = ("slip ends", "greatest compression", "separation")
ENERGIES = ("initial", "ball translation", "ball rotation", "cue", "tip loss", "friction loss")


def _outcome(flat: dict[str, Any]) -> Outcome:
    return Outcome(
        **{name: flat[name] for name in ("squirt", "ball_speed", "spin", "cue_speed", "regime", "jam")},
        ball_velocity=np.stack([flat["v_t"], flat["v_n"]], axis=-1),
        impulse=np.stack([flat["p_t"], flat["p_n"]], axis=-1),
        duration=None,
        phases=tuple(Event(name, flat[name]) for name in EVENTS),
        energy={name: flat[name] for name in ENERGIES},
        unknowns=2,
    )
