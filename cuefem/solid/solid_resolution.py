"""The resolution of a solid cue, in a module of its own that does not import scikit-fem."""

from __future__ import annotations

from dataclasses import dataclass

from cuefem.quantity.fields import check_count


@dataclass(frozen=True)
class Solid:
    """Resolution of a cue that is computed as a solid of revolution, by 3-D elasticity, instead of a beam.

    Parameters
    ----------
    order : int
        Polynomial degree of the elements, 2 to 12.
    modes : int
        Number of flexible bending modes, 1 to 400. The two rigid-body modes are always included.

    Raises
    ------
    TypeError
        If a number is not an integer.
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> import cuefem as cf
    >>> cone = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(E=12.6e9, G=4.85e9, rho=700.0)),), body_mass=0.4)
    >>> scene = cf.Scene(cone, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
    >>> mesh = cf.Resolution(elements=4, order=16, modes=30)
    >>> beam, solid = cf.strike(scene, at=mesh), cf.strike(scene, at=cf.Solid(modes=30))
    >>> abs(beam.squirt / solid.squirt - 1) < 1e-3
    True
    """

    order: int = 6
    modes: int = 60

    def __post_init__(self) -> None:
        for name, low, high in (("order", 2, 12), ("modes", 1, 400)):
            count = getattr(self, name)
            check_count(f"Solid.{name}", count, low)
            if count > high:
                raise ValueError(f"Solid.{name} must be in [{low}, {high}]; got {count}")
