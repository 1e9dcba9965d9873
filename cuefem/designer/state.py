"""The session of a browser tab: the current design, the other one, and the history for undo and redo."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from cuefem.contact.kernel import KernelError
from cuefem.cue import Cue
from cuefem.designer.controls import alike, value
from cuefem.files import load
from cuefem.files.cue_names import CUES
from cuefem.files.defaults_report import Assumption, assumptions, offered_assumptions
from cuefem.files.parts_catalogue import data_folder
from cuefem.files.reference_cues import named_scene, reference_cue_file
from cuefem.measurements.calibration import Calibration, load_calibration
from cuefem.scene import Scene
from cuefem.scene.default_scene import DEFAULT_GAME, GameName, usual_scene

SLIDE_PAUSE = 1.5  # s: moves of one slider that follow each other within it are one step
MAX_SEGMENTS = 300  # the natural frequencies and the stiffness of as many take 15 s and 0.6 GB
MAX_NAME = 80
FAILURES = (ValueError, RuntimeError, ArithmeticError, MemoryError, OSError, KernelError)
_CALIBRATION = re.compile(rb"^\[calibration\]", re.MULTILINE)
_CUE = re.compile(r"""^\s*cue\s*=\s*["']([^"'\n]+)["']""", re.MULTILINE)


def one_line(error: BaseException) -> str:
    """An error's message in one line."""
    return " ".join(str(error).split())


@dataclass(frozen=True)
class Design:
    """A scene under a name.

    assumed: the controls whose values were set neither in a file nor by the user. typed: the texts of typed values,
    by control. notes: assumptions without a control.
    """

    name: str
    scene: Scene
    assumed: frozenset[str] = frozenset()
    typed: Mapping[str, str] = field(default_factory=dict, hash=False)
    notes: tuple[Assumption, ...] = ()

    def __post_init__(self) -> None:
        count = len(self.scene.shaft.segments)  # ValueError for a lumped cue
        if count > MAX_SEGMENTS:
            raise ValueError(
                f"the designer takes a cue of at most {MAX_SEGMENTS} segments; got {count}: draw it with fewer, or "
                "use cuefem report"
            )

    def changed(self, scene: Scene, keys: Iterable[str], typed: Mapping[str, str]) -> Design:
        """The design with another scene, in which the user set some controls.

        A typed text goes with its value, which another control may change, as `game` changes the speed.
        """
        kept = {
            key: text
            for key, text in self.typed.items()
            if key not in keys and alike(value(key, scene), value(key, self.scene))
        }
        weight = frozenset(
            {"shaft_mass"} if self.scene.shaft.shaft_mass_measured and not scene.shaft.shaft_mass_measured else ()
        )
        return replace(self, scene=scene, assumed=self.assumed - {*keys} | weight, typed={**kept, **typed})


class ComparedDesign(NamedTuple):
    """The design to compare with. kind: "reference", "file", "opened" or "now", the last two of the same shaft."""

    kind: str
    design: Design


class Step(NamedTuple):
    """One step of undo."""

    design: Design
    other: ComparedDesign | None = None


class UndoHistory:
    """All steps of a tab, and the displayed one; the server retains them while the tab is open or reloaded.

    calibration: squirt measured on another shaft with the same tip; it is no step.
    """

    def __init__(self, first: Design, calibration: Calibration | None = None) -> None:
        self.opened, self.calibration = first, calibration
        self.steps = [Step(first)]
        self.at = 0
        self.label, self.when = "", 0.0

    @property
    def now(self) -> Step:
        """The displayed step."""
        return self.steps[self.at]

    def continues_slide(self, label: str, when: float) -> bool:
        """Whether a move of the slider ``label`` at a time, s, continues the displayed step."""
        return bool(label) and label == self.label and when - self.when < SLIDE_PAUSE and self.at > 0

    def slide_start(self, label: str, when: float) -> Design:
        """The design that a move of a slider changes: the one before the slide began."""
        return self.steps[self.at - self.continues_slide(label, when)].design

    def push(self, step: Step, label: str = "", *, when: float = 0.0) -> None:
        """Add a step; undone steps are dropped, and one slide is one step.

        The choice of the other design alone is no step: it applies to all steps.
        """
        if step.design == self.now.design:
            self.steps = [old._replace(other=step.other) for old in self.steps]
            return
        kept = self.steps[: self.at + (not self.continues_slide(label, when))]
        self.steps = [*kept, step]
        self.at, self.label, self.when = len(self.steps) - 1, label, when

    def move(self, steps: int) -> bool:
        """Undo (-1) or redo (1); whether that step exists."""
        at = self.at + steps
        if not 0 <= at < len(self.steps):
            return False
        self.at, self.label = at, ""
        return True


def design_of(name: str, scene: Scene, assumed: Sequence[Assumption]) -> Design:
    """The design of a scene, with the assumptions for the file it was read from."""
    keys = {{"material": "shaft_material"}.get(each.key, each.key) for each in assumed if each.key}
    notes = offered_assumptions(each for each in assumed if not each.key)
    return Design(name[:MAX_NAME], scene, frozenset(keys), {}, tuple(notes))


def reference_design(name: str) -> Design:
    """The cue or scene of a name."""
    path = data_folder() / CUES[name].file
    scene = named_scene(name)
    return design_of(name, scene, assumptions(path, scene, {}))


def read_design(name: str, content: bytes, game: GameName = DEFAULT_GAME) -> Design:
    """The design of an uploaded file; ValueError in one line.

    A cue alone gets the default stroke of a game. A scene may name a reference cue without its folder.
    """
    with TemporaryDirectory() as place:
        path = Path(place) / name
        try:
            path.write_bytes(_with_reference_cue(name, content, Path(place)))
            thing = load(path)
            scene = usual_scene(thing, game) if isinstance(thing, Cue) else thing
            return design_of(path.stem, scene, assumptions(path, scene, {}))
        except (*FAILURES, RecursionError) as error:
            raise ValueError(one_line(error).replace(f"{place}/", "")) from None


def read_file(name: str, content: bytes) -> Design | Calibration:
    """The design or the calibration of an uploaded file; ValueError in one line."""
    if not _CALIBRATION.search(content):
        return read_design(name, content)
    with TemporaryDirectory() as place:
        path = Path(place) / name
        path.write_bytes(content)
        try:
            return load_calibration(path)
        except FAILURES as error:
            raise ValueError(one_line(error).replace(f"{place}/", "")) from None


def _with_reference_cue(name: str, content: bytes, beside: Path) -> bytes:
    """The content of a scene, with the reference cue that it names beside it."""
    text = content.decode(errors="replace") if name.lower().endswith(".toml") else ""
    match = _CUE.search(text)
    found = reference_cue_file(match[1]) if match and "meshes/" in match[1] else None
    if match is None or found is None:
        return content
    file = f"reference_{Path(match[1]).name}"
    (beside / file).write_bytes(found)
    return text.replace(match[0], f'cue = "{file}"', 1).encode()
