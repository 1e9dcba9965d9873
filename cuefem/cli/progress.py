"""Progress bars on stderr, if it is a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    SpinnerColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
    track,
)
from rich.progress import Progress as Bar


def with_progress_bar(work: Sequence[Any]) -> Iterable[Any]:
    """Iterate with a progress bar if stderr is a terminal."""
    console = Console(stderr=True)
    return track(work, "computing", console=console, transient=True) if console.is_terminal else work


class Progress:
    """Number of finished designs, shown as a bar with rate and times after the first second."""

    def __init__(self, bar: Any, total: int) -> None:
        self.bar, self.total = bar, total
        self.task = bar.add_task("choosing modes", total=None, rate="") if bar else None

    def start(self, done: int) -> None:
        """Start the bar; some designs may be finished already."""
        if self.bar:
            self.bar.update(self.task, description="designs", total=self.total, completed=done)

    def update(self, done: int) -> None:
        """Set the number of finished designs."""
        if self.bar:
            speed = self.bar.tasks[0].speed
            self.bar.update(self.task, completed=done, rate=f"{speed:.3g} designs/s" if speed else "")

    def stop(self) -> None:
        """Remove the bar."""
        if self.bar:
            self.bar.stop()


@contextmanager
def progress_bar(total: int) -> Iterator[Progress]:
    """A progress bar, if stderr is a terminal."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield Progress(None, total)
        return
    texts = TextColumn("{task.description}"), TextColumn("{task.fields[rate]}")
    columns = (SpinnerColumn(), texts[0], BarColumn(), MofNCompleteColumn(), texts[1], TimeElapsedColumn())
    with Bar(*columns, TimeRemainingColumn(), console=console, transient=True) as shown:
        yield Progress(shown, total)
