"""Solution of a contact: kernel steps, and from their records phases, losses, history and outcome."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cuefem.contact.contact_model import PARTIAL_SLIP, RIGID_PATCH, ContactModel
from cuefem.contact.geometric_stiffness import SlopeOutOfRange
from cuefem.contact.kernel.declarations import CONSTANTS, STEP, KernelInput, KernelState
from cuefem.contact.kernel.library import library
from cuefem.contact.outcome import IMPACT, SEPARATION, History, Phase, contact_state
from cuefem.cue import Array
from cuefem.effects.force_law import LeatherLaw
from cuefem.scene import Outcome

FRICTION_STATES = {
    CONSTANTS[name]: state
    for name, state in (
        ("STICK", "stick"),
        ("SLIP", "slip"),
        ("SLIP_BACK", "slip back"),
        ("IMPACT", IMPACT),
        ("SEPARATED", SEPARATION[0]),
    )
}
NORMAL_PHASES = {CONSTANTS["LOADING"]: "load", CONSTANTS["UNLOADING"]: "unload", CONSTANTS["FREE"]: "free"}
INFINITE_FRICTION = 1e12  # finite value for infinite friction
STEPS_PER_CALL = 2048  # of the kernel
MAX_CONTACT_TIMES = 200  # longest contact, in head-on contact times; beyond it the strike raises an error
MAX_RECORDED_STEPS = 2_000_000  # 0.4 GB of records


Steps = NDArray[np.void]


@dataclass(frozen=True, eq=False)
class SolvedContact:
    """The solution of a contact.

    steps: records (`STEP`) up to the last separation. states: (steps + 1, 2, modes), state of the modes (v, omega q)
    before and after each step; None unless stored. state: (2, modes), the final one. ball: final velocities of the
    ball, m/s: (t, n) and R times its spin, or above a table (t, n, p) and R times (t, n, p) of its spin. losses: J by
    name.
    """

    model: ContactModel
    steps: Steps
    states: Array | None
    state: Array
    ball: Array
    losses: dict[str, float]

    @property
    def time(self) -> float:
        """End of the last contact, s."""
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
        velocities, displacements = self.state
        rigid = self.model.propagator.tip.omega == 0
        vibration = displacements @ displacements + velocities[~rigid] @ velocities[~rigid]
        return float(velocities[rigid] @ velocities[rigid]) / 2, float(vibration) / 2

    @cached_property
    def phases(self) -> tuple[Phase, ...]:
        """Runs of steps in one friction state and one normal phase."""
        steps, model = self.steps, self.model
        friction, normal = steps["friction_state"], steps["phase"]
        ends = np.append(np.flatnonzero(np.diff(8 * friction + normal)), len(steps) - 1)
        times = [0.0, *steps["time"][ends].tolist()]
        momenta = model.momentum(np.vstack([model.ball, steps["ball"][ends, : len(model.ball)]])) * [model.side, 1.0]
        names = [
            (FRICTION_STATES[int(g)], NORMAL_PHASES[int(p)]) for g, p in zip(friction[ends], normal[ends], strict=True)
        ]
        spans = zip(names, pairwise(times), np.diff(momenta, axis=0).tolist(), strict=True)
        return tuple(Phase(*name, start, end, (p_t, p_n)) for name, (start, end), (p_t, p_n) in spans)

    @property
    def history(self) -> History:
        """Forces and velocities."""
        model, steps = self.model, self.steps[self.steps["length"] > 0]  # impacts have no duration
        ends, side = np.append(0.0, steps["time"]), np.array([model.side, 1.0])
        force_times = np.concatenate([[0.0], ends[1:] - steps["length"] / 2, [self.time]])
        forces = np.zeros((len(steps) + 2, 2))  # zero at touch and separation
        forces[1:-1] = steps["F"][:, :2] * side
        velocities = np.vstack([model.approach, steps["v"][:, :2]]) * side
        if model.axes is None:
            return History(force_times, forces, ends, velocities)
        velocity, spin = model.axes @ self.ball[:3], model.axes @ self.ball[3:] / model.radius
        sides = np.array([model.side, 1.0, 1.0])
        return History(force_times, forces, ends, velocities, velocity * sides, spin * sides * model.side)

    @property
    def outcome(self) -> Outcome:
        """The outcome of the strike."""
        model, side = self.model, self.model.side
        M, s, c = model.ball_mass, math.sin(model.phi), math.cos(model.phi)
        (p_t, p_n), approach = self.impulse, model.propagator.tip.approach
        inertia = float(approach @ approach)  # of a cue that moves axially as a rigid body, kg
        if model.axes is None:
            spin, axial_impulse = float(self.ball[2]), s * p_t + c * p_n
        else:  # R times the ball's spin about the vertical; the axial momentum that the cue lost
            spin = float(model.axes[2] @ self.ball[3:])
            axial_impulse = model.speed * inertia - float(approach @ self.state[0])
        energy = self.energies(
            {
                "initial": inertia * model.speed**2 / 2,
                "ball translation": (p_t**2 + p_n**2) / (2 * M),
                "ball rotation": model.inertia * M * spin**2 / 2,
            }
        )
        return Outcome(
            squirt=side * math.atan2(s * p_n - c * p_t, s * p_t + c * p_n) + 0.0,
            ball_velocity=np.array([side * p_t, p_n]) / M,
            ball_speed=math.hypot(p_t, p_n) / M,
            spin=side * spin / model.radius,
            cue_speed=model.speed - axial_impulse / inertia,
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
        if self.time == 0:  # separated by the impact of infinite friction
            return "late stick" if abs(self.velocity[0]) <= 1e-12 * self.model.speed else "miscue"
        return contact_state(self.phases, energy)

    def energies(self, ball_energies: dict[str, float]) -> dict[str, float]:
        """Energies after the contact by name, J; ball_energies: initial energy, and those of the ball or striker."""
        model, losses, (rigid, vibration) = self.model, self.losses, self.cue_energy
        energy = {
            **ball_energies,
            "cue": rigid,
            "cue vibration": vibration + losses["radiated"],
            "tip loss": losses["tip"],
            "friction loss": losses["friction"],
        }
        if model.propagator.dissipates:
            energy["damping loss"] = losses["damping"]
        if model.patch != RIGID_PATCH:
            energy["tip shear"] = losses["shear"]
        if model.axes is not None:
            horizontal_spin, vertical = model.axes[:2] @ self.ball[3:], float(model.axes[2] @ self.ball[:3])
            energy["ball roll"] = model.inertia * model.ball_mass * float(horizontal_spin @ horizontal_spin) / 2
            energy["ball hop"] = model.ball_mass * vertical**2 / 2
            energy["table loss"] = losses["table"]
        return {name: float(joules) for name, joules in energy.items()}


def solve_contact(model: ContactModel, *, steps: int | None = None, store_states: bool = False) -> SolvedContact:
    """Solve a contact from first touch to separation, and through the window of a second hit.

    steps: in a head-on contact time, by default those of the model. store_states: store the modal coordinates after
    every step. RuntimeError if the ball does not separate; ValueError if the indentation or the slope of the shaft
    leaves its theory's range.
    """
    kernel, propagator = library(), model.propagator
    start = np.array([model.speed * propagator.tip.approach, np.zeros_like(propagator.tip.approach)])
    fields = kernel_input(model, step=model.time / (steps or model.steps))
    state = KernelState(modes=start.copy(), separated_modes=start.copy())
    state.ball[: len(model.ball)] = model.ball.tolist()
    records, states = [], [start[None]]
    contact = kernel.contact_new(fields, state)
    if not contact:
        raise MemoryError("no memory for the steps of a contact")
    try:
        while state.status == CONSTANTS["RUNNING"]:
            if state.steps >= MAX_RECORDED_STEPS:
                raise RuntimeError(
                    f"the strike takes more than {MAX_RECORDED_STEPS} steps of {fields.step:.3g} s, for "
                    f"{state.time:.3g} s so far: lower Resolution.steps, or the window of SecondHit"
                )
            rows = np.empty(STEPS_PER_CALL, STEP)
            after = np.empty((STEPS_PER_CALL if store_states else 0, *start.shape))
            tables = propagator.tables(state.next_step)
            after_steps = after.ctypes.data if store_states else None
            count = kernel.contact_steps(contact, tables, STEPS_PER_CALL, rows.ctypes.data, after_steps)
            records.append(rows[:count])
            states.append(after[:count])
    finally:
        kernel.contact_free(contact)
    if state.status != CONSTANTS["ENDED"]:
        raise _failure(model, state)
    taken = np.concatenate(records)[: state.steps_to_last_separation]
    return SolvedContact(
        model=model,
        steps=taken,
        states=np.concatenate(states)[: len(taken) + 1] if store_states else None,
        state=state.separated_modes,
        ball=taken["ball"][-1, : len(model.ball)],
        losses=_losses(model, state, taken[-1]),
    )


def kernel_input(model: ContactModel, *, step: float) -> KernelInput:
    """The kernel's input; step: length of the steps, s."""
    fields = KernelInput(
        forces=len(model.kinematics),
        speeds=len(model.ball),
        planes=1 if model.axes is None else 2,
        patch=model.patch,
        begins_with_impact=model.friction >= INFINITE_FRICTION and model.patch == RIGID_PATCH and model.phi > 0,
        kinematics=model.kinematics,
        inverse_masses=model.inverse_masses,
        phi=model.phi,
        restitution=model.restitution,
        friction=min(model.friction, INFINITE_FRICTION),
        step=step,
        max_time=MAX_CONTACT_TIMES * model.time,
        window=model.window or 0.0,
        **model.terms,
        **model.arrays,
    )
    model.propagator.write_to(fields)
    return fields


def _losses(model: ContactModel, state: KernelState, last: np.void) -> dict[str, float]:
    """Dissipated energies by name, J, up to the last step in contact."""
    tangential = state.work[0] + state.work[2]
    shear = tangential if model.patch == PARTIAL_SLIP and model.friction >= INFINITE_FRICTION else state.shear_loss
    return {
        "tip": model.law.loss(state.max_indentation),
        "friction": tangential - shear,
        "shear": shear,
        "table": sum(state.work[3:]),
        "damping": float(last["damping_loss"]),
        "radiated": float(last["radiated"]),
    }


def _failure(model: ContactModel, state: KernelState) -> Exception:
    """The exception for a contact that did not end."""
    if state.status == CONSTANTS["INDENTATION_OUT_OF_RANGE"] and isinstance(model.law, LeatherLaw):
        return model.law.out_of_range(state.indentation)
    if state.status == CONSTANTS["SLOPE_OUT_OF_RANGE"]:
        return SlopeOutOfRange(
            f"the axial force of {state.axial_force:.4g} N bends the shaft by {state.max_slope:.3g} rad at its tip, "
            "beyond the range of GeometricStiffness: lower the speed, or stiffen the shaft"
        )
    friction = FRICTION_STATES[state.friction_state]
    if state.status == CONSTANTS["UNSOLVED"]:
        return RuntimeError(
            f"the forces of the contact have no solution after {state.time:.6g} s and {state.steps} steps, in "
            f"{friction}; take more steps, or fewer modes"
        )
    return RuntimeError(
        f"the ball does not leave the cue: after {state.time:.6g} s (head-on contact time {model.time:.6g} s) the tip "
        f"is indented by {state.indentation:.3g} m, in {friction}; check restitution, contact time, masses"
    )
