"""The cue of least squirt under limits, by exact gradients; and fronts of squirt against another quantity.

A design is a point of numbers (`Variable`) that move fields of a cue's segments linearly. Squirt is its small-offset
limit over phi; its gradient and those of all limits are exact (`cuefem.design.gradient`), so SLSQP wants tens of
evaluations.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import minimize
from scipy.stats import qmc

from cuefem.cue import Array, Cue, SegmentRows
from cuefem.design.batch import CueBatch, batch_frequencies, batch_stick
from cuefem.design.gradient import densities_to, drawing, gradient
from cuefem.design.sensitivity import frequency_sensitivity
from cuefem.quantity import check_kind
from cuefem.scene import Resolution, Scene

QUANTITIES = ("squirt", "tip_stiffness", "tip_diameter", "wall", "mass", "balance_point", "first_frequency")
SHAPES = SegmentRows._fields[:5]  # what a variable may move
MODEST = Resolution(2, 8, 12)  # for speed: for numbers to trust give a finer one
TOLERANCE = 1e-6  # of a limit's own size (1 where it is 0): how near its value is to be named active


@dataclass(frozen=True)
class Variable:
    """A number that moves fields of a cue: each is its value in the base cue + slope (number - start).

    fields: {(segment, field): slope}, field one of `SHAPES`. Bounds low <= start <= high, SI.
    """

    name: str
    low: float
    high: float
    start: float
    fields: Mapping[tuple[int, str], float]

    def __post_init__(self) -> None:
        if not self.low < self.high or not self.low <= self.start <= self.high:
            raise ValueError(
                f"Variable {self.name!r} must have low < high and start in [low, high]; got {self.low}, "
                f"{self.high} and {self.start}"
            )
        for _, field in self.fields:
            if field not in SHAPES:
                raise ValueError(f"Variable {self.name!r} must move fields among {', '.join(SHAPES)}; got {field!r}")


@dataclass(frozen=True)
class Limit:
    """A quantity of `QUANTITIES` held in [low, high], SI.

    tip_stiffness: N/m, force over deflection with the last segment's end clamped. tip_diameter: m. wall: least wall
    of a bored section, m. mass, balance_point: of the segments, kg and m from the tip. first_frequency: Hz, free.
    """

    quantity: str
    low: float = -np.inf
    high: float = np.inf

    def __post_init__(self) -> None:
        if self.quantity not in QUANTITIES[1:]:
            raise ValueError(f"Limit.quantity must be one of {', '.join(QUANTITIES[1:])}; got {self.quantity!r}")
        if not self.low <= self.high or not np.isfinite([self.low, self.high]).any():
            raise ValueError(f"Limit {self.quantity} must have low <= high, one finite; got {self.low} and {self.high}")


@dataclass(frozen=True)
class Optimum:
    """The best design found.

    numbers: of the variables, by name. values: of the quantities asked for, by name. active: names of the limits and
    bounds that hold it, as "tip_stiffness >= 1500.0". evaluations: of squirt and its gradient.
    """

    cue: Cue
    squirt: float
    numbers: dict[str, float]
    values: dict[str, float]
    active: tuple[str, ...]
    evaluations: int


@dataclass(frozen=True)
class Design:
    """A scene whose cue varies: the problem that `least_squirt`, `search` and `front` solve."""

    scene: Scene
    variables: tuple[Variable, ...]
    limits: tuple[Limit, ...] = ()
    at: Resolution = MODEST

    def __post_init__(self) -> None:
        check_kind("Design.scene.cue", self.scene.cue, Cue)
        if self.scene.effects:
            raise ValueError(f"Design takes a scene without effects; got {len(self.scene.effects)}")
        if not self.variables:
            raise ValueError("Design must hold at least one Variable; got none")
        count = len(self.base.length)
        for variable in self.variables:
            for segment, _ in variable.fields:
                if not 0 <= segment < count:
                    raise ValueError(f"Variable {variable.name!r} must move segments 0 to {count - 1}; got {segment}")

    @property
    def base(self) -> SegmentRows:
        """The base cue's numbers, arrays (segments,)."""
        return drawing(self.scene.shaft)

    @property
    def start(self) -> Array:
        """The base design, (variables,)."""
        return np.array([v.start for v in self.variables])

    @property
    def bounds(self) -> Array:
        """Low and high, (2, variables)."""
        return np.array([[v.low for v in self.variables], [v.high for v in self.variables]])

    def rows(self, points: Array) -> SegmentRows:
        """Numbers of the cues at points (..., variables), arrays (..., segments)."""
        shape = (*points.shape[:-1], len(self.base.length))
        moved = {name: np.broadcast_to(row, shape).astype(points.dtype) for name, row in self.base._asdict().items()}
        for k, variable in enumerate(self.variables):
            for (segment, field), slope in variable.fields.items():
                moved[field][..., segment] += slope * (points[..., k] - variable.start)
        return SegmentRows(**moved)

    def cue(self, point: Array) -> Cue:
        """The cue at a point; ValueError where it cannot be made."""
        rows = self.rows(point)
        shapes: list[dict[str, Any]] = [
            {name: float(getattr(rows, name)[i]) for name in SHAPES} for i in range(len(rows.length))
        ]
        segments = (replace(s, **shape) for s, shape in zip(self.scene.shaft.segments, shapes, strict=True))
        return replace(self.scene.shaft, segments=tuple(segments))

    def along(self, to: SegmentRows) -> Array:
        """A gradient to the drawing's numbers as one to the variables, (variables,)."""
        moves = ([getattr(to, f)[i] * slope for (i, f), slope in v.fields.items()] for v in self.variables)
        return np.array([sum(each) for each in moves])

    def quantity(self, name: str, points: Array) -> Array:
        """A quantity of `QUANTITIES` at points (n, variables): (n, parts), for "wall" a part an end of a bored segment.

        Complex points for all but "squirt" and "first_frequency".
        """
        rows = self.rows(points)
        batch = CueBatch(rows, np.full(len(points), self.scene.shaft.body_mass))
        match name:
            case "squirt":
                return batch_stick(batch, self.scene, at=self.at).squirt[:, None]
            case "first_frequency":
                return batch_frequencies(batch, 1, at=self.at)
            case "tip_diameter":
                return rows.tip_diameter[:, :1]
            case "wall":
                walls = [(rows.tip_diameter - rows.tip_bore) / 2, (rows.butt_diameter - rows.butt_bore) / 2]
                return np.concatenate(walls, axis=1)[:, np.tile(self._bored, 2)]
            case "mass":
                return batch.shaft_mass[:, None]
        return np.asarray(getattr(batch, name))[:, None]

    @property
    def _bored(self) -> Array:
        """Which segments have, or can get, a bore, (segments,)."""
        moved = {i for variable in self.variables for i, field in variable.fields if field.endswith("bore")}
        base = self.base
        return np.array([i in moved or base.tip_bore[i] + base.butt_bore[i] > 0 for i in range(len(base.length))])

    def slopes(self, name: str, point: Array) -> Array:
        """Exact derivatives of a quantity to the variables, (parts, variables); not of "squirt": see `gradient`."""
        if name == "first_frequency":
            cue = self.cue(point)
            found = frequency_sensitivity(replace(self.scene, cue=cue), 1, self.at)
            return self.along(densities_to(found, drawing(cue)))[None]
        step = 1e-30
        return np.imag(self.quantity(name, point + 1j * step * np.eye(len(point)))).T / step

    def possible(self, points: Array) -> Array:
        """Which points are cues at all: lengths and diameters above 0, bores in [0, diameter); (n,) of booleans."""
        rows = self.rows(points)
        good = (rows.length > 0) & (rows.tip_bore >= 0) & (rows.butt_bore >= 0)
        good &= (rows.tip_diameter > rows.tip_bore) & (rows.butt_diameter > rows.butt_bore)
        return np.asarray(good.all(axis=1))

    def room(self, points: Array) -> Array:
        """How far points are inside the limits, relative to each limit's size, below 0 outside; (n, constraints)."""
        found = [np.full((len(points), 1), np.inf)]
        for limit in self.limits:
            values = self.quantity(limit.quantity, points)
            found += [sign * (values - value) / _size(value) for sign, value in _sides(limit)]
        return np.concatenate(found, axis=1)


def _sides(limit: Limit) -> list[tuple[int, float]]:
    return [(sign, value) for sign, value in ((1, limit.low), (-1, limit.high)) if np.isfinite(value)]


def _size(value: float) -> float:
    return abs(value) or 1.0


def least_squirt(design: Design, *, start: Array | None = None, iterations: int = 60) -> Optimum:
    """The design of least small-offset squirt within bounds and limits, from ``start`` (left out, the base cue).

    SLSQP in numbers scaled to their bounds, every gradient exact. A local optimum; `search` tells whether a better one
    lies elsewhere. ValueError where no design near is within the limits, naming those it breaks.
    """
    low, high = design.bounds
    asked: dict[bytes, tuple[float, Array]] = {}

    def squirt(u: Array) -> tuple[float, Array]:
        if u.tobytes() not in asked:
            point = np.clip(low + u * (high - low), low, high)
            found = gradient(replace(design.scene, cue=design.cue(point)), "stick", design.at)
            assert found.squirt is not None
            assert found.squirt_to is not None
            asked[u.tobytes()] = found.squirt, design.along(found.squirt_to) * (high - low)
        return asked[u.tobytes()]

    first = (design.start if start is None else np.asarray(start, float)) - low
    result = minimize(
        squirt,
        first / (high - low),
        jac=True,
        method="SLSQP",
        bounds=[(0, 1)] * len(low),
        constraints=[_constraint(design, limit, side) for limit in design.limits for side in _sides(limit)],
        options={"maxiter": iterations, "ftol": 1e-9},
    )
    point = np.clip(low + result.x * (high - low), low, high)
    broken = [text for text, room in _rooms(design, point) if room < -TOLERANCE]
    if broken or not result.success:
        raise ValueError(f"least_squirt found no design within {', '.join(broken) or 'the limits'}: {result.message}")
    names = dict.fromkeys(("squirt", *(limit.quantity for limit in design.limits)))
    values = {name: float(design.quantity(name, point[None]).min()) for name in names}
    active = tuple(text for text, room in _rooms(design, point) if room < TOLERANCE)
    numbers = {v.name: float(p) for v, p in zip(design.variables, point, strict=True)}
    return Optimum(design.cue(point), float(result.fun), numbers, values, active, len(asked))


def _constraint(design: Design, limit: Limit, side: tuple[int, float]) -> dict[str, Any]:
    low, high = design.bounds
    sign, value = side
    scale = sign / _size(value)

    def point(u: Array) -> Array:
        return np.clip(low + u * (high - low), low, high)

    return {
        "type": "ineq",
        "fun": lambda u: scale * (design.quantity(limit.quantity, point(u)[None])[0] - value),
        "jac": lambda u: scale * design.slopes(limit.quantity, point(u)) * (high - low),
    }


def _rooms(design: Design, point: Array) -> list[tuple[str, float]]:
    """(words, how far inside relative to its size) of every limit and bound."""
    found = []
    for limit in design.limits:
        values = design.quantity(limit.quantity, point[None])[0]
        for sign, value in _sides(limit):
            text = f"{limit.quantity} {'>=' if sign > 0 else '<='} {value:g}"
            found.append((text, float((sign * (values - value)).min() / _size(value))))
    for variable, p in zip(design.variables, point, strict=True):
        width = variable.high - variable.low
        found.append((f"{variable.name} >= {variable.low:g}", (p - variable.low) / width))
        found.append((f"{variable.name} <= {variable.high:g}", (variable.high - p) / width))
    return found


def search(design: Design, count: int, *, seed: int = 0) -> tuple[Array, Array, Array]:
    """(points (count, variables); squirt over phi; whether within the limits) of a quasi-random search.

    Halton's sequence over the bounds, worked as arrays; points that make no cue have squirt nan.
    """
    points = qmc.scale(qmc.Halton(len(design.variables), seed=seed).random(count), *design.bounds)
    good = design.possible(points)
    squirt, within = np.full(count, np.nan), np.zeros(count, bool)
    squirt[good] = design.quantity("squirt", points[good])[:, 0]
    within[good] = (design.room(points[good]) >= 0).all(axis=1)
    return points, squirt, within


def front(
    design: Design, against: str, *, largest: bool = True, size: int = 40, rounds: int = 40, seed: int = 0
) -> tuple[Array, Array]:
    """Pareto front of squirt against another quantity: (points (n, variables); (squirt, quantity) (n, 2)), by squirt.

    against: of `QUANTITIES`, wanted large, or small with ``largest`` false. NSGA-II of pymoo (the extra "optimize"),
    a population of ``size`` over ``rounds`` generations, worked as arrays.
    """
    if against not in QUANTITIES[1:]:
        raise ValueError(f"front against must be one of {', '.join(QUANTITIES[1:])}; got {against!r}")
    try:
        from pymoo.algorithms.moo.nsga2 import NSGA2
        from pymoo.core.problem import Problem
        from pymoo.optimize import minimize as evolve
    except ImportError as error:
        raise ModuleNotFoundError("front needs pymoo: pip install '.[optimize]' in the clone") from error
    sign = -1.0 if largest else 1.0
    low, high = design.bounds

    class Shafts(Problem):
        def _evaluate(self, x: Array, out: dict[str, Array], *_: object, **__: object) -> None:
            good = design.possible(x)
            out["F"], room = np.full((len(x), 2), 1e9), np.full((len(x), constraints), -1.0)
            if good.any():
                both = (design.quantity("squirt", x[good])[:, 0], sign * design.quantity(against, x[good]).min(axis=1))
                out["F"][good] = np.stack(both, axis=1)
                room[good] = np.minimum(design.room(x[good]), 1e9)
            out["G"] = -room

    constraints = design.room(design.start[None]).shape[1]
    problem = Shafts(n_var=len(low), n_obj=2, n_ieq_constr=constraints, xl=low, xu=high)
    found = evolve(problem, NSGA2(pop_size=size), ("n_gen", rounds), seed=seed, verbose=False)
    if found.X is None:
        raise ValueError("front found no design within the limits")
    order = np.argsort(found.F[:, 0])
    return np.atleast_2d(found.X)[order], found.F[order] * (1.0, sign)
