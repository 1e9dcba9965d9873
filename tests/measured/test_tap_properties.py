"""What must not matter to a tap test, and what it must say (properties)."""

from __future__ import annotations

import json
import wave
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

import cuefem
from cuefem import Cue, Scene, modes
from cuefem.io.sound import load_recording
from cuefem.measured.matching import MODES
from cuefem.measured.ringing import ringing
from cuefem.measured.tones import Tone, tones
from cuefem.measured.wood import KEPT, TapTest
from cuefem.parts import main_material
from studies.measured import tap
from studies.strokes import MESHES, NAMES, cue
from tests.helpers.command_line import call
from tests.helpers.surfaces import outline_of, revolved, written

RATE = 10000  # of the recordings here: shorter sums
KIM = MESHES / "kim.toml"
FOREIGN = "loud tones are not this shaft's"


@pytest.fixture(scope="module")
def sound() -> np.ndarray:
    """Kim's shaft with other wood, 25 dB, one channel."""
    return tap.recording(tap.ringing_shaft(tap.true("kim"), RATE)[:, :1], 25.0, 3)


def frequencies(signal: np.ndarray, rate: float = RATE, kind: str = "tone") -> list[float]:
    return [tone.frequency for tone in tones(ringing(signal, rate)) if tone.kind == kind]


def told(frequency: float, kind: str = "tone", error: float = 1e-5) -> Tone:
    return Tone(frequency, error * frequency, 10.0, 0.1, 0.1, 100.0, kind)


@pytest.fixture(scope="module")
def true_tones() -> np.ndarray:
    return modes(tap.true("kim"), MODES).frequencies


@pytest.fixture(scope="module")
def kim_test() -> TapTest:
    return TapTest(cue("kim"), mass=tap.true("kim").shaft_mass)


def test_gain_sign_offset_and_a_copied_channel_do_not_matter(sound: np.ndarray) -> None:
    usual = frequencies(sound)
    assert len(usual) >= 4
    assert frequencies(-0.01 * sound + 0.1) == pytest.approx(usual, rel=1e-6)
    assert frequencies(np.hstack([sound, 0.3 * sound])) == pytest.approx(usual, rel=1e-6)
    assert frequencies(sound[:, 0]) == usual


def test_taps_are_found_and_each_tells_more(sound: np.ndarray) -> None:
    clean = tap.ringing_shaft(tap.true("kim"), RATE)[:, :1]
    one, three = (ringing(tap.recording(clean, 15.0, 1, taps=n), RATE) for n in (1, 3))
    assert (one.taps, three.taps) == (1, 3)
    assert three.traces.shape == (3, one.traces.shape[1])
    few, many = tones(one), tones(three)
    assert len(many) >= len(few)
    assert many[2].decay_error < 0.75 * few[2].decay_error  # 1/sqrt(3)


@pytest.mark.parametrize("kind", ["uint8", "int16", "int24", "int32", "float32", "float64"])
def test_samples_of_every_kind_read_alike(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "tap.WAV"
    wanted = np.array([[-1.0, 0.5], [0.0, -0.25], [0.25, 0.75]])
    if kind == "int24":
        with wave.open(str(path), "wb") as file:
            file.setnchannels(2)
            file.setsampwidth(3)
            file.setframerate(44100)
            file.writeframes(b"".join(int(v * 2**23).to_bytes(3, "little", signed=True) for v in wanted.ravel()))
    else:
        scale, middle = {"uint8": (128, 128), "int16": (2**15, 0), "int32": (2**31, 0)}.get(kind, (1, 0))
        wavfile.write(path, 44100, (wanted * scale + middle).astype(kind))
    found = load_recording(path)
    assert found.rate == 44100
    assert found.samples.shape == (3, 2)
    assert found.samples == pytest.approx(wanted)


@pytest.mark.heavy
def test_a_limiter_s_harmonics_are_no_modes(kim_test: TapTest) -> None:
    """A phone that squeezes loud sounds makes sums of the loud tones, such as f2 + 2 f1: none is taken for a mode."""
    soft = np.tanh(3 * tap.recording(tap.ringing_shaft(tap.true("kim"), RATE)[:, :1], 40.0, 0))
    heard = tones(ringing(soft, RATE))
    f = modes(tap.true("kim"), 2).frequencies
    sums = [tone for tone in heard if np.min(np.abs(tone.frequency - np.array([2 * f[0] + f[1], f[1] - 2 * f[0]]))) < 1]
    assert len(sums) == 2
    assert {tone.kind for tone in sums} == {"harmonic"}
    found = kim_test.fit(heard)
    assert pytest.approx(main_material(tap.true("kim")).E, rel=0.01) == found.wood.E
    assert [m.mode for m in found.matched if m.tone in sums] == [None, None]


def test_clipped_samples_are_left_out(kim_test: TapTest) -> None:
    clean = tap.ringing_shaft(tap.true("kim"), RATE)[:, :1]
    cut = ringing(tap.recording(clean, 40.0, 0, clip=0.3), RATE)
    assert 0.01 < cut.clipped < 0.3
    assert not any(tone.kind == "harmonic" for tone in tones(cut) if tone.snr > 100)
    assert ringing(tap.recording(clean, 40.0, 0), RATE).clipped == 0


def test_a_hum_is_steady(sound: np.ndarray) -> None:
    t = np.arange(len(sound)) / RATE
    hum = 0.05 * np.sin(2 * np.pi * 200 * t)[:, None]
    (found,) = [tone for tone in tones(ringing(sound + hum, RATE)) if abs(tone.frequency - 200) < 2]
    assert found.kind == "steady"


@pytest.mark.heavy
def test_two_planes_are_taken_together(kim_test: TapTest) -> None:
    """Half a per cent between the planes' stiffness: the mean wood, with half the distance as error."""
    sound = tap.recording(tap.ringing_shaft(tap.true("kim"), RATE, split=0.01)[:, :1], 35.0, 2)
    heard = tones(ringing(sound, RATE))
    twins = [tone for tone in heard if tone.kind == "twin"]
    assert len(twins) >= 2
    found = kim_test.fit(heard)
    assert pytest.approx(main_material(tap.true("kim")).E, rel=0.01) == found.wood.E
    assert any("two planes" in note for note in found.notes)


def test_one_tone_keeps_the_ratio_and_says_so(kim_test: TapTest, true_tones: np.ndarray) -> None:
    found = kim_test.fit([told(true_tones[0])])
    assert not found.told
    assert pytest.approx(found.before.G / found.before.E, rel=1e-12) == found.wood.G / found.wood.E
    assert np.sqrt(found.covariance[1, 1]) == pytest.approx(KEPT)
    wood = main_material(tap.true("kim"))
    assert abs(found.wood.E - wood.E) < 3 * found.errors[0]
    assert any("one tone cannot tell G from E" in note for note in found.notes)


def test_tones_that_fit_two_ways_are_said_to(kim_test: TapTest, true_tones: np.ndarray) -> None:
    """The seventh tone alone may be the sixth or eighth of another wood."""
    found = kim_test.fit([told(true_tones[6])])
    assert found.rivals
    assert any("cannot be told apart" in refusal for refusal in found.refusals)
    assert not kim_test.fit([told(f) for f in true_tones[:4]]).rivals


def test_a_wrong_tone_is_left_out(kim_test: TapTest, true_tones: np.ndarray) -> None:
    honest = kim_test.fit([told(f) for f in true_tones[:5]])
    fooled = kim_test.fit([told(f) for f in [*true_tones[:5], 200.0, 777.0]])
    assert fooled.wood == honest.wood
    assert [m.mode for m in fooled.matched] == [1, 2, 3, 4, 5, None, None]
    assert any("200.0, 777.0 Hz" in note for note in fooled.notes)


@pytest.mark.heavy
def test_the_drawing_of_another_shaft_is_doubted() -> None:
    """Tones that fit in part, or by wood at the end of the search: what was found is told, with the doubt."""

    def struck(found: np.ndarray) -> list[Tone]:
        return [replace(told(f), level=found[0] / f) for f in found]

    hollow, maple = (modes(tap.true(name), 9).frequencies for name in ("pool_hollow", "pool_maple"))
    found = tap.hung("pool_maple").fit(struck(hollow))
    assert "most of the sound's power is in tones that this shaft does not have" in found.refusals
    refusals = tap.hung("carbon").fit(struck(maple)).refusals
    assert "E is at the end of the search, a factor 3 from the file's" in refusals


@pytest.mark.heavy
def test_recordings_of_all_other_shafts_are_doubted() -> None:
    """25 pairs of a drawing and a recording: the right ones alone without doubt."""
    clean = {name: tap.ringing_shaft(tap.true(name), 20000.0)[:, :1] for name in NAMES}
    heard = {name: tones(ringing(tap.recording(clean[name], 20.0, 1), 20000.0)) for name in NAMES}
    for name in NAMES:
        found = {other: tap.hung(name).fit(heard[other]) for other in NAMES}
        doubted = {other: fit.refusals or FOREIGN in " ".join(fit.notes) for other, fit in found.items()}
        assert [other for other in NAMES if not doubted[other]] == [name]


@pytest.mark.parametrize("name", ["kim", "pool_maple"])
def test_the_right_drawing_is_not_doubted(name: str) -> None:
    heard = modes(tap.true(name), 8).frequencies
    assert tap.hung(name).fit([told(f) for f in heard]).notes == ()


def test_supports_are_off_while_it_hangs_and_clay_stays_on(true_tones: np.ndarray) -> None:
    held = TapTest(cue("kim"), effects=(cuefem.Support(0.5, stiffness=1e4), cuefem.PointMass(0.1, 0.005)))
    assert [type(effect).__name__ for effect in held.shaft.effects] == ["PointMass"]
    there = modes(cue("kim"), 3, effects=held.shaft.effects).frequencies
    assert there[0] < 0.98 * modes(cue("kim"), 3).frequencies[0]
    assert pytest.approx(main_material(cue("kim")).E, rel=1e-3) == held.fit([told(f) for f in there]).wood.E


def test_not_weighed_is_as_uncertain_as_density(true_tones: np.ndarray) -> None:
    unweighed = TapTest(cue("kim")).fit([told(f) for f in true_tones[:5]])
    assert unweighed.errors[0] / unweighed.wood.E == pytest.approx(0.1, rel=0.05)
    wood = main_material(tap.true("kim"))
    assert unweighed.wood.E / unweighed.wood.rho == pytest.approx(wood.E / wood.rho, rel=2e-3)


def test_a_mass_against_the_drawing_is_remarked() -> None:
    assert TapTest(cue("kim"), mass=cue("kim").shaft_mass).notes == []
    (note,) = TapTest(cue("kim"), mass=1.3 * cue("kim").shaft_mass).notes
    assert "check the scale and the drawing" in note


@pytest.mark.heavy
def test_a_drawing_says_no_unit_and_no_butt(tmp_path: Path, sound: np.ndarray) -> None:
    """A surface in inches with the rest of the cue behind it tells what the scene of its drawing tells."""
    recording, drawn, new = (tmp_path / name for name in ("tap.wav", "kim.obj", "new.toml"))
    wavfile.write(recording, RATE, (sound * 32767).astype(np.int16))
    written(drawn, *revolved(outline_of(cue("kim")), 96), unit=0.0254)
    said = ("--body-mass", "420 g", "--length-unit", "in", "--contact-time", "1 ms", "--material", "hard maple")
    status, out, err = call("tap", recording, "--scene", drawn, *said, "--json", "-o", new)
    assert (status, err) == (0, "")
    record = json.loads(out)
    assert record["scene"]["cue"]["mass"] == pytest.approx(0.42 + record["shaft_mass"], rel=1e-12)
    assert record["predicted"]["end_mass"]["value"] == pytest.approx(0.0053, rel=0.15)
    found = cuefem.load(new)
    assert isinstance(found, Cue)
    assert found.length == pytest.approx(cue("kim").length, rel=1e-6)
    assert found.body_mass == 0.42
    assert pytest.approx(found.segments[0].material.E, rel=1e-5) == record["wood"]["E"]["value"]


@pytest.mark.heavy
def test_a_stroke_that_miscues_is_said_to(tmp_path: Path, sound: np.ndarray) -> None:
    recording = tmp_path / "tap.wav"
    wavfile.write(recording, RATE, (sound * 32767).astype(np.int16))
    spring = ("--contact-time", "2 ms", "--offset", "0.9")
    status, out, _ = call("tap", recording, "--scene", KIM, *spring)
    assert status == 0
    assert "this stroke miscues" in out
    assert json.loads(call("tap", recording, "--scene", KIM, *spring, "--json")[1])["regime"] == "miscue"
    assert "miscue" not in call("tap", recording, "--scene", KIM)[1]
    late = ("--offset", "0.75")  # with a usual tip it holds at first
    assert "this stroke miscues" in call("tap", recording, "--scene", KIM, *late)[1]
    told = json.loads(call("tap", recording, "--scene", KIM, *late, "--json")[1])
    assert (told["regime"], told["grip"]) == ("stick", "lets go")


@pytest.mark.heavy
def test_the_command(tmp_path: Path, sound: np.ndarray) -> None:
    recording, scene, new, figure = (tmp_path / name for name in ("tap.wav", "scene.toml", "new.toml", "spectrum.svg"))
    wavfile.write(recording, RATE, (sound * 32767).astype(np.int16))
    cuefem.save(Scene(cue("kim"), stroke=cuefem.Stroke(offset=0.2)), scene)
    mass = f"{1e3 * tap.true('kim').shaft_mass} g"
    status, out, err = call("tap", recording, "--scene", scene, "--mass", mass, "-o", new, "-o", figure)
    assert (status, err) == (0, "")
    assert "The wood" in out
    assert figure.read_text(encoding="utf-8").lstrip().startswith("<?xml")
    written = cuefem.load(new)
    assert isinstance(written, Scene)
    assert isinstance(written.cue, Cue)
    wood = main_material(tap.true("kim"))
    assert pytest.approx(wood.E, rel=0.01) == written.cue.segments[0].material.E
    assert written.cue.shaft_mass == pytest.approx(tap.true("kim").shaft_mass, rel=1e-4)
    assert replace(written, cue=cue("kim")) == cuefem.load(scene)
    status, out, _ = call("tap", recording, "--scene", KIM, "--mass", mass, "--json", "--material-of", 0)
    record = json.loads(out)
    assert status == 0
    assert record["wood"]["E"]["value"] == pytest.approx(written.cue.segments[0].material.E, rel=1e-5)
    assert record["predicted"]["squirt"]["error"] > 0
    assert record["tones"][0]["mode"] == 1
