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
from numpy.typing import NDArray
from scipy.linalg import lapack

from cuefem.beam.assembly import is_dense_faster
from cuefem.beam.truncation import LANCZOS_STEPS, truncation_correction
from cuefem.cue import Array

# If the tridiagonal matrix begins at the first load that is corrected, its leading part determines the lowest modes.
# With LEADING times as many rows as modes, and SPARE more, the rest changes none of them by more than the square of
# ROUNDING; otherwise the whole matrix is solved.
LEADING, SPARE, ROUNDING = 2.2, 12, 1e-7
# Modes span a deflection, but for round-off error, if this part of it is left.
SPANNED = 1e-10

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
        """The ``count`` lowest modes up to ``cutoff``, rad/s, as `Spectrum.lowest`: without another eigenproblem."""
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
            of_truncated = np.zeros((len(self.mu), len(correction.omega)))
            of_truncated[stop:] = correction.mix
            mix = np.concatenate([mix, of_truncated], axis=1)
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


def ritz_modes(
    modes: Array, deflections: Array, *, inverse: Callable[[Array], Array], stiffness: Callable[[Array], Array]
) -> tuple[Array, Array]:
    """(mu, q) of a few vectors that replace all modes but ``modes`` (free, m) in a truncation correction.

    They span the static ``deflections`` under the loads (free, k), and those under the inertia of these, orthogonal to
    the modes. A truncation correction is the same with them as with all other modes. inverse, stiffness: the products
    S^-1 M q and S q, S = K + shift M.
    """
    ritz = np.zeros((len(modes), 0))
    for _ in range(LANCZOS_STEPS):
        known = ritz.shape[1]
        for deflection in deflections.T:
            new = _orthogonal_part(deflection, modes, ritz, stiffness)
            ritz = np.concatenate([ritz, new], axis=1)
        deflections = inverse(ritz[:, known:])
    mu, mix = np.linalg.eigh(stiffness(ritz).T @ inverse(ritz))
    return mu[::-1], ritz @ mix[:, ::-1]


def _orthogonal_part(deflection: Array, modes: Array, ritz: Array, stiffness: Callable[[Array], Array]) -> Array:
    """The part of a deflection orthogonal to modes and Ritz vectors, of unit energy, (free, 1); (free, 0) for none."""
    part = deflection[:, None]
    whole = np.sum(part * stiffness(part))
    for _ in range(2):  # the second pass removes round-off error
        part = part - modes @ (modes.T @ stiffness(part))
        part = part - ritz @ (ritz.T @ stiffness(part))
    energy = np.sum(part * stiffness(part))
    if energy <= SPANNED**2 * whole:
        return part[:, :0]
    return np.asarray(part / np.sqrt(energy))


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
        mu = 1 / (squares[order] + self.shift)
        basis = vectors[:, order] * np.sqrt(mu)
        if len(corrected):
            ritz_mu, ritz = self._ritz_modes(basis, loads[:, corrected])
            mu, basis = np.append(mu, ritz_mu), np.concatenate([basis, ritz], axis=1)
        return mu, loads.T @ basis, lambda mix: basis @ mix

    def _ritz_modes(self, modes: Array, loads: Array) -> tuple[Array, Array]:
        from scipy.sparse.linalg import splu

        S = self.K + self.shift * self.M
        solve = splu(S.tocsc()).solve
        return ritz_modes(modes, solve(loads), inverse=lambda q: solve(self.M @ q), stiffness=lambda q: S @ q)


class Dense:
    """The eigenproblem, S = K + shift M, as a tridiagonal one, T y = mu y: y = Q' U q, U' U = S, y' y = q' S q.

    U factors S in reverse order, so that y begins with the first degree of freedom's load, which Q does not change.
    """

    def __init__(self, K: Array, M: Array, shift: float) -> None:
        # a symmetric array copied by rows has LAPACK's order when transposed; each step overwrites its input, because
        # fresh memory costs a quarter of the time
        self.upper, inertia = K[::-1, ::-1].copy().T, M[::-1, ::-1].copy().T
        self.upper += shift * inertia
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
        """The ``count`` lowest modes, then the Ritz vectors of the ``corrected`` columns of the loads (free, k)."""
        starts_at_load = len(corrected) > 0 and not loads[1:, corrected[0]].any()
        reduced, (mu, y) = self._reduced(loads), self._eigen(count, leading=starts_at_load)
        if len(corrected):
            ritz_mu, ritz = ritz_modes(y, reduced[:, corrected], inverse=self._tridiagonal, stiffness=lambda y: y)
            mu, y = np.append(mu, ritz_mu), np.concatenate([y, ritz], axis=1)
        return mu, reduced.T @ y, lambda mix: self._vectors(y @ mix)

    def _eigen(self, count: int, *, leading: bool) -> tuple[Array, Array]:
        """(mu, y), (count,) and (free, count), mu descending, of the matrix or its leading part."""
        size = len(self.diagonal)
        rows = min(int(LEADING * count) + SPARE, size) if leading else size
        mu, y = _outputs(lapack.dstevd(self.diagonal[:rows], self.off[: rows - 1]))
        mu, y = mu[: -count - 1 : -1], y[:, : -count - 1 : -1]
        if rows < size and np.any(abs(self.off[rows - 1] * y[-1]) > ROUNDING * mu):
            return self._eigen(count, leading=False)
        return mu, np.concatenate([y, np.zeros((size - rows, count))])

    def _tridiagonal(self, y: Array) -> Array:
        """T y, (free, k)."""
        product = self.diagonal[:, None] * y
        product[1:] += self.off[:, None] * y[:-1]
        product[:-1] += self.off[:, None] * y[1:]
        return np.asarray(product)

    def _reduced(self, loads: Array) -> Array:
        """y of the static deflections under loads (free, k): Q' U'^-1 loads."""
        y = _outputs(lapack.dtrtrs(self.upper, loads[::-1], trans=1))[::-1].copy()
        return self._apply_reflectors(y, "T")

    def _vectors(self, y: Array) -> Array:
        """q of y, (free, k): U^-1 Q y."""
        return np.asarray(_outputs(lapack.dtrtrs(self.upper, self._apply_reflectors(y, "N")[::-1]))[::-1])

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
