"""Notebooks run, print and show their stored output (regression); `.ci/nightly` runs them in a kernel of Jupyter."""

import ast
import contextlib
import io
import json
import re
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest

from cuefem.analysis import effect_sensitivity
from cuefem.effects.effect import effect_kinds

FOLDER = Path(__file__).parents[2] / "studies" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
NIGHTLY = ("every_question",)  # more than 10 s of processor time


def run_cell(source: str, names: dict[str, Any]) -> Any:
    """Execute a cell; the value of its last expression, or None."""
    *statements, last = ast.parse(source).body
    if not isinstance(last, ast.Expr):
        return exec(compile(source, "cell", "exec"), names)
    exec(compile(ast.Module(statements, []), "cell", "exec"), names)
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names)


def words(markup: str) -> list[str]:
    """The words of an output, without numbers, of which some are times."""
    return re.sub(r"<style>.*?</style>|<[^>]*>|[^a-zA-Z\s]", " ", markup, flags=re.DOTALL).split()


@pytest.mark.heavy
@pytest.mark.parametrize(
    "path",
    [pytest.param(path, marks=[pytest.mark.nightly] if path.stem in NIGHTLY else []) for path in NOTEBOOKS],
    ids=lambda path: path.stem,
)
def test_notebook_prints_and_shows_stored_output(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plt.switch_backend("agg")
    monkeypatch.chdir(FOLDER)
    own = {name: kind for name, kind in effect_kinds().items() if kind.__module__.startswith("cuefem.")}
    monkeypatch.setattr(f"{effect_sensitivity.__name__}.effect_kinds", lambda: own)  # without those of other tests
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    names: dict[str, Any] = {}
    for cell in (cell for cell in cells if cell["cell_type"] == "code"):
        plt.close("all")
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            value = run_cell("".join(cell["source"]), names)
        stored = [out for out in cell["outputs"] if out["output_type"] == "stream"]
        assert printed.getvalue() == "".join(line for out in stored for line in out["text"])
        shown = ["".join(out["data"].get("text/html", "")) for out in cell["outputs"] if "data" in out]
        answers = [value._repr_html_()] if hasattr(value, "_repr_html_") else []
        assert [words(text) for text in shown if text] == [*map(words, answers)], "now .ci/notebooks.py stores others"
        figures = [out for out in cell["outputs"] if out["output_type"] == "display_data"]
        assert len(plt.get_fignums()) == len(figures)
    plt.close("all")


def test_readme_links_every_notebook() -> None:
    readme = (FOLDER.parents[1] / "README.md").read_text(encoding="utf-8")
    assert [path.name for path in NOTEBOOKS if f"(studies/notebooks/{path.name})" not in readme] == []
