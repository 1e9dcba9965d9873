"""Builds the compiled kernel of the contact into the package, where there is a C compiler; goes on without it if not.

Hatchling calls it for wheels and for editable installs. `python hatch_build.py` builds the kernel in place.
The C compiler is `cc`, or what the environment variable CC names, with CFLAGS behind its flags; CUEFEM_KERNEL=python
leaves the kernel out.
"""

from __future__ import annotations

import importlib.util
import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from types import ModuleType
from typing import Any

ROOT = Path(__file__).parent
# Sums may be taken in any order, as vector instructions do; nothing else of -ffast-math, which at the link would switch
# the whole process to flush denormal numbers to zero.
FLAGS = ["-O3", "-fno-math-errno", "-fno-trapping-math", "-fno-signed-zeros", "-fassociative-math"]


def kernel() -> ModuleType:
    """cuefem.contact.kernel, without what the package needs."""
    spec = importlib.util.spec_from_file_location("kernel", ROOT / "cuefem" / "contact" / "kernel" / "__init__.py")
    assert spec is not None
    assert spec.loader is not None
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


def build() -> Path | None:
    """Compile the kernel beside its sources; None, and a word, where that cannot be."""
    found = kernel()
    binary: Path = found.BINARY
    compiler = shlex.split(os.environ.get("CC", "cc"))
    if os.environ.get(found.VARIABLE) == "python":
        return left_out(binary, f"{found.VARIABLE}=python, so the compiled kernel is left out")
    if not compiler or not shutil.which(compiler[0]):
        return left_out(binary, "no C compiler (cc), so the contact will run in Python")
    sources = [str(path) for path in sorted(found.HERE.glob("*.c"))]
    about = f'-DCUEFEM_SOURCES="{found.digest()}"'
    made = binary.with_suffix(f".{os.getpid()}")  # another process may load the kernel meanwhile
    said = ""
    own = shlex.split(os.environ.get("CFLAGS", ""))
    for flags in (FLAGS, ["-O2"]):
        command = [*compiler, "-std=gnu11", "-fPIC", "-shared", *flags, *own, about, "-o", str(made), *sources, "-lm"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            made.replace(binary)
            return binary
        said = said or done.stderr.strip()
    made.unlink(missing_ok=True)
    return left_out(binary, f"the kernel does not compile, so the contact will run in Python:\n{said}")


def left_out(binary: Path, why: str) -> None:
    """Say why there is no kernel, and leave none of an earlier time behind."""
    binary.unlink(missing_ok=True)
    print(f"cuefem: {why}", file=sys.stderr)


def platform_tag() -> str:
    """Of a wheel that holds the binary: any Python, this platform."""
    return "py3-none-" + sysconfig.get_platform().replace("-", "_").replace(".", "_")


if __name__ == "__main__":
    print(build() or "nothing built")
else:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface

    class KernelHook(BuildHookInterface):  # type: ignore[type-arg]
        """Hatchling's hook (``[tool.hatch.build.hooks.custom]``)."""

        def initialize(self, version: str, build_data: dict[str, Any]) -> None:
            """Build the kernel before a wheel, or an editable install, is made."""
            if self.target_name != "wheel":
                return
            made = build()
            if made is not None:
                build_data["artifacts"].append(str(made.relative_to(ROOT)))
                build_data["pure_python"] = False
                build_data["tag"] = platform_tag()
