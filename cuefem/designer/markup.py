"""Parts of the page that are only looked at. A change of one is a message that puts new markup in its place.

An update of an element makes the page's framework compare all that it has made, every knob and button, which takes
20 ms and more; a message touches nothing else. So a part changes by messages, and elements are updated after them.
"""

from __future__ import annotations

import json

from nicegui import ui


class Markup(ui.element):
    """A part of the page made of markup; it must be on the page as long as it changes, and so not in a dialog."""

    def __init__(self, content: str = "") -> None:
        super().__init__("div")
        self.classes("markup")
        self.content, self.stale = content, False
        self._props["innerHTML"] = content

    def set_content(self, content: str) -> None:
        """Put this markup in its place, if it is not there yet."""
        if content == self.content:
            return
        self.content = content
        with self._props.suspend_updates():  # for a page that asks for all of the element
            self._props["innerHTML"] = content
        self.client.run_javascript(f"cuefem.put({self.id}, {json.dumps(content)})")

    def set_stale(self, stale: bool) -> None:
        """Whether it is shown pale, because it belongs to the design before."""
        if stale == self.stale:
            return
        self.stale = stale
        self.client.run_javascript(f"cuefem.pale({self.id}, {json.dumps(stale)})")
