"""Optional physics: an effect is a frozen dataclass that adds its terms; effects that a scene omits cost nothing.

Effects add terms and overwrite none, so their order does not matter. Each docstring has five notes: what the effect
adds, when it matters, when it is wrong, the limit in which it vanishes, and its source.
"""

from cuefem.effects import cue_effects, leather_tip, stroke_effects, tip_effects

__all__ = ["cue_effects", "leather_tip", "stroke_effects", "tip_effects"]  # loaded for `effect_kinds`
