"""Materials of cues, tip leathers and commercial tips, by name: `materials.toml`."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from cuefem.cue.geometry import Material
from cuefem.quantity.display_units import modulus_text, with_unit
from cuefem.quantity.fields import check_kind, suggestion


class MaterialEntry(NamedTuple):
    """A material, the ranges of its properties (SI; keys E, G, rho, loss, nu), and its source.

    aliases: other names, of the trade. is_class: whether it stands for materials of which nobody publishes a modulus,
    so that its E and density are uncertain inputs.
    """

    material: Material
    ranges: Mapping[str, tuple[float, float]]
    source: str
    note: str
    aliases: tuple[str, ...]
    is_class: bool


class LeatherEntry(NamedTuple):
    """The leather of a tip (`cuefem.LeatherTip`), SI, and the source of its numbers.

    contact_time: of a centre-ball impact of a whole cue at 2 m/s, s; it determines E, with the tip's restitution.
    """

    E: float
    nu: float
    rho: float
    restitution: float
    contact_time: float
    source: str


def _entry(row: Mapping[str, Any]) -> MaterialEntry:
    numbers = {field.name: row[field.name] for field in fields(Material) if field.name in row}
    ranges = {name: (low, high) for name, (low, high) in row["ranges"].items()}
    return MaterialEntry(
        material=Material(**numbers),
        ranges=MappingProxyType(ranges),
        source=row["source"],
        note=row.get("note", ""),
        aliases=tuple(row.get("aliases", ())),
        is_class=row.get("is_class", False),
    )


_TABLES = tomllib.loads(Path(__file__).with_name("materials.toml").read_text(encoding="utf-8"))
_ROWS = _TABLES["materials"]
MATERIALS: Mapping[str, MaterialEntry] = MappingProxyType({name: _entry(row) for name, row in _ROWS.items()})
WOODS = tuple(name for name, row in _ROWS.items() if row["kind"] == "wood")
LEATHERS: Mapping[str, LeatherEntry] = MappingProxyType(
    {name: LeatherEntry(**row) for name, row in _TABLES["leathers"].items()}
)


def leather_restitution(E: float) -> float:
    """Restitution of a tip by the E of its leather, interpolated over log E between `LEATHERS`."""
    moduli, restitutions = np.array(sorted((leather.E, leather.restitution) for leather in LEATHERS.values())).T
    return float(np.interp(np.log(E), np.log(moduli), restitutions))


# Commercial tips: the name of the leather of each, and the source.
TIPS: Mapping[str, Mapping[str, str]] = MappingProxyType(_TABLES["tips"])
# Leathers by their own names and by those of tips.
LEATHER_BY_NAME: Mapping[str, LeatherEntry] = MappingProxyType(
    {**LEATHERS, **{name: LEATHERS[tip["leather"]] for name, tip in TIPS.items()}}
)
# E, nu and rho by the name of the leather or the tip, for files, options and the designer.
LEATHER_CONSTANTS: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {name: {field: getattr(entry, field) for field in ("E", "nu", "rho")} for name, entry in LEATHER_BY_NAME.items()}
)
_ALIASES = {alias: name for name, row in _ROWS.items() for alias in row.get("aliases", ())}
FERRULE_KINDS = ("plastic", "metal")


def material(name: str, use: str = "") -> Material:
    """The material of a name in the table of materials (`cuefem parts`).

    Parameters
    ----------
    name : str
        Such as "hard maple", in any case, with blanks, hyphens or underscores.
    use : {"", "ferrule"}
        What the material is for: an error offers materials of that use.

    Returns
    -------
    Material
        Its E and G, Pa, rho, kg/m³, loss factor and Poisson's ratio.

    Raises
    ------
    ValueError
        If the table has no such name; the message has similar ones.

    Examples
    --------
    >>> import cuefem as cf
    >>> maple = cf.material("Hard maple")
    >>> maple.E, maple.rho, cf.Segment(0.7, 0.012, 0.021, maple).mass
    (13860000000.0, 705.6, 0.108230...)
    """
    check_kind("material name", name, str)
    key = " ".join(name.replace("_", " ").replace("-", " ").casefold().split())
    key = _ALIASES.get(key, key)
    if key not in MATERIALS:
        raise ValueError(_unknown(name, key, use))
    return MATERIALS[key].material


def _unknown(name: str, key: str, use: str) -> str:
    """The message for a name that the table lacks: a similar one, or the names of that use."""
    if use != "ferrule":
        return f"unknown material {name!r}" + (
            suggestion(key, [*MATERIALS, *_ALIASES]) or f"; choose {', '.join(MATERIALS)}"
        )
    offered = [each for each, row in _ROWS.items() if row["kind"] in FERRULE_KINDS]
    names = [*offered, *(alias for each in offered for alias in MATERIALS[each].aliases)]
    own = "or give its E and density in a .toml (cuefem guide files)"
    hint = suggestion(key, names) or f"; choose {', '.join(offered)}; {own}"
    return f"unknown ferrule material {name!r}{hint}"


def table_name(material: Material) -> str | None:
    """The name of a material in the table, or of one of another density alone; None for other materials."""
    similar = (name for name, entry in MATERIALS.items() if replace(entry.material, rho=material.rho) == material)
    return next((name for name, entry in MATERIALS.items() if entry.material == material), next(similar, None))


def material_name(material: Material) -> str:
    """A material's name in the table of materials, with its density if that differs from the table; or its modulus."""
    name = table_name(material)
    if name is None:
        return f"E {modulus_text(material.E)}"
    return (
        name if MATERIALS[name].material == material else f"{name} of {with_unit(material.rho, 'kg/m^3', decimals=0)}"
    )
