"""The chain from the drawing to squirt on [Kim]'s cone, its limits, and invalid input (verification)."""

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import pytest

import cuefem as cf
from cuefem.analysis.reduction import FILMED_CONTACT_TIME, VIBRATING, Reduction
from cuefem.endmass.rigid_front import RigidFront
from studies.pages import STUDIES
from studies.paper.closed_forms import cone_end_mass, inertia_factor, squirt_slope
from tests.helpers.cues import rod

KIM: Any = cf.load(STUDIES / "scenes" / "kim.toml")
AT_OFFSET = "this shaft, b/R 0.3"


def scaled(factor: float, *names: str) -> cf.Scene:
    """The scene of [Kim] with material constants of the shaft times a factor; the mass of the cue is the same."""
    (cone,) = KIM.cue.segments
    constants = {name: factor * getattr(cone.material, name) for name in names}
    shaft = replace(cone, material=replace(cone.material, **constants))
    return replace(KIM, cue=cf.Cue((shaft,), KIM.cue.mass - shaft.mass))


@cache
def kim_reduction() -> Reduction:
    return cf.reduction(KIM)


def test_filmed_contact_lasts_as_long_as_the_filmed_one() -> None:
    """With axial waves a contact lasts longer than that of a rigid cue; without them as long."""
    pool = cf.usual_scene(cf.load(STUDIES.parent / "meshes" / "pool_maple.toml"))
    for scene in (KIM, pool):
        own = cf.reduction(scene, offsets=(0.3,))
        filmed = own.filmed_contact_time
        assert filmed is not None
        bare = scene.without_tip_effects
        head_on = replace(bare.stroke, offset=0.0)
        struck = replace(bare, tip=replace(bare.tip, contact_time=filmed, stiffness=None), stroke=head_on)
        assert cf.strike(struck).duration == pytest.approx(FILMED_CONTACT_TIME, rel=2e-4)
        assert filmed in [row["contact_time"] for row in own.end_mass_by_contact_time]
        assert (filmed < 0.9 * FILMED_CONTACT_TIME) == (scene is pool)
        assert own.duration == pytest.approx(cf.strike(scene).duration, rel=1e-12)


def test_rigid_front_equals_closed_forms_of_kims_cue_end() -> None:
    shaft = {"length": 0.7, "tip_radius": 6e-3, "butt_radius": 10.5e-3}
    front = RigidFront.of(KIM.cue)
    base = 6e-3 + 4.5e-3 * 0.12 / 0.7
    nu_c = float(inertia_factor(tip_radius=6e-3, base_radius=base, end_length=0.12))
    mass = float(cone_end_mass(0.12, shaft_mass=KIM.cue.shaft_mass, **shaft))
    assert front.mass_ratio(0.12) == pytest.approx((1 + nu_c) / nu_c, rel=2e-5)
    assert front.length_of(mass * nu_c / (1 + nu_c)) == pytest.approx(0.12, rel=2e-5)
    assert kim_reduction().front_ratio == pytest.approx(4.23, abs=5e-3)
    thin = rod(1000.0)
    assert RigidFront.of(thin).length_of(thin.shaft_mass / 4) == pytest.approx(thin.length, rel=2e-5)
    assert front.length_of(front.end_mass[-1]) == pytest.approx(0.7)
    assert front.length_of(1.0) is None


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_reduced_squirt_of_light_cue_converges_to_first_order_in_eps() -> None:
    """Order 1 in eps: [Kim] eq. psi squirt."""
    errors = []
    for factor in (1e-1, 1e-2, 1e-3):
        scene = scaled(factor, "E", "G", "rho")
        own = cf.reduction(scene)
        slope = squirt_slope(0.3, cue_mass_ratio=scene.axial_mass / scene.ball.mass, nu_c=own.nu_c)
        model = own.models[AT_OFFSET]
        errors.append(abs(model["squirt"][1] / (float(slope) * model["eps"]) - 1))
    orders = [math.log10(coarse / fine) for coarse, fine in pairwise(errors)]
    assert orders == pytest.approx([1.0, 1.0], abs=0.02)
    assert errors[-1] < 2e-4


@pytest.mark.heavy
def test_vibrating_squirt_of_stiff_shaft_converges_to_rigid_cue_end() -> None:
    """The error oscillates: the largest in each decade of E. Its order, 1/T^2: studies/paper/convergence."""
    rigid = 4 * float(RigidFront.of(KIM.cue).end_mass[-1])

    def error(factor: float) -> float:
        models = cf.reduction(scaled(factor, "E", "G"), cue_ends={"rigid": rigid}, offsets=[0.3]).models
        return abs(models[VIBRATING]["squirt"][0] / models["rigid"]["squirt"][0] - 1)

    errors = [max(error(10 ** (decade + step)) for step in (0.0, 0.2, 0.4, 0.6, 0.8)) for decade in (2, 3, 4)]
    assert all(stiff < soft / 2 for soft, stiff in pairwise(errors))
    assert errors[-1] < 0.015


@pytest.mark.parametrize(("joint", "roots"), [("pinned", (3.926602, 7.068583)), ("clamped", (1.875104, 4.694091))])
def test_frequencies_of_held_slender_rod_equal_closed_form(joint: Any, roots: tuple[float, ...]) -> None:
    """(βL)² of the Euler-Bernoulli beam, over that of the free rod's first mode, 4.730041²."""
    rod = cf.Scene(cf.Cue((cf.Segment(2.0, 0.005, 0.005, cf.material("hard maple")),), 0.45))
    free, held = cf.natural_frequencies(rod, 1), cf.natural_frequencies(rod, 2, joint=joint)
    expected = [(root / 4.730041) ** 2 for root in roots]
    assert [f / free.frequencies[0] for f in held.frequencies] == pytest.approx(expected, rel=1e-3)
    assert held.rigid == (joint == "pinned")
