"""The controls on the page: a row each, in groups."""

from __future__ import annotations

import math
import re
from typing import Any

from nicegui import ui

from cuefem.designer.controls import (
    GROUPS,
    KNOBS,
    NONE,
    UNITLESS,
    alike,
    label,
    limits,
    options,
    parse,
    range_of,
    value,
    value_text,
    with_unit,
)
from cuefem.designer.host import Host
from cuefem.designer.state import FAILURES, Design, one_line
from cuefem.scene import Scene


class KnobRow:
    """A control on the page: label, slider or note, field or list, and its error.

    short: in the list of assumptions. It is empty until `show` is called.
    """

    def __init__(self, key: str, page: Host, *, short: bool = False) -> None:
        self.key, self.page, self.session, self.short = key, page, page.session, short
        self.knob, self.shown = KNOBS[key], ""
        self.slider: Any = None
        with ui.element("div").classes("knob").props(f'data-knob="{key}"') as self.root:
            self.label = ui.label().classes("name")
            self.note = ui.label().classes("note")
            if self.knob.range is None:
                self.root.classes("pick")
                self.field: Any = ui.select([], on_change=self._on_choice).props("outlined dense options-dense")
            else:
                if self.knob.range.high and not short:
                    self.slider = ui.element("input").classes("slide").props("type=range")
                    self.slider.on("input", self._slid, throttle=0.05, js_handler="(e) => emit(e.target.valueAsNumber)")
                    self.slider.on("keydown.ctrl.z", lambda: self._undo_redo(-1))
                    self.slider.on("keydown.ctrl.y", lambda: self._undo_redo(1))
                self.field = ui.input().props("outlined dense autocomplete=off").classes("number")
                self.field.on("keydown.enter", lambda: self._on_input(entered=True)).on("blur", self._on_input)
            self.error = ui.label().classes("error").props("role=alert")

    def show(self) -> None:
        """Show the design's value, the other design's, and no error."""
        design, other = self.session.step.design, self.session.step.other
        mine = value(self.key, design.scene)
        self.root.set_visibility(mine is not None)
        self._fail("")
        if mine is None:
            return
        name = label(self.key, design.scene)
        self.label.set_text(name)
        _classes(self.field, "assumed", self.key in design.assumed)
        self.shown = self._text(design, mine)
        beside = None if other is None else value(self.key, other.design.scene)
        if self.knob.range is None:
            offered = options(self.key, design.scene)
            if self.field.options != offered:
                self.field.set_options(offered, value=mine)
            self.field.set_value(mine)
        else:
            self.field.set_value(self.shown)
            if self.key == "shaft_mass":
                self.field.props(f'placeholder="{"not weighed" if self.short else "weigh it"}"')
        _set_accessible_name(self.field, name)
        if self.slider is not None:
            self._place(name, mine, beside, design.scene)
        same = other is None or alike(mine, beside)
        self.note.set_text("" if self.short else self._note(design, mine, mine if same else beside))
        _classes(self.note, "other", not same)

    def _text(self, design: Design, mine: Any) -> str:
        if self.knob.range is None:
            return str(mine)
        if self.key == "shaft_mass" and not design.scene.shaft.shaft_mass_measured:
            return ""
        return design.typed.get(self.key) or value_text(self.key, mine)

    def _note(self, design: Design, mine: Any, beside: Any) -> str:
        """The note below the label: the weight, or a typed value in mm or g; and the other design's, if it differs."""
        own, there = (
            NONE if each is None else f"{each}" if self.knob.range is None else value_text(self.key, each)
            for each in (mine, beside)
        )
        plain = not self.knob.range or (not self.knob.range.unit and bool(UNITLESS.fullmatch(self.shown)))
        note = f"= {own}" if self.key in design.typed and self.shown != own and not plain else ""
        if self.key == "shaft_mass":
            note = f"{'now' if design.scene.shaft.shaft_mass_measured else 'computed'} {own}"
        parts = [note, there] if beside != mine else [note]
        text = ", other ".join(filter(None, parts))
        return text if self.knob.range is None else re.sub(r"(?<=\d) ", "\u00a0", text)

    def _place(self, name: str, mine: float, beside: float | None, scene: Scene) -> None:
        known = range_of(self.key)
        least, most, _ = limits(self.key, scene)
        low, high = max(known.low, known.scale * least), min(known.high, known.scale * most)
        low, high = (
            known.step * f(end / known.step + e) for f, end, e in ((math.ceil, low, -1e-6), (math.floor, high, 1e-6))
        )
        at = round(known.scale * mine, 9)
        first, last = (round(end, 9) for end in (min(low, at), max(high, at)))
        spans = {"low": at, "tick": None if beside is None else known.scale * beside}
        shares = {name: (end - first) / ((last - first) or 1.0) for name, end in spans.items() if end is not None}
        style = f"--at: {shares['low']:.4f}; --tick: {shares.get('tick', -1):.4f}"
        wanted = {
            "min": first,
            "max": last,
            "step": known.step,
            "value": at,
            "style": style,
            "aria-label": f"{name}, slider",
        }
        wanted["aria-valuetext"] = value_text(self.key, mine)
        if any(self.slider.props.get(key) != own for key, own in wanted.items()):
            self.slider.props.update(wanted)
            self.slider.update()

    def _set(self, new: Any, text: str = "", *, slid: bool = False) -> None:
        try:
            self.session.set_knob(self.key, new, text, slid=slid)
        except FAILURES as error:
            self._fail(one_line(error))
            return
        self.page.refresh()

    def _undo_redo(self, steps: int) -> None:
        self.session.undo_redo(steps)
        self.page.refresh()

    def _fail(self, words: str) -> None:
        self.error.set_text(words)
        self.error.set_visibility(bool(words))
        _classes(self.field, "wrong", bool(words))

    def _on_choice(self, event: Any) -> None:
        if event.value is not None and event.value != value(self.key, self.session.step.design.scene):
            self._set(event.value)

    def _slid(self, event: Any) -> None:
        scene = self.session.step.design.scene
        mine, known = value(self.key, scene), range_of(self.key)
        at = event.args
        if mine is not None and isinstance(at, int | float) and abs(at - known.scale * mine) > 1e-9 * known.step:
            self._set(float(f"{at / known.scale:.12g}"), slid=True)

    def _on_input(self, *_: Any, entered: bool = False) -> None:
        text, scene = str(self.field.value or "").strip(), self.session.step.design.scene
        if text == self.shown and not (entered and self.key in self.session.step.design.assumed):
            self._fail("")
            return
        if not text and self.key == "shaft_mass":
            return
        try:
            last = self.session.step.design.typed.get(self.key, "")
            new, text = parse(self.key, text, scene, last), with_unit(self.key, text, last)
        except FAILURES as error:
            words = one_line(error)
            self._fail(f"{label(self.key, scene)} {words}" if words.startswith("must ") else words)
            return
        self._set(new, text)


class ControlsCard:
    """All controls, in groups of which one is open."""

    def __init__(self, page: Host) -> None:
        self.session = page.session
        self.rows: list[KnobRow] = []
        self.folds: dict[str, Any] = {}
        for i, group in enumerate(GROUPS):
            with ui.expansion(group, value=i == 0, group="knobs").classes("group") as fold:
                fold.props["toggle-aria-label"] = ""  # its name is its text
                self.folds[group] = fold
                self.rows += [KnobRow(key, page) for key, knob in KNOBS.items() if knob.group == group]
        ui.html(
            '<p class="mark-key soft"><i></i>assumed. Fields take any unit: 6 mm, 1/4 in, 15 oz.</p>', sanitize=False
        )

    def show(self) -> None:
        """Show the values of the design, and a summary of each group."""
        for row in self.rows:
            row.show()
        for group, words in self.session.captions().items():
            self.folds[group].props(f'caption="{words}"')


def _classes(element: Any, name: str, on: bool) -> None:
    element.classes(**{"add" if on else "remove": name})


def _set_accessible_name(element: Any, name: str) -> None:
    element.props(f'aria-label="{name}"')
