"""Properties of the kernel's build: it needs no compiler, says so in a line, and leaves no older binary behind."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from tests.helpers.kernels import BUILT

from cuefem.contact.kernel import BINARY, VARIABLE

ROOT = Path(__file__).parents[2]


@pytest.fixture
def sources(tmp_path: Path) -> Path:
    """What the build reads, somewhere else, with a binary of an earlier time."""
    kernel = ROOT / "cuefem" / "contact" / "kernel"
    shutil.copytree(
        kernel, tmp_path / kernel.relative_to(ROOT), ignore=shutil.ignore_patterns("_kernel.*", "__pycache__")
    )
    shutil.copy(ROOT / "hatch_build.py", tmp_path)
    (tmp_path / BINARY.relative_to(ROOT)).write_text("older")
    return tmp_path


def build(sources: Path, **environment: str) -> tuple[str, str, bool]:
    """(what is printed, what is said on stderr, whether a binary is there)."""
    kept = {name: value for name, value in os.environ.items() if name not in (VARIABLE, "CC", "CFLAGS")}
    done = subprocess.run(
        [sys.executable, "hatch_build.py"],
        cwd=sources,
        env=kept | environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip(), done.stderr.strip(), (sources / BINARY.relative_to(ROOT)).exists()


@pytest.mark.parametrize(
    ("environment", "words"),
    [
        ({"CC": "no-such-compiler"}, "no C compiler (cc), so the contact will run in Python"),
        ({"PATH": ""}, "no C compiler (cc), so the contact will run in Python"),
        ({"CC": "false"}, "the kernel does not compile, so the contact will run in Python:"),
        ({VARIABLE: "python"}, "CUEFEM_KERNEL=python, so the compiled kernel is left out"),
    ],
)
def test_without_a_compiler_it_goes_on_with_a_word(sources: Path, environment: dict[str, str], words: str) -> None:
    assert build(sources, **environment) == ("nothing built", f"cuefem: {words}", False)


@BUILT
def test_with_one_it_replaces_the_binary(sources: Path) -> None:
    printed, said, there = build(sources, CFLAGS="-O0")
    assert (Path(printed).name, said, there) == (BINARY.name, "", True)
    assert (sources / BINARY.relative_to(ROOT)).read_bytes()[:4] != b"olde"
