"""A strike table agrees with the strikes that it stands for, in Python, JavaScript and pooltool (verification)."""

import json
import math
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest

import cuefem as cf
from cuefem.analysis import strike_grid
from cuefem.analysis.strike_table import StrikeTable
from studies.games.games import RANDOM, SEED, pooltool_strike
from studies.pages import STUDIES
from tests.helpers.command_line import stdout_of
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
    """Its lines, its numbers, its text, also at a wide range of speeds, and the points of its charts."""
    page = table.to_html()
    lines = [json.dumps({key: value}, default=list) for key, value in table.to_dict().items()]
    wide = replace(table, speed=tuple(10 * (speed - 0.99) for speed in table.speed))
    texts = [repr(table), *lines, str(table), str(wide), page_text(page), drawing_text(page)]
    assert_golden("strike_table.txt", rounded("\n".join(texts)), request)


def test_table_equals_strikes_at_its_nodes_and_their_mirror_images(table: StrikeTable) -> None:
    for row in (0, len(table.speed) - 1):
        speed, offset = table.speed[row], table.share[-2] * table.limit[row]
        outcome = struck(speed, offset)
        for sign in (1, -1):
            squirt, ball_speed, spin = table.at(speed, sign * offset)[:3]
            assert (sign * squirt, ball_speed) == pytest.approx((outcome.squirt, outcome.ball_speed), rel=1e-5)
            assert sign * spin == pytest.approx(outcome.spin, rel=1e-5)


def test_table_ends_below_the_miscue(table: StrikeTable) -> None:
    for speed, limit in zip(table.speed, table.limit, strict=True):
        assert struck(speed, limit).regime != "miscue"
        assert struck(speed, limit + 2e-4).regime == "miscue"


def test_strokes_beyond_the_table_are_held_and_say_so(table: StrikeTable) -> None:
    soft, first = table.at(0.25, 0.3), table.at(1.0, 0.3)
    assert soft.clamped
    assert not first.clamped
    assert (soft.squirt, 4 * soft.ball_speed, 4 * soft.spin) == pytest.approx(first[:3], rel=1e-12)
    beyond, limit = table.at(2.0, -0.7), table.at(2.0, -table.grid().limit_at(2.0))
    assert (beyond.miscue, limit.miscue) == (True, False)
    assert beyond[:3] == limit[:3]
    assert table.at(0.0, 0.3).ball_speed == 0.0
    for wrong in ((-1.0, 0.3), (math.nan, 0.3), (2.0, math.nan)):
        with pytest.raises(ValueError, match=r"^strike_table (speed|offset) must be"):
            table.at(*wrong)


def test_javascript_reads_the_table_as_python_does(table: StrikeTable, tmp_path: Path) -> None:
    if shutil.which("node") is None:
        pytest.skip("no node here: the readers in JavaScript are not run")
    table.save(tmp_path / "table.json")
    strokes = [*STROKES, (2.0, 0.6), (5.0, -0.3), (0.1, 0.3), (0.0, 0.0)]
    (tmp_path / "read.mjs").write_text(
        f"import strike from {(STUDIES / 'games' / 'strike_table.mjs').as_uri()!r};"
        "import { readFileSync } from 'node:fs';"
        f"const table = JSON.parse(readFileSync({str(tmp_path / 'table.json')!r}));"
        f"console.log(JSON.stringify({[[*s] for s in strokes]}.map(s => strike(table, ...s))));"
    )
    done = subprocess.run(["node", tmp_path / "read.mjs"], capture_output=True, text=True, check=True)
    for stroke, found in zip(strokes, json.loads(done.stdout), strict=True):
        assert found == pytest.approx(table.at(*stroke)._asdict(), rel=1e-12)


def test_script_and_module_are_one_reader() -> None:
    script, module = ((STUDIES / "games" / f"strike_table.{ending}").read_text("utf-8") for ending in ("js", "mjs"))
    assert script.partition("\nif (typeof module")[0] == module.replace("export default ", "").strip()


def test_command_writes_the_tables_of_the_call(tmp_path: Path, table: StrikeTable) -> None:
    cf.save(SCENE, tmp_path / "one.toml")
    cf.save(replace(SCENE, cue=cf.LumpedCue(0.54, 0.005)), tmp_path / "other.toml")
    files = [tmp_path / name for name in ("one.toml", "other.toml")]
    with patch.multiple(strike_grid, COARSE=3, STROKES=12):
        out = stdout_of("strike", *files, "--format", "table", "--speeds", "1 m/s", "4 m/s", "-o", tmp_path / "tables")
    assert out.count("wrote") == 2
    one, other = (json.loads((tmp_path / "tables" / f"{name}.json").read_text("utf-8")) for name in ("one", "other"))
    assert one["squirt_over_offset"] == pytest.approx(np.array(table.squirt_over_offset), rel=1e-9)
    assert one["pooltool"]["CueSpecs"]["end_mass"] > 1.5 * other["pooltool"]["CueSpecs"]["end_mass"]


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
block = sent["table"]["pooltool"]
model = StrikeTableCollision(sent["table"])
found = {"version": pt.__version__, "strokes": []}
for speed, a, phi in sent["strokes"]:
    answers = {}
    for name, collision in (("table", model), ("own", InstantaneousPoint())):
        specs = pt.objects.CueSpecs(**block["CueSpecs"])
        cue = pt.Cue(V0=speed, phi=phi, a=a, b=0.0, specs=specs)
        ball = pt.Ball("cue", params=pt.BallParams(**block["BallParams"]))
        _, after = collision.resolve(cue, ball)
        answers[name] = after.state.rvw[1:].tolist()
    found["strokes"].append([answers, model.miscue])

def shot(collision):
    table = pt.Table.default()
    balls = pt.get_rack(pt.GameType.NINEBALL, table, ball_params=pt.BallParams(**block["BallParams"]))
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


def in_pooltool(sent: Any) -> Any:
    """What the program prints as JSON, in this Python or in POOLTOOL_PYTHON, which .ci/pooltool makes.

    pooltool 0.6.0 requires a development build of its graphics that is not on PyPI, so that pip installs 0.3.3, which
    has no end mass, and `cuefem[pooltool]` cannot exist.
    """
    has_it = "from importlib.util import find_spec; raise SystemExit(find_spec('pooltool') is None)"
    pythons = [python for python in (sys.executable, os.environ.get("POOLTOOL_PYTHON", "")) if python]
    found = [
        python for python in pythons if subprocess.run([python, "-c", has_it], capture_output=True).returncode == 0
    ]
    if not found:
        pytest.skip("no pooltool here: POOLTOOL_PYTHON names the Python of an environment that has it")
    asked = {"input": json.dumps(sent), "capture_output": True, "text": True, "cwd": STUDIES.parent}
    done = subprocess.run([found[0], "-c", IN_POOLTOOL], **asked)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.heavy
def test_pooltool_strikes_by_the_table_and_plays_whole_shots(table: StrikeTable) -> None:
    """pooltool aims along y; its offset is positive to the left, our squirt then to the right."""
    strokes = [(2.0, a, phi) for a in (-0.4, 0.1, 0.5) for phi in (90.0, 30.0)] + [(2.0, 0.6, 90.0)]
    example = table.example
    sent = {
        "table": json.loads(json.dumps(table.to_dict(), default=list)),
        "strokes": [*strokes, (example["speed"], example["offset"], 90.0)],
        "shot": (3.0, 0.3, 0.2),
    }
    found = in_pooltool(sent)
    *others, (of_example, _) = found["strokes"]
    (own_x, own_y, _), _ = of_example["own"]
    assert math.atan2(own_x, own_y) == pytest.approx(example["table"]["squirt"], rel=1e-9)
    end_mass = table.pooltool["CueSpecs"]["end_mass"]
    for (speed, a, phi), (answers, miscue) in zip(strokes, others, strict=True):
        assert miscue == (a == 0.6)
        scene = replace(SCENE, stroke=cf.Stroke(speed, a))
        own = pooltool_strike(scene, end_mass)
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
