"""The compiled kernel against the Python path, which is its oracle, over every kind of contact that it runs."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from math import asin, inf

import numpy as np
import pytest

from cuefem import (
    AxialWaves,
    Elevation,
    Outcome,
    PowerLawTip,
    Resolution,
    RollingContact,
    Scene,
    SecondHit,
    StructuralDamping,
    Support,
    TipDome,
    TipShear,
    motion,
    strike,
)
from cuefem.beam.tip import TipModes
from cuefem.contact import kernel
from cuefem.contact.kernel import VARIABLE
from cuefem.contact.leather import Leather
from cuefem.contact.state import Laws
from cuefem.contact.strike import strike_modes
from cuefem.tip_modes import tip_modes_of
from tests.helpers.kernels import BUILT
from tests.helpers.leather_scenes import AT, LEATHER, POOL, leather_scene
from tests.helpers.strike_scenes import KIM_AT, hand_made, kim_scene, numbers, pool_cue

# Rounding, relative to the whole impulse and the whole energy, of up to a thousand cells of 28 terms.
AGREE = 1e-12
SHEAR, DOME = TipShear(0.75), TipDome(0.0095)


@pytest.fixture
def both(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[], Outcome]], tuple[Outcome, Outcome]]:
    """What a call gives in Python, and what in the kernel."""

    def run(call: Callable[[], Outcome]) -> tuple[Outcome, Outcome]:
        found = []
        for name in ("python", "c"):
            monkeypatch.setenv(VARIABLE, name)
            found.append(call())
            assert found[-1].kernel == name
        return found[0], found[1]

    return run


def agree(first: Outcome, second: Outcome, within: float = AGREE) -> None:
    """Numbers, phases and history of two outcomes."""
    assert [phase[:2] for phase in first.phases] == [phase[:2] for phase in second.phases]
    assert first.energy.keys() == second.energy.keys()
    initial = first.energy["initial"]
    apart = np.abs(numbers(first) - numbers(second))
    energies = len(first.energy)
    assert apart[-energies:].max() < within * initial
    assert apart[:-energies].max() < within * np.abs(numbers(first)[:-energies]).max()
    assert abs(first.duration / second.duration - 1) < within
    times = np.linspace(0, first.duration, 301)[:-1] + first.duration / 1000  # in the phases, not at their ends
    told, other = first.history(times), second.history(times)
    for kind in ("force", "velocity"):
        size = max(np.abs(told[f"{kind}_{way}"]).max() for way in "tn")
        for way in "tn":
            # in between, states of tip and modes have grown apart a little further than their sums
            assert np.abs(told[f"{kind}_{way}"] - other[f"{kind}_{way}"]).max() < 100 * within * size


SCENES = {
    "stick": kim_scene(0.3),
    "miscue": kim_scene(0.8, friction=0.3),
    "head on": kim_scene(0.0),
    "mirrored": kim_scene(-0.35),
    "dead": kim_scene(0.4, restitution=0.0),
    "nearly dead": kim_scene(0.4, restitution=1e-5),
    "lively": kim_scene(0.4, restitution=1.0),
    "endless friction": kim_scene(0.4, friction=inf),
    "no friction": kim_scene(0.4, friction=0.0),
    "short": kim_scene(0.3, contact_time=2e-4),
    "dome and shear": replace(kim_scene(0.35), effects=(DOME, SHEAR)),
    "shear, dead": replace(kim_scene(0.45, restitution=0.0), effects=(SHEAR,)),
    "shear, endless friction": replace(kim_scene(0.45, friction=inf), effects=(SHEAR,)),
    "damped": replace(kim_scene(0.35), effects=(StructuralDamping(0.02),)),
    "held, with waves": replace(kim_scene(0.35), effects=(Support(0.2, dashpot=5.0), AxialWaves())),
    "hit twice": replace(kim_scene(0.3), effects=(SecondHit(0.02),)),
    "leather beam": Scene(pool_cue(), tip=kim_scene(0.3).tip, stroke=kim_scene(0.4).stroke, effects=(SHEAR,)),
}


@BUILT
@pytest.mark.parametrize("name", SCENES)
def test_the_kernel_agrees_with_python(name: str, both) -> None:
    scene = SCENES[name]
    tip = tip_modes_of(scene)
    agree(*both(lambda: strike_modes(scene, tip)))


@BUILT
@pytest.mark.parametrize("name", ["stick", "miscue", "dome and shear", "damped", "hit twice"])
def test_phase_by_phase_the_kernel_agrees_as_well(name: str, both, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a contact takes more phases, or more cells, than there is room for at once."""
    monkeypatch.setattr("cuefem.contact.kernel.contact.PHASES", 2)
    scene = SCENES[name]
    tip = tip_modes_of(scene)
    agree(*both(lambda: strike_modes(scene, tip)))


@BUILT
@pytest.mark.parametrize("seed", range(6))
def test_the_kernel_agrees_with_python_on_loud_modes(seed: int, both) -> None:
    """Many phases: modes that throw the contact about."""
    rng = np.random.default_rng(seed)
    tip = hand_made(np.sort(10 ** rng.uniform(2.5, 4.5, 8)).tolist(), rng.uniform(2.0, 9.0, 8).tolist(), rigid=9.0)
    scene = kim_scene(float(rng.uniform(0.1, 0.6)), friction=float(rng.uniform(0.1, 1.0)))
    for effects in ((), (SHEAR,)):
        shaped = replace(scene, effects=effects)
        agree(*both(lambda shaped=shaped: strike_modes(shaped, tip)))


@BUILT
@pytest.mark.parametrize("seed", range(24))
def test_the_kernel_agrees_with_python_on_a_random_family(seed: int, both) -> None:
    """Cells as long as the motion allows, against equal ones: any friction, restitution, contact time and effects."""
    rng = np.random.default_rng(100 + seed)
    friction = rng.choice([0.0, inf, rng.uniform(0.05, 1.0), 0.7], p=[0.05, 0.1, 0.35, 0.5])
    scene = kim_scene(
        rng.uniform(-0.7, 0.7),
        friction=friction,
        restitution=rng.uniform(0.2, 1.0),
        contact_time=10 ** rng.uniform(-3.2, -2.6),
    )
    effects = SHEAR, DOME, StructuralDamping(0.02)
    scene = replace(scene, effects=tuple(effect for effect in effects if rng.random() < 0.4))
    if seed % 3:
        tip = tip_modes_of(scene, KIM_AT)
    else:
        omega, amplitude = np.sort(10 ** rng.uniform(2.5, 4.3, 8)), rng.uniform(0.5, 9.0, 8)
        tip = hand_made(omega.tolist(), amplitude.tolist(), rigid=rng.uniform(2.0, 9.0))
    agree(*both(lambda: strike_modes(scene, tip)))


@BUILT
def test_a_cell_is_as_long_as_the_motion_allows(both) -> None:
    """The dashpot that ends the modes is fast, but dies away: its bound would ask for six times as many cells."""
    scene = kim_scene(0.3)
    python, c = (sum(len(piece.lengths) for piece in found.history.pieces) for found in both(lambda: strike(scene)))
    assert python / 12 < c < python / 4


STEPPED = {
    "power law": (kim_scene(0.3), PowerLawTip(1.5)),
    "on a spring": (kim_scene(-0.4), PowerLawTip(1.5), SHEAR),
    "rolling": (kim_scene(0.4), DOME, RollingContact()),
    "rolling off": (kim_scene(0.6, friction=0.3), DOME, RollingContact(), PowerLawTip(1.4), TipShear(0.5)),
    "on a point, lively": (kim_scene(0.2, restitution=1.0), RollingContact()),
    "hit twice": (kim_scene(0.3), PowerLawTip(1.5), SecondHit(0.01)),
    "damped": (kim_scene(0.3), PowerLawTip(1.2), StructuralDamping(0.02)),
    "endless friction": (kim_scene(0.3, friction=inf), PowerLawTip(1.5)),
    "head on": (kim_scene(0.0), PowerLawTip(1.5)),
    "raised": (kim_scene(0.3), Elevation(0.1)),
    "raised, off": (kim_scene(-0.4, friction=0.3), Elevation(0.5, 0.3), PowerLawTip(1.5)),
    "raised, damped": (kim_scene(0.5), Elevation(1.0), StructuralDamping(0.02)),
    "raised, endless friction": (kim_scene(0.3, friction=inf), Elevation(0.2)),
    "raised, on a smooth table": (kim_scene(0.2), Elevation(0.3, 0.0)),
}


@BUILT
@pytest.mark.parametrize("name", STEPPED)
def test_the_kernel_takes_the_steps_that_scipy_takes(name: str, both) -> None:
    """Both choose each step by the same rule from the same tables, so that nothing but rounding tells them apart."""
    scene, *effects = STEPPED[name]
    scene = replace(scene, effects=tuple(effects))
    tip = tip_modes_of(scene, Resolution(2, 10, 5))
    agree(*both(lambda: strike_modes(scene, tip)))


@BUILT
@pytest.mark.parametrize("seed", range(4))
def test_the_kernel_steps_as_scipy_does_over_a_random_family(seed: int, both) -> None:
    rng = np.random.default_rng(seed)
    omega, amplitude = np.sort(10 ** rng.uniform(2.5, 3.8, 4)), rng.uniform(0.5, 5.0, 4)
    tip = hand_made(omega.tolist(), amplitude.tolist(), rigid=rng.uniform(2.0, 9.0))
    scene = kim_scene(rng.uniform(0.1, 0.6), friction=rng.uniform(0.1, 1.0), restitution=rng.uniform(0.3, 1.0))
    effects = [PowerLawTip(rng.uniform(1.0, 2.0))]
    if seed % 2:
        effects += [each for each in (SHEAR, RollingContact()) if rng.random() < 0.7]
    else:
        effects.append(Elevation(rng.uniform(0.02, 1.2), rng.uniform(0.1, 0.4)))
    scene = replace(scene, effects=tuple(effects))
    agree(*both(lambda: strike_modes(scene, tip)))


@BUILT
def test_what_the_kernel_does_not_step_is_left_to_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    """A nearly dead tip, and steps that get stuck, which end with scipy's words."""
    monkeypatch.setenv(VARIABLE, "c")
    tip = hand_made([1e3], [5.0])
    power = PowerLawTip(1.5)
    assert strike_modes(replace(kim_scene(0.3, restitution=0.0), effects=(power,)), tip).kernel == "python"
    wild = replace(tip, approach=tip.approach * 1e200, amplitude=tip.amplitude * 1e110)
    scene, said = replace(kim_scene(0.3), effects=(power,)), []
    for name in ("python", "c"):
        monkeypatch.setenv(VARIABLE, name)
        with np.errstate(all="ignore"), pytest.raises((RuntimeError, ArithmeticError, ValueError)) as raised:
            strike_modes(scene, wild)
        said.append(str(raised.value))
    assert said[0] == said[1]


@BUILT
def test_motion_takes_what_the_kernel_leaves_of_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, found = replace(kim_scene(0.3), effects=(PowerLawTip(1.5), DOME, RollingContact())), []
    for name in ("python", "c"):
        monkeypatch.setenv(VARIABLE, name)
        found.append(motion(scene, np.linspace(0, 3e-3, 7), Resolution(2, 10, 5)))
    for part in ("fields", "along", "centre", "turned"):
        one, other = (getattr(each, part) for each in found)
        assert np.abs(one - other).max() < 10 * AGREE * np.abs(one).max()


RINGED = replace(LEATHER, partial_slip=True)
WHOLE = {
    "ring by ring": leather_scene(leather=RINGED),
    "ring by ring, mirrored": leather_scene(-0.45, leather=RINGED),
    "ring by ring, off": leather_scene(0.5, friction=0.2, leather=RINGED),
    "ring by ring, endless friction": leather_scene(friction=inf, leather=RINGED),
    "ring by ring, hit twice": leather_scene(0.375, SecondHit(0.02), leather=RINGED),
    "ring by ring, lossless and damped": leather_scene(0.3, StructuralDamping(0.02), e=1.0, leather=RINGED),
    "stick": leather_scene(),
    "head on": leather_scene(0.0),
    "mirrored": leather_scene(-0.45),
    "slip": leather_scene(0.5, friction=0.2),
    "slip all through": leather_scene(0.6, friction=0.05),
    "endless friction": leather_scene(friction=inf),
    "fast": leather_scene(speed=5.0),
    "lossless": leather_scene(e=1.0),
    "little restitution": leather_scene(e=0.2),
    "flat": leather_scene(0.3, leather=replace(LEATHER, dome_radius=inf)),
    "steady": leather_scene(leather=replace(LEATHER, shear=1e6, rolls=False)),
    "damped": leather_scene(0.375, StructuralDamping(0.02)),
    "hit twice": leather_scene(0.375, SecondHit(0.02)),
    "with waves": leather_scene(0.375, AxialWaves()),
}


@BUILT
@pytest.mark.parametrize("name", WHOLE)
def test_the_kernel_agrees_with_python_on_a_whole_tip(name: str, both) -> None:
    """To `AGREE`, unless an iteration of forces that has all but settled takes a round more in one of the two."""
    scene = WHOLE[name]
    tip = tip_modes_of(scene, AT)
    agree(*both(lambda: strike_modes(scene, tip)))


@BUILT
def test_a_lever_that_is_a_function_keeps_a_whole_tip_in_python(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "c")
    scene, tip = leather_scene(), tip_modes_of(leather_scene(), AT)
    laws = Laws(asin(0.375), POOL.mass, POOL.inertia, scene.stiffness, 0.73, 0.7, scene.contact_time, 2.0)
    for lever, name in ((None, "c"), (lambda phi: (-1e-3, 0.0), "python")):
        terms = scene.contact_terms
        if lever is not None:
            terms.add_lever(lever)
        here = Leather(tip, laws, law=scene.tip_law(0.73, 0.375), radius=POOL.radius, terms=terms)
        assert here.kernel == name


def heavy(mass: float = 50.0) -> TipModes:
    """A cue that presses the leather deeper than its scene's own would."""
    return hand_made([500.0, 3000.0], [5.0, 8.0], mass=mass)


@BUILT
@pytest.mark.parametrize(
    ("scene", "error", "words"),
    [
        (leather_scene(0.1, speed=14.0), ValueError, "leather is compressed by"),
        (leather_scene(), RuntimeError, "could not be stepped on"),
    ],
)
def test_a_whole_tip_gives_up_where_python_does(scene, error, words, monkeypatch: pytest.MonkeyPatch) -> None:
    if error is RuntimeError:
        monkeypatch.setattr("cuefem.contact.leather.MOST_STEPS", 5)
    said = []
    for name in ("python", "c"):
        monkeypatch.setenv(VARIABLE, name)
        with pytest.raises(error, match=words) as raised:
            strike_modes(scene, heavy())
        said.append(str(raised.value))
    assert said[0] == said[1]


@BUILT
@pytest.mark.parametrize("scene", [leather_scene(0.375, SecondHit(0.02)), leather_scene(0.4, StructuralDamping(0.02))])
def test_motion_takes_what_the_kernel_leaves_of_a_whole_tip(scene, monkeypatch: pytest.MonkeyPatch) -> None:
    times, found = np.linspace(0, 3e-3, 7), []
    for name in ("python", "c"):
        monkeypatch.setenv(VARIABLE, name)
        found.append(motion(scene, times, AT))
    for part in ("fields", "along", "centre", "turned"):
        one, other = (getattr(each, part) for each in found)
        assert np.abs(one - other).max() < 10 * AGREE * np.abs(one).max()


@BUILT
def test_motion_takes_what_the_kernel_leaves(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, times = replace(kim_scene(0.3), effects=(SHEAR, SecondHit(0.02))), np.linspace(0, 3e-3, 7)
    found = []
    for name in ("python", "c"):
        monkeypatch.setenv(VARIABLE, name)
        found.append(motion(scene, times, KIM_AT))
    assert found[0].duration == pytest.approx(found[1].duration, rel=AGREE)
    for part in ("fields", "along", "centre", "turned"):
        one, other = (getattr(each, part) for each in found)
        assert np.abs(one - other).max() < 10 * AGREE * np.abs(one).max()


@BUILT
def test_the_kernel_gives_up_where_python_does(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cuefem.contact.linear.MOST_CELLS", 0.3)
    scene, said = kim_scene(0.3), []
    for name in ("python", "c"):
        monkeypatch.setenv(VARIABLE, name)
        with pytest.raises(RuntimeError, match="the ball does not leave the cue") as raised:
            strike_modes(scene, tip_modes_of(scene, Resolution(2, 10, 10)))
        said.append(str(raised.value).split(" with v_t")[0])  # which is zero but for rounding
    assert said[0] == said[1]


@BUILT
def test_numbers_that_overflow_are_left_to_python(monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernel stops at the first number that is not finite, so that both end with the same error."""
    said = []
    tip = hand_made([1e3], [5.0])
    tip = replace(tip, approach=tip.approach * 1e200, amplitude=tip.amplitude * 1e110)
    for name in ("python", "c"):
        monkeypatch.setenv(VARIABLE, name)
        with np.errstate(all="raise"), pytest.raises(ArithmeticError) as raised:
            strike_modes(kim_scene(0.3), tip)
        said.append(str(raised.value))
    assert said[0] == said[1]


def test_the_environment_chooses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "python")
    assert kernel.library() is None
    assert "CUEFEM_KERNEL" in kernel.described()
    monkeypatch.setenv(VARIABLE, "fortran")
    with pytest.raises(ValueError, match=r'CUEFEM_KERNEL must be "c", "python" or empty; got \'fortran\''):
        kernel.library()


def test_a_kernel_that_is_not_there_is_not_needed_but_missed_if_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel, "_loaded", lambda: (None, "it was not built"))
    monkeypatch.delenv(VARIABLE, raising=False)
    assert kernel.library() is None
    assert kernel.described() == "Python: it was not built"
    assert strike_modes(kim_scene(0.3), hand_made([1e3], [5.0])).kernel == "python"
    monkeypatch.setenv(VARIABLE, "c")
    with pytest.raises(RuntimeError, match="CUEFEM_KERNEL asks for the compiled kernel, but it was not built"):
        kernel.library()


def test_an_older_binary_is_not_taken_for_this_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setattr(kernel, "digest", lambda: "0" * 64)
    found, why = kernel._loaded.__wrapped__()
    assert found is None
    assert why.startswith("the compiled kernel was ")


@pytest.mark.parametrize("name", ["python", pytest.param("c", marks=BUILT)])
def test_the_command_says_which_runs(name: str) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "cuefem.cli", "--version"],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | {VARIABLE: name},
    )
    first, second = done.stdout.splitlines()
    assert first.startswith("cuefem, version ")
    assert second == {"python": "contact: Python, as CUEFEM_KERNEL says", "c": "contact: compiled (C)"}[name]
