"""Draws mutants of the package at random and counts those that a test detects: `python tests/mutants.py --seed 1`.

A mutant is the package with one operator, comparison, condition or number changed in one function. The tests of its
room and the root's (`TEST_FOLDERS`) run on a copy of the tree until the first fails. Printed: one line a mutant, then
the detected fraction with its 95 % interval (Wilson).
"""

import argparse
import ast
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
INTERFACE = ("cli", "design", "designer", "handbook", "io", "measurements", "show")
# room -> folders of its tests, fastest detection first; default: the folder of the room's name
TEST_FOLDERS = {
    "": ("contact", "endmass", "effects", "results", "show", "io", "cli"),
    "beam": ("beam", "endmass", "contact", "effects"),
    "contact": ("contact", "effects", "endmass"),
    "effects": ("effects", "contact", "solid"),
    "endmass": ("endmass", "contact", "results"),
    "cue": ("cue", "beam", "io", "contact"),
    "parameters": ("parameters", "design", "cli", "io"),
    "quantity": ("quantity", "io", "cli", "show", "design"),
    "scene": ("scene", "contact", "io", "cli"),
    "results": ("results", "show", "design"),
    "solid": ("solid", "effects"),
    "handbook": ("handbook", "cli"),
    "io": ("io", "cli", "effects", "show", "design"),
    "show": ("show", "results", "cli", "handbook", "design"),
    "measurements": ("measurements", "cli"),
    "design": ("design", "cli", "show"),
    "designer": ("designer", "results", "show"),
}
SWAPS: dict[type, type] = {
    **{ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult},
    **{ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq},
    **{ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.And: ast.Or, ast.Or: ast.And},
}


class Mutant(NamedTuple):
    """A file, the first changed line, the changed range in bytes of UTF-8, and the new text."""

    path: Path
    line: int
    ends: tuple[int, int]
    text: str


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
            return ast.Constant(value + 1 if isinstance(value, int) else 1.1 * value)
    return None


def mutants(path: Path) -> Iterator[Mutant]:
    """Every mutant of a file's functions."""
    text = path.read_bytes()
    starts = [0]
    for row in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(row))
    for outer in ast.walk(ast.parse(text)):
        if isinstance(outer, ast.FunctionDef):
            for node in (inner for part in outer.body for inner in ast.walk(part)):
                new = None if isinstance(node, ast.FunctionDef) else changed(node)
                if new is not None and isinstance(node, ast.expr) and node.end_lineno and node.end_col_offset:
                    ends = starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset
                    yield Mutant(path, node.lineno, ends, f"({ast.unparse(new)})")


def detection(tree: Path, mutant: Mutant) -> str:
    """The first failure that the mutant causes, or an empty text."""
    file = tree / mutant.path.relative_to(ROOT)
    whole = file.read_bytes()
    file.write_bytes(whole[: mutant.ends[0]] + mutant.text.encode() + whole[mutant.ends[1] :])
    room = "" if file.parent.name == "cuefem" else file.relative_to(tree / "cuefem").parts[0]
    folders = [f"tests/{name}" for name in TEST_FOLDERS.get(room, (room,)) if (tree / "tests" / name).is_dir()]
    tests = [
        "tests/test_docstrings.py",
        *folders,
        *sorted(str(path.relative_to(tree)) for path in tree.glob("tests/test_*.py")),
    ]
    environment = os.environ | {"PYTHONPATH": str(tree), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "pytest", "-n", "0", "-x", "--tb=no", "-p", "no:warnings", *dict.fromkeys(tests)]
    try:
        done = subprocess.run(command, cwd=tree, env=environment, capture_output=True, text=True, timeout=900)
        failures = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
        return "" if done.returncode == 0 else (failures or ["does not start"])[0][:110]
    except subprocess.TimeoutExpired:
        return "does not end"
    finally:
        file.write_bytes(whole)


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description="random mutants, and how many of them a test detects")
    for name, value in (("--seed", 1), ("--core", 40), ("--interface", 20)):
        parser.add_argument(name, type=int, default=value)
    options = parser.parse_args()
    files = sorted((ROOT / "cuefem").rglob("*.py"))
    interface = [file for file in files if file.relative_to(ROOT / "cuefem").parts[0] in INTERFACE]
    sample: list[Mutant] = []
    groups = (sorted({*files} - {*interface}), options.core), (interface, options.interface)
    for seed, (part, count) in enumerate(groups):
        population = [mutant for file in part for mutant in mutants(file)]
        sample += random.Random(f"{options.seed} {seed}").sample(population, count)
    detected = 0
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns(".git", ".venv*", "__pycache__", "dist", "*.sqlite"))
        for number, mutant in enumerate(sample):
            by = detection(tree, mutant)
            detected += bool(by)
            position = f"{mutant.path.relative_to(ROOT)}:{mutant.line}"
            print(number, position, mutant.text, "|", by or "SURVIVES", flush=True)
    n, z, rate = len(sample), 1.96, detected / len(sample)
    middle = (rate + z**2 / 2 / n) / (1 + z**2 / n)
    half = z * math.sqrt(rate * (1 - rate) / n + z**2 / 4 / n**2) / (1 + z**2 / n)
    print(f"detected {detected} of {n}: {rate:.0%}, 95 % interval {middle - half:.0%} to {middle + half:.0%}")


if __name__ == "__main__":
    main()
