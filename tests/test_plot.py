"""Figures: drawn lines agree with the functions (properties)."""

from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes

import cuefem as cf
from cuefem.endmass.end_mass_density import end_mass_density

HOLLOW = cf.load(Path(__file__).parents[1] / "meshes" / "pool_hollow.toml")
assert isinstance(HOLLOW, cf.Cue)
SCENE = cf.Scene(HOLLOW, cf.Ball(0.17, 0.028575), cf.Tip(0.73, 0.6, contact_time=1e-3), cf.Stroke(2.0, 0.3))
AT = cf.Resolution(1, 16, 20)


@pytest.fixture(autouse=True)
def _closed(monkeypatch: pytest.MonkeyPatch) -> object:
    plt.switch_backend("agg")
    yield
    plt.close("all")


def line(axes: Axes, i: int = 0) -> tuple[np.ndarray, np.ndarray]:
    x, y = axes.lines[i].get_data()
    return np.asarray(x), np.asarray(y)


def test_shaft_figure_has_drawn_dimensions() -> None:
    axes = cf.plot.shaft(SCENE)
    assert axes.get_xlim()[1] == pytest.approx(736.6, rel=1e-12)
    corners = np.concatenate([path.vertices for item in axes.collections for path in item.get_paths()])
    assert corners[:, 1].max() == pytest.approx(21.5 / 2, rel=1e-12)
    colours = {tuple(item.get_facecolor()[0]) for item in axes.collections}
    assert len(colours) == 4  # leather, ferrule, wood, and the bore


def test_colour_of_a_segment_tells_the_kind_of_its_material() -> None:
    """E, Pa, and density, kg/m3, of two materials of each kind: white cedar and maple, phenolic and ABS, ..."""
    kinds = {
        "wood": ((5.5e9, 340.0), (13e9, 700.0)),
        "plastic": ((7e9, 1350.0), (2.3e9, 1050.0)),
        "metal": ((69e9, 2700.0), (200e9, 7850.0)),
        "composite": ((135e9, 1600.0), (40e9, 1900.0)),
        "leather": ((2e8, 900.0), (6e7, 1000.0)),
        "foam": ((5e7, 60.0), (2e8, 250.0)),
    }
    colours = {}
    for kind, pair in kinds.items():
        cue = cf.Cue(tuple(cf.Segment(0.4, 0.012, 0.012, cf.Material(E, E / 3, rho)) for E, rho in pair), 0.4)
        (colours[kind],) = {tuple(item.get_facecolor()[0]) for item in cf.plot.shaft(cue).collections}
    assert len({*colours.values()}) == len(kinds)
    assert sum(colours["foam"]) > sum(colours["leather"])  # lighter


def test_modes_figure_lists_frequencies_of_cue() -> None:
    axes = cf.plot.modes(HOLLOW, 3)
    named = [text.get_text() for text in axes.get_legend().get_texts()]
    assert named == [f"{f:.0f} Hz" for f in cf.modes(HOLLOW, 3).frequencies]
    assert all(np.abs(line(axes, i)[1]).max() == 1 for i in range(3))
    supported = cf.plot.modes(cf.Scene(HOLLOW, effects=(cf.Support(0.7, 1e6),)), 3)
    assert [text.get_text() for text in supported.get_legend().get_texts()] != named


def test_squirt_figure_equals_strikes_and_ends_at_miscue() -> None:
    axes = cf.plot.squirt({"hollow": SCENE}, [0.0, 0.3, 0.8], at=AT)
    x, y = line(axes)
    assert x.tolist() == [0.0, 0.3, 0.8]
    assert y[:2].tolist() == [0.0, pytest.approx(np.degrees(cf.strike(SCENE, AT).squirt), rel=1e-12)]
    assert np.isnan(y[2])
    assert np.transpose(line(axes, 1)).tolist() == [[0.8, 0.0]]
    assert not axes.lines[1].get_clip_on()  # the cross stands whole on the axis


def test_forces_figure_integrates_to_impulse() -> None:
    outcome = cf.strike(SCENE, AT)
    for axes in (cf.plot.forces(outcome), cf.plot.forces(SCENE, at=AT)):
        for i, part in enumerate(outcome.impulse[::-1]):
            x, y = line(axes, i)
            assert np.trapezoid(y, 1e-3 * x) == pytest.approx(part, rel=2e-3)
    with pytest.raises(ValueError, match="forces needs an outcome of strike"):
        cf.plot.forces(cf.impulse(cf.Scene(cf.LumpedCue(0.5, 0.006))))


def test_end_mass_figure_behind_leather_tip_equals_bare_shaft() -> None:
    """At the leather tip's contact time; the title states the excluded mass of the leather."""
    scene = cf.usual_scene(SCENE.shaft)
    axes = cf.plot.end_mass(scene, at=AT)
    bare = cf.Scene(scene.cue, scene.ball, replace(scene.tip, contact_time=scene.contact_time), scene.stroke)
    np.testing.assert_allclose(line(axes)[1], line(cf.plot.end_mass(bare, at=AT))[1], rtol=1e-12)
    drivers = end_mass_density(bare, at=AT)
    drawn = np.interp(line(axes)[0], 1e3 * drivers.x, drivers.rhoA + drivers.axial_mass)
    np.testing.assert_allclose(line(axes)[1], drawn, rtol=1e-9)
    assert axes.get_title().endswith(" g of its leather")
    assert "without" not in cf.plot.end_mass(bare, at=AT).get_title()
    with pytest.raises(ValueError, match=r"takes a scene without effects other than LeatherTip; got TipDome"):
        cf.plot.end_mass(replace(SCENE, effects=(cf.TipDome(0.0095),)))


def test_reduction_figure_shows_every_model_and_both_contact_times() -> None:
    own = cf.reduction(replace(SCENE, tip=cf.Tip(0.73, 0.6, contact_time=2e-3)))
    left, right = cf.plot.reduction(own)
    assert [text.get_text() for text in left.get_legend().get_texts()] == [*own.models]
    x, y = line(left, len(own.models) - 1)
    assert y[x.tolist().index(0.3)] == pytest.approx(np.degrees(own.models["this shaft, vibrating"]["squirt"][1]))
    times, masses = line(right)
    assert masses[times.tolist().index(2.0)] == pytest.approx(1e3 * cf.end_mass(own.scene))
    assert [text.get_text() for text in right.texts] == ["filmed, 1.135 ms", "2 ms"]
