"""What one browser tab works on. A move is answered at once; slower results follow while nothing is moved."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Any

from nicegui import background_tasks, ui

from cuefem.designer.advising import AdviceSide
from cuefem.designer.answering import Answering
from cuefem.designer.checking import CheckSide
from cuefem.designer.computing import FAILURES, computed
from cuefem.designer.controls import ChoiceField, NumberField, button
from cuefem.designer.design import Design, State, Step
from cuefem.designer.door import KINDS
from cuefem.designer.editing import game_of, with_game
from cuefem.designer.kept import LONGEST_NAME, MOST_PINNED, key_of, state_of, text_of
from cuefem.designer.markup import Markup
from cuefem.designer.numbers_panel import Column, csv_text
from cuefem.designer.opening import PresetMenu, ShapeDialog, asked, reading
from cuefem.designer.pinned import PinnedList
from cuefem.designer.receiving import Receiver
from cuefem.designer.results import ResultsSide
from cuefem.designer.sheet import DrawingSheet
from cuefem.designer.sliders import choices, groups, sliders, without
from cuefem.designer.style import SCRIPT, STYLE
from cuefem.designer.unit_system import METRIC, SYSTEMS, UnitSystem
from cuefem.designer.words import head_markup
from cuefem.io.ready import Preset
from cuefem.io.ready import opened as preset_opened
from cuefem.io.toml_text import toml_text
from cuefem.report.glossary import definitions, explained
from cuefem.report.report_page import page as report_page
from cuefem.report.templates import chart_script, page_style
from cuefem.report.unusual import unusual
from cuefem.scene import Scene
from cuefem.scene.default_scene import GAMES

Read = Callable[[Path], tuple[Scene, list[str]]]


class Desk:
    """The state of the page, its history, and what its buttons do."""

    def __init__(self, first: Design, read: Read, *, weigh: bool = False) -> None:
        """weigh: whether the page asks for the weight of the first design's cue, of which nobody has told it."""
        self.read, self.opened, self.key = read, first, key_of(first)
        self.weigh = weigh
        self.state = State((Step(first),))
        self.wanted = first.knobs
        self.system: UnitSystem = METRIC
        self.reference = 0  # which pinned design the others are compared with
        self.answering = Answering(self)
        self.busy = False
        self.client = ui.context.client
        self._build()
        ui.timer(0.05, self._begin, once=True)

    @property
    def design(self) -> Design:
        """The design in work."""
        return self.state.now.design

    @property
    def pinned(self) -> tuple[Design, ...]:
        """The designs beside it."""
        return self.state.now.pinned

    # --- what is there ---------------------------------------------------------------------------------------------

    def _build(self) -> None:
        ui.add_css(page_style() + STYLE)
        ui.add_body_html(definitions() + SCRIPT)
        ui.add_body_html(f"<script>{chart_script()}</script>")
        with ui.element("header"):
            self.head = Markup()
            with ui.element("div").classes("actions"):
                button("Open a file", lambda: self.receiver.pick())
                PresetMenu(self._ready)
                button("Save as .toml", self._save)
                self.report = button("Write the report", self._report)
                self.undo = button("Undo", lambda: self._go(self.state.undo())).props("data-undo")
                self.redo = button("Redo", lambda: self._go(self.state.redo())).props("data-redo")
                button("Back to the file", lambda: self.open(self.opened))
                button("Pin this design", self._pin)
                ui.link("Guide", "/guide", new_tab=True).style("color: inherit")
                self.units = ui.select(list(SYSTEMS), value=METRIC.name, label="Units", on_change=self._switch)
                self.units.props("outlined dense options-dense").classes("units")
            self.message = Markup().on("click", lambda: self.say(""))
        with ui.element("div").classes("unseen"):
            self.receiver = Receiver(KINDS, self._received, self.say)
        self.shape = ShapeDialog(self._opened)
        with ui.element("div").classes("desk"):
            self.panel = ui.element("section").classes("knobs").props('aria-label="knobs"')
            self.side = ui.element("div").classes("answers")
            with self.side:
                self.results = ResultsSide()
        with self.results.above_table:
            self.pins = PinnedList(self._rename, self._work_on, self._compare_with, self._unpin, self._export)
        with self.results.below_verdict:
            self.check = CheckSide(lambda: self.design.scene)
            self.advice = AdviceSide(lambda: self.design.scene, lambda: self.system, self.edit)
        with self.results.below_cue:
            self.sheet = DrawingSheet(self.edit)
        self._show_design()

    def _show_design(self) -> None:
        """The knobs of the design; they are made anew if they are others, and stand elsewhere if not."""
        made = (self.design.base, self.system)
        self.wanted = self.design.knobs
        if getattr(self, "made", None) == made:
            for field in self.fields:
                field.show(field.slider.shown(self.design.knobs))
            for chooser in self.choosers:
                chooser.show(chooser.choice.name(self.design.knobs))
        else:
            self.made = made
            self._make_knobs()
        self._name_knobs()
        self._show_ways()
        self.reference = min(self.reference, max(0, len(self.pinned) - 1))
        self.pins.show(self.pinned, self.reference)
        self.sheet.show(self.design.scene, self.system)
        self._show_head()

    def _show_ways(self) -> None:
        """Whether there is a step to undo or to redo."""
        self.undo.set_enabled(self.state.can_undo)
        self.redo.set_enabled(self.state.can_redo)

    def _make_knobs(self) -> None:
        scene = self.design.base
        self.panel.clear()
        self.fields: list[NumberField] = []
        self.choosers: list[ChoiceField] = []
        with self.panel:
            Markup("<h2>Knobs</h2>")
            name = ui.input("Name of the design", value=self.design.name, on_change=lambda e: self._named(e.value))
            name.props(f"outlined dense debounce=300 maxlength={LONGEST_NAME}").classes("choice")
            for choice in choices(scene):
                turn = lambda material, knob=choice.knob: self.turn(knob, **{knob: material})  # noqa: E731
                self.choosers.append(ChoiceField(choice, choice.name(self.design.knobs), turn))
            known = {slider.knob: slider for slider in sliders(scene, self.system)}
            for title, names in groups().items():
                Markup(f"<h3>{title}</h3>")
                if title == "Stroke":
                    self.game = ui.select(list(GAMES), value=game_of(scene), label="Usual ball, tip and stroke of")
                    self.game.on_value_change(lambda event: self._play(event.value))
                    self.game.props("outlined dense").classes("choice")
                for slider in (known[name] for name in names if name in known):
                    slider = slider.reaching(slider.shown(self.design.knobs))
                    slide = lambda value, slider=slider: self._slid(slider, value)  # noqa: E731
                    self.fields.append(NumberField(slider, slider.shown(self.design.knobs), slide))
            for words in without(scene):
                Markup(explained(f'<p class="hint">{escape(words)}</p>'))

    def _name_knobs(self) -> None:
        """Label the knobs as the cue now is: where its bore begins changes with its ferrule."""
        labels = {slider.knob: slider.label for slider in sliders(self.design.scene, self.system)}
        for field in self.fields:
            field.name(labels.get(field.slider.knob, field.named))

    def _show_head(self) -> None:
        self.head.set_content(explained(head_markup(self.design, self.system)))

    # --- where it begins, and what is kept -------------------------------------------------------------------------

    async def _begin(self) -> None:
        """Take up what this browser kept."""
        stored: dict[str, str] = {}
        with suppress(TimeoutError):
            stored = await self.client.run_javascript(f"cuefem.kept({json.dumps(self.key)})", timeout=20) or {}
        self.system = SYSTEMS.get(str(stored.get("units")), METRIC)
        self.units.set_value(self.system.name)
        with suppress(*FAILURES):  # what an older version kept
            if stored.get("kept"):
                self.state = await computed(state_of, str(stored["kept"]))
        self._show_design()
        if self.weigh and not stored.get("kept"):
            self.shape.weigh(self.design.name, self.design.scene, list(self.design.notes), self.system)
        await self.answering.moved()

    async def _keep(self) -> None:
        state = self.state
        text = await asyncio.to_thread(text_of, state)
        if state is self.state:
            self.client.run_javascript(f"cuefem.keep({json.dumps(self.key)}, {json.dumps(text)})")

    # --- what a person does ----------------------------------------------------------------------------------------

    def say(self, words: str) -> None:
        """Say what went wrong, or clear the message."""
        said = escape(self.system.said(words))
        self.message.set_content(f'<p class="said" role="alert">{said}</p>' if words else "")

    def _slid(self, slider: Any, value: float) -> str:
        return self.turn(slider.knob, **{slider.knob: slider.turned(self.wanted, value)[slider.knob]})

    def turn(self, label: str, **changed: Any) -> str:
        """Turn knobs; what is wrong if no such cue can be made: then the design stays as it is."""
        self.wanted = {**self.wanted, **changed}
        if self.wanted == self.design.knobs:
            self.show_move()
            return ""
        design = replace(self.design, knobs=self.wanted)
        try:
            design.scene  # noqa: B018
        except FAILURES as error:
            self.show_move()
            return self.system.said(" ".join(str(error).split()))
        self._put(Step(design, self.pinned), label)
        return ""

    def _play(self, game: str | None) -> None:
        if game and game != game_of(self.design.scene):
            words = self.edit(lambda scene: with_game(scene, game))
            if words:
                self.say(words)
                self.game.set_value(game_of(self.design.scene))

    def edit(self, change: Callable[[Scene], Scene], label: str = "") -> str:
        """Change anything of the scene; what is wrong if that cannot be: then the design stays as it is."""
        try:
            design = self.design.edited(change(self.design.scene))
        except FAILURES as error:
            return self.system.said(" ".join(str(error).split()))
        self._put(Step(design, self.pinned), label)
        self._show_design()
        return ""

    def _ready(self, preset: Preset) -> None:
        try:
            scene, notes = preset_opened(preset)
            measured = preset.beside(scene)
        except FAILURES as error:
            self.say(f"not opened: {' '.join(str(error).split())}")
            return
        design = Design.of(Path(preset.file).name, scene, [*notes, measured])
        self.opened = design
        self.open(design)

    def _named(self, name: str) -> None:
        if name.strip() and name != self.design.name:
            self._put(Step(replace(self.design, name=name.strip()), self.pinned), "name", move=False)
            self._show_head()

    def _put(self, step: Step, label: str = "", *, move: bool = True) -> None:
        """Go on to a step: keep it, and compute it."""
        self.state = self.state.put(step, label, when=time.monotonic())
        self._moved(move)

    def _moved(self, move: bool = True) -> None:
        """Answer the present step if it is a move, and keep it while that is computed."""
        if move:
            self.say("")
            self.show_busy(True)
            background_tasks.create(self.answering.moved(), name="answer a move")
        else:
            self._show_ways()
        background_tasks.create(self._keep(), name="keep a step")

    def _go(self, state: State) -> None:
        self.state = state
        self._moved()
        self._show_design()

    def open(self, design: Design) -> None:
        """Work on another design, beside those that are pinned."""
        self._put(Step(design, self.pinned))
        self._show_design()

    def _switch(self, event: Any) -> None:
        if self.system is not SYSTEMS[event.value]:
            self.system = SYSTEMS[event.value]
            self.client.run_javascript(f"cuefem.remember({json.dumps(event.value)})")
            self._show_design()
            self._show_all()
            self.advice.fill()

    # --- designs to compare with -----------------------------------------------------------------------------------

    def _pin(self) -> None:
        if len(self.pinned) >= MOST_PINNED:
            self.say(f"at most {MOST_PINNED} designs can be pinned: take one off first")
            return
        pinned_names = {design.name for design in self.pinned}
        stem = Path(self.design.name).stem if self.design.name.endswith(KINDS) else self.design.name
        names = (f"{stem[: LONGEST_NAME - 4]} {i}" for i in range(1, MOST_PINNED + 2))
        name = next(name for name in names if name not in pinned_names)
        self._pinned((*self.pinned, replace(self.design, name=name)))

    def _pinned(self, pinned: tuple[Design, ...], label: str = "") -> None:
        self._put(Step(self.design, pinned), label, move=label != "rename")
        if label != "rename":
            self._show_design()
        self._show_all()

    def _rename(self, i: int, name: str) -> None:
        if name.strip() and i < len(self.pinned) and name.strip() != self.pinned[i].name:
            changed = replace(self.pinned[i], name=name.strip()[:LONGEST_NAME])
            self._pinned((*self.pinned[:i], changed, *self.pinned[i + 1 :]), "rename")

    def _unpin(self, i: int) -> None:
        self._pinned((*self.pinned[:i], *self.pinned[i + 1 :]))

    def _work_on(self, i: int) -> None:
        self.open(self.pinned[i])

    def _compare_with(self, i: int) -> None:
        self.reference = i
        self.pins.show(self.pinned, i)
        self.show_numbers()
        self.show_table()

    def _columns(self) -> list[Column]:
        known = [self.answering.mine, *(self.answering.known(design.scene) for design in self.pinned)]
        designs = (self.design, *self.pinned)
        return [
            Column(design, results.answers if results else None) for design, results in zip(designs, known, strict=True)
        ]

    def _export(self) -> None:
        if self.answering.mine is not None:
            text = csv_text(self._columns(), self._compared_with, self.system)
            ui.download.content("\ufeff" + text, f"{Path(self.design.name).stem}.csv")  # Excel reads it as UTF-8

    # --- what is shown ---------------------------------------------------------------------------------------------

    @property
    def _compared_with(self) -> int:
        """Which of the columns the others are compared with."""
        return self.reference + 1 if self.pinned else 0

    def scenes(self) -> list[Scene]:
        """The scene in work, and those that are pinned."""
        return [self.design.scene, *(design.scene for design in self.pinned)]

    def show_busy(self, busy: bool) -> None:
        """Whether more is being computed."""
        if busy != self.busy:
            self.busy = busy
            self.client.run_javascript(f"cuefem.busy({json.dumps(busy)})")

    def show_numbers(self) -> None:
        """The numbers that matter most, as far as they are known: all that a person waits for."""
        self.results.show_numbers(self._columns(), self._compared_with, self.system)

    def show_move(self) -> None:
        """What belongs to a move beside its answer: the knob's text, and the fields of everything."""
        self._name_knobs()
        for field in self.fields:
            field.agree()
        self._show_ways()
        self.sheet.show(self.design.scene, self.system)
        self.check.show()
        self.advice.show()

    def pictures(self) -> Iterator[None]:
        """Show words, drawings, all numbers and the curves so far, one a step."""
        mine = self.answering.mine
        self._show_head()
        if mine is not None:
            self.results.show_cue(mine, self.system)
            yield
            self.show_table()
            yield
            self.show_curves()

    def show_table(self) -> None:
        """All numbers that are known."""
        self.results.show_table(self._columns(), self._compared_with, self.system)

    def show_curves(self) -> None:
        """The curves that are known."""
        mine, before = self.answering.mine, self.answering.before
        if mine is not None:
            pinned = [(design, self.answering.known(design.scene)) for design in self.pinned]
            self.results.show_charts(mine, before, pinned, self.system)
            self.results.show_density(mine, before, pinned, self.system)

    def _show_all(self) -> None:
        self.show_numbers()
        for _ in self.pictures():
            pass

    # --- files -----------------------------------------------------------------------------------------------------

    async def _received(self, name: str, content: bytes) -> None:
        try:
            known = await computed(reading, name, content, self.read)
        except FAILURES as error:
            self.say(f"not opened: {error}")
            return
        if asked(name):
            self.shape.ask(name, known, self.system)
        else:
            self._opened(name, *known)

    def _opened(self, name: str, scene: Scene, notes: list[str]) -> None:
        try:
            design = Design.of(name, scene, notes)
        except FAILURES as error:
            self.say(f"not opened: {error}")
            return
        self.opened = design
        self.say("")
        self.open(design)

    def _save(self) -> None:
        ui.download.content(toml_text(self.design.scene), f"{Path(self.design.name).stem}.toml")

    async def _report(self) -> None:
        design = self.design
        self.report.disable()
        self.say("writing the report …")
        try:
            options: dict[str, Any] = {"notes": list(design.notes), "remarks": unusual(design.scene)}
            text = await computed(lambda: report_page(design.name, design.scene, **options))
        except FAILURES as error:
            self.say(" ".join(str(error).split()))
            return
        finally:
            self.report.enable()
        self.say("")
        ui.download.content(text, f"{Path(design.name).stem}.html")
