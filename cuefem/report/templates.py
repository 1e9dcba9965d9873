"""Single pieces of the report's page, as markup, for other pages that show the same drawings in the same style."""

from __future__ import annotations

from functools import cache
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from cuefem.report.charts import Chart
from cuefem.report.drawings import CueDrawing, ModesDrawing


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
    """The page's style sheet."""
    return environment().get_template("page.css").render()


def chart_script() -> str:
    """The script that reads values off charts."""
    return environment().get_template("charts.js").render()


def chart_markup(drawing: Chart, name: str) -> str:
    """A chart as a figure; name: its own on the page."""
    return str(_macros().chart(drawing, name))


def cue_markup(drawing: CueDrawing) -> str:
    """A drawing of the cue as a figure."""
    return str(_macros().drawing(drawing))


def verdict_markup(part: dict[str, Any]) -> str:
    """A verdict, as `cuefem.report.verdict_table.verdict_part` tells it."""
    return str(_macros().verdict_section(part))


def shapes_markup(drawing: ModesDrawing) -> str:
    """Mode shapes as a drawing."""
    return str(_macros().shapes(drawing))


@cache
def _macros() -> Any:
    return environment().get_template("drawings.html.j2").module
