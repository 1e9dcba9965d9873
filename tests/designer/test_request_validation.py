"""What the designer's server lets in: other pages, big bodies and names that no file has are refused (bad input)."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
from cuefem.designer.page import LARGEST_FILE, file_name
from cuefem.designer.server import REJECTED, RequestValidation

OWN = "http://127.0.0.1:8470"
PIECE = 1_000_000  # bytes of a body that come together


def asked(kind: str, headers: dict[str, str], pieces: int = 0) -> tuple[list[dict[str, Any]], int]:
    """What a request gets at the door of an application that reads it all and answers 200, and the bytes read."""
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
def test_other_pages_are_refused(origin: str) -> None:
    assert asked("websocket", {"origin": origin})[0] == [{"type": "websocket.close", "code": 1008}]
    sent, read = asked("http", {"origin": origin}, 3)
    assert (sent[0]["status"], read) == (403, 0)


@pytest.mark.parametrize("headers", [{}, {"origin": OWN}, {"origin": "http://localhost:8470"}])
def test_its_own_page_and_programs_are_let_in(headers: dict[str, str]) -> None:
    assert asked("websocket", headers)[0] == [{"type": "websocket.accept"}]
    sent, read = asked("http", headers, 5)
    assert (sent[0]["status"], read) == (200, 5 * PIECE)


def test_a_big_body_is_refused_and_not_read() -> None:
    sent, read = asked("http", {"content-length": "60000000"}, 60)
    assert (sent[0]["status"], sent[1]["body"], read) == (413, REJECTED.encode(), 0)
    for length in ("-1", "many", "9" * 400):
        assert asked("http", {"content-length": length}, 1)[0][0]["status"] == 413
    sent, read = asked("http", {}, 60)  # its length is not said
    assert sent[0]["status"] == 413
    assert read <= LARGEST_FILE + 2 * PIECE


@pytest.mark.parametrize("name", [None, "", " ", ".", "..", "../..", "a\0.toml", "a\n.toml", "é" * 150 + ".toml"])
def test_a_name_that_no_file_has(name: str | None) -> None:
    with pytest.raises(ValueError, match=r"^a file must have a name of at most 255 bytes; got "):
        file_name(name)


def test_names() -> None:
    assert file_name("../../etc/cue.toml") == "cue.toml"
    assert file_name("C:\\cues\\Löffel.toml") == "Löffel.toml"
