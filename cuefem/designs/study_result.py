"""The result of a study: designs and responses with units, the best designs, and the spread of the responses."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from cuefem.cue import Array
from cuefem.designs.optimum import Optimum, Problem, optimum
from cuefem.designs.sampling import Value
from cuefem.designs.scatter import Scatter, SobolIndices, sobol_indices_of
from cuefem.designs.study import Study, StudyDesign
from cuefem.designs.sweep import Columns, Row, Store, sweep
from cuefem.results.quantities import with_unit

if TYPE_CHECKING:
    import pandas as pd

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of the designs below a quantile


@dataclass(frozen=True, repr=False)
class StudyResult:
    """The result of a study.

    Parameters
    ----------
    definition : Study, Scatter or Problem
        The study.
    columns : Columns
        The responses of the designs, in order; of an optimization only the best design.
    optimum : Optimum, optional
        Of a study with an objective: the best design and its active limits.
    sobol_indices : SobolIndices, optional
        Of a study with tolerances: Sobol indices of each response.

    Attributes
    ----------
    count : int
        Number of designs.
    rows : iterator of Row
        The designs one by one: number, values, responses (None if missing) and failure.
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
    columns: Columns
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
    def count(self) -> int:
        """Number of designs."""
        return len(self.columns.values)

    @property
    def rows(self) -> Iterator[Row]:
        """The designs one by one, in order."""
        return (self.columns.row(design, values) for design, values in enumerate(self._values()))

    def _values(self) -> Iterator[tuple[Value, ...]]:
        """The parameter values of the designs, which the definition determines."""
        if self.optimum is not None:
            return iter([tuple(self.optimum.values.values())])
        return designs_of(self.definition).designs()

    @property
    def units(self) -> dict[str, str]:
        """SI units of all columns."""
        return dict(zip(self.study.columns, self.study.units, strict=True))

    @cached_property
    def designs(self) -> dict[str, np.ndarray]:
        """Parameter values."""
        kinds = [type(values) for values in next(self._values())]
        columns = [np.empty(self.count, object if kind is str else float) for kind in kinds]
        for design, values in enumerate(self._values()):
            for column, value in zip(columns, values, strict=True):
                column[design] = value
        columns = [column.astype(str) if kind is str else column for kind, column in zip(kinds, columns, strict=True)]
        return {vary.name: column for vary, column in zip(self.study.vary, columns, strict=True)}

    @cached_property
    def responses(self) -> dict[str, Array]:
        """The responses."""
        columns = self.columns.values.T
        return {response.name: column for response, column in zip(self.study.responses, columns, strict=True)}

    @property
    def failures(self) -> dict[int, str]:
        """Reasons for missing responses."""
        return dict(sorted(self.columns.failures.items()))

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
        values = {name: column[i].item() for name, column in self.designs.items()}
        numbers = {name: float(column[i]) for name, column in self.responses.items()}
        return StudyDesign(self.study.scene(tuple(values.values())), values, numbers)

    def to_frame(self) -> pd.DataFrame:
        """The designs as a pandas frame, a row each, by number.

        Returns
        -------
        pandas.DataFrame
            The varied parameters, the responses in SI (nan where one is missing), and ``failure``, the reason.
            ``attrs``: "units", "varied_fields", "responses".

        Raises
        ------
        RuntimeError
            If pandas is not installed.
        """
        try:
            pandas = importlib.import_module("pandas")
        except ModuleNotFoundError:
            raise RuntimeError("frames need pandas: pip install 'cuefem[pandas]'") from None
        index = pandas.RangeIndex(self.count, name="design")
        frame: pd.DataFrame = pandas.DataFrame({**self.designs, **self.responses}, index=index)
        frame["failure"] = [self.columns.failures.get(design) for design in range(self.count)]
        frame.attrs = {"units": self.units, "varied_fields": [*self.designs], "responses": [*self.responses]}
        return frame

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
        count = self.optimum.evaluations if self.optimum else self.count
        title = f"StudyResult({self.kind} of {count} designs{failed})"
        return "\n  ".join([title, *(f"{name}: {value}, {at}" for name, value, at in self._lines())])


def compute_study(
    definition: Study | Scatter | Problem,
    *,
    store: Store | None = None,
    workers: int | Executor | None = None,
    progress: Callable[[Any], object] = lambda step: None,
    rounds: int = 60,
) -> StudyResult:
    """Compute a study.

    store: stored designs; by default none. workers: as in `sweep`. progress: as in `sweep`, in an
    optimization called with each `Round`. rounds: of an optimization, which has neither store nor workers.
    """
    if isinstance(definition, Problem):
        best = optimum(definition, rounds=rounds, progress=progress)
        return StudyResult(definition, Columns(np.array([[*best.responses.values()]]), {}), best)
    columns = sweep(designs_of(definition), store, workers=workers, progress=progress)
    indices = sobol_indices_of(definition, columns) if isinstance(definition, Scatter) else None
    return StudyResult(definition, columns, None, indices)


def designs_of(definition: Study | Scatter | Problem) -> Study:
    """The study whose designs are computed."""
    if isinstance(definition, Scatter):
        return definition.sobol_study
    return definition if isinstance(definition, Study) else definition.study
