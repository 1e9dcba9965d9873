"""SQLite store of computed designs, keyed by content hash and shared by any number of studies.

The key of a design is a hash of its scene, the resolution and the code, so that a study with changed ranges computes
only new designs. A block of designs is one transaction: a killed process loses only its current block. Each row has a
hash of its own, so that an altered file is rejected. The tables are internal; export them by the CSV of `cuefem study`
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
from typing import Any, NamedTuple, Self

from cuefem.design import Row, Study
from cuefem.design.evaluation import Failed
from cuefem.design.sampling import Value
from cuefem.io.errors import InputError, file_state
from cuefem.quantity.display import full_repr

APPLICATION_ID = 0x43754665  # SQLite's application_id in the header of the file
LOCK_TIMEOUT = 60.0  # s, to wait for another study that writes to the file
TABLES = f"""
BEGIN;
PRAGMA application_id = {APPLICATION_ID};
CREATE TABLE IF NOT EXISTS studies (study TEXT PRIMARY KEY, name TEXT NOT NULL, about TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS designs (study TEXT, design INTEGER, scene TEXT NOT NULL, answer TEXT NOT NULL,
  digest TEXT NOT NULL, PRIMARY KEY (study, design)) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS by_scene ON designs (scene);
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


class StoredTable(NamedTuple):
    """A study's table: its columns, their units, and its rows."""

    varied: tuple[str, ...]
    responses: tuple[str, ...]
    units: dict[str, str]
    rows: list[Row]


@contextmanager
def _opened(path: Path, mode: str) -> Iterator[sqlite3.Connection]:
    """A connection to a store; InputError for a damaged file and for errors of SQLite."""
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode={mode}", timeout=LOCK_TIMEOUT, uri=True)) as file:
            questions = ("SELECT count(*) FROM sqlite_master", "PRAGMA application_id", "PRAGMA integrity_check(1)")
            tables, mark, state = (file.execute(question).fetchone()[0] for question in questions)
            if tables and mark != APPLICATION_ID:
                raise InputError(path, "", "must be a store of `cuefem study`; got another database")
            if state != "ok":
                raise sqlite3.DatabaseError(state)
            yield file
    except (sqlite3.Error, UnicodeDecodeError, OverflowError) as error:
        raise InputError(path, "", f"cannot be read or written as a database: {error}") from None


def _answer(path: Path, *line: Any) -> dict[str, Any]:
    """The answer of a row; InputError if the row was altered."""
    *written, stored_digest = line
    if digest(*written) != stored_digest:
        raise InputError(path, "", f"is damaged: design {line[1]} was altered; delete the file")
    return dict(json.loads(line[3]))


def _rows(path: Path, file: sqlite3.Connection, study: str) -> Iterator[Row]:
    for line in file.execute("SELECT * FROM designs WHERE study = ? ORDER BY design", (study,)):
        answer = _answer(path, *line)
        yield Row(line[1], tuple(answer["values"]), tuple(answer["responses"].values()), answer["failure"])


class SqliteStore:
    """The designs of a study in a file of any number of studies; a `cuefem.design.sweep.Store` and a context manager.

    InputError if the file is not a store or is damaged. done: number of stored designs of the study. computed: number
    of them added by this run.
    """

    def __init__(self, path: str | PathLike[str], study: Study, name: str = "") -> None:
        if " at 0x" in full_repr(study.base):  # a memory address, which does not identify its content
            raise InputError(path, "", "cannot store designs of a scene with a function")
        self.path, self.study, self.done, self.computed = Path(path), study, 0, 0
        self._names, self._scenes = [response.name for response in study.responses], dict[int, str]()
        about = {
            "code": code_digest(),
            "varied": [vary.name for vary in study.vary],
            "responses": self._names,
            "units": dict(zip(study.columns, study.units, strict=True)),
            "study": study.record,
        }
        text = json.dumps(about)
        self._id, self._line = digest(text), (digest(text), name, text)
        self._open = ExitStack()

    def __enter__(self) -> Self:
        with ExitStack() as opening:
            self._file = opening.enter_context(_opened(self.path, "rwc"))
            if self._file.execute("SELECT count(*) FROM sqlite_master").fetchone() == (0,):
                self._file.executescript(TABLES)
            self.done = sum(1 for _ in self.rows())
            with self._file:
                self._file.execute("INSERT OR REPLACE INTO studies VALUES (?, ?, ?)", self._line)
            self._open = opening.pop_all()
        return self

    def __exit__(self, *error: Any) -> bool | None:
        return self._open.__exit__(*error)

    def missing(self, designs: dict[int, tuple[Value, ...]]) -> dict[int, tuple[Value, ...]]:
        """The designs of a block that must be computed; known designs of other studies in the file are copied."""
        query = "SELECT design FROM designs WHERE study = ? AND design BETWEEN ? AND ?"
        there = {row[0] for row in self._file.execute(query, (self._id, min(designs), max(designs)))}
        left, known = {design: values for design, values in designs.items() if design not in there}, list[Row]()
        for design, values in [*left.items()]:
            try:
                scene = full_repr(self.study.scene(values))
            except Failed:  # the computation reports the reason
                continue
            self._scenes[design] = digest(code_digest(), scene, repr(self.study.at))
            if row := self._known(design, values):
                known.append(row)
                del left[design]
        self._insert(known)
        return left

    def _known(self, design: int, values: tuple[Value, ...]) -> Row | None:
        """The row of a design with the same scene in another study of the file; None without one."""
        for line in self._file.execute("SELECT * FROM designs WHERE scene = ?", (self._scenes[design],)):
            answer = _answer(self.path, *line)
            same = [*answer["responses"]] == self._names
            if same or (answer["failure"] is None and {*self._names} <= {*answer["responses"]}):
                return Row(design, values, tuple(answer["responses"][n] for n in self._names), answer["failure"])
        return None

    def _insert(self, rows: list[Row]) -> None:
        lines = []
        for row in rows:
            answer = {"values": row.values, "responses": dict(zip(self._names, row.responses, strict=True))}
            text = json.dumps(answer | {"failure": row.failure})
            line = self._id, row.design, self._scenes.pop(row.design, ""), text
            lines.append((*line, digest(*line)))
        with self._file:
            self._file.executemany("INSERT OR REPLACE INTO designs VALUES (?, ?, ?, ?, ?)", lines)
        self.done += len(rows)

    def write(self, rows: list[Row]) -> None:
        """Store computed rows in one transaction."""
        self._insert(rows)
        self.computed += len(rows)

    def rows(self) -> Iterator[Row]:
        """The rows of the study in the order of the designs; InputError at an altered one."""
        return _rows(self.path, self._file, self._id)


def read_table(path: str | PathLike[str], name: str | None = None) -> StoredTable:
    """The table of the named or the latest study of a store, also while a study runs.

    InputError if the file does not exist, has no such study, or is damaged.
    """
    path = Path(path)
    file_state(path)
    with _opened(path, "rw") as file:  # SQLite rolls back an interrupted transaction
        studies = file.execute("SELECT * FROM studies ORDER BY rowid DESC").fetchall()
        for study, called, text in studies:
            if name in (None, called):
                about = json.loads(text) if digest(text) == study else None
                if about is None:
                    raise InputError(path, "", "is damaged: the record of a study was altered; delete the file")
                varied, responses = (tuple(about[role]) for role in ("varied", "responses"))
                return StoredTable(varied, responses, about["units"], [*_rows(path, file, study)])
    names = ", ".join(dict.fromkeys(called for _, called, _ in studies))
    raise InputError(path, "", f"must contain a study {name or ''}; got {names or 'none'}")


def write_table(study: Study, rows: Iterable[Row], path: Path) -> None:
    """Write a study's table as .csv, numbers with all digits, units in the header."""
    pairs = zip(study.columns, study.units, strict=True)
    head = ["design", *(f"{name} [{unit}]" if unit else name for name, unit in pairs), "failure"]
    with path.open("w", newline="", encoding="utf-8") as file:
        lines = ((row.design, *row.values, *row.responses, row.failure) for row in rows)
        csv.writer(file).writerows((head, *lines))
