"""The page of one browser tab: its parts over one session, and how a change updates them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from importlib.resources import files
from typing import Any

from nicegui import Client, app, background_tasks, events, ui

from cuefem.designer.first_screen import FirstScreen
from cuefem.designer.header import Header
from cuefem.designer.in_thread import run_in_thread
from cuefem.designer.knob_row import ControlsCard
from cuefem.designer.session import OLD_NUMBERS, Results, Session, Work
from cuefem.designer.state import FAILURES, Design, UndoHistory, one_line
from cuefem.designer.tabs import TabsCard
from cuefem.measurements.calibration import Calibration
from cuefem.show.glossary import definitions
from cuefem.show.templates import chart_script, page_style
from cuefem.solid.tip_cache import computing_message


async def is_open(client: Client, timeout: float = 60.0) -> bool:
    """Whether a tab's browser has connected; not if the tab was closed before its page loaded."""
    with suppress(TimeoutError):
        await client.connected(timeout=timeout)
    return client.has_socket_connection


class Page:
    """The content of a tab: header, controls, first screen and tabs, each of which shows the session."""

    def __init__(self, first: Design, calibration: Calibration | None = None) -> None:
        self.session = Session(first, calibration)
        self.run = 0  # of the computation in work: an older one stops
        self.client = ui.context.client
        ui.add_css(page_style() + files("cuefem.designer").joinpath("page.css").read_text(encoding="utf-8"))
        ui.add_body_html(f"{definitions()}<script>{chart_script()}</script>")
        self.header = Header(self)
        self.banner = ui.label().classes("banner").props("role=alert")
        self.banner.set_visibility(False)
        with ui.element("div").classes("main").props('data-busy="true"') as self.main:
            with ui.element("aside").classes("card knobs").props("aria-label=Controls"):
                self.controls = ControlsCard(self)
            with ui.element("section").classes("screen card").props("aria-label=Result") as card:
                self.screen = FirstScreen(self, card, self.header.upload)
            with ui.element("section").classes("card tabs").props("aria-label=Details"):
                self.tabs = TabsCard(self)
        ui.keyboard(self._key, ignore=["input", "select", "textarea"])
        self.show()
        ui.timer(0.01, self._begin, once=True)

    def show(self) -> None:
        """Show the designs at once."""
        for part in (self.header, self.controls, self.screen, self.tabs):
            part.show()

    def show_message(self, words: str) -> None:
        """Show a message above the page, or none."""
        self.banner.set_text(words)
        self.banner.set_visibility(bool(words))

    def set_busy(self, busy: bool) -> None:
        """Mark the page as computing, or as idle."""
        self.main.props(f'data-busy="{str(busy).lower()}"')

    def refresh(self) -> None:
        """Show the session after a change, and compute its results."""
        self.show()
        self.compute()

    def attempt(self, change: Callable[..., Any], *arguments: Any) -> None:
        """Change the session and show it, or the error."""
        try:
            change(*arguments)
        except FAILURES as error:
            self.show_message(one_line(error))
            return
        self.show_message("")
        self.refresh()

    def _key(self, event: events.KeyEventArguments) -> None:
        key = str(event.key).lower()
        if event.action.keydown and (event.modifiers.ctrl or event.modifiers.meta) and key in ("z", "y"):
            self.header.undo_redo(1 if key == "y" or event.modifiers.shift else -1)

    # --- results -----------------------------------------------------------------------------------

    async def _begin(self) -> None:
        """Restore the state of this tab before a reload, and compute."""
        if not await is_open(self.client):
            return
        saved = app.storage.tab.get("history")
        if isinstance(saved, UndoHistory):
            self.session.history = saved
            self.show()
        app.storage.tab["history"] = self.session.history
        self.compute()

    def compute(self) -> None:
        """Compute what the open tab shows."""
        self.run += 1
        self.set_busy(True)
        self.screen.set_stale()
        self.tabs.begin()
        background_tasks.create(self._compute(self.run), name="computation")

    async def _compute(self, run: int) -> None:
        """Compute the displayed results, the first numbers first; stop when a later computation begins."""
        results, failures = Results(), list[str]()
        with self.client:
            if self.session.waits_for_tip():
                self.show_message(computing_message())
            for stage in self.session.plan(self.tabs.open, results):
                for work in stage:
                    failures += await self._do(work)
                    if run != self.run:
                        return
                if "solved_strike" in results.own:
                    self.session.take(results)
                    self.screen.show_results()
                    self.tabs.show_results()
                else:
                    failures = [f"{failures[0]}. {OLD_NUMBERS}"]
            self.show_message("; ".join(dict.fromkeys(failures)))
            self.tabs.end()
            self.set_busy(False)

    @staticmethod
    async def _do(work: Work) -> list[str]:
        """Compute and store a result; return the error message, if any."""
        try:
            work.store(await run_in_thread(work.call))
        except FAILURES as error:
            return [one_line(error)]
        return []
