"""Records (SI numbers by the names of their quantities), and the tables that display them.

Programs read records. A table declares the column of each number; heading, unit and digits
of a column are those of its quantity. A terminal, a page and a CSV file show the same table
(`cuefem.show.renderers`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from string import Formatter
from typing import Any

import numpy as np

from cuefem.quantity.display_units import METRIC, with_unit
from cuefem.results.quantities import DASH, RESULTS, format_value

Record = dict[str, Any]
# The content of a column of a row: the quantity of that name, a template such as "{swing:m}", or a text of the row.
ColumnEntry = str | Callable[[Mapping[str, Any]], str]


class ScaleCell(str):
    """A cell with a place on a scale: a page draws it, a terminal prints the text.

    at, low, high: the dot and the ends of the span around it, % of the scale.
    """

    at: float
    low: float
    high: float

    @classmethod
    def of(cls, text: str, at: float, low: float, high: float) -> ScaleCell:
        """The cell of a text and its numbers."""
        cell = cls(text)
        cell.at, cell.low, cell.high = at, low, high
        return cell


@dataclass(frozen=True)
class Table:
    """A table: its title, the head of its columns, rows of texts, and lines that state its assumptions.

    texts: indices of the columns with text; the others have numbers. styles: of highlighted rows, "bold" or
    "dim", by the row's number. more: indices of the columns that a narrow page shows on demand.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()
    texts: tuple[int, ...] = (0,)
    styles: Mapping[int, str] | None = None
    more: tuple[int, ...] = ()


def tabulate(
    title: str,
    columns: Mapping[str, ColumnEntry],
    rows: Iterable[Mapping[str, Any]],
    *notes: str,
    texts: tuple[int, ...] = (0,),
) -> Table:
    """A table with one row per record. columns: the template of each column."""
    cells = tuple(tuple(_cell(entry, row) for entry in columns.values()) for row in rows)
    return Table(title, tuple(columns), cells, notes, texts)


def _cell(entry: ColumnEntry, row: Mapping[str, Any]) -> str:
    if callable(entry):
        return entry(row)
    return _TEMPLATES.vformat(entry, (), row) if "{" in entry else format_value(entry, row[entry])


class _Templates(Formatter):
    """Templates with a format after the colon of each number; a missing number becomes a dash.

    {mass:end_mass}: as that quantity; {swing:m}: in the display unit of an SI unit; {share:.1 %}: in per
    cent; otherwise as in Python.
    """

    def get_field(self, name: str, args: Any, kwargs: Any) -> tuple[Any, str]:
        """The value of a row's entry, also of an entry of an entry that is missing."""
        first, _, inner = name.rstrip("]").partition("[")
        value = kwargs[first]
        return (value[inner] if inner and value is not None else value), first

    def format_field(self, value: Any, spec: str) -> str:
        """The value in the template's format."""
        if value is None:
            return DASH
        if spec in RESULTS:
            return format_value(spec, value)
        if spec in METRIC:
            return with_unit(value, spec)
        if spec.endswith(" %"):
            return f"{100 * value:{spec[:-2]}f} %"
        return format(value, spec)


_TEMPLATES = _Templates()


def json_value(value: Any) -> Any:
    """A value for JSON: dataclasses become dicts, arrays lists, infinite and undefined numbers null."""
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: json_value(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, dict):
        return {str(key): json_value(inner) for key, inner in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return json_value(value.tolist())
    if isinstance(value, list | tuple):
        return [json_value(inner) for inner in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
