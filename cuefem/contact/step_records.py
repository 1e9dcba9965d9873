"""Solution of a contact: kernel steps, and from their records phases, losses, history and outcome."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cuefem.contact.contact_model import ContactModel
from cuefem.contact.geometric_stiffness import SlopeOutOfRange
from cuefem.contact.kernel.declarations import CONSTANTS, STEP, KernelState, StepTables
from cuefem.contact.kernel.library import library, new_contact
from cuefem.contact.modal_response import ModalPropagator, repeated_tables
from cuefem.contact.outcome import IMPACT, SEPARATION, History, Phase, contact_state
from cuefem.contact.ports import Raised
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
STEPS_PER_CALL = 2048  # of the kernel
BOUNCE_RESIDUAL = 1e-3  # of energy, over the initial one: beyond it a tip bounces faster than the steps
MAX_RECORDED_STEPS = 2_000_000  # 0.4 GB of records


Steps = NDArray[np.void]


@dataclass(frozen=True)
class Losses:
    """Energies that a contact has taken up to the last separation, J.

    tip: along the normal. friction: of tip and ball. shear: of the tip along its surface. table: friction there.
    damping: of the cue, by dashpots and loss factors. radiated: along the cue, by the truncation correction.
    """

    tip: float
    friction: float
    shear: float
    table: float
    damping: float
    radiated: float


@dataclass(frozen=True, eq=False)
class SolvedContact:
    """The solution of a contact.

    steps: records (`STEP`) up to the last separation. states: (steps + 1, 2, modes), state of the modes (v, omega q)
    before and after each step; None unless stored. state: (2, modes), the final one. ball: final velocities of the
    ball, m/s: (t, n) and R times its spin, or above a table (t, n, p) and R times (t, n, p) of its spin.
    """

    model: ContactModel
    steps: Steps
    states: Array | None
    state: Array
    ball: Array
    losses: Losses

    @property
    def time(self) -> float:
        """End of the last contact, s."""
        return float(self.steps["time"][-1])

    @property
    def bounces(self) -> bool:
        """Whether the first separation is a bounce, which has hardly moved the ball."""
        flight = np.append(self.steps["friction_state"] == CONSTANTS["SEPARATED"], True)
        normal_velocity = self.steps["ball"][flight.argmax() - 1, CONSTANTS["N"]]
        return bool(normal_velocity < self.model.bounce_speed)

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
    def gap_velocity(self) -> float:
        """Velocity along n of the ball relative to the cue's rigid-body motion after the contact, m/s."""
        cue, rigid = self.model.propagator, self.model.propagator.tip.omega == 0
        ports = cue.ports[:, rigid] @ self.state[0, rigid]
        return float(self.model.ports.kinematics[1] @ np.concatenate([ports, self.ball]))

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

    @cached_property
    def history(self) -> History:
        """Forces and velocities."""
        model, steps = self.model, self.steps[self.steps["length"] > 0]  # impacts have no duration
        ends, side = np.append(0.0, steps["time"]), np.array([model.side, 1.0])
        forces = np.zeros((len(steps) + 2, 2))  # zero at touch and separation
        forces[1:-1] = steps["F"][:, :2] * side
        velocity, spin = self._ball_vectors
        return History(
            force_times=np.concatenate([[0.0], ends[1:] - steps["length"] / 2, [self.time]]),
            forces=forces,
            ends=ends,
            velocities=np.vstack([model.approach, steps["v"][:, :2]]) * side,
            velocity=velocity,
            spin=spin,
        )

    @property
    def _ball_vectors(self) -> tuple[Array, Array] | tuple[None, None]:
        """Velocity, m/s, and spin, rad/s, of the ball: right, forward, up; None of a level cue."""
        model = self.model
        if not isinstance(model.ports, Raised):
            return None, None
        velocity, spin = model.ports.on_table(self.ball)
        sides = np.array([model.side, 1.0, 1.0])
        return velocity * sides, spin / model.radius * sides * model.side

    @property
    def outcome(self) -> Outcome:
        """The outcome of the strike."""
        model, side = self.model, self.model.side
        M, s, c = model.ball_mass, math.sin(model.phi), math.cos(model.phi)
        (p_t, p_n), approach = self.impulse, model.propagator.tip.approach
        inertia = float(approach @ approach)  # of a cue that moves axially as a rigid body, kg
        spin = model.ports.vertical_spin(self.ball)
        axial_impulse = s * p_t + c * p_n
        if isinstance(model.ports, Raised):  # the table takes momentum: what the cue has lost
            axial_impulse = model.speed * inertia - float(approach @ self.state[0])
        energy = self.energies(
            {
                "initial": inertia * model.speed**2 / 2,
                "ball translation": (p_t**2 + p_n**2) / (2 * M),
                "ball rotation": model.inertia * M * spin**2 / 2,
            }
        )
        _check_bounces(self, energy)
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
        in_contact = [phase for phase in self.phases if phase[:2] != SEPARATION]
        return contact_state(in_contact if self.bounces else self.phases, energy)

    def energies(self, ball_energies: dict[str, float]) -> dict[str, float]:
        """Energies after the contact by name, J; ball_energies: initial energy, and those of the ball or striker."""
        model, losses, (rigid, vibration) = self.model, self.losses, self.cue_energy
        energy = {
            **ball_energies,
            "cue": rigid,
            "cue vibration": vibration + losses.radiated,
            "tip loss": losses.tip,
            "friction loss": losses.friction,
        }
        if model.propagator.dissipates:
            energy["damping loss"] = losses.damping
        if not model.tip.is_rigid:
            energy["tip shear"] = losses.shear
        if isinstance(model.ports, Raised):
            velocity, spin = model.ports.on_table(self.ball)
            energy["ball roll"] = model.inertia * model.ball_mass * float(spin[:2] @ spin[:2]) / 2
            energy["ball hop"] = model.ball_mass * float(velocity[2]) ** 2 / 2
            energy["table loss"] = losses.table
        return {name: float(joules) for name, joules in energy.items()}


def solve_contact(model: ContactModel, *, steps: int | None = None, store_states: bool = False) -> SolvedContact:
    """Solve a contact from first touch to separation, and through the window of a second hit.

    steps: in a head-on contact time, by default those of the model. store_states: store the modal coordinates after
    every step. RuntimeError if the ball does not separate; ValueError if the indentation or the slope of the shaft
    leaves its theory's range.
    """
    propagator = model.propagator
    start = np.array([model.speed * propagator.tip.approach, np.zeros_like(propagator.tip.approach)])
    fields = model.kernel_input(step=model.time / (steps or model.steps))
    state = KernelState(modes=start.copy(), separated_modes=start.copy())
    state.ball[: len(model.ball)] = model.ball.tolist()
    port_velocities = propagator.port_velocities(start[0])
    state.mean_velocities[: len(port_velocities)] = port_velocities.tolist()
    records, states = [], [start[None]]
    with new_contact(fields, state) as contact:
        while state.status == CONSTANTS["RUNNING"]:
            if state.steps >= MAX_RECORDED_STEPS:
                raise RuntimeError(
                    f"the strike takes more than {MAX_RECORDED_STEPS} steps of {fields.step:.3g} s, for "
                    f"{state.time:.3g} s so far: lower Resolution.steps, or the window of SecondHit"
                )
            rows = np.empty(STEPS_PER_CALL, STEP)
            after = np.empty((STEPS_PER_CALL if store_states else 0, *start.shape))
            tables = _next_tables(propagator, state)
            after_steps = after.ctypes.data if store_states else None
            count = library().contact_steps(contact, tables, STEPS_PER_CALL, rows.ctypes.data, after_steps)
            records.append(rows[:count])
            states.append(after[:count])
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


def _next_tables(propagator: ModalPropagator, state: KernelState) -> StepTables:
    """The tables of the next step; one that ends at separation or touch has a length of its own."""
    if state.ends_at_event:
        return propagator.tables(state.next_step)
    return repeated_tables(propagator, state.next_step)


def _losses(model: ContactModel, state: KernelState, last: np.void) -> Losses:
    """Up to the last step in contact."""
    tangential = state.work[CONSTANTS["T"]] + state.work[CONSTANTS["P"]]
    shear = tangential if model.tip.slips_in_parts and model.never_slips else state.shear_loss
    return Losses(
        tip=model.tip.loss(state.max_indentation),
        friction=tangential - shear,
        shear=shear,
        table=sum(state.work[CONSTANTS["UP"] :]),
        damping=last["damping_loss"],
        radiated=last["radiated"],
    )


def _check_bounces(contact: SolvedContact, energy: dict[str, float]) -> None:
    """RuntimeError for a tip that bounces without an end, or faster than the steps; energy: of the outcome, J."""
    if not contact.bounces:
        return
    model, speed = contact.model, -contact.gap_velocity
    residual = abs(sum(energy.values()) / energy["initial"] - 2)
    if model.window is None and speed > 0:
        reason = f"the cue still moves towards the ball at {speed:.3g} m/s"
    elif residual > BOUNCE_RESIDUAL:
        reason = "the bounces are too fast for the steps"
    else:
        return
    raise RuntimeError(
        f"friction turns the tip away from the ball again and again: after {contact.time:.3g} s {reason}; take more "
        f"steps, or lower Tip.friction, {model.friction:g}, or the offset"
    )


def _failure(model: ContactModel, state: KernelState) -> Exception:
    """The exception for a contact that did not end."""
    if state.status == CONSTANTS["INDENTATION_OUT_OF_RANGE"]:
        assert isinstance(model.tip, LeatherLaw)
        return model.tip.out_of_range(state.indentation)
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
