"""A stick-ball collision for pooltool 0.6.0 that reads a strike table: squirt, speed, spin and miscue of a cue.

    shot = pt.System(cue=cue, table=table, balls=balls)
    resolver = attrs.evolve(Resolver.default(), stick_ball=StrikeTableCollision.load("table.json"))
    pt.simulate(shot, engine=PhysicsEngine(resolver=resolver), inplace=True)

`cuefem strike FILE --format table -o table.json` writes the table, and in its block "pooltool" the parameters of cue
and ball, `CueSpecs(**table["pooltool"]["CueSpecs"])`. pooltool's ``a`` and ``b`` are b/R of the contact to the left and
up. The table holds strokes in one plane, so an offset in any direction reads the row of its distance from the centre,
in the plane through the cue and the contact; the vertical part of squirt is left out, as pooltool leaves out the ball's
vertical velocity, and a raised cue only turns the stroke. The scale is that of the ball in pooltool.
"""

from __future__ import annotations

import json
import math
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

import numpy as np

try:
    import attrs
    import pooltool.constants as const
    from pooltool.objects.ball.datatypes import BallState
    from pooltool.physics.resolve.models import StickBallModel
    from pooltool.physics.resolve.stick_ball.core import CoreStickBallCollision
    from pooltool.ptmath.utils import coordinate_rotation
except ImportError as error:
    found = [one.version for one in distributions(name="pooltool-billiards")]
    raise ImportError(
        f"pooltool_model.py needs pooltool 0.6.0; {found[0] if found else 'none'} is installed. pip chooses 0.3.3, "
        "which has other modules: `pip install --no-deps pooltool-billiards==0.6.0`, then what it imports "
        "(studies/games/games.md)"
    ) from error


def read(table: dict[str, Any], speed: float, offset: float) -> dict[str, float]:
    """The ratios of a stroke and its share of the miscue limit; beyond the limit or the speeds those at the nearest."""
    rows = table["speed"]
    speed = min(max(speed, rows[0]), rows[-1])
    j = min(max(int(np.searchsorted(rows, speed)) - 1, 0), len(rows) - 2)
    t = math.log(speed / rows[j]) / math.log(rows[j + 1] / rows[j])
    share = abs(offset) / ((1 - t) * table["limit"][j] + t * table["limit"][j + 1])
    ratios = {"share": share}
    for field in ("squirt_over_offset", "speed_ratio", "spin_over_offset"):
        values = (1 - t) * np.array(table[field][j]) + t * np.array(table[field][j + 1])
        ratios[field] = float(np.interp(share, table["share"], values))
    return ratios


@attrs.define
class StrikeTableCollision(CoreStickBallCollision):
    """The strike of a cue by its table.

    table: the contents of the JSON file. miscue: whether the last stroke was beyond the miscue limit; the ball then
    leaves as at the limit. clamped: whether its speed was beyond the table's, whose nearest row was read.
    """

    table: dict[str, Any] = attrs.field(factory=dict, repr=False)
    miscue: bool = False
    clamped: bool = False
    model: StickBallModel = attrs.field(default=StickBallModel.INSTANTANEOUS_POINT, init=False, repr=False)

    @classmethod
    def load(cls, path: str | Path) -> StrikeTableCollision:
        """The collision of a table's file."""
        return cls(json.loads(Path(path).read_text(encoding="utf-8")))

    def solve(self, cue: Any, ball: Any) -> tuple[Any, Any]:
        """Velocity and spin of the ball after the stroke."""
        speed = float(cue.V0)
        ratios = read(self.table, speed, math.hypot(cue.a, cue.b))
        self.miscue = ratios["share"] > 1
        self.clamped = not self.table["speed"][0] <= speed <= self.table["speed"][-1]
        a, b = (float(offset) / max(ratios["share"], 1.0) for offset in (cue.a, cue.b))
        elevation, turn = math.radians(cue.theta), math.radians(cue.phi) - math.pi / 2
        squirt = a * ratios["squirt_over_offset"]  # to the right of a stroke on the left
        forward = np.array([0.0, ratios["speed_ratio"] * speed * math.cos(elevation), 0.0])
        velocity = coordinate_rotation(forward, turn - squirt)
        per_offset = ratios["spin_over_offset"] * speed / ball.params.R
        spin = -per_offset * np.array([b, a * math.sin(elevation), a * math.cos(elevation)])
        motion = np.array([ball.state.rvw[0], velocity, coordinate_rotation(spin, turn)])
        ball.state = BallState(motion, const.sliding)
        return cue, ball
