"""The committed tables of accuracy_cost.py derived again, and what its three sentences say checked (regression)."""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("Agg")
sys.path.append(str(Path(__file__).parents[2] / "studies"))
import accuracy_cost
import accuracy_cost_points as points

from tests.helpers.committed import not_committed

COMMITTED = (Path(__file__).parents[2] / "studies" / "accuracy_cost.md").read_text(encoding="utf-8")


# Of the models, those that the page's sentences name; the last is what they are held against.
NAMED = ("paper's closed form, 12 g", "lumped, stick end mass", "coupled", "... and dome", "... and tip shear")


@pytest.mark.heavy
def test_the_committed_table(monkeypatch):
    """The text and all tables, without five of the eleven models."""
    models = points.models()
    kept = {name: models[name] for name in (*NAMED, list(models)[-1])}
    monkeypatch.setattr(points, "models", lambda: kept)
    derived = accuracy_cost.report()
    assert len(derived.splitlines()) == len(COMMITTED.splitlines()) - len(models) + len(kept)
    assert not_committed(COMMITTED, derived) == []


def test_the_table_of_the_beam():
    assert accuracy_cost.beam_table() in COMMITTED


def test_order_pays_more_than_elements():
    for many, few in (((8, 4), (4, 8)), ((8, 8), (4, 16))):
        rough, fine = accuracy_cost.point(*many), accuracy_cost.point(*few)
        assert fine.unknowns < rough.unknowns < 1.1 * fine.unknowns
        assert fine.error < rough.error / 10


@pytest.mark.heavy
def test_a_tail_pays_more_than_modes():
    plain, ended = (points.mode_points(by_tail=by_tail) for by_tail in (False, True))
    assert all(t.error < p.error / 2 for p, t in zip(plain, ended, strict=True))
    assert 20 < plain[-1].error / ended[-1].error < 80
    assert ended[1].error < plain[-1].error  # 17 modes with a tail beat 96 without


@pytest.mark.heavy
def test_the_contact_adds_nothing():
    exact, newmark = (accuracy_cost.curves("contact")[name] for name in ("exact", "Newmark"))
    assert exact[0].error < 1e-12
    errors = np.array([p.error for p in newmark])
    np.testing.assert_allclose(errors[:-1] / errors[1:], 4, rtol=0.1)  # second order
    assert 1e-7 < errors[0] < 1e-5


@pytest.mark.heavy
def test_no_refinement_makes_up_for_the_model():
    off = {name: np.median(np.abs(points.model_errors(name))) for name in NAMED}
    assert 0.5 < off["paper's closed form, 12 g"] < 0.65
    assert off["paper's closed form, 12 g"] > 2 * off["lumped, stick end mass"]
    assert 0.1 < off["coupled"] < 0.25
    assert off["... and tip shear"] < off["coupled"] / 3


def test_omissions_and_the_machine_are_named():
    assert all(name in accuracy_cost.__doc__ for name in ("AxialWaves", "SecondHit"))
    seconds = (Path(accuracy_cost.__file__).parent / "accuracy_cost_seconds.md").read_text(encoding="utf-8")
    assert "cores, one BLAS thread" in seconds
