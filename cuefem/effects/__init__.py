"""Opt-in physics: an effect is a frozen dataclass that adds its term; a scene that lists none pays nothing.

Every effect adds to what is there and overwrites nothing, so their order does not matter. Each docstring says what the
effect adds, when it matters, when it is wrong, and where it comes from.
"""

from cuefem.effects.at_tip import PowerLawTip, RollingContact, TipDome, TipShear
from cuefem.effects.base import CueEffect, Effect, TipEffect, Vibrations, acting_on_cue, check_effects
from cuefem.effects.on_cue import AxialWaves, Joint, PointMass, StructuralDamping, Support
from cuefem.effects.stroke import Elevation, SecondHit

__all__ = [
    "AxialWaves",
    "CueEffect",
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
    "TipEffect",
    "TipShear",
    "Vibrations",
    "acting_on_cue",
    "check_effects",
]
