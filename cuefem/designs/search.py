"""Search for the best design of a `Problem`.

SLSQP on finite differences starts at the base design. If it ends outside the limits, differential evolution searches
the ranges and SLSQP continues from there. Values in a list (names of materials) are tried one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cuefem.beam.blas_threads import one_blas_thread
from cuefem.cue import Array
from cuefem.designs.optimum import EXCLUDED, ChoiceResult, Constraint, Optimum, Problem, Round
from cuefem.quantity.fields import check_count

TOLERANCE = 1e-6  # relative to a limit's own size (1 if it is 0): a closer value makes the limit active
INVALID_OBJECTIVE = 1e3  # scaled objective of an invalid design in SLSQP
ZERO_SQUIRT = 1e-7  # rad
STEP = 1e-4  # of differences, relative to a range: a hundred times the numerical error of a strike (1e-6)
POPULATION = 15  # designs per variable in differential evolution


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
            choices.append(ChoiceResult(search.choice, optima[-1].score))
        except ValueError as error:
            reasons.append(str(error))
            choices.append(ChoiceResult(search.choice, np.nan, str(error)))
        count = search.evaluations
    if not optima:
        raise ValueError(reasons[0])
    best = min(optima, key=lambda each: sign * problem.objective.size(each.score))
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
        self.best = min(self.best, self.scores(shares, found.values).min(initial=np.inf))
        return found.values

    def scores(self, shares: Array, values: Array) -> Array:
        """The scores to minimize: the objective, or `EXCLUDED` plus the violation of the limits."""
        violation = np.minimum(self.problem.margins(values) + TOLERANCE, 0).sum(axis=1)
        if self.problem.target is None:
            objective = np.nan_to_num(self.scale * self.problem.sizes(values)[:, 0], nan=EXCLUDED)
        else:
            objective = self.problem.change(shares)
        return np.asarray(np.where(violation < 0, EXCLUDED - violation, objective))

    def report(self, *_: Any, **__: Any) -> None:
        """Count a round and report progress."""
        self.rounds += 1
        found = self.best / self.scale if self.problem.target is None else self.problem.target
        best = found if self.best < EXCLUDED else np.nan
        self.progress(Round(self.choice, self.rounds, self.evaluations, best, self.problem.objective))

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
        u = self.onto_ends(min((u for u, _ in ends), key=lambda u: self.scores(u[None], self.at(u)[None])[0]))
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
            score=float(self.at(u)[0] if self.problem.target is None else self.problem.change(u)),
        )

    def none_found(self, u: Array, violated: Sequence[str]) -> str:
        """The error for a nearest point that lacks responses, or violates limits."""
        nearest = dict(zip(self.problem.study.responses, self.at(u).tolist(), strict=True))
        missing = [response.name for response, value in nearest.items() if not np.isfinite(value)]
        if missing:
            reason = self._reasons[np.clip(u, 0, 1).tobytes()]
            return f"no design that has {', '.join(missing)} was found; of the nearest: {reason}"
        has = ", ".join(f"{response.name} {value:.6g} {response.unit}".strip() for response, value in nearest.items())
        limits = ", ".join(dict.fromkeys(violated))
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

        limits = [
            constraint(responses.index(limit.response), *side) for limit in self.problem.limits for side in limit.sides
        ]
        own, target = self.problem.shares(self.problem.start), self.problem.target
        if target is not None:
            limits.append(constraint(0, 1, target) | {"type": "eq"})

        def objective(u: Array) -> float:
            """The scaled response, or the square of the change to the target."""
            if target is not None:
                return float(np.square(u - own).sum())
            return self.scale * value(u, 0, INVALID_OBJECTIVE / self.scale)

        def slope(u: Array) -> Array:
            return self.scale * self.slopes(u)[0] if target is None else 2 * (u - own)

        try:
            result = minimize(
                objective,
                start,
                jac=slope,
                method="SLSQP",
                bounds=[(0, 1)] * len(start),
                constraints=limits,
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
            lambda u: self.scores(u.T, self.rows(u.T)),
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
            for limit in self.problem.bounds
            for sign, bound in limit.sides
        ]
        margins = list(zip(limits, self.problem.margins(self.at(u)[None])[0].tolist(), strict=True))
        for (i, span), share in zip(self.problem.spans.items(), u.tolist(), strict=True):
            name = self.problem.vary[i].name
            margins += [(Constraint(name, ">=", span.low), share), (Constraint(name, "<=", span.high), 1 - share)]
        return margins

    def _text(self, constraint: Constraint) -> str:
        """A constraint in words, the target as one."""
        is_target = (constraint.name, constraint.bound) == (self.problem.objective.name, self.problem.target)
        return f"{constraint.name} = {constraint.bound:g} (target)" if is_target else str(constraint)

    def violated(self, u: Array) -> list[str]:
        """The limits that a point violates."""
        return [self._text(constraint) for constraint, margin in self.margins(u) if not margin >= -TOLERANCE]
