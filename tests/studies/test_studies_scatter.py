"""The committed table of the scatter study is what its program gives (regression)."""

from __future__ import annotations

import pytest

from cuefem.design import evaluate
from cuefem.materials import MATERIALS
from studies import scatter
from studies.common import STUDIES
from tests.helpers.committed import not_committed


@pytest.mark.heavy
def test_scatter_table(monkeypatch: pytest.MonkeyPatch) -> None:
    """The text and what is told of the bare tip; LeatherTip's part: test_studies_leather_again.py."""
    committed = (STUDIES / "scatter.md").read_text(encoding="utf-8").split("\n## LeatherTip")[0]
    monkeypatch.setattr(scatter, "MODELS", scatter.MODELS[:1])
    derived = scatter.text()
    left_out = 2 + 5 + len(scatter.FULL.causes)  # two rows of spreads; a heading, a head and the rows of causes
    assert len(derived.splitlines()) == len(committed.splitlines()) - left_out
    assert not_committed(committed, derived) == []


def test_the_causes_are_those_told() -> None:
    assert scatter.FULL.causes == ("wood", "turning", "ferrule", "leather", "ball", "contact time", "dome", "tip shear")
    assert scatter.bare().causes == scatter.FULL.causes[:-2]


def test_the_wood_is_that_of_the_materials_table() -> None:
    """Two standard deviations of G, one of E and of density, are the ranges that materials.py gives for hard maple."""
    maple = MATERIALS["hard maple"]
    for vary, name, width in zip(scatter.FULL.study.vary, ("E", "G", "rho"), (1, 2, 1), strict=False):
        low, high = maple.ranges[name]
        middle = getattr(maple.material, name)
        assert middle * vary.range.quantile(0.5 - (0.3413, 0.4772)[width - 1]) == pytest.approx(low, rel=0.1)
        assert middle * vary.range.quantile(0.5 + (0.3413, 0.4772)[width - 1]) == pytest.approx(high, rel=0.1)


def test_the_middle_design_is_the_drawing() -> None:
    """All causes at their middles: squirt within the table's quartiles."""
    study = scatter.FULL.study
    middle = study.scene(tuple(vary.range.quantile(0.5) for vary in study.vary))
    (row,) = evaluate([middle], study.responses, at=study.resolution).values
    assert 1.488 < row[1] * scatter.SCALES["squirt"][1] < 1.759
