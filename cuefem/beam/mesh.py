"""Resolution and elements of a cue."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array
from cuefem.quantity.fields import check_count

MIN_STEPS, MAX_STEPS = 20, 1_000_000  # in a head-on contact time


@dataclass(frozen=True)
class Resolution:
    """Resolution of a finite-element cue and of its contact.

    Parameters
    ----------
    elements
        Number of elements in each smooth piece of the cue.
    order
        Polynomial degree p of the rotation; the deflection has degree p + 1.
    modes
        Number of flexible bending modes; the rigid-body modes are always included.
    steps
        Steps of the contact in a head-on contact time, 20 to 1,000,000; by default 400, with a
        `LeatherTip` 200.

    Raises
    ------
    TypeError
        If a number is not whole.
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> import cuefem as cf
    >>> fine = cf.Resolution(elements=4, order=16, modes=60)
    """

    elements: int
    order: int
    modes: int
    steps: int | None = None

    def __post_init__(self) -> None:
        if self.steps is not None:
            check_count("Resolution.steps", self.steps, MIN_STEPS, MAX_STEPS)
        for name in ("elements", "order", "modes"):
            check_count(f"Resolution.{name}", getattr(self, name), 1)


@dataclass(frozen=True, eq=False)
class Mesh:
    """Elements of a cue.

    nodes: (elements + 1,) m. orders: (elements,) polynomial degrees of the rotation. first: (elements,) each element's
    first degree of freedom. n_dof: number of degrees of freedom. Neighbouring elements share the two of their node,
    unless a joint divides the node.
    """

    nodes: Array
    orders: NDArray[np.intp]
    first: NDArray[np.intp]
    n_dof: int

    def node(self, x: float) -> int:
        """Index of the node at position ``x``."""
        return int(np.argmin(np.abs(self.nodes - x)))

    @property
    def last(self) -> NDArray[np.intp]:
        """Degree of freedom of the deflection at each element's butt end: (elements,)."""
        return self.first + 2 * self.orders + 1

    def dofs_at(self, node: int) -> tuple[int, int]:
        """Degrees of freedom (w, theta) of a node; at a joint, those of the butt side."""
        first = int(self.first[node]) if node < len(self.first) else self.n_dof - 2
        return first, first + 1

    def dofs_before(self, node: int) -> tuple[int, int]:
        """Degrees of freedom (w, theta) on the tip side of a node inside the cue."""
        last = int(self.last[node - 1])
        return last, last + 1
