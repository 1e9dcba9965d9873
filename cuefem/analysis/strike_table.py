"""The strike of a cue as a table for games: squirt, ball speed and spin over cue speed and tip offset.

A table has one row for each cue speed and one column for each share of the miscue limit at that speed, so that every
node is a stroke without a miscue and no cell holds the jump at the limit. Squirt and spin are divided by b/R, so that
they stay finite at the centre; everything is a ratio, so that a game may take it in its own units. A reader
interpolates linearly in the share and in the logarithm of the speed.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from cuefem.analysis.strike_grid import (
    CENTRE,
    FIELDS,
    TOLERANCE,
    Grid,
    Refinement,
    Strikes,
    TableStroke,
    within_tolerance,
)
from cuefem.cue import Array
from cuefem.effects.force_law import IndentationOutOfRange
from cuefem.measurements.calibration import Calibration
from cuefem.quantity.display_units import with_unit
from cuefem.results.closed_forms import alciatore_a31_mass_ratio
from cuefem.results.progress import Progress
from cuefem.results.quantities import RESULTS, format_value
from cuefem.results.records import Record, Table
from cuefem.results.verdict import MISCUE_DEFINITION
from cuefem.scene import Scene, Stroke, check_scene
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.charts import Axis, Chart, Curve, chart
from cuefem.show.scene_summary import scene_record, stroke_line

POOLTOOL_INERTIA = 0.4  # of every ball in pooltool 0.6.0
SPEEDS = (0.2, 10.0)  # m/s: from a soft stroke to a break at 22 mph
SIGNS = (
    "offset b/R is positive to the right of the ball's centre, seen along the cue; squirt is then positive and turns "
    "the ball to the left of the cue's line; spin about the vertical is then counter-clockwise from above. Squirt and "
    "spin change their sign with the offset"
)
READING = (
    "find the rows below and above the cue speed, and the position t of its logarithm between theirs, 0 or 1 for a "
    "speed beyond the first or last row; interpolate limit, the largest b/R without a miscue, by t; u = |offset| / "
    "limit, a miscue above 1, which leaves as at 1; interpolate the ratios linearly by u between shares and by t "
    "between rows; squirt = offset * squirt_over_offset, ball speed = speed * speed_ratio, spin = offset * "
    "spin_over_offset * speed / ball radius"
)
FOLLOW = (
    "with the tip a to the right and b above the ball's centre (follow; draw for b < 0), in parts of its radius, read "
    "the ratios at offset = sqrt(a^2 + b^2), in the plane of cue and contact: squirt = a * squirt_over_offset, ball "
    "speed = speed * speed_ratio, spin about the vertical = a * spin_over_offset * speed / ball radius, and spin "
    "forward, about the horizontal axis across the cue, = b * spin_over_offset * speed / ball radius. The vertical "
    "part of squirt, b * squirt_over_offset, is left out: the ball stays on the cloth. A raised cue has no table"
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
SHOWN_SPEEDS = (0.2, 0.5, 1.0, 2.0, 4.0, 7.0, 10.0)  # m/s, of the table in a terminal, beside its lowest and highest
CHART_STYLES = ("c1", "c2", "c4", "c3")  # CSS classes


@dataclass(frozen=True)
class StrikeTable(Rows, Analysis):
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
    calibration : str
        What scales its squirt, if it is calibrated.
    """

    speed: tuple[float, ...]
    share: tuple[float, ...]
    limit: tuple[float, ...]
    squirt_over_offset: tuple[tuple[float, ...], ...]
    speed_ratio: tuple[tuple[float, ...], ...]
    spin_over_offset: tuple[tuple[float, ...], ...]
    error: Record
    example: Record
    calibration: str = ""

    @property
    def pooltool(self) -> Record:
        """The parameters of the cue and the ball in pooltool, whose own strike has no table.

        "end_mass", if there is one, is that with which its formula, [A.31] with an inertia factor of
        `POOLTOOL_INERTIA`, gives the squirt of the example. Dimensions that the cue does not have are left to its
        defaults.
        """
        ball, cue = self.scene.ball, self.scene.cue
        squirt = self.example["table"]["squirt"]
        specs = {"M": self.scene.axial_mass}
        with suppress(ValueError):  # no end mass has such a squirt
            ratio = alciatore_a31_mass_ratio(self.example["offset"], squirt, inertia=POOLTOOL_INERTIA)
            specs["end_mass"] = float(ball.mass / ratio)
        if self.scene.dome_radius:
            specs["tip_radius"] = self.scene.dome_radius
        if cue.segments:
            specs["shaft_radius_at_tip"] = cue.segments[0].tip_diameter / 2
        return {"CueSpecs": specs, "BallParams": {"m": ball.mass, "R": ball.radius}}

    def at(self, speed: float, offset: float) -> TableStroke:
        """Interpolate a stroke, as a game does.

        Parameters
        ----------
        speed : float
            Cue speed, m/s. Beyond the speeds of the table its first or last row is read, and ``clamped`` is true.
        offset : float
            Tip offset b/R. Beyond the miscue limit at that speed the ball leaves as at the limit, and ``miscue`` is
            true.

        Returns
        -------
        TableStroke

        Raises
        ------
        ValueError
            If the speed is negative, or a number is not finite.
        """
        return self.grid().stroke(float(speed), float(offset), self.scene.ball.radius)

    def headline(self) -> str:
        """Its size, and its error."""
        size = f"{len(self.share)} shares of the miscue limit by {len(self.speed)} cue speeds"
        within = f"{100 * self.error['within']:.1f} % of strokes within {100 * TOLERANCE:g} %"
        return f"{size}, {within}"

    def grid(self) -> Grid:
        """The table as arrays."""
        ratios = np.stack([np.array(getattr(self, name)) for name in FIELDS], axis=-1)
        return Grid(np.array(self.speed), np.array(self.share), np.array(self.limit), ratios)

    def to_dict(self) -> Record:
        """The record of the file: the table, with units, signs and how to read it."""
        ball = {"mass": self.scene.ball.mass, "radius": self.scene.ball.radius}
        about = {"reading": READING, "signs": SIGNS, "follow_and_draw": FOLLOW, "miscue": MISCUE_DEFINITION}
        values = {name: value for name, value in self.values().items() if name != "calibration" or value}
        others = {"pooltool": self.pooltool, "units": UNITS, "scene": scene_record(self.scene)}
        return about | {"ball": ball, **values} | others

    def frame_rows(self) -> list[Record]:
        """A row for each speed and share of the miscue limit."""
        return [
            {"speed": speed, "share": share, "offset": share * limit}
            | {name: getattr(self, name)[i][k] for name in FIELDS}
            for i, (speed, limit) in enumerate(zip(self.speed, self.limit, strict=True))
            for k, share in enumerate(self.share)
        ]

    def tables(self) -> list[Table | str]:
        """Strokes read off the table, and the error of interpolation."""
        low, high = self.speed[0], self.speed[-1]
        between = (speed for speed in SHOWN_SPEEDS if low < speed < high)
        rows = [self._row(speed) for speed in (low, *between, high)]
        head = ("cue speed", "miscue limit b/R", *(f"{RESULTS[name].label}, b/R {self._shown:g}" for name in _SHOWN))
        notes = (
            f"{len(self.share)} shares of the miscue limit by {len(self.speed)} cue speeds",
            stroke_line(self.scene),
            f"miscue: {MISCUE_DEFINITION}",
            *([self.calibration] if self.calibration else []),
        )
        return [Table("Strike table", head, tuple(rows), notes), "", self._error_table()]

    @property
    def _shown(self) -> float:
        """b/R of the table in a terminal: within every limit."""
        return min(0.3, math.floor(50 * min(self.limit)) / 100)

    def _row(self, speed: float) -> tuple[str, ...]:
        limit = self.grid().limit_at(speed)
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


def strike_table(
    scene: Scene,
    speeds: tuple[float, float] = SPEEDS,
    *,
    calibration: Calibration | None = None,
    progress: Progress = list,
) -> StrikeTable:
    """Tabulate squirt, ball speed and spin of a cue over cue speed and tip offset, for games.

    Parameters
    ----------
    scene : Scene
        The cue, the ball and the tip; its own stroke does not matter.
    speeds : tuple of float
        Lowest and highest cue speed, m/s.
    calibration : Calibration, optional
        Squirt that was measured on another shaft with the same tip: its factor scales squirt at every speed and offset.
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
    check_scene("strike_table scene", scene)
    if scene.contact_terms.table is not None:
        raise ValueError("strike_table scene must have a level cue; got an elevated one, whose ball leaves the plane")
    low, high = (Stroke(float(speed)).speed for speed in speeds)
    if not low < high:
        got = f"{with_unit(low, 'm/s')} and {with_unit(high, 'm/s')}"
        raise ValueError(f"speeds must ascend, the lowest before the highest; got {got}")
    calibrated = calibration.squirt(scene) if calibration else None
    strikes = Strikes(scene, (low, high), calibrated.factor if calibrated else 1.0)
    try:
        strikes.strike(high, CENTRE)
    except IndentationOutOfRange as error:
        raise ValueError(f"speeds must be lower than {with_unit(high, 'm/s')}: {error}") from None
    grid, errors = Refinement(strikes).run(progress)
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
        calibration=calibrated.origin() if calibrated else "",
    )


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
    own = {name: float(getattr(outcome, name)) for name in _SHOWN}
    read = grid.stroke(speed, offset, strikes.scene.ball.radius)._asdict()
    return {"speed": speed, "offset": offset, "table": {name: read[name] for name in own}, "strike": own}
