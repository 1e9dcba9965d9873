"""Where to pivot a cue about so that its squirt cancels."""

from __future__ import annotations

from typing import Any

import numpy as np

from cuefem.scene import Scene
from cuefem.squirt import natural_pivot_length


def pivot_length(scene: Scene, squirt: Any) -> Any:
    """The natural pivot length of a squirt, m; None for a head-on stroke, which has none."""
    if not np.all(scene.stroke.offset):
        return None
    return pivot_at(scene, scene.stroke.offset, squirt)


def pivot_at(scene: Scene, offset: Any, squirt: Any) -> Any:
    """The same at another offset b/R than the scene's own."""
    return natural_pivot_length(offset, squirt, radius=scene.ball.radius, dome_radius=scene.dome_radius)
