"""A definition of the end mass that is added to the table alone is found by every command and page (properties)."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.design.evaluation import evaluate
from cuefem.design.responses import Response
from cuefem.designer.answers import answers, completed
from cuefem.designer.design import Design
from cuefem.designer.numbers_panel import Column, rows, table_markup
from cuefem.endmass.drives import DEFINITIONS, Definition, end_mass_spreads, flexible
from cuefem.report.report_page import page
from tests.helpers.command_line import call
from tests.helpers.strike_scenes import kim_scene

AT = cf.Resolution(2, 8, 12)
MEANING = "the inertia that the tip has as a rigid body, plus one gram"


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> Definition:
    rigid = Definition(
        "rigid", "rigid body", MEANING, "1/sum of the rigid phi^2", lambda tip, _: 1e-3 + 1 / flexible(tip)[2], True
    )
    monkeypatch.setitem(DEFINITIONS, rigid.name, rigid)
    return rigid


@pytest.fixture
def file(tmp_path: Path) -> Path:
    cf.save(kim_scene(0.3), tmp_path / "scene.toml")
    return tmp_path / "scene.toml"


def test_the_library_answers(made_up: Definition) -> None:
    scene = kim_scene(0.3)
    felt = cf.end_mass(scene, "rigid", AT)
    assert felt == pytest.approx(made_up.of(cf.tip_modes.Solved(scene, AT).tip, scene), rel=1e-12)
    assert end_mass_spreads(scene, AT)("rigid").end_mass == felt
    assert cf.resolve_end_mass(scene, "rigid", 1e-3)[0] == pytest.approx(felt, rel=1e-6)
    assert cf.end_mass(cf.Scene(cf.LumpedCue(0.5, 0.006)), "rigid") == 0.006


def test_every_command_tells_it(made_up: Definition, file: Path) -> None:
    felt = cf.end_mass(kim_scene(0.3), "rigid")
    for command, key in (("end-mass", None), ("report", "end_masses")):
        found = json.loads(call(command, file, "--json")[1])
        drives = (found if key is None else found[key])["drives"]
        assert drives["rigid"]["end_mass"] == pytest.approx(felt, rel=1e-12)
    assert "rigid, at b/R 0.3" in call("end-mass", file)[1]


def test_the_table_says_whether_the_tip_counts_in_it(
    made_up: Definition, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cf.save(replace(kim_scene(0.3), effects=(cf.TipDome(9e-3),)), tmp_path / "domed.toml")
    counts = "count effects at the tip as end mass;"
    told = " ".join(call("end-mass", tmp_path / "domed.toml")[1].split())
    assert f"stick, offset and squirt {counts} velocity, force and rigid do not" in told
    monkeypatch.setitem(DEFINITIONS, "rigid", made_up._replace(counts_tip=True))
    told = " ".join(call("end-mass", tmp_path / "domed.toml")[1].split())
    assert f"stick, offset, squirt and rigid {counts} velocity and force do not" in told


@pytest.mark.parametrize("command", ["end-mass", "strike"])
def test_help_explains_it(made_up: Definition, command: str) -> None:
    told = " ".join(call(command, "--help")[1].split())
    assert MEANING in told
    assert all(one.meaning in told for one in DEFINITIONS.values())


def test_both_pages_show_it(made_up: Definition) -> None:
    scene = kim_scene(0.3)
    shown = page("a cue", scene)
    assert "rigid body at b/R 0.3" in shown
    assert MEANING in shown
    found = completed(answers(scene))
    assert "end_mass_rigid" in {row.name for row in rows(found)}
    table = table_markup([Column(Design.of("a cue", scene), found)], 0)
    assert "end mass me, rigid body at b/R 0.3" in re.sub("<[^>]*>", "", table)  # words there are buttons


def test_a_sweep_can_ask_for_it(made_up: Definition) -> None:
    scene = kim_scene(0.3)
    found = evaluate([scene], ["end_mass_rigid", "end_mass_rigid(0.1)"], at=AT).values[0]
    assert found == pytest.approx([cf.end_mass(scene, "rigid", AT)] * 2, rel=1e-9)
    with pytest.raises(ValueError, match=r"end_mass_rigid\[\(offset\)\]"):
        Response.of("end_mass_rigit")
