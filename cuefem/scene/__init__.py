"""Scenes, default scenes of games, resolutions and outcomes."""

from cuefem.scene.scene import (
    DEFAULT_CONTACT_TIME,
    MOST_STEPS,
    Ball,
    Outcome,
    Resolution,
    Scene,
    Stroke,
    Tip,
    equal_fields,
    several,
)

__all__ = [
    "DEFAULT_CONTACT_TIME",
    "MOST_STEPS",
    "Ball",
    "Outcome",
    "Resolution",
    "Scene",
    "Stroke",
    "Tip",
    "equal_fields",
    "several",
]
