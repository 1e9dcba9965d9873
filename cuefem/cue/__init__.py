"""Finite-element cues and their geometry, lumped cues, and the table of materials."""

from cuefem.cue.geometry import (
    MAX_LEATHER_MODULUS,
    POSITION_TOLERANCE,
    Array,
    Cue,
    LumpedCue,
    Material,
    Section,
    Segment,
)

__all__ = ["MAX_LEATHER_MODULUS", "POSITION_TOLERANCE", "Array", "Cue", "LumpedCue", "Material", "Section", "Segment"]
