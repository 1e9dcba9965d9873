"""Design changes of a cue: the effect of each on its own, and of the best of them together, by the coupled strike."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np

from cuefem.analysis.shop_changes import MIN_STIFFNESS_LOSS, DesignChange, Limits, changes_of
from cuefem.analysis.strike_models import regime_warning
from cuefem.designs.evaluation import Response
from cuefem.measurements.calibration import CalibratedSquirt, Calibration
from cuefem.parameters.parts import is_tube, shaft_word
from cuefem.parameters.scene_changes import with_parameters
from cuefem.quantity.display_units import change_with_unit, format_change, to_display, with_heading, with_unit
from cuefem.results.progress import Progress
from cuefem.results.records import Record, Table, tabulate
from cuefem.results.solved_design import Solvable, SolvedDesign, off_centre
from cuefem.results.uncertainty import (
    InputChanges,
    miscue_note,
    model_share,
    ratio_error,
    squirt_changes,
    squirt_inputs,
)
from cuefem.results.verdict import reject_no_verdict
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.charts import Axis, Chart, Dots, chart

MIN_CHANGE = 0.02  # relative, of squirt: below it nobody turns a ferrule
MAX_STRIKES = 30  # of single and combined changes
TRIPLE_GAIN = 0.02  # of squirt, by which three changes together must beat two
MIN_CONTRIBUTION = 0.002  # of squirt: smaller contributions to its uncertainty are neglected in a change
NUMBERS = tuple(map(Response.of, ("squirt", "tip_stiffness", "shaft_mass", "frequency(1)")))
_NUMBER = {1: "best two together", 2: "best three together"}
STYLES = {"worthwhile": "bold", "more squirt": "dim", "within uncertainty": "dim", "small": "dim"}


@dataclass(frozen=True)
class ChangedDesign:
    """A cue with one change.

    Parameters
    ----------
    change : str
        The change in words.
    values : dict of str to object
        The parameters that it sets, as `cuefem.with_parameters` takes them.
    squirt, tip_stiffness, shaft_mass, frequency : float
        Squirt (rad), static stiffness of the tip (N/m), mass of the drawn part (kg) and first natural frequency (Hz).
    squirt_change, tip_stiffness_change : float
        Relative changes.
    shaft_mass_change, frequency_change : float
        Absolute changes, kg and Hz.
    squirt_change_error : float
        Uncertainty of squirt_change, 1 sigma.
    verdict : str
        The recommendation: "within uncertainty" if the change of squirt is smaller than its error.
    """

    change: str
    values: dict[str, Any]
    squirt: float
    tip_stiffness: float
    shaft_mass: float
    frequency: float
    squirt_change: float
    tip_stiffness_change: float
    shaft_mass_change: float
    frequency_change: float
    squirt_change_error: float
    verdict: str


@dataclass(frozen=True)
class DesignChanges(Rows, Analysis):
    """Changes that a maker can make to a cue, each on its own.

    Parameters
    ----------
    scene : Scene
        The analysed scene.
    offset : float
        Offset b/R of the strikes: a head-on stroke is computed at the game's default offset.
    regime : str
        State of the contact, as `Outcome.regime`.
    unmodified : dict of str to float
        Squirt (rad), tip stiffness (N/m), shaft mass (kg) and first natural frequency (Hz) of the cue itself.
    changes : list of ChangedDesign
        The changes, lowest squirt first.
    miscues : tuple of str
        Inputs that make the stroke of the cue itself a miscue one standard deviation up or down: their part of the
        uncertainties is that of the other side.
    calibrated : CalibratedSquirt or None
        The calibration by which every squirt is given: all changes carry the factor of the cue itself.
    together : list of ChangedDesign
        The best two changes of this shaft together, and the best three if they lower squirt by 2 % more.
    limits : Limits
        What the maker does not accept.
    """

    offset: float
    regime: str
    unmodified: dict[str, float]
    changes: list[ChangedDesign]
    miscues: tuple[str, ...] = ()
    calibrated: CalibratedSquirt | None = None
    together: Sequence[ChangedDesign] = ()
    limits: Limits = field(default=Limits(), repr=False)

    def frame_rows(self) -> list[Record]:
        """A row for each change."""
        return [{name: value for name, value in vars(each).items() if name != "values"} for each in self.changes]

    def gaps(self) -> list[str]:
        """A warning of the state of the contact, and those of the calibration."""
        own = self.calibrated.warning_lines() if self.calibrated else []
        return [*filter(None, [regime_warning(self.regime)]), *own]

    def tables(self) -> list[Table | str]:
        """A table with a row for each change, after the calibration of the cue itself and the best changes together."""
        return [*self.calibration_lines(), *([*self.together_lines(), ""] if self.together else []), self.table()]

    def calibration_lines(self) -> list[str]:
        """The calibrated squirt of the cue and the source of the calibration; empty without one."""
        own = self.calibrated
        if own is None:
            return []
        squirt = with_unit(abs(own.squirt), "rad", error=own.squirt_error)
        return [f"squirt {squirt} (1σ), {own.origin()}", own.basis(), ""]

    def together_lines(self) -> list[str]:
        """The best changes together, a line each: what, squirt before and after, stiffness and mass."""
        return [f"{_NUMBER[row.change.count(' + ')]}: {self.together_text(row)}" for row in self.together]

    def together_text(self, row: ChangedDesign) -> str:
        """Changes together in words: their squirt, and what they cost."""
        before, after = (with_unit(each, "rad", decimals=2) for each in (self.unmodified["squirt"], row.squirt))
        change = format_change(100 * row.squirt_change, 1, f"± {100 * row.squirt_change_error:.1f} %")
        costs = f"stiffness {_percent(row.tip_stiffness_change)}, {change_with_unit(row.shaft_mass_change, 'kg', 1)}"
        return f"{row.change}: {change} ({before} → {after}), {costs}"

    def table(self) -> Table:
        """A row for each change, the lowest squirt first."""
        table = tabulate(
            "Design changes",
            {
                "change": "{change}",
                "squirt change": lambda row: format_change(
                    100 * row["squirt_change"], 1, f"± {100 * row['squirt_change_error']:.1f} %"
                ),
                "stiffness change": lambda row: _percent(row["tip_stiffness_change"]),
                "mass change": lambda row: change_with_unit(row["shaft_mass_change"], "kg", 1),
                "natural frequency change": lambda row: format_change(row["frequency_change"], 1, "Hz"),
                "recommendation": "{verdict}",
            },
            map(vars, self.changes),
            *self._notes(),
            texts=(0, 5),
        )
        styles = {i: STYLES[row.verdict] for i, row in enumerate(self.changes) if row.verdict in STYLES}
        return replace(table, styles=styles, more=(2, 3, 4))

    def charts(self) -> list[Chart]:
        """Squirt against mass: the cue as it is, each change, and the best ones together."""
        rows = [("one change", "c5", self.changes), ("together", "c1", self.together)]
        points = [
            Dots(name if i == 0 else "", *_cost(row), style, row.change)
            for name, style, listed in rows
            for i, row in enumerate(listed)
        ]
        now = Dots("this cue", [0.0], [0.0], "c2")
        x, y = Axis(with_heading("mass change", "kg")), Axis("squirt change, %")
        return [chart("Squirt and mass of each change", [], x=x, y=y, points=[*points, now], height=230)]

    def _limits_line(self) -> str:
        """The limits of the changes as a line of text."""
        wall = min(self.limits.least_wall(self.scene), thinnest_wall(self.scene))
        kept = f"; {', '.join(self.limits.keep)} as they are" if self.limits.keep else ""
        loss = f"together at most {100 * self.limits.stiffness_loss:g} % less stiff"
        return f"Limits: wall {with_unit(wall, 'm')} or more{kept}; {loss}."

    def _notes(self) -> list[str]:
        """Definitions of the table's columns."""
        own = with_unit(self.unmodified["squirt"], "rad", decimals=2)
        return [
            f"By the coupled strike at b/R {self.offset:.4g}; this cue: {own}. "
            f"±: uncertainty of the change (1σ): model, unmeasured {shaft_word(self.scene)} and tip, and 1 %. "
            f"Worthwhile: squirt falls by more than its uncertainty and by {100 * MIN_CHANGE:g} % or more (small: by "
            "less); within uncertainty: the change is smaller than its uncertainty.",
            *([note] if (note := miscue_note(self.miscues)) else []),
            self._limits_line(),
            "Stiffness: static, at the tip, joint end clamped. Costs stiffness: by 5 % or more. Natural frequency: of "
            "the first mode.",
        ]


def design_changes(
    scene: Solvable,
    *,
    limits: Limits = Limits(),  # noqa: B008  # frozen
    calibration: Calibration | None = None,
    progress: Progress = list,
) -> DesignChanges:
    """Changes that a maker can make to a cue, the effect of each on its own, and the best of them together.

    Parameters
    ----------
    scene : Scene
        A stroke with a cue of segments, such as that of `usual_scene`. A head-on stroke is computed at the game's
        default offset.
    limits : Limits
        What the maker does not accept: least wall, parts that stay, loss of stiffness.
    calibration : Calibration, optional
        Squirt that was measured on another shaft with the same tip: every squirt is calibrated. A change alters squirt
        by the same share.
    progress : callable
        Wraps the list of changes, to show progress.

    Returns
    -------
    DesignChanges

    Raises
    ------
    ValueError
        If the cue is lumped, or the stroke a miscue.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> changes = cf.design_changes(scene).changes
    >>> changes[0].squirt_change < changes[-1].squirt_change
    True
    """
    trial = Trial.of(scene, limits, calibration)
    candidates = [change for change in changes_of(trial.struck) if change.part not in limits.keep]
    singles = [(change, row) for change in progress(candidates) if (row := trial.changed(change)) is not None]
    together = _together(trial, singles, MAX_STRIKES - len(candidates))
    return trial.answer(sorted((row for _, row in singles), key=lambda row: row.squirt_change), together)


@dataclass(frozen=True)
class Trial:
    """A shaft, on which changes are tried within the limits of its maker.

    design: of the scene, and its stroke off centre. base: its numbers. changes: of its squirt, by uncertain input.
    """

    scene: Scene
    design: SolvedDesign
    limits: Limits
    calibrated: CalibratedSquirt | None
    base: Record
    changes: InputChanges

    @classmethod
    def of(cls, scene: Solvable, limits: Limits, calibration: Calibration | None = None) -> Trial:
        """The shaft of a scene; ValueError if it is lumped or its stroke a miscue."""
        design = SolvedDesign.of(scene)
        original, struck = design.scene, off_centre(design.scene)
        if struck is not original:
            design = SolvedDesign.of(struck)
        reject_no_verdict(struck, design.strike())
        calibrated = calibration.squirt(struck) if calibration else None
        return cls(original, design, limits, calibrated, _numbers(design.solved), squirt_inputs(struck))

    @property
    def struck(self) -> Scene:
        """The scene, off centre."""
        return self.design.scene

    @property
    def factor(self) -> float:
        """By which the calibration scales squirt."""
        return self.calibrated.factor if self.calibrated else 1.0

    @cached_property
    def before(self) -> dict[str, float]:
        """The relative changes of squirt with the inputs that count."""
        return {key: x for key, x in self.changes.of("squirt").items() if abs(x) > MIN_CONTRIBUTION}

    def answer(self, rows: Sequence[ChangedDesign], together: Sequence[ChangedDesign] = ()) -> DesignChanges:
        """The answer with these rows, their squirt calibrated."""
        factor = self.factor
        return DesignChanges(
            scene=self.scene,
            offset=float(self.struck.stroke.offset),
            regime=self.design.strike().regime,
            unmodified=self.base | {"squirt": factor * self.base["squirt"]},
            changes=[replace(row, squirt=factor * row.squirt) for row in rows],
            together=[replace(row, squirt=factor * row.squirt) for row in together],
            miscues=self.changes.miscues,
            calibrated=self.calibrated,
            limits=self.limits,
        )

    def changed(self, change: DesignChange) -> ChangedDesign | None:
        """The shaft with a change; None where its geometry or the limits do not allow it."""
        variant = self.variant(change)
        return None if variant is None else self.with_error(change, *variant)

    def variant(self, change: DesignChange) -> tuple[SolvedScene, Record] | None:
        """The changed shaft and its numbers, without their uncertainty: one strike."""
        try:
            scene = with_parameters(self.struck, change.values)
            least = min(self.limits.least_wall(scene), thinnest_wall(self.struck))
            if thinnest_wall(scene) < (1 - 1e-9) * least:
                return None
            solved = SolvedScene(scene)
            return solved, _numbers(solved)
        except (ValueError, RuntimeError):
            return None

    def is_stiff(self, numbers: Record) -> bool:
        """Whether the stiffness at the tip stays within the limits."""
        least = (1 - self.limits.stiffness_loss) * self.base["tip_stiffness"]
        return bool(numbers["tip_stiffness"] >= least)

    def with_error(self, change: DesignChange, solved: SolvedScene, numbers: Record) -> ChangedDesign | None:
        """The changed shaft with the uncertainty of its change of squirt."""
        try:
            after = squirt_changes(solved, numbers["squirt"], self.before).of("squirt")
            residual = (_residual(x, after.get(key, 0.0), key in change.resets) for key, x in self.before.items())
            ratio = numbers["squirt"] / self.base["squirt"]
            error = ratio_error(ratio, model_share(self.struck, solved.scene), *residual)
        except (ValueError, RuntimeError):
            return None
        stiffness = numbers["tip_stiffness"] / self.base["tip_stiffness"] - 1
        return ChangedDesign(
            change.label,
            change.values,
            **numbers,
            squirt_change=ratio - 1,
            tip_stiffness_change=stiffness,
            shaft_mass_change=numbers["shaft_mass"] - self.base["shaft_mass"],
            frequency_change=numbers["frequency"] - self.base["frequency"],
            squirt_change_error=error,
            verdict=_verdict(ratio - 1, stiffness, error),
        )


def _together(trial: Trial, singles: Sequence[tuple[DesignChange, ChangedDesign]], strikes: int) -> list[ChangedDesign]:
    """The best two changes together, and the best three if they gain `TRIPLE_GAIN` more.

    Of single changes of this shaft that lower squirt; changes of the tip wear off and are none of them. Groups are
    ranked by the product of their single ratios, and the first ones struck, as many as `strikes` allows.
    """
    useful = [
        (change, math.log1p(row.squirt_change))
        for change, row in singles
        if row.squirt_change < 0 and change.part != "tip" and not change.is_new_shaft
    ]
    shares = {2: strikes - strikes // 3, 3: strikes // 3}
    best = []
    for size, most in shares.items():
        groups = [group for group in combinations(useful, size) if are_compatible([change for change, _ in group])]
        groups.sort(key=lambda group: sum(gain for _, gain in group))
        struck = []
        for group in groups[: max(0, most)]:
            change = joined([change for change, _ in group])
            variant = trial.variant(change)
            if variant is not None and trial.is_stiff(variant[1]):
                struck.append((change, *variant))
        if struck:
            best.append(trial.with_error(*min(struck, key=lambda each: each[2]["squirt"])))
    rows = [row for row in best if row is not None]
    if len(rows) == 2 and rows[1].squirt_change > rows[0].squirt_change - TRIPLE_GAIN:
        rows.pop()
    return rows


def are_compatible(group: Sequence[DesignChange]) -> bool:
    """Whether no two changes set the same parameter."""
    keys = [key for change in group for key in change.values]
    return len(keys) == len({*keys})


def joined(group: Sequence[DesignChange]) -> DesignChange:
    """Several changes as one."""
    values = {key: value for change in group for key, value in change.values.items()}
    resets = tuple(key for change in group for key in change.resets)
    label, part = (" + ".join(texts) for texts in zip(*((each.label, each.part) for each in group), strict=True))
    return DesignChange(label, values, resets, part)


def _cost(row: ChangedDesign) -> tuple[Any, list[float]]:
    """Mass and squirt of a change, in the units of a chart."""
    return to_display([row.shaft_mass_change], "kg"), [100 * row.squirt_change]


def _numbers(solved: SolvedScene) -> Record:
    design = SolvedDesign(solved)
    return {response.kind: response.value(design) for response in NUMBERS}


def thinnest_wall(scene: Scene) -> float:
    """The thinnest wall of an empty bore or of a tube, m; where solid, the radius; infinite if all bores are filled."""
    tube = is_tube(scene.shaft)
    empty = [s for s in scene.shaft.segments if tube or s.core is None]
    return min((min(s.tip_diameter - s.tip_bore, s.butt_diameter - s.butt_bore) / 2 for s in empty), default=np.inf)


def _residual(before: float, after: float, independent: bool) -> float:
    """Uncertainty of an uncertain parameter in ln(after/before); independent: the change replaces its value.

    A parameter of the changed cue alone, such as the width of a drilled bore, is known.
    """
    return math.hypot(before, after) if independent else after - before


def _verdict(squirt: float, stiffness: float, error: float) -> str:
    if abs(squirt) <= error:
        return "within uncertainty"
    if squirt > 0:
        return "more squirt"
    if squirt > -MIN_CHANGE:
        return "small"
    return "worthwhile, costs stiffness" if stiffness < -MIN_STIFFNESS_LOSS else "worthwhile"


def _percent(share: float) -> str:
    return format_change(100 * share, 1 if abs(share) < 0.095 else 0, "%")
