"""The families of random scenes on which the errors that `resolve` promises are measured. Not a study itself.

Cues of one to six segments (woods, carbon tubes, bores, ferrules, soft leather at the tip; with a body mass or
without), balls, tips (restitution 0 to 1, friction up to endless, contact times of 0.3 to 4 ms), offsets, and every
effect, drawn from a fixed seed: scene number k is the same whatever else is drawn. The estimates of `resolve` were made
on the first family and mended once on the second; the third, drawn in the same way from a seed of its own after that,
checks that they were not fitted to the others.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from cuefem import (
    AxialWaves,
    Ball,
    Cue,
    Effect,
    Elevation,
    Joint,
    Material,
    PointMass,
    PowerLawTip,
    RollingContact,
    Scene,
    SecondHit,
    Segment,
    Stroke,
    StructuralDamping,
    Support,
    Tip,
    TipDome,
    TipShear,
)
from cuefem.beam.modes import solve
from cuefem.beam.system import assemble
from cuefem.beam.tail import tail
from cuefem.beam.tip import TipModes
from cuefem.beam.waves import mesh_for
from cuefem.tip_modes import tip_modes_from, turning

# Seed and number of scenes of each family; their scenes are numbered on from one to the next.
FAMILIES = ((20250, 160), (77001, 60), (31337, 60))
SCENES = sum(scenes for _, scenes in FAMILIES)


def family_of(number: int) -> int:
    """Index of the family that a scene belongs to."""
    firsts = np.cumsum([scenes for _, scenes in FAMILIES])
    return int(np.searchsorted(firsts, number, side="right"))


def scene(number: int) -> Scene:
    """Scene ``number``, of whichever family has it."""
    rng = np.random.default_rng((FAMILIES[family_of(number)][0], number))
    cue, ball = _cue(rng), Ball(rng.uniform(0.14, 0.22), rng.uniform(0.025, 0.032), rng.uniform(0.3, 0.5))
    restitution = float(
        rng.choice([0.0, 1.0, rng.uniform(0.05, 0.95), rng.uniform(0.6, 0.9)], p=[0.07, 0.07, 0.3, 0.56])
    )
    friction = float(rng.choice([math.inf, 0.0, rng.uniform(0.1, 1.5)], p=[0.15, 0.03, 0.82]))
    tip = Tip(restitution, friction, contact_time=float(np.exp(rng.uniform(math.log(3e-4), math.log(4e-3)))))
    stroke = Stroke(float(np.exp(rng.uniform(math.log(0.3), math.log(6)))), float(rng.uniform(-0.6, 0.6)))
    return Scene(cue, ball, tip, stroke, _effects(rng, cue, restitution))


def _cue(rng: np.random.Generator) -> Cue:
    """A shaft from its tip to its butt; a body mass stands for the rest of the cue where it is short."""
    tip, butt, length = rng.uniform(0.010, 0.014), rng.uniform(0.018, 0.030), rng.uniform(0.6, 1.5)
    pieces: list[Segment] = []
    if rng.random() < 0.5:
        leather = Material(E := 10 ** rng.uniform(7.5, 8.7), E / 3, rng.uniform(850, 1050))
        pieces.append(Segment(rng.uniform(0.004, 0.010), tip, tip, leather))
    if rng.random() < 0.5:
        stuff = Material(*[(3e9, 1.1e9, 1200.0), (105e9, 39e9, 8500.0), (15e9, 5e9, 1800.0)][rng.integers(3)])
        bore = rng.choice([0.0, rng.uniform(0.3, 0.7) * tip])
        pieces.append(Segment(rng.uniform(0.006, 0.03), tip, tip, stuff, bore, bore))
    carbon = rng.random() < 0.25
    ends = np.sort(np.append(rng.uniform(0.15, 0.85, rng.integers(0, 4)), [0.0, 1.0]))
    widths = tip + (butt - tip) * ends ** rng.uniform(0.6, 1.8)
    for i in range(len(ends) - 1):
        first, last = float(widths[i]), float(widths[i + 1])
        if carbon:
            material = Material(rng.uniform(40e9, 90e9), rng.uniform(8e9, 25e9), rng.uniform(1500, 1650))
            hollow = rng.uniform(0.6, 0.85)
        else:
            E = rng.uniform(8e9, 18e9)
            material = Material(E, E / rng.uniform(10, 20), rng.uniform(550, 950), float(rng.uniform(0.005, 0.02)))
            hollow = rng.uniform(0.3, 0.7) if i == 0 and rng.random() < 0.25 else 0.0
        pieces.append(
            Segment(float((ends[i + 1] - ends[i]) * length), first, last, material, hollow * first, hollow * last)
        )
    return Cue(
        tuple(pieces), float(rng.choice([0.0, rng.uniform(0.1, 0.45)])) if length > 1 else rng.uniform(0.2, 0.45)
    )


def _effects(rng: np.random.Generator, cue: Cue, restitution: float) -> tuple[Effect, ...]:
    """Each effect with a chance of its own; what does not go with others is left out."""
    L = cue.length
    chosen: list[Effect] = []
    if rng.random() < 0.25:
        chosen.append(PointMass(rng.uniform(0, 0.5) * L, 10 ** rng.uniform(-3, -1), float(rng.choice([0.0, 1e-6]))))
    if rng.random() < 0.25:
        stiff = float(rng.choice([math.inf, 10 ** rng.uniform(3, 6)], p=[0.2, 0.8]))
        chosen.append(Support(rng.uniform(0.1, 0.9) * L, stiff, float(rng.choice([0, 100.0])), rng.uniform(0, 20)))
    if rng.random() < 0.2:
        chosen.append(Joint(rng.uniform(0.3, 0.7) * L, 10 ** rng.uniform(-6, -3), float(rng.choice([0.0, 1e-8]))))
    if rng.random() < 0.25:
        chosen.append(StructuralDamping(None if rng.random() < 0.5 else rng.uniform(0.005, 0.05)))
    if rng.random() < 0.25:
        chosen.append(AxialWaves())
    if rng.random() < 0.5:
        chosen.append(TipDome(rng.uniform(0.003, 0.012)))
    if rng.random() < 0.04:
        chosen.append(PowerLawTip(rng.uniform(1, 2), rng.uniform(0.5, 3)))
    if restitution > 0 and rng.random() < 0.04:
        return (*chosen, Elevation(rng.uniform(0.02, 0.6), rng.uniform(0.1, 0.4)))
    if rng.random() < 0.3:
        chosen.append(TipShear(rng.uniform(0.3, 2)))
    if rng.random() < 0.04:
        chosen.append(RollingContact())
    if restitution > 0 and rng.random() < 0.15:
        chosen.append(SecondHit(10 ** rng.uniform(-3, -2)))
    return tuple(chosen)


@functools.lru_cache(maxsize=4)
def reference(struck: Scene, modes: int) -> TipModes:
    """Tip modes of the scene from many modes with their tail, on a mesh of one element more and two orders less."""
    elements, order = mesh_for(struck.cue, modes)
    more = elements + 1 if isinstance(elements, int) else tuple(count + 1 for count in elements)
    system = assemble(struck.cue, elements=more, order=order - 2, effects=struck.cue_effects)
    return tip_modes_from(tail(solve(system, modes), turning=turning(struck)), struck)
