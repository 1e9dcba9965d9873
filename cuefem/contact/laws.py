"""From a scene's contact terms to the law and the numbers that the kernel takes; what no contact can do is refused."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

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
    return _planar(scene, tip, terms, common, offset)


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


class _TipPart(NamedTuple):
    """What the tip gives a planar contact: its laws, its dome, and about how long the contact takes, s."""

    law: TipLaw | LeatherLaw
    patch: int
    dome: float
    rim: float
    numbers: dict[str, float]
    arrays: dict[str, Array]
    time: float


def _leather(scene: Scene, whole: WholeTip, common: dict[str, Any], offset: float) -> _TipPart:
    """A whole tip, whose patch slips ring by ring, or is a spring where it has a constant stiffness."""
    law = whole.law(scalar("Ball.radius", scene.ball.radius), offset, common["restitution"])
    numbers: dict[str, float] = {"law": 1, "most": law.most, "terms": len(law.force_terms)}
    arrays = {"force_terms": np.array(law.force_terms), "compliance_terms": np.array(law.give_terms)}
    if whole.shear is None:
        patch = PARTIAL_SLIP
        numbers |= {"rings": RINGS, "surface_restitution": whole.surface_restitution}
        arrays |= _rings(law, min(law.most, DEEPER * scene.deepest))
    else:
        patch, numbers = SPRING_PATCH, numbers | {"compliance": 1 / whole.shear}
    return _TipPart(law, patch, whole.dome_radius, whole.rim, numbers, arrays, common["time"])


def _power_tip(scene: Scene, terms: ContactTerms, common: dict[str, Any]) -> _TipPart:
    """A tip with a power law along the normal, whose patch is rigid or a spring."""
    law, time = normal_law(scene, common)
    compliance = terms.compliance / scene.stiffness
    numbers = power_law(law) | {"compliance": compliance}
    patch = SPRING_PATCH if compliance else RIGID_PATCH
    return _TipPart(law, patch, terms.dome_radius, math.inf, numbers, {}, time)


def _planar(scene: Scene, tip: TipModes, terms: ContactTerms, common: dict[str, Any], offset: float) -> ContactModel:
    """A level cue: the contact stays in the plane of the cue's axis and the ball's centre."""
    phi, mass, nu = (common[name] for name in ("phi", "ball_mass", "inertia"))
    (u, w), turns = terms.lever(phi), terms.turns
    s, c = math.sin(phi), math.cos(phi)
    arm_t, arm_n = s * u + c * w, c * u - s * w
    whole = terms.tip
    part = _power_tip(scene, terms, common) if whole is None else _leather(scene, whole, common, offset)
    if part.patch == RIGID_PATCH and terms.window is not None and math.isinf(common["friction"]):
        raise ValueError(
            "Tip.friction must be finite beside SecondHit, or the tip give along the surface (TipShear, LeatherTip): "
            "the blows of endless friction throw ball and tip apart again and again; got inf"
        )
    numbers, arrays, common = part.numbers, part.arrays, common | {"time": part.time}
    if turns:
        numbers |= {"rolls": 1, "dome": part.dome, "rim": min(part.rim, math.pi), "radius": float(scene.ball.radius)}
        numbers |= {"arm_t": arm_t, "arm_n": arm_n}
    turning = bool(u or w or (turns and part.dome))
    propagator = planar_propagator(tip, turning=turning, time=part.time, window=common["window"] or 0.0)
    rolling = part.dome if phi < part.rim else 0.0
    arrays |= _thrust(propagator, -w - rolling * c)
    of_cue = np.array([[-s, -c, -arm_t], [-c, s, -arm_n]])[:, : len(propagator.rows)]
    facing = np.concatenate([of_cue, [[1.0, 0.0, 1.0], [0.0, 1.0, 0.0]]], axis=1)
    return ContactModel(
        propagator,
        facing,
        np.array([1 / mass, 1 / mass, 1 / (nu * mass)]),
        np.zeros(3),
        patch=part.patch,
        terms=numbers,
        arrays=arrays,
        law=part.law,
        tip=tip,
        **common,
    )


def _thrust(propagator: ModalPropagator, ahead: float, planes: int = 1) -> dict[str, Array]:
    """The arrays that a bent cue adds; ahead: how far the centre of the tip's dome lies before the cue's end, m."""
    count = len(propagator.slopes)
    if not count:
        return {}
    weights = np.append(np.ones(count // planes - 1), ahead)
    return {"slope_weights": np.tile(weights, planes)}


def normal_law(scene: Scene, common: dict[str, Any]) -> tuple[TipLaw, float]:
    """The law along the normal, the scene's own or the linear one, and about how long a contact takes, s."""
    make = scene.contact_terms.law
    if make is None:
        return TipLaw(float(scene.stiffness), 1.0, common["restitution"]), float(scene.contact_time)
    return make(HeadOn(scene.head_on_mass, common["restitution"], scene.contact_time, common["speed"]))


def power_law(law: TipLaw) -> dict[str, float]:
    """A power law as the kernel takes it."""
    return {"stiffness": float(law.stiffness), "exponent": float(law.exponent)}


def _rings(law: LeatherLaw, deepest: float) -> dict[str, Array]:
    """Rings of patches up to that of a compression; the last has what lies beyond."""
    edges = deepest * np.linspace(0.0, 1.0, RINGS + 1) ** 2
    force, stiffness = law.at(edges)
    return {
        "ring_edges": edges,
        "ring_forces": force,
        "ring_stiffness": stiffness,
        "ring_slopes": law.slope(edges),
    }


def _raised(scene: Scene, tip: TipModes, terms: ContactTerms, common: dict[str, Any]) -> ContactModel:
    """A cue that points down by an angle, over a table (handbook: Effects).

    In (t, n, p), p = t x n: the velocities of the contact are those of the tip's place along all three, and of the
    ball's lowest point upwards, aside and ahead; the ball's are its velocity and R times its spin.
    """
    if terms.compliance or terms.turns or terms.window is not None or terms.tip is not None:
        raise ValueError("a raised cue (Elevation) takes a tip without give sideways, a fixed normal and a single hit")
    assert terms.table is not None
    law, time = normal_law(scene, common)
    (u, w), phi, mass, nu = terms.lever(common["phi"]), common["phi"], common["ball_mass"], common["inertia"]
    s, c = math.sin(phi), math.cos(phi)
    right, forward, up = table_axes(phi, terms.table.angle)
    if u or w:
        tip = replace(tip, amplitude=tip.amplitude + np.outer(tip.rotation, (u, w)))
    facing = np.zeros((6, 9))
    facing[0, [0, 1]], facing[1, [0, 1]], facing[2, 2] = (-s, -c), (-c, s), -1.0
    facing[[0, 1, 2], [3, 4, 5]] = 1.0
    facing[0, 8], facing[2, 6] = 1.0, -1.0
    facing[3:, 3:6] = up, right, forward
    facing[4, 6:], facing[5, 6:] = -np.cross(up, right), -np.cross(up, forward)
    propagator = raised_propagator(tip, time)
    return ContactModel(
        propagator,
        facing,
        np.repeat([1 / mass, 1 / (nu * mass)], 3),
        np.zeros(6),
        terms={"table_friction": terms.table.friction} | power_law(law),
        arrays=_thrust(propagator, -w - terms.dome_radius * c, planes=2),
        law=law,
        table=terms.table,
        tip=tip,
        **(common | {"time": time}),
    )


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
