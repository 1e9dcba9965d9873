"""The contest with peers: everyone's numbers are right to the error the committed table claims (regression).

Peers that are not installed are left out here as there; scikit-fem always is.
"""

import re
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("Agg")
import cuefem as cf
from studies.accuracy.peers import cone, contest, ours, report, scikit_fem

COMMITTED = (Path(report.__file__).parent / "peers.md").read_text(encoding="utf-8")
EXACT = {"modes": ours.modes(cf.Resolution(7, 11, cone.MODES))}


@pytest.fixture(scope="module")
def exact():
    return ours.reference()


def committed(task: str) -> dict[str, str]:
    """Error by label, as the committed table prints it."""
    section = COMMITTED.split(f"## {report.TITLES[task]}")[1].split("##")[0]
    return dict(re.findall(r"^\| (.+?) \| (< 1e-08|\S+e-\d\d) \|", section, re.MULTILINE))


@pytest.mark.parametrize("label", scikit_fem.CONTESTANTS["modes"])
def test_scikit_fem_modes(label):
    found, _ = contest.errors("modes", scikit_fem.CONTESTANTS["modes"][label](), EXACT["modes"])
    assert report.shown(found) == committed("modes")[label]


def test_the_cone_is_the_shaft_of_meshes():
    kim = cf.load(cone.KIM)
    np.testing.assert_allclose(cf.modes(kim, 5).frequencies, ours.modes(), rtol=1e-11)


@pytest.mark.heavy
def test_the_reference_is_settled(exact):
    """Two thirds of its modes change the median end mass by less than 2e-6, and none by 5e-5."""
    off = np.abs(ours.end_masses(200) / exact["end_mass"] - 1)
    assert 0 < np.median(off) < 2e-6
    assert off.max() < 5e-5


@pytest.mark.heavy
def test_end_masses(exact):
    quick = [(scikit_fem, "scikit-fem P2 x 20, 200 steps"), *((ours, name) for name in ours.CONTESTANTS["end_mass"])]
    for peer, label in quick:
        _, answers = contest.answers(peer.__name__.rsplit(".", 1)[1], "end_mass", label)
        median, high = contest.errors("end_mass", answers, exact["end_mass"])
        found = re.search(rf"^\| {re.escape(label)} \| (\S+) \| (\S+) \|", COMMITTED, re.MULTILINE)
        assert found is not None
        np.testing.assert_allclose((median, high), [float(part) for part in found.groups()], rtol=0.1, err_msg=label)


def test_an_end_mass_of_scikit_fem():
    found, own = scikit_fem.end_mass(2, 80, 800), ours.end_mass()
    assert 1e-6 < abs(found / own - 1) < 2e-4  # each within 1e-4 of the truth


def test_the_bare_eigenproblem_is_that_of_cuefem():
    for label in ("LAPACK dsygvd alone", "scipy.linalg.eigh alone"):
        np.testing.assert_allclose(ours.CONTESTANTS["modes"][label](), ours.modes(), rtol=1e-10)


@pytest.mark.heavy
def test_a_peer_that_is_missing_is_skipped_with_a_word(monkeypatch, tmp_path):
    monkeypatch.setattr(contest, "ROUNDS", 1)
    monkeypatch.setattr(contest, "TURN", 0.0)
    heard = []
    held = contest.hold(
        {**EXACT, "end_mass": np.full(len(cone.CASES), 0.0173352)}, ("ours", "no_such_peer"), heard.append
    )
    assert (
        heard[1] == "no_such_peer: skipped, not installed here: No module named 'studies.accuracy.peers.no_such_peer'"
    )
    page = report.text(held)
    assert "no_such_peer: not installed here: No module named" in page
    assert "| modes | 1e-06 | OpenSeesPy x 1240 | at least 140 |  |  |" in page
    assert held.quickest("modes", "ours").error < 1e-6
    report.draw(held, tmp_path / "peers.png")
