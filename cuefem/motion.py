"""Where cue and ball are at any time of a strike and after it: the state of the contact, course by course.

A contact is a chain of linear courses z' = A z (`cuefem.contact`), so that between their starts exp(A t) gives the
state, and beside it the integrals of those velocities whose positions are no state (rigid motions and ball), without
stepping error. Coordinates: u along the cue in the direction of the stroke and w across it, on the side that is struck
at a positive offset; their origin is the tip's centre at first touch.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg as la
from numpy.typing import ArrayLike

from cuefem.contact import Contact, Course
from cuefem.cue import Array, Cue
from cuefem.effects import Elevation, PowerLawTip, RollingContact, TipDome
from cuefem.modes import Modes, TipModes
from cuefem.quantity import check_kind, scalar
from cuefem.resolution import modes_of, tip_modes_from
from cuefem.scene import Resolution, Scene
from cuefem.strike import struck

_STEPPED = (Elevation, PowerLawTip, RollingContact)


@dataclass(frozen=True)
class Motion:
    """Cue and ball at ``times`` s, (n,), of a strike whose (last) contact ends at ``duration`` s.

    fields: (unknowns, n), the beam's motion in the unknowns of ``modes``. along: (n,) m, the tip's along the cue; waves
    in the shaft's length (AxialWaves) are in it, but not along the shaft. centre: (n, 2) m, the ball's centre (u, w).
    turned: (n,) rad, the ball's angle about u x w. force: (n, 2) N, on the ball, (u, w); none where endless friction
    gives a blow.
    """

    times: Array
    duration: float
    modes: Modes
    fields: Array
    along: Array
    centre: Array
    turned: Array
    force: Array

    def deflection(self, x: ArrayLike) -> tuple[Array, Array]:
        """Deflection w, m, and rotation theta, rad, at ``x`` m from the tip: two arrays (n, *x.shape)."""
        return self.modes.system.interpolate(self.fields, np.asarray(x, float))


def motion(scene: Scene, times: ArrayLike, at: Resolution | None = None) -> Motion:
    """Motion of a scene's strike at ``times``, s from first touch, ascending, >= 0; after the contact all fly free.

    at: as in `strike`. ValueError for a lumped cue, and for effects whose contact is stepped (PowerLawTip,
    RollingContact, Elevation). Cost: that of the strike, and a matrix
    exponential of its unknowns for each time.
    """
    check_kind("motion scene", scene, Scene)
    times = _checked(times)
    for effect in scene.effects:
        if isinstance(effect, _STEPPED):
            raise ValueError(f"motion takes effects whose contact is linear; got {type(effect).__name__}")
    if not isinstance(scene.cue, Cue):
        raise ValueError("motion takes a cue of segments; got a lumped cue, which has no shape")
    found = modes_of(scene, at)
    tip = tip_modes_from(found, scene)
    contact = struck(scene, tip)
    return _read(scene, found, tip, contact=contact, times=times)


def last_contact(scene: Scene, at: Resolution | None = None) -> float:
    """When a strike's last contact ends, s."""
    return motion(scene, [0.0], at).duration


def _checked(times: ArrayLike) -> Array:
    times = np.atleast_1d(np.asarray(times, float))
    if not (times.ndim == 1 and times.size and np.all(np.isfinite(times)) and np.all(np.diff(times, prepend=0) >= 0)):
        raise ValueError(f"motion takes ascending times in [0, inf) s; got {times}")
    return times


def _read(scene: Scene, found: Modes, tip: TipModes, *, contact: Contact, times: Array) -> Motion:
    phi, side = contact.laws.phi, math.copysign(1.0, scalar("Stroke.offset", scene.stroke.offset))
    tangent, normal = np.array([math.sin(phi), math.cos(phi)]), np.array([math.cos(phi), -math.sin(phi)])
    q, ball_t, ball_n = _positions(contact, times)
    vectors, across = _bending(found, tip)
    nu, R = scalar("Ball.inertia", scene.ball.inertia), scalar("Ball.radius", scene.ball.radius)
    dome = sum(effect.radius for effect in scene.effects if isinstance(effect, TipDome))
    start = (dome + R) * normal - [dome, 0.0]
    return Motion(
        times,
        contact.time,
        found,
        fields=side * vectors @ q[across],
        along=tip.amplitude[:, 0] @ q,
        centre=(start + np.outer(ball_t, tangent) + np.outer(ball_n, normal)) * [1.0, side],
        turned=-side * ball_t / (nu * R),
        force=_forces(contact, times) @ np.array([tangent, normal]) * [1.0, side],
    )


def _bending(found: Modes, tip: TipModes) -> tuple[Array, Any]:
    """Vectors of the bending modes, (unknowns, k), and which of the tip modes they are."""
    vectors = np.concatenate([found.rigid_vectors, found.vectors], axis=1)
    columns = np.argsort(np.concatenate([np.zeros(found.rigid), found.omega]), kind="stable")
    across = np.flatnonzero(tip.amplitude[:, 0] == 0)
    return vectors[:, columns], across[np.argsort(tip.omega[across], kind="stable")]


def _positions(contact: Contact, times: Array) -> tuple[Array, Array, Array]:
    """Coordinates of all tip modes (modes, n), and the way of the ball along t and n, m, (n,) each."""
    n, quiet, size = contact.velocities.start, contact.quiet, len(contact.z)
    rows = np.zeros((quiet + 2, size))  # velocities whose positions are no state
    rows[range(quiet), n + np.arange(quiet)] = 1.0
    M = contact.laws.ball_mass
    rows[quiet, contact.ball_t] = 1 / (M * contact.c_t[contact.ball_t])
    rows[quiet + 1, contact.ball_n] = 1 / (M * contact.c_n[contact.ball_n])
    states = np.array(list(_states(contact, rows, times))).T
    vibrating = states[:n] / contact.tip.omega[quiet:, None]
    return np.concatenate([states[size : size + quiet], vibrating]), states[-2], states[-1]


def _states(contact: Contact, rows: Array, times: Array) -> Iterator[Array]:
    """States at ``times``, and below them the integrals over time of ``rows`` of them."""
    rate = max(contact.fastest, 1 / contact.laws.time)
    courses = [*contact.courses, Course(contact.time, contact.free, rate, contact.z)]
    gone, size = np.zeros(len(rows)), len(contact.z)
    for course, end in zip(courses, [*(later.start for later in courses[1:]), math.inf], strict=True):
        own = times[(times >= course.start) & (times < end)]
        last = [end] if end < math.inf else []
        for state in _walk(course, rows, np.append(own, last) - course.start):
            state[size:] += gone
            if len(own):
                own = own[1:]
                yield state
            else:
                gone = state[size:]


def _walk(course: Course, rows: Array, spans: Iterable[float]) -> Iterator[Array]:
    """States and integrals, from zero on, ``spans`` s after the start of a course, ascending."""
    size, scale = len(course.state), course.rate / float(np.linalg.norm(rows))
    A = np.zeros((size + len(rows),) * 2)
    A[:size, :size], A[size:, :size] = course.A, scale * rows  # the integrals change as fast as the rest
    z, before = np.concatenate([course.state, np.zeros(len(rows))]), 0.0
    for span in spans:
        z, before = la.expm(A * (span - before)) @ z, span
        state = z.copy()
        state[size:] /= scale
        yield state


def _forces(contact: Contact, times: Array) -> Array:
    """Force on the ball (t, n), N, (n, 2): none before the first and after the last piece of the contact."""
    force = np.zeros((len(times), 2))
    pressed = times <= contact.time
    if contact.pieces and pressed.any():
        known = contact.history(1.0)(times[pressed])
        force[pressed] = np.column_stack([known["force_t"], known["force_n"]])
    return force
