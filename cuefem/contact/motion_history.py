"""Motion of cue and ball at any time of a strike and after it.

The states at the ends of the steps determine the motion in between by cubic polynomials.
Coordinates: u axial in the direction of the stroke and w lateral, positive on the side that is struck at a positive
offset; their origin is the tip's centre at first touch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicHermiteSpline
from scipy.linalg import expm

from cuefem.beam.modes import Modes
from cuefem.beam.tip_modes import TipModes
from cuefem.contact.contact_model import model_of
from cuefem.contact.coupled_modes import CoupledModes
from cuefem.contact.step_records import SolvedContact, solve_contact
from cuefem.contact.strike import steps_of
from cuefem.cue import Array
from cuefem.quantity.equality import equal_fields
from cuefem.scene import Resolution, Scene, check_scene
from cuefem.scene.solved_scene import SolvedScene


@dataclass(frozen=True, eq=False)
class Motion:
    """Cue and ball at given times of a strike.

    Attributes
    ----------
    times : (n,) array
        Times from first touch, s.
    duration : float
        End of the last contact, s.
    modes : Modes
        The bending modes of the cue.
    fields : (free, n) array
        The beam's motion, in the degrees of freedom of ``modes``; `deflection` interpolates it.
    axial : (n,) array
        Axial displacement of the tip, m, with axial waves (`AxialWaves`) and the shortening of the bent shaft
        (`GeometricStiffness`); neither is resolved along the shaft.
    centre : (n, 2) array
        The ball's centre (u, w), m.
    rotation : (n,) array
        Rotation of the ball about u x w, rad.
    force : (n, 2) array
        Force on the ball (u, w), N; zero for an impact of infinite friction.
    """

    times: Array
    duration: float
    modes: Modes
    fields: Array
    axial: Array
    centre: Array
    rotation: Array
    force: Array

    __eq__ = equal_fields

    def __repr__(self) -> str:
        return f"Motion({len(self.times)} times to {self.times[-1]:.4g} s, duration={self.duration:.4g} s)"

    def deflection(self, x: ArrayLike) -> tuple[Array, Array]:
        """Shape of the cue.

        Parameters
        ----------
        x : array_like
            Positions, m from the tip.

        Returns
        -------
        w, theta : arrays of shape ``(n, *x.shape)``
            Deflection, m, and rotation, rad, at each time.
        """
        return self.modes.system.interpolate(self.fields, np.asarray(x, float))


def motion(scene: Scene, times: ArrayLike, at: Resolution | None = None) -> Motion:
    """Compute the motion of cue and ball during a strike and after it.

    Parameters
    ----------
    scene : Scene
        A level stroke of a cue of segments.
    times : array_like
        Ascending times, s from first touch, >= 0. After the contact cue and ball fly freely.
    at : Resolution, optional
        As in `strike`.

    Returns
    -------
    Motion

    Raises
    ------
    ValueError
        For a lumped cue, which has no shape; for a raised cue (`Elevation`), whose motion is not planar; for times that
        do not ascend.

    Notes
    -----
    u is axial in the direction of the stroke and w lateral, positive on the side that is struck at a positive offset;
    the origin is the tip's centre at first touch. Between the steps' ends the modes move by cubic polynomials.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.74, 0.012, 0.0215, wood),), body_mass=0.42)
    >>> moved = cf.motion(cf.Scene(cue, stroke=cf.Stroke(offset=0.3)), [0.0, 1e-3], cf.Resolution(2, 8, 6))
    >>> moved.centre.shape
    (2, 2)
    >>> bool(moved.axial[1] > moved.axial[0])
    True
    """
    check_scene("motion scene", scene)
    times = ascending(times)
    if scene.contact_terms.table is not None:
        raise ValueError("motion takes strokes in the plane of cue and ball; got Elevation")
    design = SolvedScene(scene, at)
    bending, tip = design.modes, design.tip
    contact = solve_contact(model_of(scene, tip), steps=steps_of(at), store_states=True)
    return _motion_of(scene, bending, tip, contact=contact, times=times)


def ascending(times: ArrayLike) -> Array:
    """Times as an array, (n,); ValueError unless they ascend from zero or later."""
    times = np.atleast_1d(np.asarray(times, float))
    if not (times.ndim == 1 and times.size and np.all(np.isfinite(times)) and np.all(np.diff(times, prepend=0) >= 0)):
        raise ValueError(f"motion takes ascending times in [0, inf) s; got {times}")
    return times


def _motion_of(scene: Scene, bending: Modes, tip: TipModes, *, contact: SolvedContact, times: Array) -> Motion:
    phi, side = contact.model.phi, math.copysign(1.0, scene.stroke.offset)
    tangent, normal = np.array([math.sin(phi), math.cos(phi)]), np.array([math.cos(phi), -math.sin(phi)])
    modes, ball = _path(contact, times)
    vectors, lateral = _bending(bending, tip)
    R, in_contact = scene.ball.radius, contact.steps["length"] > 0
    u, w = scene.contact_terms.moment_arm(phi)  # of the contact per unit rotation of the end: it lies at (-w, u)
    centre = R * normal + [-w, u] + ball[:, :2] @ np.array([tangent, normal])
    angle = phi + np.interp(times, np.append(0.0, contact.steps["time"]), np.append(0.0, contact.steps["angle"]))
    s, c, force = np.sin(angle), np.cos(angle), np.zeros((2, len(times)))
    if in_contact.any():
        history = contact.history(np.minimum(times, contact.time))
        force = np.where(times < contact.time, [side * history["force_t"], history["force_n"]], 0.0)
    F_t, F_n = force
    shortening = 0.0 if tip.geometric is None else np.einsum("it,ij,jt->t", modes, tip.geometric, modes) / 2
    return Motion(
        times,
        contact.time,
        bending,
        fields=side * vectors @ modes[lateral],
        axial=tip.amplitude[:, 0] @ modes - shortening,
        centre=centre * [1.0, side],
        rotation=-side * ball[:, 2] / R,
        force=np.column_stack([s * F_t + c * F_n, side * (c * F_t - s * F_n)]),
    )


def _bending(bending: Modes, tip: TipModes) -> tuple[Array, Any]:
    """Vectors of the bending modes, (free, k), and their indices among the tip modes."""
    vectors = np.concatenate([bending.rigid_vectors, bending.vectors], axis=1)
    columns = np.argsort(np.concatenate([np.zeros(bending.rigid), bending.omega]), kind="stable")
    lateral = np.flatnonzero(tip.amplitude[:, 0] == 0)
    return vectors[:, columns], lateral[np.argsort(tip.omega[lateral], kind="stable")]


def _path(contact: SolvedContact, times: Array) -> tuple[Array, Array]:
    """Displacements of the modes, (modes, times), and of the ball along each of its velocities, m, (times, n).

    Within a step cubic polynomials of time, by positions and velocities at its ends; after the contact free motion.
    """
    assert contact.states is not None
    tip, states, lengths = contact.model.propagator.tip, contact.states, contact.steps["length"]
    ends, rigid = np.append(0.0, contact.steps["time"]), tip.omega == 0
    velocities = states[:, 0]
    travelled = np.cumsum(lengths[:, None] * (velocities[:-1] + velocities[1:]) / 2, axis=0)
    positions = states[:, 1] / np.where(rigid, 1.0, tip.omega)
    positions[1:, rigid] = travelled[:, rigid]
    step = np.searchsorted(ends, times, side="right") - 1  # the step of each time; after the last, free motion
    flight, t = step == len(lengths), times - ends[step]
    moved, travel = _free_flight(tip, states[-1], t[flight])
    path = np.empty((len(times), len(rigid)))
    path[flight] = np.where(rigid, positions[-1] + travel, moved[:, 1] / np.where(rigid, 1.0, tip.omega))
    for i in np.flatnonzero(~flight):
        span = slice(step[i], step[i] + 2)
        path[i] = CubicHermiteSpline(ends[span], positions[span], velocities[span])(times[i])
    return path.T, _ball_path(contact, step, t)


def _free_flight(tip: TipModes, state: Array, times: Array) -> tuple[Array, Array]:
    """States of free modes after ascending times, s, (k, 2, n), and their integrals of v, (k, n)."""
    n = len(tip.omega)
    system = np.pad(CoupledModes(tip.omega, tip.damping).system[: 2 * n, : 2 * n], (0, n))
    system[2 * n :, :n] = np.eye(n)
    x = np.append(state, np.zeros(n))
    path = []
    for interval in np.diff(times, prepend=0.0):
        x = expm(system * interval) @ x
        path.append(x)
    result = np.reshape(path, (len(times), 3, n))
    return result[:, :2], result[:, 2]


def _ball_path(contact: SolvedContact, step: NDArray[np.intp], t: Array) -> Array:
    """Displacements of the ball along each of its velocities, m, (k, n), at times t after the start of each step."""
    steps, model = contact.steps, contact.model
    lengths, t = np.append(steps["length"], 0.0)[:, None], t[:, None]
    velocities = np.vstack([model.ball, steps["ball"][:, : len(model.ball)]])
    after = np.vstack([velocities[1:], velocities[-1:]])
    accelerations = (after - velocities) / np.where(lengths > 0, lengths, 1.0) * (lengths > 0)
    path = np.vstack([0 * velocities[:1], np.cumsum(lengths * (velocities + after) / 2, axis=0)[:-1]])
    return np.asarray(path[step] + t * (velocities[step] + t * accelerations[step] / 2))
