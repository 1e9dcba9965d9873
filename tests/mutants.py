"""Draws mutants of the package at random and counts those that a test detects: `python tests/mutants.py --seed 1`.

A mutant is the package with one operator, comparison, condition or number changed: in a function, at the level of a
module or class (tables, limits, defaults), or in the kernel's C. A first run of the everyday tests under `coverage`
records which test executes which line. Then each mutant is written into a copy of the tree, and a process forked from
one that has imported the libraries, but not the package, runs the tests that execute the line, the shortest first,
until one fails. `equivalent_mutants.txt` lists mutants that no test can detect, each with its reason.
Printed: one line a mutant, then detected fractions by group and room with their 95 % intervals (Wilson).
"""

import argparse
import ast
import contextlib
import itertools
import json
import math
import multiprocessing
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

# Imported before the forks, so that each mutant's process has them.
import matplotlib.figure  # noqa: F401
import numpy  # noqa: F401
import pytest
import scipy.linalg
import scipy.optimize  # noqa: F401
import skfem  # noqa: F401

ROOT = Path(__file__).parents[1]
INTERFACE = ("analysis", "cli", "designs", "designer", "files", "handbook", "measurements", "show")
EQUIVALENT = Path(__file__).with_name("equivalent_mutants.txt")
SECONDS = 60.0  # of tests a mutant, as the first run measured them
START = 90.0  # s that a process may take beside its tests: imports, collection, a busy machine
FIRST = 12  # tests of the first fork: most mutants are detected by them, and few test files are imported
# Tests that start the package in a process of its own, or read the tree's files: they say little of a mutant.
EXCLUDED = (
    "tests/contact/test_kernel_build.py",
    "tests/test_readme.py",
    "tests/studies",
    "tests/designer/test_server.py",
)
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
    """A file, the first changed line, the changed range in bytes of UTF-8, the old and the new text, and the group."""

    path: Path
    line: int
    ends: tuple[int, int]
    old: str
    new: str
    group: str

    @property
    def name(self) -> str:
        """File and change, without a line number, as `equivalent_mutants.txt` has them."""
        return f"{self.path.relative_to(ROOT).as_posix()}: {self.old} -> {self.new}"

    @property
    def room(self) -> str:
        """The folder of the package, or the file at its root."""
        return self.path.relative_to(ROOT / "cuefem").parts[0]


def changed(node: ast.AST) -> ast.expr | None:
    """A changed expression for an operator, comparison, condition or number, or None."""
    match node:
        case ast.BinOp(left, op, right) if type(op) in SWAPS and not isinstance(left, ast.Constant | ast.JoinedStr):
            return ast.BinOp(left, SWAPS[type(op)](), right)
        case ast.Compare(left, [op], right):
            return ast.Compare(left, [SWAPS[type(op)]()], right)
        case ast.BoolOp(op, values):
            return ast.BoolOp(SWAPS[type(op)](), values)
        case ast.UnaryOp(ast.Not() | ast.USub(), operand):
            return operand
        case ast.Constant(bool(value)):
            return ast.Constant(not value)
        case ast.Constant(int(value) | float(value)):
            return ast.Constant(value + 1 if isinstance(value, int) or value == 0 else 1.1 * value)
    return None


def expressions(node: ast.AST, in_function: bool = False) -> Iterator[tuple[ast.expr, bool]]:
    """Expressions below a node that are evaluated, each with whether it stands in a function's body.

    Annotations, patterns and the parts of f-strings, whose positions Python 3.11 does not know, are left out.
    """
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "pattern") or isinstance(node, ast.JoinedStr):
            continue
        inside = in_function or (isinstance(node, ast.FunctionDef | ast.Lambda) and name == "body")
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.expr):
                yield child, inside
            if isinstance(child, ast.AST):
                yield from expressions(child, inside)


def python_mutants(path: Path) -> Iterator[Mutant]:
    """Every mutant of a Python file."""
    text = path.read_bytes()
    starts = [0, *itertools.accumulate(len(row) for row in text.splitlines(keepends=True))]
    room = path.relative_to(ROOT / "cuefem").parts[0]
    kind = "interface" if room in INTERFACE else "core"
    for node, in_function in expressions(ast.parse(text)):
        new = changed(node)
        if new is None or node.end_lineno is None or node.end_col_offset is None:
            continue
        ends = starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset
        old = text[slice(*ends)].decode()
        yield Mutant(path, node.lineno, ends, old, f"({ast.unparse(new)})", kind if in_function else "module level")


def c_mutants(path: Path) -> Iterator[Mutant]:
    """Every mutant of a C file's functions."""
    text = path.read_text(encoding="utf-8")
    ignored = [match.span() for match in C_IGNORED.finditer(text)]
    for match in C_SITE.finditer(text):
        row = text[text.rfind("\n", 0, match.start()) + 1 :]
        if not row.startswith(" ") or any(start <= match.start() < end for start, end in ignored):
            continue
        old = match[0]
        new = C_SWAPS.get(old) or (repr(1.1 * float(old) or 1.0) if "." in old else str(int(old) + 1))
        ends = len(text[: match.start()].encode()), len(text[: match.end()].encode())
        yield Mutant(path, text.count("\n", 0, match.start()) + 1, ends, old, new, "C")


def drawn(seed: int, counts: dict[str, int]) -> list[Mutant]:
    """A random sample of each group, without those listed as equivalent."""
    listed = EQUIVALENT.read_text(encoding="utf-8").splitlines() if EQUIVALENT.exists() else []
    equivalent = {row.partition(" | ")[0] for row in listed if row and not row.startswith("#")}
    python = sorted((ROOT / "cuefem").rglob("*.py"))
    sources = sorted((ROOT / "cuefem").rglob("*.c"))
    population = defaultdict(list)
    for mutant in itertools.chain(*map(python_mutants, python), *map(c_mutants, sources)):
        if mutant.name not in equivalent:
            population[mutant.group].append(mutant)
    for group, mutants in population.items():
        print(f"{group}: {len(mutants)} mutants, {counts[group]} drawn")
    return [
        mutant
        for group, count in counts.items()
        for mutant in random.Random(f"{seed} {group}").sample(population[group], min(count, len(population[group])))
    ]


class Durations:
    """A plugin that adds up the seconds of every test function."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = defaultdict(float)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Add the seconds of one phase."""
        self.seconds[report.nodeid.partition("[")[0]] += report.duration


class FirstFailure:
    """A plugin that writes the first failure, of a test or of the collection, to a file."""

    def __init__(self, path: Path) -> None:
        self.path = path

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


def run_pytest(arguments: Sequence[str], plugin: Any) -> int:
    """Run tests in this process without workers and without output."""
    options = ["-p", "no:xdist", "-p", "no:cacheprovider", "--tb=no", "--import-mode=importlib", "-q"]
    options += ["-o", "addopts=", "-m", "not heavy and not nightly"]
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere), contextlib.redirect_stderr(nowhere):
        return int(pytest.main([*options, *arguments], plugins=[plugin]))


def record_coverage(tree: Path, folders: Sequence[str], file: Path) -> None:
    """Run tests of a tree under coverage; write seconds of each test function and the functions of each line."""
    import coverage  # no dependency of the tests

    os.chdir(tree)
    sys.path.insert(0, str(tree))
    measured = coverage.Coverage(data_file=None, source=[str(tree / "cuefem")], config_file=False)
    measured.set_option("run:dynamic_context", "test_function")
    measured.start()
    durations = Durations()
    run_pytest(folders, durations)
    measured.stop()
    data = measured.get_data()
    lines = {str(Path(path).relative_to(tree)): data.contexts_by_lineno(path) for path in sorted(data.measured_files())}
    file.write_text(json.dumps([durations.seconds, lines]), encoding="utf-8")


class Reach(NamedTuple):
    """What the first run recorded: seconds of each test function, and functions by file and line."""

    seconds: dict[str, float]
    functions: dict[str, dict[int, list[str]]]

    def tests(self, mutant: Mutant) -> list[str]:
        """The test functions that execute the mutant's line, else those of its file, the shortest first."""
        path = str(mutant.path.relative_to(ROOT))
        if mutant.group == "C":
            path = "cuefem/contact/kernel/library.py"
        lines = self.functions.get(path, {})
        reached = lines.get(mutant.line, []) if mutant.group in ("core", "interface") else []
        if not reached:
            reached = sorted(set(itertools.chain(*lines.values())))
        known = [name for name in reached if name in self.seconds]
        everything = sorted(known or self.seconds, key=lambda name: self.seconds[name])
        total, chosen = 0.0, []
        for name in everything:
            total += self.seconds[name]
            if total > SECONDS:
                break
            chosen.append(name)
        return chosen


def first_run(tree: Path, workers: int) -> Reach:
    """The everyday tests under coverage, in as many processes as there are workers."""
    folders = sorted(str(path.relative_to(tree)) for path in tree.glob("tests/*") if any(path.rglob("test_*.py")))
    folders += sorted(str(path.relative_to(tree)) for path in tree.glob("tests/test_*.py"))
    folders = [folder for folder in folders if folder not in EXCLUDED]
    files = [tree / f"coverage_{number}.json" for number in range(workers)]
    context = multiprocessing.get_context("fork")
    shares = [
        context.Process(target=record_coverage, args=(tree, folders[number::workers], file))
        for number, file in enumerate(files)
    ]
    for share in shares:
        share.start()
    for share in shares:
        share.join()
    seconds: dict[str, float] = {}
    functions: dict[str, dict[int, list[str]]] = defaultdict(lambda: defaultdict(list))
    for file in files:
        durations, lines = json.loads(file.read_text(encoding="utf-8"))
        seconds |= durations
        names = {name.replace("/", ".").removesuffix(".py").replace(".py::", "."): name for name in durations}
        for path, by_line in lines.items():
            for line, contexts in by_line.items():
                functions[path][int(line)] += [names[test] for test in contexts if test in names]
    excluded = tuple(EXCLUDED)
    return Reach({name: s for name, s in seconds.items() if not name.startswith(excluded)}, functions)


def failure(tree: Path, tests: Sequence[str], file: Path, seconds: float) -> str:
    """The first failure of tests in a process forked from this one, ended after ``seconds``; or an empty text."""
    file.unlink(missing_ok=True)
    pid = os.fork()
    if pid == 0:
        os.chdir(tree)
        sys.path.insert(0, str(tree))
        status = run_pytest(["-x", *tests], FirstFailure(file))
        os._exit(status)
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        ended, status = os.waitpid(pid, os.WNOHANG)
        if ended:
            if file.exists():
                return file.read_text(encoding="utf-8")
            return "" if status == 0 else f"ends with status {os.waitstatus_to_exitcode(status)}"
        time.sleep(0.02)
    os.kill(pid, 9)
    os.waitpid(pid, 0)
    return "does not end"


def detection(tree: Path, mutant: Mutant, tests: Sequence[str], reach: Reach) -> str:
    """The first failure that the mutant causes, or an empty text."""
    file = tree / mutant.path.relative_to(ROOT)
    whole = file.read_bytes()
    file.write_bytes(whole[: mutant.ends[0]] + mutant.new.encode() + whole[mutant.ends[1] :])
    try:
        if file.suffix == ".c" and not built(tree):
            return "does not compile"
        for stage in (tests[:FIRST], tests[FIRST:]):
            usual = sum(reach.seconds[name] for name in stage)
            by = failure(tree, stage, tree / "failure.txt", START + 5 * usual) if stage else ""
            if by:
                return by
        return ""
    finally:
        file.write_bytes(whole)
        for stale in file.parent.glob(f"__pycache__/{file.stem}.*.pyc"):
            stale.unlink()
        if file.suffix == ".c":
            built(tree)


def built(tree: Path) -> bool:
    """Compile the kernel of a tree; whether it compiles."""
    command = [sys.executable, "hatch_build.py"]
    return subprocess.run(command, cwd=tree, capture_output=True, check=False).returncode == 0


def copied(folder: Path) -> Path:
    """A copy of the tree, with its kernel compiled."""
    ignored = shutil.ignore_patterns(".git", ".venv*", "__pycache__", "dist", "site", "*.sqlite", ".hypothesis")
    shutil.copytree(ROOT, folder, ignore=ignored)
    built(folder)
    return folder


def work(tree: Path, reach: Reach, tasks: Any, results: Any) -> None:
    """Take mutants until there are no more; put each with what detects it."""
    while (mutant := tasks.get()) is not None:
        file = tree / mutant.path.relative_to(ROOT)
        for stale in file.parent.glob(f"__pycache__/{file.stem}.*.pyc"):
            stale.unlink()
        results.put((mutant, detection(tree, mutant, reach.tests(mutant), reach)))


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
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    counts = {
        "core": options.core,
        "interface": options.interface,
        "module level": options.module,
        "C": options.c,
    }
    os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sample = drawn(options.seed, counts)
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        trees = [copied(Path(folder) / f"tree{number}") for number in range(options.workers)]
        reach = first_run(trees[0], options.workers)
        print(f"{len(reach.seconds)} test functions, first run {time.monotonic() - start:.0f} s", flush=True)
        unchanged = Mutant(ROOT / "cuefem/contact/strike.py", 0, (0, 0), "", "", "core")
        if by := detection(trees[0], unchanged, reach.tests(unchanged), reach):
            raise SystemExit(f"the tree fails without a mutant: {by}")
        context = multiprocessing.get_context("fork")
        tasks, results = context.SimpleQueue(), context.SimpleQueue()
        for mutant in [*sample, *[None] * options.workers]:
            tasks.put(mutant)
        workers = [context.Process(target=work, args=(tree, reach, tasks, results)) for tree in trees]
        for worker in workers:
            worker.start()
        totals: dict[str, list[bool]] = defaultdict(list)
        for number in range(len(sample)):
            mutant, by = results.get()
            totals[mutant.group].append(bool(by))
            totals[f"  {mutant.group}, {mutant.room}"].append(bool(by))
            totals["collection errors among the detected"] += [by.startswith("collection")] if by else []
            row = f"{mutant.path.relative_to(ROOT)}:{mutant.line} {mutant.old} -> {mutant.new}"
            print(number, " ".join(row.split()), "|", by or "SURVIVES", flush=True)
        for worker in workers:
            worker.join()
    for name, hits in sorted(totals.items()):
        print(f"{name}: detected {interval(sum(hits), len(hits))}" if "errors" not in name else f"{name}: {sum(hits)}")
    print(f"{len(sample)} mutants in {(time.monotonic() - start) / 60:.1f} minutes")


if __name__ == "__main__":
    main()
