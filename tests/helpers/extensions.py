"""A parameter, results, an end-mass definition and effects, registered by their entry or class alone; no tests."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np

import cuefem as cf
from cuefem.designer.computation import numbers
from cuefem.designer.panels import tables_markup, tabulate_numbers
from cuefem.designer.session import Session
from cuefem.designer.state import Design
from cuefem.effects.contact_terms import ContactTerms
from cuefem.effects.effect import TipEffect
from cuefem.endmass.definitions import Definition
from cuefem.parameters.parameter import Parameter
from cuefem.parameters.parts import Part
from cuefem.quantity.fields import LENGTH, Quantity
from cuefem.results.quantities import Result, of_drawing, of_strike
from tests.helpers.command_line import call


def outputs(scene: cf.Scene, folder: Path, *names: str) -> dict[str, str]:
    """The text of a scene in these outputs: commands, the JSON of the report, the designer."""
    file = folder / "scene.toml"
    cf.save(scene, file)

    def text_of(name: str) -> str:
        if name == "json":
            return call("report", file, "--json")[1]
        if name == "designer":
            session = Session(Design("this", scene))
            session.results.own["numbers"] = numbers.__wrapped__(scene)
            return tables_markup([tabulate_numbers(session)])
        return call(name, file)[1]

    return {name: " ".join(re.sub("<[^>]*>", "", text_of(name)).split()) for name in names}


def outputs_without(phrase: str, texts: dict[str, str]) -> list[str]:
    """The outputs that do not contain the phrase."""
    return [name for name, text in texts.items() if phrase not in text]


def _length(scene: Any) -> float | None:
    return scene.shaft.segments[1].length if len(scene.shaft.segments) > 2 else None


def _with_length(scene: Any, value: float) -> Any:
    front, collar, behind = scene.shaft.segments
    rest = replace(behind, length=behind.length - (value - collar.length))
    return replace(scene, cue=replace(scene.shaft, segments=(front, replace(collar, length=value), rest)))


PARAMETER = Parameter(
    *("collar length", "length of the collar"), part=Part(_length, _with_length, LENGTH), spread=0.1, option="LENGTH"
)
DRAWING_RESULT = Result(
    *("sweet spot, from the tip", "m", 2),
    heading="sweet spot",
    of=of_drawing(lambda scene: scene.shaft.length / 5),
    better="higher",
)
STRIKE_RESULT = Result("push", "m/s", 3, of=of_strike(lambda outcome: 2 * outcome.ball_speed), argument="offset")
DEFINITION = Definition(
    *("rigid", "rigid body", "the inertia of the tip as a rigid body, plus one gram"),
    lambda tip, _: 1e-3 + 1 / float(np.sum(tip.amplitude[tip.omega == 0, 1] ** 2)),
    True,
)


def cap_effect() -> type[TipEffect]:
    """The class of an effect at the tip."""

    @dataclass(frozen=True)
    class Cap(TipEffect):
        """A round cap on the tip, of ``radius``, m."""

        radius: Annotated[float, Quantity("m")]
        compliance: float = 0.0

        def add_to_contact(self, terms: ContactTerms) -> None:
            """A dome, and a tangential compliance relative to the normal one."""
            terms.add_dome(self.radius)
            if self.compliance:
                terms.add_compliance(self.compliance)

    return Cap
