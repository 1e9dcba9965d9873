"""Rows of a lathe table that do not belong to their shaft: slips are found, and no plausible drawing is rejected."""

from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.files.misplaced_diameters import misplaced_rows
from cuefem.files.parts_catalogue import data_folder
from tests.helpers.random_profiles import SLIPS, random_profile

SHAFT = "x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n"
IN_INCHES = "x [in],diameter [in]\n0,.505\n14,.520\n29,.845\n"
REJECTED = {
    "an inner decimal point": (SHAFT, "13.2", "0.132", "line 3, diameter: 0.132 mm between 12.75 and 21.5", "13.2"),
    "inches in a table of mm": (SHAFT, "13.2", ".52", "line 3, diameter: 0.52 mm between 12.75 and 21.5", "13.21"),
    "two digits too many": (SHAFT, "13.2", "1320", "line 3, diameter: 1320 mm between 12.75 and 21.5", "13.2"),
    "a last row too small": (SHAFT, "21.5", "2.15", "line 4, diameter: 2.15 mm beside 13.2", "21.5"),
    "a last row too large": (SHAFT, "21.5", "215", "line 4, diameter: 215 mm beside 13.2", "21.5"),
    "a first row too small": (SHAFT, "12.75", "1.275", "line 2, diameter: 1.275 mm beside 13.2", "12.75"),
    "a first row too large": (SHAFT, "12.75", "127.5", "line 2, diameter: 127.5 mm beside 13.2", "12.75"),
    "inches too small": (IN_INCHES, ".520", ".00520", "line 3, diameter: 0.0052 in between 0.505 and 0.845", "0.52"),
    "mm in a table of inches": (
        IN_INCHES,
        ".520",
        "13.2",
        "line 3, diameter: 13.2 in between 0.505 and 0.845",
        "0.5197",
    ),
}
DRAWINGS = [path for kind in ("meshes/*.toml", "studies/*/*/cue.toml") for path in sorted(data_folder().glob(kind))]
FIRST_SEED = 580_000


@pytest.mark.parametrize("case", REJECTED)
def test_load_slipped_diameter_is_rejected_with_the_value_that_fits(case: str, tmp_path: Path) -> None:
    text, right, wrong, place, fitting = REJECTED[case]
    (path := tmp_path / "shaft.csv").write_text(text.replace(right, wrong))
    with pytest.raises(cf.InputError) as caught:
        cf.load(path)
    message = str(caught.value)
    assert place in message
    assert f"{float(fitting):.4g} would fit" in message


@pytest.mark.parametrize("count", [pytest.param(100), pytest.param(2000, marks=pytest.mark.heavy)])
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
