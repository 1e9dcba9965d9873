"""The tail: a few vectors that stand for the modes left out of a sum.

A plain sum over the lowest n modes converges only like 1/n to n^-1.3, because the modes left out also give way under
the force at the tip and carry waves away from it. A tail of a few Ritz vectors on a dashpot does both. With the same
number of modes the error of a strike falls ten to a thousand times.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg as la

from cuefem.cue import Array

Deflect = Callable[[Array], Array]

# Number of Lanczos steps, and the dashpot in units of 1/(the highest frequency kept). Measured: one step is up to
# thirty times worse and three are no better; any dashpot from 0.35 to 1.5 changes errors by less than a factor of two.
STEPS, DASHPOT = 2, 0.5


class Ritz(NamedTuple):
    """A tail of k vectors: angular frequencies (k,), vectors (unknowns, k), mass-normalised, and their radiation
    (k, k), 1/s (see `TipModes`)."""

    omega: Array
    vectors: Array
    radiation: Array


def ritz(
    modes: Array, K: Any, M: Any, force: Array, *, shift: float | Array, deflect: Deflect, highest: float | Array
) -> Ritz:
    """Tail of ``modes`` (unknowns, n) of K q = omega^2 M q, all of them up to ``highest`` rad/s.

    The flexibility of the modes left out, as the tip feels it under each force (unknowns, loads), by `STEPS` steps of
    Lanczos from the static deflections, which match its first moments in 1/omega^2. The chain ends in a dashpot, as the
    matching end of a line does: waves above the frequencies kept leave the tip and do not come back; without it the end
    would ring. deflect: multiplication by the inverse of K + shift M. Everything may be a stack of beams: arrays with
    one axis more in front, shift and highest of shape (beams,).
    """
    shift, highest = (np.asarray(value)[..., None, None] for value in (shift, highest))
    basis = _krylov(modes, K, M, force, shift=shift, deflect=deflect)
    t, mix = np.linalg.eigh(_gram(basis, M))  # the chain's masses; its stiffness is 1 - shift t
    t, mix = t[..., ::-1], (mix / np.sqrt(t)[..., None, :])[..., ::-1]
    ends = mix[..., -force.shape[-1] :, :]
    return Ritz(np.sqrt(1 / t - shift[..., 0]), basis @ mix, DASHPOT / highest * (_transposed(ends) @ ends))


def ritz_of_rest(mu: Array, felt: Array, *, shift: float, highest: float) -> Ritz:
    """The same tail where all modes left out are known: their mu = 1/(omega^2 + shift) and the loads' shares ``felt``,
    (modes, loads), in them with q' (K + shift M) q = 1. Its vectors are combinations of these modes."""
    weights = mu[:, None]
    basis = np.linalg.qr(np.concatenate([weights**step * felt for step in range(STEPS)], axis=1))[0]
    t, mix = np.linalg.eigh(basis.T @ (weights * basis))
    t, mix = t[::-1], (mix / np.sqrt(t))[:, ::-1]
    ends = mix[-felt.shape[1] :]
    return Ritz(np.sqrt(1 / t - shift), basis @ mix, DASHPOT / highest * (ends.T @ ends))


def _krylov(modes: Array, K: Any, M: Any, force: Array, *, shift: Array, deflect: Deflect) -> Array:
    """Basis of the tail, (unknowns, STEPS loads): orthonormal in K + shift M, M-orthogonal to ``modes``."""
    heavy = _transposed(M @ modes)
    steps: list[Array] = []
    for _ in range(STEPS):
        step = deflect(force)
        for _ in range(2):
            step = step - modes @ (heavy @ step)
        step = step / np.sqrt(np.sum(step * (M @ step), axis=-2, keepdims=True))
        force = M @ step
        steps.append(step)
    basis = np.concatenate(steps, axis=-1)
    for _ in range(2):  # orthonormal in their order: the last belong to the end of the chain
        lower = np.linalg.cholesky(_gram(basis, K) + shift * _gram(basis, M))
        basis = _transposed(np.linalg.solve(lower, _transposed(basis)))
    return np.asarray(basis)


def _gram(vectors: Array, A: Any) -> Array:
    """vectors' A vectors, (k, k)."""
    return np.asarray(_transposed(vectors) @ (A @ vectors))


def _transposed(stack: Array) -> Array:
    """The matrices of a stack transposed."""
    return np.swapaxes(stack, -1, -2)


def inverse(S: Any) -> Deflect:
    """The function that solves S x = load, for a symmetric positive S, dense or sparse."""
    if isinstance(S, np.ndarray):
        factor = la.cho_factor(S, check_finite=False)
        return lambda load: np.asarray(la.cho_solve(factor, load, check_finite=False))
    import scipy.sparse as sp
    from scipy.sparse.linalg import splu

    solve: Deflect = splu(sp.csc_matrix(S)).solve
    return solve
