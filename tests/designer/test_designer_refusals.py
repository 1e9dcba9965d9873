"""What the designer's command refuses, in one line, before it serves anything (bad input)."""

from __future__ import annotations

import socket
import sys
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.command_line import call


def refused(*arguments: object) -> str:
    """The one line on stderr."""
    status, out, err = call("designer", "--no-open", *arguments)
    assert (status, out, err.count("\n")) == (2, "", 1)
    return err.removeprefix("cuefem: ").rstrip()


def test_without_the_library_it_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "cuefem.designer.app", raising=False)
    monkeypatch.setitem(sys.modules, "nicegui", None)
    assert refused() == "the designer needs nicegui: pip install '.[designer]' in the clone"


def test_wrong_files_are_refused(tmp_path: Path) -> None:
    pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
    lumped = tmp_path / "lumped.toml"
    cf.save(cf.Scene(cf.LumpedCue(0.5, 0.006)), lumped)
    assert (
        refused(lumped)
        == f"{lumped}: Scene.cue must be a Cue of segments: its modes or its shape are needed; got a LumpedCue"
    )
    missing = tmp_path / "missing.toml"
    assert refused(missing) == f"{missing}: cannot be read: No such file or directory"


def test_a_port_in_use_is_refused() -> None:
    pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert refused("--port", port) == f"--port must be a free one (0 takes any); got {port}: Address already in use"
