"""The materials: record and table."""

from __future__ import annotations

from dataclasses import asdict

from rich.console import Group

from cuefem.materials import LEATHERS, MATERIALS
from cuefem.report.record import Record
from cuefem.report.table import table_of, with_caption
from cuefem.results.quantities import RESULTS, units_of


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


def materials_table(record: Record) -> Group:
    """Materials: modulus, shear modulus and density with their ranges, loss factor; sources."""
    columns = [f"{name}, {RESULTS[name].shown_unit}" for name in ("E", "G", "rho")]
    table = table_of("Materials", ["name", *columns, "loss"])
    for name, values in record["materials"].items():
        cells = (_with_range(values, name) for name in ("E", "G", "rho"))
        table.add_row(name, *cells, f"{values['loss']:g}")
    sources = (f"{name}: {values['source']}" for name, values in record["materials"].items())
    leathers = (
        f"{name} leather of a LeatherTip: E {1e-6 * values['E']:g} MPa; {values['source']}"
        for name, values in record["leathers"].items()
    )
    said = "in brackets the range of real pieces; loss: loss factor; `cuefem materials --json` has more"
    return with_caption(table, said, *sources, *leathers)


def _with_range(values: Record, name: str) -> str:
    middle, low, high = (RESULTS[name].scale * value for value in (values[name], *values["ranges"][name]))
    return f"{middle:.4g} ({low:.4g}–{high:.4g})"
