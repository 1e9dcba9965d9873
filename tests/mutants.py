"""Draws mutants of the package at random and counts those that a test detects: `python tests/mutants.py --seed 1`.

A mutant is the package with one operator, comparison, condition or number changed: in a function, at the level of a
module or class (tables, limits, defaults), or in the kernel's C. The everyday tests run once under `pytest-cov`, which
records which test executes which line. Then each mutant is written into a copy of the tree, where the tests that
execute its line run, the shortest first, until one fails. Their process has a limit of processor time, not of time: a
busy machine has no effect. A mutant that does not compile, or compiles to the same code, is not drawn.
`equivalent_mutants.txt` lists mutants that no test can detect, each with its reason.
A number becomes a tenth larger, an integer the next one. A power of ten that is very small or large becomes a thousand
times larger, and at the level of a module an integer from ten on half as large: such numbers are tolerances and
resolutions, whose neighbours change no digit that anyone is promised.
Printed: one line a mutant, then detected fractions by group and room with their 95 % intervals (Wilson).
This file is also the plugin of pytest that takes the chosen tests in their order.
"""

import argparse
import ast
import dis
import functools
import itertools
import json
import math
import os
import random
import re
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import types
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import Any, NamedTuple
from xml.etree import ElementTree

import hypothesis
import pytest

ROOT = Path(__file__).parents[1]
INTERFACE = ("analysis", "cli", "designs", "designer", "files", "handbook", "measurements", "show")
EQUIVALENT = Path(__file__).with_name("equivalent_mutants.txt")
SHARE = 0.5  # of the tests, by their seconds in the first run, that judge a mutant at most
START = 60.0  # s of processor time that a process may take beside its tests
STILL = 1800.0  # s after which a process that waits is ended
FIRST = 12  # tests of the first process: most mutants are detected by them, and few test files are imported
CHOSEN = "chosen_tests.json"
# Tests that start the package in a process of its own, or read the tree's files: they say little of a mutant.
EXCLUDED = ("tests/contact/test_kernel_build.py", "tests/test_readme.py", "tests/studies")
# What calls the kernel, whose C has no coverage of its own, and the tests of contacts.
KERNEL_CALLS = ("cuefem/contact/step_records.py", "cuefem/endmass/impulse_response.py")
KERNEL_TESTS = ("tests/contact", "tests/effects", "tests/endmass", "tests/test_golden")
# Of signatures and tables, whose lines imports execute: first for a mutant at module level.
TABLE_TESTS = ("tests/test_defaults.py", "tests/test_golden")
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
        case ast.BinOp(left, ast.Add() | ast.Sub(), right) if is_tolerance(left) or is_tolerance(right):
            return None  # a number beside its round-off
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
        case ast.Constant(float(value)) if is_order_of_magnitude(value):
            return ast.Constant(1e3 * value)
        case ast.Constant(int(value) | float(value)):
            return ast.Constant(value + 1 if isinstance(value, int) or value == 0 else 1.1 * value)
    return None


def is_order_of_magnitude(value: object) -> bool:
    """Whether a number is a power of ten beyond 1e-4 to 1e6: of a tolerance, or of something that is never reached."""
    return isinstance(value, float) and value > 0 and math.log10(value).is_integer() and not 1e-4 < value < 1e6


def is_tolerance(node: ast.expr) -> bool:
    """Whether an expression is a very small power of ten, such as round-off."""
    return isinstance(node, ast.Constant) and is_order_of_magnitude(node.value) and node.value < 1e-6


def expressions(node: ast.AST, in_function: bool = False) -> Iterator[tuple[ast.expr | ast.AugAssign, bool]]:
    """Expressions below a node that are evaluated, each with whether it stands in a function's body.

    Annotations, patterns and the parts of f-strings, whose positions Python 3.11 does not know, are left out, and what
    no result depends on: overloads, too, which say types alone.
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
            if isinstance(child, ast.AST) and not is_overload(child):
                yield from expressions(child, inside)


def is_overload(node: ast.AST) -> bool:
    """Whether a node is a signature for type checkers."""
    return isinstance(node, ast.FunctionDef) and "overload" in map(ast.unparse, node.decorator_list)


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


def is_other(mutant: Mutant) -> bool:
    """Whether a mutant compiles, to other code than what it changes: else no test can tell."""
    whole = mutant.path.read_bytes()
    if mutant.group == "C":
        return assembly(mutant.path.parent, mutant.applied(whole)) not in (b"", assembly(mutant.path.parent, whole))
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
def assembly(folder: Path, text: bytes) -> bytes:
    """The assembler code of a C file of a folder; b"" if it does not compile."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    command = [*compiler, "-std=gnu11", "-O1", "-S", "-I", str(folder), "-x", "c", "-", "-o", "-"]
    done = subprocess.run(command, input=text, capture_output=True, check=False)
    return b"" if done.returncode else done.stdout


def drawn(seed: int, counts: dict[str, int], only: str) -> list[Mutant]:
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
        others = (mutant for mutant in population[group] if is_other(mutant))
        sample += itertools.islice(others, count)
    return sample


class Reach(NamedTuple):
    """What the first run recorded: seconds of each test, and the tests that execute each line of a file."""

    seconds: dict[str, float]
    tests: dict[str, dict[int, set[str]]]

    def chosen(self, mutant: Mutant) -> list[str]:
        """Tests for a mutant: those that execute its line, else those of its file; then the others of their files.

        Of each kind the shortest come first, up to ``SHARE`` of all; for a mutant at module level those of defaults,
        tables and golden files.
        """
        files = KERNEL_CALLS if mutant.group == "C" else (mutant.file,)
        of_file = set().union(*(tests for file in files for tests in self.tests[file].values()))
        at_line = set() if mutant.group in ("C", "module level") else self.tests[mutant.file].get(mutant.line, set())
        reached = at_line & self.seconds.keys() or of_file & self.seconds.keys()  # else imports alone execute it
        if mutant.group == "C":
            reached = {name for name in reached if name.startswith(KERNEL_TESTS)}
        of_tables = {name for name in self.seconds if name.startswith(TABLE_TESTS)}
        first = of_tables if mutant.group == "module level" else set()
        homes = {test_file(name) for name in reached}
        beside = {name for name in self.seconds if test_file(name) in homes}
        ordered = [*self.ordered(first), *self.ordered(reached - first), *self.ordered(beside - reached - first)]
        until = itertools.accumulate(self.seconds[name] for name in ordered)
        most = SHARE * sum(self.seconds.values())
        return [name for name, end in zip(ordered, until, strict=True) if end < most]

    def ordered(self, names: set[str]) -> list[str]:
        """The shortest test first."""
        return sorted(names, key=lambda name: (self.seconds[name], name))


def test_file(name: str) -> str:
    """The file of a test."""
    return name.partition("::")[0]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Keep the chosen tests of those collected; one that the mutant names otherwise is left out."""
    chosen = {*json.loads(Path(CHOSEN).read_text(encoding="utf-8"))}
    items[:] = [item for item in items if item.nodeid in chosen]


def run_pytest(tree: Path, *arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run tests of a tree."""
    others = os.environ | {"PYTHONPATH": f"{tree}{os.pathsep}{tree / 'tests'}"}
    command = [sys.executable, "-m", "pytest", "--tb=no", *arguments]
    return subprocess.run(command, cwd=tree, env=others, capture_output=True, text=True, check=False, **options)


def first_run(tree: Path, workers: int) -> Reach:
    """Run the everyday tests once under coverage; those that fail without a mutant are printed and left out."""
    from coverage import CoverageData  # no dependency of the tests

    ignored = (f"--ignore={path}" for path in EXCLUDED)
    measured = ("--cov=cuefem", "--cov-context=test", "--cov-report=", "--junitxml=tests.xml")
    done = run_pytest(tree, f"-n{workers}", *measured, *ignored)
    if not (tree / "tests.xml").exists():
        raise SystemExit(f"the everyday tests do not run: {done.stdout}{done.stderr}")
    seconds = dict[str, float]()
    for case in ElementTree.parse(tree / "tests.xml").iter("testcase"):
        name = f"{case.attrib['classname'].replace('.', '/')}.py::{case.attrib['name']}"
        if {child.tag for child in case} & {"failure", "error"}:
            print(f"fails without a mutant: {name}")
        else:
            seconds[name] = float(case.attrib["time"])
    data = CoverageData(str(tree / ".coverage"))
    data.read()
    tests = defaultdict[str, dict[int, set[str]]](dict)
    for path in data.measured_files():
        for line, contexts in data.contexts_by_lineno(path).items():
            tests[str(Path(path).relative_to(tree))][line] = {context.rpartition("|")[0] for context in contexts}
    return Reach(seconds, tests)


def first_failure(tree: Path, tests: list[str], seconds: float) -> str:
    """The first of these tests that fails in a tree, or what else ends its process; "" if none does.

    A failing example is not shrunk: that it fails is enough. A process that waits for ``STILL`` seconds tells nothing.
    """
    (tree / CHOSEN).write_text(json.dumps(tests), encoding="utf-8")
    limit = math.ceil(START + 5 * seconds)
    options = ("-n0", "-x", "-rfE", "-p", "mutants", "--hypothesis-profile=mutants")
    try:
        done = run_pytest(
            tree,
            *options,
            *dict.fromkeys(map(test_file, tests)),
            timeout=STILL,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit)),
        )
    except subprocess.TimeoutExpired:
        return ""
    if done.returncode in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
        return ""
    failed = re.search(r"^(?:FAILED|ERROR) (.*?)(?: - .*)?$", done.stdout, re.M)
    return failed[1] if failed else f"ends with status {done.returncode}"


def put(tree: Path, file: Path, text: bytes) -> bool:
    """Write a file of a tree, without its stale bytecode, and compile it where it is C; whether it compiles."""
    file.write_bytes(text)
    for stale in file.parent.glob(f"__pycache__/{file.stem}.*.pyc"):
        stale.unlink()
    return built(tree) if file.suffix == ".c" else True


def detected_by(mutant: Mutant, reach: Reach, trees: SimpleQueue[Path]) -> str:
    """The failure that a mutant causes, "" if none."""
    tree, tests = trees.get(), reach.chosen(mutant)
    file = tree / mutant.file
    whole = file.read_bytes()
    try:
        if not put(tree, file, mutant.applied(whole)):
            return "does not compile"
        stages = [stage for stage in (tests[:FIRST], tests[FIRST:]) if stage]
        found = (first_failure(tree, stage, sum(reach.seconds[name] for name in stage)) for stage in stages)
        return next(filter(None, found), "")
    finally:
        put(tree, file, whole)
        trees.put(tree)


def built(tree: Path) -> bool:
    """Compile the kernel of a tree; whether it compiles."""
    command = [sys.executable, "hatch_build.py"]
    return subprocess.run(command, cwd=tree, capture_output=True, check=False).returncode == 0


def copied(folder: Path) -> Path:
    """A copy of the tree, with its kernel compiled."""
    ignored = shutil.ignore_patterns(".git", ".venv*", "__pycache__", ".*_cache", "dist", "site", ".hypothesis")
    shutil.copytree(ROOT, folder, ignore=ignored)
    built(folder)
    return folder


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
    options = parser.parse_args()
    own = {"core": options.core, "interface": options.interface, "module level": options.module, "C": options.c}
    counts = dict.fromkeys(own, sys.maxsize) if options.only else own
    start = time.monotonic()
    sys.stdout.reconfigure(line_buffering=True)  # of a file or a pipe, too
    total, detected = Counter[str](), Counter[str]()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(options.workers) as pool:
        trees = SimpleQueue[Path]()
        first, *others = [copied(Path(folder).resolve() / f"tree{number}") for number in range(options.workers)]
        sample = drawn(options.seed, counts, options.only)
        print("first run: the everyday tests under coverage")
        reach = first_run(first, options.workers)
        print(f"{len(reach.seconds)} tests, first run {time.monotonic() - start:.0f} s")
        if by := first_failure(first, reach.ordered({*reach.seconds})[:FIRST], 0.0):
            raise SystemExit(f"fails without a mutant: {by}")
        for tree in (first, *others):
            trees.put(tree)
        failures = pool.map(lambda mutant: detected_by(mutant, reach, trees), sample)
        for number, (mutant, by) in enumerate(zip(sample, failures, strict=True), 1):
            for name in (mutant.group, f"  {mutant.group}, {mutant.room}"):
                total[name] += 1
                detected[name] += bool(by)
            row = f"{mutant.file}:{mutant.line} {mutant.old} -> {mutant.new}"
            print(f"{number}/{len(sample)}", " ".join(row.split()), "|", by or "SURVIVES")
    for name, count in sorted(total.items()):
        print(f"{name}: detected {interval(detected[name], count)}")
    print(f"{len(sample)} mutants in {(time.monotonic() - start) / 60:.1f} minutes")


if __name__ == "__main__":
    main()
else:  # as a plugin of pytest
    phases = (hypothesis.Phase.explicit, hypothesis.Phase.generate)
    hypothesis.settings.register_profile("mutants", derandomize=True, deadline=None, database=None, phases=phases)
