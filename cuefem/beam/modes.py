"""Bending modes of a cue: the eigenproblem."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cuefem.beam.mesh import ActsOnCue
from cuefem.beam.spectrum import Spectrum, spectrum
from cuefem.beam.system import Points, System, assemble
from cuefem.beam.waves import modes_below
from cuefem.cue import Array, Cue, Section
from cuefem.quantity.display import brief
from cuefem.quantity.fields import Quantity, check_count, check_kind


@dataclass(frozen=True, eq=False)
class Modes(Spectrum):
    """Flexible bending modes of a cue, undamped, as a force and a couple at one node feel them, the tip by default.

    system: the assembled beam. rigid_vectors: (free unknowns, rigid), mass-normalised motions whose frequency is
    exactly zero.
    """

    system: System
    rigid_vectors: Array

    def __repr__(self) -> str:
        first = self.frequencies[:6]
        more = f" and {len(self.frequencies) - len(first)} more" if len(first) < len(self.frequencies) else ""
        return f"Modes({brief(first)} Hz{more}, {self.rigid} rigid)"

    @property
    def frequencies(self) -> Array:
        """Hz, (n,), with those of a tail at the end."""
        return self.omega / (2 * np.pi)

    @property
    def points(self) -> Points:
        """The Gauss points of the beam."""
        return self.system.points

    @property
    def rigid(self) -> int:
        """Number of rigid motions."""
        return self.rigid_vectors.shape[1]

    @property
    def at_tip(self) -> tuple[Array, Array]:
        """Deflection, 1/sqrt(kg), and rotation, 1/(m sqrt(kg)), of the tip in the rigid motions, then in the modes.

        Or of the node where the loads of the spectrum act.
        """
        w, theta = np.concatenate([self.loads.T @ self.rigid_vectors, self.felt], axis=1)
        return w, theta / self.system.length

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
        """Loss factor of every mode, (n,), from the loss factors of EI and kGA at the Gauss points, (points,).

        It is the mean of the losses, weighted with the strain energy stored there; springs store energy without loss.
        """
        fields, section, weights = (
            self.system.fields(self.vectors),
            self.system.points.section,
            self.system.points.weights,
        )
        bent, sheared = (weights * loss.EI * section.EI) @ fields.dtheta**2, fields.dw - fields.theta
        return np.asarray((bent + (weights * loss.kGA * section.kGA) @ sheared**2) / self.omega**2)


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
        A `Resolution`, of which only elements and order count. By default frequencies hold to 1e-6.

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
    system = assemble(cue, wanted if at is None else at, effects, wanted)
    if near is None:
        return solve(system, count)
    return _nearest(solve(system, min(wanted, system.size - system.rigid.shape[1])), count, near)


def _on_the_cue(effects: tuple[Any, ...]) -> tuple[ActsOnCue, ...]:
    """The effects that act on the cue; effects at the tip do not change its modes."""
    for effect in effects:
        if not hasattr(effect, "axial_mass"):
            raise TypeError(f"modes effects must be effects, as a Scene takes them; got {effect!r}")
    return tuple(effect for effect in effects if hasattr(effect, "add_to"))


def solve(system: System, count: int, *, ended: int = 0, position: float = 0.0) -> Modes:
    """The lowest ``count`` flexible modes of an assembled beam. The rigid ones are known and need no eigenvalue.

    ended: 1 for a tail (`cuefem.beam.tail`) that takes a force at ``position``, a node, m from the tip; 2 for one that
    takes a couple too, as where the contact lies off the cue's axis.
    """
    most = system.size - system.rigid.shape[1]
    if count > most:
        raise ValueError(f"modes: the mesh holds {most} flexible modes; got {count} wanted; use more elements or order")
    rigid = normalised(system)
    loads = system.forces_at(position)
    found = spectrum(system.K, system.M, loads, shift=system.shift, rigid=rigid.shape[1], count=count, ended=ended)
    return Modes(**vars(found), system=system, rigid_vectors=rigid)


def normalised(system: System) -> Array:
    """The exact rigid motions, made orthonormal in the mass."""
    rigid = system.rigid
    if rigid.shape[1] == 0:
        return rigid
    return np.asarray(np.linalg.solve(np.linalg.cholesky(rigid.T @ (system.M @ rigid)), rigid.T).T)


def _nearest(candidates: Modes, count: int, near: float) -> Modes:
    ranked = np.argsort(np.abs(candidates.frequencies - near), kind="stable")[:count]
    return candidates.those(np.sort(ranked))
