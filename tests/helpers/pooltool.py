"""A Python that has pooltool, and programs run in it; no tests.

pooltool 0.6.0 requires a development build of its graphics that is not on PyPI, so that pip installs 0.3.3, which has
no end mass, and `cuefem[pooltool]` cannot exist. .ci/pooltool makes an environment, and POOLTOOL_PYTHON names it.
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]


def pooltool_python() -> str:
    """A Python with pooltool: this one, or POOLTOOL_PYTHON."""
    has_it = "from importlib.util import find_spec; raise SystemExit(find_spec('pooltool') is None)"
    for python in (sys.executable, os.environ.get("POOLTOOL_PYTHON", "")):
        if python and subprocess.run([python, "-c", has_it], capture_output=True).returncode == 0:
            return python
    pytest.skip("no pooltool here: POOLTOOL_PYTHON names the Python of an environment that has it")


def in_pooltool(program: str, sent: Any) -> Any:
    """What a program that reads JSON prints as JSON, run beside the studies."""
    done = subprocess.run(
        [pooltool_python(), "-c", program], input=json.dumps(sent), capture_output=True, text=True, cwd=ROOT
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
