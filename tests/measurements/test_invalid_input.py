"""Invalid measurements, files and folders; one for each `raise` (bad input)."""

import errno
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cuefem.measurements.estimate import estimate
from cuefem.measurements.measured_cue import MeasuredCue
from cuefem.measurements.measurement_types import AddedMass, PivotLength, Setup, Squirt, Stiffness, Tone
from cuefem.measurements.pendulum import Pendulum
from cuefem.measurements.uncertain_parameters import Prior
from tests.helpers.command_line import call
from tests.helpers.invalid_input import assert_raises, assert_rejects, assert_unchanged
from tests.helpers.measured_cues import CUE_TOML, MEASURED_TOML, SCENE, measured_cue, measured_folder
from tests.helpers.recordings import save_wav

SWING = {"release": (0.19,), "rebound": (-0.03,), "clamped_rebound": (0.15,)}
GOOD = Pendulum(ball_mass=8e-3, thread_length=1.0, position=0.02, contact_time=1e-3, **SWING)
FAR = AddedMass(mass=0.01, position=0.8, value=0.1, baseline=0.1, error=0.01, offset=0.3)
PIVOT = PivotLength(offset=0.3, value=0.3, error=0.01)
CALLS: dict[str, Callable[[], object]] = {
    "or left and right without it; got left": lambda: Squirt(offset=0.3, left=0.03, error=1e-3),
    "or left and right without it; got none of them": lambda: Squirt(offset=0.3, error=1e-3),
    "Squirt.zero_error must be absent": lambda: Squirt(offset=0.3, left=0.03, right=0.03, error=1e-3, zero_error=1e-3),
    "pivot_length must be of a stroke with squirt": lambda: PIVOT.compute(Setup(SCENE, squirt_factor=0.0)),
    "Prior.name must be one of E, G, rho, ": lambda: Prior("colour", 0.1),
    "Prior.name must be one of E, G, rho": lambda: Prior("shaft material", 0.1),
    "got 3": lambda: Prior(3, 0.1),
    "Prior.low must be in (0, inf); got nan": lambda: Prior("E", low=float("nan"), high=2e9),
    "one prior for each parameter; got two of 'E'": lambda: measured_cue(priors=(Prior("E", 0.1), Prior("E", 0.2))),
    "TypeError: Tone.mode must be a whole number in [1, 8]": lambda: Tone(mode=1.5, value=1.0, error=1.0),
    "AddedMass.baseline must be a squirt other than 0 rad": lambda: replace(FAR, baseline=0.0),
    "Prior.spread must be given": lambda: Prior("E", 0.1, 1e9, 2e9),
    "Prior.low must be in (0, high)": lambda: Prior("E", low=2e9, high=1e9),
    "got 'dome', which it does not have": lambda: measured_cue(priors=(Prior("dome", 0.1),)),
    "TypeError: MeasuredCue.scene must be a Scene": lambda: MeasuredCue("a", "cue", ()),
    "TypeError: MeasuredCue.measurements[0] must be a Measurement": lambda: measured_cue("a tone"),
    "stiffness free_length must be in (0, 0.73] m": lambda: Stiffness(free_length=0.8, value=1.0, error=1.0).compute(
        Setup(SCENE)
    ),
    "added_mass position must be in [0, 0.73] m": lambda: FAR.compute(Setup(SCENE)),
    "estimate takes a cue with measurements": lambda: estimate(measured_cue()),
    "Pendulum.release must be displacements less than thread_length, 0.1 m": lambda: replace(GOOD, thread_length=0.1),
    "Pendulum.rebound must be displacements": lambda: replace(GOOD, rebound=()),
    "Pendulum.release must be one reading, or one for each rebound (1)": lambda: replace(GOOD, release=(0.2, 0.2)),
    "Pendulum.contact_time must be given": lambda: replace(GOOD, contact_time=None),
    "without it; got contact_time and force": lambda: replace(GOOD, force=9.0),
    "Pendulum.clamped_rebound must have a speed in (0, 1]": lambda: replace(GOOD, clamped_rebound=(0.3,)),
    "Pendulum.rebound must have a speed between -1 and 0.": lambda: replace(GOOD, rebound=(0.188,)),
    "for an error of the end mass below 100 %": lambda: replace(GOOD, rebound=(0.1495,)),
}


@pytest.mark.parametrize("message", CALLS)
def test_invalid_arguments_are_rejected(message: str) -> None:
    assert_raises(CALLS[message], message)


PENDULUM = (
    r"""[[pendulum]]\nball_mass = "8 g"\nthread_length = "1 m"\nrelease = ["200 mm"]\nclamped_rebound = ["162 mm"]\n"""
)
PENDULUM += r"""contact_time = "1 ms"\nposition = "10 mm"\n"""
# A file of the folder, its content (P: a pendulum test without the rebound), and a part of the message.
FILES = r"""
measured.toml | [[weigth]]\nvalue = "1 g"\n | measured.toml: weigth: unknown key; did you mean 'weight'?
measured.toml | [[weight]]\nvalue = 100\nerror = "1 g"\n | weight[0].value: needs a unit
measured.toml | [[weight]]\nvalue = "100 g"\n | weight[0].error: must be given
measured.toml | weight = "100 g"\n | weight: must be tables, [[weight]]
measured.toml | [[squirt]]\noffset = 0.3\nerror = "1 deg"\n | squirt[0].value: must be given, or left and right
measured.toml | name = 3\n | name: must be text
measured.toml | prior = 3\n | prior: must be tables
measured.toml | cue = { mass = "0.5 kg", end_mass = "6 g" }\n | cue: must be a cue of segments
measured.toml | Prebound = ["250 cm"]\n | pendulum[0].rebound: must be displacements less
measured.toml | [[recording]]\nfile = "none.wav"\n | none.wav: cannot be read: No such file
measured.toml | [[recording]]\nfile = "tap.mp3"\n | tap.mp3: must end in .wav
measured.toml | [[recording]]\nfile = "tap.wav"\nloud = 1\n | recording[0].loud: unknown key; valid:
measured.toml | [[recording]]\nfile = "\u0000.wav"\n | x00.wav: must be a path without null
squirt.csv | offset,sqirt [deg]\n0.3,2\n | must have headings source, offset, value
squirt.csv | offset,value,error [deg]\n0.3,2,1\n | line 1, value: must be the heading "value [rad]"
squirt.csv | offset,value [deg],error [deg]\n0.3,2\n | line 2: must have 3 cells
squirt.csv | offset,value [deg],error [deg]\na,2,1\n | line 2.offset: must be a bare number
tone.csv | # nothing\n | must begin with a line of headings
squirt.csv | offset,value [deg],value [deg]\n0.3,2,1\n | line 1, value: must be in one column; got 2
squirts.csv | offset\n | squirts.csv: must be one of weight.csv
squirt.CSV | offset\n | squirt.CSV: must be one of weight.csv
"""


@pytest.mark.parametrize("row", FILES.strip().splitlines())
def test_invalid_files_are_rejected(row: str, tmp_path: Path) -> None:
    name, text, message = row.split(" | ")
    directory = measured_folder(tmp_path / "cue")
    text = (PENDULUM + text[1:]) if text[0] == "P" else text
    (directory / name).write_text(text.replace("\\n", "\n"), encoding="utf-8")
    assert_rejects(message, "compare", directory)


NOISE, TIME = np.random.default_rng(3), np.arange(22050)[:, None] / 22050
SOUNDS: dict[str, tuple[np.ndarray | bytes, int]] = {
    "tap.wav: must hold a sound; got silence": (np.zeros((4000, 1)), 22050),
    "tap.wav: must last 0.1 s or more": (np.linspace(0, 0.5, 4000)[:, None] ** 2, 22050),
    "must have at least 3 peaks near": (0.1 * NOISE.standard_normal((22050, 1)), 22050),
    "got 318": (0.5 * np.exp(-9 * TIME) * np.sin(2e3 * TIME), 22050),
    "must have 4000 to 400000 samples per second": (NOISE.uniform(-1, 1, (900, 1)), 1000),
    "tap.wav: must be a .wav file of sound": (b"ID3 and so on", 0),
    "must be a .wav file of sound": (b"RIFF\x00\x00\x00\x00WAVE", 0),
}


@pytest.mark.parametrize("message", SOUNDS)
def test_invalid_recordings_are_rejected(message: str, tmp_path: Path) -> None:
    directory, (samples, rate) = measured_folder(tmp_path / "cue", '[[recording]]\nfile = "tap.wav"\n'), SOUNDS[message]
    path = directory / "tap.wav"
    path.write_bytes(samples) if isinstance(samples, bytes) else save_wav(path, samples, rate)
    assert_rejects(message, "compare", directory)


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


def test_invalid_folders_are_rejected(tmp_path: Path) -> None:
    assert_rejects("got no folder", "compare", tmp_path / "none")
    (empty := tmp_path / "empty").mkdir()
    assert_rejects("must contain the shaft's drawing, cue.toml or cue.csv; got none", "compare", empty)
    assert_unchanged(tmp_path, "cannot be written: No such file", "compare", tmp_path / "no" / "folder", "--template")
    scene = f"game = 'kim'\n[cue]\n{CUE_TOML.replace('[[segments]]', '[[cue.segments]]')}"
    of_scene = measured_folder(tmp_path / "scene", MEASURED_TOML, scene)
    assert_rejects("this file is the drawing; ball and tip belong in measured.toml", "compare", of_scene)
    assert_unchanged(
        tmp_path, "cannot be written", "compare", measured_folder(tmp_path / "cue"), "-o", tmp_path / "no" / "page.html"
    )
