"""A design: a scene with its knobs turned; and the steps of a desk, to go back and forth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from cuefem.designer.model import Knobs, knobs_of, turned
from cuefem.scene import Scene

TOGETHER = 1.5  # s: moves of one knob that follow each other within it are one step
MOST_STEPS = 60


@dataclass(frozen=True)
class Design:
    """A named scene with its knobs turned. notes: what was assumed because its file does not say it.

    ValueError by `scene` if no such cue can be made.
    """

    name: str
    base: Scene
    knobs: Knobs
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
    """What is on a desk: the design in work, and those that it is compared with, each by its own name."""

    design: Design
    pinned: tuple[Design, ...] = ()


class History:
    """The steps of a desk; one of them is where it stands."""

    def __init__(self, steps: Sequence[Step], at: int = -1) -> None:
        self.steps = list(steps)
        self.at = at % len(self.steps)
        self._label, self._when = "", 0.0

    @property
    def now(self) -> Step:
        """Where the desk stands."""
        return self.steps[self.at]

    def put(self, step: Step, label: str = "", *, when: float = 0.0) -> None:
        """Add a step, and forget those that were undone.

        label: what was moved. A step of the same label soon after the last, ``when`` in s, takes its place.
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
