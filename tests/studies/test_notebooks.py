"""Notebooks run, and print their stored output (regression). `.ci/nightly` executes them in a kernel of Jupyter."""

import contextlib
import io
import json
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

FOLDER = Path(__file__).parents[2] / "studies" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


@pytest.mark.heavy
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_prints_stored_output(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plt.switch_backend("agg")
    monkeypatch.chdir(FOLDER)
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    names: dict[str, object] = {}
    for cell in (cell for cell in cells if cell["cell_type"] == "code"):
        plt.close("all")
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile("".join(cell["source"]), path.name, "exec"), names)
        stored = [out for out in cell["outputs"] if out["output_type"] == "stream"]
        assert printed.getvalue() == "".join(line for out in stored for line in out["text"])
        figures = [out for out in cell["outputs"] if out["output_type"] == "display_data"]
        assert len(plt.get_fignums()) == len(figures)
    plt.close("all")


def test_readme_links_every_notebook() -> None:
    readme = (FOLDER.parents[1] / "README.md").read_text(encoding="utf-8")
    assert [path.name for path in NOTEBOOKS if f"(studies/notebooks/{path.name})" not in readme] == []
