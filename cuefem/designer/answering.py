"""The order in which a tab's results are computed and shown: the newest move's strike first, then what takes longer.

The numbers that a person waits for go to the page alone. What it has to draw anew follows when they are seen there: the
knobs at once, all pictures when nothing is moved any more, or now and then while it goes on.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import suppress
from typing import Any, Protocol

from cuefem.designer.answers import answers, completing, coupled_points, density, with_end_mass
from cuefem.designer.computing import FAILURES, Memory, Results, computed, give_back
from cuefem.scene import Scene
from cuefem.solid.own_tip import announcement

IDLE = 0.12  # s without a move before the slower results are computed
SENT = 0.002  # s that the numbers are given to leave before anything else is computed
SEEN = 0.015  # s that the page is given to draw them before it gets anything else
DRAWN_EVERY = 0.6  # s between pictures while knobs are moved all the time
SHOWN_EVERY = 4  # points of a curve that is computed


class Shows(Protocol):
    """What shows results, and knows of which scenes: the one in work first, then those that are pinned."""

    def scenes(self) -> list[Scene]:
        """The scene in work, and those that are pinned."""

    def say(self, words: str) -> None:
        """Say what went wrong, or clear the message."""

    def show_busy(self, busy: bool) -> None:
        """Whether more is being computed."""

    def show_numbers(self) -> None:
        """The numbers that matter most, as far as they are known."""

    def show_move(self) -> None:
        """What belongs to a move beside its answer."""

    def pictures(self) -> Iterator[None]:
        """Show everything else of a design, step by step."""

    def show_table(self) -> None:
        """All numbers that are known."""

    def show_curves(self) -> None:
        """The curves that are known."""


class Answering:
    """Computes one thing after the other, off the page's loop, and lets it be shown; a newer move is never waited for.

    mine: what is known of the scene in work. before: the last whole results, shown pale until there are new ones.
    """

    def __init__(self, page: Shows) -> None:
        self.page = page
        self.memory = Memory()
        self.mine: Results | None = None
        self.before: Results | None = None
        self.moves = self.answered = 0
        self.busy = False
        self.failed = False  # whether the last move has no answer
        self.drawn = 0  # the last move whose pictures are drawn
        self.since = 0.0  # s: when they were, or the first move after them came

    def known(self, scene: Scene) -> Results | None:
        """What is known of a scene."""
        return self.memory.get(scene)

    async def moved(self) -> None:
        """Answer the newest move; one that came while the last was computed is answered after it."""
        if self.drawn == self.moves:
            self.since = time.monotonic()
        self.moves += 1
        self.page.show_busy(True)
        if self.busy:
            return
        self.busy = True
        try:
            while self.answered < self.moves:
                self.answered = self.moves
                good = await self._answer()
                if good and time.monotonic() - self.since > DRAWN_EVERY:
                    await self._draw(self.answered)
        finally:
            self.busy = False
        move = self.moves
        if good:
            await self._refine(move)
        if move == self.moves:
            await asyncio.to_thread(give_back)
        if move == self.moves:
            self.page.show_busy(False)

    async def _answer(self) -> bool:
        """The strike at once; the end mass too, if no newer move waits."""
        scene = self.page.scenes()[0]
        results = self.memory.get(scene)
        try:
            if results is None and not scene.tip_at_hand:
                self.page.say(announcement())
                self.failed = True  # so that the words go with the answer
            results = results or await self._begun(scene)
            if self.mine is not None and self.mine.whole:
                self.before = self.mine
            self.mine = results
            if self.failed:
                self.failed = False
                self.page.say("")
            self.page.show_numbers()
            await asyncio.sleep(SENT)
            more = None
            if self.answered == self.moves:
                if not results.answers.has_end_mass:
                    more = asyncio.create_task(computed(with_end_mass, results.answers))
                await asyncio.sleep(SEEN)
            self.page.show_move()
            if more is not None:
                results.answers = await more
                self.page.show_numbers()
        except FAILURES as error:
            self.failed = True
            self.page.show_move()
            self.page.say(f"{' '.join(str(error).split())}. The numbers are still those of the design before.")
            return False
        return True

    async def _draw(self, move: int) -> None:
        """Draw the pictures one by one until a newer move comes."""
        self.since = time.monotonic()
        for _ in self.page.pictures():
            await asyncio.sleep(0)
            if move != self.moves:
                return
        self.drawn = move

    async def _begun(self, scene: Scene) -> Results:
        """The first results of a scene. Two moves that ask for them at the same time get the same ones."""
        answer = await computed(answers, scene)
        return self.memory.get(scene) or self.memory.put(answer, self.page.scenes())

    async def _refine(self, move: int) -> None:
        """Compute the coupled curve, where end mass lives, and both of the pinned designs, unless a knob is moved."""
        await asyncio.sleep(IDLE)
        if move != self.moves:
            return
        if self.drawn < move:
            await self._draw(move)
        for scene in self.page.scenes():
            with suppress(*FAILURES):  # a strike at another offset may have no answer: then there is no curve
                async for _ in self._steps_of(scene, move):
                    if move != self.moves:
                        return
            if move != self.moves:
                return

    async def _steps_of(self, scene: Scene, move: int) -> AsyncIterator[None]:
        """Compute and show all of a scene step by step; who asks for the steps stops when a knob is moved."""
        results = self.memory.get(scene) or await self._begun(scene)
        if not results.answers.has_end_mass:
            yield
            results.answers = await computed(with_end_mass, results.answers)
            self.page.show_numbers()
            self.page.show_table()
        yield
        if not results.answers.complete:
            parts = completing(results.answers)
            while more := await computed(next, parts, None):
                results.answers = more
                self.page.show_numbers()
                yield  # between two of them a newer move is heard
            self.page.show_numbers()
            self.page.show_table()
        if not results.whole:
            work = _after(coupled_points(results.answers), len(results.points))
            while point := await computed(next, work, None):
                results.points = (*results.points, point)
                if len(results.points) % SHOWN_EVERY == 1:
                    self.page.show_curves()
                yield
            results.whole = True
        self.page.show_curves()
        yield
        if results.density is None:
            results.density = await computed(density, scene)
            self.page.show_curves()


def _after(points: Iterator[Any], count: int) -> Iterator[Any]:
    """The points but for the first ``count``, which are known: a curve goes on where it was left."""
    return points if count == 0 else (point for i, point in enumerate(points) if i >= count)
