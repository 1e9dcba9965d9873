"""Cues: the geometry of a drawing and the section properties of its beam; and lumped cues."""

from __future__ import annotations

import math
from collections.abc import Iterable
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from itertools import takewhile
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cuefem.quantity.fields import (
    DIAMETER,
    LENGTH,
    MAX_SEGMENTS,
    OutOfBounds,
    Quantity,
    check_fields,
    check_kind,
)
from cuefem.quantity.unit_checks import CUE_DIAMETER

Array = NDArray[np.float64]

# A material at the tip of a smaller E than this, Pa, is leather: leathers have 0.05 to 0.2 GPa, the softest plastics of
# ferrules 1.2 GPa, woods about 10 GPa.
MAX_LEATHER_MODULUS = 1e9
# Positions count as one if they are closer than this fraction of the cue's length: round-off of summed lengths.
POSITION_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Material:
    """A linear elastic material: isotropic, or wood along the grain.

    Parameters
    ----------
    E
        Young's modulus along the cue, Pa.
    G
        Shear modulus in planes that contain the cue's axis, Pa; independent of E and nu, as in wood.
    rho
        Density, kg/m3.
    loss
        Loss factor of bending, for scenes with `StructuralDamping`.
    nu
        Poisson's ratio of axial tension. In a beam it only affects the shear coefficient.
    transverse_ratio
        Transverse Young's modulus over E, for a material that is isotropic in the plane across its axis: wood as a mean
        over its rings, or a wound tube. Only the solid model of a cue uses it; by default 1.
    nu_transverse
        Poisson's ratio of transverse tension, for the transverse strain. Only the solid model uses it; by default nu.

    Raises
    ------
    ValueError
        If a number is out of bounds, if 2 nu G/E is not below 1, or if nu_transverse is not below 1 - 2 nu^2
        transverse_ratio: the elastic energy must be positive.

    Examples
    --------
    >>> import cuefem as cf
    >>> maple = cf.Material(E=12.6e9, G=1.1e9, rho=700.0)
    >>> cf.Material(E=12.6e9, G=-1.0, rho=700.0)
    Traceback (most recent call last):
    ...
    ValueError: Material.G must be in (0, inf) Pa; got -1.0
    """

    E: Annotated[float, Quantity("Pa", "(0, inf)").with_typical_range(5e6, 6e11)]
    G: Annotated[float, Quantity("Pa", "(0, inf)").with_typical_range(5e6, 6e11)]
    rho: Annotated[float, Quantity("kg/m^3", "(0, inf)").with_typical_range(40.0, 2e4)]
    loss: Annotated[float, Quantity("", "[0, 1)")] = 0.0
    nu: Annotated[float, Quantity("", "[0, 0.5]")] = 0.3
    transverse_ratio: Annotated[float | None, Quantity("", "(0, inf)")] = None
    nu_transverse: Annotated[float | None, Quantity("", "(0, 1)")] = None

    def __post_init__(self) -> None:
        check_fields(self)
        if 2 * self.nu * self.G >= self.E:
            why = f", E/(2 nu) of E = {self.E} Pa, nu = {self.nu}"
            raise OutOfBounds("Material.G", Quantity("Pa", f"(0, {self.E / (2 * self.nu)})"), self.G, why)
        if self.transverse_ratio is None and self.nu_transverse is None:
            return
        limit = 1 - 2 * self.nu**2 * self.E_transverse / self.E
        if not self.nu_in_plane < limit:
            why = f", 1 - 2 nu^2 transverse_ratio of nu = {self.nu}, transverse_ratio = {self.E_transverse / self.E}"
            raise OutOfBounds("Material.nu_transverse", Quantity("", f"(0, {limit})"), self.nu_in_plane, why)

    @property
    def E_transverse(self) -> float:
        """Transverse Young's modulus, Pa."""
        return self.E * (1.0 if self.transverse_ratio is None else self.transverse_ratio)

    @property
    def nu_in_plane(self) -> float:
        """Poisson's ratio in the transverse plane."""
        return self.nu if self.nu_transverse is None else self.nu_transverse

    @property
    def effective_poisson_ratio(self) -> float:
        """The nu_e with nu_e/(1 + nu_e) = 2 nu G/E (handbook: The beam); nu itself if the material is isotropic."""
        ratio = 2 * self.nu * self.G / self.E
        return ratio / (1 - ratio)


def shear_coefficient(nu: ArrayLike, bore_ratio: ArrayLike = 0.0) -> Array:
    """Timoshenko's shear coefficient of a round section, solid or hollow.

    nu: effective Poisson ratio; bore_ratio: bore over outer diameter, in [0, 1). Both broadcast.
    Source: Hutchinson, J. Appl. Mech. 68 (2001) 87, circle and hollow circle.
    """
    nu, c = np.asarray(nu), np.asarray(bore_ratio) ** 2  # they may be complex: derivatives take a complex step
    numerator = 6 * (1 + c) ** 2 * (1 + nu) ** 2
    denominator = 7 + 34 * c + 7 * c**2 + nu * (12 + 48 * c + 12 * c**2) + nu**2 * (4 + 16 * c + 4 * c**2)
    return np.asarray(numerator / denominator)


class Section(NamedTuple):
    """Section properties at some points, each an array of the points' shape.

    EA: axial stiffness, N. EI: bending stiffness, N m2. kGA: shear stiffness kappa G A, N.
    rhoA: mass per length, kg/m. rhoI: rotary inertia per length, kg m.
    """

    EA: Array
    EI: Array
    kGA: Array
    rhoA: Array
    rhoI: Array


@dataclass(frozen=True)
class Segment:
    """A conical piece of a cue: solid, hollow, or with a core of another material in its bore.

    Diameters run linearly from the tip end to the butt end.

    Parameters
    ----------
    length
        m.
    tip_diameter, butt_diameter
        Outer diameters at the two ends, m.
    material
        Of the shell, or of the whole piece if it has no bore.
    tip_bore, butt_bore
        Diameters of the bore at the two ends, m; each smaller than the outer diameter.
    core
        Material that fills the bore; by default the bore is empty. A ferrule over a tenon is a segment of ferrule
        material with a core of wood.
    kappa
        Timoshenko's shear coefficient of the whole section. By default shell and core each have that of their shape
        and Poisson's ratio (Hutchinson 2001).

    Raises
    ------
    ValueError
        If a number is out of bounds, or if a bore is not smaller than its outer diameter.

    Examples
    --------
    >>> import cuefem as cf
    >>> shaft = cf.Segment(0.7, 0.012, 0.021, cf.Material(E=12.6e9, G=0.84e9, rho=700.0))
    >>> round(shaft.mass, 4)
    0.1074
    """

    length: Annotated[float, LENGTH.with_typical_range(0.002, 1.6)]
    tip_diameter: Annotated[float, DIAMETER.with_typical_range(*CUE_DIAMETER)]
    butt_diameter: Annotated[float, DIAMETER.with_typical_range(*CUE_DIAMETER)]
    material: Material
    tip_bore: Annotated[float, Quantity("m", "[0, inf)").with_typical_range(0.001, 0.03)] = 0.0
    butt_bore: Annotated[float, Quantity("m", "[0, inf)").with_typical_range(0.001, 0.03)] = 0.0
    core: Material | None = None
    kappa: Annotated[float | None, Quantity("", "(0, 1]")] = None

    def __post_init__(self) -> None:
        check_fields(self)
        check_kind("Segment.material", self.material, Material)
        check_kind("Segment.core", self.core, (Material, type(None)))
        for end in ("tip", "butt"):
            bore, outer = getattr(self, f"{end}_bore"), getattr(self, f"{end}_diameter")
            if bore >= outer:
                raise OutOfBounds(f"Segment.{end}_bore", Quantity("m", f"[0, {outer})"), bore, ", its outer diameter")

    @property
    def mass(self) -> float:
        """Exact mass of the piece, kg (frustum formula, shell and core)."""
        bore = _frustum(self.length, self.tip_bore, self.butt_bore)
        shell = _frustum(self.length, self.tip_diameter, self.butt_diameter) - bore
        return self.material.rho * shell + (self.core.rho * bore if self.core else 0.0)

    @property
    def centre(self) -> float:
        """Distance of the centre of mass from the tip end of the piece, m."""
        outer, bore = (self.tip_diameter, self.butt_diameter), (self.tip_bore, self.butt_bore)
        shell = _frustum_moment(self.length, *outer) - _frustum_moment(self.length, *bore)
        core = self.core.rho * _frustum_moment(self.length, *bore) if self.core else 0.0
        return (self.material.rho * shell + core) / self.mass

    @cached_property
    def constants(self) -> Array:
        """The segment as one row of numbers in the order of `SegmentRows`, to evaluate many segments together."""
        shell, core = self.material, self.core
        inner = (core.E, core.G, core.rho, core.effective_poisson_ratio) if core else (0.0, 0.0, 0.0, 0.0)
        return np.array(
            [
                *(self.length, self.tip_diameter, self.butt_diameter, self.tip_bore, self.butt_bore),
                *(shell.E, shell.G, shell.rho, shell.effective_poisson_ratio),
                *inner,
                np.nan if self.kappa is None else self.kappa,
            ]
        )

    def section(self, s: ArrayLike) -> Section:
        """Section properties at distances ``s`` from the tip end of the piece, m."""
        return section_properties(SegmentRows(*self.constants), np.asarray(s, float))


class SegmentRows(NamedTuple):
    """The numbers of one segment, or arrays of many; nu is the effective Poisson ratio, kappa is nan by default."""

    length: Array
    tip_diameter: Array
    butt_diameter: Array
    tip_bore: Array
    butt_bore: Array
    E: Array
    G: Array
    rho: Array
    nu: Array
    core_E: Array
    core_G: Array
    core_rho: Array
    core_nu: Array
    kappa: Array


def section_properties(c: SegmentRows, s: Array) -> Section:
    """Section properties at distances ``s``, m, from the tip ends of the segments ``c``; both broadcast."""
    t = s / c.length
    outer = c.tip_diameter + (c.butt_diameter - c.tip_diameter) * t
    bore = c.tip_bore + (c.butt_bore - c.tip_bore) * t
    outer2, bore2 = outer**2, bore**2
    area, core_area = np.pi / 4 * (outer2 - bore2), np.pi / 4 * bore2
    inertia, core_inertia = np.pi / 64 * (outer2**2 - bore2**2), np.pi / 64 * bore2**2
    shell, core = _shear_coefficients(c, bore / outer)
    return Section(
        c.E * area + c.core_E * core_area,
        c.E * inertia + c.core_E * core_inertia,
        shell * c.G * area + core * c.core_G * core_area,
        c.rho * area + c.core_rho * core_area,
        c.rho * inertia + c.core_rho * core_inertia,
    )


def _frustum(length: float, first: float, last: float) -> float:
    return math.pi / 12 * length * (first**2 + first * last + last**2)


def _frustum_moment(length: float, first: float, last: float) -> float:
    return math.pi / 48 * length**2 * (first**2 + 2 * first * last + 3 * last**2)


def _shear_coefficients(c: SegmentRows, bore_ratio: Array) -> tuple[Array, Array]:
    default = np.isnan(c.kappa)
    if not default.any():
        return c.kappa, c.kappa
    shell = shear_coefficient(c.nu, bore_ratio)
    core = shear_coefficient(c.core_nu) if np.any(c.core_G) else c.core_G
    return np.where(default, shell, c.kappa), np.where(default, core, c.kappa)


class AssumedDrawing(NamedTuple):
    """A cue as it was loaded, and what was assumed of it: an `Assumption` each. A later change of the cue ends some.

    warnings: of the file that was read, such as a column that is not used.
    """

    cue: Cue
    listed: tuple[Any, ...] = ()
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class Cue:
    """A cue of segments from tip to butt, and the mass of the rest of the cue.

    Parameters
    ----------
    segments
        `Segment` objects from the tip on.
    body_mass
        Mass of the rest of the cue, kg. It moves axially only ([Kim] sec. 4): it adds to the axial mass, but not to
        the inertia of bending.
    shaft_mass_measured
        Whether the density of the main material was computed from the measured mass of the shaft. It is then no
        uncertain parameter.
    assumed_body_mass
        The body mass that was assumed because a drawing has none, kg (`usual_scene`). While ``body_mass`` equals it, it
        is an uncertain parameter.
    assumed
        What a drawing left open, set by `cuefem.load`.

    Raises
    ------
    TypeError
        If the segments are not a sequence of `Segment`.
    ValueError
        If there is no segment, or more than 2001: 2000 of a drawing, and the rest of the cue (see `AxialWaves`).

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> cue.length, round(cue.shaft_mass, 4), round(cue.mass, 4)
    (0.7, 0.1074, 0.5374)
    """

    segments: tuple[Segment, ...]
    body_mass: Annotated[float, Quantity("kg", "[0, inf)").with_typical_range(0.05, 0.8)] = 0.0
    shaft_mass_measured: bool = False
    assumed_body_mass: Annotated[float, Quantity("kg", "[0, inf)")] = 0.0
    assumed: AssumedDrawing | None = field(default=None, compare=False, repr=False)

    def __repr__(self) -> str:
        count = f"{len(self.segments)} segment{'s' if len(self.segments) > 1 else ''}"
        return f"Cue({count}, {self.length:.4g} m, {self.shaft_mass:.4g} kg, body_mass={self.body_mass:.4g})"

    def __post_init__(self) -> None:
        check_fields(self)
        if isinstance(self.segments, Segment):
            raise TypeError("Cue.segments must be a sequence of Segment; got one Segment")
        object.__setattr__(self, "segments", tuple(self.segments))
        if not self.segments:
            raise ValueError("Cue.segments must hold at least one Segment; got none")
        limit = MAX_SEGMENTS + 1  # of a drawing, and the rest of the cue that `AxialWaves` adds
        if len(self.segments) > limit:
            raise ValueError(f"Cue.segments must hold at most {limit} segments; got {len(self.segments)}")
        for i, segment in enumerate(self.segments):
            check_kind(f"Cue.segments[{i}]", segment, Segment)

    def assuming(self, listed: Iterable[Any], warnings: Iterable[str]) -> Cue:
        """The cue with what was assumed of it as it is now: the fields of `AssumedDrawing`."""
        made = copy(self)
        object.__setattr__(made, "assumed", AssumedDrawing(self, tuple(listed), tuple(warnings)))
        return made

    @cached_property
    def nodes(self) -> Array:
        """Positions of the ends of the segments, m from the tip, shape (segments + 1,)."""
        return np.concatenate([[0.0], np.cumsum([s.length for s in self.segments])])

    @cached_property
    def lengths(self) -> Array:
        """Lengths of the segments, m, (segments,)."""
        return np.diff(self.nodes)

    @cached_property
    def length(self) -> float:
        """Length of the modelled cue, m."""
        return float(self.nodes[-1])

    @cached_property
    def leather_height(self) -> float:
        """Length of the leather tip, m: of the first segments with E below `MAX_LEATHER_MODULUS`; 0 if all are."""
        leathers = takewhile(lambda segment: segment.material.E < MAX_LEATHER_MODULUS, self.segments)
        count = sum(1 for _ in leathers)
        return float(self.nodes[count]) if count < len(self.segments) else 0.0

    @cached_property
    def shaft_mass(self) -> float:
        """Mass of the segments, kg."""
        return sum(s.mass for s in self.segments)

    @property
    def is_body_mass_assumed(self) -> bool:
        """Whether the body mass was assumed and not changed since."""
        return 0.0 < self.body_mass == self.assumed_body_mass

    @property
    def mass(self) -> float:
        """Mass of the segments and the rest of the cue, kg: the rigid-body axial mass."""
        return self.shaft_mass + self.body_mass

    @property
    def balance_point(self) -> float:
        """Centre of mass of the segments, m from the front of the first."""
        moments = (s.mass * (x + s.centre) for s, x in zip(self.segments, self.nodes, strict=False))
        return math.fsum(moments) / self.shaft_mass

    def section(self, x: ArrayLike) -> Section:
        """Section properties at ``x`` in [0, length] m from the tip; at a jump those of the butt side."""
        x = np.asarray(x, float)
        if not np.all((x >= 0) & (x <= self.length)):
            raise ValueError(f"Cue.section x must be in [0, {self.length}] m; got {x}")
        piece = np.clip(np.searchsorted(self.nodes, x, side="right") - 1, 0, len(self.segments) - 1)
        return self.section_in(piece, x - self.nodes[piece])

    def section_in(self, piece: NDArray[np.intp], s: Array) -> Section:
        """Section properties inside the segments of index ``piece``, at ``s`` m from their tip ends (broadcasting)."""
        return section_properties(SegmentRows(*self._constants[:, piece]), s)

    @cached_property
    def _constants(self) -> Array:
        return np.array([segment.constants for segment in self.segments]).T


@dataclass(frozen=True)
class LumpedCue:
    """A cue as its inverse mass at the tip: two numbers, or three for a domed tip.

    Parameters
    ----------
    mass
        Axial inertia at the tip, kg.
    end_mass
        Transverse inertia at the tip, kg: the effective end mass m_e. [Kim]'s m_c is four times as large: see
        `two_part`.
    coupling
        Transverse velocity of the tip per unit of axial impulse, 1/kg; between -1 and 1 over sqrt(mass end_mass). It is
        defined at positive offsets, and changes sign with the offset.

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Notes
    -----
    In axial u and transverse w the tip's inverse mass is [[1/mass, coupling], [coupling, 1/end_mass]].

    Examples
    --------
    >>> import cuefem as cf
    >>> cf.LumpedCue.two_part(mass=0.54, cue_end_mass=0.012).end_mass  # [Kim]'s cue end of 12 g
    0.003
    """

    # Empty: distinguishes a lumped cue from a finite-element one.
    segments: ClassVar[tuple[Segment, ...]] = ()

    mass: Annotated[float, Quantity("kg", "(0, inf)").with_typical_range(0.1, 1.0)]
    end_mass: Annotated[float, Quantity("kg", "(0, inf)").with_typical_range(1e-3, 0.1)]
    coupling: Annotated[float, Quantity("1/kg", "(-inf, inf)")] = 0.0

    def __post_init__(self) -> None:
        check_fields(self)
        bound = 1 / math.sqrt(self.mass * self.end_mass)
        if not abs(self.coupling) < bound:
            raise ValueError(f"LumpedCue.coupling must be in ({-bound}, {bound}) 1/kg; got {self.coupling}")

    @classmethod
    def two_part(cls, mass: float, cue_end_mass: float, nu_c: float = 1 / 3) -> LumpedCue:
        """[Kim] sec. 4: the whole ``mass`` moves axially, and only a cue end of mass m_c transversely.

        cue_end_mass: [Kim]'s m_c, kg; nu_c: inertia factor of the cue end. The end mass is m_c nu_c/(1 + nu_c).
        """
        return cls(mass, _end_mass(cue_end_mass, nu_c, "LumpedCue.two_part"))

    @classmethod
    def rigid(cls, mass: float, nu_c: float = 0.136) -> LumpedCue:
        """[Kim] sec. 2: a rigid cue of end mass mass nu_c/(1 + nu_c), with [Kim]'s nu_c of a whole cue."""
        return cls(mass, _end_mass(mass, nu_c, "LumpedCue.rigid"))


def _end_mass(mass: float, nu_c: float, name: str) -> float:
    nu_c = Quantity("", "(0, inf)").check(f"{name} nu_c", nu_c)
    return mass * nu_c / (1 + nu_c)
