"""The tap test against what is known: Cramer and Rao's bound, exact tones, recordings made by the model (verification).

The model's own recordings test the ear, the matching and the errors told, not the beam: that is tested elsewhere.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cuefem import end_mass, modes
from cuefem.measured.fit import TapFit
from cuefem.measured.matching import MODES
from cuefem.measured.ringing import Ringing, ringing
from cuefem.measured.tones import Tone, tones
from cuefem.measured.wood import KEPT, SCALE, TapTest, predicted
from cuefem.parts import main_material
from studies.measured import tap
from studies.strokes import NAMES, cue, scene

RATE = 48000.0


def decaying(frequency: float, decay: float, seed: int, noise: float) -> Ringing:
    t = np.arange(int(0.6 * RATE)) / RATE
    clean = np.exp(-decay * t) * np.cos(2 * np.pi * frequency * t + 0.7)
    return Ringing((clean + noise * np.random.default_rng(seed).standard_normal(len(t)))[None], RATE, 1, 0.0)


@pytest.mark.heavy
def test_one_tone_reaches_the_bound_of_cramer_and_rao() -> None:
    """var w = var a = 16 a^3 s^2/(A^2 rate), the bound of a damped sinusoid that decays within the record."""
    frequency, decay, noise = 1234.5, 30.0, 0.5
    bound = np.sqrt(16 * decay**3 * noise**2 / RATE)
    pulls, told_errors = [], []
    for seed in range(24):
        (one,) = tones(decaying(frequency, decay, seed, noise))
        told_errors.append(one.decay_error)
        natural = np.hypot(frequency, decay / (2 * np.pi))
        assert one.error == pytest.approx(np.hypot(one.decay_error / (2 * np.pi), 5e-5 * natural), rel=0.01)
        pulls.append(((one.frequency - natural) / one.error, (one.decay - decay) / one.decay_error))
    assert np.median(told_errors) == pytest.approx(bound, rel=0.08)
    assert 0.75 < np.std(pulls) < 1.25
    assert np.abs(pulls).max() < 3.7


def told(frequency: float, kind: str = "tone", error: float = 1e-6) -> Tone:
    return Tone(frequency, error * frequency, 10.0, 0.1, 0.1, 100.0, kind)


QUICK = ("kim", "carbon")
ALL = [name if name in QUICK else pytest.param(name, marks=pytest.mark.heavy) for name in NAMES]


@pytest.mark.heavy
@pytest.mark.parametrize("name", ALL)
def test_exact_tones_give_the_wood_exactly(name: str) -> None:
    """Some modes unheard, one wrong tone: E and G to 1e-6 of what made them, and the modes by their numbers."""
    true, wood = tap.true(name), main_material(tap.true(name))
    f = modes(true, MODES).frequencies
    heard = [1, 3, 4, 6]  # 0 the first
    wrong = told(0.42 * f[1] + 0.58 * f[3])
    found = TapTest(cue(name), mass=true.shaft_mass, model=0.0).fit([wrong, *(told(f[k]) for k in heard)])
    assert [m.mode for m in found.matched] == [None, *(k + 1 for k in heard)]
    assert found.told
    assert pytest.approx(wood.E, rel=1e-6) == found.wood.E
    assert pytest.approx(wood.G, rel=3e-6) == found.wood.G
    assert found.wood.rho == pytest.approx(wood.rho, rel=1e-6)


def heard(name: str, rate: float, snr: float, seed: int, *, clip: float = np.inf, missing: int = 0) -> TapFit:
    sound = tap.ringing_shaft(tap.true(name), rate, missing=[missing] if missing else [])
    return tap.hung(name).fit(tones(ringing(tap.recording(sound, snr, seed, clip=clip), rate)))


def check(name: str, found: TapFit) -> None:
    wood = main_material(tap.true(name))
    assert pytest.approx(wood.E, rel=0.01) == found.wood.E
    assert pytest.approx(wood.G, rel=0.05 if found.told else KEPT * 1.5) == found.wood.G
    assert not found.rivals
    f = modes(tap.true(name), MODES).frequencies
    for match in found.matched:
        if match.mode is not None:
            assert match.tone.frequency == pytest.approx(f[match.mode - 1], rel=0.01)


@pytest.mark.parametrize(
    ("name", "rate"), [("kim", 48000.0), pytest.param("pool_maple", 44100.0, marks=pytest.mark.heavy)]
)
def test_young_modulus_within_a_per_cent_at_20_db(name: str, rate: float) -> None:
    """Clipped to half its peak, one mode missing: clipped samples are left out, and the count does not shift."""
    check(name, heard(name, rate, 20.0, 0, clip=0.5, missing=2))


@pytest.mark.heavy
@pytest.mark.parametrize("rate", [44100.0, 48000.0])
@pytest.mark.parametrize("name", NAMES)
def test_young_modulus_of_every_cue(name: str, rate: float) -> None:
    for seed, missing in enumerate((0, 1, 3)):
        check(name, heard(name, rate, 20.0, 10 + seed, clip=0.5 if missing else np.inf, missing=missing))


@pytest.mark.heavy
def test_errors_told_cover_the_errors_made() -> None:
    """40 seeds of tones in noise and of a scale's error, no error of the model: pulls are standard normal."""
    name = "pool_hollow"
    true, wood = tap.true(name), main_material(tap.true(name))
    sound = tap.ringing_shaft(true)[:, 0]
    test = TapTest(cue(name), mass=true.shaft_mass, model=0.0)
    pulls = []
    for seed in range(40):
        off = SCALE * np.random.default_rng(1000 + seed).standard_normal()
        test.rho, test.rho_error = test._weigh(true.shaft_mass + off)
        found = test.fit(tones(ringing(tap.recording(sound[:, None], 20.0, seed), RATE)))
        covariance = found.covariance
        logs = np.log([found.wood.E / wood.E, found.wood.rho / wood.rho])
        speed = np.sqrt(covariance[0, 0] + covariance[2, 2] - 2 * covariance[0, 2])  # of ln E/rho, which tones tell
        ratio = np.log(found.wood.G / found.wood.E * wood.E / wood.G)
        pulls.append(
            [logs[0] / np.sqrt(covariance[0, 0]), (logs[0] - logs[1]) / speed, ratio / covariance[1, 1] ** 0.5]
        )
    assert np.abs(pulls).max() < 3.5
    spread = np.sqrt(np.mean(np.square(pulls), axis=0))
    assert (spread > 0.6).all()
    assert (spread < 1.25).all()


@pytest.mark.heavy
def test_errors_of_predictions_are_those_of_samples() -> None:
    """Linear propagation against samples of the wood's covariance, for the end mass."""
    f = modes(tap.true("kim"), 6).frequencies
    found = TapTest(cue("kim"), mass=tap.true("kim").shaft_mass).fit([told(one) for one in f])
    numbers = predicted(scene(found.cue, offset=0.3), found)
    draws = np.random.default_rng(0).multivariate_normal(np.zeros(3), found.covariance, 60)
    wood = found.wood
    felt = []
    for E, ratio, rho in np.exp(draws):
        other = replace(wood, E=E * wood.E, G=E * ratio * wood.G, rho=rho * wood.rho)
        felt.append(end_mass(scene(tap.with_material(found.cue, wood, other))))
    assert numbers["end_mass"].error == pytest.approx(np.std(felt), rel=0.25)
    assert numbers["end_mass"].value == pytest.approx(end_mass(scene(found.cue)), rel=1e-9)
    assert numbers["end_mass"].value == pytest.approx(end_mass(scene(tap.true("kim"))), rel=1e-3)
    assert numbers["end_mass"].before == pytest.approx(end_mass(scene(cue("kim"))), rel=1e-9)
    assert 0 < numbers["squirt"].error < 0.02 * numbers["squirt"].value
