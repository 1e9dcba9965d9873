"""The paper's closed forms against the numbers of their sources and exact identities (verification).

Against the impulse solver: tests/contact/test_impulse.py.
"""

import numpy as np
import pytest

from studies.paper import closed_forms as squirt

OFFSETS = np.array([0.01, 0.1, 0.3, 0.5, 0.55])
LINE = {"cue_mass_ratio": 18 / 7}
CONE = {"length": 0.7, "tip_radius": 6e-3, "butt_radius": 10.5e-3}


def test_numbers_of_the_sources() -> None:
    """Each at the source's precision."""
    form = squirt.closed_form(np.array([0.1, 0.3]), mass=0.54, end_mass=0.012 / 4)
    assert np.degrees(form.squirt) == pytest.approx([0.24141137371, 0.72794033346], abs=1e-10)
    assert squirt.cone_end_mass(0.12, shaft_mass=0.12, **CONE) == pytest.approx(0.012, abs=5e-5)
    assert squirt.base_radius(0.12, **CONE) == pytest.approx(6.77e-3, abs=5e-6)
    for ratio, sine in ((18 / 7, 0.745), (3.0, 0.730)):
        assert squirt.offset_of_largest_spin(cue_mass_ratio=ratio) == pytest.approx(sine, abs=5e-4)
    assert squirt.light_cue_end_rotation(0.5, **LINE) == pytest.approx(-1.030, abs=5e-4)


@pytest.mark.parametrize("m_e", [1 / 70, 0.3])
def test_a31_is_the_blow_without_restitution_and_has_an_inverse(m_e: float) -> None:
    offset = np.linspace(-0.29, 0.3, 12)
    form = squirt.closed_form(offset, mass=18 / 7, end_mass=m_e, ball_mass=1.0, restitution=0.0, friction=5.0)
    psi = squirt.alciatore_a31(offset, mass_ratio=1 / m_e)
    np.testing.assert_allclose(form.squirt, psi, rtol=1e-13)
    np.testing.assert_allclose(squirt.alciatore_a31_mass_ratio(offset, psi), 1 / m_e, rtol=1e-10)
    line = squirt.force_line_offset(offset, psi)
    np.testing.assert_allclose(squirt.shepard(line, mass_ratio=1 / m_e), psi, rtol=1e-13)
    for bad in (0.0, -0.01, 1.5):
        with pytest.raises(ValueError, match=r"infinite end mass in \[A.31\]"):
            squirt.alciatore_a31_mass_ratio(0.3, bad)


def test_a_light_cue_end_is_missed_by_the_next_order() -> None:
    """Halving epsilon divides the error of the expansion by four, at every level and offset."""

    def miss(x: float) -> np.ndarray:
        form = squirt.closed_form(OFFSETS, mass=18 / 7, end_mass=x / 4, ball_mass=1.0)
        return np.abs(form.squirt - squirt.first_order_squirt(OFFSETS, cue_end_ratio=x, **LINE))

    told = np.array([miss(x) for x in 1e-3 / 2 ** np.arange(4)])
    assert np.all(np.abs(np.log2(told[:-1] / told[1:]) - 2) < 0.1)


def test_miscue_offset_and_miscue_friction_are_inverse() -> None:
    mu, ratios = np.array([0.1, 0.4, 0.6, 0.9]), {"cue_mass_ratio": 3.0, "end_mass_ratio": 0.36}
    limit = squirt.miscue_offset(mu, restitution=0.75, **ratios)
    back = squirt.miscue_friction(squirt.lumped(limit, **ratios), limit, restitution=0.75)
    np.testing.assert_allclose(back, mu, rtol=1e-12)
    assert np.all(np.diff(limit) > 0)


def test_natural_pivot_is_where_the_cue_line_crosses_the_centre_line() -> None:
    """A cue turned by psi about the pivot points its axis from the ball's centre to the dome's centre."""
    psi, R, r, b = 0.02, 0.03, 0.01, 0.4
    p = squirt.natural_pivot_length(b, psi, radius=R, dome_radius=r)
    assert (p + R) * np.sin(psi) == pytest.approx(squirt.axis_offset(b, radius=R, dome_radius=r), rel=1e-14)
