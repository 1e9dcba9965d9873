"""Differences between two designs of a study, with the uncertainty that does not cancel, by the rule of `compare`."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from cuefem.designs.evaluation import evaluate
from cuefem.designs.study import Study, StudyDesign
from cuefem.parameters.parts import main_material
from cuefem.parameters.table import PARAMETERS
from cuefem.results.differences import is_shared, relative_differences
from cuefem.results.records import Record
from cuefem.results.uncertainty import changes_by_input
from cuefem.scene import Scene

DRAWN = ("bore_width",)  # uncertain in a cue that exists; a study draws it


class DesignResults(NamedTuple):
    """A design, its responses, and their relative changes by uncertain input."""

    scene: Scene
    numbers: Mapping[str, float]
    inputs: Mapping[str, Mapping[str, float]]


def design_differences(
    study: Study, first: StudyDesign, other: StudyDesign, *, with_shared: bool = True
) -> dict[str, Record]:
    """For each response of the study that both designs have, as of `relative_differences`.

    Two designs of one wood are one shaft before and after a change. The dimensions of a shaft are as drawn, and not
    uncertain (`DRAWN`). with_shared: also computes what remains of an error that both designs share, which costs some
    twenty designs and is a small part of neighbours' difference.
    """
    scenes = first.scene, other.scene
    woods = {main_material(scene.shaft).E for scene in scenes if scene.cue.segments}
    same_shaft = len(woods) < 2
    inputs = [
        key
        for key in PARAMETERS
        if key not in DRAWN
        if with_shared or not is_shared(key, *scenes, same_shaft=same_shaft)
    ]
    pair = [_with_inputs(study, design, inputs) for design in (first, other)]
    modelled = {response.name for response in study.responses if response.result.has_model_error}
    return relative_differences(*pair, same_shaft=same_shaft, with_model_error=modelled)


def _with_inputs(study: Study, design: StudyDesign, inputs: Sequence[str]) -> DesignResults:
    """A design with the changes of its responses by some inputs."""
    names = [response.name for response in study.responses]

    def numbers(scene: Scene) -> dict[str, float]:
        found = evaluate([scene], study.responses, at=study.at).values[0]
        return dict(zip(names, found.tolist(), strict=True))

    own = {name: design.responses[name] for name in names}
    known = {name: value for name, value in own.items() if value and not math.isnan(value)}
    changes = changes_by_input(design.scene, known, numbers, inputs)
    return DesignResults(design.scene, own, changes.relative)
