"""Warnings for numbers in another unit (properties)."""

import dataclasses
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

import cuefem as cf

WOOD = cf.Material(12.6e9, 0.84e9, 700.0)
SEGMENT = cf.Segment(0.7, 0.012, 0.021, WOOD)
WARNINGS: dict[str, Callable[[], object]] = {
    "TipDome.radius is 9.5 m, which no cue has: is it 9.5 mm? Write 0.0095 (m)": lambda: cf.TipDome(9.5),
    "Segment.length is 29 m, which no cue has: is it 29 mm or 29 in?": lambda: cf.Segment(29, 0.012, 0.021, WOOD),
    "Cue.body_mass is 15 kg, which no cue has: is it 15 oz? Write 0.4252 (kg)": lambda: cf.Cue((SEGMENT,), 15),
    "Material.E is 12.6 Pa, which no cue has: is it 12.6 GPa or 12.6 MPa?": lambda: cf.Material(12.6, 0.84e0, 700),
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
