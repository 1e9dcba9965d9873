"""Draws mutants of the package at random and counts those that a test detects: `python tests/mutants.py --seed 1`.

A mutant is the package with one operator, comparison, condition or number changed: in a function, at the level of a
module or class (tables, limits, defaults), or in the kernel's C. A first run of the everyday tests under `coverage`
records which test executes which line. Then each mutant is written into a copy of the tree, and a forked process runs
the tests that execute the line, the shortest first, until one fails: forked from one that has collected the tests and
with the changed functions' code exchanged, or, for the level of a module, from one that has not imported the package.
A process has a limit of processor time, not of time: a busy machine has no effect. A mutant that does not compile, or
compiles to the same code, is not drawn. `equivalent_mutants.txt` lists mutants that no test can detect, each with its
reason.
A number becomes a tenth larger, an integer the next one. At the level of a module, a power of ten that is very small or
large becomes a thousand times larger, and an integer from ten on half as large: such numbers are tolerances and
resolutions, whose neighbours change no digit that anyone is promised.
Printed: one line a mutant, then detected fractions by group and room with their 95 % intervals (Wilson).
"""

import argparse
import ast
import contextlib
import dis
import functools
import gc
import itertools
import json
import math
import multiprocessing
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import types
import warnings
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

# Imported before the forks, so that each mutant's process has them.
import hypothesis
import matplotlib.figure  # noqa: F401
import numpy  # noqa: F401
import psutil
import pytest
import scipy.linalg
import scipy.optimize  # noqa: F401
import skfem  # noqa: F401
from _pytest.runner import runtestprotocol

ROOT = Path(__file__).parents[1]
INTERFACE = ("analysis", "cli", "designs", "designer", "files", "handbook", "measurements", "show")
EQUIVALENT = Path(__file__).with_name("equivalent_mutants.txt")
SECONDS = 60.0  # of tests a mutant, as the first run measured them
START = 10.0  # s of processor time that a process may take beside its tests
IMPORTS = 40.0  # s more for imports and collection
STILL = 600.0  # s without processor time after which a process is ended
FIRST = 12  # tests of the first fork: most mutants are detected by them, and few test files are imported
# Tests that start the package in a process of its own, or read the tree's files: they say little of a mutant.
EXCLUDED = (
    "tests/contact/test_kernel_build.py",
    "tests/test_readme.py",
    "tests/studies",
)
# What calls the kernel, whose C has no coverage of its own, and the tests of contacts.
KERNEL_CALLS = ("cuefem/contact/step_records.py", "cuefem/endmass/impulse_response.py")
KERNEL_TESTS = ("tests/contact", "tests/effects", "tests/endmass", "tests/test_golden")
# Of signatures and tables, whose lines imports execute: first for a mutant at module level.
TABLE_TESTS = ("tests/test_defaults.py", "tests/test_golden_tables.py")
GOLDEN_TESTS = ("tests/test_golden_files.py", "tests/test_golden_commands.py")
# Keywords: what a dataclass prints of itself, the size of a cache, the assertion of `zip` that lengths are equal, and
# what one test asserts of all dataclasses at once: such draws would say nothing of numbers.
NO_RESULT = ("repr", "maxsize", "strict", "frozen", "eq")
SWAPS: dict[type, type] = {
    **{ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult},
    **{ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq},
    **{ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.And: ast.Or, ast.Or: ast.And},
}
C_SWAPS = {
    **{"+": "-", "-": "+", "*": "/", "/": "*", "<": ">=", ">": "<=", "<=": ">", ">=": "<"},
    **{"&&": "||", "||": "&&", "==": "!=", "!=": "==", "+=": "-=", "-=": "+="},
}
# An operator between two operands, or a number that is no index.
C_SITE = re.compile(
    r"(?<=[\w\])] )(?:\+=|-=|&&|\|\||[=!<>]=|[-+*/<>])(?= [\w(\-!&*])|(?<![\w.\[])\d+(?:\.\d+(?:e-?\d+)?)?(?![\w.\]])"
)
C_IGNORED = re.compile(
    r"/\*[\s\S]*?\*/|//[^\n]*|^#[^\n]*|\bfor \([^;]*;[^;]*;[^)]*\)|\b(?:double|int|char|void) \*", re.M
)


class Mutant(NamedTuple):
    """A file, the changed line and its text, the range in bytes of UTF-8, the old and the new text, and the group."""

    path: Path
    line: int
    row: str
    ends: tuple[int, int]
    old: str
    new: str
    group: str

    @property
    def file(self) -> str:
        """The file in a tree."""
        return self.path.relative_to(ROOT).as_posix()

    def applied(self, whole: bytes) -> bytes:
        """The text of the file with the change."""
        return whole[: self.ends[0]] + self.new.encode() + whole[self.ends[1] :]

    @property
    def name(self) -> str:
        """File, line and change, without a line number, as `equivalent_mutants.txt` has them."""
        return " ".join(f"{self.file}: {self.row}: {self.old} -> {self.new}".split())

    @property
    def room(self) -> str:
        """The folder of the package, or the file at its root."""
        return self.path.relative_to(ROOT / "cuefem").parts[0]


def changed(node: ast.AST, in_function: bool = True) -> ast.expr | ast.AugAssign | None:
    """A changed expression for an operator, comparison, condition or number, or None."""
    match node:
        case ast.BinOp(ast.JoinedStr() | ast.Constant(str()), _, _):
            return None  # no text has another operator
        case ast.BinOp(left, op, right) if type(op) in SWAPS:
            return ast.BinOp(left, SWAPS[type(op)](), right)
        case ast.AugAssign(target, op, value) if type(op) in SWAPS:
            return ast.AugAssign(target, SWAPS[type(op)](), value)
        case ast.Compare(left, [op, *others], right):
            return ast.Compare(left, [SWAPS[type(op)](), *others], right)
        case ast.BoolOp(op, values):
            return ast.BoolOp(SWAPS[type(op)](), values)
        case ast.UnaryOp(ast.Not() | ast.USub(), operand):
            return operand
        case ast.Constant(bool(value)):
            return ast.Constant(not value)
        case ast.Constant(int(value)) if value >= 10 and not in_function:
            return ast.Constant(value // 2)
        case ast.Constant(float(value)) if is_order_of_magnitude(value) and not in_function:
            return ast.Constant(1e3 * value)
        case ast.Constant(int(value) | float(value)):
            return ast.Constant(value + 1 if isinstance(value, int) or value == 0 else 1.1 * value)
    return None


def is_order_of_magnitude(value: float) -> bool:
    """Whether a number is a power of ten beyond 1e-4 to 1e6: of a tolerance, or of something that is never reached."""
    return value > 0 and math.log10(value).is_integer() and not 1e-4 < value < 1e6


def expressions(node: ast.AST, in_function: bool = False) -> Iterator[tuple[ast.expr | ast.AugAssign, bool]]:
    """Expressions below a node that are evaluated, each with whether it stands in a function's body.

    Annotations, patterns and the parts of f-strings, whose positions Python 3.11 does not know, are left out, and what
    no result depends on.
    """
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "pattern") or isinstance(node, ast.JoinedStr):
            continue
        if isinstance(node, ast.keyword) and node.arg in NO_RESULT:
            continue
        inside = in_function or (
            isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda) and name == "body"
        )
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.expr | ast.AugAssign):
                yield child, inside
            if isinstance(child, ast.AST):
                yield from expressions(child, inside)


def python_mutants(path: Path) -> Iterator[Mutant]:
    """Every mutant of a Python file."""
    text = path.read_bytes()
    rows = text.splitlines(keepends=True)
    starts = [0, *itertools.accumulate(map(len, rows))]
    room = path.relative_to(ROOT / "cuefem").parts[0]
    kind = "interface" if room in INTERFACE else "core"
    for node, in_function in expressions(ast.parse(text)):
        new = changed(node, in_function)
        if new is None or node.end_lineno is None or node.end_col_offset is None:
            continue
        ends = starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset
        row, old = rows[node.lineno - 1].decode().strip(), text[slice(*ends)].decode()
        group = kind if in_function else "module level"
        text_of_new = ast.unparse(new) if isinstance(new, ast.AugAssign) else f"({ast.unparse(new)})"
        yield Mutant(path, node.lineno, row, ends, old, text_of_new, group)


def c_mutants(path: Path) -> Iterator[Mutant]:
    """Every mutant of a C file's functions."""
    text = path.read_text(encoding="utf-8")
    ignored = [match.span() for match in C_IGNORED.finditer(text)]
    for match in C_SITE.finditer(text):
        row = text[text.rfind("\n", 0, match.start()) + 1 :].partition("\n")[0]
        if not row.startswith(" ") or any(start <= match.start() < end for start, end in ignored):
            continue
        old = match[0]
        new = C_SWAPS.get(old) or (repr(1.1 * float(old) or 1.0) if "." in old else str(int(old) + 1))
        ends = len(text[: match.start()].encode()), len(text[: match.end()].encode())
        yield Mutant(path, text.count("\n", 0, match.start()) + 1, row, ends, old, new, "C")


def is_other(mutant: Mutant, tree: Path) -> bool:
    """Whether a mutant compiles, to other code than what it changes: else no test can tell."""
    whole = mutant.path.read_bytes()
    if mutant.group == "C":
        return library(tree, mutant.file, mutant.applied(whole)) not in (b"", library(tree, mutant.file, whole))
    try:
        with warnings.catch_warnings(action="ignore"):  # of a comparison that is always true
            other = compile(mutant.applied(whole), mutant.file, "exec")
    except SyntaxError:
        return False
    return instructions(other) != instructions(compile(whole, mutant.file, "exec"))


def instructions(code: types.CodeType) -> list[Any]:
    """The instructions of a code and of those in it, without positions."""
    own = [(type(one.argval), one.opcode, repr(one.argval)) for one in dis.get_instructions(code)]
    return [own, [instructions(constant) for constant in code.co_consts if isinstance(constant, types.CodeType)]]


@functools.lru_cache(maxsize=32)
def library(tree: Path, file: str, text: bytes) -> bytes:
    """The kernel compiled from a tree with another text of one file, without the digest; b"" if it does not compile."""
    path = tree / file
    whole = path.read_bytes()
    path.write_bytes(text)
    compiles = built(tree, CFLAGS="-O1 -Wl,--build-id=none")
    path.write_bytes(whole)
    return re.sub(rb"[0-9a-f]{64}", b"", next(path.parent.glob("_kernel.*")).read_bytes()) if compiles else b""


def drawn(seed: int, counts: dict[str, int], tree: Path, only: str) -> list[Mutant]:
    """A random sample of each group: mutants that are not listed as equivalent and that `is_other` tells apart.

    only: a file and line, all mutants of which are taken instead.
    """
    listed = EQUIVALENT.read_text(encoding="utf-8").splitlines() if EQUIVALENT.exists() else []
    equivalent = {row.partition(" | ")[0] for row in listed if row and not row.startswith("#")}
    python = sorted((ROOT / "cuefem").rglob("*.py"))
    sources = sorted((ROOT / "cuefem").rglob("*.c"))
    population, names = defaultdict(list), set()
    for mutant in itertools.chain(*map(python_mutants, python), *map(c_mutants, sources)):
        names.add(mutant.name)
        if mutant.name not in equivalent and only in ("", f"{mutant.file}:{mutant.line}"):
            population[mutant.group].append(mutant)
    for name in sorted(equivalent - names):
        print(f"no such mutant, though listed as equivalent: {name}")
    if not population:
        raise SystemExit(f"no mutant at {only}")
    for group, mutants in population.items():
        print(f"{group}: {len(mutants)} mutants, {counts[group]} drawn")
    sample = []
    for group, count in counts.items():
        random.Random(f"{seed} {group}").shuffle(population[group])
        others = (mutant for mutant in population[group] if is_other(mutant, tree))
        sample += itertools.islice(others, count)
    built(tree)
    return sample


class Reach(NamedTuple):
    """What the first run recorded: processor seconds of each test, tests by file and line, and lines run by imports."""

    seconds: dict[str, float]
    tests: dict[str, dict[int, list[str]]]
    at_import: set[tuple[str, int]]

    def chosen(self, mutant: Mutant) -> list[str]:
        """Tests for a mutant: those that execute its line, else those of its file; then the others of their files.

        Of each kind the ``FIRST`` shortest come first, then the others file by file; up to ``SECONDS`` in all. For a
        mutant at module level the tests of defaults, tables and golden files come first.
        """
        files = KERNEL_CALLS if mutant.group == "C" else (mutant.file,)
        lines = [row for file in files for row in self.tests.get(file, {}).items()]
        at_line = [] if mutant.group in ("C", "module level") else self.tests.get(mutant.file, {}).get(mutant.line, [])
        reached = sorted(set(at_line) or {name for _, names in lines for name in names})
        if mutant.group == "C":
            reached = [name for name in reached if name.startswith(KERNEL_TESTS)]
        of_reached = {test_file(name) for name in reached}
        others = {name for name in self.seconds if test_file(name) in of_reached} - set(reached)
        first = [name for name in self.seconds if test_file(name) in TABLE_TESTS]
        first += [name for name in self.ordered(reached) if test_file(name) in GOLDEN_TESTS]
        if mutant.group != "module level":
            first = []
        ordered = [*first, *(name for names in (reached, others) for name in self.ordered(set(names) - set(first)))]
        total = itertools.accumulate(self.seconds[name] for name in ordered)
        return [name for name, until in zip(ordered, total, strict=True) if until < SECONDS]

    def ordered(self, names: Collection[str]) -> list[str]:
        """The shortest tests first, then the others file by file, so that tests of a file share its fixtures."""
        of_file: dict[str, float] = defaultdict(float)
        for name in names:
            of_file[test_file(name)] += self.seconds[name]
        shortest = sorted(names, key=lambda name: (self.seconds[name], name))
        return shortest[:FIRST] + sorted(shortest[FIRST:], key=lambda name: (of_file[test_file(name)], test_file(name)))


def test_file(name: str) -> str:
    """The file of a test."""
    return name.partition("::")[0]


def processor_time() -> float:
    """Processor seconds of this process and of those that it has waited for."""
    return sum(os.times()[:4])


class Recorder:
    """A plugin that records the processor time and the executed lines of each test.

    Lines of a fixture that tests share count for each test that requests it.
    """

    def __init__(self, measured: Any) -> None:
        self.measured = measured
        self.seconds: dict[str, float] = {}
        self.failed: set[str] = set()
        self.users: dict[str, list[str]] = defaultdict(list)  # of each shared fixture
        self.contexts = [""]

    @contextlib.contextmanager
    def context(self, name: str) -> Iterator[None]:
        """Record executed lines under a name."""
        self.contexts.append(name)
        self.measured.switch_context(name)
        try:
            yield
        finally:
            self.contexts.pop()
            self.measured.switch_context(self.contexts[-1])

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Note which tests request a fixture."""
        for item in session.items:
            for name in getattr(item, "fixturenames", ()):
                self.users[name].append(item.nodeid)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Measure one test."""
        start = processor_time()
        with self.context(item.nodeid):
            result = yield
        self.seconds[item.nodeid] = processor_time() - start
        return result

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Iterator[None]:
        """Record the lines of a fixture."""
        if fixturedef.scope == "function":
            return (yield)
        with self.context(f"fixture {fixturedef.argname} {fixturedef.baseid}"):
            return (yield)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note a failed test."""
        if report.failed:
            self.failed.add(report.nodeid)

    def tests(self, context: str) -> list[str]:
        """The tests of a context."""
        if not context.startswith("fixture "):
            return [context]
        _, name, base = context.split(" ", 2)
        return [test for test in self.users[name] if test.startswith(base)]


class FirstFailure:
    """A plugin that runs the named tests of those collected, and writes the first failure to a file.

    A name that is not collected, since the mutant changes it or a kept first run is older, is left out.
    """

    def __init__(self, path: Path, names: Sequence[str]) -> None:
        self.path = path
        self.order = {name: place for place, name in enumerate(names)}

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Keep the named tests, in their order."""
        named = [item for item in items if item.nodeid in self.order]
        items[:] = sorted(named, key=lambda item: self.order[item.nodeid])

    def note(self, text: str) -> None:
        """Write the first failure."""
        if not self.path.exists():
            self.path.write_text(text, encoding="utf-8")

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Note an error while tests are collected."""
        if report.failed:
            self.note(f"collection of {report.nodeid}")

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note a failed test."""
        if report.failed:
            self.note(report.nodeid)


def run_pytest(tree: Path, arguments: Sequence[str], plugin: Any) -> int:
    """Run tests of a tree in this process, without workers and without output."""
    os.chdir(tree)
    sys.path.insert(0, str(tree))
    # A failing example is not shrunk: that it fails is enough.
    phases = (hypothesis.Phase.explicit, hypothesis.Phase.generate)
    hypothesis.settings.register_profile("mutants", derandomize=True, deadline=None, database=None, phases=phases)
    options = ["-p", "no:xdist", "-p", "no:cacheprovider", "--tb=no", "--import-mode=importlib", "-q"]
    options += [
        "-W",
        "ignore::pytest.PytestAssertRewriteWarning",
        "-o",
        "addopts=",
        "-m",
        "not heavy and not nightly",
        "--hypothesis-profile=mutants",
    ]
    options += [f"--basetemp={tree / 'tmp'}"]
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere), contextlib.redirect_stderr(nowhere):
        return int(pytest.main([*options, *arguments], plugins=[plugin]))


def test_folders(tree: Path) -> list[str]:
    """Folders and files of tests, without those in ``EXCLUDED``."""
    folders = sorted(str(path.relative_to(tree)) for path in tree.glob("tests/*") if any(path.rglob("test_*.py")))
    folders += sorted(str(path.relative_to(tree)) for path in tree.glob("tests/test_*.py"))
    return [folder for folder in folders if folder not in EXCLUDED] + [f"--ignore={path}" for path in EXCLUDED]


def record_coverage(tree: Path, folders: Sequence[str], file: Path) -> None:
    """Run tests of a tree under coverage; write what `first_run` reads."""
    import coverage  # no dependency of the tests

    measured = coverage.Coverage(data_file=None, source=[str(tree / "cuefem")], config_file=False)
    measured.start()
    recorder = Recorder(measured)
    run_pytest(tree, folders, recorder)
    measured.stop()
    data = measured.get_data()
    numbers = {name: number for number, name in enumerate(recorder.seconds)}
    lines, at_import = [], []
    for path in sorted(data.measured_files()):
        short = str(Path(path).relative_to(tree))
        for line, contexts in data.contexts_by_lineno(path).items():
            named = {test for context in contexts if context for test in recorder.tests(context)}
            lines.append((short, line, sorted(numbers[test] for test in named if test in numbers)))
            if "" in contexts:
                at_import.append((short, line))
    file.write_text(json.dumps([recorder.seconds, sorted(recorder.failed), lines, at_import]), encoding="utf-8")


def first_run(tree: Path, workers: int, folder: Path) -> Reach:
    """The everyday tests under coverage, in as many processes as there are workers; or what ``folder`` has of them."""
    if not any(folder.glob("coverage_*.json")):
        folder.mkdir(parents=True, exist_ok=True)
        folders = test_folders(tree)
        context = multiprocessing.get_context("fork")
        shares = [
            context.Process(target=record_coverage, args=(tree, folders[n::workers], folder / f"coverage_{n}.json"))
            for n in range(workers)
        ]
        for share in shares:
            share.start()
        for share in shares:
            share.join()
    seconds: dict[str, float] = {}
    tests: dict[str, dict[int, list[str]]] = defaultdict(lambda: defaultdict(list))
    at_import: set[tuple[str, int]] = set()
    for file in sorted(folder.glob("coverage_*.json")):
        durations, failed, lines, imported = json.loads(file.read_text(encoding="utf-8"))
        for name in failed:
            print(f"left out, fails without a mutant: {name}")
        names = list(durations)
        passed = {name: s for name, s in durations.items() if name not in failed}
        seconds |= passed
        for path, line, numbers in lines:
            tests[path][line] += [names[number] for number in numbers if names[number] in passed]
        at_import |= {(path, line) for path, line in imported}
    return Reach(seconds, tests, at_import)


def forked(run: Callable[[], int], file: Path, seconds: float) -> str:
    """What a forked process writes to ``file`` as the first failure, ended after ``seconds`` of its processor time.

    One that ends with another status detects too, as when the tests' own modules cannot import the mutant.
    A process that burns its time does not end, which a test detects; one that waits for `STILL` seconds tells nothing.
    """
    file.unlink(missing_ok=True)
    pid = os.fork()
    if pid == 0:
        status = 1
        try:
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(seconds), math.ceil(seconds) + 1))
            status = run()
        finally:  # also after an error, which must not go on in the parent's code
            os._exit(status)
    used, since = 0.0, time.monotonic()
    while True:
        ended, status = os.waitpid(pid, os.WNOHANG)
        if ended:
            code = os.waitstatus_to_exitcode(status)
            if file.exists():
                return file.read_text(encoding="utf-8")
            quiet = {0: "", int(pytest.ExitCode.NO_TESTS_COLLECTED): "", -signal.SIGXCPU: "does not end"}
            return quiet.get(code, f"ends with status {code}")
        with contextlib.suppress(psutil.Error):
            now = sum(psutil.Process(pid).cpu_times()[:4])
            if now > used:
                used, since = now, time.monotonic()
        if time.monotonic() - since > STILL:
            os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
            return ""
        time.sleep(0.02)


@contextlib.contextmanager
def written(tree: Path, mutant: Mutant) -> Iterator[bool]:
    """Write a mutant into a tree, compiled where it is C; whether it compiles."""
    file = tree / mutant.file
    whole = file.read_bytes()
    try:
        yield put(tree, file, mutant.applied(whole))
    finally:
        put(tree, file, whole)


def put(tree: Path, file: Path, text: bytes) -> bool:
    """Write a file of a tree, without its stale bytecode, and compile it where it is C; whether it compiles."""
    file.write_bytes(text)
    for stale in file.parent.glob(f"__pycache__/{file.stem}.*.pyc"):
        stale.unlink()
    return built(tree) if file.suffix == ".c" else True


class Server:
    """A plugin that, instead of running the collected tests, forks a process a mutant that runs those that reach it.

    The forked process gets the mutant's code for the functions that it changes, so that nothing is imported anew.
    """

    def __init__(self, tree: Path, reach: Reach, mutants: Any, results: Any) -> None:
        self.tree, self.reach, self.mutants, self.results = tree, reach, mutants, results

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Serve mutants until there are no more."""
        gc.unfreeze()
        objects = gc.get_objects()
        caches = [found for found in objects if isinstance(found, functools._lru_cache_wrapper)]
        caches = [cache for cache in caches if cache.__module__.startswith("cuefem")]
        functions: dict[tuple[str, str, int], list[types.FunctionType]] = defaultdict(list)
        for found in objects:
            if isinstance(found, types.FunctionType):
                functions[where(found.__code__)].append(found)
        del objects
        gc.freeze()
        items = {item.nodeid: item for item in session.items}
        while (mutant := self.mutants.get()) is not None:
            names = [name for name in self.reach.chosen(mutant) if name in items]
            changes = self.changes(mutant, functions)
            if mutant.group != "C" and not changes:
                self.results.put((mutant, None))
                continue

            def run(names: list[str] = names, changes: list[Any] = changes) -> int:
                for cache in caches:
                    cache.cache_clear()
                for function, code in changes:
                    function.__code__ = code
                tests = [items[name] for name in names]
                for test, following in zip(tests, [*tests[1:], None], strict=True):
                    if any(report.failed for report in runtestprotocol(test, nextitem=following, log=False)):
                        (self.tree / "failure.txt").write_text(test.nodeid, encoding="utf-8")
                        return 1
                return 0

            seconds = START + 5 * sum(self.reach.seconds[name] for name in names)
            with written(self.tree, mutant) as compiles:
                by = forked(run, self.tree / "failure.txt", seconds) if compiles else "does not compile"
            # A line that imports execute may have left its result in a table: the package is imported anew.
            anew = not by and (mutant.file, mutant.line) in self.reach.at_import
            self.results.put((mutant, None if anew else by))
        return True

    def changes(self, mutant: Mutant, functions: dict[Any, list[Any]]) -> list[tuple[types.FunctionType, Any]]:
        """Functions whose code a mutant changes, each with its new code; none if it changes a module or a class."""
        if mutant.group in ("C", "module level"):
            return []
        file = self.tree / mutant.file
        whole = file.read_bytes()
        old, new = (list(codes(compile(text, file, "exec"))) for text in (whole, mutant.applied(whole)))
        if len(old) != len(new):
            return []
        pairs = [(one, other) for one, other in zip(old, new, strict=True) if one != other]
        return [(function, other) for one, other in pairs for function in functions[where(one)]]


def codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """A code and all those in it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from codes(constant)


def where(code: types.CodeType) -> tuple[str, str, int]:
    """File, name and first line of a code."""
    return code.co_filename, code.co_qualname, code.co_firstlineno


def serve(tree: Path, reach: Reach, mutants: Any, results: Any) -> None:
    """Collect the tests once and judge mutants of functions."""
    run_pytest(tree, test_folders(tree), Server(tree, reach, mutants, results))
    results.put(None)


def judge_anew(tree: Path, reach: Reach, mutants: Any, results: Any) -> None:
    """Judge mutants, each by processes that import the package anew."""
    while (mutant := mutants.get()) is not None:
        tests = reach.chosen(mutant)
        with written(tree, mutant) as compiles:
            by = "" if compiles else "does not compile"
            for stage in (tests[:FIRST], tests[FIRST:]):
                if by or not stage:
                    break
                failure = FirstFailure(tree / "failure.txt", stage)
                files = list(dict.fromkeys(map(test_file, stage)))
                seconds = IMPORTS + START + 5 * sum(reach.seconds[name] for name in stage)
                by = forked(partial(run_pytest, tree, ["-x", *files], failure), failure.path, seconds)
        results.put((mutant, by))
    results.put(None)


def built(tree: Path, **environment: str) -> bool:
    """Compile the kernel of a tree; whether it compiles."""
    command = [sys.executable, "hatch_build.py"]
    done = subprocess.run(command, cwd=tree, env=os.environ | environment, capture_output=True, check=False)
    return done.returncode == 0


def copied(folder: Path) -> Path:
    """A copy of the tree, with its kernel compiled."""
    ignored = shutil.ignore_patterns(
        ".git", ".venv*", "__pycache__", ".*_cache", "dist", "site", "*.sqlite", ".hypothesis"
    )
    shutil.copytree(ROOT, folder, ignore=ignored)
    built(folder)
    return folder


def judged(
    judge: Callable[..., None], trees: Sequence[Path], reach: Reach, mutants: Sequence[Mutant]
) -> Iterator[tuple[Mutant, str | None]]:
    """Each mutant with the first failure that it causes, as processes find them, one a tree; None if not judged."""
    if not mutants:
        return
    context = multiprocessing.get_context("fork")
    tasks, results = context.SimpleQueue(), context.SimpleQueue()
    workers = [context.Process(target=judge, args=(tree, reach, tasks, results)) for tree in trees]
    for worker in workers:
        worker.start()
    for mutant in [*mutants, *[None] * len(trees)]:
        tasks.put(mutant)
    working, left = len(trees), len(mutants)
    while working:
        if (row := results.get()) is None:
            working -= 1
            continue
        left -= 1
        yield row
    if left:
        raise SystemExit(f"{left} mutants were not judged: the tests cannot be collected")


class Tally:
    """Detected mutants of each group and room, printed one by one."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.detected: Counter[str] = Counter()
        self.at_collection = 0

    def add(self, mutant: Mutant, by: str) -> None:
        """Count and print a mutant with the failure that it causes."""
        for name in (mutant.group, f"  {mutant.group}, {mutant.room}"):
            self.counts[name] += 1
            self.detected[name] += bool(by)
        self.at_collection += by.startswith("collection")
        row = f"{mutant.file}:{mutant.line} {mutant.old} -> {mutant.new}"
        print(self.counts.total() // 2, " ".join(row.split()), "|", by or "SURVIVES", flush=True)

    def print(self) -> None:
        """Print the detected fractions."""
        for name, count in sorted(self.counts.items()):
            print(f"{name}: detected {interval(self.detected[name], count)}")
        print(f"detected by errors of collection: {self.at_collection}")


def interval(detected: int, count: int) -> str:
    """A fraction with its 95 % interval (Wilson)."""
    z, rate = 1.96, detected / count
    middle = (rate + z**2 / 2 / count) / (1 + z**2 / count)
    half = z * math.sqrt(rate * (1 - rate) / count + z**2 / 4 / count**2) / (1 + z**2 / count)
    return f"{detected} of {count}: {rate:.0%}, 95 % interval {middle - half:.0%} to {middle + half:.0%}"


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description="random mutants, and how many of them a test detects")
    for name, value in (("--seed", 1), ("--core", 80), ("--interface", 50), ("--module", 40), ("--c", 30)):
        parser.add_argument(name, type=int, default=value)
    parser.add_argument("--only", default="", metavar="FILE:LINE", help="all mutants of a line instead of random ones")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--first-run", type=Path, help="a folder that keeps the first run for the next call")
    options = parser.parse_args()
    own = {"core": options.core, "interface": options.interface, "module level": options.module, "C": options.c}
    counts = dict.fromkeys(own, sys.maxsize) if options.only else own
    os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        trees = [copied(Path(folder) / f"tree{number}") for number in range(options.workers)]
        sample = drawn(options.seed, counts, trees[0], options.only)
        reach = first_run(trees[0], options.workers, (options.first_run or Path(folder) / "first run").resolve())
        print(f"{len(reach.seconds)} tests, first run {time.monotonic() - start:.0f} s", flush=True)
        unchanged = Mutant(ROOT / "cuefem/contact/strike.py", 0, "", (0, 0), "", "", "module level")
        shortest = sorted(reach.seconds, key=reach.seconds.__getitem__)[:FIRST]
        few = reach._replace(tests={unchanged.file: {0: shortest}}, seconds={name: 0.1 for name in shortest})
        if rows := [by for _, by in judged(judge_anew, trees[:1], few, [unchanged]) if by]:
            raise SystemExit(f"the tree fails without a mutant: {rows}")
        of_modules = [mutant for mutant in sample if mutant.group == "module level"]
        found = Tally()
        for mutant, by in judged(serve, trees, reach, [mutant for mutant in sample if mutant not in of_modules]):
            if by is None:
                of_modules.append(mutant)
            else:
                found.add(mutant, by)
        for mutant, by in judged(judge_anew, trees, reach, of_modules):
            found.add(mutant, by or "")
    found.print()
    print(f"{len(sample)} mutants in {(time.monotonic() - start) / 60:.1f} minutes")


if __name__ == "__main__":
    main()
