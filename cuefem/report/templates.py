"""The templates: single pieces of the report's page for other pages, and the page of commands that have no other."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from html import escape
from itertools import groupby
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from cuefem.report.charts import Chart
from cuefem.report.drawings import CueDrawing
from cuefem.results.records import Sheet


@cache
def environment() -> Environment:
    """The templates beside this file; what they insert is text, never markup."""
    return Environment(
        loader=PackageLoader("cuefem", "report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def page_style() -> str:
    """The style sheet of pages, with that of the first screen."""
    return "".join(environment().get_template(name).render() for name in ("page.css", "first_screen.css"))


def chart_script() -> str:
    """The script that reads values off charts."""
    return environment().get_template("charts.js").render()


def chart_markup(drawing: Chart, name: str) -> str:
    """A chart as a figure; name: its own on the page."""
    return str(_macros().chart(drawing, name))


def sheet_markup(sheet: Sheet) -> str:
    """A table under its title, with its notes."""
    return f"<h2>{escape(sheet.title)}</h2>{_macros().table(sheet)}"


def plain_page(name: str, things: Sequence[str | Sheet | Chart | CueDrawing]) -> str:
    """Lines, tables, charts and drawings as a page that needs no network."""
    groups = [[*group] for _, group in groupby(filter(None, things), type)]
    return environment().get_template("plain.html.j2").render(name=name, groups=groups)


@cache
def _macros() -> Any:
    return environment().get_template("drawings.html.j2").module
