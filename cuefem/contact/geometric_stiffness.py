"""The slopes that carry a cue's geometric stiffness during the contact.

With G the geometric stiffness of all modes (`TipModes.geometric`), the contact needs rows g_a over the modes with
q'Gq = sum of (g_a q)^2 for every modal displacement q: the eigenvectors of G relative to omega^3. All of them are the
whole of G; where they are too many, those of the largest part are retained.

Under the contact's forces the modal displacements fall like 1/omega, after a velocity step, to 1/omega^2, under slow
forces; omega^3 stands for the squares of displacements in between. Relative to omega^2, the buckling modes, the rows of
high modes would not end: their axial loads tend to the least kGA of the cue, as waves of shear in a soft ferrule.
"""

from __future__ import annotations

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.kernel.declarations import CONSTANTS
from cuefem.cue import Array

# Largest number of slopes of the compiled kernel, with the slope of the cue's end; a raised cue bends in two planes.
MAX_SLOPES = CONSTANTS["SLOPES"]
N_RIGID = 3
# Rows below this share of the largest are round-off error.
MIN_SHARE = 1e-14


class SlopeOutOfRange(ValueError):
    """The axial force bends the shaft beyond the range of the second-order theory."""


def slope_rows(tip: TipModes, planes: int = 1) -> Array:
    """Rows over the modes, (rows, n), 1/sqrt(m kg), and as the last one the tip's rotation, 1/(m sqrt(kg)).

    planes: in which the cue bends; together they have at most `MAX_SLOPES` rows. (0, n) without geometric stiffness.
    """
    if tip.geometric is None:
        return np.zeros((0, len(tip.omega)))
    # rigid-body modes, one axial and two of bending, have the stiffness of the lowest flexible mode of a free cue
    roots = np.hypot(tip.omega, np.sort(tip.omega)[N_RIGID]) ** 1.5
    bending = np.flatnonzero(tip.geometric.any(axis=1))  # a head-on stroke bends nothing: axial modes have exact zeros
    roots = roots[bending]
    shares, directions = np.linalg.eigh(tip.geometric[np.ix_(bending, bending)] / np.outer(roots, roots))
    retained = np.flatnonzero(shares > MIN_SHARE * shares[-1])[-(MAX_SLOPES // planes - 1) :][::-1]
    rows = np.zeros((len(retained), len(tip.omega)))
    rows[:, bending] = np.sqrt(shares[retained])[:, None] * directions[:, retained].T * roots
    return np.concatenate([rows, tip.rotation[None]])
