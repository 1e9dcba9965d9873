"""The published cues: their folders hold the numbers of the data, and compare to what their page says (validation)."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.handbook import chapters
from cuefem.io.measured_folder import load_measured
from cuefem.measurements.measurement_types import AddedMass, Measurement, PivotLength, Squirt
from cuefem.results.quantities import with_unit
from studies.pages import STUDIES
from tests.helpers.command_line import call

HOME = STUDIES / "measured"
FOLDERS = sorted(path for path in HOME.iterdir() if (path / "measured.toml").exists())
PLAYERS = HOME / "players_maple"
CUES = {"Players": "players_maple", "Predator": "predator_z", "Stinger": "stinger"}


def rows(name: str) -> list[dict[str, str]]:
    lines = (HOME / "data" / f"{name}.csv").read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def found(folder: str, kind: type[Measurement]) -> list[Measurement]:
    return [one for one in load_measured(HOME / folder)[0].measurements if isinstance(one, kind)]


def test_squirts_are_those_of_the_data() -> None:
    """Every row of the data stands in a folder."""
    for row in rows("measured_squirt"):
        own = found(CUES[row["cue"].split()[0]], Squirt)
        values = [(one.offset, round(math.degrees(one.measured), 6)) for one in own]
        assert (float(row["b_over_R"]), float(row["squirt_deg"])) in values


def test_pivot_lengths_are_those_of_the_data() -> None:
    for row in rows("pivot_lengths_2007"):
        (own,) = found(CUES[row["cue"].split()[0]], PivotLength)
        told = (float(row["b_over_R"]), float(row["pivot_length_in"]))
        assert (own.offset, own.value / 0.0254) == pytest.approx(told, rel=1e-12)


def test_added_masses_are_those_of_the_data() -> None:
    told = [(r["mass_g"], r["distance_in"], r["squirt_deg"]) for r in rows("added_mass_players_feb2008")]
    own = [
        (1e3 * one.mass, one.position / 0.0254, math.degrees(one.value))
        for one in load_measured(PLAYERS)[0].measurements
        if isinstance(one, AddedMass)
    ]
    assert np.array(own) == pytest.approx(np.array(told, float), rel=1e-12)


def test_the_page_says_what_is_computed() -> None:
    """The table of the folder's README, one line a measurement that is not of the series of added masses."""
    text = (HOME / "README.md").read_text(encoding="utf-8")
    for path in FOLDERS:
        assert f"[{path.name}]({path.name}/measured.toml)" in text
        cue, _ = load_measured(path)
        for one in cue.measurements:
            if not isinstance(one, AddedMass):
                computed = with_unit(one.computed(cue.setup()), one.unit)
                told = with_unit(one.measured, one.unit, error=one.sd)
                assert f"| {cue.name} | {one.label} | {told} | {computed} |" in text


@pytest.mark.parametrize("name", ["stinger", pytest.param("players_maple", marks=pytest.mark.heavy)])
def test_compare(name: str, tmp_path: Path) -> None:
    assert call("compare", HOME / name, "-o", tmp_path / "page.html")[::2] == (0, "")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert all(f">{one.label}<" in text for one in load_measured(HOME / name)[0].measurements)


def test_the_handbook_s_tables_are_those_of_the_studies() -> None:
    """Of measured squirt, of its uncertainty, and of what is left out."""
    pages = ("measured/squirt.md", "measured/uncertainty.md", "article/article.md")
    known = {line for page in pages for line in (STUDIES / page).read_text(encoding="utf-8").splitlines()}
    (text,) = (chapter.text for chapter in chapters() if chapter.name == "measured")
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert len(rows) > 30
    assert [row for row in rows if row not in known] == []


@pytest.mark.heavy
def test_the_stinger_s_tip_does_head_on_what_its_file_says() -> None:
    """0.9 ms and a rebound of 0.84 on a whole cue at 2 m/s."""
    tip = load_measured(HOME / "stinger")[0].scene
    struck = cf.usual_scene(cf.load(STUDIES.parent / "meshes" / "whole_cue.toml"), tip=tip.leather)
    E, restitution = cf.identify_tip(struck, 0.9e-3, 0.84)
    assert (tip.leather.E, tip.tip.restitution) == pytest.approx((E, restitution), rel=2e-3)
