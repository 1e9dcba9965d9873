"""The committed tables of convergence.py, end_mass.py and energy.py derived again, and what they say checked."""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

from cuefem import Resolution
from cuefem.tip_modes import tip_modes_of
from cuefem.validation import disagreements

mpl.use("Agg")
sys.path.append(str(Path(__file__).parents[2] / "studies"))
import common
import convergence
import convergence_figures
import end_mass
import energy

STUDIES = Path(__file__).parents[2] / "studies"


def committed(name):
    return (STUDIES / f"{name}.md").read_text(encoding="utf-8")


@pytest.mark.heavy
@pytest.mark.parametrize("study", [convergence, end_mass], ids=["convergence", "end_mass"])
def test_committed_tables(study):
    assert disagreements(committed(study.__name__), study.report()) == []


def test_committed_table_of_energies():
    assert disagreements(committed("energy"), energy.report()) == []


def test_a_changed_number_of_a_committed_table_is_found():
    table = energy.report()
    assert len(disagreements(table.replace("| 61.74 |", "| 61.77 |"), table)) == 1
    assert len(disagreements(table.replace("late stick", "stick", 1), table)) == 1


@pytest.mark.heavy
def test_figures_are_drawn(tmp_path):
    convergence_figures.figures(tmp_path, convergence)
    end_mass.figures(tmp_path)
    energy.figures(tmp_path)
    drawn = {path.name for path in tmp_path.iterdir()}
    names = ("convergence_rigid", "convergence_lumped", "convergence_mesh", "end_mass", "energy")
    assert drawn == {f"{name}.svg" for name in names}
    assert all((STUDIES / name).exists() for name in drawn)


def test_tables_print_text_as_it_is_and_numbers_with_the_digits_asked_for():
    assert common.table(["a", "b"], [["x", 1 / 3], ["y", 2e-9]], 3) == (
        "| a | b |\n|---|---|\n| x | 0.333 |\n| y | 2e-09 |\n"
    )


# end mass


@pytest.mark.heavy
def test_which_definition_predicts_squirt():
    """Stick is the best of force, velocity and stick; taken at the offset it is better still, at every offset."""
    for offset in end_mass.OFFSETS:
        own, stick, velocity, force = (np.median(end_mass.sizes(d, offset)) for d in end_mass.DEFINITIONS[:4])
        assert own < stick / 3 < stick < velocity < force
    assert 0.004 < np.median(end_mass.sizes("stick at the offset", 0.3)) < 0.01
    assert 0.06 < np.median(end_mass.sizes("stick", 0.3)) < 0.1


@pytest.mark.heavy
def test_squirt_equivalent_is_what_the_impulse_solver_wants():
    for case in end_mass.cases():
        struck = common.scene(common.cue(case.name), case.time, case.offset)
        assert common.lumped_squirt(struck, case.equivalent) == pytest.approx(case.squirt, rel=1e-9)
        over = (case.masses["force"] / case.equivalent, case.masses["velocity"] / case.equivalent)
        assert over[0] > over[1] > 1


def test_definitions_on_kims_shaft_at_one_millisecond():
    """handbook: Effective end mass: stick 5.3 g, force 10.4 g; the paper's 12 g is 3 g at the tip."""
    struck = common.scene(common.cue("kim"), 1e-3, 0.3)
    case = end_mass.case("kim", 1e-3, 0.3, tip_modes_of(struck))
    assert case.masses["stick"] == pytest.approx(5.27e-3, rel=5e-3)
    assert case.masses["force"] == pytest.approx(10.4e-3, rel=5e-3)
    assert case.masses["stick at the offset"] == pytest.approx(case.equivalent, rel=0.02)
    assert case.errors["stick"] == pytest.approx(0.095, abs=0.005)
    assert case.errors["Kim's 3 g"] == pytest.approx(-0.354, abs=0.005)


def test_the_constant_of_a_semi_infinite_beam():
    """A long uniform rod, light beside the ball: its stick end mass before any wave returns."""
    cone = common.cue("kim").segments[0]
    wood = common.replace(cone.material, G=100 * cone.material.E / 2.6, nu=0.0)  # shear-stiff: Euler's beam
    rod = common.Cue((common.replace(cone, length=6.0, butt_diameter=1e-3, tip_diameter=1e-3, material=wood),), 0.54)
    struck = common.scene(rod, 4e-3)
    tip = tip_modes_of(struck, Resolution(40, 20, 250))
    section = rod.section(0.0)
    law = end_mass.stick_constant() * section.rhoA * np.sqrt(4e-3 * np.sqrt(section.EI / section.rhoA))
    assert end_mass.stick(tip, struck) == pytest.approx(float(law), rel=5e-4)


# energy


@pytest.mark.parametrize("name", energy.CUES)
def test_shares_add_up_and_say_what_the_text_says(name):
    for offset in energy.OFFSETS:
        assert sum(energy.shares(name, float(offset))[0].values()) == pytest.approx(1, abs=1e-9)
    head_on, _ = energy.shares(name, 0.0)
    assert head_on["ball rotation"] == head_on["cue vibration"] == head_on["friction loss"] == 0
    spin, at = energy.largest(name, "ball rotation")
    assert 0.15 < spin < 0.18
    assert 0.5 < at < 0.6
    vibration, _ = energy.largest(name, "cue vibration")
    assert 0.015 < vibration < 0.03


def test_head_on_shares_are_those_of_two_masses():
    """Momentum and e^2 alone: the ball takes (1 + e)^2 q/(1 + q)^2, q = M/M_c, the tip (1 - e^2)/(1 + 1/q)."""
    q = 0.21 / 0.54
    head_on, _ = energy.shares("kim", 0.0)
    assert head_on["ball translation"] == pytest.approx(1.75**2 * q / (1 + q) ** 2, rel=1e-9)
    assert head_on["tip loss"] == pytest.approx((1 - 0.75**2) * q / (1 + q), rel=1e-9)


def test_the_edge_of_kims_miscue_is_not_sharp():
    assert energy.miscues("kim")[0] == 0.62
    assert energy.gripping_again("kim") == [0.63, 0.64, 0.65]
    assert energy.gripping_again("pool_maple") == []
    assert energy.duration("kim", 0.64) > 2 * energy.duration("kim", 0.62)
