"""The order in which the designer answers: numbers first and alone, pictures last, and not for every move of many."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from dataclasses import replace

import pytest

from cuefem.designer.answering import Answering
from cuefem.designer.start import first_scene
from cuefem.scene import Scene
from cuefem.solid.own_tip import ONCE


class Page:
    """A page that writes down what it is told to show."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.told: list[str] = []
        self.drawn = asyncio.Event()

    def scenes(self) -> list[Scene]:
        return [self.scene]

    def say(self, words: str) -> None:
        if words:
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


@pytest.mark.parametrize("moves", [1, 4])
def test_numbers_come_before_all_else_and_pictures_once_at_the_end(moves: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cuefem.designer.answering.DRAWN_EVERY", float("inf"))

    async def answered() -> Page:
        page = Page(at_offset(0.3))
        answering = Answering(page)
        tasks = []
        for i in range(moves):
            page.scene = at_offset(0.3 + 0.01 * i)
            tasks.append(asyncio.create_task(answering.moved()))
            await asyncio.sleep(0.005)
        await page.drawn.wait()
        assert answering.mine is not None
        assert answering.mine.answers.scene == page.scene  # the newest
        assert answering.mine.answers.has_end_mass
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        return page

    told = asyncio.run(answered()).told
    said = [what for what in told if what != "busy"]
    assert told[0] == "busy"
    assert said[:2] == ["numbers", "move"]
    assert said[-4:] == ["move", "numbers", "pictures", "more pictures"]  # the strike's, then the end mass's
    assert said.count("pictures") == 1
    assert said.count("numbers") <= 1 + said.count("move")  # the end mass is not computed while a newer move waits


def test_a_scene_that_is_begun_twice_at_a_time_has_its_results_in_one_place() -> None:
    """What is computed later is shown only where the page looks for it."""

    async def begun() -> list[object]:
        answering = Answering(Page(at_offset(0.3)))
        return await asyncio.gather(*(answering._begun(at_offset(0.3)) for _ in range(2)))

    one, other = asyncio.run(begun())
    assert one is other


def test_pictures_follow_while_knobs_are_moved_all_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cuefem.designer.answering.DRAWN_EVERY", 0.0)

    async def answered() -> Page:
        page = Page(at_offset(0.3))
        answering = Answering(page)
        moving = asyncio.create_task(answering.moved())
        while "pictures" not in page.told:
            await asyncio.sleep(0.001)
        page.scene = at_offset(0.31)
        other = asyncio.create_task(answering.moved())
        await page.drawn.wait()
        for task in (moving, other):
            task.cancel()
        await asyncio.gather(moving, other, return_exceptions=True)
        return page

    told = asyncio.run(answered()).told
    assert told[: told.index("pictures") + 1] == ["busy", "numbers", "move", "numbers", "pictures"]


def test_a_tip_that_is_computed_for_seconds_is_told_and_the_words_go_with_the_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    words: list[str] = []

    async def answered() -> Page:
        page = Page(at_offset(0.3))
        page.say = lambda told: page.told.append(told) or words.append(told)  # type: ignore[method-assign,assignment,func-returns-value]
        moving = asyncio.create_task(Answering(page).moved())
        await page.drawn.wait()
        moving.cancel()
        await asyncio.gather(moving, return_exceptions=True)
        return page

    asyncio.run(answered())
    assert words == []
    monkeypatch.setattr(Scene, "tip_at_hand", False)
    told = asyncio.run(answered()).told
    assert words == [ONCE, ""]
    assert told[:4] == ["busy", ONCE, "", "numbers"]
