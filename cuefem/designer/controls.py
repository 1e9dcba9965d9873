"""The page's controls: a number that is slid or typed, and a choice; each says beside itself what is wrong."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import Any

from nicegui import events, ui

from cuefem.designer.markup import Markup
from cuefem.designer.sliders import Choice, Slider
from cuefem.designer.unit_system import typed
from cuefem.report.glossary import explained

Turn = Callable[[float], str]


class Beside:
    """The place beside a field where it says what is wrong; html: an element for it, if that is in a dialog."""

    def __init__(self, html: ui.html | None = None) -> None:
        self.html = (html or Markup()).classes("beside")

    def say(self, words: str) -> None:
        """Say what is wrong, or that nothing is."""
        self.html.set_content(f'<p class="wrong" role="alert">{escape(words)}</p>' if words else "")


class Bar(ui.slider):
    """A slider that stands where the person moves it. The server's answer, which may be late, never moves it back."""

    LOOPBACK = None  # what the person does is not sent back
    # The page remembers the value, so that it sees a change when another one is sent, and draws nothing anew for it.
    REMEMBER = "value => { Vue.toRaw(mounted_app.elements)[%d].props['model-value'] = value; }"

    def __init__(self, slider: Slider, value: float, slid: Callable[..., None]) -> None:
        super().__init__(min=slider.low, max=slider.high, step=slider.step, value=value, on_change=slid)
        self.on("update:model-value", js_handler=self.REMEMBER % self.id)


class NumberField:
    """A number to slide or to type. turn: takes a value in its unit, and returns what is wrong with it, or "".

    A typed number is taken as it is typed, in bounds wider than the slider's; a wrong one changes nothing. The bar
    follows a typed number, and the text a slid one, when they are told to agree: after the answer to the move.
    """

    def __init__(self, slider: Slider, value: float, turn: Turn) -> None:
        self.slider, self.value, self.good, self.turn = slider, value, value, turn
        self.text, self.slid = slider.text(value), False
        with ui.element("div").classes("knob"):
            with ui.element("div").classes("line"):
                self.label = Markup()
                self.input = ui.input(value=self.text, on_change=self._typed)
                self.input.props(
                    f'dense borderless hide-bottom-space debounce=200 suffix="{slider.unit}" inputmode=decimal '
                    "autocomplete=off"
                )
            self.bar = Bar(slider, value, self._slid)
            self.bar.props(f'role="none" data-knob="{slider.knob}"')
            self.beside = Beside()
        self.named = ""
        self.name(slider.label)

    def name(self, label: str) -> None:
        """Have this label: a knob's may tell where on the cue it is."""
        if label != self.named:
            self.named = label
            hint = f' title="{escape(self.slider.hint)}"' if self.slider.hint else ""
            self.label.set_content(f"<span{hint}>{explained(escape(label))}</span>")
            spoken = f"{label}, {self.slider.unit}" if self.slider.unit else label
            self.input.props(f'aria-label="{spoken}, as a number"')
            self.bar.props(f'aria-label="{spoken}"')

    def show(self, value: float) -> None:
        """Stand at a value, silently."""
        self.value = self.good = value
        self._set_bar(value)
        self._set_text(value)
        self._mark("")

    def _typed(self, event: events.ValueChangeEventArguments[Any]) -> None:
        text = str(event.value or "")
        if text == self.text:
            return
        self.text = text
        try:
            value = typed(text, self.slider.unit)
            self.slider.check(value)
        except ValueError as error:
            self._mark(f"{error}; the design keeps {self.slider.written(self.good)}")
            return
        self.value, self.slid = value, False
        self._give()

    def _slid(self, event: events.ValueChangeEventArguments[Any]) -> None:
        value = float(event.value)
        if value != self.value:
            self.value, self.slid = value, True
            self._give()

    def agree(self) -> None:
        """Let the bar and the text stand at the value."""
        if self.slid:
            self._set_text(self.value)
        else:
            self._set_bar(self.value)

    def _give(self) -> None:
        words = self.turn(self.value)
        if not words:
            self.good = self.value
        self._mark(words and f"{words}; the design keeps {self.slider.written(self.good)}")

    def _set_bar(self, value: float) -> None:
        wide = self.slider.reaching(value)
        if wide != self.slider:
            self.slider = wide
            self.bar.props(f"min={wide.low} max={wide.high}")
        self.bar.set_value(value)

    def _set_text(self, value: float) -> None:
        self.text = self.slider.text(value)
        self.input.set_value(self.text)

    def _mark(self, words: str) -> None:
        self.beside.say(words)
        self.input.props("error aria-invalid=true" if words else "", remove="" if words else "error aria-invalid")


class ChoiceField:
    """A material to choose. turn: takes it, and returns what is wrong with it, or ""."""

    def __init__(self, choice: Choice, name: str, turn: Callable[[Any], str]) -> None:
        self.choice, self.turn = choice, turn
        self.select = ui.select(list(choice.materials), value=name, label=choice.label, on_change=self._chosen)
        self.select.props(f'outlined dense data-knob="{choice.knob}"').classes("choice")
        self.beside = Beside()

    def show(self, name: str) -> None:
        """Stand at a material, silently."""
        self.select.set_value(name)
        self.beside.say("")

    def _chosen(self, event: events.ValueChangeEventArguments[Any]) -> None:
        self.beside.say(self.turn(self.choice.materials[event.value]))


def button(words: str, action: Callable[..., Any]) -> ui.button:
    """A button."""
    return ui.button(words, on_click=action, color=None).props("outline no-caps dense padding='0.25rem 0.8rem'")
