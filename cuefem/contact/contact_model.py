"""The contact model: from a scene's contact terms to the kernel's input; combinations that cannot act are rejected."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.kernel.declarations import CONSTANTS
from cuefem.contact.modal_response import ModalPropagator, propagator_of
from cuefem.cue import Array
from cuefem.effects.contact_terms import ContactTerms, PowerLaw, TipModel
from cuefem.effects.force_law import LeatherLaw, TipLaw, contact_time_ratio
from cuefem.scene import Scene

# A tip of small restitution e unloads 1/e times as fast as it loads, which needs 1/e times as many steps. Lower bounds
# of spring tips and of leather, which vibrates on the ball below its bound.
MIN_RESTITUTION, MIN_LEATHER_RESTITUTION = 0.05, 0.1
ANNULI, TABLE_MARGIN = 120, 1.05  # annuli uniform in the root of the indentation, up to 1.05 times the largest
RIGID_PATCH, SPRING_PATCH, PARTIAL_SLIP = (CONSTANTS[name] for name in ("RIGID_PATCH", "SPRING_PATCH", "PARTIAL_SLIP"))
# Steps in a head-on contact time, and those of a leather tip that does not slip as a whole: the error of squirt is
# below 0.1 % (tests/contact/test_stored_answers.py).
STEPS, LEATHER_STEPS = 400, 200


@dataclass(frozen=True, eq=False)
class ContactModel:
    """Input of the contact kernel.

    propagator: the cue's modes and ports. kinematics: (forces, ports + ball), from the velocities of ports and ball to
    those of the contact at the first touch. inverse_masses: (n,), of the ball's velocities, 1/kg. ball: (n,), these
    velocities at the first touch, m/s. phi: angle of the contact, rad. ball_mass: kg. inertia: the factor of the ball's
    moment of inertia. speed: of the cue, m/s. time: head-on contact time, s. law: the force-indentation law. patch:
    tangential compliance, `RIGID_PATCH`, `SPRING_PATCH` or `PARTIAL_SLIP`. terms, arrays: further fields of
    `kernel/contact.h`, by name. axes: right, forward and up in (t, n, p), (3, 3), above a table; None for a level cue.
    window: time simulated after separation, s; None without double hits. side: struck side of the ball, 1 or -1; all
    other fields are those of the mirrored stroke, on side 1. radius: of the ball, m. steps: default number in a head-on
    contact time.
    """

    propagator: ModalPropagator
    kinematics: Array
    inverse_masses: Array
    ball: Array
    phi: float
    ball_mass: float
    inertia: float
    restitution: float
    friction: float
    speed: float
    time: float
    law: TipLaw | LeatherLaw
    patch: int = RIGID_PATCH
    terms: dict[str, float] = field(default_factory=dict)
    arrays: dict[str, Array] = field(default_factory=dict)
    axes: Array | None = None
    window: float | None = None
    side: float = 1.0
    radius: float = 1.0
    steps: int = STEPS

    @property
    def inverse_mass(self) -> Array:
        """Inverse mass of the contact at the first touch, (forces, forces), 1/kg."""
        ports = len(self.propagator.ports)
        cue, ball = self.kinematics[:, :ports], self.kinematics[:, ports:]
        mobility = self.propagator.mobility[:ports, :ports]
        return np.asarray(cue @ mobility @ cue.T + (ball * self.inverse_masses) @ ball.T)

    @property
    def approach(self) -> Array:
        """Velocities of the contact (t, n) at the first touch, m/s."""
        cue = self.propagator.ports @ self.propagator.tip.approach * self.speed
        return np.asarray(self.kinematics @ np.concatenate([cue, self.ball]))[:2]

    @property
    def jams(self) -> bool:
        """Whether slip at the first touch increases the normal approach velocity (jam)."""
        B = self.inverse_mass
        return bool(B[1, 1] + self.friction * B[0, 1] < 0)

    def momentum(self, ball: Array) -> Array:
        """Momentum (t, n), N s, of the ball at velocities (..., speeds); above a table, its horizontal part."""
        if self.axes is None:
            return np.asarray(self.ball_mass * ball[..., :2])
        s, c, (right, forward, _) = math.sin(self.phi), math.cos(self.phi), self.axes
        horizontal = np.array([s * forward + c * right, c * forward - s * right])
        return np.asarray(self.ball_mass * (ball[..., :3] @ horizontal.T))

    @property
    def unknowns(self) -> int:
        """Number of state variables: modal displacements and velocities, the ball's, and the tip's."""
        omega = self.propagator.tip.omega
        forces = len(self.kinematics)
        rolls, has_compliance = bool(self.terms.get("rolling")), self.patch != RIGID_PATCH
        n_tip_and_ball = {2: 3 + 2 * rolls + has_compliance, 6: 8}[forces]
        return len(omega) + int(np.count_nonzero(omega)) + n_tip_and_ball


def model_of(scene: Scene, tip: TipModes) -> ContactModel:
    """The contact of a scene at an offset >= 0; a negative one is its mirror image.

    ValueError for effects that cannot act together, and for a restitution below its bound.
    """
    offset, terms = scene.stroke.offset, scene.contact_terms
    tip = tip if offset else tip.uncoupled
    model: dict[str, Any] = {
        "phi": math.asin(abs(offset)),
        "side": math.copysign(1.0, offset),
        "ball_mass": scene.ball.mass,
        "inertia": scene.ball.inertia,
        "radius": scene.ball.radius,
        "restitution": scene.tip.restitution,
        "friction": scene.tip.friction,
        "speed": scene.stroke.speed,
        "time": scene.contact_time,
        "window": terms.window,
    }
    check_restitution(
        "Tip.restitution", model["restitution"], MIN_RESTITUTION if terms.tip is None else MIN_LEATHER_RESTITUTION
    )
    is_elevated = terms.table is not None
    if is_elevated and (terms.compliance or terms.turns or terms.window is not None or terms.tip is not None):
        raise ValueError("Elevation takes a tip without tangential compliance, a fixed normal and a single hit")
    model |= _power_tip(scene, terms, model) if terms.tip is None else _leather(scene, terms.tip, model)
    if model["patch"] == RIGID_PATCH and terms.window is not None and math.isinf(model["friction"]):
        raise ValueError(
            "Tip.friction must be finite beside SecondHit, unless the tip has tangential compliance (TipShear, "
            "LeatherTip): impacts of infinite friction separate ball and tip again and again; got inf"
        )
    (u, w), dome, rim = (
        terms.moment_arm(model["phi"]),
        terms.dome_radius,
        math.inf if terms.tip is None else terms.tip.rim,
    )
    if is_elevated and (u or w):
        tip = replace(tip, amplitude=tip.amplitude + np.outer(tip.rotation, (u, w)))
    ports = "raised" if is_elevated else "turning" if u or w or (terms.turns and dome) else "straight"
    propagator = propagator_of(tip, ports)
    if len(propagator.slopes):  # in one plane or two; the last of each plane is the slope of the cue's end
        # distance from the end section forwards to the dome's centre, m
        ahead = -w - (dome * math.cos(model["phi"]) if model["phi"] < rim else 0.0)
        planes = 1 + is_elevated
        weights = np.append(np.ones(len(propagator.slopes) // planes - 1), ahead)
        model["arrays"] |= {"slope_weights": np.tile(weights, planes)}
    kinematics = _level_rows(model["phi"], u, w)
    if terms.turns:
        arm_t, arm_n = -kinematics[:, 2]
        model["terms"] |= {"rolling": 1, "dome": dome, "rim": min(rim, math.pi), "radius": model["radius"]}
        model["terms"] |= {"arm_t": arm_t, "arm_n": arm_n}
    if ports == "straight":
        kinematics = kinematics[:, [0, 1, 3, 4, 5]]
    if terms.table is not None:
        model["axes"] = _table_axes(model["phi"], terms.table.angle)
        model["terms"] |= {"table_friction": terms.table.friction}
        kinematics = _elevated_rows(model["phi"], model["axes"])
    velocity, spin = 1 / model["ball_mass"], 1 / (model["inertia"] * model["ball_mass"])
    inverse_masses = np.array([velocity] * 3 + [spin] * 3 if is_elevated else [velocity, velocity, spin])
    return ContactModel(propagator, kinematics, inverse_masses, 0 * inverse_masses, **model)


def _level_rows(phi: float, u: float, w: float) -> Array:
    """From the velocities of the ports (u, w, rotation) and of the ball to those of a level contact (t, n)."""
    s, c = math.sin(phi), math.cos(phi)
    return np.array([[-s, -c, -s * u - c * w, 1.0, 0.0, 1.0], [-c, s, s * w - c * u, 0.0, 1.0, 0.0]])


def _table_axes(phi: float, angle: float) -> Array:
    """Right, forward and up in (t, n, p), under a cue that points down by ``angle``, rad."""
    s, c, sin_a, cos_a = math.sin(phi), math.cos(phi), math.sin(angle), math.cos(angle)
    return np.array([[c, -s, 0], [cos_a * s, cos_a * c, sin_a], [-sin_a * s, -sin_a * c, cos_a]])


def _elevated_rows(phi: float, axes: Array) -> Array:
    """As `_level_rows`, of a cue that points down by an angle, over a table (handbook: Effects).

    In (t, n, p), p = t x n. The contact has the three velocities of the ball against the tip, and those of the ball's
    lowest point upwards, laterally and forwards; the ball has its velocity and R times its spin.
    """
    s, c, (right, forward, up) = math.sin(phi), math.cos(phi), axes
    kinematics = np.zeros((6, 9))
    kinematics[0, [0, 1]], kinematics[1, [0, 1]], kinematics[2, 2] = (-s, -c), (-c, s), -1.0
    kinematics[[0, 1, 2], [3, 4, 5]] = 1.0
    kinematics[0, 8], kinematics[2, 6] = 1.0, -1.0
    kinematics[3:, 3:6] = up, right, forward
    kinematics[4, 6:], kinematics[5, 6:] = -np.cross(up, right), -np.cross(up, forward)
    return kinematics


def check_restitution(name: str, restitution: float, bound: float = MIN_RESTITUTION) -> None:
    """ValueError for a restitution below ``bound``."""
    if restitution < bound:
        raise ValueError(
            f"{name} must be in [{bound:g}, 1] for a contact computed in time; got {restitution:g} "
            "(cuefem.impulse takes any)"
        )


def _leather(scene: Scene, tip: TipModel, inputs: dict[str, Any]) -> dict[str, Any]:
    """Fields of a leather tip, whose patch slips annulus by annulus."""
    law = tip.law(inputs["radius"], abs(float(scene.stroke.offset)), inputs["restitution"])
    terms = {"law": 1, "indentation_limit": law.indentation_limit, "terms": len(law.force_terms), "annuli": ANNULI}
    terms["surface_restitution"] = tip.surface_restitution
    arrays = {"force_terms": np.array(law.force_terms), "compliance_terms": np.array(law.compliance_terms)}
    # the last annulus also has what lies beyond its edge
    limit = min(law.indentation_limit, TABLE_MARGIN * scene.max_indentation)
    indentation = limit * np.linspace(0.0, 1.0, ANNULI + 1) ** 2
    force, stiffness = law.at(indentation)
    arrays |= {
        "annulus_edges": indentation,
        "annulus_forces": force,
        "annulus_stiffness": stiffness,
        "annulus_slopes": law.slope(indentation),
    }
    slips_at_touch = math.tan(inputs["phi"]) > inputs["friction"]
    steps = STEPS if slips_at_touch else LEATHER_STEPS
    return {"law": law, "patch": PARTIAL_SLIP, "terms": terms, "arrays": arrays, "steps": steps}


def _power_tip(scene: Scene, terms: ContactTerms, inputs: dict[str, Any]) -> dict[str, Any]:
    """Fields of a power-law tip, that of an effect or the linear one; its patch is rigid or a spring."""
    exponent, speed = terms.law or PowerLaw(1.0, inputs["speed"])
    impact = {"mass": scene.reduced_mass, "speed": speed, "time": inputs["time"]}
    law = TipLaw.for_contact_time(exponent, inputs["restitution"], **impact)
    compliance = terms.compliance / scene.stiffness
    patch = SPRING_PATCH if compliance else RIGID_PATCH
    return {
        "law": law,
        "patch": patch,
        "terms": power_law(law) | {"compliance": compliance},
        "arrays": {},
        "time": inputs["time"] * contact_time_ratio(exponent, inputs["speed"] / speed),
    }


def power_law(law: TipLaw) -> dict[str, float]:
    """Kernel fields of a power law."""
    return {"stiffness": float(law.stiffness), "exponent": float(law.exponent), "indentation_limit": math.inf}
