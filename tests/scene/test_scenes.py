"""The scenes of studies/scenes and the cues of meshes/ against their READMEs (regression)."""

import math
import re
from pathlib import Path

import pytest

import cuefem as cf
from studies.strokes import cue as reference_cue

SCENES = Path(__file__).parents[2] / "studies" / "scenes"
NAMES = ("break_cue", "carom", "clay_on_shaft", "kim", "pool_low_deflection", "snooker")


def rows() -> dict[str, list[str]]:
    """Rows of the scenes' README by name: content, ball, offset, squirt, effects."""
    lines = (SCENES / "README.md").read_text(encoding="utf-8").splitlines()
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("| [")]
    return {row[0][1:].partition("]")[0]: row[1:] for row in cells}


def test_ready_scenes_are_all_listed() -> None:
    assert tuple(sorted(path.stem for path in SCENES.glob("*.toml"))) == tuple(sorted(rows())) == NAMES


def test_kim_mesh_has_published_dimensions() -> None:
    """[Kim] sec. 4: radius 6 to 10.5 mm over 0.70 m, 120 g, a cue of 540 g; E 12.6 GPa, G = E/15."""
    cue = reference_cue("kim")
    (cone,) = cue.segments
    assert cue.shaft_mass == pytest.approx(0.120, rel=1e-12)
    assert cue.mass == pytest.approx(0.540, rel=1e-12)
    assert (cone.length, cone.tip_diameter, cone.butt_diameter, cone.kappa) == (0.70, 0.012, 0.021, 0.9)
    assert pytest.approx((12.6e9, 15), rel=1e-14) == (cone.material.E, cone.material.E / cone.material.G)


def test_readme_of_meshes_states_computed_squirts() -> None:
    text = (SCENES.parents[1] / "meshes" / "README.md").read_text(encoding="utf-8")
    stated = re.findall(r"([\d.]+)° \((\w+)\)", text.partition("Squirt at b/R 0.3 is then ")[2].partition(".\n")[0])
    assert len(stated) == 5
    for squirt, name in stated:
        assert f"{math.degrees(cf.strike(cf.usual_scene(reference_cue(name))).squirt):.2f}" == squirt


@pytest.mark.heavy
@pytest.mark.parametrize("name", NAMES)
def test_ready_scene_equals_its_readme(name: str) -> None:
    reference = cf.load_scene(SCENES / f"{name}.toml")
    outcome = cf.strike(reference, rtol=1e-3)
    _, ball, offset, squirt, effects = rows()[name]
    assert ball == f"{2e3 * reference.ball.radius:g} mm, {1e3 * reference.ball.mass:g} g"
    assert float(offset) == reference.stroke.offset
    assert effects == (", ".join(type(effect).__name__ for effect in reference.effects) or "none")
    assert outcome.regime == "stick"
    assert math.degrees(outcome.squirt) == pytest.approx(float(squirt), rel=1e-3, abs=5e-4)
