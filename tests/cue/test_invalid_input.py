"""Invalid cues: calls, whose messages are stored in tests/golden/refused_cue.txt (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from math import nan

import pytest

from cuefem import Cue, LumpedCue, Segment, Tip
from tests.helpers.cues import MAPLE, kim
from tests.helpers.invalid_input import assert_refused, messages_of

PIECE = Segment(0.7, 0.012, 0.021, MAPLE)
CALLS: dict[str, Callable[[], object]] = {
    "bore at the tip": lambda: replace(PIECE, tip_bore=0.013),
    "bore at the butt": lambda: replace(PIECE, butt_bore=0.021),
    "material of a text": lambda: replace(PIECE, material="maple"),
    "core of a number": lambda: replace(PIECE, core=3),
    "G above its bound": lambda: replace(MAPLE, E=6e9, G=10e9),
    "one segment": lambda: Cue(PIECE),
    "segment of a number": lambda: Cue((PIECE, 7)),
    "no segments": lambda: Cue(()),
    "section before the tip": lambda: kim().section(-1e-9),
    "section behind the butt": lambda: kim().section(0.7000001),
    "section at no number": lambda: kim().section(nan),
    "coupling": lambda: LumpedCue(0.5, 0.005, 20.0),
    "two-part cue of no ratio": lambda: LumpedCue.two_part(0.5, 0.012, 0.0),
    "contact time and stiffness": lambda: Tip(contact_time=1e-3, stiffness=1e5),
}


def test_cue_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("cue", messages_of(CALLS), request)
