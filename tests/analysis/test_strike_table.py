"""A strike table agrees with the strikes that it stands for, in Python, JavaScript and pooltool (verification)."""

import json
import math
import re
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest

import cuefem as cf
from cuefem.analysis import strike_grid
from cuefem.analysis.strike_table import StrikeTable
from studies.games.games import RANDOM, SEED, pooltool_strike
from studies.pages import STUDIES
from tests.helpers.command_line import call, stdout_of
from tests.helpers.pooltool import in_pooltool
from tests.test_golden_files import assert_golden, drawing_text, page_text, rounded

SCENE = cf.Scene(cf.LumpedCue(0.54, 0.01), cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.6, 1e-3))
STROKES = ((1.0, 0.1), (1.5, -0.3), (2.7, 0.42), (4.0, 0.54))


@pytest.fixture(scope="module")
def table() -> Iterator[StrikeTable]:
    """A quick one: a lumped cue, a coarse grid."""
    with patch.multiple(strike_grid, COARSE=3, STROKES=12):
        yield cf.strike_table(SCENE, (1.0, 4.0))


def struck(speed: float, offset: float) -> cf.Outcome:
    """The coupled strike of a stroke."""
    return cf.strike(replace(SCENE, stroke=cf.Stroke(speed, offset)))


def test_strike_table_equals_golden_file(table: StrikeTable, request: pytest.FixtureRequest) -> None:
    """Its lines, its numbers, its text, and the points of its charts."""
    page = table.to_html()
    lines = [json.dumps({key: value}, default=list) for key, value in table.to_dict().items()]
    assert_golden(
        "strike_table.txt", rounded("\n".join([*lines, str(table), page_text(page), drawing_text(page)])), request
    )


def test_table_equals_strikes_at_its_nodes_and_their_mirror_images(table: StrikeTable) -> None:
    for row in (0, len(table.speed) - 1):
        speed, offset = table.speed[row], table.share[-2] * table.limit[row]
        outcome = struck(speed, offset)
        for sign in (1, -1):
            squirt, ball_speed, spin = table.at(speed, sign * offset)
            assert (sign * squirt, ball_speed) == pytest.approx((outcome.squirt, outcome.ball_speed), rel=1e-5)
            assert sign * spin == pytest.approx(outcome.spin, rel=1e-5)


def test_table_ends_below_the_miscue(table: StrikeTable) -> None:
    for speed, limit in zip(table.speed, table.limit, strict=True):
        assert struck(speed, limit).regime != "miscue"
        assert struck(speed, limit + 2e-4).regime == "miscue"


@pytest.mark.parametrize(
    ("speed", "offset", "message"),
    [
        (0.99, 0.3, "strike_table speed must be in [1, 4] m/s, the table's; got 0.99"),
        (4.01, 0.3, "strike_table speed must be in [1, 4] m/s, the table's; got 4.01"),
        (
            2.0,
            -0.7,
            "strike_table offset must be in [-0.5532, 0.5532] b/R at 2 m/s, beyond which the stroke is a miscue",
        ),
    ],
)
def test_table_rejects_strokes_beyond_its_range(table: StrikeTable, speed: float, offset: float, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        table.at(speed, offset)


def test_command_writes_the_table_of_the_call(tmp_path: Path, table: StrikeTable) -> None:
    cf.save(SCENE, tmp_path / "cue.toml")
    arguments = ("strike", tmp_path / "cue.toml", "--format", "table", "--speeds", "1 m/s", "4 m/s")
    with patch.multiple(strike_grid, COARSE=3, STROKES=12):
        assert "wrote" in stdout_of(*arguments, "-o", tmp_path / "table.json")
    record = json.loads((tmp_path / "table.json").read_text("utf-8"))
    assert record["squirt_over_offset"] == pytest.approx(np.array(table.squirt_over_offset), rel=1e-9)
    for wrong, message in (
        (("--speeds", "4 m/s", "1 m/s"), "speeds must ascend"),
        (("--offset", "0.3"), "--offset"),
    ):
        status, out, err = call(*arguments[:4], *wrong)
        assert (status, out, message in err) == (2, "", True)


def test_javascript_reads_the_table_as_python_does(table: StrikeTable, tmp_path: Path) -> None:
    if shutil.which("node") is None:
        pytest.skip("no node here")
    table.save(tmp_path / "table.json")
    program = (
        f"const strike = require({str(STUDIES / 'games' / 'strike_table.js')!r});"
        f"const table = require({str(tmp_path / 'table.json')!r});"
        f"console.log(JSON.stringify({[[*s] for s in (*STROKES, (2.0, 0.6))]}.map(s => strike(table, ...s))));"
        "try { strike(table, 5, 0.3) } catch (error) { console.log(error.message) }"
    )
    first, second = subprocess.run(
        ["node", "-e", program], capture_output=True, text=True, check=True
    ).stdout.splitlines()
    *inside, beyond = json.loads(first)
    for stroke, found in zip(STROKES, inside, strict=True):
        assert found == pytest.approx(table.at(*stroke)._asdict() | {"miscue": False}, rel=1e-12)
    assert beyond["miscue"]
    assert second == "speed must be 1 to 4 m/s"


@pytest.mark.heavy
def test_table_of_leather_tip_is_within_one_percent_of_other_random_strokes() -> None:
    table = cf.strike_table(cf.usual_scene(cf.load(STUDIES.parent / "meshes" / "pool_maple.toml")))
    errors = strike_grid.Strikes(table.scene, table.speed).random_errors(table.grid(), RANDOM // 4, SEED)
    assert strike_grid.within_tolerance(errors) >= 0.99
    assert errors.max() < 0.025


IN_POOLTOOL = """
import json, sys
import attrs, numpy as np, pooltool as pt
from pooltool.physics.engine import PhysicsEngine
from pooltool.physics.resolve.resolver import Resolver
from pooltool.physics.resolve.stick_ball.instantaneous_point import InstantaneousPoint
from studies.games.pooltool_model import StrikeTableCollision

sent = json.load(sys.stdin)
model = StrikeTableCollision(sent["table"])
found = {"version": pt.__version__, "strokes": []}
for speed, a, phi in sent["strokes"]:
    answers = {}
    for name, collision in (("table", model), ("own", InstantaneousPoint())):
        specs = pt.objects.CueSpecs(**sent["CueSpecs"])
        cue = pt.Cue(V0=speed, phi=phi, a=a, b=0.0, specs=specs)
        ball = pt.Ball("cue", params=pt.BallParams(**sent["BallParams"]))
        _, after = collision.resolve(cue, ball)
        answers[name] = after.state.rvw[1:].tolist()
    found["strokes"].append([answers, model.miscue])

def shot(collision):
    table = pt.Table.default()
    balls = pt.get_rack(pt.GameType.NINEBALL, table, ball_params=pt.BallParams(**sent["BallParams"]))
    cue = pt.Cue(cue_ball_id="cue", V0=sent["shot"][0], a=sent["shot"][1], b=sent["shot"][2], phi=pt.aim.at_ball(
        pt.System(table=table, balls=balls, cue=pt.Cue(cue_ball_id="cue")), "1"))
    system = pt.System(table=table, balls=balls, cue=cue)
    engine = PhysicsEngine(resolver=attrs.evolve(Resolver.default(), stick_ball=collision))
    pt.simulate(system, engine=engine, inplace=True)
    first = next(event for event in system.events if event.event_type == pt.events.EventType.STICK_BALL)
    ball = next(agent.final for agent in first.agents if agent.id == "cue")
    return [len(system.events), [event.event_type.value for event in system.events[:4]], ball.state.rvw[1:].tolist()]

found["shots"] = [shot(model), shot(InstantaneousPoint())]
print(json.dumps(found))
"""


@pytest.mark.heavy
def test_pooltool_strikes_by_the_table_and_plays_whole_shots(table: StrikeTable) -> None:
    """pooltool aims along y; its offset is positive to the left, our squirt then to the right."""
    strokes = [(2.0, a, phi) for a in (-0.4, 0.1, 0.5) for phi in (90.0, 30.0)] + [(2.0, 0.6, 90.0)]
    sent = {
        "table": json.loads(json.dumps(table.to_dict(), default=list)),
        "BallParams": {"m": 0.17, "R": 0.028575},
        "CueSpecs": {"M": 0.54},
        "strokes": strokes,
        "shot": (3.0, 0.3, 0.2),
    }
    found = in_pooltool(IN_POOLTOOL, sent)
    for (speed, a, phi), (answers, miscue) in zip(strokes, found["strokes"], strict=True):
        assert miscue == (a == 0.6)
        scene = replace(SCENE, stroke=cf.Stroke(speed, a))
        own = pooltool_strike(scene)
        expected = table.at(speed, a) if not miscue else None
        for name, velocity in answers.items():
            v, w = np.array(velocity)
            squirt = math.remainder(math.radians(phi) - math.atan2(v[1], v[0]), 2 * math.pi)
            result = (squirt, math.hypot(*v) / speed, -w[2] * 0.028575 / speed)
            if name == "own":
                assert result == pytest.approx(own, rel=1e-9)
            elif expected is not None:
                values = (expected.squirt, expected.ball_speed / speed, expected.spin * 0.028575 / speed)
                assert result == pytest.approx(values, rel=1e-9)
    (events, kinds, (v, _)), (_, _, (own_v, _)) = found["shots"]
    assert "stick_ball" in kinds
    assert "ball_ball" in kinds
    assert events > 10
    assert math.hypot(*v) == pytest.approx(table.at(3.0, math.hypot(0.3, 0.2)).ball_speed, rel=1e-9)
    assert math.hypot(*own_v) > 1.05 * math.hypot(*v)
