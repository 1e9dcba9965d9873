"""The materials: record and sheet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from cuefem.io.shelf import SHAFTS
from cuefem.materials import LEATHERS, MATERIALS, TIPS, WOODS
from cuefem.results.quantities import RESULTS, units_of, with_heading
from cuefem.results.records import Entry, Record, Sheet, sheet
from cuefem.vary import FERRULES


def materials_record() -> Record:
    """The materials that a file can name, and the leathers of a tip: values, ranges, sources."""
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
        "leathers": {name: asdict(leather) for name, leather in LEATHERS.items()},
        "units": units_of("E", "G", "rho", "contact_time"),
    }


def materials_sheet(record: Record) -> Sheet:
    """Materials: modulus, shear modulus and density with their ranges, loss factor; sources."""
    known = record["materials"].items()
    return sheet(
        "Materials",
        {
            "name": "{name}",
            **{with_heading(name, RESULTS[name].unit): _with_range(name) for name in ("E", "G", "rho")},
            "loss": "{loss:g}",
        },
        [{"name": name, **values} for name, values in known],
        "in brackets the range of real pieces; loss: loss factor; `cuefem materials --json` has more",
        *(f"{name}: {values['source']}" for name, values in known),
        *(
            f"{name} leather of a LeatherTip: E {1e-6 * values['E']:g} MPa; {values['source']}"
            for name, values in record["leathers"].items()
        ),
    )


def parts_record() -> Record:
    """The parts of which a cue is put together, each with its source, and how a file and an option name them."""
    sources = {name: known.source for name, known in MATERIALS.items()}
    return {
        "shafts": {name: known.source for name, known in SHAFTS.items()},
        "woods": {name: sources[name] for name in WOODS},
        "ferrules": {name: sources[name] for name in FERRULES},
        "tips": {name: known.source for name, known in LEATHERS.items()} | {name: tip[1] for name, tip in TIPS.items()},
        "named": PART_NAMES,
    }


PART_NAMES = {
    "shafts": 'shaft = "conical taper" at the top of a .toml',
    "woods": 'material = "ash" beside it, a column material, --material "ash"',
    "ferrules": 'ferrule = "25 mm melamine" beside it, a column ferrule, --ferrule "25 mm melamine"',
    "tips": 'leather = "kamui soft" of a LeatherTip, --leather "kamui soft"',
}


def parts_sheets(record: Record) -> list[Sheet]:
    """A table of parts and their sources for each kind of part."""
    return [
        sheet(
            kind.capitalize(),
            {"name": "{name}", "source": "{source}"},
            [{"name": name, "source": source} for name, source in record[kind].items()],
            how,
            texts=(0, 1),
        )
        for kind, how in record["named"].items()
    ]


def _with_range(name: str) -> Entry:
    def text(row: Mapping[str, Any]) -> str:
        middle, low, high = (RESULTS[name].scale * value for value in (row[name], *row["ranges"][name]))
        return f"{middle:.4g} ({low:.4g}–{high:.4g})"

    return text
