"""Single pieces of the report's page, as markup, for other pages that show the same drawings in the same style."""

from __future__ import annotations

from functools import cache
from html import escape
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from cuefem.report.charts import Chart
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


@cache
def _macros() -> Any:
    return environment().get_template("drawings.html.j2").module
