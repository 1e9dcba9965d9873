"""A contact solved: the kernel runs the model, and its numbers come back as phases, losses and the course of it all."""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cuefem.contact.bent import BentTooFar, buckling_thrust
from cuefem.contact.compiled import KernelContact, library
from cuefem.contact.laws import ContactModel, table_axes
from cuefem.contact.outcome import BLOW, FLIGHT, History, Phase
from cuefem.contact.propagator import Complex, ModalPropagator
from cuefem.contact.rule import NODES
from cuefem.cue import Array
from cuefem.effects.leather_law import LeatherLaw

GRIPS = {0: "stick", 1: "slip", -1: "slip back", 2: BLOW, 3: FLIGHT[0]}
PRESSES = ("load", "unload", "rigid", "free")
# A contact that changes phase this often, or takes so many steps, does not end.
MOST_PHASES, MOST_STEPS = 5_000, 200_000
_ENDED, _LATE, _CROWDED, _STUCK, _TOO_DEEP, _TURNED_TOO_FAR, _BENT_TOO_FAR, _NO_MEMORY = range(8)
_WITH = NODES + 1
_NOTHING = np.zeros(0)


@dataclass(frozen=True, eq=False)
class Course:
    """The steps of a contact, one row each: what cue and ball do at any time follows from them.

    start, step, part: the time at which a step began, s, its length, s, and the part of it that was taken. pressed:
    whether ball and tip touched in it. force, velocity: (steps, forces, nodes + 1), of the contact, N and m/s; depth,
    angle: (steps, nodes + 1), m and rad; loads: (steps, rows, nodes), on the cue's ports, its slopes and the ball's
    velocities, N; blows: (steps, rows), on them before the step, N s.
    """

    start: Array
    step: Array
    part: Array
    pressed: Array
    force: Array
    velocity: Array
    depth: Array
    angle: Array
    loads: Array
    blows: Array

    @classmethod
    def of(cls, records: Array, forces: int, propagator: ModalPropagator, speeds: int) -> Course:
        """From the kernel's records, whose rows hold room for three ports of the cue, and its slopes at the end."""
        ports, slopes = len(propagator.rows), len(propagator.slopes)
        count, wide = len(records), 3 + speeds + slopes
        shapes = [(forces, _WITH), (forces, _WITH), (_WITH,), (_WITH,), (wide, NODES), (wide,)]
        ends = 5 + np.cumsum([math.prod(shape) for shape in shapes])
        parts = [
            part.reshape(count, *shape)
            for part, shape in zip(np.split(records[:, 5:], ends[:-1] - 5, axis=1), shapes, strict=True)
        ]
        there = np.r_[:ports, 3 + speeds : wide, 3 : 3 + speeds]
        start, step, part, _, press = records[:, :5].T
        force, velocity, depth, angle, loads, blows = parts
        pressed = press != PRESSES.index("free")
        return cls(start, step, part, pressed, force, velocity, depth, angle, loads[:, there], blows[:, there])


@dataclass(frozen=True, eq=False)
class SolvedContact:
    """A contact that is over.

    xi_before, xi: the coordinates of the cue's modes before and after it (`ModalPropagator`). ball: the ball's
    velocities after it, m/s (raised: and its spins times R). losses: J by name. peak, deepest: the tip's greatest
    force, N, and compression, m. records: the kernel's rows, one a step; None where they were not asked for.
    """

    model: ContactModel
    phases: tuple[Phase, ...]
    time: float
    xi_before: Complex
    xi: Complex
    ball: Array
    parted: bool
    deepest: float
    peak: float
    losses: dict[str, float]
    records: Array | None
    slopes: Array

    @cached_property
    def course(self) -> Course:
        """Its steps, of a contact that was recorded."""
        assert self.records is not None
        model = self.model
        return Course.of(self.records, len(model.facing), model.propagator, len(model.ball_gives))

    @property
    def impulse(self) -> tuple[float, float]:
        """The momentum (t, n) of the ball after the contact, N s: the impulse on it if it was at rest before."""
        p_t, p_n = impulse_on(self.model, self.ball).tolist()
        return p_t, p_n

    @property
    def velocity(self) -> tuple[float, float]:
        """Of ball against tip (t, n), m/s, in the directions of the first touch."""
        v = _velocities(self.model, self.xi, self.ball, self.slopes)
        return float(v[0]), float(v[1])

    @property
    def cue_energy(self) -> tuple[float, float]:
        """Of the cue's rigid motions and of its vibration, J."""
        propagator = self.model.propagator
        stretched, moving = (propagator.displacements @ self.xi).real, (propagator.velocities @ self.xi).real
        rigid = propagator.omega == 0
        vibrating = stretched @ stretched + moving[~rigid] @ moving[~rigid]
        return float(moving[rigid] @ moving[rigid]) / 2, float(vibrating) / 2

    def history(self, mirror: float, radius: float = 1.0) -> History:
        """Forces and velocities; mirror: -1 for a stroke on the other side; radius: of the ball, m."""
        assert self.records is not None
        count, forces = len(self.records), len(self.model.facing)
        start, step = self.records[:, :2].T.copy()
        both = self.records[:, 5 : 5 + 2 * forces * _WITH].reshape(count, 2, forces, _WITH)[:, :, :2]
        values = (both * np.array([[mirror], [1.0]])).reshape(count, 4, _WITH)
        if self.model.table is None:
            return History(start, step, self.time, values)
        axes, flip = np.array(table_axes(self.model.phi, self.model.table.angle)), np.array([mirror, 1.0, 1.0])
        velocity, turning = axes @ self.ball[:3] * flip, axes @ self.ball[3:] / radius * flip * mirror
        return History(start, step, self.time, values, velocity, turning)


def _velocities(model: ContactModel, xi: Complex, ball: Array, slopes: Array) -> Array:
    """Of the contact, m/s, in the directions of the first touch; a bent cue takes its tip back as it bends further."""
    propagator = model.propagator
    modes = (propagator.velocities @ xi).real
    ports = propagator.rows @ modes
    if len(slopes):
        ports[0] -= (model.arrays["slope_weights"] * slopes) @ (propagator.slopes @ modes)
    return np.asarray(model.facing @ np.concatenate([ports, ball]))


def impulse_on(model: ContactModel, ball: Array) -> Array:
    """The impulses (t, n), N s, that gave balls at rest velocities (..., speeds); above a table, along it."""
    if model.table is None:
        return np.asarray(model.ball_mass * ball[..., :2])
    s, c = math.sin(model.phi), math.cos(model.phi)
    right, forward, _ = table_axes(model.phi, model.table.angle)
    along = np.array([s * forward + c * right, c * forward - s * right])
    return np.asarray(model.ball_mass * (ball[..., :3] @ along.T))


def solve_contact(model: ContactModel, *, recorded: bool = True) -> SolvedContact:
    """Follow a contact from touch to parting, and what comes after it within its window.

    RuntimeError if the ball does not leave the cue, or the contact cannot be stepped on.
    """
    kernel, propagator = library(), model.propagator
    before = propagator.approaching * model.speed
    arrays = {
        "facing": np.ascontiguousarray(model.facing),
        "ball_gives": np.ascontiguousarray(model.ball_gives),
        "xi": before.copy(),
        "ball": np.append(model.ball, np.zeros(6 - len(model.ball))),  # the kernel has room for six
        **{name: np.array(values, float) for name, values in model.arrays.items()},
    }
    numbers = {
        "exponent": 1.0,
        "restitution": model.restitution,
        "friction": model.friction,
        "speed": model.speed,
        "across": model.across,
        "clock": model.time,
        "impulse": model.speed * model.ball_mass,
        "longest": model.longest,
        "window": model.window or 0.0,
        "most_phases": MOST_PHASES,
        "most_steps": MOST_STEPS,
        "forces": len(model.facing),
        "speeds": len(model.ball_gives),
        "patch": model.patch,
        "lossy": propagator.lossy,
        "recording": int(recorded),
        "plane": len(propagator.slopes) // (1 if model.table is None else 2),
    }
    c = KernelContact(**numbers | model.terms | {name: array.ctypes.data for name, array in arrays.items()})
    c.cue = propagator.cue
    kernel.contact_run(ctypes.byref(c))
    phases = _phases(model, _rows(c.phases, c.phase_count, 4 + 2 * c.speeds), c.speeds)
    arrays["ball"] = arrays["ball"][: c.speeds]
    records = _rows(c.records, c.record_count, c.row) if recorded else None
    kernel.contact_free(ctypes.byref(c))
    if c.status != _ENDED:
        raise _failure(model, c, phases, arrays)
    losses = {"friction": c.friction_loss, "shear": c.shear_loss, "table": c.table_loss}
    losses |= {"damping": c.damping_loss, "radiated": c.radiated}
    return SolvedContact(
        model=model,
        phases=phases,
        time=c.time,
        xi_before=before,
        xi=arrays["xi"],
        ball=arrays["ball"],
        parted=bool(c.parted),
        deepest=c.deepest,
        peak=c.peak,
        losses=losses,
        records=records,
        slopes=arrays.get("slopes", _NOTHING),
    )


def _rows(pointer: ctypes._Pointer[ctypes.c_double], count: int, wide: int) -> Array:
    """A copy of the kernel's rows."""
    return np.frombuffer(ctypes.string_at(pointer, 8 * count * wide) if count else b"").reshape(count, max(wide, 5))


def _phases(model: ContactModel, rows: Array, speeds: int) -> tuple[Phase, ...]:
    before, after = rows[:, 4 : 4 + speeds], rows[:, 4 + speeds :]
    impulses = impulse_on(model, after) - impulse_on(model, before)
    return tuple(
        Phase(GRIPS[int(grip)], PRESSES[int(press)], start, end, (p_t, p_n))
        for (grip, press, start, end), (p_t, p_n) in zip(rows[:, :4].tolist(), impulses.tolist(), strict=True)
    )


def _buckling(model: ContactModel) -> float:
    assert model.tip is not None
    return buckling_thrust(model.tip, float(model.arrays["slope_weights"][-1]))


def _failure(model: ContactModel, c: KernelContact, phases: tuple[Phase, ...], arrays: dict[str, Array]) -> Exception:
    """What a contact that did not end says."""
    if c.status == _NO_MEMORY:
        return MemoryError("no memory for the steps of a contact")
    if c.status == _TOO_DEEP and isinstance(model.law, LeatherLaw):
        return model.law.too_deep(c.depth)
    where = f"{GRIPS[c.grip]}, {PRESSES[c.press]}"
    if c.status == _TURNED_TOO_FAR:
        return RuntimeError(f"the contact has rolled by {c.angle:.3g} rad, further than its levers are known")
    if c.status == _BENT_TOO_FAR:
        return BentTooFar(
            f"the thrust of {c.thrust:.4g} N bends the shaft by {c.steepest:.3g} rad at its tip, further than "
            f"GeometricStiffness holds; thrust that lasts buckles it from {_buckling(model):.4g} N on"
        )
    if c.status == _STUCK:
        return RuntimeError(
            f"the contact could not be stepped on from {c.time:.6g} s, after {c.steps} steps, in {where}; "
            "keep fewer modes, or a Tip.restitution further from 0"
        )
    v = _velocities(model, np.asarray(arrays["xi"], complex), arrays["ball"], arrays.get("slopes", _NOTHING))
    return RuntimeError(
        f"the ball does not leave the cue: after {c.time:.6g} s and {len(phases)} phases "
        f"(head-on contact time {model.time:.6g} s) the contact is in {where}, with v_t = {v[0]:.3g} m/s, "
        f"v_n = {v[1]:.3g} m/s and the tip pressed by {c.depth:.3g} m; "
        "check restitution, contact time and the masses, or keep fewer modes"
    )
