"""Where cue and ball are at any time of a strike and after it: the state of the contact, course by course.

A contact is a chain of linear courses z' = A z (`cuefem.contact.linear`), so that between their starts exp(A t) gives
the state, and beside it the integrals of those velocities whose positions are no state (rigid motions and ball),
without stepping error; one that is stepped (`cuefem.contact.nonlinear`) is read off the solver's interpolants.
Coordinates: u along the cue in the direction of the stroke and w across it, on the side that is struck at a positive
offset; their origin is the tip's centre at first touch.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg as la
from numpy.typing import ArrayLike

from cuefem.beam.modes import Modes
from cuefem.beam.tip import TipModes
from cuefem.contact.history import Stretch
from cuefem.contact.linear import Contact, Course
from cuefem.contact.stepped import SteppedContact
from cuefem.contact.strike import struck
from cuefem.cue import Array
from cuefem.effects import Elevation
from cuefem.quantity import check_kind, scalar
from cuefem.scene import Resolution, Scene
from cuefem.tip_modes import Solved

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(8)  # exact for the interpolants of DOP853, of degree 7


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

    at: as in `strike`. ValueError for a lumped cue, and for a raised one (Elevation), which leaves the plane. Cost:
    that of the strike, and a matrix exponential of its unknowns for each time.
    """
    check_kind("motion scene", scene, Scene)
    times = _checked(times)
    if any(isinstance(effect, Elevation) for effect in scene.effects):
        raise ValueError("motion takes strokes in the plane of cue and ball; got Elevation")
    solved = Solved(scene, at)
    found, tip = solved.modes, solved.tip
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
    q, ball = _positions(contact, times)
    vectors, across = _bending(found, tip)
    R = scalar("Ball.radius", scene.ball.radius)
    r = scene.dome_radius
    centre = (r + R) * normal - [r, 0.0] + ball.gone @ np.array([tangent, normal])
    s, c = np.sin(phi + ball.contact), np.cos(phi + ball.contact)
    F_t, F_n = _forces(contact, times).T
    return Motion(
        times,
        contact.time,
        found,
        fields=side * vectors @ q[across],
        along=tip.amplitude[:, 0] @ q,
        centre=centre * [1.0, side],
        turned=-side * ball.rolled / R,
        force=np.column_stack([s * F_t + c * F_n, side * (c * F_t - s * F_n)]),
    )


def _bending(found: Modes, tip: TipModes) -> tuple[Array, Any]:
    """Vectors of the bending modes, (unknowns, k), and which of the tip modes they are."""
    vectors = np.concatenate([found.rigid_vectors, found.vectors], axis=1)
    columns = np.argsort(np.concatenate([np.zeros(found.rigid), found.omega]), kind="stable")
    across = np.flatnonzero(tip.amplitude[:, 0] == 0)
    return vectors[:, columns], across[np.argsort(tip.omega[across], kind="stable")]


class _Ball(NamedTuple):
    """Of a ball: its way (t, n), (n, 2), and that of its surface by its spin, (n,), m; the contact's angle on it."""

    gone: Array
    rolled: Array
    contact: Array


def _positions(contact: Contact, times: Array) -> tuple[Array, _Ball]:
    """Coordinates of all tip modes (modes, n), and the ball's."""
    n, quiet, size = contact.velocities.start, contact.quiet, len(contact.z)
    states = np.array(list(_states(contact, _unstated(contact), times))).T
    vibrating = states[:n] / contact.tip.omega[quiet:, None]
    t, n_, rolled = states[-3:]
    angle = states[contact.angle] if isinstance(contact, SteppedContact) else np.zeros(len(times))
    return np.concatenate([states[size : size + quiet], vibrating]), _Ball(np.column_stack([t, n_]), rolled, angle)


def _unstated(contact: Contact) -> Array:
    """Rows that read velocities whose positions are no state: rigid modes, the ball's (t, n), its surface's; m/s."""
    quiet, M, nu = contact.quiet, contact.laws.ball_mass, contact.laws.inertia
    rows = np.zeros((quiet + 3, len(contact.z)))
    rows[range(quiet), contact.velocities.start + np.arange(quiet)] = 1.0
    rows[quiet + 1, contact.ball_n] = M**-0.5
    if isinstance(contact, SteppedContact):  # whose ball turns by a state of its own
        rows[quiet, contact.ball_t], rows[quiet + 2, contact.spin] = M**-0.5, (nu * M) ** -0.5
    else:
        rows[quiet, contact.ball_t] = 1 / (M * contact.c_t[contact.ball_t])
        rows[quiet + 2] = rows[quiet] / nu
    return rows


def _states(contact: Contact, rows: Array, times: Array) -> Iterator[Array]:
    """States at ``times``, and below them the integrals over time of ``rows`` of them."""
    rate = max(contact.fastest, 1 / contact.laws.time)
    touching = contact.stretches if isinstance(contact, SteppedContact) else contact.courses
    parts: list[Course | Stretch] = [*touching, Course(contact.time, contact.free, rate, contact.z)]
    gone, size = np.zeros(len(rows)), len(contact.z)
    for part, end in zip(parts, [*(later.start for later in parts[1:]), math.inf], strict=True):
        own = times[(times >= part.start) & (times < end)]
        last = [end] if end < math.inf else []
        spans = np.append(own, last) - part.start
        for state in _walk(part, rows, spans) if isinstance(part, Course) else _read_off(part, rows, spans):
            state[size:] += gone
            if len(own):
                own = own[1:]
                yield state
            else:
                gone = state[size:]


def _walk(course: Course, rows: Array, spans: Array) -> Iterator[Array]:
    """States and integrals, from zero on, ``spans`` s after the start of a course, ascending."""
    size, scale = len(course.state), course.rate / float(np.linalg.norm(rows))
    A = np.zeros((size + len(rows),) * 2)
    A[:size, :size], A[size:, :size] = course.A, scale * rows  # the integrals change as fast as the rest
    z, before = np.concatenate([course.state, np.zeros(len(rows))]), 0.0
    taken, onward = 0.0, np.eye(len(A))
    for span in spans:
        if abs(span - before - taken) > 1e-13 * taken:  # even times are so but for rounding: one exponential will do
            taken = span - before
            onward = la.expm(A * taken)
        z, before = onward @ z, span
        state = z.copy()
        state[size:] /= scale
        yield state


def _read_off(part: Stretch, rows: Array, spans: Array) -> Iterator[Array]:
    """What `_walk` gives, of a stretch that was stepped."""
    solution: Any = part.solution
    steps = np.asarray(solution.ts) * part.clock - part.start
    before, gone = 0.0, np.zeros(len(rows))
    for span in spans:
        knots = np.unique([before, *steps[(steps > before) & (steps < span)], span])
        if len(knots) > 1:
            half = np.diff(knots)[:, None] / 2
            places = (part.start + knots[:-1, None] + half * (1 + _GAUSS)).ravel()
            gone = gone + rows @ solution(np.minimum(places, part.end) / part.clock) @ (half * _WEIGHTS).ravel()
        before = span
        yield np.concatenate([solution(min(part.start + span, part.end) / part.clock), gone])


def _forces(contact: Contact, times: Array) -> Array:
    """Force on the ball (t, n), where these have turned to, N, (n, 2): none after the contact."""
    force = np.zeros((len(times), 2))
    pressed = times <= contact.time
    if pressed.any() and (contact.pieces or isinstance(contact, SteppedContact)):
        known = contact.history(1.0)(times[pressed])
        force[pressed] = np.column_stack([known["force_t"], known["force_n"]])
    return force
