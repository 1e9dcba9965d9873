"""The page of one browser tab: header, first screen, controls and tabs, and how a change updates them."""

from __future__ import annotations

import time
import weakref
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from html import escape
from importlib.resources import files
from pathlib import PurePosixPath
from typing import Any

from nicegui import Client, app, background_tasks, events, ui

from cuefem.analysis.cue_report import report
from cuefem.analysis.first_screen import (
    HeadlineCue,
    drawings_markup,
    headline_markup,
    parts_line,
    scale_markup,
    tiles_markup,
)
from cuefem.analysis.strike_models import regime_warning
from cuefem.analysis.verdict import with_cue
from cuefem.designer import computation, panels
from cuefem.designer.computation import run_in_thread
from cuefem.designer.file_editor import FileEditor
from cuefem.designer.knobs import GROUPS, INPUTS, KNOBS, KnobRow, label, value, value_text, with_value
from cuefem.designer.panels import Results
from cuefem.designer.state import (
    FAILURES,
    MAX_NAME,
    ComparedDesign,
    Design,
    Step,
    UndoHistory,
    one_line,
    read_design,
    reference_design,
)
from cuefem.files.defaults_report import assumption_texts, tenon_assumption
from cuefem.files.reference_cues import PRESETS, REFERENCE_FILES
from cuefem.files.toml_writer import toml_text
from cuefem.parameters.parameter import parameter, with_parameters
from cuefem.results.quantities import REGIMES
from cuefem.results.verdict import verdict_problem
from cuefem.scene import Scene
from cuefem.show.glossary import definitions, with_term_buttons
from cuefem.show.renderers import csv_text
from cuefem.show.templates import chart_script, page_style
from cuefem.solid.tip_cache import computing_message

MAX_FILE = 5_000_000  # bytes
KINDS = (".toml", ".csv", ".stl", ".ply", ".obj")
TABS = ("Curves", "Changes", "Numbers", "Check", "File")
NOTHING, OPENED, NOW, FILE = "nothing", "as it was opened", "as it is now", "a file …"
OPTIONS = {"opened": OPENED, "now": NOW}
# What is computed of a design before its tabs, and for each tab.
FIRST = ("solved_strike", "numbers", "verdict")
OF_TAB = {"Curves": ("curve", "end_mass_distribution"), "Changes": ("changes",)}
OF_VERDICT = ("verdict", "changes")  # which need a squirt that can be reported
SHARED = ("solved_strike", "numbers", "curve", "end_mass_distribution")  # also computed of the other design


async def is_open(client: Client, timeout: float = 60.0) -> bool:
    """Whether a tab's browser has connected; not if the tab was closed before its page loaded."""
    with suppress(TimeoutError):
        await client.connected(timeout=timeout)
    return client.has_socket_connection


class Page:
    """The content of a tab, and the actions of its controls."""

    def __init__(self, first: Design) -> None:
        self.history = UndoHistory(first)
        self.listed = (self._assumed(), self._notes())  # the assumptions that are on the page
        self.version = 0  # of the design in work: results of an older one are dropped
        self.results = Results()
        self.solid_of: Scene | None = None  # that was computed as a solid
        self.tab = TABS[0]
        self.rows: list[KnobRow] = []
        self.folds: dict[str, Any] = {}  # of the groups of controls
        self.client = ui.context.client
        ui.add_css(page_style() + files("cuefem.designer").joinpath("page.css").read_text(encoding="utf-8"))
        ui.add_body_html(f"{definitions()}<script>{chart_script()}</script>")
        self._header()
        with ui.element("div").classes("main").props('data-busy="true"') as self.main:
            with ui.element("aside").classes("card knobs").props("aria-label=Controls"):
                self._knobs()
            with ui.element("section").classes("screen card").props("aria-label=Result") as self.card:
                self._first_screen()
            with ui.element("section").classes("card tabs").props("aria-label=Details"):
                self._tabs()
        ui.keyboard(self._key, ignore=["input", "select", "textarea"])
        self.show()
        ui.timer(0.01, self._begin, once=True)

    @property
    def step(self) -> Step:
        """The two designs on the page: the current one and the other one."""
        return self.history.now

    # --- the parts of the page ---------------------------------------------------------------------

    def _header(self) -> None:
        with ui.element("header").classes("head"):
            ui.html("<h1>cuefem designer</h1>", sanitize=False).classes("brand")
            self.name = ui.input(on_change=self._on_rename).props(
                f'borderless dense debounce=400 maxlength={MAX_NAME} aria-label="Name of the design"'
            )
            self.changed = ui.label().classes("soft setup")
            with ui.element("div").classes("tools").props('role=toolbar aria-label="File and history"'):
                _tool("Open", "folder_open", lambda: self._pick("design"))
                with _tool("Reference cues", "list", lambda: None), ui.menu().props('aria-label="Reference cues"'):
                    for preset in PRESETS:
                        ui.menu_item(preset.name, lambda preset=preset: self._reference(preset))
                _tool("Save", "save_alt", self._save)
                self.report = _tool("Report", "description", self._report)
                self.undo = _tool("Undo", "undo", lambda: self.undo_redo(-1))
                self.redo = _tool("Redo", "redo", lambda: self.undo_redo(1))
                ui.link("Guide", "/guide", new_tab=True).classes("guide")
            page = weakref.proxy(self)  # the server caches the route of an upload, also after the page is closed
            self.upload = ui.upload(
                auto_upload=True,
                max_file_size=MAX_FILE,
                on_upload=lambda event: page._uploaded(event),
                on_rejected=lambda: page.show_message(f"not opened: at most {MAX_FILE // 10**6} MB"),
            ).props(f'accept="{",".join(KINDS)}"')
            self.upload.classes("unseen")
            self.purpose = "design"
        self.banner = ui.label().classes("banner").props("role=alert")
        self.banner.set_visibility(False)

    def _first_screen(self) -> None:
        self.progress = ui.element("div").classes("progress").props("aria-hidden=true")
        with ui.element("div").classes("top"):
            self.headline = ui.html(sanitize=False).classes("num")
            with ui.element("div"):
                with ui.element("div").classes("compare"):
                    ui.label("Compare with").classes("soft")
                    self.compare = ui.select([NOTHING], value=NOTHING, on_change=self._on_compare)
                    self.compare.props('outlined dense options-dense aria-label="Compare with"')
                    self.swap = ui.button("Swap", on_click=self._swap).props("outline dense no-caps")
                self.scale = ui.html(sanitize=False).classes("num")
        self.tiles = ui.html(sanitize=False).classes("num")
        self.drawing = ui.html(sanitize=False)
        with ui.expansion(on_value_change=lambda: self.assumptions.refresh()).classes("assumptions") as self.fold:
            self.assumptions()
        self.printed = ui.label().classes("printed soft")

    @ui.refreshable_method
    def assumptions(self) -> None:
        """The assumptions, one line each, with the control that changes it."""
        self.rows = [row for row in self.rows if not row.short]
        if not self.fold.value:
            return
        parts = self._parts()
        for key in sorted(self._assumed(), key=lambda key: -parts.get(key, 0.0)):
            with ui.element("div").classes("assumption"):
                self.rows.append(KnobRow(key, self, short=True))
                self.rows[-1].show()
                ui.label(f"part of ±: {100 * parts[key]:.0f} %" if key in parts else "not in ±").classes("soft")
        for note in self._notes():
            ui.label(note).classes("soft")

    def _assumed(self) -> list[str]:
        scene = self.step.design.scene
        return [key for key in KNOBS if key in self.step.design.assumed and value(key, scene) is not None]

    def _notes(self) -> list[str]:
        tenon = assumption_texts(tenon_assumption(self.step.design.scene.shaft))
        return [*self.step.design.notes, *(f"{text} (change it in File)" for text in tenon)]

    def _assumption_lines(self) -> list[str]:
        scene = self.step.design.scene
        return [*(f"{label(key, scene)} {_assumption(key, scene)}" for key in self._assumed()), *self._notes()]

    def _parts(self) -> dict[str, float]:
        """Relative uncertainty of squirt by each control's parameters."""
        verdict = self.results.own.get("verdict")
        inputs = verdict.inputs if verdict else {}
        parts = {key: sum(inputs.get(name, 0.0) ** 2 for name in INPUTS.get(key, (key,))) ** 0.5 for key in KNOBS}
        return {key: part for key, part in parts.items() if part}

    def _knobs(self) -> None:
        for i, group in enumerate(GROUPS):
            with ui.expansion(group, value=i == 0, group="knobs").classes("group") as fold:
                self.folds[group] = fold
                for key, knob in KNOBS.items():
                    if knob.group == group:
                        self.rows.append(KnobRow(key, self))
        ui.html('<p class="mark-key soft"><i></i>assumed. Fields take any unit: 1/4 in, 15 oz.</p>', sanitize=False)

    def _tabs(self) -> None:
        with ui.tabs(on_change=self._on_open).props("no-caps align=left") as tabs:
            for name in TABS:
                ui.tab(name)
        with ui.tab_panels(tabs, value=TABS[0], animated=False):
            with ui.tab_panel("Curves"):
                self.curves = ui.html(sanitize=False).classes("num")
            with ui.tab_panel("Changes"):
                self.changes()
            with ui.tab_panel("Numbers"):
                ui.button("Save as .csv", on_click=self._table).props("outline dense no-caps").classes("right")
                self.numbers = ui.html(sanitize=False).classes("num")
            with ui.tab_panel("Check"):
                self.check_button = ui.button("Check against a solid model", on_click=self._check)
                self.check_button.props("outline dense no-caps").classes("right")
                self.check = ui.html(sanitize=False).classes("num")
            with ui.tab_panel("File") as self.file_panel:
                self.file: FileEditor | None = None  # made when it is opened: the browser loads its code then

    @ui.refreshable_method
    def changes(self) -> None:
        """The table of changes, each with Try."""
        panels.changes_panel(self.step, self.results, self._try)

    # --- changes -----------------------------------------------------------------------------------

    def set_knob(self, key: str, new: Any, text: str = "", *, slid: bool = False) -> None:
        """Set a control to a value, typed as a text; ValueError if that design is invalid."""
        when, name = time.monotonic(), key if slid else ""
        base = self.history.slide_start(name, when)
        made = base.changed(with_value(base.scene, key, new), {key}, {key: text} if text else {})
        self.push(Step(made, self.step.other), name, when=when)

    def _try(self, places: Mapping[str, Any]) -> None:
        design = self.step.design
        keys = {known.key for name in places if (known := parameter(name))}
        self._attempt(
            lambda: self.push(Step(design.changed(with_parameters(design.scene, places), keys, {}), self.step.other))
        )

    def _applied(self, read: Design) -> None:
        design = self.step.design
        new = {key for key in KNOBS if value(key, read.scene) != value(key, design.scene)}
        self.push(Step(design.changed(read.scene, new, {}), self.step.other))

    def _attempt(self, work: Callable[[], Any]) -> None:
        try:
            work()
            self.show_message("")
        except FAILURES as error:
            self.show_message(one_line(error))

    def push(self, step: Step, label: str = "", *, when: float = 0.0) -> None:
        """Add a step to the history, and show it."""
        self.history.push(step, label, when=when)
        self.show()
        self._start_computation()

    def undo_redo(self, steps: int) -> None:
        """Undo (-1) or redo (1)."""
        if self.history.move(steps):
            self.show()
            self._start_computation()

    def _key(self, event: events.KeyEventArguments) -> None:
        key = str(event.key).lower()
        if event.action.keydown and (event.modifiers.ctrl or event.modifiers.meta) and key in ("z", "y"):
            self.undo_redo(1 if key == "y" or event.modifiers.shift else -1)

    def _on_rename(self, event: Any) -> None:
        name = str(event.value or "").strip()[:MAX_NAME]
        if name and name != self.step.design.name:
            self.push(Step(replace(self.step.design, name=name), self.step.other), "name", when=time.monotonic())

    # --- files -------------------------------------------------------------------------------------

    def _pick(self, purpose: str) -> None:
        self.purpose = purpose
        self.upload.run_method("pickFiles")

    async def _uploaded(self, event: events.UploadEventArguments) -> None:
        content, name = await event.file.read(), file_name(event.file.name)
        self.upload.reset()
        purpose, self.purpose = self.purpose, "design"
        try:
            if len(content) > MAX_FILE:
                raise ValueError(f"a file must be of at most {MAX_FILE // 10**6} MB")
            design = await run_in_thread(read_design, name, content)
        except FAILURES as error:
            self.show_message(one_line(error))
            return
        self.show_message("")
        if purpose == "design":
            self._edit(design)
        else:
            self.push(Step(self.step.design, ComparedDesign("file", design)))

    def _edit(self, design: Design) -> None:
        self.history.opened = design
        self.push(Step(design, self.step.other))

    def _reference(self, preset: Any) -> None:
        self._attempt(lambda: self._edit(reference_design(preset)))

    def _save(self) -> None:
        design = self.step.design
        ui.download.content(toml_text(design.scene), f"{_stem(design.name)}.toml")

    async def _report(self) -> None:
        """Write the report of the design, compared with the other one."""
        design, other = self.step.design, self.step.other
        self.report.disable()
        beside = None if other is None else (panels.named_designs(self.step)[1][0], self._compared_scene())
        try:
            text = await run_in_thread(self._page, design, self._assumption_lines(), beside)
            ui.download.content(text, f"{_stem(design.name)}.html")
        except FAILURES as error:
            self.show_message(one_line(error))
        finally:
            self.report.enable()

    @staticmethod
    def _page(design: Design, notes: list[str], beside: tuple[str, Scene] | None) -> str:
        return report(design.scene, details=True).to_html(design.name, notes, other=beside)

    def _table(self) -> None:
        made = panels.tabulate_numbers(self.step, self.results)
        if made is not None:
            ui.download.content("\ufeff" + csv_text(made.head, made.rows), f"{_stem(self.step.design.name)}.csv")

    # --- comparing ---------------------------------------------------------------------------------

    def _on_compare(self, event: Any) -> None:
        name, step = event.value, self.step
        if name == _other_name(step.other):
            return
        if name == FILE:
            self._pick("other")
            self.show()
        elif name == NOTHING:
            self.push(Step(step.design))
        elif name in REFERENCE_FILES:
            preset = next(preset for preset in PRESETS if preset.file == REFERENCE_FILES[name])
            self.push(Step(step.design, ComparedDesign("reference", replace(reference_design(preset), name=name))))
        else:
            kind = next(kind for kind, words in OPTIONS.items() if words == name)
            self.push(Step(step.design, ComparedDesign(kind, self.history.opened if kind == "opened" else step.design)))

    def _swap(self) -> None:
        design, other = self.step
        if other is not None:
            self.push(Step(other.design, ComparedDesign("now" if other.kind in OPTIONS else "file", design)))

    # --- what is shown -----------------------------------------------------------------------------

    def show_message(self, words: str) -> None:
        """Show a message above the page, or none."""
        self.banner.set_text(words)
        self.banner.set_visibility(bool(words))

    def show(self) -> None:
        """Show the design at once: its controls, name, drawing and file."""
        design, other = self.step
        self.name.set_value(design.name)
        self.changed.set_text("changed since opened" if design.scene != self.history.opened.scene else "")
        self.undo.set_enabled(self.history.at > 0)
        self.redo.set_enabled(self.history.at < len(self.history.steps) - 1)
        if self.listed != (listed := (self._assumed(), self._notes())):
            self.listed = listed
            self.assumptions.refresh()
        for row in self.rows:
            row.show()
        chosen = _other_name(other)
        offered = [NOTHING, *OPTIONS.values(), *REFERENCE_FILES, FILE]
        offered = offered if chosen in offered else [chosen, *offered]
        if (self.compare.options, self.compare.value) != (offered, chosen):
            self.compare.set_options(offered, value=chosen)
        self.swap.set_visibility(other is not None)
        shown = panels.named_designs(self.step)
        self.drawing.set_content(drawings_markup({name: each.scene for name, each in shown}))
        captions = {
            "Shaft": f"length {1e3 * design.scene.shaft.length:.1f} mm",
            "Tip": f"{value('leather', design.scene) or 'a spring'}, {_texts(design.scene, 'tip_height', 'dome')}",
            "Stroke": f"{value('game', design.scene)}, {_texts(design.scene, 'speed', 'offset')}",
        }
        for group, words in captions.items():
            self.folds[group].props(f'caption="{words}"')
        if self.tab == "File" and self.file is not None:
            self.file.show(design)

    def _show_numbers(self) -> None:
        """Show the results computed so far."""
        own, other = self._shown(self.results.own, 0), self._shown(self.results.other, 1)
        if own is None:
            return
        outcome = self.results.own["solved_strike"].outcome
        warning = REGIMES[outcome.regime] if regime_warning(outcome.regime) else verdict_problem(own.scene, outcome)
        difference = self.results.difference
        self.headline.set_content(with_term_buttons(headline_markup(own, other, difference, warning)))
        self.scale.set_content(scale_markup(own, other))
        self.tiles.set_content(with_term_buttons(tiles_markup(own, other)))
        lines = self._assumption_lines()
        self.printed.set_text("; ".join(lines))
        words = f"{len(lines)} assumption{'s' if len(lines) != 1 else ''}"
        self.fold.props(f'label="{words}" caption="{parts_line(own.verdict) if own.verdict else ""}"')
        self._show_tab()

    def _shown(self, side: Mapping[str, Any], i: int) -> HeadlineCue | None:
        if "solved_strike" not in side:
            return None
        name, design = panels.named_designs(self.step)[i]
        numbers = side.get("numbers") or computation.first_numbers(design.scene if i == 0 else self._compared_scene())
        return HeadlineCue(name, design.scene, numbers, side.get("verdict"))

    def _compared_scene(self) -> Scene:
        """The other design with this one's ball and stroke; a reference cue with this tip too."""
        assert self.step.other is not None
        mine, other = self.step.design.scene, self.step.other.design.scene
        return (
            with_cue(mine, other.shaft)
            if self.step.other.kind == "reference"
            else computation.with_stroke_of(mine, other)
        )

    def _show_tab(self) -> None:
        if self.tab == "Curves":
            self.curves.set_content(panels.curves_markup(self.step, self.results))
        elif self.tab == "Changes":
            self.changes.refresh()
        elif self.tab == "Numbers":
            self.numbers.set_content(panels.tables_markup([panels.tabulate_numbers(self.step, self.results)]))
        elif self.tab == "Check":
            self.check.set_content(panels.tables_markup(panels.tabulate_check(self.step, self.results)))

    def _on_open(self, event: Any) -> None:
        self.tab = str(event.value)
        if self.tab == "File":
            if self.file is None:
                with self.file_panel:
                    self.file = FileEditor(self._applied)
            self.file.show(self.step.design)
            self.file.set_accessible_name()
        else:
            self._start_computation()

    # --- results -----------------------------------------------------------------------------------

    async def _begin(self) -> None:
        """Restore the state of this tab before a reload, and compute."""
        if not await is_open(self.client):
            return
        saved = app.storage.tab.get("history")
        if isinstance(saved, UndoHistory):
            self.history = saved
            self.show()
        app.storage.tab["history"] = self.history
        self._start_computation()

    def _start_computation(self) -> None:
        self.version += 1
        self.main.props('data-busy="true"')
        self.card.classes(add="stale")
        background_tasks.create(self._compute_all(self.version), name="computation")

    async def _compute_all(self, version: int) -> None:
        """Compute the displayed results, the first numbers first; stop when the design changes."""
        step, results = self.step, Results()
        other = None if step.other is None else self._compared_scene()
        scenes = [(step.design.scene, results.own), *([] if other is None else [(other, results.other)])]
        waits = not all(scene.tip_is_cached for scene, _ in scenes)
        with self.client:
            if waits:
                self.show_message(computing_message())
            failures = list[str]()
            for name in (*FIRST, *OF_TAB.get(self.tab, ())):
                if name in OF_VERDICT:
                    outcome = results.own["solved_strike"].outcome
                    if verdict_problem(step.design.scene, outcome):
                        continue
                for scene, side in scenes:
                    if side is results.own or name in SHARED:
                        failures += await self._compute(side, name, getattr(computation, name), scene)
                        if version != self.version:
                            return
                if name == "verdict" and other is not None and "solved_strike" in results.other:
                    same = step.other is not None and step.other.kind in OPTIONS
                    work = computation.comparison
                    failures += await self._compute(results.own, "comparison", work, step.design.scene, other, same)
                    if version != self.version:
                        return
                if "solved_strike" not in results.own:
                    failures = [f"{failures[0]}. The numbers are those of the previous design."]
                    break
                self._show_results(results)
            self.show_message("; ".join(dict.fromkeys(failures)))
            self.main.props('data-busy="false"')

    @staticmethod
    async def _compute(side: dict[str, Any], name: str, work: Callable[..., Any], *arguments: Any) -> list[str]:
        """Compute one result of a design; return the error message, if any."""
        try:
            side[name] = await run_in_thread(work, *arguments)
        except FAILURES as error:
            return [one_line(error)]
        return []

    def _show_results(self, results: Results) -> None:
        """Show results; the card is no longer stale once the numbers belong to this design."""
        first = "verdict" not in self.results.own
        solid = self.results.own.get("solid") if self.solid_of == self.step.design.scene else None
        self.results = Results(dict(results.own), dict(results.other), results.own.get("comparison", {}).get("squirt"))
        if solid is not None:
            self.results.own["solid"] = solid
        if "numbers" in results.own:
            self.card.classes(remove="stale")
        self._show_numbers()
        if first and "verdict" in results.own:
            self.assumptions.refresh()

    async def _check(self) -> None:
        """Compute the design as a solid."""
        scene, version = self.step.design.scene, self.version
        self.check_button.disable()
        self.main.props('data-busy="true"')
        try:
            solid = await run_in_thread(computation.solid, scene)
            if scene == self.step.design.scene:
                self.solid_of, self.results.own["solid"] = scene, solid
                self._show_tab()
        except FAILURES as error:
            self.show_message(one_line(error))
        finally:
            self.check_button.enable()
            if version == self.version:
                self.main.props('data-busy="false"')


def file_name(text: Any) -> str:
    """The name of an uploaded file without folders; ValueError for an invalid file name."""
    name = PurePosixPath(str(text or "").replace("\\", "/")).name
    if name.strip() in ("", ".", "..") or not name.isprintable() or len(name.encode(errors="replace")) > 255:
        raise ValueError(f"a file must have a name of at most 255 bytes; got {name[:20]!r}")
    return name


def _tool(words: str, icon: str, action: Callable[[], Any]) -> Any:
    return ui.button(words, icon=icon, on_click=action).props("flat dense no-caps")


def _other_name(other: ComparedDesign | None) -> str:
    return NOTHING if other is None else OPTIONS.get(other.kind, other.design.name)


def _stem(name: str) -> str:
    """A design's name as a file name."""
    return "".join(c if c.isalnum() or c in " -_." else "_" for c in name).strip(" .") or "design"


def _assumption(key: str, scene: Scene) -> str:
    own = value(key, scene)
    return str(own) if KNOBS[key].range is None else value_text(key, own)


def _texts(scene: Scene, *keys: str) -> str:
    return ", ".join(escape(value_text(key, own)) for key in keys if (own := value(key, scene)) is not None)
