"""Tables of studies as pandas frames (`pip install '.[pandas]'`), for analysis in Python.

Values are SI; ``attrs["units"]`` has the units of the columns.

>>> import cuefem as cf
>>> result = cf.study("studies/sweeps/bore.toml")  # doctest: +SKIP
>>> cf.frames.of_study(result).plot("bore", "squirt(0.3)")  # doctest: +SKIP
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from cuefem.design.study_result import StudyResult

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["of_study"]


def __dir__() -> list[str]:
    """The public names, for completion in a Python session."""
    return __all__


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
        ``failure``, the reason. ``attrs``: "units", "varied_fields", "responses".
    """
    varied = [vary.name for vary in result.study.vary]
    responses = [response.name for response in result.study.responses]
    lines = [(row.design, *row.values, *row.responses, row.failure) for row in result.rows]
    try:
        pandas = importlib.import_module("pandas")
    except ModuleNotFoundError:
        raise RuntimeError("frames need pandas: pip install '.[pandas]' in the clone") from None
    frame: pd.DataFrame = pandas.DataFrame.from_records(
        lines, columns=["design", *varied, *responses, "failure"], index="design"
    )
    frame[responses] = frame[responses].astype(float)
    frame.attrs = {"units": result.units, "varied_fields": varied, "responses": responses}
    return frame
