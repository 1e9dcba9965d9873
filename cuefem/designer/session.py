"""The session of a browser tab, without a browser: two designs, their history, and what is computed of them.

A change makes a step of the history. `plan` lists what a tab of the page needs then as named work in stages, the first
numbers first; `compute` does it at once.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple

from cuefem.analysis.first_screen import HeadlineCue
from cuefem.analysis.strike_models import regime_warning
from cuefem.analysis.verdict import with_cue
from cuefem.designer import computation
from cuefem.designer.controls import INPUTS, KNOBS, label, value, value_text, with_value
from cuefem.designer.state import (
    FAILURES,
    MAX_NAME,
    ComparedDesign,
    Design,
    Step,
    UndoHistory,
    one_line,
    reference_design,
)
from cuefem.files import today
from cuefem.files.cue_names import CUES
from cuefem.files.defaults_report import Assumption, ferrule_assumption, tenon_assumption
from cuefem.files.toml_writer import toml_text
from cuefem.measurements.calibration import Calibration
from cuefem.measurements.shot import Shot
from cuefem.parameters.scene_changes import with_parameters
from cuefem.parameters.scene_paths import parameter
from cuefem.quantity.display_units import with_unit
from cuefem.results.quantities import REGIMES
from cuefem.results.records import Record
from cuefem.results.verdict import verdict_problem
from cuefem.scene import Scene

if TYPE_CHECKING:  # loads scikit-fem, which the page's start need not
    from cuefem.analysis.model_error import ModelError

NOTHING, OPENED, NOW, FILE = "nothing", "as it was opened", "as it is now", "a file …"
OPTIONS = {"opened": OPENED, "now": NOW}
# What is computed of a design before its tabs, and for each tab: names of functions of `cuefem.designer.computation`.
FIRST = ("solved_strike", "numbers", "verdict")
OF_TAB = {"Curves": ("curve", "end_mass_distribution"), "Changes": ("changes",), "Report": ("answers",)}
OF_VERDICT = ("verdict", "changes")  # which need a squirt that can be reported
OF_CALIBRATION = ("verdict", "changes", "answers")  # which take a calibration
OF_FACTOR = ("numbers", "curve")  # which take its factor for the current design
SHARED = ("solved_strike", "numbers", "curve", "end_mass_distribution")  # also computed of the other design
OLD_NUMBERS = "The numbers are those of the previous design."


@dataclass
class Results:
    """Results of the current design ("own") and of the other one, by the names of the computation."""

    own: dict[str, Any] = field(default_factory=dict)
    other: dict[str, Any] = field(default_factory=dict)

    @property
    def difference(self) -> Record | None:
        """The difference of squirt of the two designs."""
        difference: Record | None = self.own.get("comparison", {}).get("squirt")
        return difference


class Work(NamedTuple):
    """A result to compute: its name, the results to which it belongs, and the call."""

    name: str
    side: dict[str, Any]
    call: Callable[[], Any]

    def store(self, result: Any) -> None:
        """Keep the result under its name."""
        self.side[self.name] = result


class Session:
    """The designs of a tab with their results, and every change of them."""

    def __init__(self, first: Design, calibration: Calibration | None = None) -> None:
        self.history = UndoHistory(first, calibration)
        self.results = Results()
        self.solid_of: Scene | None = None  # that was computed as a solid
        self.count: tuple[int, int] | None = None  # changes that are computed, of all

    @property
    def step(self) -> Step:
        """The two designs: the current one and the other one."""
        return self.history.now

    @property
    def scene(self) -> Scene:
        """The scene of the current design."""
        return self.step.design.scene

    # --- changes -----------------------------------------------------------------------------------

    def set_knob(self, key: str, new: Any, text: str = "", *, slid: bool = False) -> None:
        """Set a control to a value, typed as a text; ValueError if that design is invalid."""
        when, name = time.monotonic(), key if slid else ""
        base = self.history.slide_start(name, when)
        made = base.changed(with_value(base.scene, key, new), {key}, {key: text} if text else {})
        self._push(Step(made, self.step.other), name, when=when)

    def set_parameters(self, values: Mapping[str, Any]) -> None:
        """Set parameters by their names; ValueError if that design is invalid."""
        design = self.step.design
        keys = {known.key for name in values if (known := parameter(name))}
        self._push(Step(design.changed(with_parameters(design.scene, values), keys, {}), self.step.other))

    def apply(self, read: Design) -> None:
        """Take the scene of an edited file; its name and the assumptions of unchanged controls stay."""
        design = self.step.design
        new = {key for key in KNOBS if value(key, read.scene) != value(key, design.scene)}
        self._push(Step(design.changed(read.scene, new, {}), self.step.other))

    def rename(self, name: str) -> bool:
        """Give the design another name; whether it is another one."""
        name = name.strip()[:MAX_NAME]
        if not name or name == self.step.design.name:
            return False
        renamed = replace(self.step.design, name=name)
        self._push(Step(renamed, self.step.other), "name", when=time.monotonic())
        return True

    def open(self, design: Design) -> None:
        """Begin with a design from a file."""
        self.history.opened = design
        self._push(Step(design, self.step.other))

    def calibrate(self, calibration: Calibration | None) -> None:
        """Calibrate squirt by another shaft, or no longer; ValueError if it has another ball or tip."""
        if calibration is not None:
            calibration.check(self.scene)
        self.history.calibration = calibration

    def calibration_call(self, shots: Sequence[Shot]) -> Callable[[], Calibration]:
        """The calibration by shots with the current design; the call reads the session no more."""
        return partial(computation.calibration_by, self.step.design.name, self.scene, shots)

    def open_file(self, read: Design | Calibration) -> None:
        """Begin with a design from a file, or calibrate by one."""
        if isinstance(read, Calibration):
            self.calibrate(read)
        else:
            self.open(read)

    def open_reference(self, name: str) -> None:
        """Begin with the cue or scene of a name."""
        self.open(reference_design(name))

    def compare_with(self, choice: str) -> None:
        """Compare with one of `compare_choices`, but `FILE`, whose design `compare_with_file` takes."""
        design = self.step.design
        if choice == NOTHING:
            self._push(Step(design))
        elif choice in CUES:
            self._push(Step(design, ComparedDesign("reference", reference_design(choice))))
        else:
            kind = next(kind for kind, words in OPTIONS.items() if words == choice)
            self._push(Step(design, ComparedDesign(kind, self.history.opened if kind == "opened" else design)))

    def compare_with_file(self, design: Design | Calibration) -> None:
        """Compare with a design from a file; ValueError for a calibration."""
        if isinstance(design, Calibration):
            raise ValueError("a calibration is no design to compare with: Open it")
        self._push(Step(self.step.design, ComparedDesign("file", design)))

    def swap(self) -> None:
        """Exchange the two designs."""
        design, other = self.step
        if other is not None:
            self._push(Step(other.design, ComparedDesign("now" if other.kind in OPTIONS else "file", design)))

    def undo_redo(self, steps: int) -> bool:
        """Undo (-1) or redo (1); whether that step exists."""
        return self.history.move(steps)

    def _push(self, step: Step, label: str = "", *, when: float = 0.0) -> None:
        self.history.push(step, label, when=when)

    # --- texts -------------------------------------------------------------------------------------

    def assumed(self) -> list[str]:
        """The controls whose values are assumed."""
        return [key for key in KNOBS if key in self.step.design.assumed and value(key, self.scene) is not None]

    def notes(self) -> list[Assumption]:
        """Assumptions without a control."""
        drawn = [*ferrule_assumption(self.scene.shaft), *tenon_assumption(self.scene.shaft)]
        return [*self.step.design.notes, *(Assumption("", f"{each.text} (change it in File)") for each in drawn)]

    def assumptions(self) -> list[Assumption]:
        """All assumptions: the values of controls, and those without a control."""
        texts = {key: f"{label(key, self.scene)} {_text(key, self.scene)}" for key in self.assumed()}
        return [*(Assumption(key, text) for key, text in texts.items()), *self.notes()]

    def uncertainty_parts(self) -> dict[str, float]:
        """Relative uncertainty of squirt by each control's parameters."""
        inputs = self.results.own["verdict"].inputs if "verdict" in self.results.own else {}
        parts = {key: sum(inputs.get(name, 0.0) ** 2 for name in INPUTS.get(key, (key,))) ** 0.5 for key in KNOBS}
        return {key: part for key, part in parts.items() if part}

    def captions(self) -> dict[str, str]:
        """A summary of each group of controls, as HTML."""
        scene = self.scene
        return {
            "Shaft": f"length {with_unit(scene.shaft.length, 'm', decimals=1)}",
            "Tip": f"{value('leather', scene) or 'a spring'}, {_texts(scene, 'tip_height', 'dome')}",
            "Stroke": f"{value('game', scene)}, {_texts(scene, 'speed', 'offset')}",
        }

    @property
    def compared(self) -> str:
        """The choice of the other design."""
        other = self.step.other
        return NOTHING if other is None else OPTIONS.get(other.kind, other.design.name)

    def compare_choices(self) -> list[str]:
        """What the design can be compared with, including what it is compared with."""
        offered = [NOTHING, *OPTIONS.values(), *CUES, FILE]
        return offered if self.compared in offered else [self.compared, *offered]

    def designs(self) -> dict[str, Design]:
        """The displayed designs, by distinct names."""
        mine, other = self.step
        if other is None:
            return {mine.name: mine}
        name = other.design.name
        return {mine.name: mine, name if name != mine.name else f"{name} before": other.design}

    # --- files -------------------------------------------------------------------------------------

    def file(self) -> str:
        """The scene as the text of a file."""
        return toml_text(self.scene)

    def file_name(self, extension: str) -> str:
        """The design's name as a file name."""
        return f"{_file_stem(self.step.design.name)}.{extension}"

    def calibration_file(self) -> tuple[str, str]:
        """The text of the calibration's file, and its name."""
        made = self.history.calibration
        assert made is not None
        return made.text(), f"{_file_stem(made.name)} calibration.toml"

    def report_call(self) -> Callable[[], str]:
        """The report of the design as a page, compared with the other one; the call reads the session no more."""
        design, notes, other = self.step.design, self.assumptions(), self.compared_scene()
        beside = None if other is None else ([*self.designs()][1], other)
        calibration = self.calibration_of_tip()
        answers = partial(computation.answers, design.scene, calibration)
        return lambda: replace(answers(), other=beside).to_html(design.name, notes, made=today())

    # --- results -----------------------------------------------------------------------------------

    def compared_scene(self) -> Scene | None:
        """The other design with this one's ball and stroke; a reference cue with this tip too."""
        other = self.step.other
        if other is None:
            return None
        if other.kind == "reference":
            return with_cue(self.scene, other.design.scene.shaft)
        return computation.with_stroke_of(self.scene, other.design.scene)

    def calibration_of_tip(self) -> Calibration | None:
        """The calibration, unless it is of another ball or tip than the design's."""
        calibration = self.history.calibration
        with suppress(ValueError):
            if calibration is not None:
                calibration.check(self.scene)
                return calibration
        return None

    def calibration_lines(self) -> list[str]:
        """What the calibrated squirt rests on, and warnings; or why the calibration does not apply."""
        if self.history.calibration is None:
            return []
        calibrated = self.results.own["verdict"].calibrated if "verdict" in self.results.own else None
        if calibrated is not None:
            return [calibrated.basis(), *calibrated.warning_lines()]
        try:
            self.history.calibration.check(self.scene)
        except ValueError as error:
            return [f"not calibrated: {one_line(error)}"]
        return []

    def waits_for_tip(self) -> bool:
        """Whether the table of a tip must be computed first, which takes a while."""
        scenes = [self.scene, *filter(None, [self.compared_scene()])]
        return not all(scene.tip_is_cached for scene in scenes)

    def plan(self, tab: str, results: Results) -> Iterator[tuple[Work, ...]]:
        """The stages of what is computed of the displayed designs for a tab.

        results: where the work is stored. A stage follows from the results of those before it; nothing follows from a
        strike that failed.
        """
        scene, other = self.scene, self.compared_scene()
        self.count = None
        same_shaft = self.step.other is not None and self.step.other.kind in OPTIONS
        for name in (*FIRST, *OF_TAB.get(tab, ())):
            if name in OF_VERDICT and verdict_problem(scene, results.own["solved_strike"].outcome):
                continue
            call = getattr(computation, name)
            more = self._calibration_of(name)
            work: Callable[[], Any] = partial(call, scene, *more)
            if name == "changes":
                work = partial(computation.with_count, self._count, work)
            stage = [Work(name, results.own, work)]
            if other is not None and name in SHARED:
                stage.append(Work(name, results.other, partial(call, other, *more)))
            if name == "verdict" and other is not None and "solved_strike" in results.other:
                stage.append(Work("comparison", results.own, partial(computation.comparison, scene, other, same_shaft)))
            yield tuple(stage)
            if "solved_strike" not in results.own:
                return

    def _calibration_of(self, name: str) -> list[Any]:
        """What a function of the computation takes of the calibration."""
        calibration = self.calibration_of_tip()
        if name in OF_FACTOR:
            return [calibration and computation.SquirtFactor(calibration, self.scene)]
        return [calibration] if name in OF_CALIBRATION else []

    def _count(self, done: int, of: int) -> None:
        self.count = done, of

    def compute(self, tab: str = "Curves") -> list[str]:
        """Compute and take what a tab shows; the messages of what failed."""
        results, failures = Results(), list[str]()
        for stage in self.plan(tab, results):
            for work in stage:
                try:
                    work.store(work.call())
                except FAILURES as error:
                    failures.append(one_line(error))
            if "solved_strike" in results.own:
                self.take(results)
        return failures

    def take(self, results: Results) -> None:
        """Show these results from now on; a solid that was computed of this scene stays."""
        solid = self.results.own.get("solid") if self.solid_of == self.scene else None
        self.results = Results(dict(results.own), dict(results.other))
        if solid is not None:
            self.results.own["solid"] = solid

    def take_solid(self, scene: Scene, solid: ModelError) -> None:
        """Show a scene as a solid, unless the design has changed since."""
        if scene == self.scene:
            self.solid_of, self.results.own["solid"] = scene, solid

    def headline_cue(self, i: int) -> HeadlineCue | None:
        """The design (0) or the other one (1) on the first screen; None until its squirt is computed."""
        side = (self.results.own, self.results.other)[i]
        first = "solved_strike" if self.calibration_of_tip() is None else "numbers"
        if first not in side or i >= len(self.designs()):
            return None
        name, design = [*self.designs().items()][i]
        scene = self.scene if i == 0 else self.compared_scene()
        assert scene is not None
        numbers: dict[str, Any] = side.get("numbers") or computation.first_numbers(scene)
        if "frequencies" in numbers:
            numbers = numbers | {"frequency_1": numbers["frequencies"][0]}
        return HeadlineCue(name, design.scene, numbers, side.get("verdict"))

    def warning(self) -> str:
        """What is wrong with the strike, or makes a verdict on it impossible."""
        outcome = self.results.own["solved_strike"].outcome
        return REGIMES[outcome.regime] if regime_warning(outcome.regime) else verdict_problem(self.scene, outcome)


def _text(key: str, scene: Scene) -> str:
    own = value(key, scene)
    return str(own) if KNOBS[key].range is None else value_text(key, own)


def _texts(scene: Scene, *keys: str) -> str:
    return ", ".join(escape(value_text(key, own)) for key in keys if (own := value(key, scene)) is not None)


def _file_stem(name: str) -> str:
    """A name as a file name without extension."""
    stem = "".join(c if c.isalnum() or c in " -_." else "_" for c in name)
    return stem.strip(" .") or "design"
