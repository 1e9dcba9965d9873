"""Density of the end mass along the cue: the sum rule, and central differences of the end mass (verification)."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from cuefem import Cue, Resolution, Scene, Tip, load_cue
from cuefem.endmass.definitions import end_mass
from cuefem.endmass.end_mass_density import EndMassDensity, end_mass_density
from studies.strokes import cue as reference_cue
from tests.helpers.cues import kim, low_deflection, scaled

MESHES = Path(__file__).parents[2] / "meshes"
AT = Resolution(3, 8, 14)


def scene(cue: Cue, contact_time: float = 1e-3) -> Scene:
    return Scene(cue, tip=Tip(contact_time=contact_time))


def integral(result: EndMassDensity, cue: Cue, *names: str) -> float:
    """Integral of densities times their properties."""
    section = cue.section(result.x)
    return math.fsum(result.weights @ (getattr(result, name) * getattr(section, name)) for name in names)


@pytest.mark.heavy
@pytest.mark.parametrize("path", sorted(MESHES.glob("*.toml")), ids=lambda path: path.stem)
def test_end_mass_density_parts_sum_to_end_mass(path: Path) -> None:
    """handbook: Effective end mass, on every cue in meshes/."""
    cue = load_cue(path)
    base = scene(cue)
    result = end_mass_density(base, Resolution(2, 14, 40))
    whole = result.end_mass - base.ball.mass * result.ball_mass - base.axial_mass * result.axial_mass
    assert integral(result, cue, "rhoA", "rhoI", "EI", "kGA") == pytest.approx(whole, rel=1e-8)
    assert result.end_mass == pytest.approx(end_mass(base, "stick", Resolution(2, 14, 40)), rel=1e-11)


def test_end_mass_density_sum_of_kim_shaft_equals_handbook() -> None:
    """Kim's shaft, 1 ms: 1.0206 m_e."""
    result = end_mass_density(scene(kim()))
    sum_of_parts = integral(result, kim(), "rhoA", "rhoI", "EI", "kGA")
    assert sum_of_parts / result.end_mass == pytest.approx(1.0206, abs=6e-5)


def slope(function: Callable[[float], float], step: float) -> float:
    """Derivative at 0 by central differences of two steps, Richardson's: error of step^4."""
    wide, narrow = ((function(h) - function(-h)) / (2 * h) for h in (step, step / 2))
    return (4 * narrow - wide) / 3


CUES = pytest.mark.parametrize("cue", [low_deflection(), reference_cue("carbon")], ids=["bored", "tube"])


@CUES
@pytest.mark.parametrize(("constant", "names"), [("E", ["EI"]), ("G", ["kGA"]), ("rho", ["rhoA", "rhoI"])])
def test_end_mass_density_to_material_constant_equals_difference(cue: Cue, constant: str, names: list[str]) -> None:
    """A stated shear coefficient is independent of E and G; a denser cue has a larger axial mass."""
    cue = replace(cue, segments=tuple(replace(segment, kappa=0.9) for segment in cue.segments))
    result = end_mass_density(scene(cue), AT)
    expected = integral(result, cue, *names) + (result.axial_mass * cue.shaft_mass if constant == "rho" else 0.0)
    measured = slope(lambda h: end_mass(scene(scaled(cue, **{constant: 1 + h})), "stick", AT), 1e-2)
    assert measured == pytest.approx(expected, rel=1e-6)
