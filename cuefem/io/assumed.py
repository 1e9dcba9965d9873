"""What a file leaves out and the defaults supply: by the key of the parameter or fitting, and in words for the reader
of the result. An assumption that nothing changes has the key ""."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from cuefem.cue import Cue, Material
from cuefem.io.fittings import BORE, FERRULE, LEATHER, TENON
from cuefem.io.profile import DEFAULT_MATERIAL, DEFAULT_UNIT, SHAPES, SURFACES, read_profile
from cuefem.io.slices import TOLERANCE
from cuefem.io.toml import left_out, read_tables
from cuefem.parameters.parts import Layout
from cuefem.scene import DEFAULT_CONTACT_TIME, Scene
from cuefem.scene.default_scene import DEFAULT_GAME, GAMES

Assumptions = list[tuple[str, str]]

OF_BLOW = ("ball_mass", "ball_diameter", "contact_time", "restitution", "friction", "speed", "offset")
_EXAMPLES = {"ferrule": FERRULE, "bore": BORE, "begins": LEATHER}
# The keys of what a scene's tables leave out; where none stands, the name of the field.
_KEYS = {"ball.mass": ("ball_mass",), "ball.radius": ("ball_diameter",), "effects": ("tip_height", "dome", "leather")}
_UNNAMED = Material(1e9, 1e9 / 15, 1000.0)  # stands for the material that a profile does not name


def assumed(path: Path, scene: Scene, given: Mapping[str, Any]) -> Assumptions:
    """What is assumed for the scene of a file. given: what options tell, by their names."""
    tables = read_tables(path) if path.suffix.lower() == ".toml" else {}
    if "cue" in tables:
        return assumed_in(tables, path.parent, scene, given)
    game = given.get("game") or DEFAULT_GAME
    known, butt = GAMES.get(game), ""
    if known and scene.shaft.body_mass:
        butt = f", butt to {1e3 * known.cue_length:g} mm, {1e3 * known.butt_diameter:g} mm wide, for axial waves"
    stroke = ("game", f"default stroke of {game}{butt}")
    missing = [] if "game" in given else [stroke]
    return [*assumed_drawing(path, scene.shaft, given), *missing, *_stroke({}, game, scene, given)]


def assumed_in(tables: dict[str, Any], folder: Path, scene: Scene, given: Mapping[str, Any]) -> Assumptions:
    """What is assumed for a scene of a file's tables."""
    cue, game = tables["cue"], str(tables.get("game", DEFAULT_GAME))
    drawing = assumed_drawing(folder / cue, scene.shaft, given) if isinstance(cue, str) else []
    stroke = _stroke(tables, game, scene, given)
    named = [] if "game" in tables or not stroke else [("", f"what is left out as in the default stroke of {game}")]
    return [*drawing, *named, *stroke]


def assumed_drawing(path: Path, cue: Cue, given: Mapping[str, Any]) -> Assumptions:
    """What a lathe profile or a surface cannot say: its unit, its material, its parts, and what is behind the shaft; of
    any drawing, the tenon of its ferrule."""
    ending = path.suffix.lower()
    if ending not in SHAPES:
        return tenon(cue)
    lacking = [("material", f"material {DEFAULT_MATERIAL}"), ("shaft_mass", "weight by the density of that material")]
    parts = [
        ("ferrule", "no ferrule"),
        ("bore", "no bore"),
        ("begins", "the drawing begins at the ferrule, the tip is added"),
    ]
    if ending in SURFACES:
        notes = [*([] if "length_unit" in given else [f"lengths in {DEFAULT_UNIT} (--length-unit)"]), *_surface(path)]
    else:
        drawn, notes = read_profile(path, _UNNAMED, given.get("length_unit"))
        woods, ferrule = [segment.material for segment in drawn.segments], Layout.of(drawn).ferrule
        told = {
            "material": _UNNAMED not in woods,
            "ferrule": any(wood != _UNNAMED for wood in woods),
            "bore": any(s.tip_bore for i, s in enumerate(drawn.segments) if i not in ferrule),
            "begins": bool(drawn.leather),
        }
        given = {**given, **{key: True for key, is_told in told.items() if is_told}}
    if any(cue.segments[i].tip_bore and cue.segments[i].core is None for i in Layout.of(cue).ferrule):
        notes = [*notes, "the ferrule has the bore of the shaft, without a tenon"]
    lacking = [] if "material" in given else lacking
    found = [*lacking, ("body_mass", "no mass behind the shaft"), *parts]
    return [*(("", note) for note in notes), *((k, words) for k, words in found if k not in given), *tenon(cue)]


def tenon(cue: Cue) -> Assumptions:
    """What was drawn inside a ferrule that says nothing of it."""
    pieces = [cue.segments[i] for i in Layout.of(cue).ferrule]
    if pieces and all(s.core and math.isclose(s.tip_bore, TENON * s.tip_diameter, rel_tol=1e-4) for s in pieces):
        return [("tenon", f"the ferrule sits on a tenon of the shaft's wood, {TENON:g} of its width")]
    return []


def _surface(path: Path) -> list[str]:
    """How many segments a surface has become, and how far its facets leave the round form open."""
    from cuefem.io.surface import read_surface

    surface = read_surface(path)
    corners = 2 * surface.facets / surface.widest
    count = len(surface.pieces)
    return [
        f"{count} conical segment{'s' if count > 1 else ''}, diameters within {TOLERANCE:.0e} of the widest",
        f"facets taken as round (corners up to {corners:.0e} of the widest diameter further out)",
        "the thinner end is the tip",
    ]


def _stroke(tables: dict[str, Any], game: str, scene: Scene, given: Mapping[str, Any]) -> Assumptions:
    """What a scene's tables leave out of ball, tip, stroke and effects, with the values of the scene."""
    known, ball, tip = GAMES.get(game), scene.ball, scene.tip
    missing = {key for left in left_out(tables) for key in _KEYS.get(left, (left.rpartition(".")[2],))} - {*given}
    whole = ""
    if known and tip.restitution != known.restitution:
        whole = f" of the tip (with axial waves, {known.restitution:g} of the whole cue head-on)"
    words = {"ball_mass": f"ball {1e3 * ball.mass:g} g", "ball_diameter": f"ball {2e3 * ball.radius:g} mm"}
    if any(effect.whole_tip for effect in scene.effects):
        leather = scene.leather
        words |= {
            "tip_height": f"leather tip {1e3 * leather.height:.4g} mm high, replacing any drawn leather",
            "dome": f"tip radius (dome) {1e3 * leather.dome_radius:g} mm",
            "leather": f"tip hardness {known.leather if known else ''}, E {1e-6 * leather.E:g} MPa",
        }
    elif tip.contact_time is None and tip.stiffness is None:
        words["contact_time"] = f"head-on contact time {1e3 * DEFAULT_CONTACT_TIME:g} ms (leather: about 1 ms)"
        missing.add("contact_time")
    words |= {
        "restitution": f"restitution {tip.restitution:.3g}{whole}",
        "friction": f"friction {tip.friction:g}",
        "speed": f"cue speed {scene.stroke.speed:g} m/s",
        "offset": f"offset b/R {scene.stroke.offset:.4g}",
    }
    return [(key, text) for key, text in words.items() if key in missing]


def in_words(found: Assumptions, offered: Collection[str] = (), *, blow: bool = True) -> list[str]:
    """The assumptions in words, each with the option that changes it, if the command has it.

    blow: whether ball, tip and stroke matter.
    """
    return [f"{words}{_option(key, offered)}" for key, words in found if blow or key not in OF_BLOW]


def _option(key: str, offered: Collection[str]) -> str:
    example = f' "{_EXAMPLES[key]}"' if key in _EXAMPLES else ""
    return f" (--{key.replace('_', '-')}{example})" if key in offered else ""
