"""Comparison of cues: their results, and each difference with the uncertainty that does not cancel."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple, overload

from cuefem.analysis.end_mass import SQUIRT_END_MASS
from cuefem.analysis.measured import MeasuredComparison, compare_measured
from cuefem.analysis.strike_models import regime_warning
from cuefem.analysis.verdict import squirt_difference, verdict_by
from cuefem.files.cue_names import INSIDE_ASSUMED
from cuefem.files.defaults_report import Assumption
from cuefem.files.reference_cues import inside_mark
from cuefem.measurements.calibration import CalibratedSquirt, Calibration
from cuefem.measurements.measured_cue import MeasuredCue
from cuefem.measurements.measured_folder import load_measured
from cuefem.parameters.parts import main_material, shaft_word
from cuefem.quantity.display_units import cached_by_units, modulus_text, off_line, with_unit
from cuefem.quantity.fields import brief_value
from cuefem.results.computable_results import computable_results
from cuefem.results.differences import difference_text, relative_differences
from cuefem.results.progress import Progress
from cuefem.results.quantities import DASH, RESULTS, UNITS, format_value
from cuefem.results.records import Record, Table, json_value
from cuefem.results.solved_design import SolvedDesign, coupled_curve, off_centre
from cuefem.results.uncertainty import changes_by_input, miscue_note
from cuefem.results.verdict import verdict_problem
from cuefem.scene import Scene, check_scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.analysis import DESIGN_STYLES, Analysis, PageFrame, Rows
from cuefem.show.charts import Chart
from cuefem.show.drawings import DIAMETER_SCALE, CueDrawing, cue_drawing
from cuefem.show.offset_charts import offset_charts
from cuefem.show.scene_summary import effect_text, listed, scene_record

# The compared results, by their names in the registry.
SQUIRT_RESULTS = ("squirt", "end_mass_squirt", "pivot_length")  # derived from squirt: a miscue has none
SHAPE_RESULTS = ("tip_stiffness", "shaft_mass", "mass")
N_FREQUENCIES = 3
RESULT_NAMES = (*SQUIRT_RESULTS, *SHAPE_RESULTS, *(f"frequency_{k}" for k in range(1, N_FREQUENCIES + 1)))

UNKNOWN_STIFFNESS = 0.5  # relative uncertainty by E from which it should be measured: a wood has 0.22, a tube 0.83
CURVE_OFFSETS = tuple(i / 20 for i in range(1, 13))  # b/R
MAX_CUES = len(DESIGN_STYLES)
_LABELS = {"end_mass_squirt": SQUIRT_END_MASS}


@dataclass(frozen=True)
class Comparison(Rows, Analysis):
    """Results of some cues, and the relative differences of the others from the first with their uncertainty.

    Parameters
    ----------
    scene : Scene
        The scene of the first cue, off centre.
    offset, speed : float
        Offset b/R and speed, m/s, of the stroke of all cues.
    same_shaft : bool
        Whether the cues are one shaft before and after a change.
    reference : str
        Name of the first cue.
    regimes : dict of str to str
        State of the contact of each cue, as `Outcome.regime`; "" if its strike fails.
    problems : dict of str to str
        Why a cue has no verdict, by its name.
    cues : dict of str to dict
        Results of each cue in SI by their names in the registry; nan where it has none, such as squirt of a miscue.
    differences : dict of str to dict
        For each other cue, by result, "difference", its value over that of the first less 1; "error", its uncertainty
        (1 sigma); and "distinct", whether the difference exceeds the error, whichever of two cues is the first.
    miscues : dict of str to tuple of str
        Inputs, by cue, that make its stroke a miscue one standard deviation up or down: their uncertainty is that of
        the other side.
    unmeasured_moduli : dict of str to tuple
        For each other cue whose difference in stiffness is hardly known, since E of a shaft is not measured: the cue of
        that shaft, and the uncertainty of the difference (1 sigma) that remains with its E known.
    scenes : dict of str to Scene
        The compared scenes, all with the ball and the stroke of the first.
    calibrated : CalibratedSquirt or None
        The calibration of the first cue, by which every squirt is given: the others carry the same factor.
    """

    offset: float
    speed: float
    same_shaft: bool
    reference: str
    regimes: dict[str, str]
    problems: dict[str, str]
    cues: dict[str, dict[str, float]]
    differences: dict[str, dict[str, Record]]
    miscues: dict[str, tuple[str, ...]]
    unmeasured_moduli: dict[str, tuple[str, float]]
    scenes: dict[str, Scene] = field(repr=False)
    calibrated: CalibratedSquirt | None = None

    def heading(self) -> str:
        """The names of the cues."""
        return listed([*self.scenes])

    def effects_line(self) -> str:
        """The effects of all cues, or of each."""
        texts = {name: ", ".join(map(effect_text, scene.effects)) for name, scene in self.scenes.items()}
        if len(set(texts.values())) == 1:
            return texts[self.reference]
        return "; ".join(f"{name}: {text or 'none'}" for name, text in texts.items())

    def to_dict(self) -> Record:
        """The record: every scene, numbers in SI units, and the unit of each."""
        scenes = {name: scene_record(scene) for name, scene in self.scenes.items()}
        return json_value({**self.said(), "scenes": scenes, **self.values(), "units": dict(UNITS)})

    @property
    def warnings(self) -> list[str]:
        """What is implausible in each cue and its file."""
        own = {name: Analysis(scene).warnings for name, scene in self.scenes.items()}
        return [f"{name}: {line}" for name, lines in own.items() for line in lines]

    @property
    def assumptions(self) -> list[Assumption]:
        """What is assumed of each cue; of the stroke, which all have, once."""
        own = {name: Analysis(scene).assumptions for name, scene in self.scenes.items()}
        shared = [each for each in own[self.reference] if all(each in listed for listed in own.values())]
        apart = [
            replace(each, text=f"{name}: {each.text}")
            for name, listed in own.items()
            for each in listed
            if each not in shared
        ]
        return [*shared, *apart]

    def frame_rows(self) -> list[Record]:
        """A row for each cue and quantity, with its difference from the first cue."""
        return [
            {"cue": cue, "quantity": name, "value": value, "unit": UNITS.get(name, "")}
            | self.differences.get(cue, {}).get(name, {})
            for cue, numbers in self.cues.items()
            for name, value in numbers.items()
        ]

    def sentences(self) -> list[str]:
        """A sentence on the squirt of each cue relative to the first."""
        return [
            f"{name}: {squirt_difference(**each['squirt'])} {self.reference} (1σ)."
            for name, each in self.differences.items()
            if "squirt" in each
        ]

    def gaps(self) -> list[str]:
        """A sentence on the cues whose squirt cannot be compared with that of the first, each reason once."""
        apart = [name for name, each in self.differences.items() if "squirt" not in each]
        if not apart:
            return []
        cues = [self.reference, *apart]
        having: dict[str, list[str]] = {}
        for name in cues:
            if name in self.problems:
                having.setdefault(self.problems[name], []).append(name)
        reasons = [problem if names == cues else f"{listed(names)}: {problem}" for problem, names in having.items()]
        why = "; ".join(reasons) or "a stroke is nearly a miscue"
        return [f"{listed(apart)} and {self.reference} cannot be compared in squirt: {why}."]

    def tables(self) -> list[Table | str]:
        """A sentence on each difference of squirt, and the table."""
        return [*self.sentences(), *self.calibration_lines(), "", self.table()]

    def calibration_lines(self) -> list[str]:
        """The calibrated squirt of the first cue, what it rests on, and warnings; empty without a calibration."""
        own = self.calibrated
        if own is None:
            return []
        squirt = with_unit(abs(own.squirt), "rad", error=own.squirt_error)
        others = "the other carries" if len(self.cues) == 2 else "the others carry"
        return [
            f"{self.reference}: squirt {squirt} (1σ), {own.origin()}; {others} the same factor.",
            own.basis(),
            *own.warning_lines(),
        ]

    def _markup(self, frame: PageFrame) -> str:
        """The page with the first screen of the first cue; a plain page if that has no verdict."""
        # templates take 0.1 s to load
        from cuefem.analysis.first_screen import HeadlineCue, cue_names, screen_markup
        from cuefem.analysis.report_page import facts, page, section_of

        title = f"{self.heading()}: compared"
        if self.reference in self.problems:
            return super()._markup(frame._replace(name=title))
        answer = verdict_by(SolvedDesign.of(self.scene), None, lambda _: self.calibrated)
        first, *others = [HeadlineCue(name, scene, self.cues[name]) for name, scene in self.scenes.items()]
        own = replace(first, verdict=answer)
        facts_of = {name: facts(scene) for name, scene in self.scenes.items()}
        shared = [fact for fact in facts_of[own.name] if all(fact in each for each in facts_of.values())]
        apart = [f"{name}: {fact}" for name, each in facts_of.items() for fact in each if fact not in shared]
        return page(
            cue_names(own, others),
            inline=frame.inline,
            kind="compare",
            name=self.heading(),
            title=title,
            made=frame.made,
            notes=[*map(str, frame.assumptions)],
            warnings=[*self.gaps(), *frame.warnings, *(self.calibrated.warning_lines() if self.calibrated else ())],
            facts=[*apart, *shared],
            uncertainty=[f"{own.name}, {answer.uncertainty_line()}"],
            screen=screen_markup(own, others, self._headlines(), with_values=True),
            sections=[section_of(self.table(), self.curves())],
        )

    def _headlines(self) -> list[list[tuple[str, str]]]:
        """What the first screen says of the other cues: texts, each with the style of its cue or ""."""
        styles = dict(zip(self.scenes, DESIGN_STYLES, strict=False))
        titles = self._titles()
        squirts = {name: each["squirt"] for name, each in self.differences.items() if "squirt" in each}
        lines = [
            [(titles[name], styles[name]), (f": {squirt_difference(**each).removesuffix(' than')}", "")]
            for name, each in squirts.items()
        ]
        if self.calibrated:
            lines.append([(self.calibrated.origin(), "")])
        return lines

    def table(self) -> Table:
        """A row for each result: its value for each cue, and the differences of the others from the first."""
        first, *others = self.cues
        rows = []
        for name, own in self.cues[first].items():
            cells = [_label(name), _value(name, own)]
            for other in others:
                text = DASH
                if difference := self.differences[other].get(name):
                    text = difference_text(difference["difference"], difference["error"])
                    text += "" if difference["distinct"] else " *"
                cells += [_value(name, self.cues[other][name]), text]
            rows.append(tuple(cells))
            if name == "squirt":
                lateral = [_lateral(self.cues[cue][name]) for cue in (first, *others)]
                rows.append(
                    (
                        f"off line after {off_line(0.0)[1]}",
                        lateral[0],
                        *(cell for each in lateral[1:] for cell in (each, "")),
                    )
                )
        titles = self._titles()
        head = ("", titles[first], *(cell for other in others for cell in (titles[other], "difference")))
        shaft = "one shaft, before and after a change" if self.same_shaft else self._pieces()
        speed = with_unit(self.speed, "m/s", 6)
        notes = (
            f"Same stroke, with the ball of {first}, b/R {self.offset:.3g} at {speed}. ±: 1σ of the "
            f"difference, for {shaft}; shared errors cancel.",
            *(f"{name}: {warning}" for name, warning in self._regime_warnings().items()),
            *(self._modulus_note(name) for name in self.unmeasured_moduli),
            *(f"{name}: {miscue_note(inputs)}" for name, inputs in self.miscues.items()),
            "* smaller than its uncertainty: the cues are not distinct in this quantity.",
            *([INSIDE_ASSUMED] if [*titles.values()] != [*titles] else []),
        )
        return Table("Side by side", head, tuple(rows), notes)

    def _titles(self) -> dict[str, str]:
        """The names of the cues, with a dagger where the inside is assumed."""
        return {name: f"{name}{inside_mark(name, scene)}" for name, scene in self.scenes.items()}

    def _regime_warnings(self) -> dict[str, str]:
        """Warnings about the contact of the cues whose squirt is given; of the others the sentences say why not."""
        given = {name: regime_warning(regime) for name, regime in self.regimes.items() if name not in self.problems}
        return {name: warning for name, warning in given.items() if warning}

    def _pieces(self) -> str:
        """The shafts in words."""
        is_wood = all(shaft_word(scene) == "wood" for scene in self.scenes.values())
        return f"shafts of different pieces{' of wood' if is_wood else ''}"

    def _modulus_note(self, other: str) -> str:
        """What to measure where the difference of stiffness from the first cue is hardly known."""
        uncertain, remains = self.unmeasured_moduli[other]
        error = self.differences[other]["tip_stiffness"]["error"]
        shaft = shaft_word(self.scenes[uncertain])
        return (
            f"Stiffness, {other}: of ± {100 * error:.0f} % most is the unmeasured E of the {shaft} of {uncertain}. "
            "Measure a natural frequency and the weight of that shaft (cuefem compare FOLDER --estimate), or draw it "
            f"with its E: ± {100 * remains:.0f} % remain."
        )

    def curves(self) -> tuple[Chart, Chart]:
        """Squirt and natural pivot length against the offset."""
        factor = self.calibrated.factor if self.calibrated else 1.0
        lines = [
            (name, style, coupled_curve(scene, CURVE_OFFSETS, SolvedScene(scene).tip, factor))
            for style, (name, scene) in zip(DESIGN_STYLES, self.scenes.items(), strict=False)
        ]
        return offset_charts(lines, CURVE_OFFSETS, self.offset, height=300)

    def charts(self) -> list[Chart | CueDrawing]:
        """The curves, and a drawing of each cue."""
        drawings = [
            cue_drawing(scene, f"{name}, diameters {DIAMETER_SCALE:g} times enlarged")
            for name, scene in self.scenes.items()
        ]
        return [*self.curves(), *drawings]


def _label(name: str) -> str:
    if name.startswith("frequency_"):
        return f"natural frequency {name.removeprefix('frequency_')}"
    return _LABELS.get(name) or RESULTS[name].label


def _value(name: str, value: float) -> str:
    """A value with its unit."""
    quantity = "frequency" if name.startswith("frequency_") else "end_mass" if name in _LABELS else name
    return format_value(quantity, value)


def _lateral(squirt: float) -> str:
    return DASH if math.isnan(squirt) else off_line(squirt)[0]


@overload
def compare(
    cues: Mapping[str, Scene],
    *,
    same_shaft: bool = False,
    calibration: Calibration | None = None,
    progress: Progress | None = None,
) -> Comparison: ...
@overload
def compare(cues: MeasuredCue | str | Path, *, progress: Progress | None = None) -> MeasuredComparison: ...
def compare(
    cues: Mapping[str, Scene] | MeasuredCue | str | Path,
    *,
    same_shaft: bool = False,
    calibration: Calibration | None = None,
    progress: Progress | None = None,
) -> Comparison | MeasuredComparison:
    """Compare cues side by side, or the measured values of one cue with computed ones, with uncertainties.

    Parameters
    ----------
    cues : mapping of str to Scene, or str, path or MeasuredCue
        Two to five cues by their names, struck with the ball and the stroke of the first; or the folder of a measured
        cue (`cuefem guide measuring` has the format), or what it holds.
    same_shaft : bool
        Whether the cues are one shaft before and after a change: the uncertainty of its wood cancels.
    calibration : Calibration, optional
        Squirt that was measured on another shaft with the same tip: squirt and what follows from it are calibrated by
        the factor of the first cue.
    progress : callable, optional
        Wraps the list of cues or of uncertain parameters, to show progress.

    Returns
    -------
    Comparison or MeasuredComparison
        Of cues, or of a measured cue. Show it with ``print``, in a notebook, or by ``.save("both.html")``.

    Raises
    ------
    ValueError
        If there are too few or too many cues, one has no shape (a lumped cue), one shaft has two woods, or a file of a
        measured cue is invalid.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> wide = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> slim = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.0095, 0.021, wood),), body_mass=0.43))
    >>> squirt = cf.compare({"wide": wide, "slim": slim}).differences["slim"]["squirt"]
    >>> f"{squirt['difference']:.0%} ± {squirt['error']:.0%}", squirt["distinct"]
    ('-17% ± 6%', True)
    """
    if isinstance(cues, Mapping):
        return compare_cues(cues, same_shaft=same_shaft, calibration=calibration, progress=progress or list)
    if not isinstance(cues, MeasuredCue | str | Path):
        takes = f"2 to {MAX_CUES} scenes by name, {{'a': scene, 'b': other}}, or the folder of a measured cue"
        raise TypeError(f"compare cues must be {takes}; got {brief_value(cues)}")
    measured = cues if isinstance(cues, MeasuredCue) else load_measured(Path(cues))[0]
    return compare_measured(measured, progress=progress or iter)


def _check_calibration(calibration: Calibration, scenes: Mapping[str, Scene]) -> None:
    """ValueError with the name of a cue that has another tip than a calibration."""
    for name, scene in scenes.items():
        try:
            calibration.check(scene)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None


def compare_cues(
    scenes: Mapping[str, Scene],
    *,
    same_shaft: bool = False,
    names: Sequence[str] = RESULT_NAMES,
    calibration: Calibration | None = None,
    squirt_factor: float = 1.0,
    progress: Progress = list,
) -> Comparison:
    """Compare cues by the ball and the stroke of the first, with the uncertainty of each difference.

    same_shaft: whether they are one shaft before and after a change (`relative_differences`).

    names: the results that are compared. calibration: its factor for the first cue, or else squirt_factor, scales every
    squirt. progress: wraps the list of cues, to show progress. ValueError for less than two cues or more than
    `MAX_CUES`, for one shaft of two woods, and for another tip than the calibration's.
    """
    if not 2 <= len(scenes) <= MAX_CUES:
        raise ValueError(f"compare takes 2 to {MAX_CUES} cues; got {len(scenes)}")
    for name, scene in scenes.items():
        check_scene(f"compare cues[{name!r}]", scene)
    struck = with_same_stroke(scenes)
    woods = {main_material(scene.shaft).E for scene in struck.values()}
    if same_shaft and len(woods) > 1:
        moduli = " and ".join(modulus_text(E) for E in sorted(woods))
        raise ValueError(f"one shaft before and after a change must be of one wood; got E of {moduli}")
    reference, *others = struck
    calibrated = None
    if calibration is not None:
        _check_calibration(calibration, struck)
        calibrated = calibration.squirt(struck[reference])
        squirt_factor = calibrated.factor
    results = {name: _cue_results(struck[name], tuple(names), squirt_factor) for name in progress([*struck])}
    first = struck[reference]
    return Comparison(
        first,
        offset=float(first.stroke.offset),
        speed=float(first.stroke.speed),
        same_shaft=same_shaft,
        reference=reference,
        regimes={name: each.regime for name, each in results.items()},
        problems={name: each.problem for name, each in results.items() if each.problem},
        cues={name: each.numbers for name, each in results.items()},
        differences={name: _differences(results[reference], results[name], same_shaft=same_shaft) for name in others},
        miscues={name: each.miscues for name, each in results.items() if each.miscues},
        unmeasured_moduli={
            name: modulus
            for name in others
            if (modulus := _unmeasured_modulus(results, reference, name, same_shaft=same_shaft))
        },
        scenes=struck,
        calibrated=calibrated,
    )


def with_same_stroke(scenes: Mapping[str, Scene]) -> dict[str, Scene]:
    """The scenes with the ball and the stroke of the first, off centre."""
    first = off_centre(next(iter(scenes.values())))
    return {name: replace(scene, ball=first.ball, stroke=first.stroke) for name, scene in scenes.items()}


class _CueResults(NamedTuple):
    """A scene, its results, the contact state of its strike ("" if it fails), why it has no verdict ("" if it has), the
    relative changes of the results with each uncertain input, and the inputs whose uncertainty includes a miscue."""

    scene: Scene
    numbers: dict[str, float]
    regime: str
    problem: str
    inputs: dict[str, dict[str, float]]
    miscues: tuple[str, ...]


@cached_by_units(16)  # the reference usually remains while the other cue changes
def _cue_results(scene: Scene, names: tuple[str, ...], squirt_factor: float) -> _CueResults:
    design = SolvedDesign.of(scene).calibrated(squirt_factor)
    numbers = _numbers(design, names)
    try:
        outcome = design.strike()
        regime, problem = outcome.regime, verdict_problem(scene, outcome)
    except (ValueError, RuntimeError) as error:
        regime, problem = "", str(error)

    def numbers_of(other: Scene) -> dict[str, float]:
        return _numbers(SolvedDesign.of(other).calibrated(squirt_factor), names)

    changes = changes_by_input(scene, numbers, numbers_of)
    return _CueResults(scene, numbers, regime, problem, *changes)


def _numbers(design: SolvedDesign, names: Sequence[str]) -> dict[str, float]:
    """The compared results of a design; nan where it has none, such as squirt of a miscue."""
    scene, registry = design.scene, computable_results()
    _ = scene.shaft  # ValueError for a lumped cue, which has no shape

    def value(name: str) -> float:
        base, _, mode = name.partition("frequency_")
        of = registry[base or "frequency"].of
        argument: Any = int(mode) if mode else float(scene.stroke.offset) if name == "pivot_length" else None
        assert of is not None
        try:
            if name in SQUIRT_RESULTS and verdict_problem(scene, design.strike()):
                return math.nan
            return of(design, argument)
        except (ValueError, RuntimeError):
            return math.nan

    return {name: value(name) for name in names}


def _differences(first: _CueResults, other: _CueResults, *, same_shaft: bool) -> dict[str, Record]:
    registry = computable_results()
    modelled = {name for name in first.numbers if name in registry and registry[name].has_model_error}
    return relative_differences(first, other, same_shaft=same_shaft, with_model_error=modelled)


def _unmeasured_modulus(
    results: Mapping[str, _CueResults], reference: str, other: str, *, same_shaft: bool
) -> tuple[str, float] | None:
    """Of two cues the one whose E makes most of an uncertain difference in stiffness, and the uncertainty that remains
    with its E known; None where stiffness is known well enough."""
    shares = {name: abs(results[name].inputs.get("E", {}).get("tip_stiffness", 0.0)) for name in (reference, other)}
    uncertain = max(shares, key=lambda name: shares[name])
    if same_shaft or not shares[uncertain] > UNKNOWN_STIFFNESS:
        return None
    own = results[uncertain]
    measured = own._replace(inputs={key: change for key, change in own.inputs.items() if key != "E"})
    pair = [measured if name == uncertain else results[name] for name in (reference, other)]
    remains = _differences(*pair, same_shaft=same_shaft)["tip_stiffness"]["error"]
    return uncertain, float(remains)
