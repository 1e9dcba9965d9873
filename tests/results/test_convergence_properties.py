"""`resolve` and `resolve_end_mass`: lumped cues, cost against accuracy (properties)."""

from dataclasses import replace

from hypothesis import given, settings

from cuefem import LumpedCue, Scene, impulse, resolve, resolve_end_mass
from tests.helpers.accuracy_scenes import scene
from tests.helpers.strike_scenes import lumped_scenes

KIM = scene("kim", 1e-3, 0.3)


@settings(max_examples=8, deadline=None)
@given(lumped_scenes())
def test_resolve_lumped_cue_agrees_with_impulse(lumped: Scene) -> None:
    result, exact = resolve(lumped, 1e-3), impulse(lumped)
    assert result.error <= 1e-3
    assert abs(result.squirt - exact.squirt) <= 1e-3 * max(abs(exact.squirt), abs(lumped.stroke.angle))


def test_resolve_end_mass_lumped_cue_is_its_own() -> None:
    assert resolve_end_mass(replace(KIM, cue=LumpedCue(0.5, 0.006)), "force", 1e-3) == (0.006, 0.0)


def test_resolve_smaller_rtol_takes_more_degrees_of_freedom() -> None:
    results = [resolve(KIM, rtol) for rtol in (0.5, 1e-2, 1e-3, 3e-4)]
    assert [outcome.unknowns for outcome in results] == sorted(outcome.unknowns for outcome in results)
    errors = [outcome.error for outcome in results]
    assert all(error is not None and error <= rtol for error, rtol in zip(errors, (0.5, 1e-2, 1e-3, 3e-4), strict=True))
