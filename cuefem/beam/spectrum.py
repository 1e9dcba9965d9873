"""The lowest modes of K q = omega^2 M q as some loads feel them; their shapes are worked out when they are asked for.

`eigh(K, M)` would lose the low modes in the rounding of the high ones. So this solves the inverse form
M q = mu (K + shift M) q, whose largest mu = 1/(omega^2 + shift) are the lowest modes. LAPACK reduces it to a
tridiagonal matrix; a strike needs the frequencies and the loads' shares in the modes, which follow from that alone, in
half the time of an eigenproblem with vectors.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray
from scipy.linalg import lapack

from cuefem.beam.system import suits_dense
from cuefem.beam.tail import STEPS, tail
from cuefem.cue import Array

# The lowest modes follow from the leading part of the tridiagonal matrix, if it begins at the only load. With LEADING
# times as many rows as modes wanted, and SPARE more, the rest changes none of them by more than the square of ROUNDING,
# or the whole is taken; the modes left over have the same first moments in mu as those of the whole.
LEADING, SPARE, ROUNDING = 2.2, 12, 1e-7


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Modes with ascending frequency, mass-normalised, the tail's last.

    omega: (n,) rad/s. loads: (unknowns, loads). felt: (loads, n), each load's work on each mode. highest: rad/s, of
    those before the tail. radiation: of the tail, (tail, tail), 1/s; None without one. shapes: makes the vectors.
    """

    omega: Array
    loads: Array
    felt: Array
    highest: float
    radiation: Array | None
    shapes: Callable[[], Array]

    @cached_property
    def vectors(self) -> Array:
        """(unknowns, n)."""
        return self.shapes()

    def those(self, index: NDArray[np.intp]) -> Self:
        """Some of the modes alone, without a tail."""
        omega, felt = self.omega[index], self.felt[:, index]
        return replace(
            self, omega=omega, felt=felt, highest=omega[-1], radiation=None, shapes=lambda: self.vectors[:, index]
        )


def spectrum(
    K: Any, M: Any, loads: Array, *, shift: float, rigid: int, count: int, below: float = np.inf, ended: int = 0
) -> Spectrum:
    """The ``count`` lowest flexible modes, or those of them up to ``below`` rad/s.

    loads: (unknowns, loads). rigid: how many modes of zero frequency come first and are left out. ended: how many of
    the loads the tail takes; 0 for none.
    """
    if not isinstance(K, np.ndarray) and suits_dense(K.shape[0], count):
        K, M = K.toarray(), M.toarray()
    taken = np.flatnonzero(loads[:, :ended].any(axis=0))  # no load acts on an unknown that a clamp holds
    if isinstance(K, np.ndarray):
        form = _Tridiagonal(K, M, shift)
        mu, z = form.eigen(rigid + count, leading=len(taken) == 1 and not loads[1:, taken].any())
        felt, vectors = form.loads(loads)[: len(z)].T @ z, lambda mix: form.vectors(z @ mix)
    else:
        mu, basis = _sparse(K, M, loads[:, taken], shift, rigid + count)
        felt, vectors = loads.T @ basis, lambda mix: basis @ mix
    last = rigid + int(np.sum(1 / mu[rigid : rigid + count] - shift <= below**2))
    if last == rigid and np.isinf(below):
        raise np.linalg.LinAlgError("no mode has a frequency that is a number: check sizes and materials")
    # the square of a mode on a support that is next to nothing is rounding
    omega = np.sqrt(np.maximum(1 / mu[rigid:last] - shift, np.finfo(float).eps * shift))
    mix = np.eye(len(mu), last)[:, rigid:] / np.sqrt(mu[rigid:last]) * np.where(felt[0, rigid:last] < 0, -1.0, 1.0)
    highest, radiation = float(omega[-1]) if np.isinf(below) else below, None
    if len(taken):
        rest = tail(mu[last:], felt[taken, last:].T, shift=shift, highest=highest)
        omega, radiation = np.append(omega, rest.omega), rest.radiation
        mix = np.concatenate([mix, np.concatenate([np.zeros((last, len(rest.omega))), rest.mix])], axis=1)
    return Spectrum(omega, loads, felt @ mix, highest, radiation, lambda: vectors(mix))


def _sparse(K: Any, M: Any, loads: Array, shift: float, count: int) -> tuple[Array, Array]:
    """(mu, q), q' (K + shift M) q = 1, of the ``count`` lowest modes, then of what stands for all others.

    These are the Ritz vectors of the deflections under the loads, and under those as loads, as far as they are not in
    the modes: a tail finds the same in them as in all others.
    """
    from scipy.sparse.linalg import eigsh, splu

    start = np.ones(K.shape[0])  # a fixed start, so that the same input gives the same numbers
    squares, vectors = eigsh(K, count, M, sigma=-shift, v0=start)
    order = np.argsort(squares)
    mu, vectors = 1 / (squares[order] + shift), vectors[:, order]
    if not loads.size:
        return mu, vectors * np.sqrt(mu)
    S, steps, forces = K + shift * M, [], loads
    deflect = splu(S.tocsc()).solve
    for _ in range(STEPS):
        step = deflect(forces)
        for _ in range(2):  # once more, for rounding
            step -= vectors @ ((M @ vectors).T @ step)
        steps.append(step / np.sqrt(np.sum(step * (M @ step), axis=0)))
        forces = M @ steps[-1]
    rest = np.concatenate(steps, axis=1)
    own, mix = la.eigh(rest.T @ (M @ rest), rest.T @ (S @ rest))
    return np.append(mu, own[::-1]), np.concatenate([vectors * np.sqrt(mu), rest @ mix[:, ::-1]], axis=1)


class _Tridiagonal:
    """M q = mu S q with S = K + shift M as a tridiagonal problem T y = mu shift y: y = Q' U q, U' U = S, y' y = q' S q.

    U is taken with the unknowns in reverse, so that y begins with the first unknown's load, which Q leaves alone.
    """

    def __init__(self, K: Array, M: Array, shift: float) -> None:
        # a symmetric array copied by rows has LAPACK's order when it is transposed; each step overwrites its input,
        # for fresh memory costs a quarter of the time
        self.shift, self.upper, heavy = shift, K[::-1, ::-1].copy().T, M[::-1, ::-1].copy().T
        heavy *= shift
        self.upper += heavy
        _done(lapack.dpotrf(self.upper, lower=0, clean=0, overwrite_a=1))
        _done(lapack.dsygst(heavy, self.upper, lower=0, overwrite_a=1))
        size, whole = len(M), heavy.T[::-1, ::-1].copy().T
        # wider blocks take longer for so few unknowns
        found = _done(lapack.dsytrd(whole, lower=1, lwork=10 * size, overwrite_a=1))
        _, self.diagonal, self.off, self.tau = found
        self.reflectors = whole.T.ravel()[1 : 1 + size * (size - 1)].reshape(size - 1, size).T  # whole[1:], unmoved

    def eigen(self, count: int, *, leading: bool) -> tuple[Array, Array]:
        """(mu, y) with descending mu, (m,), (m, m): the first ``count`` exact, of all or only the leading ones."""
        size = len(self.diagonal)
        part = min(int(LEADING * count) + SPARE, size) if leading else size
        mu, y = (each[..., ::-1] for each in _done(lapack.dstevd(self.diagonal[:part], self.off[: part - 1])))
        if part < size and np.any(abs(self.off[part - 1] * y[-1, :count]) > ROUNDING * mu[:count]):
            return self.eigen(count, leading=False)
        return mu / self.shift, y

    def loads(self, loads: Array) -> Array:
        """y of loads on the unknowns, (unknowns, k): Q' U'^-1 loads."""
        y = _done(lapack.dtrtrs(self.upper, loads[::-1], trans=1))[::-1].copy()
        return self._turned(y, "T")

    def vectors(self, y: Array) -> Array:
        """Unknowns (unknowns, k) of y (rows of the leading part, k): U^-1 Q y."""
        whole = np.zeros((len(self.upper), y.shape[1]))
        whole[: len(y)] = y
        return np.asarray(_done(lapack.dtrtrs(self.upper, self._turned(whole, "N")[::-1]))[::-1])

    def _turned(self, y: Array, trans: str) -> Array:
        if len(y) > 1 and y.shape[1]:
            y[1:] = lapack.dormqr("L", trans, self.reflectors, self.tau, y[1:], 64 * y.shape[1])[0]
        return y


def _done(answer: tuple[Any, ...]) -> Any:
    """What a routine of LAPACK gives; LinAlgError if it failed."""
    *found, failed = answer
    if failed:
        raise np.linalg.LinAlgError(f"the eigenproblem of the modes has no solution (LAPACK {failed})")
    return found[0] if len(found) == 1 else found
