"""The page of a command that has no other: the lines and tables that it prints, and figures."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from cuefem.report.charts import Chart
from cuefem.report.drawings import CueDrawing
from cuefem.report.templates import environment
from cuefem.results.records import Sheet


def plain_page(name: str, things: Sequence[str | Sheet | Chart | CueDrawing]) -> str:
    """Lines, tables, charts and drawings as a page that needs no network."""
    groups = [[*group] for _, group in groupby(filter(None, things), type)]
    return environment().get_template("plain.html.j2").render(name=name, groups=groups)
