"""What the designer keeps: steps back and forth, and texts that hold every step (properties)."""

from __future__ import annotations

import base64
import json
import zlib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cuefem as cf
from cuefem.cli.common import scene_of
from cuefem.cue.materials import material
from cuefem.designer.design import MOST_SEGMENTS, MOST_STEPS, Design, State, Step
from cuefem.designer.kept import key_of, state_of, text_of
from cuefem.designer.start import first_scene
from cuefem.parameters.parts import with_material

ROOT = Path(__file__).parents[2]
FIRST = Design.of("maple", first_scene(), ["material hard maple"])
FILES = [*sorted((ROOT / "meshes").glob("*.toml")), *sorted((ROOT / "studies" / "scenes").glob("*.toml"))]


def turned(design: Design = FIRST, **changes: object) -> Design:
    return replace(design, knobs={**design.knobs, **changes})


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_scene_comes_back(path: Path) -> None:
    scene, notes = scene_of(path, {"body_mass": None, "material": None})
    step = Step(Design.of(path.name, scene, notes))
    assert state_of(text_of(State((step,)))).now == step


@settings(max_examples=15)
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


def test_another_file_is_kept_apart() -> None:
    changed = replace(first_scene(), ball=cf.Ball())
    keys = [key_of(Design.of(*file)) for file in (("a", first_scene()), ("b", first_scene()), ("a", changed))]
    assert len(set(keys)) == 3
    assert key_of(Design.of("a", first_scene())) == keys[0]


def test_steps_are_undone_and_done_again() -> None:
    a, b, c = (Step(turned(tip_diameter=d)) for d in (0.0127, 0.0125, 0.0123))
    state = State((a,)).put(b).put(c)
    assert (state.undo().now, state.undo().redo().now, state.redo().now) == (b, c, c)
    state = state.undo().undo()
    assert (state.now, state.can_undo, state.can_redo) == (a, False, True)
    assert state.undo().redo().now == b  # beyond the first step there is nothing
    state = state.redo().put(a)
    assert (state.steps, state.can_redo) == ((a, b, a), False)


def test_one_drag_of_a_knob_is_one_step_and_the_oldest_are_forgotten() -> None:
    state = State((Step(FIRST),))
    for i in range(1, 20):
        state = state.put(Step(turned(offset=0.3 + 0.001 * i)), "offset", when=0.1 * i)
    state = state.put(Step(turned(offset=0.4)), "offset", when=30.0)
    assert [step.design.knobs["offset"] for step in state.steps] == pytest.approx([0.3, 0.319, 0.4])
    for i in range(3 * MOST_STEPS):
        state = state.put(Step(turned(offset=0.001 * (i + 1))))
    assert len(state.steps) == MOST_STEPS
    assert state_of(text_of(state)) == state


def packed(record: object) -> str:
    return base64.urlsafe_b64encode(zlib.compress(json.dumps(record).encode())).decode()


WHOLE = text_of(State((Step(FIRST),)))
RECORD = json.loads(zlib.decompress(base64.urlsafe_b64decode(WHOLE + "=" * (-len(WHOLE) % 4))))
SEGMENTS = [RECORD["scenes"][0]["cue"]["segments"][-1]] * (MOST_SEGMENTS + 1)


@pytest.mark.parametrize(
    "text",
    [
        *("", "%%%é", WHOLE[:-8], "a" * 1_000_001, packed([1])),
        base64.urlsafe_b64encode(zlib.compress(b" " * 50_000_000)).decode(),
        *(
            packed(RECORD | changed)
            for changed in (
                *({"version": 2}, {"scenes": []}, {"steps": []}, {"steps": [[0] * 14]}, {"at": 5}),
                *({"scenes": [{"cue": "/etc/passwd"}]}, {"scenes": [{"cue": {"segments": SEGMENTS}}]}),
                *({"designs": [["a", 0, {"offset": value}, []]]} for value in (3, None, "1", float("nan"), 10**400)),
                *({"designs": [["a", 0, {"made up": 1.0}, []]]}, {"designs": [[5, 0, {}, []]]}),
            )
        ),
    ],
)
def test_a_damaged_state_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(ValueError) as refused:  # noqa: PT011  # by whichever part finds it
        state_of(text)
    assert "\n" not in str(refused.value)
    assert len(str(refused.value)) < 400


def test_a_design_has_no_more_segments_than_can_be_answered_for() -> None:
    scene = first_scene()
    piece = replace(scene.cue.segments[-1], length=0.002, tip_diameter=0.012, butt_diameter=0.012)
    most = replace(scene, cue=replace(scene.cue, segments=(piece,) * MOST_SEGMENTS))
    assert Design.of("most", most).scene == most
    with pytest.raises(ValueError, match=r"^the designer takes a cue of at most 300 segments; got 301: "):
        Design.of("more", replace(scene, cue=replace(scene.cue, segments=(piece,) * (MOST_SEGMENTS + 1))))
