"""Warnings of a command, kept until it has ended: one that fails prints its error alone."""

from __future__ import annotations

import click

PENDING = "cuefem.cli.pending_warnings"  # key of the lines in a context's meta


def warn(line: str) -> None:
    """Print a warning on stderr when the command has ended, so that an error is a single line."""
    click.get_current_context().meta.setdefault(PENDING, []).append(f"warning: {line}")


def print_pending_warnings() -> None:
    """Print the warnings on stderr, in order: at the end of a command, or before one that takes long."""
    for line in click.get_current_context().meta.pop(PENDING, []):
        click.echo(line, err=True)
