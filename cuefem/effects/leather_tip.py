"""The leather tip by its geometry: a domed cylinder of leather on the ferrule."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from cuefem.cue import MAX_LEATHER_MODULUS, Array, Cue
from cuefem.cue.materials import LEATHER_CONSTANTS
from cuefem.effects.contact_terms import ContactTerms
from cuefem.effects.cue_effects import PointMass
from cuefem.effects.effect import CueEffect, Effect
from cuefem.effects.force_law import LeatherLaw, series_terms
from cuefem.quantity.display_units import span_text, with_unit
from cuefem.quantity.fields import DIAMETER, OutOfBounds, Quantity, check_fields, check_kind
from cuefem.solid.tip_cache import cached_table, read_table
from cuefem.solid.tip_table import (
    CURVATURE,
    HEAD_ON_RADIUS,
    MIN_SIDE,
    TipTable,
    UntabulatedTip,
    compliance,
    head_on,
    is_tabulated,
    max_position,
    rigid_patch_gain,
    table_of_tip,
)

if TYPE_CHECKING:
    from cuefem.beam.point_terms import PointTerms

# Names of dome radii, m: half of the coin's diameter (United States Mint: 17.91 and 21.21 mm).
DOMES = {"dime": 8.955e-3, "nickel": 10.605e-3, "flat": math.inf}
RADII = np.linspace(0.0, 0.5, 101)  # over D: patch radii of the stiffness curve
HEIGHTS = (0.05, 3.0)  # over D: computable heights; `covers` has the table's range
MODULI = (1e-3, 1e4)  # over E: of the layers
MAX_LAYERS = 10  # laminated tips have up to ten; 20 took two minutes


@dataclass(frozen=True)
class TipLayer:
    """A flat layer under the leather of a `LeatherTip`: a pad or another leather.

    Parameters
    ----------
    height : float
        Its height, m.
    E : float
        Young's modulus, Pa.
    nu : float, default 0.35
        Poisson's ratio, in [0, 0.49].
    rho : float, default 1000.0
        Density, kg/m^3.

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> import cuefem as cf
    >>> cf.TipLayer(height=0.8e-3, E=2e9).nu
    0.35
    """

    height: Annotated[float, Quantity("m", "(0, inf)")]
    E: Annotated[float, Quantity("Pa", "(0, inf)")]
    nu: Annotated[float, Quantity("", "[0, 0.49]")] = 0.35
    rho: Annotated[float, Quantity("kg/m^3", "(0, inf)")] = 1000.0

    def __post_init__(self) -> None:
        check_fields(self)


@dataclass(frozen=True)
class LeatherTip(CueEffect):
    """A leather tip by measurable properties: its height, its dome and its leather.

    Parameters
    ----------
    height : float
        Height of the tip from the ferrule to the apex of the dome, m, with the layers under the leather.
    dome_radius : float
        Radius of the dome, m; inf for a flat tip.
    E : float
        Young's modulus of the leather, Pa.
    nu : float, default 0.4
        Poisson's ratio of the leather, in [0, 0.49].
    rho : float, default 1000.0
        Density of the leather, kg/m^3.
    rolling : bool, default True
        Whether the contact rolls over ball and dome, which turns its normal; False for comparison.
    surface_restitution : float, default 1.0
        Square root of the part of the tangential work that the leather returns, in [0.1, 1]; along the normal this is
        the tip's restitution.
    layers : tuple of TipLayer, optional
        At most ten layers under the leather, from the ferrule up, within ``height`` and below the dome.
    diameter : float, optional
        Diameter of the tip, m, where it is smaller than the end of the ferrule; by default it is flush.

    Raises
    ------
    ValueError
        If a number is out of bounds; by the methods, if the tip does not fit a shaft of that diameter, or if its layers
        reach into the dome.

    Notes
    -----
    Adds: The static compliance of a short domed cylinder of leather in 3-D elasticity, its base fixed on the ferrule:
    the normal force over the indentation, the tangential stiffness of the patch, the moment arm of the contact about
    the ferrule's end, and the mass of the leather, lumped there. It defines the tip completely: the cue is drawn
    without its leather, and contact time and stiffness of the `Tip` follow from it. The tip unloads along the curve of
    its normal force with the indentation scaled by e^2, which returns the part e^2 of the work. The patch sticks and
    slips annulus by annulus (Mindlin and Deresiewicz): each annulus is strained by the shift of the surfaces since it
    touched, and its force is at most mu times its part of F_n. The normal turns as the contact rolls over ball and
    dome. `Outcome.energy` has "friction loss", dissipated by slipping annuli, and "tip shear", dissipated by tangential
    strain where ``surface_restitution`` is below 1 (with infinite friction, lost as the patch shrinks).

    Matters when: Always. The tip's tangential compliance is two to three times its normal one, where the patch alone
    has 4/3, and the contact grows stiffer and shorter with the speed of the stroke.

    Wrong when: The strain of the leather is large (the model is linear), the leather is loose, or its patch grows over
    the rim, where the pressure is cut off. The end section of the ferrule stays plane: its compliance under the tip
    lowers squirt a little, the more the softer the ferrule. The annuli are exact on a half-space, not on a bonded
    layer.

    Limit: The compliance vanishes in proportion to 1/E; a stiff leather keeps the moment arm of its dome.

    Source: handbook: Effects; studies/beam/leather.py; K. L. Johnson, Contact Mechanics (1985),
    chapters 3 and 4.

    The package has a table for tips without layers of nu 0.2 to 0.45, 2/15 to 3/2 of the diameter high. Any other is
    computed once, in about ten seconds, and stored in the user's cache folder.

    The offset b/R is the sine of the angle phi between the cue's axis and the normal of the contact. The contact lies
    r sin(phi) off the axis, or on the rim where the dome ends before that. Elastic methods take a ``diameter``, that
    of the tip, m.

    Examples
    --------
    >>> import cuefem as cf
    >>> tip = cf.LeatherTip(height=6e-3, dome_radius=9.5e-3, E=100e6)
    >>> compliance = tip.compliance(diameter=12.75e-3, offset=0.375, patch=2e-3)
    >>> bool(compliance[1, 1] > 2 * compliance[0, 0])
    True
    """

    needs_beam: ClassVar[bool] = True
    once: ClassVar[bool] = True
    at_tip: ClassVar[bool] = True
    part_of_cue: ClassVar[bool] = True
    defines_tip: ClassVar[bool] = True
    excludes: ClassVar[tuple[str, ...]] = ("TipDome", "TipShear", "PowerLawTip", "RollingContact", "Elevation")
    presets: ClassVar[Mapping[str, Mapping[str, Mapping[str, float]]]] = {"leather": LEATHER_CONSTANTS}

    height: Annotated[float, Quantity("m", "(0, inf)").with_typical_range(0.001, 0.015)]
    dome_radius: Annotated[float, Quantity("m", "(0, inf]", tuple(DOMES.items())).with_typical_range(0.005, 0.02)]
    E: Annotated[float, Quantity("Pa", "(0, inf)").with_typical_range(5e6, 1e9)]
    nu: Annotated[float, Quantity("", "[0, 0.49]")] = 0.4
    rho: Annotated[float, Quantity("kg/m^3", "(0, inf)").with_typical_range(40.0, 2e4)] = 1000.0
    rolling: bool = True
    surface_restitution: Annotated[float, Quantity("", "[0.1, 1]")] = 1.0
    layers: tuple[TipLayer, ...] = ()
    diameter: Annotated[float | None, DIAMETER] = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_kind("LeatherTip.layers", self.layers, (tuple, list))
        object.__setattr__(self, "layers", tuple(self.layers))
        if len(self.layers) > MAX_LAYERS:
            raise ValueError(f"LeatherTip.layers must be at most {MAX_LAYERS}; got {len(self.layers)}: join thin ones")
        low, high = (bound * self.E for bound in MODULI)
        for i, layer in enumerate(self.layers):
            check_kind(f"LeatherTip.layers[{i}]", layer, TipLayer)
            if not low <= layer.E <= high:
                bounds = Quantity("Pa", f"[{low:.6g}, {high:.6g}]")
                raise OutOfBounds(f"LeatherTip.layers[{i}].E", bounds, layer.E, ", 1e-3 to 1e4 of the leather's E")
        check_kind("LeatherTip.rolling", self.rolling, bool)

    @property
    def positions(self) -> tuple[float, ...]:
        """The end of the ferrule."""
        return (0.0,)

    def check_on(self, cue: Cue, name: str) -> None:
        """ValueError if the cue is drawn with its leather, or the tip does not fit it."""
        if cue.leather_height:
            raise ValueError(
                f"{name} must be the only leather: draw the cue without its first "
                f"{with_unit(cue.leather_height, 'm')}, which have "
                f"an E below {MAX_LEATHER_MODULUS / 1e9:g} GPa; got a {type(self).__name__} before them"
            )
        end = cue.segments[0].tip_diameter
        if self.diameter is not None and self.diameter > end * (1 + 1e-9):
            why = ", the end of the ferrule"
            raise OutOfBounds(f"{name}.diameter", Quantity("m", f"(0, {end}]"), self.diameter, why)
        self.check_diameter(self.diameter_on(end))

    def on_other_cue(self, own: Cue, other: Cue) -> LeatherTip:
        """The tip for another cue: the first that fits of itself, with a dome of the same shape, scaled as a whole."""
        scale = other.segments[0].tip_diameter / own.segments[0].tip_diameter
        domed = self.with_scaled_dome(scale)
        layers = tuple(replace(layer, height=scale * layer.height) for layer in self.layers)
        diameter = None if self.diameter is None else scale * self.diameter
        scaled = replace(domed, height=scale * self.height, layers=layers, diameter=diameter)
        return next((tip for tip in (self, domed, scaled) if tip.fits(other)), self)

    def with_scaled_dome(self, scale: float) -> LeatherTip:
        """The tip with another radius of the dome: of the same shape on a face scaled as much."""
        return replace(self, dome_radius=scale * self.dome_radius)

    def fits(self, cue: Cue) -> bool:
        """Whether a cue may have the tip."""
        try:
            self.check_on(cue, "")
        except ValueError:
            return False
        return True

    def diameter_on(self, end: float) -> float:
        """Diameter of the tip, m, on a ferrule whose end has this one, m."""
        return end if self.diameter is None else self.diameter

    def add_to(self, terms: PointTerms) -> None:
        """Add the mass of the leather, lumped at the end of the ferrule."""
        terms.add_mass(0.0, self.mass_on(terms.cue))

    def mass_on(self, cue: Cue) -> float:
        """Mass of the leather on this cue, kg."""
        return self.mass(self.diameter_on(cue.segments[0].tip_diameter))

    def mass_on_face(self, cue: Cue) -> float | None:
        """The mass of the leather."""
        return self.mass_on(cue)

    def without_tip(self, cue: Cue) -> tuple[Effect, ...]:
        """The mass of the leather remains."""
        return (PointMass(position=0.0, mass=self.mass_on(cue)),)

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The whole tip, and the rolling contact."""
        if terms.tip_diameter is not None:  # `check_effects` rejects a lumped cue
            terms.tip = self
            terms.tip_diameter = self.diameter_on(terms.tip_diameter)
        terms.turns = terms.turns or self.rolling

    def check_diameter(self, diameter: float) -> None:
        """Check that the tip fits a shaft, and that its height is computable.

        Parameters
        ----------
        diameter
            Diameter of the tip, m.

        Raises
        ------
        ValueError
            If it does not; the message states the bound.
        """
        DIAMETER.check("diameter", diameter)
        if self.dome_radius < diameter / 2:
            raise ValueError(
                f"dome radius {with_unit(self.dome_radius, 'm')} is too small: a {with_unit(diameter, 'm')} tip "
                f"needs at least {with_unit(diameter / 2, 'm')}"
            )
        dome = self._dome_depth(diameter / 2)
        if self.height <= dome:
            raise ValueError(
                f"a leather tip on {with_unit(diameter, 'm')} must be higher than {with_unit(dome, 'm')}, the depth of "
                f"its dome; got {with_unit(self.height, 'm')}"
            )
        layers = math.fsum(layer.height for layer in self.layers)
        if self.layers and layers > self.height - dome - MIN_SIDE * diameter:
            raise ValueError(
                f"layers of a leather tip must be at most {with_unit(self.height - dome - MIN_SIDE * diameter, 'm')} "
                f"high together, to end below its dome; got {with_unit(layers, 'm')}"
            )
        low, high = (bound * diameter for bound in HEIGHTS)
        if not low * (1 - 1e-9) <= self.height <= high * (1 + 1e-9):
            raise ValueError(
                f"a leather tip on {with_unit(diameter, 'm')} must be {span_text(low, high, 'm', 3)} high; "
                f"got {with_unit(self.height, 'm')}"
            )

    def mass(self, diameter: float) -> float:
        """Mass of the leather.

        Parameters
        ----------
        diameter
            Diameter of the tip, m.

        Returns
        -------
        float
            Mass of the domed cylinder, kg, with its layers.
        """
        self.check_diameter(diameter)
        depth, rim = self._dome_depth(diameter / 2), diameter / 2
        cap = math.pi * depth * (3 * rim**2 + depth**2) / 6
        excess = math.fsum((layer.rho - self.rho) * layer.height for layer in self.layers)  # instead of leather
        return self.rho * (math.pi * rim**2 * (self.height - depth) + cap) + math.pi * rim**2 * excess

    def moment_arm(self, phi: float, diameter: float) -> tuple[float, float]:
        """Moment arm of the contact about the end of the ferrule.

        Parameters
        ----------
        phi
            Angle of the contact, rad.
        diameter
            Diameter of the tip, m.

        Returns
        -------
        tuple of float
            Displacement (u, w) of the contact per unit rotation of the ferrule's end section, m: along the cue and
            across it. On the dome (-r sin(phi), -(h - r (1 - cos(phi)))), on the rim (-D/2, -(h - depth of the dome)).
        """
        distance = min(self._axis_distance(phi), diameter / 2)
        return -math.copysign(distance, phi), -(self.height - self._dome_depth(distance))

    def compliance(self, diameter: float, offset: float, patch: ArrayLike) -> Array:
        """Compliance of a patch under Hertz's pressure: its mean displacement weighted with the load.

        Parameters
        ----------
        diameter
            Diameter of the tip, m.
        offset
            b/R in (-1, 1), the sine of the contact's angle.
        patch
            Radius of the patch in the plane that touches the dome at its centre, m, at most half of the diameter; one
            or an array of them.

        Returns
        -------
        ndarray
            (..., 2, 2), m/N, symmetric, in (n, t): n into the leather, t in the plane of the cue's axis and the
            contact, for positive offsets away from the axis and down the dome. With both reversed (n into the ball, t
            towards the axis) it is the same matrix. The opposite offset has the opposite coupling, in the same frame.

        Notes
        -----
        Where the patch reaches over the rim, the traction there is cut off and the rest scaled up. On a steep dome
        (b/R > 0.75) the patch stays at the end of the table, short of the rim; only normal and tangent turn further.
        """
        self.check_diameter(diameter)
        bounds, patch = Quantity("m", f"(0, {diameter / 2}]"), np.asarray(patch)
        radii = np.array([bounds.check("patch", radius) for radius in patch.flat]) / diameter
        matrices = self._compliance(diameter, offset, radii) / (self.E * diameter)
        return np.asarray(matrices.reshape(*patch.shape, 2, 2))

    def head_on(self, diameter: float, ball_radius: float) -> tuple[Array, Array, Array]:
        """Normal force over the indentation of a ball on the dome, without friction.

        Parameters
        ----------
        diameter
            Diameter of the tip, m.
        ball_radius
            Radius of the ball, m.

        Returns
        -------
        tuple of ndarray
            Radius of the patch, m; depth by which ball and ferrule have come closer, m; force, N. All start at zero
            and rise, up to the largest patch, of radius 0.45 diameters. Beyond it, extrapolate
            the force with the slope of the last two points: the patch, whose edge is at the rim, no longer grows.

        Notes
        -----
        The ball is rigid, and the pressure acts along the axis, in between the normal of the dome and that of the
        ball. It vanishes at the edge of the patch.
        """
        Quantity("m", "(0, inf)").check("ball_radius", ball_radius)
        radius = np.linspace(0.0, HEAD_ON_RADIUS[1], 91)[1:]
        scaled = head_on(self._table(diameter), radius, ball_radius / diameter)
        force, depth = np.vstack([np.zeros(2), scaled * [self.E * diameter**2, diameter]]).T
        return np.append(0.0, radius * diameter), depth, force

    def shear_stiffness(self, diameter: float, offset: float) -> tuple[Array, Array]:
        """Tangential stiffness of a patch that sticks to the ball.

        Parameters
        ----------
        diameter
            Diameter of the tip, m.
        offset
            b/R in (-1, 1), the sine of the contact's angle.

        Returns
        -------
        tuple of ndarray
            Radius of the patch, from zero to half of the diameter, m; stiffness along t, N/m.

        Notes
        -----
        From the compliance of the Hertz-weighted patch, less the difference between it and a rigid patch: a sixth on a
        half-space, 0.05 (1 - nu/2)/(G a); less of it on thin leather and for a wide patch, more on a dome
        (`cuefem.solid.tip_table.rigid_patch_gain`).
        """
        height = self.height - self._dome_depth(self._position(diameter, offset)[0] * diameter / 2)
        compliance = self._compliance(diameter, offset, RADII[1:])[:, 1, 1]
        compliance -= rigid_patch_gain(self.nu, self._curvature(diameter), height / diameter, RADII[1:])
        stiffness = np.maximum.accumulate(1 / compliance)  # near the rim it levels off, to a thousandth
        return RADII * diameter, np.append(0.0, self.E * diameter * stiffness)

    def rim(self, diameter: float) -> float:
        """The contact's angle at which the dome ends, rad; ``diameter``: of the tip, m."""
        return math.asin(diameter / 2 / self.dome_radius) if self.dome_radius > diameter / 2 else math.pi / 2

    def law(self, diameter: float, ball_radius: float, offset: float, restitution: float) -> LeatherLaw:
        """The tip's forces on a ball at an offset b/R >= 0; diameter: of the tip, m."""
        return _law(self, diameter, ball_radius, offset, restitution)

    def _dome_depth(self, distance: float) -> float:
        """Depth of the dome below its apex at a distance from the axis, m."""
        return distance**2 / self.dome_radius / (1 + math.sqrt(max(1 - (distance / self.dome_radius) ** 2, 0.0)))

    def _axis_distance(self, phi: float) -> float:
        """Distance of the contact from the axis on a dome without a rim, m."""
        return abs(self.dome_radius * math.sin(phi)) if phi else 0.0

    def _table(self, diameter: float) -> TipTable:
        self.check_diameter(diameter)
        tip = self._untabulated_tip(diameter)
        if tip is not None:
            return cached_table(tip)
        return table_of_tip(self.height / diameter, self._curvature(diameter), self.nu)

    def _curvature(self, diameter: float) -> float:
        return min(diameter / self.dome_radius, CURVATURE[1])

    def _untabulated_tip(self, diameter: float) -> UntabulatedTip | None:
        """The tip, lengths over its diameter, if the table does not cover it; else None."""
        height = self.height / diameter
        if not self.layers and is_tabulated(height, self.nu):
            return None
        layers = tuple((layer.height / diameter, layer.E / self.E, layer.nu) for layer in self.layers)
        return UntabulatedTip(height, self._curvature(diameter), self.nu, layers)

    def is_cached(self, diameter: float) -> bool:
        """Whether the tip's elasticity is in the table or in the cache.

        Parameters
        ----------
        diameter
            Diameter of the tip, m.

        Returns
        -------
        bool
            False if the next use takes about ten seconds of computation.
        """
        self.check_diameter(diameter)
        tip = self._untabulated_tip(diameter)
        return tip is None or read_table(tip) is not None

    def _position(self, diameter: float, offset: float) -> tuple[float, float]:
        """Distance of the patch's centre from the axis over the tip's radius, and by how much the contact's angle
        exceeds that of the dome there, rad."""
        Quantity("", "(-1, 1)").check("offset", offset)
        phi, curvature = math.asin(abs(offset)), diameter / self.dome_radius
        position = min(2 * self._axis_distance(phi) / diameter, max_position(min(curvature, CURVATURE[1])))
        return position, phi - math.asin(min(curvature * position / 2, 1.0))

    def _compliance(self, diameter: float, offset: float, radii: Array) -> Array:
        """E D times the compliance at radii over D."""
        position, tilt = self._position(diameter, offset)
        matrices = compliance(self._table(diameter), position, radii)
        rotation = np.array([[math.cos(tilt), -math.sin(tilt)], [math.sin(tilt), math.cos(tilt)]])
        matrices = rotation @ matrices @ rotation.T
        matrices = (matrices + matrices.transpose(0, 2, 1)) / 2  # of rounding
        return matrices * np.array([[1, math.copysign(1, offset)], [math.copysign(1, offset), 1]])


@lru_cache(maxsize=64)
def _loading_curve(tip: LeatherTip, diameter: float, ball_radius: float) -> tuple[Array, Array, tuple[float, ...]]:
    """Patch radius and indentation of a central impact, without zero, and the force's series, shared by the laws of all
    offsets."""
    patch, depth, force = (values[1:] for values in tip.head_on(diameter, ball_radius))
    return patch, depth, series_terms(np.sqrt(depth), force, lowest=3)


@lru_cache(maxsize=256)
def _law(tip: LeatherTip, diameter: float, ball_radius: float, offset: float, restitution: float) -> LeatherLaw:
    """The force-indentation law of a tip."""
    patch, depth, force_terms = _loading_curve(tip, diameter, ball_radius)
    radius, shear = tip.shear_stiffness(diameter, offset)
    # stiffness over radius is nearly straight
    stiffness = patch * np.interp(patch, radius[1:], shear[1:] / radius[1:])
    root = np.sqrt(depth)
    compliance_terms = series_terms(root, root / stiffness, lowest=0)
    return LeatherLaw(force_terms, compliance_terms, restitution, float(depth[-1]), tip.surface_restitution)
