"""Thrust on the bent shaft: columns, a geometrically exact chain, the account of energies, limits and refusals."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq
from scipy.special import jv

import cuefem as cf
from cuefem.beam.tip import TipModes
from cuefem.contact import bent
from cuefem.contact.strike import strike_modes
from cuefem.tip_modes import tip_modes_of
from tests.helpers.leather_scenes import LEATHER, SHAFT
from tests.helpers.strike_scenes import hollow_cue, kim_cue, pool_cue
from tests.oracle.chain import Chain, chain_squirt

THRUST = cf.GeometricStiffness()
LENGTH, DIAMETER, E = 0.7, 0.012, 12e9
EI, AREA = E * math.pi * DIAMETER**4 / 64, math.pi * DIAMETER**2 / 4


def column(G: float, *supports: cf.Support, count: int = 60) -> tuple[Any, float]:
    """Tip modes of a uniform rod under the same thrust everywhere (a great mass is behind it), and its kGA."""
    cue = cf.Cue((cf.Segment(LENGTH, DIAMETER, DIAMETER, cf.Material(E=E, G=G, rho=700.0)),), body_mass=1e9)
    scene = cf.Scene(cue, effects=(THRUST, *supports))
    return tip_modes_of(scene, cf.Resolution(6, 18, count)), float(cf.modes(cue).system.section.kGA[0, 0])


@pytest.mark.parametrize("G", [1.9e10, 0.84e9])
def test_thrust_slows_a_column_up_to_engesser_s_load(G: float) -> None:
    """f^2/f0^2 = 1 - P/P_cr, simply supported; P_cr is Euler's with Engesser's shear."""
    tip, kGA = column(G, cf.Support(0.0, math.inf), cf.Support(LENGTH, math.inf))
    euler = math.pi**2 * EI / LENGTH**2
    critical, bending = euler / (1 + euler / kGA), np.flatnonzero(tip.geometric.any(axis=1))
    omega, stiffness = tip.omega[bending], tip.geometric[np.ix_(bending, bending)]
    for part in (0.1, 0.5, 0.9):
        lowest = np.linalg.eigvalsh(np.diag(omega**2) - part * critical * stiffness)[0]
        assert lowest / omega[0] ** 2 == pytest.approx(1 - part, abs=2e-6)


@pytest.mark.parametrize("G", [1.9e10, 0.84e9])
def test_a_cantilever_gives_as_the_tangent_says(G: float) -> None:
    """The deflection under a load across the end, beside a thrust: tan(kL)/k, with Engesser's shear."""
    clamp = cf.Support(LENGTH, math.inf, rotational_stiffness=math.inf)
    off = []
    for count in (20, 40, 80):
        tip, kGA = column(G, clamp, count=count)
        thrust = 0.7 * math.pi**2 * EI / 4 / LENGTH**2
        k = math.sqrt(thrust / EI / (1 - thrust / kGA))
        exact = (kGA / thrust * (math.tan(k * LENGTH) / k - LENGTH) + LENGTH) / (kGA - thrust)
        matrix = np.diag(tip.omega**2) - thrust * tip.geometric
        matrix[0, 0] = 1.0  # the motion along the axis
        across = tip.amplitude[:, 1]
        off.append(abs(across @ np.linalg.solve(matrix, across) / exact - 1))
    assert off[0] > off[1] > off[2]
    assert off[2] < (1e-5 if G > 1e10 else 3e-3)  # shear under a point load: like 1/count


CLAMP = cf.Support(LENGTH, math.inf, rotational_stiffness=math.inf)
# Loads over EI/L^2. Free: the slope v over s, from the butt on, has v'' + k v = 0, or v'' + k s v = 0 where the thrust
# falls to nothing there, with v' = 0 at both ends; the latter has v' = s J_2/3(2 sqrt(k) s^1.5/3).
COLUMNS = {
    "free, a great mass behind it": (1e9, (), math.pi**2),
    "clamped, a great mass behind it": (1e9, (CLAMP,), math.pi**2 / 4),
    "free, the thrust falls to nothing": (0.43e-9, (), (1.5 * brentq(lambda z: float(jv(2 / 3, z)), 2.5, 4.5)) ** 2),
}


@pytest.mark.parametrize(("behind", "supports", "factor"), COLUMNS.values(), ids=COLUMNS)
def test_a_thrust_that_lasts_buckles_a_column_at_its_exact_load(behind: float, supports: Any, factor: float) -> None:
    """A cue that nothing holds buckles while it turns as it likes: holding that gives 430 for 639 N of the last."""
    material = cf.Material(E=E, G=60e9, rho=700.0, nu=0.05)
    cue = cf.Cue((cf.Segment(LENGTH, DIAMETER, DIAMETER, material),), body_mass=behind)
    for count in (30, 60):
        scene = cf.Scene(cue, effects=(THRUST, *supports))
        tip = tip_modes_of(scene, cf.Resolution(6, 18, count))
        euler = factor * EI / LENGTH**2
        engesser = euler / (1 + euler / float(cf.modes(cue).system.section.kGA[0, 0]))
        assert bent.buckling_thrust(tip) == pytest.approx(engesser, rel=1e-3 * (30 / count) ** 3)


STIFFNESS, SHEAR = 6e5, 2e5  # of the tip, N/m


def wood(x: Any) -> Any:
    return 0.00625 + 0.0045 * x / LENGTH


def chain_of(stiffer: float) -> Chain:
    """A shaft of wood with 430 g at its end; stiffer: than wood, along its axis."""
    chain = Chain(LENGTH, wood, 700.0, 12.6e9, 0.43, 60)
    chain.stretch = chain.stretch * stiffer
    return chain


def struck_shaft(speed: float, offset: float) -> cf.Scene:
    """The same shaft of finite elements, whose tip holds the ball by two springs."""
    material = cf.Material(E=12.6e9, G=60e9, rho=700.0, nu=0.05)
    cue = cf.Cue((cf.Segment(LENGTH, 0.0125, 0.0215, material),), body_mass=1e-9)
    tip = cf.Tip(restitution=1.0, friction=math.inf, stiffness=STIFFNESS)
    effects = (cf.PointMass(LENGTH, 0.43), cf.AxialWaves(), cf.TipShear(SHEAR / STIFFNESS))
    return cf.Scene(cue, cf.Ball(0.17, 0.028575), tip, cf.Stroke(speed, offset), effects)


def modes_of(chain: Chain) -> TipModes:
    """The chain's own modes with the geometric stiffness of its links."""
    count, nudge = len(chain.mass), 1e-6
    stiffness = np.zeros((2, count, count))
    for axis, i in np.ndindex(2, count):
        at = chain.rest.copy()
        at[i, axis] += nudge
        stiffness[axis, :, i] = -chain.forces(at, exact=False)[:, axis] / nudge
    (along, u), (across, w) = (scipy.linalg.eigh(matrix, np.diag(chain.mass)) for matrix in stiffness)
    along[0] = across[0] = across[1] = 0.0
    amplitude, approach = np.zeros((2 * count, 2)), np.zeros(2 * count)
    amplitude[:count, 0], amplitude[count:, 1], approach[0] = u[0], w[0], u[:, 0] @ chain.mass
    share, turns = 1 - np.cumsum(chain.mass)[:-1] / chain.mass.sum(), np.diff(w, axis=0)
    geometric = np.pad(turns.T @ ((share / chain.link)[:, None] * turns), (count, 0))
    omega = np.sqrt(np.concatenate([along, across]))
    return TipModes(omega, amplitude, approach, np.zeros(2 * count), geometric=geometric)


def changes(chain: Chain, scene: cf.Scene) -> float:
    """By how much the chain's squirt changes where its links may turn by any angle."""
    linear, exact = (
        chain_squirt(chain, scene.stroke, scene.ball, STIFFNESS, SHEAR, exact=exact) for exact in (False, True)
    )
    return exact / linear - 1


RIGID_AXIS = [
    pytest.param(7.0, 0.187),
    pytest.param(2.0, 0.375, marks=pytest.mark.heavy),
    pytest.param(7.0, 0.375, marks=pytest.mark.heavy),
    pytest.param(4.0, 0.6, marks=pytest.mark.heavy),
]


@pytest.mark.parametrize(("speed", "offset"), RIGID_AXIS)
def test_squirt_changes_as_in_a_geometrically_exact_chain(speed: float, offset: float) -> None:
    """Of 12 to 57 % of squirt all but a thousandth: the chain's modes in the engine, and the chain by small steps."""
    chain, scene = chain_of(stiffer=16.0), struck_shaft(speed, offset)
    tip = modes_of(chain)
    bends, straight = (strike_modes(scene, each).squirt for each in (tip, replace(tip, geometric=None)))
    assert bends / straight - 1 == pytest.approx(changes(chain, scene), rel=1e-3)
    assert bends < 0.95 * straight


@pytest.mark.heavy
@pytest.mark.parametrize(("speed", "offset"), [(2.0, 0.375), (7.0, 0.187)])
def test_beside_waves_along_the_cue_it_changes_by_a_hundredth_less(speed: float, offset: float) -> None:
    """The beam against a chain of wood: there the thrust runs along the cue too, which the share p leaves out."""
    scene, chain = struck_shaft(speed, offset), chain_of(stiffer=1.0)
    straight, bends = (cf.strike(each).squirt for each in (scene, replace(scene, effects=(*scene.effects, THRUST))))
    linear = chain_squirt(chain, scene.stroke, scene.ball, STIFFNESS, SHEAR, exact=False)
    assert straight == pytest.approx(linear, rel=3e-3)
    assert bends / straight - 1 == pytest.approx(changes(chain, scene), rel=0.012)


def random_scene(seed: int) -> cf.Scene:
    """With thrust, waves, and everything that goes beside them."""
    rng = np.random.default_rng(seed)
    leather = rng.random() < 0.4
    cue: cf.Cue = SHAFT if leather else [kim_cue(), pool_cue(), hollow_cue()][rng.integers(3)]
    effects: list[cf.Effect] = [THRUST]
    effects += [cf.AxialWaves()] * (rng.random() < 0.5) + [cf.StructuralDamping(0.01)] * (rng.random() < 0.3)
    effects += [cf.PointMass(float(rng.uniform(0.0, 0.3)), 0.008)] * (rng.random() < 0.3)
    effects += [cf.Support(0.3, float(10 ** rng.uniform(2, 6)))] * (rng.random() < 0.3)
    effects += [cf.Joint(0.5, 1e-4)] * (rng.random() < 0.3)
    if leather:
        effects.append(replace(LEATHER, E=float(rng.uniform(1e8, 3e8))))
    else:
        raised = rng.random() < 0.3
        effects += [cf.TipDome(9e-3)] * (rng.random() < 0.6)
        effects += [cf.Elevation(0.3, 0.2)] if raised else [cf.TipShear(1.0)] * (rng.random() < 0.5)
        effects += [cf.RollingContact()] * (not raised and rng.random() < 0.5)
    tip = cf.Tip(float(rng.uniform(0.5, 1.0)), float(rng.choice([0.3, 0.6, 1.0])))
    stroke = cf.Stroke(float(np.exp(rng.uniform(np.log(0.3), np.log(4.0)))), float(rng.uniform(-0.6, 0.6)))
    return cf.Scene(cue, cf.Ball(0.17, 0.028575), tip, stroke, tuple(effects))


def imbalance(outcome: cf.Outcome) -> float:
    return abs(2 * outcome.energy["initial"] - sum(outcome.energy.values())) / outcome.energy["initial"]


def account_closes(seed: int) -> None:
    assert imbalance(cf.strike(random_scene(seed))) < 1e-8, seed


def test_no_energy_is_made() -> None:
    for seed in range(8):
        account_closes(seed)


@pytest.mark.heavy
def test_no_energy_is_made_in_many_scenes() -> None:
    for seed in range(8, 208):
        account_closes(seed)


def test_the_order_of_effects_and_company_do_not_matter() -> None:
    scene = random_scene(3)
    again = replace(scene, effects=scene.effects[::-1])
    one, other = cf.strike(scene), cf.strike(again)
    together = cf.batch_strike([scene, again, scene])
    assert one.squirt == pytest.approx(other.squirt, rel=1e-13)
    assert together.squirt.tolist() == [one.squirt, other.squirt, one.squirt]


def test_the_change_falls_like_the_speed() -> None:
    scene = cf.Scene(SHAFT, stroke=cf.Stroke(0.1, 0.375), effects=(cf.TipDome(9e-3), cf.TipShear(1.0)))
    changed = []
    for speed in (0.1, 0.2):
        slow = replace(scene, stroke=cf.Stroke(speed, 0.375))
        changed.append(cf.strike(replace(slow, effects=(*slow.effects, THRUST))).squirt / cf.strike(slow).squirt - 1)
    assert changed[1] < 0
    assert changed[1] / changed[0] == pytest.approx(2.0, rel=5e-3)


def test_a_dozen_rows_of_slopes_are_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    """A strike with 30 rows differs by less than 2e-4 of squirt; what three would leave out is much more."""
    scenes = [
        cf.Scene(SHAFT, tip=cf.Tip(0.73, 0.6), stroke=cf.Stroke(speed, offset), effects=(LEATHER, THRUST))
        for speed, offset in ((2.0, 0.375), (4.0, 0.187))
    ]
    usual = [cf.strike(scene).squirt for scene in scenes]
    monkeypatch.setattr(bent, "MOST", 30)
    many = [cf.strike(scene).squirt for scene in scenes]
    monkeypatch.setattr(bent, "MOST", 3)
    few = [cf.strike(scene).squirt for scene in scenes]
    assert usual == pytest.approx(many, rel=2e-4)
    assert all(abs(a / b - 1) > 1e-3 for a, b in zip(few, many, strict=True))


def test_motion_and_history_carry_the_thrust() -> None:
    scene = cf.Scene(SHAFT, stroke=cf.Stroke(4.0, 0.3), effects=(THRUST, cf.TipDome(9e-3), cf.SecondHit(3e-3)))
    outcome = cf.strike(scene)
    moved = cf.motion(scene, [outcome.duration, outcome.duration + 1e-3])
    velocity = (moved.centre[1] - moved.centre[0]) / 1e-3
    assert math.atan2(-velocity[1], velocity[0]) == pytest.approx(outcome.squirt, abs=1e-9)


def test_tones_end_masses_and_blows_from_the_side_do_not_know_it() -> None:
    scene = cf.Scene(SHAFT, stroke=cf.Stroke(4.0, 0.3))
    bends = replace(scene, effects=(THRUST,))
    assert cf.end_mass(scene, "force") == cf.end_mass(bends, "force")
    for tip in ((LEATHER,), (LEATHER, cf.AxialWaves()), (cf.TipDome(9e-3),)):
        one, other = (replace(each, effects=(*tip, *each.effects)) for each in (scene, bends))
        for drive in ("stick", "offset", "velocity", "force"):
            assert cf.end_mass(one, drive) == cf.end_mass(other, drive), (tip, drive)
    assert np.array_equal(cf.modes(SHAFT).frequencies, cf.modes(SHAFT, effects=(THRUST,)).frequencies)
    side = cf.SideStrike(SHAFT, cf.Striker(0.02, 0.7, contact_time=1e-3), 0.3, 1.0)
    assert cf.side_strike(side).rebound_speed == cf.side_strike(replace(side, effects=(THRUST,))).rebound_speed


def test_a_shaft_that_bends_too_far_is_refused_by_its_load() -> None:
    thin = cf.Cue((cf.Segment(0.7, 0.005, 0.006, cf.Material(E=12.6e9, G=0.84e9, rho=700.0)),), body_mass=0.5)
    scene = cf.Scene(thin, tip=cf.Tip(contact_time=4e-3), stroke=cf.Stroke(20.0, 0.5), effects=(THRUST,))
    with pytest.raises(
        ValueError, match=r"the thrust of \S+ N bends the shaft by 0\.\d+ rad .* buckles it from \S+ N on"
    ):
        cf.strike(scene)


def test_a_lumped_cue_has_no_slopes() -> None:
    with pytest.raises(ValueError, match="GeometricStiffness, which needs a finite-element Cue"):
        cf.Scene(cf.LumpedCue(0.54, 0.01), effects=(THRUST,))
