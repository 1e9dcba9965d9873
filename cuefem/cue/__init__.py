"""Finite-element cues and their geometry, lumped cues, and the table of materials."""

from cuefem.cue.geometry import (
    SOFT,
    Array,
    Cue,
    LumpedCue,
    Material,
    Section,
    Segment,
    SegmentRows,
    section_properties,
    shear_coefficient,
)

__all__ = [
    "SOFT",
    "Array",
    "Cue",
    "LumpedCue",
    "Material",
    "Section",
    "Segment",
    "SegmentRows",
    "section_properties",
    "shear_coefficient",
]
