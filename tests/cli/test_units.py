"""Units of display: every number in US units is the metric one, files stay metric, unknown systems (properties)."""

import re
from itertools import zip_longest
from pathlib import Path
from typing import NamedTuple

import pytest

from cuefem.cli import scene_command
from cuefem.quantity.display_units import displayed_system
from cuefem.results.records import Table
from tests.helpers.command_line import call, stdout_of
from tests.helpers.invalid_input import assert_rejects
from tests.helpers.sweeps import SCATTER, STUDY, write_study
from tests.test_golden_files import NUMBER, last_place

ROOT = Path(__file__).parents[2]
HOLLOW, KIM = ROOT / "meshes/pool_hollow.toml", ROOT / "studies/scenes/kim.toml"
FACTORS = {("mm", "in"): 25.4, ("g", "oz"): 28.349523125, ("m/s", "mph"): 0.44704, ("mm/m", "in/4 ft"): 1e3 / 48}
FACTORS |= {
    ("N/m", "lbf/in"): 175.126835,
    ("kN/mm", "lbf/in"): 1.75126835e-4,
    ("mm/N", "in/lbf"): 5.71014715,
    ("N", "lbf"): 4.44822162,
    ("mJ", "in·lbf"): 112.984829,
}
FACTORS |= {("kg/m³", "lb/ft³"): 16.0184634, ("GPa", "×10⁶ psi"): 6.89475729, ("MPa", "psi"): 6.89475729e-3}
FACTORS |= {("rad/s", "rpm"): 0.104719755, ("m/s", "ft/s"): 0.3048}
OFF_LINE = {"mm": "mm/m", "in": "in/4 ft"}  # the sentence says "after 1 m"
QUANTITY = re.compile(
    rf"({NUMBER.pattern})|(?<=\d[ \u00a0])(mm/m|mm|g|m/s|in/4 ft|in·lbf|in|oz|mph|N/m|kN/mm|N|GPa|MPa|kg/m³|mJ|rad/s|"
    r"mm/N|lbf/in|in/lbf|lbf|×10⁶ psi|psi|lb/ft³|rpm|ft/s)(?![\w/])"
)
DRAWN = re.compile(r"(?<![\w.])\.(?=\d)")  # a size below 1 in, as on a drawing
AFTER = re.compile(r"after (?:1 m|4 ft)")
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


class Shown(NamedTuple):
    """A number, its unit, and whether that stands right behind it."""

    number: str
    unit: str
    is_beside: bool


def cells(things: list[Table | str]) -> list[tuple[str, str]]:
    """Every text of tables and lines, with the unit of its column's heading, or "off line" for such distances."""
    texts = []
    for each in things:
        if isinstance(each, str):
            texts.append((each, "off line" if "off line" in each else ""))
            continue
        texts += [(text, "") for text in (each.title, *each.notes)]
        for row in each.rows:
            own = row[each.head.index("unit")] if "unit" in each.head else "off line" if "off line" in row[0] else ""
            units = (own or head.rpartition(", ")[2] for head in each.head)
            texts += zip(row, units, strict=True)
    return texts


def quantities(text: str, column: str) -> list[Shown]:
    """The numbers of a text, each with the next unit behind it, or that of its column."""
    found: list[Shown] = []
    unit, begins = column, -1
    for match in reversed([*QUANTITY.finditer(DRAWN.sub("0.", AFTER.sub("", text)))]):
        if match[2]:
            unit, begins = OFF_LINE.get(match[2], match[2]) if column == "off line" else match[2], match.start()
        else:
            found.append(Shown(match[1].replace("−", "-"), unit, begins == match.end() + 1))
    return found[::-1]


def assert_same_quantities(metric: list[tuple[str, str]], us: list[tuple[str, str]]) -> int:
    """Each number converts back within the rounding of both; how many had another unit."""
    converted = 0
    for before, after in zip_longest(metric, us):
        for mine, other in zip_longest(quantities(*before), quantities(*after)):
            if mine.number == other.number and not mine.is_beside:
                continue
            factor = FACTORS.get((mine.unit, other.unit), 1.0)
            rounded = other.unit in ("psi", "ft/s")  # three digits of a leather's E or of a wave's speed
            places = 100 if rounded else last_place(other.number)
            rounding = 0.51 * (last_place(mine.number) + factor * places)
            assert abs(float(mine.number) - factor * float(other.number)) <= rounding, (before, after)
            converted += factor != 1.0
    return converted


@pytest.mark.parametrize(
    "arguments", [*QUICK, *(pytest.param(slow, marks=pytest.mark.heavy) for slow in SLOW)], ids=str
)
def test_every_number_in_us_units_is_the_metric_one(arguments: list[object], monkeypatch: pytest.MonkeyPatch) -> None:
    """In every table and line of a command; no metric length, speed or weight remains."""
    shown: list[list[Table | str]] = []
    monkeypatch.setattr(scene_command, "print_tables", lambda things: shown.append([*things]))
    for units in ("metric", "us"):
        stdout_of(*arguments, "--units", units)
    metric, us = map(cells, shown)
    assert [text for text, _ in us if METRIC_LEFT.search(text)] == []
    assert assert_same_quantities(metric, us) > 0


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
