"""Optional physics: an effect is a frozen dataclass that adds its terms; effects that a scene omits cost nothing.

Effects add terms and overwrite none, so their order does not matter. Each docstring has five notes: what the effect
adds, when it matters, when it is wrong, the limit in which it vanishes, and its source.
"""

from cuefem.effects.at_tip import PowerLawTip, RollingContact, TipDome, TipShear
from cuefem.effects.base import (
    CueEffect,
    Effect,
    TipEffect,
    Usual,
    acting_on_cue,
    check_effects,
    effect_kinds,
)
from cuefem.effects.leather_tip import LeatherTip, TipLayer
from cuefem.effects.on_cue import AxialWaves, GeometricStiffness, Joint, PointMass, StructuralDamping, Support
from cuefem.effects.stroke import Elevation, SecondHit

__all__ = [
    "AxialWaves",
    "CueEffect",
    "Effect",
    "Elevation",
    "GeometricStiffness",
    "Joint",
    "LeatherTip",
    "PointMass",
    "PowerLawTip",
    "RollingContact",
    "SecondHit",
    "StructuralDamping",
    "Support",
    "TipDome",
    "TipEffect",
    "TipLayer",
    "TipShear",
    "Usual",
    "acting_on_cue",
    "check_effects",
    "effect_kinds",
]
