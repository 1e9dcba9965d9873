"""Effects against closed forms and exact limits (verification)."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from scipy.optimize import brentq

import cuefem as cf
from cuefem.beam.assembly import assemble
from cuefem.beam.axial_modes import rod_modes
from cuefem.beam.tip_modes import TipModes
from cuefem.contact.strike import strike_modes
from cuefem.effects.effect import Effect
from cuefem.scene.solved_scene import tip_modes_of
from tests.helpers.cues import MAPLE, kim
from tests.helpers.orders import assert_error_falls_with_the_step
from tests.helpers.strike_scenes import KIM, kim_scene

POSITION = 0.213  # m, between the nodes of every mesh used here


NODE = cf.PointMass(
    position=POSITION, mass=0.0
)  # a node alone: the mesh's error is the same with and without the effect


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_point_mass_adds_its_axial_share_to_axial_mass(share):
    """Bending modes include the whole mass; in a centre-ball impact the cue's mass includes the axial share."""
    point_mass = cf.PointMass(position=POSITION, mass=0.05, axial_share=share)
    frequencies = [
        cf.modes(kim(), 3, effects=(effect,)).frequencies
        for effect in (point_mass, cf.PointMass(position=POSITION, mass=0.05))
    ]
    np.testing.assert_allclose(*frequencies, rtol=1e-12)
    heavier = replace(kim(), body_mass=kim().body_mass + 0.05 * share)
    assert cf.strike(cf.Scene(kim(), effects=(point_mass,))).ball_speed == pytest.approx(
        cf.strike(cf.Scene(heavier)).ball_speed
    )


SOFT = (3e-3, 2e-6)  # rad/(N m), m/N


@pytest.mark.parametrize("order", [3, 12])
@pytest.mark.parametrize("compliances", [SOFT, (SOFT[0], 0.0), (0.0, SOFT[1]), (0.0, 0.0)])
def test_joint_compliance_adds_in_series(compliances, order):
    """The joint adds moment arm squared times its rotational compliance, and its shear compliance."""

    def compliance(*effects: Effect) -> float:
        system = assemble(KIM, cf.Resolution(3, order, 1), (cf.Support(0.7, inf, inf), *effects))
        force = system.unit_loads_at(0.0)[:, 0]
        return force @ np.linalg.solve(system.K, force)

    rotational, shear = compliances
    extra = POSITION**2 * rotational + shear
    assert abs(compliance(cf.Joint(POSITION, *compliances)) / (compliance(NODE) + extra) - 1) < 1e-11


def test_rod_modes_of_cone_equal_closed_form():
    """r u is a plane wave, with (r u)' = (r'/r) (r u) at both free ends."""
    cue = kim()
    material = cue.segments[0].material
    k = rod_modes(cue, tuple(cue.nodes), cutoff=2 * pi * 3e4).omega / (material.E / material.rho) ** 0.5
    tip, butt = 0.0045 / 0.7 / 0.006, 0.0045 / 0.7 / 0.0105  # r'/r

    def misfit(k: float) -> float:  # of A = 1, B = tip/k in A cos(kx) + B sin(kx)
        s, c = np.sin(0.7 * k), np.cos(0.7 * k)
        return -k * s + tip * c - butt * (c + tip / k * s)

    exact = [brentq(misfit, (n + 0.5) * pi / 0.7, (n + 1.5) * pi / 0.7, xtol=1e-13) for n in range(len(k))]
    np.testing.assert_allclose(k, exact, rtol=1e-7)


def lossy_cue(shell: float = 1.0, core: float = 1.0) -> cf.Cue:
    """A bored segment with a core, and a plain one; the factors scale both moduli of shell and core."""
    plastic, foam = (
        cf.Material(3e9 * shell, 1.1e9 * shell, 1200.0, 0.05),
        cf.Material(1e9 * core, 4e8 * core, 300.0, 0.2),
    )
    wood = replace(MAPLE, loss=0.012)
    front = cf.Segment(0.3, 0.0125, 0.0125, plastic, 0.008, 0.009, core=foam, kappa=0.9)
    return cf.Cue((front, cf.Segment(0.4, 0.0125, 0.02, wood, kappa=0.9)))


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
@pytest.mark.parametrize("effects", [(), (cf.AxialWaves(),)])
def test_structural_damping_equals_strain_energy_loss(effects: tuple[Effect, ...]) -> None:
    """A material's share of a mode's strain energy is what its moduli do to the frequency: d ln omega^2 / d ln E."""

    def modes(shell: float = 1.0, core: float = 1.0, *added: Effect) -> TipModes:
        scene = cf.Scene(lossy_cue(shell, core), effects=(*added, *effects))
        return tip_modes_of(scene, cf.Resolution(3, 16, 12))

    h, lossy = 1e-4, modes(1.0, 1.0, cf.StructuralDamping())
    vibrating = lossy.omega > 0
    pairs = (modes(1 + h), modes(1 - h)), (modes(core=1 + h), modes(core=1 - h))
    front, inside = (np.log(up.omega[vibrating] / down.omega[vibrating]) / h for up, down in pairs)
    expected = 0.05 * front + 0.2 * inside + 0.012 * (1 - front - inside)
    np.testing.assert_allclose(lossy.loss[vibrating], expected, rtol=1e-5)
    assert np.ptp(lossy.loss[vibrating]) > 1e-3
    assert np.count_nonzero(lossy.loss[~vibrating]) == 0


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_joint_strain_energy_is_not_dissipated() -> None:
    scene = cf.Scene(lossy_cue(), effects=(cf.StructuralDamping(0.05), cf.Joint(0.3, 1e-3)))
    tip = tip_modes_of(scene, cf.Resolution(3, 16, 12))
    loss = tip.loss[tip.omega > 0]
    assert loss.min() < 0.0495
    assert loss.max() < 0.05


RADIUS = 0.012


def rigid_domed(offset: float) -> tuple[cf.Cue, cf.LumpedCue]:
    """A stub, and its inverse mass at the contact as a rigid body with a dome.

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
    forward, lateral = x - RADIUS + RADIUS * np.cos(phi), -RADIUS * np.sin(phi)
    u, w = -lateral, forward
    axial, transverse = 1 / stub.mass + u**2 / inertia, 1 / stub.mass + w**2 / inertia
    return stub, cf.LumpedCue(1 / axial, 1 / transverse, u * w / inertia)


@pytest.mark.parametrize("offset", [0.05, 0.3, 0.6, -0.3])
@pytest.mark.parametrize(("restitution", "friction"), [(0.75, 0.7), (0.05, 0.5), (1.0, 0.2), (0.75, inf)])
def test_dome_on_rigid_body_equals_lumped_cue_with_coupling(offset, restitution, friction):
    stub, lumped = rigid_domed(abs(offset))
    scene = replace(kim_scene(offset, restitution=restitution, friction=friction), cue=stub)
    domed = replace(scene, effects=(cf.TipDome(RADIUS),))
    tip, expected = (
        tip_modes_of(domed, cf.Resolution(1, 4, 1)).subset(np.arange(3)),
        cf.impulse(replace(scene, cue=lumped)),
    )

    def error(steps: int) -> float:
        coupled = strike_modes(domed, tip, steps=steps)
        impulse_error = np.abs(coupled.impulse - expected.impulse).max() / expected.impulse[1]
        return float(max(abs(coupled.squirt - expected.squirt), impulse_error))

    assert_error_falls_with_the_step(error, most=1e-3)
    flat = cf.impulse(replace(scene, cue=replace(lumped, coupling=0.0)))
    assert abs(expected.squirt - flat.squirt) > 1e-4 or friction == 0.2
