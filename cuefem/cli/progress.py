"""Progress on stderr: bars if it is a terminal, lines of long runs if not."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from time import monotonic
from typing import Any

import click
from rich.console import Console
from rich.progress import MofNCompleteColumn, Progress, track


def with_progress_bar(work: Sequence[Any]) -> Iterable[Any]:
    """Iterate with a progress bar if stderr is a terminal."""
    console = Console(stderr=True)
    return track(work, "computing", console=console, transient=True, disable=not console.is_terminal)


def progress_bar() -> Progress:
    """A progress bar with count and remaining time, hidden if stderr is no terminal."""
    console = Console(stderr=True)
    columns = (*Progress.get_default_columns(), MofNCompleteColumn())
    return Progress(*columns, console=console, transient=True, disable=not console.is_terminal)


LINE_SHARE, FIRST_LINE = 0.1, 60.0  # a line for each share of the work, of a run longer than these seconds


class ProgressLines:
    """Lines such as "cuefem: 30 % of 4096 designs after 125 s", if stderr is no terminal."""

    def __init__(self, total: int) -> None:
        self.total, self.count, self.begun = total, 0, monotonic()
        self.is_hidden = Console(stderr=True).is_terminal

    def add(self, count: int) -> None:
        """Count designs; print a line where they reach the next share."""
        before, self.count = self.count, self.count + count
        seconds = monotonic() - self.begun
        first, last = (int(n / (LINE_SHARE * self.total)) for n in (before, self.count))
        if first < last and not self.is_hidden and seconds >= FIRST_LINE:
            click.echo(
                f"cuefem: {100 * LINE_SHARE * last:.0f} % of {self.total} designs after {seconds:.0f} s", err=True
            )
