"""The version: one number in package, citation and changelog (regression)."""

import re
import tomllib
from pathlib import Path

import pytest

import cuefem

ROOT = Path(__file__).parents[1]
CHANGELOG = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def has_unreleased_changes(changelog: str) -> bool:
    unreleased = changelog.partition("## Unreleased\n")[2].partition("\n## ")[0]
    return "\n- " in unreleased


def test_workflows_try_every_python_of_the_classifiers() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    listed = re.findall(r"Python :: (3\.\d+)", " ".join(project["classifiers"]))
    (matrix,) = re.findall(r"python: \[(.*)\]", (ROOT / ".github/workflows/tests.yml").read_text(encoding="utf-8"))
    assert re.findall(r"[\d.]+", matrix) == listed
    assert project["requires-python"] == f">={listed[0]}"


def test_citation_names_package_version() -> None:
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.findall(r"^version: (.+)$", citation, re.M) == [cuefem.__version__]


@pytest.mark.parametrize(
    ("changelog", "unreleased"),
    [
        (CHANGELOG, cuefem.__version__.endswith(".dev0")),
        ("## Unreleased\n\n### Added\n\n- A line.\n\n## 0.2.0, 2026-11-23\n", True),
        ("## Unreleased\n\n## 0.2.0, 2026-11-23\n\n- A line.\n", False),
    ],
)
def test_version_is_of_development_while_unreleased_holds_changes(changelog: str, unreleased: bool) -> None:
    assert has_unreleased_changes(changelog) == unreleased
