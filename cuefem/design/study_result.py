"""What a study found: its designs and responses with their units, the best of them, and how much they scatter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cuefem.cue import Array
from cuefem.design.optimum import Optimum, Problem, optimum
from cuefem.design.scatter import Drivers, Scatter, drivers_of
from cuefem.design.study import Study, StudyDesign
from cuefem.design.sweep import MemoryStore, Pool, Row, Store, sweep
from cuefem.results.quantities import with_unit

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of the designs below a quantile


@dataclass(frozen=True, repr=False)
class StudyResult:
    """What a study found.

    Parameters
    ----------
    asked : Study, Scatter or Problem
        The study.
    rows : tuple of Row
        A row a design, in the order of the designs; of an optimum the best design alone.
    optimum : Optimum, optional
        Of a study with an objective: its best design, and which limits hold it.
    drivers : Drivers, optional
        Of a study with tolerances: which part of each response's variance which cause has (Sobol indices).

    Attributes
    ----------
    kind : str
        "sweep", "scatter" or "optimum".
    units : dict
        SI units by the names of what varies and of the responses, "" for pure numbers and names.
    designs : dict
        What varies by its name, arrays (designs,).
    responses : dict
        Responses by their names, arrays (designs,), nan where one is missing.
    failures : dict
        Why a design lacks a response, by the number of the design.
    best : dict
        The best design by the name of the response that it is best for: its ``scene``, ``values`` and ``responses``.
        Of a scatter, which is no choice, empty.
    spread : dict
        Mean, standard deviation ("sd") and quantiles ("5 %", ...) of each response over the designs, of a scatter over
        its two independent samples.
    """

    asked: Study | Scatter | Problem
    rows: tuple[Row, ...]
    optimum: Optimum | None = None
    drivers: Drivers | None = None

    @property
    def kind(self) -> str:
        """Of which kind the study is."""
        return "optimum" if self.optimum else "scatter" if self.drivers else "sweep"

    @property
    def study(self) -> Study:
        """What varies, and what is asked."""
        return self.asked if isinstance(self.asked, Study) else self.asked.study

    @property
    def units(self) -> dict[str, str]:
        """SI units of all columns."""
        return dict(zip(self.study.columns, self.study.units, strict=True))

    @cached_property
    def designs(self) -> dict[str, np.ndarray]:
        """What varies."""
        columns = zip(*(row.values for row in self.rows), strict=True)
        return {vary.name: np.array(column) for vary, column in zip(self.study.vary, columns, strict=True)}

    @cached_property
    def responses(self) -> dict[str, Array]:
        """The responses."""
        columns = np.array([row.responses for row in self.rows], float).T
        return {response.name: column for response, column in zip(self.study.responses, columns, strict=True)}

    @property
    def failures(self) -> dict[int, str]:
        """Why designs lack a response."""
        return {row.design: row.failure for row in self.rows if row.failure}

    @cached_property
    def best(self) -> dict[str, StudyDesign]:
        """The best design for each response of which one way is better; for all, the lowest, if there is none."""
        if self.optimum or self.drivers:
            return {self.study.responses[0].name: self.optimum} if self.optimum else {}
        judged = [response for response in self.study.responses if response.result.better] or self.study.responses
        found = dict[str, StudyDesign]()
        for response in judged:
            column = self.responses[response.name]
            if np.isfinite(column).any():
                i = int(np.nanargmax(column) if response.result.better == "higher" else np.nanargmin(column))
                found[response.name] = self._design(i)
        return found

    def _design(self, i: int) -> StudyDesign:
        row, names = self.rows[i], [vary.name for vary in self.study.vary]
        numbers = {name: float(column[i]) for name, column in self.responses.items()}
        return StudyDesign(self.study.scene(row.values), dict(zip(names, row.values, strict=True)), numbers)

    @cached_property
    def spread(self) -> dict[str, dict[str, float]]:
        """How the responses are distributed."""
        independent = slice(2 * self.asked.count if isinstance(self.asked, Scatter) else None)
        columns = {name: column[independent] for name, column in self.responses.items()}
        columns = {name: column[np.isfinite(column)] for name, column in columns.items()}
        return {
            name: {"mean": float(column.mean()), "sd": float(column.std(ddof=1))}
            | {f"{100 * s:g} %": float(q) for s, q in zip(SHARES, np.quantile(column, SHARES), strict=True)}
            for name, column in columns.items()
            if len(column) > 1
        }

    def _lines(self) -> list[tuple[str, ...]]:
        """A line a response: its name, what there is of it, and the design where it is the best."""
        lines = list[tuple[str, ...]]()
        for response in self.study.responses:
            best = self.best.get(response.name) or self.optimum
            spread = self.spread.get(response.name)
            if best is not None:
                at = ", ".join(
                    f"{name} {value if isinstance(value, str) else with_unit(value, self.units[name])}"
                    for name, value in best.values.items()
                )
                lines.append((response.name, with_unit(best.responses[response.name], response.unit), at))
            elif spread is not None:
                lines.append((response.name, with_unit(spread["mean"], response.unit, error=spread["sd"]), "mean ± sd"))
        return lines

    def __repr__(self) -> str:
        failed = f", {len(self.failures)} without an answer" if self.failures else ""
        count = self.optimum.evaluations if self.optimum else len(self.rows)
        head = f"StudyResult({self.kind} of {count} designs{failed})"
        return "\n  ".join([head, *(f"{name}: {value}, {at}" for name, value, at in self._lines())])


def found(
    asked: Study | Scatter | Problem,
    *,
    store: Store | None = None,
    pool: Pool | None = None,
    progress: Callable[[Any], object] = lambda reached: None,
    rounds: int = 60,
) -> StudyResult:
    """Compute a study.

    store: where designs go, and what is known already; by default they end with the result. pool: as in `sweep`.
    progress: called with the rows of each block, of an optimum with each `Round`. rounds: of an optimum. An optimum
    takes neither store nor pool.
    """
    if isinstance(asked, Problem):
        best = optimum(asked, rounds=rounds, progress=progress)
        row = Row(0, tuple(best.values.values()), tuple(best.responses.values()), None)
        return StudyResult(asked, (row,), best)
    designs = asked.designs if isinstance(asked, Scatter) else asked
    store = MemoryStore() if store is None else store
    sweep(designs, store, pool=pool, progress=progress)
    rows = tuple(store.rows())
    return StudyResult(asked, rows, None, drivers_of(asked, rows) if isinstance(asked, Scatter) else None)
