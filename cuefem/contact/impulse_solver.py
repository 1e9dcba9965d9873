"""The impulse solver: exact impact of a lumped cue on a ball in impulse space ([Stronge] ch. 8).

In the tangent-normal frame (t, n) the contact velocity changes by dv = B dp. Over the normal impulse p it has at most
three straight pieces, so every event is the root of a line or a parabola:

- slip: dp_t = mu dp (the tip slides towards -t at first touch, so friction on the ball points to +t);
- then, from p_s on, stick: dp_t = mu_c dp, mu_c = -B_tn/B_tt, where |mu_c| <= mu; or reversed slip: dp_t = -mu dp;
- compression lasts until v_n = 0; at separation the returned normal work is e^2 times the work of compression.

One formula serves all strokes; negative offsets are the mirror image of positive ones. The stroke is solved at unit
cue speed and scaled. The lateral momentum follows from the lateral velocity at separation, a sum without cancellation,
so that squirt has no round-off error at small end masses.
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


class _Solution(NamedTuple):
    """Of an impact at unit cue speed: normal impulses at slip end, greatest compression and separation and tangential
    impulse, N s; velocity (t, n) at separation, m/s; losses, J; index of the regime; jam."""

    slip_end: Array
    compression_impulse: Array
    final: Array
    tangential: Array
    final_t: Array
    final_n: Array
    tip_loss: Array
    friction_loss: Array
    regime: Array
    jam: Any


def _solve(B: InverseMass, v_t: Array, v_n: Array, *, mu: Array, e: Array) -> _Solution:
    """Contacts that start with v_t = -s <= 0 and v_n = -c < 0, at unit cue speed."""
    infinite, mu = np.isinf(mu), np.minimum(mu, INFINITE_FRICTION)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        mu_c = -B.tn / B.tt
        stick_rate = B.det / B.tt  # dv_n/dp during stick
        slip_rate_t = B.tt * (mu - mu_c)  # dv_t/dp during slip
        slip_rate_n = stick_rate + B.tn * (mu - mu_c)  # dv_n/dp during slip; negative in a jam
        deficit = np.maximum(-mu_c - mu, 0)  # dp_t/dp that friction lacks to stick once slip has ended
        reverses = deficit > 0
        after_t, after_n = mu_c + deficit, stick_rate + B.tn * deficit  # dp_t/dp, dv_n/dp after slip
        sticks_at_touch, always_slips = v_t == 0, mu <= mu_c
        p_s = np.where(sticks_at_touch, 0.0, np.where(always_slips, np.inf, -v_t / slip_rate_t))
        t_s = np.where(sticks_at_touch, 0.0, np.where(always_slips, np.inf, mu * -v_t / slip_rate_t))
        v_s = np.where(sticks_at_touch, v_n, np.where(always_slips, np.inf, (B.cross_t - mu * B.cross_n) / slip_rate_t))
        compressed_in_slip = v_s >= 0  # greatest compression before slip ends
        # compression, and the work done on the tip
        has_slip_end = compressed_in_slip | reverses  # else v_t = v_n = 0 at greatest compression, where B p = -v
        p_c = np.where(
            compressed_in_slip, -v_n / slip_rate_n, np.where(reverses, p_s - v_s / after_n, B.cross_n / B.det)
        )
        work = np.where(compressed_in_slip, v_n * p_c / 2, (v_n + v_s) / 2 * p_s - v_s**2 / (2 * after_n))
        returned = -(e**2) * work
        # restitution: during slip alone, partly during slip, or after it
        returned_in_slip = v_s**2 / (2 * slip_rate_n)
        miscue = compressed_in_slip & (returned_in_slip >= returned)
        returned_later = np.maximum(returned - returned_in_slip, 0)
        v_n_late = np.sqrt(v_s**2 + 2 * after_n * returned_later)
        v_n_early = np.sqrt(2 * after_n * returned)
        p_f = np.where(compressed_in_slip, p_s + 2 * returned_later / (v_s + v_n_late), p_c + v_n_early / after_n)
        p_f = np.where(miscue, p_c * (1 + e), p_f)
        p_after = np.where(miscue, 0.0, p_f - p_s)
        tangential = np.where(has_slip_end, t_s + after_t * p_after, B.cross_t / B.det + mu_c * (p_f - p_c))
        tangential = np.where(miscue, mu * p_f, tangential)
        final_t = np.where(miscue, v_t + slip_rate_t * p_f, B.tt * deficit * p_after)
        final_n = np.where(miscue, -e * v_n, np.where(compressed_in_slip, v_n_late, v_n_early))
        # friction dissipates -v_t dp_t; v_t is linear in p, zero at p_s
        dissipated = np.where(miscue, -(v_t + final_t) / 2 * mu * p_f, (final_t * mu * p_after - v_t * t_s) / 2)
    jam = (slip_rate_n < 0) & (p_s > 0) & ~infinite
    slip_end = np.where(miscue, np.inf, np.where(infinite & ~compressed_in_slip, 0.0, p_s))
    regime = np.select([miscue, reverses, compressed_in_slip], [2, 3, 1], 0)
    return _Solution(slip_end, p_c, p_f, tangential, final_t, final_n, -work - returned, dissipated, regime, jam)


def impulse_inputs(scene: Scene, cue: LumpedCue) -> dict[str, float]:
    """Arguments of `impact` for a scene, struck with a lumped cue."""
    ball, tip, stroke = scene.ball, scene.tip, scene.stroke
    return {
        **{"mass": cue.mass, "end_mass": cue.end_mass, "coupling": cue.coupling},
        **{"ball_mass": ball.mass, "inertia": ball.inertia, "radius": ball.radius},
        **{"restitution": tip.restitution, "friction": tip.friction, "speed": stroke.speed, "offset": stroke.offset},
    }


def impact(inputs: Mapping[str, Any]) -> Outcome:
    """Outcome of a lumped cue's stroke by `impulse_inputs`, every regime; of many strokes where some are arrays, (n,).

    phases: the events "slip ends", "greatest compression", "separation" with the normal impulse until then. energy:
    "ball translation", "ball rotation", "cue", "tip loss", "friction loss", which add up to "initial". The coupling of
    a LumpedCue is meant for positive offsets and changes sign with them, so that all is odd in the offset.
    """
    flat, is_batch = _strokes(**inputs), any(np.ndim(value) for value in inputs.values())
    return _outcome(flat if is_batch else {name: values[0].item() for name, values in flat.items()})


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
    """Results of the strokes by name, each an array, (n,)."""
    m, m_e, M, nu, R, U = mass, end_mass, ball_mass, inertia, radius, speed
    offset = np.atleast_1d(offset)
    side, distance = np.sign(offset), np.abs(offset)
    coupling = np.where(side == 0, 0.0, coupling)
    B = inverse_mass(distance, mass=m, end_mass=m_e, coupling=coupling, ball_mass=M, inertia=nu)
    s, c = sine_cosine(distance)
    solution = _solve(B, -s, -c, mu=friction, e=restitution)  # at unit speed
    p_t, p_n = U * solution.tangential, U * solution.final
    p_u = s * p_t + c * p_n
    # lateral velocity of the contact at separation: (1/M + 1/m_e) p_w + p_t c/(nu M) + coupling p_u
    v_w = U * (c * solution.final_t - s * solution.final_n)
    p_w = (v_w - c * p_t / (nu * M) - coupling * p_u) / (1 / M + 1 / m_e)
    # its round-off error is relative to m_e, that of c p_t - s p_n to m; during slip the latter is as accurate as mu
    p_w = np.where(np.less(m_e, m) & (solution.regime < SLIPPING), p_w, c * p_t - s * p_n)
    # the cue's tip velocity after the impact in (u, w), and kinetic energies with the inverse of B_cue
    tip_u, tip_w = U - p_u / m - coupling * p_w, -coupling * p_u - p_w / m_e
    axial_factor = 1 - coupling**2 * m * m_e  # m/axial_factor: the inertia of a cue that moves axially as a rigid body
    cue_energy = (m * tip_u**2 + m_e * tip_w**2 - 2 * coupling * m * m_e * tip_u * tip_w) / (2 * axial_factor)
    results = {
        "squirt": side * np.arctan2(-p_w, p_u) + 0.0,
        "p_t": side * p_t,
        "p_n": p_n,
        "v_t": side * p_t / M,
        "v_n": p_n / M,
        "ball_speed": np.hypot(p_t, p_n) / M,
        "spin": side * p_t / (nu * M * R),
        "cue_speed": U - p_u * axial_factor / m,
        "regime": REGIMES[solution.regime],
        "jam": solution.jam,
        "slip ends": U * solution.slip_end,
        "greatest compression": U * solution.compression_impulse,
        "separation": p_n,
        "initial": m * U**2 / (2 * axial_factor),
        "ball translation": (p_t**2 + p_n**2) / (2 * M),
        "ball rotation": p_t**2 / (2 * nu * M),
        "cue": cue_energy,
        "tip loss": U**2 * solution.tip_loss,
        "friction loss": U**2 * solution.friction_loss,
    }
    return dict(zip(results, np.broadcast_arrays(*results.values()), strict=True))


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
