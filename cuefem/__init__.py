"""From a cue shaft's drawing to its effective end mass and squirt.

The public names are loaded when they are first used (PEP 562), so that `import cuefem` costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cuefem.accuracy import resolve, resolve_end_mass
    from cuefem.beam.modes import modes
    from cuefem.contact.motion import motion
    from cuefem.contact.place import Placed, place
    from cuefem.contact.strike import strike
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
    from cuefem.endmass.drives import end_mass
    from cuefem.endmass.lumped import impulse, lump
    from cuefem.io import load, save
    from cuefem.scene import Ball, Outcome, Resolution, Scene, Stroke, Tip

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
    "endmass.drives": ["end_mass"],
    "endmass.lumped": ["impulse", "lump"],
    "io": ["load", "save"],
    "beam.modes": ["modes"],
    "contact.motion": ["motion"],
    "contact.place": ["Placed", "place"],
    "scene": ["Ball", "Outcome", "Resolution", "Scene", "Stroke", "Tip"],
    "contact.strike": ["strike"],
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
