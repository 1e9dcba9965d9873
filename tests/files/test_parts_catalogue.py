"""Parts catalogue: cues, options, files, command (regression)."""

import re
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cue.materials import LEATHERS, MATERIALS
from cuefem.files.parts_catalogue import CATALOGUE_SHAFTS
from tests.helpers.command_line import call

ROOT = Path(__file__).parents[2]
CONE = 'shaft = "conical taper"\nbody_mass = "15 oz"\n'


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "parts.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_cue_from_parts_equals_csv_with_options(tmp_path: Path) -> None:
    own = written(
        tmp_path, f'{CONE}material = "ash"\nferrule = "melamine ferrule 25 mm"\nbore = "6 mm wide, 127 mm deep"'
    )
    (tmp_path / "same.csv").write_text("x [mm],diameter [mm]\n0,12.75\n730.6,21.5\n", encoding="utf-8")
    options = {"material": "ash", "ferrule": "25 mm melamine", "bore": "6 mm wide, 127 mm deep"}
    parts, table = cf.load(own), cf.load(tmp_path / "same.csv", **options)
    assert parts.segments == table.segments
    assert parts.body_mass == pytest.approx(0.42524, rel=1e-4)
    assert parts.segments[0].core == MATERIALS["ash"].material


@pytest.mark.parametrize("name", CATALOGUE_SHAFTS)
def test_catalogue_shaft_strikes_and_documents_assumptions(name: str, tmp_path: Path) -> None:
    own = written(tmp_path, f'shaft = "{name}"\nbody_mass = "15 oz"')
    assert call("strike", own)[::2] == (0, "")
    assert 0.01 < cf.strike(cf.usual_scene(cf.load(own))).squirt < 0.05
    assert "assumed" in CATALOGUE_SHAFTS[name].source or "usual" in CATALOGUE_SHAFTS[name].source


def test_catalogue_shaft_from_drawing_has_no_leather(tmp_path: Path) -> None:
    ready = cf.load(ROOT / "meshes" / "pool_hollow.toml")
    assert cf.load(written(tmp_path, 'shaft = "Low Deflection"')).segments == ready.segments[1:]


def test_tip_by_name_in_option_and_file_agree(tmp_path: Path) -> None:
    own = written(tmp_path, CONE)
    results = [call("strike", own, "--leather", tip) for tip in ("Kamui Soft", "soft", "medium")]
    assert [status for status, *_ in results] == [0] * 3
    squirts = [re.findall(r"squirt .*", out) for _, out, _ in results]
    assert squirts[0] == squirts[1] != squirts[2]
    tip = '{ type = "LeatherTip", height = "6 mm", dome_radius = "dime", leather = "Kamui hard" }'
    scene = tmp_path / "scene.toml"
    scene.write_text(f'game = "pool"\ncue = "parts.toml"\neffects = [{tip}]\n', encoding="utf-8")
    assert cf.load(scene).effects[0].E == LEATHERS["hard"].E
