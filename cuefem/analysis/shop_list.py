"""The shafts of a shop in one list: squirt, its difference from the first shaft, and what a maker can check of each."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from cuefem.analysis.comparison import with_same_stroke
from cuefem.analysis.verdict import verdict
from cuefem.files import write_atomically
from cuefem.files.cue_names import INSIDE_ASSUMED
from cuefem.files.reference_cues import inside_mark
from cuefem.results.closed_forms import pivot_length
from cuefem.results.progress import Progress
from cuefem.results.quantities import DASH, drawn_mass, format_value
from cuefem.results.records import Record, Table, tabulate
from cuefem.results.solved_design import SolvedDesign
from cuefem.results.uncertainty import difference_record, model_share, shaft_uncertainty
from cuefem.scene import Scene
from cuefem.show.analysis import Answer
from cuefem.show.renderers import csv_text

# Of a .csv: heading, name, and factor from SI.
CSV_COLUMNS = (
    ("squirt, deg", "squirt", math.degrees(1.0)),
    ("difference from the first, %", "difference", 100.0),
    ("error of the difference, %", "error", 100.0),
    ("weight with tip, g", "shaft_mass", 1e3),
    ("stiffness, N/m", "tip_stiffness", 1.0),
    ("tap tone, Hz", "frequency", 1.0),
    ("pivot length, mm", "pivot_length", 1e3),
    ("tip, mm", "tip_diameter", 1e3),
)


@dataclass(frozen=True)
class ShopList(Answer):
    """Shafts sorted by squirt, each compared with the first one.

    Parameters
    ----------
    first : str
        The shaft with which the others are compared.
    offset, speed : float
        Offset b/R and speed, m/s, of the stroke of all shafts.
    uncertainty : float
        Largest relative uncertainty of one shaft's own squirt, 1 sigma; most of it is common to all.
    shafts : list of dict
        Of each shaft "name", "squirt", rad, "difference" from the first, relative, its "error" and whether both are
        "distinct"; "shaft_mass" with its tip, kg, "tip_stiffness", N/m, "frequency" of the first mode, Hz,
        "pivot_length" and "tip_diameter", m. Lowest squirt first.
    unread : dict of str to str
        Files that have no answer, and why.
    marks : dict of str to str
        Daggers of the shafts whose inside is assumed.
    """

    first: str
    offset: float
    speed: float
    uncertainty: float
    shafts: list[Record]
    unread: dict[str, str] = field(default_factory=dict)
    marks: dict[str, str] = field(default_factory=dict, repr=False)

    def problem(self) -> str:
        """How many files have no answer."""
        count = len(self.unread)
        return f"{count} of {count + len(self.shafts)} files have no answer" if count else ""

    def headline(self) -> str:
        """How many shafts, and their range of squirt."""
        low, high = (format_value("squirt", row["squirt"]) for row in (self.shafts[0], self.shafts[-1]))
        return f"{len(self.shafts)} shafts, squirt {low} to {high}"

    def tables(self) -> list[Table | str]:
        """A row for each shaft; grey where it is not distinct from the first."""
        columns: Any = {
            "shaft": lambda row: f"{row['name']}{self.marks.get(row['name'], '')}",
            "squirt": "squirt",
            f"difference from {self.first}": _difference,
            "weight with tip": "shaft_mass",
            "stiffness": "tip_stiffness",
            "tap tone": "{frequency:.0f} Hz",
            "pivot length": "pivot_length",
            "tip": "tip_diameter",
        }
        stroke = f"b/R {self.offset:.3g} at {format_value('speed', self.speed)}"
        table = tabulate(
            "Shafts by squirt",
            columns,
            self.shafts,
            f"Same stroke, {stroke}. ± of a difference: 1σ of the model and of unmeasured wood; grey: not distinct. "
            f"Squirt of one shaft: ± {100 * self.uncertainty:.0f} % (1σ), of which most is common to all.",
            "Stiffness: static, at the tip, joint end clamped. Tap tone: first natural frequency, joint end free. "
            "Pivot length: at this offset.",
            *([INSIDE_ASSUMED] if any(self.marks.values()) else []),
        )
        styles = {i: "dim" for i, row in enumerate(self.shafts) if row["name"] != self.first and not row["distinct"]}
        red = {i: "red" for i in range(len(self.unread))}
        unread = Table("No answer", ("file", "why"), tuple(self.unread.items()), texts=(0, 1), styles=red)
        return [replace(table, styles=styles, more=(3, 6, 7)), *([unread] if self.unread else [])]

    def save(self, path: str | Path) -> None:
        """Write the record (.json), a page (.html) or the numbers (.csv)."""
        path = Path(path)
        if path.suffix.lower() != ".csv":
            super().save(path)
            return
        head, *rows = self.plain_rows()
        text = "\ufeff" + csv_text(head, rows)
        write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))

    def plain_rows(self) -> list[tuple[str, ...]]:
        """Head and rows of a .csv: numbers alone, in the units of its head; a reason where there are none."""
        head = ("shaft", *(heading for heading, _, _ in CSV_COLUMNS), "distinct", "problem")
        rows = [
            (
                row["name"],
                *(f"{factor * row[name]:.6g}" for _, name, factor in CSV_COLUMNS),
                "yes" if row["distinct"] else "no",
                "",
            )
            for row in self.shafts
        ]
        blank = ("",) * (len(CSV_COLUMNS) + 1)
        return [head, *rows, *((name, *blank, why) for name, why in self.unread.items())]


def shop_list(
    scenes: Mapping[str, Scene], *, unread: Mapping[str, str] | None = None, progress: Progress = list
) -> ShopList:
    """List the shafts of a shop by squirt, with the difference of each from the first one.

    Parameters
    ----------
    scenes : mapping of str to Scene
        Strokes by the names of their shafts, as `usual_scene` makes them; ball and stroke are those of the first.
    unread : mapping of str to str, optional
        Names of shafts without a scene, and why, which the list shows too.
    progress : callable
        Wraps the list of shafts, to show progress.

    Returns
    -------
    ShopList
        ``save("list.csv")``, ".html" or ".json" writes it.

    Raises
    ------
    ValueError
        Without a shaft that has a squirt.

    Examples
    --------
    >>> import cuefem as cf
    >>> names = ("plain maple", "low deflection", "carbon")
    >>> made = cf.shop_list({name: cf.usual_scene(cf.load(name)) for name in names})
    >>> [row["name"] for row in made.shafts][0], made.shafts[0]["distinct"]
    ('carbon', True)
    """
    missing, rows, uncertainties = dict(unread or {}), list[Record](), list[float]()
    struck = with_same_stroke(scenes) if scenes else {}
    solved: dict[str, tuple[Scene, float, float]] = {}
    for name in progress([*struck]):
        design = SolvedDesign.of(struck[name])
        try:
            own = verdict(design, {})
            rows.append({"name": name, "squirt": own.squirt, **_numbers(design)})
        except (ValueError, RuntimeError) as error:
            missing[name] = str(error)
            continue
        solved[name] = (struck[name], own.squirt, shaft_uncertainty(own.inputs))
        uncertainties.append(own.uncertainty["total"])
    if not rows:
        why = "; ".join(f"{name}: {text}" for name, text in missing.items())
        raise ValueError(f"no shaft has a squirt to list{f': {why}' if why else ''}")
    first = rows[0]["name"]
    compared = [row | _compared(solved[row["name"]], solved[first]) for row in rows]
    compared.sort(key=lambda row: row["squirt"])
    stroke = struck[first].stroke
    marks = {name: inside_mark(name, scene) for name, (scene, _, _) in solved.items()}
    return ShopList(first, float(stroke.offset), float(stroke.speed), max(uncertainties), compared, missing, marks)


def _numbers(design: SolvedDesign) -> Record:
    """What a maker can check of a shaft."""
    scene = design.scene
    return {
        "shaft_mass": drawn_mass(scene),
        "tip_stiffness": design.tip_stiffness,
        "frequency": design.frequency(1),
        "pivot_length": float(pivot_length(scene, design.squirt())),
        "tip_diameter": scene.tip_diameter,
    }


def _compared(own: tuple[Scene, float, float], first: tuple[Scene, float, float]) -> Record:
    """The difference of squirt of a shaft from the first one's."""
    (scene, squirt, inputs), (other, reference, other_inputs) = own, first
    if own is first:
        return {"difference": 0.0, "error": 0.0, "distinct": False}
    return difference_record(squirt / reference, model_share(other, scene), inputs, other_inputs)


def _difference(row: Mapping[str, Any]) -> str:
    if not row["error"]:
        return DASH
    return f"{100 * row['difference']:+.1f} ± {100 * row['error']:.1f} %".replace("-", "−")
