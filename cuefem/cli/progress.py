"""Progress bars on stderr, if it is a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

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
