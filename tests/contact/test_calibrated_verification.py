"""The leather's modulus from a contact time gives that contact time back, with and without axial waves."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cuefem import AxialWaves, leather_modulus, rebound, strike, tip_restitution
from cuefem.contact.tip_identification import with_modulus
from tests.helpers.leather_scenes import LEATHER, leather_scene


@pytest.mark.parametrize("E", [60e6, 140e6, 400e6])
def test_the_law_of_a_rigid_cue_gives_its_modulus_back(E: float) -> None:
    """Head on, a cue without axial waves is a rigid one, whose contact time is an integral of the law."""
    told = leather_scene(leather=replace(LEATHER, E=E)).contact_time
    assert leather_modulus(leather_scene(), float(told)) == pytest.approx(E, rel=1e-4)  # what the steps leave


def test_it_does_not_matter_which_leather_the_scene_has() -> None:
    soft = leather_scene(leather=replace(LEATHER, E=1e6))  # a ball would be pressed through it
    assert leather_modulus(soft, 1.1e-3) == pytest.approx(leather_modulus(leather_scene(), 1.1e-3), rel=1e-9)


def test_axial_waves_are_counted() -> None:
    scene = leather_scene(0.0, AxialWaves())
    found = leather_modulus(scene, 1.1e-3)
    assert strike(with_modulus(scene, found)).duration == pytest.approx(1.1e-3, rel=1e-7)
    assert found > 1.05 * leather_modulus(leather_scene(), 1.1e-3)  # the wood gives way too


def test_the_whole_cue_rebounds_less_or_more_than_its_tip() -> None:
    """A rigid cue and ball part with the tip's restitution times the stroke's speed; it is what the tip is told by."""
    assert rebound(leather_scene(0.3)) == pytest.approx(0.73, rel=1e-4)
    scene = leather_scene(0.0, AxialWaves())
    told = tip_restitution(scene, 0.8)
    assert rebound(replace(scene, tip=replace(scene.tip, restitution=told))) == pytest.approx(0.8, rel=1e-6)
