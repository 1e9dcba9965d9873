"""The designer's server: one page, on this computer alone; what a tab of it does is in `cuefem.designer.desk`.

NiceGUI, because a change is one message over a websocket and touches only what it changes (Streamlit runs the whole
script again, Dash and Panel send whole figures), its sliders have roles and keys, and all of it is served from here.
"""

from __future__ import annotations

from collections.abc import Callable

from nicegui import app, ui
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.responses import HTMLResponse

from cuefem.designer.design import Design
from cuefem.designer.desk import Desk, Read
from cuefem.designer.door import Door
from cuefem.handbook.page import page

HOST = "127.0.0.1"


def serve(first: Design, read: Read, *, weigh: bool, port: int, show: bool, announce: Callable[[str], None]) -> None:
    """Serve the page on this computer alone until it is stopped. show: open it in the browser.

    weigh: the page asks for the weight of the first design's cue.
    """

    @ui.page("/")
    def desk() -> None:
        Desk(first, read, weigh=weigh)

    app.add_api_route("/guide", page, response_class=HTMLResponse)
    app.add_middleware(TrustedHostMiddleware, allowed_hosts=[HOST, "localhost"])
    app.add_middleware(Door, origins=(f"http://{HOST}:{port}", f"http://localhost:{port}"))
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
        message_history_length=100,  # kept for that while: one with charts takes 0.1 MB
        tailwind=False,
        show_welcome_message=False,
    )
