"""Differences between two designs of a study, with the uncertainty that does not cancel, by the rule of `compare`."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

from cuefem.designs.evaluation import Response
from cuefem.designs.study import Study, StudyDesign
from cuefem.parameters.parts import main_material
from cuefem.parameters.table import PARAMETERS
from cuefem.results.differences import is_shared, relative_differences
from cuefem.results.records import Record
from cuefem.results.uncertainty import changes_by_input, model_error
from cuefem.scene import Scene

DRAWN = ("bore_width",)  # uncertain in a cue that exists; a study draws it


class DesignResults(NamedTuple):
    """A design, its responses, and their relative changes by uncertain input."""

    scene: Scene
    numbers: Mapping[str, float]
    inputs: Mapping[str, Mapping[str, float]]


def design_differences(
    study: Study, designs: Sequence[StudyDesign], *, with_shared: bool = True
) -> list[dict[str, Record]]:
    """Differences of each design from the one before, for each response of the study that both have, as of
    `relative_differences`.

    Two designs of one wood are one shaft before and after a change. The dimensions of a shaft are as drawn, and not
    uncertain (`DRAWN`). with_shared: also computes what remains of an error that both designs share, which costs some
    twenty designs and is a small part of neighbours' difference.
    """
    modelled = {response.name for response in study.responses if response.result.has_model_error}
    changes: list[dict[str, Mapping[str, float]]] = [{} for _ in designs]  # of each design, computed so far
    records = []
    for i, pair in enumerate(pairwise(designs)):
        woods = {main_material(design.scene.shaft).E for design in pair if design.scene.cue.segments}
        same_shaft = len(woods) < 2
        inputs = [
            key
            for key in PARAMETERS
            if key not in DRAWN
            if with_shared or not is_shared(key, *(design.scene for design in pair), same_shaft=same_shaft)
        ]
        for design, known in zip(pair, changes[i : i + 2], strict=True):
            known |= _changes(study, design, [key for key in inputs if key not in known])
        first, other = (
            DesignResults(design.scene, design.responses, {key: known[key] for key in inputs})
            for design, known in zip(pair, changes[i : i + 2], strict=True)
        )
        records.append(relative_differences(first, other, same_shaft=same_shaft, with_model_error=modelled))
    return records


def squirt_error(study: Study, design: StudyDesign, response: Response) -> float:
    """Uncertainty (1 sigma) of a design's squirt, rad: of the model, and of inputs that a study does not draw."""
    if study.squirt_factor != 1.0:
        return math.nan  # a calibration has its own
    squirt = design.responses[response.name]
    alone = replace(study, responses=(response,)), replace(design, responses={response.name: squirt})
    changes = _changes(*alone, [key for key in PARAMETERS if key not in DRAWN])
    inputs = (each.get(response.name, 0.0) for each in changes.values())
    return abs(squirt) * math.hypot(model_error(design.scene), *inputs)


def _changes(study: Study, design: StudyDesign, inputs: Sequence[str]) -> dict[str, Mapping[str, float]]:
    """Changes of a design's responses by inputs, none by an input that it does not have."""
    names = [response.name for response in study.responses]

    def numbers(scene: Scene) -> dict[str, float]:
        found = study.evaluate_scenes([scene]).values[0]
        return dict(zip(names, found.tolist(), strict=True))

    known = {name: value for name, value in design.responses.items() if value and not math.isnan(value)}
    found: dict[str, Mapping[str, float]] = {key: {} for key in inputs}
    return found | changes_by_input(design.scene, known, numbers, inputs).relative
