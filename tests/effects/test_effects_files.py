"""Effects in a scene file (regression)."""

from cuefem import AxialWaves, Joint, StructuralDamping, load, save
from tests.effects.test_refusals import SCENE


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
