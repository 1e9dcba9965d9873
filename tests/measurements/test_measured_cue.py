"""Computed values of measurements, residuals, and offset zeros (verification)."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.cue.geometry import shear_coefficient
from cuefem.measurements.measured_cue import compare, offset_zeros
from cuefem.measurements.measured_folder import load_measured
from cuefem.measurements.measurement_types import (
    AddedMass,
    Balance,
    ContactTime,
    PivotLength,
    Setup,
    Squirt,
    Stiffness,
    Weight,
)
from tests.helpers.leather_scenes import leather_scene
from tests.helpers.measured_cues import SCENE, WOOD, cheap_measurements, measured_cue, measured_folder

ROD = replace(SCENE, cue=cf.Cue((cf.Segment(0.7, 0.014, 0.014, WOOD),), 0.45))


@pytest.mark.parametrize("free_length", [None, 0.7, 0.3, 0.1])
def test_stiffness_of_rod_is_exact(free_length: float | None) -> None:
    L, second, A = free_length or 0.7, np.pi / 64 * 0.014**4, np.pi / 4 * 0.014**2
    shear = float(shear_coefficient(WOOD.effective_poisson_ratio)) * WOOD.G * A
    exact = 1 / (L**3 / (3 * WOOD.E * second) + L / shear)
    result = Stiffness(free_length=free_length, value=1.0, error=1.0).compute(Setup(ROD))
    assert result == pytest.approx(exact, rel=1e-8)


def test_weight_and_balance_with_leather_tip_include_it() -> None:
    scene = leather_scene()
    tip = scene.leather_tip.mass_on(scene.shaft)
    mass = Weight(part="shaft", value=1.0, error=1.0).compute(Setup(scene))
    assert mass == pytest.approx(scene.shaft.shaft_mass + tip, rel=1e-14)
    assert Weight(part="cue", value=1.0, error=1.0).compute(Setup(scene)) == pytest.approx(scene.shaft.mass + tip)
    moment = scene.shaft.shaft_mass * scene.shaft.balance_point
    expected = scene.leather_tip.height + moment / mass
    assert Balance(value=1.0, error=1.0).compute(Setup(scene)) == pytest.approx(expected, rel=1e-14)


def test_squirt_and_contact_time_equal_a_strike() -> None:
    for scene in (SCENE, leather_scene()):
        outcome = cf.strike(replace(scene, stroke=cf.Stroke(1.5, 0.25)))
        one = Squirt(offset=0.25, value=0.03, error=1e-3, speed=1.5)
        assert one.compute(Setup(scene)) == pytest.approx(outcome.squirt, rel=1e-12)
        assert one.compute(Setup(scene, squirt_factor=1.1)) == pytest.approx(1.1 * outcome.squirt, rel=1e-12)
        head_on = cf.strike(replace(scene, stroke=cf.Stroke(1.5, 0.0)))
        time = ContactTime(value=1e-3, error=1e-4, speed=1.5)
        assert time.compute(Setup(scene)) == pytest.approx(head_on.duration, rel=1e-12)


def test_pivot_length_follows_from_squirt_and_dome() -> None:
    """TP B.1: rotated by the squirt about the bridge, the axis of the cue passes the centre at (R + r) b/R."""
    for scene, dome in ((SCENE, 0.0), (leather_scene(), leather_scene().leather_tip.dome_radius)):
        one, radius = PivotLength(offset=0.25, value=0.3, error=0.01, speed=1.5), float(scene.ball.radius)
        for factor in (1.0, 1.1):
            turned = factor * cf.strike(replace(scene, stroke=cf.Stroke(1.5, 0.25))).squirt
            result = one.compute(Setup(scene, squirt_factor=factor))
            assert (radius + result) * np.sin(turned) == pytest.approx((radius + dome) * 0.25, rel=1e-12)
    assert measured_cue(one).parameters[-1].name == "squirt model"


def test_added_mass_position_counts_from_the_leather() -> None:
    scene = leather_scene()
    added = cf.PointMass(position=0.05 - scene.leather_tip.height, mass=5e-3)
    heavy = replace(scene, effects=(*scene.effects, added), stroke=cf.Stroke(scene.stroke.speed, 0.3))
    plain = replace(scene, stroke=cf.Stroke(scene.stroke.speed, 0.3))
    one = AddedMass(mass=5e-3, position=0.05, value=0.05, baseline=0.04, error=1e-3, offset=0.3)
    assert one.compute(Setup(scene)) == pytest.approx(cf.strike(heavy).squirt / cf.strike(plain).squirt, rel=1e-12)
    assert one.measured_value == pytest.approx(1.25)


def test_offset_zero_moves_one_side_and_not_the_mean() -> None:
    """A zero error shifts one side and not the mean of both; it is estimated from their difference."""
    radius, shift = float(SCENE.ball.radius), 1e-3
    setup = Setup(SCENE, {"a": shift})
    both = [cf.strike(replace(SCENE, stroke=cf.Stroke(2.0, 0.3 + side * shift / radius))).squirt for side in (1, -1)]
    alone = Squirt(offset=0.3, value=0.03, error=1e-3, series="a", zero_error=1e-3)
    sides = Squirt(offset=0.3, left=both[0], right=both[1], error=1e-3, series="a")
    assert alone.compute(setup) == pytest.approx(both[0], rel=1e-12)
    assert sides.compute(setup) == pytest.approx(cf.strike(SCENE).squirt, rel=1e-12)
    cue = measured_cue(sides)
    (result,) = offset_zeros(cue, compare(cue))
    assert result.zero_error == pytest.approx(shift, rel=0.2)
    assert result.error > 0
    symmetric = measured_cue(Squirt(offset=0.3, left=0.0, right=0.0, error=1e-3))
    assert offset_zeros(symmetric, compare(symmetric)) == ()  # no slope of squirt over the offset


def test_residuals_are_in_units_of_errors() -> None:
    rows = compare(measured_cue(*cheap_measurements()))
    for row in rows:
        difference = row.measured_value - row.computed_value
        assert row.residual == pytest.approx(difference / row.error)
        assert row.normalized_residual == pytest.approx(difference / np.hypot(row.error, row.spread))
    weight, tone = rows[0], rows[1]
    # closed form: weight proportional to density, frequency to the root of E/rho
    assert weight.spread / weight.computed_value == pytest.approx(np.log(780 / 630) / 2, rel=2e-2)
    E, rho = np.log(16.9 / 10.8) / 2, np.log(780 / 630) / 2
    assert tone.spread / tone.computed_value == pytest.approx(np.hypot(E, rho) / 2, rel=5e-2)


def test_series_of_a_spreadsheet_is_read(tmp_path: Path) -> None:
    """With a byte-order mark, decimal commas, an empty row and empty cells; other formats: test_lathe_profiles.py."""
    folder = measured_folder(tmp_path / "cue")
    rows = "offset;value [deg];error [deg];source;\r\n0,3;2,1;0,1;by hand: twice;\r\n;;;;\r\n0,4;2,8;0,1;;\r\n"
    (folder / "squirt.csv").write_text(f"\ufeff{rows}", encoding="utf-8", newline="")
    squirts = [each for each in load_measured(folder)[0].measurements if isinstance(each, Squirt)]
    found = [(each.offset, float(np.degrees(each.measured_value)), each.source) for each in squirts]
    assert found == [(0.3, pytest.approx(2.1), "by hand: twice"), (0.4, pytest.approx(2.8), "")]


def test_folder_may_name_its_drawing(tmp_path: Path) -> None:
    folder = measured_folder(tmp_path / "cue", 'cue = "shaft.csv"\n')
    (folder / "shaft.csv").write_text("x [mm],diameter [mm]\n0,12.75\n700,21\n", encoding="utf-8")
    assert load_measured(folder)[0].scene.shaft.length == pytest.approx(0.7)


def test_load_measured_without_scene_has_default_stroke_of_game(tmp_path: Path) -> None:
    """The default stroke is that of every command, for the game of measured.toml."""
    folder = measured_folder(tmp_path / "cue")
    drawing = cf.load(folder / "cue.toml")
    assert isinstance(drawing, cf.Cue)
    for game in ("", "snooker"):
        (folder / "measured.toml").write_text(f'game = "{game}"\n' if game else "# none\n", encoding="utf-8")
        assert load_measured(folder)[0].scene == cf.usual_scene(drawing, game or "pool")
    (folder / "measured.toml").write_text('game = "pool"\n[tip]\nfriction = 0.5\n', encoding="utf-8")
    usual = cf.usual_scene(drawing)
    assert load_measured(folder)[0].scene == replace(usual, tip=replace(usual.tip, friction=0.5))
