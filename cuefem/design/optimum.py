"""The best design within limits: what a sweep varies and asks for, searched instead of tabulated.

Where every derivative is exact (`cuefem.design.gradient`, complex steps), SLSQP needs tens of evaluations; otherwise
differential evolution needs thousands. `front` trades two responses off against each other.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from cuefem.cue import Array, SegmentRows
from cuefem.design.batch import CueBatch
from cuefem.design.evaluation import evaluate
from cuefem.design.gradient import STEP, densities_to, drawing, gradient, with_poisson_ratios
from cuefem.design.ranges import Span
from cuefem.design.responses import Response
from cuefem.design.sensitivity import frequency_sensitivity
from cuefem.design.study import Study, Vary
from cuefem.scene import Resolution, Scene
from cuefem.vary import Path, value_at

TOLERANCE = 1e-6  # relative to a limit's own size (1 if it is 0): a value nearer than this makes the limit active
EXCLUDED = 1e9  # score of a design that breaks a limit: worse than any within the limits
SHAPES = ("length", "tip_diameter", "butt_diameter", "tip_bore", "butt_bore", "kappa")
MATERIAL = ("E", "G", "rho")
Progress = Callable[[int, float], object]

# Responses that follow from the drawing alone, (designs, parts); a limit holds for every part.
_DRAWN: dict[str, Callable[[CueBatch], Array]] = {
    "mass": lambda batch: batch.mass[:, None],
    "shaft_mass": lambda batch: batch.shaft_mass[:, None],
    "balance_point": lambda batch: batch.balance_point[:, None],
    "tip_stiffness": lambda batch: batch.tip_stiffness[:, None],
    "tip_diameter": lambda batch: batch.rows.tip_diameter[:, :1],
    "wall": lambda batch: batch.walls,
}


@dataclass(frozen=True)
class Limit:
    """A response that must stay in [low, high], in SI units."""

    response: Response
    low: float = -np.inf
    high: float = np.inf

    def __post_init__(self) -> None:
        if not self.low <= self.high or not np.isfinite([self.low, self.high]).any():
            bounds = f"{self.low} and {self.high}"
            raise ValueError(f"limit on {self.response.name} must have low <= high, one finite; got {bounds}")

    @property
    def sides(self) -> list[tuple[int, float]]:
        """(1, low) and (-1, high), without infinite bounds."""
        return [(sign, value) for sign, value in ((1, self.low), (-1, self.high)) if np.isfinite(value)]


@dataclass(frozen=True)
class Optimum:
    """The best design found.

    scene: with the best cue. value: of the objective. numbers: what varied, by name. values: the objective and the
    limited responses, by name. active: the limits and ends of ranges that hold the design, as "tip_stiffness >= 1500".
    evaluations: of the objective. exact: whether exact gradients led there, which finds a local optimum.
    unfinished: why the search stopped before it had converged, "" if it converged.
    """

    scene: Scene
    value: float
    numbers: dict[str, float]
    values: dict[str, float]
    active: tuple[str, ...]
    evaluations: int
    exact: bool
    unfinished: str = ""


@dataclass(frozen=True)
class Problem:
    """What to make as small (or, with ``largest``, as large) as possible, by varying what, within which limits.

    at: the one resolution of all designs; the default is that of a `Study`.
    """

    base: Scene
    vary: tuple[Vary, ...]
    objective: Response
    limits: tuple[Limit, ...] = ()
    at: Resolution | None = None
    largest: bool = False

    def __post_init__(self) -> None:
        for vary in self.vary:
            if not isinstance(vary.range, Span):
                raise ValueError(f"{vary.name} must have low and high, between which an optimum is sought")
        _ = self.study  # checks fields and responses

    @cached_property
    def study(self) -> Study:
        """The same variables and responses as a study, the objective first."""
        asked = dict.fromkeys((self.objective, *(limit.response for limit in self.limits)))
        return Study(self.base, self.vary, tuple(asked), at=self.at)

    @property
    def bounds(self) -> Array:
        """Lowest and highest values, (2, variables)."""
        return np.array([vary.range.ends for vary in self.vary], float).T

    def points(self, parts: Array) -> Array:
        """Points from parts in [0, 1] of the ranges, (..., variables); logarithmic spacing goes in equal ratios."""
        low, high = self.bounds
        even = low + parts * (high - low)
        return np.clip(np.where(self._log_ratio > 0, low * np.exp(parts * self._log_ratio), even), low, high)

    def parts(self, points: Array) -> Array:
        """The inverse of `points`."""
        low, high = self.bounds
        parts, even = (points - low) / (high - low), self._log_ratio == 0
        parts[..., ~even] = np.log(points[..., ~even] / low[~even]) / self._log_ratio[~even]
        return np.clip(parts, 0, 1)

    def stretch(self, points: Array) -> Array:
        """Derivatives of `points` to their parts, (..., variables)."""
        low, high = self.bounds
        return np.where(self._log_ratio > 0, points * self._log_ratio, high - low)

    @cached_property
    def _log_ratio(self) -> Array:
        """Logarithm of high over low of the ranges with logarithmic spacing, 0 of the others."""
        spans = [vary.range for vary in self.vary if isinstance(vary.range, Span)]
        return np.array([np.log(span.high / span.low) if span.logarithmic else 0.0 for span in spans])

    @property
    def start(self) -> Array:
        """The base design as a point, (variables,), moved into the ranges, or their middle if it has no value."""
        low, high = self.bounds
        bounded = [
            1.0 if vary.factor else 0.0 if vary.shift else value_at(self.base, vary.fields(self.base)[0])
            for vary in self.vary
        ]
        middle = (low + high) / 2
        return np.clip([m if value is None else value for value, m in zip(bounded, middle, strict=True)], low, high)

    def scene(self, point: Array) -> Scene:
        """The design at a point; ValueError if it cannot be made."""
        return self.study.scene(tuple(point.tolist()))

    def values(self, points: Array, *more: Response) -> Array:
        """Responses of the study, then ``more``, at points (n, variables): (n, responses), nan if there is none."""
        asked = (*self.study.responses, *more)
        values, scenes = np.full((len(points), len(asked)), np.nan), dict[int, Scene]()
        for i, point in enumerate(points):
            try:
                scenes[i] = self.scene(point)
            except ValueError:
                continue
        if scenes:
            values[list(scenes)] = evaluate(list(scenes.values()), asked, at=self.study.resolution).values
        return values

    def room(self, values: Array) -> Array:
        """How far values (n, responses) lie inside the limits, relative to each limit's size: (n, sides).

        Negative outside, and where a response has no value.
        """
        rooms = [
            sign * (values[:, self.study.responses.index(limit.response)] - bound) / _size(bound)
            for limit in self.limits
            for sign, bound in limit.sides
        ]
        return np.nan_to_num(np.reshape(rooms, (-1, len(values))).T, nan=-EXCLUDED)

    @cached_property
    def exact(self) -> bool:
        """Whether all derivatives are exact: dimensions and moduli of a bare cue's segments vary, and every response
        follows from the drawing, or is a frequency, the small-offset squirt or the stick end mass."""
        moved = {path for vary in self.vary for path in (*vary.fields(self.base), *vary.givers(self.base))}
        known = {*_DRAWN, "frequency", "squirt_slope", "end_mass"}
        drawn = all(response.kind in known and not response.in_time for response in self.study.responses)
        return drawn and not self.base.effects and None not in map(_row, moved)

    def derived(self, response: Response, point: Array) -> tuple[Array, Array]:
        """Parts of a response at a point and their exact derivatives: (parts,), (parts, variables).

        "wall" has a part for each end of every segment, other responses have one.
        """
        scene, at, moves = self.scene(point), self.study.resolution, self._moves(point)
        cue = scene.shaft
        match response.kind:
            case "squirt_slope" | "end_mass":
                gradients = gradient(scene, "stick", at)
                squirt = response.kind == "squirt_slope"
                value, to = (
                    (gradients.squirt, gradients.squirt_to) if squirt else (gradients.end_mass, gradients.end_mass_to)
                )
                assert value is not None
                assert to is not None
                return np.array([value]), _along(to, moves)
            case "frequency":
                density = frequency_sensitivity(scene, response.modes, at)
                return np.array([density.end_mass]), _along(densities_to(density, drawing(cue)), moves)
        rows = SegmentRows(*(row + 1j * STEP * move for row, move in zip(drawing(cue), moves, strict=True)))
        parts = _DRAWN[response.kind](CueBatch(rows, np.full(len(point), cue.body_mass)))
        return parts[0].real, parts.imag.T / STEP

    def _moves(self, point: Array) -> SegmentRows:
        """Derivatives of the drawing's numbers to the variables, arrays (variables, segments)."""
        cue = self.scene(point).shaft
        moves = SegmentRows(*np.zeros((len(SegmentRows._fields), len(point), len(cue.segments))))
        for k, shifted in enumerate(point + 1j * STEP * np.eye(len(point))):
            for path, number in self.study.numbers(dict(enumerate(shifted.tolist()))).items():
                i, name = _row(path) or (0, "")
                getattr(moves, name)[k, i] = np.imag(number) / STEP
        return with_poisson_ratios(drawing(cue), moves)


def _row(path: Path) -> tuple[int, str] | None:
    """The segment and the name among `SegmentRows` of a field; None for a field that is not among them."""
    match path:
        case ("cue", "segments", int(i), str(name)) if name in SHAPES:
            return i, name
        case ("cue", "segments", int(i), "material" | "core" as owner, str(name)) if name in MATERIAL:
            return i, name if owner == "material" else f"core_{name}"
    return None


def _along(to: SegmentRows, moves: SegmentRows) -> Array:
    """A gradient to the drawing's numbers as one to the variables, (1, variables); E and G carry their nu along."""
    names = (name for name in SegmentRows._fields if not name.endswith("nu"))
    return np.sum([np.nan_to_num(getattr(to, n)) @ getattr(moves, n).T for n in names], axis=0)[None]


def _size(bound: float) -> float:
    return abs(bound) or 1.0


def optimum(
    problem: Problem,
    *,
    start: Array | None = None,
    iterations: int = 60,
    seed: int = 0,
    progress: Progress = lambda count, best: None,
) -> Optimum:
    """The best design within ranges and limits.

    Parameters
    ----------
    problem : Problem
        What varies, what is asked, and the limits.
    start : array, optional
        The point to start from; the default is the base design.
    iterations : int
        At most so many steps of SLSQP, or generations of differential evolution.
    seed : int
        Of differential evolution.
    progress : callable, optional
        Called with the number of evaluations and an objective: with exact gradients that of the design tried last,
        otherwise the best so far within the limits, nan until one is found.

    Returns
    -------
    Optimum
        With exact gradients a local optimum; `search` shows whether a better one lies elsewhere.

    Raises
    ------
    ValueError
        If no design near is within the limits; the message names the limits that are broken.

    Notes
    -----
    With exact derivatives, SLSQP (`scipy.optimize.minimize`) in numbers scaled to their ranges (their logarithms, if
    the spacing is logarithmic). Otherwise differential
    evolution (`scipy.optimize.differential_evolution`), a population of 15 designs a variable; among designs that break
    a limit it prefers those that break it least.
    """
    first = problem.parts(problem.start if start is None else np.asarray(start, float))
    seek = _by_gradients if problem.exact else _by_evolution
    u, count, unfinished = seek(problem, first, iterations, seed, progress)
    point = problem.points(u)
    values = problem.values(point[None])
    rooms = _rooms(problem, point, values)
    broken = [words for words, room in rooms if not room >= -TOLERANCE]
    if broken:
        raise ValueError(f"no design within {', '.join(broken)} was found: {unfinished or 'none is near'}")
    named = dict(zip((response.name for response in problem.study.responses), values[0].tolist(), strict=True))
    numbers = {vary.name: float(p) for vary, p in zip(problem.vary, point, strict=True)}
    active = tuple(words for words, room in rooms if room < TOLERANCE)
    return Optimum(problem.scene(point), values[0, 0].item(), numbers, named, active, count, problem.exact, unfinished)


def _scale(problem: Problem, point: Array) -> float:
    """The sign and size of the objective for a minimiser: pure numbers as they are, others in units of the first."""
    if problem.objective.unit == "":
        size = 1.0
    else:
        first = problem.values(point[None])[0, 0]
        size = abs(first) if np.isfinite(first) and first else 1.0
    return (-1 if problem.largest else 1) / size


def _by_gradients(
    problem: Problem, start: Array, iterations: int, seed: int, progress: Progress
) -> tuple[Array, int, str]:
    """(the best point, scaled to the ranges; evaluations; why it stopped too early, or "") of SLSQP."""
    from scipy.optimize import minimize

    scale = _scale(problem, problem.points(start))
    known: dict[tuple[bytes, Response], tuple[Array, Array]] = {}

    def value_and_slopes(u: Array, response: Response) -> tuple[Array, Array]:
        key = u.tobytes(), response
        if key not in known:
            point = problem.points(u)
            values, slopes = problem.derived(response, point)
            known[key] = values, slopes * problem.stretch(point)
        return known[key]

    def objective(u: Array) -> tuple[float, Array]:
        values, slopes = value_and_slopes(u, problem.objective)
        progress(evaluations(), float(values[0]))
        return scale * values[0], scale * slopes[0]

    def evaluations() -> int:
        return sum(response == problem.objective for _, response in known)

    def constraint(response: Response, sign: int, bound: float) -> dict[str, Any]:
        unit = sign / _size(bound)
        fun, jac = (
            (lambda u: unit * (value_and_slopes(u, response)[0] - bound)),
            (lambda u: unit * value_and_slopes(u, response)[1]),
        )
        return {"type": "ineq", "fun": fun, "jac": jac}

    sides = [constraint(limit.response, *side) for limit in problem.limits for side in limit.sides]
    options = {"maxiter": iterations, "ftol": 1e-9}
    box = [(0, 1)] * len(start)
    try:
        result = minimize(objective, start, jac=True, method="SLSQP", bounds=box, constraints=sides, options=options)
    except ValueError as error:
        raise ValueError(f"no design was found: a design in the ranges cannot be made ({error})") from None
    return result.x, evaluations(), "" if result.success else result.message


def _by_evolution(
    problem: Problem, start: Array, iterations: int, seed: int, progress: Progress
) -> tuple[Array, int, str]:
    """As `_by_gradients`, by differential evolution."""
    from scipy.optimize import differential_evolution

    scale, seen, best = _scale(problem, problem.points(start)), 0, np.inf

    def scores(u: Array) -> Array:
        nonlocal seen, best
        values = problem.values(problem.points(u.T))
        missing = np.minimum(problem.room(values), 0).sum(axis=1)
        own = np.nan_to_num(scale * values[:, 0], nan=EXCLUDED)
        scores = np.where(missing < 0, EXCLUDED - missing, own)
        seen, best = seen + len(scores), min(best, scores.min())
        progress(seen, best / scale if best < EXCLUDED else np.nan)
        return scores

    box, generator = [(0, 1)] * len(start), np.random.default_rng(seed)
    shared = {"vectorized": True, "updating": "deferred", "polish": False, "tol": 1e-6, "maxiter": iterations}
    result = differential_evolution(scores, box, x0=start, rng=generator, **shared)
    return result.x, seen, "" if result.success else result.message.rstrip(".")


def _rooms(problem: Problem, point: Array, values: Array) -> list[tuple[str, float]]:
    """(words, how far inside relative to its size) of every limit and every end of a range."""
    sides = [(limit.response.name, sign, bound) for limit in problem.limits for sign, bound in limit.sides]
    words = [f"{name} {'>=' if sign > 0 else '<='} {bound:g}" for name, sign, bound in sides]
    rooms = list(zip(words, problem.room(values)[0].tolist(), strict=True))
    for vary, p, low, high in zip(problem.vary, point, *problem.bounds, strict=True):
        rooms.append((f"{vary.name} >= {low:g}", (p - low) / (high - low)))
        rooms.append((f"{vary.name} <= {high:g}", (high - p) / (high - low)))
    return rooms


def search(problem: Problem, count: int, *, seed: int = 0) -> tuple[Array, Array, Array]:
    """(points (count, variables); objective; whether within the limits) of a quasi-random search, Halton's sequence.

    A point that makes no cue has the objective nan.
    """
    from scipy.stats import qmc

    points = problem.points(qmc.Halton(len(problem.vary), seed=seed).random(count))
    values = problem.values(points)
    within = np.isfinite(values[:, 0]) & (problem.room(values) >= 0).all(axis=1)
    return points, values[:, 0], np.asarray(within)


def front(
    problem: Problem, against: Response, *, largest: bool = True, size: int = 40, rounds: int = 40, seed: int = 0
) -> tuple[Array, Array]:
    """Pareto front of the objective and another response: (points (n, variables); both values (n, 2)), in order of the
    objective.

    against: wanted large, or small if ``largest`` is false. NSGA-II of pymoo (the extra "optimize"), a population of
    ``size`` over ``rounds`` generations.
    """
    try:
        from pymoo.algorithms.moo.nsga2 import NSGA2
        from pymoo.core.problem import Problem as Evolved
        from pymoo.optimize import minimize as evolve
    except ImportError as error:
        raise ModuleNotFoundError("front needs pymoo: pip install '.[optimize]' in the clone") from error
    if against == problem.objective:
        raise ValueError(f"front against must be another response than the objective; got {against.name}")
    signs = np.array([-1.0 if problem.largest else 1.0, -1.0 if largest else 1.0])
    low, high = problem.bounds
    shown = replace(problem, limits=(*problem.limits, Limit(against, low=-EXCLUDED)))
    columns = [0, shown.study.responses.index(against)]

    class Shafts(Evolved):
        def _evaluate(self, x: Array, out: dict[str, Array], *_: object, **__: object) -> None:
            values = shown.values(x)
            out["F"] = np.nan_to_num(signs * values[:, columns], nan=EXCLUDED)
            out["G"] = -shown.room(values)

    shafts = Shafts(n_var=len(low), n_obj=2, n_ieq_constr=shown.room(np.ones((1, 99))).shape[1], xl=low, xu=high)
    evolved = evolve(shafts, NSGA2(pop_size=size), ("n_gen", rounds), seed=seed, verbose=False)
    if evolved.X is None:
        raise ValueError("front found no design within the limits")
    order = np.argsort(evolved.F[:, 0])
    return np.atleast_2d(evolved.X)[order], (signs * evolved.F)[order]
