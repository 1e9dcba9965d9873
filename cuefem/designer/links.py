"""The dialog of links: the link that holds the designs on the page, and a field for one that somebody sent."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from nicegui import ui

from cuefem.designer.controls import Beside, button
from cuefem.designer.markup import Markup

MARK = "#d="  # after it stands what `kept.text_of` writes; a browser sends it to no server


class LinkDialog:
    """Shows a link, and opens one. opened: takes what a link holds, and returns what is wrong with it, or ""."""

    def __init__(self, opened: Callable[[str], Awaitable[str]]) -> None:
        self.opened = opened
        self.client = ui.context.client
        with ui.dialog().props('aria-label="Links"') as self.dialog, ui.element("div").classes("dialog"):
            Markup("<h2>A link that holds all of this</h2>")
            Markup(
                "<p>It holds this design and the pinned ones, and opens them in the designer on any computer. "
                "Nothing of it is sent to a server.</p>"
            )
            self.link = ui.input("Link").props("readonly outlined dense data-link").classes("wide-field")
            with ui.element("div").classes("actions"):
                button("Copy", lambda: ui.clipboard.write(self.link.value))
            self.other = ui.input("Open a link that you were sent").props("outlined dense").classes("wide-field")
            self.beside = Beside(ui.html(sanitize=False))
            with ui.element("div").classes("actions"):
                button("Open it", self._open)
                button("Close", self.dialog.close)

    def show(self, text: str) -> None:
        """Show the link of a text."""
        request = self.client.request
        self.link.set_value(f"{request.base_url}{MARK}{text}")
        self.other.set_value("")
        self.beside.say("")
        self.dialog.open()

    async def _open(self) -> None:
        _, _, text = str(self.other.value).strip().partition(MARK)
        words = await self.opened(text)
        self.beside.say(words)
        if not words:
            self.dialog.close()
