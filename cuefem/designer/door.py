"""What the designer's server lets in: its own page alone, files of a bounded size, under names that files can have."""

from __future__ import annotations

from typing import Any

from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LARGEST_FILE = 5_000_000  # bytes
AROUND_FILE = 10_000  # bytes of a form beside its file
LONGEST_NAME = 255  # bytes: what file systems take
KINDS = (".toml", ".csv", ".vtk", ".vtu", ".stl", ".ply", ".obj")
REJECTED = f"a file must be a {', '.join(KINDS[:-1])} or {KINDS[-1]} of at most {LARGEST_FILE // 10**6} MB"


class TooBig(Exception):
    """More was sent than the server reads."""


class Door:
    """Refuses what other pages ask for, and bodies that are too big, before they are read."""

    def __init__(self, app: ASGIApp, origins: tuple[str, ...]) -> None:
        self.app, self.origins = app, origins

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request in, or answer it here."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        if headers.get("origin", self.origins[0]) not in self.origins:
            if scope["type"] == "websocket":
                await receive()
                await send({"type": "websocket.close", "code": 1008})
            else:
                await _refused(403, "this page is for this computer's own browser", scope, receive, send)
        elif scope["type"] == "http":
            await self._bounded(headers, scope, receive, send)
        else:
            await self.app(scope, receive, send)

    async def _bounded(self, headers: Headers, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, and stop reading its body where it is longer than a file and its form may be."""
        most, read, begun = LARGEST_FILE + AROUND_FILE, 0, False

        async def counted() -> Message:
            nonlocal read
            message = await receive()
            read += len(message.get("body", b""))
            if read > most:
                raise TooBig
            return message

        async def noted(message: Message) -> None:
            nonlocal begun
            begun = True
            await send(message)

        said = headers.get("content-length", "0")
        try:
            if not said.isdecimal() or len(said) > 18 or int(said) > most:
                raise TooBig
            await self.app(scope, counted, noted)
        except TooBig:
            if not begun:
                await _refused(413, REJECTED, scope, receive, send)


async def _refused(status: int, words: str, scope: Scope, receive: Receive, send: Send) -> None:
    answer = PlainTextResponse(words, status_code=status, headers={"connection": "close"})  # the rest is not read
    await answer(scope, receive, send)


def file_name(told: Any) -> str:
    """The name of a file as the browser sent it, without folders; ValueError if no file can have that name."""
    name = str(told or "").replace("\\", "/").rsplit("/", 1)[-1]
    if name.strip() in ("", ".", "..") or not name.isprintable():
        raise ValueError(f"a file must have a name; got {name[:20]!r}")
    size = len(name.encode(errors="replace"))
    if size > LONGEST_NAME:
        raise ValueError(f"a file's name must be of at most {LONGEST_NAME} bytes; got {size}")
    return name
