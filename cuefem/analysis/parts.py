"""Catalogue of the parts that a file can name: shafts, materials, tips."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from cuefem.cue.materials import LEATHER_CONSTANTS, LEATHERS, MATERIALS, TIPS, WOODS
from cuefem.files.cue_names import CUES
from cuefem.files.parts_catalogue import CATALOGUE_SHAFTS
from cuefem.files.shaft_additions import example
from cuefem.parameters.table import FERRULES
from cuefem.quantity.display_units import modulus_text, short_number, with_heading
from cuefem.results.quantities import RESULTS, UNITS
from cuefem.results.records import ColumnEntry, Record, Table, tabulate
from cuefem.show.analysis import Answer, Rows


@dataclass(frozen=True)
class Parts(Rows, Answer):
    """Cues, shafts, materials and tips that a file can name.

    Parameters
    ----------
    cues : dict of str to dict
        "file" and "source" of each cue that has a name.
    shafts : dict of str to dict
        "source" of each shaft.
    materials : dict of str to dict
        For each material its "use", "wood", "ferrule" or ""; "E", "G", Pa; "rho", kg/m3; "loss", the loss factor;
        "ranges" of real pieces; "aliases", other names; "source" and "note".
    tips : dict of str to dict
        The constants of each leather in SI, and their "source".
    """

    cues: dict[str, Record]
    shafts: dict[str, Record]
    materials: dict[str, Record]
    tips: dict[str, Record]

    def to_dict(self) -> Record:
        """The record, with the units of its numbers."""
        return {**self.values(), "units": {name: UNITS[name] for name in ("E", "G", "rho")}}

    def frame_rows(self) -> list[Record]:
        """A row for each part: what it is, its name, and what is known of it."""
        kinds = {"cue": self.cues, "shaft": self.shafts, "material": self.materials, "tip": self.tips}
        return [{"kind": kind, "name": name, **known} for kind, of in kinds.items() for name, known in of.items()]

    def tables(self) -> list[Table | str]:
        """A table for each kind of part; the notes show how a file and an option name it."""
        source: dict[str, ColumnEntry] = {"source": "{source}"}
        moduli: dict[str, ColumnEntry] = {
            with_heading(name, RESULTS[name].unit): _with_range(name) for name in ("E", "G", "rho")
        }
        return [
            tabulate(
                "Cues",
                {"name": "{name}", **source},
                _rows(self.cues),
                'instead of a file: cuefem report "plain maple", cuefem compare my.csv "predator z2", cue = "carbon"',
                texts=(0, 1),
            ),
            tabulate(
                "Shafts",
                {"name": "{name}", **source},
                _rows(self.shafts),
                'shaft = "conical taper" at the top of a .toml',
                texts=(0, 1),
            ),
            tabulate(
                "Materials",
                {"name": "{name}", "use": "{use}", **moduli, "loss": "{loss:g}"},
                _rows(self.materials),
                "in brackets the range of real pieces; loss: loss factor; --json has more",
                'wood: material = "ash" at the top of a .toml, a column material, --material "ash"',
                f'ferrule: ferrule = "{example("ferrule")}" there, a column ferrule, --ferrule "{example("ferrule")}"',
                *(_name_and_source(name, values) for name, values in self.materials.items()),
                texts=(0, 1),
            ),
            tabulate(
                "Tips",
                {"name": "{name}", "E": lambda row: modulus_text(row["E"]), **source},
                _rows(self.tips),
                'leather = "kamui soft" of a LeatherTip, --leather "kamui soft"',
                texts=(0, 2),
            ),
        ]


def parts() -> Parts:
    """The cues, shafts, materials (wood, ferrule) and tips that a file can name, with their sources.

    Returns
    -------
    Parts
        Show it with ``print``, in a notebook, or by ``.save("parts.html")``.

    Examples
    --------
    >>> import cuefem as cf
    >>> round(1e-9 * cf.parts().materials["hard maple"]["E"], 2)  # GPa
    13.86
    """
    sources = {name: known.source for name, known in LEATHERS.items()} | {
        name: tip["source"] for name, tip in TIPS.items()
    }
    materials = {
        name: {
            "use": "wood" if name in WOODS else "ferrule" if name in FERRULES else "",
            **asdict(known.material),
            "ranges": {key: list(ends) for key, ends in known.ranges.items()},
            "aliases": list(known.aliases),
            "source": known.source,
            "note": known.note,
        }
        for name, known in MATERIALS.items()
    }
    return Parts(
        cues={name: {"file": cue.file, "source": cue.assumed} for name, cue in CUES.items()},
        shafts={name: {"source": known.source} for name, known in CATALOGUE_SHAFTS.items()},
        materials=materials,
        tips={name: {**LEATHER_CONSTANTS[name], "source": source} for name, source in sources.items()},
    )


def _rows(parts: Record) -> list[Record]:
    return [{"name": name, **values} for name, values in parts.items()]


def _name_and_source(name: str, values: Record) -> str:
    also = f" (also {', '.join(values['aliases'])})" if values["aliases"] else ""
    return f"{name}{also}: {values['source']}"


def _with_range(name: str) -> ColumnEntry:
    def text(row: Mapping[str, Any]) -> str:
        unit = RESULTS[name].unit
        middle, low, high = (short_number(value, unit) for value in (row[name], *row["ranges"][name]))
        return f"{middle} ({low}–{high})"

    return text
