"""The Jinja templates: parts of the report page for other pages, and the plain page of a command's tables."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache
from html import escape
from itertools import groupby
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from cuefem.results.quantities import unbroken
from cuefem.results.records import Table
from cuefem.show.charts import Chart
from cuefem.show.drawings import CueDrawing

OPTIONS = re.compile(r"(\s*\([^()]*--[^()]*\)|\S*--\S+)")  # in parentheses, or alone


@cache
def environment() -> Environment:
    """The templates in this folder; inserted text is escaped."""
    made = Environment(
        loader=PackageLoader("cuefem", "show"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=lambda value: unbroken(value) if type(value) is str else value,
    )
    made.filters["code"] = code_markup
    made.filters["css_string"] = css_string
    made.filters["options"] = option_pieces
    return made


def code_markup(text: str) -> Markup:
    """A text with `code` between backticks as HTML."""
    return Markup(re.sub(r"`([^`]*)`", r"<code>\1</code>", escape(unbroken(text), quote=False)))


def option_pieces(text: str) -> list[tuple[str, bool]]:
    """A line in pieces, each with whether it names options of a command, which are of no use on paper."""
    return [(piece, i % 2 == 1) for i, piece in enumerate(OPTIONS.split(text)) if piece]


def css_string(text: str) -> Markup:
    """A text as a string of a style sheet."""
    return Markup('"' + "".join(c if c.isalnum() else f"\\{ord(c):06x}" for c in text) + '"')


def page_style() -> str:
    """The style sheet of pages, including the first screen."""
    return "".join(environment().get_template(name).render() for name in ("page.css", "first_screen.css"))


def chart_script() -> str:
    """The script that shows a chart's values at the pointer."""
    return environment().get_template("charts.js").render()


def chart_markup(drawing: Chart, name: str) -> str:
    """A chart as a figure. name: its id on the page."""
    return str(_macros().chart(drawing, name))


def shading_markup(drawing: Chart, of: str = "") -> str:
    """The legend of a chart's shaded spans."""
    return str(_macros().shading(drawing, of))


def table_markup(sheet: Table) -> str:
    """A table below its title, with its notes."""
    return f"<h2>{escape(sheet.title)}</h2>{_macros().table(sheet)}"


def answer_markup(key: str, answer: Any) -> str:
    """Charts, tables and description of an analysis. key: the first part of the charts' ids on the page."""
    return str(_macros().answer(key, answer.charts(), answer.tables(), answer.about, answer.more_charts()))


def plain_page(
    name: str, things: Sequence[str | Table | Chart | CueDrawing], made: str = "", warnings: Sequence[str] = ()
) -> str:
    """Lines, tables, charts and drawings as a self-contained page. made: the date at its end."""
    groups = [[*group] for _, group in groupby(filter(None, things), type)]
    return environment().get_template("plain.html.j2").render(name=name, groups=groups, made=made, warnings=warnings)


@cache
def _macros() -> Any:
    return environment().get_template("drawings.html.j2").module
