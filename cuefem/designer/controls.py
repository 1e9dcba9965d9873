"""The controls of the designer: the parameter each changes in a scene, its options, and typed input."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

from cuefem.cue import Cue, Segment
from cuefem.cue.materials import LEATHERS, material_name, table_name
from cuefem.files.shaft_additions import with_additions
from cuefem.parameters.parameter import Slider, millimetres
from cuefem.parameters.parts import Layout, bore_mouth, max_bore_depth, split_segment, taper_position
from cuefem.parameters.scene_changes import with_parameters
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import display_unit, displayed_system, modulus_text
from cuefem.quantity.display_units import with_unit as quantity_text
from cuefem.quantity.fields import Quantity
from cuefem.quantity.units import plain_fractions, split_quantity, unit_of
from cuefem.scene import Scene
from cuefem.scene.default_scene import GAMES, stroke_name, usual_scene, without_leather

MIN_WALL = 0.0005  # m, the thinnest wall around a typed bore
NEW_BORE, NEW_DEPTH = 0.006, 0.127
NEW_FERRULES = {"metric": "25 mm", "us": "1 in"}
DECIMALS = {"mm": 2, "g": 1, "mph": 2}  # the most that are shown; of other units 3
NONE, DRILLED = "none", "drilled"
MAX_TEXT = 40
UNITLESS = re.compile(r"[-+]?[\d./\s¼-¾⅐-⅞-]+")
FERRULE_BEGINS, LEATHER_BEGINS = "the ferrule; tip added", "the tip"


class Knob(NamedTuple):
    """A control: its group, its label ("{at}" is a position on the cue), and its range (None for a choice)."""

    group: str
    label: str
    range: Slider | None = None


def _of_parameter(group: str, key: str, label: str) -> tuple[str, Knob]:
    """A control with the range of the parameter that it changes."""
    return key, Knob(group, label, PARAMETERS[key].slider)


# By the keys of the parameters that they change, where a parameter has it.
KNOBS = dict(
    [
        _of_parameter("Shaft", "shaft_material", "Material"),
        _of_parameter("Shaft", "tip_diameter", "Tip diameter"),
        _of_parameter("Shaft", "taper_diameter", "Taper, {at}"),
        _of_parameter("Shaft", "butt_diameter", "Taper, end"),
        ("ferrule", Knob("Shaft", "Ferrule")),
        _of_parameter("Shaft", "ferrule_length", "Ferrule length"),
        ("bore", Knob("Shaft", "Bore")),
        _of_parameter("Shaft", "bore_width", "Bore width"),
        _of_parameter("Shaft", "bore_depth", "Bore depth"),
        _of_parameter("Shaft", "shaft_mass", "Shaft weight, with tip"),
        _of_parameter("Shaft", "body_mass", "Rest of cue"),
        _of_parameter("Tip", "leather", "Tip hardness"),
        _of_parameter("Tip", "tip_height", "Tip height"),
        _of_parameter("Tip", "dome", "Tip radius"),
        _of_parameter("Tip", "contact_time", "Contact time"),
        _of_parameter("Tip", "friction", "Friction"),
        _of_parameter("Tip", "restitution", "Restitution"),
        ("game", Knob("Stroke", "Game")),
        _of_parameter("Stroke", "speed", "Cue speed"),
        _of_parameter("Stroke", "offset", "Tip offset b/R"),
        ("ball_mass", Knob("Stroke", "Ball mass", Slider("g", 1e3, 0, 0, 1, 1, 10_000))),
        ("ball_diameter", Knob("Stroke", "Ball diameter", millimetres(0, 0, 0.05, 1, 1000))),
        ("front", Knob("", "Front of the drawing")),
    ]
)
GROUPS = ("Shaft", "Tip", "Stroke")
SI = {"mm": "m", "g": "kg", "ms": "s", "in": "m", "oz": "kg", "mph": "m/s"}
# Controls whose uncertain parameters have other names in a verdict.
INPUTS = {"shaft_material": ("E", "G"), "shaft_mass": ("rho",), "bore": ("bore_width",)}


def label(key: str, scene: Scene) -> str:
    """A control's label."""
    position = quantity_text(taper_position(scene.shaft), "m", decimals=0)
    return KNOBS[key].label.format(at=position.replace(" ", "\u00a0"))


def range_of(key: str) -> Slider:
    """The ranges of a number's slider and of its typed values, in the unit displayed."""
    known = KNOBS[key].range
    assert known is not None
    shown = display_unit(SI.get(known.unit, known.unit))
    if not known.unit or shown.name == known.unit:
        return known
    ratio = shown.factor / known.scale
    low, high, least, most = (ratio * end for end in (known.low, known.high, known.least, known.most))
    return Slider(shown.name, shown.factor, low, high, float(f"{ratio * known.step:.1g}"), least, most)


def value(key: str, scene: Scene) -> Any:
    """A control's value in a scene: an SI number, or the name of a choice; None if it does not apply."""
    cue, layout = scene.shaft, Layout.of(scene.shaft)
    if key == "ferrule":
        return _name(cue.segments[layout.ferrule.start].material) if layout.ferrule else NONE
    if key in ("bore", "bore_width", "bore_depth") and not layout.bore:
        filling = layout.filling
        return None if key != "bore" else f"{_name(filling)} core" if filling else NONE
    if key == "bore":
        return DRILLED
    if key == "shaft_material":
        return _name(cue.segments[layout.shaft.start].material)
    if key == "leather":
        E = PARAMETERS[key].value(scene)
        return E and next((n for n, known in LEATHERS.items() if known.E == E), f"E {modulus_text(E)}")
    if key == "game":
        return next((name for name, game in GAMES.items() if game.ball == scene.ball), "another ball")
    if key == "front":
        return None if PARAMETERS["tip_height"].value(scene) is None else FERRULE_BEGINS
    if key in ("ball_mass", "ball_diameter"):
        return scene.ball.mass if key == "ball_mass" else 2 * scene.ball.radius
    return PARAMETERS[key].value(scene)


def alike(mine: Any, other: Any) -> bool:
    """Whether two values are the same but for rounding."""
    numbers = isinstance(mine, float) and isinstance(other, float)
    return math.isclose(mine, other, rel_tol=1e-9) if numbers else mine == other


def _name(known: Any) -> str:
    return table_name(known) or material_name(known)


def options(key: str, scene: Scene) -> list[str]:
    """The options of a choice, including the scene's own."""
    offered = {
        "shaft_material": PARAMETERS["shaft_material"].choices,
        "ferrule": (NONE, *PARAMETERS["ferrule_material"].choices),
        "bore": () if Layout.of(scene.shaft).bore is None else (NONE, DRILLED),
        "leather": PARAMETERS["leather"].choices,
        "game": (*GAMES,),
        "front": (FERRULE_BEGINS, LEATHER_BEGINS),
    }[key]
    own = value(key, scene)
    return [*offered] if own in offered or own is None else [own, *offered]


def with_value(scene: Scene, key: str, new: Any) -> Scene:
    """The scene with a control at another value; ValueError if that scene is invalid."""
    made = _with_value(scene, key, new)
    if key.startswith(("ferrule", "bore")):  # which cut segments, and would cut them anew with every move
        made = replace(made, cue=_merged(made.shaft))
    return made


def _merged(cue: Cue) -> Cue:
    """The cue with adjacent segments merged if they form one cone of one material."""
    segments = list(cue.segments[:1])
    for piece in cue.segments[1:]:
        last = segments[-1]
        length = last.length + piece.length
        whole = replace(piece, length=length, tip_diameter=last.tip_diameter, tip_bore=last.tip_bore)
        front, back = split_segment(whole, last.length / length)
        ends = zip(_sizes(front) + _sizes(back), _sizes(last) + _sizes(piece), strict=True)
        alike = (last.material, last.core, last.kappa) == (piece.material, piece.core, piece.kappa)
        if alike and all(math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-12) for a, b in ends):
            segments[-1] = whole
        else:
            segments.append(piece)
    return replace(cue, segments=tuple(segments))


def _sizes(piece: Segment) -> tuple[float, ...]:
    return piece.tip_diameter, piece.butt_diameter, piece.tip_bore, piece.butt_bore


def _with_value(scene: Scene, key: str, new: Any) -> Scene:
    if key == "ferrule":
        return _with_ferrule(scene, new)
    if key == "bore":
        depth = min(NEW_DEPTH, max_bore_depth(scene.shaft))
        return with_parameters(
            scene, {"bore depth": 0.0} if new == NONE else {"bore depth": depth, "bore width": NEW_BORE}
        )
    if key == "game":
        return _with_game(scene, new)
    if key == "front":
        height = f"leather {PARAMETERS['tip_height'].value(scene):.9g} m"
        return replace(
            scene,
            cue=without_leather(with_additions(scene.shaft, front=height if new == LEATHER_BEGINS else "ferrule")),
        )
    if key == "ball_diameter":
        return with_parameters(scene, {"ball.radius": new / 2})
    return with_parameters(scene, {{"ball_mass": "ball.mass"}.get(key, key): new})


def _with_ferrule(scene: Scene, name: str) -> Scene:
    """The scene with a ferrule of a material, a new one on a tenon; or with wood instead of it."""
    layout = Layout.of(scene.shaft)
    if name == NONE or not layout.ferrule:
        ferrule = name if name == NONE else f"{NEW_FERRULES[displayed_system()]} {name}"
        return replace(scene, cue=with_additions(scene.shaft, ferrule=ferrule))
    return with_parameters(scene, {"ferrule material": name})


def _with_game(scene: Scene, name: str) -> Scene:
    """The scene with a game's ball, tip and stroke; effects on the cue are unchanged."""
    usual = usual_scene(scene.shaft, stroke_name(name))
    brought = {type(effect) for effect in usual.effects}
    staying = tuple(effect for effect in scene.effects if not effect.at_tip and type(effect) not in brought)
    return replace(usual, effects=(*usual.effects, *staying))


def value_text(key: str, shown: float, whole: Callable[[float], int] = round) -> str:
    """A number with its unit, to the digits of a slider's step, or to its own up to `DECIMALS`: "12.40 mm".

    whole: how the last digit is rounded.
    """
    known = range_of(key)
    most = DECIMALS.get(known.unit, 3)
    number = whole(10**most * known.scale * shown) / 10**most
    decimals = max(len(f"{known.step:g}".partition(".")[2]), len(f"{number:.{most}f}".rstrip("0").partition(".")[2]))
    return f"{number:.{decimals}f} {known.unit}".rstrip()


def parse(key: str, text: str, scene: Scene, last: str = "") -> float:
    """The SI number of a typed text such as "11,8", "1/4 in", "15 oz". last: see `with_unit`."""
    bare = text.strip().replace(",", ".").replace("−", "-")
    if len(text) > MAX_TEXT or not bare:
        raise ValueError(f"must be a number of at most {MAX_TEXT} characters")
    unit, unitless = range_of(key).unit, UNITLESS.fullmatch(bare)
    if key == "offset" and not unitless:
        return _check_limits(key, Quantity("m").read(bare) / scene.ball.radius, text, scene)
    if not unit:
        return _check_limits(key, Quantity("").read(_float(bare)), text, scene)
    complete = with_unit(key, bare, last)
    return _check_limits(key, Quantity(SI.get(unit, unit)).read(complete), complete, scene)


def with_unit(key: str, text: str, last: str = "") -> str:
    """A typed text with its unit; the default is that of ``last``, the previous input, else the displayed one.

    A fraction is in inches unless it has a unit.
    """
    unit = range_of(key).unit
    if not unit or not UNITLESS.fullmatch(text.replace(",", ".").replace("−", "-")):
        return text
    typed = split_quantity(last.replace(",", "."))[1] or unit
    if unit == "mm" and "/" in plain_fractions(text) and unit_of(typed) != unit_of("in"):
        raise ValueError(f"{text.strip()} in or {text.strip()} {typed}?")
    return f"{text} {typed}"


def _float(text: str) -> Any:
    """A bare number; the text itself if it is none."""
    try:
        return float(text)
    except ValueError:
        return text


def limits(key: str, scene: Scene) -> tuple[float, float, str]:
    """The limits of typed values, SI, and the reason of each; they depend on the cue."""
    known, cue = range_of(key), scene.shaft
    least, most, why = known.least / known.scale, known.most / known.scale, ""
    if key == "bore_width" and (bore := Layout.of(cue).bore):
        narrow = min(min(cue.segments[i].tip_diameter, cue.segments[i].butt_diameter) for i in bore)
        wall, around = quantity_text(MIN_WALL, "m"), quantity_text(narrow, "m", decimals=2)
        most, why = narrow - 2 * MIN_WALL, f"a wall of {wall} in {around}"
    elif key == "bore_depth":
        mouth = quantity_text(bore_mouth(cue), "m", decimals=0)
        most, why = max_bore_depth(cue), f"to the end, from {mouth} behind the tip"
    elif key == "dome":
        tip = quantity_text(scene.tip_diameter, "m", decimals=2)
        least, why = max(least, scene.tip_diameter / 2), f"half of the tip's {tip}"
    return least, most, why


def _check_limits(key: str, new: float, text: str, scene: Scene) -> float:
    least, most, why = limits(key, scene)
    if math.isnan(new) or not least * (1 - 1e-9) <= new <= most * (1 + 1e-9):
        if low := not new > least:
            size, end = "small: at least", value_text(key, least, lambda x: math.ceil(x - 1e-6))
        else:
            size, end = "large: at most", value_text(key, most, lambda x: math.floor(x + 1e-6))
        reason = f" ({why})" if why and low == (key == "dome") else ""
        raise ValueError(f"{text.strip()} is too {size} {end}{reason}.")
    return new
