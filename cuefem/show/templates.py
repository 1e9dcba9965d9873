"""The Jinja templates: parts of the report page for other pages, and the plain page of a command's tables."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
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

# Colours of curves where no style sheet holds: 3 to 1 at least on white and on black.
INKS = {"c1": "#2f86d0", "c2": "#c8691f", "c3": "#1f9a75", "c4": "#b064a5", "c5": "#7f8890"}
PLAIN_STYLES = ("answer.css", "page.css")  # style sheets of a page, in their order
SCREEN_STYLES = (*PLAIN_STYLES, "first_screen.css")
SHEET_STYLES = (*SCREEN_STYLES, "sheet.css")
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
    made.filters["ink"] = ink
    return made


def code_markup(text: str) -> Markup:
    """A text with `code` between backticks as HTML."""
    return Markup(re.sub(r"`([^`]*)`", r"<code>\1</code>", escape(unbroken(text), quote=False)))


def option_pieces(text: str) -> list[tuple[str, bool]]:
    """A line in pieces, each with whether it names options of a command, which are of no use on paper."""
    return [(piece, i % 2 == 1) for i, piece in enumerate(OPTIONS.split(text)) if piece]


def ink(style: str) -> Markup:
    """The colour of a curve as attributes, for viewers that remove style sheets; those of a page override them."""
    return Markup(f' fill="none" stroke="{INKS.get(style[:2], "currentColor")}"')


def css_string(text: str) -> Markup:
    """A text as a string of a style sheet."""
    return Markup('"' + "".join(c if c.isalnum() else f"\\{ord(c):06x}" for c in text) + '"')


def page_style() -> str:
    """The style sheet of pages, including the first screen."""
    return "".join(environment().get_template(name).render() for name in SCREEN_STYLES)


def chart_script() -> str:
    """The script that shows a chart's values at the pointer."""
    return environment().get_template("charts.js").render()


def chart_markup(drawing: Chart) -> str:
    """A chart as a figure."""
    return str(_macros().chart(drawing))


def shading_markup(drawing: Chart, of: str = "") -> str:
    """The legend of a chart's shaded spans."""
    return str(_macros().shading(drawing, of))


def table_markup(sheet: Table) -> str:
    """A table below its title, with its notes."""
    return f"<h2>{escape(sheet.title)}</h2>{_macros().table(sheet)}"


def section_markup(part: Mapping[str, Any]) -> str:
    """Charts, tables and description of a section of a page."""
    return str(_macros().answer(part["charts"], part["tables"], part["about"], part["more"]))


def plain_page(
    name: str,
    things: Sequence[str | Table | Chart | CueDrawing],
    made: str = "",
    warnings: Sequence[str] = (),
    *,
    notes: Sequence[str] = (),
    inline: bool = False,
) -> str:
    """Lines, tables, charts and drawings as a page, or as a part of one. made: the date at its end. notes: folded."""
    groups = [[*group] for _, group in groupby(filter(None, things), type)]
    parts = {"title": name, "name": name, "groups": groups, "made": made, "warnings": warnings, "notes": notes}
    return framed("plain.html.j2", **parts, styles=PLAIN_STYLES, kind="", inline=inline)


def framed(template: str, *, inline: bool, styles: Sequence[str] = SCREEN_STYLES, **parts: Any) -> str:
    """A template in the frame of a self-contained page, with its style sheets; inline: of an output in a notebook.

    That has neither title nor script nor ids, and a style of its own alone.
    """
    frame = "inline.html.j2" if inline else "frame.html.j2"
    return environment().get_template(template).render(frame=frame, inline=inline, styles=styles, **parts)


@cache
def _macros() -> Any:
    return environment().get_template("drawings.html.j2").module
