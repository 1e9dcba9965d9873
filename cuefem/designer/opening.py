"""Ways to begin: ready cues, files, and what the page asks where a file holds a shape alone."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from nicegui import ui

from cuefem.cue import Cue
from cuefem.cue.materials import MATERIALS, material
from cuefem.designer.computing import FAILURES
from cuefem.designer.controls import Beside, button
from cuefem.designer.markup import Markup
from cuefem.designer.unit_system import UnitSystem, typed
from cuefem.io import load
from cuefem.io.fittings import FITTINGS, fitted
from cuefem.io.profile import DEFAULT_MATERIAL, SHAPES
from cuefem.io.ready import PRESETS, Preset, ready_cue
from cuefem.parameters.parameter import varied
from cuefem.parameters.parts import with_material
from cuefem.scene import Scene
from cuefem.scene.default_scene import DEFAULT_GAME, GAMES, usual_scene

TOLD = ("begins", "ferrule", "bore")  # of `FITTINGS`, what the page asks of a shape
_CUE = re.compile(r"""^\s*cue\s*=\s*["']([^"'\n]+)["']""", re.MULTILINE)


def asked(name: str) -> bool:
    """Whether a file of this name holds a shape alone, so that its material, weight and game are asked for."""
    return name.lower().endswith(SHAPES)


def reading(name: str, content: bytes, read: Callable[[Path], Any]) -> Any:
    """The cue of a shape's file; else scene and notes, as ``read`` makes them. ValueError in one line.

    A scene that names a ready cue finds it, wherever the scene lies.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder) / name
        try:
            path.write_bytes(_with_ready_cue(name, content, Path(folder)))
            return load(path) if asked(name) else read(path)
        except FAILURES as error:
            raise ValueError(" ".join(str(error).split()).replace(f"{folder}/", "")) from None


def _with_ready_cue(name: str, content: bytes, folder: Path) -> bytes:
    """The content of a scene, with the ready cue that it names beside it."""
    text = content.decode(errors="replace") if name.lower().endswith(".toml") else ""
    match = _CUE.search(text)
    ready = ready_cue(match[1]) if match and "meshes/" in match[1] else None
    if match is None or ready is None:
        return content
    beside = f"ready_{Path(match[1]).name}"
    (folder / beside).write_bytes(ready)
    return text.replace(match[0], f'cue = "{beside}"', 1).encode()


class PresetMenu:
    """The ready cues and scenes, each with what was measured on such cues."""

    def __init__(self, chosen: Callable[[Preset], None]) -> None:
        with button("Ready cues", lambda: None), ui.menu().props('aria-label="ready cues"'):
            for preset in PRESETS:
                with ui.menu_item(on_click=partial(chosen, preset)).classes("menu-item"):
                    measured = escape(preset.told)
                    Markup(f"<span>{escape(preset.name)}</span><small>{measured}</small>")


PER_UNIT = {"g": 1e-3, "oz": 28.349523125e-3}  # kg


class ShapeDialog:
    """Asks for what a shape cannot say: the weight of the rest, the material, the game."""

    def __init__(self, opened: Callable[[str, Scene, list[str]], None]) -> None:
        self.opened = opened
        self.name, self.unit = "", "g"
        self.cue: Cue | None = None
        self.scene: Scene | None = None  # whose cue is weighed; None for a shape that is opened
        self.notes: list[str] = []
        self.dialog = ui.dialog().props('aria-label="What the file does not say"')
        with self.dialog, ui.element("div").classes("dialog"):
            Markup("<h2>What the file does not say</h2>")
            self.facts = ui.html(sanitize=False)  # in a dialog, which may be closed
            self.weight = ui.input("Weight", value="").props("outlined dense inputmode=decimal autocomplete=off")
            self.which = ui.radio({"rest": "of the rest of the cue", "whole": "of the whole cue"}, value="whole")
            self.which.props("inline dense")
            self.shaft = ui.input("Weight of the shaft", value="").classes("wide-field")
            self.shaft.props("outlined dense inputmode=decimal autocomplete=off").tooltip(
                "With its tip, if you have a scale: it sets the density of the wood"
            )
            self.material = ui.select(list(MATERIALS), value=DEFAULT_MATERIAL, label="Material of the shaft")
            self.material.props("outlined dense").classes("wide-field")
            self.told = {name: ui.input(FITTINGS[name].title).classes("wide-field") for name in TOLD}
            for name, field in self.told.items():
                field.props(f'outlined dense stack-label autocomplete=off placeholder="{FITTINGS[name].example}"')
                field.tooltip(FITTINGS[name].help)
            self.game = ui.select(list(GAMES), value=DEFAULT_GAME, label="Game").classes("wide-field")
            self.game.props("outlined dense")
            self.beside = Beside(ui.html(sanitize=False))
            with ui.element("div").classes("actions"):
                button("Open it", self._open)
                button("Cancel", self.dialog.close)

    def ask(self, name: str, cue: Cue, system: UnitSystem) -> None:
        """Ask about a shape."""
        self.scene = None
        self._show(name, cue, system)

    def weigh(self, name: str, scene: Scene, notes: list[str], system: UnitSystem) -> None:
        """Ask for nothing but the weight of a scene's cue."""
        self.scene, self.notes = scene, notes
        self._show(name, scene.shaft, system)

    def _show(self, name: str, cue: Cue, system: UnitSystem) -> None:
        self.name, self.cue, self.unit = name, cue, system.units["kg"][1]
        for field in (self.material, self.game, *self.told.values()):
            field.set_visibility(self.scene is None)
        sizes = (system.length(size) for size in (cue.length, cue.segments[0].tip_diameter))
        self.facts.set_content(f"<p>{escape(name)}: {' long, tip '.join(sizes)} wide. How heavy is the cue?</p>")
        self.weight.props(f'label="Weight, {self.unit}"')
        self.weight.set_value("")
        self.shaft.props(f'label="Weight of the shaft with its tip, {self.unit}, if known"')
        self.shaft.set_value("")
        self.beside.say("")
        self.dialog.open()

    def _open(self) -> None:
        try:
            scene = self._scene()
        except FAILURES as error:
            self.beside.say(" ".join(str(error).split()))
            return
        self.dialog.close()
        if self.scene is not None:
            self.opened(self.name, scene, [note for note in self.notes if "--body-mass" not in note])
            return
        game = self.game.value
        self.opened(self.name, scene, [f"a usual stroke of {game}", f"e {GAMES[game].bounce}"])

    def _scene(self) -> Scene:
        assert self.cue is not None
        kilograms = self._kilograms(self.weight, "the weight")
        shaft = self._kilograms(self.shaft, "the weight of the shaft") if str(self.shaft.value).strip() else None
        if self.scene is not None:
            cue = self.cue
        else:
            told = {name: field.value.strip() or None for name, field in self.told.items()}
            wood = material(self.material.value)
            cue = fitted(with_material(self.cue, material(DEFAULT_MATERIAL), wood), **told)
        drawn = cue.shaft_mass if shaft is None else shaft
        rest = kilograms - (drawn if self.which.value == "whole" else 0.0)
        if rest < 0:
            least, got = (f"{mass / PER_UNIT[self.unit]:.4g} {self.unit}" for mass in (drawn, kilograms))
            raise ValueError(f"the whole cue must weigh more than its shaft, {least}; got {got}")
        whole = replace(cue, body_mass=float(f"{rest:.12g}"))
        scene = usual_scene(whole, self.game.value) if self.scene is None else replace(self.scene, cue=whole)
        return scene if shaft is None else varied(scene, {"shaft mass": shaft})

    def _kilograms(self, field: Any, name: str) -> float:
        """What a field says, kg; ValueError that names it."""
        try:
            return typed(str(field.value), self.unit) * PER_UNIT[self.unit]
        except ValueError as error:
            raise ValueError(f"{name} {error}") from None
