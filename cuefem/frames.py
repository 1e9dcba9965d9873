"""Tables of studies as pandas frames (`pip install '.[pandas]'`), for analysis in Python.

Numbers are SI; the units of the columns stand in ``attrs["units"]``. What pandas does with a frame is pandas' own, such
as ``to_parquet`` and ``to_xarray``.

>>> import cuefem as cf
>>> found = cf.study("studies/sweeps/bore.toml")  # doctest: +SKIP
>>> cf.frames.of_study(found).plot("bore", "squirt(0.3)")  # doctest: +SKIP
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
    """What a person looks for here, without what the module imports."""
    return __all__


def of_store(path: str | PathLike[str], study: str | None = None) -> pd.DataFrame:
    """Read the store of a study.

    Parameters
    ----------
    path : str or path
        What `cuefem study` wrote, ``STUDY.sqlite``; it may still be at work on it.
    study : str, optional
        The name of a study's file, without its ending, in a store of several; by default the one computed last.

    Returns
    -------
    pandas.DataFrame
        As `of_study` gives it.

    Raises
    ------
    ValueError
        If the file is no store, or a damaged one.
    """
    table = read_table(path, study)
    return _frame(table.rows, table.varied, table.responses, table.units)


def of_study(result: StudyResult) -> pd.DataFrame:
    """The designs of a study.

    Parameters
    ----------
    result : StudyResult
        What `cuefem.study` returned.

    Returns
    -------
    pandas.DataFrame
        A row a design, by its number: what varied, the responses in SI (nan where one is missing), and ``failure``,
        why it is missing. ``attrs``: "units", "varied", "responses".
    """
    varied = [vary.name for vary in result.study.vary]
    return _frame(result.rows, varied, [response.name for response in result.study.responses], result.units)


def _frame(rows: Iterable[Row], varied: Sequence[str], responses: Sequence[str], units: dict[str, str]) -> Any:
    lines = [(row.design, *row.values, *row.responses, row.failure) for row in rows]
    try:
        pandas = importlib.import_module("pandas")
    except ModuleNotFoundError:
        raise RuntimeError("this needs the library pandas: pip install '.[pandas]' in the clone") from None
    frame = pandas.DataFrame.from_records(lines, columns=["design", *varied, *responses, "failure"], index="design")
    frame[[*responses]] = frame[[*responses]].astype(float)
    frame.attrs = {"units": dict(units), "varied": [*varied], "responses": [*responses]}
    return frame
