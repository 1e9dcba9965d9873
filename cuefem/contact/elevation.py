"""The contact of a raised cue, in three dimensions, with the table under the ball (the effect Elevation).

The cue's axis u points down by the elevation a. w points to the right of it, level; n and t lie in the plane of u and w
as in `cuefem.contact.state` (phi > 0: the ball is struck on its right), and p = t x n stands on that plane, upwards.
Vectors are written in (t, n, p):

    u = (s, c, 0), w = (c, -s, 0), up z = cos(a) p - sin(a) u, forward f = cos(a) u + sin(a) p.

With V the ball's velocity and G its spin times R, a force F at the contact, -R n from its centre, and a force N z + f
at its lowest point, -R z, do

    M V' = F + N z + f,    nu M G' = (-F_p, 0, F_t) - z x f,

so that the surface moves at V + (G_p, 0, -G_t) at the tip and at V - G x z at the table. Every force acts through the
row c that reads the velocity it works on. The tip slips against its force, in two directions, or sticks; the ball is
pressed to the table (V . z = 0, N >= 0), where its lowest point slides or is held, or is lifted off it. In each phase
the forces solve a small linear system.
"""

from __future__ import annotations

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.raised import Raised
from cuefem.contact.state import Laws
from cuefem.cue import Array
from cuefem.effects.law import NormalLaw
from cuefem.effects.terms import Table


def in_both_planes(tip: TipModes) -> tuple[TipModes, Array]:
    """The tip modes, each bending mode repeated in the perpendicular plane, and every mode's displacement along p."""
    again = np.flatnonzero(tip.amplitude[:, 1] != 0)
    count, more = len(tip.omega), len(again)
    omega = np.concatenate([tip.omega, tip.omega[again]])
    order = np.argsort(omega, kind="stable")

    def both(matrix: Array | None) -> Array | None:
        if matrix is None:
            return None
        whole = np.zeros((count + more, count + more))
        whole[:count, :count], whole[count:, count:] = matrix, matrix[np.ix_(again, again)]
        return whole[np.ix_(order, order)]

    both_modes = TipModes(
        omega[order],
        np.concatenate([tip.amplitude, np.zeros((more, 2))])[order],
        np.concatenate([tip.approach, np.zeros(more)])[order],
        np.concatenate([tip.rotation, np.zeros(more)])[order],
        both(tip.damping),
        both(tip.radiation),
    )
    return both_modes, np.concatenate([np.zeros(count), tip.amplitude[again, 1]])[order]


def raised_contact(table: Table, tip: TipModes, laws: Laws, *, law: NormalLaw, clock: float, radius: float) -> Raised:
    """The contact of a raised cue; ValueError for a dead tip, whose contact has no such phases."""
    if laws.restitution == 0:
        raise ValueError("Elevation takes a Tip.restitution in (0, 1]; got 0.0")
    modes, across = in_both_planes(tip)
    return Raised(modes, laws, law=law, clock=clock, table=table, across=across, radius=radius)
