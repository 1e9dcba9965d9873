"""A sheet is declared once and shown alike in a terminal, on a page and in a spreadsheet (properties)."""

from __future__ import annotations

import ast
import csv
import io
import json
import re
from html import unescape
from pathlib import Path

import pytest
from rich.console import Console

import cuefem
from cuefem.report import everything
from cuefem.report.table import csv_text, json_text, terminal
from cuefem.report.templates import environment
from cuefem.results.quantities import NONE, RESULTS, Result
from cuefem.results.records import Sheet, by_words, sheet, value_rows
from tests.helpers.command_line import call

PACKAGE = Path(cuefem.__file__).parent
ROWS = [{"at": 0.01, "felt": 0.0062, "part": 0.25}, {"at": 0.02, "felt": None, "part": -0.5}]


def cells(made: Sheet) -> dict[str, list[list[str]]]:
    """What stands in the cells of a sheet, by medium."""
    console = Console(width=200, file=io.StringIO())
    with console.capture() as said:
        console.print(terminal(made))
    lines = [line for line in said.get().splitlines()[1:] if line.strip() and "─" not in line]
    markup = str(environment().get_template("drawings.html.j2").module.sheet(made))  # type: ignore[attr-defined]
    page = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in re.findall(r"<tr.*?</tr>", markup)]
    return {
        "terminal": [re.split(r"\s{2,}", line.strip()) for line in lines],
        "page": [[unescape(cell) for cell in row] for row in page],
        "spreadsheet": list(csv.reader(io.StringIO(csv_text(made.head, made.rows)))),
    }


def test_every_medium_shows_the_same_cells() -> None:
    columns = {"place": "{at:m}", "felt <there>": "{felt:end_mass}", "part": "{part:.1 %}"}
    made = sheet("Where", columns, ROWS, texts=())
    whole = [["place", "felt <there>", "part"], ["10 mm", "6.200 g", "25.0 %"], ["20 mm", NONE, "-50.0 %"]]
    assert cells(made) == dict.fromkeys(("terminal", "page", "spreadsheet"), whole)


def test_a_made_up_quantity_is_shown_by_its_declaration_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(RESULTS, "collar", Result("length of the collar", "m", 2))
    made = sheet("Collars", by_words("collar"), [{"collar": 0.0123}])
    assert (made.head, made.rows) == (("length of the collar",), (("12.30 mm",),))
    assert value_rows({"collar": None, "mass": 0.5}, ["collar", "mass"]) == [("mass of the cue", "500.0 g")]


def test_what_is_missing_is_a_dash_also_within_what_is_missing() -> None:
    made = sheet("", {"error": "{plain[error]:error}"}, [{"plain": {"error": 1e-3}}, {"plain": None}])
    assert made.rows == (("1.0e-03",), (NONE,))


def test_json_has_no_numbers_that_json_has_not() -> None:
    assert json.loads(json_text({"a": float("inf"), "b": [float("nan"), 1.0], "c": {"d": 2}})) == {
        "a": None,
        "b": [None, 1.0],
        "c": {"d": 2},
    }


def test_a_spreadsheet_takes_no_cell_for_a_formula() -> None:
    assert csv_text(["=1+1"], [["-2"], ["-x"]]).split() == ["'=1+1", "-2", "'-x"]


def test_a_sheet_added_to_the_report_is_printed(monkeypatch: pytest.MonkeyPatch, kim: Path) -> None:
    known = everything.values_sheet
    monkeypatch.setattr(everything, "values_sheet", lambda *_: known("All of it", [("a collar", "3 mm")], "of brass"))
    out = call("report", kim)[1]
    assert re.search(r"All of it.*a collar +3 mm.*of brass", out, flags=re.DOTALL)


@pytest.fixture
def kim() -> Path:
    return PACKAGE.parent / "meshes/kim.toml"


def test_one_file_alone_renders_for_the_terminal() -> None:
    """What is shown is declared without a word on how: rich stands in one file of the report."""
    importing = {
        path.name
        for path in (PACKAGE / "report").rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("rich")
    }
    assert importing == {"table.py"}


def test_pages_have_one_way_to_write_a_sheet() -> None:
    heads = {path.name: path.read_text(encoding="utf-8").count("<thead>") for path in (PACKAGE / "report").glob("*.j2")}
    assert {name: count for name, count in heads.items() if count} == {"drawings.html.j2": 1}
