"""What the page computes of its designs, off the page's own loop: the newest move first, slower results after it."""

from __future__ import annotations

import asyncio
import ctypes
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from cuefem.designer.answers import Answers, Density, Point, SquirtCurve, curve_of
from cuefem.scene import Scene

LONGEST_WORK = 60.0  # s that an answer may take: no cue that people play with needs a tenth of it
FAILURES = (ValueError, RuntimeError, ArithmeticError, MemoryError, OSError)
MOST_KEPT = 12  # designs whose results are kept beside those on the page: to undo at once


async def computed(work: Callable[..., Any], *arguments: Any) -> Any:
    """Work done in a thread, with overflows as errors; RuntimeError if it takes too long."""

    def guarded() -> Any:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            return work(*arguments)

    try:
        return await asyncio.wait_for(asyncio.to_thread(guarded), LONGEST_WORK)
    except TimeoutError:
        raise RuntimeError(f"this takes more than {LONGEST_WORK:g} s: draw fewer segments, or check sizes") from None


def give_back() -> None:
    """Give the system the memory that nothing takes any more: the C library of Linux keeps it after many results."""
    if sys.platform.startswith("linux"):
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        if trim is not None:
            trim(0)


@dataclass
class Results:
    """What is known of one design so far. whole: whether its coupled curve is; failed: whether it has none."""

    answers: Answers
    points: tuple[Point, ...] = ()
    whole: bool = False
    density: Density | None = None

    @property
    def coupled(self) -> SquirtCurve | None:
        """The coupled curve, as far as it is known."""
        return curve_of(self.points) if self.points else None


class Memory:
    """Results by their scenes, the least recently used of them forgotten."""

    def __init__(self) -> None:
        self.results: dict[Scene, Results] = {}

    def get(self, scene: Scene) -> Results | None:
        """What is known of a scene."""
        results = self.results.pop(scene, None)
        if results is not None:
            self.results[scene] = results
        return results

    def put(self, answers: Answers, keep: Iterable[Scene]) -> Results:
        """Remember a scene's first results; those to keep, and the latest, are not forgotten."""
        made = self.results[answers.scene] = Results(answers)
        scenes = {*keep, answers.scene}
        for scene in list(self.results)[:-MOST_KEPT]:
            if scene not in scenes:
                del self.results[scene]
        return made
