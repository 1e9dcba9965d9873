"""Many cues as arrays give the numbers of the calls for one (verification)."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from cuefem import Ball, Cue, Material, Resolution, Scene, Segment, StructuralDamping, Tip, end_mass, modes
from cuefem.beam.modes import solve
from cuefem.beam.system import assemble
from cuefem.design import Levels, Response, Study, Vary
from cuefem.design.batch import BLOCK, CueBatch, batch_frequencies, batch_modes, batch_stick
from cuefem.design.study_result import found
from cuefem.endmass.definitions import stick
from cuefem.endmass.sticking_contact import StickLimit
from cuefem.results.solved_design import static_tip_stiffness
from cuefem.tip_modes import tip_modes_from
from tests.helpers.cues import ABS, CARBON, FAMILY, FOAM, LEATHER, MAPLE, kim, rod, scene, soft_tip, stiff_ferrule

AT = Resolution(1, 14, 7)
MATERIALS = (MAPLE, LEATHER, ABS, CARBON, FOAM)


def random_cues(segments: int, count: int = 25) -> list[Cue]:
    """Cues with that many segments: any taper, bores and cores, jumps of diameter and material at every joint."""
    rng = np.random.default_rng(segments)

    def segment() -> Segment:
        diameters = rng.uniform(0.01, 0.03, 2)
        bores = diameters * rng.uniform(0, 0.9, 2) * rng.integers(0, 2)
        core = MATERIALS[rng.integers(5)] if rng.integers(2) else None
        kappa = rng.uniform(0.6, 1.0) if rng.integers(2) else None
        return Segment(rng.uniform(0.01, 0.5), *diameters, MATERIALS[rng.integers(5)], *bores, core=core, kappa=kappa)

    return [Cue(tuple(segment() for _ in range(segments)), rng.uniform(0, 0.5)) for _ in range(count)]


COLLECTIONS = {f"{n} segments": random_cues(n) for n in (1, 2, 4)}
COLLECTIONS |= {name: [cue] for name, cue in FAMILY.items()}
COLLECTIONS |= {"soft tip": [soft_tip()], "stiff ferrule": [stiff_ferrule()], "slender rod": [rod(500)]}


@pytest.fixture(params=COLLECTIONS.values(), ids=COLLECTIONS.keys())
def cues(request: pytest.FixtureRequest) -> list[Cue]:
    return request.param


def test_tip_amplitudes_are_those_of_each_cue(cues: list[Cue]) -> None:
    found = batch_modes(CueBatch.of(cues), 5, at=AT)
    for i, cue in enumerate(cues):
        single = modes(cue, 5, at=AT)
        np.testing.assert_allclose(found.tip[i], single.vectors[0], rtol=1e-7, atol=1e-9)
        np.testing.assert_allclose(found.rigid[i], single.rigid_vectors[0] @ single.rigid_vectors[0], rtol=1e-11)


def test_stick_end_mass_and_squirt_are_those_of_each_cue(cues: list[Cue]) -> None:
    """Each in a place of its own: ball, restitution and contact time differ from cue to cue."""
    rng = np.random.default_rng(3)
    scenes = []
    for cue in cues:
        tip = Tip(rng.uniform(0, 1), contact_time=rng.uniform(0.7e-3, 3e-3))
        scenes.append(Scene(cue, Ball(rng.uniform(0.15, 0.22), inertia=rng.uniform(0.3, 0.5)), tip))
    mass, slope = batch_stick(CueBatch.of(cues), scenes, at=AT)
    for i, one in enumerate(scenes):
        np.testing.assert_allclose(mass[i], end_mass(one, at=AT), rtol=1e-9)
        limit = StickLimit.of(one)
        J = (limit.K - 1) / (1 / mass[i] + limit.c)
        np.testing.assert_allclose(slope[i], limit.slope(J), rtol=1e-9)


def test_modes_end_in_the_tail_of_each_cue(cues: list[Cue]) -> None:
    found = batch_modes(CueBatch.of(cues), 7, at=AT, ended=True)
    assert found.radiation is not None
    for i, cue in enumerate(cues):
        single = solve(assemble(cue, AT), 7, ended=1)
        np.testing.assert_allclose(found.frequencies[i], single.frequencies, rtol=1e-9)
        np.testing.assert_allclose(found.tip[i], abs(single.vectors[0]), rtol=1e-7, atol=1e-9)
        assert single.radiation is not None
        scale = abs(single.radiation).max()
        np.testing.assert_allclose(abs(found.radiation[i]), abs(single.radiation), rtol=1e-7, atol=1e-7 * scale)


def test_end_mass_by_a_tail_is_that_of_each_cue(cues: list[Cue]) -> None:
    """The single cue's own modes and tail; contact times, restitutions (0 too) and balls as arrays."""
    rng, n = np.random.default_rng(4), len(cues)
    e = np.where(np.arange(n) % 3 == 1, 0.0, rng.uniform(0, 1, n))
    ball, nu, T = rng.uniform(0.15, 0.22, n), rng.uniform(0.3, 0.5, n), rng.uniform(0.7e-3, 3e-3, n)
    batch = CueBatch.of(cues)
    mass, _ = batch_stick(batch, StickLimit.law(ball, nu, e, T, batch.mass), at=AT, ended=True)
    for i, cue in enumerate(cues):
        one = Scene(cue, Ball(ball[i], inertia=nu[i]), Tip(e[i], contact_time=T[i]))
        found = solve(assemble(cue, AT), AT.modes, ended=1)
        np.testing.assert_allclose(mass[i], stick(tip_modes_from(found, one), one), rtol=1e-8)


def test_masses_and_balance_points(cues: list[Cue]) -> None:
    batch = CueBatch.of(cues)
    for name in ("mass", "shaft_mass", "balance_point"):
        np.testing.assert_allclose(getattr(batch, name), [getattr(cue, name) for cue in cues], rtol=1e-12)


def test_blocks_do_not_show() -> None:
    """Cues beyond the first block, and the joint between two blocks, in the order they were given."""
    cues = [replace(kim(), body_mass=m) for m in np.linspace(0, 1, BLOCK + 3)]
    cues = [replace(c, segments=(replace(c.segments[0], length=0.6 + 1e-4 * i),)) for i, c in enumerate(cues)]
    batch, at = CueBatch.of(cues), Resolution(1, 8, 3)
    whole, (mass, _) = batch_frequencies(batch, 2, at=at), batch_stick(batch, scene(kim(), 1e-3), at=at)
    for i in (0, BLOCK - 1, BLOCK, BLOCK + 2):
        np.testing.assert_allclose(whole[i], modes(cues[i], 2, at=at).frequencies, rtol=1e-10)
        np.testing.assert_allclose(mass[i], end_mass(scene(cues[i], 1e-3), at=at), rtol=1e-11)


@pytest.mark.parametrize("ratio", [1.5, 3.0, 10.0])
def test_static_tip_stiffness_is_exact_to_steep_cones(ratio: float) -> None:
    cue = Cue((Segment(0.7, 0.004, 0.004 * ratio, MAPLE, 0.001, 0.0005, core=FOAM),))

    def compliance(x: float) -> float:
        section = cue.section(x)
        return float(x**2 / section.EI + 1 / section.kGA)

    found = quad(compliance, 0, 0.7, epsabs=0, epsrel=1e-12, limit=500)[0]
    np.testing.assert_allclose(CueBatch.of([cue]).tip_stiffness, [1 / found], rtol=1e-11)


def test_static_tip_stiffness_is_that_of_the_clamped_beam(cues: list[Cue]) -> None:
    """Foam rods apart: below 1 N/m the beam's K has lost the whole cue's bending beside its stiffest element's."""
    single = np.array([static_tip_stiffness(Scene(cue), Resolution(3, 16, 1)) for cue in cues])
    stiff = single > 1
    assert stiff.any()
    np.testing.assert_allclose(CueBatch.of(cues).tip_stiffness[stiff], single[stiff], rtol=1e-7)


FINE = Resolution(1, 24, 12)
LONG = Tip(contact_time=2e-3)
HARD = [12, 25, BLOCK + 2]


def light_shaft(mass: float) -> Cue:
    """A short, steep shaft of ash, without a body, of a mass in kg."""
    ash = Material(9e9, 0.64e9, 660.0)
    tip = np.sqrt(12 * mass / np.pi / 0.33 / ash.rho / (1 + 5.5 + 5.5**2))
    return Cue((Segment(0.33, tip, 5.5 * tip, ash),))


def stack() -> list[Cue]:
    """Whole cues, and among them bare shafts of 16, 21 and 27 g."""
    cues = [Cue((Segment(0.7, 0.012, 0.02, MAPLE),), m) for m in np.linspace(0.3, 0.5, BLOCK + 6)]
    for i, mass in zip(HARD, (0.016, 0.021, 0.027), strict=True):
        cues[i] = light_shaft(mass)
    return cues


@pytest.mark.parametrize("ended", [False, True])
def test_one_design_without_an_end_mass_does_not_stop_the_stack(ended: bool) -> None:
    cues = stack()
    scene = Scene(cues[0], Ball(0.17, 0.0286), LONG)
    found = batch_stick(CueBatch.of(cues), scene, at=FINE, ended=ended)
    mass, squirt = found
    assert np.flatnonzero(np.isnan(mass)).tolist() == HARD
    assert np.all(np.isfinite(squirt))
    assert np.all(squirt[HARD] < 0)
    assert [i for i, reason in enumerate(found.reasons) if reason] == HARD
    assert all(f"the squirt is {squirt[i]:.4g} times phi, below that of any" in str(found.reasons[i]) for i in HARD)
    whole = [i for i in range(len(cues)) if i not in HARD]
    np.testing.assert_allclose(
        mass[whole], batch_stick(CueBatch.of([cues[i] for i in whole]), scene, at=FINE, ended=ended)[0], rtol=1e-12
    )


def light(effects: tuple[StructuralDamping, ...] = ()) -> Study:
    """A cue, a bare shaft that is too light, and one that cannot be."""
    vary = Vary(("cue.body_mass",), Levels((0.4, 0.0, -1.0)))
    base = Scene(light_shaft(0.021), Ball(0.17, 0.0286), LONG, effects=effects)
    return Study(base, (vary,), tuple(map(Response.of, ("end_mass", "squirt_slope", "mass"))), at=FINE)


@pytest.mark.parametrize("effects", [(), (StructuralDamping(),)], ids=["together", "one by one"])
def test_a_sweep_says_which_design_has_none_and_keeps_its_squirt(
    effects: tuple[StructuralDamping, ...],
) -> None:
    study = light(effects)
    heavy, alone, none = found(study).rows
    assert heavy.failure is None
    assert none.responses == (None, None, None)
    assert alone.responses[0] is None
    assert alone.responses[1] < 0
    assert alone.responses[2] == pytest.approx(0.021)
    assert alone.failure.startswith("end_mass: the squirt is -")
