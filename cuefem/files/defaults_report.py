"""Report of defaults: an `Assumption` for each value that a file lacks."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from cuefem.cue import Cue, Material
from cuefem.cue.materials import MATERIALS, material, table_name
from cuefem.files import load
from cuefem.files.cue_names import CUES, cue_name, named_path
from cuefem.files.lathe_profile import (
    DEFAULT_MATERIAL,
    DEFAULT_UNIT,
    SHAPE_EXTENSIONS,
    SURFACE_EXTENSIONS,
    names_units,
    read_profile,
)
from cuefem.files.shaft_additions import EXAMPLES, SHAFT_ADDITIONS, TENON_RATIO, example
from cuefem.files.surface_sections import TOLERANCE
from cuefem.files.toml_reader import missing_keys, read_tables
from cuefem.files.warnings_of_drawings import drawing_warnings
from cuefem.parameters.parts import Layout, is_wood_of, main_material
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import modulus_text, span_text, with_unit
from cuefem.scene import DEFAULT_CONTACT_TIME, Scene
from cuefem.scene.default_scene import DEFAULT_GAME, GAMES, without_leather

CUE, TIP, IMPACT, STROKE = "cue", "tip", "impact", "stroke"  # what an assumption is on
_OF = {
    **dict.fromkeys(("tip_height", "dome", "leather"), TIP),
    **dict.fromkeys(("contact_time", "restitution", "friction"), IMPACT),
    **dict.fromkeys(("ball_mass", "ball_diameter", "speed", "offset"), STROKE),
}
_OPTIONS = {"ball_mass": "game", "ball_diameter": "game"}  # of other keys: that of the same name
# Options of missing keys of a scene file; for other keys the name of the field.
_KEYS = {"ball.mass": ("ball_mass",), "ball.radius": ("ball_diameter",), "effects": ("tip_height", "dome", "leather")}
_ROUND_OFF = 1e-9  # of the widest diameter
_UNNAMED = Material(1e9, 1e9 / 15, 1000.0)  # placeholder for the material of a profile without one


@dataclass(frozen=True)
class Assumption:
    """A value that neither a file nor an option sets.

    key: the parameter or addition to a drawing that it concerns; "" for none. text: the value. option: the option that
    sets it. of: what it is on, "cue", "tip" (the leather), "impact" (of tip and ball) or "stroke" (with the ball).
    """

    key: str
    text: str
    option: str = ""
    of: str = CUE

    @classmethod
    def on(cls, key: str, text: str) -> Assumption:
        """The assumption on a parameter or an addition to a drawing."""
        return cls(key, text, _OPTIONS.get(key, key), _OF.get(key, CUE))

    def __str__(self) -> str:
        """The text, with the option."""
        shown = f' "{example(self.key)}"' if self.key in EXAMPLES["metric"] else ""
        return f"{self.text} (--{self.option.replace('_', '-')}{shown})" if self.option else self.text


def assumptions(path: Path, scene: Scene, options: Mapping[str, Any]) -> list[Assumption]:
    """Assumptions for the scene of a file; options: values of the command's options by name."""
    tables = read_tables(path) if path.suffix.lower() == ".toml" else {}
    notes = notes_on_options(path, options)
    if "cue" in tables:
        return [*notes, *assumptions_of_tables(tables, path.parent, scene, options)]
    drawing = _with_rest(scene.shaft, _of_drawing(path, scene.shaft, options))
    return [*notes, *drawing, *_default_stroke(options.get("game") or DEFAULT_GAME, scene, options)]


def with_assumptions(
    path: Path, loaded: Cue | Scene, options: Mapping[str, Any], notes: Iterable[Assumption]
) -> Cue | Scene:
    """What a file holds with its assumptions and warnings; options: those it was loaded with; notes: on them."""
    warnings = tuple(drawing_warnings(path))
    if isinstance(loaded, Scene):
        return loaded.assuming(listed=(*notes, *assumptions(path, loaded, options)), warnings=warnings)
    return loaded.assuming([*notes, *notes_on_options(path, options), *_of_drawing(path, loaded, options)], warnings)


def notes_on_options(path: Path, options: Mapping[str, Any]) -> list[Assumption]:
    """What options replace in a file's drawing, in which state a shaft was weighed, and whose density another has."""
    added = [key for key in ("ferrule", "bore") if key in options]
    wood = options.get("material")
    if not added and wood is None:
        return []
    unit = options.get("length_unit")
    opened = load(path, length_unit=unit)
    own = given_keys(path, opened, unit)
    notes = [Assumption("", f"the {key} in the file is replaced: {options[key]}") for key in added if key in own]
    if "shaft_mass" in options:
        state = ", ".join(["its tip", *(f"this {key}" for key in added)])
        return [*notes, Assumption("", f"the shaft was weighed with {state}")]
    cue = opened.shaft if isinstance(opened, Scene) else opened
    if wood is not None and "shaft_mass" in own and not is_wood_of(material(wood), main_material(cue)):
        text = f"mass by the density of {wood}: the weighed wood is replaced"
        notes.append(Assumption.on("shaft_mass", text))
    return notes


def assumptions_of_tables(
    tables: dict[str, Any], folder: Path, scene: Scene, options: Mapping[str, Any]
) -> list[Assumption]:
    """Assumptions for a scene of a file's tables."""
    cue, game = tables["cue"], str(tables.get("game", DEFAULT_GAME))
    file = named_path(folder / cue) if isinstance(cue, str) else None
    drawing = [] if file is None or scene.lumped else _of_drawing(file, scene.shaft, options)
    drawing = drawing if scene.lumped else _with_rest(scene.shaft, drawing)
    stroke = _stroke(tables, game, scene, options)
    if stroke and "game" not in tables:
        stroke = [Assumption("", f"missing values from the default stroke of {game}"), *stroke]
    return [*drawing, *stroke]


def _of_drawing(path: Path, cue: Cue, options: Mapping[str, Any]) -> list[Assumption]:
    """Assumptions for the drawing of a file, which may be a cue with a name."""
    name = cue_name(path)
    named = [Assumption("", CUES[name].assumed)] if name else []
    return [*named, *drawing_assumptions(path, cue, options)]


def _with_rest(cue: Cue, drawing: list[Assumption]) -> list[Assumption]:
    """The assumptions for a drawing, with that for the rest of its cue."""
    if not cue.is_body_mass_assumed:
        return drawing
    rest = Assumption.on("body_mass", f"usual rest of the cue, {with_unit(cue.body_mass, 'kg')}")
    return [rest, *(each for each in drawing if each.key != "body_mass")]


def drawing_assumptions(path: Path, cue: Cue, options: Mapping[str, Any]) -> list[Assumption]:
    """Assumptions for a drawing: unit, material, parts and rest of the cue of a profile or surface; the tenon."""
    ending = path.suffix.lower()
    if ending not in SHAPE_EXTENSIONS:
        return [*ferrule_assumption(cue), *tenon_assumption(cue)]
    wood = {"material": f"material {DEFAULT_MATERIAL}", "shaft_mass": "mass by the density of that material"}
    parts = {
        "body_mass": "no butt behind the shaft",
        "ferrule": "no ferrule",
        "bore": "no bore",
        "front": "the drawing starts at the ferrule, the tip is added",
    }
    given = {*options}
    if ending in SURFACE_EXTENSIONS:
        unit = Assumption("", f"lengths in {DEFAULT_UNIT}", "length_unit")
        notes = [*([] if "length_unit" in options else [unit]), *(Assumption("", note) for note in _surface(path))]
    else:
        notes = [Assumption("", note) for note in read_profile(path, _UNNAMED, options.get("length_unit"))[1]]
    given |= _given_in_drawing(path, cue, options.get("length_unit"))
    if any(cue.segments[i].tip_bore and cue.segments[i].core is None for i in Layout.of(cue).ferrule):
        notes = [*notes, Assumption("", "the ferrule has the bore of the shaft, without a tenon")]
    lacking = parts if "material" in given else wood | parts
    return [
        *notes,
        *(Assumption.on(key, text) for key, text in lacking.items() if key not in given),
        *ferrule_assumption(cue),
        *tenon_assumption(cue),
    ]


def _is_bored(cue: Cue) -> bool:
    """Whether a drawing has a bore, apart from that of a ferrule for its tenon."""
    ferrule = Layout.of(cue).ferrule
    return any(max(s.tip_bore, s.butt_bore) > 0 for i, s in enumerate(cue.segments) if i not in ferrule)


def own_values(path: Path, length_unit: str | None = None) -> set[str]:
    """The options of cue, tip and game whose values a file has itself; a cue by its name and a lumped cue have all."""
    ending = path.suffix.lower()
    own = {"length_unit", "front"} if ending == ".toml" else set[str]()
    if ending == ".csv" and length_unit is not None and names_units(path):
        own, length_unit = {"length_unit"}, None
    opened = load(path, length_unit=None if "length_unit" in own else length_unit)
    own |= given_keys(path, opened, length_unit)
    has_no_shaft = isinstance(opened, Scene) and opened.lumped is not None
    if isinstance(opened, Scene):
        own.add("game")
    return own | {*SHAFT_ADDITIONS, "body_mass", "shaft_mass"} if cue_name(path) or has_no_shaft else own


def given_keys(path: Path, opened: Cue | Scene, length_unit: str | None = None) -> set[str]:
    """The options of cue and tip whose values a file has itself; opened: what it holds, without options."""
    tables = read_tables(path) if path.suffix.lower() == ".toml" else {}
    tip = {key for key, of in _OF.items() if of in (TIP, IMPACT)} - _missing(tables) if "cue" in tables else set()
    if isinstance(opened, Scene) and opened.lumped:
        return tip
    drawing = path.parent / tables["cue"] if isinstance(tables.get("cue"), str) else path
    cue = opened.shaft if isinstance(opened, Scene) else opened
    return tip | _given_in_drawing(drawing, cue, length_unit)


def _given_in_drawing(path: Path, cue: Cue, length_unit: str | None) -> set[str]:
    """The options whose values a drawing has itself; a profile is read with `_UNNAMED` where it names no material."""
    ending = path.suffix.lower()
    if ending in SURFACE_EXTENSIONS:
        return {"bore"} if _is_bored(cue) else set()
    is_profile = ending in SHAPE_EXTENSIONS
    cue = read_profile(path, _UNNAMED, length_unit)[0] if is_profile else cue
    woods = [segment.material for segment in cue.segments]
    given = {
        "material": _UNNAMED not in woods,
        "ferrule": any(wood != _UNNAMED for wood in woods) if is_profile else bool(Layout.of(cue).ferrule),
        "bore": _is_bored(cue),
        "front": bool(cue.leather_height),
        "body_mass": cue.body_mass > 0 and not cue.is_body_mass_assumed,
        "shaft_mass": cue.shaft_mass_measured,
    }
    return {key for key, is_given in given.items() if is_given}


def ferrule_assumption(cue: Cue) -> list[Assumption]:
    """Assumption of the E and density of a ferrule whose name stands for materials without published numbers."""
    for i in Layout.of(cue).ferrule:
        name = table_name(cue.segments[i].material)
        if name is not None and MATERIALS[name].is_class:
            low, high = MATERIALS[name].ranges["E"]
            return [
                Assumption(
                    "ferrule_class", f"the ferrule is read as {name}, E {span_text(low, high, 'Pa')}: none is published"
                )
            ]
    return []


def tenon_assumption(cue: Cue) -> list[Assumption]:
    """Assumption of a tenon of the default diameter in the ferrule."""
    pieces = [cue.segments[i] for i in Layout.of(cue).ferrule]
    if pieces and all(s.core and math.isclose(s.tip_bore, TENON_RATIO * s.tip_diameter, rel_tol=1e-4) for s in pieces):
        text = f"the ferrule sits on a tenon of the shaft's wood, {TENON_RATIO:g} of its width"
        return [Assumption("tenon", text)]
    return []


def _surface(path: Path) -> list[str]:
    """Number of segments from a surface, and the error of its facets."""
    from cuefem.files.surface_reader import read_surface

    surface = read_surface(path)
    corners = 2 * surface.facets / surface.widest
    beyond = f" (corners up to {corners:.0e} of the widest diameter further out)" if corners > _ROUND_OFF else ""
    count = len(surface.pieces)
    return [
        f"{count} conical segment{'s' if count > 1 else ''}, diameters within {TOLERANCE:.0e} of the widest",
        f"facets replaced by circles{beyond}",
        "the thinner end is the tip",
    ]


def _default_stroke(game: str, scene: Scene, given: Collection[str]) -> list[Assumption]:
    """Assumptions for ball, tip and stroke of a cue alone."""
    known, butt = GAMES.get(game), ""
    if known and scene.shaft.body_mass:
        length, diameter = (with_unit(size, "m", 6) for size in (known.cue_length, known.butt_diameter))
        butt = f", butt to {length}, {diameter} wide, for axial waves"
    stroke = [] if "game" in given else [Assumption.on("game", f"default stroke of {game}{butt}")]
    return [*stroke, *_stroke({}, game, scene, given)]


def _stroke(tables: dict[str, Any], game: str, scene: Scene, given: Collection[str]) -> list[Assumption]:
    """Assumptions for ball, tip, stroke and effects that a scene's tables lack, with the values of the scene."""
    known, ball, tip = GAMES.get(game), scene.ball, scene.tip
    missing = _missing(tables) - {*given}
    whole_cue = ""
    if known and tip.restitution != known.restitution:
        whole_cue = f" of the tip (with axial waves, {known.restitution:g} of the whole cue head-on)"
    words = {
        "ball_mass": f"ball {with_unit(ball.mass, 'kg', 6)}",
        "ball_diameter": f"ball {with_unit(2 * ball.radius, 'm', 6)}",
    }
    if any(effect.defines_tip for effect in scene.effects):
        leather = scene.leather_tip
        words |= {
            "tip_height": f"leather tip {with_unit(leather.height, 'm')} high, replacing any drawn leather",
            "dome": f"tip radius (dome) {with_unit(leather.dome_radius, 'm', 6)}",
            "leather": f"tip hardness {known.leather if known else ''}, E {modulus_text(leather.E)}",
        }
    elif tip.contact_time is None and tip.stiffness is None:
        words["contact_time"] = (
            f"contact time {1e3 * DEFAULT_CONTACT_TIME:g} ms, rigid cue head-on (leather: about 1 ms)"
        )
        missing.add("contact_time")
    words |= {
        "restitution": f"restitution {tip.restitution:.3g}{whole_cue}",
        "friction": f"friction {tip.friction:g}",
        "speed": f"cue speed {with_unit(scene.stroke.speed, 'm/s', 6)}",
        "offset": f"offset b/R {scene.stroke.offset:.4g}",
    }
    return [Assumption.on(key, text) for key, text in words.items() if key in missing]


def _missing(tables: dict[str, Any]) -> set[str]:
    """The options whose values a scene's tables lack."""
    return {key for left in missing_keys(tables) for key in _KEYS.get(left, (left.rpartition(".")[2],))}


# What ends an assumption on an addition to a drawing if it changes.
_ADDITIONS: Mapping[str, Callable[[Cue], Any]] = {
    "material": main_material,
    "shaft_mass": lambda cue: cue.shaft_mass_measured,
    "body_mass": lambda cue: cue.body_mass,
    "ferrule": lambda cue: bool(Layout.of(cue).ferrule),
    "tenon": lambda cue: len(tenon_assumption(cue)),
    "bore": _is_bored,
    "front": lambda cue: bool(cue.leather_height),
}


def held_assumptions(scene: Scene) -> list[Assumption]:
    """What was assumed when cue and scene were loaded or made, without what was changed since."""
    made = scene.assumed
    if made is not None and not made.game:  # of a scene's file, which lists its cue, too
        return _held(made.listed, scene, made.scene)
    stroke = [] if made is None else _held(_default_stroke(made.game, made.scene, made.given), scene, made.scene)
    if scene.lumped is not None:
        return stroke
    cue, drawn = scene.shaft, scene.shaft.assumed
    drawing = [each for each in drawn.listed if _is_of_drawing(each, cue, drawn.cue)] if drawn else []
    return [*_with_rest(cue, drawing), *stroke]


def _held(listed: Iterable[Assumption], scene: Scene, made: Scene) -> list[Assumption]:
    """The assumptions whose values are those of the scene as it was made."""
    return [each for each in listed if _assumed_value(each.key, scene) == _assumed_value(each.key, made)]


def _is_of_drawing(assumption: Assumption, cue: Cue, drawn: Cue) -> bool:
    """Whether the value that an assumption is on is that of the cue as it was drawn."""
    return bool(_drawn_value(assumption.key, cue) == _drawn_value(assumption.key, drawn))


def _assumed_value(key: str, scene: Scene) -> Any:
    """The value of a scene that an assumption is on."""
    if key == "game":
        return scene.ball
    if key in PARAMETERS and (scene.lumped or key not in _ADDITIONS):
        return PARAMETERS[key].value(scene)
    return None if scene.lumped else _drawn_value(key, scene.shaft)


def _drawn_value(key: str, cue: Cue) -> Any:
    """The value of a drawing that an assumption is on; of other assumptions its count of segments behind the tip."""
    return _ADDITIONS[key](cue) if key in _ADDITIONS else len(without_leather(cue).segments)


def offered_assumptions(
    listed: Iterable[Assumption], offered: Collection[str] = (), *, with_impact: bool = True
) -> list[Assumption]:
    """The assumptions; one whose option is not among ``offered`` names no option.

    with_impact: whether to include ball, tip and stroke.
    """
    return [
        each if each.option in offered else replace(each, option="")
        for each in listed
        if with_impact or each.of not in (IMPACT, STROKE)
    ]
