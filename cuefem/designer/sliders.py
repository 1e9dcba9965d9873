"""The knobs as the page shows them: names, units, ranges, and the materials on offer."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from cuefem.cue import Material
from cuefem.cue.materials import MATERIALS, material_name
from cuefem.designer.ranges import RANGES, knobs_of, reach
from cuefem.designer.unit_system import METRIC, UnitSystem
from cuefem.parameters.parameter import PARAMETERS
from cuefem.parameters.parts import bore_mouth, taper_position
from cuefem.scene import Scene
from cuefem.scene.default_scene import GAMES

Knobs = Mapping[str, Any]
LABELS = {
    "tip_diameter": "Tip diameter",
    "taper_diameter": "Taper, at {exact}",
    "butt_diameter": "Taper, at the end",
    "bore_depth": "Bore depth, from {exact} on",
    "bore_width": "Bore width",
    "ferrule_length": "Ferrule length",
    "ferrule_material": "Ferrule material",
    "shaft_material": "Shaft material",
    "leather": "Leather, E (30 soft, 140 medium, 360 hard)",
    "tip_height": "Height of the leather",
    "dome": "Radius of the dome",
    "contact_time": "Contact time (hard–soft tip)",
    "restitution": "Bounce of the tip, e",
    "friction": "Friction of tip and ball",
    "speed": "Speed of the cue",
    "offset": "Offset b/R",
    "body_mass": "Mass behind what is drawn",
}
HINTS = {
    "taper_diameter": "From here the diameter changes evenly to the tip and to the end",
    "ferrule_length": "A longer ferrule takes its length from the wood behind it: the cue stays as long",
}
ABSENT = {
    "bore_depth": "the bore behind the tip is filled, so it stays as it is",
    "ferrule_length": "no ferrule is drawn behind the tip, so there is no knob for it",
    "contact_time": "the contact time follows from the leather tip, so there is no knob for it",
}
GROUPS = {
    "Shaft": ("tip_diameter", "taper_diameter", "butt_diameter", "bore_depth", "bore_width", "ferrule_length"),
    "Tip": ("leather", "tip_height", "dome", "contact_time", "restitution", "friction"),
    "Stroke": ("speed", "offset"),
    "Butt": ("body_mass",),
}
DECIMALS = 9  # shown at most: beyond them a slider's own rounding begins


@dataclass(frozen=True)
class Slider:
    """A number to turn: its key among the knobs, its label, its range in ``unit``; one SI unit is ``scale`` of them."""

    knob: str
    label: str
    unit: str
    scale: float
    low: float
    high: float
    step: float
    least: float  # what may be typed, beyond what can be slid to
    most: float
    hint: str = ""  # what is said where one points at the label

    def shown(self, knobs: Knobs) -> float:
        """Its value in its unit."""
        return round(knobs[self.knob] * self.scale, DECIMALS)

    def turned(self, knobs: Knobs, shown: float) -> Knobs:
        """The knobs with this one set to a value in its unit; the same object if it has that value."""
        if abs(shown - self.shown(knobs)) < 10.0**-DECIMALS:
            return knobs
        return {**knobs, self.knob: float(f"{shown / self.scale:.15g}")}  # 0.5 in is 0.0127 m

    def written(self, shown: float) -> str:
        """A value with its unit."""
        return f"{self.text(shown)} {self.unit}".rstrip()

    def text(self, shown: float) -> str:
        """A value as it stands in its field; one between two steps has a digit more."""
        whole = f"{shown:.{self.decimals}f}"
        finer = f"{shown:.{self.decimals + 1}f}"
        return whole if abs(float(whole) - shown) < 10.0**-DECIMALS else finer.rstrip("0").rstrip(".")

    def check(self, shown: float) -> None:
        """ValueError in words if a typed value is out of range."""
        if not self.least <= shown <= self.most:
            raise ValueError(f"must be from {self.least:.4g} to {self.written(self.most)}")

    def reaching(self, shown: float) -> Slider:
        """The slider with a range that includes a value."""
        return replace(self, low=min(self.low, shown), high=max(self.high, shown))

    @property
    def decimals(self) -> int:
        """How many decimals a step has."""
        return len(f"{self.step:g}".partition(".")[2])


@dataclass(frozen=True)
class Choice:
    """A material to choose: its key among the knobs, its label, and the materials by name, the scene's own included."""

    knob: str
    label: str
    materials: dict[str, Material]

    def name(self, knobs: Knobs) -> str:
        """The name of the chosen material."""
        return next(name for name, known in self.materials.items() if known == knobs[self.knob])


def sliders(scene: Scene, system: UnitSystem = METRIC) -> tuple[Slider, ...]:
    """The sliders that a scene has, in a system of units; each range includes the scene's own value."""
    knobs = knobs_of(scene)
    made = (_slider(key, scene, system) for key in knobs if key in RANGES)
    return tuple(slider.reaching(slider.shown(knobs)) for slider in made)


def _slider(key: str, scene: Scene, system: UnitSystem) -> Slider:
    cue = scene.shaft
    x = bore_mouth(cue) if key == "bore_depth" else taper_position(cue)
    label = LABELS[key].format(exact=system.length(x)) + (_raised(scene) if key == "restitution" else "")
    return _in_system(Slider(key, label, *reach(key, cue), hint=HINTS.get(key, "")), system)


def _raised(scene: Scene) -> str:
    """What the tip's bounce of the game whose ball this is makes of a whole cue's; "" where nothing raises it."""
    game = next((game for game in GAMES.values() if game.ball == scene.ball), None)
    if game is None or not {*game.effects} <= {*scene.effects}:
        return ""
    return f" ({game.tip_restitution:.2f} is a cue's {game.restitution:g})"


STEPS_IN_INCHES = {0.05: 0.002, 0.1: 0.005, 0.5: 0.02, 1: 0.05, 5: 0.2}  # of a step in mm, in; of one in g, oz


def _in_system(slider: Slider, system: UnitSystem) -> Slider:
    """A slider whose unit is mm or g in the units of a system, its ends rounded outwards to whole steps."""
    scale, unit = system.units.get({"mm": "m", "g": "kg"}.get(slider.unit, ""), (slider.scale, slider.unit))
    if unit == slider.unit:
        return slider
    per, step = scale / slider.scale, STEPS_IN_INCHES[slider.step]
    low, high = step * math.floor(slider.low * per / step), step * math.ceil(slider.high * per / step)
    ends: dict[str, Any] = {
        "low": round(low, 6),
        "high": round(high, 6),
        "least": slider.least * per,
        "most": slider.most * per,
    }
    return replace(slider, unit=unit, scale=scale, step=step, **ends)


def groups() -> dict[str, tuple[str, ...]]:
    """The keys of the sliders under their headings."""
    return GROUPS


def choices(scene: Scene) -> tuple[Choice, ...]:
    """The materials that can be chosen in a scene."""
    own = knobs_of(scene)
    offered = ((key, PARAMETERS[key].materials) for key in own if PARAMETERS[key].materials)
    return tuple(Choice(key, LABELS[key], _offered(materials, own[key])) for key, materials in offered)


def _offered(names: tuple[str, ...], own: Material) -> dict[str, Material]:
    known = {name: MATERIALS[name].material for name in names}
    return known if own in known.values() else {f"the file's own ({material_name(own)})": own, **known}


def without(scene: Scene) -> list[str]:
    """Sentences about the parts of this scene that have no knob."""
    own = knobs_of(scene)
    return [words for key, words in ABSENT.items() if key not in own]
