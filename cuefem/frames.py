"""Tables of studies as pandas frames (`pip install '.[pandas]'`), for analysis in Python.

Numbers are SI; the units of the columns stand in ``attrs["units"]``. What pandas does with a frame is pandas' own, such
as ``to_parquet`` and ``to_xarray``.

>>> import cuefem as cf
>>> from cuefem import frames
>>> wood = cf.Material(12.6e9, 0.84e9, 700.0)
>>> batch = cf.CueBatch.of([cf.Cue((cf.Segment(0.74, d, 0.0215, wood),), 0.42) for d in (0.0115, 0.0135)])
>>> frames.of_batch(batch, stiffness=[1.0, 2.0]).columns.tolist()  # doctest: +SKIP
['length', 'tip_diameter', 'butt_diameter', 'shaft_mass', 'mass', 'body_mass', 'stiffness']
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from cuefem.design import Row
from cuefem.design.batch import CueBatch
from cuefem.design.study_result import StudyResult
from cuefem.io.store import read_table
from cuefem.quantity.fields import check_kind
from cuefem.results.quantities import RESULTS

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["of_batch", "of_drivers", "of_store", "of_study"]


def __dir__() -> list[str]:
    """What a person looks for here, without what the module imports."""
    return __all__


def _pandas() -> Any:
    try:
        return importlib.import_module("pandas")
    except ModuleNotFoundError:
        raise RuntimeError("this needs the library pandas: pip install '.[pandas]' in the clone") from None


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
    frame = _pandas().DataFrame.from_records(lines, columns=["design", *varied, *responses, "failure"], index="design")
    frame[[*responses]] = frame[[*responses]].astype(float)
    frame.attrs = {"units": dict(units), "varied": [*varied], "responses": [*responses]}
    return frame


def of_drivers(result: StudyResult) -> pd.DataFrame:
    """Which cause has which share of the variance.

    Parameters
    ----------
    result : StudyResult
        Of a study with tolerances.

    Returns
    -------
    pandas.DataFrame
        A row a response and cause, with the columns "first", "first_low", "first_high", "total", "total_low" and
        "total_high": Sobol indices and their 95 % intervals.

    Raises
    ------
    ValueError
        If the study has no tolerances.
    """
    drivers = result.drivers
    if drivers is None:
        raise ValueError(f"of_drivers takes a scatter, a study with tolerances; got one of kind {result.kind}")
    pandas = _pandas()
    index = pandas.MultiIndex.from_product([[*result.responses], drivers.causes], names=["response", "cause"])
    columns = dict[str, Any]()
    for name, value, ends in (
        ("first", drivers.first, drivers.first_interval),
        ("total", drivers.total, drivers.total_interval),
    ):
        columns |= {name: value.T.ravel(), f"{name}_low": ends[0].T.ravel(), f"{name}_high": ends[1].T.ravel()}
    return pandas.DataFrame(columns, index=index)


def of_batch(batch: CueBatch, **results: ArrayLike) -> pd.DataFrame:
    """The cues of a batch, and results of them as further columns.

    Parameters
    ----------
    batch : CueBatch
        The cues.
    **results : array_like
        Numbers of the cues, such as the end masses and squirts of `cuefem.batch_stick`.

    Returns
    -------
    pandas.DataFrame
        A row a cue, SI; ``attrs["units"]``: those of the cues' own columns.

    Raises
    ------
    ValueError
        If a result has not one number a cue.
    """
    check_kind("batch", batch, CueBatch)
    pandas = _pandas()
    rows = batch.rows
    columns: dict[str, Any] = {
        "length": rows.length.sum(axis=1),
        "tip_diameter": rows.tip_diameter[:, 0],
        "butt_diameter": rows.butt_diameter[:, -1],
        "shaft_mass": batch.shaft_mass,
        "mass": batch.mass,
        "body_mass": batch.body_mass,
    }
    for name, values in results.items():
        columns[name] = np.asarray(values)
        if columns[name].shape != (len(batch.body_mass),):
            raise ValueError(
                f"{name} must have one number a cue, shape ({len(batch.body_mass)},); got {columns[name].shape}"
            )
    frame = pandas.DataFrame(columns)
    frame.attrs = {"units": {name: RESULTS[name].unit for name in columns if name not in results}}
    return frame
