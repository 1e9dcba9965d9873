"""The committed table of default_accuracy.py: a sample of its rows derived again, and what is said of it."""

import sys
from pathlib import Path

import matplotlib as mpl
import pytest

mpl.use("Agg")
sys.path.append(str(Path(__file__).parents[2] / "studies"))
import default_accuracy as study

COMMITTED = (Path(__file__).parents[2] / "studies" / "default_accuracy.md").read_text(encoding="utf-8")
TABLE = [[cell.strip() for cell in line.split("|")[1:-1]] for line in COMMITTED.splitlines() if line.startswith("|")]
ROWS = TABLE[2:]


def committed(what: str, cue: str) -> list[str]:
    return next(row for row in ROWS if row[:2] == [what, cue])


def assert_printed(row: list[object]) -> None:
    """The per cents are those of the table, to one of its last digits."""
    found = [float(cell) for cell in row[4:] if cell]
    assert found == pytest.approx([float(cell) for cell in committed(row[0], row[1])[4:] if cell], abs=0.011)


@pytest.mark.heavy
@pytest.mark.parametrize("name", ["kim", "carbon"])
def test_stick_end_masses_again(name: str) -> None:
    found = study.stuck(name)
    assert_printed(study.row(name, [name], "stick end mass", found.errors, found.estimates))


@pytest.mark.heavy
@pytest.mark.parametrize("drive", ["force", "velocity"])
@pytest.mark.parametrize("name", ["kim", "pool_maple"])
def test_end_masses_of_smooth_drives_again(name: str, drive: str) -> None:
    assert_printed(study.row(name, [name], f"{drive} end mass", study.driven(name, drive)))


@pytest.mark.heavy
def test_squirt_again() -> None:
    assert_printed(study.row("carbon", ["carbon"], "squirt", study.struck("carbon", study.STRIKES, False)))


def test_half_a_percent_or_an_estimate_above_it() -> None:
    """The default holds 0.5 %, but for brass, one random cue (0.53 %; the estimates tell) and one force (0.51 %)."""
    for what, cue, _, count, _, most, largest, _, ratio in ROWS:
        least = {"stick end mass": 200, "force end mass": 200, "velocity end mass": 40}
        assert int(count) >= least.get(what, 5 if "mass, AxialWaves" in what else 10)
        assert float(most) < 0.62
        if what == "stick end mass" and float(largest) > 0.5:
            assert float(ratio) < 1.3
        else:
            soft_leather = what == "force end mass" and cue == "random, no brass"
            limit = {"squirt": 0.2, "velocity": 0.01}.get(what.split()[0].rstrip(","), 0.5)
            assert float(largest) < (0.52 if soft_leather else limit)
    for drive in ("stick", "force", "velocity"):
        assert sum(int(row[2]) for row in ROWS if row[0] == f"{drive} end mass") == 45
