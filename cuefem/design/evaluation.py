"""Designs in, numbers out: responses of many scenes, each failing on its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cuefem.beam.waves import even_mesh_for, modes_below
from cuefem.cue import Array
from cuefem.design.batch import BLOCK
from cuefem.design.responses import Response
from cuefem.design.solvers import OneByOne, Together, key_of
from cuefem.results.solved_design import Designs
from cuefem.scene import Resolution, Scene
from cuefem.tip_modes import PERIODS_KEPT

# A design may fail because it cannot be made, has no answer, or its numbers overflow.
Failed = (ValueError, RuntimeError, ArithmeticError, np.linalg.LinAlgError)


@dataclass(frozen=True)
class Evaluation:
    """Responses of designs: values (designs, responses) in SI units, nan if a response has no value; reasons, why a
    design lacks a value, None if it has all.
    """

    values: Array
    reasons: tuple[str | None, ...]


def evaluate(
    scenes: Sequence[Scene], responses: Sequence[Response | str], *, at: Resolution | None = None
) -> Evaluation:
    """The responses of every scene.

    Bare cues with the same number of segments are computed as arrays, in blocks; scenes with effects, and lumped cues,
    one by one, where the modes of equal cues with equal effects are solved once. ``at`` is one resolution for all; by
    default it is `common_resolution`, which is coarser than the default of `cuefem.end_mass`: stick end masses differ
    from that by up to 2 %. A response that a scene has not gets a reason and disturbs neither the scene's other
    responses nor other scenes. ValueError if no response has one of the names.
    """
    asked = tuple(Response.of(response) if isinstance(response, str) else response for response in responses)
    at = at or common_resolution(scenes, asked)
    values, reasons = np.full((len(scenes), len(asked)), np.nan), dict[int, str]()
    waiting = _blocks(scenes)
    while waiting:
        rows = waiting.pop()
        try:
            values[rows], why = _values([scenes[i] for i in rows], asked, at)
            reasons |= {i: reason for i, reason in zip(rows, why, strict=True) if reason}
        except Failed as error:
            if len(rows) == 1:
                reasons[rows[0]] = " ".join(str(error).split())
            else:  # one by one they show which it was
                waiting += [[i] for i in rows]
    return Evaluation(values, tuple(reasons.get(i) for i in range(len(scenes))))


def _blocks(scenes: Sequence[Scene]) -> list[list[int]]:
    """Indices of scenes to compute together, in blocks.

    Bare cues go by their number of segments; with effects on them, those whose modes are the same; lumped ones alone.
    """
    groups: dict[Any, list[int]] = {}
    for i, scene in enumerate(scenes):
        if scene.cue.segments:
            together: Any = key_of(scene, scene.cue, scene.cue_effects) if scene.effects else len(scene.cue.segments)
        else:
            together = -i
        groups.setdefault(together, []).append(i)
    return [rows[start : start + BLOCK] for rows in groups.values() for start in range(0, len(rows), BLOCK)]


def _values(scenes: Sequence[Scene], responses: Sequence[Response], at: Resolution) -> tuple[Array, list[str | None]]:
    """(responses (designs, responses) of scenes that can be computed together; for each design why one is missing).

    Of a single scene a response that fails leaves the others their values; of several it fails for all.
    """
    bare = scenes[0].cue.segments and not scenes[0].effects
    count = max([0, *(each.modes for each in responses)])
    solver: Designs = (Together if bare else OneByOne)(scenes, at, count)
    values, why = np.full((len(scenes), len(responses)), np.nan), list[str | None]([None] * len(scenes))
    for j, response in enumerate(responses):
        try:
            values[:, j], reasons = _column(solver, response)
        except Failed as error:
            if len(scenes) > 1:
                raise
            reasons = [" ".join(str(error).split())]
        why = [before or reason for before, reason in zip(why, reasons, strict=True)]
    return values, why


def _column(solver: Designs, response: Response) -> tuple[Array, list[str | None]]:
    """(A response of the solver's designs; for each why it is missing); ValueError if one is missing for no reason."""
    if response.result.segments and not solver.scenes[0].cue.segments:
        raise ValueError(f"{response.name} needs a cue of segments; got a lumped cue")
    values = response.values(solver)
    known = response.result.reasons
    every = known(solver) if known else [None] * len(values)
    reasons = [reason if x != x else None for x, reason in zip(values, every, strict=True)]
    if any(x != x and reason is None for x, reason in zip(values, reasons, strict=True)):
        raise ValueError(f"{response.name} is not a number")
    return values, [None if reason is None else f"{response.name}: {reason}" for reason in reasons]


def common_resolution(scenes: Sequence[Scene], responses: Sequence[Response]) -> Resolution:
    """One resolution for all scenes: the most modes that any needs, and a mesh that carries them.

    A strike keeps the modes up to `PERIODS_KEPT` periods a contact. `cuefem.end_mass` is finer: it keeps at least 160
    modes and lets a tail stand for those above. Designs compare well with each other, but their stick end masses are
    off by up to 2 %: on the reference cues 1.2 % at 2 ms (maple) and 1.8 % at 1.5 ms (carbon).
    """
    count = max([1, *(response.modes for response in responses)])
    strikes = any(response.result.strikes for response in responses)
    mesh, modes = (1, 1), 1
    for scene in scenes:
        if not scene.cue.segments:
            continue
        time = scene.known_contact_time if strikes else None
        if strikes and time is None:  # its contact fails by itself, with its reason, and stops no other design
            continue
        own = count if time is None else modes_below(scene.shaft, 2 * np.pi * PERIODS_KEPT / time)
        # a mesh of more elements follows shorter waves, and so does one of as many of a higher order
        mesh, modes = max(mesh, even_mesh_for(scene.shaft, max(own, count))), max(modes, own)
    return Resolution(*mesh, modes)
