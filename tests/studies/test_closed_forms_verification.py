"""The closed forms against exact identities and limits (against the solver: contact/test_impulse_verification.py)."""

import numpy as np
import pytest

from studies.paper import closed_forms as squirt

OFFSETS = np.array([0.01, 0.1, 0.3, 0.5, 0.55])
LINE = {"cue_mass_ratio": 18 / 7}
KIM = {"cue_end_ratio": 2 / 35, **LINE}
SLOPES = squirt.first_order_coefficients(OFFSETS, **LINE)


def test_betas_are_the_papers_expressions():
    phi = np.arcsin(OFFSETS)
    s, c, t, nu, Q = np.sin(phi), np.cos(phi), np.tan(phi), 0.4, 18 / 7
    rigid = squirt.rigid(OFFSETS, cue_mass_ratio=Q)
    k = 1 / (0.136 * (Q + 1))
    expected = [1 + Q / (nu * (Q + 1)) + c**2 * k, 1 + s**2 * k, s * c * k]
    np.testing.assert_allclose(rigid[:3], expected, rtol=1e-14)
    eps, nu_c = 2 / 35, 1 / 3
    m = eps / (1 + eps)  # of the ball's mass
    less = 1 - eps / Q
    expected = [
        1 + m / nu + m / eps * c**2 * (1 / nu_c - less * t**2),
        1 - m / eps * c**2 * (less - t**2 / nu_c),
        m / eps * (1 / nu_c + less) * c * s,
    ]
    two = squirt.two_part(OFFSETS, **KIM)
    np.testing.assert_allclose(two[:3], expected, rtol=1e-14)
    for beta in (rigid, two):
        np.testing.assert_allclose(beta.determinant, beta.parallel * beta.perpendicular - beta.cross**2, rtol=1e-12)


def test_one_minus_gamma_keeps_its_digits_where_one_less_gamma_has_none():
    """First-order expansion is exact to O(eps) relative; 1 - gamma itself is of order eps."""
    for eps in (1e-6, 1e-9, 1e-12):
        beta = squirt.two_part(0.5, cue_mass_ratio=18 / 7, cue_end_ratio=eps)
        slope = 0.25 * (1 + 7 / 18 + 0.25 / 0.4) / (0.25 * 0.75)
        assert squirt.one_minus_gamma(beta) == pytest.approx(eps * slope, rel=20 * eps + 1e-14)
    beta = squirt.two_part(0.5, **KIM)
    assert squirt.one_minus_gamma(beta) == pytest.approx(1 - squirt.gamma(beta), rel=1e-13)


@pytest.mark.parametrize(
    ("eps", "cue", "nu", "nu_c"), [(2 / 35, 18 / 7, 0.4, 1 / 3), (1e-5, 0.1, 1.0, 2.0), (3, 30, 0.2, 0.1)]
)
def test_no_restitution_is_a31_exactly(eps, cue, nu, nu_c):
    offset = np.linspace(-0.3, 0.3, 13)
    m_e = eps * nu_c / (1 + nu_c)
    form = squirt.closed_form(offset, mass=cue, end_mass=m_e, ball_mass=1.0, inertia=nu, restitution=0.0, friction=5.0)
    np.testing.assert_allclose(form.squirt, squirt.alciatore_a31(offset, mass_ratio=1 / m_e, inertia=nu), rtol=1e-14)


def expansions(x: float) -> dict[str, tuple]:
    """Exact values at an epsilon beside what their expansions to first order say."""
    line, form = {"cue_end_ratio": x, **LINE}, two_part_form(x)
    beta, zero, slope = squirt.two_part(OFFSETS, **line), squirt.light_coefficients(OFFSETS), SLOPES
    return {
        **{
            of: (getattr(beta, of), getattr(zero, of) * (1 - x * getattr(slope, of))) for of in squirt.Expansion._fields
        },
        "mu_c": (squirt.critical_friction(beta), squirt.first_order_critical_friction(OFFSETS, **line)),
        "gamma": (squirt.gamma(beta), squirt.first_order_gamma(OFFSETS, **line)),
        "tangent": (np.divide(*form.velocity.T), squirt.first_order_leaving_tangent(OFFSETS, **line)),
        "psi": (form.squirt, squirt.first_order_squirt(OFFSETS, **line)),
    }


def limits(x: float) -> dict[str, tuple]:
    """Exact values at an epsilon beside their limits for a light cue end."""
    form, velocity = two_part_form(x), two_part_form(x).velocity
    start = squirt.initial_impulse(squirt.two_part(OFFSETS, cue_end_ratio=x, **LINE), OFFSETS)
    turning = squirt.cue_end_rotation(OFFSETS, velocity, cue_end_ratio=x)
    return {
        "speed": (np.hypot(*velocity.T), squirt.ball_speed(OFFSETS, **LINE)),
        "spin": (form.spin, squirt.ball_spin(OFFSETS, **LINE)),
        "cue_speed": (form.cue_speed, squirt.cue_speed(OFFSETS, **LINE)),
        "factor": (form.restitution_factor, squirt.light_restitution_factor(OFFSETS)),
        "rotation": (turning, squirt.light_cue_end_rotation(OFFSETS, **LINE)),
        "p_0": (start, squirt.light_initial_impulse(OFFSETS, **LINE)),
        "energy": (np.sum(velocity**2, axis=-1) + 0.4 * form.spin**2, squirt.kinetic_energy(OFFSETS, **LINE)),
    }


def two_part_form(x: float) -> squirt.ClosedForm:
    return squirt.closed_form(OFFSETS, mass=18 / 7, end_mass=x / 4, ball_mass=1.0)


@pytest.mark.parametrize(("pairs", "order", "largest", "within"), [(expansions, 2, 1e-3, 0.1), (limits, 1, 1e-4, 0.05)])
def test_a_light_cue_end_is_missed_by_the_next_order(pairs, order, largest, within):
    """Halving epsilon divides the error by 2^order, at every level and offset: each has its own constant."""
    told = [pairs(x) for x in largest / 2 ** np.arange(4)]
    for name in told[0]:
        # the expansions have poles 1/sin^2 at head on
        miss = np.array([np.abs(np.subtract(*each[name])) for each in told])[:, order - 1 :]
        rate = np.log2(miss[:-1] / miss[1:])
        assert np.all(np.abs(rate - order) < within), (name, rate)


def test_largest_spin_is_where_spin_is_largest():
    at = squirt.offset_of_largest_spin(**LINE)
    spin = squirt.ball_spin([at - 1e-4, at, at + 1e-4], **LINE)
    assert spin[1] == pytest.approx(squirt.largest_spin(**LINE), rel=1e-14)
    assert spin[0] < spin[1] > spin[2]


def slips_to_the_end(offset, *, m_a, m_e, mu, e):
    """Independent of the formula: walk the slip only, and look at the sliding speed when e^2 of the work is back."""
    u = np.array([offset, np.sqrt(1 - offset**2)])
    w = np.array([u[1], -u[0]])
    B = np.diag([3.5, 1.0]) + np.outer(u, u) / m_a + np.outer(w, w) / m_e
    rate = B @ [mu, 1.0]
    if rate[1] <= 0:
        return False
    return -u[0] + rate[0] * (1 + e) * u[1] / rate[1] < 0


@pytest.mark.parametrize(("m_a", "m_e"), [(18 / 7, 1 / 70), (3.0, 0.36), (1.0, 1.0), (0.5, 3.0)])
@pytest.mark.parametrize("e", [0.0, 0.75, 1.0])
def test_miscue_offset_is_where_slip_lasts_to_the_end(m_a, m_e, e):
    ratios = {"cue_mass_ratio": m_a, "end_mass_ratio": m_e}
    mu = np.array([0.1, 0.4, 0.6, 0.9])
    limit = squirt.miscue_offset(mu, restitution=e, **ratios)
    back = squirt.miscue_friction(squirt.lumped(limit, **ratios), limit, restitution=e)
    np.testing.assert_allclose(back, mu, rtol=1e-12)
    for friction, offset in zip(mu, limit, strict=True):
        assert not slips_to_the_end(offset * (1 - 1e-9), m_a=m_a, m_e=m_e, mu=friction, e=e)
        assert slips_to_the_end(offset * (1 + 1e-9), m_a=m_a, m_e=m_e, mu=friction, e=e)
    assert squirt.miscue_offset(0.0, restitution=e, **ratios) == 0


def test_jam_friction_turns_the_compression_rate():
    beta = squirt.two_part(OFFSETS, **KIM)
    jam = squirt.jam_friction(beta)
    np.testing.assert_allclose(jam, squirt.critical_friction(beta) / squirt.gamma(beta), rtol=1e-13)
    assert squirt.jam_friction(squirt.lumped(0.0, cue_mass_ratio=1.0, end_mass_ratio=1.0)) == np.inf


def test_cue_end_of_a_cylinder_and_of_a_pointed_cone():
    assert squirt.centre_of_mass(tip_radius=0.006, base_radius=0.006) == pytest.approx(0.5, rel=1e-15)
    assert squirt.inertia_factor(tip_radius=0.006, base_radius=0.006) == pytest.approx(1 / 3, rel=1e-14)
    rod = squirt.inertia_factor(tip_radius=0.006, base_radius=0.006, end_length=0.12)
    assert rod == pytest.approx(1 / 3 + (0.006 / 0.12) ** 2, rel=1e-14)  # + r^2/4 over (l/2)^2
    assert squirt.centre_of_mass(tip_radius=0.0, base_radius=0.01) == pytest.approx(0.25, rel=1e-15)
    assert squirt.inertia_factor(tip_radius=0.0, base_radius=0.01) == pytest.approx(1 / 15, rel=1e-14)
    long = squirt.inertia_factor(tip_radius=0.0, base_radius=0.01, end_length=0.1)
    assert long == pytest.approx(1 / 15 + 3 / 20 * 0.1**2 / 0.75**2, rel=1e-13)
    assert squirt.volume_ratio(0.5, length=1.0, tip_radius=0.0, butt_radius=0.02) == pytest.approx(1 / 8, rel=1e-14)


def test_natural_pivot_is_where_the_cue_line_crosses_the_centre_line():
    """A cue turned by psi about the pivot points its axis from the ball's centre to the dome's centre."""
    psi, R, r, b = 0.02, 0.03, 0.01, 0.4
    p = squirt.natural_pivot_length(b, psi, radius=R, dome_radius=r)
    assert (p + R) * np.sin(psi) == pytest.approx(squirt.axis_offset(b, radius=R, dome_radius=r), rel=1e-14)
    assert squirt.natural_pivot_length(-b, -psi, radius=R, dome_radius=r) == p
    assert squirt.natural_pivot_length(b, 0.0, radius=R) == np.inf


def test_shepard_is_a31_with_b_measured_to_the_line_of_force():
    offset = np.linspace(-0.9, 0.9, 19)
    psi = squirt.alciatore_a31(offset, mass_ratio=70.0)
    line = squirt.force_line_offset(offset, psi)
    np.testing.assert_allclose(squirt.shepard(line, mass_ratio=70.0), psi, rtol=1e-13)
    np.testing.assert_allclose(squirt.contact_offset(line, psi), offset, rtol=1e-14, atol=1e-16)
    assert np.all(np.abs(line) <= np.abs(offset))
    # the line of the force passes the centre at R p_t/|p|
    form = squirt.closed_form(0.5, mass=0.54, end_mass=0.003)
    p_t, p_n = form.velocity
    assert squirt.force_line_offset(0.5, form.squirt) == pytest.approx(p_t / np.hypot(p_t, p_n), rel=1e-14)


def test_elastic_a30_is_the_light_limit_of_the_ball_speed():
    a30 = squirt.alciatore_a30(OFFSETS, mass_ratio=7 / 18)
    np.testing.assert_allclose(a30, squirt.ball_speed(OFFSETS, cue_mass_ratio=18 / 7, restitution=1.0), rtol=1e-15)
