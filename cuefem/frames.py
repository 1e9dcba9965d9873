"""Tables of studies as pandas frames (`pip install '.[pandas]'`), for analysis in Python.

Values are SI; ``attrs["units"]`` has the units of the columns.

>>> import cuefem as cf
>>> result = cf.study("studies/sweeps/bore.toml")  # doctest: +SKIP
>>> cf.frames.of_study(result).plot("bore", "squirt(0.3)")  # doctest: +SKIP
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

from cuefem.design import Row
from cuefem.design.study_result import StudyResult
from cuefem.io.store import read_table

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["of_store", "of_study"]


def __dir__() -> list[str]:
    """The public names, for completion in a Python session."""
    return __all__


def of_store(path: str | PathLike[str], study: str | None = None) -> pd.DataFrame:
    """Read the store of a study.

    Parameters
    ----------
    path : str or path
        The store of `cuefem study`, ``STUDY.sqlite``; the study may still be running.
    study : str, optional
        The name of a study's file, without extension, in a store of several; by default the one computed last.

    Returns
    -------
    pandas.DataFrame
        As of `of_study`.

    Raises
    ------
    ValueError
        If the file is not a store, or is damaged.
    """
    table = read_table(path, study)
    return _frame(table.rows, table.varied, table.responses, table.units)


def of_study(result: StudyResult) -> pd.DataFrame:
    """The designs of a study.

    Parameters
    ----------
    result : StudyResult
        The result of `cuefem.study`.

    Returns
    -------
    pandas.DataFrame
        A row for each design, by its number: the varied parameters, the responses in SI (nan where one is missing), and
        ``failure``, the reason. ``attrs``: "units", "varied", "responses".
    """
    varied = [vary.name for vary in result.study.vary]
    return _frame(result.rows, varied, [response.name for response in result.study.responses], result.units)


def _frame(rows: Iterable[Row], varied: Sequence[str], responses: Sequence[str], units: dict[str, str]) -> Any:
    lines = [(row.design, *row.values, *row.responses, row.failure) for row in rows]
    try:
        pandas = importlib.import_module("pandas")
    except ModuleNotFoundError:
        raise RuntimeError("frames need pandas: pip install '.[pandas]' in the clone") from None
    frame = pandas.DataFrame.from_records(lines, columns=["design", *varied, *responses, "failure"], index="design")
    frame[[*responses]] = frame[[*responses]].astype(float)
    frame.attrs = {"units": dict(units), "varied": [*varied], "responses": [*responses]}
    return frame
