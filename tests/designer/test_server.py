"""The designer's command and server: validation of requests, errors (bad input)."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
import cuefem as cf
from cuefem.designer import in_thread
from cuefem.designer.header import MAX_FILE, file_name
from cuefem.designer.server import REJECTED, RequestValidation
from cuefem.designer.state import Design
from tests.helpers.command_line import call
from tests.helpers.designer_browser import wait_for_port
from tests.helpers.invalid_input import assert_rejects

OWN = "http://127.0.0.1:8470"
KIM = Path(__file__).parents[2] / "studies/scenes/kim.toml"
PIECE = 1_000_000  # bytes of a chunk of a body


def test_work_beyond_its_time_limit_raises(monkeypatch: pytest.MonkeyPatch) -> None:
    assert asyncio.run(in_thread.run_in_thread(abs, -2)) == 2
    monkeypatch.setattr(in_thread, "TIME_LIMIT", 0.02)
    with pytest.raises(RuntimeError, match=r"this takes more than 0\.02 s: draw fewer segments, or check sizes"):
        asyncio.run(in_thread.run_in_thread(time.sleep, 0.1))


def response_to(kind: str, headers: dict[str, str], pieces: int = 0) -> tuple[list[dict[str, Any]], int]:
    """Messages for a request to an application that reads it completely and responds 200, and the bytes read."""
    sent: list[dict[str, Any]] = []
    left = pieces

    async def receive() -> dict[str, Any]:
        nonlocal left
        if kind == "websocket":
            return {"type": "websocket.connect"}
        left -= 1
        return {"type": "http.request", "body": bytes(PIECE if left >= 0 else 0), "more_body": left > 0}

    async def send(message: Any) -> None:
        sent.append(message)

    async def inside(scope: Any, receive: Callable[[], Any], send: Callable[[Any], Any]) -> None:
        if scope["type"] == "websocket":
            await send({"type": "websocket.accept"})
            return
        while (await receive())["more_body"]:
            pass
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": b"in"})

    scope = {
        "type": kind,
        "method": "POST",
        "path": "/",
        "headers": [(k.encode(), v.encode()) for k, v in headers.items()],
    }
    asyncio.run(RequestValidation(inside, (OWN, "http://localhost:8470"))(scope, receive, send))
    return sent, PIECE * (pieces - max(left, 0))


@pytest.mark.parametrize(
    "origin", ["http://elsewhere.example", "null", "http://127.0.0.1:9", "https://127.0.0.1:8470", ""]
)
def test_request_of_other_page_is_rejected(origin: str) -> None:
    assert response_to("websocket", {"origin": origin})[0] == [{"type": "websocket.close", "code": 1008}]
    sent, read = response_to("http", {"origin": origin}, 3)
    assert (sent[0]["status"], read) == (403, 0)


@pytest.mark.parametrize("headers", [{}, {"origin": OWN}, {"origin": "http://localhost:8470"}])
def test_request_of_own_page_or_program_passes(headers: dict[str, str]) -> None:
    assert response_to("websocket", headers)[0] == [{"type": "websocket.accept"}]
    sent, read = response_to("http", headers, 5)
    assert (sent[0]["status"], read) == (200, 5 * PIECE)


def test_large_body_is_rejected_unread() -> None:
    sent, read = response_to("http", {"content-length": "60000000"}, 60)
    assert (sent[0]["status"], sent[1]["body"], read) == (413, REJECTED.encode(), 0)
    for length in ("-1", "many", "9" * 400):
        assert response_to("http", {"content-length": length}, 1)[0][0]["status"] == 413
    sent, read = response_to("http", {}, 60)  # without content-length
    assert sent[0]["status"] == 413
    assert read <= MAX_FILE + 2 * PIECE


@pytest.mark.parametrize("name", [None, "", " ", ".", "..", "../..", "a\0.toml", "a\n.toml", "é" * 150 + ".toml"])
def test_invalid_file_name_raises(name: str | None) -> None:
    with pytest.raises(ValueError, match=r"^a file must have a name of at most 255 bytes; got "):
        file_name(name)


def test_file_name_drops_folders() -> None:
    assert file_name("../../etc/cue.toml") == "cue.toml"
    assert file_name("C:\\cues\\Löffel.toml") == "Löffel.toml"


@pytest.mark.parametrize(
    ("arguments", "served", "said"),
    [
        ([], ("plain maple", True, True), "here\n"),
        (["predator z2", "--units", "us"], ("predator z2", True, False), "here\n"),
        ([str(KIM), "--no-open", "--json"], ("kim", False, True), '{"address": "here"}'),
    ],
)
def test_designer_serves_the_design_of_its_scene(
    monkeypatch: pytest.MonkeyPatch, arguments: list[str], served: tuple[object, ...], said: str
) -> None:
    """Its name, whether a browser opens, and whether the page keeps the units of the last visit."""
    found = []

    def serve(first: Design, *, show: bool, with_kept_units: bool, announce: Any, **given: Any) -> None:
        found.append((first.name, show, with_kept_units))
        announce("here")

    monkeypatch.setattr("cuefem.designer.server.serve", serve)
    status, out, _ = call("designer", *arguments, "--port", "0")
    assert (status, found) == (0, [served])
    assert "".join(out.split()) == "".join(said.split())


def test_designer_without_nicegui_names_install_command(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "cuefem.designer.server", raising=False)
    monkeypatch.setitem(sys.modules, "nicegui", None)
    assert_rejects("the designer needs nicegui: pip install '.[designer]' in the clone", "designer", "--no-open")


@pytest.mark.heavy
def test_designer_with_too_many_segments_exits_with_message(tmp_path: Path) -> None:
    piece = cf.Segment(1.8e-3, 0.012, 0.012, cf.Material(12.6e9, 0.84e9, 700.0))
    cf.save(cf.Cue((piece,) * 301, body_mass=0.45), tmp_path / "many.toml")
    message = "many.toml: the designer takes a cue of at most 300 segments; got 301"
    assert_rejects(message, "designer", "--no-open", tmp_path / "many.toml")


def test_designer_with_port_in_use_exits_with_message() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        message = f"--port {port} is not available"
        assert_rejects(message, "designer", "--no-open", "--port", port)


@pytest.mark.heavy
@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends Ctrl-C to whole groups of processes")
def test_ctrl_c_stops_server_without_output() -> None:
    command = [sys.executable, "-m", "cuefem", "designer", "--no-open", "--port", "0"]
    outside = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=outside)
    try:
        assert running.stdout is not None
        address = running.stdout.readline().strip()
        wait_for_port(int(address.rstrip("/").rsplit(":", 1)[1]))
        with urllib.request.urlopen(address, timeout=90) as answer:
            assert answer.status == 200
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=90)
    finally:
        running.kill()
        running.communicate()
    assert (running.returncode, out, err) == (0, "", "")
