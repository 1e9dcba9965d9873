"""Solid cues through the public doors: a strike, masses on the tip, files, refusals in words (properties)."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cuefem as cf
from cuefem.io import InputError
from cuefem.solid.half_section import Fineness
from cuefem.solid.shaft import Body
from tests.helpers.command_line import call

MESHES = Path(__file__).parents[2] / "meshes"
WOOD = cf.Material(E=12.6e9, G=1.1e9, rho=700.0, nu=0.45, across_ratio=0.0985, nu_across=0.52)
CONE = cf.Segment(0.7, 0.012, 0.021, WOOD)
SCENE = cf.Scene(cf.Cue((CONE,), body_mass=0.42), tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
COARSE = cf.Solid(order=4, modes=20)


def test_a_strike_on_the_solid_is_near_that_on_the_beam() -> None:
    """The scene stays the same; as many modes on both sides, and the solid's order is what is left."""
    beam = cf.strike(SCENE, at=cf.Resolution(3, 16, 20))
    solid, finer = (cf.strike(SCENE, at=cf.Solid(order, 20)) for order in (5, 6))
    assert abs(solid.squirt / finer.squirt - 1) < 2e-5
    assert 0 < abs(beam.squirt / finer.squirt - 1) < 2e-3


@settings(max_examples=3, deadline=None)
@given(mass=st.floats(1e-4, 5e-3))
def test_a_mass_on_the_tip_works_on_a_solid_as_on_a_beam(mass: float) -> None:
    laden = replace(SCENE, effects=(cf.PointMass(0.0, mass),))
    beam, solid = (
        cf.strike(laden, at=at).squirt / cf.strike(SCENE, at=at).squirt for at in (cf.Resolution(3, 16, 20), COARSE)
    )
    assert solid == pytest.approx(beam, rel=2e-3)


def test_two_masses_are_as_good_as_their_sum() -> None:
    one = cf.strike(replace(SCENE, effects=(cf.PointMass(0.0, 3e-3),)), at=COARSE)
    two = cf.strike(replace(SCENE, effects=(cf.PointMass(0.0, 1e-3), cf.PointMass(0.0, 2e-3))), at=COARSE)
    assert two.squirt == pytest.approx(one.squirt, rel=1e-10)


def test_the_modes_of_a_solid_are_those_of_the_beam() -> None:
    beam, solid = cf.modes(SCENE.cue, 4), cf.solid_modes(SCENE.cue, 4)
    assert solid.rigid == beam.rigid == 2
    np.testing.assert_allclose(solid.frequencies, beam.frequencies, rtol=2e-4)
    for ours, theirs in zip(solid.at_tip, beam.at_tip, strict=True):
        np.testing.assert_allclose(ours[2:], theirs[2:], rtol=2e-3)
    assert np.sum(solid.at_tip[0][:2] ** 2) == pytest.approx(np.sum(beam.at_tip[0][:2] ** 2), rel=1e-9)


def test_the_beam_asks_for_no_constant_across_the_axis() -> None:
    plain = replace(WOOD, across_ratio=None, nu_across=None)
    cue = cf.Cue((replace(CONE, material=plain),))
    assert np.array_equal(cf.modes(cue, 3).frequencies, cf.modes(cf.Cue((CONE,)), 3).frequencies)
    assert abs(cf.solid_modes(cue, 3).frequencies / cf.solid_modes(cf.Cue((CONE,)), 3).frequencies - 1).max() > 1e-8


@pytest.mark.parametrize("suffix", [".toml", ".vtu", ".vtk"])
def test_files_hold_the_constants_across_the_axis(tmp_path: Path, suffix: str) -> None:
    core = replace(WOOD, rho=400.0, across_ratio=None)
    cue = cf.Cue((CONE, cf.Segment(0.1, 0.021, 0.021, WOOD, 0.01, 0.01, core)), body_mass=0.4)
    cf.save(cue, tmp_path / f"cue{suffix}")
    assert cf.load(tmp_path / f"cue{suffix}") == cue


def crossing() -> cf.Cue:
    """Two bores between the same diameters, one within the other at one end and outside it at the other."""
    return cf.Cue(
        (
            cf.Segment(0.1, 0.012, 0.012, WOOD, 0.004, 0.004),
            cf.Segment(0.1, 0.012, 0.012, WOOD, 0.0119999999, 0.0119999999),
        )
    )


FINE = tuple(cf.Segment(0.002, 0.012, 0.013, WOOD) for _ in range(300))
REFUSED: list[tuple[Callable[[], object], str]] = [
    (lambda: replace(WOOD, nu_across=0.98), r"Material.nu_across must be in \(0, 0.9"),
    (lambda: replace(WOOD, across_ratio=4.0), "Material.nu_across must be in .* across_ratio = 4.0"),
    (lambda: replace(WOOD, across_ratio=-1.0), r"Material.across_ratio must be in \(0, inf\)"),
    (lambda: cf.Segment(0.1, 0.012, 0.012, WOOD, 0.012, 0.012), "Segment.tip_bore must be in"),
    (lambda: cf.Segment(0.0, 0.012, 0.012, WOOD), "Segment.length must be in"),
    (lambda: cf.solid_modes(crossing()), "wall of 1 um or more"),
    (lambda: cf.solid_modes(cf.Cue(FINE), at=cf.Solid(order=12)), "2 GiB"),
    (lambda: cf.solid_modes(SCENE.cue, 0), "count must be a whole number >= 1"),
    (lambda: cf.Solid(order=1), "order must be a whole number >= 2"),
    (lambda: cf.Solid(order=40), r"order must be in \[2, 12\]"),
    (
        lambda: cf.strike(replace(SCENE, effects=(cf.Support(0.3, 1e4),)), at=COARSE),
        "those that a Solid can have.*; got Support",
    ),
]


@pytest.mark.parametrize(("ask", "message"), REFUSED, ids=[message for _, message in REFUSED])
def test_what_no_solid_can_be_is_refused_in_words(
    ask: Callable[[], object], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before anything is assembled, which is what takes seconds."""
    monkeypatch.setattr(Body, "matrices", property(lambda body: pytest.fail("a solid was assembled")))
    with pytest.raises(ValueError, match=message):
        ask()


def test_a_file_says_which_constant_is_wrong(tmp_path: Path) -> None:
    cf.save(cf.Cue((CONE,)), tmp_path / "cue.toml")
    text = (tmp_path / "cue.toml").read_text(encoding="utf-8").replace("nu_across = 0.52", "nu_across = 0.99")
    (tmp_path / "cue.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"segments\[0\].material.nu_across"):
        cf.load(tmp_path / "cue.toml")


def test_check_says_how_far_beam_theory_is_off() -> None:
    status, out, err = call("check", MESHES / "kim.toml", "--json")
    assert (status, err) == (0, "")
    answer = json.loads(out)
    rows = {row["quantity"]: row for row in answer["rows"]}
    assert list(rows)[:6] == [f"tone {k}" for k in range(1, 7)]
    for row in rows.values():
        assert row["mesh_error"] < 2e-4
        assert abs(row["difference"]) < 4e-3  # kim.toml has Kim's own shear coefficient, 0.9
        assert row["difference"] == pytest.approx(row["beam"] / row["solid"] - 1, abs=1e-15)
    assert 1e-3 < rows["tone 6"]["difference"] < 4e-3
    off = abs(rows["squirt"]["difference"])
    assert answer["sentence"] == f"For this shaft beam theory is off by {100 * off:.1g} % in squirt."


def test_check_says_what_is_far_off_without_powers_of_ten(tmp_path: Path) -> None:
    """A short stub with a conical bore, where a beam is no model at all."""
    stub = cf.Cue((cf.Segment(0.0021, 0.0092, 0.0095, WOOD, 0.0026, 0.0061),), body_mass=0.42)
    cf.save(replace(SCENE, cue=stub), tmp_path / "stub.toml")
    status, out, _ = call("check", tmp_path / "stub.toml")
    assert status == 0
    assert "+298 %" in out
    assert not re.search(r"e\+\d+ %", out)
    assert max(row["difference"] for row in json.loads(call("check", tmp_path / "stub.toml", "--json")[1])["rows"]) > 1


def test_a_long_drawing_is_meshed_without_a_word(caplog: pytest.LogCaptureFixture) -> None:
    """scikit-fem tells on standard error when it has to copy a mesh of over a thousand points."""
    pieces = tuple(cf.Segment(0.0007, 0.012, 0.012, WOOD) for _ in range(1001))
    assert Body(cf.Cue(pieces), Fineness(2, 2.0, 0.2)).cells[0].nelements >= 1001
    assert not caplog.records


@pytest.mark.heavy
def test_the_report_says_on_request_what_check_says(tmp_path: Path) -> None:
    asked = ("report", MESHES / "kim.toml")
    checked, told = (json.loads(call(*words, "--json")[1]) for words in (("check", asked[1]), (*asked, "--check")))
    assert told["model_error"] == {name: checked[name] for name in told["model_error"]}
    assert {"rows", "sentence"} < set(told["model_error"])
    assert checked["sentence"] in " ".join(call(*asked, "--check")[1].split())
    for words, count in (((), 0), (("--check",), 1)):
        assert call(*asked, *words, "-o", tmp_path / "page.html")[0] == 0
        assert (tmp_path / "page.html").read_text(encoding="utf-8").count(f"<p>{checked['sentence']}</p>") == count
    assert "model_error" not in json.loads(call(*asked, "--json")[1])


def test_check_leaves_out_what_no_solid_can_have(tmp_path: Path) -> None:
    scene = replace(SCENE, effects=(cf.AxialWaves(), cf.PointMass(0.0, 1e-3)))
    cf.save(scene, tmp_path / "scene.toml")
    status, out, _ = call("check", tmp_path / "scene.toml")
    assert status == 0
    assert "* without AxialWaves" in " ".join(out.split())


def test_check_of_a_lumped_cue_is_refused(tmp_path: Path) -> None:
    cf.save(cf.Scene(cf.LumpedCue(0.54, 0.006), stroke=cf.Stroke(offset=0.3)), tmp_path / "lumped.toml")
    status, out, err = call("check", tmp_path / "lumped.toml")
    assert (status, out) == (2, "")
    assert err.startswith("cuefem: ")
    assert "must be a Cue of segments" in err
