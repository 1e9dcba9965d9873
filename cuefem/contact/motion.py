"""Where cue and ball are at any time of a strike and after it.

The modes turn exactly between the contact's forces, so the motion follows from the loads of the steps that were taken.
Positions of rigid motions and of the ball are integrals of velocities, carried along.
Coordinates: u along the cue in the direction of the stroke and w across it, on the side that is struck at a positive
offset; their origin is the tip's centre at first touch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cuefem.beam.modes import Modes
from cuefem.beam.tip import TipModes
from cuefem.contact.laws import model_of
from cuefem.contact.propagator import Complex
from cuefem.contact.rule import FORCE_WAVES, GAUSS, WEIGHTS, sums_to, values_at, waves_over
from cuefem.contact.solve import SolvedContact, solve_contact
from cuefem.cue import Array
from cuefem.quantity.fields import check_kind, scalar
from cuefem.scene import Resolution, Scene
from cuefem.tip_modes import Solved


@dataclass(frozen=True)
class Motion:
    """Cue and ball at given times of a strike.

    Attributes
    ----------
    times : (n,) array
        Times from first touch, s.
    duration : float
        When the last contact ends, s.
    modes : Modes
        The bending modes of the cue.
    fields : (unknowns, n) array
        The beam's motion, in the unknowns of ``modes``; `deflection` reads it anywhere.
    along : (n,) array
        Way of the tip along the cue, m. Waves in the shaft's length (`AxialWaves`) are in it, and what a bent shaft is
        shorter by (`GeometricStiffness`); their shape along the shaft is not given.
    centre : (n, 2) array
        The ball's centre (u, w), m.
    turned : (n,) array
        Angle that the ball has turned through about u x w, rad.
    force : (n, 2) array
        Force on the ball (u, w), N; zero where endless friction gives a blow.
    """

    times: Array
    duration: float
    modes: Modes
    fields: Array
    along: Array
    centre: Array
    turned: Array
    force: Array

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
        w, theta : arrays of shape (n, *x.shape)
            Deflection, m, and rotation, rad, at each time.
        """
        return self.modes.system.interpolate(self.fields, np.asarray(x, float))


def motion(scene: Scene, times: ArrayLike, at: Resolution | None = None) -> Motion:
    """Follow cue and ball through a strike and after it.

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
        For a lumped cue, which has no shape; for a raised one (`Elevation`), which leaves the plane; for times that do
        not ascend.

    Notes
    -----
    u points along the cue in the direction of the stroke and w across it, to the side that is struck at a positive
    offset; the origin is the tip's centre at first touch. Between the contact's forces the modes turn exactly, so that
    the motion is as accurate as the strike at every time.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.74, 0.012, 0.0215, wood),), body_mass=0.42)
    >>> moved = cf.motion(cf.Scene(cue, stroke=cf.Stroke(offset=0.3)), [0.0, 1e-3], cf.Resolution(2, 8, 6))
    >>> moved.centre.shape
    (2, 2)
    >>> bool(moved.along[1] > moved.along[0])
    True
    """
    check_kind("motion scene", scene, Scene)
    times = ascending(times)
    if scene.contact_terms.table is not None:
        raise ValueError("motion takes strokes in the plane of cue and ball; got Elevation")
    solved = Solved(scene, at)
    bending, tip = solved.modes, solved.tip
    return _read(scene, bending, tip, solved=solve_contact(model_of(scene, tip)), times=times)


def last_contact(scene: Scene, at: Resolution | None = None) -> float:
    """Time at which the last contact of a strike ends, s."""
    return motion(scene, [0.0], at).duration


def ascending(times: ArrayLike) -> Array:
    """Times as an array, (n,); ValueError unless they ascend from zero or later."""
    times = np.atleast_1d(np.asarray(times, float))
    if not (times.ndim == 1 and times.size and np.all(np.isfinite(times)) and np.all(np.diff(times, prepend=0) >= 0)):
        raise ValueError(f"motion takes ascending times in [0, inf) s; got {times}")
    return times


def _read(scene: Scene, bending: Modes, tip: TipModes, *, solved: SolvedContact, times: Array) -> Motion:
    phi, side = solved.model.phi, math.copysign(1.0, scalar("Stroke.offset", scene.stroke.offset))
    tangent, normal = np.array([math.sin(phi), math.cos(phi)]), np.array([math.cos(phi), -math.sin(phi)])
    path = Path.of(solved, times)
    vectors, across = _bending(bending, tip)
    R = scalar("Ball.radius", scene.ball.radius)
    aside, back = scene.contact_terms.lever(phi)  # where on the cue's end the contact lies
    centre = R * normal + [-back, aside] + path.ball[:, :2] @ np.array([tangent, normal])
    s, c = np.sin(phi + path.angle), np.cos(phi + path.angle)
    F_t, F_n = path.force.T
    return Motion(
        times,
        solved.time,
        bending,
        fields=side * vectors @ path.modes[across],
        along=tip.amplitude[:, 0] @ path.modes - _shortened(tip, path.modes),
        centre=centre * [1.0, side],
        turned=-side * path.ball[:, 2] / R,
        force=np.column_stack([s * F_t + c * F_n, side * (c * F_t - s * F_n)]),
    )


def _shortened(tip: TipModes, modes: Array) -> Array | float:
    """By how much a bent cue is shorter, m, at each time (`GeometricStiffness`)."""
    return 0.0 if tip.geometric is None else np.einsum("it,ij,jt->t", modes, tip.geometric, modes) / 2


def _bending(bending: Modes, tip: TipModes) -> tuple[Array, Any]:
    """Vectors of the bending modes, (unknowns, k), and which of the tip modes they are."""
    vectors = np.concatenate([bending.rigid_vectors, bending.vectors], axis=1)
    columns = np.argsort(np.concatenate([np.zeros(bending.rigid), bending.omega]), kind="stable")
    across = np.flatnonzero(tip.amplitude[:, 0] == 0)
    return vectors[:, columns], across[np.argsort(tip.omega[across], kind="stable")]


class Path(NamedTuple):
    """Where the modes of a cue and the ball are at given times of a contact and after it.

    modes: (modes, times), the modes' displacements. ball: (times, speeds), the way of the ball along each of its
    velocities, m. angle: (times,), by which the contact has turned, rad. force: (times, 2), on the ball (t, n), N.
    """

    modes: Array
    ball: Array
    angle: Array
    force: Array

    @classmethod
    def of(cls, solved: SolvedContact, times: Array) -> Path:
        """Follow the steps of a contact once more, from load to load; times: ascending, s."""
        course, propagator = solved.course, solved.model.propagator
        speeds, walk = len(solved.ball), _Walk(solved)
        modes, ball = np.zeros((len(propagator.omega), len(times))), np.zeros((len(times), speeds))
        angle, force = np.zeros(len(times)), np.zeros((len(times), 2))
        ends = np.append(course.start[1:], solved.time)
        bounds = np.append(np.searchsorted(times, course.start), np.searchsorted(times, solved.time, side="right"))
        for i in range(len(course.start)):
            walk.blow(course.blows[i])
            first, last = bounds[i], bounds[i + 1]
            here, span = np.append(times[first:last], ends[i]) - course.start[i], course.step[i]
            parts = np.minimum(here / span, course.part[i])
            xi, gone, way = walk.follow(here, parts, course.loads[i], span)
            if last > first:
                modes[:, first:last] = walk.displacements(xi[:-1], gone[:-1]).T
                ball[first:last] = way[:-1]
                values = values_at(parts[:-1])
                angle[first:last] = values @ course.angle[i]
                if course.pressed[i]:
                    force[first:last] = values @ course.force[i, :2].T
            walk.go_on(xi[-1], gone[-1], way[-1], course.loads[i], parts[-1], span)
        late = np.flatnonzero(times > solved.time) if len(course.start) else np.arange(len(times))
        if len(late):
            if not len(course.start):  # a blow that threw the two apart
                walk.end(solved)
            xi, gone, way = walk.fly(times[late] - solved.time)
            modes[:, late], ball[late] = walk.displacements(xi, gone).T, way
            angle[late] = course.angle[-1] @ values_at(course.part[-1]) if len(course.start) else 0.0
        return cls(modes, ball, angle, force)


class _Walk:
    """The state of cue and ball on the way through the steps: coordinates, ways of the rigid modes and of the ball."""

    def __init__(self, solved: SolvedContact) -> None:
        self.propagator, self.gives = solved.model.propagator, solved.model.ball_gives
        self.xi, self.rigid = solved.xi_before.copy(), self.propagator.omega == 0
        self.ball, self.way = np.array(solved.model.ball, float), np.zeros(len(solved.ball))
        self.gone = np.zeros(int(self.rigid.sum()))
        self.ports = len(self.propagator.pushed)
        self.drives = self.propagator.onto @ self.propagator.pushed.T

    def blow(self, impulses: Array) -> None:
        """What blows on the ports do at once."""
        if impulses.any():
            self.xi = self.xi + self.drives @ impulses[: self.ports]
            self.ball = self.ball + self.gives * impulses[self.ports :]

    def displacements(self, xi: Complex, gone: Array) -> Array:
        """Of all modes, (times, modes), from the coordinates and the ways of the rigid ones."""
        omega = self.propagator.omega
        displaced = (xi @ self.propagator.displacements.T).real / np.where(self.rigid, 1.0, omega)
        displaced[:, self.rigid] = gone
        return np.asarray(displaced)

    def follow(self, here: Array, parts: Array, loads: Array, span: float) -> tuple[Complex, Array, Array]:
        """Coordinates, ways of the rigid modes and of the ball at times from the start of a step under its loads."""
        inner = parts[:, None] * GAUSS  # of each time, the points of an integral up to it
        every = np.concatenate([inner.ravel(), parts])
        waves = np.array([loads[: self.ports] @ waves_over(part).T for part in every])
        xi = self.propagator.follow(self.xi, span * every, waves)
        between, at = xi[: inner.size].reshape(*inner.shape, -1), xi[inner.size :]
        speeds = (between @ self.propagator.velocities[self.rigid].T).real
        gone = self.gone + span * parts[:, None] * np.einsum("q,tqr->tr", WEIGHTS, speeds)
        pushed = np.array([sums_to(part, FORCE_WAVES) for part in inner.ravel()]) @ loads[self.ports :].T
        moving = self.ball + span * self.gives * pushed.reshape(*inner.shape, -1)
        return at, gone, self.way + span * parts[:, None] * np.einsum("q,tqb->tb", WEIGHTS, moving)

    def go_on(self, xi: Complex, gone: Array, way: Array, loads: Array, part: float, span: float) -> None:
        """To the end of a step."""
        self.xi, self.gone, self.way = xi, gone, way
        self.ball = self.ball + span * self.gives * (loads[self.ports :] @ sums_to(part, FORCE_WAVES))

    def end(self, solved: SolvedContact) -> None:
        """To the end of a contact without steps."""
        self.xi, self.ball = solved.xi, solved.ball

    def fly(self, here: Array) -> tuple[Complex, Array, Array]:
        """The same without loads, at any time: a coordinate's integral is known in closed form."""
        xi, rates = self.propagator.follow(self.xi, here), self.propagator.rates
        turned = np.multiply.outer(here, rates)
        still = turned == 0
        mean = np.where(still, 1.0, np.expm1(turned) / np.where(still, 1.0, turned))
        summed = self.xi * here[:, None] * mean
        gone = self.gone + (summed @ self.propagator.velocities[self.rigid].T).real
        return xi, gone, self.way + here[:, None] * self.ball
