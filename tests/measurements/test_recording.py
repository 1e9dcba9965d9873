"""Recordings: estimate of the wood, mode numbers with missing modes, noise (verification)."""

import itertools
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.measurements.estimate import estimate
from cuefem.measurements.measured_folder import load_measured
from cuefem.measurements.measurement_types import Tone
from cuefem.measurements.recording import Peak, assign_modes, spectral_peaks, tones_in
from tests.helpers.measured_cues import SHAFT, measured_folder
from tests.helpers.recordings import other_wood, recording, save_wav, tap_sound
from tests.test_golden_files import assert_golden

POOL = Path(__file__).parents[2] / "meshes" / "pool_maple.toml"
RECORDING = '[[recording]]\nfile = "tap.wav"\n'


@pytest.fixture(scope="module")
def drawn() -> np.ndarray:
    """Natural frequencies of the shaft as drawn."""
    return cf.modes(SHAFT, 8).frequencies


@pytest.mark.heavy
def test_recording_of_known_wood_gives_its_constants(tmp_path: Path) -> None:
    """Three taps of pool_maple in another wood, 25 dB: true E, G, density, and those of an earlier estimate."""
    pool_cue = cf.load(POOL)
    assert isinstance(pool_cue, cf.Cue)
    shaft = other_wood(pool_cue)
    weight = f'[[weight]]\nvalue = "{1e3 * shaft.shaft_mass:.1f} g"\nerror = "0.5 g"\n'
    directory = measured_folder(tmp_path / "cue", weight + RECORDING, POOL.read_text(encoding="utf-8"))
    save_wav(directory / "tap.wav", recording(tap_sound(shaft), 25.0, 0))
    cue, _ = load_measured(directory)
    assert [one.mode for one in cue.measurements if isinstance(one, Tone)] == [1, 2, 3, 4, 5, 6, 7]
    assert {one.source for one in cue.measurements if isinstance(one, Tone)} == {"tap.wav"}
    result = estimate(cue)
    assert result.misfit < 2 * len(cue.measurements)
    values = {value.name: value for value in result.values}
    for name, *known in (("E", 15.94e9, 15.84e9), ("G", 1.025e9, 1.015e9), ("rho", 748.0, 742.0)):
        error = (values[name].high - values[name].low) / 2
        assert values[name].value == pytest.approx(known[0], abs=2 * error)
        assert values[name].value == pytest.approx(known[1], abs=2 * error)
        assert error < 0.04 * known[0]


@pytest.mark.parametrize(("snr", "missing"), [(10.0, (1, 2)), (60.0, (3,))])
def test_tones_with_missing_modes_have_right_mode_numbers(
    drawn: np.ndarray, snr: float, missing: tuple[int, ...]
) -> None:
    """The wood is 15 % stiffer than drawn; a missing mode does not shift the numbers of the others."""
    shaft = other_wood(SHAFT)
    true = cf.modes(shaft, 8).frequencies
    tones = tones_in(recording(tap_sound(shaft, missing=missing), snr, 1), 44100.0, drawn)
    assert [tone.mode for tone in tones][: 6 - len(missing)] == [k for k in range(1, 7) if k not in missing]
    for tone in tones:
        assert abs(tone.value - true[tone.mode - 1]) < 3 * tone.sd
        assert tone.error < 2e-3 * tone.value


def heard(rows: Sequence[tuple[float, float, float]], rate: float = 11025.0, last: float = 0.5) -> np.ndarray:
    """Sound of tones of a frequency, a level in dB and a decay in 1/s that begin after 0.1 s of noise at -70 dB."""
    time = np.arange(int((0.1 + last) * rate)) / rate - 0.1
    tones = [10 ** (level / 20) * np.exp(-rho * time) * np.cos(2 * np.pi * f * time) for f, level, rho in rows]
    sound = np.sum([np.where(time >= 0, tone, 0) for tone in tones], axis=0)
    return np.asarray((sound + 10**-3.5 * np.random.default_rng(3).standard_normal(len(time)))[:, None])


SOUNDS = {
    "one": heard([(300.0, 0.0, 20.0)]),
    "two, 4.2 % apart": heard([(300.0, 0.0, 20.0), (313.0, -10.0, 20.0)]),
    "two, 5.3 % apart": heard([(300.0, 0.0, 20.0), (316.5, -10.0, 20.0)]),
    "some quiet": heard([(300.0, 0.0, 20.0), (900.0, -30.0, 20.0), (1500.0, -45.0, 20.0)]),
    "at the ends": heard([(f, 0.0, 20.0) for f in (180.0, 220.0, 1950.0, 2050.0)]),
    "in noise": heard([(300.0, -40.0, 5.0), (700.0, -50.0, 5.0), (900.0, -60.0, 5.0)]),
    "two taps": np.concatenate([0.3 * heard([(500.0, 0.0, 30.0)]), heard([(700.0, 0.0, 30.0)])]),
    "two channels": np.hstack([heard([(500.0, 0.0, 30.0)]), 1 + heard([(700.0, 0.0, 60.0)])]),
    "short": heard([(300.0, 0.0, 20.0)], last=0.11),
    "too short": heard([(300.0, 0.0, 20.0)], last=0.09),
    "silent": np.ones((9999, 1)),
    "infinite": np.full((9999, 1), np.inf),
}
WOODS = (0.75, 0.9, 1.0, 1.2, 1.4)


def test_peaks_and_mode_numbers_equal_golden_file(drawn: np.ndarray, request: pytest.FixtureRequest) -> None:
    """Peaks of made sounds, with their errors, and the modes of three peaks in softer and stiffer woods."""
    lines = []
    for name, sound in SOUNDS.items():
        try:
            peaks = spectral_peaks(sound, 11025.0, 200.0, 2000.0)
        except ValueError as error:
            lines.append(f"{name}: {error}")
            continue
        lines.append(f"{name}: {', '.join(f'{peak.frequency:.3f} ± {peak.error:.2e}' for peak in peaks)}")
    for factor, chosen in itertools.product(WOODS, [(0, 1, 2), (0, 2, 3), (1, 3, 4), (2, 3, 4, 5)]):
        numbers = assign_modes([Peak(factor * float(drawn[i]), 0.1) for i in chosen], drawn)
        lines.append(f"modes {chosen} times {factor}: {sorted(numbers)}")
    assert_golden("recordings.txt", "\n".join(lines) + "\n", request)


DISTORTED: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "gain 10": lambda sound: np.clip(10 * sound, -1, 1),
    "gain 3": lambda sound: np.clip(3 * sound, -1, 1),
    "gain 2": lambda sound: np.clip(2 * sound, -1, 1),
    "gain 1.6": lambda sound: np.clip(1.6 * sound, -1, 1),  # few samples are near the top, many at it
    "tanh": lambda sound: np.tanh(4 * sound),
}


@pytest.mark.parametrize("name", DISTORTED)
def test_clipped_recording_is_rejected(name: str) -> None:
    time, drawn = np.arange(35280) / 44100, np.array([92.0, 277.0, 555.0, 917.0])
    tones = zip(drawn, (0.3, 0.5, 0.4, 0.2), (3, 5, 8, 10), (0, 0.3, 0.7, 1.1), strict=True)
    sound = sum(a * np.exp(-rho * time) * np.sin(2 * np.pi * f * time + phase) for f, a, rho, phase in tones)
    clean = 0.8 * sound / np.abs(sound).max()
    assert len(tones_in(clean[:, None], 44100.0, drawn)) >= 4
    distorted = np.round(32767 * 0.99 * DISTORTED[name](clean)) / 32767
    for channels in (distorted[:, None], np.column_stack([0.3 * clean, distorted])):
        with pytest.raises(ValueError, match="must not be clipped"):
            tones_in(channels, 44100.0, drawn)


def test_random_taps_are_not_taken_for_clipped() -> None:
    """One to six tones over 40 dB, decaying as of wood or of carbon, loud or at 5 % of full scale."""
    generator, ratios = np.random.default_rng(58), np.array([1, 2.9, 5.9, 9.8, 14.6, 20.2])
    time = np.arange(4410) / 11025
    for _ in range(100):
        count = int(generator.integers(1, 7))
        f = generator.uniform(60, 130) * ratios[:count]
        decay = np.pi * f * generator.uniform(0.0005, 0.015, count)
        waves = np.exp(-np.outer(time, decay)) * np.sin(np.outer(time, 2 * np.pi * f) + generator.uniform(0, 6, count))
        sound = waves @ 10 ** generator.uniform(-2, 0, count)
        loud = generator.uniform(0.05, 1) * sound / np.abs(sound).max()
        samples = np.round(32767 * (loud + 1e-4 * generator.normal(size=len(time)))) / 32767
        spectral_peaks(samples[:, None], 11025.0, 40.0, 3000.0)


@pytest.mark.parametrize("size", [0, 0xFFFFFFFF])
def test_recording_with_unknown_size_of_its_data_is_read(size: int, drawn: np.ndarray, tmp_path: Path) -> None:
    directory = measured_folder(tmp_path / "cue", RECORDING)
    time = np.arange(22050) / 44100
    save_wav(
        directory / "tap.wav", 0.3 * np.sum([np.exp(-15 * time) * np.sin(2 * np.pi * f * time) for f in drawn[:3]], 0)
    )
    known = load_measured(directory)[0].measurements
    content = (directory / "tap.wav").read_bytes()
    at = content.index(b"data") + 4
    (directory / "tap.wav").write_bytes(content[:at] + size.to_bytes(4, "little") + content[at + 4 :])
    assert load_measured(directory)[0].measurements == known


def test_mode_numbers_of_any_subset_and_wood_are_right(drawn: np.ndarray) -> None:
    """Woods within the spread of the table; three modes may be ambiguous, five are not."""
    generator, wrong, sets = np.random.default_rng(0), 0, 0
    for E, G, rho in np.exp(generator.normal(0, (0.2, 0.25, 0.1), (6, 3))):
        true = cf.modes(other_wood(SHAFT, E=E, G=G, rho=rho), 8).frequencies
        for count in (3, 5, 7):
            for chosen in itertools.combinations(range(8), count):
                result = assign_modes([Peak(float(true[i]), 0.1) for i in chosen], drawn)
                off = any(abs(peak.frequency / true[mode - 1] - 1) > 1e-9 for mode, peak in result.items())
                assert not off or count == 3
                wrong, sets = wrong + off, sets + 1
    assert wrong < 0.02 * sets


def test_two_recordings_give_one_tone_per_mode(drawn: np.ndarray, tmp_path: Path) -> None:
    """A difference of 1 Hz is an error of 0.5 Hz; the tones have both files as source."""
    time = np.arange(44100) / 44100

    def sound(*tones: float) -> np.ndarray:
        return 0.4 * sum(np.exp(-15 * time) * np.sin(2 * np.pi * f * time) for f in tones)[:, None]

    directory = measured_folder(tmp_path / "cue", RECORDING + RECORDING.replace("tap", "two"))
    save_wav(directory / "tap.wav", sound(*drawn[:3]))
    save_wav(directory / "two.wav", sound(drawn[0], drawn[1] + 1.0, drawn[3]))
    first, second, third, fourth = load_measured(directory)[0].measurements
    assert isinstance(second, Tone)
    assert (first.source, third.source, fourth.source) == ("tap.wav, two.wav", "tap.wav", "two.wav")
    assert drawn[1] < second.value < drawn[1] + 1
    assert second.error == pytest.approx(0.5, rel=0.2)
