"""SQLite store of computed designs, keyed by content hash and shared by any number of studies.

The key of a design is a hash of its scene, the resolution and the code, so that a study with changed ranges computes
only new designs. A block of designs is one line and one transaction: a killed process loses only its current blocks.
Each line has a hash of its own, so that an altered file is rejected. The table is internal; export designs by the CSV
or Parquet of `cuefem study`, or `StudyResult.to_frame`.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, closing, contextmanager
from functools import lru_cache
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np

from cuefem.cue import Array
from cuefem.designs.blocks import BlockResult
from cuefem.designs.design_key import KEY_BYTES, digest
from cuefem.designs.study import Study
from cuefem.files.errors import InputError, check_path, file_state
from cuefem.quantity.display import full_repr

APPLICATION_ID = 0x43754666  # SQLite's application_id in the header of the file
LOCK_TIMEOUT = 60.0  # s, to wait for another study that writes to the file
TABLES = f"""
BEGIN;
PRAGMA application_id = {APPLICATION_ID};
CREATE TABLE blocks (id INTEGER PRIMARY KEY, names TEXT NOT NULL, keys BLOB NOT NULL, answers BLOB NOT NULL,
  failures TEXT NOT NULL, digest BLOB NOT NULL);
COMMIT;
"""
KEY = np.dtype([("first", "<u8"), ("second", "<u8")])
READ_BLOCKS = 64  # stored blocks in memory: designs in order are in few of them


@contextmanager
def _opened(path: Path, mode: str = "rwc") -> Iterator[sqlite3.Connection]:
    """A connection to a store; InputError for a damaged file and errors of SQLite. mode: "ro" reads one that exists."""
    check_path(path)
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode={mode}", timeout=LOCK_TIMEOUT, uri=True)) as file:
            questions = ("SELECT count(*) FROM sqlite_master", "PRAGMA application_id", "PRAGMA quick_check(1)")
            tables, mark, state = (file.execute(question).fetchone()[0] for question in questions)
            if (tables or mode == "ro") and mark != APPLICATION_ID:
                raise InputError(path, "", "must be a store of `cuefem study`; got another database or an older store")
            if state != "ok":
                raise sqlite3.DatabaseError(state)
            yield file
    except (sqlite3.Error, UnicodeDecodeError, OverflowError) as error:
        raise InputError(path, "", f"cannot be read or written as a database: {error}") from None


class Stored(NamedTuple):
    """Stored designs of a block: their places in it, responses (places, responses), and failures by place in those."""

    places: list[int]
    values: Array
    failures: dict[int, str]


class SqliteStore:
    """The designs of a study in a file of any number of studies; a context manager.

    others: further stores, such as those of a study's parts, whose designs are read only.
    InputError if the file is not a store or is damaged. done: number of designs of the study that are stored, so far as
    they were asked for. computed: number of them added by this run.
    """

    def __init__(self, path: str | PathLike[str], study: Study, others: Iterable[Path] = ()) -> None:
        if " at 0x" in full_repr(study.base):  # a memory address, which does not identify its content
            raise InputError(path, "", "cannot store designs of a scene with a function")
        self.path, self.study, self.done, self.computed = Path(path), study, 0, 0
        self._others = tuple(others)
        self._names = [response.name for response in study.responses]
        self._block = lru_cache(READ_BLOCKS)(self._read_block)
        self._open = ExitStack()

    def __enter__(self) -> Self:
        for path in self._others:
            file_state(path)
        with ExitStack() as opening:
            files = {path: opening.enter_context(_opened(path, mode="ro")) for path in self._others}
            self._file = files[self.path] = opening.enter_context(_opened(self.path))
            if self._file.execute("SELECT count(*) FROM sqlite_master").fetchone() == (0,):
                self._file.executescript(TABLES)
            self._index_keys(files)
            self._open = opening.pop_all()
        return self

    def __exit__(self, *error: Any) -> bool | None:
        return self._open.__exit__(*error)

    @contextmanager
    def _reading(self, path: Path) -> Iterator[None]:
        """InputError for lines whose types or texts are damaged, which SQLite does not check."""
        try:
            yield
        except (TypeError, ValueError, AttributeError):
            raise InputError(path, "", "is damaged: a design was altered; delete the file") from None

    def _index_keys(self, files: dict[Path, sqlite3.Connection]) -> None:
        """Sort the keys of all stored blocks that have the study's responses, with their blocks and places in those."""
        self._lines, keys = list[tuple[Path, sqlite3.Connection, int]](), list[np.ndarray]()
        for path, file in files.items():
            with self._reading(path):
                for number, names, stored in file.execute("SELECT id, names, keys FROM blocks"):
                    if {*self._names} <= {*json.loads(names)}:
                        self._lines.append((path, file, number))
                        keys.append(np.frombuffer(stored[: len(stored) // KEY_BYTES * KEY_BYTES], KEY))
        every, counts = np.concatenate([np.zeros(0, KEY), *keys]), [len(each) for each in keys]
        order = np.argsort(every["first"], kind="stable")
        self._keys = every[order]
        self._blocks = np.repeat(np.arange(len(counts)), counts)[order]
        places = np.concatenate([np.zeros(0, int), *(np.arange(n) for n in counts)])
        self._places = places[order]

    @property
    def is_empty(self) -> bool:
        """Whether it held no design of such responses when it was opened."""
        return not len(self._keys)

    def read(self, keys: bytes) -> Stored:
        """The stored designs among those with these keys, of this or another study; InputError if one was altered."""
        asked = np.frombuffer(keys, KEY)
        at = np.searchsorted(self._keys["first"], asked["first"], side="right") - 1  # the last one stored
        found = np.flatnonzero((at >= 0) & (self._keys[at] == asked)) if len(self._keys) else np.zeros(0, int)
        places, values, failures = list[int](), list[np.ndarray](), dict[int, str]()
        for place in found.tolist():
            names, answers, reasons = self._block(int(self._blocks[at[place]]))
            inside = int(self._places[at[place]])
            reason = reasons.get(str(inside))
            if reason is not None and names != self._names:  # another response may have failed
                continue
            if reason is not None:
                failures[len(places)] = reason
            places.append(place)
            values.append(answers[inside, [names.index(name) for name in self._names]])
        self.done += len(places)
        return Stored(places, np.reshape(values, (-1, len(self._names))), failures)

    def _read_block(self, number: int) -> tuple[list[str], np.ndarray, dict[str, str]]:
        """The names, answers and failures of a stored block; InputError if it was altered."""
        path, file, line = self._lines[number]
        question = "SELECT names, keys, answers, failures, digest FROM blocks WHERE id = ?"
        with self._reading(path):
            names, keys, answers, failures, stored_digest = file.execute(question, (line,)).fetchone()
            if _line_digest(names, keys, answers, failures) != stored_digest:
                raise ValueError("digest")
        listed = json.loads(names)
        return listed, np.frombuffer(answers, "<f8").reshape(-1, len(listed)), json.loads(failures)

    def write(self, result: BlockResult) -> None:
        """Store a computed block in one transaction."""
        assert result.values is not None
        names, failures = json.dumps(self._names), json.dumps(result.failures)
        line = names, result.keys, result.values.astype("<f8").tobytes(), failures
        with self._file:
            self._file.execute(
                "INSERT INTO blocks (names, keys, answers, failures, digest) VALUES (?, ?, ?, ?, ?)",
                (*line, _line_digest(*line)),
            )
        self.done += len(result.values)
        self.computed += len(result.values)


def _line_digest(names: str, keys: bytes, answers: bytes, failures: str) -> bytes:
    return digest(names, bytes(keys).hex(), bytes(answers).hex(), failures)
