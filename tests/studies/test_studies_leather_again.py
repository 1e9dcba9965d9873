"""LeatherTip in the studies that stood before it: rows of their committed tables derived again (regression)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem.design import evaluate
from cuefem.validation import disagreements
from studies import added_mass_leather, dome_leather, effects, low_squirt, measured_leather, pool, scatter
from studies import measured_shafts as shafts
from studies.common import STUDIES

MODERN = pool.MODERN
PREDICTIONS = {
    "measured": measured_leather.PREDICTED,
    "added_mass": added_mass_leather.PREDICTED,
    "dome": dome_leather.PREDICTED,
    "effects": effects.PREDICTED,
    "scatter": scatter.PREDICTED,
    "low_squirt": low_squirt.PREDICTED,
}


def page(name: str) -> str:
    """The part of a committed page that is about LeatherTip."""
    text = (STUDIES / f"{name}.md").read_text(encoding="utf-8")
    return text[text.index("\n## LeatherTip") :]


def row(name: str, *starts: str) -> list[str]:
    """Cells of the one row of a page that starts so."""
    rows = [
        [cell.strip() for cell in line.split("|")[1:-1]] for line in page(name).splitlines() if line.startswith("| ")
    ]
    (found,) = [cells for cells in rows if tuple(cells[: len(starts)]) == starts]
    return found


@pytest.mark.parametrize("name", PREDICTIONS)
def test_predictions_stand_beside_what_was_found(name: str) -> None:
    for number, said in PREDICTIONS[name].items():
        cells = row(name, number)
        assert cells[1] == said
        assert cells[2]


@pytest.mark.parametrize("place", [1, 5])  # the middle of the series of 2007, and the low-deflection shaft
def test_measured_levels(place: int) -> None:
    measured = shafts.measurements()[place]
    cells = row("measured", measured.cue)
    assert cells[5] == f"{measured_leather.usual(measured, MODERN):.2f}"
    assert cells[4] == f"{measured_leather.usual(measured, measured_leather.BOTH):.2f}"


@pytest.mark.heavy
def test_a_band_and_a_zero() -> None:
    measured = shafts.robot()
    low, high = measured_leather.band(measured.shaft, measured.offset)
    assert row("measured", measured.cue)[6] == f"{low:.2f} to {high:.2f}"
    assert disagreements(measured_leather.series_table(), _table("measured", "| b/R as told")) == []
    assert f"LeatherTip {1e3 * measured_leather.best_zero(MODERN):.1f}." in page("measured")


def _table(name: str, start: str) -> str:
    lines = page(name).splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith(start))
    return "\n".join(lines[first : lines.index("", first)]) + "\n"


def test_the_bore_that_the_stiffness_asks_for() -> None:
    """The last 8 in are as stiff as was measured; the answers bracket the bores that the studies use."""
    E = shafts.USUAL["maple's E, Pa"]
    bore = shafts.asked_bore(E, measured_leather.DEPTHS[0])
    end = shafts.end_of(shafts.bored(bore, E, measured_leather.DEPTHS[0]), shafts.END)
    assert end.length == pytest.approx(0.2032, rel=1e-9)
    assert shafts.stiffness(end) == pytest.approx(3480, rel=1e-9)
    assert bore == pytest.approx(pool.BORES[-1], abs=0.05e-3)
    assert disagreements(measured_leather.bore_table(), _table("measured", "| E of the wood")) == []


def test_added_mass() -> None:
    E = pool.LEATHER.E
    cells = row("added_mass", MODERN, f"{E / 1e6:g}")
    assert cells[3] == f"{added_mass_leather.ratio(MODERN, E, 2):.2f}"
    assert cells[9] == f"{added_mass_leather.ratio(MODERN, E, 7):.2f}"


@pytest.mark.heavy
def test_shares_of_the_small_clip() -> None:
    assert disagreements(added_mass_leather.share_table(), _table("added_mass", "| inches")) == []


def test_dome() -> None:
    for tip, model in (("patchwork", dome_leather.patchwork), (MODERN, dome_leather.leather)):
        cells = row("dome", "pool_maple", tip)
        assert (cells[3], cells[6]) == (f"{model('pool_maple', 9.5e-3):.2f}", f"{model('pool_maple', np.inf):.2f}")


@pytest.mark.heavy
def test_a_scene_with_the_leather_that_makes_its_contact_time() -> None:
    struck = effects.leather_scene("carom")
    cells = row("effects", "carom")
    assert cells[1] == f"{struck.leather.E / 1e6:.0f}"
    assert cells[3] == f"{np.degrees(effects.strike(struck).squirt):.2f}"
    assert cells[4] == f"{100 * effects.leather_worth('carom')['AxialWaves']:+.1f}"


def test_low_squirt() -> None:
    """The optimum of the bare model gains little with a real tip."""
    shafts_there = {"hollow front": low_squirt.cue("pool_hollow"), "solid pro taper": low_squirt.cue("pool_maple")}
    for words, shaft in shafts_there.items():
        cells = row("low_squirt", words)
        assert [cells[1], cells[3], cells[5]] == [f"{squirt:.2f}" for squirt in low_squirt.leather_squirt(shaft)]
    cells = row("low_squirt", low_squirt.OPTIMUM)
    assert float(cells[2]) < 0.45
    assert float(cells[6]) > 0.65


def test_the_middle_shaft_of_the_scatter() -> None:
    study = scatter.LEATHER.study
    middle = study.scene(tuple(vary.range.quantile(0.5) for vary in study.vary))
    (found,) = evaluate([middle], study.responses, at=study.resolution).values
    cells = [float(cell) for cell in row("scatter", "squirt, °, LeatherTip")[1:]]
    assert cells[3] < np.degrees(found[0]) < cells[5]


@pytest.mark.heavy
def test_the_scatter_with_leather() -> None:
    assert disagreements(scatter.leather_text(), page("scatter").lstrip("\n")) == []
