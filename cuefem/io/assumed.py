"""What a file leaves out and the defaults supply, in words for whoever reads the result."""

from __future__ import annotations

import math
from collections.abc import Collection
from pathlib import Path
from typing import Any

from cuefem.cue import Cue
from cuefem.effects import AxialWaves, effect_kinds
from cuefem.io.fittings import BORE, FERRULE, LEATHER, TENON
from cuefem.io.profile import DEFAULT_MATERIAL, DEFAULT_UNIT, SHAPES, SURFACES, Profile, read_profile
from cuefem.io.slices import TOLERANCE
from cuefem.io.toml import left_out, read_tables
from cuefem.parameters.parts import Layout
from cuefem.scene import DEFAULT_CONTACT_TIME, Ball, Stroke, Tip
from cuefem.scene.default_scene import DEFAULT_GAME, GAMES, KIM, usual_tip

BEGINS = f'the front of the drawing is the ferrule; the tip is added in front (--begins "{LEATHER}" if it is leather)'
ON_TENON = f"the ferrule sits on a tenon of the shaft's wood, {TENON:g} of its width"
BORED_FERRULE = "the ferrule has the bore of the shaft, without a tenon"


def assumed(
    path: Path, options: Collection[str], *, cue: Cue | None = None, offered: Collection[str] = (), blow: bool = True
) -> list[str]:
    """What a loaded cue or scene file leaves to defaults.

    options: the options that were given as well, such as "offset". cue: what file and options draw. offered: all
    options that the command has. blow: whether ball, tip and stroke count.
    """
    tables = read_tables(path) if path.suffix.lower() == ".toml" else {}
    if "cue" not in tables:
        return _profile(path, options, " (--material)", cue)
    named = tables["cue"]
    shaft = _profile(path.parent / named, options, cue=cue) if isinstance(named, str) else []
    return [*shaft, *(assumed_blow(tables, options, offered=offered) if blow else [])]


def assumed_drawing(path: Path, cue: Cue) -> list[str]:
    """What a drawing that other files stand beside cannot say: its material, and what is behind the shaft."""
    if path.suffix.lower() not in SHAPES:
        return []
    return [*_profile(path, ("body_mass",), cue=cue), "no mass behind the shaft (body_mass in a cue.toml)"]


def _profile(path: Path, options: Collection[str], choose: str = "", cue: Cue | None = None) -> list[str]:
    """What a lathe profile or a surface cannot say: its unit, its material, and what is screwed to the shaft."""
    if path.suffix.lower() not in SHAPES:
        return []
    lengths = path.suffix.lower() in SURFACES and "length_unit" not in options
    profile = None if path.suffix.lower() in SURFACES else read_profile(path, DEFAULT_UNIT, checked=False)
    unit = f"lengths in {DEFAULT_UNIT}{choose and ' (--length-unit)'}"
    return [
        *([unit] if lengths else []),
        *(_fit(path) if profile is None else profile.notes),
        *(
            []
            if "material" in options or (profile is not None and profile.named)
            else [f"material {DEFAULT_MATERIAL}{choose}"]
        ),
        *([] if "body_mass" in options else ["no mass behind the shaft (--body-mass)"]),
        *_parts(profile, options, choose, cue),
    ]


def _parts(profile: Profile | None, options: Collection[str], choose: str, cue: Cue | None) -> list[str]:
    """What a shape has neither drawn nor told: ferrule and bore, the ferrule's tenon, the leather at its front."""
    words = {"ferrule": f'--ferrule "{FERRULE}"', "bore": f'--bore "{BORE}"'}
    lacking = [name for name in (("ferrule", "bore") if profile is None else profile.lacking) if name not in options]
    add = " and ".join(words[name] for name in lacking)
    names = " or a column of that name" if len(lacking) == 1 else " or columns of those names"
    columns = "" if profile is None else names
    pronoun = "them" if len(lacking) > 1 else "it"
    told = f"{', '.join(f'no {name}' for name in lacking)}: add {pronoun} with {add}{columns}"
    leather = profile is not None and profile.leather
    return [
        *([told if choose else told.partition(":")[0]] if lacking else []),
        *(_tenon(cue) if "ferrule" in options or (profile is not None and profile.ferruled) else []),
        *([BEGINS] if choose and not leather and "begins" not in options else []),
    ]


def _tenon(cue: Cue | None) -> list[str]:
    """What was drawn inside a ferrule that says nothing of it."""
    pieces = [] if cue is None else [cue.segments[i] for i in Layout.of(cue).ferrule]
    if pieces and all(s.core and math.isclose(s.tip_bore, TENON * s.tip_diameter, rel_tol=1e-4) for s in pieces):
        return [ON_TENON]
    return [BORED_FERRULE] if any(s.tip_bore and s.core is None for s in pieces) else []


def _fit(path: Path) -> list[str]:
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


def assumed_usual(
    cue: Cue, game: str, options: Collection[str], *, offered: Collection[str], blow: bool = True
) -> list[str]:
    """What a cue alone gets of its game's default stroke (`cuefem.scene.default_scene`); arguments as for `assumed`."""
    known = GAMES[game]
    ball, tip = known.ball, usual_tip(cue, game)
    drawn = f"{1e3 * cue.leather:.4g} mm"
    height = (
        f"leather tip of the drawn height, {drawn}"
        if cue.leather
        else f"leather tip {1e3 * tip.height:g} mm high, added in front of the drawing"
    )
    if cue.leather and "tip_height" in options:
        height = f"the leather tip replaces the drawn leather, {drawn}"
    sizes = f"{1e3 * ball.mass:g} g, {2e3 * ball.radius:g} mm"
    butt = f", butt to {1e3 * known.cue_length:g} mm, {1e3 * known.butt_diameter:g} mm wide, for axial waves"
    said = (
        (False, f"default stroke of {game}{butt if blow and cue.body_mass else ''}{_option('game', offered)}"),
        (not blow, f"ball {sizes}"),
        (not cue.leather and "tip_height" in options, f"{height}{_option('tip_height', offered)}"),
        ("dome" in options, f"tip radius (dome) {1e3 * tip.dome_radius:g} mm{_option('dome', offered)}"),
        (
            "leather" in options,
            f"tip hardness {known.leather}, E {1e-6 * tip.E:g} MPa{_option('leather', offered)}",
        ),
        (not blow or "restitution" in options, f"restitution {known.bounce}{_option('restitution', offered)}"),
        (not blow or "friction" in options, f"friction {known.friction:g}{_option('friction', offered)}"),
        (not blow or "speed" in options, f"cue speed {known.speed:g} m/s{_option('speed', offered)}"),
        (not blow or "offset" in options, f"offset b/R {known.offset:g}{_option('offset', offered)}"),
    )
    return [words for told, words in said if not told]


def assumed_blow(tables: dict[str, Any], options: Collection[str], *, offered: Collection[str]) -> list[str]:
    """What a scene's tables leave out of ball, tip, stroke and effects, and its game supplies."""
    game = str(tables.get("game", DEFAULT_GAME))
    missing = {key for key in left_out(tables) if key.rpartition(".")[2] not in options}
    missing -= {"effects"} if game == KIM else set()
    cue, tip = tables["cue"], tables.get("tip", {})
    timed = bool({"contact_time", "stiffness"} & {*tip})
    kinds = [effect_kinds().get(str(effect.get("type"))) for effect in tables.get("effects", ())]
    usual = "effects" in missing and game != KIM and not (isinstance(cue, dict) and "end_mass" in cue)
    whole = (usual and not timed) or any(kind and kind.whole_tip for kind in kinds)
    ball, tip_of, stroke, bounce = Ball(), Tip(), Stroke(), f"{Tip().restitution:g}"
    if game != KIM:
        known = GAMES[game]
        ball, tip_of, stroke = known.ball, Tip(friction=known.friction), Stroke(known.speed, known.offset)
        bounce = known.bounce if usual or AxialWaves in kinds else f"{known.restitution:g}"
    sizes = {"ball.mass": f"{1e3 * ball.mass:g} g", "ball.radius": f"{2e3 * ball.radius:g} mm"}
    said = [words for key, words in sizes.items() if key in missing]
    leather = "leather tip (drawn or default height)" if whole else ""
    effects = " and ".join(filter(None, [leather, "axial waves and geometric stiffness"]))
    time = f"{1e3 * DEFAULT_CONTACT_TIME:g} ms (leather: about 1 ms)"
    stroke_of = "Kim's stroke" if game == KIM else f"default stroke of {game}"
    told = (
        (bool(missing), stroke_of if len(tables) <= 1 + ("game" in tables) else f"missing keys as in {stroke_of}"),
        (bool(said), f"ball {', '.join(said)}"),
        ("effects" in missing and usual, f"{effects} (effects = [] for none)"),
        (not (timed or whole), f"head-on contact time {time}"),
        ("tip.restitution" in missing, f"restitution {bounce}{_option('restitution', offered)}"),
        ("tip.friction" in missing, f"friction {tip_of.friction:g}{_option('friction', offered)}"),
        ("stroke.speed" in missing, f"cue speed {stroke.speed:g} m/s{_option('speed', offered)}"),
        ("stroke.offset" in missing, f"offset b/R {stroke.offset:.4g}{_option('offset', offered)}"),
    )
    return [words for wanted, words in told if wanted]


def _option(name: str, offered: Collection[str]) -> str:
    """The option that gives another value, if the command has it."""
    return f" (--{name.replace('_', '-')})" if name in offered else ""
