"""The table of all designs of a study as a file, .csv or .parquet."""

from __future__ import annotations

import csv
import importlib
from collections.abc import Iterable
from itertools import islice
from pathlib import Path

from cuefem.designs.many_designs import Row
from cuefem.designs.study import Study

CHUNK = 4096  # designs that are exported at a time


def _heads(study: Study) -> list[str]:
    """The columns of an exported table, with SI units."""
    pairs = zip(study.columns, study.units, strict=True)
    return ["design", *(f"{name} [{unit}]" if unit else name for name, unit in pairs), "failure"]


def write_table(study: Study, rows: Iterable[Row], path: Path) -> None:
    """Write a study's table as .csv, numbers with all digits, units in the header."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(_heads(study))
        writer.writerows((row.design, *row.values, *row.responses, row.failure) for row in rows)


def check_parquet() -> None:
    """RuntimeError if pyarrow is not installed."""
    try:
        importlib.import_module("pyarrow.parquet")
    except ModuleNotFoundError:
        raise RuntimeError("a table in .parquet needs pyarrow: pip install 'cuefem[parquet]'") from None


def write_parquet(study: Study, rows: Iterable[Row], path: Path) -> None:
    """Write a study's table as .parquet, with the columns of the CSV, `CHUNK` designs at a time."""
    check_parquet()
    arrow = importlib.import_module("pyarrow")
    parquet = importlib.import_module("pyarrow.parquet")
    is_text = [isinstance(vary.range.ends[0], str) for vary in study.vary]
    kinds = [arrow.int64(), *(arrow.string() if text else arrow.float64() for text in is_text)]
    kinds += [*[arrow.float64()] * len(study.responses), arrow.string()]
    schema, remaining = arrow.schema([*zip(_heads(study), kinds, strict=True)]), iter(rows)
    with parquet.ParquetWriter(path, schema) as writer:
        while chunk := [*islice(remaining, CHUNK)]:
            lines = ((row.design, *row.values, *row.responses, row.failure) for row in chunk)
            columns = [arrow.array(column, kind) for column, kind in zip(zip(*lines, strict=True), kinds, strict=True)]
            writer.write_batch(arrow.record_batch(columns, schema=schema))
