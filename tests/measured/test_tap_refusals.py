"""What a tap test refuses: bad input with status 2, a sound that tells nothing or is doubted with 1 (regression)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

from cuefem import PointMass
from cuefem.measured.ringing import ringing
from cuefem.measured.tones import Tone
from cuefem.measured.wood import TapTest
from studies.measured import tap
from studies.strokes import MESHES, cue
from tests.helpers.command_line import call

KIM = MESHES / "kim.toml"
RATE = 8000
NOISE = np.random.default_rng(0).standard_normal(RATE) / 10
T = np.arange(2 * RATE) / RATE


def refused(*arguments: object, status: int = 2) -> str:
    found, out, err = call("tap", *arguments)
    assert (found, out) == (status, "")
    assert err.count("\n") == 1
    assert err.startswith("cuefem: ")
    return err.removeprefix("cuefem: ").rstrip("\n")


def decaying(frequency: float, clip: float = 1.0) -> np.ndarray:
    return np.clip(np.exp(-4 * T) * np.sin(2 * np.pi * frequency * T), -clip, clip)


RECORDINGS = {
    "empty": (np.zeros(0), "must hold a sound; got none"),
    "short": (NOISE[:400], "a recording must last 0.2 s or more; got 0.05 s"),
    "silent": (np.zeros(RATE), "a recording must hold a sound; got silence"),
    "constant": (np.full(RATE, 0.25), "a recording must hold a sound; got silence"),
    "nan": (np.where(np.arange(RATE) == 7, np.nan, NOISE), "a recording must hold finite samples; got nan or inf"),
    "loud": (1e30 * NOISE, "a recording must hold samples within [-1e+12, 1e+12]; got 3.9e+29"),
    "noise": (NOISE, "must hold a decaying tone between 60 and 8000 Hz; got none"),
    "hum": (np.sin(2 * np.pi * 150 * T), "the tones fit this shaft no better than by chance"),
    "clipped": (decaying(300.0, 0.001)[: int(1.6 * RATE)], "clipped beyond use: record with less gain or farther away"),
    "long": (np.zeros(130 * RATE), "must last 120 s at most; got 130 s"),
}


@pytest.mark.parametrize(("samples", "line"), RECORDINGS.values(), ids=RECORDINGS.keys())
def test_recordings(samples: np.ndarray, line: str, tmp_path: Path) -> None:
    path = tmp_path / "tap.wav"
    wavfile.write(path, RATE, samples.astype(np.float32))
    status = 1 if "tone" in line else 2  # a sound file in which nothing, or no shaft, rings
    new = ("-o", tmp_path / "new.toml", "-o", tmp_path / "new.png")
    said = refused(path, "--scene", KIM, *new, status=status)
    assert said.startswith(f"{path}: ")
    assert line in said
    assert sorted(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("name", "content", "line"),
    [
        ("tap.wav", None, "cannot be read: No such file or directory"),
        ("tap.wav", b"", "must be a .wav file of sound"),
        ("tap.wav", b"ID3 no wav at all, but some other sound", "must be a .wav file of sound"),
        ("tap.wav", b"RIFF\x24\x00\x00\x00WAVEfmt \x10\x00", "must be a .wav file of sound"),
        ("tap.wav", b"RIFF\x04\x00\x00\x00WAVE", "must be a .wav file of sound"),
        ("tap.m4a", b"....ftyp", "must end in .wav; got '.m4a' (ffmpeg -i tap.m4a tap.wav converts)"),
    ],
)
def test_files_that_are_no_recording(tmp_path: Path, name: str, content: bytes | None, line: str) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    assert refused(path, "--scene", KIM).startswith(f"{path}: {line}")


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (["--mass", "118"], f'{KIM}: --mass: needs a unit: "15 oz" or "425 g"; got'),
        (["--mass", "-118 g"], f"{KIM}: --mass: must be more than 0 g; got -118 g"),
        (["--material-of", "1"], f"{KIM}: segment must be in [0, 0], 0 at the tip; got 1"),
        (["-o", "spectrum.pdf"], "spectrum.pdf: --output: must end in .html or .toml or .png or .svg; got '.pdf'"),
        (["--offset", "1"], f"{KIM}: --offset: must be between -1 and 1; got 1.0"),
    ],
)
def test_options(options: list[str], line: str, tmp_path: Path) -> None:
    assert refused(tmp_path / "none.wav", "--scene", KIM, *options).startswith(line)


@pytest.mark.parametrize("options", [("-o", "new.toml", "-o", "none/f.svg"), ("-o", "dir.toml", "-o", "f.svg")])
def test_places_where_nothing_can_be_written(options: tuple[str, ...], tmp_path: Path) -> None:
    """Said before the recording is heard: neither of the two files is there without the other."""
    (tmp_path / "dir.toml").mkdir()
    here = [word if word.startswith("-") else tmp_path / word for word in options]
    said = refused(tmp_path / "none.wav", "--scene", KIM, *here)
    where, why = (
        ("none/f.svg", "No such file or directory") if "none/f.svg" in options else ("dir.toml", "Is a directory")
    )
    assert said == f"{tmp_path / where}: cannot be written: {why}"
    assert list(tmp_path.iterdir()) == [tmp_path / "dir.toml"]


def test_a_drawing_that_is_there_is_not_replaced_unasked(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text("somebody's work")
    said = refused(tmp_path / "none.wav", "--scene", KIM, "-o", tmp_path / "mine.toml")
    assert said == f"{tmp_path / 'mine.toml'}: is there already: --force replaces it"
    said = refused(tmp_path / "none.wav", "--scene", KIM, "-o", tmp_path / "mine.toml", "--force")
    assert said.startswith(f"{tmp_path / 'none.wav'}: ")
    assert (tmp_path / "mine.toml").read_text() == "somebody's work"


@pytest.mark.parametrize("mass", [0.002, 11.8, 1e-300, 1e300])
def test_a_mass_that_no_such_shaft_has(mass: float) -> None:
    """Below that of the other parts, and kilograms for grams."""
    bound = r"mass of the shaft must be .* to .* g, the wood's density within a factor 3 of the file's; got "
    with pytest.raises(ValueError, match=bound):
        TapTest(cue("pool_maple"), mass=mass)


def test_a_weighed_mass_holds_the_clay() -> None:
    clay, drawn = PointMass(0.1, 0.02), cue("kim").shaft_mass
    assert TapTest(cue("kim"), mass=drawn + 0.02, effects=(clay,)).notes == []
    with pytest.raises(ValueError, match=rf"; got {1e3 * (drawn / 3 + 0.01):.4g} g"):
        TapTest(cue("kim"), mass=drawn / 3 + 0.01, effects=(clay,))


def test_a_lumped_cue_has_no_tones(tmp_path: Path) -> None:
    lumped = tmp_path / "lumped.toml"
    lumped.write_text("game = 'kim'\n[cue]\nmass = '540 g'\nend_mass = '6 g'\n")
    said = refused(tmp_path / "tap.wav", "--scene", lumped)
    assert said == f"{lumped}: must hold a cue of segments: a lumped cue has no tones"


def told(frequency: float) -> Tone:
    return Tone(frequency, 0.01, 10.0, 0.1, 0.1, 100.0)


def test_tones_of_another_thing() -> None:
    with pytest.raises(RuntimeError, match="must be bending tones of this shaft"):
        TapTest(cue("kim")).fit([told(f) for f in (1000.0, 1031.0, 1061.0, 1093.0, 1126.0)])
    with pytest.raises(RuntimeError, match="must be bending tones of this shaft"):
        TapTest(cue("kim")).fit([])


@pytest.mark.parametrize("option", ["--doubted", pytest.param("--force", marks=pytest.mark.heavy)])
def test_what_cannot_be_told_apart_is_not_written(tmp_path: Path, option: str) -> None:
    """One tone, of the seventh mode perhaps: refused with status 1, told and written when asked to go on."""
    path, new = tmp_path / "tap.wav", tmp_path / "new.toml"
    wavfile.write(path, 10000, tap.recording(one_tone(2600.0), 30.0, 0).astype(np.float32))
    status, out, err = call("tap", path, "--scene", KIM, "-o", new)
    assert (status, out, err.count("\n")) == (1, "", 1)
    assert err.startswith(f"cuefem: {path}: refused, --doubted goes on: ")
    assert "tones cannot be told apart: E " in err
    assert not new.exists()
    status, out, _ = call("tap", path, "--scene", KIM, "-o", new, option)
    assert status == 0
    assert "the tones cannot be told apart" in " ".join(out.split())
    assert new.exists()
    # a drawing that is there takes --force
    assert call("tap", path, "--scene", KIM, "-o", new, option)[0] == (0 if option == "--force" else 2)


def one_tone(frequency: float) -> np.ndarray:
    t = np.arange(10000) / 10000
    return (np.exp(-60 * t) * np.sin(2 * np.pi * frequency * t))[:, None]


@pytest.mark.parametrize("rate", [4000.0, 0.0, np.nan, 1e6])
def test_rates(rate: float) -> None:
    with pytest.raises(ValueError, match=r"ringing rate must be in \[8000, 384000\] Hz"):
        ringing(np.zeros(48000), rate)
