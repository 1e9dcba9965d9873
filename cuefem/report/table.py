"""Tables that show every cell whole in a terminal of any width."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from rich import box
from rich.console import Console, ConsoleOptions, Group
from rich.measure import Measurement
from rich.padding import Padding
from rich.table import Column, Table
from rich.text import Text

# Spaces between columns: in a wide terminal, with one more at either edge; and in a narrow one, without edges.
ROOMY, TIGHT = 3, 2


class WholeTable(Table):
    """A table whose cells are never cut: texts to the left, which wrap at spaces; numbers to the right, which do not.

    Headings wrap first, then texts, the longest most. A table that is too wide even so stands at its natural width and
    leaves it to the terminal to wrap its lines (print it with ``crop=False``).
    """

    def __init__(self, title: str, columns: Sequence[str], *, text_columns: int = 1) -> None:
        super().__init__(title=title, box=box.SIMPLE_HEAD, title_justify="left", title_style="bold")
        for i, column in enumerate(columns):
            self.add_column(Text(column), justify="left" if i < text_columns else "right")
        self.text_columns = text_columns

    def add_row(self, *cells: str, **options: Any) -> None:  # type: ignore[override]
        """A row of plain strings; brackets in them are not taken for markup."""
        found = (Text(cell, no_wrap=i >= self.text_columns) for i, cell in enumerate(cells))
        super().add_row(*found, **options)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Any]:
        ranges = [self._range(column, console, options) for column in self.columns]
        natural = [most for _, most in ranges]
        gaps = len(ranges) - 1
        spare = options.max_width - TIGHT * gaps
        roomy = sum(natural) + ROOMY * gaps + 4 <= options.max_width
        fits = roomy or sum(least for least, _ in ranges) <= spare
        numbers = range(self.text_columns, len(ranges))
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
        wraps = self.columns.index(column) < self.text_columns
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


def table_of(title: str, columns: Sequence[str], *, text_columns: int = 1) -> Table:
    """An empty table: text to the left, numbers to the right; no cell is ever cut."""
    return WholeTable(title, columns, text_columns=text_columns)


def with_caption(table: Table, *lines: str) -> Group:
    """The table, then caption lines that state its assumptions."""
    return Group(table, *(Padding(Text(line, style="dim"), (0, 0, 0, 2), expand=False) for line in lines), "")
