"""The designer's server: one page, on this computer only. It rejects requests of other pages, and large bodies."""

from __future__ import annotations

import ctypes
import gc
import logging
import platform
import warnings
from collections.abc import Callable
from importlib.resources import files
from typing import Any

from nicegui import app, ui
from starlette.datastructures import Headers
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.responses import HTMLResponse, PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from cuefem.designer.header import MAX_FILE, UNITS_KEPT
from cuefem.designer.page import Page, is_open
from cuefem.designer.state import Design
from cuefem.files.lathe_profile import DRAWING_EXTENSIONS
from cuefem.handbook.page import page as handbook
from cuefem.measurements.calibration import Calibration
from cuefem.quantity.display_units import SYSTEMS, display, displayed_system
from cuefem.quantity.unit_checks import PlausibilityWarning

HOST = "127.0.0.1"
FORM_SIZE = 10_000  # bytes of a form beside its file
ENDINGS = f"{', '.join(DRAWING_EXTENSIONS[:-1])} or {DRAWING_EXTENSIONS[-1]}"
M_ARENA_MAX = -8  # of glibc's mallopt
REJECTED = f"a file must be a {ENDINGS} of at most {MAX_FILE // 10**6} MB"


def serve(
    first: Design,
    *,
    port: int,
    show: bool,
    announce: Callable[[str], None],
    calibration: Calibration | None = None,
    with_kept_units: bool = False,
) -> None:
    """Serve the page on this computer only until stopped.

    show: open it in the browser. calibration: squirt measured on another shaft. with_kept_units: display the units that
    the browser keeps, those of its last switch.
    """
    warnings.filterwarnings("ignore", category=PlausibilityWarning)  # the page's Check lists these warnings
    _share_one_heap()

    logging.getLogger("uvicorn.error").addFilter(_is_of_open_page)

    @ui.page("/")
    async def index() -> None:
        ui.add_body_html(files("cuefem.designer").joinpath("states.html").read_text(encoding="utf-8"))
        if not await is_open(ui.context.client):
            return
        if with_kept_units:
            kept = await ui.run_javascript(f"localStorage.getItem('{UNITS_KEPT}')")
            display(kept if kept in SYSTEMS else displayed_system())
        Page(first, calibration)

    app.add_api_route("/guide", handbook, response_class=HTMLResponse)
    app.add_middleware(TrustedHostMiddleware, allowed_hosts=[HOST, "localhost"])
    app.add_middleware(RequestValidation, origins=(f"http://{HOST}:{port}", f"http://localhost:{port}"))
    app.on_delete(_return_free_memory)
    app.on_startup(lambda: announce(f"http://{HOST}:{port}/"))
    ui.run(
        host=HOST,
        port=port,
        show=show,
        title="cuefem designer",
        favicon="data:,",
        dark=None,
        language="en-US",
        reload=False,
        reconnect_timeout=30.0,  # s: a busy computer may be silent for longer than the default, 3 s
        tailwind=False,
        show_welcome_message=False,
    )


def _return_free_memory() -> None:
    """Return what a page that was closed has held to the system: glibc keeps most of it."""
    gc.collect()
    if "glibc" in platform.libc_ver():
        ctypes.CDLL(None).malloc_trim(0)


def _share_one_heap() -> None:
    """Let all threads allocate from one heap: glibc gives each its own, which keep what is free in them."""
    if "glibc" in platform.libc_ver():
        ctypes.CDLL(None).mallopt(M_ARENA_MAX, 1)


def _is_of_open_page(record: logging.LogRecord) -> bool:
    """Whether a record is not of a page that was closed before its response began: NiceGUI then has none to send."""
    error = record.exc_info[1] if record.exc_info else None
    return not (isinstance(error, RuntimeError) and str(error) == "No response returned.")


class TooBig(Exception):
    """The request body exceeds the limit."""


class RequestValidation:
    """Rejects requests of other pages, and bodies above the limit, before reading them."""

    def __init__(self, app: ASGIApp, origins: tuple[str, ...]) -> None:
        self.app, self.origins = app, origins

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on a valid request, or reject it."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        if headers.get("origin", self.origins[0]) not in self.origins:
            if scope["type"] == "websocket":
                await receive()
                await send({"type": "websocket.close", "code": 1008})
            else:
                await _reject(403, "this page is for this computer's own browser", scope, receive, send)
        elif scope["type"] == "http":
            await self._bounded(headers, scope, receive, send)
        else:
            await self.app(scope, receive, send)

    async def _bounded(self, headers: Headers, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, and stop reading its body where it is longer than a file and its form may be."""
        most, read, begun = MAX_FILE + FORM_SIZE, 0, False

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

        length = headers.get("content-length", "0")
        try:
            if not length.isdecimal() or len(length) > 18 or int(length) > most:
                raise TooBig
            await self.app(scope, counted, noted)
        except TooBig:
            if not begun:
                await _reject(413, REJECTED, scope, receive, send)


async def _reject(status: int, text: str, scope: Scope, receive: Receive, send: Send) -> None:
    answer: Any = PlainTextResponse(text, status_code=status, headers={"connection": "close"})  # the rest is not read
    await answer(scope, receive, send)
