"""The documentation site: every public name is on it, and a gap or a broken link fails the build (bad input)."""

import json
import re
import subprocess
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType, SimpleNamespace
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
