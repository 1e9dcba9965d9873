"""Solution of a contact: kernel steps, and from their records phases, losses, history and outcome."""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cuefem.contact.contact_model import PARTIAL_SLIP, RIGID_PATCH, ContactModel
from cuefem.contact.geometric_stiffness import SlopeOutOfRange
from cuefem.contact.kernel.library import STEP, KernelContact, library
from cuefem.contact.modal_response import Complex
from cuefem.contact.outcome import IMPACT, SEPARATION, History, Phase, contact_state
from cuefem.cue import Array
from cuefem.effects.force_law import LeatherLaw
from cuefem.scene import Outcome

FRICTION_STATES = {0: "stick", 1: "slip", -1: "slip back", 2: IMPACT, 3: SEPARATION[0]}
NORMAL_PHASES = ("load", "unload", "free")
# Steps in a head-on contact time: squirt of a default strike is then right to 0.1 %
# (tests/contact/test_stored_answers.py).
DEFAULT_STEPS = 400
INFINITE_FRICTION = 1e12  # friction, as the kernel takes it
STEPS_PER_CALL = 2048  # of the kernel
MAX_CONTACT_TIMES = 200  # without separation, after which the strike raises an error; head-on contact times
MAX_RECORDED_STEPS = 2_000_000  # 0.4 GB of records
_RUNNING, _ENDED, _, _INDENTATION_OUT_OF_RANGE, _SLOPE_OUT_OF_RANGE, _UNSOLVED, _NO_MEMORY = range(7)


Steps = NDArray[np.void]


@dataclass(frozen=True, eq=False)
class SolvedContact:
    """The solution of a contact.

    steps: records (`STEP`) up to the last separation. course: (steps + 1, coordinates), modal coordinates before and
    after each step; None unless stored. xi: final modal coordinates. ball: its final velocities, m/s (raised: also R
    times its spins). losses: J by name.
    """

    model: ContactModel
    steps: Steps
    course: Complex | None
    xi: Complex
    ball: Array
    losses: dict[str, float]

    @property
    def time(self) -> float:
        """When the last contact ended, s."""
        return float(self.steps["time"][-1])

    @property
    def impulse(self) -> tuple[float, float]:
        """Final momentum (t, n) of the ball, N s: the impulse on a ball initially at rest."""
        p_t, p_n = self.model.momentum(self.ball).tolist()
        return p_t, p_n

    @property
    def velocity(self) -> tuple[float, float]:
        """Velocity of the ball relative to the tip (t, n) at separation, m/s."""
        v_t, v_n = self.steps["v"][-1, :2].tolist()
        return v_t, v_n

    @property
    def cue_energy(self) -> tuple[float, float]:
        """Energies of the cue's rigid-body modes and of its vibration, J."""
        propagator = self.model.propagator
        stretched, moving = (propagator.displacements @ self.xi).real, (propagator.velocities @ self.xi).real
        rigid = propagator.omega == 0
        vibrating = stretched @ stretched + moving[~rigid] @ moving[~rigid]
        return float(moving[rigid] @ moving[rigid]) / 2, float(vibrating) / 2

    @cached_property
    def phases(self) -> tuple[Phase, ...]:
        """Runs of steps in one friction state and one normal phase."""
        steps, model = self.steps, self.model
        grip, press = steps["friction_state"], steps["phase"]
        ends = np.append(np.flatnonzero(np.diff(8 * grip + press)), len(steps) - 1)
        times = [0.0, *steps["time"][ends].tolist()]
        given = model.momentum(np.vstack([model.ball, steps["ball"][ends, : len(model.ball)]])) * [model.side, 1.0]
        names = [(FRICTION_STATES[int(g)], NORMAL_PHASES[int(p)]) for g, p in zip(grip[ends], press[ends], strict=True)]
        spans = zip(names, pairwise(times), np.diff(given, axis=0).tolist(), strict=True)
        return tuple(Phase(*name, start, end, (p_t, p_n)) for name, (start, end), (p_t, p_n) in spans)

    @property
    def history(self) -> History:
        """Forces and velocities."""
        model, blows = self.model, int(np.sum(self.steps["length"] == 0))  # which take no time
        steps = self.steps[self.steps["length"] > 0] if blows else self.steps
        ends, side = np.append(0.0, steps["time"]), np.array([model.side, 1.0])
        force_times = np.concatenate([[0.0], ends[1:] - steps["length"] / 2, [self.time]])
        forces = np.zeros((len(steps) + 2, 2))  # none at the touch, and none as the two part
        forces[1:-1] = steps["F"][:, :2] * side
        velocities = np.vstack([model.approach, steps["v"][:, :2]]) * side
        if model.axes is None:
            return History(force_times, forces, ends, velocities)
        moving, turning = model.axes @ self.ball[:3], model.axes @ self.ball[3:] / model.radius
        sides = np.array([model.side, 1.0, 1.0])
        return History(force_times, forces, ends, velocities, moving * sides, turning * sides * model.side)

    @property
    def outcome(self) -> Outcome:
        """The outcome of the strike."""
        model, side = self.model, self.model.side
        M, s, c = model.ball_mass, math.sin(model.phi), math.cos(model.phi)
        (p_t, p_n), approach = self.impulse, model.propagator.approach
        inertia = float(approach @ approach)  # of a cue that moves as one along its axis
        if model.axes is None:
            turning, along = float(self.ball[2]), s * p_t + c * p_n
        else:  # what turned the ball about the vertical, and what the cue gave
            turning = float(model.axes[2] @ self.ball[3:])
            along = model.speed * inertia - float(approach @ (model.propagator.velocities @ self.xi).real)
        energy = self.energies(
            {
                "initial": inertia * model.speed**2 / 2,
                "ball translation": (p_t**2 + p_n**2) / (2 * M),
                "ball rotation": model.inertia * M * turning**2 / 2,
            }
        )
        return Outcome(
            squirt=side * math.atan2(s * p_n - c * p_t, s * p_t + c * p_n) + 0.0,
            ball_velocity=np.array([side * p_t, p_n]) / M,
            ball_speed=math.hypot(p_t, p_n) / M,
            spin=side * turning / model.radius,
            cue_speed=model.speed - along / inertia,
            impulse=np.array([side * p_t, p_n]),
            duration=self.time,
            regime=self._regime(energy),
            jam=self.phases[0].state == "slip" and model.jams,
            phases=self.phases,
            energy=energy,
            unknowns=model.unknowns,
            history=self.history,
        )

    def _regime(self, energy: dict[str, float]) -> str:
        if self.time == 0:  # separated by the impact of infinite friction, which stopped the slip or did not
            return "late stick" if abs(self.velocity[0]) <= 1e-12 * self.model.speed else "miscue"
        return contact_state(self.phases, energy)

    def energies(self, of_ball: dict[str, float]) -> dict[str, float]:
        """Energies after the contact by name, J; of_ball: the initial one, and the ball's or striker's."""
        model, losses, (rigid, vibrating) = self.model, self.losses, self.cue_energy
        account = {
            **of_ball,
            "cue": rigid,
            "cue vibration": vibrating + losses["radiated"],
            "tip loss": losses["tip"],
            "friction loss": losses["friction"],
        }
        if model.propagator.n_dissipative:
            account["damping loss"] = losses["damping"]
        if model.patch != RIGID_PATCH:
            account["tip shear"] = losses["shear"]
        if model.axes is not None:
            level, hop = model.axes[:2] @ self.ball[3:], float(model.axes[2] @ self.ball[:3])
            account["ball roll"] = model.inertia * model.ball_mass * float(level @ level) / 2
            account["ball hop"] = model.ball_mass * hop**2 / 2
            account["table loss"] = losses["table"]
        return {name: float(joules) for name, joules in account.items()}


def solve_contact(model: ContactModel, *, steps: int | None = None, keep_states: bool = False) -> SolvedContact:
    """Solve a contact from first touch to separation, and through the window of a second hit.

    steps: per central-impact contact time. keep_states: store the modal coordinates after every step. RuntimeError if
    the ball does not separate; ValueError where leather or a bent shaft leave the range of their theory.
    """
    kernel, propagator, level = library(), model.propagator, model.axes is None
    arrays = {
        "rates": propagator.rates,
        "rows": propagator.output_rows,
        "drives": propagator.input_rows,
        "kinematics": model.kinematics,
        "inverse_masses": model.inverse_masses,
        "xi": propagator.approach_state * model.speed,
        "ball": model.ball.copy(),
        **model.arrays,
    }
    arrays = {name: np.ascontiguousarray(values) for name, values in arrays.items()}
    numbers = {
        "modes": len(propagator.rates),
        "ports": len(propagator.rows),
        "slopes": len(propagator.slopes),
        "forces": len(model.kinematics),
        "speeds": len(model.ball),
        "planes": 1 if level else 2,
        "patch": model.patch,
        "phi": model.phi,
        "restitution": model.restitution,
        "friction": min(model.friction, INFINITE_FRICTION),
        "step": model.time / (steps or DEFAULT_STEPS),
        "max_time": MAX_CONTACT_TIMES * model.time,
        "window": model.window or 0.0,
    }
    c = KernelContact(**numbers | model.terms | {name: array.ctypes.data for name, array in arrays.items()})
    records, states, dissipated = [], [arrays["xi"][None].copy()], []
    watched = keep_states or len(propagator.dampers) > 0
    work = kernel.contact_new(ctypes.byref(c))
    if not work:
        raise MemoryError("no memory for the steps of a contact")
    try:
        while c.status == _RUNNING:
            if c.steps >= MAX_RECORDED_STEPS:
                raise RuntimeError(
                    f"the strike takes more than {MAX_RECORDED_STEPS} steps of {c.step:.3g} s, for {c.time:.3g} s so "
                    "far: lower Resolution.steps, or the window of SecondHit"
                )
            rows, after = (
                np.empty(STEPS_PER_CALL, STEP),
                np.empty((STEPS_PER_CALL if watched else 0, 2, len(propagator.rates))),
            )
            count = kernel.contact_steps(work, STEPS_PER_CALL, rows.ctypes.data, after.ctypes.data if watched else None)
            records.append(rows[:count])
            if watched:
                states.append(after[:count, 0] + 1j * after[:count, 1])
                xi = np.concatenate([states[-2][-1:], states[-1]])
                dissipated.append(propagator.dissipated(xi, rows["length"][:count]))
                states = states if keep_states else states[-1:]
    finally:
        kernel.contact_free(work)
    if c.status != _ENDED:
        raise _failure(model, c)
    tangential = c.work[0] + c.work[2]
    shear = tangential if model.patch == PARTIAL_SLIP and model.friction >= INFINITE_FRICTION else c.shear_loss
    damping, radiated = np.concatenate([*dissipated, np.zeros((1, 2))])[: c.steps_in_contact].sum(axis=0).tolist()
    losses = {
        "tip": model.law.loss(c.max_depth),
        "friction": tangential - shear,
        "shear": shear,
        "table": sum(c.work[3:]),
        "damping": damping,
        "radiated": radiated,
    }
    return SolvedContact(
        model,
        np.concatenate(records)[: c.steps_in_contact],
        np.concatenate(states)[: c.steps_in_contact + 1] if keep_states else None,
        arrays["xi"],
        arrays["ball"],
        losses,
    )


def _failure(model: ContactModel, c: KernelContact) -> Exception:
    """The error of a contact that did not end."""
    if c.status == _NO_MEMORY:
        return MemoryError("no memory for the steps of a contact")
    if c.status == _INDENTATION_OUT_OF_RANGE and isinstance(model.law, LeatherLaw):
        return model.law.too_deep(c.depth)
    if c.status == _SLOPE_OUT_OF_RANGE:
        return SlopeOutOfRange(
            f"the axial force of {c.axial_force:.4g} N bends the shaft by {c.max_slope:.3g} rad at its tip, beyond the "
            "range of GeometricStiffness: lower the speed, or stiffen the shaft"
        )
    if c.status == _UNSOLVED:
        return RuntimeError(
            f"the forces of the contact have no solution after {c.time:.6g} s and {c.steps} steps, in "
            f"{FRICTION_STATES[c.friction_state]}; take more steps, or fewer modes"
        )
    return RuntimeError(
        f"the ball does not leave the cue: after {c.time:.6g} s (head-on contact time {model.time:.6g} s) the tip is "
        f"indented by {c.depth:.3g} m, in {FRICTION_STATES[c.friction_state]}; check restitution, contact time, masses"
    )
