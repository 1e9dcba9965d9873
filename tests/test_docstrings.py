"""Examples in the docstrings of the package run and print the stated output (regression)."""

import doctest
import importlib
from pathlib import Path

import pytest

import cuefem as cf

FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
ROOT = Path(cf.__file__).parent
FILES = [file for file in ROOT.rglob("*.py") if ">>>" in file.read_text(encoding="utf-8")]
MODULES = sorted(".".join(file.relative_to(ROOT.parent).with_suffix("").parts) for file in FILES)
SLOW = ("cuefem.analysis.design_changes", "cuefem.analysis.strike_table")  # strikes for every change, every node


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.heavy if n in SLOW else ()) for n in MODULES])
def test_docstring_examples_of_module_run(name: str) -> None:
    failures: list[str] = []
    for example in doctest.DocTestFinder().find(importlib.import_module(name), extraglobs={"cf": cf}):
        doctest.DocTestRunner(optionflags=FLAGS).run(example, out=failures.append)
    assert "".join(failures) == ""
