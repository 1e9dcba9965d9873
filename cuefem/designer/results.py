"""The results' side of the page: it shows what is known, and what is still computed."""

from __future__ import annotations

from collections.abc import Sequence

from nicegui import ui

from cuefem.designer import numbers_panel, pictures
from cuefem.designer.answers import CURVE_OFFSETS, Answers
from cuefem.designer.computing import Results
from cuefem.designer.design import Design
from cuefem.designer.markup import Markup
from cuefem.designer.numbers_panel import Column
from cuefem.designer.pictures import Drawn
from cuefem.designer.unit_system import UnitSystem
from cuefem.designer.words import ABOUT
from cuefem.report.glossary import explained


class ResultsSide:
    """The parts that show results. before: the last design with all of its key numbers."""

    def __init__(self) -> None:
        self.before: Answers | None = None
        with ui.element("section").classes("key-strip"):
            self.keys = Markup()
        with ui.element("div").classes("rest"):
            with ui.element("section"):
                self.verdict = Markup()
            self.trust = Markup().classes("trust")
            self.below_verdict = ui.element("div")
            with ui.element("section"):
                Markup("<h2>The cue</h2>")
                self.cue = Markup()
                self.below_cue = ui.element("div")
            self.charts = self._section("Squirt and pivot length against the offset")
            with ui.element("div").classes("grid2"):
                self.lives = self._section("Where end mass lives")
                with ui.element("section"):
                    Markup("<h2>How it rings</h2>")
                    self.shapes = Markup()
                    self.tones = Markup()
            with ui.element("section"):
                Markup("<h2>All numbers</h2>")
                self.above_table = ui.element("div")
                self.table = Markup()
            Markup(explained(ABOUT))

    def _section(self, title: str) -> Markup:
        with ui.element("section"):
            Markup(f"<h2>{title}</h2>")
            return Markup()

    def show_numbers(self, columns: Sequence[Column], reference: int, system: UnitSystem) -> None:
        """The numbers of the first design that matter most, beside the one compared with."""
        answers, other = columns[0].answers, columns[reference].answers
        if answers is None:
            return
        keys = numbers_panel.key_markup(answers, other if reference else None, system, self.before)
        self.keys.set_content(explained(keys))
        if answers.verdict:
            self.verdict.set_content(explained(system.said(numbers_panel.verdict_markup(answers))))
        self.verdict.set_stale(not answers.verdict)
        self.table.set_stale(True)
        if answers.has_end_mass:
            self.before = answers

    def show_table(self, columns: Sequence[Column], reference: int, system: UnitSystem) -> None:
        """All numbers of the first design beside the others', and how it rings."""
        answers = columns[0].answers
        if answers is None or not answers.has_end_mass:
            return
        self.tones.set_content(numbers_panel.tones_markup(answers.frequencies.tolist()))
        self.shapes.set_content(pictures.shapes_picture(answers, system))
        self.table.set_content(explained(numbers_panel.table_markup(columns, reference, system)))
        self.table.set_stale(False)

    def show_cue(self, mine: Results, system: UnitSystem) -> None:
        """The cue."""
        self.cue.set_content(pictures.cue_pictures(mine.answers.scene, system))
        self.trust.set_content(explained(numbers_panel.trust_markup(mine.answers.scene)))

    def show_charts(
        self, mine: Results, before: Results | None, pinned: Sequence[tuple[Design, Results | None]], system: UnitSystem
    ) -> None:
        """The curves against the offset. before: of the design before, until the first point of this one is known."""
        current = bool(mine.points)
        shown = mine if current or before is None else before
        spans, said = pictures.limits_of(mine.points)
        drawn = [
            Drawn(d.name, answers.coupled if answers else None, answers.density if answers else None)
            for d, answers in pinned
        ]
        markup = pictures.offset_charts(
            mine.answers, shown.coupled, drawn, current=current, limits=spans, system=system
        )
        waiting = sum(answers is None or not answers.whole for _, answers in pinned)
        words = [said, f"Still computing {waiting} of the pinned designs." if waiting else ""]
        if not mine.whole:
            words = [f"Computing the coupled curve: {len(mine.points)} of {len(CURVE_OFFSETS)} offsets.", *words]
        lines = "".join(f"<p>{line}</p>" for line in words if line)
        under = f'<div class="under" aria-live="off">{lines}</div>'
        self.charts.set_content(explained(markup + under))

    def show_density(
        self, mine: Results, before: Results | None, pinned: Sequence[tuple[Design, Results | None]], system: UnitSystem
    ) -> None:
        """Where end mass lives."""
        current = mine.density is not None
        shown = mine if current or before is None else before
        if shown.density is not None:
            drawn = [Drawn(d.name, None, answers.density if answers else None) for d, answers in pinned]
            self.lives.set_content(explained(pictures.density_chart(shown.density, drawn, system)))
        self.lives.set_stale(not current)
