"""Files that would take unlimited time or memory are rejected within seconds (bad input)."""

import os
import resource
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.invalid_input import assert_rejects

SOON = 20  # s; commands take less than 1 s
PIECE = '[[segments]]\nlength = "{}"\ntip_diameter = "{}"\nbutt_diameter = "21 mm"\nmaterial = "hard maple"\n'
GOOD = PIECE.format("700 mm", "12 mm")
STUDY = """scene = "{}"
responses = ["end_mass"]
[[vary]]
path = "cue.segments[0].length"
values = ["{}"]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("good.toml").write_text(GOOD)
    return tmp_path


def test_longest_drawing_with_axial_waves_accepts_a_butt() -> None:
    wood = cf.Material(12e9, 8e8, 680.0)
    long_cue = cf.Cue((cf.Segment(0.7 / 2000, 0.012, 0.012, wood),) * 2000, body_mass=0.43)
    assert len(cf.AxialWaves(1.47, 0.03, 4430.0).with_butt(long_cue).segments) == 2001


LIMITS = {"toml": 1, "csv": 1, "stl": 100, "wav": 100}  # MB


def test_measured_series_with_a_cell_of_200_000_characters_is_rejected(folder: Path) -> None:
    Path("measured").mkdir()
    Path("measured/cue.toml").write_text(f'body_mass = "420 g"\n{GOOD}')
    Path("measured/squirt.csv").write_text("value [deg],offset\n" + "1" * 200_000 + ",0.3\n")
    assert_rejects("squirt.csv: line 2: must have at most 10000 characters", "compare", "measured")


@pytest.fixture
def soon() -> Iterator[None]:
    """Ends a test that blocks, as opening a pipe does."""

    def late(*_: object) -> None:
        raise TimeoutError("blocked")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(SOON)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def commands_on(name: str) -> list[list[str]]:
    """Command lines that read a file of this name, by itself or through another file."""
    if name.endswith("wav"):
        Path("measured").mkdir(exist_ok=True)
        Path("measured/cue.toml").write_text(f'body_mass = "420 g"\n{GOOD}')
        Path("measured/measured.toml").write_text(f'[[recording]]\nfile = "../{name}"\n')
        return [["compare", "measured"]]
    Path("names.toml").write_text(f'cue = "{name}"\n')
    Path("study.toml").write_text(STUDY.format(name, "0.7 m"))
    return [["modes", name], ["modes", "names.toml"], ["study", "study.toml"], ["convert", name, "made.toml"]]


@pytest.mark.parametrize(("kind", "make"), [("a folder", os.mkdir), ("a pipe or a device", os.mkfifo)])
@pytest.mark.parametrize("suffix", LIMITS)
def test_commands_on_folder_or_pipe_reject_it(
    folder: Path, soon: None, suffix: str, kind: str, make: Callable[[str], None]
) -> None:
    name = f"cue.{suffix}"
    make(name)
    for command in commands_on(name):
        assert_rejects(f"{name}: must be a file; got {kind}\n", *command)
    assert not Path("made.toml").exists()


@pytest.mark.parametrize("suffix", LIMITS)
def test_commands_on_too_large_file_do_not_read_it(folder: Path, suffix: str) -> None:
    name = f"cue.{suffix}"
    with open(name, "wb") as file:
        file.truncate(1_500_000_000)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for command in commands_on(name):
        assert_rejects(f"{name}: must be a file of at most {LIMITS[suffix]} MB; got 1500\n", *command)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000  # kB: none of it was read
