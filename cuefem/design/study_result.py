"""The result of a study: designs and responses with units, the best designs, and the spread of the responses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cuefem.cue import Array
from cuefem.design.optimum import Optimum, Problem, optimum
from cuefem.design.scatter import Scatter, SobolIndices, sobol_indices_of
from cuefem.design.study import Study, StudyDesign
from cuefem.design.sweep import MemoryStore, Row, Store, sweep
from cuefem.results.quantities import with_unit

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of the designs below a quantile


@dataclass(frozen=True, repr=False)
class StudyResult:
    """The result of a study.

    Parameters
    ----------
    definition : Study, Scatter or Problem
        The study.
    rows : tuple of Row
        One row per design, in order; of an optimization only the best design.
    optimum : Optimum, optional
        Of a study with an objective: the best design and its active limits.
    sobol_indices : SobolIndices, optional
        Of a study with tolerances: Sobol indices of each response.

    Attributes
    ----------
    kind : str
        "sweep", "scatter" or "optimum".
    units : dict
        SI units by the names of parameters and responses, "" for pure numbers and names.
    designs : dict
        Parameter values by name, arrays (designs,).
    responses : dict
        Responses by name, arrays (designs,), nan if missing.
    failures : dict
        Reasons for missing responses, by the number of the design.
    best : dict
        The best design for each response, by its name: ``scene``, ``values`` and ``responses``. Empty for a scatter.
    spread : dict
        Mean, standard deviation ("sd") and quantiles ("5 %", ...) of each response over the designs, of a scatter over
        its two independent samples.
    """

    definition: Study | Scatter | Problem
    rows: tuple[Row, ...]
    optimum: Optimum | None = None
    sobol_indices: SobolIndices | None = None

    @property
    def kind(self) -> str:
        """ "sweep", "scatter" or "optimum"."""
        return "optimum" if self.optimum else "scatter" if self.sobol_indices else "sweep"

    @property
    def study(self) -> Study:
        """Parameters and responses."""
        return self.definition if isinstance(self.definition, Study) else self.definition.study

    @property
    def units(self) -> dict[str, str]:
        """SI units of all columns."""
        return dict(zip(self.study.columns, self.study.units, strict=True))

    @cached_property
    def designs(self) -> dict[str, np.ndarray]:
        """Parameter values."""
        columns = zip(*(row.values for row in self.rows), strict=True)
        return {vary.name: np.array(column) for vary, column in zip(self.study.vary, columns, strict=True)}

    @cached_property
    def responses(self) -> dict[str, Array]:
        """The responses."""
        columns = np.array([row.responses for row in self.rows], float).T
        return {response.name: column for response, column in zip(self.study.responses, columns, strict=True)}

    @property
    def failures(self) -> dict[int, str]:
        """Reasons for missing responses."""
        return {row.design: row.failure for row in self.rows if row.failure}

    @cached_property
    def best(self) -> dict[str, StudyDesign]:
        """The best design for each response with a preferred direction; if none has one, the lowest of each."""
        if self.optimum or self.sobol_indices:
            return {self.study.responses[0].name: self.optimum} if self.optimum else {}
        ranked = [response for response in self.study.responses if response.result.better] or self.study.responses
        best = dict[str, StudyDesign]()
        for response in ranked:
            column = self.responses[response.name]
            if np.isfinite(column).any():
                best[response.name] = self._design(int(np.nanargmin(response.loss(column))))
        return best

    def _design(self, i: int) -> StudyDesign:
        row, names = self.rows[i], [vary.name for vary in self.study.vary]
        numbers = {name: float(column[i]) for name, column in self.responses.items()}
        return StudyDesign(self.study.scene(row.values), dict(zip(names, row.values, strict=True)), numbers)

    @cached_property
    def spread(self) -> dict[str, dict[str, float]]:
        """Mean, standard deviation and quantiles of the responses."""
        independent = slice(2 * self.definition.count if isinstance(self.definition, Scatter) else None)
        columns = {name: column[independent] for name, column in self.responses.items()}
        columns = {name: column[np.isfinite(column)] for name, column in columns.items()}
        return {
            name: {"mean": float(column.mean()), "sd": float(column.std(ddof=1))}
            | {f"{100 * s:g} %": float(q) for s, q in zip(SHARES, np.quantile(column, SHARES), strict=True)}
            for name, column in columns.items()
            if len(column) > 1
        }

    def _lines(self) -> list[tuple[str, ...]]:
        """A line per response: its name, its best value or mean, and the best design."""
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
        failed = f", {len(self.failures)} failed" if self.failures else ""
        count = self.optimum.evaluations if self.optimum else len(self.rows)
        title = f"StudyResult({self.kind} of {count} designs{failed})"
        return "\n  ".join([title, *(f"{name}: {value}, {at}" for name, value, at in self._lines())])


def compute_study(
    definition: Study | Scatter | Problem,
    *,
    store: Store | None = None,
    workers: int | None = None,
    progress: Callable[[Any], object] = lambda step: None,
    rounds: int = 60,
) -> StudyResult:
    """Compute a study.

    store: stored designs; by default none. workers: as in `sweep`. progress: called with the rows of each block, in an
    optimization with each `Round`. rounds: of an optimization, which has neither store nor workers.
    """
    if isinstance(definition, Problem):
        best = optimum(definition, rounds=rounds, progress=progress)
        row = Row(0, tuple(best.values.values()), tuple(best.responses.values()), None)
        return StudyResult(definition, (row,), best)
    designs = definition.sobol_study if isinstance(definition, Scatter) else definition
    store = MemoryStore() if store is None else store
    sweep(designs, store, workers=workers, progress=progress)
    rows = tuple(store.rows())
    drivers = sobol_indices_of(definition, rows) if isinstance(definition, Scatter) else None
    return StudyResult(definition, rows, None, drivers)
