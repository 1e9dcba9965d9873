"""Rows of a lathe table that do not belong to their shaft: slips are found, and no plausible drawing is rejected."""

from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.files.misplaced_diameters import misplaced_rows
from cuefem.files.parts_catalogue import data_folder
from tests.helpers.random_profiles import SLIPS, random_profile

DRAWINGS = [path for kind in ("meshes/*.toml", "studies/*/*/cue.toml") for path in sorted(data_folder().glob(kind))]
FIRST_SEED = 580_000


@pytest.mark.parametrize("count", [pytest.param(100), pytest.param(600, marks=pytest.mark.heavy)])
def test_random_profiles_are_accepted_and_nine_of_ten_slips_found(count: int) -> None:
    rng = np.random.default_rng(FIRST_SEED)
    found = dict.fromkeys(("first", "inner", "last"), 0)
    slips = dict(found)
    for seed in range(FIRST_SEED, FIRST_SEED + count):
        x, d = random_profile(seed)
        assert misplaced_rows(x, d, in_inches=False) == [], seed
        rows = {"first": (0, 1), "inner": (k := int(rng.integers(1, max(2, len(d) - 1))), k - 1), "last": (-1, -2)}
        for place, (row, beside) in rows.items():
            if d[row] < 0.8 * d[beside]:
                continue  # a row of a dome or of a chamfer has no width of its own
            wrong = [*d]
            wrong[row] *= float(rng.choice(SLIPS))
            slips[place] += 1
            found[place] += row % len(d) in [each.row for each in misplaced_rows(x, wrong, in_inches=False)]
    for place, number in found.items():
        assert number >= 0.9 * slips[place], (place, number, slips[place])


@pytest.mark.parametrize("path", DRAWINGS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_drawings_of_the_repository_are_accepted(path: Path) -> None:
    drawing = cf.load(path)
    segments = drawing.cue.segments if isinstance(drawing, cf.Scene) else drawing.segments
    ends = np.cumsum([0.0, *(segment.length for segment in segments)])
    x = [float(end) for end in np.repeat(ends, 2)[1:-1]]
    d = [width for segment in segments for width in (segment.tip_diameter, segment.butt_diameter)]
    assert misplaced_rows(x, d, in_inches=False) == []


def test_column_in_another_unit_is_no_list_of_slips() -> None:
    """Fewer than half of the rows are as wide as a cue."""
    assert misplaced_rows([0.0, 0.2, 0.4, 0.6, 0.8], [0.012, 0.013, 0.05, 0.05, 0.05], in_inches=False) == []
