"""Scenes, default scenes of games, resolutions and outcomes."""

from cuefem.beam.mesh import Resolution
from cuefem.scene.scene import (
    DEFAULT_CONTACT_TIME,
    Assumed,
    Ball,
    Outcome,
    Outcomes,
    Scene,
    Stroke,
    Tip,
    as_scenes,
    check_scene,
)

__all__ = [
    "DEFAULT_CONTACT_TIME",
    "Assumed",
    "Ball",
    "Outcome",
    "Outcomes",
    "Resolution",
    "Scene",
    "Stroke",
    "Tip",
    "as_scenes",
    "check_scene",
]
