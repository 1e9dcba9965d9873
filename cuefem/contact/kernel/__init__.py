"""The compiled kernel of the contact: where it lies, and whether it is whole.

hatch_build.py, at the root of the sources, compiles it when the package is installed. A kernel that is missing, cut
short or built from other sources is refused in one line before it is loaded.
"""

from __future__ import annotations

import sys
from hashlib import sha256
from pathlib import Path

HERE = Path(__file__).parent
BUILD = "build it with `python hatch_build.py` in a clone, or install cuefem again"


class KernelError(ImportError):
    """The compiled kernel cannot be used; the message says why, and how to build it."""


def binary(platform: str) -> Path:
    """Of the system that it is for, by `sys.platform` or by the platform of a wheel's tag."""
    return HERE / ("_kernel.dll" if platform.startswith("win") else "_kernel.so")


BINARY = binary(sys.platform)


def sources_digest() -> str:
    """Of the sources beside this file, the line ends of every system alike; "" where they are not installed."""
    sources = sorted([*HERE.glob("*.c"), *HERE.glob("*.h")])
    together = b"".join(path.read_bytes().replace(b"\r\n", b"\n") for path in sources)
    return sha256(together).hexdigest() if sources else ""


def check() -> None:
    """KernelError unless the kernel is there, whole, and built from the sources beside it.

    The library holds their digest (run.c), behind all code, so that one that was cut short has lost it.
    """
    if not BINARY.exists():
        raise KernelError(f"the contact's compiled kernel is missing; {BUILD}")
    if sources_digest().encode() not in BINARY.read_bytes():
        raise KernelError(f"the contact's compiled kernel was built from other sources, or is damaged; {BUILD}")
