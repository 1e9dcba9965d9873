"""What people stumbled over on the page, and no longer do: labels, digits, and where there is more (regression)."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.report.report_page import page as report_page

WHISKER = re.compile(r'class="whisker" d="M([0-9.]+) [0-9.]+H([0-9.]+)"')


USUAL = cf.usual_scene(cf.load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml"))
WOOD, BRASS = cf.Material(12.6e9, 0.84e9, 782.0), cf.Material(1e11, 3.7e10, 8500.0)
RINGING = cf.Cue((cf.Segment(0.006, 0.012, 0.012, BRASS), cf.Segment(0.7, 0.012, 0.021, WOOD)), 0.4)


@pytest.mark.parametrize(
    ("scene", "told"),
    [
        (cf.Scene(USUAL.cue, USUAL.ball, cf.Tip(contact_time=2e-3), USUAL.stroke), False),
        (cf.Scene(RINGING, tip=cf.Tip(contact_time=1.2e-3), stroke=cf.Stroke(offset=0.3)), True),
    ],
    ids=["spring", "a brass tip that rings"],
)
def test_a_line_through_a_dot_is_told_only_where_one_is(scene: cf.Scene, told: bool) -> None:
    """The range of an end mass while fewer modes are kept is told only where it is longer than its dot."""
    text = report_page("a scene", scene)
    drawn = [float(high) - float(low) for low, high in WHISKER.findall(text)]
    assert len(drawn) > 3
    assert any(length > 9 for length in drawn) is told
    assert ("The line through a dot" in text) is told
