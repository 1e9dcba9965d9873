"""What commands write of made files, with their pages' charts, against golden files (regression)."""

import re
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from tests.helpers.command_line import call
from tests.helpers.cues import kim, low_deflection
from tests.helpers.measured_cues import MEASURED_TOML, OTHER_KINDS, measured_folder
from tests.helpers.surfaces import revolve, write_surface
from tests.helpers.sweeps import OPTIMUM, SCATTER, STUDY, vary, write_study
from tests.test_golden_files import assert_golden, drawing_text, page_text, rounded

SPRING = cf.Scene(kim(), tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(2.0, 0.3))
BESIDE = ("cue.toml", "old/cue.toml", "slippery.toml", "cue.toml")
# Millimetres: a ferrule on a bored front with a step, and a cone behind it.
BORED = ((0, 0), (0, 2), (120, 2.5), (120, 0)), ((0, 6), (25, 6), (25, 6.2), (300, 6.5), (700, 10.5))
KNOWN = "".join(f'[[prior]]\nname = "{name}"\nspread = 0.0\n' for name in ("G", "bore width", "contact time"))


def sweep(folder: Path) -> list[list[object]]:
    """A grid of bores, contact times and woods, of which eight fail; and one of which all do."""
    write_study(
        folder, STUDY.replace('low = "0 mm"\nhigh = "15 mm"', 'low = "13 mm"\nhigh = "14 mm"'), name="none.toml"
    )
    write_study(folder, STUDY.replace("count = 8", "count = 4"))
    outputs = ["-o", "best.toml", "-o", "page.html", "-o", "study.json"]
    front = ["study", "study.toml", "--front", "-o", "front.csv"]
    return [["study", "none.toml", *outputs], ["study", "study.toml", *outputs], front]


def scatter(folder: Path) -> list[list[object]]:
    """A tolerance analysis with a correlation and a group."""
    write_study(folder, SCATTER.replace("count = 16", "count = 4"))
    return [["study", "study.toml", "-o", "page.html", "-o", "study.json"]]


def optimum(folder: Path) -> list[list[object]]:
    """An optimum under a limit."""
    write_study(folder, OPTIMUM)
    return [["study", "study.toml", "--iterations", "1", "-o", "page.html"]]


def optimum_of_woods(folder: Path) -> list[list[object]]:
    """The best of three woods, of which one is not stiff enough."""
    woods = vary('"cue.segments[0].material"', 'values = ["hard maple", "ash", "purpleheart"]')
    write_study(folder, OPTIMUM.partition("[[vary]]")[0].replace("300 N/m", "650 N/m") + woods)
    return [["study", "study.toml", "-o", "page.html"]]


def trade_off(folder: Path) -> list[list[object]]:
    """A lighter shaft against a stiffer one; the smallest change that makes it 95 g."""
    text = OPTIMUM.replace('minimize = "squirt_slope"', 'minimize = "shaft_mass"\nagainst = "tip_stiffness"\ncount = 5')
    write_study(folder, text)
    target = OPTIMUM.replace('minimize = "squirt_slope"', 'response = "shaft_mass"\ntarget = "95 g"')
    write_study(folder, target, name="target.toml")
    return [
        ["study", name, "-o", output] for name, output in (("study.toml", "page.html"), ("target.toml", "best.toml"))
    ]


def comparison(folder: Path) -> list[list[object]]:
    """A measured cue, compared; one whose weight contradicts its drawing; one with every kind of measurement; none."""
    measured_folder(folder / "cue")
    measured_folder(folder / "heavy", MEASURED_TOML.replace('"100 g"', '"160 g"'))
    measured_folder(folder / "all", MEASURED_TOML + OTHER_KINDS + KNOWN)
    (measured_folder(folder / "bare") / "measured.toml").unlink()
    return [*(["compare", name, "-o", f"{name}.html"] for name in ("cue", "heavy", "all")), ["compare", "bare"]]


def beside(folder: Path) -> list[list[object]]:
    """A cue beside another of its name, which takes its ball and stroke, and beside one that miscues."""
    (folder / "old").mkdir()
    cf.save(SPRING, folder / "cue.toml")
    cf.save(replace(SPRING, cue=low_deflection(), stroke=cf.Stroke(3.0, 0.4)), folder / "old" / "cue.toml")
    cf.save(replace(SPRING, tip=replace(SPRING.tip, friction=0.2)), folder / "slippery.toml")
    return [["compare", first, other, "-o", "page.html"] for first, other in pairwise(BESIDE)]


def shop(folder: Path) -> list[list[object]]:
    """A folder of three shafts, and a drawing that cannot be read."""
    shafts = folder / "shop"
    shafts.mkdir()
    for name, values in (("own", {}), ("slim", {"tip diameter": 0.0115}), ("alike", {"tip diameter": 0.01202})):
        cf.save(cf.with_parameters(SPRING, values), shafts / f"{name}.toml")
    (shafts / "broken.csv").write_text("x (in),d (in)\n0,.5\n14,abc\n", encoding="utf-8")
    (shafts / "notes.txt").write_text("no drawing", encoding="utf-8")
    return [["compare", "shop", "-o", f"list.{kind}"] for kind in ("html", "csv", "json")]


def filled(folder: Path) -> list[list[object]]:
    """Options that fill in what one of two cues leaves open."""
    (folder / "bare.csv").write_text("x [mm],diameter [mm]\n0,12\n700,21\n", encoding="utf-8")
    (folder / "bare.toml").write_text('cue = "bare.csv"\n[tip]\ncontact_time = "1 ms"\n', encoding="utf-8")
    cf.save(SPRING, folder / "own.toml")
    return [["compare", "bare.toml", "own.toml", "--body-mass", "15 oz", "--ferrule", "1 in melamine"]]


def like(folder: Path) -> list[list[object]]:
    """The bore that gives a shaft the squirt of a slimmer one."""
    cf.save(SPRING, folder / "cue.toml")
    cf.save(cf.with_parameters(SPRING, {"tip diameter": 0.0118}), folder / "slim.toml")
    return [["improve", "cue.toml", "--like", "slim.toml", "--keep", "taper,ferrule,wood"]]


def estimate(folder: Path) -> list[list[object]]:
    """E and density of the wood, estimated from a weight and a tone."""
    measured_folder(folder / "cue", MEASURED_TOML.partition("[[stiffness]]")[0] + KNOWN)
    return [["compare", "cue", "--estimate", "-o", "estimated.html"]]


def surfaces(folder: Path) -> list[list[object]]:
    """CAD surfaces: in three units, bored, mirrored, off circles, oval, nearly straight, bent, open, too short."""
    inner, outer = BORED
    outline = [(1e-3 * x, 1e-3 * r) for x, r in (*inner[::-1], *outer, (700, 0))]
    points, faces = revolve(outline, 16)
    trefoil = 1 + 0.01 * np.cos(3 * np.arctan2(points[:, 2], points[:, 1]))
    rows = {
        "bored.stl": (points, faces, 1e-3),
        "inches.ply": (points, faces, 0.0254),
        "turned.obj": (points[:, [2, 0, 1]] * [1, -1, 1], faces, 1e-3),
        "mirrored.stl": (points * [-1, 1, 1], faces, 1e-3),
        "trefoil.stl": (points * trefoil[:, None] ** [0, 1, 1], faces, 1e-3),
        "oval.stl": (points * [1, 1.04, 1], faces, 1e-3),
        "straight.stl": (points + np.outer(points[:, 0] ** 2, [0, 5e-4, 3e-4]), faces, 1e-3),
        "bent.stl": (points + np.outer(points[:, 0] ** 2, [0, 0.1, 0.06]), faces, 1e-3),
        "open.stl": (points, faces[:-9], 1e-3),
        "metres.stl": (points, faces, 1.0),
    }
    for name, (corners, triangles, unit) in rows.items():
        write_surface(folder / name, corners, triangles, unit=unit)
    units = {"inches.ply": "in", "metres.stl": "mm"}
    return [
        ["convert", *(["--length-unit", units[name]] if name in units else []), name, f"{name}.toml"] for name in rows
    ]


def convert(folder: Path) -> list[list[object]]:
    """A profile, a cue and a scene, with options."""
    (folder / "shaft.csv").write_text("x [mm],diameter [mm]\n0,12\n700,21\n", encoding="utf-8")
    effects = cf.PointMass(position=0.1, mass=0.005), cf.Elevation(0.1), cf.AxialWaves(1.45, 0.03, 4400.0)
    cf.save(kim(), folder / "cue.toml")
    cf.save(replace(SPRING, effects=effects), folder / "scene.toml")
    return [
        ["convert", "shaft.csv", "shaft.toml", "--material", "ash"],
        ["convert", "cue.toml", "new.toml", "--body-mass", "15 oz"],
        ["convert", "scene.toml", "shaft.toml", "--body-mass", "0.4 kg", "--force"],
    ]


def parts(folder: Path) -> list[list[object]]:
    """Parts that a file may name."""
    return [["parts"]]


def clamped(folder: Path) -> list[list[object]]:
    """A stroke whose simpler models have no end mass, and leather too soft for any."""
    tip, clamp = cf.Tip(0.75, 0.7, contact_time=2e-3), cf.Support(0.01, 1e8)
    cf.save(cf.Scene(kim(), tip=tip, stroke=cf.Stroke(offset=0.3), effects=(clamp,)), folder / "clamped.toml")
    return [["strike", "clamped.toml"], ["report", "plain maple", "--leather", "1 MPa"]]


def written(path: Path) -> str:
    """A written file: a page's text and charts, or the file itself."""
    text = path.read_text(encoding="utf-8")
    return page_text(text) + drawing_text(text) if path.suffix == ".html" else text


STUDIES = (sweep, scatter, optimum, optimum_of_woods, trade_off)
CUES = (comparison, shop, filled, like, estimate, convert, parts, clamped)
HEAVY = [pytest.param(each, marks=pytest.mark.heavy) for each in (beside, surfaces)]


@pytest.mark.parametrize("prepare", [*STUDIES, *CUES, *HEAVY])
def test_written_files_equal_golden_file(
    prepare: Callable[[Path], list[list[object]]],
    tmp_path: Path,
    request: pytest.FixtureRequest,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "110")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    lines = []
    for arguments in prepare(tmp_path):
        status, out, err = call(*arguments)
        lines += [f"$ {' '.join(map(str, arguments))}: {status}", out, err]
        lines += [written(tmp_path / name) for name in re.findall(r"^wrote (\S+)$", out + err, re.MULTILINE)]
    assert_golden(f"written_{prepare.__name__}.txt", rounded("\n".join(lines)), request)
