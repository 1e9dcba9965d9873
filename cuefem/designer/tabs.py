"""The tabs below the result, each shown from the session when it is open."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from html import escape
from typing import Any

from nicegui import ui

from cuefem.designer import computation, panels
from cuefem.designer.file_editor import FileEditor
from cuefem.designer.host import Host
from cuefem.designer.in_thread import run_in_thread
from cuefem.designer.session import Session
from cuefem.designer.state import FAILURES, Design, one_line
from cuefem.quantity.display_units import displayed_in
from cuefem.results.quantities import unbroken
from cuefem.results.verdict import verdict_problem
from cuefem.show.renderers import csv_text

TABS = ("Curves", "Changes", "Numbers", "Report", "Check", "File")


class TabsCard:
    """The tabs."""

    def __init__(self, page: Host) -> None:
        self.page, self.session = page, page.session
        self.open = TABS[0]
        self.counting = ui.timer(0.3, self._show_count, active=False)
        with ui.tabs().props("no-caps align=left") as tabs:
            for name in TABS:
                ui.tab(name)
        with ui.tab_panels(tabs, value=TABS[0], animated=False):
            with ui.tab_panel("Curves"):
                self.curves = ui.html(sanitize=False).classes("num")
            with ui.tab_panel("Changes"):
                self.count = ui.label().classes("soft").props("role=status")
                self.changes()
            with ui.tab_panel("Numbers"):
                ui.button("Save as .csv", on_click=self._table).props("outline dense no-caps").classes("right")
                self.numbers = ui.html(sanitize=False).classes("num")
            with ui.tab_panel("Report"):
                self.sections = ui.html(sanitize=False).classes("num")
            with ui.tab_panel("Check"):
                self.check_button = ui.button("Check against a solid model", on_click=self._check)
                self.check_button.props("outline dense no-caps").classes("right")
                self.check = ui.html(sanitize=False).classes("num")
            with ui.tab_panel("File") as self.file_panel:
                self.file: FileEditor | None = None  # made when it is opened: the browser loads its code then
        tabs.on_value_change(self._on_open)

    @ui.refreshable_method
    def changes(self) -> None:
        """The table of changes, each with Try."""
        changes_panel(self.session, lambda values: self.page.attempt(self.session.set_parameters, values))

    def show(self) -> None:
        """Show the file, if it is open."""
        if self.open == "File" and self.file is not None:
            self.file.show(self.session.step.design)

    def begin(self) -> None:
        """Show how many changes are computed, while they are."""
        self.counting.active = self.open == "Changes"

    def end(self) -> None:
        """Show no count any longer."""
        self.counting.active = False
        self.count.set_text("")

    def _show_count(self) -> None:
        if self.session.count is not None:
            done, of = self.session.count
            self.count.set_text(f"{done} of {of} changes computed")

    def show_results(self) -> None:
        """Show the results of the open tab."""
        if self.open == "Curves":
            self.curves.set_content(panels.curves_markup(self.session))
        elif self.open == "Changes":
            self.changes.refresh()
        elif self.open == "Numbers":
            self.numbers.set_content(panels.tables_markup([panels.tabulate_numbers(self.session)]))
        elif self.open == "Report":
            self.sections.set_content(panels.sections_markup(self.session))
        elif self.open == "Check":
            self.check.set_content(panels.tables_markup(panels.tabulate_check(self.session)))

    def _on_open(self, event: Any) -> None:
        self.open = str(event.value)
        if self.open != "File":
            self.page.compute()
            return
        if self.file is None:
            with self.file_panel:
                self.file = FileEditor(self._apply)
        self.file.show(self.session.step.design)
        self.file.set_accessible_name()

    def _apply(self, read: Design) -> None:
        self.page.attempt(self.session.apply, read)

    def _table(self) -> None:
        with displayed_in("metric"):  # as all files
            made = panels.tabulate_numbers(self.session)
        if made is not None:
            ui.download.content("\ufeff" + csv_text(made.head, made.rows), self.session.file_name("csv"))

    async def _check(self) -> None:
        """Compute the design as a solid."""
        scene = self.session.scene
        self.check_button.disable()
        self.page.set_busy(True)
        try:
            self.session.take_solid(scene, await run_in_thread(computation.solid, scene))
            self.show_results()
        except FAILURES as error:
            self.page.show_message(one_line(error))
        finally:
            self.check_button.enable()
            self.page.set_busy(False)


def changes_panel(session: Session, attempt: Callable[[Mapping[str, Any]], None]) -> None:
    """The design changes, each with a button that applies it."""
    record = session.results.own.get("changes")
    if record is None:
        solved = session.results.own.get("solved_strike")
        problem = solved and verdict_problem(session.scene, solved.outcome)
        ui.html(f'<p class="soft">{escape(problem)}</p>' if problem else panels.COMPUTING, sanitize=False)
        return
    made = record.table()
    ui.label(f"Changes to {session.step.design.name}, each alone").classes("h2")
    for line, row in zip(record.together_lines(), record.together, strict=True):
        with ui.row().classes("together"):
            ui.label(unbroken(line))
            button = ui.button("Try", on_click=lambda places=row.values: attempt(places))
            button.props(f'outline dense no-caps aria-label="Try {row.change}"')
    around = ui.element("div").classes("scroll").props('tabindex=0 role=region aria-label="Design changes"')
    with around, ui.element("table").classes("changes"):
        with ui.element("thead"), ui.element("tr"):
            for i, head in enumerate(made.head):
                _cell("th", head, text=i in made.texts)
            _cell("td", "")
        with ui.element("tbody"):
            for i, (cells, row) in enumerate(zip(made.rows, record.changes, strict=True)):
                with ui.element("tr").classes((made.styles or {}).get(i, "")):
                    for j, cell in enumerate(cells):
                        _cell("td", cell, text=j in made.texts)
                    with ui.element("td"):
                        button = ui.button("Try", on_click=lambda places=row.values: attempt(places))
                        button.props(f'outline dense no-caps aria-label="Try {row.change}"')
    for note in (*record.gaps(), *made.notes):
        ui.label(note).classes("soft")


def _cell(kind: str, content: str, *, text: bool = False) -> None:
    with ui.element(kind).classes("text" if text else "") as cell:
        ui.label(unbroken(content).replace(" →", "\u00a0→"))
    if kind == "th":
        cell.props("scope=col")
