"""SQLite store of computed designs, keyed by content hash and shared by any number of studies.

The key of a design is a hash of its scene, the resolution and the code, so that a study with changed ranges computes
only new designs. A block of designs is one transaction: a killed process loses only its current block. Each row has a
hash of its own, so that an altered file is rejected. The table is internal; export designs by the CSV of `cuefem study`
or `cuefem.frames`.
"""

from __future__ import annotations

import csv
import hashlib
import json
import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, closing, contextmanager
from functools import cache
from os import PathLike
from pathlib import Path
from typing import Any, Self

from cuefem.design import Row, Study
from cuefem.design.evaluation import Failed
from cuefem.design.sampling import Value
from cuefem.io.errors import InputError, check_path
from cuefem.quantity.display import full_repr

APPLICATION_ID = 0x43754665  # SQLite's application_id in the header of the file
LOCK_TIMEOUT = 60.0  # s, to wait for another study that writes to the file
TABLES = f"""
BEGIN;
PRAGMA application_id = {APPLICATION_ID};
CREATE TABLE designs (scene TEXT, responses TEXT, answers TEXT NOT NULL, failure TEXT, digest TEXT NOT NULL,
  PRIMARY KEY (scene, responses)) WITHOUT ROWID;
COMMIT;
"""


def digest(*parts: Any) -> str:
    """Hash of texts and numbers, all bits included."""
    return hashlib.blake2b(json.dumps(parts).encode("utf-8", "backslashreplace"), digest_size=16).hexdigest()


@cache
def code_digest() -> str:
    """Hash of the package's sources and tables: another version computes designs again."""
    every, content = Path(__file__).parents[1].rglob("*"), hashlib.blake2b(digest_size=16)
    for path in sorted(path for path in every if path.suffix in (".py", ".c", ".h", ".toml", ".npz")):
        content.update(path.read_bytes())
    return content.hexdigest()


@contextmanager
def _opened(path: Path) -> Iterator[sqlite3.Connection]:
    """A connection to a store; InputError for a damaged file and for errors of SQLite."""
    check_path(path)
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=rwc", timeout=LOCK_TIMEOUT, uri=True)) as file:
            questions = ("SELECT count(*) FROM sqlite_master", "PRAGMA application_id", "PRAGMA integrity_check(1)")
            tables, mark, state = (file.execute(question).fetchone()[0] for question in questions)
            if tables and mark != APPLICATION_ID:
                raise InputError(path, "", "must be a store of `cuefem study`; got another database")
            if state != "ok":
                raise sqlite3.DatabaseError(state)
            yield file
    except (sqlite3.Error, UnicodeDecodeError, OverflowError) as error:
        raise InputError(path, "", f"cannot be read or written as a database: {error}") from None


class SqliteStore:
    """The designs of a study in a file of any number of studies; a `cuefem.design.sweep.Store` and a context manager.

    InputError if the file is not a store or is damaged. done: number of designs of the study that are stored, so far as
    they were asked for. computed: number of them added by this run.
    """

    def __init__(self, path: str | PathLike[str], study: Study) -> None:
        if " at 0x" in full_repr(study.base):  # a memory address, which does not identify its content
            raise InputError(path, "", "cannot store designs of a scene with a function")
        self.path, self.study, self.done, self.computed = Path(path), study, 0, 0
        self._names, self._scenes = [response.name for response in study.responses], dict[int, str]()
        self._open = ExitStack()

    def __enter__(self) -> Self:
        with ExitStack() as opening:
            self._file = opening.enter_context(_opened(self.path))
            if self._file.execute("SELECT count(*) FROM sqlite_master").fetchone() == (0,):
                self._file.executescript(TABLES)
            self._open = opening.pop_all()
        return self

    def __exit__(self, *error: Any) -> bool | None:
        return self._open.__exit__(*error)

    def missing(self, designs: dict[int, tuple[Value, ...]]) -> dict[int, tuple[Value, ...]]:
        """The designs of a block that must be computed."""
        for design, values in designs.items():
            try:
                scene = full_repr(self.study.scene(values))
            except Failed as error:
                scene = f"invalid: {error}"
            self._scenes[design] = digest(code_digest(), scene, repr(self.study.at))
        left = {design: values for design, values in designs.items() if self._row(design, values) is None}
        self.done += len(designs) - len(left)
        return left

    def _row(self, design: int, values: tuple[Value, ...]) -> Row | None:
        """The stored row of a design, of this or another study; None without one. InputError if it was altered."""
        for line in self._file.execute("SELECT * FROM designs WHERE scene = ?", (self._scenes.get(design),)):
            *written, stored_digest = line
            if digest(*written) != stored_digest:
                raise InputError(self.path, "", "is damaged: a design was altered; delete the file")
            _, names, numbers, failure = written
            answers = dict(zip(json.loads(names), json.loads(numbers), strict=True))
            if [*answers] == self._names or (failure is None and {*self._names} <= {*answers}):
                return Row(design, values, tuple(answers[name] for name in self._names), failure)
        return None

    def write(self, rows: list[Row]) -> None:
        """Store computed rows in one transaction."""
        names = json.dumps(self._names)
        lines = [(self._scenes[row.design], names, json.dumps(row.responses), row.failure) for row in rows]
        with self._file:
            self._file.executemany(
                "INSERT OR REPLACE INTO designs VALUES (?, ?, ?, ?, ?)", [(*line, digest(*line)) for line in lines]
            )
        self.done += len(rows)
        self.computed += len(rows)

    def rows(self) -> Iterator[Row]:
        """The rows of the study in the order of the designs, so far as they were asked for."""
        found = (self._row(design, values) for design, values in enumerate(self.study.designs()))
        return (row for row in found if row)


def write_table(study: Study, rows: Iterable[Row], path: Path) -> None:
    """Write a study's table as .csv, numbers with all digits, units in the header."""
    pairs = zip(study.columns, study.units, strict=True)
    head = ["design", *(f"{name} [{unit}]" if unit else name for name, unit in pairs), "failure"]
    with path.open("w", newline="", encoding="utf-8") as file:
        lines = ((row.design, *row.values, *row.responses, row.failure) for row in rows)
        csv.writer(file).writerows((head, *lines))
