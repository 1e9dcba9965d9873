"""The scene as text: the file that Save writes, with every key, also those without a control."""

from __future__ import annotations

import json
from collections.abc import Callable

from nicegui import ui

from cuefem.designer.state import FAILURES, Design, one_line, read_design
from cuefem.files.toml_writer import toml_text

NAME = "design.toml"


class FileEditor:
    """The text with its buttons. applied: called with the design read from it."""

    def __init__(self, applied: Callable[[Design], None]) -> None:
        self.applied = applied
        self.saved = ""
        with ui.element("div").classes("line"):
            self.title = ui.label().classes("h2")
            ui.label("the file that Save writes; joint, bridge, layers and custom materials are here").classes("soft")
            self.apply = ui.button("Apply", on_click=self._apply).props("outline dense no-caps")
            self.revert = ui.button("Revert", on_click=lambda: self.show(self.design)).props("outline dense no-caps")
        self.error = ui.label().classes("error").props("role=alert")
        self.editor = ui.codemirror(line_wrapping=True, on_change=self._changed)

    def show(self, design: Design) -> None:
        """Show a design's file."""
        self.design, self.saved = design, toml_text(design.scene)
        self.title.set_text(f"{design.name}.toml")
        self.editor.set_value(self.saved)
        self._show_error("")
        self._changed()

    def set_accessible_name(self) -> None:
        """Set the editor's accessible name once the browser has loaded it."""
        name = json.dumps("Scene as text")
        ui.run_javascript(
            f"document.querySelectorAll('.cm-content').forEach(e => e.setAttribute('aria-label', {name}))"
        )

    def _changed(self, *_: object) -> None:
        for button in (self.apply, self.revert):
            button.set_enabled(self.editor.value != self.saved)

    def _apply(self) -> None:
        try:
            made = read_design(NAME, str(self.editor.value).encode())
            self._show_error("")
            self.applied(made)
        except FAILURES as error:
            self._show_error(one_line(error).replace(NAME, self.title.text))

    def _show_error(self, words: str) -> None:
        self.error.set_text(words)
        self.error.set_visibility(bool(words))
