"""What is struck, how, and with what result: scenes, their default for a game, resolutions and outcomes."""

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
