"""What is no tap is refused, what is one is not; hum is taken out; the text says what the table does (properties)."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import wavfile

from cuefem import modes
from cuefem.materials import WOODS, material
from cuefem.measured.chance import LEVEL, SETS, by_chance, random_sets
from cuefem.measured.doubts import unlike
from cuefem.measured.hum import without_hum
from cuefem.measured.matching import MODES
from cuefem.measured.ringing import Ringing, ringing
from cuefem.measured.strings import better_note, note_of
from cuefem.measured.tones import HIGH, LOW, Tone, tones
from cuefem.measured.wood import TapTest
from cuefem.parts import main_material
from studies.measured import tap, tap_refusals, tap_sounds
from studies.strokes import MESHES, NAMES, cue
from tests.helpers import strings
from tests.helpers.command_line import call

KIM = MESHES / "kim.toml"
RATE = 10000


@pytest.fixture(scope="module")
def kim_test() -> TapTest:
    return TapTest(cue("kim"), mass=tap.true("kim").shaft_mass)


@pytest.fixture(scope="module")
def true_tones() -> np.ndarray:
    return modes(tap.true("kim"), MODES).frequencies


def told(frequency: float, kind: str = "tone") -> Tone:
    return Tone(frequency, 1e-5 * frequency, 10.0, 0.1, 0.1, 100.0, kind)


@pytest.mark.heavy
@pytest.mark.parametrize(("kind", "seed"), [("speech", 0), ("cough", 0)])
def test_speech_and_coughs_are_refused_and_write_nothing(kind: str, seed: int, tmp_path: Path) -> None:
    path, new = tmp_path / "talk.wav", tmp_path / "new.toml"
    wavfile.write(path, tap_sounds.RATE, tap_sounds.other_sound(kind, seed).astype(np.float32))
    status, out, err = call("tap", path, "--scene", KIM, "-o", new)
    assert (status, out, err.count("\n"), new.exists()) == (1, "", 1, False)
    assert "no better than by chance" in err


def test_tones_of_a_shaft_are_better_than_chance_and_others_are_not(kim_test: TapTest, true_tones: np.ndarray) -> None:
    assert by_chance(kim_test.table, [told(f) for f in true_tones[:4]]) == 1 / (SETS + 1)
    assert by_chance(kim_test.table, [told(true_tones[0])]) > LEVEL
    assert by_chance(kim_test.table, [told(f, "steady") for f in true_tones[:4]]) == 1


@pytest.mark.heavy
def test_p_values_of_random_tones_are_even(kim_test: TapTest) -> None:
    """Eighteen sets: of even p-values fewer than two, or more than 16, lie below the half in 1 of 6000 cases."""
    made = np.exp(random_sets(np.geomspace(90, 3500, 9), 18, seed=1))
    p = np.array([by_chance(kim_test.table, [told(f) for f in row]) for row in made])
    assert 2 <= np.sum(p <= 0.5) <= 16
    assert np.sum(p <= LEVEL) <= 2


def test_missing_modes_are_refused(kim_test: TapTest, true_tones: np.ndarray) -> None:
    found = kim_test.fit([told(true_tones[k]) for k in (0, 7, 8, 9)])
    assert any(line == "6 of the 10 modes that should be heard are missing" for line in found.refusals)
    assert not kim_test.fit([told(f) for f in true_tones[:5]]).refusals


STRINGS: dict[str, tuple[str, Callable[[], np.ndarray]]] = {
    "a string in a loop, every second partial a mode": ("kim", lambda: strings.looped(582.1, softness=0.3, seed=1)),
    "a bright string": ("kim", lambda: strings.looped(499.2, damping=1e-3, seed=2)),
    "a bass string": ("pool_maple", lambda: strings.plucked(82.4, seed=3)),
    "a stiff string": ("pool_hollow", lambda: strings.plucked(167.0, stiffness=6e-5, loss=1e-3, seed=4)),
    "a muted string": ("pool_hollow", lambda: strings.plucked(303.6, loss=8e-3, place=0.13, seed=5)),
    "a guitar's string": ("carbon", lambda: strings.plucked(146.8, stiffness=3e-5, place=0.3, seed=6)),
    "a sung ah": ("kim", lambda: strings.sung(265.1, seed=7)),
    "a sung ee": ("pool_maple", lambda: strings.sung(310.0, (270.0, 2290.0, 3010.0), seed=8)),
}


DAILY = {"a string in a loop, every second partial a mode", "a stiff string", "a sung ah"}


@pytest.mark.parametrize(
    ("name", "sound"),
    [
        pytest.param(*made, id=words, marks=[pytest.mark.heavy] * (words not in DAILY))
        for words, made in STRINGS.items()
    ],
)
def test_strings_and_voices_are_refused_as_such(name: str, sound: Callable[[], np.ndarray]) -> None:
    heard = tones(ringing(sound(), strings.RATE))
    with_tones = [tone for tone in heard if tone.kind in ("tone", "harmonic")]
    refusals = TapTest(cue(name)).fit(heard).refusals
    assert any(line.startswith("a string, a pipe or a voice explains the tones better: ") for line in refusals)
    assert any(f"of {len(with_tones)} are partials of a note of" in line for line in refusals)


@pytest.mark.heavy
@given(
    note=st.floats(70.0, 600.0),
    stiffness=st.floats(0.0, 1e-3),
    count=st.integers(10, 24),
    place=st.floats(0.05, 0.5),
)
@settings(max_examples=60, deadline=None)
def test_the_note_of_any_string_is_found(note: float, stiffness: float, count: int, place: float) -> None:
    """Every partial but those that the place of the pluck silences; some wood never explains them as well."""
    order = np.arange(1, count + 1)
    f = note * order * np.sqrt(1 + stiffness * order**2)
    sizes = np.abs(np.sin(np.pi * order * place)) / order
    heard = [
        replace(told(frequency), level=size)
        for frequency, size in zip(f, sizes, strict=True)
        if size > 0.02 * sizes.max() and LOW < frequency < HIGH
    ]
    found = note_of(heard)
    assert found.frequency == pytest.approx(note, rel=5e-3)
    assert found.partials == len(heard)
    wood = tap.hung("kim").table.hypotheses(heard)
    assert better_note(heard, wood[0].score if wood else -np.inf) == found


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.heavy] * (name != "carbon")) for name in NAMES[:-1]]
)
def test_no_shaft_sounds_like_a_string(name: str) -> None:
    """Woods of half to twice the file's E, from three tones to all of them, also with multiples that clipping adds.

    Not the whole cue: with such multiples the search itself misses its wood, which is then doubted anyway.
    """
    table = tap.hung(name).table
    for E, ratio in itertools.product(table.E[1] + np.log([0.5, 1.0, 2.0]), table.ratio[2:-1:4]):
        f = np.exp(table.log_frequencies(np.array([E]), np.array([ratio]))[0])
        own = [replace(told(each), level=f[0] / each) for each in f[(f > LOW) & (f < HIGH)]]
        clipped = [replace(told(k * own[0].frequency, "harmonic"), level=0.3 / k) for k in (2, 3, 5)]
        for heard in (own[:3], own[:5], own[:9], own, [*own[:5], *clipped], [*own, *clipped]):
            wood = table.hypotheses(heard)
            assert not wood or better_note(heard, wood[0].score) is None


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("rate", "usual"),
    [(44100, 48000), (48000, 44100), (22050, 16000), (8000, 16000), (96000, 88200), (11025, 8000), (32000, 44100)],
)
def test_the_answer_says_what_another_usual_rate_would_mean(
    rate: float, usual: float, kim_test: TapTest, true_tones: np.ndarray
) -> None:
    found = kim_test.fit([told(f) for f in true_tones[:6]], rate)
    assert not found.refusals
    (line,) = found.notes
    share, E, lowest = usual / rate, found.wood.E / 1e9, true_tones[0]
    assert line == (
        f"the file says {rate:g} samples a second, which is believed; if it was recorded at {usual:g}, the lowest tone "
        f"is {share * lowest:.4g} Hz, not {lowest:.4g} Hz, and E is {share**2 * E:.3g} GPa, not {E:.3g} GPa"
    )


def test_a_wrong_sampling_rate_is_told_with_the_tone_it_would_mean(kim_test: TapTest, true_tones: np.ndarray) -> None:
    """Tones that ask for stiffer wood than there is, and for a usual one at 44.1 kHz in the place of 48."""
    true = main_material(tap.true("kim"))
    stiffer = ((f, replace(true, E=f**2 * true.E, G=f**2 * true.G)) for f in np.linspace(1.0, 1.7, 71))
    factor = 1.02 * next(f for f, wood in stiffer if unlike(wood, main_material(cue("kim"))))
    found = kim_test.fit([told(factor * f) for f in true_tones[:6]])
    (line,) = (line for line in found.refusals if "sampling rate" in line)
    share = 44.1 / 48
    assert f"44.1 kHz for 48, the lowest tone is {share * factor * true_tones[0]:.4g} Hz, not" in line
    assert f"E is {share**2 * found.wood.E / 1e9:.3g} GPa" in line
    assert not any("sampling rate" in line for line in kim_test.fit([told(f) for f in true_tones[:6]]).refusals)


@pytest.mark.parametrize("name", WOODS)
def test_every_wood_of_the_table_is_like_wood(name: str) -> None:
    assert unlike(material(name), material("hard maple")) == []
    assert unlike(material(name), main_material(cue("kim"))) == []


def test_wood_far_outside_the_table_is_named() -> None:
    maple = material("hard maple")
    (line,) = unlike(replace(maple, G=0.29e9), maple)
    assert line == "G 0.29 GPa is far outside the 0.8 to 1.8 GPa that woods have"
    (line,) = unlike(replace(maple, E=5e9), maple)
    assert line.startswith("E 5 GPa is far outside the 10.3 to 22.3 GPa")
    (line,) = unlike(replace(maple, rho=1500.0), maple)
    assert line.startswith("rho 1.5e+03 kg/m³ is far outside the 600 to 905 kg/m³")
    tube = material("carbon fibre")
    assert unlike(replace(tube, E=135e9, G=30e9), tube) == []
    assert len(unlike(replace(tube, E=12e9), tube)) == 1
    nobody_s = replace(maple, E=1e12)
    assert unlike(maple, nobody_s) == []  # nothing to compare with


@pytest.mark.heavy
@pytest.mark.parametrize("mains", [50.0, 60.0])
def test_mains_hum_above_the_ring_is_taken_out_and_named(mains: float, kim_test: TapTest, tmp_path: Path) -> None:
    """7 dB above the ring, the grid 0.05 % off: the same tones to their errors, and the wood to a per cent."""
    sound = tap.ringing_shaft(tap.true("kim"), RATE)[:, :1]
    t = np.arange(len(sound)) / RATE
    hum = sum(np.sin(2 * np.pi * k * 1.0005 * mains * t + k) / k for k in range(1, 13))[:, None]
    hum *= np.sqrt(np.mean(np.square(sound)) * 10**0.7 / np.mean(np.square(hum)))
    samples = tap.recording(sound + hum, 30.0, 0)
    _, found = without_hum(samples, RATE)
    assert found is not None
    assert found.mains == pytest.approx(1.0005 * mains, abs=0.02)
    assert set(found.multiples) >= {1, 2, 3, 4}
    assert found.level == pytest.approx(7.0, abs=1.0)
    wood = kim_test.fit(tones(ringing(samples, RATE)))
    assert not wood.refusals
    assert pytest.approx(main_material(tap.true("kim")).E, rel=0.01) == wood.wood.E
    path = tmp_path / "tap.wav"
    wavfile.write(path, RATE, samples.astype(np.float32))
    status, out, _ = call("tap", path, "--scene", KIM)
    assert status == 0
    assert f"a mains hum of {mains:.0f}.0" in " ".join(out.split())


@pytest.mark.heavy
@pytest.mark.parametrize("name", NAMES)
def test_no_hum_is_heard_in_a_tap(name: str) -> None:
    for taps in (1, 3):
        heard = tap.recording(tap.ringing_shaft(tap.true(name), RATE)[:, :1], 20.0, 0, taps=taps)
        clean, hum = without_hum(heard, RATE)
        assert hum is None
        assert clean is heard


@pytest.mark.heavy
def test_a_tone_near_the_noise_is_faint_and_as_uncertain_as_its_line_is_wide() -> None:
    """It may be two that overlap. Twice the least amplitude that is heard at all makes it a tone."""
    t = np.arange(int(0.6 * RATE)) / RATE
    noise = np.random.default_rng(0).standard_normal(len(t))

    def heard(amplitude: float) -> Tone:
        weak = amplitude * np.exp(-60 * t) * np.cos(2 * np.pi * 2000 * t)
        found = tones(Ringing((100 * np.exp(-5 * t) * np.cos(600 * t) + weak + noise)[None], RATE, 1, 0.0))
        return min(found, key=lambda tone: abs(tone.frequency - 2000))

    assert heard(1.4).kind == "faint"
    assert heard(1.4).error > heard(1.4).decay / (2 * np.pi)
    assert heard(4.0).kind == "tone"
    assert heard(4.0).error < heard(4.0).decay / (2 * np.pi)


@pytest.mark.heavy
def test_a_faint_tone_says_nothing_for_a_mode_or_against_it(kim_test: TapTest, true_tones: np.ndarray) -> None:
    honest = kim_test.fit([told(f) for f in true_tones[:5]])
    strange = replace(told(777.0, "faint"), error=30.0)
    found = kim_test.fit([*(told(f) for f in true_tones[:5]), strange])
    assert (found.notes, found.wood) == ((), honest.wood)
    others = [told(true_tones[k]) for k in (0, 1, 2, 4)]
    assert kim_test.fit(others).notes == ("not heard: mode 4",)
    fourth = replace(told(true_tones[3] + 5, "faint"), error=30.0)
    found = kim_test.fit([*others, fourth])
    assert (found.notes, found.matched[-1].mode) == ((), None)


@pytest.mark.heavy
def test_density_that_is_not_weighed_is_the_file_s(true_tones: np.ndarray) -> None:
    for name in ("kim", "pool_maple"):
        heard = modes(tap.true(name), 6).frequencies
        found = TapTest(cue(name)).fit([told(f) for f in heard])
        assert found.wood.rho == pytest.approx(found.before.rho, rel=1e-14)
        assert found.errors[2] == pytest.approx(0.1 * found.before.rho, rel=1e-12)
        assert any("density is kept as it is" in note for note in found.notes)


@pytest.mark.heavy
def test_the_shear_coefficient_of_g_is_told(tmp_path: Path) -> None:
    """G times kappa is what the tones tell: with the coefficient halved G doubles."""
    cone = cue("kim")
    (one,) = cone.segments
    other = replace(cone, segments=(replace(one, kappa=0.6),))
    f, mass = modes(tap.true("kim"), 8).frequencies, tap.true("kim").shaft_mass
    first, second = (TapTest(drawn, mass=mass).fit([told(x) for x in f]) for drawn in (cone, other))
    assert (first.shear_coefficients, second.shear_coefficients) == ((0.9, 0.9), (0.6, 0.6))
    assert pytest.approx(1.5 * first.wood.G, rel=1e-4) == second.wood.G
    path = tmp_path / "tap.wav"
    samples = tap.recording(tap.ringing_shaft(tap.true("kim"), RATE)[:, :1], 25.0, 3)
    wavfile.write(path, RATE, samples.astype(np.float32))
    out = " ".join(call("tap", path, "--scene", KIM)[1].split())
    assert "the tones tell G times the shear coefficient; here a shear coefficient of 0.900" in out
    assert out.index("Tones") < out.index("The wood") < out.index("What follows") < out.index("assumed: a usual stroke")
    assert json.loads(call("tap", path, "--scene", KIM, "--json")[1])["shear_coefficients"] == [0.9, 0.9]


@pytest.mark.heavy
@pytest.mark.parametrize("seed", [0, 3])
def test_honest_taps_of_other_wood_are_not_refused(seed: int) -> None:
    found, wood = tap_refusals.honest(seed)
    assert tap_refusals.accepted(found)
    assert found is not None
    assert found.wood.E / found.wood.rho == pytest.approx(wood.E / wood.rho, rel=0.01)


def test_a_single_short_tap_leaves_no_multiple_of_the_hum() -> None:
    """The tap's own ring pulls the first estimate of the mains frequency; 1.2 s are enough to put that right."""
    sound = tap.ringing_shaft(tap.true("pool_maple"), RATE)[:, :1]
    hum = tap_sounds.hum(np.random.default_rng(1), len(sound), RATE, mains=60.0)[:, None]
    hum *= np.sqrt(np.mean(np.square(sound)) * 10**0.7)
    samples = tap.recording(sound + hum, 40.0, 0)
    clean, found = without_hum(samples, RATE)
    assert found is not None
    heard = tones(ringing(samples, RATE))
    assert [tone.frequency for tone in heard if tone.kind == "steady"] == []
    multiples = [
        tone for tone in heard if abs(tone.frequency / found.mains - round(tone.frequency / found.mains)) < 5e-3
    ]
    own = modes(tap.true("pool_maple"), 12).frequencies
    assert all(np.min(np.abs(own / tone.frequency - 1)) < 2e-3 for tone in multiples if tone.kind == "tone")
    scale = np.abs(samples).max() / np.abs(sound + hum).max()
    assert np.sqrt(np.mean(np.square(clean - scale * sound))) < 0.1 * np.sqrt(np.mean(np.square(scale * sound)))


def test_what_a_refusal_says_no_note_says_again(true_tones: np.ndarray) -> None:
    for heard in ([2600.0], [true_tones[k] for k in (0, 7, 8, 9)]):
        found = TapTest(cue("kim")).fit([told(f) for f in heard])
        assert found.refusals
        assert not any(refusal in note or note in refusal for refusal in found.refusals for note in found.notes)
        assert not any("cannot be told apart" in note for note in found.notes)
