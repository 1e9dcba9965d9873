"""The first screen of the page: headline, comparison, five numbers, drawings and assumptions."""

from __future__ import annotations

from typing import Any

from nicegui import ui

from cuefem.analysis.first_screen import (
    comparison_lines,
    cue_names,
    drawings_markup,
    headline_markup,
    parts_line,
    scale_markup,
    tiles_markup,
)
from cuefem.designer.header import Upload
from cuefem.designer.host import Host
from cuefem.designer.knob_row import KnobRow
from cuefem.designer.session import FILE, NOTHING
from cuefem.files.defaults_report import Assumption
from cuefem.show.glossary import with_term_buttons


class FirstScreen:
    """The card with the result.

    upload: takes the file of a design to compare with. The card is dimmed until its numbers belong to the design.
    """

    def __init__(self, page: Host, card: Any, upload: Upload) -> None:
        self.page, self.session, self.card, self.upload = page, page.session, card, upload
        self.rows: list[KnobRow] = []
        self.listed = self._assumptions()  # that are on the page
        self.had_verdict = False
        ui.element("div").classes("progress").props("aria-hidden=true")
        with ui.element("div").classes("top"):
            self.headline = ui.html(sanitize=False).classes("num")
            with ui.element("div"):
                with ui.element("div").classes("compare"):
                    ui.label("Compare with").classes("soft")
                    self.compare = ui.select([NOTHING], value=NOTHING, on_change=self._on_compare)
                    self.compare.props('outlined dense options-dense aria-label="Compare with"')
                    self.swap = ui.button("Swap", on_click=lambda: page.attempt(self.session.swap))
                    self.swap.props("outline dense no-caps")
                self.scale = ui.html(sanitize=False).classes("num")
        self.tiles = ui.html(sanitize=False).classes("num")
        with ui.element("div").classes("calibration") as self.calibration:
            self.basis = ui.label().classes("soft")
            save = ui.button("Save calibration", on_click=self._save_calibration)
            save.props("outline dense no-caps")
            remove = ui.button("Remove calibration", on_click=lambda: page.attempt(self.session.calibrate, None))
            remove.props("outline dense no-caps")
        self.drawing = ui.html(sanitize=False)
        with ui.expansion(on_value_change=lambda: self.assumptions.refresh()).classes("assumptions") as self.fold:
            self.fold.props["toggle-aria-label"] = ""  # its name is its text
            self.assumptions()
        self.printed = ui.label().classes("printed soft")

    @ui.refreshable_method
    def assumptions(self) -> None:
        """The assumptions, one line each, with the control that changes it."""
        self.rows = []
        if not self.fold.value:
            return
        parts = self.session.uncertainty_parts()
        for key in sorted(self.session.assumed(), key=lambda key: -parts.get(key, 0.0)):
            with ui.element("div").classes("assumption"):
                self.rows.append(KnobRow(key, self.page, short=True))
                self.rows[-1].show()
                ui.label(f"part of ±: {100 * parts[key]:.0f} %" if key in parts else "not in ±").classes("soft")
        for note in self.session.notes():
            ui.label(str(note)).classes("soft")

    def show(self) -> None:
        """Show the designs at once: drawings, assumptions, and the choice of the other one."""
        if self.listed != (listed := self._assumptions()):
            self.listed = listed
            self.assumptions.refresh()
        for row in self.rows:
            row.show()
        shown = (self.session.compare_choices(), self.session.compared)
        if (self.compare.options, self.compare.value) != shown:
            self.compare.set_options(shown[0], value=shown[1])
        self.calibration.set_visibility(self.session.history.calibration is not None)
        self.swap.set_visibility(self.session.step.other is not None)
        self.drawing.set_content(
            drawings_markup({name: design.scene for name, design in self.session.designs().items()})
        )

    def set_stale(self) -> None:
        """Mark the numbers as those of another design."""
        self.card.classes(add="stale")

    def show_results(self) -> None:
        """Show the results computed so far."""
        results = self.session.results
        own, other = self.session.headline_cue(0), self.session.headline_cue(1)
        if own is None:
            return
        if "numbers" in results.own:
            self.card.classes(remove="stale")
        others = [*filter(None, [other])]
        names = cue_names(own, others)
        lines = comparison_lines(own, other, results.difference)
        headline = headline_markup(own, lines, self.session.warning(), with_name=bool(others))
        self.headline.set_content(with_term_buttons(headline, names))
        self.scale.set_content(scale_markup(own, others))
        self.tiles.set_content(with_term_buttons(tiles_markup(own, others), names))
        self.basis.set_text(" ".join(self.session.calibration_lines()))
        assumed = self.session.assumptions()
        self.printed.set_text("; ".join(map(str, assumed)))
        words = f"{len(assumed)} assumption{'s' if len(assumed) != 1 else ''}"
        parts = parts_line(own.verdict) if own.verdict else ""
        self.fold.props(f'label="{words}" caption="{parts}"')
        has_verdict = "verdict" in results.own
        if has_verdict and not self.had_verdict:
            self.assumptions.refresh()
        self.had_verdict = has_verdict

    def _assumptions(self) -> tuple[list[str], list[Assumption]]:
        return self.session.assumed(), self.session.notes()

    def _save_calibration(self) -> None:
        ui.download.content(*self.session.calibration_file())

    def _on_compare(self, event: Any) -> None:
        if event.value == self.session.compared:
            return
        if event.value == FILE:
            self.upload.pick(self.session.compare_with_file)
            self.show()
        else:
            self.page.attempt(self.session.compare_with, event.value)
