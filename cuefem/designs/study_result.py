"""What the results of all studies share: designs and responses with units, the spread of the responses, and frames."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from cuefem.cue import Array
from cuefem.designs.design_table import write_parquet, write_table
from cuefem.designs.evaluation import shortfalls
from cuefem.designs.many_designs import Columns, Row
from cuefem.designs.sampling import Value
from cuefem.designs.study import Study, StudyDefinition, StudyDesign
from cuefem.designs.study_table import failure_lines, tabulate_parameters, varied_segments
from cuefem.files import InputError, save, write_atomically
from cuefem.parameters.scene_changes import with_values_at
from cuefem.parameters.scene_paths import value_at
from cuefem.quantity.display import counted
from cuefem.quantity.display_units import with_unit
from cuefem.quantity.frames import frame_of
from cuefem.results.records import Record, Table, json_value
from cuefem.scene import Scene
from cuefem.show.analysis import Analysis
from cuefem.show.scene_summary import scene_record

if TYPE_CHECKING:
    import pandas as pd

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of the designs below a quantile
CHART_HEIGHT, ROW_HEIGHT, ROWS_END = 260.0, 22.0, 60.0  # of a chart; of a name in a chart of names, and of its axis


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

    definition: StudyDefinition = field(repr=False)
    columns: Columns = field(repr=False)
    kind: ClassVar[str] = ""
    folds_assumptions: ClassVar[bool] = True
    why_no_best: ClassVar[str] = "none has a response"

    def save(self, path: str | Path, *, front: bool = False) -> None:
        """Write the page (.html), the record (.json), the designs (.csv, .parquet), or the best one as a scene (.toml).

        Parameters
        ----------
        path : str or path
            The file.
        front : bool, optional
            Of the designs only those of the Pareto front.

        Raises
        ------
        InputError
            For another extension, or a .toml if there is no best design.
        RuntimeError
            If pyarrow is not installed, for .parquet.
        """
        path = Path(path)
        match path.suffix.lower():
            case ".html" | ".json":
                super().save(path)
            case ".csv" | ".parquet" if front and not self.front:
                raise InputError(path, "", "has no Pareto front to write: no two responses trade off")
            case ".csv" | ".parquet" as kind:
                write = write_table if kind == ".csv" else write_parquet
                kept = {*self.front} if front else range(self.count)
                rows = (row for row in self.rows if row.design in kept)
                write_atomically(path, lambda temporary: write(self.study, rows, temporary))
            case ".toml" if self.best:
                save(self._rounded(next(iter(self.best.values())).scene), path)
            case ".toml":
                raise InputError(path, "", f"has no design to write: {self.why_no_best}")
            case other:
                raise InputError(path, "", f"must end in .html, .json, .csv, .parquet or .toml; got {other!r}")

    def _rounded(self, scene: Scene) -> Scene:
        """The scene with varied numbers rounded to nine digits, far within the tolerance of the limits."""
        moved = {path for vary in self.study.vary for path in (*vary.fields(scene), *vary.compensating_fields(scene))}
        numbers = {path: value_at(scene, path) for path in moved}
        return with_values_at(scene, {path: float(f"{x:.9g}") for path, x in numbers.items() if isinstance(x, float)})

    def heading(self) -> str:
        """The kind of the study."""
        return self.kind

    def page_title(self, name: str, question: str) -> str:
        """The file and the kind of the study."""
        return super().page_title(name, self.kind)

    def to_dict(self) -> Record:
        """The record: scene, resolution, varied parameters, numbers in SI units, and the unit of each."""
        study = self.definition.all_designs
        record: Record = {
            **self.said(),
            "scene": scene_record(self.scene),
            "resolution": study.at and vars(study.at),
            **({"squirt_factor": study.squirt_factor} if study.squirt_factor != 1.0 else {}),
            "kind": self.kind,
            "varied_fields": varied_segments(study.vary, study.base),
            **self.values(),
            "units": self.units,
        }
        return json_value(record)

    def tables(self) -> list[Table | str]:
        """The squirt factor of a calibration and the varied parameters; then, by kind, the results."""
        factor = self.study.squirt_factor
        calibrated = [f"calibrated: all squirt is {factor:.2f} times the computed one"] if factor != 1.0 else []
        return [*calibrated, tabulate_parameters(self.study)]

    def gaps(self) -> list[str]:
        """Which responses designs lack, with the first reason."""
        return failure_lines(self.study, self.designs, self.columns.values, self.failures)

    @property
    def study(self) -> Study:
        """Parameters and responses."""
        return self.definition.study

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
        return self.definition.all_designs.designs()

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
    def front(self) -> list[int]:
        """The designs of the Pareto front by number, of all but a sweep every one."""
        return [*range(self.count)]

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
        failures = [self.columns.failures.get(design) for design in range(self.count)]
        frame = frame_of({**self.designs, **self.responses, "failure": failures}, self.units, index="design")
        frame.attrs |= {"varied_fields": [*self.designs], "responses": [*self.responses]}
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
        """How many designs, what they lack, and the best or mean of each response, in one line."""
        lacks = "".join(f"; {text}" for text, _ in shortfalls(self.study.responses, self.columns.values))
        lines = (f"{name}: {value}, {at}" for name, value, at in self._lines())
        varied = ", ".join(vary.name for vary in self.study.vary)
        count = f"{counted(self._computed(), 'design')} that vary {varied}"
        return self._in_one_line("; ".join([f"{count}{lacks}", *lines]))

    def _computed(self) -> int:
        """Number of computed designs."""
        return self.count
