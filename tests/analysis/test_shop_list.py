"""The list of a shop's shafts: against single comparisons, its files, and what it cannot read (properties)."""

import csv
import json
import math
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.command_line import call

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


@pytest.mark.heavy
def test_mark_of_an_assumed_inside_is_of_the_named_cue_alone(tmp_path: Path) -> None:
    """Head, first screen and list mark "carbon", with another ferrule too, and not a maker's own carbon.csv."""
    write_shop(tmp_path / "shop")
    own, named = cf.load(tmp_path / "shop" / "s0.csv"), cf.load("carbon")
    changed = cf.load("carbon", ferrule="10 mm melamine")
    for cue, mark in ((own, "carbon"), (named, "carbon†"), (changed, "carbon†")):
        scenes = {"carbon": cf.usual_scene(cue), "plain maple": cf.usual_scene(cf.load("plain maple"))}
        compared = cf.compare(scenes)
        assert compared.table().head[1:3] == (mark, "plain maple")
        assert {row[0] for row in cf.shop_list(scenes).tables()[0].rows} == {mark, "plain maple"}
        assert f"<span>{mark}</span>" in compared.to_html()
