"""How far beam theory is off for the design, computed as a solid when it is asked for and said in a sentence."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator, Sequence
from html import escape
from typing import Any

from nicegui import ui

import cuefem.report
from cuefem.designer.computing import FAILURES, computed
from cuefem.designer.controls import Beside, button
from cuefem.designer.markup import Markup
from cuefem.report.glossary import explained
from cuefem.results.records import Record
from cuefem.scene import Scene

OFFER = "The numbers are a beam's. This computes the cue as a solid too, which takes some seconds."
BEFORE = "That was the design before: check it again for this one."


def _model_error(scene: Scene, follow: Callable[[Sequence[Any]], Iterator[Any]]) -> Record:
    return cuefem.report.model_error_record(scene, follow)  # loads scikit-fem, which the page's start need not


class CheckSide:
    """A button and its sentence. scene: tells the scene in work."""

    def __init__(self, scene: Callable[[], Scene]) -> None:
        self.scene = scene
        self.of: Scene | None = None
        self.sentence = ""
        with ui.element("section").classes("check"):
            self.said = Markup(f"<p>{OFFER}</p>").props("aria-live=polite")
            with ui.element("div").classes("actions"):
                self.ask = button("Check beam theory", self._compute)
            self.beside = Beside()

    def show(self) -> None:
        """Say whether the sentence is of the design in work."""
        if self.of is not None:
            self._say(self.sentence if self.of == self.scene() else f"{self.sentence} {BEFORE}")

    def _say(self, words: str) -> None:
        self.said.set_content(explained(f"<p>{escape(words)}</p>"))

    async def _compute(self) -> None:
        scene, loop = self.scene(), asyncio.get_running_loop()

        def follow(work: Sequence[Any]) -> Iterator[Any]:
            for i, part in enumerate(work, 1):
                loop.call_soon_threadsafe(self._say, f"Computing: step {i} of {len(work)} …")
                yield part

        self.ask.disable()
        self.beside.say("")
        try:
            self.sentence = (await computed(_model_error, scene, follow))["sentence"]
            self.of = scene
            self.show()
        except FAILURES as error:
            self.of = None
            self._say(OFFER)
            self.beside.say(" ".join(str(error).split()))
        finally:
            self.ask.enable()
