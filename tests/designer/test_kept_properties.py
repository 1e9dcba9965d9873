"""What the designer keeps: steps back and forth, and texts that hold every step (properties)."""

from __future__ import annotations

import base64
import json
import zlib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.cli.common import scene_of
from cuefem.designer.design import MOST_STEPS, Design, History, Step
from cuefem.designer.kept import key_of, steps_of, text_of
from cuefem.designer.start import first_scene
from cuefem.materials import material

ROOT = Path(__file__).parents[2]
FILES = [*sorted((ROOT / "meshes").glob("*.toml")), *sorted((ROOT / "studies" / "scenes").glob("*.toml"))]


def first() -> Design:
    return Design.of("maple", first_scene(), ["material hard maple"])


def turned(design: Design, **changes: object) -> Design:
    return replace(design, knobs={**design.knobs, **changes})


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_scene_comes_back(path: Path) -> None:
    scene, notes = scene_of(path, {"body_mass": None, "material": None})
    step = Step(Design.of(path.name, scene, notes))
    assert steps_of(text_of([step])) == ([step], 0)


@given(
    diameters=st.lists(st.floats(0.0101, 0.0139), min_size=1, max_size=30),
    at=st.integers(0, 29),
    wood=st.floats(8e9, 16e9),
)
def test_every_step_comes_back(diameters: list[float], at: int, wood: float) -> None:
    own = turned(first(), shaft_material=cf.Material(wood, 1e9, 700.0), ferrule_material=material("nylon"))
    steps = [
        Step(turned(own, tip_diameter=d), (own, replace(first(), name="Löffel"))[: i % 3])
        for i, d in enumerate(diameters)
    ]
    at = min(at, len(steps) - 1)
    assert steps_of(text_of(steps, at)) == (steps, at)


def test_a_link_of_three_designs_is_short() -> None:
    others = (turned(first(), tip_diameter=0.0118), turned(first(), bore_depth=0.1, bore_width=0.006))
    assert len(text_of([Step(first(), others)])) < 2000  # letters: every mail and messenger takes them


def test_another_file_is_kept_apart() -> None:
    changed = replace(first_scene(), ball=cf.Ball())
    keys = [key_of(Design.of(*one)) for one in (("a", first_scene()), ("b", first_scene()), ("a", changed))]
    assert len(set(keys)) == 3
    assert key_of(Design.of("a", first_scene())) == keys[0]


def test_steps_are_undone_and_done_again() -> None:
    a, b, c = (Step(turned(first(), tip_diameter=d)) for d in (0.0127, 0.0125, 0.0123))
    history = History([a])
    history.put(b)
    history.put(c)
    assert [history.undo(), history.undo(), history.undo()] == [b, a, a]
    assert (history.can_undo, history.can_redo) == (False, True)
    assert [history.redo(), history.redo(), history.redo()] == [b, c, c]
    history.undo()
    history.put(a)
    assert history.steps == [a, b, a]
    assert not history.can_redo


def test_one_drag_of_a_knob_is_one_step() -> None:
    history = History([Step(first())])
    for i in range(1, 20):
        history.put(Step(turned(first(), offset=0.3 + 0.001 * i)), "offset", when=0.1 * i)
    history.put(Step(turned(first(), offset=0.4)), "offset", when=30.0)
    assert [step.design.knobs["offset"] for step in history.steps] == pytest.approx([0.3, 0.319, 0.4])


def test_the_oldest_steps_are_forgotten() -> None:
    history = History([Step(first())])
    for i in range(3 * MOST_STEPS):
        history.put(Step(turned(first(), offset=0.001 * (i + 1))))
    assert len(history.steps) == MOST_STEPS
    assert steps_of(text_of(history.steps, history.at)) == (history.steps, MOST_STEPS - 1)


def packed(content: bytes) -> str:
    return base64.urlsafe_b64encode(zlib.compress(content)).decode()


def spoilt(**changes: object) -> str:
    text = text_of([Step(first())])
    record = json.loads(zlib.decompress(base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))))
    return packed(json.dumps(record | changes).encode())


DESIGN = ["a", 0, {}, []]
WRONG = {
    "empty": ("", "is not whole: copy all of it"),
    "no letters": ("%%%é", "is not whole: copy all of it"),
    "cut off": (text_of([Step(first())])[:-8], "is not whole: copy all of it"),
    "a bomb": (packed(b" " * 50_000_000), "is not whole: copy all of it"),
    "too long": ("a" * 1_000_001, "must have at most 1000000 letters; got 1000001"),
    "nested": (packed(b"[" * 100_000), "is not whole"),
    "a list": (packed(b"[1]"), "must be of version 1"),
    "newer": (spoilt(version=2), "must be of version 1"),
    "no scene": (spoilt(scenes=[]), "its parts do not fit together"),
    "no steps": (spoilt(steps=[]), "must hold 1 to 60 steps; got 0"),
    "a path": (spoilt(scenes=[{"cue": "/etc/passwd"}]), "cue: must be a table of its own; got the path of a file"),
    "a lumped cue": (spoilt(scenes=[{"cue": {"mass": "1 kg", "end_mass": "6 g"}}]), "must be a Cue of segments"),
    "a made-up knob": (spoilt(designs=[["a", 0, {"x": 1.0}, []]]), "'x' must be a knob of its cue"),
    "no number": (spoilt(designs=[["a", 0, {"offset": "1"}, []]]), "offset must be a number; got '1'"),
    "nan": (spoilt(designs=[["a", 0, {"offset": float("nan")}, []]]), "offset must be a number; got nan"),
    "far off": (spoilt(designs=[["a", 0, {"offset": 3}, []]]), "Stroke.offset must be in (-1, 1); got 3.0"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_link_is_refused_in_one_line(name: str) -> None:
    text, words = WRONG[name]
    with pytest.raises(ValueError, match=r"this link|Stroke|Scene") as refused:
        steps_of(text)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)
