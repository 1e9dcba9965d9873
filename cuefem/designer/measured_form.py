"""The form "I measured": shots with the cue on the page, which calibrate its squirt and that of the next shaft."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from nicegui import ui

from cuefem.designer.host import Host
from cuefem.designer.in_thread import run_in_thread
from cuefem.designer.state import FAILURES, one_line
from cuefem.files.schema import build
from cuefem.measurements.shot import ADVICE, Shot


class FormField(NamedTuple):
    """A field: its label, an example, and what is assumed without it."""

    label: str
    example: str
    without: str = ""


OFFSETS = {
    "cue_offset": FormField("Cue's centre line from the ball's centre", "14.3 mm", "or the chalk mark"),
    "chalk_mark": FormField("Chalk mark from the ball's centre", "10.7 mm", "or the cue's centre line"),
}
READING = {
    "left": FormField("Ball off the line, struck left", "1.6 in"),
    "right": FormField("Ball off the line, struck right", "1.5 in"),
    "distance": FormField("Distance where you read it", "3 ft"),
    "speed": FormField("Speed of the cue", "3.5 m/s", "0.9 of the ball's; without it the stroke's ± 50 %"),
}
STANCE = {
    "elevation": FormField("Elevation of the cue", "2 deg", "without it 1.8 to 4.9° are assumed"),
    "elevation_error": FormField("Error of the elevation", "0.5 deg", "without it 1°"),
}
FORM = "I measured"  # names the form in messages


def shots_of(texts: Mapping[str, str], second: Mapping[str, str]) -> tuple[Shot, ...]:
    """The shots of what was typed, and those at a second speed or distance; InputError for invalid ones."""
    shared = {name: text for name, text in texts.items() if name not in READING}
    rows = [dict(texts)] if not any(second.values()) else [dict(texts), shared | dict(second)]
    typed = [{name: text.strip() for name, text in row.items() if text.strip()} for row in rows]
    return tuple(build(Shot, row, file=FORM, key="") for row in typed)


class MeasuredForm:
    """The dialog with its fields."""

    def __init__(self, page: Host) -> None:
        self.page = page
        with ui.dialog().props(f'aria-label="{FORM}"') as self.dialog, ui.card().classes("form"):
            ui.html(f"<h2>{FORM}</h2>", sanitize=False)
            ui.label("Shots with the cue on this page calibrate its squirt, and that of the next shaft with this tip.")
            ui.label(ADVICE).classes("soft")
            with ui.element("div").classes("fields"):
                self.first = _inputs(OFFSETS | READING | STANCE)
            with ui.expansion("The same at a second speed or distance"), ui.element("div").classes("fields"):
                self.second = _inputs(READING)
            self.error = ui.label().classes("error").props("role=alert")
            self.error.set_visibility(False)
            with ui.element("div").classes("line"):
                ui.label("Both sides count away from the struck side, as the mean of your shots.").classes("soft")
                ui.button("Close", on_click=self.dialog.close).props("outline dense no-caps")
                self.button = ui.button("Calibrate", on_click=self._calibrate).props("outline dense no-caps")

    def open(self) -> None:
        """Show the form with what was typed before."""
        self.dialog.open()

    async def _calibrate(self) -> None:
        """Estimate, and calibrate the page at once."""
        self._show_error("")
        self.button.disable()
        try:
            texts, second = ({name: str(field.value or "") for name, field in side.items()} for side in self._sides)
            shots = shots_of(texts, second)
            made = await run_in_thread(self.page.session.calibration_call(shots))
        except FAILURES as error:
            self._show_error(one_line(error))
            return
        finally:
            self.button.enable()
        self.dialog.close()
        self.page.attempt(self.page.session.calibrate, made)

    @property
    def _sides(self) -> tuple[dict[str, Any], dict[str, Any]]:
        return self.first, self.second

    def _show_error(self, words: str) -> None:
        self.error.set_text(words)
        self.error.set_visibility(bool(words))


def _inputs(entries: Mapping[str, FormField]) -> dict[str, Any]:
    """The fields of some entries."""
    fields = {}
    for name, entry in entries.items():
        field = ui.input(entry.label, placeholder=entry.example)
        hint = f" hint={entry.without!r}" if entry.without else ""
        fields[name] = field.props(f"outlined dense stack-label{hint}")
    return fields
