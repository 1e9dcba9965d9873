"""The result of a study: designs and responses with units, the best designs, and the spread of the responses."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from cuefem.cue import Array
from cuefem.designs.design_differences import design_differences
from cuefem.designs.evaluation import shortfalls
from cuefem.designs.optimum import Optimum, Problem, optimum
from cuefem.designs.sampling import Value
from cuefem.designs.scatter import Scatter, SobolIndices, sobol_indices_of
from cuefem.designs.study import Study, StudyDesign
from cuefem.designs.study_statistics import SweepStatistics, sweep_statistics
from cuefem.designs.study_table import (
    failure_lines,
    optimum_record,
    scatter_record,
    sweep_record,
    tabulate_optimum,
    tabulate_parameters,
    tabulate_scatter,
    tabulate_sweep,
    varied_segments,
)
from cuefem.designs.many_designs import Columns, Row, Store, compute_designs
from cuefem.quantity.display import counted
from cuefem.quantity.display_units import with_unit
from cuefem.results.records import Record, Table
from cuefem.show.analysis import Analysis
from cuefem.show.scene_summary import scene_record

if TYPE_CHECKING:
    import pandas as pd

    from cuefem.show.charts import Chart
    from cuefem.show.drawings import CueDrawing

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of the designs below a quantile


@dataclass(frozen=True, repr=False)
class StudyResult(Analysis):
    """The result of a study: a `SweepResult`, a `ScatterResult` or an `OptimumResult`.

    Parameters
    ----------
    scene : Scene
        The scene that the designs vary.
    definition : Study, Scatter or Problem
        The study.
    columns : Columns
        The responses of the designs, in order; of an optimization only the best design.

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

    definition: Study | Scatter | Problem = field(repr=False)
    columns: Columns = field(repr=False)
    kind: ClassVar[str] = ""

    def heading(self) -> str:
        """The kind of the study."""
        return self.kind

    def page_title(self, name: str, question: str) -> str:
        """The file and the kind of the study."""
        return super().page_title(name, self.kind)

    def to_dict(self) -> Record:
        """The record: scene, resolution, varied parameters, numbers in SI units, and the unit of each."""
        study = designs_of(self.definition)
        return {
            "scene": scene_record(self.scene),
            "resolution": study.at and vars(study.at),
            "kind": self.kind,
            "varied_fields": varied_segments(study.vary, study.base),
            **self.values(),
            "units": self.units,
        }

    def tables(self) -> list[Table | str]:
        """The varied parameters; then, by kind, the results."""
        return [tabulate_parameters(self.study)]

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

    @property
    def best(self) -> dict[str, StudyDesign]:
        """The best design for each response."""
        return {}

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

    @property
    def finite_samples(self) -> dict[str, Array]:
        """The responses that exist, of a scatter those of its two independent samples."""
        columns = {name: column[: self._independent()] for name, column in self.responses.items()}
        return {name: column[np.isfinite(column)] for name, column in columns.items()}

    @cached_property
    def spread(self) -> dict[str, dict[str, float]]:
        """Mean, standard deviation and quantiles of the responses."""
        columns = self.finite_samples
        return {
            name: {"mean": float(column.mean()), "sd": float(column.std(ddof=1))}
            | {f"{100 * s:g} %": float(q) for s, q in zip(SHARES, np.quantile(column, SHARES), strict=True)}
            for name, column in columns.items()
            if len(column) > 1
        }

    def _independent(self) -> int | None:
        """How many of the first designs are an independent sample; None for all."""
        return None

    def _lines(self) -> list[tuple[str, ...]]:
        """A line per response: its name, its best value or mean, and the best design."""
        lines = list[tuple[str, ...]]()
        for response in self.study.responses:
            best = self.best.get(response.name)
            spread = self.spread.get(response.name)
            if best is not None:
                at = ", ".join(
                    f"{name} {value if isinstance(value, str) else with_unit(value, self.units[name])}"
                    for name, value in best.values.items()
                )
                lines.append((response.name, with_unit(best.responses[response.name], response.display_key), at))
            elif spread is not None:
                lines.append(
                    (response.name, with_unit(spread["mean"], response.display_key, error=spread["sd"]), "mean ± sd")
                )
        return lines

    def __repr__(self) -> str:
        lacks = "".join(f"; {text}" for text, _ in shortfalls(self.study.responses, self.columns.values))
        title = f"{type(self).__name__}({counted(self._computed(), 'design')}{lacks})"
        return "\n  ".join([title, *(f"{name}: {value}, {at}" for name, value, at in self._lines())])

    def _computed(self) -> int:
        """Number of computed designs."""
        return self.count


@dataclass(frozen=True, repr=False)
class SweepResult(StudyResult):
    """The result of a sweep: the best designs, the main parameter of each response, and a trade-off."""

    kind: ClassVar[str] = "sweep"

    @cached_property
    def best(self) -> dict[str, StudyDesign]:
        """Of the designs with a response the best for it, if one direction is preferred; without any, the lowest."""
        statistics = self.statistics
        if statistics is None:
            return {}
        return {
            statistics.responses[k].name: self._design(int(statistics.numbers[statistics.best(k)]))
            for k in statistics.ranked
        }

    def _design(self, i: int) -> StudyDesign:
        values = {name: column[i].item() for name, column in self.designs.items()}
        numbers = {name: float(column[i]) for name, column in self.responses.items()}
        return StudyDesign(self.study.scene(tuple(values.values())), values, numbers, failure=self.failures.get(i))

    @cached_property
    def statistics(self) -> SweepStatistics | None:
        """Its statistics; None if no design has a response."""
        return sweep_statistics(self.study, self.designs, self.columns.values)

    @cached_property
    def front_steps(self) -> list[dict[str, Record]]:
        """Differences of each design of the front in the table from the one above, as of `design_differences`.

        Of the two responses that trade off; what remains of the errors that both designs share is left out.
        """
        statistics = self.statistics
        if statistics is None or statistics.pair is None:
            return []
        two = replace(self.study, responses=tuple(statistics.responses[k] for k in statistics.pair))
        names = [response.name for response in two.responses]
        designs = [self._design(int(statistics.numbers[i])) for i in statistics.shown_front]
        designs = [replace(design, responses={name: design.responses[name] for name in names}) for design in designs]
        return design_differences(two, designs, with_shared=False)

    def values(self) -> Record:
        """Counts of designs, and the summary: best designs, sensitivities, Pareto front."""
        first_failure = next(iter(self.failures.values()), None)
        lacking = np.isnan(self.columns.values)
        counts = {
            "designs": self.count,
            "failed": np.all(lacking, axis=1).sum(),
            "lacking": dict(zip(self.responses, lacking.sum(axis=0), strict=True)),
            "first_failure": first_failure,
        }
        return counts | {"summary": self.statistics and sweep_record(self.statistics, self.front_steps)}

    def charts(self) -> list[Chart]:
        """The trade-off with its Pareto front, and the first response against each parameter."""
        from cuefem.designs.study_charts import sweep_charts  # charts are not for terminals

        return [] if self.statistics is None else sweep_charts(self.statistics)

    def gaps(self) -> list[str]:
        """Which responses designs lack, with the first reason."""
        return failure_lines(self.study, self.designs, self.columns.values, self.failures)

    def tables(self) -> list[Table | str]:
        """Varied parameters, best designs, sensitivities, and the Pareto front."""
        found = [] if self.statistics is None else tabulate_sweep(self.statistics, self.front_steps)
        return [*super().tables(), *found]


@dataclass(frozen=True, repr=False)
class ScatterResult(StudyResult):
    """The result of a tolerance analysis: the spread of each response, and the share of each factor in it.

    Parameters
    ----------
    sobol_indices : SobolIndices
        Sobol indices of each response.
    """

    sobol_indices: SobolIndices = field(repr=False)
    definition: Scatter
    kind: ClassVar[str] = "scatter"

    def _independent(self) -> int:
        """The two independent samples; the other designs mix them."""
        return 2 * self.definition.count

    def values(self) -> Record:
        """The distribution of each response, and the shares of its factors."""
        about = {"count": self.definition.count, "seed": self.definition.seed}
        return about | {"responses": scatter_record(self.study, self.spread, self.sobol_indices)}

    def charts(self) -> list[Chart]:
        """The distribution of each response, and the share of each factor in its variance."""
        from cuefem.designs.study_charts import scatter_charts

        return scatter_charts(self.study.responses, self.finite_samples, self.spread, self.sobol_indices)

    def tables(self) -> list[Table | str]:
        """Varied parameters, spreads, and the shares of the factors."""
        return [*super().tables(), *tabulate_scatter(self.definition, self.spread, self.sobol_indices)]


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

    def values(self) -> Record:
        """The best design, its responses and active constraints, and the evaluations."""
        return optimum_record(self.definition, self.optimum, self.changes)

    def tables(self) -> list[Table | str]:
        """Varied parameters, the best design, its active constraints, and the best design for each choice."""
        return [*super().tables(), *tabulate_optimum(self.definition, self.optimum, self.changes)]

    @cached_property
    def changes(self) -> dict[str, Record]:
        """Relative difference of each response of the best design from the unmodified one, as of `cuefem.compare`.

        "difference", "error" (1 sigma) and "distinct"; without a response that one of them lacks.
        """
        assert self.optimum.start is not None
        (changes,) = design_differences(self.study, [self.optimum.start, self.optimum])
        return changes

    def charts(self) -> list[CueDrawing]:
        """Drawings of the unmodified and of the best design."""
        from cuefem.show.drawings import DIAMETER_SCALE, cue_drawing  # drawings are not for terminals

        assert self.optimum.start is not None
        designs = {"start": self.optimum.start, "best design": self.optimum}
        return [
            cue_drawing(design.scene, f"{name}, diameters {DIAMETER_SCALE:g} times enlarged")
            for name, design in designs.items()
            if design.scene.cue.segments
        ]


def compute_study(
    definition: Study | Scatter | Problem,
    *,
    store: Store | None = None,
    workers: int | Executor | None = None,
    progress: Callable[[Any], object] = lambda step: None,
    rounds: int = 60,
) -> StudyResult:
    """Compute a study.

    store: stored designs; by default none. workers: as in `compute_designs`. progress: as in `compute_designs`, in an
    optimization called with each `Round`. rounds: of an optimization, which has neither store nor workers.
    """
    if isinstance(definition, Problem):
        best = optimum(definition, rounds=rounds, progress=progress)
        columns = Columns(np.array([[*best.responses.values()]]), {})
        return OptimumResult(definition.study.base, definition, columns, best)
    designs = designs_of(definition)
    columns = compute_designs(designs, store, workers=workers, progress=progress)
    if isinstance(definition, Scatter):
        return ScatterResult(designs.base, definition, columns, sobol_indices_of(definition, columns))
    return SweepResult(designs.base, definition, columns)


def designs_of(definition: Study | Scatter | Problem) -> Study:
    """The study whose designs are computed."""
    if isinstance(definition, Scatter):
        return definition.sobol_study
    return definition if isinstance(definition, Study) else definition.study
