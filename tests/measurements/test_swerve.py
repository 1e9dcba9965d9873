"""The path of a ball struck by a raised cue, and the shots that a maker reads (verification)."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import cuefem as cf
from cuefem.handbook import chapters
from cuefem.measurements.measurement_types import Setup
from cuefem.measurements.shot import Shot
from cuefem.measurements.swerve import GRAVITY, reading_angle
from tests.helpers.command_line import call
from tests.helpers.measured_cues import SCENE, measured_cue

STEP = 1e-4  # s


def rolled_out(velocity: np.ndarray, slip: np.ndarray, *, pressed: float, distance: float, friction: float) -> float:
    """The angle of a ball at a distance, by small steps of Coulomb friction against the slip, anew in each.

    pressed: the impulse that stops a downward motion at first, over M.
    """
    position = np.zeros(2)
    while True:
        size = float(np.hypot(*slip))
        change = min(friction * pressed, 2 / 7 * size) * slip / max(size, 1e-300)
        after = velocity - change
        slip = slip - 3.5 * change
        mean = after if not position.any() else (velocity + after) / 2
        if position[0] + mean[0] * STEP > distance:
            return math.atan2(position[1] + mean[1] * (distance - position[0]) / mean[0], distance)
        position = position + mean * STEP
        velocity, pressed = after, GRAVITY * STEP


def integrated(squirt: float, offset: float, *, elevation: float, speed: float, **path: float) -> float:
    """Of a stroke with a raised cue."""
    sine, cosine = math.sin(elevation), math.cos(elevation)
    velocity = speed * np.array([cosine * math.cos(squirt), math.sin(squirt)])
    slip = velocity + np.array([0.0, 2.5 * speed * sine * math.sin(math.asin(offset) - squirt)])
    return rolled_out(velocity, slip, pressed=speed * sine * math.cos(squirt), **path)


@pytest.mark.heavy
def test_closed_form_equals_integration_of_random_strokes() -> None:
    """60 strokes: largest difference 0.001 degrees, of a step's length."""
    draw = np.random.default_rng(6)
    largest = 0.0
    for _ in range(60):
        squirt, offset = math.radians(draw.uniform(0.5, 4)), draw.uniform(0.1, 0.5)
        path = {
            "elevation": math.radians(draw.uniform(0, 8)),
            "speed": draw.uniform(1.5, 8),
            "distance": draw.uniform(0.4, 2.5),
            "friction": draw.uniform(0.1, 0.35),
        }
        largest = max(largest, abs(reading_angle(squirt, offset, **path) - integrated(squirt, offset, **path)))
    assert math.degrees(largest) < 1e-3


def test_limits_of_the_path() -> None:
    """A level cue has no swerve; a long path has Coriolis' final direction, tan = b/R tan(elevation)."""
    level = {"elevation": 0.0, "speed": 3.0, "distance": 2.0, "friction": 0.2}
    assert reading_angle(0.04, 0.4, **level) == pytest.approx(0.04, abs=1e-15)
    raised = {"elevation": math.radians(5), "speed": 2.0, "distance": 3.0, "friction": 100.0}
    final = reading_angle(0.0, 0.375, **raised)  # it rolls almost from the start
    assert math.tan(final) == pytest.approx(-0.375 * math.tan(math.radians(5)), rel=1e-3)


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("degrees", "speed", "limit"), [(2, 3.0, 0.013), (2, 1.5, 0.04), (5, 3.0, 0.03), (5, 1.5, 0.11)]
)
def test_closed_form_equals_a_raised_strike(degrees: float, speed: float, limit: float) -> None:
    """The package's own strike with `Elevation`, and the path after it: only the pinch during contact differs."""
    elevation, friction = math.radians(degrees), 0.2
    cue = cf.LumpedCue(mass=0.54, end_mass=0.0069)
    for offset in (0.2, 0.375, 0.45):
        level = cf.Scene(cue, stroke=cf.Stroke(speed, offset))
        plain = cf.strike(level)
        raised = cf.strike(replace(level, effects=(cf.Elevation(elevation, friction),)))
        assert raised.history is not None
        right, ahead, _ = np.array(raised.history.velocity)
        spin_right, spin_ahead, _ = np.array(raised.history.spin)
        radius = float(level.ball.radius)
        velocity = np.array([ahead, -right])
        slip = velocity + radius * np.array([spin_right, spin_ahead])
        for distance in (0.7, 1.2):
            path = {"distance": distance, "friction": friction}
            speed_of_ball = float(plain.ball_speed)
            closed = reading_angle(float(plain.squirt), offset, elevation=elevation, speed=speed_of_ball, **path)
            assert math.degrees(abs(closed - rolled_out(velocity, slip, pressed=0.0, **path))) < limit


SQUIRT, OFFSET = math.radians(2.2), 0.375


def change(stroke: dict[str, float], *, offset: float = OFFSET, miss: float = 0.0, **other: float) -> str:
    """By how much squirt is another one, if a reading is of another offset, miss or number of the stroke."""
    reading = reading_angle(SQUIRT, OFFSET, **stroke)
    read = math.atan(math.tan(reading) + miss / stroke["distance"])
    found = brentq(lambda guess: reading_angle(guess, offset, **stroke | other) - read, 0.0, 0.2)
    return f"{100 * (found / SQUIRT - 1):.1f} %"


def test_handbook_states_the_sensitivities_of_the_closed_form() -> None:
    chapter = next(chapter for chapter in chapters() if chapter.name == "measuring")
    rows = [line.split("|") for line in chapter.text.splitlines() if re.match(r"\| [\d.]+ m/s, ", line)]
    assert len(rows) == 6
    for _, label, *stated in rows:
        speed, degrees, distance = (float(re.split("m|°", text)[0]) for text in label.split(","))
        stroke = {"elevation": math.radians(degrees), "speed": speed, "distance": distance, "friction": 0.2}
        assert [text.strip() for text in stated[:6]] == [
            f"{math.degrees(reading_angle(SQUIRT, OFFSET, **stroke)):.2f}°",
            change(stroke, elevation=math.radians(degrees + 1)),
            change(stroke, friction=0.25),
            change(stroke, speed=1.1 * speed),
            change(stroke, offset=OFFSET + 1e-3 / 0.028575),
            change(stroke, miss=2e-3),
        ]


SHOT = Shot(cue_offset=0.0143, left=0.04, right=0.038, distance=1.2, speed=2.3)


def test_shot_of_cue_offset_equals_that_of_its_chalk_mark() -> None:
    radius, dome = float(SCENE.ball.radius), SCENE.dome_radius
    mark = replace(SHOT, cue_offset=None, chalk_mark=0.0143 * radius / (radius + dome))
    assert mark.squirt(SCENE).offset == pytest.approx(SHOT.squirt(SCENE).offset, rel=1e-12)
    assert SHOT.squirt(SCENE).offset == pytest.approx(0.0143 / (radius + dome), rel=1e-12)


@pytest.mark.heavy
def test_estimate_finds_squirt_and_elevation_from_two_speeds() -> None:
    """Readings of the model at 4 degrees, without its value: squirt factor to 1 %, elevation to half a degree."""
    cue = measured_cue()
    truth, path = Setup(cue.scene), {"elevation": math.radians(4), "distance": 1.2, "friction": 0.2}
    shots = []
    for speed in (2.0, 5.0):
        squirt = 1.1 * truth.predictions.squirt(0.375, speed)
        angle = reading_angle(squirt, 0.375, speed=truth.predictions.ball_speed(0.375, speed), **path)
        miss = 1.2 * math.tan(angle)
        chalk = 0.375 * float(cue.scene.ball.radius)
        shot = Shot(chalk_mark=chalk, left=miss, right=miss, distance=1.2, speed=speed, offset_error=1e-5)
        shots.append(replace(shot, reading_error=2e-4).squirt(cue.scene))
    values = {each.name: each for each in cf.estimate(measured_cue(*shots)).found.values}
    assert values["squirt model"].value == pytest.approx(1.1, rel=0.02)
    assert math.degrees(values["elevation"].value) == pytest.approx(4.0, abs=0.5)


def test_untouched_template_is_refused_by_name(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    status, out, _ = call("compare", folder, "--template")
    assert (status, out.endswith(f"cuefem compare {folder} --estimate -o mine_calibration.toml\n")) == (0, True)
    assert "cue.toml: must be replaced by your drawing" in call("compare", folder)[2]
    (folder / "cue.toml").write_text((folder / "cue.toml").read_text("utf-8").replace("467 g", "450 g"), "utf-8")
    text = (folder / "measured.toml").read_text("utf-8")
    values = {"distance": "1 m", "speed": "3.5 m/s"}
    for name in ("cue_offset", "left", "right", "distance", "speed"):
        status, out, err = call("compare", folder, "--estimate", "-o", tmp_path / "c.toml")
        assert (status, out, err.count("\n")) == (2, "", 1)
        assert f"shot[0].{name}: must be filled in" in err
        text = text.replace(f'{name} = "?"', f'{name} = "{values.get(name, "14 mm")}"', 1)
        (folder / "measured.toml").write_text(text, "utf-8")
    assert not (tmp_path / "c.toml").exists()
