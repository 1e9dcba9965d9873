"""Additions to a drawing: material of the shaft, front of leather, ferrule, bore.

`SHAFT_ADDITIONS` declares them; the options of the commands and the fields of the designer follow from it.
"""

from __future__ import annotations

import math
import re
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple

from cuefem.cue import MAX_LEATHER_MODULUS, POSITION_TOLERANCE, Cue, Material, Segment
from cuefem.cue.materials import material as material_of
from cuefem.parameters.parts import MAX_FERRULE, Layout, split_at
from cuefem.parameters.scene_changes import with_parameters
from cuefem.quantity.display_units import displayed_system, with_unit
from cuefem.quantity.unit_checks import MIN_CUE_MASS
from cuefem.quantity.units import parse_number
from cuefem.scene import Scene

MAX_LEATHER = 0.03  # m, height of leather
TENON_RATIO = 0.62  # tenon over ferrule diameter: 5/16 in in a pool ferrule of 12.75 mm
# Examples, by the system of units displayed.
EXAMPLES = {
    "metric": {"ferrule": "25 mm melamine", "bore": "6 mm wide, 127 mm deep", "front": "leather 6 mm"},
    "us": {"ferrule": "1 in melamine", "bore": "1/4 in wide, 5 in deep", "front": "leather 1/4 in"},
}

_SIZE = re.compile(r"[\d.,/ ¼-¾⅐-⅞-]*[\d¼-¾⅐-⅞]\s*(?:mm|cm|m|in|inch|inches|\"|″)(?!\w)")
_BORE = re.compile(r"(.+)\bwide\s*,\s*(.+)\bdeep")


class ShaftAddition(NamedTuple):
    """An addition to a drawing: metavar and help of its option, title of its field."""

    metavar: str
    title: str
    help: str


def example(key: str) -> str:
    """An example of an addition's text, in the units displayed."""
    return EXAMPLES[displayed_system()][key]


def _both(key: str) -> str:
    return " or ".join(f'"{texts[key]}"' for texts in EXAMPLES.values())


SHAFT_ADDITIONS = {
    "material": ShaftAddition(
        "NAME", "Material of the shaft", "Material of the shaft, instead of the one in FILE (see `cuefem parts`)."
    ),
    "length_unit": ShaftAddition(
        "UNIT", "Unit of length", "Length unit of a CAD surface (default: mm), or of a .csv whose header names none."
    ),
    "front": ShaftAddition(
        "WHERE",
        "Front of the drawing",
        f'What the front of the .csv profile or CAD surface is: "ferrule" (default), {_both("front")}.',
    ),
    "ferrule": ShaftAddition(
        "FERRULE",
        "Ferrule",
        f'Ferrule at the front, {_both("ferrule")}, on a wooden tenon ("tenon 8 mm", "no tenon"); "none" removes it.',
    ),
    "bore": ShaftAddition(
        "BORE",
        "Bore",
        f"Bore, drilled from behind the tenon of the ferrule, or from the front: {_both('bore')}.",
    ),
}


def with_additions(cue: Cue, **texts: str | None) -> Cue:
    """The cue with another material of its shaft, a leather front, a ferrule and a bore given as texts.

    ValueError with the name of an invalid one.
    """
    adding = {"material": _with_shaft_material, "front": _with_leather, "ferrule": _with_ferrule, "bore": _bored}
    for name, add in adding.items():
        if (text := texts.get(name)) is not None:
            try:
                cue = add(cue, text)
            except ValueError as error:
                raise ValueError(f"{name}: {error}") from None
    return cue


def _with_shaft_material(cue: Cue, name: str) -> Cue:
    """The cue with shaft and tenon of another material."""
    return _with_parameters(cue, {"shaft material": name})


def _with_parameters(cue: Cue, changes: dict[str, Any]) -> Cue:
    """The cue with other parameters; a scene of a shaft that has no butt yet would warn."""
    whole = replace(cue, body_mass=cue.body_mass or MIN_CUE_MASS)
    changed = with_parameters(Scene(whole), changes).shaft
    return replace(changed, body_mass=cue.body_mass)


def _with_leather(cue: Cue, text: str) -> Cue:
    """The cue with leather of the height in the text at its front; unchanged for "ferrule"."""
    words = text.strip().casefold()
    if words == "ferrule":
        return cue
    height = words.removeprefix("leather").strip()
    if height in (words, ""):
        raise ValueError(f'must be "ferrule" or leather with a height, such as "{example("front")}"; got {text!r}')
    if cue.leather_height:
        raise ValueError("must be omitted: the drawing already has leather")
    end = _length(height)
    if end > MAX_LEATHER:
        raise ValueError(f"must have at most {with_unit(MAX_LEATHER, 'm', 6)} of leather; got {text!r}")
    cue = split_at(cue, end)
    stop = next(i for i, x in enumerate(cue.nodes) if x >= end * (1 - POSITION_TOLERANCE))
    front = (
        replace(s, material=material_of("leather"), tip_bore=0.0, butt_bore=0.0, core=None) for s in cue.segments[:stop]
    )
    return replace(cue, segments=(*front, *cue.segments[stop:]))


def _with_ferrule(cue: Cue, text: str) -> Cue:
    """The cue with a ferrule behind its leather: on a tenon of the shaft's wood, or bored where the shaft is."""
    layout = Layout.of(cue)
    wood = cue.segments[layout.shaft.start].material
    stripped = [_without_tenon(s, wood) if i in layout.ferrule else s for i, s in enumerate(cue.segments)]
    if text.strip().casefold() == "none":
        return replace(cue, segments=tuple(stripped))
    length, ferrule_material, tenon = _ferrule_of(text)
    first = next(i for i, s in enumerate(stripped) if s.material.E >= MAX_LEATHER_MODULUS)
    start = float(cue.nodes[first])
    longest = min(MAX_FERRULE, 0.9 * (cue.length - start))
    if not 0 < length <= longest:
        raise ValueError(f"must be at most {with_unit(longest, 'm', 3)} long; got {text!r}")
    cue = split_at(replace(cue, segments=tuple(stripped)), start + length)
    stop = next(i for i, x in enumerate(cue.nodes) if x >= (start + length) * (1 - POSITION_TOLERANCE))
    front = (ferrule_on_tenon(s, ferrule_material, wood, tenon) for s in cue.segments[first:stop])
    return replace(cue, segments=(*cue.segments[:first], *front, *cue.segments[stop:]))


def _without_tenon(ferrule: Segment, wood: Material) -> Segment:
    """A segment of the ferrule replaced by the wood of the shaft, its tenon included."""
    filled: dict[str, Any] = {} if ferrule.core is None else {"tip_bore": 0.0, "butt_bore": 0.0, "core": None}
    return replace(ferrule, material=wood, **filled)


def ferrule_on_tenon(
    segment: Segment, ferrule_material: Material, wood: Material, tenon: float | None = None
) -> Segment:
    """The segment as a ferrule on a wooden tenon, m wide, by default `TENON_RATIO` of its width; a bore stays."""
    if tenon and (segment.tip_bore or segment.butt_bore):
        raise ValueError("must have no tenon: the shaft is bored there")
    if segment.tip_bore or segment.butt_bore or tenon == 0:
        return replace(segment, material=ferrule_material)
    first, last = (
        round(TENON_RATIO * d, 9) if tenon is None else tenon for d in (segment.tip_diameter, segment.butt_diameter)
    )
    return replace(segment, material=ferrule_material, tip_bore=first, butt_bore=last, core=wood)


def has_length(text: str) -> bool:
    """Whether the text of a ferrule has a length, as in "25 mm melamine"."""
    return _SIZE.search(text.casefold()) is not None


def _ferrule_of(text: str) -> tuple[float, Material, float | None]:
    """Length, m, material and tenon diameter, m, of a ferrule; the tenon is 0 for "no tenon", None if not mentioned."""
    first, *more = (piece.strip() for piece in text.casefold().split(","))
    size = _SIZE.search(first)
    name = _SIZE.sub(" ", first).replace("ferrule", " ").strip()
    if size is None or not name:
        raise ValueError(f'must be a length and a material, such as "{example("ferrule")}"; got {text!r}')
    tenon = None
    for piece in more:
        if "tenon" not in piece:
            raise ValueError(
                f'must be such as "{example("ferrule")}, tenon 8 mm" or "{example("ferrule")}, no tenon"; got {text!r}'
            )
        width = piece.replace("tenon", " ").strip()
        tenon = 0.0 if width == "no" else _length(width)
    return _length(size[0]), material_of(" ".join(name.split()), "ferrule"), tenon


def _bored(cue: Cue, text: str) -> Cue:
    """The cue with the bore of a text."""
    sizes = _BORE.fullmatch(text.strip().casefold())
    if not sizes:
        raise ValueError(f'must be a width and a depth, such as "{example("bore")}"; got {text!r}')
    width, depth = (_length(size) for size in sizes.groups())
    if Layout.of(cue).bore is None:
        raise ValueError("must be omitted: the drawing has a filled bore")
    return _with_parameters(cue, {"bore depth": depth, "bore width": width})


def _length(text: str) -> float:
    """A length above 0, m, of a text such as "25 mm" or "1/4 in"."""
    length = math.nan
    with suppress(ValueError):
        length = parse_number(text, "m")
    if not 0 < length < math.inf:
        raise ValueError(f'must have lengths above 0 with a unit, such as "25 mm" or "1 in"; got {text.strip()!r}')
    return length
