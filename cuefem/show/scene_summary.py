"""Summaries of a cue, a scene and its effects: as records, and as a line of text each."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import asdict, fields
from typing import Any

from cuefem.cue import Cue, LumpedCue
from cuefem.effects.effect import Effect
from cuefem.files.schema import table as file_table
from cuefem.quantity.display_units import END_MASS, WAVE_SPEED, modulus_text, with_unit
from cuefem.quantity.units import parse_number
from cuefem.results.quantities import format_value
from cuefem.results.records import Record
from cuefem.scene import Scene


def cue_record(cue: Cue | LumpedCue) -> Record:
    """Length, masses and number of segments of a cue, or the parameters of a lumped cue, SI."""
    if not cue.segments:
        return {name: getattr(cue, name) for name in ("mass", "end_mass", "coupling")}
    names = ("length", "mass", "shaft_mass", "body_mass")
    return {name: getattr(cue, name) for name in names} | {"segments": len(cue.segments)}


def scene_record(scene: Scene) -> Record:
    """The cue, ball, tip, stroke and effects of a scene, SI."""
    return {
        "cue": cue_record(scene.cue),
        "ball": asdict(scene.ball),
        "tip": {name: value for name, value in asdict(scene.tip).items() if value is not None}
        | {"contact_time": scene.valid_contact_time},
        "stroke": asdict(scene.stroke),
        "effects": [{"type": type(effect).__name__, **asdict(effect)} for effect in scene.effects],
        "effects_at_tip": [type(effect).__name__ for effect in scene.at_tip],
    }


def stroke_line(scene: Scene) -> str:
    """Ball, tip and stroke as one line of text."""
    ball, tip, time = scene.ball, scene.tip, scene.valid_contact_time
    return ", ".join(
        [
            f"ball {format_value('mass', ball.mass)}, {with_unit(2 * ball.radius, 'm')}",
            f"contact time {'unknown' if time is None else with_unit(time, 's')} (rigid cue head-on)",
            f"tip restitution {tip.restitution:g}",
            f"friction {tip.friction:g}".replace("inf", "∞"),
            f"speed {with_unit(scene.stroke.speed, 'm/s', 6)}",
        ]
    )


def cue_line(cue: Cue | LumpedCue) -> str:
    """A cue as one line of text."""
    whole = format_value("mass", cue.mass)
    if isinstance(cue, LumpedCue):
        return f"lumped cue, {whole}, end mass {format_value('end_mass', cue.end_mass)}"
    count = len(cue.segments)
    masses = f"as drawn {format_value('mass', cue.shaft_mass)}, butt {format_value('mass', cue.body_mass)}"
    return f"{with_unit(cue.length, 'm')} in {count} segment{'s' * (count > 1)}, cue {whole} ({masses})"


def effect_text(effect: Effect) -> str:
    """An effect and its values other than defaults: "PointMass (position 100 mm, mass 5 g)"."""
    defaults = {field.name: field.default for field in fields(effect)}
    entered = {name: value for name, value in file_table(effect).items() if getattr(effect, name) != defaults[name]}
    displayed = {"wave_speed": WAVE_SPEED}
    entries = [f"{name.replace('_', ' ')} {_short(value, displayed.get(name, ''))}" for name, value in entered.items()]
    return type(effect).__name__ + (f" ({', '.join(entries)})" if entries else "")


def plain_effect_line(effect: Effect) -> str:
    """An effect for a reader without its file: "point mass, position 100 mm, mass 5 g"."""
    kind, _, values = effect_text(effect).removesuffix(")").partition(" (")
    return ", ".join(filter(None, (effect_name(kind), values)))


def effect_name(kind: str) -> str:
    """The name of an effect in texts: "point mass" of a `PointMass`."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", kind).lower()


# Units of files whose numbers have a display unit: its key and the SI unit. Masses of effects are those of tips.
_DISPLAYED = {"mm": ("m", "m"), "g": (END_MASS, "kg"), "m/s": ("m/s", "m/s"), "N/m": ("N/m", "N/m")}


def _short(value: Any, displayed: str = "") -> str:
    """A number with its unit to six digits, a Boolean, or a table or list of them, as text."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return " and ".join(map(_short, value))
    if isinstance(value, dict):
        return "of " + ", ".join(f"{name} {_short(number)}" for name, number in value.items())
    number_text, _, unit = str(value).partition(" ")
    if unit in _DISPLAYED:
        key, si = _DISPLAYED[unit]
        return with_unit(parse_number(str(value), si), displayed or key, 6)
    if unit in ("GPa", "MPa"):
        return modulus_text(parse_number(str(value), "Pa"))
    number = float(number_text)
    return f"{number:.6g} {unit}".rstrip()


def listed(names: Sequence[str]) -> str:
    """Names as a list in a sentence: "stick, offset and squirt"."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def tip_effect_notes(scene: Scene, note: str) -> list[str]:
    """The note, if the scene has effects at the tip."""
    return [note] if scene.at_tip else []
