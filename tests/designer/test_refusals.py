"""What the designer's command refuses, in one line, before it serves anything (bad input)."""

from __future__ import annotations

import socket
import sys
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.refusals import command_refuses

NICEGUI = "needs NiceGUI: pip install '.[designer]' in the clone"


def test_without_the_library_it_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "cuefem.designer.server", raising=False)
    monkeypatch.setitem(sys.modules, "nicegui", None)
    command_refuses("the designer needs nicegui: pip install '.[designer]' in the clone", "designer", "--no-open")


@pytest.mark.parametrize(
    ("file", "message"),
    [
        (
            "many.toml",
            "many.toml: the designer takes a cue of at most 300 segments; got 400: draw it with fewer, or use cuefem "
            "report",
        ),
        ("lumped.toml", "lumped.toml: Scene.cue must be a Cue of segments: its modes or its shape are needed"),
        ("missing.toml", "missing.toml: cannot be read: No such file or directory"),
    ],
)
def test_files(tmp_path: Path, file: str, message: str) -> None:
    pytest.importorskip("nicegui", reason=NICEGUI)
    piece = cf.Segment(1.8e-3, 0.012, 0.012, cf.Material(12.6e9, 0.84e9, 700.0))
    made = {"many.toml": cf.Cue((piece,) * 400, body_mass=0.45), "lumped.toml": cf.Scene(cf.LumpedCue(0.5, 0.006))}
    if file in made:
        cf.save(made[file], tmp_path / file)
    command_refuses(message, "designer", "--no-open", tmp_path / file)


def test_a_port_in_use(tmp_path: Path) -> None:
    pytest.importorskip("nicegui", reason=NICEGUI)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        message = f"--port {port} is not available"
        command_refuses(message, "designer", "--no-open", "--port", port)
