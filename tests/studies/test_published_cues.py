"""Published cues: their folders against the data, their page and the handbook against computed values (validation)."""

import csv
import math

import pytest

from cuefem.handbook import chapters
from cuefem.measurements.measured_folder import load_measured
from cuefem.measurements.measurement_types import AddedMass, PivotLength, Squirt
from cuefem.quantity.display_units import with_unit
from studies.pages import STUDIES

HOME = STUDIES / "measured"
FOLDERS = sorted(path for path in HOME.iterdir() if (path / "measured.toml").exists())
PLAYERS = "players_maple"
CUES = {"Players": PLAYERS, "Predator": "predator_z", "Stinger": "stinger"}


def rows(name: str) -> list[dict[str, str]]:
    lines = (HOME / "data" / f"{name}.csv").read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def test_measured_folders_have_every_row_of_data() -> None:
    """Squirt and pivot length at offsets, and the series of added masses."""
    expected = [("squirt", CUES[r["cue"].split()[0]], r["b_over_R"], r["squirt_deg"]) for r in rows("measured_squirt")]
    pivots = rows("pivot_lengths_2007")
    expected += [("pivot", CUES[r["cue"].split()[0]], r["b_over_R"], r["pivot_length_in"]) for r in pivots]
    masses = rows("added_mass_players_feb2008")
    expected += [(f"{float(r['mass_g']):g} g", PLAYERS, r["distance_in"], r["squirt_deg"]) for r in masses]
    own = set()
    for name in CUES.values():
        for one in load_measured(HOME / name)[0].measurements:
            if isinstance(one, Squirt):
                own.add(("squirt", name, one.offset, round(math.degrees(one.measured_value), 6)))
            elif isinstance(one, PivotLength):
                own.add(("pivot", name, one.offset, round(one.value / 0.0254, 6)))
            elif isinstance(one, AddedMass):
                inch, squirt = round(one.position / 0.0254, 6), round(math.degrees(one.value), 6)
                own.add((f"{1e3 * one.mass:g} g", name, inch, squirt))
    assert {(kind, name, float(x), float(y)) for kind, name, x, y in expected} - own == set()


@pytest.mark.heavy
def test_measured_readme_states_computed_values() -> None:
    """Every measurement except the series of added masses."""
    text = (HOME / "README.md").read_text(encoding="utf-8")
    for path in FOLDERS:
        assert f"[{path.name}]({path.name}/measured.toml)" in text
        cue, _ = load_measured(path)
        for one in cue.measurements:
            if not isinstance(one, AddedMass):
                computed = with_unit(one.compute(cue.setup()), one.unit)
                measured = with_unit(one.measured_value, one.unit, error=one.sd)
                assert f"| {cue.name} | {one.label} | {measured} | {computed} |" in text


def test_handbook_tables_equal_those_of_studies() -> None:
    """Tables of measured squirt, its uncertainty, and excluded effects."""
    pages = ("measured/squirt.md", "measured/uncertainty.md", "article/article.md")
    known = {line for page in pages for line in (STUDIES / page).read_text(encoding="utf-8").splitlines()}
    (text,) = (chapter.text for chapter in chapters() if chapter.name == "measured")
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert len(rows) > 30
    assert [row for row in rows if row not in known] == []
