"""Files of every kind load and save exactly (regression)."""

import math
from dataclasses import replace
from pathlib import Path

import meshio
import pytest

import cuefem as cf
from cuefem.files import InputError, load_accuracy
from tests.helpers.cues import kim

KIM = kim()
(SEGMENT,) = KIM.segments
MAPLE = SEGMENT.material
KIM_TOML = """
segments = [
  { length = "700 mm", tip_diameter = "12 mm", butt_diameter = "21 mm", kappa = 0.9, material = MAPLE },
]
body_mass = "420 g"
""".replace("MAPLE", f'{{ E = "12.6 GPa", G = "840 MPa", rho = "{MAPLE.rho!r} kg/m^3" }}')
SCENE_TOML = """
cue = "cues/kim.toml"
ball = { mass = "6 oz", radius = "1.125 in" }
tip = { restitution = 0.75, friction = inf, contact_time = "1.2 ms" }
stroke = { speed = "10 km/h", offset = 0.3 }
effects = [{ type = "PointMass", position = "1 in", mass = "5 g" }]
accuracy = { rtol = 1e-4 }
"""


def test_load_scene_resolves_relative_path_of_cue(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "cues").mkdir()
    (tmp_path / "cues" / "kim.toml").write_text(KIM_TOML)
    (tmp_path / "scene.toml").write_text(SCENE_TOML)
    ball, tip = cf.Ball(0.17009713875, 0.028575), cf.Tip(friction=math.inf, contact_time=0.0012)
    stroke = cf.Stroke(float("2.777777777777777777777777778"), 0.3)
    monkeypatch.chdir(tmp_path / "cues")
    assert cf.load("../scene.toml") == cf.Scene(KIM, ball, tip, stroke, (cf.PointMass(position=0.0254, mass=0.005),))
    assert (load_accuracy("../scene.toml"), load_accuracy("kim.toml")) == (1e-4, None)


PROFILE = "# a shaft\nx [mm],diameter [in]\n10,0.5\n110,0.5\n210,0.5\n\n310,0.6\n410,0.7\n710,0.8\n"


def test_load_profile_merges_straight_tapers(tmp_path: Path) -> None:
    (tmp_path / "shaft.csv").write_text(PROFILE)
    cue = cf.load(tmp_path / "shaft.csv")
    ash = cf.load(tmp_path / "shaft.csv", material="ash")
    assert [s.length for s in cue.segments] == pytest.approx([0.2, 0.2, 0.3], rel=1e-15, abs=0)
    ends = [(s.tip_diameter, s.butt_diameter) for s in cue.segments]
    assert ends == [(0.0127, 0.0127), (0.0127, 0.01778), (0.01778, 0.02032)]
    assert cue.body_mass == 0
    assert ash.segments[0].material != cue.segments[0].material
    assert replace(ash.segments[1], material=cue.segments[1].material) == cue.segments[1]


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_save_over_file_replaces_it(tmp_path: Path) -> None:
    path = tmp_path / "cue.toml"
    path.write_text("before")
    cf.save(cf.Cue((SEGMENT, SEGMENT)), path)
    assert cf.load(path).length == 1.4
    assert list(tmp_path.iterdir()) == [path]


def test_save_failure_leaves_no_file(tmp_path: Path) -> None:
    folder = tmp_path / "cue.toml"
    folder.mkdir()
    with pytest.raises(InputError, match=r"cue\.toml: cannot be written: Is a directory"):
        cf.save(KIM, folder)
    assert list(tmp_path.iterdir()) == [folder]


def test_stored_meshes_equal_their_toml(tmp_path: Path) -> None:
    folder = Path(__file__).parents[2] / "meshes"
    cues = sorted(folder.glob("*.toml"))
    assert cues
    for path in cues:  # where this fails: cuefem convert meshes/NAME.toml meshes/NAME.vtu --force
        cf.save(cf.load(path), tmp_path / "made.vtu")
        saved, stored = (meshio.vtu.read(mesh) for mesh in (tmp_path / "made.vtu", path.with_suffix(".vtu")))
        assert saved.points.tolist() == stored.points.tolist()
        assert {name: value[0].tolist() for name, value in saved.cell_data.items()} == {
            name: value[0].tolist() for name, value in stored.cell_data.items()
        }
