"""What commands print: tables and lines for people, and JSON for programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click
from rich.console import Console

from cuefem.report.table import json_text, terminal

# The option of every command that has numbers for programs.
json_option = click.option("--json", "as_json", is_flag=True, help="SI numbers as JSON.")


def assumed_lines(notes: Sequence[str]) -> list[str]:
    """What was assumed, in a line; none where nothing was."""
    return [f"assumed: {'; '.join(notes)}"] if notes else []


def print_json(record: Any) -> None:
    """Print a record for programs."""
    click.echo(json_text(record))


def tell(as_json: bool, record: Any, things: Sequence[Any]) -> None:
    """Print a record for programs, or lines and sheets for people."""
    if as_json:
        print_json(record)
    else:
        print_all(things)


def print_all(things: Sequence[Any]) -> None:
    """Print lines and sheets for people."""
    console = Console(highlight=False, emoji=False)
    if not console.is_terminal:
        console.width = 120  # files and pipes have no width: do not cut tables
    for thing in things:
        console.print(thing, markup=False) if isinstance(thing, str) else console.print(terminal(thing), crop=False)
