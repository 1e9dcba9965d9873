"""The springs, dashpots, masses, clamps and joints that effects add at the nodes of a cue."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from cuefem.beam.mesh import Mesh
from cuefem.cue import Array, Cue

# A joint with less compliance than this, relative to the whole shaft's, is rigid: its spring would add round-off error.
MIN_COMPLIANCE = 1e-9


class PointTerms:
    """What effects add at nodes: springs, dashpots, masses and clamps, and compliances between the sides of a joint.

    stiffness, dashpot, mass: (n_dof,), diagonal terms. fixed: clamped degrees of freedom. compliance: of a joint, by
    its degrees of freedom on the tip and the butt side. At a joint, the degrees of freedom of the node are those of the
    butt side.
    """

    def __init__(self, mesh: Mesh, cue: Cue) -> None:
        self.mesh, self.cue = mesh, cue
        self.stiffness, self.dashpot, self.mass = np.zeros((3, mesh.n_dof))
        self.compliance: dict[tuple[int, int], float] = {}
        self.fixed: set[int] = set()

    def add_mass(self, x: float, mass: float, rotary_inertia: float = 0.0) -> None:
        """Add a mass, kg, with its rotary inertia, kg m2, at position ``x``, m."""
        self._add(self.mass, x, mass, rotary_inertia)

    def add_dashpot(self, x: float, lateral: float) -> None:
        """Add a dashpot on the deflection, N s/m, at position ``x``, m."""
        self._add(self.dashpot, x, lateral, 0.0)

    def add_springs(self, x: float, lateral: float, rotational: float) -> None:
        """Add springs on deflection, N/m, and rotation, N m/rad, at position ``x``, m; an infinite one is a clamp."""
        dofs = self.mesh.dofs_at(self.mesh.node(x))
        self.fixed.update(dof for dof, k in zip(dofs, (lateral, rotational), strict=True) if np.isinf(k))
        self._add(self.stiffness, x, *(0.0 if np.isinf(k) else k for k in (lateral, rotational)))

    def _add(self, diagonal: Array, x: float, w: float, theta: float) -> None:
        diagonal[list(self.mesh.dofs_at(self.mesh.node(x)))] += (w, theta)

    def join(self, x: float, w: float, theta: float) -> None:
        """Add a joint at position ``x`` with compliances ``w`` (m/N) and ``theta`` (rad/(N m)); zero: no jump."""
        node, section = self.mesh.node(x), self.cue.section(min(x, self.cue.length))
        pairs = zip(self.mesh.dofs_before(node), self.mesh.dofs_at(node), strict=True)
        for pair, value, stiffness in zip(pairs, (w, theta), (section.kGA, section.EI), strict=True):
            compliant = value * stiffness > MIN_COMPLIANCE * self.cue.length
            self.compliance[pair] = self.compliance.get(pair, 0.0) + (value if compliant else 0.0)


class BeamEffect(Protocol):
    """Interface of an effect that acts on the cue."""

    @property
    def positions(self) -> tuple[float, ...]:
        """Positions that must be mesh nodes, m from the tip."""

    @property
    def joint_positions(self) -> tuple[float, ...]:
        """Positions where deflection and rotation may jump, m from the tip."""

    def check_on(self, cue: Cue, name: str) -> None:
        """ValueError, naming the effect ``name``, unless all its positions lie on the cue."""

    def add_to(self, terms: PointTerms) -> None:
        """Add the effect's point terms."""
