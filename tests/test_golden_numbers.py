"""Numbers of beams, end masses, side strikes, lumped cues and solids against a golden file (regression).

1e-9 is the round-off error of eigenvalues; `--update` writes them. Each comes from a room's public door.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from unittest import mock

import numpy as np
import pytest

import cuefem as cf
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.files.cue_names import CUES
from cuefem.files.reference_cues import named_scene
from cuefem.parameters.table import PARAMETERS
from cuefem.solid import tip_compliance as tc
from cuefem.solid.tip_table import UntabulatedTip
from tests.contact.test_independent_effects import KINDS, RandomScene
from tests.helpers.golden_numbers import assert_golden_numbers
from tests.helpers.strike_scenes import KIM, KIM_AT, kim_scene


def effect_scenes() -> list[cf.Scene]:
    """Bored cues with supports, joints, masses and losses."""
    return [KINDS[kind].make(RandomScene(seed)) for kind in ("Support", "all on the cue") for seed in range(3)]


def beams() -> dict[str, float]:
    """Frequencies, mode shapes, and the modes next to a frequency."""
    total = {}
    for number, scene in enumerate((*effect_scenes(), cf.Scene(KIM))):
        effects = tuple(one for one in scene.effects if isinstance(one, cf.Support | cf.Joint | cf.PointMass))
        found, near = cf.modes(scene.cue, 6, effects=effects), cf.modes(scene.cue, 2, effects=effects, near=900.0)
        deflection, rotation = found.shape(np.array([0.0, 0.1, 0.6]))
        total |= {
            f"{number}, frequencies": found.frequencies.sum(),
            f"{number}, deflection": np.abs(deflection).sum(),
            f"{number}, rotation": np.abs(rotation).sum(),
            f"{number}, near": near.frequencies.sum(),
        }
    return total


def end_masses() -> dict[str, float]:
    """By every definition: of few modes, of the default ones, and refined."""
    bent = replace(kim_scene(), effects=(cf.AxialWaves(), cf.GeometricStiffness()))
    lossy = replace(kim_scene(), effects=(cf.StructuralDamping(0.2),))
    of_every_drive = [*((kim_scene(), drive) for drive in DEFINITIONS), (bent, "stick"), (lossy, "force")]
    of_beams = [(scene, drive) for scene in effect_scenes()[2:5] for drive in ("stick", "velocity", "force")]
    total = {
        f"{number}, {drive}": cf.end_mass(scene, drive, KIM_AT)
        for number, (scene, drive) in enumerate(of_every_drive + of_beams)
    }
    total |= {f"default, {drive}": cf.end_mass(kim_scene(), drive) for drive in ("stick", "velocity")}
    return total | {"refined": cf.end_mass(kim_scene(), rtol=1e-2)}


def refined_strikes() -> dict[str, float]:
    """Squirt, estimated error and number of unknowns."""
    total = {}
    for number, effects in enumerate(((), (cf.AxialWaves(),), (cf.TipDome(0.0106),))):
        outcome = cf.strike(replace(kim_scene(), effects=effects), rtol=3e-3)
        total |= {f"{number}, {name}": getattr(outcome, name) for name in ("squirt", "error", "unknowns")}
    return total


def side_strikes() -> dict[str, float]:
    """Strikers with each law, on a cue with effects, on either side of its middle, and with a second hit."""
    on_cue = cf.PointMass(position=0.1, mass=2e-3), cf.Support(0.5, 1e4, 3.0), cf.StructuralDamping(0.02)
    strikers = (
        cf.Striker(0.05, 0.8, contact_time=1e-3),
        cf.Striker(0.01, 0.1, stiffness=1e5),
        cf.Striker(0.02, 0.6, modulus=1e8, radius=0.02),
    )
    total = {}
    for number, striker in enumerate(strikers):
        scene = cf.SideStrike(KIM, striker, 0.25 * number, 1.7, (*on_cue, cf.SecondHit(8e-3)))
        outcome = cf.side_strike(scene, KIM_AT)
        total |= {f"{number}, {name}": getattr(scene, name) for name in ("rigid_mass", "contact_time", "window")}
        total |= {
            f"{number}, {name}": getattr(outcome, name)
            for name in ("rebound_speed", "impulse", "duration", "effective_mass", "contact_point_speed")
        }
        total |= {f"{number}, {name}": joules for name, joules in outcome.energy.items()}
    return total


def lumped_cues() -> dict[str, float]:
    """The lumped numbers of cues, and impulse solver's strikes from stick to miscue."""
    total = {}
    for number, scene in enumerate((kim_scene(), replace(kim_scene(), effects=(cf.TipDome(0.0106),)))):
        cue = cf.lump(scene, KIM_AT)
        total |= {f"{number}, {name}": getattr(cue, name) for name in ("mass", "end_mass", "coupling")}
        for friction in (0.1, 0.3, 0.7, math.inf):
            for offset in (0.2, -0.5, 0.8):
                outcome = cf.impulse(cf.Scene(cue, tip=cf.Tip(0.8, friction), stroke=cf.Stroke(2.0, offset)))
                total |= {
                    f"{number}, {friction}, {offset}, {name}": float(getattr(outcome, name))
                    for name in ("squirt", "ball_speed", "spin", "cue_speed", "jam")
                }
    return total


def leather_tips() -> dict[str, float]:
    """Contacts of a patch on the dome and across its rim, and a small table of a tip with a layer."""
    fineness = tc.graded_fineness(2, 2, 2, 20)
    shape = tc.Shape(0.6, 1.3, ((0.1, 3.0, 0.3),))
    surfaces = tc.surface_compliances(tc.TipSolid(shape, fineness), 0.4)
    total = {}
    for number, (position, radius) in enumerate(((0.0, 0.2), (0.4, 0.15), (0.8, 0.3))):
        found = tc.compliance(surfaces, tc.patch_loads(shape, tc.Patch(position, radius), fineness))
        total |= {f"patch {number}, {entry}": value for entry, value in enumerate(found.ravel())}
    coarse = partial(tc.contact_fineness, order=2)
    with mock.patch.multiple(
        tc, N_POSITIONS=2, N_RADII=2, N_HEAD_ON=2, TABLE_FINENESS=fineness, contact_fineness=coarse
    ):
        tc.table_loads.cache_clear()
        found_table = tc.compute_tip_table(UntabulatedTip(0.5, 1.1, 0.35, ((0.1, 3.0, 0.3),)))
    tc.table_loads.cache_clear()
    for name in ("patches", "head_on"):
        total |= {f"{name}, {entry}": value for entry, value in enumerate(getattr(found_table, name).ravel())}
    return total


def changed_scenes() -> dict[str, float]:
    """Sections of reference cues, and of one with all kinds of parts, after a change of each parameter of a cue."""
    wood, plastic, foam = map(cf.material, ("hard maple", "melamine", "foam"))
    parts = (
        cf.Segment(0.004, 0.0126, 0.0127, plastic, 0.008, 0.008, core=wood),
        cf.Segment(0.016, 0.0127, 0.0128, plastic, 0.008, 0.008, core=foam),
        cf.Segment(0.3, 0.0128, 0.0145, wood, 0.008, 0.006),
        cf.Segment(0.42, 0.0145, 0.0215, wood),
    )
    scenes = [cf.usual_scene(cf.Cue(parts, 0.43)), *map(named_scene, CUES)]
    total = Counter[str]()
    for key, known in PARAMETERS.items():
        for number, scene in enumerate(scenes, 1):
            value = "ash" if known.materials else known.value(scene)
            for changed in (value,) if isinstance(value, str) else (value * 0.98, value * 1.01) if value else ():
                try:
                    cue = cf.with_parameters(scene, {known.name: changed}).shaft
                except ValueError:
                    total[f"{key}, refused"] += number
                    continue
                if cue != scene.shaft:
                    total[key] += number * (sections_sum(cue) - sections_sum(scene.shaft))
    return total


def sections_sum(cue: cf.Cue) -> float:
    """A number that every size and material of a cue changes."""
    sections = np.log(cue.section(cue.length * np.linspace(0.001, 0.999, 30)))
    return float(np.arange(1, 31) @ sections.sum(axis=0) + cue.mass)


def solids() -> dict[str, float]:
    """A stub of two pieces, bored and capped, and its parts."""
    wood = cf.Material(E=12.6e9, G=1.1e9, rho=700.0, nu=0.45, transverse_ratio=0.0985, nu_transverse=0.52)
    front = cf.Segment(0.02, 0.012, 0.012, wood, 0.004, 0.004)
    found = cf.solid_modes(cf.Cue((front, cf.Segment(0.05, 0.012, 0.014, wood)), body_mass=0.1), 2, cf.Solid(order=2))
    motion, rotation = found.at_tip
    return {
        "frequencies": found.frequencies.sum(),
        "deflection": np.abs(motion[2:]).sum(),
        "rotation": np.abs(rotation[2:]).sum(),
    }


@pytest.mark.parametrize(
    "numbers",
    [beams, end_masses, refined_strikes, side_strikes, lumped_cues, leather_tips, changed_scenes, solids],
)
def test_numbers_equal_golden_file(numbers: Callable[[], dict[str, float]], request: pytest.FixtureRequest) -> None:
    now = {name: float(value) for name, value in numbers().items()}
    assert_golden_numbers(numbers.__name__, now, request, 1e-7 if numbers is solids else 1e-8)
