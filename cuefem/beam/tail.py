"""The tail of the modes: what those left out do at the tip, as a few more vectors and their radiation.

A plain sum over the lowest n modes converges like 1/n to n^-1.3: the modes left out still give way, and carry waves
away from the tip. `tail` ends the sum by a few Ritz vectors on a dashpot that do both; at equal modes the error of a
strike falls ten to a thousand times. What it does for bending, `ritz` does for modes of any kind.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from cuefem.beam.modes import Modes
from cuefem.beam.system import System
from cuefem.cue import Array

Deflect = Callable[[Array], Array]

# Steps of Lanczos in the tail, and its dashpot in units of 1/(the highest frequency kept). Measured: one step is up to
# thirty times worse, three are no better; a dashpot of 0.35 to 1.5 changes errors by less than a factor of two.
STEPS, DASHPOT = 2, 0.5


class Ritz(NamedTuple):
    """A tail of k vectors: angular frequencies (k,), vectors (unknowns, k), mass-normalised, and their radiation
    (k, k), 1/s (see `TipModes`)."""

    omega: Array
    vectors: Array
    radiation: Array


def tail(found: Modes, *, turning: bool = False, deflect: Deflect | None = None) -> Modes:
    """Modes ended by a tail: what the modes left out do at the tip, as a few more vectors and their radiation.

    turning: the contact lies off the cue's axis, where a couple turns the tip beside the force. Cost: one factorisation
    of K, `STEPS` solutions; deflect: the `flexibility` of the system, where it is known already.
    """
    system = found.system
    kept = np.concatenate([found.rigid_vectors, found.vectors], axis=1)
    force = np.zeros((system.mesh.unknowns, 2 if turning else 1))
    np.fill_diagonal(force, 1.0)  # at the tip: on w, and on theta
    if system.free is not None:
        force = force[:, np.asarray(abs(system.free.T @ force).sum(axis=0)).ravel() > 0]  # none on what a clamp holds
    if force.shape[1] == 0:
        return found
    deflect = deflect or flexibility(system)
    more = ritz(kept, system.K, system.M, force, shift=system.shift, deflect=deflect, highest=found.highest)
    return replace(
        found,
        frequencies=np.concatenate([found.frequencies, more.omega / (2 * np.pi)]),
        vectors=np.concatenate([found.vectors, more.vectors], axis=1),
        radiation=more.radiation,
    )


def ritz(kept: Array, K: Any, M: Any, force: Array, *, shift: float, deflect: Deflect, highest: float) -> Ritz:
    """Tail of the modes ``kept`` (unknowns, n), all of K q = omega^2 M q up to ``highest`` rad/s, under ``force``.

    The flexibility of the modes left out, as the tip feels it, by `STEPS` steps of Lanczos from the static deflection
    under each force (unknowns, loads) at the tip, which match its first moments in 1/omega^2. The chain ends in a
    dashpot, as the matching end of a line: waves above the frequencies kept leave the tip and do not come back; an end
    without it would ring. deflect: the inverse of K + shift M.
    """
    basis = _krylov(kept, K, M, force, shift=shift, deflect=deflect)
    T = basis.T @ (M @ basis)  # what the chain's masses are, where its stiffness is I - shift T
    squares, mix = la.eigh(np.eye(len(T)) - shift * T, T)
    ends = mix[-force.shape[1] :]
    return Ritz(np.sqrt(squares), basis @ mix, DASHPOT / highest * ends.T @ ends)


def _krylov(kept: Array, K: Any, M: Any, force: Array, *, shift: float, deflect: Deflect) -> Array:
    """Basis of the tail, (unknowns, STEPS loads): orthonormal in K + shift M, M-orthogonal to the modes kept."""
    heavy = M @ kept
    steps: list[Array] = []
    for _ in range(STEPS):
        step = deflect(force)
        for _ in range(2):
            step = step - kept @ (heavy.T @ step)
        step = step / np.sqrt(np.sum(step * (M @ step), axis=0))
        force = M @ step
        steps.append(step)
    basis = np.concatenate(steps, axis=1)
    for _ in range(2):  # orthonormal in their order: the last belong to the end of the chain
        gram = basis.T @ (K @ basis) + shift * (basis.T @ (M @ basis))
        basis = la.solve_triangular(la.cholesky(gram, lower=True), basis.T, lower=True).T
    return np.asarray(basis)


def flexibility(system: System) -> Deflect:
    """Deflections (unknowns, k) of the beam under loads (unknowns, k), on the springs shift M that modes are shifted
    by."""
    S, free = system.K + system.shift * system.M, system.free
    if free is not None:
        S = free.T @ S @ free
    held = inverse(S)
    return held if free is None else lambda load: free @ held(free.T @ load)


def inverse(S: Any) -> Deflect:
    """What solves S x = load, for a symmetric positive S, dense or sparse."""
    if isinstance(S, np.ndarray):
        factors = la.cho_factor(S, check_finite=False)
        return lambda load: la.cho_solve(factors, load)
    solve: Deflect = sla.splu(sp.csc_matrix(S)).solve
    return solve
