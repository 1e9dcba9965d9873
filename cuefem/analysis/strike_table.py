"""The strike of a cue as a table for games: squirt, ball speed and spin over cue speed and tip offset.

A table has one row for each cue speed and one column for each share of the miscue limit at that speed, so that every
node is a stroke without a miscue and no cell holds the jump at the limit. Squirt and spin are divided by b/R, so that
they stay finite at the centre; everything is a ratio, so that a game may take it in its own units. A reader
interpolates linearly in the share and in the logarithm of the speed.

Squirt has kinks: where the patch first slips as a whole, it turns within a few thousandths of b/R. The grid has finer
cells there: a row or a column is added where interpolation is wrong at the middle of its cells, until strokes drawn at
random agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from cuefem.contact.strike import strike_modes
from cuefem.cue import Array
from cuefem.effects.force_law import IndentationOutOfRange
from cuefem.quantity.fields import check_kind
from cuefem.results.quantities import MISCUE_DEFINITION, RESULTS, format_value
from cuefem.results.records import Record, Table
from cuefem.scene import Outcome, Scene, Stroke
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.analysis import Analysis
from cuefem.show.scene_summary import assumptions, scene_record

if TYPE_CHECKING:
    from cuefem.show.charts import Chart

SPEEDS = (0.2, 10.0)  # m/s: from a soft stroke to a break at 22 mph
MAX_OFFSET = 0.7  # b/R of the limit of a stroke that never miscues: beyond it the edge of the tip touches
LIMIT_ACCURACY = 1e-4  # b/R of a miscue limit
CENTRE = 1e-3  # b/R, at which the ratios of the centre are computed
TOLERANCE = 0.01  # relative error of interpolation, of
WITHIN = 0.99  # of strokes
COARSE = 8  # cells in each direction before refinement
FINEST = 2e-3  # width of a cell that is not divided again, as a part of the range
MAX_ROUNDS = 24  # of refinement
SMALL_RATIOS = (0.01, 0.1, 0.1)  # of `FIELDS`: errors of smaller values are relative to these
STROKES = 400  # random strokes that measure the error
DIGITS = 6  # of the table's numbers
FIELDS = {
    "squirt_over_offset": "squirt over b/R",
    "speed_ratio": "ball speed over cue speed",
    "spin_over_offset": "spin times ball radius over cue speed and b/R",
}
SIGNS = (
    "offset b/R is positive to the right of the ball's centre, seen along the cue; squirt is then positive and turns "
    "the ball to the left of the cue's line; spin about the vertical is then counter-clockwise from above. Squirt and "
    "spin change their sign with the offset"
)
READING = (
    "find the rows below and above the cue speed, and the position t of its logarithm between theirs; interpolate "
    "limit, the largest b/R without a miscue, by t; u = |offset| / limit, a miscue above 1; interpolate the ratios "
    "linearly by u between shares and by t between rows; squirt = offset * squirt_over_offset, ball speed = speed * "
    "speed_ratio, spin = offset * spin_over_offset * speed / ball radius"
)
UNITS = {
    "mass": "kg",
    "radius": "m",
    "speed": "m/s",
    "share": "1",
    "limit": "1",
    "squirt_over_offset": "rad",
    "speed_ratio": "1",
    "spin_over_offset": "1",
    "offset": "1",
    "squirt": "rad",
    "ball_speed": "m/s",
    "spin": "rad/s",
}
Progress = Callable[[Sequence[Any]], Iterable[Any]]
SHOWN_SPEEDS = (0.2, 0.5, 1.0, 2.0, 4.0, 7.0, 10.0)  # m/s, of the table in a terminal, beside its lowest and highest
CHART_STYLES = ("c1", "c2", "c4", "c3")  # CSS classes


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
    """

    squirt: float
    ball_speed: float
    spin: float


@dataclass(frozen=True)
class StrikeTable(Analysis):
    """The strike of a cue over cue speed and tip offset, for games.

    Parameters
    ----------
    scene : Scene
        The cue, the ball and the tip; its own stroke does not matter.
    speed : tuple of float
        Cue speed of each row, m/s, ascending.
    share : tuple of float
        Share of the miscue limit of each column, from 0 to 1, ascending.
    limit : tuple of float
        The largest b/R without a miscue at each speed.
    squirt_over_offset : tuple of tuple of float
        Squirt over b/R, rad, a row for each speed.
    speed_ratio : tuple of tuple of float
        Speed of the ball over speed of the cue.
    spin_over_offset : tuple of tuple of float
        Spin times the ball's radius over cue speed and b/R.
    error : dict
        Of random strokes below the limit: their number "strokes", the part "within" `TOLERANCE`, and the relative
        "error" of squirt, speed and spin: median, 95 %, 99 %, largest.
    example : dict
        A stroke, what the table gives, and what the coupled strike gives.
    """

    speed: tuple[float, ...]
    share: tuple[float, ...]
    limit: tuple[float, ...]
    squirt_over_offset: tuple[tuple[float, ...], ...]
    speed_ratio: tuple[tuple[float, ...], ...]
    spin_over_offset: tuple[tuple[float, ...], ...]
    error: Record
    example: Record

    def at(self, speed: float, offset: float) -> TableStroke:
        """Interpolate a stroke, as a game does.

        Parameters
        ----------
        speed : float
            Cue speed, m/s, within the table's.
        offset : float
            Tip offset b/R, within the miscue limit at that speed.

        Returns
        -------
        TableStroke

        Raises
        ------
        ValueError
            Beyond the speeds of the table, or beyond the miscue limit.
        """
        return self.grid().stroke(float(speed), float(offset), self.scene.ball.radius)

    def grid(self) -> Grid:
        """The table as arrays."""
        ratios = np.stack([np.array(getattr(self, name)) for name in FIELDS], axis=-1)
        return Grid(np.array(self.speed), np.array(self.share), np.array(self.limit), ratios)

    def to_dict(self) -> Record:
        """The record of the file: the table, with units, signs and how to read it."""
        ball = {"mass": self.scene.ball.mass, "radius": self.scene.ball.radius}
        about = {"reading": READING, "signs": SIGNS, "miscue": MISCUE_DEFINITION}
        return about | {"ball": ball, **self.values(), "units": UNITS, "scene": scene_record(self.scene)}

    def tables(self) -> list[Table | str]:
        """Strokes read off the table, and the error of interpolation."""
        low, high = self.speed[0], self.speed[-1]
        between = (speed for speed in SHOWN_SPEEDS if low < speed < high)
        rows = [self._row(speed) for speed in (low, *between, high)]
        head = ("cue speed", "miscue limit b/R", *(f"{RESULTS[name].label}, b/R {self._shown:g}" for name in _SHOWN))
        notes = (
            f"{len(self.share)} shares of the miscue limit by {len(self.speed)} cue speeds",
            assumptions(scene_record(self.scene)),
            f"miscue: {MISCUE_DEFINITION}",
        )
        return [Table("Strike table", head, tuple(rows), notes), "", self._error_table()]

    @property
    def _shown(self) -> float:
        """b/R of the table in a terminal: within every limit."""
        return min(0.3, math.floor(50 * min(self.limit)) / 100)

    def _row(self, speed: float) -> tuple[str, ...]:
        limit = np.interp(math.log(speed), np.log(self.speed), self.limit)
        read = self.at(speed, self._shown)._asdict()
        return (format_value("speed", speed), f"{limit:.3f}", *(format_value(name, read[name]) for name in _SHOWN))

    def _error_table(self) -> Table:
        columns = ("median", "95 %", "99 %", "largest")
        rows = [
            (FIELDS[name], *(f"{100 * self.error['error'][name][column]:.2f} %" for column in columns))
            for name in FIELDS
        ]
        within = f"{100 * self.error['within']:.1f} % of them within {100 * TOLERANCE:g} %"
        title = f"Error of interpolation, {self.error['strokes']} random strokes below the limit"
        return Table(title, ("", *columns), tuple(rows), (f"{within}; drawn evenly in share and logarithm of speed",))

    def charts(self) -> list[Chart]:
        """Squirt against b/R at some cue speeds."""
        from cuefem.show.charts import Axis, Curve, chart

        rows = [int(i) for i in np.linspace(0, len(self.speed) - 1, len(CHART_STYLES))]
        curves = []
        for row, style in zip(rows, CHART_STYLES, strict=True):
            offsets = np.array(self.share) * self.limit[row]
            squirt = np.degrees(offsets * np.array(self.squirt_over_offset[row]))
            curves.append(Curve(format_value("speed", self.speed[row]), offsets, squirt, style))
        return [
            chart("Squirt up to the miscue limit", curves, x=Axis("tip offset b/R", 0.0), y=Axis("squirt, degrees"))
        ]


_SHOWN = ("squirt", "ball_speed", "spin")


@dataclass(frozen=True, eq=False)
class Grid:
    """A grid of ratios, (speeds, shares, fields), with the limit at each speed, and linear interpolation between."""

    speed: Array
    share: Array
    limit: Array
    ratios: Array

    def stroke(self, speed: float, offset: float, radius: float) -> TableStroke:
        """Interpolate a stroke; ValueError beyond the speeds or the miscue limit."""
        low, high = self.speed[[0, -1]]
        if not low <= speed <= high:
            raise ValueError(f"strike_table speed must be in [{low:.4g}, {high:.4g}] m/s, the table's; got {speed}")
        limit = self.limit_at(speed)
        if not abs(offset) <= limit:
            problem = (
                f"must be in [-{limit:.4f}, {limit:.4f}] b/R at {speed:g} m/s, beyond which the stroke is a miscue"
            )
            raise ValueError(f"strike_table offset {problem}; got {offset}")
        squirt, ball_speed, spin = self.ratios_at(speed, abs(offset) / limit)
        return TableStroke(offset * squirt, speed * ball_speed, offset * spin * speed / radius)

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
    """Strikes of one cue by speed and share, each computed once: x is the position of log speed in its range."""

    def __init__(self, scene: Scene, speeds: Sequence[float]) -> None:
        self.scene, self.speeds = scene, (speeds[0], speeds[-1])
        self.tip = SolvedScene(scene).tip
        self._limits: dict[float, float] = {}
        self._ratios: dict[tuple[float, float], Array] = {}

    def speed(self, x: float) -> float:
        """Cue speed at a position."""
        low, high = self.speeds
        return float(f"{low * (high / low) ** x:.{DIGITS}g}")

    def strike(self, speed: float, offset: float) -> Outcome:
        """The coupled strike."""
        return strike_modes(replace(self.scene, stroke=Stroke(speed, offset)), self.tip)

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


def strike_table(scene: Scene, speeds: tuple[float, float] = SPEEDS, *, progress: Progress = list) -> StrikeTable:
    """Tabulate squirt, ball speed and spin of a cue over cue speed and tip offset, for games.

    Parameters
    ----------
    scene : Scene
        The cue, the ball and the tip; its own stroke does not matter.
    speeds : tuple of float
        Lowest and highest cue speed, m/s.
    progress : callable
        Wraps the rounds of refinement, to show progress.

    Returns
    -------
    StrikeTable
        ``save("table.json")`` writes it with units, signs, its error and an example.

    Raises
    ------
    ValueError
        For an elevated cue, for speeds that do not ascend, or if a stroke miscues next to the ball's centre.

    Notes
    -----
    The grid starts with `COARSE` cells in each direction. A line of nodes is added midway between two others where
    interpolation between them is wrong by more than half of `TOLERANCE`, until such cells cover less than a part of the
    range; that part is halved until the tolerance holds for `WITHIN` of `STROKES` random strokes.

    Examples
    --------
    >>> import cuefem as cf
    >>> scene = cf.Scene(cf.LumpedCue(0.54, 0.01), cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.6, 1e-3))
    >>> table = cf.strike_table(scene, (1.0, 4.0))
    >>> direct = cf.strike(cf.Scene(scene.cue, scene.ball, scene.tip, cf.Stroke(3.0, 0.4)))
    >>> abs(table.at(3.0, 0.4).squirt / direct.squirt - 1) < 0.01
    True
    """
    check_kind("strike_table scene", scene, Scene)
    if scene.contact_terms.table is not None:
        raise ValueError("strike_table scene must have a level cue; got an elevated one, whose ball leaves the plane")
    low, high = (Stroke(float(speed)).speed for speed in speeds)
    if not low < high:
        raise ValueError(
            f"strike_table speeds must ascend, the lowest before the highest; got {low:g} and {high:g} m/s"
        )
    strikes = Strikes(scene, (low, high))
    try:
        strikes.strike(high, CENTRE)
    except IndentationOutOfRange as error:
        raise ValueError(f"strike_table speeds must be lower than {high:g} m/s: {error}") from None
    grid, errors = _Refinement(strikes).run(progress)
    squirt, ball_speed, spin = (tuple(map(tuple, grid.ratios[:, :, k].tolist())) for k in range(len(FIELDS)))
    return StrikeTable(
        scene,
        speed=tuple(map(float, grid.speed)),
        share=tuple(map(float, grid.share)),
        limit=tuple(map(float, grid.limit)),
        squirt_over_offset=squirt,
        speed_ratio=ball_speed,
        spin_over_offset=spin,
        error=_error_record(errors),
        example=_example(strikes, grid),
    )


class _Refinement:
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
    """Relative errors; of values near zero relative to `SMALL_RATIOS`."""
    return np.abs(value - true) / np.maximum(np.abs(true), SMALL_RATIOS)


def within_tolerance(errors: Array) -> float:
    """The part of strokes with all fields within the tolerance."""
    return float(np.mean(errors.max(axis=1) <= TOLERANCE))


def _error_record(errors: Array) -> Record:
    """Statistics of the errors by field."""
    quantiles = {"median": 0.5, "95 %": 0.95, "99 %": 0.99, "largest": 1.0}
    values = {
        name: {q: float(np.quantile(errors[:, k], p)) for q, p in quantiles.items()} for k, name in enumerate(FIELDS)
    }
    return {"strokes": len(errors), "within": within_tolerance(errors), "error": values}


def _example(strikes: Strikes, grid: Grid) -> Record:
    """A stroke in the middle of the table, as the table has it and as the coupled strike does."""
    speed = strikes.speed(0.5)
    offset = round(grid.limit_at(speed) / 2, 3)
    outcome = strikes.strike(speed, offset)
    own = TableStroke(float(outcome.squirt), float(outcome.ball_speed), float(outcome.spin))
    read = grid.stroke(speed, offset, strikes.scene.ball.radius)
    return {"speed": speed, "offset": offset, "table": read._asdict(), "strike": own._asdict()}
