"""Comparison of cues: differences, shared errors, invalid input (properties)."""

import math
from dataclasses import replace

import pytest

import cuefem as cf
from cuefem.parameters.parts import main_material
from cuefem.parameters.scene_changes import with_parameters
from cuefem.results.differences import SHAPE_FLOOR
from cuefem.results.uncertainty import MASS_ERROR, RATIO_FLOOR, SHAFT_ERROR
from tests.helpers.cues import kim

SCENE = cf.Scene(kim(), tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(2.0, 0.3))
BORED = with_parameters(SCENE, {"bore depth": 0.1, "bore width": 0.006})


TWIN = {"a": SCENE, "b": replace(SCENE)}


def test_comparison_of_equal_cues_has_error_floor() -> None:
    same = cf.compare(TWIN, same_shaft=True).differences["b"]
    assert same["squirt"]["error"] == pytest.approx(RATIO_FLOOR, rel=1e-9)
    assert same["shaft_mass"]["error"] == same["frequency_1"]["error"] == pytest.approx(SHAPE_FLOOR, rel=1e-9)


def test_comparison_of_two_woods_adds_input_errors() -> None:
    compared = cf.compare(TWIN)
    two = compared.differences["b"]
    assert "not distinct" in compared.sentences()[0]
    assert not any(each["distinct"] for each in two.values())
    heavier = with_parameters(SCENE, {"rho": main_material(SCENE.shaft).rho * math.exp(0.1)})
    assert two["shaft_mass"]["error"] > 0.9 * (heavier.shaft.shaft_mass / SCENE.shaft.shaft_mass - 1)


@pytest.mark.heavy
def test_comparison_with_tube_names_the_measurement_of_its_stiffness() -> None:
    """E of a tube is known to a factor of 2; with its E measured the rest is that of the wood, as computed."""
    scenes = {name: cf.usual_scene(cf.load(f"meshes/{name}.toml")) for name in ("pool_maple", "carbon")}
    compared = cf.compare(scenes)
    uncertain, remains = compared.unmeasured_moduli["carbon"]
    assert uncertain == "carbon"
    error = compared.differences["carbon"]["tip_stiffness"]["error"]
    assert remains < error / 3
    (note,) = (note for note in compared.table().notes if note.startswith("Stiffness"))
    assert f"± {100 * error:.0f} %" in note
    assert note.endswith(f"± {100 * remains:.0f} % remain.")
    assert cf.compare(TWIN).unmeasured_moduli == {}


@pytest.mark.heavy
def test_comparison_with_shaft_masses_has_smaller_error() -> None:
    faster = replace(SCENE, stroke=cf.Stroke(4.0, 0.1))
    light, heavy = (with_parameters(scene, {"shaft mass": mass}) for scene, mass in ((SCENE, 0.112), (faster, 0.128)))
    weighed = cf.compare({"light": light, "heavy": heavy})
    assert (weighed.speed, weighed.offset) == (SCENE.stroke.speed, SCENE.stroke.offset)
    mass = weighed.differences["heavy"]["shaft_mass"]
    assert (mass["error"] < 0.01, mass["distinct"]) == (True, True)
    bare = cf.compare({"light": SCENE, "heavy": with_parameters(SCENE, {"rho": 880.0})})
    assert bare.differences["heavy"]["squirt"]["error"] > weighed.differences["heavy"]["squirt"]["error"]


@pytest.mark.heavy
def test_comparison_with_point_mass_has_larger_error() -> None:
    """The model error of a ratio with a point mass is MASS_ERROR."""
    clip = replace(SCENE, effects=(*SCENE.effects, cf.PointMass(position=0.05, mass=0.011)))
    squirt = cf.compare({"plain": SCENE, "clip": clip}, same_shaft=True).differences["clip"]["squirt"]
    assert squirt["error"] >= MASS_ERROR * squirt["difference"] > SHAFT_ERROR * squirt["difference"]


def test_comparison_miscue_has_no_squirt() -> None:
    miscues = {name: replace(scene, stroke=cf.Stroke(2.0, 0.8)) for name, scene in (("a", SCENE), ("b", BORED))}
    compared = cf.compare(miscues)
    assert math.isnan(compared.cues["a"]["squirt"])
    assert not {"squirt", "pivot_length"} & {*compared.differences["b"]}
    (sentence,) = compared.gaps()
    assert sentence.startswith("b and a cannot be compared in squirt: miscue at b/R 0.8")
    assert str(compared).count("miscue at") == compared.to_html("compare").count("miscue at") == 1
