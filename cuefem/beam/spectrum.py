"""All modes of a beam as its tip feels them, from one tridiagonal form that begins at the tip.

A strike needs the frequencies and the tip's displacement in each mode, and no shapes. LAPACK reduces
M q = mu (K + shift M) q to a tridiagonal problem; ordered so that the tip's deflection comes first, the first entries
of that problem's vectors are the deflections of the tip in the modes. All modes of the mesh are then known there, so
the tail (`cuefem.beam.tail`) is two steps of Lanczos in numbers, without another factorisation. Shapes are worked out
only where an effect asks for them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from cuefem.beam.lapack import lapack
from cuefem.beam.modes import Modes, check_solved, normalised, solve
from cuefem.beam.system import System
from cuefem.beam.tail import DASHPOT, STEPS, flexibility, tail
from cuefem.cue import Array, Section

# The lowest modes follow from the leading part of the tridiagonal form. If it has LEADING times as many rows as modes
# are asked for, and SPARE more, the rest of the form usually changes none of them by more than ROUNDING of itself;
# where it does, the whole form is taken.
LEADING, SPARE, ROUNDING = 2.2, 12, 1e-16

# K carries a rounding error of eps times its largest entry, which shows in the lowest mode where stiffness is uneven (a
# stiff ferrule beside soft leather). Where the lowest omega^2 is off its strain energy by more than this, the modes
# take their Rayleigh-Ritz step (`cuefem.beam.modes`).
EVEN_ENOUGH = 1e-11


@dataclass(frozen=True, eq=False)
class Reduced:
    """A dense beam with no unknown taken out, reduced to a tridiagonal matrix; y = Q z, upper q = y, both in reverse.

    system: the beam. diagonal: (n,), off: (n - 1,), of the matrix. upper: (n, n) triangle, upper' upper = K + shift M
    with the unknowns in reverse. reflectors: (n - 1, n - 1), tau: Q as LAPACK keeps it; Q leaves the first entry alone.
    wanted: how many of the lowest modes are asked for.
    """

    system: System
    diagonal: Array
    off: Array
    upper: Array
    reflectors: Array
    tau: Array
    wanted: int

    @cached_property
    def eigen(self) -> tuple[Array, Array]:
        """(mu, z) descending in mu, ascending in frequency, of all modes or of the form's leading part: (m,), (m, m).

        The modes asked for are exact. The others of a leading part stand for all further modes of the beam: a load
        on the tip's deflection finds the same first moments in mu in both.
        """
        size = len(self.diagonal)
        part = min(size, int(LEADING * self.wanted) + SPARE)
        mu, z = self._leading(part)
        if part < size and np.any(abs(self.off[part - 1] * z[-1, : self.wanted]) > ROUNDING * mu[: self.wanted]):
            mu, z = self._leading(size)
        return mu, z

    def _leading(self, size: int) -> tuple[Array, Array]:
        mu, z, failed = lapack().dstevd(self.diagonal[:size], self.off[: size - 1])
        check_solved(failed, "dstevd")
        return mu[::-1], z[:, ::-1]

    @property
    def squares(self) -> Array:
        """omega^2 of these modes, the rigid ones' near zero, (m,)."""
        return np.asarray(1 / self.eigen[0] - self.system.shift)

    @cached_property
    def felt(self) -> Array:
        """The tip's deflection, and its rotation times the length, in each z: (2, m)."""
        z, upper = self.eigen[1], self.upper
        deflection = z[0] / upper[-1, -1]
        second = np.zeros((len(upper) - 1, 1), order="F")
        second[0] = 1.0
        rotation = (self._turned(second, "T")[: len(z) - 1, 0] @ z[1:] - upper[-2, -1] * deflection) / upper[-2, -2]
        return np.asarray([deflection, rotation])

    def shapes(self, mix: Array) -> Array:
        """Unknowns (n, k) of combinations ``mix``, (m, k), of the vectors z."""
        y = np.zeros((len(self.upper), mix.shape[1]))
        y[: len(mix)] = self.eigen[1] @ mix
        y[1:] = self._turned(y[1:], "N")
        q, failed = lapack().dtrtrs(self.upper, y[::-1])
        check_solved(failed, "dtrtrs")
        return np.asarray(q[::-1])

    def _turned(self, y: Array, trans: str) -> Array:
        """Q or its transpose times y, both without their first row."""
        turned, _, failed = lapack().dormqr("L", trans, self.reflectors, self.tau, y, 64 * y.shape[1])
        check_solved(failed, "dormqr")
        return np.asarray(turned)


def reduced(system: System, wanted: int | None = None) -> Reduced:
    """The tridiagonal form of a dense beam none of whose unknowns are taken out.

    wanted: how many modes are asked for, whose tail takes loads on the tip's deflection alone; None for all.
    """
    # with the unknowns in reverse the tip is last, where LAPACK's upper triangles leave it alone
    upper, failed = lapack().dpotrf((system.K + system.shift * system.M)[::-1, ::-1], lower=0)
    check_solved(failed, "dpotrf")
    standard, failed = lapack().dsygst(system.M[::-1, ::-1], upper, lower=0)
    check_solved(failed, "dsygst")
    work = 10 * len(upper)  # wider blocks take longer for so few unknowns
    whole, diagonal, off, tau, failed = lapack().dsytrd(standard[::-1, ::-1], lower=1, lwork=work)
    check_solved(failed, "dsytrd")
    return Reduced(system, diagonal, off, upper, np.asfortranarray(whole[1:, :-1]), tau, wanted or len(upper))


@dataclass(frozen=True, eq=False)
class TipSpectrum:
    """The lowest modes of a beam with a tail, as its tip feels them; what `cuefem.beam.tip.tip_modes` takes.

    Its fields and properties are those of `Modes`, but for the shapes, which `modes` works out when asked.

    system: the beam. omega: rad/s, (n,), the tail's last. highest: of those before the tail. at_tip: the tip's
    deflection and rotation in the rigid motions and in these modes. rigid: the number of rigid motions. radiation: of
    the tail (`TipModes`). shapes: makes the vectors, (unknowns, n).
    """

    system: System
    omega: Array
    highest: float
    at_tip: tuple[Array, Array]
    rigid: int
    rigid_vectors: Array
    radiation: Array
    shapes: Callable[[], Array]

    @cached_property
    def modes(self) -> Modes:
        """The same modes with their shapes."""
        shaped = Modes(self.frequencies, self.shapes(), self.rigid, self.rigid_vectors, self.system)
        return replace(shaped, radiation=self.radiation)

    @property
    def frequencies(self) -> Array:
        """Hz, (n,)."""
        return self.omega / (2 * np.pi)

    @property
    def vectors(self) -> Array:
        """Those of `modes`."""
        return self.modes.vectors

    def loss_factors(self, loss: Section) -> Array:
        """As `Modes.loss_factors`."""
        return self.modes.loss_factors(loss)


Ended = Modes | TipSpectrum


def ended(system: System, most: int, *, turning: bool) -> Callable[[int], Ended]:
    """A function from a number of modes, up to ``most``, to the lowest modes of a beam, ended by a tail at the tip.

    Every further number of modes costs little. turning: as in `tail`. A dense beam goes by its tridiagonal form; one
    with clamps, stiff joints or uneven stiffness, or a sparse one, is solved for the shapes of ``most`` modes.
    """
    if isinstance(system.K, np.ndarray) and system.free is None:
        form, rigid = reduced(system, None if turning else most + 2), normalised(system)
        if _even(form, rigid.shape[1]):
            return lambda count: _ended(form, rigid, count, loads=2 if turning else 1)
    whole, deflect = solve(system, most), flexibility(system)

    def solved(count: int) -> Modes:
        lowest = replace(whole, frequencies=whole.frequencies[:count], vectors=whole.vectors[:, :count])
        return tail(lowest, turning=turning, deflect=deflect)

    return solved


def _even(form: Reduced, rigid: int) -> bool:
    """Whether the lowest frequency agrees with the strains of its mode, so that the rounding of K does not show."""
    mix = np.zeros((len(form.eigen[0]), 1))
    mix[rigid] = 1.0
    lowest = form.shapes(mix)
    energy = np.sum(form.system.strains(lowest) ** 2)
    return bool(abs(form.squares[rigid] * form.eigen[0][rigid] / energy - 1) < EVEN_ENOUGH)


def _ended(form: Reduced, rigid_vectors: Array, count: int, *, loads: int) -> TipSpectrum:
    """The ``count`` lowest flexible modes, and a tail made of all others that the form has (`cuefem.beam.tail.ritz`).

    In the modes left out, of weights mu, the steps of Lanczos are the loads and mu times the loads.
    """
    system, rigid = form.system, rigid_vectors.shape[1]
    mu, felt, first = form.eigen[0], form.felt, rigid + count
    asked, rest = slice(rigid, first), mu[first:, None]
    force = felt[:loads, first:].T
    basis = np.linalg.qr(np.concatenate([rest**step * force for step in range(STEPS)], axis=1))[0]
    t, mix = np.linalg.eigh(basis.T @ (rest * basis))
    t, mix = t[::-1], (mix / np.sqrt(t))[:, ::-1]
    ends, basis = mix[-loads:], basis @ mix
    signs = np.where(felt[0, asked] < 0, -1.0, 1.0) / np.sqrt(mu[asked])
    omega = np.sqrt(form.squares[asked])
    flexible = np.concatenate([felt[:, asked] * signs, felt[:, first:] @ basis], axis=1)
    still = np.array([rigid_vectors[0], rigid_vectors[1]])
    across, turned = np.concatenate([still, flexible], axis=1)

    def shapes() -> Array:
        whole = np.zeros((len(mu), count + len(t)))
        whole[np.arange(rigid, first), np.arange(count)] = signs
        whole[first:, count:] = basis
        return form.shapes(whole)

    return TipSpectrum(
        system,
        np.concatenate([omega, np.sqrt(1 / t - system.shift)]),
        float(omega[-1]),
        (across, turned / system.length),
        rigid,
        rigid_vectors,
        DASHPOT / float(omega[-1]) * (ends.T @ ends),
        shapes,
    )
