"""What a maker tells of a cue beside its drawing: its material, where it begins, its ferrule, its bore.

Each is declared once in `FITTINGS`, of which the commands' options and the designer's questions are made.
"""

from __future__ import annotations

import math
import re
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple

from cuefem.cue import SOFT, Cue, Material, Segment
from cuefem.cue.materials import material as material_of
from cuefem.parameters.parameter import varied
from cuefem.parameters.parts import LONGEST_FERRULE, SAME, Layout, split_at
from cuefem.quantity.units import number
from cuefem.scene import Scene

HIGHEST = 0.03  # m, of leather
TENON = 0.62  # of a ferrule's width: 5/16 in in a pool ferrule of 12.75 mm
FERRULE, BORE, LEATHER = "25 mm melamine", "6 mm wide, 127 mm deep", "leather 6 mm"

_SIZE = re.compile(r"[\d.,/ ]*\d\s*(?:mm|cm|m|in|inch|inches|\"|″)(?!\w)")
_BETWEEN, _DEEP = re.compile(r",|;|×|\bx\b|\band\b|\bby\b"), re.compile(r"deep|depth|long")
_WORDS = re.compile(r"\b(wide|deep|across|diameter|width|depth|long)\b")


class Fitting(NamedTuple):
    """Something to be told beside a drawing: how an option and a field of a page ask for it."""

    metavar: str
    title: str
    help: str
    example: str = ""


FITTINGS = {
    "material": Fitting(
        "NAME", "Material of the shaft", "Material of the shaft, instead of the one in FILE (see `cuefem parts`)."
    ),
    "length_unit": Fitting(
        "UNIT", "Unit of length", "Length unit of a CAD surface (default: mm), or of a .csv whose header names none."
    ),
    "begins": Fitting(
        "WHERE",
        "The drawing begins at",
        f'What the front of the .csv profile or CAD surface is: "ferrule" (default) or "{LEATHER}".',
        "ferrule",
    ),
    "ferrule": Fitting(
        "FERRULE",
        "Ferrule",
        f'Ferrule at the front, e.g. "{FERRULE}", on a wooden tenon ("tenon 8 mm", "no tenon"); "none" removes it.',
        f"none; or such as {FERRULE}",
    ),
    "bore": Fitting(
        "BORE",
        "Bore",
        f'Bore, drilled from behind the tenon of the ferrule, or from the front: "{BORE}".',
        f"none; or such as {BORE}",
    ),
}


def fitted(thing: Any, *, begins: str | None = None, ferrule: str | None = None, bore: str | None = None) -> Any:
    """The cue or scene with its front of leather, a ferrule and a bore as texts say them; ValueError if none can be."""
    if isinstance(thing, Cue):
        return fitted(Scene(thing), begins=begins, ferrule=ferrule, bore=bore).cue
    if begins is not None:
        thing = replace(thing, cue=_with_leather(thing.shaft, begins))
    if ferrule is not None:
        thing = replace(thing, cue=_with_ferrule(thing.shaft, ferrule))
    return thing if bore is None else _bored(thing, bore)


def with_shaft_of(thing: Any, name: str) -> Any:
    """The cue or scene with the shaft, and the tenon of its wood, of another material."""
    if isinstance(thing, Cue):
        return with_shaft_of(Scene(thing), name).cue
    return varied(thing, {"shaft material": name})


def _with_leather(cue: Cue, text: str) -> Cue:
    """The cue whose front is leather where the text says a height of leather; as it is for "ferrule"."""
    words = text.strip().casefold()
    if words == "ferrule":
        return cue
    height = words.removeprefix("leather").strip()
    if height in (words, ""):
        raise ValueError(f'begins must be "ferrule" or the leather with its height, such as "{LEATHER}"; got {text!r}')
    if cue.leather:
        raise ValueError("begins must be left out: the file names its leather itself")
    end = _length("begins", height)
    if end > HIGHEST:
        raise ValueError(f"begins must have at most {1e3 * HIGHEST:g} mm of leather; got {text!r}")
    cue = split_at(cue, end)
    stop = next(i for i, x in enumerate(cue.nodes) if x >= end * (1 - SAME))
    front = (
        replace(s, material=material_of("leather"), tip_bore=0.0, butt_bore=0.0, core=None) for s in cue.segments[:stop]
    )
    return replace(cue, segments=(*front, *cue.segments[stop:]))


def _with_ferrule(cue: Cue, text: str) -> Cue:
    """The cue with a ferrule behind its leather: on a tenon of the shaft's wood, or bored where the shaft is."""
    layout = Layout.of(cue)
    wood = cue.segments[layout.shaft.start].material
    bare = [_without_tenon(s, wood) if i in layout.ferrule else s for i, s in enumerate(cue.segments)]
    if text.strip().casefold() == "none":
        return replace(cue, segments=tuple(bare))
    length, stuff, tenon = _ferrule_of(text)
    first = next(i for i, s in enumerate(bare) if s.material.E >= SOFT)
    start = float(cue.nodes[first])
    longest = min(LONGEST_FERRULE, 0.9 * (cue.length - start))
    if not 0 < length <= longest:
        raise ValueError(f"ferrule must be at most {1e3 * longest:.3g} mm long; got {text!r}")
    cue = split_at(replace(cue, segments=tuple(bare)), start + length)
    stop = next(i for i, x in enumerate(cue.nodes) if x >= (start + length) * (1 - SAME))
    front = (on_tenon(s, stuff, wood, tenon) for s in cue.segments[first:stop])
    return replace(cue, segments=(*cue.segments[:first], *front, *cue.segments[stop:]))


def _without_tenon(ferrule: Segment, wood: Material) -> Segment:
    """A ferrule that is taken off: the shaft's wood in its place, and the tenon part of it."""
    filled: dict[str, Any] = {} if ferrule.core is None else {"tip_bore": 0.0, "butt_bore": 0.0, "core": None}
    return replace(ferrule, material=wood, **filled)


def on_tenon(segment: Segment, stuff: Material, wood: Material, tenon: float | None = None) -> Segment:
    """The segment as a ferrule on a tenon of wood, m wide, by default `TENON` of its width; a bored one stays bored."""
    if tenon and (segment.tip_bore or segment.butt_bore):
        raise ValueError("ferrule must be told without a tenon: the shaft is bored there")
    if segment.tip_bore or segment.butt_bore or tenon == 0:
        return replace(segment, material=stuff)
    first, last = (
        round(TENON * d, 9) if tenon is None else tenon for d in (segment.tip_diameter, segment.butt_diameter)
    )
    return replace(segment, material=stuff, tip_bore=first, butt_bore=last, core=wood)


def has_length(text: str) -> bool:
    """Whether the text of a ferrule has a length in it, as "25 mm melamine" has."""
    return _SIZE.search(text.casefold()) is not None


def _ferrule_of(text: str) -> tuple[float, Material, float | None]:
    """Length, material and tenon's width that a text says, m; the tenon is None if it says nothing of it."""
    first, *more = (piece.strip() for piece in text.casefold().split(","))
    size = _SIZE.search(first)
    name = _SIZE.sub(" ", first).replace("ferrule", " ").strip()
    if size is None or not name:
        raise ValueError(f'ferrule must be a length and a material, such as "{FERRULE}"; got {text!r}')
    tenon = None
    for piece in more:
        if "tenon" not in piece:
            raise ValueError(f'ferrule must be such as "{FERRULE}, tenon 8 mm" or "{FERRULE}, no tenon"; got {text!r}')
        width = piece.replace("tenon", " ").strip()
        tenon = 0.0 if width == "no" else _length("the ferrule's tenon", width)
    return _length("ferrule", size[0]), material_of(" ".join(name.split())), tenon


def _bored(scene: Any, text: str) -> Any:
    """The scene with a bore as the text says it; of two lengths without words the smaller is the width."""
    pieces = [piece for piece in _BETWEEN.split(text.casefold()) if piece.strip()]
    if len(pieces) != 2:
        raise ValueError(f'bore must be a width and a depth, such as "{BORE}"; got {text!r}')
    first, second = (_length("bore", _WORDS.sub("", piece)) for piece in pieces)
    swapped = _DEEP.search(pieces[0]) or (first > second and not _DEEP.search(pieces[1]))
    width, depth = (second, first) if swapped else (first, second)
    if Layout.of(scene.shaft).bore is None:
        raise ValueError("bore must be left out: the one that is drawn is filled")
    return varied(scene, {"bore depth": depth, "bore width": width})


def _length(name: str, text: str) -> float:
    """A length of more than nothing, m; of a text such as "25 mm" or "1/4 in"."""
    length = math.nan
    with suppress(ValueError):
        length = number(text, "m")
    if not 0 < length < math.inf:
        raise ValueError(
            f'{name} must have lengths above 0 with a unit, such as "25 mm" or "1 in"; got {text.strip()!r}'
        )
    return length
