"""What would change the design: a table that is computed when it is asked for, each of whose rows can be taken over."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from html import escape

from nicegui import ui

from cuefem.design.design_changes import design_changes
from cuefem.designer.computing import FAILURES, computed
from cuefem.designer.controls import Beside, button
from cuefem.designer.markup import Markup
from cuefem.designer.unit_system import UnitSystem
from cuefem.parameters.parameter import varied
from cuefem.report.advice_table import advice_sheet
from cuefem.results.records import Record
from cuefem.scene import Scene

Edit = Callable[[Callable[[Scene], Scene], str], str]


class AdviceSide:
    """The changes a maker can make.

    scene: tells the scene in work. units: those in use. edit: changes the scene, and returns what is wrong.
    """

    def __init__(self, scene: Callable[[], Scene], units: Callable[[], UnitSystem], edit: Edit) -> None:
        self.scene, self.units, self.edit = scene, units, edit
        self.record: Record | None = None
        self.of: Scene | None = None
        with ui.element("section").classes("advice"):
            Markup("<h2>Design changes</h2>")
            self.said = Markup("<p>Every change that a maker can make to this cue, each alone.</p>")
            with ui.element("div").classes("actions"):
                self.ask = button("Compute the changes", self._compute)
            self.beside = Beside()
            self.rows = ui.element("div").classes("scroll")

    def show(self) -> None:
        """Say whether the table is of the design in work."""
        if self.of is not None and self.of != self.scene():
            self.said.set_content("<p>The table is of the design before: compute it again for this one.</p>")

    async def _compute(self) -> None:
        scene = self.scene()
        self.ask.disable()
        self.said.set_content("<p>Computing …</p>")
        try:
            record = await computed(design_changes, scene)
        except FAILURES as error:
            self.beside.say(" ".join(str(error).split()))
            return
        finally:
            self.ask.enable()
        self.beside.say("")
        self.of = scene
        self.record = record
        self.fill()
        self.show()

    def fill(self) -> None:
        """The table in the units in use, if there is one."""
        record = self.record
        if record is None:
            return
        advice = advice_sheet(record)
        self.said.set_content("".join(f"<p>{escape(note)}</p>" for note in advice.notes))
        self.rows.clear()
        with self.rows, ui.element("table"):
            with ui.element("thead"), ui.element("tr"):
                for name in ("", *advice.head):
                    self._cell("th", name, left=name in ("change", ""))
            with ui.element("tbody"):
                for cells, row in zip(advice.rows, record["changes"], strict=True):
                    with ui.element("tr").props(f'data-verdict="{row["verdict"]}"'):
                        with ui.element("td"):
                            made = button("Try", partial(self._take, row))
                            made.props(f'aria-label="try: {escape(row["change"])}"')
                        for i, text in enumerate(cells):
                            self._cell("td", self.units().said(text), left=i in advice.texts)

    def _cell(self, tag: str, text: str, *, left: bool) -> None:
        with ui.element(tag).classes("text" if left else ""):
            ui.label(text)

    def _take(self, row: Record) -> None:
        """Take a change over, in the design that the table is of."""
        if self.of is not None:
            of = self.of
            self.beside.say(self.edit(lambda scene: varied(of, row["set"]), ""))
            self.show()
