"""The smallest change to the squirt of another cue: found rows are strikes within the limits, on random shafts."""

import math
import random

import pytest

import cuefem as cf
from cuefem.analysis.design_changes import Trial, are_compatible, joined
from cuefem.analysis.plays_like import SAME, PlaysLike, _ChangedShaft, _ShaftSearch
from cuefem.analysis.shop_changes import DesignChange, Dimension, Limits, dimensions_of
from tests.designs.test_changes_together import LIMITS, assert_within, random_scene

MAPLE = cf.Cue((cf.Segment(0.7, 0.01275, 0.021, cf.material("hard maple")),), body_mass=0.43)
SCENE = cf.Scene(MAPLE, cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.6, 1e-3), cf.Stroke(2.0, 0.3))


def with_squirt(scene: cf.Scene, factor: float) -> cf.Scene:
    """A cue whose squirt is about that of the scene times a factor: a slim or a wide one."""
    diameter = scene.shaft.segments[0].tip_diameter
    return cf.with_parameters(scene, {"tip diameter": diameter * factor**0.7})


def assert_rows_are_strikes(scene: cf.Scene, found: PlaysLike, limits: Limits) -> None:
    """Each row: the squirt of its strike, that of the other cue if it is reached, and the limits."""
    for row in found.changes:
        changed = cf.with_parameters(scene, row.values)
        assert row.squirt == pytest.approx(cf.strike(changed).squirt, rel=1e-9)
        assert not found.is_reached or abs(row.squirt / found.target - 1) < 1.01 * SAME
    assert_within(scene, found, limits)


@pytest.mark.heavy
def test_bored_shaft_is_found_again_from_the_solid_one() -> None:
    """A bore of a drill of the shop, 6.5 mm by 90 mm, is among the changes to the millimetre."""
    bored = cf.with_parameters(SCENE, {"bore depth": 0.090, "bore width": 0.0065})
    found = cf.plays_like(SCENE, bored, limits=Limits(keep=("taper",)))
    assert found.is_reached
    assert_rows_are_strikes(SCENE, found, Limits())
    bores = [(1e3 * row.values["bore width"], 1e3 * row.values["bore depth"]) for row in found.changes]
    assert (6.5, 90.0) in [(round(width, 6), pytest.approx(depth, abs=1.1)) for width, depth in bores]
    assert found.difference is not None
    assert not found.difference["distinct"]


@pytest.mark.heavy
def test_shaft_that_plays_alike_needs_no_change_and_a_far_one_has_a_nearest() -> None:
    same = cf.plays_like(SCENE, SCENE)
    assert (same.is_reached, same.changes) == (True, [])
    far = cf.plays_like(SCENE, with_squirt(SCENE, 0.4), limits=Limits(keep=("taper", "ferrule")))
    assert not far.is_reached
    (nearest,) = far.changes
    assert far.target < nearest.squirt < far.unmodified["squirt"]
    assert "no change within the limits reaches the squirt of the other cue" in str(far)


def test_three_changes_at_most_are_combined_from_the_two_nearest() -> None:
    """Made-up dimensions a to d, which reduce the logarithm of squirt by 0.1 to 0.4, that of the other cue by 2."""

    class Reducing(_ShaftSearch):
        def __init__(self) -> None:
            self.own_gap, self.tried = 2.0, list[str]()

        def end(self, base: _ChangedShaft | None, dimension: Dimension) -> _ChangedShaft | None:
            group = [*([base.change] if base else []), dimension.change(0.0)]
            if not are_compatible(group):
                return None
            change = joined(group)
            self.tried.append(change.label)
            return _ChangedShaft(change, {}, 2.0 - math.fsum(change.values.values()))

    names = ("ferrule material", *"abcd")  # another material is a base, too, since it has no size
    changes = [DesignChange(name, {name: 0.1 * k}, (), "") for k, name in enumerate(names)]
    search = Reducing()
    (nearest,) = search.run([Dimension(lambda _, change=change: change, 0.0, 0.0, 1.0) for change in changes], list)
    assert {*nearest.change.values} == {"b", "c", "d"}
    assert {label.partition(" + ")[0] for label in search.tried if "+" in label} == {"ferrule material", "c", "d"}


@pytest.mark.parametrize("seed", [pytest.param(k, marks=pytest.mark.nightly) for k in range(20)])
def test_changes_to_a_squirt_are_strikes_within_the_limits(seed: int) -> None:
    scene, draw = random_scene(seed), random.Random(seed)
    for limits in (Limits(), LIMITS):
        found = cf.plays_like(scene, with_squirt(scene, draw.uniform(0.75, 1.15)), limits=limits)
        assert_rows_are_strikes(scene, found, limits)
        if not found.is_reached:
            trial, nearest = Trial.of(scene, limits), abs(found.changes[0].squirt - found.target)
            alone = [
                each.change(each.size(k)) for each in dimensions_of(scene) for k in (0, each.steps // 2, each.steps)
            ]
            for change in alone:
                variant = trial.variant(change) if change.part not in limits.keep else None
                if variant is not None and trial.is_stiff(variant[1]):
                    assert abs(variant[1]["squirt"] - found.target) > 0.99 * nearest
