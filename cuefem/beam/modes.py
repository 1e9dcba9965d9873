"""Bending modes of a cue."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cuefem.beam.assembly import Points, System, assemble
from cuefem.beam.blas_threads import one_blas_thread
from cuefem.beam.eigensolver import EigenSolution, solve_eigenproblem
from cuefem.beam.mode_count import modes_below
from cuefem.beam.point_terms import BeamEffect
from cuefem.cue import Array, Cue, Section
from cuefem.quantity.display import brief, html_table
from cuefem.quantity.fields import Quantity, check_count, check_kind


@dataclass(frozen=True, eq=False)
class Modes(EigenSolution):
    """Undamped flexible bending modes of a cue, with their motion at one node, the tip by default.

    Attributes
    ----------
    omega : (n,) array
        Angular frequencies, rad/s, ascending; those of a truncation correction last.
    participation : (loads, n) array
        The work of each load on each mode, 1/sqrt(kg); the first load is a transverse force at the tip.
    cutoff : float
        Highest angular frequency of the retained modes, rad/s.
    resolved : float
        Highest angular frequency that the mesh determines, rad/s.
    vectors : (free, n) array
        Mass-normalised mode shapes, in the degrees of freedom of ``system``; `shape` interpolates them.
    rigid_vectors : (free, rigid) array
        Mass-normalised rigid-body modes of zero frequency.
    system : System
        The assembled beam.
    radiation, mix, spectrum, loads : arrays and Spectrum
        The eigensolution behind the modes, of `cuefem/beam/eigensolver.py`.
    """

    system: System
    rigid_vectors: Array

    def __eq__(self, other: object) -> bool:
        """Whether cue, frequencies and shapes are equal."""
        if not isinstance(other, Modes):
            return NotImplemented
        pairs = ((self.omega, other.omega), (self.vectors, other.vectors), (self.rigid_vectors, other.rigid_vectors))
        return self.system.cue == other.system.cue and all(np.array_equal(a, b) for a, b in pairs)

    def __repr__(self) -> str:
        first = self.frequencies[:6]
        more = f" and {len(self.frequencies) - len(first)} more" if len(first) < len(self.frequencies) else ""
        return f"Modes({brief(first)} Hz{more}, {self.rigid} rigid)"

    def _repr_html_(self) -> str:
        """A row a mode: its frequency, and its deflection of the tip."""
        tip = self.participation[0]
        rows = [(f"{i}", f"{f:.2f}", f"{w:.3f}") for i, (f, w) in enumerate(zip(self.frequencies, tip, strict=True), 1)]
        return html_table("Bending modes", ("mode", "frequency, Hz", "tip amplitude, 1/√kg"), rows)

    @property
    def frequencies(self) -> Array:
        """Natural frequencies, Hz, (n,); those of a truncation correction last."""
        return self.omega / (2 * np.pi)

    @property
    def points(self) -> Points:
        """The Gauss points of the beam."""
        return self.system.points

    @property
    def rigid(self) -> int:
        """Number of rigid-body modes."""
        return self.rigid_vectors.shape[1]

    @property
    def at_tip(self) -> tuple[Array, Array]:
        """Deflection, 1/sqrt(kg), and rotation, 1/(m sqrt(kg)), of the tip in the rigid-body and the flexible modes.

        If the loads act at another node, of that node.
        """
        w, theta = np.concatenate([self.loads.T @ self.rigid_vectors, self.participation], axis=1)
        return w, theta / self.system.cue.length

    def shape(self, x: ArrayLike) -> tuple[Array, Array]:
        """Deflection w and rotation theta of every mode at ``x`` m from the tip: two arrays ``(n, *x.shape)``.

        Mass-normalised: w in 1/sqrt(kg), theta in 1/(m sqrt(kg)); w(0) > 0.
        """
        x = np.asarray(x, float)
        length = self.system.cue.length
        if not np.all((x >= 0) & (x <= length)):
            raise ValueError(f"Modes.shape takes positions in [0, {length}] m; got {x}")
        return self.system.interpolate(self.vectors, x)

    def loss_factors(self, loss: Section) -> Array:
        """Loss factor of every mode, (n,), from the loss factors of EI and kGA at the Gauss points, (points,).

        Their mean weighted with the strain energy; springs store energy without loss.
        """
        fields, section, weights = (
            self.system.fields(self.vectors),
            self.system.points.section,
            self.system.points.weights,
        )
        bending, shear = (weights * loss.EI * section.EI) @ fields.dtheta**2, fields.dw - fields.theta
        return np.asarray((bending + (weights * loss.kGA * section.kGA) @ shear**2) / self.omega**2)


@one_blas_thread
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
        A frequency, Hz. By default the lowest modes are computed.
    effects
        Effects of a scene. Effects at the tip do not change the modes.
    at
        A `Resolution`, of which only elements and order count. By default the discretisation error of a frequency is
        below 1e-6, relative.

    Returns
    -------
    Modes
        ``.frequencies`` in Hz, ascending; ``.rigid``, the number of rigid-body modes; ``.shape(x)``, deflection and
        rotation of every mode at ``x`` m from the tip.

    Raises
    ------
    TypeError
        If the cue is lumped: it has no modes.
    ValueError
        If the mesh of ``at`` has fewer modes.

    Notes
    -----
    A Timoshenko beam, free at both ends unless an effect supports it (handbook: The beam). The cost is one dense
    symmetric eigenproblem, cubic in the degrees of freedom.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> result = cf.modes(cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),)), count=2)
    >>> [round(float(f), 1) for f in result.frequencies]
    [128.0, 343.8]
    """
    check_kind("modes cue", cue, Cue)
    check_count("modes count", count, 1)
    effects = _cue_effects(effects)
    if near is not None:
        near = Quantity("Hz", "[0, inf)").check("modes near", near)
    n_below = 0 if near is None else modes_below(cue, 2 * np.pi * near)
    n_modes = n_below + count + (0 if near is None else 2)
    system = assemble(cue, n_modes if at is None else at, effects, n_modes)
    if near is None:
        return solve(system, count)
    return _nearest(solve(system, min(n_modes, system.size - system.rigid_basis.shape[1])), count, near)


def _cue_effects(effects: tuple[Any, ...]) -> tuple[BeamEffect, ...]:
    """The effects that act on the cue; effects at the tip do not change its modes."""
    for effect in effects:
        if not hasattr(effect, "axial_mass"):
            raise TypeError(f"modes effects must be effects, as a Scene takes them; got {effect!r}")
    return tuple(effect for effect in effects if hasattr(effect, "add_to"))


@one_blas_thread
def solve(system: System, count: int, *, n_corrected: int = 0, position: float = 0.0) -> Modes:
    """The lowest ``count`` flexible modes of an assembled beam; the rigid-body modes need no eigenproblem.

    n_corrected: number of loads with a truncation correction (`cuefem.beam.truncation`): 1 for a force at ``position``,
    a node, m from the tip; 2 for a couple too, as where the contact lies off the cue's axis; 0 for none.
    """
    limit = system.size - system.rigid_basis.shape[1]
    if count > limit:
        raise ValueError(f"modes count must be at most {limit} on this mesh; got {count}: use more elements")
    rigid = rigid_body_modes(system)
    loads = system.unit_loads_at(position)
    spectrum = solve_eigenproblem(
        system.K, system.M, loads, shift=system.shift, rigid=rigid.shape[1], count=count, n_corrected=n_corrected
    )
    return Modes(**vars(spectrum.lowest(count)), system=system, rigid_vectors=rigid)


def rigid_body_modes(system: System) -> Array:
    """The exact rigid-body modes, mass-normalised, (free, r)."""
    basis = system.rigid_basis
    if basis.shape[1] == 0:
        return basis
    return np.asarray(np.linalg.solve(np.linalg.cholesky(basis.T @ (system.M @ basis)), basis.T).T)


def _nearest(candidates: Modes, count: int, near: float) -> Modes:
    ranked = np.argsort(np.abs(candidates.frequencies - near), kind="stable")[:count]
    return candidates.subset(np.sort(ranked))
