"""A design is a scene with its knobs turned. The history holds the designs before and after it, to undo and redo."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

from cuefem.scene import Scene
from cuefem.vary import knobs_of, turned

TOGETHER = 1.5  # s: moves of one knob that follow each other within it are one step
MOST_STEPS = 60


@dataclass(frozen=True)
class Design:
    """A scene as it was opened, and where its knobs stand now.

    base: the scene as it was opened or last edited. notes: what was assumed because the file does not say it. A design
    can be written down that no cue can have (a bore wider than the shaft); then `scene` raises ValueError.
    """

    name: str
    base: Scene
    knobs: Mapping[str, Any] = field(hash=False)
    notes: tuple[str, ...] = ()

    @classmethod
    def of(cls, name: str, scene: Scene, notes: Sequence[str] = ()) -> Design:
        """A scene as it is; ValueError for a lumped cue."""
        return cls(name, scene, knobs_of(scene), tuple(notes))

    @cached_property
    def scene(self) -> Scene:
        """The scene that the knobs make."""
        return turned(self.base, self.knobs)

    def edited(self, scene: Scene) -> Design:
        """The design with another scene under its knobs, which stand where that scene has them."""
        return replace(self, base=scene, knobs=knobs_of(scene))


class Step(NamedTuple):
    """What one undo brings back: the design in work, and the designs that are pinned beside it to be compared."""

    design: Design
    pinned: tuple[Design, ...] = ()


class History:
    """All steps of a page in their order, and which of them is shown. Undo and redo move to a neighbour."""

    def __init__(self, steps: Sequence[Step], at: int = -1) -> None:
        self.steps = list(steps)
        self.at = at % len(self.steps)
        self._label, self._when = "", 0.0

    @property
    def now(self) -> Step:
        """The step that is shown."""
        return self.steps[self.at]

    def put(self, step: Step, label: str = "", *, when: float = 0.0) -> None:
        """Add a step behind the one that is shown; steps that were undone are forgotten.

        label: the knob that was moved. when: the time, s. Moves of one knob within `TOGETHER` of each other become one
        step, so that one undo takes back a whole slide.
        """
        if step == self.now:
            return
        joined = bool(label) and label == self._label and when - self._when < TOGETHER and self.at > 0
        self.steps = [*self.steps[: self.at + (0 if joined else 1)], step][-MOST_STEPS:]
        self.at = len(self.steps) - 1
        self._label, self._when = label, when

    @property
    def can_undo(self) -> bool:
        """Whether there is a step before."""
        return self.at > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is a step after."""
        return self.at < len(self.steps) - 1

    def undo(self) -> Step:
        """Go back a step, if there is one."""
        return self._go(-1)

    def redo(self) -> Step:
        """Go forth a step, if there is one."""
        return self._go(1)

    def _go(self, by: int) -> Step:
        self.at = min(max(self.at + by, 0), len(self.steps) - 1)
        self._label = ""
        return self.now
