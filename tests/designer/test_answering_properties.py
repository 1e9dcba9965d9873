"""The order in which the designer answers: numbers first and alone, pictures last, and not for every move of many."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from dataclasses import replace

import pytest

from cuefem.designer.answering import Answering
from cuefem.designer.start import first_scene
from cuefem.scene import Scene
from cuefem.solid.own_tip import announcement


class Page:
    """A page that writes down what it is told to show."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.told: list[str] = []
        self.drawn = asyncio.Event()

    def scenes(self) -> list[Scene]:
        return [self.scene]

    def say(self, words: str) -> None:
        self.told.append(words)

    def show_busy(self, busy: bool) -> None:
        self.told.append("busy" if busy else "ready")

    def show_numbers(self) -> None:
        self.told.append("numbers")

    def show_move(self) -> None:
        self.told.append("move")

    def pictures(self) -> Iterator[None]:
        self.told.append("pictures")
        yield
        self.told.append("more pictures")
        self.drawn.set()

    def show_table(self) -> None:
        self.told.append("table")

    def show_curves(self) -> None:
        self.told.append("curves")


def at_offset(offset: float) -> Scene:
    scene = first_scene()
    return replace(scene, stroke=replace(scene.stroke, offset=offset))


def follow(page: Page, offsets: list[float], until: str = "") -> Answering:
    """The answering of a page that is moved to offsets one after the other, until its pictures are drawn.

    until: what the page must have shown before each further move; without it, moves come 5 ms apart.
    """

    async def followed() -> Answering:
        answering, tasks = Answering(page), []
        for offset in offsets:
            while tasks and until and until not in page.told:
                await asyncio.sleep(0.001)
            page.scene = at_offset(offset)
            tasks.append(asyncio.create_task(answering.moved()))
            await asyncio.sleep(0 if until else 0.005)
        await page.drawn.wait()
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        return answering

    return asyncio.run(followed())


@pytest.mark.parametrize("moves", [1, 4])
def test_numbers_come_before_all_else_and_pictures_once_at_the_end(moves: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cuefem.designer.answering.DRAWN_EVERY", float("inf"))
    page = Page(at_offset(0.3))
    mine = follow(page, [0.3 + 0.01 * i for i in range(moves)]).mine
    assert mine is not None
    assert mine.answers.scene == page.scene  # the newest
    assert mine.answers.has_end_mass
    said = [what for what in page.told if what != "busy"]
    assert page.told[0] == "busy"
    assert said[:2] == ["numbers", "move"]
    assert said[-4:] == ["move", "numbers", "pictures", "more pictures"]  # the strike's, then the end mass's
    assert said.count("pictures") == 1
    assert said.count("numbers") <= 1 + said.count("move")  # the end mass is not computed while a newer move waits


def test_pictures_follow_while_knobs_are_moved_all_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cuefem.designer.answering.DRAWN_EVERY", 0.0)
    page = Page(at_offset(0.3))
    follow(page, [0.3, 0.31], until="pictures")
    assert page.told[: page.told.index("pictures") + 1] == ["busy", "numbers", "move", "numbers", "pictures"]


def test_a_tip_that_is_computed_for_seconds_is_told_and_the_words_go_with_the_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    at_hand, computed = Page(at_offset(0.3)), Page(at_offset(0.3))
    follow(at_hand, [0.3])
    assert {*at_hand.told} <= {"busy", "ready", "numbers", "move", "pictures", "more pictures", "table", "curves"}
    monkeypatch.setattr(Scene, "tip_at_hand", False)
    follow(computed, [0.3])
    assert computed.told[:4] == ["busy", announcement(), "", "numbers"]
    assert computed.told.count("") == computed.told.count(announcement()) == 1
