"""The documentation site: names, formulas and pages; a gap or a broken link fails the build (bad input)."""

import inspect
import json
import re
import subprocess
import sys
from dataclasses import fields, is_dataclass
from importlib.util import module_from_spec, spec_from_file_location
from itertools import product
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from xml.etree.ElementTree import fromstring

import pytest

import cuefem
from tests.helpers.designer_browser import BROWSER, empty_page, open_browser, violations

ROOT = Path(__file__).parents[2]
CONFIGURATION = ROOT / ".ci" / "conf.py"
FORMULAS = ROOT / ".ci" / "formulas.py"
pytest.importorskip("sphinx", reason="the extra [docs] is not installed")
pytest.importorskip("latex2mathml", reason="the extra [docs] is not installed")
pytestmark = pytest.mark.heavy  # Sphinx takes seconds to import
BUILT = ROOT / "site"  # by .ci/run, before the heavy tests
PAGES = (
    "index.html",
    "studies/README.html",
    "studies/notebooks/every_question.html",
    "cuefem/handbook/beam.html",
    "cuefem/handbook/api/cuefem.Verdict.html",
)


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


def test_symbols_of_site_have_subscripts(site: ModuleType) -> None:
    pieces = site.with_subscripts("With m_e and R_1² of `two_balls`, ν_e.")
    assert [piece.astext() for piece in pieces if piece.tagname == "subscript"] == ["e", "1", "e"]
    assert "".join(piece.astext() for piece in pieces) == "With me and R1² of `two_balls`, νe."


def letters(formula: dict[str, str]) -> str:
    """What a formula's MathML shows: its attributes differ between versions of latex2mathml."""
    return "".join(fromstring(formula["mathml"]).itertext())


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


def test_reference_lists_public_names_and_what_readme_promises(site: ModuleType) -> None:
    listed = re.findall(r"^   (\w+)$", site.reference(), flags=re.MULTILINE)
    assert sorted(listed) == sorted(cuefem.__all__)
    texts = (ROOT / "README.md").read_text(encoding="utf-8") + (ROOT / ".ci/home.md").read_text(encoding="utf-8")
    promised = set(re.findall(r"\bcf\.(\w+)", texts))
    functions = [value for name in promised if inspect.isfunction(value := getattr(cuefem, name, None))]
    returned = " ".join(str(inspect.signature(each).return_annotation) for each in functions)
    assert promised | set(re.findall(r"[A-Z]\w+", returned)) - {"Any", "None"} <= set(listed)


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


def test_site_with_broken_links_fails_and_names_them(tmp_path: Path) -> None:
    links = "[here](#contributing), [no file](missing.md), [no section](#no-such-section)"
    (tmp_path / "CONTRIBUTING.md").write_text(f"# Contributing\n\n{links}.\n", encoding="utf-8")
    page = ("-D", "root_doc=CONTRIBUTING", "-D", "include_patterns=CONTRIBUTING.md")
    command = [sys.executable, "-m", "sphinx", "-b", "dummy", "-W", "-q", "-c", str(CONFIGURATION.parent), *page]
    built = subprocess.run([*command, tmp_path, tmp_path / "site"], capture_output=True, text=True, check=False)
    assert built.returncode == 1
    named = [name in built.stderr for name in ("missing.md", "no-such-section", "'contributing'")]
    assert named == [True, True, False], built.stderr


@pytest.mark.skipif(not BUILT.exists(), reason="needs the site: python -m sphinx -c .ci . site")
@pytest.mark.skipif(BROWSER is None, reason="needs Chromium: apt-get install chromium")
def test_pages_of_site_are_accessible_and_not_cropped() -> None:
    found = {}
    with open_browser() as browser, empty_page(browser, BUILT.as_uri()) as page:
        for name, (width, scheme) in product(PAGES, ((1280, "light"), (390, "dark"))):
            page.set_viewport_size({"width": width, "height": 900})
            page.emulate_media(color_scheme=scheme)
            page.goto((BUILT / name).as_uri())
            rules = [each["id"] for each in violations(page, preload=False)]
            if rules or page.evaluate("document.documentElement.scrollWidth") > width:
                found[name, width] = rules
    assert found == {}
