"""Verification of sensitivities: the sum rule, and central differences of the end mass itself."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cuefem import Cue, Material, PointMass, Resolution, Scene, Tip, load
from cuefem.design.sensitivity import Sensitivity, sensitivity
from cuefem.endmass.definitions import end_mass
from tests.helpers.cues import drawn, kim, low_deflection

MESHES = Path(__file__).parents[2] / "meshes"
AT = Resolution(3, 8, 14)


def scene(cue: Cue, contact_time: float = 1e-3) -> Scene:
    return Scene(cue, tip=Tip(contact_time=contact_time))


def integral(found: Sensitivity, cue: Cue, *names: str) -> float:
    """Integral of densities times their properties."""
    section = cue.section(found.x)
    return math.fsum(found.weights @ (getattr(found, name) * getattr(section, name)) for name in names)


@pytest.mark.parametrize("path", sorted(MESHES.glob("*.toml")), ids=lambda path: path.stem)
def test_the_parts_add_up_to_the_end_mass(path: Path) -> None:
    """handbook: Effective end mass, on every cue in meshes/."""
    cue = load(path)
    assert isinstance(cue, Cue)
    struck = scene(cue)
    found = sensitivity(struck, Resolution(2, 14, 40))
    whole = found.end_mass - struck.ball.mass * found.ball_mass - struck.axial_mass * found.axial_mass
    assert integral(found, cue, "rhoA", "rhoI", "EI", "kGA") == pytest.approx(whole, rel=1e-8)
    assert found.end_mass == pytest.approx(end_mass(struck, "stick", Resolution(2, 14, 40)), rel=1e-11)


def test_the_sum_is_that_of_the_handbook() -> None:
    """Kim's shaft, 1 ms: 1.0206 m_e."""
    found = sensitivity(scene(kim()))
    sum_of_parts = integral(found, kim(), "rhoA", "rhoI", "EI", "kGA")
    assert sum_of_parts / found.end_mass == pytest.approx(1.0206, abs=6e-5)


def slope(function: Callable[[float], float], step: float) -> float:
    """Derivative at 0 by central differences of two steps, Richardson's: error of step^4."""
    wide, narrow = ((function(h) - function(-h)) / (2 * h) for h in (step, step / 2))
    return (4 * narrow - wide) / 3


CUES = pytest.mark.parametrize("cue", [kim(), low_deflection(), drawn("carbon")], ids=["kim", "hollow", "carbon"])


@CUES
def test_a_gram_somewhere(cue: Cue) -> None:
    """The density of rhoA is the end mass that a point mass there adds."""
    fine = Resolution(4, 20, 14)  # so fine that the node which the point mass needs changes nothing
    found = sensitivity(scene(cue), fine)
    i = len(found.x) // 3
    masses = 1e-6 * np.arange(3)
    felt = [end_mass(replace(scene(cue), effects=(PointMass(found.x[i], m),)), "stick", fine) for m in masses[1:]]
    bare = end_mass(scene(cue), "stick", fine)
    measured = (4 * (felt[0] - bare) - (felt[1] - bare)) / masses[2]
    assert measured == pytest.approx(found.rhoA[i] + found.axial_mass, rel=1e-6)


def multiplied(cue: Cue, constant: str, factor: float) -> Cue:
    """The cue with a constant of every material, and every core, multiplied; Poisson's ratio follows."""

    def material(m: Material | None) -> Material | None:
        return m and replace(m, nu=0.0, **{constant: getattr(m, constant) * factor})

    segments = (replace(s, material=material(s.material), core=material(s.core)) for s in cue.segments)
    return replace(cue, segments=tuple(segments))


@CUES
@pytest.mark.parametrize(("constant", "names"), [("E", ["EI"]), ("G", ["kGA"]), ("rho", ["rhoA", "rhoI"])])
def test_sensitivity_to_material_constant_equals_difference(cue: Cue, constant: str, names: list[str]) -> None:
    """nu = 0 makes the shear coefficient free of E and G; a denser cue is heavier along the axis too."""
    cue = multiplied(cue, constant, 1.0)
    found = sensitivity(scene(cue), AT)
    want = integral(found, cue, *names) + (found.axial_mass * cue.shaft_mass if constant == "rho" else 0.0)
    measured = slope(lambda h: end_mass(scene(multiplied(cue, constant, 1 + h)), "stick", AT), 1e-2)
    assert measured == pytest.approx(want, rel=1e-6)
