"""The knobs as the page shows them: names, units, ranges, and the materials on offer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from cuefem.cue import Cue, Material
from cuefem.designer.model import Knobs, bore_mouth, cue_of, deepest_bore, knobs_of, taper_position
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

    def shown(self, knobs: Knobs) -> float:
        """Its value in its unit."""
        return round(getattr(knobs, self.knob) * self.scale, DECIMALS)

    def turned(self, knobs: Knobs, shown: float) -> Knobs:
        """The knobs with this one set to a value in its unit; the same object if it has that value."""
        if abs(shown - self.shown(knobs)) < 10.0**-DECIMALS:
            return knobs
        changed: dict[str, Any] = {self.knob: shown / self.scale}
        return replace(knobs, **changed)

    def written(self, shown: float) -> str:
        """A value with its unit."""
        return f"{shown:.6g} {self.unit}".rstrip()

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


def sliders(scene: Scene) -> tuple[Slider, ...]:
    """The sliders that a scene has; each range includes the scene's own value."""
    cue, knobs = cue_of(scene), knobs_of(scene)
    wanted = [make(cue) for name, make in _SLIDERS.items() if getattr(knobs, name) is not None]
    return tuple(_wide_enough(slider, knobs) for slider in wanted)


def _wide_enough(slider: Slider, knobs: Knobs) -> Slider:
    here = slider.shown(knobs)
    return replace(slider, low=min(slider.low, here), high=max(slider.high, here))


def _bore(cue: Cue) -> Slider:
    label = f"Bore depth, from {1e3 * bore_mouth(cue):.4g} mm on"
    return Slider("bore_depth", label, "mm", 1e3, 0, round(min(300.0, 1e3 * deepest_bore(cue)), 1), 1)


def _taper(cue: Cue) -> Slider:
    label = f"Taper, at {1e3 * taper_position(cue):.0f} mm"
    return Slider("taper_diameter", label, "mm", 1e3, 8, 20, 0.05)


def _joint(cue: Cue) -> Slider:
    return Slider("joint_position", "Joint at", "mm", 1e3, 20, round(1e3 * cue.length - 10), 1)


_SLIDERS: dict[str, Callable[[Cue], Slider]] = {
    "tip_diameter": lambda cue: Slider("tip_diameter", "Tip diameter", "mm", 1e3, 8, 15, 0.05),
    "taper_diameter": _taper,
    "butt_diameter": lambda cue: Slider("butt_diameter", "Taper, at the end", "mm", 1e3, 12, 34, 0.1),
    "bore_depth": _bore,
    "bore_width": lambda cue: Slider("bore_width", "Bore width", "mm", 1e3, 1, 11, 0.1),
    "ferrule_length": lambda cue: Slider("ferrule_length", "Ferrule length", "mm", 1e3, 2, 40, 0.5),
    "joint_compliance": lambda cue: Slider("joint_compliance", "Joint bends", "mrad/(N m)", 1e3, 0, 5, 0.05),
    "joint_position": _joint,
    "contact_time": lambda cue: Slider("contact_time", "Contact time (hard–soft tip)", "ms", 1e3, 0.6, 3, 0.01),
    "offset": lambda cue: Slider("offset", "Offset b/R", "", 1.0, 0, 0.6, 0.01),
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
