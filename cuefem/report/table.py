"""The renderers of records and sheets, one a medium: terminal, JSON and CSV; that of pages is drawings.html.j2."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any

from rich import box
from rich.console import Console, ConsoleOptions, Group
from rich.measure import Measurement
from rich.padding import Padding
from rich.table import Column, Table
from rich.text import Text

from cuefem.results.records import Sheet, plain

# Spaces between columns: in a wide terminal, with one more at either edge; and in a narrow one, without edges.
ROOMY, TIGHT = 3, 2


class WholeTable(Table):
    """A table whose cells are never cut: texts to the left, which wrap at spaces; numbers to the right, which do not.

    Headings wrap first, then texts, the longest most. A table that is too wide even so stands at its natural width and
    leaves it to the terminal to wrap its lines (print it with ``crop=False``).
    """

    def __init__(self, title: str, columns: Sequence[str], *, texts: Collection[int] = (0,)) -> None:
        super().__init__(title=title, box=box.SIMPLE_HEAD, title_justify="left", title_style="bold")
        for i, column in enumerate(columns):
            self.add_column(Text(column), justify="left" if i in texts else "right")
        self.texts = texts

    def add_row(self, *cells: str, **options: Any) -> None:  # type: ignore[override]
        """A row of plain strings; brackets in them are not taken for markup."""
        texts = (Text(cell, no_wrap=i not in self.texts) for i, cell in enumerate(cells))
        super().add_row(*texts, **options)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Any]:
        ranges = [self._range(column, console, options) for column in self.columns]
        natural = [most for _, most in ranges]
        gaps = len(ranges) - 1
        spare = options.max_width - TIGHT * gaps
        roomy = sum(natural) + ROOMY * gaps + 4 <= options.max_width
        fits = roomy or sum(least for least, _ in ranges) <= spare
        numbers = [i for i in range(len(ranges)) if i not in self.texts]
        widths = natural if roomy or not fits else shared(ranges, spare, first=numbers)
        for column, width in zip(self.columns, widths, strict=True):
            column.width = width
        self.show_edge = self.pad_edge = roomy or not fits
        self.padding = (0, 1) if self.show_edge else (0, 1, 0, 0)
        whole = sum(widths) + ROOMY * gaps + 4
        yield from super().__rich_console__(console, options.update(width=max(options.max_width, whole)))
        if not self.show_edge:
            yield Text()

    def _range(self, column: Column, console: Console, options: ConsoleOptions) -> tuple[int, int]:
        """The least and the natural width of a column."""
        free = options.update(width=10_000)
        heading, *cells = (Measurement.get(console, free, cell) for cell in (column.header, *column.cells))
        wraps = self.columns.index(column) in self.texts
        least = max([heading.minimum, *(cell.minimum if wraps else cell.maximum for cell in cells)])
        return least, max([heading.maximum, *(cell.maximum for cell in cells)])


def shared(ranges: Sequence[tuple[int, int]], spare: int, *, first: Sequence[int]) -> list[int]:
    """The width of each column, so that together they fill ``spare`` characters.

    The widest columns are made narrower first, those of ``first`` before the others. ranges: the smallest and the
    natural width of each column; the smallest widths fit together.
    """
    widths = [most for _, most in ranges]
    for group in (first, range(len(ranges))):
        while sum(widths) > spare and (wide := [i for i in group if widths[i] > ranges[i][0]]):
            widths[max(wide, key=widths.__getitem__)] -= 1
    return widths


def terminal(sheet: Sheet) -> Group:
    """A sheet for the terminal: text to the left, numbers to the right, no cell cut; its notes below it."""
    table = WholeTable(sheet.title, sheet.head, texts=sheet.texts)
    for i, row in enumerate(sheet.rows):
        table.add_row(*row, style=(sheet.styles or {}).get(i, ""))
    if not sheet.notes:
        return Group(table)
    return Group(table, *(Padding(Text(note, style="dim"), (0, 0, 0, 2), expand=False) for note in sheet.notes), "")


def json_text(record: Any) -> str:
    """A record for programs."""
    return json.dumps(plain(record), indent=2, allow_nan=False, ensure_ascii=False)


def csv_text(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Head and rows for a spreadsheet, none of whose cells it takes for a formula."""
    file = io.StringIO()
    writer = csv.writer(file)
    writer.writerows([_no_formula(cell) for cell in cells] for cells in (head, *rows))
    return file.getvalue()


def _no_formula(cell: str) -> str:
    return f"'{cell}" if re.match(r"[=@\t\r]|[-+](?![0-9])", cell) else cell
