"""The request of a command: its scene, and its assumptions as objects (properties)."""

from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cli.request import Request
from cuefem.designer.state import read_design
from cuefem.designs.study_file import base_assumptions
from cuefem.files import InputError

SURFACE, KIM = Path("meshes/kim.stl"), Path("meshes/kim.toml")


def test_request_has_scene_of_options_and_assumes_only_the_others() -> None:
    request = Request.of(KIM, {"game": "carom", "speed": "3 m/s", "offset": None, "dome": None})
    assert request.scene.stroke.speed == 3
    assert request.scene.ball.mass == pytest.approx(0.209, abs=0.01)
    assumed = {each.key: each for each in request.assumptions}
    assert not {"game", "speed"} & set(assumed)
    assert (assumed["dome"].of, assumed["dome"].option, assumed["tip_height"].option) == ("tip", "dome", "")
    assert str(assumed["dome"]) == f"{assumed['dome'].text} (--dome)"
    assert str(assumed["tip_height"]) == assumed["tip_height"].text
    with pytest.raises(InputError, match="--speed: must be"):
        _ = Request.of(KIM, {"speed": "0 m/s"}).scene


def test_request_without_impact_is_as_drawn_until_an_option_sets_the_tip() -> None:
    drawn = Request.of(KIM, {"dome": None}, with_impact=False)
    assert drawn.scene == cf.Scene(cf.load(KIM))
    assert "game" not in {each.key for each in drawn.assumptions}
    assert Request.of(KIM, {"dome": "9 mm"}, with_impact=False).scene.leather_tip.dome_radius == 0.009


def test_assumption_names_an_option_only_where_it_is_one(tmp_path: Path) -> None:
    """The unit of a surface has an option in `strike`, none in a study and in the designer."""
    assert "lengths in mm (--length-unit)" in map(str, Request.of(SURFACE, {"length_unit": None}).assumptions)
    (tmp_path / "study.toml").write_text(f'scene = "{SURFACE.resolve().as_posix()}"\n', encoding="utf-8")
    base = cf.usual_scene(cf.load(SURFACE))
    assert "lengths in mm" in map(str, base_assumptions(tmp_path / "study.toml", base))
    assert "lengths in mm" in map(str, read_design(SURFACE.name, SURFACE.read_bytes()).notes)
