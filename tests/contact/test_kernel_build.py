"""The compiled kernel: a library of other sources raises, and a build replaces it (bad input)."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

import cuefem as cf
from cuefem.contact.kernel import BINARY, BUILD, sources_digest
from cuefem.contact.kernel.declarations import KernelInput, KernelState, KernelStep, StepTables
from cuefem.contact.kernel.library import library

ROOT = Path(__file__).parents[2]
STRIKE = "import cuefem as cf; cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01), stroke=cf.Stroke(offset=0.3)))"
SCENE = 'game = "kim"\ncue = { mass = "540 g", end_mass = "10 g" }\nstroke = { speed = "2 m/s", offset = 0.3 }\n'
NAMES_BOTH = "cuefem: no C compiler; install one (cc), or `python -m pip install 'ziglang>=0.13.0'`"
BUILDING = "import runpy; runpy.run_path('hatch_build.py', run_name='__main__')"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the package and its build script."""
    shutil.copytree(ROOT / "cuefem", tmp_path / "cuefem", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "hatch_build.py", tmp_path)
    return tmp_path


def run(folder: Path, *arguments: str, **environment: str) -> tuple[int, str, list[str]]:
    """(exit status, stdout, lines of stderr) of Python in a folder."""
    others = {name: value for name, value in os.environ.items() if name not in ("CC", "CFLAGS")}
    process = subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=others | {"PYTHONPATH": str(folder)} | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    return process.returncode, process.stdout.strip(), process.stderr.strip().splitlines()


OTHER = "was built from other sources, or is damaged"
DAMAGES = {  # the changed file of the kernel, its new bytes, and the message
    "missing": (BINARY.name, lambda whole: None, "is missing"),
    "cut short": (BINARY.name, lambda whole: whole[: len(whole) // 2], OTHER),
    "cut behind the code": (BINARY.name, lambda whole: whole[: whole.index(sources_digest().encode()) + 63], OTHER),
    "empty": (BINARY.name, lambda whole: b"", OTHER),
    "other sources": ("step.c", lambda whole: whole + b"/* another version */\n", OTHER),
}


@pytest.mark.heavy
@pytest.mark.parametrize("damage", DAMAGES)
def test_kernel_of_other_sources_raises_until_built(folder: Path, damage: str) -> None:
    name, change, message = DAMAGES[damage]
    binary = folder / BINARY.relative_to(ROOT)
    file = binary.parent / name
    content = change(file.read_bytes())
    file.unlink()
    if content is not None:
        file.write_bytes(content)
    (folder / "scene.toml").write_text(SCENE)
    status, printed, errors = run(folder, "-m", "cuefem", "strike", "scene.toml")
    assert (status, printed, len(errors)) == (2, "", 1)
    assert errors[0].endswith(f"the contact's compiled kernel {message}; {BUILD}")
    if damage == "other sources":
        assert run(folder, "-c", STRIKE)[2][-1].startswith("cuefem.contact.kernel.KernelError: ")
        assert run(folder, "hatch_build.py", CFLAGS="-O0") == (0, str(binary), [])
        assert run(folder, "-c", STRIKE) == (0, "", [])
        assert sorted(path.name for path in binary.parent.glob("_kernel*")) == [BINARY.name]


def test_structures_have_the_sizes_that_the_library_was_compiled_with() -> None:
    structures = (KernelInput, KernelState, KernelStep, StepTables)
    sizes = (ctypes.c_size_t * len(structures)).in_dll(library(), "structure_sizes")
    assert list(sizes) == [ctypes.sizeof(structure) for structure in structures]


def test_contact_without_memory_raises(monkeypatch: pytest.MonkeyPatch) -> None:
    full = SimpleNamespace(contact_new=lambda *_: None)
    monkeypatch.setattr("cuefem.contact.kernel.library.library", lambda: full)
    with pytest.raises(MemoryError, match="no memory for the steps of a contact"):
        cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01)))


@pytest.mark.heavy
@pytest.mark.parametrize("environment", [{"PATH": ""}, {"CC": "false"}])
def test_kernel_build_without_compiler_uses_zig_or_names_both(folder: Path, environment: dict[str, str]) -> None:
    without_zig = f"import sys; sys.modules['ziglang'] = None; {BUILDING}"
    assert run(folder, "-c", without_zig, **environment) == (1, "", [NAMES_BOTH])
    (folder / "ziglang.py").write_text("raise SystemExit('a zig that does not compile')")
    status, printed, errors = run(folder, "-c", BUILDING, **environment)
    assert (status, printed) == (1, "")
    assert errors[0].startswith("cuefem: the contact's kernel does not compile with ")
    assert errors[-1].endswith("a zig that does not compile")


def test_kernel_build_on_older_python_is_rejected_in_one_line() -> None:
    """pip asks the build first, and would list the versions of scipy that are missing."""
    script = "import runpy, sys; sys.version_info = (3, 10); runpy.run_path('hatch_build.py')"
    status, _, errors = run(ROOT, "-c", script)
    assert (status, len(errors)) == (1, 1)
    assert errors[0].startswith("cuefem needs Python 3.11 or newer")
