"""Analyses of a scene: one file for each question, with its computation, its result, its tables and its charts.

`QUESTIONS` registers them. Page, terminal and JSON of the report, the designer's report, `cuefem --help` and
``cuefem.NAME`` read this table.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from cuefem.scene import Scene
    from cuefem.show.analysis import Analysis


def has_segments(scene: Scene) -> bool:
    """Whether the cue is drawn, not lumped."""
    return bool(scene.cue.segments)


def has_leather(scene: Scene) -> bool:
    """Whether the tip has a force law of its own."""
    return scene.contact_terms.tip is not None


def is_any(scene: Scene) -> bool:
    """Every scene."""
    return True


class Question(NamedTuple):
    """A question about a scene, and where its answer stands.

    title: of its section in the report. place: "module:function"; the function takes a `Scene` (in the report a
    `SolvedDesign`, which shares modes and strike) and returns an `Analysis`. It is imported when it is called.
    help, group: line and heading in `cuefem --help` of a question whose command needs no options of its own; "" for
    others. in_report: whether it is a section of the report; page_only: of its page alone, for long or slow parts;
    folded: closed there. engineer: among the parts "For engineers", behind those of a maker. needs: what the scene must
    have.
    """

    title: str
    place: str
    help: str = ""
    group: str = "Cue"
    in_report: bool = True
    page_only: bool = False
    folded: bool = False
    engineer: bool = False
    needs: Callable[[Scene], bool] = is_any

    @property
    def call(self) -> str:
        """The name of its function in `cuefem`."""
        return self.place.partition(":")[2]

    def function(self) -> Callable[..., Analysis]:
        """Its function, imported."""
        module, _, name = self.place.partition(":")
        function: Callable[..., Analysis] = getattr(import_module(module), name)
        return function

    def answer(self) -> type[Analysis]:
        """The class of its answers, which its function is annotated to return."""
        function = self.function()
        kind = function.__annotations__["return"]  # a text, if the module postpones its annotations
        answer: type[Analysis] = function.__globals__[kind] if isinstance(kind, str) else kind
        return answer


# By the key of its JSON, of its section on a page, and the name of its command; in the order of the report.
QUESTIONS: dict[str, Question] = {
    "verdict": Question("Squirt", "cuefem.analysis.verdict:verdict"),
    "advice": Question(
        "Design changes", "cuefem.analysis.design_changes:design_changes", page_only=True, needs=has_segments
    ),
    "squirt": Question("Squirt and tip offset", "cuefem.analysis.squirt_curve:squirt_curve"),
    "numbers": Question("Cue and stroke", "cuefem.analysis.cue_numbers:cue_numbers"),
    "modes": Question(
        "Natural frequencies", "cuefem.analysis.natural_frequencies:natural_frequencies", needs=has_segments
    ),
    "reduction": Question("From the drawing to squirt", "cuefem.analysis.reduction:reduction", engineer=True),
    "end_masses": Question("Effective end mass", "cuefem.analysis.end_mass:end_masses", engineer=True),
    "tip": Question(
        "Leather tip, head-on impact", "cuefem.analysis.tip_impacts:tip_impacts", needs=has_leather, engineer=True
    ),
    "strike": Question(
        "Stroke by model", "cuefem.analysis.strike_models:strike_models", page_only=True, folded=True, engineer=True
    ),
    "contact": Question(
        "The contact", "cuefem.analysis.contact_history:contact_history", page_only=True, folded=True, engineer=True
    ),
    "effects": Question(
        "Sensitivity to effects",
        "cuefem.analysis.effect_sensitivity:effect_sensitivity",
        help="Sensitivity to each physical effect, removed or added.",
        group="Verification",
        in_report=False,
    ),
    "check": Question(
        "Beam model against a 3-D solid",
        "cuefem.analysis.model_error:model_error",
        help="Error of the beam model against a 3-D elastic solid, a part of all errors.",
        group="Verification",
        in_report=False,
    ),
}


def report_sections(scene: Scene | None = None, *, details: bool = True) -> dict[str, Question]:
    """The questions of the report by key, in its order.

    scene: leaves out the questions whose `needs` it lacks. details: whether to include those of the page alone.
    """
    return {
        key: question
        for key, question in QUESTIONS.items()
        if question.in_report
        if details or not question.page_only
        if scene is None or question.needs(scene)
    }


def asked_questions() -> dict[str, Question]:
    """The questions whose command needs no options of its own, by the command's name."""
    return {key.replace("_", "-"): question for key, question in QUESTIONS.items() if question.help}


def public_question(name: str) -> Any:
    """The function of that name of a registered question, or None."""
    return next((question.function() for question in QUESTIONS.values() if question.call == name), None)
