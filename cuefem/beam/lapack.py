"""LAPACK's own routines, without the rest of scipy.linalg, which takes one and a half times as long to load as NumPy.

scipy keeps them in one compiled module. That module is loaded alone, where it stands where it always stood; otherwise
scipy.linalg hands out the same routines.
"""

from __future__ import annotations

import sys
from functools import cache
from importlib import import_module
from importlib.machinery import PathFinder
from importlib.util import module_from_spec
from pathlib import Path
from typing import Any

HOME, NAME = "scipy.linalg.lapack", "scipy.linalg._flapack"


@cache
def lapack() -> Any:
    """The module of routines named as in LAPACK: ``lapack().dpotrf(a)``."""
    return (None if HOME in sys.modules else _alone()) or import_module(HOME)


def _alone() -> Any:
    """scipy's module of routines by itself; None if it is not there or does not load alone."""
    scipy = PathFinder.find_spec("scipy")  # `find_spec` would load a lazy module
    folders = [str(Path(folder) / "linalg") for folder in (scipy.submodule_search_locations or ())] if scipy else []
    spec = PathFinder.find_spec(NAME, folders)
    if spec is None or spec.loader is None:
        return None
    try:
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
    except ImportError:
        return None
    return module if hasattr(module, "dsygvd") else None
