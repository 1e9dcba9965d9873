"""An effect that is made up here is found by every command and page (properties).

It is known by its class alone: nothing else of the package is told of it.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar

import pytest

import cuefem as cf
from cuefem.design import Levels, Response, Study, Vary
from cuefem.design.worth import variants
from cuefem.designer.answers import answers
from cuefem.designer.design import Design
from cuefem.designer.words import head_markup
from cuefem.effects import CueEffect, Usual, effect_kinds
from cuefem.io import schema
from cuefem.quantity.fields import Quantity
from cuefem.report.report_page import page
from cuefem.vary import knobs_of, turned
from tests.helpers.command_line import as_json, said

CUE = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(12.6e9, 0.84e9, 782.3284453057836), kappa=0.9),), 0.42)
BARE = cf.Scene(CUE, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
WORDS = "Collar (position 30 mm, mass 4 g)"


@pytest.fixture
def collar() -> Iterator[type[cf.Effect]]:
    @dataclass(frozen=True)
    class Collar(CueEffect):
        """A ring on the shaft."""

        usual: ClassVar[Usual | None] = Usual({"position": 0.03, "mass": 4e-3}, "made up")

        position: Annotated[float, Quantity("m", "[0, inf)")]
        mass: Annotated[float, Quantity("kg", "[0, inf)")]

        @property
        def positions(self) -> tuple[float, ...]:
            """Its place."""
            return (self.position,)

        def add_to(self, terms: Any) -> None:
            """Its mass."""
            terms.add(self.position, "mass", self.mass, 0.0)

    yield Collar
    schema.types_of.cache_clear()
    del Collar
    gc.collect()


@pytest.fixture
def scene(collar: type[cf.Effect]) -> cf.Scene:
    made: Any = collar
    return replace(BARE, effects=(made(0.03, 4e-3),))


def test_files_hold_it(collar: type[cf.Effect], scene: cf.Scene, tmp_path: Path) -> None:
    assert effect_kinds()["Collar"] is collar
    cf.save(scene, tmp_path / "scene.toml")
    assert 'type = "Collar"' in (tmp_path / "scene.toml").read_text(encoding="utf-8")
    assert cf.load(tmp_path / "scene.toml") == scene


def test_commands_and_pages_name_it(scene: cf.Scene, tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    cf.save(scene, file)
    for command in ("strike", "report", "end-mass", "modes"):
        assert WORDS in said(command, file)
    assert as_json("strike", file)["scene"]["effects"][0]["type"] == "Collar"
    shown = page("scene.toml", scene)
    assert f"with {WORDS}" in shown
    assert ">Collar</text>" in shown  # at its place on the drawing


def test_the_designer_keeps_it(scene: cf.Scene) -> None:
    knobs = {**knobs_of(scene), "offset": 0.2}
    assert turned(scene, knobs).effects == scene.effects
    assert WORDS in head_markup(Design.of("scene.toml", scene))
    found = answers(scene)
    assert found.strike["squirt"] == pytest.approx(cf.strike(scene).squirt, rel=1e-12)
    assert found.strike["squirt"] > cf.strike(BARE).squirt  # the ring lies within reach of the tip


@pytest.mark.heavy
def test_it_is_tried_at_its_usual_values(scene: cf.Scene, tmp_path: Path) -> None:
    (added,) = (v for v in variants(BARE) if v.name == "Collar")
    assert (added.listed, added.scene) == (False, scene)
    cf.save(BARE, tmp_path / "bare.toml")
    assert f"with {WORDS}" in said("effects", tmp_path / "bare.toml")
    cf.save(scene, tmp_path / "scene.toml")
    found = as_json("effects", tmp_path / "scene.toml")
    assert found["textbook"]["Collar"] == {"values": {"position": 0.03, "mass": 4e-3}, "source": "made up"}
    assert [row["name"] for row in found["effects"] if row["listed"]] == ["Collar"]


def test_a_study_varies_it(scene: cf.Scene) -> None:
    study = Study(scene, (Vary(("effects[0].mass",), Levels((0.0, 4e-3))),), (Response.of("squirt"),))
    assert study.scene((4e-3,)) == scene
    assert study.units[0] == "kg"
