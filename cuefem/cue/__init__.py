"""Cues as they are drawn, lumped cues, and the materials that a file may name."""

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
