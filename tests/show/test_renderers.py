"""Renderers: equal cells in terminal, page and CSV; missing values; narrow terminals (properties)."""

import csv
import io
import json
import re
from html import unescape
from typing import Any

from rich.console import Console

from cuefem.results.quantities import DASH, unbroken
from cuefem.results.records import Table, tabulate
from cuefem.show.renderers import csv_text, json_text, terminal
from cuefem.show.templates import environment

ROWS = [{"at": 0.01, "mass": 0.0062, "part": 0.25}, {"at": 0.02, "mass": None, "part": -0.5}]


def cells(table: Table) -> dict[str, list[list[str]]]:
    """The cells of a table by medium."""
    console = Console(width=200, file=io.StringIO())
    with console.capture() as captured:
        console.print(terminal(table))
    lines = [line for line in captured.get().splitlines()[1:] if line.strip() and "─" not in line]
    markup = str(environment().get_template("drawings.html.j2").module.cells(table))  # type: ignore[attr-defined]
    page = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in re.findall(r"<tr.*?</tr>", markup)]
    return {
        "terminal": [re.split(r"\s{2,}", line.strip()) for line in lines],
        "page": [[unescape(cell).replace("\u00a0", " ") for cell in row] for row in page],
        "spreadsheet": list(csv.reader(io.StringIO(csv_text(table.head, table.rows)))),
    }


def test_table_in_every_medium_has_same_cells() -> None:
    columns = {"position": "{at:m}", "mass <there>": "{mass:end_mass}", "part": "{part:.1 %}"}
    table = tabulate("Where", columns, ROWS, texts=())
    whole = [["position", "mass <there>", "part"], ["10 mm", "6.200 g", "25.0 %"], ["20 mm", DASH, "-50.0 %"]]
    assert cells(table) == dict.fromkeys(("terminal", "page", "spreadsheet"), whole)


def test_missing_value_is_dash_and_nonfinite_is_null() -> None:
    table = tabulate("", {"error": "{plain[error]:error}"}, [{"plain": {"error": 1e-3}}, {"plain": None}])
    assert table.rows == (("0.0010",), (DASH,))
    numbers = json.loads(json_text({"a": float("inf"), "b": [float("nan"), 1.0], "c": {"d": 2}}))
    assert numbers == {"a": None, "b": [None, 1.0], "c": {"d": 2}}
    assert csv_text(["=1+1"], [["-2"], ["-x"]]).split() == ["'=1+1", "-2", "'-x"]  # not a spreadsheet formula


def rendered(items: list[Any], width: int) -> str:
    out = io.StringIO()
    console = Console(file=out, width=width, force_terminal=False, highlight=False)
    for item in items:
        console.print(item, crop=False) if not isinstance(item, str) else console.print(item, markup=False)
    return out.getvalue()


def test_table_in_narrow_terminal_wraps_headings_first_and_numbers_never() -> None:
    table = terminal(
        Table("A title", ("what", "a long heading", "another one"), (("[words] of text", "-1.2345 m/s", "3.4e-12"),))
    )

    def lines(width: int) -> list[str]:
        return [line.strip() for line in rendered([table], width).splitlines()[1:] if line.strip()]

    head, _, row = lines(60)
    assert head.split() == ["what", "a", "long", "heading", "another", "one"]
    assert re.fullmatch(r"\[words\] of text +-1.2345 m/s +3.4e-12", row)
    above, head, _, row = lines(39)
    assert (above.split(), head.split()) == (["a", "long", "another"], ["what", "heading", "one"])
    assert re.fullmatch(r"\[words\] of text +-1.2345 m/s +3.4e-12", row)
    assert "-1.2345 m/s  3.4e-12" in rendered([table], 20)  # wider than the terminal


def test_number_stays_on_line_of_its_unit() -> None:
    assert unbroken('1 %: 6 mm of 25 minutes, "15 oz"') == '1\u00a0%: 6\u00a0mm of 25 minutes, "15 oz"'
