"""The rates at which the finite-element cue reaches the lumped one (studies/paper/convergence.py), and why."""

import matplotlib as mpl
import numpy as np
import pytest

from cuefem import Resolution
from cuefem.tip_modes import tip_modes_of
from studies import pages, strokes
from tests.helpers.orders import observed_orders

mpl.use("Agg")
from studies.paper import convergence as study
from studies.paper import convergence_roads as roads

KIM = strokes.scene(strokes.cue("kim"), 1e-3, 0.3)


def test_the_stub_has_the_exact_rigid_end_mass_of_its_frustum():
    """m_c nu_c/(1 + nu_c) is what its two rigid modes give; nu_c with rotary inertia, 0.309 (without: 0.307)."""
    tip = tip_modes_of(strokes.scene(roads.stub()), Resolution(1, 6, 1))
    assert roads.stub_end_mass() == pytest.approx(roads.rigid_end_mass(tip), rel=1e-12)
    assert roads.stub_end_mass() == pytest.approx(2.84587e-3, rel=1e-5)


@pytest.mark.heavy
@pytest.mark.parametrize(("name", "power"), [("stiff_stub", -1), ("long_contact", -2)])
def test_force_velocity_and_squirt_become_rigid_and_stick_does_not(name, power):
    rates, (_, largest) = study.rigid_rates(name), study.envelopes(name)
    for drive in ("force", "velocity", "squirt"):
        assert rates[drive] == pytest.approx(power, abs=0.2), drive
        assert largest[drive][-1] < (5e-4 if drive == "squirt" else 5e-5)
    assert abs(rates["stick"]) < 0.2
    assert 0.1 < largest["stick"][-1] < 0.3


@pytest.mark.heavy
def test_it_is_friction_that_ends_the_ringing():
    """Without a cap on the tangential force the coupled squirt rings for ever, as the stick end mass does."""
    endless, largest = study.rigid_rates("stiff_stub", np.inf), study.envelopes("stiff_stub", np.inf)[1]
    assert abs(endless["squirt"]) < 0.1
    assert 0.1 < largest["squirt"][-1] < 0.3
    assert study.rigid_rates("stiff_stub", 10.0)["squirt"] == pytest.approx(-1, abs=0.2)


def test_kims_shaft_at_its_rigid_limit():
    """handbook: Effective end mass: mass/m_e = 5.494268; squirt 4.093 degrees at b/R 0.3."""
    tip = tip_modes_of(KIM, Resolution(4, 20, 12))
    assert 0.12 / roads.rigid_end_mass(tip) == pytest.approx(5.494268, rel=1e-7)
    assert np.degrees(strokes.lumped_squirt(KIM, roads.rigid_end_mass(tip))) == pytest.approx(4.093, abs=5e-4)


@pytest.mark.heavy
def test_the_tail_of_the_modes_follows_the_compliance_left_out():
    """As a power of it the tail is the first; their ratio wanders by some per cent and does not settle."""
    road = study.road("more_modes")
    far = road.along >= 28
    assert pages.slope(road.errors["compliance"][far], road.errors["squirt"][far]) == pytest.approx(1, abs=0.03)
    ratios = study.tail_ratios()
    assert 1.03 < ratios.max() / ratios.min() < 1.1
    assert study.modes_rate() == pytest.approx(-1.4, abs=0.1)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_squirt_converges_with_two_orders_a_degree(order):
    """Linear elements only late."""
    road = study.road("more_elements", order)
    orders = observed_orders(1 / road.along, np.abs(road.errors["squirt"]))
    assert orders[-1 if order == 1 else 0 :] == pytest.approx(2 * order, abs=0.03 if order == 1 else 0.06)


def test_the_order_converges_faster_than_any_power():
    """Every three orders gain more than the three before, from 12 on; at 21 the error is 5e-11."""
    road = study.road("higher_order")
    errors = dict(zip(road.along, np.abs(road.errors["squirt"]), strict=True))
    assert all(errors[p] / errors[p + 3] > gain for p, gain in ((12, 10), (15, 100), (18, 100)))
    assert 1e-13 < errors[21] < 5e-10
