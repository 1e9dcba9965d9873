"""The header of the page: the design's name, files, history, and the hidden field that takes a file."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any

from nicegui import Client, events, ui

from cuefem.designer.host import Host
from cuefem.designer.in_thread import run_in_thread
from cuefem.designer.measured_form import MeasuredForm
from cuefem.designer.state import FAILURES, MAX_NAME, one_line, read_file
from cuefem.files.cue_names import CUES
from cuefem.files.lathe_profile import DRAWING_EXTENSIONS
from cuefem.quantity.display_units import display, displayed_system

MAX_FILE = 5_000_000  # bytes
UNITS_KEPT = "cuefem.units"  # of the browser's storage
# By the system displayed: words and icon of the button that displays the other one, and its name.
OTHER_UNITS = {"metric": ("Inches", "square_foot", "us"), "us": ("Metric", "square_foot", "metric")}


class Upload:
    """The field that takes a file, unseen: buttons open it, and say what its design is for."""

    def __init__(self, page: Host) -> None:
        self.page = page
        self.take: Callable[[Any], None] = page.session.open_file
        held = weakref.proxy(self)  # the server caches the route of an upload, also after the page is closed
        self.field = ui.upload(
            auto_upload=True,
            max_file_size=MAX_FILE,
            on_upload=lambda event: held.take_file(event),
            on_rejected=lambda: held.page.show_message(f"not opened: at most {MAX_FILE // 10**6} MB"),
        ).props(f'accept="{",".join(DRAWING_EXTENSIONS)}"')
        self.field.classes("unseen")

    def pick(self, take: Callable[[Any], None]) -> None:
        """Let the user pick a file, and take its design or calibration."""
        self.take = take
        self.field.run_method("pickFiles")

    async def take_file(self, event: events.UploadEventArguments) -> None:
        """Read an uploaded file."""
        content, name = await event.file.read(), file_name(event.file.name)
        self.field.reset()
        take, self.take = self.take, self.page.session.open_file
        try:
            if len(content) > MAX_FILE:
                raise ValueError(f"a file must be of at most {MAX_FILE // 10**6} MB")
            read = await run_in_thread(read_file, name, content)
        except FAILURES as error:
            self.page.show_message(one_line(error))
            return
        self.page.attempt(take, read)


class Header:
    """The name of the design, and the buttons for files and history."""

    def __init__(self, page: Host) -> None:
        self.page, self.session = page, page.session
        with ui.element("header").classes("head"):
            ui.html("<h1>cuefem designer</h1>", sanitize=False).classes("brand")
            self.name = ui.input(on_change=self._on_rename).props(
                f'borderless dense debounce=400 maxlength={MAX_NAME} aria-label="Name of the design"'
            )
            self.changed = ui.label().classes("soft setup")
            with ui.element("div").classes("tools").props('role=toolbar aria-label="File and history"'):
                _tool("Open", "folder_open", lambda: self.upload.pick(self.session.open_file))
                with _tool("Reference cues", "list", lambda: None), ui.menu().props('aria-label="Reference cues"'):
                    for name in CUES:
                        ui.menu_item(name, lambda name=name: page.attempt(self.session.open_reference, name))
                _tool("Save", "save_alt", self._save)
                self.report = _tool("Report", "description", self._report)
                _tool("I measured", "straighten", lambda: self.measured.open())
                self.undo = _tool("Undo", "undo", lambda: self.undo_redo(-1))
                self.redo = _tool("Redo", "redo", lambda: self.undo_redo(1))
                _tool(*OTHER_UNITS[displayed_system()][:2], self._switch_units)
                ui.link("Guide", "/guide", new_tab=True).classes("guide")
            self.upload = Upload(page)
            self.measured = MeasuredForm(page)

    def show(self) -> None:
        """Show the design's name, and which steps can be undone and redone."""
        history, design = self.session.history, self.session.step.design
        self.name.set_value(design.name)
        self.changed.set_text("changed since opened" if design.scene != history.opened.scene else "")
        self.undo.set_enabled(history.at > 0)
        self.redo.set_enabled(history.at < len(history.steps) - 1)

    def undo_redo(self, steps: int) -> None:
        """Undo (-1) or redo (1)."""
        if self.session.undo_redo(steps):
            self.page.refresh()

    @staticmethod
    def _switch_units() -> None:
        """Display the other units on every open page, and keep them in this browser."""
        *_, system = OTHER_UNITS[displayed_system()]
        display(system)
        ui.run_javascript(f"localStorage.setItem('{UNITS_KEPT}', '{system}')")
        for client in [*Client.instances.values()]:
            if client.has_socket_connection:
                client.run_javascript("location.reload()")

    def _on_rename(self, event: Any) -> None:
        if self.session.rename(str(event.value or "")):
            self.page.refresh()

    def _save(self) -> None:
        ui.download.content(self.session.file(), self.session.file_name("toml"))

    async def _report(self) -> None:
        """Write the report of the design, compared with the other one."""
        name, call = self.session.file_name("html"), self.session.report_call()
        self.report.disable()
        try:
            ui.download.content(await run_in_thread(call), name)
        except FAILURES as error:
            self.page.show_message(one_line(error))
        finally:
            self.report.enable()


def file_name(text: Any) -> str:
    """The name of an uploaded file without folders; ValueError for an invalid file name."""
    name = PurePosixPath(str(text or "").replace("\\", "/")).name
    if name.strip() in ("", ".", "..") or not name.isprintable() or len(name.encode(errors="replace")) > 255:
        raise ValueError(f"a file must have a name of at most 255 bytes; got {name[:20]!r}")
    return name


def _tool(words: str, icon: str, action: Callable[[], Any]) -> Any:
    return ui.button(words, icon=icon, on_click=action).props("flat dense no-caps")
