"""Invalid measurements, files and folders; one for each `raise` (bad input)."""

import errno
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.measurements.estimate import estimate
from cuefem.measurements.measured_cue import MeasuredCue
from cuefem.measurements.measurement_types import AddedMass, PivotLength, Setup, Squirt, Stiffness, Tone
from cuefem.measurements.shot import Shot
from cuefem.measurements.swerve import reading_angle
from cuefem.measurements.uncertain_parameters import Prior
from tests.helpers.command_line import call
from tests.helpers.invalid_input import (
    assert_calls_refused,
    assert_refused,
    assert_unchanged,
    rejected,
    stored_rows,
)
from tests.helpers.measured_cues import measured_cue, measured_folder
from tests.helpers.recordings import save_wav
from tests.measurements.test_calibration import calibration

SHOT = Shot(cue_offset=0.0143, left=0.04, right=0.038, distance=1.2)
FAR = AddedMass(mass=0.01, position=0.8, value=0.1, baseline=0.1, error=0.01, offset=0.3)
PIVOT = PivotLength(offset=0.3, value=0.3, error=0.01)
# What rows of tests/golden/refused_measurements.txt name beside the names here.
KINDS = {kind.__name__: kind for kind in (MeasuredCue, Prior, Setup, Squirt, Stiffness, Tone)}
NAMED = KINDS | {each.__name__: each for each in (calibration, estimate, measured_cue, reading_angle, replace)}


def test_invalid_arguments_are_rejected(request: pytest.FixtureRequest) -> None:
    assert_calls_refused("measurements", globals() | NAMED | {"cf": cf}, request)


SHOTS = r"""[[shot]]\nleft = "40 mm"\nright = "38 mm"\n"""


def test_invalid_files_are_rejected(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """Each row: a file of the folder, its content (P: a shot without its distance and its offset)."""
    messages = {}
    for i, row in enumerate(stored_rows("measured_files")):
        name, text = row.split(" | ")
        directory = measured_folder(tmp_path / f"{i}")
        text = (SHOTS + text[1:]) if text[0] == "P" else text
        (directory / name).write_text(text.replace("\\n", "\n"), encoding="utf-8")
        messages[row] = rejected(directory, "compare", directory)
    assert_refused("measured_files", messages, request)


NOISE, TIME = np.random.default_rng(3), np.arange(22050)[:, None] / 22050
SOUNDS: dict[str, tuple[np.ndarray | bytes, int]] = {
    "silence": (np.zeros((4000, 1)), 22050),
    "a ramp": (np.linspace(0, 0.5, 4000)[:, None] ** 2, 22050),
    "noise": (0.1 * NOISE.standard_normal((22050, 1)), 22050),
    "a high tone": (0.5 * np.exp(-9 * TIME) * np.sin(2e3 * TIME), 22050),
    "few samples": (NOISE.uniform(-1, 1, (900, 1)), 1000),
    "an mp3 file": (b"ID3 and so on", 0),
    "a header": (b"RIFF\x00\x00\x00\x00WAVE", 0),
}


def test_invalid_recordings_are_rejected(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    messages = {}
    directory = measured_folder(tmp_path / "cue", '[[recording]]\nfile = "tap.wav"\n')
    path = directory / "tap.wav"
    for name, (samples, rate) in SOUNDS.items():
        path.write_bytes(samples) if isinstance(samples, bytes) else save_wav(path, samples, rate)
        messages[name] = rejected(directory, "compare", directory).partition(" (File format")[0]  # of scipy
    assert_refused("recordings", messages, request)


def test_template_write_failure_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, *_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    template = ("compare", tmp_path / "cue", "--template")
    with monkeypatch.context() as patch:
        patch.setattr(
            "cuefem.measurements.measured_folder.TEMPLATE", ("README.md", "none")
        )  # the second file cannot be read
        assert_unchanged(tmp_path, "cannot be written", *template)
        patch.setattr(Path, "write_text", full)
        assert_unchanged(tmp_path, "cannot be written: No space left on device", *template)
    assert call(*template)[0] == 0
    assert_unchanged(tmp_path, "must be a new folder", *template)
