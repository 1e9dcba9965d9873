"""Changes together on random shafts: limits hold, no wood is added, a triple beats its pair, numbers are strikes."""

import math
import random

import numpy as np
import pytest

import cuefem as cf
from cuefem.analysis.design_changes import TRIPLE_GAIN, DesignChanges
from cuefem.analysis.shop_changes import SHOP, Limits, changes_of
from cuefem.files.shaft_additions import with_additions
from cuefem.parameters.parts import outer_diameter
from cuefem.quantity.display_units import displayed_in, inch_fraction

INCH = 0.0254
LIMITS = Limits(wall=0.003, keep=("ferrule",), stiffness_loss=0.02)


def random_scene(seed: int) -> cf.Scene:
    """A turned pool shaft with a ferrule, some bored."""
    draw = random.Random(seed)
    wood = cf.material(draw.choice(["hard maple", "ash", "hornbeam"]))
    tip, gain, end = (draw.uniform(*ends) * INCH for ends in ((0.45, 0.54), (0.0, 0.03), (0.80, 0.87)))
    at = draw.uniform(9, 16) * INCH
    cone = cf.Segment(at, tip, tip + gain, wood), cf.Segment(29 * INCH - at, tip + gain, end, wood)
    ferrule = f"{draw.choice((0.5, 0.75, 1.0))} in {draw.choice(('melamine', 'brass', 'juma'))}"
    bore = f"3/16 in wide, {draw.uniform(3, 6):.1f} in deep" if draw.random() < 0.3 else None
    return cf.usual_scene(with_additions(cf.Cue(cone, body_mass=0.43), ferrule=ferrule, bore=bore))


def thinnest(scene: cf.Scene) -> float:
    """Least wall of what is empty, m."""
    empty = (s for s in scene.shaft.segments if s.core is None)
    return min(min(s.tip_diameter - s.tip_bore, s.butt_diameter - s.butt_bore) / 2 for s in empty)


def assert_within(scene: cf.Scene, made: DesignChanges, limits: Limits) -> None:
    """Every combination: squirt of a strike, walls, stiffness, and no diameter above that of the shaft."""
    xs = np.linspace(0, scene.shaft.length, 200)
    for row in made.together:
        changed = cf.with_parameters(scene, row.values)
        assert row.squirt == pytest.approx(cf.strike(changed).squirt, rel=1e-9)
        assert thinnest(changed) >= (1 - 1e-9) * min(limits.least_wall(changed), thinnest(scene))
        assert row.tip_stiffness_change >= -limits.stiffness_loss
        assert all(outer_diameter(changed.shaft, x) <= outer_diameter(scene.shaft, x) + 1e-9 for x in xs)
    pairs_and_triple = [row.squirt_change for row in made.together]
    assert pairs_and_triple == sorted(pairs_and_triple, reverse=True)
    if len(pairs_and_triple) == 2:
        assert pairs_and_triple[1] <= pairs_and_triple[0] - TRIPLE_GAIN


@pytest.mark.parametrize("seed", [pytest.param(k, marks=pytest.mark.nightly) for k in range(40)])
def test_changes_together_keep_the_limits_and_add_no_wood(seed: int) -> None:
    scene = random_scene(seed)
    for limits in (Limits(), LIMITS):
        with displayed_in("us" if seed % 2 else "metric"):
            made = cf.design_changes(scene, limits=limits)
        assert_within(scene, made, limits)
        kept = {change.label for change in changes_of(scene) if change.part in limits.keep}
        assert not kept & {row.change for row in made.changes}


def test_bores_are_of_drills_that_a_shop_has() -> None:
    """A wider bore of 3/16 in or 5 mm is the next size of the drill set, in 1/64 in or 0.5 mm."""
    for system, width in (("us", 3 / 16 * INCH), ("metric", 5.1e-3)):
        scene = cf.with_parameters(random_scene(1), {"bore width": width, "bore depth": 0.1})
        with displayed_in(system):
            (wider,) = (change for change in changes_of(scene) if change.label.startswith("bore wider"))
        steps = wider.values["bore width"] / SHOP[system].drill_step
        assert steps == pytest.approx(round(steps), abs=1e-9)
        assert wider.values["bore width"] > width
    assert inch_fraction(15 / 64 * INCH) == "15/64"
    assert math.isclose(SHOP["us"].new_bore, INCH / 4)
