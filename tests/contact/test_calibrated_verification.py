"""The leather's modulus from a contact time gives that contact time back, with and without axial waves."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cuefem import AxialWaves, TipDome, leather_modulus, strike
from cuefem.contact.calibrated import with_modulus
from tests.helpers.leather_scenes import LEATHER, leather_scene


@pytest.mark.parametrize("E", [60e6, 140e6, 400e6])
def test_the_law_of_a_rigid_cue_gives_its_modulus_back(E: float) -> None:
    """Head on, a cue without axial waves is a rigid one, whose contact time is an integral of the law."""
    told = leather_scene(leather=replace(LEATHER, E=E)).contact_time
    assert leather_modulus(leather_scene(), float(told)) == pytest.approx(E, rel=1e-6)


def test_it_does_not_matter_which_leather_the_scene_has() -> None:
    soft = leather_scene(leather=replace(LEATHER, E=1e6))  # a ball would be pressed through it
    assert leather_modulus(soft, 1.1e-3) == pytest.approx(leather_modulus(leather_scene(), 1.1e-3), rel=1e-9)


def test_axial_waves_are_counted() -> None:
    scene = leather_scene(0.0, AxialWaves())
    found = leather_modulus(scene, 1.1e-3)
    assert strike(with_modulus(scene, found)).duration == pytest.approx(1.1e-3, rel=1e-7)
    assert found > 1.05 * leather_modulus(leather_scene(), 1.1e-3)  # the wood gives way too


def test_refusals() -> None:
    with pytest.raises(ValueError, match=r"^leather_modulus contact_time must be in \[1e-6, 10\] s; got 0"):
        leather_modulus(leather_scene(), 0.0)
    with pytest.raises(ValueError, match=r"^Scene.effects must hold a LeatherTip; got none$"):
        leather_modulus(replace(leather_scene(), effects=(TipDome(0.01),)), 1e-3)
    with pytest.raises(ValueError, match="further than its law is known"):
        leather_modulus(leather_scene(), 9e-3)
