"""The trade-off between two responses: for limits on one of them, the designs that are best for the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from cuefem.cue import Array
from cuefem.designs.evaluation import Response
from cuefem.designs.optimum import Limit, Optimum, OptimumResult, Problem, Round
from cuefem.designs.sampling import Value
from cuefem.designs.search import optimum
from cuefem.designs.study_table import column_label, shown
from cuefem.quantity.display_units import to_display, with_heading
from cuefem.results.records import Record, Table
from cuefem.show.charts import Axis, Chart, Curve, Dots, chart
from cuefem.show.drawings import CueDrawing

SHORTEST = 1e-3  # distance of two designs, relative to the whole trade-off, between which no other is searched
FRONT_NOTE = "each design is the best for its own limit on the other result"


def trade_off(
    problem: Problem,
    *,
    rounds: int = 60,
    progress: Callable[[Round], object] = lambda round: None,
) -> tuple[Optimum, ...]:
    """The designs of a trade-off, from the best one for the objective to the best one for the other response.

    Parameters
    ----------
    problem : Problem
        With the response that its objective is traded ``against``.
    rounds : int, optional
        As of `optimum`, of each search.
    progress : callable, optional
        As of `optimum`.

    Returns
    -------
    tuple of Optimum
        At most ``problem.count`` designs. Fewer if no design is between two, as where one is the best for both.

    Raises
    ------
    ValueError
        If the response that it is traded against has no preferred direction; as of `optimum`.

    Notes
    -----
    Limits on one response (Haimes, Lasdon & Wismer 1971) where the designs are needed: the longest piece of the curve,
    in units of the distances between its ends, is halved. The limit is on the response that differs more between the
    ends of the piece, so that steep and flat ends have as many designs as the middle.
    """
    assert problem.against is not None
    if not problem.against.result.better:
        raise ValueError(
            f"against must be a result of which high or low is better; got {problem.against.name}: "
            f"take a limit on {problem.against.name}"
        )
    aims = {problem.objective: problem.maximize, problem.against: problem.against.result.better == "higher"}
    search = _Front(problem, aims, rounds, progress)
    best = optimum(problem, rounds=rounds, progress=progress)
    designs, searched = [best, search.other_end(best)], set[tuple[int, int]]()
    while len(designs) < problem.count:
        pieces = search.pieces(designs)
        pairs = [(id(one), id(other)) for one, other in pairwise(designs)]
        lengths = np.hypot(*pieces.T)
        lengths[[pair in searched for pair in pairs]] = 0.0
        i = int(lengths.argmax())
        if not lengths[i] > SHORTEST:
            break
        between = search.between(designs[i], designs[i + 1], on_second=bool(pieces[i, 1] >= pieces[i, 0]))
        if between is None:
            searched.add(pairs[i])
        else:
            designs.insert(i + 1, between)
    return tuple(designs)


@dataclass(frozen=True)
class _Front:
    """Searches for designs of a trade-off; aims: whether each of the two responses is maximized."""

    problem: Problem
    aims: dict[Response, bool]
    rounds: int
    progress: Callable[[Round], object]

    def values(self, designs: list[Optimum]) -> Array:
        """The two responses of designs as they are compared, (designs, 2)."""
        return np.array([[each.size(design.responses[each.name]) for each in self.aims] for design in designs], float)

    def pieces(self, designs: list[Optimum]) -> Array:
        """The distances of neighbours in the two responses, relative to those of the ends, (designs - 1, 2)."""
        values = self.values(designs)
        whole = abs(values[-1] - values[0])
        steps = abs(np.diff(values, axis=0))
        return np.divide(steps, whole, out=np.zeros_like(steps), where=whole > 0)

    def other_end(self, best: Optimum) -> Optimum:
        """The best design for the second response, and of those for the first."""
        found = self.best_for(1, None, best)
        assert found is not None
        bound = float(self.values([found])[0, 1])
        return self.best_for(0, bound, found) or found

    def between(self, one: Optimum, other: Optimum, *, on_second: bool) -> Optimum | None:
        """The best design for a limit halfway between two designs; None if it is not between them."""
        values = self.values([one, other])
        limited = 1 if on_second else 0
        found = self.best_for(1 - limited, float(values[:, limited].mean()), one, other)
        if found is None:
            return None
        here, ends = self.values([found])[0], np.sort(values, axis=0)
        return found if ((ends[0] < here) & (here < ends[1])).all() else None

    def best_for(self, k: int, bound: float | None, *near: Optimum) -> Optimum | None:
        """The best design for one of the two responses, with a limit on the other, searched from the middle of others.

        None if none is within the limits.
        """
        responses = [*self.aims]
        objective, other = responses[k], responses[1 - k]
        limits = self.problem.limits
        if bound is not None:
            limits += (Limit(other, low=bound) if self.aims[other] else Limit(other, high=bound),)
        case = replace(self.problem, objective=objective, against=other, maximize=self.aims[objective], limits=limits)
        names = [self.problem.vary[i].name for i in self.problem.spans]
        start = np.array([[each.values[name] for name in names] for each in near], float).mean(axis=0)
        try:
            return optimum(case, start=start, rounds=self.rounds, progress=self.progress)
        except ValueError:
            return None


@dataclass(frozen=True, repr=False)
class TradeOffResult(OptimumResult):
    """The result of an optimization against another response: the best design, and those of the trade-off.

    Parameters
    ----------
    trade_off : tuple of Optimum
        From the best design for the objective to the best one for the other response.
    """

    trade_off: tuple[Optimum, ...] = field(default=(), repr=False, kw_only=True)

    def _values(self) -> Iterator[tuple[Value, ...]]:
        return iter([tuple(design.values.values()) for design in self.trade_off])

    def _computed(self) -> int:
        return self.optimum.evaluations + sum(design.evaluations for design in self.trade_off[1:])

    @property
    def two(self) -> tuple[Response, Response]:
        """The objective, and the response that it is traded against."""
        assert self.definition.against is not None
        return self.definition.objective, self.definition.against

    def active(self, design: Optimum) -> list[str]:
        """The limits and ranges whose ends a design has reached, without the limit that made it."""
        two = {response.name for response in self.two}
        asked = {(limit.response.name, bound) for limit in self.definition.limits for _, bound in limit.sides}
        active = (each.name for each in design.active if each.name not in two or (each.name, each.bound) in asked)
        return [*dict.fromkeys(active)]

    def values(self) -> Record:
        """The best design, and the designs of the trade-off."""
        designs = [
            {"values": each.values, "responses": each.responses, "active": self.active(each)} for each in self.trade_off
        ]
        return super().values() | {"trade_off": {"of": [each.name for each in self.two], "designs": designs}}

    def tables(self) -> list[Table | str]:
        """Varied parameters, the best design, and a row for each design of the trade-off."""
        study = self.study
        units = study.units[: len(study.vary)]
        labels = [column_label(vary.name) for vary in study.vary]
        head = ("design", *(each.heading for each in self.two), *map(with_heading, labels, units))
        rows = tuple(
            (
                str(i),
                *(shown(each.responses[response.name], response.display_key) for response in self.two),
                *(shown(value, unit) for value, unit in zip(each.values.values(), units, strict=True)),
            )
            for i, each in enumerate(self.trade_off)
        )
        title = f"Trade-off, {self.two[0].label} against {self.two[1].label}"
        notes = (FRONT_NOTE, *filter(None, map(self._limits_text, range(len(self.trade_off)))))
        return [*super().tables(), Table(title, head, rows, notes)]

    def _limits_text(self, i: int) -> str:
        """The limits and ranges whose ends a design of the trade-off has reached; empty if there are none."""
        active = [*map(self._label, self.active(self.trade_off[i]))]
        return f"design {i} is at the limit of {', '.join(active)}" if active else ""

    def charts(self) -> list[Chart | CueDrawing]:
        """The trade-off with the unmodified design; drawings of that and of the best one."""
        designs = [*self.trade_off, self.start]
        y, x = (to_display([each.responses[of.name] for each in designs], of.display_key) for of in self.two)
        front = [Dots("", x[i : i + 1], y[i : i + 1], "c1", f"design {i}") for i in range(len(self.trade_off))]
        drawn = chart(
            f"Trade-off: {self.two[0].label}",
            [Curve("best designs", x[:-1], y[:-1], "c1")],
            x=Axis(self.two[1].heading, from_zero=False),
            y=Axis(self.two[0].heading, from_zero=False),
            points=[*front, Dots("start", x[-1:], y[-1:], "c5")],
        )
        return [drawn, *super().charts()]
