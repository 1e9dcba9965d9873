"""What a parameter is: one number or one material of a scene, with its name, its part or path and its uncertainty."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from cuefem.cue.materials import LEATHERS
from cuefem.parameters.field_paths import Path, field_value, steps
from cuefem.parameters.parts import CONTACT_TIME_OF_SPRING, Part
from cuefem.quantity.fields import Quantity, field_quantity
from cuefem.scene import Scene


class Slider(NamedTuple):
    """The range of a slider, ``low`` to ``high`` in steps, and of typed values, ``least`` to ``most``.

    All in the display unit; ``scale`` is the factor from the SI unit. A range from 0 to 0 has no slider.
    """

    unit: str
    scale: float
    low: float
    high: float
    step: float
    least: float
    most: float


def millimetres(low: float, high: float, step: float, least: float, most: float) -> Slider:
    """A slider in mm."""
    return Slider("mm", 1e3, low, high, step, least, most)


@dataclass(frozen=True)
class Parameter:
    """A named parameter of scenes.

    Parameters
    ----------
    name
        Its name in files and options, with blanks or underscores.
    label
        A short description.
    path
        Its path; "" if it is a part.
    part
        How the value of a part is read and written, and its quantity; None for a path.
    materials
        The choices, if it is a material.
    spread
        Prior standard deviation of its logarithm, or a function of the scene for it. None: uncertain only if a file
        says so.
    below
        Relative uncertainty, downwards, of a number that is usually at its upper bound.
    option, help
        The metavariable and the text of a command's help; "" if it is no option.
    sets
        For each name of its value ("medium"): the values, by path, that the name sets, of this and other parameters.
    slider
        Range of its slider in the designer; None without one.
    dependent_values
        Function of scene and value: values of other parameters, by path, that change with it where it is uncertain.
    """

    name: str
    label: str
    path: str = ""
    part: Part | None = None
    materials: tuple[str, ...] = ()
    spread: float | Callable[[Scene], float | None] | None = None
    below: float | None = None
    option: str = ""
    help: str = ""
    sets: Mapping[str, Mapping[str, float]] | None = None
    slider: Slider | None = None
    dependent_values: Callable[[Scene, float], dict[Path, float]] | None = None

    @property
    def key(self) -> str:
        """Its name as an identifier."""
        return self.name.replace(" ", "_")

    @property
    def choices(self) -> tuple[str, ...]:
        """The names that a list offers: materials, or kinds of leather."""
        return self.materials or tuple(name for name in self.sets or () if name in LEATHERS)

    def steps(self) -> Path:
        """Its path, in steps."""
        return steps(self.path) if self.path else (self.name,)

    def value(self, scene: Scene) -> Any:
        """Its value in a scene; None if the scene has no such parameter, or if it is infinite."""
        value = self.part.read(scene) if self.part else field_value(scene, self.steps())
        return None if isinstance(value, float) and not math.isfinite(value) else value

    @property
    def is_shareable(self) -> bool:
        """Whether it belongs to the tip or the butt, which two shafts may share."""
        return self.path.startswith(("leather.", "tip.", "waves.")) or self.part is CONTACT_TIME_OF_SPRING

    def scaled(self, scene: Scene, factor: float) -> dict[Path, float]:
        """Its value in a scene times a factor, and the dependent values, by path."""
        value = factor * self.value(scene)
        return {self.steps(): value} | (self.dependent_values(scene, value) if self.dependent_values else {})

    def spread_in(self, scene: Scene) -> float | None:
        """Its spread in a scene; None if it is not uncertain there."""
        return self.spread(scene) if callable(self.spread) else self.spread

    def quantity(self, scene: Scene) -> Quantity:
        """Unit and bounds of its number, and the names of values; ValueError if the scene has no such number."""
        if self.part:
            number = self.part.number(scene)
        else:
            *owner, name = self.steps()
            number = field_quantity(field_value(scene, tuple(owner)), name)
        if number is None:
            raise ValueError(f"{self.name} must be a number of this scene; got none")
        return replace(number, names=tuple((n, v[self.path]) for n, v in self.sets.items())) if self.sets else number

    def named_value(self, name: str) -> dict[Path, float]:
        """The values by path for a name of its value; empty if there is no such name."""
        return {steps(path): value for path, value in (self.sets or {}).get(name.strip().lower(), {}).items()}
