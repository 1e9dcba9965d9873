"""`cuefem compare` on measured cues: numbers of the library, the template, the page (regression)."""

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.io.measured_folder import TEMPLATE, load_measured
from cuefem.measurements.estimate import estimate
from cuefem.measurements.measured_cue import compare
from cuefem.measurements.measurement_types import MEASUREMENT_TYPES
from tests.helpers.command_line import as_json, call, stdout_of
from tests.helpers.measured_cues import SOME, folder
from tests.helpers.refusals import command_refuses


def test_numbers_and_the_page(tmp_path: Path) -> None:
    place, page = folder(tmp_path / "cue"), tmp_path / "page.html"
    (place / "squirt.csv").write_text("offset,value [deg],error [deg]\n0.3,1.5,0.1\n", encoding="utf-8")
    found, (cue, _) = as_json("compare", place), load_measured(place)
    for told, row in zip(found["rows"], compare(cue), strict=True):
        assert told["label"] == row.measurement.label
        assert [told[name] for name in ("computed", "spread", "pull")] == [row.computed, row.spread, row.pull]
    assert (found["name"], found["missing"]) == ("a cue", cue.missing)
    out = stdout_of("compare", place)
    assert all(words in out for words in ("weight of the shaft", "100.00 ± 0.50 g", "Missing measurements"))
    assert call("compare", place, "-o", page) == (0, f"wrote {page}\n", "")
    text = page.read_text(encoding="utf-8")
    assert all(f">{one.label}<" in text for one in cue.measurements)
    assert "http" not in text.replace("http://www.w3.org", "")


@pytest.mark.parametrize("drawing", ["cue.toml", "cue.csv"])
def test_only_the_shaft_must_be_there(tmp_path: Path, drawing: str) -> None:
    place = folder(tmp_path / "cue")
    (place / "measured.toml").unlink()
    if bare := drawing == "cue.csv":
        (place / "cue.toml").unlink()
        (place / "cue.csv").write_text("x [mm],diameter [mm]\n0,12.75\n730,21\n", encoding="utf-8")
    status, out, err = call("compare", place)
    assert (status, err[:7]) == (0, "unusual" if bare else "")
    assert all(kind.title in out for kind in MEASUREMENT_TYPES.values())


def test_the_template_holds_every_kind(tmp_path: Path) -> None:
    place = tmp_path / "mine"
    assert call("compare", place, "--template")[::2] == (0, "")
    assert sorted(path.name for path in place.iterdir()) == sorted(TEMPLATE)
    cue, notes = load_measured(place)
    assert {type(one) for one in cue.measurements} == set(MEASUREMENT_TYPES.values())
    assert cue.missing == []
    assert notes[0].startswith(", ".join(name for name in sorted(TEMPLATE) if name != "README.md"))
    (place / "squirt.csv").unlink()
    (place / "cue.toml").write_text((place / "cue.toml").read_text().replace("467 g", "450 g"), encoding="utf-8")
    assert load_measured(place)[1][0].startswith("added_mass.csv, measured.toml as in the template")


def test_without_a_scene_it_is_the_games_usual_stroke(tmp_path: Path) -> None:
    """The one that every command gives to a drawing, of the game that measured.toml names."""
    place = folder(tmp_path / "cue")
    drawing = cf.load(place / "cue.toml")
    assert isinstance(drawing, cf.Cue)
    for game in ("", "snooker"):
        (place / "measured.toml").write_text(f'game = "{game}"\n' if game else "# none\n", encoding="utf-8")
        assert load_measured(place)[0].scene == cf.usual_scene(drawing, game or "pool")
    (place / "measured.toml").write_text('game = "pool"\n[tip]\nfriction = 0.5\n', encoding="utf-8")
    usual = cf.usual_scene(drawing)
    assert load_measured(place)[0].scene == replace(usual, tip=replace(usual.tip, friction=0.5))
    (place / "measured.toml").write_text('game = "chess"\n', encoding="utf-8")
    command_refuses("measured.toml: game: must be one of pool, carom, snooker, kim", "compare", place)


def test_an_estimate_has_the_numbers_of_the_library(tmp_path: Path) -> None:
    known = "".join(f'[[prior]]\nname = "{name}"\nspread = 0.0\n' for name in ("G", "bore width", "contact time"))
    place = folder(tmp_path / "cue", SOME + known)
    told = as_json("compare", place, "--estimate")
    found = estimate(load_measured(place)[0])
    assert [value["value"] for value in told["values"]] == pytest.approx([value.value for value in found.values])
    assert (told["misfit"], told["converged"]) == (pytest.approx(found.misfit), True)
    assert {gain["kind"] for gain in told["recommended"]} <= set(MEASUREMENT_TYPES)
    assert all(0 < gain["error_ratio"] <= 1 and gain["bits"] >= 0 for gain in told["recommended"])
