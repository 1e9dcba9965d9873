"""Runs commands in this process; no tests."""

import io
import json
from contextlib import redirect_stderr, redirect_stdout
from typing import Any

import pytest

from cuefem.cli import main


def call(*arguments: object) -> tuple[object, str, str]:
    """Exit status, stdout and stderr of ``cuefem ARGUMENTS`` (click's own runner joins the streams before 8.2)."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as exit_:
        main([str(argument) for argument in arguments])
    return exit_.value.code, out.getvalue(), err.getvalue()


def stdout_of(*arguments: object) -> str:
    """Stdout of a command with exit status 0 and no warning."""
    status, out, err = call(*arguments)
    assert (status, err) == (0, "")
    return out


def as_json(*arguments: object) -> Any:
    """The record that a command prints with --json: strict JSON, without NaN and Infinity."""

    def no_constant(name: str) -> None:
        raise AssertionError(f"{name} is not JSON")

    return json.loads(stdout_of(*arguments, "--json"), parse_constant=no_constant)
