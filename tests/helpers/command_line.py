"""A command run in this process, as a user would see it."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout

import pytest

from cuefem.cli import main


def call(*arguments: object) -> tuple[object, str, str]:
    """Exit status, stdout and stderr of ``cuefem ARGUMENTS`` (click's own runner joins the streams before 8.2)."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
        main([str(argument) for argument in arguments])
    return ended.value.code, out.getvalue(), err.getvalue()
