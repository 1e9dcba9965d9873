"""Verification of the default: its stick end mass where the front of the shear wave is back, and its size of mesh."""

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest

from cuefem import Cue, Material, PointMass, Resolution, Segment, Stroke, end_mass
from cuefem.beam.modes import modes, solve
from cuefem.beam.spectrum import ended
from cuefem.beam.system import assemble
from cuefem.beam.tail import tail
from cuefem.beam.waves import ended_mesh_for, even_mesh_for, mesh_for
from cuefem.contact.strike import strike_modes
from cuefem.endmass.drives import end_mass_spreads, formula_of
from cuefem.tip_modes import LEAST, LEAST_STUCK, MOST_KEPT, Solved, default_resolution, tip_modes_from
from tests.helpers.cues import LEATHER, MAPLE, kim, scene

mpl.use("Agg")
from studies.accuracy.default_accuracy import random_cue

BRASS = Material(1e11, 3.7e10, 8500.0)
MANY = 200  # modes of a reference
SHORT = Segment(0.001, 0.012, 0.012, LEATHER)
SHORT_ENDED = Cue((SHORT, Segment(0.7, 0.012, 0.021, MAPLE), Segment(0.001, 0.021, 0.021, LEATHER)), 0.42)


@pytest.mark.parametrize("T", [1.41e-3, 2.6e-3])
def test_the_stick_end_mass_where_the_front_is_back(T: float) -> None:
    """2 L/c of Kim's cone is 1.43 ms: half a percent there takes frequencies that the contact time does not ask for."""
    found = scene(kim(), T)
    exact = formula_of("stick")(tip_modes_from(tail(modes(kim(), 200)), found), found)
    assert end_mass(found) == pytest.approx(exact, rel=3.5e-3)


def test_a_brass_tip_says_what_it_rings_by() -> None:
    """Its error is beyond half a percent, the estimate with the number above that and above the error."""
    cue = Cue((Segment(0.008, 0.012, 0.012, BRASS), Segment(0.7, 0.012, 0.021, MAPLE)), 0.4)
    spread = end_mass_spreads(scene(cue, 1.3e-3))("stick")
    assert spread.error is not None
    assert 0.01 < spread.error < 0.1
    assert spread.lowest <= spread.end_mass * (1 - spread.error)
    assert spread.highest >= spread.end_mass * (1 + spread.error)
    assert 0.8 * spread.end_mass < spread.lowest < spread.highest < 1.2 * spread.end_mass
    wood = end_mass_spreads(scene(kim(), 1.3e-3))("stick")
    assert wood.error is not None
    assert wood.error < 5e-3


@pytest.mark.parametrize("T", [0.1e-3, 0.3e-3, 2e-3, 5e-3])
def test_no_default_asks_for_more_than_the_tail_needs(T: float) -> None:
    """End segments of 1 mm took 400 modes and 810 unknowns; now modes end where the tail takes over."""
    at = default_resolution(scene(SHORT_ENDED, T))
    assert 40 <= at.modes <= MOST_KEPT
    assert default_resolution(scene(SHORT_ENDED, T), least=LEAST_STUCK).modes >= LEAST_STUCK


@pytest.mark.parametrize("number", [*range(3), *(pytest.param(n, marks=pytest.mark.heavy) for n in range(3, 40))])
def test_the_coarser_mesh_under_a_tail_changes_no_digit_that_the_default_holds(number: int) -> None:
    """It costs at most 1.5e-5 of the stick end mass, and 3e-6 of squirt; the default claims 5e-3."""
    draw = np.random.default_rng([5, number])
    found = scene(random_cue(draw), draw.uniform(0.5e-3, 3e-3))
    for least in (LEAST, LEAST_STUCK):
        at = default_resolution(found, least=least)
        whole = assemble(found.shaft, elements=at.elements, order=at.order, count=at.modes)
        exact = formula_of("stick")(tip_modes_from(tail(solve(whole, at.modes)), found), found)
        tip = Solved(found).tip_modes(least)
        assert formula_of("stick")(tip, found) == pytest.approx(exact, rel=1.5e-5)
        elements, orders = ended_mesh_for(found.shaft, at.modes)
        fewer = assemble(found.shaft, elements=elements, order=orders, count=at.modes)
        assert at.modes < fewer.mesh.unknowns < 0.82 * whole.mesh.unknowns
    struck = replace(found, stroke=Stroke(1.0, draw.uniform(0.05, 0.5)))
    by_whole = strike_modes(struck, tip_modes_from(tail(solve(whole, at.modes)), struck))
    assert strike_modes(struck, tip).squirt == pytest.approx(by_whole.squirt, rel=3e-6)


@pytest.mark.parametrize("number", [*range(3), *(pytest.param(n, marks=pytest.mark.heavy) for n in range(3, 40))])
def test_the_modes_of_a_strike_hold_the_end_masses_of_smooth_drives(number: int) -> None:
    """Force to 0.5 % on leather, which rings above the modes kept, soft one from 1 ms on; to 0.1 % on all else."""
    draw = np.random.default_rng([8, number])
    cue = random_cue(draw)
    E = cue.segments[0].material.E
    leather = E < 1e9
    found = scene(cue, 1e-3)
    elements, orders = ended_mesh_for(found.shaft, MANY, spare=8)
    family = ended(assemble(cue, elements=elements, order=orders, count=MANY), MANY, turning=False)
    exact = tip_modes_from(family(MANY), found)
    shortest = 1e-3 if E < 150e6 else 0.5e-3
    for T in draw.uniform(shortest, 5e-3, 12):
        found = scene(cue, float(T))
        assert end_mass(found, "velocity") == pytest.approx(formula_of("velocity")(exact, found), rel=5e-6)
        wanted = formula_of("force")(exact, found)
        assert end_mass(found, "force") == pytest.approx(wanted, rel=5e-3 if leather else 1e-3)


HEAVY_HEADS = [  # leather's E and height, then a ferrule of brass or a mass at the ferrule, kg
    pytest.param(62e6, 0.010, True, 0.0, id="brass ferrule"),
    pytest.param(208e6, 0.0153, False, 0.01775, id="18 g", marks=pytest.mark.heavy),
    pytest.param(270e6, 0.0108, False, 0.01227, id="12 g", marks=pytest.mark.heavy),
]


@pytest.mark.parametrize(("E", "height", "ferrule", "mass"), HEAVY_HEADS)
def test_leather_on_a_heavy_head_has_its_end_mass_by_force(E: float, height: float, ferrule: bool, mass: float) -> None:
    """A strike's modes alone would leave it 0.9 % off."""
    leather = Segment(height, 0.0125, 0.0125, Material(E, E / 3, 1000.0))
    brass = (Segment(0.012, 0.0125, 0.0125, BRASS),) if ferrule else ()
    cue = Cue((leather, *brass, Segment(0.7, 0.0125, 0.021, MAPLE)), 0.4)
    effects = (PointMass(0.02, mass),) if mass else ()
    found = replace(scene(cue, 1e-3), effects=effects)
    elements, orders = ended_mesh_for(found.shaft, MANY, spare=8)
    whole = assemble(cue, elements=elements, order=orders, effects=effects, count=MANY)
    exact = tip_modes_from(ended(whole, MANY, turning=False)(MANY), found)
    for T in (1e-3, 1.2e-3, 1.5e-3, 3e-3):
        at = replace(found, tip=replace(found.tip, contact_time=T))
        assert end_mass(at, "force") == pytest.approx(formula_of("force")(exact, at), rel=5e-3)


@pytest.mark.heavy
@pytest.mark.parametrize("length", [0.005, 0.05, 0.3])
@pytest.mark.parametrize(("thin", "thick"), [(0.012, 0.03), (0.004, 0.03), (0.002, 0.012)])
@pytest.mark.parametrize("bored", [0.0, 0.7])
def test_a_short_steep_cone_has_the_orders_that_its_taper_asks_for(
    length: float, thin: float, thick: float, bored: float
) -> None:
    """Their waves alone would ask for so few that the tip's amplitudes were up to a tenth off."""
    cone = Segment(length, thin, thick, MAPLE, tip_bore=bored * thin)
    turned = Segment(length, thick, thin, MAPLE, butt_bore=bored * thin)
    wide, slim = Segment(1.1, thick, 0.03, MAPLE), Segment(1.1, thin, 0.03, MAPLE)
    for cue in (
        Cue((cone, wide), 0.3),
        Cue((turned, slim), 0.3),
        Cue((Segment(0.7, 0.012, thick, MAPLE), turned), 0.3),
    ):
        elements, orders = ended_mesh_for(cue, 45)
        found = solve(assemble(cue, elements=elements, order=orders, count=45), 45)
        elements, order = mesh_for(cue, 45)
        finer = tuple(2 * number for number in elements)
        exact = solve(assemble(cue, elements=finer, order=order + 4, count=45), 45)
        np.testing.assert_allclose(found.frequencies[:5], exact.frequencies[:5], rtol=2e-9)
        np.testing.assert_allclose(found.vectors[0, :20], exact.vectors[0, :20], rtol=2e-7)


def test_a_short_segment_gets_the_elements_that_its_own_waves_ask_for() -> None:
    elements, order = mesh_for(SHORT_ENDED, 100)
    even, even_order = even_mesh_for(SHORT_ENDED, 100)
    assert elements[0] == elements[2] == 1
    assert elements[1] >= 5
    assert sum(elements) * order < 0.6 * 3 * even * even_order
    found = modes(SHORT_ENDED, 100, at=Resolution(elements, order, 100)).frequencies
    finer = modes(SHORT_ENDED, 100, at=Resolution(even + 1, even_order + 2, 100)).frequencies
    np.testing.assert_allclose(found, finer, rtol=2e-7)


def test_elements_of_a_segment_are_shared_out_over_its_pieces() -> None:
    from cuefem.beam.mesh import mesh_cue

    mesh = mesh_cue(SHORT_ENDED, elements=(1, 4, 1), order=3, positions=(0.001 + 0.7 / 4,))
    assert list(np.bincount(mesh.piece)) == [1, 4, 1]
    with pytest.raises(ValueError, match="must be one number or 3 of them, one a segment; got 2"):
        mesh_cue(SHORT_ENDED, elements=(1, 4), order=3)
