"""What the sheet of a scene shows and changes: the numbers of its parts, and segments and effects added or removed."""

from __future__ import annotations

from dataclasses import MISSING, fields, replace
from typing import Any, NamedTuple

from cuefem.effects import Effect, effect_kinds
from cuefem.parameters.parameter import Path
from cuefem.parameters.parts import halves, with_segments
from cuefem.quantity.fields import quantities
from cuefem.scene import Scene
from cuefem.scene.default_scene import GAMES, usual_scene, without_leather

LABELS = {
    "tip_diameter": "diameter, tip end",
    "butt_diameter": "diameter, butt end",
    "tip_bore": "bore, tip end",
    "butt_bore": "bore, butt end",
    "rho": "density",
    "loss": "loss factor",
    "E": "E",
    "G": "G",
    "kappa": "shear coefficient",
    "dome_radius": "radius of the dome",
    "nu": "Poisson's ratio",
}


class Field(NamedTuple):
    """A number that can be edited: where it is, its label, its SI unit, and its value (None: it has none)."""

    path: Path
    label: str
    unit: str
    value: float | None


def fields_of(thing: Any, path: Path) -> list[Field]:
    """The numbers of a dataclass."""
    return [
        Field((*path, name), LABELS.get(name, name.replace("_", " ")), mark.unit, getattr(thing, name))
        for name, mark, *_ in quantities(type(thing))  # type: ignore[arg-type]
    ]


def split(scene: Scene, i: int) -> Scene:
    """The scene with a segment cut in two halves of the same cone."""
    segments = scene.shaft.segments
    return with_segments(scene, (*segments[:i], *halves(segments[i], 0.5), *segments[i + 1 :]))


def added(scene: Scene, i: int) -> Scene:
    """The scene with a new segment behind a segment: 50 mm of its material, as thick as its end."""
    segments = scene.shaft.segments
    s = segments[i]
    new = replace(s, length=0.05, tip_diameter=s.butt_diameter, tip_bore=s.butt_bore)
    return with_segments(scene, (*segments[: i + 1], new, *segments[i + 1 :]))


def removed(scene: Scene, i: int) -> Scene:
    """The scene without a segment."""
    segments = scene.shaft.segments
    if len(segments) == 1:
        raise ValueError("a cue needs a segment: this is the last one")
    return with_segments(scene, (*segments[:i], *segments[i + 1 :]))


def new_effect(scene: Scene, name: str) -> Effect:
    """An effect of this kind at its usual values, or where it has none at plain ones to begin with."""
    kind = effect_kinds()[name]
    values: dict[str, Any] = dict(kind.usual.values) if kind.usual else {}
    needed = [f.name for f in fields(kind) if f.default is MISSING and f.name not in values]
    values |= {name: _STARTS.get(name, 0.5 * scene.shaft.length) for name in needed}
    return kind(**values)


_STARTS = {"mass": 0.005, "height": 0.006, "dome_radius": 0.0095, "E": 140e6, "position": 0.1, "stiffness": 5000.0}


def with_effect(scene: Scene, effect: Effect) -> Scene:
    """The scene with an effect more; ValueError if it does not go with the others."""
    return replace(scene, effects=(*scene.effects, effect))


def without_effect(scene: Scene, i: int) -> Scene:
    """The scene without an effect."""
    return replace(scene, effects=(*scene.effects[:i], *scene.effects[i + 1 :]))


def with_game(scene: Scene, game: str) -> Scene:
    """The scene with a game's ball, tip and stroke; what acts on the cue stays."""
    cue = scene.shaft
    usual = usual_scene(cue, game)
    brought = {type(effect) for effect in usual.effects}
    staying = tuple(effect for effect in scene.effects if not effect.at_tip and type(effect) not in brought)
    return replace(usual, cue=without_leather(cue), effects=(*usual.effects, *staying))


def game_of(scene: Scene) -> str | None:
    """The game whose ball this is."""
    return next((name for name, game in GAMES.items() if game.ball == scene.ball), None)
