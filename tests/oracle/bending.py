"""An independent beam: scikit-fem's matrices of the weak forms, with all its modes and their damping; no tests."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray

from cuefem import Cue, Effect, Material, StructuralDamping
from cuefem.beam import weak_forms

Array = NDArray[np.float64]
ORDER, MAX_LENGTH = 7, 0.06  # of an element; m
SHIFT = 4e4  # rad2/s2, about the lowest squared angular frequency of a cue


@dataclass(frozen=True)
class Bending:
    """Modes of a beam: angular frequency, rad/s, deflection and rotation of the tip, and the damping matrix, 1/s."""

    omega: Array
    deflection: Array
    rotation: Array
    damping: Array


def stiffened(cue: Cue, loss: float | None) -> Cue:
    """The cue with moduli larger by their loss factors: what its stiffness gains dissipates."""

    def material(m: Material | None) -> Material | None:
        factor = 1 + (m.loss if loss is None else loss) if m else 1.0
        return m and replace(m, E=m.E * factor, G=m.G * factor)

    segments = (replace(s, material=material(s.material), core=material(s.core)) for s in cue.segments)
    return replace(cue, segments=tuple(segments))


def bending(cue: Cue, effects: tuple[Effect, ...], count: int) -> Bending:
    """The lowest ``count`` modes, rigid ones included, with the effects on the cue."""
    positions = (effect.position for effect in effects if hasattr(effect, "position"))
    ends = np.union1d(cue.nodes, [x for x in positions if np.abs(cue.nodes - x).min() > 1e-9])
    pieces = [np.linspace(a, b, math.ceil((b - a) / MAX_LENGTH), endpoint=False) for a, b in pairwise(ends)]
    nodes = np.concatenate([*pieces, ends[-1:]])
    beam = weak_forms.assemble(cue, nodes, order=ORDER, effects=effects)
    K, M, C = (matrix.toarray() for matrix in beam[:3])
    inverse, vectors = la.eigh(M, K + SHIFT * M, subset_by_index=[len(K) - count, len(K) - 1])
    squares, shapes = 1 / inverse[::-1] - SHIFT, (vectors / np.sqrt(inverse))[:, ::-1]
    omega = np.where(squares > 1e-5 * SHIFT, np.sqrt(np.abs(squares)), 0.0)
    damping = shapes.T @ C @ shapes
    for effect in effects:
        if isinstance(effect, StructuralDamping):
            gain = weak_forms.assemble(stiffened(cue, effect.loss), nodes, order=ORDER, effects=effects).K - K
            lost, stored = (np.einsum("in,ij,jn->n", shapes, matrix, shapes) for matrix in (np.asarray(gain), K))
            damping += np.diag(np.divide(lost * omega, stored, where=omega > 0, out=np.zeros_like(omega)))
    return Bending(omega, *(beam.tip @ shapes), damping)
