"""Effects that cannot be: one line that names the field, its bound, its unit and the value."""

import re
from dataclasses import replace
from math import inf, nan

import pytest

from cuefem import (
    AxialWaves,
    Joint,
    LumpedCue,
    PointMass,
    StructuralDamping,
    Support,
    TipDome,
    TipShear,
    load,
    modes,
    save,
)
from tests.helpers.strike_scenes import KIM, kim_scene


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PointMass(nan, 0.01), "PointMass.position must be in [0, inf) m; got nan"),
        (lambda: PointMass(inf, 0.01), "PointMass.position must be in [0, inf) m; got inf"),
        (lambda: PointMass(-0.1, 0.01), "PointMass.position must be in [0, inf) m; got -0.1"),
        (lambda: PointMass(0.1, -0.01), "PointMass.mass must be in [0, inf) kg; got -0.01"),
        (lambda: PointMass(0.1, inf), "PointMass.mass must be in [0, inf) kg; got inf"),
        (lambda: PointMass(0.1, 0.1, -1.0), "PointMass.rotary_inertia must be in [0, inf) kg m^2; got -1.0"),
        (lambda: Support(nan), "Support.position must be in [0, inf) m; got nan"),
        (lambda: Support(0.1, -1.0), "Support.stiffness must be in [0, inf] N/m; got -1.0"),
        (lambda: Support(0.1, 0, nan), "Support.rotational_stiffness must be in [0, inf] N m/rad; got nan"),
        (lambda: Support(0.1, dashpot=inf), "Support.dashpot must be in [0, inf) N s/m; got inf"),
        (lambda: Joint(0.0), "Joint.position must be in (0, inf) m; got 0.0"),
        (lambda: Joint(nan), "Joint.position must be in (0, inf) m; got nan"),
        (lambda: Joint(0.1, -1.0), "Joint.rotational_compliance must be in [0, inf) rad/(N m); got -1.0"),
        (lambda: Joint(0.1, inf), "Joint.rotational_compliance must be in [0, inf) rad/(N m); got inf"),
        (lambda: Joint(0.1, 0, inf), "Joint.shear_compliance must be in [0, inf) m/N; got inf"),
        (lambda: StructuralDamping(1.0), "StructuralDamping.loss must be in [0, 1); got 1.0"),
        (lambda: StructuralDamping(-0.1), "StructuralDamping.loss must be in [0, 1); got -0.1"),
        (lambda: TipDome(-0.01), "TipDome.radius must be in [0, inf) m; got -0.01"),
        (lambda: TipShear(0.0), "TipShear.ratio must be in (0, inf); got 0.0"),
        (lambda: TipShear(inf), "TipShear.ratio must be in (0, inf); got inf"),
    ],
)
def test_a_field_out_of_bounds(make, message):
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        make()


@pytest.mark.parametrize("value", ["10 g", None, True])
def test_a_field_that_is_no_number(value):
    with pytest.raises(TypeError, match=r"^PointMass.mass must be a number in \[0, inf\) kg; got "):
        PointMass(0.1, value)


OFF = [(PointMass(0.71, 0.01), "[0, 0.7] m, on the cue"), (Support(0.8, 1.0), "[0, 0.7] m, on the cue")]
ENDS = [(Joint(0.7, 1e-3), "(0, 0.7) m, between the ends of the cue"), (Joint(0.9), "(0, 0.7) m, between the ends")]


@pytest.mark.parametrize(("effect", "bound"), OFF + ENDS)
def test_a_position_off_the_cue(effect, bound):
    words = f"position must be in {bound}"
    with pytest.raises(ValueError, match=re.escape(f"Scene.effects[1].{words}") + f".*; got {effect.position}$"):
        replace(kim_scene(), effects=(PointMass(0.1, 0.0), effect))
    with pytest.raises(ValueError, match=re.escape(f"{type(effect).__name__}.{words}") + f".*; got {effect.position}$"):
        modes(KIM, 3, effects=(effect,))


def test_the_very_end_is_on_the_cue_but_for_rounding():
    assert modes(KIM, 1, effects=(Support(0.7 * (1 + 1e-12), inf, inf),)).rigid == 0


def test_two_clamps_at_one_place():
    clamp, turned = Support(0.7, inf, inf), Support(0.7, 0.0, inf)
    message = (
        "Scene.effects[2].stiffness must be in [0, inf) N/m at 0.7 m, where effects[0] is a clamp already; got inf"
    )
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        replace(kim_scene(), effects=(clamp, Support(0.2, inf), clamp))
    with pytest.raises(ValueError, match=r"^Scene.effects\[1\].rotational_stiffness must be in \[0, inf\) N m/rad at"):
        replace(kim_scene(), effects=(clamp, turned))
    with pytest.raises(ValueError, match=r"^a clamp must be the only one at its place; got two at 0.7 m"):
        modes(KIM, 3, effects=(clamp, turned))
    # one holds the deflection, the other the rotation; springs beside a clamp are no second clamp
    replace(kim_scene(), effects=(Support(0.7, inf), turned, Support(0.7, 5.0)))


@pytest.mark.parametrize("effect", [PointMass(0.1, 0.01), Support(0.1, 5.0), Joint(0.1), AxialWaves(), TipDome(0.01)])
def test_a_lumped_cue_has_no_place_for_it(effect):
    message = f"got {type(effect).__name__}, which needs a finite-element Cue"
    with pytest.raises(
        ValueError, match=r"^Scene.effects\[1\] must be an effect that a LumpedCue can have.*" + message
    ):
        replace(kim_scene(), cue=LumpedCue(0.54, 0.005), effects=(TipShear(0.75), effect))


def test_axial_waves_act_once():
    with pytest.raises(
        ValueError, match=r"^Scene.effects\[2\] must be another effect, AxialWaves acts once; got Axial"
    ):
        replace(kim_scene(), effects=(AxialWaves(), TipShear(1.0), AxialWaves()))


def test_what_is_no_effect():
    with pytest.raises(TypeError, match=r"^Scene.effects\[1\] must be a Effect; got 'TipDome'$"):
        replace(kim_scene(), effects=(TipShear(1.0), "TipDome"))


SCENE = """
[[effects]]
type = "AxialWaves"
[[effects]]
{effect}
[cue]
body_mass = "0.42 kg"
[[cue.segments]]
length = "0.7 m"
tip_diameter = "12 mm"
butt_diameter = "21 mm"
material = {{ E = "12.6 GPa", G = "0.84 GPa", rho = "700 kg/m^3" }}
"""


@pytest.mark.parametrize(
    ("effect", "words"),
    [
        ('type = "Joint"\nposition = "0.71 m"', r"effects\[1\].position: must be in \(0, 0.7\) m, between"),
        ('type = "PointMass"\nposition = "71 cm"\nmass = "5 g"', r"effects\[1\].position: must be in \[0, 0.7\] m, on"),
        ('type = "Joint"\nposition = 0.3', r"effects\[1\].position: must be in \(0, inf\) m, a length with its unit"),
        ('type = "AxialWaves"', r"effects\[1\]: must be another effect, AxialWaves acts once"),
    ],
)
def test_a_scene_file_names_the_effect(tmp_path, effect, words):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(effect=effect), encoding="utf-8")
    with pytest.raises(ValueError, match=rf"^{re.escape(str(path))}: {words}"):
        load(path)


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
