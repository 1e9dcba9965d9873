"""Cues side by side: differences are those of the strikes, and errors that cues share cancel (properties)."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.parameters.parameter import varied
from cuefem.results.comparison import OTHER_FLOOR, comparison_record
from cuefem.results.uncertainty import FLOOR, MASSES, SHAFTS
from tests.helpers.command_line import as_json, call
from tests.helpers.cues import pool

SCENE = cf.usual_scene(pool())
BORED = varied(SCENE, {"bore depth": 0.1, "bore width": 0.006})


def test_differences_are_those_of_the_cues_alone() -> None:
    record = comparison_record({"plain": SCENE, "bored": BORED})
    squirts = [float(cf.strike(scene).squirt) for scene in (SCENE, BORED)]
    assert [record["cues"][name]["squirt"] for name in ("plain", "bored")] == pytest.approx(squirts, rel=1e-9)
    assert record["cues"]["plain"]["end_mass_squirt"] == pytest.approx(cf.end_mass(SCENE, "squirt"), rel=1e-9)
    squirt = record["differences"]["bored"]["squirt"]
    assert squirt["difference"] == pytest.approx(squirts[1] / squirts[0] - 1, rel=1e-9)
    assert squirt["error"] > abs(squirt["difference"]) * SHAFTS / 1.1


def test_shared_errors_cancel() -> None:
    """Of one cue beside itself only the floor is left; of two pieces of wood the root of two of each input's."""
    twin = {"a": SCENE, "b": replace(SCENE)}
    same = comparison_record(twin, same_shaft=True)["differences"]["b"]
    assert same["squirt"]["error"] == pytest.approx(FLOOR, rel=1e-9)
    assert same["shaft_mass"]["error"] == same["frequency_1"]["error"] == pytest.approx(OTHER_FLOOR, rel=1e-9)
    two = comparison_record(twin)["differences"]["b"]
    assert not any(each["distinct"] for each in two.values())
    rho = varied(SCENE, {"rho": 700.0 * math.exp(0.1)})
    assert two["shaft_mass"]["error"] > 0.9 * (rho.shaft.shaft_mass / SCENE.shaft.shaft_mass - 1)


def test_a_weight_makes_a_difference_surer_and_all_are_struck_like_the_first() -> None:
    faster = replace(SCENE, stroke=cf.Stroke(4.0, 0.1))
    light, heavy = (varied(scene, {"shaft mass": mass}) for scene, mass in ((SCENE, 0.100), (faster, 0.115)))
    weighed = comparison_record({"light": light, "heavy": heavy})
    assert (weighed["speed"], weighed["offset"]) == (SCENE.stroke.speed, SCENE.stroke.offset)
    mass = weighed["differences"]["heavy"]["shaft_mass"]
    assert (mass["error"] < 0.01, mass["distinct"]) == (True, True)
    bare = comparison_record({"light": SCENE, "heavy": varied(SCENE, {"rho": 800.0})})
    assert bare["differences"]["heavy"]["squirt"]["error"] > weighed["differences"]["heavy"]["squirt"]["error"]


def test_a_mass_on_one_shaft_is_less_sure_than_two_shafts() -> None:
    """The model's part of a ratio with a mass on the shaft is that of the measured masses."""
    clip = replace(SCENE, effects=(*SCENE.effects, cf.PointMass(0.05, 0.011)))
    squirt = comparison_record({"plain": SCENE, "clip": clip}, same_shaft=True)["differences"]["clip"]["squirt"]
    ln = math.log1p(squirt["difference"])
    assert squirt["error"] >= MASSES * ln * squirt["difference"] / ln > SHAFTS * squirt["difference"]


def test_the_command_compares_files_of_ones_own(tmp_path: Path) -> None:
    csv = "x [mm],diameter [mm]{0}\n0,12.75{1}\n150,12.95{2}\n330,13.2{2}\n736.6,21.5{2}\n"
    (tmp_path / "plain.csv").write_text(csv.format("", "", ""))
    (tmp_path / "bored.csv").write_text(csv.format(",bore [mm]", ",6", ","))
    files = (tmp_path / "plain.csv", tmp_path / "bored.csv", "--same-shaft", "--body-mass", "15 oz")
    record = as_json("compare", *files)
    assert record["differences"]["bored"]["squirt"]["distinct"]
    assert record["cues"]["plain"]["squirt"] == as_json("report", *files[:1], *files[3:])["numbers"]["squirt"]
    assert call("compare", *files, "-o", tmp_path / "both.html")[0] == 0
    page = (tmp_path / "both.html").read_text(encoding="utf-8")
    assert page.count("<svg") >= 4
    assert "plain and bored" in page


def test_the_verdict_is_the_same_in_either_order() -> None:
    for depth in (0.02, 0.1):
        bored = varied(SCENE, {"bore depth": depth, "bore width": 0.006})
        ends = [("a", SCENE), ("b", bored)]
        ways = [comparison_record(dict(pair), same_shaft=True) for pair in (ends, ends[::-1])]
        one, other = ways[0]["differences"]["b"], ways[1]["differences"]["a"]
        for name in one:
            sizes = [each[name]["difference"] / (each[name]["error"] or math.inf) for each in (one, other)]
            assert sizes[0] == pytest.approx(-sizes[1], rel=1e-6, abs=1e-9)


def test_a_miscue_is_not_compared(tmp_path: Path) -> None:
    for name, scene in (("plain", SCENE), ("bored", BORED)):
        cf.save(replace(scene, stroke=cf.Stroke(2.0, 0.8)), tmp_path / f"{name}.toml")
    files = (tmp_path / "plain.toml", tmp_path / "bored.toml")
    record = as_json("compare", *files)
    assert record["cues"]["plain"]["squirt"] is None
    assert not {"squirt", "pivot_length"} & {*record["differences"]["bored"]}
    assert "miscue" in call("compare", *files)[1]


def test_ball_and_stroke_are_those_of_the_first_alone(tmp_path: Path) -> None:
    cf.save(replace(SCENE, ball=cf.Ball(0.21, 0.03075), stroke=cf.Stroke(3.0, 0.4)), tmp_path / "first.toml")
    cf.save(pool(), tmp_path / "other.toml")
    record = as_json("compare", tmp_path / "first.toml", tmp_path / "other.toml")
    first, other = record["scenes"].values()
    assert (other["ball"], other["stroke"]) == (first["ball"], first["stroke"])
    assert not [note for note in record["assumed"] if any(word in note for word in (": ball", ": stroke", ": offset"))]


def test_cues_of_one_name_are_told_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "old").mkdir()
    files = ["cue.toml", "cue.vtu", "old/cue.toml", "other.toml"]
    for file in files:
        cf.save(pool(), tmp_path / file)
    monkeypatch.chdir(tmp_path)
    assert [*as_json("compare", *files)["cues"]] == ["cue.toml", "cue.vtu", "old/cue.toml", "other"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["cue.toml"], "needs another FILE"),
        (["cue.toml", "--speed", "3 m/s"], "compares with measurements"),
        (["cue.toml", "cue.toml", "--shaft-mass", "112 g"], "must stand in each cue's file"),
        (["cue.toml", "cue.toml", "--estimate"], "takes one FOLDER"),
        (["cue.toml"] * 6, "at most 5 cues"),
        (["cue.toml", "lumped.toml"], "LumpedCue"),
        (["cue.toml", "ash.toml", "--same-shaft"], "must be of one wood"),
        (["cue.toml", "lumped.toml", "./cue.toml"], "another file"),
        (["nowhere"], "got no folder"),
    ],
)
def test_refusals(arguments: list[str], words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cf.save(pool(), tmp_path / "cue.toml")
    cf.save(cf.Scene(cf.LumpedCue(0.54, 0.006)), tmp_path / "lumped.toml")
    cf.save(varied(SCENE, {"wood": "ash"}).shaft, tmp_path / "ash.toml")
    monkeypatch.chdir(tmp_path)
    status, out, err = call("compare", *arguments)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert words.casefold() in err.casefold()
