"""pandas frames of answers, which pandas, an optional library, makes when one is asked for."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd


def frame_of(
    data: Mapping[str, Any] | Sequence[Mapping[str, Any]], units: Mapping[str, str], *, index: str | None = None
) -> pd.DataFrame:
    """A frame of columns by name, or of rows; ``attrs["units"]`` has the units of its columns.

    units: SI units by name, also of other columns. index: the name of the index. RuntimeError if pandas is not
    installed.
    """
    try:
        pandas = importlib.import_module("pandas")
    except ImportError:
        raise RuntimeError("frames need pandas: pip install 'cuefem[pandas]'") from None
    frame: pd.DataFrame = pandas.DataFrame(data)
    frame.index.name = index
    frame.attrs["units"] = {name: units[name] for name in frame.columns if name in units}
    return frame
