"""Renderers of records and tables: terminal, JSON and CSV. drawings.html.j2 renders tables on pages."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from rich import box
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, Group
from rich.measure import Measurement
from rich.padding import Padding
from rich.table import Table as RichTable
from rich.text import Text

from cuefem.quantity.display import visible
from cuefem.results.records import Table, json_value

UNLIMITED = 10_000  # characters: wider than any table


class UncroppedTable(RichTable):
    """A table that never crops a cell: texts are left-aligned and wrap at spaces, numbers are right-aligned.

    In a narrow terminal the headings of numbers wrap first, then the texts, the longest most. If the table is still too
    wide, the terminal wraps its lines (print it with ``crop=False``).
    """

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Any]:
        if Measurement.get(console, options.update(width=UNLIMITED), self).maximum > options.max_width:
            self.show_edge = self.pad_edge = False
            self.padding = (0, 1, 0, 0)
            for column in self.columns:
                if column.justify == "right":
                    column.width = column.min_width
        least = sum((column.min_width or 0) + 2 for column in self.columns)
        yield from super().__rich_console__(console, options.update(width=max(options.max_width, least)))
        if not self.show_edge:
            yield Text()


def terminal(sheet: Table) -> Group:
    """A table for the terminal, its notes below it; no cell is cropped."""
    table = UncroppedTable(title=visible(sheet.title), box=box.SIMPLE_HEAD, title_justify="left", title_style="bold")
    for i, head in enumerate(sheet.head):
        text = i in sheet.texts
        pieces = [*head.split(), *(piece for row in sheet.rows for piece in (row[i].split() if text else [row[i]]))]
        least = max(map(cell_len, pieces), default=0)
        table.add_column(Text(visible(head)), justify="left" if text else "right", min_width=least)
    for i, row in enumerate(sheet.rows):
        table.add_row(*(Text(visible(cell)) for cell in row), style=(sheet.styles or {}).get(i, ""))
    notes = (Padding(Text(visible(note), style="dim"), (0, 0, 0, 2), expand=False) for note in sheet.notes)
    return Group(table, *notes, *([""] if sheet.notes else []))


def print_tables(things: Sequence[Any], console: Console | None = None) -> None:
    """Print text and tables."""
    console = console or Console(highlight=False, emoji=False)
    if not console.is_terminal:
        console.width = 120  # files and pipes have no width: do not cut tables
    for thing in things:
        if isinstance(thing, str):
            console.print(visible(thing), markup=False)
        else:
            console.print(terminal(thing), crop=False)


def plain_text(things: Sequence[Any]) -> str:
    """Text and tables as a terminal shows them."""
    file = io.StringIO()
    print_tables(things, Console(file=file, highlight=False, emoji=False))
    return file.getvalue()


def json_text(record: Any, *, escaped: bool = False) -> str:
    """A record as JSON. escaped: whether in ASCII, other characters as escape sequences."""
    return json.dumps(json_value(record), indent=2, allow_nan=False, ensure_ascii=escaped)


def csv_text(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Head and rows as CSV; a quote is put before a cell that a spreadsheet would read as a formula."""
    file = io.StringIO()
    writer = csv.writer(file)
    writer.writerows([_no_formula(cell) for cell in cells] for cells in (head, *rows))
    return file.getvalue()


def _no_formula(cell: str) -> str:
    return f"'{cell}" if re.match(r"[=@\t\r]|[-+](?![0-9])", cell) else cell
