"""ROSS (rotor dynamics): conical Timoshenko shaft elements, at rest, with the shear coefficient of the wood.

ROSS takes its coefficient from Poisson's ratio, here E/(2G) - 1 = 6.5, so the elements are given the cone's own. It
solves both planes, torsion and stretching at once (6 unknowns a node) as one unsymmetric first-order system, which is
more than was asked for; the bending frequencies are those that come in pairs. Its sparse solver takes longer and loses
modes of a free shaft.
"""

from __future__ import annotations

from functools import partial
from itertools import pairwise

import numpy as np
import ross

from studies.accuracy.peers.cone import CONE, MODES

VERSION = ross.__version__
WOOD = ross.Material(name="wood", rho=CONE.rho, E=CONE.E, G_s=CONE.G)


def shaft(elements: int) -> ross.Rotor:
    """The free cone."""
    diameters = 2 * CONE.radius(np.linspace(0, CONE.length, elements + 1))
    pieces = [
        ross.ShaftElement(L=CONE.length / elements, idl=0, odl=tip, idr=0, odr=butt, material=WOOD)
        for tip, butt in pairwise(diameters)
    ]
    for piece in pieces:
        piece.phi *= piece.kappa / CONE.kappa
        piece.kappa = CONE.kappa
    return ross.Rotor(pieces)


def modes(elements: int) -> np.ndarray:
    """f1 to f5, Hz."""
    found = np.sort(shaft(elements).run_modal(0, num_modes=40, sparse=False).wn) / (2 * np.pi)
    pairs = np.flatnonzero(np.diff(found) < 1e-5 * found[1:])
    return found[pairs[:MODES]]


CONTESTANTS = {"modes": {f"ROSS x {n}": partial(modes, n) for n in (10, 20, 40, 80)}, "end_mass": {}}
