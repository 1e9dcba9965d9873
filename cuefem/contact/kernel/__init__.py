"""The compiled kernel of the contact: the same steps as in Python, in C, where a compiler was there to build it.

It is never required. `library` is None without it, and then everything runs in Python, which is the oracle the kernel
is tested against. The environment variable CUEFEM_KERNEL chooses: "python" switches the kernel off, "c" makes it an
error that it is not there. hatch_build.py, at the root of the sources, builds it.
"""

from __future__ import annotations

import ctypes
import os
import sys
from functools import cache
from hashlib import sha256
from pathlib import Path

VARIABLE = "CUEFEM_KERNEL"
HERE = Path(__file__).parent
BINARY = HERE / ("_kernel.dll" if sys.platform == "win32" else "_kernel.so")


def library() -> ctypes.CDLL | None:
    """The compiled kernel; None where it is switched off or not there.

    RuntimeError if the environment asks for it and it is not there; ValueError if it asks for another one.
    """
    asked = os.environ.get(VARIABLE, "")
    if asked == "python":
        return None
    if asked not in ("", "c"):
        raise ValueError(f'{VARIABLE} must be "c", "python" or empty; got {asked!r}')
    found, why = _loaded()
    if asked and found is None:
        raise RuntimeError(f"{VARIABLE} asks for the compiled kernel, but {why}")
    return found


def described() -> str:
    """The same in words, for a person."""
    if library() is not None:
        return "compiled (C)"
    if os.environ.get(VARIABLE):
        return f"Python, as {VARIABLE} says"
    return f"Python: {_loaded()[1]}"


def digest() -> str:
    """Of the sources beside this file; "" where they are not installed."""
    sources = sorted([*HERE.glob("*.c"), *HERE.glob("*.h")])
    return (
        sha256(b"".join(path.read_bytes().replace(b"\r\n", b"\n") for path in sources)).hexdigest() if sources else ""
    )


@cache
def _loaded() -> tuple[ctypes.CDLL | None, str]:
    """The compiled library and ""; or None and the reason why there is no library."""
    if not BINARY.exists():
        return None, "the compiled kernel was not built; install again where there is a C compiler"
    try:
        found = ctypes.CDLL(str(BINARY))
        found.cuefem_sources.restype = ctypes.c_char_p
        built = found.cuefem_sources().decode()
    except (OSError, AttributeError) as error:
        return None, f"the compiled kernel does not load: {' '.join(str(error).split())}"
    if digest() not in ("", built):
        return None, "the compiled kernel was built from other sources; install again"
    return found, ""
