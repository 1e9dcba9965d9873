"""Bending modes of a cue: the eigenproblem, and one Rayleigh-Ritz step that keeps it exact."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cuefem.beam.lapack import lapack
from cuefem.beam.mesh import ActsOnCue
from cuefem.beam.system import System, assemble, suits_dense
from cuefem.beam.waves import mesh_for, modes_below
from cuefem.cue import Array, Cue, Section
from cuefem.quantity.display import brief
from cuefem.quantity.fields import Quantity, check_count, check_kind

# LAPACK's omega^2 and the Rayleigh quotients of its vectors agree to this where the rounding of K does not show.
EVENLY = 1e-12
# Fewer than one in FEW modes of a problem of fewer than SMALL unknowns are found faster one by one.
FEW, SMALL = 3, 120


@dataclass(frozen=True)
class Modes:
    """Flexible bending modes of a cue, undamped, ascending in frequency.

    frequencies: (n,) Hz. vectors: (unknowns, n), mass-normalised. rigid: the number of rigid motions, whose frequency
    is exactly zero. rigid_vectors: (unknowns, rigid), mass-normalised. system: the assembled beam. radiation: see
    `TipModes`; None unless the modes end in a tail (`cuefem.beam.tail`).
    """

    frequencies: Array
    vectors: Array
    rigid: int
    rigid_vectors: Array
    system: System
    radiation: Array | None = None

    def __repr__(self) -> str:
        first = self.frequencies[:6]
        more = f" and {len(self.frequencies) - len(first)} more" if len(first) < len(self.frequencies) else ""
        return f"Modes({brief(first)} Hz{more}, {self.rigid} rigid)"

    @property
    def modes(self) -> Modes:
        """These modes themselves; see `cuefem.beam.spectrum.TipSpectrum.modes`."""
        return self

    @property
    def omega(self) -> Array:
        """Angular frequencies, rad/s, (n,)."""
        return 2 * np.pi * self.frequencies

    @property
    def highest(self) -> float:
        """Highest angular frequency kept, rad/s, without the tail's."""
        return float(self.omega[: len(self.omega) - (0 if self.radiation is None else len(self.radiation))][-1])

    @property
    def at_tip(self) -> tuple[Array, Array]:
        """Deflection, 1/sqrt(kg), and rotation, 1/(m sqrt(kg)), of the tip in the rigid motions, then in the modes."""
        return self.system.tip_displacement(np.concatenate([self.rigid_vectors, self.vectors], axis=1))

    def shape(self, x: ArrayLike) -> tuple[Array, Array]:
        """Deflection w and rotation theta of every mode at ``x`` m from the tip: two arrays (n, *x.shape).

        Mass-normalised: w in 1/sqrt(kg), theta in 1/(m sqrt(kg)); w(0) > 0.
        """
        x = np.asarray(x, float)
        length = self.system.length
        if not np.all((x >= 0) & (x <= length)):
            raise ValueError(f"Modes.shape takes positions in [0, {length}] m; got {x}")
        return self.system.interpolate(self.vectors, x)

    def loss_factors(self, loss: Section) -> Array:
        """Loss factor of every mode, (n,), from the loss factors of EI and kGA at the Gauss points, (elements, q).

        It is the mean of the losses, weighted with the strain energy stored there; springs store energy without loss.
        """
        weights = np.concatenate([loss.EI, loss.kGA], axis=1).ravel()
        return np.asarray(weights @ self.system.strains(self.vectors)[: len(weights)] ** 2 / self.omega**2)


def modes(
    cue: Cue,
    count: int = 6,
    near: float | None = None,
    effects: tuple[Any, ...] = (),
    at: Any = None,
) -> Modes:
    """Flexible bending modes of a cue: the ``count`` lowest, or the ``count`` nearest to ``near`` Hz.

    Parameters
    ----------
    cue
        A `Cue` of segments.
    count
        How many modes.
    near
        A frequency, Hz. By default the lowest modes are given.
    effects
        Effects of a scene. Those that act on the cue count; effects at the tip do not change its modes.
    at
        A `Resolution`, of which only elements and order count. By default frequencies hold to 2e-7, the first five to
        1e-9.

    Returns
    -------
    Modes
        ``.frequencies`` in Hz, ascending; ``.rigid``, the number of rigid motions; ``.shape(x)``, deflection and
        rotation of every mode at ``x`` m from the tip.

    Raises
    ------
    TypeError
        If the cue is lumped: it has no modes.
    ValueError
        If the mesh of ``at`` holds fewer modes.

    Notes
    -----
    Timoshenko's beam, free at both ends unless an effect holds it (handbook: The beam). Costs one dense symmetric
    eigenproblem, cubic in the unknowns.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> found = cf.modes(cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),)), count=2)
    >>> [round(float(f), 1) for f in found.frequencies]
    [128.0, 343.8]
    """
    check_kind("modes cue", cue, Cue)
    check_count("modes count", count, 1)
    effects = _on_the_cue(effects)
    if near is not None:
        near = Quantity("Hz", "[0, inf)").check("modes near", near)
    below = 0 if near is None else modes_below(cue, 2 * np.pi * near)
    wanted = below + count + (0 if near is None else 2)
    elements, order = mesh_for(cue, wanted) if at is None else (at.elements, at.order)
    system = assemble(cue, elements=elements, order=order, effects=effects, count=wanted)
    if near is None:
        return solve(system, count)
    return _nearest(solve(system, min(wanted, _most_modes(system))), count, near)


def _on_the_cue(effects: tuple[Any, ...]) -> tuple[ActsOnCue, ...]:
    """The effects that act on the cue; effects at the tip do not change its modes."""
    for effect in effects:
        if not hasattr(effect, "axial_mass"):
            raise TypeError(f"modes effects must be effects, as a Scene takes them; got {effect!r}")
    return tuple(effect for effect in effects if hasattr(effect, "add_to"))


def solve(system: System, count: int) -> Modes:
    """The lowest ``count`` flexible modes of an assembled beam. The rigid ones are known and need no eigenvalue.

    `eigh(K, M)` would lose the low modes in the rounding of the high ones. So this solves the inverse form
    M q = mu (K + sigma M) q, whose largest mu are the lowest modes, and then takes their frequencies from the strains.
    Relative errors stay near rounding, even with soft tips and stiff ferrules.
    """
    most = _most_modes(system)
    if count > most:
        raise ValueError(f"modes: the mesh holds {most} flexible modes; got {count} wanted; use more elements or order")
    rigid, shift = system.rigid.shape[1], system.shift
    K, M, free = system.K, system.M, system.free
    if free is not None:
        K, M = free.T @ K @ free, free.T @ M @ free
    squares, vectors = lowest(K, M, count=count + rigid, shift=shift)
    flexible = vectors[:, rigid:]
    if free is not None:
        flexible = free @ flexible
    rigid_vectors = normalised(system)
    omega, flexible = _polished(system, squares[rigid:], flexible, rigid_vectors)
    flexible *= np.where(flexible[0] < 0, -1.0, 1.0)
    return Modes(omega / (2 * np.pi), flexible, rigid, rigid_vectors, system)


def _polished(system: System, squares: Array, flexible: Array, rigid: Array) -> tuple[Array, Array]:
    """(omega, vectors) of mass-normalised modes of about omega^2 ``squares``, with the energy taken from the strains.

    K carries a rounding error of eps times its largest entry. A stiff short element makes that 1e-9 of the lowest
    mode's square, and more. The strains do not have it, and the error of the vectors enters squared: about 5e-15 is
    left at every size. Where the rounding of K shows, the vectors are mixed by it too, and one Rayleigh-Ritz step parts
    them; elsewhere their Rayleigh quotients do.
    """
    flexible = flexible - rigid @ (rigid.T @ (system.M @ flexible))
    strains, heavy = system.strains(flexible), system.M @ flexible
    mass = np.einsum("ij,ij->j", flexible, heavy)
    quotients = np.einsum("ij,ij->j", strains, strains) / mass
    # the squares are those of the shifted form, less the shift
    if np.abs((squares - quotients) / (quotients + system.shift)).max(initial=0.0) < EVENLY:
        return np.sqrt(quotients), flexible / np.sqrt(mass)
    # shifted, since all frequencies are wanted to their last digits, those on the softest support too
    masses = flexible.T @ heavy
    inverse, mix = _all_of(masses, strains.T @ strains + system.shift * masses)
    mix = (mix / np.sqrt(inverse))[:, ::-1]
    energies = strains @ mix
    return np.sqrt(np.einsum("ij,ij->j", energies, energies)), flexible @ mix


def _most_modes(system: System) -> int:
    unknowns = system.mesh.unknowns if system.free is None else system.free.shape[1]
    return int(unknowns) - system.rigid.shape[1]


def lowest(K: Any, M: Any, *, count: int, shift: float) -> tuple[Array, Array]:
    """The ``count`` lowest omega^2 of K q = omega^2 M q, ascending, and vectors (unknowns, count) with q' M q = 1."""
    if not isinstance(K, np.ndarray) and suits_dense(K.shape[0], count):
        K, M = K.toarray(), M.toarray()
    if isinstance(K, np.ndarray):
        inverse, vectors = _largest(M, K + shift * M, count)
        return 1 / inverse - shift, vectors / np.sqrt(inverse)
    return _lowest_sparse(K, M, count=count, shift=shift)


def _largest(A: Any, B: Any, count: int) -> tuple[Array, Array]:
    """The ``count`` largest mu of A q = mu B q, descending, with q' B q = 1 (dense)."""
    scale = 1 / np.sqrt(B.diagonal())
    A, B = A * scale, B * scale
    A *= scale[:, None]
    B *= scale[:, None]
    if FEW * count < len(A) < SMALL:
        low, high = len(A) - count + 1, len(A)
        mu, vectors, _, _, failed = lapack().dsygvx(A.T, B.T, uplo="L", range="I", il=low, iu=high)
        check_solved(failed, "dsygvx")
        mu = mu[:count]
    else:
        mu, vectors = _all_of(A, B)
    return mu[::-1][:count], vectors[:, ::-1][:, :count] * scale[:, None]


def _all_of(A: Array, B: Array) -> tuple[Array, Array]:
    """Every mu of A q = mu B q, ascending, and vectors with q' B q = 1; A and B symmetric, B positive definite."""
    mu, vectors, failed = lapack().dsygvd(A.T, B.T, uplo="L")
    check_solved(failed, "dsygvd")
    return mu, vectors


def check_solved(failed: int, routine: str) -> None:
    """LinAlgError if a routine of LAPACK failed."""
    if failed:
        raise np.linalg.LinAlgError(f"the eigenproblem of the modes has no solution ({routine} {failed})")


def _lowest_sparse(K: Any, M: Any, *, count: int, shift: float) -> tuple[Array, Array]:
    """As `lowest`, for sparse K and M: shift-inverted Lanczos."""
    from scipy.sparse.linalg import eigsh

    start = np.ones(K.shape[0])  # a fixed start, so that the same input gives the same numbers
    squares, vectors = eigsh(K, count, M, sigma=-shift, v0=start)
    order = np.argsort(squares)
    return squares[order], vectors[:, order]


def normalised(system: System) -> Array:
    """The exact rigid motions, made orthonormal in the mass."""
    rigid = system.rigid
    if rigid.shape[1] == 0:
        return rigid
    return np.asarray(np.linalg.solve(np.linalg.cholesky(rigid.T @ (system.M @ rigid)), rigid.T).T)


def _nearest(candidates: Modes, count: int, near: float) -> Modes:
    ranked = np.argsort(np.abs(candidates.frequencies - near), kind="stable")[:count]
    chosen = np.sort(ranked)
    return replace(candidates, frequencies=candidates.frequencies[chosen], vectors=candidates.vectors[:, chosen])
