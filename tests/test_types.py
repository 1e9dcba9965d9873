"""Python of README and handbook under the type checker of a careful user: no error, and misspelt names found."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mypy")
pytestmark = [pytest.mark.heavy, pytest.mark.nightly]

ROOT = Path(__file__).parents[1]
CHAPTERS = sorted((ROOT / "cuefem" / "handbook").glob("*.md"))
PAGES = sorted((ROOT / "studies").rglob("*.md"))
NOTEBOOKS = sorted((ROOT / "studies" / "notebooks").glob("*.ipynb"))
USER = """
import cuefem as cf

scene: cf.Scene = cf.load_scene("plain maple", game="carom")
solved: cf.SolvedDesign = cf.solve(scene)
verdict: cf.Verdict = cf.verdict(solved)
squirt: float = cf.strike(scene).squirt
many: cf.Outcomes = cf.batch_strike([scene, scene])
one: cf.Outcome = many[0]
rows: int = len(many.to_frame())
cue: cf.Cue = cf.load_cue("plain maple")
curve: cf.SquirtCurve = cf.squirt_curve(scene)
cf.end_mass(scene, "ofset")
cf.load_scene("plain maple", game="darts")
cf.squirt_curve(cue)
curve.sqirt
"""
MISTAKES = {13: "arg-type", 14: "arg-type", 15: "arg-type", 16: "attr-defined"}


def python_of(path: Path) -> list[str]:
    """The Python of a page in blocks, or that of a notebook."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".ipynb":
        return re.findall(r"^```python\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)
    cells = ["".join(cell["source"]) for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
    return ["\n".join(re.sub(r"^%.*$", "", cell, flags=re.MULTILINE) for cell in cells)]


def test_python_of_pages_passes_strict_types_and_mistakes_are_found(tmp_path: Path) -> None:
    programs = {
        f"{path.parent.name}_{path.stem.lower()}_{i}.py": block
        for path in (ROOT / "README.md", *CHAPTERS, *PAGES, *NOTEBOOKS)
        for i, block in enumerate(python_of(path))
    }
    assert {
        f"{ROOT.name}_readme_0.py",
        "handbook_working_0.py",
        "notebooks_kims_chain_0.py",
        "contact_energy_0.py",
    } <= {*programs}
    for name, block in {**programs, "user.py": USER}.items():
        (tmp_path / name).write_text(block, encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", "--follow-imports=silent", "--no-pretty"]
    checked = subprocess.run(
        [*command, "--scripts-are-modules", "--cache-dir", str(tmp_path / "cache"), *programs, "user.py"],
        cwd=tmp_path,
        env={"MYPYPATH": str(ROOT), "PATH": ""},
        capture_output=True,
        text=True,
    )
    errors = [line for line in checked.stdout.splitlines() if ": error:" in line]
    found = {int(line.split(":")[1]): line.rpartition("[")[2].rstrip("]") for line in errors if line.startswith("user")}
    assert [line for line in errors if not line.startswith("user.py")] == []
    assert found == MISTAKES
