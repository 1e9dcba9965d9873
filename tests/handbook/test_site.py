"""The documentation site: every public name is on it, and a gap or a broken link fails the build (bad input)."""

import inspect
import json
import re
import subprocess
import sys
from dataclasses import fields, is_dataclass
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from xml.etree.ElementTree import fromstring

import pytest

import cuefem

ROOT = Path(__file__).parents[2]
CONFIGURATION = ROOT / ".ci" / "conf.py"
FORMULAS = ROOT / ".ci" / "formulas.py"
pytest.importorskip("sphinx", reason="the extra [docs] is not installed")
pytest.importorskip("latex2mathml", reason="the extra [docs] is not installed")


def module_of(path: Path) -> ModuleType:
    spec = spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def site() -> ModuleType:
    return module_of(CONFIGURATION)


def test_stored_formulas_are_those_of_chapters() -> None:
    formulas = module_of(FORMULAS)
    stored = json.loads(formulas.STORED.read_text(encoding="utf-8"))
    made = formulas.stored_formulas()
    assert {key: formula["text"] for key, formula in stored.items()} == {
        key: formula["text"] for key, formula in made.items()
    }, "run .venv/bin/python .ci/formulas.py"
    assert [key for key in made if letters(stored[key]) != letters(made[key])] == []


def letters(formula: dict[str, str]) -> str:
    """What a formula's MathML shows: its attributes differ between versions of latex2mathml."""
    return "".join(fromstring(formula["mathml"]).itertext())


@pytest.mark.heavy
def test_reference_lists_public_names(site: ModuleType) -> None:
    listed = re.findall(r"^   (\w+)$", site.reference(), flags=re.MULTILINE)
    assert sorted(listed) == sorted(cuefem.__all__)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (SimpleNamespace(__doc__=None, __module__="cuefem.beam"), "public names without a docstring: ['extra']"),
        (SimpleNamespace(__doc__="A name.", __module__="cuefem.attic"), "rooms without a title in TITLES"),
    ],
)
def test_reference_without_docstring_or_title_raises(
    site: ModuleType, monkeypatch: pytest.MonkeyPatch, value: SimpleNamespace, message: str
) -> None:
    monkeypatch.setattr(cuefem, "extra", value, raising=False)
    monkeypatch.setattr(cuefem, "__all__", [*cuefem.__all__, "extra"])
    with pytest.raises(ValueError, match=re.escape(message)):
        site.reference()


def test_names_of_readme_and_their_answers_are_in_reference() -> None:
    texts = (ROOT / "README.md").read_text(encoding="utf-8") + (ROOT / ".ci/home.md").read_text(encoding="utf-8")
    promised = set(re.findall(r"\bcf\.(\w+)", texts))
    functions = [getattr(cuefem, name) for name in promised if inspect.isfunction(getattr(cuefem, name, None))]
    answers = {
        word for each in functions for word in re.findall(r"[A-Z]\w+", str(inspect.signature(each).return_annotation))
    }
    assert promised | answers - {"Any", "None"} <= set(cuefem.__all__)


def test_pages_of_classes_document_every_field() -> None:
    classes = {name: value for name in cuefem.__all__ if is_dataclass(value := getattr(cuefem, name))}
    missing = {name: set(shown_fields(value)) - documented(value) for name, value in classes.items()}
    assert {name: names for name, names in missing.items() if names} == {}


def shown_fields(kind: Any) -> list[str]:
    return [field.name for field in fields(kind) if field.repr]


def documented(kind: type) -> set[str]:
    """Names that a class and its bases list in sections of their docstrings."""
    texts = "\n".join(inspect.getdoc(base) or "" for base in kind.__mro__)
    listed = re.findall(r"^(\w+(?:, \w+)*)(?: : .*)?\n +\S", texts, re.MULTILINE)
    return {name for line in listed for name in line.split(", ")}


@pytest.mark.heavy
@pytest.mark.parametrize(("link", "status"), [("#contributing", 0), ("missing.md", 1), ("#no-such-section", 1)])
def test_site_with_broken_link_fails(tmp_path: Path, link: str, status: int) -> None:
    (tmp_path / "CONTRIBUTING.md").write_text(f"# Contributing\n\n[A link]({link}).\n", encoding="utf-8")
    page = ("-D", "root_doc=CONTRIBUTING", "-D", "include_patterns=CONTRIBUTING.md")
    command = [sys.executable, "-m", "sphinx", "-b", "dummy", "-W", "-q", "-c", str(CONFIGURATION.parent), *page]
    built = subprocess.run(
        [*command, str(tmp_path), str(tmp_path / "site")], capture_output=True, text=True, check=False
    )
    assert built.returncode == status
    assert (link.lstrip("#") in built.stderr) == bool(status)
