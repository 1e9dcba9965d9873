"""Compiles the contact's kernel into the package, whenever a wheel or an editable install of it is made.

The compiler is `cc`, or what the environment variable CC names, with CFLAGS behind its flags. Where there is none that
works, the build asks for the wheel `ziglang`, which holds one for every system. `python hatch_build.py` compiles the
kernel in place.
"""

from __future__ import annotations

import importlib.util
import os
import runpy
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

# pip looks for the dependencies first, and would list the versions of scipy that this Python cannot have.
if sys.version_info < (3, 11):  # noqa: UP036, as requires-python
    raise SystemExit(f"cuefem needs Python 3.11 or newer; this is {sys.version.split()[0]}")

ROOT = Path(__file__).parent
# cuefem.contact.kernel, without what the package needs: where the library lies, and the digest of its sources.
KERNEL = runpy.run_path(str(ROOT / "cuefem" / "contact" / "kernel" / "__init__.py"))
# The platform of the wheel: this one, or another that _PYTHON_HOST_PLATFORM names (.ci/wheels).
PLATFORM = sysconfig.get_platform().replace("-", "_").replace(".", "_")
BINARY: Path = KERNEL["binary"](PLATFORM)
ZIG = "ziglang>=0.13.0"
# Sums may be taken in any order, as vector instructions do; nothing else of -ffast-math, which at the link would switch
# the whole process to flush denormal numbers to zero.
SHARED = ["-std=gnu11", "-fPIC", "-fvisibility=hidden", "-shared"]
FLAGS = ["-O3", "-fno-math-errno", "-fno-trapping-math", "-fno-signed-zeros", "-fassociative-math"]


@cache
def compiler() -> tuple[str, ...] | None:
    """The C compiler's command, if it can compile and link against the mathematics library; None if there is none."""
    command = tuple(shlex.split(os.environ.get("CC", "cc")))
    if not command or not shutil.which(command[0]):
        return None
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "works.c"
        source.write_text("#include <math.h>\ndouble root(double x) { return sqrt(x); }\n")
        made = [*command, "-shared", "-fPIC", "-o", str(source.with_suffix(".so")), str(source), "-lm"]
        return command if subprocess.run(made, capture_output=True, check=False).returncode == 0 else None


def zig() -> tuple[str, ...] | None:
    """The compiler of the wheel `ziglang`, for any processor of this kind; None where the wheel is not installed."""
    if importlib.util.find_spec("ziglang") is None:
        return None
    return sys.executable, "-m", "ziglang", "cc", "-mcpu=baseline", "-s"


def build() -> Path:
    """Compile the kernel beside its sources; SystemExit with the reason where that cannot be."""
    command = compiler() or zig()
    if command is None:
        raise SystemExit(f"cuefem: no C compiler; install one (cc), or `python -m pip install '{ZIG}'`")
    sources = [str(path) for path in sorted(BINARY.parent.glob("*.c"))]
    flags = [
        *SHARED,
        *FLAGS,
        f'-DSOURCES_DIGEST="{KERNEL["sources_digest"]()}"',
        *shlex.split(os.environ.get("CFLAGS", "")),
    ]
    # another process may load the kernel meanwhile; a linker for Windows leaves more than the library
    with tempfile.TemporaryDirectory(dir=BINARY.parent, prefix="_kernel.") as folder:
        made = Path(folder) / BINARY.name
        line = [*command, *flags, "-o", str(made), *sources, "-lm"]
        done = subprocess.run(line, capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(f"cuefem: the contact's kernel does not compile with {command[0]}:\n{done.stderr.strip()}")
        made.replace(BINARY)
    return BINARY


if __name__ == "__main__":
    print(build())
else:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface

    class KernelHook(BuildHookInterface):  # type: ignore[type-arg]
        """Hatchling's hook (``[tool.hatch.build.hooks.custom]``)."""

        def dependencies(self) -> list[str]:
            """What the build needs: a compiler by name of its wheel, where this machine has none."""
            return [] if compiler() else [ZIG]

        def initialize(self, version: str, build_data: dict[str, Any]) -> None:
            """Build the kernel before a wheel, or an editable install, is made."""
            if self.target_name != "wheel":
                return
            build_data["artifacts"].append(str(build().relative_to(ROOT)))
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{PLATFORM}"  # any Python
