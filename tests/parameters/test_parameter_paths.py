"""Paths of a scene: values, changes and errors (properties)."""

from dataclasses import replace

import pytest

from cuefem import Scene, Stroke, Tip
from cuefem.parameters.field_paths import path_text
from cuefem.parameters.scene_changes import with_values_at
from cuefem.parameters.scene_paths import paths, value_at
from tests.helpers.cues import MAPLE, low_deflection

BASE = Scene(low_deflection(), tip=Tip(contact_time=1.2e-3), stroke=Stroke(2.0, 0.3))


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("cue.segments[2].tip_bore", 0.008),
        ("cue.segments[4].material.E", MAPLE.E),
        ("cue.body_mass", 0.43),
        ("tip.contact_time", 1.2e-3),
        ("stroke.offset", 0.3),
        ("cue.segments[0].kappa", None),
    ],
)
def test_path_resolves_to_its_field(path: str, value: float) -> None:
    (resolved,) = paths(BASE, path)
    assert value_at(BASE, resolved) == value
    assert path_text(resolved) == path


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("cue.segments[2].tip_boar", "got 'cue.segments[2].tip_boar'; did you mean 'tip_bore'"),
        ("kue.segments[0].length", "did you mean 'cue'"),
        ("cue.segments[5].length", "where cue.segments has 5 items"),
        ("cue.segments[0].core.E", "where cue.segments[0].core has 0 items"),
        ("cue.segments[0]", "must name one number or a material"),
        ("effects[0].mass", "where effects has 0 items"),
        ("cue..length", "unknown parameter 'cue..length'; write a name such as"),
    ],
)
def test_path_without_field_raises(path: str, message: str) -> None:
    with pytest.raises(ValueError, match=r"must|unknown") as error:
        paths(BASE, path)
    assert message in str(error.value)


def test_replaced_values_change_together() -> None:
    """A bore may exceed the former diameter if the diameter changes too; nothing else changes."""
    (bore,), (outer,) = paths(BASE, "cue.segments[2].tip_bore"), paths(BASE, "cue.segments[2].tip_diameter")
    changed = with_values_at(BASE, {bore: 0.0126, outer: 0.014})
    assert changed.cue.segments[2] == replace(BASE.cue.segments[2], tip_bore=0.0126, tip_diameter=0.014)
    assert with_values_at(changed, {bore: 0.008, outer: 0.0125}) == BASE
