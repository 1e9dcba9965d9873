"""Warnings for implausible values, and none for shipped cues (regression)."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.show.plausibility import plausibility_warnings
from tests.helpers.command_line import call

ROOT = Path(__file__).parents[2]
FILES = sorted(path for kind in ("meshes/*.toml", "meshes/*.stl", "studies/scenes/*.toml") for path in ROOT.glob(kind))
PROFILE = "x [mm],diameter [mm]\n0,12.5\n250,12.9\n737,21\n"


def warnings_of(path: Path) -> list[str]:
    loaded = cf.load(path)
    if isinstance(loaded, cf.Cue) and not loaded.body_mass and path.suffix != ".toml":  # a profile has no other mass
        loaded = replace(loaded, body_mass=0.43)
    return plausibility_warnings(loaded if isinstance(loaded, cf.Scene) else cf.Scene(loaded))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_plausibility_of_shipped_cues_has_no_warning(path: Path) -> None:
    assert warnings_of(path) == []


EXPECTED = "the whole cue weighs "


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_strike_of_shaft_without_butt_warns(tmp_path: Path) -> None:
    shaft = tmp_path / "shaft.csv"
    shaft.write_text(PROFILE)
    light = cf.load(shaft)
    assert isinstance(light, cf.Cue)
    (line,) = plausibility_warnings(cf.Scene(light))
    assert line.startswith(f"{EXPECTED}{1e3 * light.mass:.4g} g, less than 250 g: squirt is too low")
    status, out, err = call("strike", shaft, "--body-mass", "0 g", "--json")
    assert (status, err.splitlines()) == (0, [f"warning: {json.loads(out)['warnings'][0]}"])
    assert EXPECTED in err
    assert call("strike", shaft)[2] == ""  # with the usual rest of a pool cue
    assert call("modes", shaft)[2] == ""  # frequencies do not depend on it


BUTTS = {"chamfer": "1460,30\n1470,5\n", "bumper": "1440,30\n1440.1,12\n1470,12\n"}


@pytest.mark.parametrize("name", BUTTS)
def test_chamfer_or_bumper_at_the_butt_causes_no_warning(name: str, tmp_path: Path) -> None:
    (tmp_path / "cue.csv").write_text("x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n" + BUTTS[name])
    assert plausibility_warnings(cf.Scene(cf.load(tmp_path / "cue.csv"))) == []
