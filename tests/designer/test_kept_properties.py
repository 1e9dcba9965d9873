"""What the designer keeps: steps back and forth, and texts that hold every step (properties)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.cli.common import scene_of
from cuefem.designer.design import Design, State, Step
from cuefem.designer.kept import state_of, step_of, text_of
from cuefem.designer.start import first_scene
from cuefem.materials import material
from cuefem.parts import with_material
from tests.helpers.designer_links import FIRST, WRONG

ROOT = Path(__file__).parents[2]
FILES = [*sorted((ROOT / "meshes").glob("*.toml")), *sorted((ROOT / "studies" / "scenes").glob("*.toml"))]


def turned(design: Design = FIRST, **changes: object) -> Design:
    return replace(design, knobs={**design.knobs, **changes})


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_scene_comes_back(path: Path) -> None:
    scene, notes = scene_of(path, {"body_mass": None, "material": None})
    step = Step(Design.of(path.name, scene, notes))
    assert step_of(text_of(State((step,)))) == step


@given(
    diameters=st.lists(st.floats(0.0101, 0.0139), min_size=1, max_size=30),
    at=st.integers(0, 29),
    wood=st.floats(8e9, 16e9),
)
def test_every_step_comes_back(diameters: list[float], at: int, wood: float) -> None:
    wooden = with_material(first_scene().cue, material("hard maple"), cf.Material(wood, 1e9, 700.0))
    own = turned(FIRST.edited(replace(first_scene(), cue=wooden)), ferrule_material=material("nylon"))
    steps = [
        Step(turned(own, tip_diameter=d), (own, replace(FIRST, name="Löffel"))[: i % 3])
        for i, d in enumerate(diameters)
    ]
    state = State(tuple(steps), min(at, len(steps) - 1))
    assert state_of(text_of(state)) == state


def test_steps_are_undone_and_done_again() -> None:
    a, b, c = (Step(turned(tip_diameter=d)) for d in (0.0127, 0.0125, 0.0123))
    state = State((a,)).put(b).put(c)
    assert (state.undo().now, state.undo().redo().now, state.redo().now) == (b, c, c)
    state = state.undo().undo()
    assert (state.now, state.can_undo, state.can_redo) == (a, False, True)
    assert state.undo().redo().now == b  # beyond the first step there is nothing
    state = state.redo().put(a)
    assert (state.steps, state.can_redo) == ((a, b, a), False)


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_link_is_refused_in_one_line(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    text, words = WRONG[name]
    if "segments" in name:  # they stalled every page of the server for 7.8 s
        monkeypatch.setattr("cuefem.designer.kept.scene_of_table", lambda *_: pytest.fail("a scene was made"))
    with pytest.raises(ValueError, match=r"this link|Stroke|Scene|the designer") as refused:
        step_of(text)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)
