"""Tables of design studies as SQLite databases: one file, one writer, every block of designs written whole or not.

A rollback journal and one transaction a block: what a kill or a full disk interrupts is as if it had not begun. Numbers
are stored as they are, eight bytes each; the study that they belong to stands beside them, and a checksum of each row:
a row that is not as it was written is not exported, and its block is computed again. A lock beside the file keeps a
second sweep out (`cuefem.io.lock`).
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple, Self

from cuefem.design import Row, Study
from cuefem.io.errors import InputError, shown
from cuefem.io.lock import Lock

# SQLite's marks in the head of the file: whose database it is, and the version of its tables. The first had no
# checksums: what it holds is taken as it stands, and gets them when more is written.
APPLICATION, SCHEMA = 0x43754665, 2
# A reader may hold the file while a block waits to be written, s.
PATIENCE = 60.0


class Database:
    """The table of one study; a `cuefem.design.Store`. A context manager: closes the file.

    The file is made if it does not exist. InputError, with the file left as it was, if it holds another study or a
    newer schema, if more than single rows are damaged, or while another `Database` has it open.

    damaged: {number of a block's first design: what is wrong in the block}; such blocks count as missing.
    """

    def __init__(self, path: str | Path, study: Study) -> None:
        self.path, self.study = Path(path), study
        self.damaged: dict[int, str] = {}
        self._lock = Lock(self.path)
        try:
            with self._refusing():
                self._file = connect(self.path)
                try:
                    self._claim()
                except BaseException:
                    self._file.close()
                    raise
        except BaseException:
            self._lock.release()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the file, and let others have it."""
        self._file.close()
        self._lock.release()

    @contextmanager
    def _refusing(self) -> Iterator[None]:
        try:
            yield
        except (sqlite3.Error, UnicodeDecodeError, OverflowError) as error:
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
        wrong = self._one("PRAGMA integrity_check(1)")
        if wrong != "ok":
            raise self._damage(str(wrong))
        record = self._one("SELECT value FROM study WHERE key = 'record'")
        if record is None:
            raise InputError(self.path, "", "must hold this study; got a database without one")
        try:
            self._compare(json.loads(record))
        except (ValueError, TypeError, AttributeError) as error:
            if isinstance(error, InputError):
                raise
            raise self._damage("the study in it cannot be read") from None
        self._checked = self._one("SELECT 1 FROM sqlite_master WHERE name = 'checksums'") is not None
        if self._checked != (schema == SCHEMA):
            raise self._damage(f"it says that it is of schema {schema}")
        self._verify()

    def _damage(self, what: str) -> InputError:
        return InputError(
            self.path, "", f"is damaged: {what}; take a copy of it from before, or delete it to begin anew"
        )

    def _verify(self) -> None:
        """Find the blocks that are not as they were written: rows lost or with other values than their checksum's."""
        size, last, count = self.study.block, -1, 0
        for row, good in self._with_checksums():
            design = row[0]
            if not 0 <= design < self.study.size:
                raise self._damage(f"it holds a design {design}, and the study has {self.study.size}")
            first = design - design % size
            if first != last:
                self._check_whole(last, count)
                last, count = first, 0
            count += 1
            if not good:
                self.damaged.setdefault(first, f"design {design} is not as it was written")
        self._check_whole(last, count)

    def _check_whole(self, first: int, count: int) -> None:
        """Note a block of which rows are lost."""
        wanted = min(self.study.block, self.study.size - first)
        if first >= 0 and count < wanted:
            self.damaged.setdefault(first, f"{wanted - count} of the designs {first} to {first + wanted - 1} are lost")

    def _with_checksums(self) -> Iterator[tuple[tuple[Any, ...], bool]]:
        """All rows in the order of the designs, and whether each is as it was written."""
        if not self._checked:
            for row in self._file.execute("SELECT * FROM designs ORDER BY design"):
                yield row, True
            return
        query = "SELECT checksums.checksum, designs.* FROM designs LEFT JOIN checksums USING (design) ORDER BY design"
        for kept, *row in self._file.execute(query):
            yield tuple(row), kept == checksum(row)

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
            self._file.execute(CHECKSUMS)
            self._checked = True
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
        """Whether the block that begins with design number ``first`` is there, and as it was written."""
        with self._refusing():
            return (
                first not in self.damaged and self._one("SELECT 1 FROM designs WHERE design = ?", (first,)) is not None
            )

    def write(self, rows: list[Row]) -> None:
        """Add a block, whole, and on the disk when this returns; in place of a damaged one."""
        marks = ", ".join("?" * (len(self.study.columns) + 2))
        flat = [(row.design, *row.values, *row.responses, row.failure) for row in rows]
        first, last = rows[0].design, rows[-1].design
        with self._refusing(), self._transaction():
            if not self._checked:
                self._add_checksums()
            if first in self.damaged:
                for name in ("designs", "checksums"):
                    self._file.execute(f"DELETE FROM {name} WHERE design BETWEEN ? AND ?", (first, last))
            self._file.executemany(f"INSERT INTO designs VALUES ({marks})", flat)
            sums = [(row[0], checksum(row)) for row in flat]
            self._file.executemany("INSERT OR REPLACE INTO checksums VALUES (?, ?)", sums)
        self._checked = True
        self.damaged.pop(first, None)

    def _add_checksums(self) -> None:
        """Those of the rows of the first schema, as they stand."""
        self._file.execute(CHECKSUMS)
        self._file.execute(f"PRAGMA user_version = {SCHEMA}")
        rows = self._file.execute("SELECT * FROM designs").fetchall()
        self._file.executemany("INSERT INTO checksums VALUES (?, ?)", [(row[0], checksum(row)) for row in rows])

    def held(self) -> int:
        """How many designs are there, and as they were written."""
        size = self.study.block
        with self._refusing():
            count = self._one("SELECT count(*) FROM designs")
            between = "SELECT count(*) FROM designs WHERE design BETWEEN ? AND ?"
            return int(count - sum(self._one(between, (first, first + size - 1)) for first in self.damaged))

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
        """All rows in the order of the designs, streamed: number, what varied, responses, failure.

        InputError at a row that is not as it was written.
        """
        with self._refusing():
            for row, good in self._with_checksums():
                if not good:
                    raise self._damage(f"design {row[0]} is not as it was written")
                yield row


class Stored(NamedTuple):
    """The table of a database without its study: columns in their order, their units, and the rows as `Database.rows`
    has them. named: columns of names of materials. sampled: whether the designs are a sample and no grid."""

    varied: tuple[str, ...]
    responses: tuple[str, ...]
    units: dict[str, str]
    named: tuple[str, ...]
    sampled: bool
    rows: list[tuple[Any, ...]]

    @property
    def names(self) -> tuple[str, ...]:
        """All columns but the number of the design and its failure."""
        return (*self.varied, *self.responses)


def read_stored(path: str | PathLike[str]) -> Stored:
    """What a database of `cuefem sweep` holds, read only, also while a sweep writes on; InputError if it is none."""
    path = Path(path)
    if not path.is_file():
        raise InputError(path, "", "cannot be read: no such file")
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True, timeout=PATIENCE)) as file:
            if file.execute("PRAGMA application_id").fetchone()[0] != APPLICATION:
                raise InputError(path, "", "must be a database of `cuefem sweep`; got another one")
            about = {name: (unit, role) for name, unit, role in file.execute("SELECT name, unit, role FROM columns")}
            kinds = {name: kind for _, name, kind, *_ in file.execute("PRAGMA table_info(designs)") if name in about}
            record = json.loads(file.execute("SELECT value FROM study WHERE key = 'record'").fetchone()[0])
            rows = file.execute("SELECT * FROM designs ORDER BY design").fetchall()
    except (sqlite3.Error, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(path, "", f"cannot be read as a database: {error}") from None
    by_role = {role: tuple(name for name in kinds if about[name][1] == role) for role in ("varied", "response")}
    units = {name: unit for name, (unit, _) in about.items()}
    named = tuple(name for name, kind in kinds.items() if kind == "TEXT")
    return Stored(by_role["varied"], by_role["response"], units, named, record["sample"] != "None", rows)


def connect(path: Path) -> sqlite3.Connection:
    """A connection in which transactions are begun by hand."""
    return sqlite3.connect(path, timeout=PATIENCE, isolation_level=None)


CHECKSUMS = "CREATE TABLE checksums (design INTEGER PRIMARY KEY, checksum BLOB NOT NULL)"


def checksum(row: Sequence[Any]) -> bytes:
    """Of a row's number, values, responses and failure, as SQLite gives them back: numbers by all their bits."""
    design, *values, failure = row
    # a column of numbers gives back 1 as 1.0, -0.0 as 0.0, and nan as nothing
    kept = [v if v is None or isinstance(v, (str, bytes)) else float(v) + 0.0 for v in values]
    told = repr((design, [None if v != v else v for v in kept], failure))
    return hashlib.blake2b(told.encode("utf-8", "backslashreplace"), digest_size=8).digest()


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'


def headings(study: Study) -> list[str]:
    """Names of an export's columns, with their units: "end_mass [kg]"."""
    pairs = zip(study.columns, study.units, strict=True)
    return ["design", *(f"{name} [{unit}]" if unit else name for name, unit in pairs), "failure"]


def export_path(path: str | Path) -> Path:
    """The path of an export; InputError if its kind is unknown or its library is missing."""
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
