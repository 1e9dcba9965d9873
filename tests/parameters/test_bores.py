"""Bores wherever they start: what the parameters read, and what a change drills."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given

import cuefem as cf
from cuefem.analysis.shop_changes import changes_of
from cuefem.parameters.parts import bore_mouth
from cuefem.parameters.scene_changes import with_parameters
from cuefem.parameters.table import PARAMETERS
from tests.helpers.bored_cues import bored_cues
from tests.helpers.examples import examples

HEAD = "x [mm];diameter [mm];bore [mm];material\n"
# Rows, and where the bore begins, its depth and its width, mm.
DRAWINGS = {
    "from the front": ("0;12,4;7\n200;12,6;\n730;21;\n", (0, 200, 7)),
    "behind a plug of 3 mm": ("0;12,4;\n3;12,4;7\n203;12,6;\n730;21;\n", (3, 200, 7)),
    "behind a plug of 6 mm": ("0;12,4;\n6;12,4;7\n206;12,6;\n730;21;\n", (6, 200, 7)),
    "behind a plug of 100 mm": ("0;12,4;\n100;12,4;7\n206;12,6;\n730;21;\n", (100, 106, 7)),
    "stepped": ("0;12,4;\n25;12,4;8\n75;12,5;8\n75;12,5;6\n200;12,6;\n730;21;\n", (25, 175, 8)),
    "two bores": ("0;12,4;\n6;12,4;7\n100;12,5;\n120;12,5;9\n200;12,6;\n730;21;\n", (6, 94, 7)),
    "in a ferrule": ("0;12,4;;melamine\n6;12,4;7;\n25;12,4;7;hard maple\n200;12,6;\n730;21;\n", (6, 194, 7)),
    "at the joint alone": ("0;12,4;\n200;12,6;\n680;20;8\n730;21;\n", (0, 0, 6)),
}


def drawn(folder: Path, text: str) -> cf.Scene:
    path = folder / "shaft.csv"
    path.write_text(text)
    return cf.Scene(cf.load(path, body_mass="15 oz"), stroke=cf.Stroke(2.0, 0.3))


@pytest.mark.parametrize("name", DRAWINGS)
def test_bore_parameters_read_it_where_it_starts(name: str, tmp_path: Path) -> None:
    rows, expected = DRAWINGS[name]
    scene = drawn(tmp_path, HEAD + rows)
    sizes = bore_mouth(scene.cue), PARAMETERS["bore_depth"].value(scene), PARAMETERS["bore_width"].value(scene)
    assert sizes == pytest.approx([1e-3 * size for size in expected], rel=1e-12)


def test_bore_change_behind_a_plug_widens_it(tmp_path: Path) -> None:
    """It removes the annulus from 7 to 8 mm, as long as the bore, and nothing else."""
    scene = drawn(tmp_path, HEAD + DRAWINGS["behind a plug of 6 mm"][0])
    labels = [change.label for change in changes_of(scene) if change.label.startswith("bore")]
    assert labels == ["bore wider, 7 → 8 mm", "bore deeper, 200 → 225 mm"]
    wider = with_parameters(scene, {"bore width": 0.008})
    annulus = scene.cue.segments[0].material.rho * 0.2 * np.pi / 4 * (0.008**2 - 0.007**2)
    assert scene.cue.mass - wider.cue.mass == pytest.approx(annulus, rel=1e-9)


def bore_at(cue: cf.Cue, x: float) -> float:
    """The width of what is hollow at x."""
    i = int(np.searchsorted(cue.nodes, x)) - 1
    segment = cue.segments[i]
    share = (x - cue.nodes[i]) / segment.length
    return 0.0 if segment.core else segment.tip_bore + (segment.butt_bore - segment.tip_bore) * share


@examples(12)
@given(bored_cues())
def test_design_changes_of_bores_and_tapers_remove_wood(cue: cf.Cue) -> None:
    """No change whose name says that wood goes adds any, wherever the bores are."""
    scene = cf.Scene(cue, stroke=cf.Stroke(2.0, 0.3))
    middles = [(a + b) / 2 for a, b in pairwise(cue.nodes)]
    for change in changes_of(scene):
        if not change.label.startswith(("bore", "0.5 mm thinner")):
            continue
        try:
            changed = with_parameters(scene, change.values).cue
        except ValueError:
            continue  # the drawing does not allow it
        assert changed.mass < cue.mass, change.label
        if change.label.startswith("bore"):
            assert all(bore_at(changed, x) >= bore_at(cue, x) * (1 - 1e-12) for x in middles), change.label
