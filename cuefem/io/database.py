"""Tables of design studies as SQLite databases: one file, one writer, every block of designs written whole or not.

A rollback journal and one transaction a block: what a kill or a full disk interrupts is as if it had not begun. Numbers
are stored as they are, eight bytes each; the study that they belong to stands beside them.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

from cuefem.design import Row, Study
from cuefem.io.errors import InputError, shown

# SQLite's marks in the head of the file: whose database it is, and the version of its tables.
APPLICATION, SCHEMA = 0x43754665, 1
# A reader may hold the file while a block waits to be written, s.
PATIENCE = 60.0


class Database:
    """The table of one study; a `cuefem.design.Store`. A context manager: closes the file.

    Made where there is none. InputError, and the file as it was, where it holds another study or a newer schema.
    """

    def __init__(self, path: str | Path, study: Study) -> None:
        self.path, self.study = Path(path), study
        with self._refusing():
            self._file = connect(self.path)
        try:
            with self._refusing():
                self._claim()
        except InputError:
            self._file.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    @contextmanager
    def _refusing(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise InputError(self.path, "", f"cannot be read or written as a database: {error}") from None

    def _claim(self) -> None:
        """Make the tables in an empty database; refuse one that is not this study's."""
        mark, schema = (self._one(f"PRAGMA {name}") for name in ("application_id", "user_version"))
        if self._one("SELECT count(*) FROM sqlite_master") == 0 and not mark:
            return self._make()
        if mark != APPLICATION:
            raise InputError(self.path, "", "must be a database of `cuefem sweep`; got another one")
        if schema > SCHEMA:
            raise InputError(self.path, "", f"must be of schema {SCHEMA} or older; got {schema}, of a newer cuefem")
        record = self._one("SELECT value FROM study WHERE key = 'record'")
        if record is None:
            raise InputError(self.path, "", "must hold this study; got a database without one")
        self._compare(json.loads(record))

    def _compare(self, other: dict[str, Any]) -> None:
        own = json.loads(json.dumps(self.study.record))
        differing = [key for key in {**own, **other} if own.get(key) != other.get(key)]
        if differing:
            problem = f"must hold this study; got another one, with another {' and '.join(differing)}"
            raise InputError(self.path, "", problem)

    def _make(self) -> None:
        study = self.study
        columns = [f"{_quoted(name)} REAL" for name in study.columns]
        for i, vary in enumerate(study.vary):
            columns[i] = f"{_quoted(vary.name)} {'TEXT' if vary.named else 'REAL'}"
        with self._transaction():
            self._file.execute(f"PRAGMA application_id = {APPLICATION}")
            self._file.execute(f"PRAGMA user_version = {SCHEMA}")
            self._file.execute("CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT NOT NULL)")
            self._file.execute("CREATE TABLE columns (name TEXT PRIMARY KEY, unit TEXT NOT NULL, role TEXT NOT NULL)")
            self._file.execute(f"CREATE TABLE designs (design INTEGER PRIMARY KEY, {', '.join(columns)}, failure TEXT)")
            found = [("fingerprint", study.fingerprint), ("record", json.dumps(study.record))]
            self._file.executemany("INSERT INTO study VALUES (?, ?)", found)
            roles = ["varied"] * len(study.vary) + ["response"] * len(study.responses)
            about = zip(study.columns, study.units, roles, strict=True)
            self._file.executemany("INSERT INTO columns VALUES (?, ?, ?)", about)

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        self._file.execute("BEGIN IMMEDIATE")
        try:
            yield
            self._file.execute("COMMIT")
        except BaseException:
            if self._file.in_transaction:  # a full disk has rolled back by itself
                self._file.execute("ROLLBACK")
            raise

    def _one(self, query: str, values: tuple[Any, ...] = ()) -> Any:
        row = self._file.execute(query, values).fetchone()
        return None if row is None else row[0]

    def holds(self, first: int) -> bool:
        """Whether the block that begins with design number ``first`` is there."""
        with self._refusing():
            return self._one("SELECT 1 FROM designs WHERE design = ?", (first,)) is not None

    def write(self, rows: list[Row]) -> None:
        """Add a block, whole, and on the disk when this returns."""
        marks = ", ".join("?" * (len(self.study.columns) + 2))
        flat = [(row.design, *row.values, *row.responses, row.failure) for row in rows]
        with self._refusing(), self._transaction():
            self._file.executemany(f"INSERT INTO designs VALUES ({marks})", flat)

    def count(self) -> tuple[int, int]:
        """(designs there, those that failed)."""
        with self._refusing():
            failed = self._one("SELECT count(*) FROM designs WHERE failure IS NOT NULL")
            return self._one("SELECT count(*) FROM designs"), failed

    def first_failure(self) -> tuple[int, str] | None:
        """(design, reason) of the first that failed."""
        query = "SELECT design, failure FROM designs WHERE failure IS NOT NULL ORDER BY design LIMIT 1"
        with self._refusing():
            found = self._file.execute(query).fetchone()
        return None if found is None else (found[0], found[1])

    def rows(self) -> Iterator[tuple[Any, ...]]:
        """All rows in the order of the designs, streamed: number, what varied, responses, failure."""
        with self._refusing():
            yield from self._file.execute("SELECT * FROM designs ORDER BY design")


def connect(path: Path) -> sqlite3.Connection:
    """A connection in which transactions are begun by hand."""
    return sqlite3.connect(path, timeout=PATIENCE, isolation_level=None)


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'


def headings(study: Study) -> list[str]:
    """Names of an export's columns, with their units: "end_mass [kg]"."""
    pairs = zip(study.columns, study.units, strict=True)
    return ["design", *(f"{name} [{unit}]" if unit else name for name, unit in pairs), "failure"]


def export_path(path: str | Path) -> Path:
    """The path of an export; InputError where its kind is unknown or its library is not there."""
    path = Path(path)
    if path.suffix not in (".csv", ".parquet"):
        raise InputError(path, "", f"must end in .csv or .parquet; got {shown(path.suffix)}")
    if path.suffix == ".parquet":
        try:
            import pyarrow.parquet  # noqa: F401
        except ImportError:
            raise InputError(path, "", "needs the library pyarrow: pip install '.[parquet]' in the clone") from None
    return path


def write_csv(database: Database, path: Path) -> None:
    """The table as CSV, numbers with all their digits."""
    import csv

    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(headings(database.study))
        writer.writerows(database.rows())


def write_parquet(database: Database, path: Path, at_once: int = 65536) -> None:
    """The table as Parquet, ``at_once`` rows in memory."""
    from itertools import islice

    import pyarrow as pa
    import pyarrow.parquet as pq

    study = database.study
    kinds = [pa.string() if vary.named else pa.float64() for vary in study.vary]
    kinds = [pa.int64(), *kinds, *[pa.float64()] * len(study.responses), pa.string()]
    schema = pa.schema(list(zip(headings(study), kinds, strict=True)))
    rows = database.rows()
    with pq.ParquetWriter(path, schema) as writer:
        while part := list(islice(rows, at_once)):
            arrays = [pa.array(column, kind) for column, kind in zip(zip(*part, strict=True), kinds, strict=True)]
            writer.write_table(pa.Table.from_arrays(arrays, schema=schema))
