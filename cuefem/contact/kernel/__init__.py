"""The compiled kernel of the contact: where it lies, and whether it is whole.

hatch_build.py, at the root of the sources, compiles it when the package is installed. A kernel that is missing, cut
short or built from other sources is refused in one line before it is loaded.
"""

from __future__ import annotations

import sys
from hashlib import sha256
from pathlib import Path

HERE = Path(__file__).parent
BINARY = HERE / ("_kernel.dll" if sys.platform == "win32" else "_kernel.so")
# Beside it: the digest of the sources that it was built from, and its own.
DIGESTS = HERE / "_kernel.sha256"
BUILD = "build it with `python hatch_build.py` in a clone, or install cuefem again"


class KernelError(ImportError):
    """The compiled kernel cannot be used; the message says why, and how to build it."""


def sources_digest() -> str:
    """Of the sources beside this file, the line ends of every system alike; "" where they are not installed."""
    sources = sorted([*HERE.glob("*.c"), *HERE.glob("*.h")])
    together = b"".join(path.read_bytes().replace(b"\r\n", b"\n") for path in sources)
    return sha256(together).hexdigest() if sources else ""


def seal() -> None:
    """Write the digests of a kernel that was just built."""
    digests = (sources_digest(), sha256(BINARY.read_bytes()).hexdigest())
    DIGESTS.write_text("\n".join([*digests, ""]), encoding="ascii", newline="\n")


def check() -> None:
    """KernelError unless the kernel is there, whole, and built from the sources beside it."""
    if not BINARY.exists() or not DIGESTS.exists():
        raise KernelError(f"the contact's compiled kernel is missing; {BUILD}")
    # in lines of any system's ends: a clone or an archive may have changed them
    sources, binary = [*DIGESTS.read_text(encoding="ascii", errors="replace").split(), "", ""][:2]
    if sha256(BINARY.read_bytes()).hexdigest() != binary:
        raise KernelError(f"the contact's compiled kernel is damaged: it is not the one that was built; {BUILD}")
    if sources_digest() not in ("", sources):
        raise KernelError(f"the contact's compiled kernel was built from other sources; {BUILD}")
