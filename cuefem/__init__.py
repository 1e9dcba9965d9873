"""From a cue shaft's drawing to its effective end mass and squirt.

The public names are loaded when they are first used (PEP 562), so that `import cuefem` costs next to nothing.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cuefem.accuracy import resolve, resolve_end_mass
    from cuefem.cue import Cue, LumpedCue, Material, Segment
    from cuefem.effects import (
        AxialWaves,
        Effect,
        Elevation,
        Joint,
        PointMass,
        PowerLawTip,
        RollingContact,
        SecondHit,
        StructuralDamping,
        Support,
        TipDome,
        TipShear,
    )
    from cuefem.endmass import end_mass, lump
    from cuefem.impulse import impulse
    from cuefem.io import load, save
    from cuefem.modes import modes
    from cuefem.motion import motion
    from cuefem.place import Placed, place
    from cuefem.scene import Ball, Outcome, Resolution, Scene, Stroke, Tip
    from cuefem.strike import strike

__version__ = "0.1.0"

_HOMES = {
    "accuracy": ["resolve", "resolve_end_mass"],
    "cue": ["Cue", "LumpedCue", "Material", "Segment"],
    "effects": [
        "AxialWaves",
        "Effect",
        "Elevation",
        "Joint",
        "PointMass",
        "PowerLawTip",
        "RollingContact",
        "SecondHit",
        "StructuralDamping",
        "Support",
        "TipDome",
        "TipShear",
    ],
    "endmass": ["end_mass", "lump"],
    "impulse": ["impulse"],
    "io": ["load", "save"],
    "modes": ["modes"],
    "motion": ["motion"],
    "place": ["Placed", "place"],
    "scene": ["Ball", "Outcome", "Resolution", "Scene", "Stroke", "Tip"],
    "strike": ["strike"],
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "AxialWaves",
    "Ball",
    "Cue",
    "Effect",
    "Elevation",
    "Joint",
    "LumpedCue",
    "Material",
    "Outcome",
    "Placed",
    "PointMass",
    "PowerLawTip",
    "Resolution",
    "RollingContact",
    "Scene",
    "SecondHit",
    "Segment",
    "Stroke",
    "StructuralDamping",
    "Support",
    "Tip",
    "TipDome",
    "TipShear",
    "end_mass",
    "impulse",
    "load",
    "lump",
    "modes",
    "motion",
    "place",
    "resolve",
    "resolve_end_mass",
    "save",
    "strike",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOME])


class _Package(ModuleType):
    """Keeps `cuefem.modes` the function: importing the file modes.py would otherwise bind the module to that name."""

    def __setattr__(self, name: str, value: Any) -> None:
        if isinstance(value, ModuleType) and _HOME.get(name) == name:
            value = getattr(value, name)
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
