"""Tests that run in Python and in the compiled kernel; no tests."""

from __future__ import annotations

import pytest

from cuefem.contact.kernel import library

# "c" is skipped with a word where the kernel was not built, or is switched off.
BUILT = pytest.mark.skipif(library() is None, reason="the compiled kernel is not there")
KERNELS = ["python", pytest.param("c", marks=BUILT)]
