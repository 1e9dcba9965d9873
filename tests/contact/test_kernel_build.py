"""Properties of the compiled kernel: one that is not the one of these sources ends in a line, and a build mends it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cuefem.contact.kernel import BINARY, BUILD

ROOT = Path(__file__).parents[2]
STRIKE = """
import cuefem as cf
from cuefem.contact.kernel import KernelError
try:
    cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01), stroke=cf.Stroke(offset=0.3)))
except KernelError as error:
    print(error)
"""
SCENE = """
game = "kim"
cue = { mass = "540 g", end_mass = "10 g" }
stroke = { speed = "2 m/s", offset = 0.3 }
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The package and its build somewhere else."""
    shutil.copytree(ROOT / "cuefem", tmp_path / "cuefem", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "hatch_build.py", tmp_path)
    return tmp_path


def run(folder: Path, *arguments: str, **environment: str) -> tuple[int, str, str]:
    """(exit status, what is printed, what is said on stderr) of Python in a folder."""
    kept = {name: value for name, value in os.environ.items() if name not in ("CC", "CFLAGS")}
    kept |= {"PYTHONPATH": str(folder)} | environment
    done = subprocess.run(
        [sys.executable, *arguments], cwd=folder, env=kept, capture_output=True, text=True, check=False
    )
    return done.returncode, done.stdout.strip(), done.stderr.strip()


def cut_short(kernel: Path) -> None:
    whole = (kernel / BINARY.name).read_bytes()
    (kernel / BINARY.name).write_bytes(whole[: len(whole) // 2])


def change_a_source(kernel: Path) -> None:
    (kernel / "march.c").write_text((kernel / "march.c").read_text() + "/* of another version */\n")


BROKEN = pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda kernel: (kernel / BINARY.name).unlink(), "is missing"),
        (lambda kernel: (kernel / "_kernel.sha256").unlink(), "is missing"),
        (cut_short, "is damaged: it is not the one that was built"),
        (lambda kernel: (kernel / "_kernel.sha256").write_text("half"), "is damaged: it is not the one that was built"),
        (change_a_source, "was built from other sources"),
    ],
    ids=["missing", "without digest", "cut short", "half a digest", "other sources"],
)


@BROKEN
def test_a_kernel_that_is_not_of_these_sources_ends_in_a_line(folder: Path, spoil, words: str) -> None:
    spoil(folder / "cuefem" / "contact" / "kernel")
    line = f"the contact's compiled kernel {words}; {BUILD}"
    assert run(folder, "-c", STRIKE) == (0, line, "")
    (folder / "scene.toml").write_text(SCENE)
    status, printed, said = run(folder, "-m", "cuefem", "strike", "scene.toml")
    assert (status, printed) == (2, "")
    assert said.endswith(line)
    assert len(said.splitlines()) == 1


def test_a_build_mends_it(folder: Path) -> None:
    change_a_source(folder / "cuefem" / "contact" / "kernel")
    binary = folder / BINARY.relative_to(ROOT)
    assert run(folder, "hatch_build.py", CFLAGS="-O0") == (0, str(binary), "")
    assert run(folder, "-c", STRIKE) == (0, "", "")
    assert sorted(path.name for path in binary.parent.glob("_kernel*")) == ["_kernel.sha256", BINARY.name]


WITHOUT_ZIG = "import sys; sys.modules['ziglang'] = None\n"
BUILDING = "import runpy; runpy.run_path('hatch_build.py', run_name='__main__')"


@pytest.mark.parametrize("environment", [{"CC": "no-such-compiler"}, {"PATH": ""}, {"CC": "false"}])
def test_without_a_compiler_it_takes_zig_or_names_both(folder: Path, environment: dict[str, str]) -> None:
    names_both = "cuefem: no C compiler; install one (cc), or `python -m pip install 'ziglang>=0.13.0'`"
    assert run(folder, "-c", WITHOUT_ZIG + BUILDING, **environment) == (1, "", names_both)
    (folder / "ziglang.py").write_text("raise SystemExit('a zig that does not compile')")
    status, printed, said = run(folder, "-c", BUILDING, **environment)
    assert (status, printed) == (1, "")
    assert said.startswith("cuefem: the contact's kernel does not compile with ")
    assert said.endswith("a zig that does not compile")
