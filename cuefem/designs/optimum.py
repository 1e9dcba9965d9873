"""An optimum: the best design within limits on its responses, beside the unmodified one; `search` finds it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from typing import Any, ClassVar, NamedTuple

import numpy as np

from cuefem.cue import Array, Material
from cuefem.cue.materials import material_name
from cuefem.designs.design_differences import design_differences
from cuefem.designs.evaluation import Evaluation, Response
from cuefem.designs.sampling import Levels, Normal, Span, Value
from cuefem.designs.study import Study, StudyDesign, Vary
from cuefem.designs.study_result import StudyResult
from cuefem.designs.study_table import column_label, displayed_reason, shown
from cuefem.parameters.scene_paths import value_at
from cuefem.quantity.display import counted
from cuefem.quantity.display_units import displayed_in, format_change, with_unit
from cuefem.quantity.fields import check_count
from cuefem.results.differences import difference_text
from cuefem.results.quantities import DASH
from cuefem.results.records import Record, Table
from cuefem.scene import Resolution, Scene
from cuefem.show.charts import Chart
from cuefem.show.drawings import DIAMETER_SCALE, CueDrawing, cue_drawing

EXCLUDED = 1e9  # relative margin of a missing response to a limit
NOT_DISTINCT = "* smaller than its uncertainty: the two designs are not distinct in this result."


@dataclass(frozen=True)
class Limit:
    """A response that must be in [low, high] in an optimization.

    Parameters
    ----------
    response : Response
        Of squirt, which has the sign of the offset, its size counts.
    low, high : float
        SI, one of them finite.

    Raises
    ------
    ValueError
        If ``low`` exceeds ``high``, neither is finite, or a bound of squirt is negative.

    Examples
    --------
    >>> import cuefem as cf
    >>> cf.Limit(cf.Response("tip_stiffness"), low=1500.0).sides
    [(1, 1500.0)]
    """

    response: Response
    low: float = -np.inf
    high: float = np.inf

    def __post_init__(self) -> None:
        if not self.low <= self.high or not np.isfinite([self.low, self.high]).any():
            bounds = f"{self.low} and {self.high}"
            raise ValueError(f"limit on {self.response.name} must have low <= high, one finite; got {bounds}")
        negative = [f"{bound:g}" for _, bound in self.sides if bound < 0 and self.response.result.odd]
        if negative:
            raise ValueError(f"limit on {self.response.name} is on its size and must be >= 0; got {negative[0]}")

    @property
    def sides(self) -> list[tuple[int, float]]:
        """(1, low) and (-1, high), without infinite bounds."""
        return [(sign, value) for sign, value in ((1, self.low), (-1, self.high)) if np.isfinite(value)]


class Round(NamedTuple):
    """Progress of a search: its listed values, rounds and designs so far, and the best objective within the limits (nan
    without one). objective: which response that is."""

    choice: dict[str, Value]
    number: int
    evaluations: int
    best: float
    objective: Response


class ChoiceResult(NamedTuple):
    """Result for one combination of listed values: the best `Optimum.score`, or nan and the reason."""

    values: dict[str, Value]
    objective: float
    reason: str = ""


class Constraint(NamedTuple):
    """A bound of a response or of a variable. name: of either. sense: ">=" or "<=". bound: SI."""

    name: str
    sense: str
    bound: float

    def __str__(self) -> str:
        return f"{self.name} {self.sense} {self.bound:g}"


@dataclass(frozen=True)
class Optimum(StudyDesign):
    """The best design of an optimization.

    active: the constraints that it has reached: limits and ends of ranges. evaluations: number of designs computed.
    stop_reason: why the search stopped without convergence, "" if it converged. choices: one for each combination of
    listed values, if there are any. start: the unmodified design, nan where it has no value or response. score: the
    objective, or with a target the size of the change, `Problem.change`.
    """

    active: tuple[Constraint, ...] = ()
    evaluations: int = 0
    stop_reason: str = ""
    choices: tuple[ChoiceResult, ...] = ()
    start: StudyDesign | None = None
    score: float = math.nan


@dataclass(frozen=True)
class Problem:
    """An optimization: the best design within limits, by `cuefem.study`.

    Points are values of the variables with low and high.

    Parameters
    ----------
    base : Scene
        The design to start from.
    vary : tuple of Vary
        The variables: spans, and lists of values, of which every combination is tried.
    objective : Response
        What is minimized.
    limits : tuple of Limit
        Which the best design keeps.
    at : Resolution, optional
        As of a `Study`.
    maximize : bool, default False
        Maximize the objective instead.
    choice : mapping
        Values of the variables over a list, by index; by default those of the base.
    against : Response, optional
        A response with a preferred direction: the answer is the trade-off between the two.
    count : int, default 7
        Designs on the trade-off, at least 3.
    squirt_factor : float, default 1.0
        As of a `Study`.
    target : float, optional
        A value that the objective, of squirt its size, must reach, SI: the answer is the design that does so with the
        smallest change, the root mean square of the variables' changes in parts of their ranges.

    Raises
    ------
    ValueError
        If a range is a distribution, ``against`` is the objective, ``count`` is below 3, or a ``target`` stands beside
        ``against`` or ``maximize``; as of a `Study`.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.material("hard maple")),), body_mass=0.42)
    >>> width = cf.Vary("tip diameter", cf.Span(0.011, 0.013))
    >>> limit = cf.Limit(cf.Response("tip_stiffness"), low=665.0)
    >>> best = cf.study(cf.Problem(cf.Scene(cue), (width,), cf.Response("end_mass"), (limit,))).optimum
    >>> best.active
    (Constraint(name='tip_stiffness', sense='>=', bound=665.0),)
    """

    base: Scene
    vary: tuple[Vary, ...]
    objective: Response
    limits: tuple[Limit, ...] = ()
    at: Resolution | None = None
    maximize: bool = False
    choice: Mapping[int, Value] = field(default_factory=dict)
    against: Response | None = None
    count: int = 7
    squirt_factor: float = 1.0
    target: float | None = None

    def __post_init__(self) -> None:
        check_count("count", self.count, 3)
        if self.target is not None and (self.maximize or self.against):
            raise ValueError("target must stand alone: the objective reaches it, and is not maximized or traded off")
        _ = self.bounds  # checks the target
        if self.against == self.objective:
            raise ValueError(f"against must be another response than the objective; got {self.objective.name} for both")
        for vary in self.vary:
            if isinstance(vary.range, Normal):
                raise ValueError(f"{vary.name} must have low and high, or values, in an optimization")
        _ = self.study  # checks fields and responses

    @cached_property
    def study(self) -> Study:
        """The same variables and responses as a study, the objective first."""
        against = () if self.against is None else (self.against,)
        responses = dict.fromkeys((self.objective, *against, *(limit.response for limit in self.limits)))
        return Study(self.base, self.vary, tuple(responses), at=self.at, squirt_factor=self.squirt_factor)

    def calibrated(self, squirt_factor: float) -> Problem:
        """The same problem with another squirt factor."""
        return replace(self, squirt_factor=squirt_factor)

    @property
    def bounds(self) -> tuple[Limit, ...]:
        """The limits, after them the target as one with both bounds."""
        target = () if self.target is None else (Limit(self.objective, self.target, self.target),)
        return (*self.limits, *target)

    @property
    def spans(self) -> dict[int, Span]:
        """The ranges of the variables with low and high, by index."""
        return {i: vary.range for i, vary in enumerate(self.vary) if isinstance(vary.range, Span)}

    def choices(self) -> list[Problem]:
        """The problem with every combination of the values in lists."""
        lists = {i: vary.range.values for i, vary in enumerate(self.vary) if isinstance(vary.range, Levels)}
        return [replace(self, choice=dict(zip(lists, v, strict=True))) for v in product(*lists.values())]

    def points(self, shares: Array) -> Array:
        """Points from fractions in [0, 1] of the ranges, (..., variables); of logarithms for logarithmic spacing."""
        return _each(Span.quantile, self.spans, shares)

    def shares(self, points: Array) -> Array:
        """The inverse of `points`."""
        return _each(Span.share, self.spans, points)

    @property
    def all_designs(self) -> Study:
        """Its study, whose ranges the search fills."""
        return self.study

    @property
    def start(self) -> Array:
        """The base design as a point, (variables,), clipped to the ranges, or their middle if it has no value."""
        point = list[float]()
        for i, span in self.spans.items():
            value = self.base_value(self.vary[i])
            point.append(span.quantile(0.5) if value is None else min(max(value, span.low), span.high))
        return np.array(point)

    def base_value(self, vary: Vary) -> Any:
        """The value of a variable in the base design: a number, the name of a material, or None without one."""
        if vary.factor or vary.shift:
            return 1.0 if vary.factor else 0.0
        value = value_at(self.base, vary.fields(self.base)[0])
        return material_name(value) if isinstance(value, Material) else value

    def change(self, shares: Array) -> Array:
        """The size of the change to points in fractions of the ranges, (..., variables); another name is one range."""
        others = sum(self.choice[i] != self.base_value(self.vary[i]) for i in self.choice)
        squares = np.square(shares - self.shares(self.start)).sum(axis=-1) + others
        return np.asarray(np.sqrt(squares / len(self.vary)))

    @property
    def base_design(self) -> StudyDesign:
        """The base with the values of its variables and its responses, nan where it has none, for a metric reason."""
        values = {vary.name: self.base_value(vary) for vary in self.vary}
        values = {name: np.nan if value is None else value for name, value in values.items()}
        with displayed_in("metric"):
            found = self.study.evaluate_scenes([self.base])
        names = (response.name for response in self.study.responses)
        responses = dict(zip(names, found.values[0].tolist(), strict=True))
        return StudyDesign(self.base, values, responses, failure=found.reasons[0])

    def design(self, point: Array) -> tuple[Value, ...]:
        """The values of all variables at a point."""
        values = {**self.choice, **dict(zip(self.spans, point.tolist(), strict=True))}
        return tuple(values[i] for i in range(len(self.vary)))

    def scene(self, point: Array) -> Scene:
        """The design at a point; ValueError if it is invalid."""
        return self.study.scene(self.design(point))

    @displayed_in("metric")
    def evaluate(self, points: Array) -> Evaluation:
        """Responses of the study at points (n, variables), nan and a reason, in metric units, where it has none."""
        return self.study.evaluate([self.design(point) for point in points])

    def sizes(self, values: Array) -> Array:
        """Values (n, responses) as they are compared: `Response.size`."""
        columns = zip(self.study.responses, values.T, strict=True)
        return np.stack([response.size(column) for response, column in columns], axis=1)

    def margins(self, values: Array) -> Array:
        """Margins of values (n, responses) to the limits, relative to each limit: (n, sides).

        Negative outside, and for a missing response.
        """
        sizes = self.sizes(values)
        margins = [
            sign * (sizes[:, self.study.responses.index(limit.response)] - bound) / (abs(bound) or 1.0)
            for limit in self.bounds
            for sign, bound in limit.sides
        ]
        return np.nan_to_num(np.reshape(margins, (-1, len(values))).T, nan=-EXCLUDED)


def _each(of: Callable[[Span, float], float], spans: Mapping[int, Span], values: Array) -> Array:
    """A function of every range at its column of values (..., variables)."""
    rows = ([of(*pair) for pair in zip(spans.values(), row, strict=True)] for row in np.atleast_2d(values).tolist())
    return np.array([*rows], float).reshape(values.shape)


@dataclass(frozen=True, repr=False)
class OptimumResult(StudyResult):
    """The result of an optimization: the best design and its active limits.

    Parameters
    ----------
    optimum : Optimum
        The best design: ``scene``, ``values``, ``responses``, ``active`` limits and ``evaluations``.
    """

    optimum: Optimum = field(repr=False)
    definition: Problem
    kind: ClassVar[str] = "optimum"

    @property
    def best(self) -> dict[str, StudyDesign]:
        """The best design, by the name of every response."""
        return {response.name: self.optimum for response in self.study.responses}

    def _values(self) -> Iterator[tuple[Value, ...]]:
        return iter([tuple(self.optimum.values.values())])

    def _computed(self) -> int:
        return self.optimum.evaluations

    def headline(self) -> str:
        """The objective before and after, with the uncertainty of the change, and how many limits are active."""
        problem, best, name = self.definition, self.optimum, self.definition.objective.name
        start = self.start.responses[name]
        before = "" if math.isnan(start) else f"{shown(start, problem.objective.display_key)} → "
        change = _change_text(start, best.responses[name], self.changes.get(name))
        limited = {each.name for each in best.active if each.name != name or problem.target is None}
        of = len(problem.limits) + len(problem.spans)
        value = f"{before}{with_unit(best.responses[name], problem.objective.display_key)}"
        changed = "" if change == DASH else f", {change}"
        return f"{problem.objective.label} {value}{changed}; {len(limited)} of {counted(of, 'limit')} and ranges active"

    def values(self) -> Record:
        """The best design, its responses and active constraints beside the unmodified design, and the evaluations."""
        problem, best, start = self.definition, self.optimum, self.start
        aim = "maximize" if problem.maximize else "minimize" if problem.target is None else "response"
        target = {} if problem.target is None else {"target": problem.target}
        return {
            "objective": {aim: problem.objective.name} | target,
            "value": best.responses[problem.objective.name],
            "values": best.values,
            "responses": best.responses,
            "start": {"values": start.values, "responses": start.responses, "failure": start.failure},
            "changes": self.changes,
            "active": [constraint._asdict() for constraint in best.active],
            "is_set_by_constraints": self.is_set_by_constraints,
            "evaluations": self._computed(),
            "stop_reason": best.stop_reason,
            "choices": [choice._asdict() for choice in best.choices],
        }

    @property
    def is_set_by_constraints(self) -> bool:
        """Whether as many constraints are active as there are numbers to choose."""
        reached = {constraint.name for constraint in self.optimum.active}  # a limit with both bounds counts once
        return self.definition.target is None and len(reached) >= len(self.definition.spans) > 0

    @property
    def start(self) -> StudyDesign:
        """The unmodified design."""
        assert self.optimum.start is not None
        return self.optimum.start

    def tables(self) -> list[Table | str]:
        """Varied parameters, the best design, its active constraints, and the best design for each choice."""
        problem, best = self.definition, self.optimum
        aim = f"{'maximize' if problem.maximize else 'minimize'} {problem.objective.label}"
        if problem.target is not None:
            aim = f"smallest change to {problem.objective.label} {self._text(problem.objective.name, problem.target)}"
        limits = [each for each in best.active if (each.name, each.bound) != (problem.objective.name, problem.target)]
        active = [f"{self._label(name)} {sense} {self._text(name, bound)}" for name, sense, bound in limits]
        tables: list[Table | str] = [
            self.headline(),
            *super().tables(),
            f"{aim}: {counted(self._computed(), 'design')} computed",
            self._compared(),
            f"active constraints: {', '.join(active) or 'none'}",
        ]
        if self.is_set_by_constraints:
            tables.append(
                "The answer is your limits: as many constraints are active as there are numbers to choose. Only "
                "another limit or a wider range gives a better design."
            )
        if best.stop_reason:
            tables.append(f"not finished: {best.stop_reason}; more --iterations may find a better design")
        return [*tables, self._choices()] if best.choices else tables

    def _text(self, name: str, value: Any) -> str:
        """A value of a variable or a response, with its unit."""
        units = self.units | {response.name: response.display_key for response in self.study.responses}
        if isinstance(value, str):
            return value
        return DASH if math.isnan(value) else with_unit(value, units[name])

    def _label(self, name: str) -> str:
        """The label of a variable or a response."""
        labels = {response.name: response.label for response in self.study.responses}
        return labels.get(name) or column_label(name)

    def _compared(self) -> Table:
        """The best design beside the unmodified one."""
        start = {**self.start.responses, **self.start.values}
        best = {**self.optimum.responses, **self.optimum.values}
        rows = tuple(
            (
                self._label(name),
                self._text(name, start[name]),
                self._text(name, value),
                _change_text(start[name], value, self.changes.get(name)),
            )
            for name, value in best.items()
        )
        notes = ["±: 1σ of the difference; shared errors cancel."] if self.changes else []
        if any(not change["distinct"] for change in self.changes.values()):
            notes.append(NOT_DISTINCT)
        if self.start.failure:
            notes.append(f"start: {displayed_reason(self.study, self.start.scene, self.start.failure)}")
        return Table("Best design", ("", "start", "best", "change"), rows, tuple(notes))

    def _choices(self) -> Table:
        """The best design for each combination of listed values."""
        score, unit = self.definition.objective.heading, self.definition.objective.display_key
        if self.definition.target is not None:
            score, unit = "change, part of the ranges", ""
        choices = self.optimum.choices
        head = (*map(column_label, choices[0].values), score, "")
        rows = tuple(
            (
                *(self._text(*pair) for pair in choice.values.items()),
                DASH if choice.reason else shown(choice.objective, unit),
                choice.reason,
            )
            for choice in choices
        )
        return Table("Best design for each choice", head, rows, texts=(*range(len(head) - 2), len(head) - 1))

    @cached_property
    def changes(self) -> dict[str, Record]:
        """Relative difference of each response of the best design from the unmodified one, as of `cuefem.compare`.

        "difference", "error" (1 sigma) and "distinct"; without a response that one of them lacks.
        """
        (changes,) = design_differences(self.study, [self.start, self.optimum])
        return changes

    def charts(self) -> list[Chart | CueDrawing]:
        """Drawings of the unmodified and of the best design."""
        designs = {"start": self.start, "best design": self.optimum}
        return [
            cue_drawing(design.scene, f"{name}, diameters {DIAMETER_SCALE:g} times enlarged")
            for name, design in designs.items()
            if design.scene.cue.segments
        ]


def _change_text(start: Any, value: Any, change: Record | None) -> str:
    """A change in %, of a response with its uncertainty; a dash where there is none."""
    if change is not None:
        return difference_text(change["difference"], change["error"]) + ("" if change["distinct"] else " *")
    numbers = not isinstance(start, str) and not isinstance(value, str)
    if not numbers or not start * value > 0:
        return DASH
    return format_change(100 * (value / start - 1), 1, "%")
