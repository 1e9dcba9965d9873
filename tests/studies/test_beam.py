"""The solid of studies/beam against exact elasticity, the beam against the solid, and what leather_elasticity.py claims
(verification)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cuefem import Cue, Material, Segment, modes
from cuefem.cue import shear_coefficient
from cuefem.solid.half_section import Fineness
from cuefem.solid.shaft import Body
from studies.beam import leather_elasticity, solid
from studies.strokes import NAMES, cue
from tests.helpers.study_tables import rows


@pytest.mark.parametrize("name", NAMES)
def test_rigid_motions_have_the_cues_mass_and_no_energy(name: str) -> None:
    """U = 1, S = W = 0, and U = z, W = -r; the drawing's mass to rounding holds the mesh of every piece."""
    body = Body(cue(name), Fineness(3, 2.0, 0.2))
    K, M = body.matrices
    mesh, N = body.cells[0], body.basis.N
    vertices = body.basis.nodal_dofs[0]
    motions = np.zeros((body.unknowns, 2))
    motions[vertices, 0] = 1.0
    motions[vertices, 1], motions[2 * N + vertices, 1] = mesh.p[0], -mesh.p[1]
    mass = motions.T @ (M @ motions)
    assert mass[0, 0] == pytest.approx(cue(name).shaft_mass, rel=1e-12)
    assert mass[0, 1] == pytest.approx(cue(name).shaft_mass * cue(name).balance_point, rel=1e-12)
    assert np.abs(K @ motions).max() < 1e-12 * abs(K).max()
    assert body.tip @ motions == pytest.approx([1.0, 0.0], abs=1e-14)


def test_a_free_body_has_two_modes_without_frequency() -> None:
    found = Body(solid.kim(solid.KIM_WOOD), solid.ROUGH).modes(4).omega
    assert np.all(found[:2] < 1e-6 * found[2])
    assert found[2] > 700


@pytest.mark.heavy
@pytest.mark.parametrize("name", ["solid, E/G 15", "bore 0.8, maple"])
def test_the_shear_coefficient_of_the_long_wave(name: str) -> None:
    """Hutchinson's at the effective Poisson ratio; Cowper's is off by half a per cent and more."""
    wood, bore = solid.SECTIONS[name]
    rule = float(shear_coefficient(wood.effective_poisson_ratio, bore))
    assert solid.kappa(name) == pytest.approx(rule, rel=1e-8)
    assert abs(solid.cowper(wood.effective_poisson_ratio, bore) / rule - 1) > 5e-3


@pytest.mark.parametrize(("wood", "bound"), [(solid.KIM_ISOTROPIC, 1e-5), (solid.KIM_WOOD, 2e-4)], ids=["iso", "wood"])
def test_the_beam_of_kims_cone(wood: Material, bound: float) -> None:
    """Six free modes within 1e-5 (isotropic) and 2e-4 (wood) of the solid; with Cowper's coefficient not."""
    body = Body(solid.kim(wood), solid.ROUGH).modes(8).frequencies
    off = np.abs(modes(solid.kim(wood), 6).frequencies / body - 1)
    assert bound / 10 < off.max() < bound
    assert np.abs(modes(solid.kim(wood, solid.cowper(wood.nu)), 6).frequencies / body - 1).max() > 5 * bound


def test_a_cones_error_goes_with_its_slope_squared() -> None:
    off = []
    for half in (0.003, 0.006):
        whole = Cue((Segment(0.7, 0.0165 - half, 0.0165 + half, solid.KIM_WOOD),))
        found = Body(whole, solid.ROUGH).modes(3).frequencies[0]
        off.append(modes(whole, 1).frequencies[0] / found - 1)
    assert off[1] / off[0] == pytest.approx(4, rel=0.1)


def test_what_is_left_on_kims_cone_is_understood() -> None:
    """Shear made by the taper, derived, and what a uniform rod of the mean width is off by: together to 8e-6."""
    cone, straight = (
        modes(whole, 6).frequencies / Body(whole, solid.ROUGH).modes(8).frequencies - 1
        for whole in (solid.kim(solid.KIM_WOOD), solid.uniform(solid.KIM_WOOD))
    )
    shear = solid.taper(solid.kim(solid.KIM_WOOD))
    assert np.all(shear > 4e-5)
    assert np.abs(cone - shear - straight).max() < 8e-6


def test_constants_across_the_grain_hardly_matter() -> None:
    found = [
        Body(solid.kim(replace(solid.KIM_WOOD, across_ratio=E)), solid.ROUGH).modes(8).frequencies for E in (0.05, 0.2)
    ]
    assert np.abs(found[1] / found[0] - 1).max() < 1e-4


def test_a_ferrule_gives_where_its_force_leaves_it_through_a_ring() -> None:
    """What makes the carbon cue 6.6 % softer along the axis than its beam: it does not grow with the ferrule's
    length, and is what an evenly loaded ring says but for how the force is spread over it."""
    drawn = cue("carbon")
    _, ferrule, *tube = drawn.segments
    rule = solid.ferrule_give(ferrule.material.E, ferrule.material.nu, ferrule.butt_diameter / 2, tube[0].tip_bore / 2)
    usual, long = (
        solid.along_the_axis(replace(drawn, segments=(replace(ferrule, length=length), *tube)), 6)
        for length in (ferrule.length, 2 * ferrule.length)
    )
    assert 0.7 < usual / rule < 0.9
    assert long == pytest.approx(usual, rel=0.05)


# the table of leather tips


def quantiles(column: int) -> dict[tuple[str, str], float]:
    """A column of the page's table of errors, by what they are of."""
    found = [cells for cells in rows(leather_elasticity.STUDY.committed) if len(cells) == 6 and cells[2].isdigit()]
    assert len(found) == 8
    return {(cells[0], cells[1]): float(cells[column]) for cells in found}


@pytest.mark.heavy
def test_the_table_at_the_first_tips_again() -> None:
    """Of the random tips of the page, the first two: none further off than the page's largest."""
    largest = quantiles(5)
    again = list(leather_elasticity.measured(leather_elasticity.errors(2)))
    assert len(again) == 8
    assert all(float(cells[5]) <= largest[cells[0], cells[1]] + 0.01 for cells in again)


def test_the_table_is_within_half_a_per_cent() -> None:
    """Of the compliance of whole patches and of the head-on law, in 95 of 100 random tips."""
    assert all(value < 0.5 for (what, _), value in quantiles(4).items() if what != "patches that the rim cuts")
