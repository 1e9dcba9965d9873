"""Warnings for numbers in another unit (properties)."""

import dataclasses
import math
import shutil
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.command_line import call

ROOT = Path(__file__).parents[2]
WOOD = cf.Material(12.6e9, 0.84e9, 700.0)
SEGMENT = cf.Segment(0.7, 0.012, 0.021, WOOD)
WARNINGS: dict[str, Callable[[], object]] = {
    "TipDome.radius is 9.5 m, which no cue has: is it 9.5 mm? Write 0.0095 (m)": lambda: cf.TipDome(9.5),
    "Segment.length is 700 m, which no cue has: is it 700 mm?": lambda: cf.Segment(700, 0.012, 0.021, WOOD),
    "Segment.length is 29 m, which no cue has: is it 29 mm or 29 in?": lambda: cf.Segment(29, 0.012, 0.021, WOOD),
    "Segment.tip_diameter is 0.5 m, which no cue has: is it 0.5 in?": lambda: cf.Segment(0.7, 0.5, 0.85, WOOD),
    "Cue.body_mass is 15 kg, which no cue has: is it 15 oz? Write 0.4252 (kg)": lambda: cf.Cue((SEGMENT,), 15),
    "Ball.mass is 170 kg, which no cue has: is it 170 g? Write 0.17 (kg)": lambda: cf.Ball(170),
    "Tip.contact_time is 1.1 s, which no cue has: is it 1.1 ms?": lambda: cf.Tip(contact_time=1.1),
    "Material.E is 12.6 Pa, which no cue has: is it 12.6 GPa or 12.6 MPa?": lambda: cf.Material(12.6, 0.84e0, 700),
    "Material.rho is 0.7 kg/m^3, which no cue has: is it 0.7 g/cm^3?": lambda: cf.Material(12.6e9, 0.84e9, 0.7),
}


@pytest.mark.parametrize("message", WARNINGS)
def test_number_in_other_unit_warns_at_caller(message: str) -> None:
    with pytest.warns(cf.PlausibilityWarning) as caught:
        WARNINGS[message]()
    assert str(caught[0].message).startswith(message)
    assert {Path(one.filename).name for one in caught} == {Path(__file__).name}


def test_scene_of_shaft_without_butt_warns() -> None:
    """Only a scene, in which the mass matters, warns; a scale model may be light."""
    with pytest.warns(
        cf.PlausibilityWarning, match=r"^Cue.body_mass is 0 kg, so the whole cue weighs 0.107 kg; expected 0.4 to 0.7"
    ) as caught:
        cf.Scene(cf.Cue((SEGMENT,)))
    assert {Path(one.filename).name for one in caught} == {Path(__file__).name}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cf.modes(cf.Cue((SEGMENT,)), 2)
        cf.Scene(cf.Cue((SEGMENT,), 0.43))
        cf.Scene(cf.Cue((dataclasses.replace(SEGMENT, length=0.07),)))


def test_limits_and_scale_models_do_not_warn() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for item in (cf.TipDome(1.0), cf.TipDome(1e3), cf.Tip(contact_time=1e-6), cf.Ball(1e6)):
            assert item
        for item in (cf.Segment(5.0, 0.06, 0.06, WOOD), cf.LumpedCue(5.0, 1e-9), cf.LeatherTip(0.006, math.inf, 1e12)):
            assert item


def test_end_mass_search_does_not_warn() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert cf.end_mass(cf.Scene(cf.Cue((SEGMENT,), 0.43), stroke=cf.Stroke(2.0, 0.3)), "squirt") > 0


def test_file_number_in_other_unit_warns_at_load(tmp_path: Path) -> None:
    shutil.copy(ROOT / "meshes" / "pool_maple.toml", tmp_path / "cue.toml")
    path = tmp_path / "scene.toml"
    ball = '[stroke]\noffset = 0.3\n[ball]\nmass = "170 g"\nradius = "28.575 mm"\n'
    path.write_text(f'game = "kim"\ncue = "cue.toml"\n{ball}[[effects]]\ntype = "TipDome"\nradius = "9.5 m"\n')
    with pytest.warns(cf.PlausibilityWarning, match="is it 9.5 mm") as caught:
        cf.load(path)
    assert Path(caught[0].filename).name == Path(__file__).name
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        status, _, err = call("strike", path)
    assert (status, err[:35]) == (0, "warning: dome radius 9500 mm; expec")
