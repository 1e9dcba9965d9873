"""Optional physics: an effect is a frozen dataclass that adds its terms; effects that a scene omits cost nothing.

Effects add terms and overwrite none, so their order does not matter. Each docstring has five notes: what the effect
adds, when it matters, when it is wrong, the limit in which it vanishes, and its source.
"""

from cuefem.effects.cue_effects import AxialWaves, GeometricStiffness, Joint, PointMass, StructuralDamping, Support
from cuefem.effects.effect import (
    CueEffect,
    Effect,
    TipEffect,
    TrialValues,
    acting_on_cue,
    check_effects,
    effect_kinds,
)
from cuefem.effects.leather_tip import LeatherTip, TipLayer
from cuefem.effects.stroke_effects import Elevation, SecondHit
from cuefem.effects.tip_effects import PowerLawTip, RollingContact, TipDome, TipShear

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
    "TrialValues",
    "acting_on_cue",
    "check_effects",
    "effect_kinds",
]
