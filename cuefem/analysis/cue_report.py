"""The report of a cue: the answers of its sections, in one object."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from cuefem.analysis import report_sections
from cuefem.analysis.shop_changes import Limits
from cuefem.analysis.squirt_curve import FINE_OFFSETS
from cuefem.analysis.strike_models import regime_warning
from cuefem.contact.geometric_stiffness import SlopeOutOfRange
from cuefem.effects.force_law import IndentationOutOfRange
from cuefem.files.defaults_report import Assumption
from cuefem.measurements.calibration import Calibration
from cuefem.results.progress import Progress
from cuefem.results.records import Record, Table
from cuefem.results.solved_design import SolvedDesign
from cuefem.results.verdict import NoVerdict
from cuefem.scene import Scene, check_scene
from cuefem.show.analysis import Analysis, PageFrame

if TYPE_CHECKING:
    from cuefem.analysis.report_page import Beside


@dataclass(frozen=True)
class CueReport(Analysis):
    """All analyses of one stroke, by the keys of `QUESTIONS`.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    sections : dict of str to Analysis
        The answers, in their order.
    regime : str
        State of the contact, as `Outcome.regime`; "" without a contact.
    no_contact, no_squirt : str
        Why only what needs no stroke is known, such as natural frequencies; why there is no verdict.
    other : tuple of str and Scene, optional
        Name and scene of a cue that its page shows beside this one: ``replace(report, other=(name, scene))``.
    """

    sections: dict[str, Analysis]
    regime: str = ""
    no_contact: str = ""
    no_squirt: str = ""
    other: tuple[str, Scene] | None = field(default=None, repr=False)

    def headline(self) -> str:
        """Squirt with its uncertainty."""
        return self.sections["verdict"].headline() if "verdict" in self.sections else ""

    def problem(self) -> str:
        """Why there is no squirt."""
        return self.no_contact and f"{self.no_contact} (--tip-height, --leather, --speed)"

    def values(self) -> Record:
        """The numbers of every section."""
        others = {name: getattr(self, name) for name in ("regime", "no_contact", "no_squirt")}
        return {key: answer.values() for key, answer in self._brief()} | {k: text for k, text in others.items() if text}

    def to_dict(self) -> Record:
        """The record, with the units of what is no quantity of the registry in any section."""
        record = super().to_dict()
        for _, answer in self._brief():
            record["units"] |= answer.own_units
        return record

    def tables(self) -> list[Table | str]:
        """The tables of every section, the warnings first."""
        first = self.no_contact and f"no end mass and no squirt: {self.no_contact}"
        as_entered = self.no_squirt and f"{self.no_squirt}\nBelow: the numbers of the cue as entered."
        first = first or as_entered or regime_warning(self.regime)
        return [*([first, ""] if first else []), *(table for _, answer in self._brief() for table in answer.tables())]

    def lines(
        self, name: str = "", assumptions: Sequence[Assumption] = (), hints: Sequence[Table | str] = ()
    ) -> list[Table | str]:
        """What a terminal shows, the assumptions by their part of the uncertainty."""
        verdict: Any = self.sections.get("verdict")
        return super().lines(name, verdict.by_part(assumptions) if verdict else assumptions, hints)

    def _brief(self) -> list[tuple[str, Analysis]]:
        """The sections that terminal and JSON show too."""
        return [(key, self.sections[key]) for key in report_sections(details=False) if key in self.sections]

    def page_title(self, name: str, question: str) -> str:
        """The name of the file alone: the page says that it is a report."""
        return name

    def _markup(self, frame: PageFrame) -> str:
        """The page with the first screen; ValueError for a miscue, which has none."""
        from cuefem.analysis.report_page import page_of  # templates take 0.1 s to load

        problem = self.no_squirt or self.no_contact
        if problem and frame.inline:
            return super()._markup(frame)
        if problem:
            raise ValueError(problem)
        named = frame._replace(name=frame.name or "cue")
        beside = None if self.other is None else self._beside(named.name, *self.other)
        return page_of(self.scene, self.sections, self.regime, named, beside)

    def _beside(self, name: str, other: str, other_scene: Scene) -> Beside:
        """Another cue beside this one, of this name."""
        from cuefem.analysis.comparison import compare_cues
        from cuefem.analysis.first_screen import HeadlineCue
        from cuefem.analysis.report_page import Beside

        verdict: Any = self.sections["verdict"]
        compared = compare_cues({other: other_scene, name: self.scene}, squirt_factor=verdict.factor)
        cue = HeadlineCue(other, other_scene, compared.cues[other])
        return Beside(cue, compared.differences[name].get("squirt"), compared.table())


def report(
    scene: Scene,
    rtol: float | None = None,
    *,
    calibration: Calibration | None = None,
    limits: Limits = Limits(),  # noqa: B008  # frozen
    details: bool = False,
    progress: Progress = list,
) -> CueReport:
    """All analyses of one stroke of a cue.

    Parameters
    ----------
    scene : Scene
        A stroke.
    rtol : float, optional
        Relative numerical error target of the coupled strike; by default that of a default strike.
    calibration : Calibration, optional
        Squirt that was measured on another shaft with the same tip: squirt and all that follows from it are calibrated.
    limits : Limits
        What the maker does not accept of a design change.
    details : bool
        Whether the sections are computed too that only a page has, and the finer curves.
    progress : callable
        Wraps the list of sections, to show progress.

    Returns
    -------
    CueReport
        Beyond the valid range of the force law or of the geometric stiffness it has only what needs no stroke, such as
        the natural frequencies, and the reason as ``no_contact``; of a miscue no verdict, and the reason as
        ``no_squirt``.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> list(cf.report(scene).sections)[:4]
    ['verdict', 'squirt', 'numbers', 'modes']
    """
    found: dict[str, Analysis] = {}
    lacking = ""
    check_scene("report scene", scene)
    wanted = report_sections(scene, details=details)
    try:
        scene.contact_time  # noqa: B018
        design = SolvedDesign.of(scene, rtol)
        regime = design.strike().regime
    except (IndentationOutOfRange, SlopeOutOfRange) as error:
        resting = {key: each for key, each in wanted.items() if not each.answer().has_stroke}
        return CueReport(scene, {key: each.function()(scene) for key, each in resting.items()}, no_contact=str(error))
    calibrated: Record = {} if calibration is None else {"calibration": calibration}
    if calibration is not None:
        with suppress(NoVerdict):  # the section of the verdict says why
            design = design.calibrated(calibration.factor(scene))
    arguments: Record = {
        "verdict": calibrated,
        "advice": calibrated | {"limits": limits},
        "squirt": {"offsets": FINE_OFFSETS} if details else {},
    }
    for key, question in progress([*wanted.items()]):
        answer = question.function()
        try:
            found[key] = answer(design, **arguments.get(key, {}))
        except NoVerdict as error:
            lacking = str(error)
    return CueReport(scene, found, regime, no_squirt=lacking)
