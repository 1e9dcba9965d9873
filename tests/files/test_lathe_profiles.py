"""Lathe profiles in unusual but unambiguous formats are read; rejected ones: test_invalid_input.py (regression)."""

import itertools
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cue.materials import material
from cuefem.files.defaults_report import Assumption, drawing_assumptions

MAPLE = material("hard maple")
POINTS = ((0.0, 12.75), (330.0, 13.2), (736.6, 21.5))  # mm
INCHES = ((0.0, 12.7), (330.2, 13.208), (736.6, 21.59))


PLAIN = "x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n"
GERMAN = "x [mm];Durchmesser [mm]\n0,0;12,75\n330,0;13,2\n736,6;21,5\n"
TABS = PLAIN.replace(",", "\t")
# Files with the points POINTS, but for OTHER_POINTS, and without notes, but for NOTES.
PROFILES: dict[str, str | bytes] = {
    "plain": PLAIN,
    "semicolons and decimal commas": GERMAN,
    "semicolons and decimal points": PLAIN.replace(",", ";"),
    "tabs": TABS,
    "tabs and decimal commas": TABS.replace(".", ","),
    "Excel's Unicode text": TABS.replace("\n", "\r\n").encode("utf-16"),
    "UTF-16, big end first, no mark": PLAIN.encode("utf-16-be"),
    "byte order mark and Windows lines": b"\xef\xbb\xbf" + PLAIN.replace("\n", "\r\n").encode(),
    "a diameter sign of Windows": GERMAN.replace("Durchmesser", "Ø").encode("cp1252"),
    "decimal commas in quotes": '"x [mm]","diameter [mm]"\n"0,0","12,75"\n"330,0","13,2"\n"736,6","21,5"\n',
    "a line that names the separator": "sep=;\n" + GERMAN,
    "columns in spaces": "x_mm  dia_mm\n0      12.75\n330    13.2\n736.6  21.5\n",
    "commas in the header, semicolons below": "x [mm],diameter [mm]\n0;12,75\n330;13,2\n736,6;21,5\n",
    "extra columns": "No,x [mm],diameter [mm],note\n1,0,12.75,ferrule\n2,330,13.2,\n3,736.6,21.5,joint\n",
    "swapped columns": "diameter [mm],x [mm]\n12.75,0\n13.2,330\n21.5,736.6\n",
    "loose names": "Distance from tip (in),Dia. (in)\n0,0.5\n13,0.52\n29,0.85\n",
    "names in capitals": "POS_MM,DIA_MM\n0,12.75\n330,13.2\n736.6,21.5\n",
    "radius for diameter": "x [mm],radius [mm]\n0,6.375\n330,6.6\n736.6,10.75\n",
    "first point after 0": "x [mm],diameter [mm]\n10,12.75\n340,13.2\n746.6,21.5\n",
    "a line of units": "x,diameter\nmm,mm\n0,12.75\n330,13.2\n736.6,21.5\n",
    "units beside the numbers": "x,diameter\n0 mm,12.75 mm\n330 mm,13.2mm\n736.6 mm,21.5 mm\n",
    "titles above": "Shaft 12; maple\nmeasured by Ann; 3 May\n\n" + GERMAN,
    "notes below": PLAIN.replace("\n330", "\n--- 13 in ---\n330") + "Note: dry, cold, and straight\n",
    "the unit first": "inches from tip,thick in inches\n0,0.5\n13,0.52\n29,0.85\n",
    "German words": GERMAN.replace("x [mm];Durchmesser [mm]", "mm von der Spitze;Dicke mm"),
    "empty cells of a spreadsheet": "x [mm],diameter [mm],,\n0,12.75,,\n,,,\n330,13.2,,\n736.6,21.5,,\n,,,\n,,,\n",
    "butt first": "x [mm],diameter [mm]\n736.6,21.5\n330,13.2\n0,12.75\n",
    "from the butt": "distance from joint [mm],diameter [mm]\n0,21.5\n406.6,13.2\n736.6,12.75\n",
    "fractions of an inch": 'x [in],diameter [in]\n0,1/2"\n14 1/2,17/32\n29,27/32\n',
    "marks of thousands": '"x [mm]","diameter [mm]"\n"0.0","9.5"\n"800.0","18.0"\n"1,470.5","29.0"\n',
    "a diameter sign in the cells": PLAIN.replace(",1", ",Ø1").replace(",2", ",⌀ 2"),
    "narrow blanks as marks of thousands": "x [mm];d [mm]\n0;9.5\n800;18.0\n1\u202f470.5;29.0\n",
    "mixed fractions": 'x [in],diameter [in]\n0,½\n14-1/2,17/32"\n29,27/32\n',
    "a fraction in one character": "x [in],diameter [in]\n0,1/2\n14½,17/32\n29,27/32\n",
    "a weight below": GERMAN + "Gewicht;104 g\n",
    "Korean": PLAIN.replace("x [mm],diameter [mm]", "팁에서 거리 (mm),직경(mm)"),
    "Chinese": PLAIN.replace("x [mm],diameter [mm]", "距尖端距离(mm),直径(mm)"),
    "Japanese, full width": PLAIN.replace("x [mm],diameter [mm]", "先端からの距離（㎜）,直径（ｍｍ）").replace(
        "0,1", "０,１"
    ),
    "digits of full width": PLAIN.replace("12.75", "１２．７５"),
    "Russian": PLAIN.replace("x [mm],diameter [mm]", "Расстояние от кончика (мм),Диаметр (мм)"),
    "Japanese, from the butt": "バットからの距離 [mm],外径 [mm]\n0,21.5\n406.6,13.2\n736.6,12.75\n",
    "Z of a lathe": "Z [mm],diameter [mm]\n0,12.75\n-330,13.2\n-736.6,21.5\n",
    "Z of a lathe, butt first": "Z [mm],diameter [mm]\n-736.6,21.5\n-330,13.2\n0,12.75\n",
    "a point written twice": "x [mm],diameter [mm]\n0,12.75\n330,13.2\n330,13.2\n736.6,21.5\n",
}
OTHER_POINTS = {
    **{"loose names": INCHES, "the unit first": INCHES, "marks of thousands": ((0, 9.5), (800, 18), (1470.5, 29))},
    "narrow blanks as marks of thousands": ((0, 9.5), (800, 18), (1470.5, 29)),
    **dict.fromkeys(
        ("fractions of an inch", "mixed fractions", "a fraction in one character"),
        ((0, 12.7), (368.3, 25.4 * 17 / 32), (736.6, 25.4 * 27 / 32)),
    ),
}
NOTES = {
    "extra columns": "columns 'No', 'note' are not used",
    "radius for diameter": "diameters are twice the column 'radius [mm]'",
    "first point after 0": "the shaft begins at its first point, x = 10 mm",
    "titles above": "lines 1, 2 skipped: without data",
    "notes below": "lines 3, 6 skipped: without data",
    "from the butt": "x is measured from the butt ('distance from joint [mm]')",
    "Japanese, from the butt": "x is measured from the butt ('バットからの距離 [mm]')",
    "a weight below": "line 5 skipped: without data",
    "Z of a lathe": "positions are negative, as on a lathe: read as distances from the front",
    "Z of a lathe, butt first": "positions are negative, as on a lathe: read as distances from the front",
}


def write_profile(folder: Path, content: str | bytes) -> Path:
    path = folder / "shaft.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


FERRULED = """x [mm],Diameter [mm],Bore [mm],Material,Core
0,12.75,,leather,
6,12.75,8,Melamine,hard maple
31,12.8,6,hard maple,foam
150,13,5,,foam
200,13.1,,,
330,13.2
430,14.7,-
736.6,21.5
"""


def test_profile_columns_bore_material_core_make_segments(tmp_path: Path) -> None:
    """A material applies from its row on, bore and core to their row; a bore tapers within the same materials."""
    path = write_profile(tmp_path, FERRULED)
    leather, melamine, foam = map(material, ("leather", "melamine", "foam"))
    sizes = [
        (0, 12.75, 6, 12.75, leather, 0, 0, None),
        (6, 12.75, 31, 12.8, melamine, 8, 8, MAPLE),
        (31, 12.8, 150, 13, MAPLE, 6, 5, foam),
        (150, 13, 200, 13.1, MAPLE, 5, 5, foam),
        (200, 13.1, 330, 13.2, MAPLE, 0, 0, None),
        (330, 13.2, 430, 14.7, MAPLE, 0, 0, None),
        (430, 14.7, 736.6, 21.5, MAPLE, 0, 0, None),
    ]
    result = cf.load(path)
    assert isinstance(result, cf.Cue)
    for segment, (x0, d0, x1, d1, wood, b0, b1, core) in zip(result.segments, sizes, strict=True):
        numbers = segment.length, segment.tip_diameter, segment.butt_diameter, segment.tip_bore, segment.butt_bore
        expected = [value / 1e3 for value in (x1 - x0, d0, d1, b0, b1)]
        assert numbers == pytest.approx(expected, rel=1e-12, abs=1e-15)
        assert (segment.material, segment.core) == (wood, core)
    texts = [each.text for each in drawing_assumptions(path, result, {"body_mass": 0.4})]
    assert texts == [
        "bored 8 mm from 6 to 31 mm and filled with hard maple",
        "bored 6 to 5 mm from 31 to 150 mm and filled with foam",
        "bored 5 mm from 150 to 200 mm and filled with foam",
    ]
    cf.save(result, tmp_path / "cue.toml")
    assert cf.load(tmp_path / "cue.toml") == result


def test_profile_ferrule_cell_equals_the_option(tmp_path: Path) -> None:
    """The cell has the notation of the option; behind leather the ferrule starts at its row."""
    by_option = cf.load(write_profile(tmp_path, PLAIN), ferrule="25 mm melamine")
    text = "x [mm],diameter [mm],ferrule\n0,12.75,25 mm melamine\n330,13.2,\n736.6,21.5,\n"
    assert cf.load(write_profile(tmp_path, text)) == by_option
    behind = "x [mm],diameter [mm],material,ferrule\n0,12.75,leather,\n6,12.75,ash,1 in abs\n330,13.2\n736.6,21.5\n"
    result = cf.load(write_profile(tmp_path, behind))
    assert isinstance(result, cf.Cue)
    assert result.nodes[:3] == pytest.approx([0, 0.006, 0.0314], rel=1e-12)
    assert [s.core for s in result.segments[:3]] == [None, material("ash"), None]


# The second row of each; in none does the ferrule's core fill the bore behind it.
SECOND_ROWS = {
    "an empty cell": "25,12.8,6,,\n",
    "none": "25,12.8,6,,none\n",
    "a dash": "25,12.8,6,,-\n",
    "a change of material": "25,12.8,6,hard maple,\n",
}


@pytest.mark.parametrize("row", SECOND_ROWS.values(), ids=[*SECOND_ROWS])
def test_profile_core_applies_to_its_row(row: str, tmp_path: Path) -> None:
    text = "x [mm],diameter [mm],bore [mm],material,core\n0,12.75,8,melamine,hard maple\n" + row
    cue = cf.load(write_profile(tmp_path, text + "152,12.95\n736.6,21.5\n"))
    assert isinstance(cue, cf.Cue)
    ferrule, bored, rest = cue.segments
    assert (ferrule.core, bored.core, rest.core) == (MAPLE, None, None)
    assert (ferrule.tip_bore, bored.tip_bore, bored.butt_bore) == (0.008, 0.006, 0.006)
    assert ferrule.butt_bore == 0.008  # no taper into the empty bore


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
@pytest.mark.parametrize("name", PROFILES)
def test_profile_in_unusual_format_is_read(name: str, tmp_path: Path) -> None:
    result = cf.load(write_profile(tmp_path, PROFILES[name]))
    assert isinstance(result, cf.Cue)
    for segment, (a, b) in zip(result.segments, itertools.pairwise(OTHER_POINTS.get(name, POINTS)), strict=True):
        sizes = segment.length, segment.tip_diameter, segment.butt_diameter
        assert sizes == pytest.approx(((b[0] - a[0]) / 1e3, a[1] / 1e3, b[1] / 1e3), rel=1e-12, abs=0)
    assumed = drawing_assumptions(tmp_path / "shaft.csv", result, {"material": "ash", "body_mass": 0.4})
    notes = [Assumption("", NOTES[name])] if name in NOTES else []
    assert assumed[: len(notes)] == notes
    assert [each.key for each in assumed[len(notes) :]] == ["ferrule", "bore", "front"]


def test_profile_repeated_position_steps_core_and_material(tmp_path: Path) -> None:
    """The row in front holds up to the position, the row behind it from there on."""
    text = "x [mm],diameter [mm],bore [mm],material,core\n0,12.4,8,abs,hard maple\n25,12.4,8,abs,hard maple\n"
    text += "25,12.4,6,hard maple,foam\n100,12.5,5,hard maple,foam\n100,12.5,5,hard maple,\n200,12.6,5\n736,21,\n"
    cue = cf.load(write_profile(tmp_path, text))
    foam = material("foam")
    interiors = [(1e3 * s.tip_bore, 1e3 * s.butt_bore, s.material, s.core) for s in cue.segments]
    assert interiors == [
        (8, 8, material("abs"), MAPLE),
        (6, 5, MAPLE, foam),
        (5, 5, MAPLE, None),
        (5, 5, MAPLE, None),
    ]


def test_bore_tapers_to_the_last_row_whose_material_has_no_interval(tmp_path: Path) -> None:
    text = "x [mm],diameter [mm],bore [mm],material\n0,12.4,8,ash\n300,13,7,ash\n736,21,6,hard maple\n"
    segments = cf.load(write_profile(tmp_path, text)).segments
    assert [(1e3 * s.tip_bore, 1e3 * s.butt_bore) for s in segments] == [(8, 7), (7, 6)]


@pytest.mark.parametrize("word", ["Ferrule", "Zwinge", "Hülse", "virola", "virole", "先角", "선골"])
def test_profile_ferrule_heading_in_another_language_is_read(word: str, tmp_path: Path) -> None:
    text = f"x [mm],diameter [mm],{word}\n0,12.75,25 mm melamine\n330,13.2,\n736.6,21.5,\n"
    cue = cf.load(write_profile(tmp_path, text))
    assert isinstance(cue, cf.Cue)
    assert cue.segments[0].material == material("melamine")


@pytest.mark.parametrize("name", ["foo", "ratio", "instance", "form", "long side", "state", "score", "code", "tol"])
def test_profile_column_of_another_word_is_read_with_a_warning(name: str, tmp_path: Path) -> None:
    (path := tmp_path / "shaft.csv").write_text(f"x [mm],diameter [mm],{name}\n0,12.4,1\n736,21,2\n")
    with pytest.warns(cf.PlausibilityWarning, match=f"column '{name}' is not used"):
        cf.load(path)
