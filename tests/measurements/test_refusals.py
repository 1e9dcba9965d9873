"""What measured cues refuse: measurements that cannot be, folders that are none (regression)."""

import errno
from collections.abc import Callable
from pathlib import Path

import pytest

from cuefem.measurements.estimate import estimate
from cuefem.measurements.measured_cue import MeasuredCue
from cuefem.measurements.measurement_types import AddedMass, PivotLength, Setup, Squirt, Stiffness, Tone, Weight
from cuefem.measurements.uncertain_parameters import Prior
from tests.helpers.command_line import call
from tests.helpers.measured_cues import DRAWING, SCENE, SOME, folder, measured_cue
from tests.helpers.refusals import command_refuses, refuses, untouched

CALLS: dict[str, tuple[Callable[[], object], str]] = {
    "weight": (lambda: Weight(of="butt", value=0.4, error=1e-3), "Weight.of must be one of shaft, cue; got 'butt'"),
    "error": (lambda: Weight(value=0.1, error=0.0), "Weight.error must be in (0, inf) kg; got 0.0"),
    "mode": (lambda: Tone(mode=9, value=95.0, error=0.2), "Tone.mode must be in [1, 8], 1 the lowest; got 9"),
    "one side": (lambda: Squirt(offset=0.3, left=0.03, error=1e-3), "or left and right without it; got left"),
    "three": (lambda: Squirt(offset=0.3, value=0.03, left=0.03, right=0.03, error=1e-3), "got value and left and"),
    "nothing": (lambda: Squirt(offset=0.3, error=1e-3), "without it; got none of them"),
    "zero": (
        lambda: Squirt(offset=0.3, left=0.03, right=0.03, error=1e-3, zero_error=1e-3),
        "Squirt.zero_error must be absent beside left and right, whose mean has none; got 0.001 m",
    ),
    "pivot": (
        lambda: PivotLength(offset=0.3, value=0.0, error=0.01),
        "PivotLength.value must be in (0, inf) m; got 0.0",
    ),
    "pivot's side": (
        lambda: PivotLength(offset=-0.3, value=0.3, error=0.01),
        "PivotLength.offset must be in (0, 1); got -0.3",
    ),
    "no squirt": (
        lambda: PivotLength(offset=0.3, value=0.3, error=0.01).computed(Setup(SCENE, squirt_factor=0.0)),
        "pivot_length must be of a stroke with squirt above 0 rad; got 0 rad at b/R 0.3",
    ),
    "prior": (lambda: Prior("colour", 0.1), "Prior.name must be one of E, G, rho, bore, taper"),
    "two priors": (lambda: Prior("E", 0.1, 1e9, 2e9), "or low and high without it"),
    "ends": (lambda: Prior("E", low=2e9, high=1e9), "Prior.low must be in (0, high)"),
    "no dome": (lambda: measured_cue(priors=(Prior("dome", 0.1),)), "got 'dome', which it does not have"),
    "no cue": (lambda: MeasuredCue("a", "cue", ()), "TypeError: MeasuredCue.scene must be a Scene"),  # type: ignore[arg-type]
    "found": (lambda: measured_cue("a tone"), "TypeError: MeasuredCue.measurements[0] must be a Measurement"),  # type: ignore[arg-type]
    "too long": (
        lambda: Stiffness(free_length=0.8, value=1.0, error=1.0).computed(Setup(SCENE)),
        "stiffness free_length must be in (0, 0.73] m, that of the wood; got 0.8",
    ),
    "beside": (
        lambda: AddedMass(mass=0.01, position=0.8, value=0.1, baseline=0.1, error=0.01, offset=0.3).computed(
            Setup(SCENE)
        ),
        "added_mass position must be in [0, 0.73] m, on the shaft; got 0.8",
    ),
    "no estimate": (lambda: estimate(measured_cue()), "estimate takes a cue with measurements; got none"),
}


@pytest.mark.parametrize(("ask", "message"), CALLS.values(), ids=CALLS.keys())
def test_refusals(ask: Callable[[], object], message: str) -> None:
    refuses(ask, message)


FILES = {
    "key": ('[[weigth]]\nvalue = "1 g"\n', "measured.toml: weigth: must be one of the keys name, source"),
    "unit": ('[[weight]]\nvalue = 100\nerror = "1 g"\n', 'weight[0].value: needs a unit: "15 oz" or "425 g"; got 100'),
    "missing": ('[[weight]]\nvalue = "100 g"\n', "weight[0].error: must be given, a mass with its unit"),
    "extra": (
        '[[tone]]\nvalue = "1 Hz"\nerror = "1 Hz"\nmode = 1\nloud = 1\n',
        "tone[0].loud: must be one of the keys",
    ),
    "no table": ('weight = "100 g"\n', "weight: must be tables, [[weight]]; got '100 g'"),
    "squirt": ('[[squirt]]\noffset = 0.3\nerror = "1 deg"\n', "squirt[0].value: must be given, or left and right"),
    "pivot": (
        '[[pivot_length]]\noffset = 0.3\nvalue = "13 in"\n',
        "pivot_length[0].error: must be given, a length with its unit",
    ),
    "name": ("name = 3\n", "name: must be text; got 3"),
    "unknown": (
        '[[uncertain]]\nname = "bor"\n',
        "uncertain[0].name: must be one of E, G, rho, bore",
    ),
    "prior": (
        '[[uncertain]]\nname = "bore"\nlow = 6\nhigh = 7\n',
        "uncertain[0].low: needs a unit",
    ),
    "closed": (
        'game = "kim"\n[tip]\nfriction = 0.6\n[[uncertain]]\nname = "dome"\nspread = 0.1\n',
        "uncertain parameters must be of this cue; got 'dome'",
    ),
    "lumped": (
        'cue = { mass = "0.5 kg", end_mass = "6 g" }\n',
        "cue: must be a cue of segments, which can be measured",
    ),
}


@pytest.mark.parametrize(("text", "message"), FILES.values(), ids=FILES.keys())
def test_files(text: str, message: str, tmp_path: Path) -> None:
    command_refuses(message, "compare", folder(tmp_path / "cue", text))


SERIES = {
    "heading": ("squirt.csv", "offset,sqirt [deg]\n0.3,2\n", "must have headings source, offset, value"),
    "unit": ("squirt.csv", "offset,value,error [deg]\n0.3,2,1\n", 'line 1, value: must be the heading "value [rad]"'),
    "cells": (
        "squirt.csv",
        "offset,value [deg],error [deg]\n0.3,2\n",
        "line 2: must have 3 cells, as the headings; got 2",
    ),
    "number": ("squirt.csv", "offset,value [deg],error [deg]\na,2,1\n", "line 2, offset: must be a number; got 'a'"),
    "value": ("tone.csv", "mode,value [Hz],error [Hz]\n1,x,1\n", "line 2.value: must be a frequency with its unit"),
    "empty": ("tone.csv", "# nothing\n", "must begin with a line of headings; got comments alone"),
    "name": ("squirts.csv", "offset\n", "squirts.csv: must be one of weight.csv"),
}


@pytest.mark.parametrize(("name", "text", "message"), SERIES.values(), ids=SERIES.keys())
def test_series(name: str, text: str, message: str, tmp_path: Path) -> None:
    place = folder(tmp_path / "cue")
    (place / name).write_text(text, encoding="utf-8")
    command_refuses(message, "compare", place)


def test_a_template_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, *_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    with monkeypatch.context() as patch:
        patch.setattr("cuefem.io.measured_folder.TEMPLATE", ("README.md", "none"))  # the second file cannot be read
        untouched(tmp_path, "cannot be written", "compare", tmp_path / "cue", "--template")
        patch.setattr(Path, "write_text", full)
        untouched(tmp_path, "cannot be written: No space left on device", "compare", tmp_path / "cue", "--template")
    assert call("compare", tmp_path / "cue", "--template")[0] == 0


def test_folders(tmp_path: Path) -> None:
    command_refuses("got no folder", "compare", tmp_path / "none")
    empty = tmp_path / "empty"
    empty.mkdir()
    command_refuses("must hold the shaft's drawing, cue.toml or cue.csv; got none", "compare", empty)
    untouched(tmp_path, "must be a new folder", "compare", empty, "--template")
    untouched(tmp_path, "cannot be written: No such file", "compare", tmp_path / "no" / "folder", "--template")
    scene = folder(
        tmp_path / "scene", SOME, f"game = 'kim'\n[cue]\n{DRAWING.replace('[[segments]]', '[[cue.segments]]')}"
    )
    command_refuses("this file is the drawing; ball and tip stand in measured.toml", "compare", scene)
    place = folder(tmp_path / "cue")
    untouched(tmp_path, "cannot be written", "compare", place, "-o", tmp_path / "no" / "page.html")
    assert call("compare", tmp_path / "cue")[0] == 0
