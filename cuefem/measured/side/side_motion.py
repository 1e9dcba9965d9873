"""Where beam and striker are at any time of a strike from the side, and after it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cuefem.beam.modes import Modes
from cuefem.contact.motion import Path, ascending
from cuefem.cue import Array
from cuefem.measured.side.side_scene import SideStrike
from cuefem.measured.side.side_strike import SideSolved, solved_side
from cuefem.quantity.fields import check_kind
from cuefem.scene import Resolution


@dataclass(frozen=True)
class SideMotion:
    """Beam and striker at given times of a strike from the side.

    Attributes
    ----------
    times : (n,) array
        Times from first touch, s.
    duration : float
        When the last contact ends, s.
    modes : Modes
        The bending modes of the beam.
    fields : (unknowns, n) array
        The beam's motion, in the unknowns of ``modes``; `deflection` reads it anywhere.
    striker : (n,) array
        Way of the striker in the direction of the strike, m.
    force : (n,) array
        Force between striker and beam, N.
    """

    times: Array
    duration: float
    modes: Modes
    fields: Array
    striker: Array
    force: Array

    def deflection(self, x: ArrayLike) -> tuple[Array, Array]:
        """Shape of the beam.

        Parameters
        ----------
        x : array_like
            Positions, m from the tip.

        Returns
        -------
        w, theta : arrays of shape (n, *x.shape)
            Deflection in the direction of the strike, m, and rotation, rad, at each time.
        """
        return self.modes.system.interpolate(self.fields, np.asarray(x, float))


def side_motion(scene: SideStrike, times: ArrayLike, at: Resolution | None = None) -> SideMotion:
    """Follow beam and striker through a strike from the side and after it.

    Parameters
    ----------
    scene : SideStrike
        What is there, and which effects act.
    times : array_like
        Ascending times, s from first touch, >= 0. After the contact both move freely.
    at : Resolution, optional
        As in `cuefem.side_strike`.

    Returns
    -------
    SideMotion

    Raises
    ------
    ValueError
        For times that do not ascend.

    Notes
    -----
    Between the contact's forces the modes turn exactly, so that the motion is as accurate as the strike at every time.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),))
    >>> scene = cf.SideStrike(shaft, cf.Striker(mass=0.005, restitution=0.8, contact_time=1e-3))
    >>> moved = cf.side_motion(scene, [0.0, 5e-4, 1e-3], cf.Resolution(2, 8, 6))
    >>> w, theta = moved.deflection([0.0, 0.35])
    >>> w.shape, bool(w[1, 0] > 0)
    ((3, 2), True)
    """
    check_kind("side_motion scene", scene, SideStrike)
    times = ascending(times)
    solved = SideSolved(scene, at)
    modes = solved.modes
    contact = solved_side(scene, solved.place)
    path = Path.of(contact, times)
    vectors = np.concatenate([modes.rigid_vectors, modes.vectors], axis=1)
    return SideMotion(
        times,
        contact.time,
        modes,
        fields=vectors @ path.modes,
        striker=-path.ball[:, 1],
        force=path.force[:, 1],
    )
