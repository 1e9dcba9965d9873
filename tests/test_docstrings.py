"""Docstrings: examples run and print the stated output, numbers in prose are listed (regression)."""

import ast
import doctest
import importlib
import re
import tomllib
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.sources import PACKAGE, statements, trees

FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
FILES = [file for file in PACKAGE.rglob("*.py") if ">>>" in file.read_text(encoding="utf-8")]
MODULES = sorted(".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts) for file in FILES)
DOCUMENTED = ast.ClassDef | ast.FunctionDef
UNITS = r"%|°|rad|[mcµ]?m|in|k?g|oz|[mµ]?s|k?Hz|k?N|[MG]?Pa|m?J|[kMG]?B|times|modes|designs|elements"
NUMBER = re.compile(rf"(?<![\w.(=^/*+-])\d[\d.]*(?:e-?\d+)?(?: to \d[\d.]*)? ?(?:{UNITS})(?:/\w+)?(?!\w)")
LISTED = Path(__file__).with_name("docstring_numbers.toml")
SLOW = {  # more than half a second: strikes of every change, node or uncertain parameter, or a search
    "cuefem.analysis.comparison",
    "cuefem.analysis.cue_report",
    "cuefem.analysis.design_changes",
    "cuefem.analysis.measured",
    "cuefem.analysis.model_error",
    "cuefem.analysis.plays_like",
    "cuefem.analysis.shop_list",
    "cuefem.analysis.strike_table",
    "cuefem.designs.optimum",
    "cuefem.solid.solid_resolution",
}


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.heavy if n in SLOW else ()) for n in MODULES])
def test_docstring_examples_of_module_run(name: str) -> None:
    failures: list[str] = []
    for example in doctest.DocTestFinder().find(importlib.import_module(name), extraglobs={"cf": cf}):
        doctest.DocTestRunner(optionflags=FLAGS).run(example, out=failures.append)
    assert "".join(failures) == ""


def prose(docstring: str) -> str:
    """A docstring without its examples, quoted texts, code and shapes of arrays."""
    parts = doctest.DocTestParser().parse(docstring)
    text = "".join(part for part in parts if isinstance(part, str))
    return re.sub(r"\"[^\"]*\"|'[^'\n]*'|`[^`]*`|\(\d* ?\w+(?:, \d* ?\w+)+\)", "", text)


@pytest.mark.heavy
def test_numbers_of_docstrings_are_examples_or_listed() -> None:
    """A number with a unit in prose: nothing computes it again, unless the list says what does."""
    found: dict[str, list[str]] = {}
    for path, tree in trees().items():
        nodes = [tree, *(each for each in statements(tree) if isinstance(each, DOCUMENTED))]
        numbers = {number for node in nodes for number in NUMBER.findall(prose(ast.get_docstring(node) or ""))}
        if numbers:
            found[str(path.relative_to(PACKAGE))] = sorted(numbers)
    listed: dict[str, list[str]] = {}
    for kind in tomllib.loads(LISTED.read_text(encoding="utf-8")).values():
        for name, numbers in kind.items():
            listed[name] = sorted([*listed.get(name, []), *numbers])
    assert found == listed
