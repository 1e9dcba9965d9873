"""Lathe profiles in unusual but unambiguous formats are read; rejected ones: test_invalid_input.py (regression)."""

import re
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cue.materials import MATERIALS
from cuefem.files.defaults_report import drawing_assumptions
from tests.test_golden_files import GOLDEN, assert_golden

PROFILES = "read_profiles.txt"
NAMES = {entry.material: name for name, entry in MATERIALS.items()}


def described(segment: cf.Segment) -> str:
    """Length, diameters and bore, mm, material and core of a segment."""
    *sizes, tip_bore, butt_bore = (
        f"{1e3 * getattr(segment, name):.9g}"
        for name in ("length", "tip_diameter", "butt_diameter", "tip_bore", "butt_bore")
    )
    inside = f" bore {tip_bore} to {butt_bore}" if segment.tip_bore or segment.butt_bore else ""
    core = f" core {NAMES[segment.core]}" if segment.core else ""
    return f"{sizes[0]} long {sizes[1]} to {sizes[2]} {NAMES[segment.material]}{inside}{core}"


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_profiles_in_unusual_formats_equal_golden_file(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    r"""Each row: name, encoding and content of a profile; behind ": " its segments, and what is assumed.

    A new row is a line of tests/golden/read_profiles.txt up to its content, to which `--update` adds the rest.
    """
    path, lines = tmp_path / "shaft.csv", []
    for line in (GOLDEN / PROFILES).read_text(encoding="utf-8").splitlines():
        row = line.partition(": ")[0]
        _, encoding, content = row.split(" | ")
        text = re.sub(r"\\(?:[ntr]|u\w{4})", lambda code: code[0].encode().decode("unicode_escape"), content)
        path.write_bytes(text.encode(encoding))
        cue = cf.load(path)
        assert isinstance(cue, cf.Cue)
        assumed = drawing_assumptions(path, cue, {"material": "ash", "body_mass": 0.4})
        found = [*map(described, cue.segments), *(each.key or each.text for each in assumed)]
        lines.append(f"{row}: {'; '.join(found)}\n")
    assert_golden(PROFILES, "".join(lines), request, exact=True)


def test_unused_column_is_warned_of(tmp_path: Path) -> None:
    (path := tmp_path / "shaft.csv").write_text("x [mm],diameter [mm],score\n0,12.4,1\n736,21,2\n")
    with pytest.warns(cf.PlausibilityWarning, match="column 'score' is not used"):
        cf.load(path)
