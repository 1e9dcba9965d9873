"""Additions to a drawing by options: material, ferrule, bore, leather front, body mass (regression)."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.cue.materials import material
from cuefem.files.shaft_additions import with_additions
from tests.helpers.command_line import as_json, call
from tests.helpers.examples import examples

BARE = "x [mm],diameter [mm]\n0,12\n700,21\n"
MAPLE, ASH, ABS = map(material, ("hard maple", "ash", "abs"))
CONE = cf.Cue((cf.Segment(0.7, 0.012, 0.021, MAPLE),))


def shaft(folder: Path, text: str = BARE) -> Path:
    path = folder / "shaft.csv"
    path.write_text(text)
    return path


@examples(30)
@given(st.floats(2, 59), st.sampled_from(["abs", "Melamine", "carbon fibre", "brass"]), st.booleans())
def test_ferrule_by_text_has_its_length_and_material(length: float, name: str, backwards: bool) -> None:
    text = f"{name} ferrule {length!r} mm" if backwards else f"{length!r} mm {name}"
    cue = with_additions(CONE, ferrule=f"{text}, tenon 8 mm")
    front, behind = cue.segments
    assert (front.length, front.tip_bore, front.butt_bore) == pytest.approx((length / 1e3, 0.008, 0.008), rel=1e-9)
    assert (front.material, front.core, behind.material) == (material(name), MAPLE, MAPLE)
    assert cue.length == pytest.approx(0.7, rel=1e-12)
    other = [segment.length for segment in with_additions(cue, ferrule="20 mm nylon").segments if segment.core]
    assert sum(other) == pytest.approx(0.02, rel=1e-9)  # the first ferrule is replaced
    assert with_additions(CONE, ferrule=f"{text}, no tenon").segments[0].core is None


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
@pytest.mark.parametrize("text", ["6.35 mm wide, 127 mm deep", "1/4 in wide, 5 in deep"])
def test_bore_by_text_in_any_unit_is_the_same(text: str) -> None:
    front, behind = with_additions(CONE, bore=text).segments
    assert (front.length, front.tip_bore, front.butt_bore) == pytest.approx((0.127, 0.00635, 0.00635), rel=1e-9)
    assert behind.tip_bore == 0


def test_ferrule_without_tenon_text_reports_the_default_tenon(tmp_path: Path) -> None:
    assumed = [
        as_json("modes", shaft(tmp_path), "--ferrule", f"25 mm melamine{x}")["assumptions"] for x in ("", ", no tenon")
    ]
    assert ["tenon" in " ".join(each) for each in assumed] == [True, False]


def test_load_body_mass_equals_the_option(tmp_path: Path) -> None:
    csv, ounces = shaft(tmp_path), 15 * 0.028349523125
    assert [cf.load(csv, body_mass=mass).body_mass for mass in ("15 oz", ounces, 0)] == pytest.approx(
        [ounces, ounces, 0]
    )
    assert call("convert", csv, tmp_path / "cue.toml", "--body-mass", "15 oz")[0] == 0
    assert cf.load(tmp_path / "cue.toml") == cf.load(csv, body_mass="15 oz")
    cf.save(cf.usual_scene(CONE), tmp_path / "scene.toml")
    assert cf.load(tmp_path / "scene.toml", body_mass="1 lb", material="ash").cue.body_mass == pytest.approx(0.45359237)
