"""Any field of a scene changed: segments, materials, ball, tip, stroke and effects, and what is added or taken away."""

from __future__ import annotations

from dataclasses import MISSING, fields, replace
from typing import Any, NamedTuple

from cuefem.cue import Cue, Material, Segment
from cuefem.designer.model import cue_of
from cuefem.effects import Effect, effect_kinds
from cuefem.games import GAMES, usual_scene, without_leather
from cuefem.quantity import quantities
from cuefem.scene import Scene

Path = tuple[str | int, ...]  # such as ("segments", 0, "length") or ("ball", "mass")

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
    found = []
    for name, mark, *_ in quantities(type(thing)):  # type: ignore[arg-type]
        label = LABELS.get(name, name.replace("_", " "))
        found.append(Field((*path, name), label, mark.unit, getattr(thing, name)))
    return found


def materials_in(cue: Cue) -> tuple[Material, ...]:
    """The materials of a cue, each once, from tip to butt."""
    found = [m for segment in cue.segments for m in (segment.material, segment.core) if m is not None]
    return tuple(dict.fromkeys(found))


def got(scene: Scene, path: Path) -> Any:
    """What is at a place of a scene."""
    head, *rest = path
    if head == "segments":
        found: Any = cue_of(scene).segments[rest.pop(0)]  # type: ignore[index]
    elif head == "materials":
        found = materials_in(cue_of(scene))[rest.pop(0)]  # type: ignore[index]
    elif head == "effects":
        found = scene.effects[rest.pop(0)]  # type: ignore[index]
    else:
        found = getattr(scene, str(head))
    for name in rest:
        found = getattr(found, str(name))
    return found


def put(scene: Scene, path: Path, value: Any) -> Scene:
    """The scene with another value at a place; ValueError if no such scene can be made."""
    head, *rest = path
    cue = cue_of(scene)
    if head == "segments":
        i, name = rest
        changed: dict[str, Any] = {str(name): value}
        return replace(scene, cue=_with_segment(cue, int(i), replace(cue.segments[int(i)], **changed)))
    if head == "materials":
        i, name = rest
        old = materials_in(cue)[int(i)]
        return replace(scene, cue=_with_material(cue, old, replace(old, **{str(name): value})))
    if head == "effects":
        i, name = rest
        effects = list(scene.effects)
        effects[int(i)] = replace(effects[int(i)], **{str(name): value})
        return replace(scene, effects=tuple(effects))
    changes = {str(rest[0]): value}
    if head == "tip" and rest[0] in _EITHER and value is not None:
        changes |= {other: None for other in _EITHER if other != rest[0]}
    return replace(scene, **{str(head): replace(getattr(scene, str(head)), **changes)})


_EITHER = ("contact_time", "stiffness")  # of a spring as tip: one of them


def _with_segment(cue: Cue, i: int, segment: Segment) -> Cue:
    return replace(cue, segments=(*cue.segments[:i], segment, *cue.segments[i + 1 :]))


def _with_material(cue: Cue, old: Material, new: Material) -> Cue:
    def made(segment: Segment) -> Segment:
        return replace(
            segment,
            material=new if segment.material == old else segment.material,
            core=new if segment.core == old else segment.core,
        )

    return replace(cue, segments=tuple(map(made, cue.segments)))


def split(scene: Scene, i: int) -> Scene:
    """The scene with a segment cut in two halves of the same cone."""
    cue = cue_of(scene)
    s = cue.segments[i]
    middle = (s.tip_diameter + s.butt_diameter) / 2, (s.tip_bore + s.butt_bore) / 2
    front = replace(s, length=s.length / 2, butt_diameter=middle[0], butt_bore=middle[1])
    back = replace(s, length=s.length - front.length, tip_diameter=middle[0], tip_bore=middle[1])
    return replace(scene, cue=replace(cue, segments=(*cue.segments[:i], front, back, *cue.segments[i + 1 :])))


def added(scene: Scene, i: int) -> Scene:
    """The scene with a new segment behind a segment: 50 mm of its material, as thick as its end."""
    cue = cue_of(scene)
    s = cue.segments[i]
    new = replace(s, length=0.05, tip_diameter=s.butt_diameter, tip_bore=s.butt_bore)
    return replace(scene, cue=replace(cue, segments=(*cue.segments[: i + 1], new, *cue.segments[i + 1 :])))


def removed(scene: Scene, i: int) -> Scene:
    """The scene without a segment."""
    cue = cue_of(scene)
    if len(cue.segments) == 1:
        raise ValueError("a cue needs a segment: this is the last one")
    return replace(scene, cue=replace(cue, segments=(*cue.segments[:i], *cue.segments[i + 1 :])))


def new_effect(scene: Scene, name: str) -> Effect:
    """An effect of this kind at its usual values, or where it has none at plain ones to begin with."""
    kind = effect_kinds()[name]
    values: dict[str, Any] = dict(kind.usual.values) if kind.usual else {}
    needed = [f.name for f in fields(kind) if f.default is MISSING and f.name not in values]
    values |= {name: _STARTS.get(name, 0.5 * cue_of(scene).length) for name in needed}
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
    cue = cue_of(scene)
    usual = usual_scene(cue, game)
    kept = tuple(effect for effect in scene.effects if not effect.at_tip)
    return replace(usual, cue=without_leather(cue), effects=(*usual.effects, *kept))


def game_of(scene: Scene) -> str | None:
    """The game whose ball this is."""
    return next((name for name, game in GAMES.items() if game.ball == scene.ball), None)
