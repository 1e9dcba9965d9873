"""End mass of a sticking tip at the scene's offset: symmetry, limits, lumped models (properties)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import cuefem as cf
from cuefem.analysis.squirt_curve import squirt_curve
from cuefem.analysis.strike_models import strike_models
from cuefem.endmass.definitions import squirt_equivalent
from cuefem.endmass.lumped import lump
from cuefem.scene.solved_scene import tip_modes_of
from tests.helpers.strike_scenes import KIM_AT, kim_scene

OFFSETS = (0.1, 0.3, 0.5)
EFFECTS: dict[str, tuple[cf.Effect, ...]] = {
    "bare": (),
    "damped": (cf.StructuralDamping(0.02),),
    "dome and shear": (cf.TipDome(9e-3), cf.TipShear(0.75)),
    "axial waves": (cf.AxialWaves(),),
}


def at_offset(scene: cf.Scene, offset: object) -> cf.Scene:
    return replace(scene, stroke=replace(scene.stroke, offset=offset))


def offset_mass(scene: cf.Scene) -> float:
    return cf.end_mass(scene, "offset", KIM_AT)


@pytest.mark.parametrize("effects", EFFECTS.values(), ids=EFFECTS.keys())
def test_offset_end_mass_small_offsets_converges_to_stick(effects: tuple[object, ...]) -> None:
    scene = replace(kim_scene(0.0), effects=effects)
    limit = cf.end_mass(scene, "stick", KIM_AT)
    assert offset_mass(scene) == pytest.approx(limit, rel=1e-12)
    gaps = [offset_mass(at_offset(scene, b)) / limit - 1 for b in (0.02, 0.01)]
    assert gaps[0] / gaps[1] == pytest.approx(4, rel=0.05)
    assert abs(gaps[0]) < 1e-2
    assert offset_mass(at_offset(scene, -0.3)) == pytest.approx(offset_mass(at_offset(scene, 0.3)), rel=1e-12)


def test_two_part_cue_is_the_same_in_strike_curve_and_chain() -> None:
    scene = replace(kim_scene(0.3), effects=EFFECTS["dome and shear"])
    struck, curve, chain = strike_models(scene), squirt_curve(scene, OFFSETS), cf.reduction(scene, offsets=OFFSETS)
    own = chain.models["this shaft, b/R 0.3"]
    assert struck.end_mass == curve.end_mass == own["end_mass"] == cf.end_mass(scene, "offset")
    assert curve.models["two-part, this cue"]["squirt"].tolist() == pytest.approx(own["squirt"], rel=1e-12)
    assert struck.models["two-part"]["squirt"] == pytest.approx(own["squirt"][OFFSETS.index(0.3)], rel=1e-12)
    assert struck.a31_end_mass == pytest.approx(cf.end_mass(scene.without_tip_effects, "offset"), rel=1e-8)


@pytest.mark.parametrize("offset", [-0.4, 0.1, 0.3])
def test_lump_with_dome_squirt_equals_strike_without_slip(offset: float) -> None:
    scene = replace(kim_scene(offset), effects=EFFECTS["dome and shear"])
    gripping = replace(scene, tip=replace(scene.tip, friction=math.inf))
    lumped = replace(gripping, cue=lump(scene, KIM_AT), effects=())
    assert cf.impulse(lumped).squirt == pytest.approx(cf.strike(gripping, KIM_AT).squirt, rel=1e-9)


def test_two_part_cue_of_a_lumped_cue_has_its_own_coupling() -> None:
    scene = at_offset(cf.Scene(cf.LumpedCue(0.54, 0.006, coupling=3.0), tip=cf.Tip(contact_time=1e-3)), 0.2)
    models = squirt_curve(scene, (-0.3, 0.3)).models
    assert models["two-part, this cue"]["squirt"] == pytest.approx(models["coupled, this cue"]["squirt"], rel=1e-3)


def test_strike_record_without_end_mass_omits_two_part_models() -> None:
    """A tip of low restitution, far off centre: the tip moves ahead of the ball."""
    scene = replace(kim_scene(0.85), tip=cf.Tip(0.05, 0.7, 1e-3))
    with pytest.raises(ValueError, match=r"end_mass: squirt of a sticking tip must be in \(0, .* angle; got"):
        cf.impulse(scene)
    record = strike_models(scene)
    assert record.end_mass is None
    assert set(record.models) == {"coupled"}
    curve = squirt_curve(scene, (0.3, 0.85))
    assert (curve.end_mass, curve.a31_end_mass[1]) == (None, None)
    assert np.isnan(curve.models["two-part, this cue"]["squirt"]).all()
    assert np.isnan(curve.models["A.31, this cue"]["squirt"]).tolist() == [False, True]


@pytest.mark.parametrize("effects", [(), (cf.GeometricStiffness(),), (cf.Elevation(0.2), cf.GeometricStiffness())])
def test_squirt_end_mass_is_continuous_at_centre(effects: tuple[cf.Effect, ...]) -> None:
    """At the centre it is the limit of small offsets, with axial force (7 %) and the table's force (40 %)."""
    cue = cf.Cue((cf.Segment(0.74, 0.0125, 0.0215, cf.Material(12.6e9, 0.84e9, 700.0)),), body_mass=0.42)
    scene = cf.Scene(cue, tip=cf.Tip(0.73, 0.6), stroke=cf.Stroke(2.0, 0.0), effects=effects)
    tip = tip_modes_of(scene)
    centre, small, larger = (
        squirt_equivalent(tip, replace(scene, stroke=cf.Stroke(2.0, offset))) for offset in (0.0, 1e-4, 1e-3)
    )
    assert centre == pytest.approx(small, rel=5e-4)
    assert small == pytest.approx(larger, rel=2e-3)
