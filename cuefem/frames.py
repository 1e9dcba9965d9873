"""Tables of studies as pandas and xarray objects (`pip install '.[pandas]'`), for analysis in Python.

Numbers are SI; the units of the columns stand in ``attrs["units"]`` of a frame and ``attrs["units"]`` of each variable
of a dataset.

>>> import cuefem as cf
>>> from cuefem import frames
>>> wood = cf.Material(12.6e9, 0.84e9, 700.0)
>>> batch = cf.CueBatch.of([cf.Cue((cf.Segment(0.74, d, 0.0215, wood),), 0.42) for d in (0.0115, 0.0135)])
>>> frames.of_batch(batch, stiffness=[1.0, 2.0]).columns.tolist()  # doctest: +SKIP
['length', 'tip_diameter', 'butt_diameter', 'shaft_mass', 'mass', 'body_mass', 'stiffness']
"""

from __future__ import annotations

import importlib
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from cuefem.design.batch import CueBatch
from cuefem.design.scatter import Drivers, Scatter
from cuefem.io.store import StoredTable, read_table
from cuefem.quantity.fields import check_kind
from cuefem.results.quantities import RESULTS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["of_batch", "of_drivers", "of_scatter", "of_sweep", "sweep_grid"]


def _library(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        raise RuntimeError(f"this needs the library {name}: pip install '.[pandas]' in the clone") from None


def of_sweep(path: str | PathLike[str], study: str | None = None) -> pd.DataFrame:
    """Read the store of a sweep.

    Parameters
    ----------
    path : str or path
        What `cuefem sweep` wrote, ``STUDY.sqlite``; it may still be at work on it.
    study : str, optional
        The name of a study's file, without its ending, in a store of several; by default the one swept last.

    Returns
    -------
    pandas.DataFrame
        A row a design, by its number: what varied, the responses in SI (nan where one is missing), and ``failure``,
        why it is missing. ``attrs``: "units", "varied", "responses".

    Raises
    ------
    ValueError
        If the file is no store, or a row in it is not as it was written.
    """
    return _frame(read_table(path, study))


def _frame(table: StoredTable) -> Any:
    pandas = _library("pandas")
    names = ["design", *table.names, "failure"]
    frame = pandas.DataFrame.from_records(table.rows, columns=names).set_index("design")
    numbers = [name for name in table.names if name not in table.named]
    frame[numbers] = frame[numbers].astype(float)
    frame.attrs = {"units": dict(table.units), "varied": list(table.varied), "responses": list(table.responses)}
    return frame


def sweep_grid(path: str | PathLike[str], study: str | None = None) -> xr.Dataset:
    """Read the store of a sweep over a grid as arrays with named axes.

    Parameters
    ----------
    path : str or path
        What `cuefem sweep` wrote for a study without [sample].
    study : str, optional
        The name of a study's file, as in `of_sweep`.

    Returns
    -------
    xarray.Dataset
        A variable a response, with what varied as its axes; nan where a design failed or is not computed yet.

    Raises
    ------
    ValueError
        If the designs are no grid, the file is no store, or a row in it is not as it was written.
    """
    xarray = _library("xarray")
    table = read_table(path, study)
    if table.sampled:
        raise ValueError(f"{path}: holds a sample and no grid: of_sweep reads it")
    frame = _frame(table)
    frame = frame[~frame.duplicated(list(table.varied))].set_index(list(table.varied))[list(table.responses)]
    data = xarray.Dataset.from_dataframe(frame)
    for name in data.variables:
        data[name].attrs["units"] = table.units[str(name)]
    return data


def of_scatter(wanted: Scatter, found: Drivers) -> pd.DataFrame:
    """The designs of a scatter: what varied in them and their responses.

    Parameters
    ----------
    wanted : Scatter
        The study.
    found : Drivers
        What `cuefem.design.scatter.drivers` returned.

    Returns
    -------
    pandas.DataFrame
        A row a design of the two independent samples.
    """
    pandas = _library("pandas")
    study = wanted.study
    varied = pandas.DataFrame(list(found.spread.values), columns=[vary.name for vary in study.vary])
    names = [response.name for response in study.responses]
    frame = varied.join(pandas.DataFrame(found.spread.responses, columns=names))
    frame.attrs = {"units": dict(zip(study.columns, study.units, strict=True))}
    return frame


def of_drivers(wanted: Scatter, found: Drivers) -> pd.DataFrame:
    """Which cause has which share of the variance.

    Parameters
    ----------
    wanted : Scatter
        The study.
    found : Drivers
        What `cuefem.design.scatter.drivers` returned.

    Returns
    -------
    pandas.DataFrame
        A row a response and cause, with the columns "first", "first_low", "first_high", "total", "total_low" and
        "total_high": Sobol indices and their 95 % intervals.
    """
    pandas = _library("pandas")
    names = [response.name for response in wanted.study.responses]
    index = pandas.MultiIndex.from_product([names, found.causes], names=["response", "cause"])
    columns = dict[str, Any]()
    for name, value, ends in (
        ("first", found.first, found.first_interval),
        ("total", found.total, found.total_interval),
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
    pandas = _library("pandas")
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
