"""Bending modes of a cue, and what a ball feels of them at the tip."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse.linalg as sla
from numpy.typing import ArrayLike, NDArray

from cuefem.beam import ActsOnCue, System, assemble
from cuefem.cue import Array, Cue, LumpedCue, Section
from cuefem.quantity import Quantity, check_count, check_kind

# A sparse eigenproblem is solved densely when more than one in MANY of its modes are wanted.
MANY = 5


@dataclass(frozen=True)
class Modes:
    """Flexible bending modes of a cue, undamped, ascending in frequency.

    frequencies: (n,) Hz. vectors: (unknowns, n), mass-normalised. rigid: the number of rigid motions, whose frequency
    is exactly zero. rigid_vectors: (unknowns, rigid), mass-normalised. system: the assembled beam. radiation: see
    `TipModes`, None but where `cuefem.accuracy` ends the modes kept by a tail.
    """

    frequencies: Array
    vectors: Array
    rigid: int
    rigid_vectors: Array
    system: System
    radiation: Array | None = None

    @property
    def omega(self) -> Array:
        """Angular frequencies, rad/s, (n,)."""
        return 2 * np.pi * self.frequencies

    @property
    def highest(self) -> float:
        """Highest angular frequency kept, rad/s, without the tail's."""
        return float(self.omega[: len(self.omega) - (0 if self.radiation is None else len(self.radiation))][-1])

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
        """Loss factor of every mode, (n,), from those of EI and kGA at the Gauss points, (elements, q).

        The mean of the losses, weighted with the strain energy that is stored there; springs store theirs without loss.
        """
        weights = np.concatenate([loss.EI.ravel(), loss.kGA.ravel()])
        return np.asarray(weights @ self.system.strains(self.vectors)[: len(weights)] ** 2 / self.omega**2)


def modes(
    cue: Cue,
    count: int = 6,
    near: float | None = None,
    effects: tuple[Any, ...] = (),
    at: Any = None,
) -> Modes:
    """Flexible bending modes of a cue: the ``count`` lowest, or the ``count`` nearest to ``near`` Hz.

    effects: those of a scene; the ones that act on the cue count. at: a Resolution (its ``modes`` is not used here);
    left out, one that holds the frequencies asked for to 2e-7, the first five to 1e-9. Cost: one dense symmetric
    eigenproblem, cubic in the unknowns.
    """
    check_kind("modes cue", cue, Cue)
    check_count("modes count", count, 1)
    effects = _on_the_cue(effects)
    if near is not None:
        near = Quantity("Hz", "[0, inf)").check("modes near", near)
    below = 0 if near is None else modes_below(cue, 2 * np.pi * near)
    wanted = below + count + (0 if near is None else 2)
    elements, order = mesh_for(cue, wanted) if at is None else (at.elements, at.order)
    system = assemble(cue, elements=elements, order=order, effects=effects)
    if near is None:
        return solve(system, count)
    return _nearest(solve(system, min(wanted, _held(system))), count, near)


def _on_the_cue(effects: tuple[Any, ...]) -> tuple[ActsOnCue, ...]:
    """Those of a scene's effects that act on the cue; one at the tip leaves its modes as they are."""
    for effect in effects:
        if not hasattr(effect, "axial_mass"):
            raise TypeError(f"modes effects must be effects, as a Scene takes them; got {effect!r}")
    return tuple(effect for effect in effects if hasattr(effect, "add_to"))


def solve(system: System, count: int) -> Modes:
    """The lowest ``count`` flexible modes of an assembled beam; the rigid ones are known and need no eigenvalue.

    Solves the inverse form M q = mu (K + sigma M) q, whose large mu are the low modes, where `eigh(K, M)` loses them to
    the high ones; then `_polished`. Relative errors stay near rounding, soft tips and stiff ferrules included.
    """
    held = _held(system)
    if count > held:
        raise ValueError(f"modes: the mesh holds {held} flexible modes; got {count} wanted; use more elements or order")
    rigid, shift = system.rigid.shape[1], system.shift
    K, M, free = system.K, system.M, system.free
    if free is not None:
        K, M = free.T @ K @ free, free.T @ M @ free
    flexible = lowest(K, M, count=count + rigid, shift=shift)[:, rigid:]
    if free is not None:
        flexible = free @ flexible
    rigid_vectors = _normalised(system)
    omega, flexible = _polished(system, flexible, rigid_vectors)
    flexible *= np.where(flexible[0] < 0, -1.0, 1.0)
    return Modes(omega / (2 * np.pi), flexible, rigid, rigid_vectors, system)


def _polished(system: System, flexible: Array, rigid: Array) -> tuple[Array, Array]:
    """(omega, vectors) of one Rayleigh-Ritz step on mass-normalised modes, with the energy taken from the strains.

    K itself has lost eps times its largest entry, which a stiff short element makes 1e-9 of the lowest mode's square
    and more; the strains have not, and the error of the vectors enters squared: about 5e-15 at every size.
    """
    flexible = flexible - rigid @ (rigid.T @ (system.M @ flexible))
    strains = system.strains(flexible)
    inverse, mix = la.eigh(flexible.T @ (system.M @ flexible), strains.T @ strains, check_finite=False)
    return 1 / np.sqrt(inverse[::-1]), flexible @ (mix / np.sqrt(inverse))[:, ::-1]


def _held(system: System) -> int:
    unknowns = system.mesh.unknowns if system.free is None else system.free.shape[1]
    return int(unknowns) - system.rigid.shape[1]


def lowest(K: Any, M: Any, *, count: int, shift: float) -> Array:
    """Vectors (unknowns, count) of the ``count`` lowest omega^2 of K q = omega^2 M q, ascending, with q' M q = 1."""
    if not isinstance(K, np.ndarray) and MANY * count > K.shape[0]:
        K, M = K.toarray(), M.toarray()
    if isinstance(K, np.ndarray):
        inverse, vectors = _largest(M, K + shift * M, count)
        return np.asarray(vectors / np.sqrt(inverse))
    return _lowest_sparse(K, M, count=count, shift=shift)


def _largest(A: Any, B: Any, count: int) -> tuple[Array, Array]:
    """The ``count`` largest mu of A q = mu B q, descending, with q' B q = 1 (dense)."""
    scale = 1 / np.sqrt(B.diagonal())
    A, B = A * scale[:, None] * scale, B * scale[:, None] * scale
    mu, vectors = la.eigh(A, B, check_finite=False, overwrite_a=True, overwrite_b=True)
    return mu[::-1][:count], vectors[:, ::-1][:, :count] * scale[:, None]


def _lowest_sparse(K: Any, M: Any, *, count: int, shift: float) -> Array:
    """Vectors of the ``count`` lowest omega^2 of sparse K q = omega^2 M q, with q' M q = 1: shift-inverted Lanczos."""
    start = np.ones(K.shape[0])  # a fixed start, so that the same input gives the same numbers
    squares, vectors = sla.eigsh(K, count, M, sigma=-shift, v0=start)
    return np.asarray(vectors[:, np.argsort(squares)])


def _normalised(system: System) -> Array:
    """The exact rigid motions, made orthonormal in the mass."""
    rigid = system.rigid
    if rigid.shape[1] == 0:
        return rigid
    return np.asarray(np.linalg.solve(np.linalg.cholesky(rigid.T @ (system.M @ rigid)), rigid.T).T)


def _nearest(found: Modes, count: int, near: float) -> Modes:
    ranked = np.argsort(np.abs(found.frequencies - near), kind="stable")[:count]
    chosen = np.sort(ranked)
    return Modes(found.frequencies[chosen], found.vectors[:, chosen], found.rigid, found.rigid_vectors, found.system)


def wave_phase(cue: Cue, omega: ArrayLike) -> Array:
    """Phase of bending waves of angular frequency ``omega`` over each segment, rad: (2, segments, *omega.shape).

    The integral of the local wave numbers of Timoshenko's beam (the two branches, the second above its cut-off), at
    three points a segment: the sum over branches and segments, over pi, is nearly the number of modes below omega.
    """
    omega = np.asarray(omega, float)[..., None, None]
    lengths = np.diff(cue.nodes)
    piece = np.arange(len(lengths))[:, None]
    s = cue.section_in(piece, lengths[:, None] * np.array([0.5 - 0.15**0.5, 0.5, 0.5 + 0.15**0.5]))
    shear, rotary = s.rhoA / s.kGA, s.rhoI / s.EI
    split = np.sqrt((shear - rotary) ** 2 + 4 * s.rhoA / (s.EI * np.maximum(omega, 1e-9) ** 2))
    branches = np.array([shear + rotary + split, np.maximum(shear + rotary - split, 0)])
    phase = omega * np.sqrt(branches / 2) @ (np.array([5, 8, 5]) / 18) * lengths
    return np.moveaxis(phase, -1, 1)


def modes_below(cue: Cue, omega: float) -> int:
    """About how many flexible modes of a free cue lie below ``omega`` rad/s (never too few by more than one)."""
    return math.ceil(float(wave_phase(cue, omega).sum()) / np.pi)


_GUESSES = np.geomspace(1e0, 1e9, 100)  # angular frequencies between which `mesh_for` interpolates, rad/s


@functools.lru_cache(maxsize=32)
def _log_phases(cue: Cue) -> tuple[Array, Array]:
    """Logarithms of the phase of all waves together, and of the shortest over each segment, at `_GUESSES`.

    Kept, because a ladder or a sweep of strokes meshes one cue many times.
    """
    phases = wave_phase(cue, _GUESSES)
    return np.log(phases.sum(axis=(0, 1))), np.log(phases[0])  # the first branch has the shortest waves


def mesh_for(cue: Cue, count: int) -> tuple[int, int]:
    """(elements, order) that hold the ``count`` lowest flexible modes to 2e-7 in frequency, the first five to 1e-9.

    A polynomial of degree p follows a wave of phase P over its element once p > P/2; the error then falls faster than
    exponentially. Elements are added where the order would pass 26.
    """
    whole, shortest = _log_phases(cue)
    longest = math.exp(max(np.interp(math.log((count + 1) * math.pi), whole, own) for own in shortest))
    elements = math.ceil(longest / 2 / 18)
    return elements, math.ceil(longest / elements / 2) + 8


@dataclass(frozen=True)
class TipModes:
    """All that an impact sees of a cue: B(t) = sum of a_k a_k' cos(omega_k t), the inverse mass at the contact.

    omega: (n,) rad/s, the rigid ones (zero) first. amplitude: (n, 2), the mass-normalised displacement of the contact
    along and across the cue (u, w), 1/sqrt(kg). approach: (n,), the modal velocities of a cue that moves at unit speed
    along its axis, sqrt(kg). rotation: (n,) of the tip's section, 1/(m sqrt(kg)). damping: (n, n) viscous, 1/s, of the
    modal equations q'' + damping q' + omega^2 q = f, None without any. radiation: (n, n) likewise, but nothing is lost:
    it stands for the waves that leave the tip in modes left out. A lumped cue has omega = 0 throughout.
    """

    omega: Array
    amplitude: Array
    approach: Array
    rotation: Array
    damping: Array | None = None
    radiation: Array | None = None

    @property
    def resistance(self) -> Array | None:
        """Damping and radiation together, (n, n), 1/s; None without either."""
        parts = [part for part in (self.damping, self.radiation) if part is not None]
        return sum(parts[1:], parts[0]) if parts else None

    def lowest(self, count: int) -> TipModes:
        """The first ``count`` modes alone."""
        return self._chosen(np.arange(count))

    def _chosen(self, index: NDArray[np.intp]) -> TipModes:
        parts = (None if part is None else part[np.ix_(index, index)] for part in (self.damping, self.radiation))
        damping, radiation = (part if part is not None and part.any() else None for part in parts)
        omega, amplitude, approach, rotation = self.omega, self.amplitude, self.approach, self.rotation
        return TipModes(omega[index], amplitude[index], approach[index], rotation[index], damping, radiation)

    def beside(self, omega: Array, along: Array, radiation: Array | None = None) -> TipModes:
        """With vibrating modes of amplitude ``along`` the cue after these, (n,) each; damping is added after it.

        radiation: of the last of them, where these are a tail.
        """
        n, before = len(omega), len(self.omega)
        own = None if self.radiation is None else np.pad(self.radiation, (0, n))
        if radiation is not None:
            theirs = np.pad(radiation, (before + n - len(radiation), 0))
            own = theirs if own is None else own + theirs
        return TipModes(
            np.concatenate([self.omega, omega]),
            np.concatenate([self.amplitude, np.column_stack([along, np.zeros(n)])]),
            np.concatenate([self.approach, np.zeros(n)]),
            np.concatenate([self.rotation, np.zeros(n)]),
            None if self.damping is None else np.pad(self.damping, (0, n)),
            own,
        )

    def ascending(self) -> TipModes:
        """The same modes in the order of their frequencies."""
        return self._chosen(np.argsort(self.omega, kind="stable"))

    @property
    def transverse(self) -> tuple[Array, Array]:
        """(omega, amplitude across the cue) of the modes that move the contact across the cue."""
        moving = self.amplitude[:, 1] != 0
        return self.omega[moving], self.amplitude[moving, 1]


def lumped_tip_modes(cue: LumpedCue) -> TipModes:
    """The two modes without frequency that give a lumped cue's inverse mass (scalar fields)."""
    root = math.sqrt(cue.mass)
    across = math.sqrt(1 / cue.end_mass - cue.coupling**2 * cue.mass)
    amplitude = np.array([[1 / root, cue.coupling * root], [0.0, across]])
    return TipModes(np.zeros(2), amplitude, np.linalg.solve(amplitude.T, [1.0, 0.0]), np.zeros(2))


def tip_modes(found: Modes, axial_mass: float) -> TipModes:
    """Tip modes of a beam's bending modes beside a rigid axial motion of ``axial_mass`` kg (the first mode)."""
    vectors = np.concatenate([found.rigid_vectors, found.vectors], axis=1)
    across, turning = found.system.at_tip(vectors)
    amplitude = np.zeros((1 + len(across), 2))
    amplitude[0, 0], amplitude[1:, 1] = axial_mass**-0.5, across
    approach = np.zeros(len(amplitude))
    approach[0] = axial_mass**0.5
    omega = np.concatenate([np.zeros(1 + found.rigid), found.omega])
    damping = None
    if found.system.dashpots is not None:
        damping = np.zeros((len(omega), len(omega)))
        damping[1:, 1:] = vectors.T @ (found.system.dashpots[:, None] * vectors)
    radiation = None if found.radiation is None else np.pad(found.radiation, (len(omega) - len(found.radiation), 0))
    return TipModes(omega, amplitude, approach, np.concatenate([[0.0], turning]), damping, radiation)
