"""The package's files as syntax trees; no tests."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import cuefem

PACKAGE = Path(cuefem.__file__).parent


@cache
def trees() -> dict[Path, ast.Module]:
    """The files of the package."""
    return {path: ast.parse(path.read_bytes()) for path in sorted(PACKAGE.rglob("*.py"))}


def statements(block: ast.AST) -> Iterator[ast.stmt]:
    """The statements of a file, also those inside others; expressions are not looked into."""
    for one in ast.iter_child_nodes(block):
        if isinstance(one, ast.stmt):
            yield one
        if isinstance(one, ast.stmt | ast.excepthandler | ast.match_case):
            yield from statements(one)
