"""Effects in a scene file (regression)."""

from math import inf

import cuefem as cf
from cuefem.io.assumed import assumed
from tests.effects.test_refusals import SCENE


def test_a_scene_file_holds_every_linear_effect(tmp_path):
    texts = [
        'type = "Joint"\nposition = "10 in"\nrotational_compliance = "3e-4 rad/(N m)"\nshear_compliance = "1e-8 m/N"',
        'type = "StructuralDamping"',
        'type = "StructuralDamping"\nloss = 0.012',
    ]
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(effect="\n[[effects]]\n".join(texts)), encoding="utf-8")
    joint = cf.Joint(0.254, 3e-4, 1e-8)
    scene = cf.load(path)
    assert scene.effects == (cf.AxialWaves(), joint, cf.StructuralDamping(), cf.StructuralDamping(0.012))
    cf.save(scene, path)
    assert cf.load(path) == scene


def test_a_scene_file_holds_a_whole_tip(tmp_path):
    text = 'type = "LeatherTip"\nheight = "6 mm"\ndome_radius = "{}"\nE = "140 MPa"\n{}'
    path = tmp_path / "scene.toml"
    for dome, more, told in (
        ("9.5 mm", "", cf.LeatherTip(6e-3, 9.5e-3, 140e6)),
        ("inf m", 'nu = 0.3\nrho = "900 kg/m^3"', cf.LeatherTip(6e-3, inf, 140e6, 0.3, 900.0)),
        ("0.375 in", 'shear = "4e5 N/m"\nrolls = false', cf.LeatherTip(6e-3, 9.525e-3, 140e6, shear=4e5, rolls=False)),
    ):
        path.write_text(SCENE.format(effect=text.format(dome, more)), encoding="utf-8")
        scene = cf.load(path)
        assert scene.effects == (cf.AxialWaves(), told)
        assert "contact time" not in " ".join(assumed(path, ()))  # it follows from the tip
        cf.save(scene, path)
        assert cf.load(path) == scene
