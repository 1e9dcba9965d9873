"""The lowest modes of K q = omega^2 M q and their participation in given loads; mode shapes are computed on demand.

`eigh(K, M)` would lose the low modes in the round-off error of the high ones. This solves the inverse form
M q = mu (K + shift M) q, whose largest mu = 1/(omega^2 + shift) are the lowest modes. LAPACK reduces it to a
tridiagonal matrix, which determines the frequencies and the participation of loads, all that a strike needs, in half
the time of an eigenproblem with vectors.
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

from cuefem.beam.assembly import is_dense_faster
from cuefem.beam.truncation import LANCZOS_STEPS, truncation_correction
from cuefem.cue import Array

# If the tridiagonal matrix begins at the only load, its leading part determines the lowest modes. With LEADING times
# as many rows as modes, and SPARE more, the rest changes none of them by more than the square of ROUNDING; otherwise
# the whole matrix is solved. The truncated modes have the same first moments in mu as those of the whole.
LEADING, SPARE, ROUNDING = 2.2, 12, 1e-7

# mu, work and combine of a `Spectrum`.
RawSpectrum = tuple[Array, Array, Callable[[Array], Array]]


@dataclass(frozen=True, eq=False)
class EigenSolution:
    """Mass-normalised modes of ascending frequency, those of the truncation correction last.

    omega: (n,) rad/s. participation: (loads, n), the work of each load on each mode, 1/sqrt(kg). cutoff: rad/s, of the
    retained modes. radiation: (k, k) of the k correction modes, 1/s; None without a correction. mix: (m, n), from the
    modes of the ``spectrum``, which has more of them, and is None in a copy from another process. resolved: rad/s, the
    highest frequency that the spectrum determines. loads: (free, loads).
    """

    omega: Array
    participation: Array
    cutoff: float
    radiation: Array | None
    mix: Array
    spectrum: Spectrum
    resolved: float
    loads: Array

    @cached_property
    def vectors(self) -> Array:
        """Mode shapes, (free, n)."""
        return self.spectrum.combine(self.mix)

    def __getstate__(self) -> dict[str, Any]:
        """For copies and other processes: the computed vectors in place of the work that computes them."""
        return {**self.__dict__, "vectors": self.vectors, "spectrum": None}

    def subset(self, index: NDArray[np.intp]) -> Self:
        """The modes of these indices, without a truncation correction."""
        omega = self.omega[index]
        return replace(
            self,
            omega=omega,
            participation=self.participation[:, index],
            cutoff=omega[-1],
            radiation=None,
            mix=self.mix[:, index],
        )

    def lowest(self, count: int, cutoff: float = np.inf) -> Self:
        """As `Spectrum.lowest`: without another eigenproblem."""
        return replace(self, **vars(self.spectrum.lowest(count, cutoff)))


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Modes of M q = mu (K + shift M) q, q' (K + shift M) q = 1, of descending mu.

    mu: (m,), 1/(omega^2 + shift); the first ``exact`` of them are exact, the others stand for all truncated modes.
    work: (loads, m), of each load on each mode. combine: the vectors (free, k) of a combination (m, k) of the modes.
    rigid: number of modes of zero frequency, which come first. corrected: (loads, free), which of them have a
    truncation correction.
    """

    mu: Array
    work: Array
    combine: Callable[[Array], Array]
    loads: Array
    corrected: NDArray[np.intp]
    shift: float
    rigid: int
    exact: int

    def lowest(self, count: int, cutoff: float = np.inf) -> EigenSolution:
        """The ``count`` lowest flexible modes, at most ``exact`` - ``rigid``, or those of them up to ``cutoff`` rad/s.

        All others are in the truncation correction.
        """
        rigid, shift = self.rigid, self.shift
        # on a nearly vanishing support, the squared frequency is round-off error
        squares = np.maximum(1 / self.mu[rigid : self.exact] - shift, np.finfo(float).eps * shift)
        frequencies = np.sqrt(squares)
        omega = frequencies[:count][frequencies[:count] <= cutoff]
        if np.isinf(cutoff):
            if not len(omega):
                raise np.linalg.LinAlgError("the frequencies of all modes are NaN: check sizes and materials")
            cutoff = float(omega[-1])
        stop = rigid + len(omega)
        signs = np.where(self.work[0, rigid:stop] < 0, -1.0, 1.0)
        mix, radiation = np.eye(len(self.mu), stop)[:, rigid:] / np.sqrt(self.mu[rigid:stop]) * signs, None
        if len(self.corrected):
            truncated = self.work[self.corrected, stop:].T
            correction = truncation_correction(self.mu[stop:], truncated, shift=shift, cutoff=cutoff)
            omega, radiation = np.append(omega, correction.omega), correction.radiation
            mix = np.concatenate([mix, np.pad(correction.mix, ((stop, 0), (0, 0)))], axis=1)
        return EigenSolution(
            omega=omega,
            participation=self.work @ mix,
            cutoff=cutoff,
            radiation=radiation,
            mix=mix,
            spectrum=self,
            resolved=float(frequencies[-1]),
            loads=self.loads,
        )


def solve_eigenproblem(
    K: Any, M: Any, loads: Array, *, shift: float, rigid: int, count: int, n_corrected: int = 0
) -> Spectrum:
    """The spectrum whose ``count`` lowest flexible modes are exact.

    loads: (free, loads). rigid: number of modes of zero frequency. n_corrected: number of loads with a truncation
    correction; 0 for none.
    """
    if not isinstance(K, np.ndarray) and is_dense_faster(K.shape[0], count):
        K, M = K.toarray(), M.toarray()
    problem = Dense(K, M, shift) if isinstance(K, np.ndarray) else Sparse(K, M, shift)
    corrected = np.flatnonzero(loads[:, :n_corrected].any(axis=0))  # loads on clamped degrees of freedom are zero
    mu, work, combine = problem.spectrum(rigid + count, loads, corrected)
    return Spectrum(mu, work, combine, loads=loads, corrected=corrected, shift=shift, rigid=rigid, exact=rigid + count)


class Sparse:
    """The eigenproblem by shift-invert Lanczos of ARPACK, in proportion to the number of modes."""

    def __init__(self, K: Any, M: Any, shift: float) -> None:
        self.K, self.M, self.shift = K, M, shift

    def spectrum(self, count: int, loads: Array, corrected: NDArray[np.intp]) -> RawSpectrum:
        """The ``count`` lowest modes, then the Ritz vectors of the ``corrected`` columns of the loads (free, k)."""
        from scipy.sparse.linalg import eigsh

        start = np.ones(self.K.shape[0])  # a fixed start, so that results are reproducible
        squares, vectors = eigsh(self.K, count, self.M, sigma=-self.shift, v0=start)
        order = np.argsort(squares)
        mu, vectors = 1 / (squares[order] + self.shift), vectors[:, order]
        basis = vectors * np.sqrt(mu)
        if len(corrected):
            ritz_mu, ritz = self._ritz_vectors(vectors, loads[:, corrected])
            mu, basis = np.append(mu, ritz_mu), np.concatenate([basis, ritz], axis=1)
        return mu, loads.T @ basis, lambda mix: basis @ mix

    def _ritz_vectors(self, vectors: Array, forces: Array) -> tuple[Array, Array]:
        """(mu, q) of a few vectors that replace all modes but ``vectors`` in a truncation correction.

        They span the static deflections under the forces, and under the inertia of those, orthogonal to the modes. A
        truncation correction is the same with them as with all other modes.
        """
        from scipy.sparse.linalg import splu

        S, ritz = self.K + self.shift * self.M, []
        solve = splu(S.tocsc()).solve
        for _ in range(LANCZOS_STEPS):
            vector = solve(forces)
            for _ in range(2):  # the second pass removes round-off error
                vector -= vectors @ ((self.M @ vectors).T @ vector)
            ritz.append(vector / np.sqrt(np.sum(vector * (self.M @ vector), axis=0)))
            forces = self.M @ ritz[-1]
        basis = np.concatenate(ritz, axis=1)
        mu, mix = la.eigh(basis.T @ (self.M @ basis), basis.T @ (S @ basis))
        return mu[::-1], basis @ mix[:, ::-1]


class Dense:
    """The eigenproblem, S = K + shift M, as a tridiagonal one, T y = mu shift y: y = Q' U q, U' U = S, y' y = q' S q.

    U factors S in reverse order, so that y begins with the first degree of freedom's load, which Q does not change.
    """

    def __init__(self, K: Array, M: Array, shift: float) -> None:
        # a symmetric array copied by rows has LAPACK's order when transposed; each step overwrites its input, because
        # fresh memory costs a quarter of the time
        self.shift, self.upper, inertia = shift, K[::-1, ::-1].copy().T, M[::-1, ::-1].copy().T
        inertia *= shift
        self.upper += inertia
        _outputs(lapack.dpotrf(self.upper, lower=0, clean=0, overwrite_a=1))
        _outputs(lapack.dsygst(inertia, self.upper, lower=0, overwrite_a=1))
        size, matrix = len(M), inertia.T[::-1, ::-1].copy().T
        # wider blocks take longer for matrices of this size
        outputs = _outputs(lapack.dsytrd(matrix, lower=1, lwork=10 * size, overwrite_a=1))
        _, self.diagonal, self.off, self.tau = outputs
        self.reflectors = (
            matrix.T.ravel()[1 : 1 + size * (size - 1)].reshape(size - 1, size).T
        )  # matrix[1:], not copied

    def spectrum(self, count: int, loads: Array, corrected: NDArray[np.intp]) -> RawSpectrum:
        """The modes of the matrix, or those of its leading part if the only ``corrected`` load begins there."""
        starts_at_load = len(corrected) == 1 and not loads[1:, corrected].any()
        mu, y = self._eigen(count, leading=starts_at_load)
        return mu, self._reduced(loads)[: len(y)].T @ y, lambda mix: self._vectors(y @ mix)

    def _eigen(self, count: int, *, leading: bool) -> tuple[Array, Array]:
        """(mu, y), (m,) and (m, m), mu descending, of the matrix or its leading part; the first ``count`` are exact."""
        size = len(self.diagonal)
        rows = min(int(LEADING * count) + SPARE, size) if leading else size
        mu, y = (a[..., ::-1] for a in _outputs(lapack.dstevd(self.diagonal[:rows], self.off[: rows - 1])))
        if rows < size and np.any(abs(self.off[rows - 1] * y[-1, :count]) > ROUNDING * mu[:count]):
            return self._eigen(count, leading=False)
        return mu / self.shift, y

    def _reduced(self, loads: Array) -> Array:
        """y of loads (free, k): Q' U'^-1 loads."""
        y = _outputs(lapack.dtrtrs(self.upper, loads[::-1], trans=1))[::-1].copy()
        return self._apply_reflectors(y, "T")

    def _vectors(self, y: Array) -> Array:
        """q (free, k) of y (rows of the leading part, k): U^-1 Q y."""
        padded = np.zeros((len(self.upper), y.shape[1]))
        padded[: len(y)] = y
        return np.asarray(_outputs(lapack.dtrtrs(self.upper, self._apply_reflectors(padded, "N")[::-1]))[::-1])

    def _apply_reflectors(self, y: Array, trans: str) -> Array:
        """Q y, or Q' y if ``trans`` is "T"; y is overwritten."""
        if len(y) > 1 and y.shape[1]:
            y[1:] = lapack.dormqr("L", trans, self.reflectors, self.tau, y[1:], 64 * y.shape[1])[0]
        return y


def _outputs(result: tuple[Any, ...]) -> Any:
    """The outputs of a LAPACK routine; LinAlgError if it failed."""
    *outputs, info = result
    if info:
        raise np.linalg.LinAlgError(f"the eigenproblem of the modes has no solution (LAPACK {info})")
    return outputs[0] if len(outputs) == 1 else outputs
