"""What the optimum refuses, in one line (bad input)."""

from __future__ import annotations

import sys
from dataclasses import replace

import pytest

from cuefem import LumpedCue, PointMass, Resolution, Scene, Tip
from cuefem.design.optimum import Design, Limit, Variable, front, least_squirt
from tests.helpers.cues import kim, low_deflection

SCENE = Scene(low_deflection(), tip=Tip(contact_time=1e-3))
BORE = Variable("bore", 0.002, 0.010, 0.008, {(i, f"{end}_bore"): 1.0 for i in (1, 2) for end in ("tip", "butt")})
DESIGN = Design(SCENE, (BORE,), (Limit("wall", low=0.0015),), Resolution(1, 6, 8))


def test_bad_input() -> None:
    with pytest.raises(ValueError, match="'bore' must have low < high"):
        replace(BORE, low=0.02)
    with pytest.raises(ValueError, match=r"fields among length, .*; got 'rho'"):
        Variable("density", 1.0, 2.0, 1.0, {(0, "rho"): 1.0})
    with pytest.raises(ValueError, match=r"Limit\.quantity must be one of .*; got 'colour'"):
        Limit("colour", low=1.0)
    with pytest.raises(ValueError, match="one finite"):
        Limit("mass")
    with pytest.raises(ValueError, match="segments 0 to 0; got 1"):
        Design(Scene(kim()), (BORE,))
    with pytest.raises(ValueError, match="at least one Variable"):
        Design(SCENE, ())
    with pytest.raises(ValueError, match="without effects"):
        Design(replace(SCENE, effects=(PointMass(0.1, 1e-3),)), (BORE,))
    with pytest.raises(TypeError, match=r"Design\.scene\.cue"):
        Design(Scene(LumpedCue(0.5, 0.01)), (BORE,))
    with pytest.raises(ValueError, match="no design within tip_stiffness >= 1000"):
        least_squirt(replace(DESIGN, limits=(Limit("tip_stiffness", low=1e3),)), iterations=8)
    with pytest.raises(ValueError, match="front against"):
        front(DESIGN, "squirt")


def test_a_front_without_its_library(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "pymoo"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "pymoo", None)
    with pytest.raises(ModuleNotFoundError) as refused:
        front(DESIGN, "tip_stiffness")
    assert str(refused.value) == "front needs pymoo: pip install '.[optimize]' in the clone"
