"""Effects against closed forms and exact limits, each limit at its stated rate."""

from dataclasses import replace
from math import inf, pi
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from cuefem import (
    AxialWaves,
    Cue,
    Joint,
    LumpedCue,
    Material,
    PointMass,
    Resolution,
    Scene,
    Segment,
    StructuralDamping,
    Support,
    TipDome,
    TipShear,
    end_mass,
    impulse,
    load,
    modes,
    strike,
)
from cuefem.beam.modes import solve
from cuefem.beam.system import assemble
from cuefem.contact.strike import strike_modes
from cuefem.effects import Effect
from cuefem.effects.axial import rod_modes
from cuefem.tip_modes import tip_modes_of
from tests.helpers.cues import MAPLE, isotropic_kim, kim
from tests.helpers.orders import assert_order
from tests.helpers.strike_scenes import KIM, KIM_AT, imbalance, kim_scene

HERE = 0.213  # m, between the nodes of every mesh used here


def squirt(*effects: Effect, offset: float = 0.3) -> float:
    return strike(replace(kim_scene(offset), effects=effects), KIM_AT).squirt


# --- limits in which an effect vanishes -------------------------------------------------------------------------------

NODE = PointMass(HERE, 0.0)  # a node alone: the mesh's error is the same with and without the effect
VANISHING = {
    "point mass": (lambda x: PointMass(HERE, 1e-4 * x), NODE),
    "point mass at the tip": (lambda x: PointMass(0.0, 1e-4 * x), None),
    "rotary inertia": (lambda x: PointMass(HERE, 0.0, 1e-7 * x), NODE),
    "support": (lambda x: Support(HERE, 1e3 * x), NODE),
    "rotational support": (lambda x: Support(HERE, 0.0, x), NODE),
    "dashpot": (lambda x: Support(HERE, dashpot=0.1 * x), NODE),
    "damping": (lambda x: StructuralDamping(0.01 * x), None),
    "rotational joint": (lambda x: Joint(HERE, rotational_compliance=1e-5 * x), NODE),
    "shear joint": (lambda x: Joint(HERE, shear_compliance=1e-8 * x), NODE),
    "dome": (lambda x: TipDome(1e-3 * x), None),
}


@pytest.mark.parametrize("name", VANISHING)
def test_an_effect_vanishes_linearly(name):
    make, limit = VANISHING[name]
    bare = squirt(limit) if limit else squirt()
    steps = [1.0, 1e-1, 1e-2]
    errors = [abs(squirt(make(x)) - bare) for x in steps]
    assert_order(1.0, steps, errors, within=[0.04, 0.01])


@pytest.mark.parametrize("name", VANISHING)
def test_an_effect_of_size_zero_is_none(name):
    make, limit = VANISHING[name]
    bare = squirt(limit) if limit else squirt()
    assert abs(squirt(make(0.0)) / bare - 1) < 1e-14


@pytest.mark.parametrize(("make", "scale"), [(lambda k: Support(HERE, k), 1e9), (lambda k: Support(HERE, 0.0, k), 1e5)])
def test_a_stiff_support_becomes_a_clamp_like_one_over_its_stiffness(make, scale):
    steps = [1.0, 0.1, 0.01]
    clamped = squirt(make(inf))
    assert_order(1.0, steps, [abs(squirt(make(scale / x)) - clamped) for x in steps], within=[0.06, 0.02])


def test_stiff_tip_shear_becomes_the_bare_strike_like_one_over_its_ratio():
    """The patch swings on its spring: the size falls like 1/ratio, with wiggles of a factor two."""
    bare = squirt()
    for ratio in (1e3, 1e4, 1e5, 1e6):
        assert 5e-3 / ratio < abs(squirt(TipShear(ratio)) - bare) < 5e-2 / ratio


# --- supports ---------------------------------------------------------------------------------------------------------

CLAMPED = [30.0962060889, 135.9070113953]  # Hz, Kim's isotropic cone clamped at the butt


@pytest.mark.parametrize(("stiffness", "within"), [(inf, 1e-11), (1e12, 1e-7)])
def test_a_clamp_at_the_butt(stiffness, within):
    found = modes(isotropic_kim(), 2, effects=(Support(0.7, stiffness, stiffness),))
    np.testing.assert_allclose(found.frequencies, CLAMPED, rtol=within)
    assert found.rigid == 0


# --- point masses -----------------------------------------------------------------------------------------------------


def test_a_mass_between_nodes_is_exact():
    """The mass gets a node of its own (trap 4); put on the nearest node of 8 elements it is several per cent off."""
    here = 0.7 * 3.5 / 8
    coarse, fine = (
        end_mass(replace(kim_scene(), effects=(PointMass(here, 0.005),)), at=Resolution(n, order, 40))
        for n, order in ((8, 12), (11, 16))
    )
    assert abs(coarse / fine - 1) < 1e-10
    near = end_mass(replace(kim_scene(), effects=(PointMass(0.1, 0.005),)), at=Resolution(8, 12, 40))
    snapped = end_mass(replace(kim_scene(), effects=(PointMass(0.7 / 8, 0.005),)), at=Resolution(8, 12, 40))
    assert abs(snapped / near - 1) > 0.02


# --- joints -----------------------------------------------------------------------------------------------------------

SOFT = (3e-3, 2e-6)  # rad/(N m), m/N


@pytest.mark.parametrize("order", [3, 12])
@pytest.mark.parametrize("compliances", [SOFT, (SOFT[0], 0.0), (0.0, SOFT[1]), (0.0, 0.0)])
def test_a_joint_is_a_spring_in_series(compliances, order):
    """A force at the tip of a cue clamped at its butt bends it by the joint's lever squared, and shears it, more."""

    def give(*effects: Effect) -> float:
        system = assemble(KIM, elements=3, order=order, effects=(Support(0.7, inf, inf), *effects))
        force = np.zeros(system.mesh.unknowns)
        force[0] = 1.0
        moved = np.linalg.solve(system.free.T @ system.K @ system.free, system.free.T @ force)
        return (system.free @ moved)[0]

    rotational, shear = compliances
    extra = HERE**2 * rotational + shear
    assert abs(give(Joint(HERE, *compliances)) / (give(NODE) + extra) - 1) < 1e-11


def test_a_hinge_in_the_middle_leaves_odd_modes_and_makes_even_ones_of_two_halves():
    """Even modes of a hinged rod: each half is free at both ends; odd ones have no moment in the middle anyway."""
    whole, half = Cue((Segment(0.8, 0.012, 0.012, MAPLE),)), Cue((Segment(0.4, 0.012, 0.012, MAPLE),))
    at = Resolution(2, 20, 7)
    hinged = modes(whole, 7, effects=(Joint(0.4, rotational_compliance=1e12),), at=at).frequencies
    odd, even = modes(whole, 6, at=at).frequencies[1::2], modes(half, 3, at=at).frequencies
    assert hinged[0] < 1e-3  # the hinge's own swing
    np.testing.assert_allclose(hinged[1:], np.sort([*odd, *even]), rtol=1e-11)


def test_a_joint_that_gives_everywhere_leaves_two_pieces():
    wood = KIM.segments[0].material
    middle = 0.012 + 0.009 * 0.3 / 0.7
    pieces = [
        Cue((Segment(0.3, 0.012, middle, wood, kappa=0.9),)),
        Cue((Segment(0.4, middle, 0.021, wood, kappa=0.9),)),
    ]
    alone = np.sort(np.concatenate([modes(piece, 4).frequencies for piece in pieces]))[:4]
    steps = [1.0, 0.1, 0.01]
    errors = []
    for x in steps:
        found = modes(KIM, 6, effects=(Joint(0.3, 1e3 / x, 1e-2 / x),))
        errors.append(np.max(np.abs(found.frequencies[2:] / alone - 1)))
        assert np.all(found.frequencies[:2] < 50 * x**0.5)
    assert_order(1.0, steps, errors, within=0.02)


def test_the_sparse_path_knows_joints_ties_and_clamps():
    effects = (Joint(HERE, SOFT[0]), Joint(0.5, *SOFT), Support(0.7, inf), PointMass(0.1, 0.01))
    dense, sparse = (
        solve(assemble(KIM, elements=n, order=order, effects=effects), 6) for n, order in ((1, 16), (25, 5))
    )
    assert isinstance(dense.system.K, np.ndarray)
    assert not isinstance(sparse.system.K, np.ndarray)
    np.testing.assert_allclose(sparse.frequencies, dense.frequencies, rtol=1e-8)
    for (w, _), (w2, _) in [(dense.shape([HERE, 0.6]), sparse.shape([HERE, 0.6]))]:
        np.testing.assert_allclose(w, w2, rtol=1e-5, atol=1e-5)


# --- axial waves ------------------------------------------------------------------------------------------------------

ROD = Cue((Segment(0.7, 0.012, 0.012, MAPLE),))
SPEED = (MAPLE.E / MAPLE.rho) ** 0.5


def rods(cue: Cue, *masses: tuple[float, float]) -> np.ndarray:
    system = assemble(cue, elements=4, order=16, effects=tuple(PointMass(x, 0.0) for x, _ in masses))
    return rod_modes(system, cue, masses, below=2 * pi * 3e4).omega


def test_a_free_rod_sounds_at_whole_multiples():
    found = rods(ROD)
    np.testing.assert_allclose(found, np.arange(1, len(found) + 1) * pi * SPEED / 0.7, rtol=1e-12)
    assert len(found) == int(2 * 3e4 * 0.7 / SPEED)


def test_a_rod_with_a_mass_at_its_butt():
    """cos(kx) ends on the mass m: EA k sin(kL) + m omega^2 cos(kL) = 0."""
    EA, m = float(ROD.section(0.0).EA), 0.3
    k = rods(ROD, (0.7, m)) / SPEED

    def misfit(y: float) -> float:
        return np.sin(y) + m * SPEED**2 * y / (EA * 0.7) * np.cos(y)

    exact = [brentq(misfit, (n + 0.5) * pi, (n + 1) * pi, xtol=1e-14) for n in range(len(k))]
    np.testing.assert_allclose(k * 0.7, exact, rtol=1e-12)


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
    np.testing.assert_allclose(k, exact, rtol=1e-12)


def slim(stiffer: float) -> Cue:
    """Kim's EI, kGA and rhoA at the tip on a uniform rod whose EA is ``stiffer`` times as large."""
    d = 0.012 / stiffer**0.5
    material = Material(12.6e9 * stiffer**2, 0.84e9 * stiffer, 700.0 * stiffer, nu=0.0)
    return Cue((Segment(0.7, d, d, material, kappa=0.9),), 0.42)


def test_a_stiff_cue_is_rigid_along_its_axis_like_one_over_its_stiffness():
    """EA alone grows: the contact lasts as much longer as the rod gives, L/EA, and its squirt follows."""
    steps, longer, squirts = 4.0 ** -np.arange(5), [], []
    for x in steps:
        scene, at = replace(kim_scene(), cue=slim(1 / x)), Resolution(8, 20, 100)
        section = scene.cue.section(0.0)
        np.testing.assert_allclose([section.EI, section.kGA], [slim(1).section(0.0).EI, slim(1).section(0.0).kGA])
        rigid, waves = strike(scene, at), strike(replace(scene, effects=(AxialWaves(),)), at)
        longer.append(waves.duration - rigid.duration)
        squirts.append(waves.squirt - rigid.squirt)
        assert imbalance(waves) < 1e-9
    assert_order(1.0, steps, longer, within=0.12)
    assert_order(1.0, steps, squirts, within=0.3)  # waves that return add wiggles


def test_rod_modes_are_kept_up_to_the_highest_bending_mode():
    scene = replace(kim_scene(), effects=(AxialWaves(),))
    for at in (Resolution(2, 12, 4), Resolution(4, 20, 22), Resolution(6, 24, 60)):
        bare, tip = tip_modes_of(kim_scene(), at), tip_modes_of(scene, at)
        assert tip.omega[-1] == bare.omega[-1]
        assert np.all(np.diff(tip.omega) >= 0)
        along = tip.amplitude[(tip.omega > 0) & (tip.amplitude[:, 0] != 0)]
        assert len(along) == len(tip.omega) - len(bare.omega)
        assert np.all(along[:, 1] == 0)
    assert len(along) > 5
    few = Resolution(2, 12, 2)  # its highest mode, 325 Hz, is below the first rod mode
    assert len(tip_modes_of(scene, few).omega) == len(tip_modes_of(kim_scene(), few).omega)


# --- structural damping -----------------------------------------------------------------------------------------------


def lossy_cue(shell: float = 1.0, core: float = 1.0) -> Cue:
    """A bored shaft with a core and a plain one behind it; the factors scale both moduli of two of its materials."""
    plastic, foam = Material(3e9 * shell, 1.1e9 * shell, 1200.0, 0.05), Material(1e9 * core, 4e8 * core, 300.0, 0.2)
    wood = replace(MAPLE, loss=0.012)
    front = Segment(0.3, 0.0125, 0.0125, plastic, 0.008, 0.009, core=foam, kappa=0.9)
    return Cue((front, Segment(0.4, 0.0125, 0.02, wood, kappa=0.9)))


def modal_loss(cue: Cue, effect: StructuralDamping, **more: float) -> np.ndarray:
    """Loss factors of the tip modes: damping over frequency."""
    tip = tip_modes_of(Scene(cue, effects=(effect, *more.get("effects", ()))), Resolution(3, 16, 12))
    assert np.count_nonzero(tip.damping - np.diag(np.diag(tip.damping))) == 0
    vibrating = tip.omega > 0
    assert np.all(np.diag(tip.damping)[~vibrating] == 0)
    return np.diag(tip.damping)[vibrating] / tip.omega[vibrating]


@pytest.mark.parametrize("effects", [(), (AxialWaves(),), (Joint(0.3, 1e-3),)])
def test_loss_factors_are_those_of_the_strain_energy(effects):
    """A material's share of a mode's strain energy is what its moduli do to the frequency: d ln omega^2 / d ln E."""

    def squares(shell: float, core: float) -> np.ndarray:
        return tip_modes_of(Scene(lossy_cue(shell, core), effects=effects), Resolution(3, 16, 12)).omega ** 2

    h = 1e-4
    shares = []
    for shell, core in ((h, 0.0), (0.0, h)):
        up, down = squares(1 + shell, 1 + core), squares(1 - shell, 1 - core)
        moving = up > 0
        shares.append((np.log(up[moving]) - np.log(down[moving])) / (2 * h))
    front, inside = shares
    if not any(isinstance(effect, Joint) for effect in effects):  # whose energy is lost nowhere
        expected = 0.05 * front + 0.2 * inside + 0.012 * (1 - front - inside)
        found = modal_loss(lossy_cue(), StructuralDamping(), effects=effects)
        np.testing.assert_allclose(found, expected, rtol=1e-5)
        assert np.ptp(found) > 1e-3
    else:
        found = modal_loss(lossy_cue(), StructuralDamping(0.05), effects=effects)
        assert np.all(found < 0.05)
        assert found.min() < 0.05 * 0.99


def test_one_material_s_loss_is_every_mode_s():
    np.testing.assert_allclose(modal_loss(kim(), StructuralDamping(0.012)), 0.012, rtol=1e-12)
    wood = replace(kim().segments[0].material, loss=0.012)
    lossy = Cue((replace(kim().segments[0], material=wood),))
    np.testing.assert_allclose(modal_loss(lossy, StructuralDamping()), 0.012, rtol=1e-12)
    assert np.all(modal_loss(kim(), StructuralDamping()) == 0)


# --- dome -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("radius", "slope"), [(0.0, 0.0713), (0.006, 0.1013), (0.009, 0.1163)])
def test_a_dome_raises_small_offset_squirt_on_kim_s_shaft(radius, slope):
    """psi/phi at b -> 0, T = 1 ms; endless friction takes out the first slip, which vanishes in the limit."""
    scene = replace(kim_scene(1e-5, friction=inf), effects=(TipDome(radius),))
    assert abs(strike(scene).squirt / scene.stroke.angle - slope) < 1e-4


RADIUS = 0.012


def rigid_domed(offset: float) -> tuple[Cue, LumpedCue]:
    """A stub, and its inverse mass at the contact as a rigid body's with a dome.

    With u forward along the axis and w across it the contact lies from the centre of mass at x forward to the apex,
    r back to the dome's centre, and r along n = (cos phi, -sin phi): rotation moves it by (-w, u) of that.
    """
    stub = Cue((Segment(0.06, 0.012, 0.016, MAPLE),))
    x = stub.balance_point
    s, weights = np.polynomial.legendre.leggauss(10)
    s = (s + 1) * 0.03
    section = stub.section(s)
    inertia = 0.03 * weights @ (section.rhoA * (s - x) ** 2 + section.rhoI)
    phi = np.arcsin(offset)
    forward, aside = x - RADIUS + RADIUS * np.cos(phi), -RADIUS * np.sin(phi)
    u, w = -aside, forward
    along, across = 1 / stub.mass + u**2 / inertia, 1 / stub.mass + w**2 / inertia
    return stub, LumpedCue(1 / along, 1 / across, u * w / inertia)


@pytest.mark.parametrize("offset", [0.05, 0.3, 0.6, -0.3])
@pytest.mark.parametrize(("restitution", "friction"), [(0.75, 0.7), (0.0, 0.5), (1.0, 0.2), (0.75, inf)])
def test_a_rigid_body_with_a_dome_is_a_lumped_cue_with_coupling(offset, restitution, friction):
    stub, lumped = rigid_domed(abs(offset))
    scene = replace(kim_scene(offset, restitution=restitution, friction=friction), cue=stub)
    domed = replace(scene, effects=(TipDome(RADIUS),))
    coupled = strike_modes(domed, tip_modes_of(domed, Resolution(1, 4, 1)).lowest(3))
    expected = impulse(replace(scene, cue=lumped))
    assert abs(coupled.squirt - expected.squirt) < 1e-9
    np.testing.assert_allclose(coupled.impulse, expected.impulse, rtol=1e-9, atol=1e-12)
    flat = impulse(replace(scene, cue=replace(lumped, coupling=0.0)))
    assert abs(expected.squirt - flat.squirt) > 1e-4 or friction == 0.2


# --- a hand -----------------------------------------------------------------------------------------------------------

EIGHT_INCHES = 0.2032
POOL = Path(__file__).parents[2] / "meshes" / "pool_maple.toml"


@pytest.mark.parametrize("time", [0.7e-3, 1e-3, 1.4e-3, 2e-3])
def test_a_hand_eight_inches_behind_the_tip_changes_squirt_by_less_than_a_percent(time):
    scene = kim_scene(0.3, contact_time=time)
    bare = strike(scene).squirt
    for position in (EIGHT_INCHES, 0.25, 0.35):
        hand = strike(replace(scene, effects=(Support(position, 1e4),))).squirt
        assert abs(hand / bare - 1) < 0.01
    if time < 2e-3:
        pool = replace(scene, cue=load(POOL))
        hand = replace(pool, effects=(Support(EIGHT_INCHES, 1e4),))
        assert abs(strike(hand).squirt / strike(pool).squirt - 1) < 0.01
    nearer = strike(replace(scene, effects=(Support(EIGHT_INCHES / 2, 1e4),))).squirt
    assert abs(nearer / bare - 1) > 1e-3
