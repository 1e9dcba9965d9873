"""Everything in a design as fields to type: segments, materials, ball, tip, stroke, and effects on and off."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from html import escape
from typing import Any

from nicegui import ui

from cuefem.cue import Material
from cuefem.cue.materials import MATERIALS, material_name
from cuefem.designer import editing
from cuefem.designer.controls import Beside, button
from cuefem.designer.editing import Field
from cuefem.designer.markup import Markup
from cuefem.designer.unit_system import METRIC, UnitSystem, typed
from cuefem.effects import Effect, effect_kinds
from cuefem.parameters.parameter import Path, replaced, value_at
from cuefem.parameters.parts import materials_in
from cuefem.scene import Scene

Edit = Callable[[Callable[[Scene], Scene], str], str]
EMPTY = "empty"


class DrawingSheet:
    """The fields of a scene, made when they are first opened. edit: changes the scene, and returns what is wrong."""

    def __init__(self, edit: Edit) -> None:
        self.edit = edit
        self.scene: Scene | None = None
        self.system: UnitSystem = METRIC
        self.off: dict[str, Effect] = {}  # effects that were switched off, by name, to be switched on as they were
        self.cells: dict[Path, tuple[Any, Field]] = {}
        self.shape: Any = None
        self.fold = ui.expansion("Everything in this design: segments, materials, ball, effects").classes("sheet")
        self.fold.on_value_change(lambda event: self._refresh())

    def show(self, scene: Scene, system: UnitSystem) -> None:
        """Show this scene."""
        self.scene, self.system = scene, system
        self._refresh()

    def _refresh(self) -> None:
        scene = self.scene
        if scene is None or not self.fold.value:
            return
        cue = scene.shaft
        materials = materials_in(cue)
        places = [(materials.index(s.material), s.core and materials.index(s.core)) for s in cue.segments]
        names = tuple(map(material_name, materials))
        shape = (self.system, tuple(places), names, tuple(type(effect) for effect in scene.effects))
        if shape != self.shape:
            self.shape = shape
            self._make(scene, materials)
            return
        for path, (cell, field) in self.cells.items():
            value = value_at(scene, path)
            if value != field.value:
                self.cells[path] = (cell, field._replace(value=value))
                cell.set_value(self._text(value, field.unit))

    def _make(self, scene: Scene, materials: tuple[Material, ...]) -> None:
        self.fold.clear()
        self.cells = {}
        with self.fold:
            self.beside = Beside()
            for i, segment in enumerate(scene.shaft.segments):
                with self._card(f"Segment {i + 1}"):
                    with ui.element("div").classes("cells"):
                        self._numbers(segment, ("cue", "segments", i))
                        self._material(("cue", "segments", i, "material"), "material", segment.material)
                        self._material(("cue", "segments", i, "core"), "core in the bore", segment.core)
                    with ui.element("div").classes("row"):
                        button("Split", partial(self._on_segment, editing.split, i))
                        button("Add one behind", partial(self._on_segment, editing.added, i))
                        button("Remove", partial(self._on_segment, editing.removed, i))
            for i, material in enumerate(materials):
                with self._card(f"Material: {material_name(material)}"), ui.element("div").classes("cells"):
                    self._numbers(material, ("materials", i))
            for title, name in (("Ball", "ball"), ("Tip", "tip"), ("Stroke", "stroke")):
                with self._card(title), ui.element("div").classes("cells"):
                    self._numbers(getattr(scene, name), (name,))
            with self._card("Behind what is drawn"), ui.element("div").classes("cells"):
                self._number(Field(("cue", "body_mass"), "mass", "kg", scene.shaft.body_mass))
            for i, effect in enumerate(scene.effects):
                with self._card(type(effect).__name__):
                    with ui.element("div").classes("cells"):
                        self._numbers(effect, ("effects", i))
                    box = ui.checkbox("acts", value=True, on_change=partial(self._switch_off, i, effect))
                    box.props(f'dense aria-label="{type(effect).__name__} acts"')
            with self._card("Effects that do not act"), ui.element("div").classes("row"):
                for name in effect_kinds():
                    if name not in {type(effect).__name__ for effect in scene.effects}:
                        box = ui.checkbox(name, value=False, on_change=partial(self._switch_on, name))
                        box.props("dense")

    def _card(self, title: str) -> ui.element:
        made = ui.element("div").classes("card").props(f'role="group" aria-label="{escape(title)}"')
        with made:
            Markup(f"<h3>{escape(title)}</h3>")
        return made

    def _numbers(self, thing: Any, path: Path) -> None:
        for field in editing.fields_of(thing, path):
            self._number(field)

    def _number(self, field: Field) -> None:
        _, unit = self._unit(field.unit)
        label = f"{field.label}, {unit}" if unit else field.label
        with ui.element("div").classes("cell"):
            cell = ui.input(label, value=self._text(field.value, field.unit))
            cell.props("outlined dense debounce=400 inputmode=decimal autocomplete=off")
            cell.on_value_change(lambda event: self._typed(field.path, str(event.value or "")))
        self.cells[field.path] = (cell, field)

    def _unit(self, unit: str) -> tuple[float, str]:
        return self.system.units.get(unit, (1.0, unit))

    def _text(self, value: float | None, unit: str) -> str:
        if value is None:
            return ""
        scale, name = self._unit(unit)
        finest = 4 if name in ("in", "oz") else 300  # decimals: 0.0001 in is 2.5 um
        return f"{round(value * scale, finest):.6g}"

    def _typed(self, path: Path, text: str) -> None:
        cell, field = self.cells[path]
        if text == self._text(field.value, field.unit):
            self._say("", cell)
            return
        scale, unit = self._unit(field.unit)
        try:
            entry = text.strip().lower()
            value = None if not entry else float("inf") if entry in ("inf", "∞") else typed(text, unit) / scale
        except ValueError as error:
            self._say(f"{field.label} {error}; the design stays as it was", cell)
            return
        value = value if value is None else float(f"{value:.15g}")
        self.cells[path] = (cell, field._replace(value=value))
        words = self.edit(lambda scene: replaced(scene, {path: value}), f"{path}")
        if words:
            self.cells[path] = (cell, field)
        self._say(words, cell)

    def _say(self, words: str, cell: Any = None) -> None:
        self.beside.say(words)
        if cell is not None:
            cell.props("error aria-invalid=true" if words else "", remove="" if words else "error aria-invalid")

    def _on_segment(self, change: Callable[[Scene, int], Scene], i: int) -> None:
        self._do(lambda scene: change(scene, i))

    def _do(self, change: Callable[[Scene], Scene]) -> None:
        self._say(self.edit(change, ""))

    def _material(self, path: Path, label: str, material: Material | None) -> None:
        names = {name: known.material for name, known in MATERIALS.items()}
        own = EMPTY if material is None else material_name(material)
        if material is not None and own not in names:
            names[own] = material
        options = [EMPTY, *names] if label != "material" else list(names)
        with ui.element("div").classes("cell broad"):
            chosen = ui.select(options, value=own, label=label).props("outlined dense options-dense")
            chosen.on_value_change(lambda event: self._do(lambda s: replaced(s, {path: names.get(event.value)})))

    def _switch_off(self, i: int, effect: Effect, event: Any) -> None:
        self.off[type(effect).__name__] = effect
        self._do(lambda scene: editing.without_effect(scene, i))

    def _switch_on(self, name: str, event: Any) -> None:
        def change(scene: Scene) -> Scene:
            return editing.with_effect(scene, self.off.get(name) or editing.new_effect(scene, name))

        words = self.edit(change, "")
        self._say(words)
        if words:
            event.sender.set_value(False)
