"""The tap test on the page: record with the browser's microphone, or choose or drop a recording."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable

from nicegui import ui

from cuefem.designer.computing import FAILURES, LONGEST_WORK
from cuefem.designer.controls import Beside, button
from cuefem.designer.markup import Markup
from cuefem.designer.tapping import Tapped, tapped, tapped_markup, with_wood
from cuefem.designer.unit_system import METRIC, UnitSystem, typed
from cuefem.scene import Scene

SECONDS = 6  # that are recorded
HOW = """<p>Weigh the bare shaft. Hang it on two loops of thread, 22 % of its length from either end. Put the microphone
a hand&#8217;s breadth from the tip end. Tap the joint end crosswise with something small and hard, three times, a
second apart, and let it ring. Draw the shaft first as it hangs: the tones are compared with this design.</p>"""


class TapSide:
    """The section of the tap test. address: where recordings are sent; scene: the present one; edit: changes it."""

    def __init__(
        self, address: str, scene: Callable[[], Scene], edit: Callable[[Callable[[Scene], Scene], str], str]
    ) -> None:
        self.scene, self.edit, self.system = scene, edit, METRIC
        self.address = address
        self.client = ui.context.client
        self.one: Tapped | None = None
        with ui.expansion("Tap test: what wood is it?").classes("tap"):
            Markup(HOW)
            self.weight = ui.input("Weight of the shaft as it hangs, g")
            self.weight.props("outlined dense inputmode=decimal autocomplete=off").classes("choice")
            with ui.element("div").classes("actions"):
                button(f"Record {SECONDS} seconds", self._record)
                button("Choose a recording", lambda: self.client.run_javascript("cuefem.pick()"))
            self.beside = Beside()
            self.shown = Markup()
            self.take = button("Take this wood into the design", self._take)
            self.take.set_visibility(False)
            self.client.on_connect(lambda: self.client.run_javascript(f"cuefem.sends({json.dumps(address)})"))

    def show(self, system: UnitSystem) -> None:
        """Show numbers in these units."""
        self.system = system
        self.weight.props(f'label="Weight of the shaft as it hangs, {system.units["kg"][1]}"')

    def _record(self) -> None:
        self.client.run_javascript(f"cuefem.record({SECONDS})")

    async def listen(self, content: bytes) -> None:
        """Fit the wood to a recording, off the page's loop."""
        self.take.set_visibility(False)
        self.shown.set_content("<p>Listening …</p>")
        try:
            unit = self.system.units["kg"][1]
            text = str(self.weight.value or "").strip()
            mass = typed(text, unit) * {"g": 1e-3, "oz": 28.349523125e-3}[unit] if text else None
            work = asyncio.to_thread(tapped, self.scene(), content, mass)
            self.one = await asyncio.wait_for(work, LONGEST_WORK)
        except (*FAILURES, TimeoutError) as error:
            self.shown.set_content("")
            self.beside.say(" ".join(str(error).split()) or "this takes too long")
            return
        self.beside.say("")
        self.shown.set_content(tapped_markup(self.one, self.system))
        self.take.set_visibility(True)

    def _take(self) -> None:
        if self.one is not None:
            fit = self.one.fit
            self.beside.say(self.edit(lambda scene: with_wood(scene, fit), ""))
