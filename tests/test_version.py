"""The version: one number in package, citation and changelog (regression)."""

import re
import tomllib
from pathlib import Path

import cuefem

ROOT = Path(__file__).parents[1]
CHANGELOG = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_workflows_try_every_python_of_the_classifiers() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    listed = re.findall(r"Python :: (3\.\d+)", " ".join(project["classifiers"]))
    (matrix,) = re.findall(r"python: \[(.*)\]", (ROOT / ".github/workflows/tests.yml").read_text(encoding="utf-8"))
    assert re.findall(r"[\d.]+", matrix) == listed
    assert project["requires-python"] == f">={listed[0]}"


def test_citation_names_package_version() -> None:
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.findall(r"^version: (.+)$", citation, re.M) == [cuefem.__version__]


def test_version_is_of_development_while_unreleased_holds_changes() -> None:
    unreleased = CHANGELOG.partition("## Unreleased\n")[2].partition("\n## ")[0]
    assert ("\n- " in unreleased) == cuefem.__version__.endswith(".dev0")
