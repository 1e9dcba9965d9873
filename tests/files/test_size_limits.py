"""Files that would take unlimited time or memory are rejected within seconds (bad input)."""

import os
import re
import resource
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.invalid_input import assert_rejects

SOON = 20  # s; commands take less than 1 s
PIECE = '[[segments]]\nlength = "{}"\ntip_diameter = "{}"\nbutt_diameter = "21 mm"\nmaterial = "hard maple"\n'
GOOD = PIECE.format("700 mm", "12 mm")
TIP = 'cue = "good.toml"\n[stroke]\noffset = 0.3\n[tip]\n'
LONG = "segments[0].length: must be more than 0 and at most 1000 m; got 1e9 m"
WIDE = "segments[0].tip_diameter: must be more than 0 and at most 10000 mm; got 99999 mm"
SHORT = "tip.contact_time: must be 1e-6 to 10 s; got 1e-12 s"
FILES = {
    "long.toml": (PIECE.format("1e9 m", "12 mm"), LONG),
    "wide.toml": (PIECE.format("700 mm", "99999 mm"), WIDE),
    "short.toml": (TIP + 'contact_time = "1e-12 s"\n', SHORT),
    "many.toml": (PIECE.format("1 mm", "12 mm") * 2001, "segments: must have at most 2000 segments; got 2001"),
    "more.toml": (PIECE.format("1 mm", "12 mm") * 40_000, "must be a file of at most 1 MB; got 4"),
    "dots.toml": ("a" + ".a" * 20_000 + " = 1\n", "line 1: must have keys of at most 32 parts; got one of "),
    "quoted.toml": ("x = {" + '"a".' * 20_000 + "a = 1}\n", "line 1: must have keys of at most 32 parts; got one of "),
    "blank.toml": (PIECE.format("700" + 200_000 * " " + "x", "12 mm"), "segments[0].length: must be a length"),
}
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


@pytest.mark.parametrize("name", FILES)
def test_commands_on_unbounded_sizes_reject_them(folder: Path, name: str) -> None:
    """By three commands, one with a study of the file."""
    content, line = FILES[name]
    Path(name).write_text(content)
    Path("study.toml").write_text(STUDY.format(name, "0.7 m"))
    for command in (("modes", name), ("convert", name, "made.toml"), ("study", "study.toml")):
        assert_rejects(f"{name}: {line}", *command)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_constructors_beyond_bounds_raise() -> None:
    ash = cf.Material(12e9, 8e8, 680.0)
    for make, line in (
        (lambda: cf.Segment(1e9, 0.012, 0.021, ash), "Segment.length must be in (0, 1000] m; got 1000000000.0"),
        (lambda: cf.Tip(contact_time=1e-12), "Tip.contact_time must be in [1e-6, 10] s; got 1e-12"),
        (lambda: cf.Cue((cf.Segment(1e-3, 0.012, 0.012, ash),) * 2002), "Cue.segments must hold at most 2001 segments"),
        (lambda: cf.end_mass(stiff(1e30)), "Tip.stiffness must make a head-on contact time in [1e-6, 10] s; got 1e+30"),
        (lambda: cf.end_mass(stiff(1e6), at=cf.Resolution(4000, 8, 4)), "the mesh must have at most 50000 degrees of"),
        (lambda: cf.modes(stiff(1e6).cue, 10**9), "the mesh must have at most 50000 degrees of freedom; got "),
    ):
        with pytest.raises(ValueError, match=f"^{re.escape(line)}"):
            make()


def test_longest_drawing_with_axial_waves_accepts_a_butt() -> None:
    wood = cf.Material(12e9, 8e8, 680.0)
    long_cue = cf.Cue((cf.Segment(0.7 / 2000, 0.012, 0.012, wood),) * 2000, body_mass=0.43)
    assert len(cf.AxialWaves(1.47, 0.03, 4430.0).with_butt(long_cue).segments) == 2001


def stiff(stiffness: float) -> cf.Scene:
    """A scene whose tip has this stiffness."""
    ash = cf.Material(12e9, 8e8, 680.0)
    return cf.Scene(cf.Cue((cf.Segment(0.7, 0.012, 0.021, ash),)), tip=cf.Tip(stiffness=stiffness))


KINDS = ["toml", "csv", "stl", "ply", "obj", "wav"]
LIMITS = {"toml": 1, "csv": 1, "stl": 100, "ply": 100, "obj": 100, "wav": 100}  # MB


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


def make_special_file(name: str, kind: str) -> None:
    if kind == "a folder":
        Path(name).mkdir()
    else:
        os.mkfifo(name)


@pytest.mark.parametrize("kind", ["a folder", "a pipe or a device"])
@pytest.mark.parametrize("suffix", KINDS)
def test_commands_on_folder_or_pipe_reject_it(folder: Path, soon: None, suffix: str, kind: str) -> None:
    name = f"cue.{suffix}"
    make_special_file(name, kind)
    for command in commands_on(name):
        assert_rejects(f"{name}: must be a file; got {kind}\n", *command)
    assert not Path("made.toml").exists()


@pytest.mark.parametrize("suffix", KINDS)
def test_commands_on_too_large_file_do_not_read_it(folder: Path, suffix: str) -> None:
    name = f"cue.{suffix}"
    with open(name, "wb") as file:
        file.truncate(1_500_000_000)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for command in commands_on(name):
        assert_rejects(f"{name}: must be a file of at most {LIMITS[suffix]} MB; got 1500\n", *command)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000  # kB: none of it was read
