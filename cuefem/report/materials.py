"""The materials: record and table."""

from __future__ import annotations

from dataclasses import asdict

from rich.console import Group

from cuefem.materials import MATERIALS
from cuefem.report.record import UNITS, Record
from cuefem.report.table import table_of, with_caption


def materials_record() -> Record:
    """The materials that a file can name: values, ranges, sources."""
    return {
        "materials": {
            name: {
                **asdict(known.material),
                "ranges": {key: list(ends) for key, ends in known.ranges.items()},
                "source": known.source,
                "note": known.note,
            }
            for name, known in MATERIALS.items()
        },
        "units": {name: UNITS[name] for name in ("E", "G", "rho")},
    }


def materials_table(record: Record) -> Group:
    """Materials: modulus, shear modulus and density with their ranges, loss factor; sources."""
    table = table_of("Materials", ["name", "E, GPa", "G, GPa", "rho, kg/m³", "loss"])
    for name, values in record["materials"].items():
        cells = (_with_range(values, key, scale=scale) for key, scale in (("E", 1e9), ("G", 1e9), ("rho", 1.0)))
        table.add_row(name, *cells, f"{values['loss']:g}")
    sources = (f"{name}: {values['source']}" for name, values in record["materials"].items())
    return with_caption(table, "with the ranges in which real pieces lie; `cuefem materials --json` has more", *sources)


def _with_range(values: Record, key: str, *, scale: float) -> str:
    low, high = values["ranges"][key]
    return f"{values[key] / scale:.4g} ({low / scale:.4g}–{high / scale:.4g})"
