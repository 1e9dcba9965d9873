"""The rules by which a shrinking patch lets go: stepped in another way than cuefem does, and their account of energy
(verification); the committed page derived again (regression, heavy)."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from cuefem import AxialWaves, Tip, strike
from cuefem.effects import Effect
from cuefem.validation import disagreements
from studies import leather_release as study
from studies.common import STUDIES


@pytest.mark.parametrize(
    ("offset", "partial", "more"),
    [(0.2, False, ()), (-0.2, False, ()), (0.45, False, ()), (0.2, True, ()), (-0.45, True, (AxialWaves(),))],
)
def test_what_cuefem_computes_is_stepped_alike(offset: float, partial: bool, more: tuple[Effect, ...]) -> None:
    scene = study.struck_scene(offset, leather=replace(study.LEATHER, partial_slip=partial), more=more)
    ours, theirs = strike(scene), study.stepped(scene, "rings that slip" if partial else "scaled", 2e-6)
    first = ours.energy["initial"]
    assert theirs.squirt == pytest.approx(math.degrees(ours.squirt), rel=2e-3)
    assert theirs.time == pytest.approx(1e3 * ours.duration, abs=4e-3)  # it ends with a step
    assert theirs.lost == pytest.approx(ours.energy["tip shear"] / first, rel=6e-3, abs=1e-5)
    assert theirs.slid == pytest.approx(ours.energy["friction loss"] / first, rel=0.02, abs=1e-4)


@pytest.mark.parametrize("rule", study.RULES)
def test_the_account_closes_with_the_square_of_the_step(rule: str) -> None:
    scene = study.struck_scene(0.375, tip=Tip(1.0, 0.7))
    coarse, fine = (study.stepped(scene, rule, step) for step in (4e-6, 2e-6))
    assert coarse.missing / fine.missing == pytest.approx(4, rel=0.15)
    assert min(fine.lost, fine.slid) >= 0


def test_the_rings_without_slip_depend_on_their_number_only_a_little() -> None:
    few, many = (study.stepped(study.struck_scene(), "rings", 2e-6, count) for count in (100, 400))
    assert few.squirt == pytest.approx(many.squirt, rel=2e-4)


@pytest.mark.heavy
def test_the_page_again() -> None:
    assert disagreements((STUDIES / "leather_release.md").read_text(encoding="utf-8"), study.text()) == []
