"""The page of a command that has no other: the lines and sheets that it prints."""

from __future__ import annotations

from collections.abc import Sequence

from cuefem.report.templates import environment
from cuefem.results.records import Sheet


def plain_page(name: str, things: Sequence[str | Sheet]) -> str:
    """Lines and sheets as a page that needs no network."""
    lines = [thing for thing in things if thing]
    return environment().get_template("plain.html.j2").render(name=name, things=lines)
