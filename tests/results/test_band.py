"""The model's errors are those of the measured cues, nothing fitted (validation)."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from cuefem.io.documented import load_documented
from cuefem.measured.kinds import AddedMass, Squirt
from cuefem.results.band import LEVEL, LEVEL_OF_SPRING, OF_DIFFERENCE
from studies.measured import measured
from studies.measured import measured_shafts as shafts

MEASURED = Path(__file__).parents[2] / "studies" / "measured"
CUES = ("players_maple", "predator_z", "stinger")


@cache
def pairs(name: str, kind: type) -> list[tuple[float, float]]:
    """Measured and computed values of a kind on one cue."""
    cue, _ = load_documented(MEASURED / name)
    return [
        (one.measured, float(value)) for one, value in zip(cue.found, cue.computed(), strict=True) if type(one) is kind
    ]


def rms(values: list[float]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.mark.heavy
def test_the_error_of_a_level() -> None:
    strokes = [pair for name in CUES for pair in pairs(name, Squirt)]
    assert len(strokes) == 7
    assert round(rms([found / ours - 1 for found, ours in strokes]), 2) == LEVEL


@pytest.mark.heavy
def test_the_error_of_a_level_with_a_spring() -> None:
    """The larger of those with dome and shear and without."""
    errors = [
        rms([row.squirt / measured.usual(row, model) - 1 for row in shafts.measurements()])
        for model in ("bare", "dome + shear")
    ]
    assert round(max(errors), 2) == LEVEL_OF_SPRING


@pytest.mark.heavy
def test_the_error_of_a_difference() -> None:
    """Of two shafts that were measured at one offset in one series, and of masses on one of them."""
    maple, hollow = pairs("players_maple", Squirt)[2], pairs("predator_z", Squirt)[0]
    shafts_apart = (hollow[0] / maple[0], hollow[1] / maple[1])
    ratios = np.log([shafts_apart, *pairs("players_maple", AddedMass)])
    assert len(ratios) == 32
    found, ours = ratios.T
    assert round(float(np.sqrt(np.sum((found - ours) ** 2) / np.sum(ours**2))), 2) == OF_DIFFERENCE
