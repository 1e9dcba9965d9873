"""Effects in a scene file (regression)."""

from dataclasses import replace
from math import inf

import pytest

from cuefem import (
    AxialWaves,
    Elevation,
    Joint,
    LeatherTip,
    PowerLawTip,
    RollingContact,
    SecondHit,
    StructuralDamping,
    load,
    save,
)
from cuefem.io.assumed import assumed
from tests.effects.test_refusals import SCENE
from tests.helpers.strike_scenes import kim_scene


def test_a_scene_file_holds_every_linear_effect(tmp_path):
    texts = [
        'type = "Joint"\nposition = "10 in"\nrotational_compliance = "3e-4 rad/(N m)"\nshear_compliance = "1e-8 m/N"',
        'type = "StructuralDamping"',
        'type = "StructuralDamping"\nloss = 0.012',
    ]
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(effect="\n[[effects]]\n".join(texts)), encoding="utf-8")
    joint = Joint(0.254, 3e-4, 1e-8)
    scene = load(path)
    assert scene.effects == (AxialWaves(), joint, StructuralDamping(), StructuralDamping(0.012))
    save(scene, path)
    assert load(path) == scene


def test_a_scene_file_holds_a_whole_tip(tmp_path):
    text = 'type = "LeatherTip"\nheight = "6 mm"\ndome_radius = "{}"\nE = "140 MPa"\n{}'
    path = tmp_path / "scene.toml"
    for dome, more, told in (
        ("9.5 mm", "", LeatherTip(6e-3, 9.5e-3, 140e6)),
        ("inf m", 'nu = 0.3\nrho = "900 kg/m^3"', LeatherTip(6e-3, inf, 140e6, 0.3, 900.0)),
        ("0.375 in", 'shear = "4e5 N/m"\nrolls = false', LeatherTip(6e-3, 9.525e-3, 140e6, shear=4e5, rolls=False)),
    ):
        path.write_text(SCENE.format(effect=text.format(dome, more)), encoding="utf-8")
        scene = load(path)
        assert scene.effects == (AxialWaves(), told)
        assert "contact time" not in " ".join(assumed(path, ()))  # it follows from the tip
        save(scene, path)
        assert load(path) == scene


@pytest.mark.parametrize(
    ("effects", "words"),
    [
        ((PowerLawTip(1.5, 2.0), RollingContact(), SecondHit(4e-3)), 'window = "4 ms"'),
        ((Elevation(0.1, 0.25),), 'type = "Elevation"'),
    ],
)
def test_what_acts_in_the_contact_reads_back(effects, words, tmp_path):
    scene = replace(kim_scene(), effects=effects)
    save(scene, tmp_path / "scene.toml")
    assert load(tmp_path / "scene.toml") == scene
    assert words in (tmp_path / "scene.toml").read_text(encoding="utf-8")
