"""The materials: record and sheet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from cuefem.materials import LEATHERS, MATERIALS
from cuefem.results.quantities import RESULTS, units_of, with_heading
from cuefem.results.records import Entry, Record, Sheet, sheet


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


def _with_range(name: str) -> Entry:
    def text(row: Mapping[str, Any]) -> str:
        middle, low, high = (RESULTS[name].scale * value for value in (row[name], *row["ranges"][name]))
        return f"{middle:.4g} ({low:.4g}–{high:.4g})"

    return text
