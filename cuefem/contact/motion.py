"""Where cue and ball are at any time of a strike and after it.

Every kind of contact gives its motion as stretches of time (`cuefem.contact.stretches`): linear courses, whose states
are exponentials, or phases that were stepped, which are read off the solver's interpolants. Positions of rigid motions
and of the ball are no part of the state: they are integrals of velocities, carried along.
Coordinates: u along the cue in the direction of the stroke and w across it, on the side that is struck at a positive
offset; their origin is the tip's centre at first touch.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cuefem.beam.modes import Modes
from cuefem.beam.tip import TipModes
from cuefem.contact.phases import Kind
from cuefem.contact.state import Contact
from cuefem.contact.strike import struck
from cuefem.cue import Array
from cuefem.quantity import check_kind, scalar
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
        Way of the tip along the cue, m. Waves in the shaft's length (`AxialWaves`) are in it; their shape along the
        shaft is not given.
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
    offset; the origin is the tip's centre at first touch. Between phases the state follows z' = A z, so that exp(A t)
    gives it without stepping error. Beside the strike, each time costs a matrix exponential.

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
    found, tip = solved.modes, solved.tip
    return _read(scene, found, tip, kind=struck(scene, tip), times=times)


def last_contact(scene: Scene, at: Resolution | None = None) -> float:
    """Time at which the last contact of a strike ends, s."""
    return motion(scene, [0.0], at).duration


def ascending(times: ArrayLike) -> Array:
    """Times as an array, (n,); ValueError unless they ascend from zero or later."""
    times = np.atleast_1d(np.asarray(times, float))
    if not (times.ndim == 1 and times.size and np.all(np.isfinite(times)) and np.all(np.diff(times, prepend=0) >= 0)):
        raise ValueError(f"motion takes ascending times in [0, inf) s; got {times}")
    return times


def _read(scene: Scene, found: Modes, tip: TipModes, *, kind: Kind, times: Array) -> Motion:
    phi, side = kind.contact.laws.phi, math.copysign(1.0, scalar("Stroke.offset", scene.stroke.offset))
    tangent, normal = np.array([math.sin(phi), math.cos(phi)]), np.array([math.cos(phi), -math.sin(phi)])
    q, ball = positions_of(kind, times)
    vectors, across = _bending(found, tip)
    R = scalar("Ball.radius", scene.ball.radius)
    aside, back = scene.contact_terms.lever(phi)  # where on the cue's end the contact lies
    centre = R * normal + [-back, aside] + ball.gone @ np.array([tangent, normal])
    s, c = np.sin(phi + ball.contact), np.cos(phi + ball.contact)
    F_t, F_n = forces_of(kind, times).T
    return Motion(
        times,
        kind.contact.time,
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


def positions_of(kind: Kind, times: Array) -> tuple[Array, _Ball]:
    """Coordinates of all tip modes (modes, n), and the ball's."""
    contact = kind.contact
    slots, quiet, size = contact.slots, contact.quiet, len(contact.z)
    states = np.array(list(_states(kind, _unstated(contact), times))).T
    vibrating = states[slots.vibration] / contact.omega[:, None]
    t, n_, rolled = states[-3:]
    angle = states[slots["angle"]] if "angle" in slots else np.zeros(len(times))
    return np.concatenate([states[size : size + quiet], vibrating]), _Ball(np.column_stack([t, n_]), rolled, angle)


def _unstated(contact: Contact) -> Array:
    """Rows that read velocities whose positions are no state: rigid modes, the ball's (t, n), its surface's; m/s."""
    quiet, M, nu = contact.quiet, contact.laws.ball_mass, contact.laws.inertia
    rows, (read, per) = np.zeros((quiet + 3, len(contact.z))), contact.readings
    rows[range(quiet), contact.slots.velocities.start + np.arange(quiet)] = 1.0
    rows[quiet:] = read[:3] / per[:3, None] / np.array([[M], [M], [nu * M]])
    return rows


def _states(kind: Kind, rows: Array, times: Array) -> Iterator[Array]:
    """States at ``times``, and below them the integrals over time of ``rows`` of them."""
    parts = kind.stretches()
    gone, size = np.zeros(len(rows)), len(kind.contact.z)
    for part, end in zip(parts, [*(later.start for later in parts[1:]), math.inf], strict=True):
        own = times[(times >= part.start) & (times < end)]
        last = [end] if end < math.inf else []
        for state in part.states(rows, np.append(own, last) - part.start):
            state[size:] += gone
            if len(own):
                own = own[1:]
                yield state
            else:
                gone = state[size:]


def forces_of(kind: Kind, times: Array) -> Array:
    """Force on the ball (t, n), where these have turned to, N, (n, 2): none after the contact, or in a blow alone."""
    force = np.zeros((len(times), 2))
    pressed = times <= kind.contact.time
    if pressed.any() and len(kind.stretches()) > 1:
        known = kind.history(1.0)(times[pressed])
        force[pressed] = np.column_stack([known["force_t"], known["force_n"]])
    return force
