"""Cues that tests of the beam, modes and end masses share; no tests."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from cuefem import Cue, Material, PlausibilityWarning, Scene, Segment, Tip
from studies.strokes import cue as reference_cue

KIM_DENSITY = 782.3284453057836  # kg/m3: [Kim]'s cone, 120 g
MAPLE = Material(12.6e9, 12.6e9 / 15, 700.0)
LEATHER = Material(0.1e9, 0.1e9 / 3, 950.0)
ABS = Material(2.3e9, 0.85e9, 1050.0)
STEEL = Material(200e9, 200e9 / 2.6, 7850.0)
CARBON = Material(60e9, 6e9, 1550.0)
FOAM = Material(0.07e9, 0.025e9, 60.0)


def kim() -> Cue:
    """Kim's shaft as in meshes/kim.toml: 70 cm, 120 g; the whole cue 540 g."""
    wood = Material(12.6e9, 12.6e9 / 15, KIM_DENSITY)
    return Cue((Segment(0.7, 0.012, 0.021, wood, kappa=0.9),), body_mass=0.42)


def isotropic_kim() -> Cue:
    """Kim's cone with G = E/2.6 and kappa = 39/44, that of the published frequencies."""
    return Cue((Segment(0.7, 0.012, 0.021, Material(12.6e9, 12.6e9 / 2.6, KIM_DENSITY), kappa=39 / 44),))


@contextmanager
def any_size() -> Iterator[None]:
    """Without warnings of sizes that no cue has: limits and scale models."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PlausibilityWarning)
        yield


@any_size()
def rod(slenderness: float, *, diameter: float = 0.012, material: Material = MAPLE) -> Cue:
    """A uniform rod; slenderness: length over radius."""
    return Cue((Segment(slenderness * diameter / 2, diameter, diameter, material),))


@any_size()
def cone(slenderness: float, ratio: float, *, material: Material = MAPLE) -> Cue:
    """A cone; slenderness: length over butt radius; ratio: tip over butt diameter."""
    return Cue((Segment(slenderness * 0.01, 0.02 * ratio, 0.02, material),))


def soft_tip() -> Cue:
    """A leather tip of 6 mm a hundred times softer than the maple behind it."""
    return Cue((Segment(0.006, 0.013, 0.013, LEATHER), Segment(0.7, 0.013, 0.021, MAPLE)))


def stiff_ferrule() -> Cue:
    """A steel ferrule 1 mm long between leather and maple: the largest jump of stiffness tested."""
    tip, shaft = soft_tip().segments
    return Cue((tip, Segment(0.001, 0.013, 0.013, STEEL), shaft))


def pool() -> Cue:
    """A pool shaft: leather tip, ferrule over a tenon, pro taper, cone."""
    return Cue(
        (
            Segment(0.006, 0.01275, 0.01275, LEATHER),
            Segment(0.025, 0.01275, 0.01275, ABS, 0.008, 0.008, core=MAPLE),
            Segment(0.30, 0.01275, 0.0132, MAPLE),
            Segment(0.4056, 0.0132, 0.0215, MAPLE),
        ),
        body_mass=0.43,
    )


def low_deflection() -> Cue:
    """A shaft bored from the front."""
    return Cue(
        (
            Segment(0.006, 0.0125, 0.0125, LEATHER),
            Segment(0.012, 0.0125, 0.0125, ABS, 0.008, 0.008),
            Segment(0.12, 0.0125, 0.0127, MAPLE, 0.008, 0.008),
            Segment(0.18, 0.0127, 0.0132, MAPLE),
            Segment(0.42, 0.0132, 0.0215, MAPLE),
        ),
        body_mass=0.43,
    )


FAMILY = {
    "kim": kim(),
    "pool": pool(),
    "low deflection": low_deflection(),
    "carbon tube": reference_cue("carbon"),
    "whole cue": reference_cue("whole_cue"),
}


@any_size()
def scaled(cue: Cue, *, E: float = 1.0, G: float = 1.0, rho: float = 1.0, length: float = 1.0) -> Cue:
    """The cue with the constants of every material, and every length, multiplied."""

    def material(m: Material | None) -> Material | None:
        return m and replace(m, E=m.E * E, G=m.G * G, rho=m.rho * rho)

    sizes = ("length", "tip_diameter", "butt_diameter", "tip_bore", "butt_bore")
    segments = tuple(
        replace(s, material=material(s.material), core=material(s.core), **{n: getattr(s, n) * length for n in sizes})
        for s in cue.segments
    )
    return replace(cue, segments=segments)


@any_size()
def scene(cue: Cue, contact_time: float, **tip: float) -> Scene:
    """A centre-ball impact of the cue on the default ball, with a contact of ``contact_time`` s."""
    return Scene(cue, tip=Tip(contact_time=contact_time, **tip))
