"""A name stands for one thing: few class names stand in two files (properties)."""

from __future__ import annotations

import ast
from collections import Counter
from pathlib import Path

import cuefem

TREES = [ast.parse(path.read_text(encoding="utf-8")) for path in Path(cuefem.__file__).parent.rglob("*.py")]


def test_a_class_name_stands_in_one_file() -> None:
    names = Counter(name for tree in TREES for name in {n.name for n in ast.walk(tree) if isinstance(n, ast.ClassDef)})
    assert names["Scene"] == 1
    assert len([name for name, count in names.items() if count > 1]) <= 1


def test_offsets_are_those_of_one_table() -> None:
    """Other grids of offsets say in their name what they are for."""
    targets = [
        target for tree in TREES for node in tree.body if isinstance(node, ast.Assign) for target in node.targets
    ]
    assert [ast.unparse(target) for target in targets].count("OFFSETS") == 1
