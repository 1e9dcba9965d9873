"""Catalogue of the parts that a file can name (shafts, materials, tips): record and tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from cuefem.cue.materials import LEATHER_CONSTANTS, LEATHERS, MATERIALS, TIPS, WOODS
from cuefem.files.parts_catalogue import CATALOGUE_SHAFTS
from cuefem.parameters.parameter import FERRULES
from cuefem.results.quantities import RESULTS, units_of, with_heading
from cuefem.results.records import ColumnEntry, Record, Table, tabulate


def parts_record() -> Record:
    """Shafts, materials and tips by name, each with its values, SI, and their source."""
    sources = {name: known.source for name, known in LEATHERS.items()} | {
        name: tip["source"] for name, tip in TIPS.items()
    }
    return {
        "shafts": {name: {"source": known.source} for name, known in CATALOGUE_SHAFTS.items()},
        "materials": {
            name: {
                "use": "wood" if name in WOODS else "ferrule" if name in FERRULES else "",
                **asdict(known.material),
                "ranges": {key: list(ends) for key, ends in known.ranges.items()},
                "source": known.source,
                "note": known.note,
            }
            for name, known in MATERIALS.items()
        },
        "tips": {name: {**LEATHER_CONSTANTS[name], "source": source} for name, source in sources.items()},
        "units": units_of("E", "G", "rho"),
    }


def tabulate_parts(record: Record) -> list[Table]:
    """A table for each kind of part; the notes show how a file and an option name it."""
    source: dict[str, ColumnEntry] = {"source": "{source}"}
    moduli: dict[str, ColumnEntry] = {
        with_heading(name, RESULTS[name].unit): _with_range(name) for name in ("E", "G", "rho")
    }
    return [
        tabulate(
            "Shafts",
            {"name": "{name}", **source},
            _rows(record["shafts"]),
            'shaft = "conical taper" at the top of a .toml',
            texts=(0, 1),
        ),
        tabulate(
            "Materials",
            {"name": "{name}", "use": "{use}", **moduli, "loss": "{loss:g}"},
            _rows(record["materials"]),
            "in brackets the range of real pieces; loss: loss factor; --json has more",
            'wood: material = "ash" at the top of a .toml, a column material, --material "ash"',
            'ferrule: ferrule = "25 mm melamine" there, a column ferrule, --ferrule "25 mm melamine"',
            *(f"{name}: {values['source']}" for name, values in record["materials"].items()),
            texts=(0, 1),
        ),
        tabulate(
            "Tips",
            {"name": "{name}", "E, MPa": lambda row: f"{1e-6 * row['E']:g}", **source},
            _rows(record["tips"]),
            'leather = "kamui soft" of a LeatherTip, --leather "kamui soft"',
            texts=(0, 2),
        ),
    ]


def _rows(parts: Record) -> list[Record]:
    return [{"name": name, **values} for name, values in parts.items()]


def _with_range(name: str) -> ColumnEntry:
    def text(row: Mapping[str, Any]) -> str:
        middle, low, high = (RESULTS[name].scale * value for value in (row[name], *row["ranges"][name]))
        return f"{middle:.4g} ({low:.4g}–{high:.4g})"

    return text
