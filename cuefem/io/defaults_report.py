"""Report of defaults: for each value that a file lacks, the option that sets it and a text.

An assumption without an option has the key "".
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from cuefem.cue import Cue, Material
from cuefem.io.lathe_profile import DEFAULT_MATERIAL, DEFAULT_UNIT, SHAPE_EXTENSIONS, SURFACE_EXTENSIONS, read_profile
from cuefem.io.shaft_additions import BORE, FERRULE, LEATHER, TENON_RATIO
from cuefem.io.surface_sections import TOLERANCE
from cuefem.io.toml_reader import missing_keys, read_tables
from cuefem.parameters.parts import Layout
from cuefem.scene import DEFAULT_CONTACT_TIME, Scene
from cuefem.scene.default_scene import DEFAULT_GAME, GAMES

Assumptions = list[tuple[str, str]]

IMPACT_KEYS = ("ball_mass", "ball_diameter", "contact_time", "restitution", "friction", "speed", "offset")
_EXAMPLES = {"ferrule": FERRULE, "bore": BORE, "front": LEATHER}
# Options of missing keys of a scene file; for other keys the name of the field.
_KEYS = {"ball.mass": ("ball_mass",), "ball.radius": ("ball_diameter",), "effects": ("tip_height", "dome", "leather")}
_UNNAMED = Material(1e9, 1e9 / 15, 1000.0)  # placeholder for the material of a profile without one


def assumptions(path: Path, scene: Scene, options: Mapping[str, Any]) -> Assumptions:
    """Assumptions for the scene of a file; options: values of the command's options by name."""
    tables = read_tables(path) if path.suffix.lower() == ".toml" else {}
    if "cue" in tables:
        return assumptions_of_tables(tables, path.parent, scene, options)
    game = options.get("game") or DEFAULT_GAME
    known, butt = GAMES.get(game), ""
    if known and scene.shaft.body_mass:
        butt = f", butt to {1e3 * known.cue_length:g} mm, {1e3 * known.butt_diameter:g} mm wide, for axial waves"
    stroke = ("game", f"default stroke of {game}{butt}")
    missing = [] if "game" in options else [stroke]
    return [*drawing_assumptions(path, scene.shaft, options), *missing, *_stroke({}, game, scene, options)]


def assumptions_of_tables(
    tables: dict[str, Any], folder: Path, scene: Scene, options: Mapping[str, Any]
) -> Assumptions:
    """Assumptions for a scene of a file's tables."""
    cue, game = tables["cue"], str(tables.get("game", DEFAULT_GAME))
    drawing = drawing_assumptions(folder / cue, scene.shaft, options) if isinstance(cue, str) else []
    stroke = _stroke(tables, game, scene, options)
    named = [] if "game" in tables or not stroke else [("", f"missing values from the default stroke of {game}")]
    return [*drawing, *named, *stroke]


def drawing_assumptions(path: Path, cue: Cue, options: Mapping[str, Any]) -> Assumptions:
    """Assumptions for a drawing: unit, material, parts and rest of the cue of a profile or surface; the tenon."""
    ending = path.suffix.lower()
    if ending not in SHAPE_EXTENSIONS:
        return tenon_assumption(cue)
    lacking = [("material", f"material {DEFAULT_MATERIAL}"), ("shaft_mass", "mass by the density of that material")]
    parts = [
        ("ferrule", "no ferrule"),
        ("bore", "no bore"),
        ("front", "the drawing starts at the ferrule, the tip is added"),
    ]
    if ending in SURFACE_EXTENSIONS:
        notes = [*([] if "length_unit" in options else [f"lengths in {DEFAULT_UNIT} (--length-unit)"]), *_surface(path)]
    else:
        drawn, notes = read_profile(path, _UNNAMED, options.get("length_unit"))
        woods, ferrule = [segment.material for segment in drawn.segments], Layout.of(drawn).ferrule
        in_drawing = {
            "material": _UNNAMED not in woods,
            "ferrule": any(wood != _UNNAMED for wood in woods),
            "bore": any(s.tip_bore for i, s in enumerate(drawn.segments) if i not in ferrule),
            "front": bool(drawn.leather_height),
        }
        options = {**options, **{key: True for key, present in in_drawing.items() if present}}
    if any(cue.segments[i].tip_bore and cue.segments[i].core is None for i in Layout.of(cue).ferrule):
        notes = [*notes, "the ferrule has the bore of the shaft, without a tenon"]
    lacking = [] if "material" in options else lacking
    assumptions = [*lacking, ("body_mass", "no butt behind the shaft"), *parts]
    return [
        *(("", note) for note in notes),
        *((k, words) for k, words in assumptions if k not in options),
        *tenon_assumption(cue),
    ]


def tenon_assumption(cue: Cue) -> Assumptions:
    """Assumption of a tenon of the default diameter in the ferrule."""
    pieces = [cue.segments[i] for i in Layout.of(cue).ferrule]
    if pieces and all(s.core and math.isclose(s.tip_bore, TENON_RATIO * s.tip_diameter, rel_tol=1e-4) for s in pieces):
        return [("tenon", f"the ferrule sits on a tenon of the shaft's wood, {TENON_RATIO:g} of its width")]
    return []


def _surface(path: Path) -> list[str]:
    """Number of segments from a surface, and the error of its facets."""
    from cuefem.io.surface_reader import read_surface

    surface = read_surface(path)
    corners = 2 * surface.facets / surface.widest
    count = len(surface.pieces)
    return [
        f"{count} conical segment{'s' if count > 1 else ''}, diameters within {TOLERANCE:.0e} of the widest",
        f"facets replaced by circles (corners up to {corners:.0e} of the widest diameter further out)",
        "the thinner end is the tip",
    ]


def _stroke(tables: dict[str, Any], game: str, scene: Scene, options: Mapping[str, Any]) -> Assumptions:
    """Assumptions for ball, tip, stroke and effects that a scene's tables lack, with the values of the scene."""
    known, ball, tip = GAMES.get(game), scene.ball, scene.tip
    missing = {key for left in missing_keys(tables) for key in _KEYS.get(left, (left.rpartition(".")[2],))} - {*options}
    whole_cue = ""
    if known and tip.restitution != known.restitution:
        whole_cue = f" of the tip (with axial waves, {known.restitution:g} of the whole cue head-on)"
    words = {"ball_mass": f"ball {1e3 * ball.mass:g} g", "ball_diameter": f"ball {2e3 * ball.radius:g} mm"}
    if any(effect.defines_tip for effect in scene.effects):
        leather = scene.leather_tip
        words |= {
            "tip_height": f"leather tip {1e3 * leather.height:.4g} mm high, replacing any drawn leather",
            "dome": f"tip radius (dome) {1e3 * leather.dome_radius:g} mm",
            "leather": f"tip hardness {known.leather if known else ''}, E {1e-6 * leather.E:g} MPa",
        }
    elif tip.contact_time is None and tip.stiffness is None:
        words["contact_time"] = (
            f"contact time {1e3 * DEFAULT_CONTACT_TIME:g} ms, rigid cue head-on (leather: about 1 ms)"
        )
        missing.add("contact_time")
    words |= {
        "restitution": f"restitution {tip.restitution:.3g}{whole_cue}",
        "friction": f"friction {tip.friction:g}",
        "speed": f"cue speed {scene.stroke.speed:g} m/s",
        "offset": f"offset b/R {scene.stroke.offset:.4g}",
    }
    return [(key, text) for key, text in words.items() if key in missing]


def assumption_texts(assumptions: Assumptions, offered: Collection[str] = (), *, with_impact: bool = True) -> list[str]:
    """Texts of assumptions, each with the option that changes it if it is among ``offered``.

    with_impact: whether to include ball, tip and stroke.
    """
    return [f"{words}{_option(key, offered)}" for key, words in assumptions if with_impact or key not in IMPACT_KEYS]


def _option(key: str, offered: Collection[str]) -> str:
    key = "game" if key.startswith("ball_") else key
    example = f' "{_EXAMPLES[key]}"' if key in _EXAMPLES else ""
    return f" (--{key.replace('_', '-')}{example})" if key in offered else ""
