"""The knobs as the page shows them: names, units, ranges, and the materials on offer."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from cuefem.cue import Cue, Material
from cuefem.designer.model import Knobs, bore_mouth, cue_of, deepest_bore, knobs_of, taper_position
from cuefem.designer.units import METRIC, System
from cuefem.materials import MATERIALS, WOODS
from cuefem.report.drawings import material_name
from cuefem.scene import Scene

SHAFTS = (*WOODS, "carbon fibre")
FERRULES = tuple(name for name in MATERIALS if name not in (*SHAFTS, "foam", "leather"))
DECIMALS = 9  # shown at most: beyond them a slider's own rounding begins


@dataclass(frozen=True)
class Slider:
    """A number to turn: its field of `Knobs`, its label, its range in ``unit``; one SI unit is ``scale`` of them."""

    knob: str
    label: str
    unit: str
    scale: float
    low: float
    high: float
    step: float
    least: float  # what may be typed, beyond what can be slid to
    most: float

    def shown(self, knobs: Knobs) -> float:
        """Its value in its unit."""
        return round(getattr(knobs, self.knob) * self.scale, DECIMALS)

    def turned(self, knobs: Knobs, shown: float) -> Knobs:
        """The knobs with this one set to a value in its unit; the same object if it has that value."""
        if abs(shown - self.shown(knobs)) < 10.0**-DECIMALS:
            return knobs
        changed: dict[str, Any] = {self.knob: float(f"{shown / self.scale:.15g}")}  # 0.5 in is 0.0127 m
        return replace(knobs, **changed)

    def written(self, shown: float) -> str:
        """A value with its unit."""
        return f"{self.text(shown)} {self.unit}".rstrip()

    def text(self, shown: float) -> str:
        """A value as it stands in its field."""
        whole = f"{shown:.{self.decimals}f}"
        return whole if abs(float(whole) - shown) < 10.0**-DECIMALS else f"{shown:.6g}"

    def check(self, shown: float) -> None:
        """ValueError in words if a typed value is out of range."""
        if not self.least <= shown <= self.most:
            raise ValueError(f"must be from {self.least:.6g} to {self.written(self.most)}")

    def reaching(self, shown: float) -> Slider:
        """The slider with a range that includes a value."""
        return replace(self, low=min(self.low, shown), high=max(self.high, shown))

    @property
    def decimals(self) -> int:
        """How many decimals a step has."""
        return len(f"{self.step:g}".partition(".")[2])


@dataclass(frozen=True)
class Choice:
    """A material to choose: its field of `Knobs`, its label, and the materials by name, the scene's own included."""

    knob: str
    label: str
    materials: dict[str, Material]

    def name(self, knobs: Knobs) -> str:
        """The name of the chosen material."""
        return next(name for name, known in self.materials.items() if known == getattr(knobs, self.knob))


def sliders(scene: Scene, system: System = METRIC) -> tuple[Slider, ...]:
    """The sliders that a scene has, in a system of units; each range includes the scene's own value."""
    cue, knobs = cue_of(scene), knobs_of(scene)
    wanted = [make(cue, system) for name, make in _SLIDERS.items() if getattr(knobs, name) is not None]
    return tuple(found.reaching(found.shown(knobs)) for found in (_in_system(slider, system) for slider in wanted))


STEPS_IN_INCHES = {0.05: 0.002, 0.1: 0.005, 0.5: 0.02, 1: 0.05, 5: 0.2}  # of a step in mm, in; of one in g, oz


def _in_system(slider: Slider, system: System) -> Slider:
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


def _bore(cue: Cue, system: System) -> Slider:
    label = f"Bore depth, from {system.length(bore_mouth(cue))} on"
    deepest = 1e3 * deepest_bore(cue)
    return Slider("bore_depth", label, "mm", 1e3, 0, round(min(300.0, deepest), 1), 1, 0, deepest)


def _taper(cue: Cue, system: System) -> Slider:
    label = f"Taper, at {system.length(taper_position(cue), 3)}"
    return Slider("taper_diameter", label, "mm", 1e3, 8, 20, 0.05, 4, 60)


def _joint(cue: Cue, system: System) -> Slider:
    far = round(1e3 * cue.length - 10)
    return Slider("joint_position", "Joint at", "mm", 1e3, 20, far, 1, 1, far)


_SLIDERS: dict[str, Callable[[Cue, System], Slider]] = {
    "tip_diameter": lambda *_: Slider("tip_diameter", "Tip diameter", "mm", 1e3, 8, 15, 0.05, 4, 30),
    "taper_diameter": _taper,
    "butt_diameter": lambda *_: Slider("butt_diameter", "Taper, at the end", "mm", 1e3, 12, 34, 0.1, 4, 60),
    "bore_depth": _bore,
    "bore_width": lambda *_: Slider("bore_width", "Bore width", "mm", 1e3, 1, 11, 0.1, 0.1, 30),
    "ferrule_length": lambda *_: Slider("ferrule_length", "Ferrule length", "mm", 1e3, 2, 40, 0.5, 0.5, 60),
    "joint_compliance": lambda *_: Slider("joint_compliance", "Joint bends", "mrad/(N m)", 1e3, 0, 5, 0.05, 0, 100),
    "joint_position": _joint,
    "contact_time": lambda *_: Slider("contact_time", "Contact time (hard–soft tip)", "ms", 1e3, 0.6, 3, 0.01, 0.2, 20),
    "tip_height": lambda *_: Slider("tip_height", "Height of the leather", "mm", 1e3, 2, 12, 0.1, 0.5, 40),
    "tip_dome": lambda *_: Slider("tip_dome", "Radius of the dome", "mm", 1e3, 6, 20, 0.1, 3, 500),
    "leather": lambda *_: Slider(
        "leather", "Leather, E (30 soft, 140 medium, 360 hard)", "MPa", 1e-6, 20, 500, 5, 1, 20_000
    ),
    "restitution": lambda *_: Slider("restitution", "Bounce of the tip, e", "", 1.0, 0.5, 0.95, 0.01, 0, 1),
    "friction": lambda *_: Slider("friction", "Friction of tip and ball", "", 1.0, 0.2, 1.2, 0.01, 0.01, 10),
    "bridge_stiffness": lambda *_: Slider("bridge_stiffness", "Bridge hand holds", "N/mm", 1e-3, 0, 30, 0.5, 0, 1000),
    "bridge_position": lambda cue, _: Slider(
        "bridge_position", "Bridge at", "mm", 1e3, 20, round(1e3 * cue.length - 10), 1, 1, round(1e3 * cue.length - 1)
    ),
    "speed": lambda *_: Slider("speed", "Speed of the cue", "m/s", 1.0, 0.3, 12, 0.1, 0.01, 40),
    "body_mass": lambda *_: Slider("body_mass", "Mass behind what is drawn", "g", 1e3, 0, 700, 5, 0, 5000),
    "offset": lambda *_: Slider("offset", "Offset b/R", "", 1.0, 0, 0.9, 0.01, -0.95, 0.95),
}


# The knobs under headings; those that a scene does not have are left out.
GROUPS = {
    "Shaft": ("tip_diameter", "taper_diameter", "butt_diameter", "bore_depth", "bore_width", "ferrule_length"),
    "Tip": ("tip_height", "tip_dome", "leather", "contact_time", "restitution", "friction"),
    "Stroke": ("speed", "offset"),
    "Joint, bridge and butt": (
        *("joint_compliance", "joint_position", "bridge_stiffness", "bridge_position", "body_mass"),
    ),
}


def choices(scene: Scene) -> tuple[Choice, ...]:
    """The materials that can be chosen in a scene."""
    knobs = knobs_of(scene)
    found = (
        ("ferrule_material", "Ferrule material", FERRULES),
        ("shaft_material", "Shaft material", SHAFTS),
    )
    return tuple(
        Choice(knob, label, _offered(names, getattr(knobs, knob)))
        for knob, label, names in found
        if getattr(knobs, knob) is not None
    )


def _offered(names: tuple[str, ...], own: Material) -> dict[str, Material]:
    known = {name: MATERIALS[name].material for name in names}
    return known if own in known.values() else {f"the file's own ({material_name(own)})": own, **known}


def without(scene: Scene) -> list[str]:
    """Sentences about the parts of this scene that have no knob."""
    knobs = knobs_of(scene)
    reasons = []
    if knobs.ferrule_length is None:
        reasons.append("no ferrule is drawn behind the tip, so there is no knob for it")
    if knobs.bore_depth is None:
        reasons.append("the bore behind the tip is filled, so it stays as it is")
    if knobs.contact_time is None:
        reasons.append("the contact time follows from the leather tip, so there is no knob for it")
    return reasons
