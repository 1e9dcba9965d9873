"""A question and effects appear in all outputs by their file or class alone (properties)."""

import gc
import html
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import pytest

import cuefem as cf
from cuefem.analysis import QUESTIONS, Question
from cuefem.analysis.effect_sensitivity import variants
from cuefem.designer.panels import sections_markup
from cuefem.designer.session import Session
from cuefem.designer.state import Design
from cuefem.designs import Levels, Response, Study, Vary
from cuefem.effects.contact_terms import ContactTerms
from cuefem.effects.effect import Effect, TipEffect, effect_kinds
from cuefem.parameters.scene_changes import with_parameters
from cuefem.quantity.fields import Quantity
from tests.helpers.command_line import as_json, stdout_of
from tests.helpers.contributors_guide import module_of
from tests.helpers.strike_scenes import kim_scene

AT = cf.Resolution(2, 8, 12)


@pytest.fixture
def _effects_deleted() -> Iterator[None]:
    """Deletes effects defined by a test, because files and tables list every effect class."""
    yield
    modules = [module for name, module in sys.modules.items() if name.startswith("cuefem.")]
    for cached in [one for module in modules for one in vars(module).values() if hasattr(one, "cache_clear")]:
        cached.cache_clear()
    gc.collect()


def test_added_question_is_command_section_and_call(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A file and its line in `QUESTIONS`: help, command, report in terminal, JSON, page and designer, and notebook."""
    guide = module_of("A question about a scene", monkeypatch)
    weigh = Question("Weight", f"{guide.__name__}:weight", help="Weight of a cue.")
    monkeypatch.setitem(QUESTIONS, "weight", weigh)
    scene = cf.Scene(cf.LumpedCue(0.54, 0.006))
    cf.save(scene, tmp_path / "scene.toml")
    newtons = 9.81 * scene.cue.mass
    assert "  weight    Weight of a cue.\n" in stdout_of("--help")
    assert "\n  Weigh a cue.\n\n" in stdout_of("weight", "--help")
    assert as_json("weight", tmp_path / "scene.toml")["weight"] == pytest.approx(newtons, rel=1e-12)
    answer: Any = cf.weight  # type: ignore[attr-defined]
    assert f"<td>{newtons:.3f}\xa0N</td>" in html.unescape(answer(scene)._repr_html_())
    (tmp_path / "cue.csv").write_text("position (mm);diameter (mm)\n0;12\n700;20\n", encoding="utf-8")
    weighed, modes = (as_json(name, tmp_path / "cue.csv") for name in ("weight", "modes"))
    assert weighed["assumptions"] == modes["assumptions"]  # none of a stroke, which matters to neither
    report = cf.report(scene, details=True)
    assert report.to_dict()["weight"] == {"weight": newtons}
    assert "Weight of the cue" in str(report)
    too_soft = replace(
        kim_scene(0.3), tip=cf.Tip(), stroke=cf.Stroke(14.0), effects=(cf.LeatherTip(6e-3, 9.5e-3, 3e6),)
    )
    assert [*cf.report(too_soft).sections] == ["modes", "weight"]  # no contact
    session = Session(Design("this", kim_scene(0.3)))
    session.results.own["answers"] = report
    for page in (report.to_html(), sections_markup(session)):
        assert "<h2>Weight</h2>" in page
        assert f"<td>{newtons:.3f}\xa0N</td>" in page


@pytest.mark.usefixtures("_effects_deleted")
def test_added_cue_effect_is_displayed_saved_and_varied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The class of CONTRIBUTING.md alone."""
    kind: Any = module_of("An effect", monkeypatch).Collar
    bare = kim_scene(0.3)
    scene = replace(bare, effects=(kind(0.03, 4e-3),))
    assert effect_kinds()["Collar"] is kind
    cf.save(scene, tmp_path / "scene.toml")
    assert "Collar (position 30 mm, mass 4 g)" in " ".join(stdout_of("strike", tmp_path / "scene.toml").split())
    assert 'type = "Collar"' in (tmp_path / "scene.toml").read_text(encoding="utf-8")
    assert cf.load(tmp_path / "scene.toml").effects == scene.effects
    as_mass = replace(bare, effects=(cf.PointMass(position=0.03, mass=4e-3),))
    assert cf.strike(scene, AT).squirt == cf.strike(as_mass, AT).squirt > 1.01 * cf.strike(bare, AT).squirt
    assert cf.cue_numbers(scene).values() == cf.cue_numbers(as_mass).values()
    (added,) = (one for one in variants(bare) if one.name == "Collar")
    assert (added.is_listed, added.scene) == (False, scene)
    study = Study(scene, (Vary(("effects[0].mass",), Levels((0.0, 4e-3))),), (Response.of("squirt"),))
    assert (study.scene((4e-3,)), study.units[0]) == (scene, "kg")
    assert with_parameters(scene, {"effects[0].mass": 5e-3}).effects == (kind(0.03, 5e-3),)


@pytest.mark.usefixtures("_effects_deleted")
def test_added_tip_effect_acts_in_contact() -> None:
    """One that adds what `TipDome` adds strikes as it does; a raised cue takes no compliance of its own."""

    @dataclass(frozen=True)
    class Cap(TipEffect):
        """A round cap of a radius, m, on the tip."""

        radius: Annotated[float, Quantity("m")]
        compliance: float = 0.0

        def add_to_contact(self, terms: ContactTerms) -> None:
            terms.add_dome(self.radius)
            terms.add_compliance(self.compliance)

    def struck(*effects: Effect) -> cf.Outcome:
        return cf.strike(replace(kim_scene(0.4), effects=effects), AT)

    assert struck(Cap(0.007)).squirt == struck(cf.TipDome(0.007)).squirt != struck().squirt
    with pytest.raises(ValueError, match="takes a tip without tangential compliance, a fixed normal"):
        struck(Cap(0.0, compliance=1.0), cf.Elevation(0.1))
