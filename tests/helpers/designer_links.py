"""Links as the designer writes them, and links that somebody damaged, with the words that refuse each."""

from __future__ import annotations

import base64
import json
import zlib
from typing import Any

from cuefem.designer.design import Design, State, Step
from cuefem.designer.kept import text_of
from cuefem.designer.start import first_scene

FIRST = Design.of("maple", first_scene(), ["material hard maple"])
TEXT = text_of(State((Step(FIRST),)))


def record_of(text: str) -> Any:
    """What a link holds."""
    return json.loads(zlib.decompress(base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))))


def packed(content: bytes) -> str:
    """The text of a link that holds these bytes."""
    return base64.urlsafe_b64encode(zlib.compress(content)).decode()


def text_with(record: Any) -> str:
    """The text of a link that holds a record."""
    return packed(json.dumps(record).encode())


def spoilt(**parts: object) -> str:
    """The first design's link with parts of it exchanged."""
    return text_with(record_of(TEXT) | parts)


def knobs(turned: object) -> str:
    """The first design's link with these knobs."""
    return spoilt(designs=[["a", 0, turned, []]])


def many_segments(count: int) -> str:
    """A link of as many designs as there can be, each of so many segments."""
    (scene,) = record_of(TEXT)["scenes"]
    segment = scene["cue"]["segments"][-1] | {"length": "0.4 mm", "tip_diameter": "12 mm", "butt_diameter": "12 mm"}
    scenes = [scene | {"cue": {"segments": [segment] * count, "body_mass": f"{400 + i} g"}} for i in range(13)]
    return spoilt(scenes=scenes, designs=[["a", i, {}, []] for i in range(13)], steps=[list(range(13))])


CUT = "this link is not whole: copy all of it"
DAMAGED = "this link is damaged: its parts do not fit together"
NUMBER = "offset must be a number; got "
WRONG = {
    "empty": ("", CUT),
    "no letters": ("%%%é", CUT),
    "cut off": (TEXT[:-8], CUT),
    "a letter gone": (TEXT[:50] + TEXT[51:], CUT),
    "a bomb": (packed(b" " * 50_000_000), "this link must hold at most 4 MB of designs"),
    "too long": ("a" * 1_000_001, "must have at most 1000000 letters; got 1000001"),
    "nested": (packed(b"[" * 100_000), "is not whole"),
    "a list": (packed(b"[1]"), "must be of version 1"),
    "newer": (spoilt(version=2), "must be of version 1"),
    "no scene": (spoilt(scenes=[]), DAMAGED),
    "no steps": (spoilt(steps=[]), "must hold 1 step; got 0"),
    "many steps": (spoilt(steps=[[0], [0]]), "must hold 1 step; got 2"),
    "many designs": (spoilt(designs=[["a", 0, {}, []]] * 14), "must hold at most 13 designs; got 14"),
    "many pinned": (spoilt(steps=[[0] * 14]), "must hold at most 12 pinned designs a step"),
    "many segments": (many_segments(301), "the designer takes a cue of at most 300 segments; got 301: draw it with "),
    "no end of segments": (many_segments(5000), "this link must hold at most 4 MB of designs"),
    "a path": (spoilt(scenes=[{"cue": "/etc/passwd"}]), "cue: must be a table of its own; got the path of a file"),
    "a lumped cue": (spoilt(scenes=[{"cue": {"mass": "1 kg", "end_mass": "6 g"}}]), "must be a Cue of segments"),
    "a made-up knob": (knobs({"x": 1.0}), "'x' must be a knob of its cue"),
    "far off": (knobs({"offset": 3}), "Stroke.offset must be in (-1, 1); got 3.0"),
    "an endless number": (knobs({"offset": 10**400}), NUMBER + "1000"),
    "no name": (spoilt(designs=[[5, 0, {}, []]]), DAMAGED),
    "no list of notes": (spoilt(designs=[["a", 0, {}, 5]]), DAMAGED),
    **{f"knobs {value!r}": (knobs(value), DAMAGED) for value in (0, "x", None, True, [], [5], ["offset"])},
    **{
        f"offset {value!r}": (knobs({"offset": value}), NUMBER)
        for value in (None, True, [], {}, float("nan"), float("inf"), "1")
    },
    **{f"steps {value!r}": (spoilt(steps=value), DAMAGED) for value in (5, None, [[]], [[1]], [[-1]], [["0"]])},
}
