"""The contact model: tip, ports and modes of a scene, and from them the kernel's input."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.kernel.declarations import KernelInput
from cuefem.contact.modal_response import ModalPropagator
from cuefem.contact.ports import LevelPorts, Ports, ports_of
from cuefem.contact.tips import contact_time_of, default_steps, tip_fields, tip_of
from cuefem.cue import Array
from cuefem.effects.force_law import LeatherLaw, TipLaw
from cuefem.scene import Scene
from cuefem.scene.solved_scene import RESOLVED_RESTITUTION

INFINITE_FRICTION = 1e6  # stands for infinite friction: at 1e12 the forces of a last touch drown in round-off
BOUNCE_SPEED = 0.01  # of the ball along the normal, over the approach speed: a tip that leaves a slower one bounces
MAX_CONTACT_TIMES = 200  # longest contact, in head-on contact times; beyond it the strike raises an error


@dataclass(frozen=True, eq=False)
class ContactModel:
    """A contact of tip and ball.

    propagator: the cue's modes at the ports. ball: (n,), the ball's velocities at the first touch, m/s. ball_mass: kg.
    inertia: the factor of the ball's moment of inertia. radius: of the ball, m. speed: of the cue, m/s. time: head-on
    contact time, s. steps: default number in it. max_indentation: of leather in a head-on impact, m. window: time
    simulated after separation, s; None without double hits. side: struck side of the ball, 1 or -1; all other fields
    are those of the mirrored stroke, on side 1.
    """

    propagator: ModalPropagator
    ports: Ports
    tip: TipLaw | LeatherLaw
    ball: Array
    ball_mass: float
    inertia: float
    restitution: float
    friction: float
    speed: float
    time: float
    steps: int
    max_indentation: float = 0.0
    window: float | None = None
    side: float = 1.0
    radius: float = 1.0

    @property
    def phi(self) -> float:
        """Angle of the contact at the first touch, rad."""
        return self.ports.touch.phi

    @property
    def inverse_masses(self) -> Array:
        """Of the ball's velocities, (n,), 1/kg."""
        return self.ports.inverse_masses(self.ball_mass, self.inertia)

    @property
    def inverse_mass(self) -> Array:
        """Inverse mass of the contact at the first touch, (forces, forces), 1/kg."""
        ports = len(self.propagator.ports)
        cue, ball = self.ports.kinematics[:, :ports], self.ports.kinematics[:, ports:]
        mobility = self.propagator.mobility[:ports, :ports]
        return np.asarray(cue @ mobility @ cue.T + (ball * self.inverse_masses) @ ball.T)

    @property
    def approach(self) -> Array:
        """Velocities of the contact (t, n) at the first touch, m/s."""
        cue = self.propagator.ports @ self.propagator.tip.approach * self.speed
        return np.asarray(self.ports.kinematics @ np.concatenate([cue, self.ball]))[:2]

    @property
    def jams(self) -> bool:
        """Whether slip at the first touch increases the normal approach velocity (jam)."""
        B = self.inverse_mass
        return bool(B[1, 1] + self.friction * B[0, 1] < 0)

    @property
    def bounce_speed(self) -> float:
        """Speed of the ball along n, m/s: a separation that leaves a slower one is a bounce, by friction.

        None is slow enough at the centre of the ball, or on a table, which may stop it.
        """
        may_bounce = self.phi > 0 and isinstance(self.ports, LevelPorts)
        return BOUNCE_SPEED * abs(float(self.approach[1])) if may_bounce else -math.inf

    @property
    def never_slips(self) -> bool:
        """Whether friction is infinite."""
        return self.friction >= INFINITE_FRICTION

    def momentum(self, ball: Array) -> Array:
        """Momentum (t, n), N s, of the ball at velocities (..., speeds); above a table, its horizontal part."""
        return np.asarray(self.ball_mass * self.ports.horizontal(ball))

    @property
    def slope_weights(self) -> Array:
        """Weight of each slope in the tip's shortening; the last one of each plane is that of the cue's end."""
        per_plane = len(self.propagator.slopes) // self.ports.planes
        weights = np.append(np.ones(max(per_plane - 1, 0)), self.ports.touch.ahead)
        return np.tile(weights[:per_plane], self.ports.planes)

    @property
    def unknowns(self) -> int:
        """Number of state variables: modal displacements and velocities, the ball's, and the tip's."""
        omega = self.propagator.tip.omega
        return len(omega) + int(np.count_nonzero(omega)) + self.ports.unknowns + (not self.tip.is_rigid)

    def kernel_input(self, *, step: float) -> KernelInput:
        """The kernel's input; step: length of the steps, s."""
        return KernelInput(
            **self.propagator.fields,
            **self.ports.fields,
            **tip_fields(self.tip, self.max_indentation),
            forces=len(self.ports.kinematics),
            kinematics=self.ports.kinematics,
            planes=self.ports.planes,
            phi=self.phi,
            slope_weights=self.slope_weights,
            radius=self.radius,
            speeds=len(self.ball),
            inverse_masses=self.inverse_masses,
            restitution=self.restitution,
            friction=min(self.friction, INFINITE_FRICTION),
            begins_with_impact=self.never_slips and self.tip.is_rigid and self.phi > 0,
            step=step,
            unloading_step=step * min(1.0, self.restitution / RESOLVED_RESTITUTION),
            max_time=MAX_CONTACT_TIMES * self.time,
            window=self.window or 0.0,
            bounce_speed=self.bounce_speed,
            bounce_window=self.time,
        )


def model_of(scene: Scene, tip: TipModes) -> ContactModel:
    """The contact of a scene at an offset >= 0; a negative one is its mirror image.

    ValueError for effects that cannot act together, and for a restitution below its bound.
    """
    offset, ball, window = scene.stroke.offset, scene.ball, scene.contact_terms.window
    ports = ports_of(scene)
    return ContactModel(
        propagator=ports.propagator(tip if offset else tip.uncoupled),
        ports=ports,
        tip=tip_of(scene),
        ball=np.zeros_like(ports.inverse_masses(ball.mass, ball.inertia)),
        ball_mass=ball.mass,
        inertia=ball.inertia,
        restitution=scene.tip.restitution,
        friction=scene.tip.friction,
        speed=scene.stroke.speed,
        time=contact_time_of(scene),
        steps=default_steps(scene),
        max_indentation=0.0 if scene.contact_terms.tip is None else scene.max_indentation,
        window=window,
        side=math.copysign(1.0, offset),
        radius=ball.radius,
    )
