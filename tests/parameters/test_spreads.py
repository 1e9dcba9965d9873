"""Spreads of parameters, behind every printed uncertainty, are those of their sources (regression)."""

from dataclasses import replace
from math import asin, log, tan

import pytest

import cuefem as cf
from cuefem.parameters.table import PARAMETERS
from studies.strokes import cue

HOLLOW = cue("pool_hollow")
MAPLE = {"E": log(16.9 / 10.8) / 2, "G": log(1.55 / 0.85) / 2, "rho": log(780 / 630) / 2}  # cuefem/cue/materials.toml
FRICTION = ((log(tan(asin(0.5)) / 0.7) ** 2 + log(tan(asin(0.55)) / 0.7) ** 2) / 3) ** 0.5  # [TP 2.1], [Kim]
LEATHER = {"leather": 3.5 * 0.1, "restitution": 0.05, "tip_height": 0.1, "dome": 0.1}
OTHERS = {"friction": FRICTION, "wave_speed": 0.12, "contact_time": 0.1, "tip_height": 0.1, "dome": 0.1}


def spreads(scene: cf.Scene) -> dict[str, float]:
    return {key: spread for key, known in PARAMETERS.items() if (spread := known.spread_in(scene))}


def test_spreads_of_parameters_equal_their_sources() -> None:
    scene = cf.usual_scene(HOLLOW)
    bore = {"bore_width": log(7.5 / 6) / 2}  # meshes/README.md
    assert spreads(scene) == pytest.approx(MAPLE | OTHERS | LEATHER | bore)
    tip = replace(scene.leather_tip, E=1.1 * scene.leather_tip.E)  # of a measured contact time, ±5 %
    of_a_spring = replace(scene, effects=(), tip=cf.Tip(contact_time=1e-3))
    assert spreads(replace(scene, effects=(tip,)))["leather"] == pytest.approx(3.5 * 0.05)
    assert spreads(of_a_spring) == pytest.approx(MAPLE | OTHERS | bore)


def test_spreads_of_weighed_and_assumed_masses() -> None:
    weighed = cf.usual_scene(replace(HOLLOW, shaft_mass_measured=True))
    assert "rho" not in spreads(weighed)
    assumed = cf.usual_scene(replace(HOLLOW, assumed_body_mass=HOLLOW.body_mass))
    assert spreads(assumed)["body_mass"] == pytest.approx(log(17.5 / 13.5) / 2)  # butts of pool cues, oz
    assert "friction" not in spreads(replace(weighed, tip=replace(weighed.tip, friction=0.0)))
