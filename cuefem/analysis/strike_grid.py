"""The grid of a strike table: ratios over cue speed and share of the miscue limit, refined until strokes agree.

Squirt has kinks: where the patch first slips as a whole, it turns within a few thousandths of b/R. The grid has finer
cells there: a row or a column is added where interpolation is wrong at the middle of its cells, until strokes drawn at
random agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from cuefem.contact.strike import strike_modes
from cuefem.cue import Array
from cuefem.results.progress import Progress
from cuefem.scene import Outcome, Scene, Stroke
from cuefem.scene.solved_scene import SolvedScene

MAX_OFFSET = 0.7  # b/R of the limit of a stroke that never miscues: beyond it the edge of the tip touches
LIMIT_ACCURACY = 1e-4  # b/R of a miscue limit
CENTRE = 1e-3  # b/R, at which the ratios of the centre are computed
TOLERANCE = 0.01  # relative error of interpolation, of
WITHIN = 0.99  # of strokes
COARSE = 8  # cells in each direction before refinement
FINEST = 2e-3  # width of a cell that is not divided again, as a part of the range
MAX_ROUNDS = 24  # of refinement
SMALL = 0.01  # value of a field: errors of smaller ones are relative to it
STROKES = 400  # random strokes that measure the error
DIGITS = 6  # of the table's numbers
FIELDS = {
    "squirt_over_offset": "squirt over b/R",
    "speed_ratio": "ball speed over cue speed",
    "spin_over_offset": "spin times ball radius over cue speed and b/R",
}


class TableStroke(NamedTuple):
    """What a table says of a stroke.

    Attributes
    ----------
    squirt : float
        rad.
    ball_speed : float
        m/s.
    spin : float
        rad/s.
    miscue : bool
        Whether the offset is beyond the miscue limit; the ball leaves as at the limit.
    clamped : bool
        Whether the speed is beyond the table's; the ratios are those of its first or last row.
    """

    squirt: float
    ball_speed: float
    spin: float
    miscue: bool = False
    clamped: bool = False


@dataclass(frozen=True, eq=False)
class Grid:
    """A grid of ratios, (speeds, shares, fields), with the limit at each speed, and linear interpolation between."""

    speed: Array
    share: Array
    limit: Array
    ratios: Array

    def stroke(self, speed: float, offset: float, radius: float) -> TableStroke:
        """Interpolate a stroke; beyond the speeds or the miscue limit at the nearest of them."""
        if not 0 <= speed < math.inf:
            raise ValueError(f"strike_table speed must be in [0, inf) m/s; got {speed}")
        if not math.isfinite(offset):
            raise ValueError(f"strike_table offset must be a finite b/R; got {offset}")
        row = float(np.clip(speed, *self.speed[[0, -1]]))
        limit = self.limit_at(row)
        held = float(np.clip(offset, -limit, limit))
        squirt, ball_speed, spin = self.ratios_at(row, abs(held) / limit)
        velocities = speed * ball_speed, held * spin * speed / radius
        return TableStroke(held * squirt, *velocities, miscue=held != offset, clamped=row != speed)

    def limit_at(self, speed: float) -> float:
        """The miscue limit at a speed."""
        return float(np.interp(math.log(speed), np.log(self.speed), self.limit))

    def ratios_at(self, speed: float, share: float) -> tuple[float, ...]:
        """The fields at a speed and a share of the limit."""
        row = min(max(int(np.searchsorted(self.speed, speed)) - 1, 0), len(self.speed) - 2)
        low, high = self.speed[row : row + 2]
        t = math.log(speed / low) / math.log(high / low)
        values = (1 - t) * self.ratios[row] + t * self.ratios[row + 1]
        return tuple(float(np.interp(share, self.share, values[:, k])) for k in range(len(FIELDS)))


class Strikes:
    """Strikes of one cue by speed and share, each computed once: x is the position of log speed in its range.

    squirt_factor: of a calibration.
    """

    def __init__(self, scene: Scene, speeds: Sequence[float], squirt_factor: float = 1.0) -> None:
        self.scene, self.speeds, self.squirt_factor = scene, (speeds[0], speeds[-1]), squirt_factor
        self.tip = SolvedScene(scene).tip
        self._limits: dict[float, float] = {}
        self._ratios: dict[tuple[float, float], Array] = {}

    def speed(self, x: float) -> float:
        """Cue speed at a position."""
        low, high = self.speeds
        return float(f"{low * (high / low) ** x:.{DIGITS}g}")

    def strike(self, speed: float, offset: float) -> Outcome:
        """The coupled strike, its squirt calibrated."""
        outcome = strike_modes(replace(self.scene, stroke=Stroke(speed, offset)), self.tip)
        return replace(outcome, squirt=self.squirt_factor * outcome.squirt)

    def limit(self, x: float) -> float:
        """The largest b/R without a miscue, from below."""
        if x not in self._limits:
            self._limits[x] = self._found_limit(self.speed(x))
        return self._limits[x]

    def _found_limit(self, speed: float) -> float:
        low, high = 0.0, MAX_OFFSET
        if self.strike(speed, high).regime != "miscue":
            return high
        while high - low > LIMIT_ACCURACY:
            middle = (low + high) / 2
            if self.strike(speed, middle).regime == "miscue":
                high = middle
            else:
                low = middle
        if low < 2 * CENTRE:
            friction = self.scene.tip.friction
            raise ValueError(f"strike_table tip must hold the ball off its centre; got a friction of {friction:g}")
        return float(f"{low:.{DIGITS}g}")

    def ratios(self, x: float, share: float) -> Array:
        """The fields at a node."""
        if (x, share) not in self._ratios:
            speed, offset = self.speed(x), max(share * self.limit(x), CENTRE)
            self._ratios[x, share] = ratios_of(self.strike(speed, offset), speed, offset, self.scene.ball.radius)
        return self._ratios[x, share]

    def grid(self, positions: Sequence[float], shares: Sequence[float]) -> Grid:
        """The grid of these lines, its numbers rounded as in a file."""
        ratios = [[self.ratios(x, share) for share in shares] for x in positions]
        rounded = np.vectorize(lambda value: float(f"{value:.{DIGITS}g}"))(np.array(ratios))
        limits = np.array([self.limit(x) for x in positions])
        return Grid(np.array([self.speed(x) for x in positions]), np.array(shares), limits, rounded)

    def random_errors(self, grid: Grid, count: int, seed: int = 0) -> Array:
        """Relative errors of a grid's fields at random strokes below the limit, the same in every round."""
        errors = []
        for x, share in np.random.default_rng(seed).uniform(size=(count, 2)):
            speed = self.speed(float(x))
            offset = float(share) * grid.limit_at(speed)
            true = ratios_of(self.strike(speed, offset), speed, offset, self.scene.ball.radius)
            errors.append(_relative(np.array(grid.ratios_at(speed, float(share))), true))
        return np.array(errors)


def ratios_of(outcome: Outcome, speed: float, offset: float, radius: float) -> Array:
    """The fields of a stroke."""
    spin = float(outcome.spin) * radius / (speed * offset)
    return np.array([float(outcome.squirt) / offset, float(outcome.ball_speed) / speed, spin])


class Refinement:
    """The lines of a grid, which rounds of refinement add to.

    allowed: the part of the grid that wrong cells may cover. smooth: middles of cells that were nowhere wrong, which
    are not computed again.
    """

    def __init__(self, strikes: Strikes) -> None:
        self.strikes = strikes
        self.positions = self.shares = [i / COARSE for i in range(COARSE + 1)]
        self.allowed = 1 - WITHIN
        self.smooth_positions, self.smooth_shares = set[float](), set[float]()

    def run(self, progress: Progress) -> tuple[Grid, Array]:
        """Refine until random strokes agree: the grid, and their errors."""
        done: tuple[Grid, Array] | None = None
        for _ in progress(range(MAX_ROUNDS)):
            if done is not None or self._added_lines():
                continue  # a progress bar runs to its end
            grid = self.strikes.grid(self.positions, self.shares)
            errors = self.strikes.random_errors(grid, STROKES)
            if within_tolerance(errors) >= WITHIN:
                done = grid, errors
            self.allowed /= 2
            self.smooth_positions.clear()
            self.smooth_shares.clear()
        if done is None:
            grid = self.strikes.grid(self.positions, self.shares)
            done = grid, self.strikes.random_errors(grid, STROKES)
        return done

    def _added_lines(self) -> bool:
        """Whether a round added lines."""
        ratios = self.strikes.ratios
        shares = self._midlines(self.shares, self.positions, lambda share, x: ratios(x, share), self.smooth_shares)
        self.shares = sorted([*self.shares, *shares])
        positions = self._midlines(self.positions, self.shares, ratios, self.smooth_positions)
        self.positions = sorted([*self.positions, *positions])
        return bool(shares or positions)

    def _midlines(
        self,
        lines: Sequence[float],
        across: Sequence[float],
        ratios: Callable[[float, float], Array],
        smooth: set[float],
    ) -> list[float]:
        """Lines midway between others, so many that cells that are still wrong cover at most the allowed part.

        ratios: the fields at a line and a position across.
        """
        areas = []
        for low, high in pairwise(lines):
            middle = (low + high) / 2
            if high - low < FINEST or middle in smooth:
                continue
            wrong = [_is_wrong(*(ratios(line, other) for line in (low, middle, high))) for other in across]
            if not any(wrong):
                smooth.add(middle)
            areas.append((float(np.mean(wrong)) * (high - low), middle))
        areas.sort()
        covered = np.cumsum([area for area, _ in areas])
        return [middle for (_, middle), total in zip(areas, covered, strict=True) if total > self.allowed]


def _is_wrong(low: Array, middle: Array, high: Array) -> bool:
    """Whether a straight line misses the middle by more than half of the tolerance: errors of two directions add."""
    return bool(_relative((low + high) / 2, middle).max() > TOLERANCE / 2)


def _relative(value: Array, true: Array) -> Array:
    """Relative errors; of values near zero relative to `SMALL`."""
    return np.abs(value - true) / np.maximum(np.abs(true), SMALL)


def within_tolerance(errors: Array) -> float:
    """The part of strokes with all fields within the tolerance."""
    return float(np.mean(errors.max(axis=1) <= TOLERANCE))
