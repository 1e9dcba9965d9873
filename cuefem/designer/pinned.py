"""The list of pinned designs: their names, and what can be done with each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from nicegui import ui

from cuefem.designer.controls import button
from cuefem.designer.design import Design
from cuefem.designer.kept import LONGEST_NAME
from cuefem.designer.markup import Markup


class PinnedList:
    """A row of buttons for every pinned design.

    Each function that is given is called with the row's place in the list, from 0; `rename` with the new name too.
    """

    def __init__(
        self,
        rename: Callable[[int, str], None],
        work_on: Callable[[int], None],
        compare_with: Callable[[int], None],
        unpin: Callable[[int], None],
        export: Callable[[], None],
    ) -> None:
        self.rename, self.work_on, self.compare_with, self.unpin = rename, work_on, compare_with, unpin
        self.rows = ui.element("div").classes("pins")
        with ui.element("div").classes("actions"):
            button("Save the table as .csv", export)
        self.shown: tuple[tuple[Design, ...], int] | None = None

    def show(self, pinned: Sequence[Design], reference: int) -> None:
        """Show these designs; differences are those from the one at ``reference``."""
        if self.shown == (tuple(pinned), reference):
            return
        self.shown = tuple(pinned), reference
        self.rows.clear()
        with self.rows:
            if not pinned:
                hint = "Pin designs to see them as columns here and as curves above."
                Markup(f'<p class="hint">{hint}</p>')
            for i, design in enumerate(pinned):
                self._row(i, design, reference)

    def _row(self, i: int, design: Design, reference: int) -> None:
        with ui.element("div").classes("pin").props(f'role="group" aria-label="pinned design {i + 1}"'):
            name = ui.input(value=design.name, on_change=lambda event: self.rename(i, event.value))
            name.props(f"dense outlined debounce=300 maxlength={LONGEST_NAME}")
            name.props(f'aria-label="name of pinned design {i + 1}"')
            if i == reference:
                Markup('<span class="hint">differences are from this one</span>')
            else:
                button("Differences from this", partial(self.compare_with, i))
            button("Work on it", partial(self.work_on, i))
            button("Take off", partial(self.unpin, i))
