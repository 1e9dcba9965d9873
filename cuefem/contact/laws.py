"""From a scene's contact terms to the law and the numbers that the kernel takes; what no contact can do is refused."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.propagator import ModalPropagator, planar_propagator, raised_propagator
from cuefem.cue import Array
from cuefem.effects.law import TipLaw
from cuefem.effects.leather_law import LeatherLaw
from cuefem.effects.terms import ContactTerms, HeadOn, Table, WholeTip
from cuefem.quantity.fields import scalar
from cuefem.scene import Scene

# A tip of a small restitution e unloads 1/e times as fast as it loads, and takes as many steps. Such tips are refused
# below the first number, and leather, which rings on the ball then, below the second.
LEAST_RESTITUTION, LEAST_OF_LEATHER = 0.05, 0.1
RINGS, DEEPER = 120, 1.05  # even in the root of the indentation, up to so many times a head-on blow's greatest
RIGID_PATCH, SPRING_PATCH, PARTIAL_SLIP = range(3)


@dataclass(frozen=True, eq=False)
class ContactModel:
    """A contact as the kernel takes it.

    propagator: the cue's modes and ports. facing: (forces, ports + ball), from the velocities of the ports to those of
    the contact at the first touch. inverse_masses: (n,), of the ball's velocities; ball: these at the first touch, m/s.
    law: the force along the normal. terms, arrays: what `kernel/contact.h` names, by name. tip: the cue's modes, where
    they are known.
    """

    propagator: ModalPropagator
    facing: Array
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
    table: Table | None = None
    window: float | None = None
    tip: TipModes | None = None

    @property
    def inverse_mass(self) -> Array:
        """Rates of the contact's velocities per force at the first touch, (forces, forces), 1/kg."""
        ports = len(self.propagator.rows)
        of_cue, of_ball = self.facing[:, :ports], self.facing[:, ports:]
        return np.asarray(of_cue @ self.propagator.mobility @ of_cue.T + (of_ball * self.inverse_masses) @ of_ball.T)

    @property
    def approach(self) -> Array:
        """Velocities of the contact (t, n) at the first touch, m/s."""
        cue = self.propagator.rows @ self.propagator.approach * self.speed
        return np.asarray(self.facing @ np.concatenate([cue, self.ball]))[:2]

    @property
    def unknowns(self) -> int:
        """Of the model: the modes' displacements and velocities, the ball's, and the states of the tip."""
        omega = self.propagator.omega
        forces = len(self.facing)
        turns, gives = bool(self.terms.get("rolls")), self.patch != RIGID_PATCH
        of_tip = {2: 3 + 2 * turns + gives, 6: 8}[forces]
        return len(omega) + int(np.count_nonzero(omega)) + of_tip


def model_of(scene: Scene, tip: TipModes) -> ContactModel:
    """The contact of a scene at an offset >= 0, a negative one being its mirror image.

    ValueError for what no contact honours together, and for a tip of too low a restitution.
    """
    offset = abs(scalar("Stroke.offset", scene.stroke.offset))
    terms, phi = scene.contact_terms, math.asin(offset)
    tip = tip if offset else tip.uncoupled
    mass, nu = scalar("Ball.mass", scene.ball.mass), scalar("Ball.inertia", scene.ball.inertia)
    common: dict[str, Any] = {
        "phi": phi,
        "ball_mass": mass,
        "inertia": nu,
        "restitution": scalar("Tip.restitution", scene.tip.restitution),
        "friction": scalar("Tip.friction", scene.tip.friction),
        "speed": scalar("Stroke.speed", scene.stroke.speed),
        "time": scene.contact_time,
        "window": terms.window,
    }
    _check_restitution(common["restitution"], terms)
    if terms.table is not None:
        return _raised(scene, tip, terms, common)
    return _planar(scene, tip, terms, common)


def _check_restitution(e: float, terms: ContactTerms) -> None:
    if terms.tip is not None and e < LEAST_OF_LEATHER:
        raise ValueError(
            f"Tip.restitution must be in [{LEAST_OF_LEATHER}, 1] beside LeatherTip; got {e:g}: leather that gives back "
            "less rings on the ball while it is unloaded, which is not computed (cue tips: 0.7 to 0.85)"
        )
    check_restitution("Tip.restitution", e)


def check_restitution(name: str, restitution: float) -> None:
    """ValueError for a restitution near 0."""
    if restitution < LEAST_RESTITUTION:
        raise ValueError(
            f"{name} must be in [{LEAST_RESTITUTION:g}, 1] where a contact is followed in time; got {restitution:g} "
            "(cuefem.impulse takes any)"
        )


def _leather(scene: Scene, whole: WholeTip, common: dict[str, Any]) -> dict[str, Any]:
    """What a whole tip gives a contact: its patch slips ring by ring, or is a spring of a constant stiffness."""
    offset = abs(scalar("Stroke.offset", scene.stroke.offset))
    law = whole.law(scalar("Ball.radius", scene.ball.radius), offset, common["restitution"])
    terms: dict[str, float] = {"law": 1, "most": law.most, "terms": len(law.force_terms)}
    arrays = {"force_terms": np.array(law.force_terms), "compliance_terms": np.array(law.give_terms)}
    if whole.shear is not None:
        return {"law": law, "patch": SPRING_PATCH, "terms": terms | {"compliance": 1 / whole.shear}, "arrays": arrays}
    terms |= {"rings": RINGS, "surface_restitution": whole.surface_restitution}
    # the last ring has what lies beyond
    edges = min(law.most, DEEPER * scene.deepest) * np.linspace(0.0, 1.0, RINGS + 1) ** 2
    force, stiffness = law.at(edges)
    arrays |= {"ring_edges": edges, "ring_forces": force, "ring_stiffness": stiffness, "ring_slopes": law.slope(edges)}
    return {"law": law, "patch": PARTIAL_SLIP, "terms": terms, "arrays": arrays}


def _power_tip(scene: Scene, terms: ContactTerms, common: dict[str, Any]) -> dict[str, Any]:
    """What a tip with a power law gives a contact, the effects' or the linear one; its patch is rigid or a spring."""
    law, time = TipLaw(float(scene.stiffness), 1.0, common["restitution"]), float(common["time"])
    if terms.law is not None:
        law, time = terms.law(HeadOn(scene.head_on_mass, common["restitution"], time, common["speed"]))
    compliance = terms.compliance / scene.stiffness
    patch = SPRING_PATCH if compliance else RIGID_PATCH
    return {
        "law": law,
        "patch": patch,
        "terms": power_law(law) | {"compliance": compliance},
        "arrays": {},
        "time": time,
    }


def power_law(law: TipLaw) -> dict[str, float]:
    """A power law as the kernel takes it."""
    return {"stiffness": float(law.stiffness), "exponent": float(law.exponent)}


def _planar(scene: Scene, tip: TipModes, terms: ContactTerms, common: dict[str, Any]) -> ContactModel:
    """A level cue: the contact stays in the plane of the cue's axis and the ball's centre."""
    phi, mass, nu = (common[name] for name in ("phi", "ball_mass", "inertia"))
    (u, w), whole, dome = terms.lever(phi), terms.tip, terms.dome_radius
    s, c, rim = math.sin(phi), math.cos(phi), math.inf if whole is None else whole.rim
    arm_t, arm_n = s * u + c * w, c * u - s * w
    model = common | (_power_tip(scene, terms, common) if whole is None else _leather(scene, whole, common))
    if model["patch"] == RIGID_PATCH and terms.window is not None and math.isinf(common["friction"]):
        raise ValueError(
            "Tip.friction must be finite beside SecondHit, or the tip give along the surface (TipShear, LeatherTip): "
            "the blows of endless friction throw ball and tip apart again and again; got inf"
        )
    if terms.turns:
        rolls = {"rolls": 1, "dome": dome, "rim": min(rim, math.pi), "radius": float(scene.ball.radius)}
        model["terms"] |= rolls | {"arm_t": arm_t, "arm_n": arm_n}
    turning = bool(u or w or (terms.turns and dome))
    propagator = planar_propagator(tip, turning=turning, time=model["time"], window=terms.window or 0.0)
    model["arrays"] |= _thrust(propagator, -w - (dome * c if phi < rim else 0.0))
    of_cue = np.array([[-s, -c, -arm_t], [-c, s, -arm_n]])[:, : len(propagator.rows)]
    facing = np.concatenate([of_cue, [[1.0, 0.0, 1.0], [0.0, 1.0, 0.0]]], axis=1)
    inverse_masses = np.array([1 / mass, 1 / mass, 1 / (nu * mass)])
    return ContactModel(propagator, facing, inverse_masses, np.zeros(3), tip=tip, **model)


def _thrust(propagator: ModalPropagator, ahead: float, planes: int = 1) -> dict[str, Array]:
    """The arrays that a bent cue adds; ahead: how far the centre of the tip's dome lies before the cue's end, m."""
    count = len(propagator.slopes)
    return {"slope_weights": np.tile(np.append(np.ones(count // planes - 1), ahead), planes)} if count else {}


def _raised(scene: Scene, tip: TipModes, terms: ContactTerms, common: dict[str, Any]) -> ContactModel:
    """A cue that points down by an angle, over a table (handbook: Effects).

    In (t, n, p), p = t x n: the velocities of the contact are those of the tip's place along all three, and of the
    ball's lowest point upwards, aside and ahead; the ball's are its velocity and R times its spin.
    """
    if terms.compliance or terms.turns or terms.window is not None or terms.tip is not None:
        raise ValueError("a raised cue (Elevation) takes a tip without give sideways, a fixed normal and a single hit")
    assert terms.table is not None
    (u, w), phi, mass, nu = terms.lever(common["phi"]), common["phi"], common["ball_mass"], common["inertia"]
    s, c, model = math.sin(phi), math.cos(phi), common | _power_tip(scene, terms, common)
    right, forward, up = table_axes(phi, terms.table.angle)
    if u or w:
        tip = replace(tip, amplitude=tip.amplitude + np.outer(tip.rotation, (u, w)))
    facing = np.zeros((6, 9))
    facing[0, [0, 1]], facing[1, [0, 1]], facing[2, 2] = (-s, -c), (-c, s), -1.0
    facing[[0, 1, 2], [3, 4, 5]] = 1.0
    facing[0, 8], facing[2, 6] = 1.0, -1.0
    facing[3:, 3:6] = up, right, forward
    facing[4, 6:], facing[5, 6:] = -np.cross(up, right), -np.cross(up, forward)
    propagator = raised_propagator(tip, model["time"])
    model["terms"] |= {"table_friction": terms.table.friction}
    model["arrays"] |= _thrust(propagator, -w - terms.dome_radius * c, planes=2)
    inverse_masses = np.repeat([1 / mass, 1 / (nu * mass)], 3)
    return ContactModel(propagator, facing, inverse_masses, np.zeros(6), table=terms.table, tip=tip, **model)


def table_axes(phi: float, angle: float) -> tuple[Array, Array, Array]:
    """Right, forward and up in (t, n, p), under a cue that points down by ``angle``, rad."""
    s, c, sin_a, cos_a = math.sin(phi), math.cos(phi), math.sin(angle), math.cos(angle)
    return np.array([c, -s, 0]), np.array([cos_a * s, cos_a * c, sin_a]), np.array([-sin_a * s, -sin_a * c, cos_a])


def impulse_on(model: ContactModel, ball: Array) -> Array:
    """The impulses (t, n), N s, that gave balls at rest velocities (..., speeds); above a table, along it."""
    if model.table is None:
        return np.asarray(model.ball_mass * ball[..., :2])
    s, c = math.sin(model.phi), math.cos(model.phi)
    right, forward, _ = table_axes(model.phi, model.table.angle)
    along = np.array([s * forward + c * right, c * forward - s * right])
    return np.asarray(model.ball_mass * (ball[..., :3] @ along.T))
