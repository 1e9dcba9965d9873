"""The page as its parts use it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from cuefem.designer.session import Session


class Host(Protocol):
    """The page of a browser tab, with its session."""

    session: Session

    def refresh(self) -> None:
        """Show the session after a change, and compute its results."""

    def attempt(self, change: Callable[..., Any], *arguments: Any) -> None:
        """Change the session and show it, or the error."""

    def compute(self) -> None:
        """Compute what the open tab shows."""

    def show_message(self, words: str) -> None:
        """Show a message above the page, or none."""

    def set_busy(self, busy: bool) -> None:
        """Mark the page as computing, or as idle."""
