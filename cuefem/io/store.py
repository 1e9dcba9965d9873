"""Designs that studies have computed, stored by what they are: one SQLite file for any number of studies.

A design is known by a digest of its scene, the resolution and the code that computes, so that a study whose ranges were
changed computes only what is new. A block of designs is one transaction: a kill loses the block in work and no other.
Each row carries a digest of its own: a file in which one was altered is refused. The tables are internal; the CSV of
`cuefem study` and `cuefem.frames` are the ways out of them.
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
from cuefem.design.ranges import Value
from cuefem.io.errors import InputError, state_of
from cuefem.quantity.display import spelt_out

APPLICATION = 0x43754665  # SQLite's mark in the head of the file: whose database it is
PATIENCE = 60.0  # s, for which a study waits for another one that writes into the file
TABLES = f"""
BEGIN;
PRAGMA application_id = {APPLICATION};
CREATE TABLE IF NOT EXISTS studies (study TEXT PRIMARY KEY, name TEXT NOT NULL, about TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS designs (study TEXT, design INTEGER, scene TEXT NOT NULL, answer TEXT NOT NULL,
  digest TEXT NOT NULL, PRIMARY KEY (study, design)) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS by_scene ON designs (scene);
COMMIT;
"""


def digest(*parts: Any) -> str:
    """Of texts and numbers, these by all their bits."""
    return hashlib.blake2b(json.dumps(parts).encode("utf-8", "backslashreplace"), digest_size=16).hexdigest()


@cache
def code() -> str:
    """A digest of the package's sources and tables, so that designs of another version are computed again."""
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
    """A connection to a store; InputError in one line for what SQLite, or a damaged file, says in many ways."""
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode={mode}", timeout=PATIENCE, uri=True)) as file:
            questions = ("SELECT count(*) FROM sqlite_master", "PRAGMA application_id", "PRAGMA integrity_check(1)")
            tables, mark, state = (file.execute(question).fetchone()[0] for question in questions)
            if tables and mark != APPLICATION:
                raise InputError(path, "", "must be a store of `cuefem study`; got another database")
            if state != "ok":
                raise sqlite3.DatabaseError(state)
            yield file
    except (sqlite3.Error, UnicodeDecodeError, OverflowError) as error:
        raise InputError(path, "", f"cannot be read or written as a database: {error}") from None


def _answer(path: Path, *line: Any) -> dict[str, Any]:
    """The answer of a row; InputError if the row is not as it was written."""
    *written, told = line
    if digest(*written) != told:
        raise InputError(path, "", f"is damaged: design {line[1]} is not as it was written; delete the file")
    return dict(json.loads(line[3]))


def _rows(path: Path, file: sqlite3.Connection, study: str) -> Iterator[Row]:
    for line in file.execute("SELECT * FROM designs WHERE study = ? ORDER BY design", (study,)):
        answer = _answer(path, *line)
        yield Row(line[1], tuple(answer["values"]), tuple(answer["responses"].values()), answer["failure"])


class SqliteStore:
    """The designs of a study in a file of any number of studies; a `cuefem.design.sweep.Store` and a context manager.

    InputError if the file is no store or a damaged one. done: designs of the study that are there. computed: those of
    them that this run added.
    """

    def __init__(self, path: str | PathLike[str], study: Study, name: str = "") -> None:
        if " at 0x" in spelt_out(study.base):  # a place in memory, which tells nothing of what stands there
            raise InputError(path, "", "cannot store designs of a scene with a function")
        self.path, self.study, self.done, self.computed = Path(path), study, 0, 0
        self._names, self._scenes = [response.name for response in study.responses], dict[int, str]()
        about = {
            "code": code(),
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

    def take(self, designs: dict[int, tuple[Value, ...]]) -> dict[int, tuple[Value, ...]]:
        """What is left to compute of a block; designs that a study in the file has are copied."""
        query = "SELECT design FROM designs WHERE study = ? AND design BETWEEN ? AND ?"
        there = {row[0] for row in self._file.execute(query, (self._id, min(designs), max(designs)))}
        left, known = {design: values for design, values in designs.items() if design not in there}, list[Row]()
        for design, values in [*left.items()]:
            try:
                scene = spelt_out(self.study.scene(values))
            except Failed:  # computing it gives the reason
                continue
            self._scenes[design] = digest(code(), scene, repr(self.study.at))
            if row := self._known(design, values):
                known.append(row)
                del left[design]
        self._insert(known)
        return left

    def _known(self, design: int, values: tuple[Value, ...]) -> Row | None:
        """The row of a design whose scene a study in the file has answered."""
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
        """Store rows that were computed, all or none."""
        self._insert(rows)
        self.computed += len(rows)

    def rows(self) -> Iterator[Row]:
        """The rows of the study in the order of the designs; InputError at one that is not as it was written."""
        return _rows(self.path, self._file, self._id)


def read_table(path: str | PathLike[str], name: str | None = None) -> StoredTable:
    """The table of the study of a name in a store, or of the one computed last; also while a study is at work.

    InputError if the file is none, has no such study, or is damaged.
    """
    path = Path(path)
    state_of(path)
    with _opened(path, "rw") as file:  # what a kill left half written is taken back
        studies = file.execute("SELECT * FROM studies ORDER BY rowid DESC").fetchall()
        for study, called, text in studies:
            if name in (None, called):
                about = json.loads(text) if digest(text) == study else None
                if about is None:
                    raise InputError(
                        path, "", "is damaged: what it says of a study is not as it was written; delete it"
                    )
                varied, responses = (tuple(about[role]) for role in ("varied", "responses"))
                return StoredTable(varied, responses, about["units"], [*_rows(path, file, study)])
    names = ", ".join(dict.fromkeys(called for _, called, _ in studies))
    raise InputError(path, "", f"must hold a study {name or ''}; got {names or 'none'}")


def write_table(study: Study, rows: Iterable[Row], path: Path) -> None:
    """A study's table as .csv, numbers with all their digits; the units stand in the head, "" for pure numbers."""
    pairs = zip(study.columns, study.units, strict=True)
    head = ["design", *(f"{name} [{unit}]" if unit else name for name, unit in pairs), "failure"]
    with path.open("w", newline="", encoding="utf-8") as file:
        lines = ((row.design, *row.values, *row.responses, row.failure) for row in rows)
        csv.writer(file).writerows((head, *lines))
