"""Tables for people stay whole: at any width every label and every number that the widest shows (properties)."""

from __future__ import annotations

import io
import json
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

import cuefem as cf
from cuefem.cli import COMMANDS as TABLE
from cuefem.materials import MATERIALS
from cuefem.report.table import terminal
from cuefem.results.records import Sheet
from tests.helpers.command_line import call

ROOT = Path(__file__).parents[2]
POOL = "studies/scenes/pool_low_deflection.toml"
WIDE = 400
# Every table that a command makes, at least once; the word is one that its table holds.
COMMANDS = {
    "modes": (["modes", POOL, "--near", "250"], "frequency"),
    "end mass": (["end-mass", POOL], "squirt, at b/R 0.375"),
    "strike": (["strike", POOL], "natural pivot length"),
    "bare strike": (["strike", "meshes/kim.toml"], "ball velocity, normal"),
    "effects": (["effects", POOL], "RollingContact"),
    "cost": (["cost", POOL, "--most", "24"], "elements x order"),
    "check": (["check", "meshes/kim.toml"], "give of the tip, cue free"),
    "report": (["report", POOL], "two-part, this cue"),
    "lumped report": (["report", "{lumped}"], "two-part, this cue"),
    "parts": (["parts"], "yellow birch"),
    "scatter": (["scatter", "{scatter}"], "95 %"),
}


def rendered(things: list[Any], width: int) -> str:
    out = io.StringIO()
    console = Console(file=out, width=width, force_terminal=False, highlight=False)
    for thing in things:
        console.print(thing, crop=False) if not isinstance(thing, str) else console.print(thing, markup=False)
    return out.getvalue()


def words(text: str) -> list[str]:
    return sorted(word for word in text.split() if set(word) != {"─"})


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("tables")
    cf.save(cf.Scene(cf.LumpedCue(0.54, 0.006), stroke=cf.Stroke(offset=0.3)), folder / "lumped.toml")
    study = (ROOT / "studies/design/scatter_maple.toml").read_text(encoding="utf-8").replace("count = 256", "count = 8")
    study = study.replace("scatter_scene.toml", str(ROOT / "studies/design/scatter_scene.toml"))
    (folder / "scatter.toml").write_text(study, encoding="utf-8")
    made = {"lumped": "lumped.toml"}
    return {name: str(folder / path) for name, path in made.items()} | {"scatter": str(folder / "scatter.toml")}


@pytest.fixture(scope="module")
def shown(files: dict[str, str]) -> Callable[[str], list[Any]]:
    """What a command prints, as it hands it to rich; each command once."""
    known: dict[str, list[Any]] = {}

    def of(name: str) -> list[Any]:
        if name not in known:
            with pytest.MonkeyPatch.context() as patch:
                things: list[Any] = []
                patch.setattr(Console, "print", lambda self, thing, **options: things.append(thing))
                patch.chdir(ROOT)
                arguments = [part.format_map(files) for part in COMMANDS[name][0]]
                assert call(*arguments)[::2] == (0, "")
            known[name] = things
        return known[name]

    return of


@pytest.mark.heavy
@pytest.mark.parametrize("width", [80, 60])
@pytest.mark.parametrize("name", COMMANDS)
def test_nothing_of_a_commands_tables_is_lost(name: str, width: int, shown: Callable[[str], list[Any]]) -> None:
    things = shown(name)
    whole = rendered(things, WIDE)
    assert COMMANDS[name][1] in whole
    narrow = rendered(things, width)
    assert "…" not in narrow
    assert words(narrow) == words(whole)
    numbers = re.findall(r"(?<=  )-?\d[\d.e+-]* (?:Hz|g|mm|ms|m/s|rad/s|%|kHz)(?=  |$)", whole, flags=re.MULTILINE)
    assert [number for number in numbers if number not in narrow] == []  # on one line with their units
    if width == 80:
        assert max(map(len, narrow.splitlines())) <= width


def test_headings_wrap_before_texts_and_numbers_never() -> None:
    table = terminal(
        Sheet("A title", ("what", "a long heading", "another one"), (("[words] of text", "-1.2345 m/s", "3.4e-12"),))
    )

    def lines(width: int) -> list[str]:
        return [line.strip() for line in rendered([table], width).splitlines()[1:] if line.strip()]

    head, _, row = lines(60)
    assert head.split() == ["what", "a", "long", "heading", "another", "one"]
    assert re.fullmatch(r"\[words\] of text +-1.2345 m/s +3.4e-12", row)
    above, head, _, row = lines(39)
    assert (above.split(), head.split()) == (["a", "long", "another"], ["what", "heading", "one"])
    assert re.fullmatch(r"\[words\] of text +-1.2345 m/s +3.4e-12", row)
    *_, row, rest = lines(32)
    assert (row.split("  ")[0], rest) == ("[words] of", "text")
    assert lines(20) == lines(60)  # even the least is too wide: the terminal may wrap it


def test_a_terminal_gets_it_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "40")
    out = re.sub(r"\x1b\[[0-9;]*m", "", call("parts")[1])
    assert "…" not in out
    table = out.split("Materials")[1].split("in brackets the range")[0]
    rows = [line for line in table.splitlines() if "(" in line]
    assert len(rows) == len(MATERIALS)
    assert all(name in row for name, row in zip(MATERIALS, rows, strict=True))
    assert all(row.count("(") == row.count(")") == 3 for row in rows)


def test_the_mode_nearest_a_frequency_is_marked() -> None:
    kim = str(ROOT / "meshes/kim.toml")
    plain, near = call("modes", kim)[1], call("modes", kim, "--near", "250")[1]
    (marked,) = (line.split() for line in near.splitlines() if line.endswith("nearest  "))
    assert "nearest" not in plain
    found = json.loads(call("modes", kim, "--near", "250", "--json")[1])
    assert found["nearest"] == min(found["frequencies"], key=lambda frequency: abs(frequency - 250))
    assert marked[0] == f"{found['nearest']:.2f}"
    assert json.loads(call("modes", kim, "--json")[1])["nearest"] is None


def test_what_changes_little_is_told_without_colours(shown: Callable[[str], list[Any]]) -> None:
    lines = [line.split("  ")[0] for line in rendered(shown("effects"), 80).splitlines()]
    border = lines.index("changes less than 1 %:")
    assert "without TipDome" in lines[:border]
    assert "with SecondHit" in lines[border:]


def test_no_command_s_summary_is_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.get_terminal_size", lambda *_, **__: os.terminal_size((78, 24)))
    status, out, _ = call("--help")
    listed = out.split("Commands:\n")[1].splitlines()
    assert status == 0
    assert "…" not in out
    assert [line.split()[0] for line in listed] == sorted(TABLE)  # a line each
    assert all(re.search(r"[^.]\.$", line) for line in listed)
    assert max(map(len, out.splitlines())) <= 78
