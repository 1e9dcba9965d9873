"""Numbers that sources give for the closed forms, each at the source's precision."""

import numpy as np
import pytest

from studies.paper import closed_forms as squirt

KIM = {"mass": 0.54, "end_mass": 0.012 / 4}


@pytest.mark.parametrize(("offset", "degrees"), [(0.1, 0.24141137371), (0.3, 0.72794033346)])
def test_squirt_of_kims_cue(offset, degrees):
    form = squirt.closed_form(offset, mass=18 / 7 * 0.21, end_mass=2 / 35 * 0.21 / 4)
    assert np.degrees(form.squirt) == pytest.approx(degrees, abs=1e-10)
    assert form.squirt == pytest.approx(squirt.closed_form(offset, **KIM).squirt, rel=1e-14)


def test_kims_cue_end():
    cone = {"length": 0.7, "tip_radius": 6e-3, "butt_radius": 10.5e-3}
    assert squirt.cone_end_mass(0.12, shaft_mass=0.12, **cone) == pytest.approx(0.012, abs=5e-5)
    base = squirt.base_radius(0.12, **cone)
    assert base == pytest.approx(6.77e-3, abs=5e-6)
    assert squirt.full_cone_length(0.12, tip_radius=6e-3, base_radius=base) == pytest.approx(1.053, abs=5e-4)
    assert squirt.centre_of_mass(tip_radius=6e-3, base_radius=base) == pytest.approx(0.48, abs=5e-4)
    assert squirt.inertia_factor(tip_radius=6e-3, base_radius=base) == pytest.approx(0.307, abs=5e-4)
    assert squirt.cue_end_mass(0.003) == pytest.approx(0.012, rel=1e-14)


@pytest.mark.parametrize(("ratio", "sine"), [(18 / 7, 0.745), (3.0, 0.730)])
def test_offset_of_largest_spin(ratio, sine):
    assert squirt.offset_of_largest_spin(cue_mass_ratio=ratio) == pytest.approx(sine, abs=5e-4)


def test_rotation_of_the_cue_end():
    assert squirt.light_cue_end_rotation(0.5, cue_mass_ratio=18 / 7) == pytest.approx(-1.030, abs=5e-4)
