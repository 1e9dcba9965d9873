"""The six chapters for makers: numbers, pictures and example files are computed again (verification)."""

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.handbook import MAKERS, chapters
from cuefem.parameters.parameter import with_parameters
from cuefem.results.uncertainty import MODEL_ERROR, SHAFT_ERROR
from tests.helpers.command_line import call
from tests.helpers.maker_pictures import FOLDER, PICTURES, command_json, reference_squirts

TEXTS = {chapter.name: chapter.text for chapter in chapters() if chapter.name in MAKERS}
NUMBER = re.compile(r"[−+-]?\d+(?:\.\d+)?")


def test_makers_chapters_are_first_and_short() -> None:
    assert [chapter.name for chapter in chapters()][:6] == [*TEXTS] == [*MAKERS]
    assert max(len(text.split()) for text in TEXTS.values()) < 400
    pictures = re.findall(r"```drawing\n(\w+)", "".join(TEXTS.values()))
    assert len(pictures) == len(TEXTS)
    assert {*PICTURES} <= {*pictures}
    assert all((FOLDER / f"{name}.svg").exists() for name in pictures)


@pytest.mark.heavy
@pytest.mark.parametrize("name", PICTURES)
def test_picture_equals_redrawn_picture(name: str) -> None:
    """Within three units: rounded numbers may differ between machines."""
    stored, now = (FOLDER / f"{name}.svg").read_text(encoding="utf-8"), PICTURES[name]()
    assert NUMBER.sub("#", stored) == NUMBER.sub("#", now)
    both = zip(NUMBER.findall(stored), NUMBER.findall(now), strict=True)
    assert [(a, b) for a, b in both if abs(float(a.replace("−", "-")) - float(b.replace("−", "-"))) > 3] == []


@pytest.mark.heavy
def test_numbers_in_makers_chapters_equal_computation() -> None:
    verdict = command_json("report")["verdict"]
    degrees, off_line = math.degrees(verdict["squirt"]), 1e3 * math.tan(verdict["squirt"])
    off = degrees * verdict["uncertainty"]["total"]
    line = f"squirt {degrees:.2f} ± {off:.2f}° (at b/R 0.3, 3/10 of the way to the edge): the ball is"
    assert line in TEXTS["read_the_report"]
    assert f"about {off_line:.0f} mm off line after 1 m" in TEXTS["what_squirt_is"]
    known = reference_squirts()
    for name in ("low deflection", "carbon"):  # "about a fifth less"
        assert 0.18 < 1 - known[name] / known["plain maple"] < 0.24
    assert verdict["uncertainty"]["total"] == pytest.approx(0.2, abs=0.025)  # "off by about 20 %"
    assert f"The model's own is {100 * MODEL_ERROR:.0f} %" in TEXTS["read_the_report"]
    assert f"its uncertainty is {100 * SHAFT_ERROR:.0f} % of the difference for the model" in TEXTS["read_the_report"]
    assert f"{100 * SHAFT_ERROR:.0f} % of the change for the model" in TEXTS["change_it"]
    assert 0.13 < verdict["inputs"]["rho"] / 0.1 < 0.2  # "by about a sixth as much", of wood heavier by a tenth


def squirt_of(path: Path) -> float:
    """Squirt, degrees, by the default stroke of pool with a butt of 15 oz."""
    cue: Any = cf.load(path)
    return math.degrees(cf.strike(cf.usual_scene(replace(cue, body_mass=0.42524))).squirt)


@pytest.mark.parametrize(("name", "least", "most"), [("pool_maple", 1.0, 2.0), ("pool_hollow", -1.0, 0.0)])
def test_deeper_bore_changes_squirt_as_stated(name: str, least: float, most: float) -> None:
    """From 5 to 7 in: less than 1 % under the light ferrule of one, a loss under the other's; deeper no gain."""
    scene = cf.usual_scene(cf.load(Path("meshes") / f"{name}.toml"))
    of = {
        inches: cf.strike(with_parameters(scene, {"bore depth": 0.0254 * inches, "bore width": 0.006})).squirt
        for inches in (5, 7, 9, 12, 16)
    }
    change = {inches: 100 * (squirt / of[5] - 1) for inches, squirt in of.items()}
    assert least < change[7] < most
    assert all(-0.3 < change[inches] < 4.5 for inches in (9, 12, 16))
    if name == "pool_maple":
        assert "takes about 5 % off" in TEXTS["change_it"]
        assert 1 - of[5] / cf.strike(scene).squirt == pytest.approx(0.055, abs=0.005)


def test_profiles_in_chapters_load_as_bored_shaft(tmp_path: Path) -> None:
    """The bore behind the ferrule is empty, and both notations of the ferrule have the same squirt."""
    plain, ferrule = re.findall(r"```csv\n(.*?)```", TEXTS["measure_your_shaft"], re.DOTALL)
    files = next(chapter.text for chapter in chapters() if chapter.name == "files")
    cored = next(text for text in re.findall(r"```csv\n(.*?)```", files, re.DOTALL) if "core" in text)
    squirts = []
    for text in (plain, ferrule, cored):
        (path := tmp_path / "my_shaft.csv").write_text(text, encoding="utf-8")
        status, out, err = call("modes", path)
        assert (status, err) == (0, "")
        squirts.append(squirt_of(path))
        if text == plain:
            continue
        assert "bored 6 mm from 25 to 152 mm " in " ".join(out.split())
        front, bored, *rest = cf.load(path).segments  # type: ignore[union-attr]
        assert (front.length, front.tip_bore, bored.tip_bore) == pytest.approx((0.025, 0.008, 0.006), rel=0.02)
        assert (bored.core, bored.material) == (None, front.core)
        assert all(segment.tip_bore == 0 for segment in rest)
    assert squirts[2] == pytest.approx(1.660, abs=5e-3)  # 1.79 with the bore filled by the tenon's wood
    assert squirts[1] == pytest.approx(squirts[2], rel=0.01)
