"""LAPACK is the same whether scipy.linalg is loaded before it, after it, or is all there is (properties)."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg.lapack

from cuefem.beam import lapack

ROOT = Path(lapack.__file__).parents[2]
SOLVED = """
import sys
{before}
import numpy as np
from cuefem.beam.lapack import lapack
alone = "scipy.linalg.lapack" not in sys.modules
mu, vectors, failed = lapack().dsygvd(np.diag([1.0, 2.0]), np.array([[2.0, 1.0], [1.0, 3.0]]))
import scipy.linalg
theirs = scipy.linalg.eigh(np.diag([1.0, 2.0]), np.array([[2.0, 1.0], [1.0, 3.0]]), driver="gvd")
print(alone, failed, bool(np.array_equal(mu, theirs[0]) and np.array_equal(vectors, theirs[1])))
"""


@pytest.mark.parametrize(("before", "alone"), [("", True), ("import scipy.linalg", False)])
def test_routines_are_scipys(before: str, alone: bool) -> None:
    program = SOLVED.format(before=before)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=ROOT, check=True)
    assert done.stdout.split() == [str(alone), "0", "True"]


def test_where_scipy_keeps_them_elsewhere_all_of_it_is_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lapack, "NAME", "scipy.linalg._not_there")
    monkeypatch.setattr(lapack, "HOME", "scipy.linalg.blas")  # as if it were not loaded, and is then asked for
    monkeypatch.delitem(sys.modules, "scipy.linalg.blas")
    assert lapack._alone() is None
    assert hasattr(lapack.lapack.__wrapped__(), "dgemm")


def test_a_failure_is_told() -> None:
    assert scipy.linalg.lapack.dpotrf(-np.eye(2))[1] == lapack.lapack().dpotrf(-np.eye(2))[1] == 1
