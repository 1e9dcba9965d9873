"""Verification of the strike from the side on long beams: the square root of time of endless Euler beams."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cuefem import Cue, Material, Segment, SideOutcome, SideStrike, Striker, resolve_side_strike, side_strike
from tests.helpers.half_order import spring_exact, stepped
from tests.helpers.orders import assert_order

T, DIAMETER, DENSITY, SPEED = 1e-3, 1e-2, 700.0, 2.0
HERTZ_TIME = 2.943275  # of a contact with a wall, in the unit of `stepped`
# Of a striker whose law gives so much back, on a beam so long that nothing returns in the contact: in waves' lengths.
LONG = {"middle": 16.0, "end": 8.0}


def beam(lengths: float, slenderness: float, *, shear: float = 1e4) -> Cue:
    """A rod of so many times the way that bending waves spread in T, which is so many of its diameters.

    shear: G over E; a large one leaves out the shear of Timoshenko's beam, slenderness its rotary inertia.
    """
    spread = slenderness * DIAMETER  # (EI/rhoA)^(1/4) sqrt(T)
    E = 16 * DENSITY * (spread**2 / T) ** 2 / DIAMETER**2
    return Cue((Segment(lengths * spread, DIAMETER, DIAMETER, Material(E, shear * E, DENSITY, nu=0.0), kappa=1.0),))


def struck(
    cue: Cue,
    where: str,
    inelasticity: float,
    *,
    restitution: float = 1.0,
    hertz: bool = False,
    rtol: float | None = None,
) -> tuple[SideOutcome, float]:
    """The strike of that inelasticity in the middle or at the end; and the unit of time of `half_order`, s."""
    section = cue.section(0.0)
    C = 1 / (2 * math.sqrt(2) * float(section.EI) ** 0.25 * float(section.rhoA) ** 0.75)
    C = C if where == "middle" else 4 * C
    unit = T / (HERTZ_TIME if hertz else math.pi)
    mass = inelasticity / C * math.sqrt(unit)
    if hertz:
        depth = SPEED * unit
        law = {"modulus": 0.75 * mass * SPEED**2 / depth**2.5 / 0.1, "radius": 0.01}
    else:
        law = {"stiffness": mass / unit**2}
    scene = SideStrike(cue, Striker(mass, restitution, **law), cue.length / 2 if where == "middle" else 0.0, SPEED)
    return side_strike(scene) if rtol is None else resolve_side_strike(scene, rtol), unit


def test_two_independent_solutions_agree() -> None:
    """The closed form of a spring, and product integration of any law, whose error falls like 1/steps^2."""
    exact = spring_exact(0.5)[0]
    steps = (500, 1000, 2000)
    errors = [abs(stepped(0.5, steps=count, span=4.0)[0] - exact) for count in steps]
    assert_order(2, [1 / count for count in steps], errors, within=0.05)
    assert errors[-1] < 2e-7
    assert abs(spring_exact(1e-9)[0] - 1) < 1e-7  # a heavy beam is a wall


@pytest.mark.parametrize("inelasticity", [0.05, 0.2, 0.5, 1.0, 2.0])
@pytest.mark.parametrize("where", ["middle", "end"])
def test_the_curve_of_e_A_over_inelasticity(where: str, inelasticity: float) -> None:
    """An elastic spring: e_A of the endless beam to 1e-5, its duration to 1e-4."""
    outcome, unit = struck(beam(LONG[where], 250), where, inelasticity)
    exact, duration = spring_exact(inelasticity)
    assert abs(outcome.apparent_restitution - exact) < 1e-5
    assert abs(outcome.duration / unit / duration - 1) < 1e-4


@pytest.mark.parametrize(("where", "lengths"), [("middle", (4, 8, 16)), ("end", (2, 4, 8))])
def test_it_is_reached_as_the_beam_gets_long(where: str, lengths: tuple[float, ...]) -> None:
    """What comes back from the ends fades: twice the length takes e_A ten, then a hundred times nearer."""
    exact = spring_exact(1.0)[0]
    errors = [abs(struck(beam(n, 250), where, 1.0)[0].apparent_restitution - exact) for n in lengths]
    assert errors[0] > 10 * errors[1] > 1000 * errors[2]
    assert errors[-1] < 1e-6


@pytest.mark.parametrize("where", ["middle", "end"])
@pytest.mark.parametrize("restitution", [0.8, 0.5, 0.2])
def test_with_a_loss_of_the_contact_itself(where: str, restitution: float) -> None:
    outcome, unit = struck(beam(LONG[where], 250), where, 0.5, restitution=restitution)
    exact, duration = stepped(0.5, restitution=restitution, span=4.0)
    assert abs(outcome.apparent_restitution - exact) < 1e-5
    assert abs(outcome.duration / unit / duration - 1) < 1e-4


@pytest.mark.heavy
@pytest.mark.parametrize("where", ["middle", "end"])
@pytest.mark.parametrize(("inelasticity", "restitution"), [(0.2, 1.0), (1.0, 1.0), (0.5, 0.7)])
def test_hertz(where: str, inelasticity: float, restitution: float) -> None:
    outcome, unit = struck(beam(LONG[where], 250), where, inelasticity, restitution=restitution, hertz=True)
    exact, duration = stepped(inelasticity, exponent=1.5, restitution=restitution, span=5.0)
    assert abs(outcome.apparent_restitution - exact) < 2e-5
    assert abs(outcome.duration / unit / duration - 1) < 1e-4


def test_hertz_at_the_end() -> None:
    outcome, _ = struck(beam(5.0, 250), "end", 0.5, restitution=0.7, hertz=True)
    exact, _ = stepped(0.5, exponent=1.5, restitution=0.7, steps=2000, span=5.0)
    assert abs(outcome.apparent_restitution - exact) < 1e-4


@pytest.mark.parametrize("where", ["middle", "end"])
def test_rotary_inertia_goes_with_the_square_of_the_thickness(where: str) -> None:
    exact = spring_exact(1.0)[0]
    thick = (10.0, 20.0, 40.0)
    errors = [struck(beam(LONG[where], n), where, 1.0)[0].apparent_restitution - exact for n in thick]
    assert_order(2, [1 / n for n in thick], np.abs(errors), within=0.12)


def test_shear_goes_with_the_square_too_and_matters_more() -> None:
    """Timoshenko's beam of wood against Euler's: shear with E/G = 15 takes e_A down, rotary inertia a little up."""
    exact = spring_exact(1.0)[0]
    thick = (20.0, 40.0, 80.0)
    wood, stiff = (
        np.array([struck(beam(8.0, n, shear=shear), "end", 1.0)[0].apparent_restitution - exact for n in thick])
        for shear in (1 / 15, 1e4)
    )
    assert_order(2, [1 / n for n in thick], np.abs(wood), within=0.25)
    assert -8 < wood[-1] / stiff[-1] < -3


@pytest.mark.parametrize("where", ["middle", "end"])
def test_the_accuracy_asked_for_holds_against_the_exact_solution(where: str) -> None:
    exact = spring_exact(0.5)[0]
    for rtol in (1e-2, 1e-3, 1e-4):
        outcome, _ = struck(beam(LONG[where], 250), where, 0.5, rtol=rtol)
        assert outcome.error is not None
        assert abs(outcome.apparent_restitution - exact) < outcome.error < rtol
