"""Forty scenes on which the error estimates of `strike(scene, rtol=...)` are tested; no tests."""

from __future__ import annotations

import cuefem as cf
from cuefem.effects.effect import Effect
from studies.strokes import DOME, NAMES, SHEAR, cue

WAVES = cf.AxialWaves()
BRIDGE, CLAY = cf.Support(0.2, stiffness=1e4, dashpot=5.0), cf.PointMass(position=0.1, mass=0.011)

# (contact time in s, offset, restitution, friction) of the cues without effects; each cue takes six of these eight.
STROKES = (
    (1e-3, 0.3, 0.75, 0.7),
    (2e-3, 0.1, 0.75, 0.7),
    (1e-3, 0.5, 0.75, 0.7),
    (0.7e-3, 0.2, 0.9, 0.6),
    (1.5e-3, -0.4, 0.6, 0.6),
    (3e-3, 0.35, 0.05, 0.7),
    (1e-3, 0.02, 1.0, 0.3),
    (1.2e-3, 0.45, 0.75, 0.3),
)
# (cue, contact time, offset, effects)
WITH_EFFECTS: tuple[tuple[str, float, float, tuple[Effect, ...]], ...] = (
    ("kim", 1e-3, 0.3, (DOME,)),
    ("pool_maple", 1e-3, 0.4, (DOME,)),
    ("pool_maple", 1.2e-3, 0.375, (DOME, SHEAR)),
    ("pool_hollow", 1e-3, 0.4, (DOME, SHEAR)),
    ("carbon", 1e-3, 0.2, (SHEAR,)),
    ("whole_cue", 1e-3, 0.3, (BRIDGE, cf.StructuralDamping(0.012))),
    ("kim", 1e-3, 0.4, (CLAY, BRIDGE)),
    ("pool_hollow", 1.5e-3, 0.3, (DOME, CLAY)),
    ("kim", 1e-3, 0.3, (WAVES,)),
    ("whole_cue", 1e-3, 0.35, (DOME, SHEAR, cf.Joint(0.74, 1e-4, 1e-8), cf.StructuralDamping())),
)


def scene(
    name: str,
    contact_time: float,
    offset: float,
    restitution: float = 0.75,
    friction: float = 0.7,
    *,
    effects: tuple[Effect, ...] = (),
) -> cf.Scene:
    tip = cf.Tip(restitution, friction, contact_time=contact_time)
    return cf.Scene(cue(name), cf.Ball(), tip, cf.Stroke(1.0, offset), effects)


def bare_scenes() -> list[cf.Scene]:
    """Six strokes a cue, shifted from cue to cue."""
    return [scene(name, *STROKES[(i + 3 * j) % len(STROKES)]) for j, name in enumerate(NAMES) for i in range(6)]


def family() -> list[cf.Scene]:
    return bare_scenes() + [scene(name, T, b, effects=effects) for name, T, b, effects in WITH_EFFECTS]
