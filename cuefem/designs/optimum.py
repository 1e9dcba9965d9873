"""Optimization of a design within limits on its responses.

SLSQP on finite differences starts at the base design. If it ends outside the limits, differential evolution searches
the ranges and SLSQP continues from there. Values in a list (names of materials) are tried one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from cuefem.beam.blas_threads import one_blas_thread
from cuefem.cue import Array, Material
from cuefem.cue.materials import material_name
from cuefem.designs.evaluation import Evaluation, Response, evaluate
from cuefem.designs.sampling import Levels, Normal, Span, Value
from cuefem.designs.study import Study, StudyDesign, Vary
from cuefem.parameters.scene_paths import value_at
from cuefem.quantity.fields import check_count
from cuefem.scene import Resolution, Scene

TOLERANCE = 1e-6  # relative to a limit's own size (1 if it is 0): a closer value makes the limit active
EXCLUDED = 1e9  # score of a design that violates a limit: worse than any within the limits
INVALID_OBJECTIVE = 1e3  # scaled objective of an invalid design in SLSQP
ZERO_SQUIRT = 1e-7  # rad
STEP = 1e-4  # of differences, relative to a range: a hundred times the numerical error of a strike (1e-6)
POPULATION = 15  # designs per variable in differential evolution


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
    without one)."""

    choice: dict[str, Value]
    number: int
    evaluations: int
    best: float


class ChoiceResult(NamedTuple):
    """Result for one combination of listed values: the best objective, or nan and the reason."""

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
    listed values, if there are any. start: the unmodified design, nan where it has no value or response.
    """

    active: tuple[Constraint, ...] = ()
    evaluations: int = 0
    stop_reason: str = ""
    choices: tuple[ChoiceResult, ...] = ()
    start: StudyDesign | None = None


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
    maximize : bool
        Maximize the objective instead.
    choice : mapping
        Values of the variables over a list, by index; by default those of the base.

    Raises
    ------
    ValueError
        If a range is a distribution; as of a `Study`.

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

    def __post_init__(self) -> None:
        for vary in self.vary:
            if isinstance(vary.range, Normal):
                raise ValueError(f"{vary.name} must have low and high, or values, in an optimization")
        _ = self.study  # checks fields and responses

    @cached_property
    def study(self) -> Study:
        """The same variables and responses as a study, the objective first."""
        responses = dict.fromkeys((self.objective, *(limit.response for limit in self.limits)))
        return Study(self.base, self.vary, tuple(responses), at=self.at)

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

    @property
    def base_design(self) -> StudyDesign:
        """The base with the values of its variables and its responses, nan where it has none."""
        values = {vary.name: self.base_value(vary) for vary in self.vary}
        values = {name: np.nan if value is None else value for name, value in values.items()}
        found = evaluate([self.base], self.study.responses, at=self.at)
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

    def evaluate(self, points: Array) -> Evaluation:
        """Responses of the study at points (n, variables), nan and a reason where a design has none."""
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
            for limit in self.limits
            for sign, bound in limit.sides
        ]
        return np.nan_to_num(np.reshape(margins, (-1, len(values))).T, nan=-EXCLUDED)


def _each(of: Callable[[Span, float], float], spans: Mapping[int, Span], values: Array) -> Array:
    """A function of every range at its column of values (..., variables)."""
    rows = ([of(*pair) for pair in zip(spans.values(), row, strict=True)] for row in np.atleast_2d(values).tolist())
    return np.array([*rows], float).reshape(values.shape)


def optimum(
    problem: Problem,
    *,
    start: Array | None = None,
    rounds: int = 60,
    seed: int = 0,
    progress: Callable[[Round], object] = lambda round: None,
) -> Optimum:
    """The best design within ranges and limits.

    Parameters
    ----------
    problem : Problem
        Variables, objective and limits. Each combination of listed values is a separate search.
    start : array, optional
        The point to start from; the default is the base design.
    rounds : int
        Maximum number of steps of SLSQP, and of generations of differential evolution.
    seed : int
        Of differential evolution.
    progress : callable, optional
        Called with a `Round` after each step or generation.

    Returns
    -------
    Optimum
        A local optimum if SLSQP converged from the base: try another ``start`` to search for a better one.

    Raises
    ------
    ValueError
        If no design is within the limits, the message names the violated ones; if ``rounds`` is below 1.

    Notes
    -----
    SLSQP (`scipy.optimize.minimize`) in numbers scaled to their ranges (their logarithms, if the spacing is
    logarithmic); its gradients are forward differences of `STEP`, all of a step in one batch. Differential evolution
    (`scipy.optimize.differential_evolution`) prefers, among designs that violate a limit, the smallest violation.
    """
    check_count("rounds", rounds, 1)
    optima, choices, reasons = list[Optimum](), list[ChoiceResult](), list[str]()
    sign, count = -1 if problem.maximize else 1, 0
    for case in problem.choices():
        search = _Search(case, progress, count)
        first = case.shares(case.start if start is None else np.asarray(start, float))
        try:
            optima.append(search.optimum(first, rounds, seed))
            choices.append(ChoiceResult(search.choice, optima[-1].responses[problem.objective.name]))
        except ValueError as error:
            reasons.append(str(error))
            choices.append(ChoiceResult(search.choice, np.nan, str(error)))
        count = search.evaluations
    if not optima:
        raise ValueError(reasons[0])
    best = min(optima, key=lambda each: sign * problem.objective.size(each.responses[problem.objective.name]))
    listed = tuple(choices) if len(choices) > 1 else ()
    return replace(best, evaluations=count, choices=listed, start=problem.base_design)


class _NoDesign(Exception):
    """A point whose design is invalid or lacks a response."""


class _Search:
    """One search: points are fractions in [0, 1] of the ranges; evaluations start at ``count``."""

    def __init__(self, problem: Problem, progress: Callable[[Round], object], count: int) -> None:
        self.problem, self.progress, self.evaluations = problem, progress, count
        self.choice = {problem.vary[i].name: value for i, value in problem.choice.items()}
        self.rounds, self.best, self.scale = 0, np.inf, -1.0 if problem.maximize else 1.0
        self._responses, self._slopes = dict[bytes, Array](), dict[bytes, Array]()
        self._reasons = dict[bytes, str]()

    def rows(self, shares: Array) -> Array:
        """Responses at points (n, variables)."""
        found = self.problem.evaluate(self.problem.points(shares))
        self._reasons |= {u.tobytes(): reason for u, reason in zip(shares, found.reasons, strict=True) if reason}
        self.evaluations += len(shares)
        self.best = min(self.best, self.scores(found.values).min(initial=np.inf))
        return found.values

    def scores(self, values: Array) -> Array:
        """The scores to minimize: the objective, or `EXCLUDED` plus the violation of the limits."""
        violation = np.minimum(self.problem.margins(values) + TOLERANCE, 0).sum(axis=1)
        objective = np.nan_to_num(self.scale * self.problem.sizes(values)[:, 0], nan=EXCLUDED)
        return np.asarray(np.where(violation < 0, EXCLUDED - violation, objective))

    def report(self, *_: Any, **__: Any) -> None:
        """Count a round and report progress."""
        self.rounds += 1
        best = self.best / self.scale if self.best < EXCLUDED else np.nan
        self.progress(Round(self.choice, self.rounds, self.evaluations, best))

    def optimum(self, start: Array, rounds: int, seed: int) -> Optimum:
        """The best design; ValueError if none is within the limits."""
        size = abs(self.at(start)[0]) if self.problem.objective.unit else 1.0
        self.scale, self.best = self.scale / (size if np.isfinite(size) and size else 1.0), np.inf
        ends = [(start, "")]
        if len(start) and not self.is_least(start):
            ends.append(self.by_slsqp(start, rounds))
            is_found = self.is_least(ends[-1][0]) or not (ends[-1][1] or self.violated(ends[-1][0]))
            if not is_found:
                ends.append(self.by_evolution(start, rounds, seed))
                ends.append(self.by_slsqp(ends[-1][0], rounds))
        u = self.onto_ends(min((u for u, _ in ends), key=lambda u: self.scores(self.at(u)[None])[0]))
        violated, stop_reason = self.violated(u), "" if self.is_least(u) else ends[-1][1]
        if violated or not np.isfinite(self.at(u)).all():
            raise ValueError(self.none_found(u, violated))
        point, study = self.problem.points(u), self.problem.study
        return Optimum(
            self.problem.scene(point),
            dict(zip((vary.name for vary in self.problem.vary), self.problem.design(point), strict=True)),
            dict(zip((response.name for response in study.responses), self.at(u).tolist(), strict=True)),
            tuple(constraint for constraint, margin in self.margins(u) if margin < TOLERANCE),
            self.evaluations,
            stop_reason,
        )

    def none_found(self, u: Array, violated: Sequence[str]) -> str:
        """The error for a nearest point that lacks responses, or violates limits."""
        nearest = dict(zip(self.problem.study.responses, self.at(u).tolist(), strict=True))
        missing = [response.name for response, value in nearest.items() if not np.isfinite(value)]
        if missing:
            reason = self._reasons[np.clip(u, 0, 1).tobytes()]
            return f"no design that has {', '.join(missing)} was found; of the nearest: {reason}"
        has = ", ".join(f"{response.name} {value:.6g} {response.unit}".strip() for response, value in nearest.items())
        limits = ", ".join(violated)
        return f"no design within {limits} was found; the nearest has {has}: relax a limit or widen a range"

    def is_least(self, u: Array) -> bool:
        """Whether a size that is minimized, such as that of squirt, is 0 at a point within the limits.

        No design is better. SLSQP does not converge there: the size has a kink.
        """
        objective = self.problem.objective
        is_zero = float(objective.size(self.at(u)[0])) <= ZERO_SQUIRT
        return objective.result.odd and not self.problem.maximize and is_zero and not self.violated(u)

    def at(self, u: Array) -> Array:
        """Responses at one point, (responses,)."""
        u = np.clip(u, 0, 1)  # SLSQP oversteps by rounding
        key = u.tobytes()
        if key not in self._responses:
            self._responses[key] = self.rows(u[None])[0]
        return self._responses[key]

    def slopes(self, u: Array) -> Array:
        """Derivatives of the responses' sizes by forward differences into the ranges, (responses, variables)."""
        u = np.clip(u, 0, 1)
        key = u.tobytes()
        if key not in self._slopes:
            steps = np.where(u > 0.5, -STEP, STEP)
            ahead, here = (self.problem.sizes(rows) for rows in (self.rows(u + np.diag(steps)), self.at(u)[None]))
            self._slopes[key] = ((ahead - here) / steps[:, None]).T
        if not np.isfinite(self._slopes[key]).all():
            raise _NoDesign
        return self._slopes[key]

    def onto_ends(self, u: Array) -> Array:
        """The point with values closer than `TOLERANCE` to an end of a range on that end, if this violates no limit."""
        end = np.round(u)
        ends = np.where(np.abs(u - end) < TOLERANCE, end, u)
        return u if self.violated(ends) else ends

    @one_blas_thread  # SLSQP's own equations, too: their round-off decides how many designs it takes
    def by_slsqp(self, start: Array, rounds: int) -> tuple[Array, str]:
        """(The last point of SLSQP; why it stopped without convergence, or "")."""
        from scipy.optimize import minimize  # loaded when used: a second

        responses, last = self.problem.study.responses, start

        def value(u: Array, k: int, missing: float) -> float:
            """The size of a response; ``missing`` for a design without one, so that SLSQP shortens the step."""
            nonlocal last
            values = self.at(u)
            last = u if np.isfinite(values).all() else last
            return float(responses[k].size(values[k])) if np.isfinite(values).all() else missing

        def constraint(k: int, sign: int, bound: float) -> dict[str, Any]:
            unit = sign / (abs(bound) or 1.0)
            return {
                "type": "ineq",
                "fun": lambda u: unit * (value(u, k, bound - INVALID_OBJECTIVE / unit) - bound),
                "jac": lambda u: unit * self.slopes(u)[k],
            }

        try:
            result = minimize(
                lambda u: self.scale * value(u, 0, INVALID_OBJECTIVE / self.scale),
                start,
                jac=lambda u: self.scale * self.slopes(u)[0],
                method="SLSQP",
                bounds=[(0, 1)] * len(start),
                constraints=[
                    constraint(responses.index(limit.response), *side)
                    for limit in self.problem.limits
                    for side in limit.sides
                ],
                options={"maxiter": rounds, "ftol": 1e-9},
                callback=self.report,
            )
        except _NoDesign:
            return last, "a design in the ranges is invalid"
        return np.clip(result.x, 0, 1), "" if result.success else result.message.rstrip(".")

    def by_evolution(self, start: Array, rounds: int, seed: int) -> tuple[Array, str]:
        """The same for differential evolution."""
        from scipy.optimize import differential_evolution

        result = differential_evolution(
            lambda u: self.scores(self.rows(u.T)),
            [(0, 1)] * len(start),
            x0=start,
            rng=np.random.default_rng(seed),
            popsize=POPULATION,
            maxiter=rounds,
            tol=1e-6,
            vectorized=True,
            updating="deferred",
            polish=False,
            callback=self.report,
        )
        return result.x, "" if result.success else result.message.rstrip(".")

    def margins(self, u: Array) -> list[tuple[Constraint, float]]:
        """Every limit and every end of a range, with its relative margin."""
        limits = [
            Constraint(limit.response.name, ">=" if sign > 0 else "<=", bound)
            for limit in self.problem.limits
            for sign, bound in limit.sides
        ]
        margins = list(zip(limits, self.problem.margins(self.at(u)[None])[0].tolist(), strict=True))
        for (i, span), share in zip(self.problem.spans.items(), u.tolist(), strict=True):
            name = self.problem.vary[i].name
            margins += [(Constraint(name, ">=", span.low), share), (Constraint(name, "<=", span.high), 1 - share)]
        return margins

    def violated(self, u: Array) -> list[str]:
        """The limits that a point violates."""
        return [str(constraint) for constraint, margin in self.margins(u) if not margin >= -TOLERANCE]
