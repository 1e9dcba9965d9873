"""Units of display: no metric one is left in US units, files stay metric, unknown systems (properties)."""

import re
from pathlib import Path

import pytest

from cuefem.cli import scene_command
from cuefem.quantity.display_units import displayed_system
from cuefem.results.records import Table
from tests.helpers.command_line import call, stdout_of
from tests.helpers.invalid_input import assert_rejects
from tests.helpers.sweeps import SCATTER, STUDY, write_study

ROOT = Path(__file__).parents[2]
HOLLOW, KIM = ROOT / "meshes/pool_hollow.toml", ROOT / "studies/scenes/kim.toml"
METRIC = r"(?:mm|m/s|kg|N/m|kN/mm|N|GPa|MPa|kg/m³|mJ|rad/s|mm/N)(?![\w/])"
METRIC_LEFT = re.compile(rf"\d[\s\u00a0]*{METRIC}|, {METRIC}")
QUICK = [["report", KIM], ["strike", HOLLOW], ["end-mass", KIM], ["modes", KIM], ["effects", KIM]]
SLOW = [
    ["report", HOLLOW],
    ["compare", HOLLOW, "plain maple"],
    ["compare", "players maple"],
    ["compare", "predator z2", "--estimate"],
    ["check", HOLLOW],
]
PAGES = [
    ["report", "plain maple"],
    ["compare", HOLLOW, "plain maple"],
    ["study", ROOT / "studies/design/optimum.toml"],
    ["study", "sweep.toml"],
    ["study", "scatter.toml"],
]


def texts(things: list[Table | str]) -> list[str]:
    """Every text of tables and lines."""
    found = []
    for each in things:
        found += [each] if isinstance(each, str) else [each.title, *each.notes, *each.head, *sum(each.rows, ())]
    return found


@pytest.mark.parametrize(
    "arguments", [*QUICK, *(pytest.param(slow, marks=pytest.mark.heavy) for slow in SLOW)], ids=str
)
def test_tables_in_us_units_have_no_metric_one(arguments: list[object], monkeypatch: pytest.MonkeyPatch) -> None:
    """No length, speed or weight; numbers in both systems are in golden files of results and reports."""
    shown: list[Table | str] = []
    monkeypatch.setattr(scene_command, "print_tables", shown.extend)
    stdout_of(*arguments, "--units", "us")
    us = texts(shown)
    assert [text for text in us if METRIC_LEFT.search(text)] == []
    assert re.search(r"(^|, )in\b|\d[ \u00a0](in|lbf)\b", "\n".join(us), re.MULTILINE)


def test_json_is_metric(tmp_path: Path) -> None:
    """Printed or written, in every text; nothing stays chosen."""
    written = [tmp_path / f"{units}.json" for units in ("metric", "us")]
    for path in written:
        assert call("strike", KIM, "-o", path, "--units", path.stem)[0] == 0
    assert written[0].read_text() == written[1].read_text()
    study = tmp_path / "study.toml"
    vary = '[[vary]]\npath = "stroke.speed"\nvalues = ["1 m/s", "2 m/s"]\n'
    study.write_text(f'scene = "{HOLLOW.as_posix()}"\nresponses = ["squirt"]\n{vary}')
    assert call("study", study, "-o", written[1], "--units", "us")[0] == 0
    shown = written[1].read_text()
    assert re.search(r"\d mm\b", shown)
    assert re.search(r"\d (oz|in)\b", shown) is None
    assert stdout_of("modes", KIM, "--json", "--units", "us") == stdout_of("modes", KIM, "--json")
    assert displayed_system() == "metric"


def test_environment_chooses_units_and_option_overrides_it(monkeypatch: pytest.MonkeyPatch) -> None:
    us, metric = stdout_of("modes", KIM, "--units", "us"), stdout_of("modes", KIM)
    monkeypatch.setenv("CUEFEM_UNITS", "us")
    assert stdout_of("modes", KIM) == us != metric == stdout_of("modes", KIM, "--units", "metric")


def test_unknown_units_of_the_environment_are_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CUEFEM_UNITS", "imperial")
    assert_rejects("'CUEFEM_UNITS'): 'imperial' is not one of 'metric', 'us'", "modes", KIM)


@pytest.mark.heavy
@pytest.mark.parametrize("command", PAGES, ids=str)
def test_page_in_us_units_has_no_metric_one(command: list[object], tmp_path: Path) -> None:
    """Neither texts nor axes; the glossary is the handbook's."""
    for name, study in (("sweep", STUDY), ("scatter", SCATTER)):
        write_study(tmp_path, study, name=f"{name}.toml")
    page = tmp_path / "page.html"
    arguments = [tmp_path / each if each in ("sweep.toml", "scatter.toml") else each for each in command]
    assert call(*arguments, "-o", page, "--units", "us")[0] == 0
    text = re.sub(r"<(style|script|aside).*?</\1>", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    assert METRIC_LEFT.findall(re.sub(r"<[^>]*>", "\n", text)) == []
    assert re.search(r"\d\u00a0in\b|, in<", text)
