"""Designs that sweeps have computed, kept by what they are: one SQLite file for any number of sweeps and studies.

A design is known by a digest of its scene, the resolution and the code that computes, so a study whose ranges were
changed computes only what is new. Every row carries a digest of its own: one that is not as it was written counts as
missing and is computed again. Any number of sweeps may be at work on the file at once, and any of them may be killed.
The tables are internal: `write_table` (CSV, Parquet) and `cuefem.frames` are the ways out of them.
"""

from __future__ import annotations

import csv
import hashlib
import importlib
import json
import os
import random
import sqlite3
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from functools import cache
from importlib.metadata import version
from itertools import islice
from os import PathLike
from pathlib import Path
from time import monotonic, sleep
from typing import Any, NamedTuple, Self, TypeVar

from cuefem.design import Row, Study, Task
from cuefem.design.ranges import Value
from cuefem.design.sweep import scenes_of, tasks_of
from cuefem.io.errors import InputError, shown
from cuefem.notebook import spelt_out
from cuefem.scene import Scene

# SQLite's marks in the head of the file: whose database it is, and the version of its tables.
APPLICATION, SCHEMA = 0x43754665, 3
# How long a sweep waits for its turn to write, s.
PATIENCE = 60.0
T = TypeVar("T")
# studies: `turn` counts which was swept last. claims: blocks on which a sweep is, or was until it was killed, at work.
TABLES = (
    f"PRAGMA application_id = {APPLICATION}",
    f"PRAGMA user_version = {SCHEMA}",
    "CREATE TABLE studies (study BLOB PRIMARY KEY, turn INTEGER NOT NULL, name TEXT NOT NULL, about TEXT NOT NULL)",
    "CREATE TABLE designs (study BLOB, design INTEGER, scene BLOB, answer TEXT NOT NULL, digest BLOB NOT NULL, "
    "PRIMARY KEY (study, design)) WITHOUT ROWID",
    "CREATE INDEX by_scene ON designs (scene)",
    "CREATE TABLE claims (study BLOB, first INTEGER, sweep BLOB NOT NULL, PRIMARY KEY (study, first)) WITHOUT ROWID",
)
# Parts of cuefem that change no answer: left out of the digest.
NO_PHYSICS = {"cli", "designer", "frames.py", "handbook", "io", "measurements", "plot.py", "report"}


def digest(*parts: Any) -> bytes:
    """Of anything that JSON can hold, numbers by all their bits, and of bytes."""
    text = json.dumps(parts, default=bytes.hex)
    return hashlib.blake2b(text.encode("utf-8", "backslashreplace"), digest_size=16).digest()


@cache
def physics() -> str:
    """A digest of the code that computes, so that designs of another version are not taken for this one's."""
    package = Path(__file__).parents[1]
    code = hashlib.blake2b(version("cuefem").encode(), digest_size=16)
    for path in sorted(package.rglob("*")):
        inside = path.relative_to(package)
        if inside.parts[0] not in NO_PHYSICS and path.is_file() and path.suffix not in (".pyc", ".so", ".pyd", ".dll"):
            code.update(inside.as_posix().encode() + path.read_bytes())
    return code.hexdigest()


def what_it_is(scene: Scene, at: str) -> bytes:
    """A design's digest; a random one, never met again, where its text has a place in memory, as a function has."""
    text = spelt_out(scene)
    return digest(physics(), text, at, os.urandom(16) if " at 0x" in text else b"")


class StoredTable(NamedTuple):
    """A study's table: its columns in their order, their units, and its rows: number, what varied, responses, failure.

    named: columns of names of materials. sampled: whether the designs are a sample and no grid.
    """

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


class Store:
    """The designs of a study in a file that may hold those of others; a `cuefem.design.Store` and a context manager.

    InputError, with the file left as it was, if it is no store or a damaged one, and if it has two names (hard
    links): SQLite keeps its journal by the name, so that two sweeps by two names would destroy it.

    done: designs of the blocks taken so far that are there. computed: those of them that this sweep computed. damaged:
    rows that were not as they were written. changes: why designs of an earlier sweep of this name cannot be used.
    """

    def __init__(self, path: str | Path, study: Study, name: str = "") -> None:
        self.path, self.study, self.name, self.done, self.computed = Path(path), study, name, 0, 0
        self.damaged, self.changes = list[str](), list[str]()
        self._at, self._sweep, self._keys = repr(study.resolution), os.urandom(8), dict[int, bytes]()
        self._about: dict[str, Any] = {
            "physics": physics(),
            "varied": [vary.name for vary in study.vary],
            "responses": [response.name for response in study.responses],
            "units": dict(zip(study.columns, study.units, strict=True)),
            "named": [vary.name for vary in study.vary if vary.named],
            "sampled": study.sample is not None,
            "study": study.record,
        }
        self._id = digest(self._about)
        with refusing(self.path):
            self._file = opened(self.path)
            try:
                self._begin()
            except BaseException:
                self._file.close()
                raise

    def _begin(self) -> None:
        """Make the tables in an empty file, and let this study be the one swept last; refuse an older file."""
        schema = schema_of(self.path, self._file)
        if schema == 0:
            with self._transaction():
                if schema_of(self.path, self._file) == 0:  # still, now that no other sweep can make them
                    for command in TABLES:
                        self._file.execute(command)
        elif schema < SCHEMA:
            problem = "holds the sweep of an older cuefem, which can be read (`cuefem.frames.of_sweep`) but not go on"
            raise InputError(self.path, "", f"{problem}: rename it, or name another file with --store")
        studies = studies_in(self.path, self._file)
        before = next((about for _, name, about in studies if name == self.name), self._about)
        was, now = before["study"]["resolution"], self._about["study"]["resolution"]
        if before["physics"] != self._about["physics"]:
            self.changes = ["another version of cuefem computed this study before; all designs are computed again"]
        elif was != now:
            words = f"the resolution changed from {was} to {now}: all designs are computed again"
            self.changes = [f"{words}; [resolution] in the study holds it"]
        if not studies or studies[0][:2] != (self._id, self.name):
            line = self._id, self.name, json.dumps(self._about)
            with self._transaction():
                turn = "SELECT ?, 1 + coalesce(max(turn), 0), ?, ? FROM studies"
                self._file.execute(f"INSERT OR REPLACE INTO studies {turn}", line)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give up what is claimed, and leave one plain file if no other sweep is at work on it."""
        with closing(self._file), suppress(sqlite3.Error):
            if self._file.execute("PRAGMA journal_mode").fetchone() == ("wal",):
                self._file.execute("DELETE FROM claims WHERE sweep = ?", (self._sweep,))
        log = self.path.with_name(f"{self.path.name}-wal")
        for attempt in range(8):  # two that end at the same moment stand in each other's way, so each tries again
            if not log.exists():
                break
            sleep(random.uniform(0.0, 1e-3 * 2**attempt))
            with suppress(sqlite3.Error, InputError), closing(opened(self.path, mode="rw")) as alone:
                alone.execute("PRAGMA busy_timeout = 0")
                alone.execute("PRAGMA journal_mode = DELETE")

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        # write-ahead: a block costs no waiting for the disk, and those who read need not wait; a kill loses nothing
        unlocked(lambda: self._file.execute("PRAGMA journal_mode = WAL"))
        self._file.execute("PRAGMA synchronous = NORMAL")
        self._file.execute("BEGIN IMMEDIATE")
        try:
            yield
            self._file.execute("COMMIT")
        except BaseException:
            if self._file.in_transaction:  # a full disk has rolled back by itself
                self._file.execute("ROLLBACK")
            raise

    def take(self, designs: dict[int, tuple[Value, ...]], *, from_others: bool) -> list[Task] | None:
        """What is to be computed of a block; see `cuefem.design.Store`. Designs that other studies have are copied."""
        with refusing(self.path):
            missing = self._missing(designs)
            if not missing:
                self.done += len(designs)
                return []
            scenes, failed = scenes_of(self.study, missing)
            keys = {design: what_it_is(scene, self._at) for design, scene in scenes.items()}
            names = [response.name for response in self.study.responses]
            with self._transaction():
                claim, how = (self._id, min(designs), self._sweep), "REPLACE" if from_others else "IGNORE"
                if self._file.execute(f"INSERT OR {how} INTO claims VALUES (?, ?, ?)", claim).rowcount == 0:
                    return None
                known, whole = dict[int, dict[str, float]](), list[Row]()
                for design, key in keys.items():
                    known[design], failure = self._known(key, names)
                    if failure is not None or len(known[design]) == len(names):
                        whole.append(Row(design, missing[design], tuple(map(known[design].get, names)), failure))
                        del scenes[design]
                self._insert(whole, keys)
        self.done += len(designs) - len(missing) + len(whole)
        self._keys |= {design: keys[design] for design in scenes}
        return tasks_of(self.study, missing, scenes, failed, known)

    def _missing(self, designs: dict[int, tuple[Value, ...]]) -> dict[int, tuple[Value, ...]]:
        """The designs of a block that are not there, or not as they were written."""
        missing = dict(designs)
        for design, good, answer in stored_rows(self._file, self._id, min(designs), max(designs)):
            if good and answer["values"] == list(designs[design]):
                del missing[design]
            else:
                self.damaged.append(f"design {design} was not as it was written and is computed again")
        return missing

    def _known(self, key: bytes, names: list[str]) -> tuple[dict[str, float], str | None]:
        """What the studies in the file know of a scene, and why it has not all answers if the same was asked before."""
        numbers = dict[str, float]()
        for study, design, text, told in self._file.execute(
            "SELECT study, design, answer, digest FROM designs WHERE scene = ?", (key,)
        ):
            if told == digest(study, design, key, text):
                answer = json.loads(text)
                if answer["failure"] is not None and list(answer["responses"]) == names:
                    return answer["responses"], answer["failure"]
                numbers |= {name: x for name, x in answer["responses"].items() if x is not None and name in names}
        return numbers, None

    def _insert(self, rows: list[Row], keys: Mapping[int, bytes | None]) -> None:
        names, lines = [response.name for response in self.study.responses], []
        for row in rows:
            answer = {
                "values": [value if isinstance(value, str) else float(value) for value in row.values],
                "responses": dict(zip(names, row.responses, strict=True)),
                "failure": row.failure,
            }
            about = self._id, row.design, keys[row.design], json.dumps(answer)
            lines.append((*about, digest(*about)))
        self._file.executemany("INSERT OR REPLACE INTO designs VALUES (?, ?, ?, ?, ?)", lines)

    def write(self, rows: list[Row]) -> None:
        """Keep rows that were computed, all or none; a kill takes none of them back."""
        with refusing(self.path), self._transaction():
            self._insert(rows, {row.design: self._keys.pop(row.design, None) for row in rows})
        self.computed, self.done = self.computed + len(rows), self.done + len(rows)

    def count(self) -> int:
        """How many designs of the study are there, whoever computed them."""
        with refusing(self.path):
            query = "SELECT count(*) FROM designs WHERE study = ?"
            return int(self._file.execute(query, (self._id,)).fetchone()[0])

    def rows(self) -> Iterator[tuple[Any, ...]]:
        """The rows of the study in the order of the designs, streamed; InputError at one that was altered."""
        with refusing(self.path):
            yield from plain_rows(self.path, self._file, self._id)


def unlocked(ask: Callable[[], T]) -> T:
    """What is asked of SQLite, again until no other sweep is in the way: some of its locks it does not wait for."""
    late = monotonic() + PATIENCE
    while True:
        try:
            return ask()
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY or monotonic() > late:
                raise
        sleep(random.uniform(1e-3, 1e-2))


@contextmanager
def refusing(path: Path) -> Iterator[None]:
    """Say in one line what SQLite, or a damaged file, says in many ways."""
    try:
        yield
    except (sqlite3.Error, UnicodeDecodeError, OverflowError) as error:
        raise InputError(path, "", f"cannot be read or written as a database: {error}") from None


def opened(path: Path, *, mode: str = "rwc") -> sqlite3.Connection:
    """A connection in which transactions are begun by hand; InputError for a file of several names.

    mode: what SQLite may do with the file: "ro" reads, "rw" writes too, "rwc" makes it where it is missing.
    """
    with suppress(OSError):
        if os.stat(path).st_nlink > 1:
            raise InputError(path, "", "must have one name; got a file with hard links: make a copy of it instead")
    where = f"{path.resolve().as_uri()}?mode={mode}"
    return sqlite3.connect(where, timeout=PATIENCE, isolation_level=None, uri=True)


def schema_of(path: Path, file: sqlite3.Connection) -> int:
    """The version of a file's tables, 0 if it is empty; InputError if it is another file, too new, or damaged."""
    # Tables and mark are made in one transaction: looked for first, tables never stand without the mark.
    empty = file.execute("SELECT count(*) FROM sqlite_master").fetchone() == (0,)
    mark, schema = (int(file.execute(f"PRAGMA {name}").fetchone()[0]) for name in ("application_id", "user_version"))
    if not mark and empty:
        return 0
    if mark != APPLICATION:
        raise InputError(path, "", "must be a database of `cuefem sweep`; got another one")
    if not 1 <= schema <= SCHEMA:
        raise InputError(path, "", f"must be of schema {SCHEMA} or older; got {schema}, of a newer cuefem")
    (wrong,) = file.execute("PRAGMA integrity_check(1)").fetchone()
    if wrong != "ok":
        raise InputError(path, "", f"is damaged: {wrong}; take a copy from before, or delete it")
    return schema


def studies_in(path: Path, file: sqlite3.Connection) -> list[tuple[bytes, str, dict[str, Any]]]:
    """(digest, name, what is said of it) of each study in a file, the one swept last first."""
    studies = list[tuple[bytes, str, dict[str, Any]]]()
    for study, name, text in file.execute("SELECT study, name, about FROM studies ORDER BY turn DESC"):
        try:
            about = json.loads(text)
        except ValueError:
            about = None
        if study != digest(about):
            raise InputError(path, "", "is damaged: what it says of a study is not as it was written; take a copy")
        studies.append((study, name, about))
    return studies


def stored_rows(
    file: sqlite3.Connection, study: bytes, first: int = 0, last: int = 2**62
) -> Iterator[tuple[int, bool, dict[str, Any]]]:
    """(number of a design, whether its row is as it was written, its answer) of a study, in their order."""
    query = "SELECT design, scene, answer, digest FROM designs WHERE study = ? AND design BETWEEN ? AND ?"
    for design, key, text, told in file.execute(f"{query} ORDER BY design", (study, first, last)):
        good = told == digest(study, design, key, text)
        yield design, good, json.loads(text) if good else {}


def plain_rows(path: Path, file: sqlite3.Connection, study: bytes) -> Iterator[tuple[Any, ...]]:
    """The rows of a study: number, what varied, responses, failure; InputError at one that was altered."""
    for design, good, answer in stored_rows(file, study):
        if not good:
            raise InputError(path, "", f"design {design} is not as it was written: `cuefem sweep` computes it again")
        yield design, *answer["values"], *answer["responses"].values(), answer["failure"]


def read_table(path: str | PathLike[str], name: str | None = None) -> StoredTable:
    """The table of the study of a name in a store, or of the one swept last; read only, also while sweeps write on.

    InputError if the file is none, has no such study, or a row of it was altered.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(path, "", "cannot be read: no such file")
    with refusing(path), closing(opened(path, mode="ro")) as file:
        if schema_of(path, file) < SCHEMA:
            return _older_table(path, file)
        studies = studies_in(path, file)
        for study, called, about in studies:
            if name in (None, called):
                varied, responses, named = (tuple(about[role]) for role in ("varied", "responses", "named"))
                rows = list(plain_rows(path, file, study))
                return StoredTable(varied, responses, about["units"], named, about["sampled"], rows)
    names = ", ".join(dict.fromkeys(called for _, called, _ in studies))
    raise InputError(path, "", f"must hold a study {name or ''}; got {names or 'none'}")


def _older_table(path: Path, file: sqlite3.Connection) -> StoredTable:
    """The table of a file from before designs were kept by what they are: one study, a row a design."""
    about = {name: (unit, role) for name, unit, role in file.execute("SELECT name, unit, role FROM columns")}
    kinds = {name: kind for _, name, kind, *_ in file.execute("PRAGMA table_info(designs)") if name in about}
    record = json.loads(file.execute("SELECT value FROM study WHERE key = 'record'").fetchone()[0])
    rows = file.execute("SELECT * FROM designs ORDER BY design").fetchall()
    if file.execute("PRAGMA user_version").fetchone() == (2,):
        sums = dict(file.execute("SELECT design, checksum FROM checksums"))
        for design, *values, failure in rows:
            told = repr((design, values, failure)).encode("utf-8", "backslashreplace")
            if sums.get(design) != hashlib.blake2b(told, digest_size=8).digest():
                raise InputError(path, "", f"design {design} is not as it was written: take a copy from before")
    varied, responses = (tuple(name for name in kinds if about[name][1] == role) for role in ("varied", "response"))
    units = {name: unit for name, (unit, _) in about.items()}
    named = tuple(name for name, kind in kinds.items() if kind == "TEXT")
    return StoredTable(varied, responses, units, named, record["sample"] != "None", rows)


def export_path(path: str | Path) -> Path:
    """The path of an export; InputError if its kind is unknown or its library is missing."""
    path = Path(path)
    if path.suffix not in (".csv", ".parquet"):
        raise InputError(path, "", f"must end in .csv or .parquet; got {shown(path.suffix)}")
    if path.suffix == ".parquet":
        try:
            for library in ("pyarrow", "pyarrow.parquet"):
                importlib.import_module(library)
        except ImportError:
            raise InputError(path, "", "needs the library pyarrow: pip install '.[parquet]' in the clone") from None
    return path


def write_table(store: Store, path: Path) -> None:
    """The study's table as .csv or .parquet, numbers with all their digits."""
    study, rows = store.study, store.rows()
    pairs = zip(study.columns, study.units, strict=True)
    headings = ["design", *(f"{name} [{unit}]" if unit else name for name, unit in pairs), "failure"]
    if path.suffix == ".csv":
        with path.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([headings])
            csv.writer(file).writerows(rows)
        return
    arrow, parquet = importlib.import_module("pyarrow"), importlib.import_module("pyarrow.parquet")
    kinds = ["int64", *("string" if vary.named else "float64" for vary in study.vary)]
    kinds += ["float64"] * len(study.responses) + ["string"]
    schema = arrow.schema([(name, getattr(arrow, kind)()) for name, kind in zip(headings, kinds, strict=True)])
    with parquet.ParquetWriter(path, schema) as writer:
        while part := list(islice(rows, 65536)):
            writer.write_table(arrow.table([*map(list, zip(*part, strict=True))], schema=schema))
