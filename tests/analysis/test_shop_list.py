"""The list of a shop's shafts: against single comparisons, its files, and what it cannot read (properties)."""

import csv
import json
import math
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.command_line import call
from tests.helpers.invalid_input import assert_rejects

FRONTS = (0.495, 0.505, 0.470)


def write_shop(folder: Path) -> Path:
    """Three shafts, and a file without a diameter."""
    folder.mkdir()
    for i, front in enumerate(FRONTS):
        rows = f"x (in),d (in)\n0,{front}\n14,{front + 0.015}\n29,.845\n"
        (folder / f"s{i}.csv").write_text(rows, encoding="utf-8")
    (folder / "broken.csv").write_text("x (in),d (in)\n0,.5\n14,abc\n", encoding="utf-8")
    (folder / "notes.txt").write_text("no drawing", encoding="utf-8")
    return folder


@pytest.mark.heavy
def test_list_equals_comparisons_and_names_what_it_cannot_read(tmp_path: Path) -> None:
    """JSON, CSV and page of a folder; the reference is its first file, and each difference that of `compare`."""
    shop = write_shop(tmp_path / "shop")
    files = [tmp_path / f"list.{kind}" for kind in ("json", "csv", "html")]
    for file in files:
        status, _, err = call("compare", shop, "--body-mass", "425 g", "-o", file)
        assert (status, err) == (2, f"cuefem: {shop}: 1 of 4 files have no answer\n")
    made = json.loads(files[0].read_text("utf-8"))
    assert made["unread"] == {"broken": "line 3, diameter: must be a number; got 'abc'"}
    assert [row["name"] for row in made["shafts"]] == ["s2", "s0", "s1"]
    scenes = {name: cf.usual_scene(cf.load(shop / f"{name}.csv", body_mass="425 g")) for name in ("s0", "s2")}
    single = cf.compare(scenes).differences["s2"]["squirt"]
    assert made["shafts"][0]["difference"] == pytest.approx(single["difference"], rel=1e-9)
    assert made["shafts"][0]["error"] == pytest.approx(single["error"], rel=0.05)
    head, *rows = csv.reader(files[1].read_text("utf-8-sig").splitlines())
    squirt = math.degrees(made["shafts"][0]["squirt"])
    assert float(rows[0][head.index("squirt, deg")]) == pytest.approx(squirt, rel=1e-5)
    assert rows[-1][0] == "broken"
    assert 'class="red"' in files[2].read_text("utf-8")


def test_folder_without_drawings_and_list_of_one_shaft_before_and_after_are_one_line(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    assert_rejects("must hold drawings (.toml, .csv, .stl, .ply, .obj), or", "compare", tmp_path / "empty")
    shop = write_shop(tmp_path / "shop")
    assert_rejects("--same-shaft and --calibration take at most 5 FILEs", "compare", shop, "--same-shaft")
    assert_rejects("a list is written as .html, .json or .csv", "compare", shop, "-o", tmp_path / "list.toml")
