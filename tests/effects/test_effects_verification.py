"""Effects against closed forms and exact limits, each limit at its stated rate."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from scipy.optimize import brentq

import cuefem as cf
from cuefem.beam.system import assemble
from cuefem.contact.strike import strike_modes
from cuefem.effects import Effect
from cuefem.effects.axial import rod_modes
from cuefem.tip_modes import tip_modes_of
from tests.helpers.cues import MAPLE, isotropic_kim, kim
from tests.helpers.orders import falls_with_the_step
from tests.helpers.strike_scenes import KIM, kim_scene

HERE = 0.213  # m, between the nodes of every mesh used here


NODE = cf.PointMass(HERE, 0.0)  # a node alone: the mesh's error is the same with and without the effect


# --- supports ---------------------------------------------------------------------------------------------------------

CLAMPED = [30.0962060889, 135.9070113953]  # Hz, Kim's isotropic cone clamped at the butt


@pytest.mark.parametrize(("stiffness", "within"), [(inf, 1e-7), (1e12, 1e-7)])
def test_a_clamp_at_the_butt(stiffness, within):
    found = cf.modes(isotropic_kim(), 2, effects=(cf.Support(0.7, stiffness, stiffness),))
    np.testing.assert_allclose(found.frequencies, CLAMPED, rtol=within)
    assert found.rigid == 0


# --- point masses -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_a_point_mass_loads_the_axis_by_its_share_alone(share):
    """Bending modes are those of the whole mass; head on, the cue is as heavy as with its share of it behind."""
    lump = cf.PointMass(HERE, 0.05, axial_share=share)
    across = [cf.modes(kim(), 3, effects=(each,)).frequencies for each in (lump, cf.PointMass(HERE, 0.05))]
    np.testing.assert_allclose(*across, rtol=1e-12)
    heavier = replace(kim(), body_mass=kim().body_mass + 0.05 * share)
    assert cf.strike(cf.Scene(kim(), effects=(lump,))).ball_speed == pytest.approx(
        cf.strike(cf.Scene(heavier)).ball_speed
    )


# --- joints -----------------------------------------------------------------------------------------------------------

SOFT = (3e-3, 2e-6)  # rad/(N m), m/N


@pytest.mark.parametrize("order", [3, 12])
@pytest.mark.parametrize("compliances", [SOFT, (SOFT[0], 0.0), (0.0, SOFT[1]), (0.0, 0.0)])
def test_a_joint_is_a_spring_in_series(compliances, order):
    """A force at the tip of a cue clamped at its butt bends it by the joint's lever squared, and shears it, more."""

    def give(*effects: Effect) -> float:
        system = assemble(KIM, cf.Resolution(3, order, 1), (cf.Support(0.7, inf, inf), *effects))
        force = system.forces_at(0.0)[:, 0]
        return force @ np.linalg.solve(system.K, force)

    rotational, shear = compliances
    extra = HERE**2 * rotational + shear
    assert abs(give(cf.Joint(HERE, *compliances)) / (give(NODE) + extra) - 1) < 1e-11


def test_a_hinge_in_the_middle_leaves_odd_modes_and_makes_even_ones_of_two_halves():
    """Even modes of a hinged rod: each half is free at both ends; odd ones have no moment in the middle anyway."""
    whole, half = cf.Cue((cf.Segment(0.8, 0.012, 0.012, MAPLE),)), cf.Cue((cf.Segment(0.4, 0.012, 0.012, MAPLE),))
    at = cf.Resolution(2, 20, 7)
    hinged = cf.modes(whole, 7, effects=(cf.Joint(0.4, rotational_compliance=1e12),), at=at).frequencies
    odd, even = cf.modes(whole, 6, at=at).frequencies[1::2], cf.modes(half, 3, at=at).frequencies
    assert hinged[0] < 1e-3  # the hinge's own swing
    np.testing.assert_allclose(hinged[1:], np.sort([*odd, *even]), rtol=1e-11)


# --- axial waves ------------------------------------------------------------------------------------------------------

ROD = cf.Cue((cf.Segment(0.7, 0.012, 0.012, MAPLE),))
SPEED = (MAPLE.E / MAPLE.rho) ** 0.5


def rods(cue: cf.Cue, *masses: tuple[float, float]) -> np.ndarray:
    return rod_modes(cue, masses, below=2 * pi * 3e4).omega


def test_a_rod_with_a_mass_at_its_butt():
    """cos(kx) ends on the mass m: EA k sin(kL) + m omega^2 cos(kL) = 0."""
    EA, m = float(ROD.section(0.0).EA), 0.3
    k = rods(ROD, (0.7, m)) / SPEED

    def misfit(y: float) -> float:
        return np.sin(y) + m * SPEED**2 * y / (EA * 0.7) * np.cos(y)

    exact = [brentq(misfit, (n + 0.5) * pi, (n + 1) * pi, xtol=1e-14) for n in range(len(k))]
    np.testing.assert_allclose(k * 0.7, exact, rtol=1e-7)


def test_a_cone_s_rod_modes():
    """r u is a plane wave: (r u)' = (r'/r) (r u) at both free ends."""
    cue = kim()
    material = cue.segments[0].material
    k = rods(cue) / (material.E / material.rho) ** 0.5
    tip, butt = 0.0045 / 0.7 / 0.006, 0.0045 / 0.7 / 0.0105  # r'/r

    def misfit(k: float) -> float:  # of A = 1, B = tip/k in A cos(kx) + B sin(kx)
        s, c = np.sin(0.7 * k), np.cos(0.7 * k)
        return -k * s + tip * c - butt * (c + tip / k * s)

    exact = [brentq(misfit, (n + 0.5) * pi / 0.7, (n + 1.5) * pi / 0.7, xtol=1e-13) for n in range(len(k))]
    np.testing.assert_allclose(k, exact, rtol=1e-7)


# --- structural damping -----------------------------------------------------------------------------------------------


def lossy_cue(shell: float = 1.0, core: float = 1.0) -> cf.Cue:
    """A bored shaft with a core and a plain one behind it; the factors scale both moduli of two of its materials."""
    plastic, foam = (
        cf.Material(3e9 * shell, 1.1e9 * shell, 1200.0, 0.05),
        cf.Material(1e9 * core, 4e8 * core, 300.0, 0.2),
    )
    wood = replace(MAPLE, loss=0.012)
    front = cf.Segment(0.3, 0.0125, 0.0125, plastic, 0.008, 0.009, core=foam, kappa=0.9)
    return cf.Cue((front, cf.Segment(0.4, 0.0125, 0.02, wood, kappa=0.9)))


def modal_loss(cue: cf.Cue, effect: cf.StructuralDamping, **more: float) -> np.ndarray:
    """Loss factors of the tip modes: damping over frequency."""
    tip = tip_modes_of(cf.Scene(cue, effects=(effect, *more.get("effects", ()))), cf.Resolution(3, 16, 12))
    assert np.count_nonzero(tip.damping - np.diag(np.diag(tip.damping))) == 0
    vibrating = tip.omega > 0
    assert np.all(np.diag(tip.damping)[~vibrating] == 0)
    return np.diag(tip.damping)[vibrating] / tip.omega[vibrating]


@pytest.mark.parametrize("effects", [(), (cf.AxialWaves(),), (cf.Joint(0.3, 1e-3),)])
def test_loss_factors_are_those_of_the_strain_energy(effects):
    """A material's share of a mode's strain energy is what its moduli do to the frequency: d ln omega^2 / d ln E."""

    def squares(shell: float, core: float) -> np.ndarray:
        return tip_modes_of(cf.Scene(lossy_cue(shell, core), effects=effects), cf.Resolution(3, 16, 12)).omega ** 2

    h = 1e-4
    shares = []
    for shell, core in ((h, 0.0), (0.0, h)):
        up, down = squares(1 + shell, 1 + core), squares(1 - shell, 1 - core)
        moving = up > 0
        shares.append((np.log(up[moving]) - np.log(down[moving])) / (2 * h))
    front, inside = shares
    if not any(isinstance(effect, cf.Joint) for effect in effects):  # whose energy is lost nowhere
        expected = 0.05 * front + 0.2 * inside + 0.012 * (1 - front - inside)
        found = modal_loss(lossy_cue(), cf.StructuralDamping(), effects=effects)
        np.testing.assert_allclose(found, expected, rtol=1e-5)
        assert np.ptp(found) > 1e-3
    else:
        found = modal_loss(lossy_cue(), cf.StructuralDamping(0.05), effects=effects)
        assert np.all(found < 0.05)
        assert found.min() < 0.05 * 0.99


def test_one_material_s_loss_is_every_mode_s():
    np.testing.assert_allclose(modal_loss(kim(), cf.StructuralDamping(0.012)), 0.012, rtol=1e-12)
    wood = replace(kim().segments[0].material, loss=0.012)
    lossy = cf.Cue((replace(kim().segments[0], material=wood),))
    np.testing.assert_allclose(modal_loss(lossy, cf.StructuralDamping()), 0.012, rtol=1e-12)
    assert np.all(modal_loss(kim(), cf.StructuralDamping()) == 0)


# --- dome -------------------------------------------------------------------------------------------------------------


RADIUS = 0.012


def rigid_domed(offset: float) -> tuple[cf.Cue, cf.LumpedCue]:
    """A stub, and its inverse mass at the contact as a rigid body's with a dome.

    With u forward along the axis and w across it the contact lies from the centre of mass at x forward to the apex,
    r back to the dome's centre, and r along n = (cos phi, -sin phi): rotation moves it by (-w, u) of that.
    """
    stub = cf.Cue((cf.Segment(0.06, 0.012, 0.016, MAPLE),))
    x = stub.balance_point
    s, weights = np.polynomial.legendre.leggauss(10)
    s = (s + 1) * 0.03
    section = stub.section(s)
    inertia = 0.03 * weights @ (section.rhoA * (s - x) ** 2 + section.rhoI)
    phi = np.arcsin(offset)
    forward, aside = x - RADIUS + RADIUS * np.cos(phi), -RADIUS * np.sin(phi)
    u, w = -aside, forward
    along, across = 1 / stub.mass + u**2 / inertia, 1 / stub.mass + w**2 / inertia
    return stub, cf.LumpedCue(1 / along, 1 / across, u * w / inertia)


@pytest.mark.parametrize("offset", [0.05, 0.3, 0.6, -0.3])
@pytest.mark.parametrize(("restitution", "friction"), [(0.75, 0.7), (0.05, 0.5), (1.0, 0.2), (0.75, inf)])
def test_a_rigid_body_with_a_dome_is_a_lumped_cue_with_coupling(offset, restitution, friction):
    stub, lumped = rigid_domed(abs(offset))
    scene = replace(kim_scene(offset, restitution=restitution, friction=friction), cue=stub)
    domed = replace(scene, effects=(cf.TipDome(RADIUS),))
    tip, expected = tip_modes_of(domed, cf.Resolution(1, 4, 1)).lowest(3), cf.impulse(replace(scene, cue=lumped))

    def error(steps: int) -> float:
        coupled = strike_modes(domed, tip, steps=steps)
        given_by = np.abs(coupled.impulse - expected.impulse).max() / expected.impulse[1]
        return float(max(abs(coupled.squirt - expected.squirt), given_by))

    falls_with_the_step(error, most=1e-3)
    flat = cf.impulse(replace(scene, cue=replace(lumped, coupling=0.0)))
    assert abs(expected.squirt - flat.squirt) > 1e-4 or friction == 0.2
