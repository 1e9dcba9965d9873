"""A design is a scene with its knobs turned. A page's state holds the designs before and after it, to undo and redo."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

from cuefem.designer.ranges import knobs_of, turned
from cuefem.scene import Scene

TOGETHER = 1.5  # s: moves of one knob that follow each other within it are one step
MOST_STEPS = 60
MOST_SEGMENTS = 300  # of a design: the tones and the stiffness of as many take 15 s and 0.6 GB


def check_segments(count: int) -> None:
    """ValueError in words if a cue has more segments than the designer answers for while one waits."""
    if count > MOST_SEGMENTS:
        raise ValueError(
            f"the designer takes a cue of at most {MOST_SEGMENTS} segments; got {count}: draw it with fewer, or use "
            "cuefem report"
        )


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

    def __post_init__(self) -> None:
        check_segments(len(self.base.shaft.segments))

    @classmethod
    def of(cls, name: str, scene: Scene, notes: Sequence[str] = ()) -> Design:
        """A scene as it is; ValueError for a lumped cue, or for one of too many segments."""
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


@dataclass(frozen=True)
class State:
    """All steps of a page in their order, and which of them is shown: a value, from which a change makes the next.

    label, when: the knob that was moved last, and the time, s, so that a slide becomes one step.
    """

    steps: tuple[Step, ...]
    at: int = 0
    label: str = field(default="", compare=False)
    when: float = field(default=0.0, compare=False)

    @property
    def now(self) -> Step:
        """The step that is shown."""
        return self.steps[self.at]

    def put(self, step: Step, label: str = "", *, when: float = 0.0) -> State:
        """The state with a step behind the one that is shown; steps that were undone are forgotten.

        label: the knob that was moved. when: the time, s. Moves of one knob within `TOGETHER` of each other become one
        step, so that one undo takes back a whole slide.
        """
        if step == self.now:
            return self
        joined = bool(label) and label == self.label and when - self.when < TOGETHER and self.at > 0
        steps = (*self.steps[: self.at + (0 if joined else 1)], step)[-MOST_STEPS:]
        return State(steps, len(steps) - 1, label, when)

    @property
    def can_undo(self) -> bool:
        """Whether there is a step before."""
        return self.at > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is a step after."""
        return self.at < len(self.steps) - 1

    def undo(self) -> State:
        """The step before is shown, if there is one."""
        return State(self.steps, max(self.at - 1, 0))

    def redo(self) -> State:
        """The step after is shown, if there is one."""
        return State(self.steps, min(self.at + 1, len(self.steps) - 1))
