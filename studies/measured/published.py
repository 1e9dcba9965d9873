"""Published and computed squirt of real cues: the rows that the pages of this folder share.

The folders beside this file contain cues, strokes, measured values and their sources. Models: "bare tip", and the
"full model" of the folder's scene.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache, partial
from typing import NamedTuple

import cuefem as cf
from cuefem.measurements.measured_cue import MeasuredCue
from cuefem.measurements.measured_folder import load_measured
from cuefem.measurements.measurement_types import AddedMass, Measurement, PivotLength, Setup, Squirt
from cuefem.parameters.scene_paths import parameter
from cuefem.results.uncertainty import changes_by_input
from studies import pages, strokes
from studies.strokes import INCH

HOME = pages.STUDIES / "measured"
PLAYERS, PREDATOR, STINGER = CUES = ("players_maple", "predator_z", "stinger")
MODELS = ("bare tip", "full model")
INCHES = (2, 3, 4, 5, 6, 6.5, 7, 8, 9, 10)
RADIUS = strokes.POOL.radius


@cache
def measured(folder: str, model: str, kinds: tuple[type, ...] = (Squirt, PivotLength)) -> MeasuredCue:
    """A published cue in a model, with its measurements of some kinds."""
    cue, _ = load_measured(HOME / folder)
    scene = cue.scene
    if model == "bare tip":
        scene = replace(
            scene.without_tip_effects,
            tip=replace(scene.without_tip_effects.tip, restitution=0.85 if folder == STINGER else 0.73),
        )
    return replace(cue, scene=scene, measurements=tuple(m for m in cue.measurements if isinstance(m, kinds)))


class Row(NamedTuple):
    """A published value and the model's, SI.

    difference: logarithm of measured over computed, as squirt. inputs: what each uncertain input changes in it.
    """

    folder: str
    name: str
    series: str
    offset: float
    pivot: bool
    measured: float
    computed: float
    difference: float
    inputs: dict[str, float]

    def over(self, other: Row) -> tuple[float, float]:
        """Measured and computed logarithm of this squirt over another that was measured in the same way.

        Of pivot lengths that of squirt by offset: p + R goes as 1/sin(squirt).
        """
        ratios = ((self.measured, other.measured), (self.computed, other.computed))
        if self.pivot:
            ratios = tuple((b + RADIUS, a + RADIUS) for a, b in ratios)
        measured, computed = (math.log(a / b) for a, b in ratios)
        return measured, computed

    @property
    def texts(self) -> tuple[str, str, str]:
        """Offset, measured and computed value as they are published."""
        values = (self.measured, self.computed)
        printed = (f"{v / INCH:.1f} in" if self.pivot else f"{math.degrees(v):.2f}°" for v in values)
        return (f"{self.offset:.3f}", *printed)


def as_squirt(measurement: Measurement, value: float) -> float:
    """A value that is proportional to squirt: a pivot length p as 1/(p + R)."""
    return 1 / (value + RADIUS) if isinstance(measurement, PivotLength) else value


def squirts(cue: MeasuredCue, scene: cf.Scene) -> dict[str, float]:
    """The measurements of a cue as squirts, computed with another scene."""
    return {str(i): as_squirt(m, float(m.compute(Setup(scene)))) for i, m in enumerate(cue.measurements)}


@cache
def rows(model: str) -> tuple[Row, ...]:
    """Every published squirt and pivot length."""
    result = []
    for folder in CUES:
        cue = measured(folder, model)
        spreads = {entry.key: each.spread for each in cue.parameters if (entry := parameter(each.name))}
        at = cue.compute().tolist()
        base = {str(i): as_squirt(m, value) for i, (m, value) in enumerate(zip(cue.measurements, at, strict=True))}
        changes = changes_by_input(cue.scene, base, partial(squirts, cue), spreads=spreads).relative
        for i, (m, value) in enumerate(zip(cue.measurements, at, strict=True)):
            assert isinstance(m, Squirt | PivotLength)
            pivot = isinstance(m, PivotLength)
            difference = math.log(as_squirt(m, m.measured_value) / base[str(i)])
            inputs = {key: change[str(i)] for key, change in changes.items()}
            by_hand = isinstance(m, Squirt) and m.series == "2007"
            series = cue.name if folder != PLAYERS else "angles, 2007" if by_hand else "robot, 2008"
            result.append(Row(folder, cue.name, series, m.offset, pivot, m.measured_value, value, difference, inputs))
    return tuple(result)


def series(model: str) -> dict[str, tuple[Row, ...]]:
    """The rows by independent series."""
    names = dict.fromkeys(row.series for row in rows(model))
    return {name: tuple(row for row in rows(model) if row.series == name) for name in names}


@cache
def mass_ratios(model: str = "full model") -> dict[tuple[int, float], tuple[float, float]]:
    """Measured and computed squirt ratio of the Players shaft by the mass on it, g, and its distance, in."""
    cue = measured(PLAYERS, model, (AddedMass,))
    return {
        (round(1e3 * m.mass), round(m.position / INCH, 2)): (m.measured_value, float(value))
        for m, value in zip(cue.measurements, cue.compute(), strict=True)
        if isinstance(m, AddedMass)
    }
