"""From a scene's contact terms to the law and the numbers that the kernel takes; what no contact can do is refused."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.propagator import ModalPropagator, planar_propagator, raised_propagator
from cuefem.cue import Array
from cuefem.effects.law import TipLaw
from cuefem.effects.leather_law import LeatherLaw
from cuefem.effects.terms import ContactTerms, HeadOn, Lever, Table, WholeTip
from cuefem.quantity.fields import scalar
from cuefem.scene import Scene

# A contact is given up after this many head-on contact times and, since a rigid tip may ride on the cue's slowest
# vibration, a period and a half of that.
LONGEST = 200
# A tip of a small restitution e unloads 1/e times as fast as it loads, and to follow that takes longer than anybody
# waits. Such tips are refused below the first number (e = 0, a dead tip, is another law), and leather below the second.
LEAST_RESTITUTION, LEAST_OF_LEATHER = 1e-4, 0.1
# What the last terms of a step may add, as a part of the blow's impulse. Forces of rings have many small kinks, but not
# along the blow, where the kernel asks for a tenth.
TOLERANCE, LEATHER_TOLERANCE, RINGED_TOLERANCE = 1e-11, 1e-10, 3e-7
RINGS, DEEPER = 120, 1.05  # even in the root of the compression, up to so many times a head-on blow's greatest
RIGID_PATCH, SPRING_PATCH, RINGED_PATCH = range(3)
# Errors along the surface are measured by the motion there, but by no less than this part of the motion along the
# normal. Where the normal turns, the motion along it enters with its rounding, and the least part is larger.
LEAST_ACROSS, LEAST_ACROSS_TURNING = 1e-9, 1e-3
# Levers that are functions are sampled over this range of the contact's angle, rad, by so many Chebyshev terms.
LEVER_REACH, LEVER_TERMS, LEVER_FIT = 0.5, 24, 1e-11
# The stiffness of a power law is zero at the first touch. Whether a patch on a spring grips there is therefore judged
# at a compression of this part of the stroke's speed times the contact time.
TOUCHED = 1e-11


@dataclass(frozen=True, eq=False)
class ContactModel:
    """A contact as the kernel takes it.

    propagator: the cue's modes and ports. facing: (forces, ports + ball), from the velocities of the ports to those of
    the contact at the first touch. ball_gives: (n,), the inverse masses of the ball's velocities; ball: these at the
    first touch, m/s. law: the force along the normal. across: the part of the
    speed along the surface, by which its errors are measured. terms, arrays: what `kernel/contact.h` names, by name.
    tip: the cue's modes, where they are known.
    """

    propagator: ModalPropagator
    facing: Array
    ball_gives: Array
    ball: Array
    phi: float
    ball_mass: float
    inertia: float
    restitution: float
    friction: float
    speed: float
    time: float
    law: TipLaw | LeatherLaw
    across: float = 1.0
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
        return np.asarray(of_cue @ self.propagator.mobility[0] @ of_cue.T + (of_ball * self.ball_gives) @ of_ball.T)

    @property
    def longest(self) -> float:
        """How long the contact may last at most, s.

        A dead tip may stay on a slow mode, slower still with the ball on it, by no more than the second term.
        """
        ports = len(self.propagator.rows)
        along, of_ball = self.facing[1, :ports], float(self.facing[1, ports:] ** 2 @ self.ball_gives)
        whole, rigid = (float(along @ part @ along) + of_ball for part in self.propagator.mobility)
        return LONGEST * self.time + 10 / self.propagator.slowest * math.sqrt(whole / rigid)

    @property
    def unknowns(self) -> int:
        """Of the model: the modes' displacements and velocities, the ball's, and the states of the tip."""
        omega = self.propagator.omega
        forces = len(self.facing)
        turns, gives = bool(self.terms.get("turns")), self.patch != RIGID_PATCH
        of_tip = {2: 3 + 2 * turns + gives, 6: 8}[forces]
        return len(omega) + int(np.count_nonzero(omega)) + of_tip


def model_of(scene: Scene, tip: TipModes) -> ContactModel:
    """The contact of a scene at an offset >= 0, a negative one being its mirror image.

    ValueError for what no contact honours together, and for a tip that gives back next to nothing.
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
            f"Tip.restitution must be in [{LEAST_OF_LEATHER}, 1] beside LeatherTip; got {e}: leather "
            "that gives back less rings on the ball while it is unloaded, which is not computed (cue tips: 0.7 to 0.85)"
        )
    if terms.window is not None and e < LEAST_RESTITUTION:
        raise ValueError(f"SecondHit takes a Tip.restitution in [{LEAST_RESTITUTION:g}, 1]; got {e}")
    if terms.table is not None and e == 0:
        raise ValueError("Elevation takes a Tip.restitution in (0, 1]; got 0.0")
    check_lively("Tip.restitution", e)


def check_lively(name: str, restitution: float) -> None:
    """ValueError for a tip that gives back next to nothing, but not nothing."""
    if 0 < restitution < LEAST_RESTITUTION:
        raise ValueError(
            f"{name} must be 0, or in [{LEAST_RESTITUTION:g}, 1], where a contact is followed in time; got "
            f"{restitution:g}: such a tip rings too fast past its peak (0 is a dead tip)"
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
    numbers = {"curve": 1, "most": law.most, "terms": len(law.force_terms)}
    arrays = {"force_terms": np.array(law.force_terms), "give_terms": np.array(law.give_terms)}
    if whole.shear is None:
        patch = RINGED_PATCH
        numbers |= {"rings": RINGS, "tolerance": RINGED_TOLERANCE, "surface_restitution": whole.surface_restitution}
        arrays |= _rings(law, min(law.most, DEEPER * scene.deepest))
    else:
        patch = SPRING_PATCH
        numbers |= {"tolerance": LEATHER_TOLERANCE, "compliance": 1 / whole.shear, "first_ratio": math.inf}
    return _TipPart(law, patch, whole.dome_radius, whole.rim, numbers, arrays, common["time"])


def _power_tip(scene: Scene, terms: ContactTerms, common: dict[str, Any]) -> _TipPart:
    """A tip with a power law along the normal, whose patch is rigid or a spring."""
    law, time = normal_law(scene, common)
    compliance = terms.compliance / scene.stiffness
    numbers = power_law(law) | {"tolerance": TOLERANCE, "compliance": compliance}
    if compliance:
        n, touched = law.exponent, TOUCHED * common["speed"] * time
        numbers["first_ratio"] = 1 / (compliance * law.stiffness * n * touched ** (n - 1))
    patch = SPRING_PATCH if compliance else RIGID_PATCH
    return _TipPart(law, patch, terms.dome_radius, math.inf, numbers, {}, time)


def _planar(scene: Scene, tip: TipModes, terms: ContactTerms, common: dict[str, Any], offset: float) -> ContactModel:
    """A level cue: the contact stays in the plane of the cue's axis and the ball's centre."""
    phi, mass, nu = (common[name] for name in ("phi", "ball_mass", "inertia"))
    (u, w), turns = terms.lever(phi), terms.turns
    s, c = math.sin(phi), math.cos(phi)
    lever_t, lever_n = s * u + c * w, c * u - s * w
    whole = terms.tip
    part = _power_tip(scene, terms, common) if whole is None else _leather(scene, whole, common, offset)
    numbers, arrays, common = part.numbers, part.arrays, common | {"time": part.time}
    if turns:
        numbers |= {"turns": 1, "phi": phi, "dome": part.dome, "rim": part.rim, "radius": float(scene.ball.radius)}
        numbers |= {"lever_t": lever_t, "lever_n": lever_n}
        if terms.levers:
            numbers |= {"levers": LEVER_TERMS, "lever_reach": LEVER_REACH}
            arrays["lever_terms"] = _sampled(terms.levers, phi)
    turning = bool(u or w or (turns and (part.dome or terms.levers)))
    propagator = planar_propagator(tip, turning=turning, time=part.time, window=common["window"] or 0.0)
    rolling = part.dome if phi < part.rim else 0.0
    arrays |= _thrust(propagator, -w - rolling * c)
    of_cue = np.array([[-s, -c, -lever_t], [-c, s, -lever_n]])[:, : len(propagator.rows)]
    facing = np.concatenate([of_cue, [[1.0, 0.0, 1.0], [0.0, 1.0, 0.0]]], axis=1)
    tn, nn = (of_cue @ propagator.mobility[0] @ of_cue[1]).tolist()
    pushed = min(1.0, abs(tn) / (nn + 1 / mass))  # by what moves the tip along and across at once
    return ContactModel(
        propagator,
        facing,
        np.array([1 / mass, 1 / mass, 1 / (nu * mass)]),
        np.zeros(3),
        across=max(s, pushed, LEAST_ACROSS_TURNING if turns else LEAST_ACROSS),
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
    return {"slope_weights": np.tile(weights, planes), "slopes": np.zeros(count)}


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
        "ring_shear": np.zeros(RINGS),
    }


def _sampled(levers: Sequence[Lever], phi: float) -> Array:
    """Chebyshev terms of how levers move the contact (u, w) as it turns on from phi; ValueError if they are rough."""

    def moved(angle: Array) -> Array:
        at = np.array([np.sum([lever(phi + each) for lever in levers], axis=0) for each in angle])
        return np.asarray(at - np.sum([lever(phi) for lever in levers], axis=0))

    chebyshev = np.polynomial.chebyshev
    places = chebyshev.chebpts1(LEVER_TERMS)
    terms = np.linalg.solve(chebyshev.chebvander(places, LEVER_TERMS - 1), moved(LEVER_REACH * places))
    between = np.cos(np.arange(1, LEVER_TERMS) * math.pi / LEVER_TERMS)
    off = np.abs(chebyshev.chebvander(between, LEVER_TERMS - 1) @ terms - moved(LEVER_REACH * between)).max()
    if not off <= LEVER_FIT:
        raise ValueError(
            f"a lever of the contact must be smooth over {LEVER_REACH} rad about its angle, to {LEVER_FIT} m; "
            f"got one that a polynomial misses by {off:.3g} m"
        )
    return np.ascontiguousarray(terms.T)


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
        terms={"tolerance": TOLERANCE, "table_friction": terms.table.friction} | power_law(law),
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
