"""What the designer keeps: steps back and forth, and texts that hold every step (properties)."""

from __future__ import annotations

import base64
import json
import random
import zlib
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.cli.common import scene_of
from cuefem.designer.design import MOST_SEGMENTS, MOST_STEPS, Design, State, Step
from cuefem.designer.kept import key_of, state_of, step_of, text_of
from cuefem.designer.pictures import cue_pictures
from cuefem.designer.sliders import choices, sliders
from cuefem.designer.start import first_scene
from cuefem.designer.words import head_markup
from cuefem.materials import material
from cuefem.parts import with_material

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
    assert step_of(text_of(State((step,)))) == step


@given(
    diameters=st.lists(st.floats(0.0101, 0.0139), min_size=1, max_size=30),
    at=st.integers(0, 29),
    wood=st.floats(8e9, 16e9),
)
def test_every_step_comes_back(diameters: list[float], at: int, wood: float) -> None:
    wooden = with_material(first_scene().cue, material("hard maple"), cf.Material(wood, 1e9, 700.0))
    own = turned(first().edited(replace(first_scene(), cue=wooden)), ferrule_material=material("nylon"))
    steps = [
        Step(turned(own, tip_diameter=d), (own, replace(first(), name="Löffel"))[: i % 3])
        for i, d in enumerate(diameters)
    ]
    at = min(at, len(steps) - 1)
    assert state_of(text_of(State(tuple(steps), at))) == State(tuple(steps), at)


def test_a_link_of_three_designs_is_short() -> None:
    others = (turned(first(), tip_diameter=0.0118), turned(first(), bore_depth=0.1, bore_width=0.006))
    assert len(text_of(State((Step(first(), others),)))) < 2000  # letters: every mail and messenger takes them


def test_another_file_is_kept_apart() -> None:
    changed = replace(first_scene(), ball=cf.Ball())
    keys = [key_of(Design.of(*one)) for one in (("a", first_scene()), ("b", first_scene()), ("a", changed))]
    assert len(set(keys)) == 3
    assert key_of(Design.of("a", first_scene())) == keys[0]


def test_steps_are_undone_and_done_again() -> None:
    a, b, c = (Step(turned(first(), tip_diameter=d)) for d in (0.0127, 0.0125, 0.0123))
    state = State((a,)).put(b).put(c)
    assert [state.undo().now, state.undo().undo().now, state.undo().undo().undo().now] == [b, a, a]
    assert state.undo().undo().undo().undo().redo().now == b  # beyond the first step there is nothing
    state = state.undo().undo()
    assert (state.can_undo, state.can_redo) == (False, True)
    assert [state.redo().now, state.redo().redo().now, state.redo().redo().redo().now] == [b, c, c]
    state = state.redo().put(a)
    assert state.steps == (a, b, a)
    assert not state.can_redo


def test_one_drag_of_a_knob_is_one_step() -> None:
    state = State((Step(first()),))
    for i in range(1, 20):
        state = state.put(Step(turned(first(), offset=0.3 + 0.001 * i)), "offset", when=0.1 * i)
    state = state.put(Step(turned(first(), offset=0.4)), "offset", when=30.0)
    assert [step.design.knobs["offset"] for step in state.steps] == pytest.approx([0.3, 0.319, 0.4])


def test_the_oldest_steps_are_forgotten() -> None:
    state = State((Step(first()),))
    for i in range(3 * MOST_STEPS):
        state = state.put(Step(turned(first(), offset=0.001 * (i + 1))))
    assert len(state.steps) == MOST_STEPS
    assert state_of(text_of(state)) == state


def packed(content: bytes) -> str:
    return base64.urlsafe_b64encode(zlib.compress(content)).decode()


def record_of(text: str) -> dict[str, Any]:
    found = json.loads(zlib.decompress(base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))))
    assert isinstance(found, dict)
    return found


def text_with(record: Any) -> str:
    return packed(json.dumps(record).encode())


def spoilt(**changes: object) -> str:
    return text_with(record_of(text_of(State((Step(first()),)))) | changes)


def many_segments(count: int) -> dict[str, Any]:
    """A scene's table as a link holds it, of so many segments."""
    (scene,) = record_of(text_of(State((Step(first()),))))["scenes"]
    segment = scene["cue"]["segments"][-1] | {"length": "0.5 mm", "tip_diameter": "12 mm", "butt_diameter": "12 mm"}
    return dict(scene | {"cue": {"segments": [segment] * count}})


WRONG = {
    "empty": ("", "is not whole: copy all of it"),
    "no letters": ("%%%é", "is not whole: copy all of it"),
    "cut off": (text_of(State((Step(first()),)))[:-8], "is not whole: copy all of it"),
    "a bomb": (packed(b" " * 50_000_000), "must hold at most 4 MB of designs"),
    "too long": ("a" * 1_000_001, "must have at most 1000000 letters; got 1000001"),
    "nested": (packed(b"[" * 100_000), "is not whole"),
    "a list": (packed(b"[1]"), "must be of version 1"),
    "newer": (spoilt(version=2), "must be of version 1"),
    "no scene": (spoilt(scenes=[]), "its parts do not fit together"),
    "no steps": (spoilt(steps=[]), "must hold 1 step; got 0"),
    "a path": (spoilt(scenes=[{"cue": "/etc/passwd"}]), "cue: must be a table of its own; got the path of a file"),
    "a lumped cue": (spoilt(scenes=[{"cue": {"mass": "1 kg", "end_mass": "6 g"}}]), "must be a Cue of segments"),
    "a made-up knob": (spoilt(designs=[["a", 0, {"x": 1.0}, []]]), "'x' must be a knob of its cue"),
    **{
        f"knobs {knobs!r}": (spoilt(designs=[["a", 0, knobs, []]]), "is damaged: its parts do not fit together")
        for knobs in (0, "x", None, True, 1.5, [], [5], "offset", ["offset"])
    },
    **{
        f"offset {value!r}"[:30]: (spoilt(designs=[["a", 0, {"offset": value}, []]]), "offset must be a number; got ")
        for value in (None, True, [], {}, float("inf"), "0.3", -1e301)
    },
    **{f"steps {steps!r}"[:30]: (spoilt(steps=steps), "this link ") for steps in (None, [[1]], [["0"]], {"0": [0]})},
    "no number": (spoilt(designs=[["a", 0, {"offset": "1"}, []]]), "offset must be a number; got '1'"),
    "nan": (spoilt(designs=[["a", 0, {"offset": float("nan")}, []]]), "offset must be a number; got nan"),
    "no table of knobs": (spoilt(designs=[["a", 0, 5, []]]), "is damaged: its parts do not fit together"),
    "no name": (spoilt(designs=[[5, 0, {}, []]]), "is damaged: its parts do not fit together"),
    "no list of notes": (spoilt(designs=[["a", 0, {}, 5]]), "is damaged: its parts do not fit together"),
    "counted from the end": (spoilt(steps=[[-1]]), "is damaged: its parts do not fit together"),
    "no number of steps": (spoilt(steps=5), "is damaged: its parts do not fit together"),
    "a step of nothing": (spoilt(steps=[[]]), "is damaged: its parts do not fit together"),
    "many steps": (spoilt(steps=[[0], [0]]), "must hold 1 step; got 2"),
    "many designs": (spoilt(designs=[["a", 0, {}, []]] * 14), "must hold at most 13 designs; got 14"),
    "many pinned": (spoilt(steps=[[0] * 14]), "must hold at most 12 pinned designs a step"),
    "many segments": (
        spoilt(scenes=[many_segments(301)] * 13),
        "the designer takes a cue of at most 300 segments; got 301: draw it with fewer, or use cuefem report",
    ),
    "an endless number": (spoilt(designs=[["a", 0, {"offset": 10**400}, []]]), "offset must be a number; got 1000"),
    "far off": (spoilt(designs=[["a", 0, {"offset": 3}, []]]), "Stroke.offset must be in (-1, 1); got 3.0"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_link_is_refused_in_one_line(name: str) -> None:
    text, words = WRONG[name]
    with pytest.raises(ValueError, match=r"this link|Stroke|Scene|the designer") as refused:
        step_of(text)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


def test_thirteen_designs_of_too_many_segments_are_refused_before_any_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    """They stalled every page of the server for 7.8 s."""
    link = spoilt(scenes=[many_segments(2000)] * 13, designs=[["a", i, {}, []] for i in range(13)])
    monkeypatch.setattr("cuefem.designer.kept.scene_of_table", lambda *_: pytest.fail("a scene was made"))
    with pytest.raises(ValueError, match="at most 300 segments; got 2000"):
        step_of(link)


def test_a_design_has_no_more_segments_than_can_be_answered_for() -> None:
    scene = first_scene()
    piece = replace(scene.cue.segments[-1], length=0.002, tip_diameter=0.012, butt_diameter=0.012)
    most = replace(scene, cue=replace(scene.cue, segments=(piece,) * MOST_SEGMENTS))
    assert Design.of("most", most).scene == most
    with pytest.raises(ValueError, match=r"^the designer takes a cue of at most 300 segments; got 301: "):
        Design.of("more", replace(scene, cue=replace(scene.cue, segments=(piece,) * (MOST_SEGMENTS + 1))))


# --- thousands of links that somebody changed: each opens whole, or is refused in a line ---------------------------

VALUES: tuple[Any, ...] = (
    *(None, True, 0, -1, 5, 1e300, 10**400, float("nan"), float("inf"), "", "x", "\ud800", "12 mm", "1e300 m"),
    *([], [5], {}, {"E": 1}, {"E": "1 GPa", "G": "1 GPa", "rho": "700 kg/m3"}, [[0]], "hard maple", "../../etc/passwd"),
)


def places(tree: Any, way: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The way to every part of nested tables and lists."""
    for key, part in tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ():
        yield (*way, key)
        yield from places(part, (*way, key))


def tampered(record: Any, rng: random.Random) -> str:
    """The text of a record in which one to three parts are others, are gone, or stand twice or in another place."""
    record = deepcopy(record)
    for _ in range(rng.randint(1, 3)):
        *way, last = rng.choice(list(places(record)))
        held = record
        for key in way:
            held = held[key]
        match rng.randrange(5):
            case 0:
                del held[last]
            case 1 if isinstance(held, list):
                held.insert(last, deepcopy(held[last]))
            case 2:
                *other, name = rng.choice(list(places(record)))
                part = record
                for key in (*other, name):
                    part = part[key]
                held[last] = deepcopy(part)
            case _:
                held[last] = deepcopy(rng.choice(VALUES))
    return text_with(record)


def shifted(text: str, rng: random.Random) -> str:
    """The text with letters changed, cut out or put in, as mail and hands do."""
    letters = list(text)
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(letters))
        letters[at : at + rng.randrange(3)] = rng.choices("abcXYZ019-_=% é\n", k=rng.randrange(3))
    return "".join(letters)


def read(link: str) -> tuple[Step | None, str]:
    """The step of a link, or in which words it is refused."""
    try:
        return step_of(link), ""
    except ValueError as refused:
        return None, str(refused)


def looked_at(step: Step) -> None:
    """All that the page shows of a step before it computes anything, in letters that can be sent."""
    for design in (step.design, *step.pinned):
        head_markup(design).encode()
        [slider.shown(design.knobs) for slider in sliders(design.scene)]
        [choice.name(design.knobs) for choice in choices(design.base)]
        cue_pictures(design.scene).encode()
        assert key_of(design)
    assert step_of(text_of(State((step,)))) == step


@pytest.mark.heavy
@pytest.mark.parametrize("seed", range(4))
def test_thousands_of_tampered_links(seed: int) -> None:
    rng = random.Random(seed)
    own = turned(first(), shaft_material=material("ash"), bore_depth=0.1, offset=0.4, leather=2e8)
    text = text_of(State((Step(own, (first(), replace(own, name="Löffel"))),)))
    whole = 0
    for i in range(1500):
        link = tampered(record_of(text), rng) if i % 3 else shifted(text, rng)
        step, words = read(link)
        assert "\n" not in words
        assert len(words) < 400
        if step is not None:
            whole += 1
            looked_at(step)
    assert 20 < whole < 1000
