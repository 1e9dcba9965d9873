"""Verdict on a cue: its squirt with its uncertainty, compared with that of reference cues at the same stroke."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import NamedTuple

from cuefem.cue import Cue
from cuefem.files.cue_names import CUES, INSIDE_ASSUMED
from cuefem.files.defaults_report import Assumption
from cuefem.files.reference_cues import reference_cues
from cuefem.measurements.calibration import CalibratedSquirt, Calibration
from cuefem.parameters.parts import shaft_word
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import off_line, to_display, with_unit
from cuefem.results.differences import difference_text
from cuefem.results.records import Record, ScaleCell, Table
from cuefem.results.solved_design import Solvable, SolvedDesign, off_centre
from cuefem.results.uncertainty import (
    NUMERICAL_ERROR,
    SHAFT_ERROR,
    SPRING_ERROR,
    Uncertainty,
    difference_record,
    miscue_note,
    model_error,
    model_share,
    shaft_uncertainty,
    squirt_inputs,
    squirt_of,
)
from cuefem.results.verdict import reject_no_verdict
from cuefem.scene import Scene
from cuefem.scene.default_scene import without_leather
from cuefem.show.analysis import Analysis

BAR = 32  # characters of the scale in a terminal
LEAST_PART = 0.5e-3  # of squirt, that is shown beside an assumption
# The uncertain inputs of an assumption on more than the parameter of its own name.
INPUTS_OF = {
    "material": ("E", "G"),
    "shaft_mass": ("rho",),
    "game": ("wave_speed",),
    "ferrule_class": ("ferrule E", "ferrule density"),
}


class ScaleRow(NamedTuple):
    """A cue on the scale: name, squirt and difference as text; kind "own" for the design, "other" for the compared one;
    position and interval (1σ), per cent of the scale; mark of a name whose cue's inside is assumed."""

    name: str
    text: str
    difference: str
    kind: str
    at: float
    low: float
    high: float
    mark: str = ""


@dataclass(frozen=True)
class Verdict(Analysis):
    """Squirt of a stroke with its uncertainty, beside that of reference cues.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    offset : float
        Offset b/R of the verdict.
    head_on : bool
        Whether that offset is the default one, instead of that of a head-on stroke.
    squirt : float
        Squirt, rad, signed.
    uncertainty : dict of str to float
        Relative uncertainty of squirt (1 sigma) by its cause, "model", "inputs" and "computation", and "total", these
        in quadrature.
    inputs : dict of str to float
        Relative part of each uncertain parameter in "inputs".
    squirt_error : float
        Uncertainty of squirt (1 sigma), rad.
    references : dict of str to dict
        By the name of each reference cue "squirt", rad; "difference", squirt of the scene over it less 1, both at the
        default resolution; "error" of the difference (1 sigma); "distinct", whether the difference exceeds it. A cue
        whose strike fails, or whose squirt is zero or of the opposite sign, is left out.
    miscues : tuple of str
        Inputs that make the stroke a miscue one standard deviation up or down: their part is that of the other side.
    calibrated : CalibratedSquirt or None
        The calibration by which squirt and its uncertainty are given, and the squirts of the reference cues, which
        carry the same factor.
    """

    offset: float
    head_on: bool
    squirt: float
    uncertainty: dict[str, float]
    inputs: dict[str, float]
    squirt_error: float
    references: dict[str, Record]
    miscues: tuple[str, ...] = ()
    calibrated: CalibratedSquirt | None = None

    @property
    def factor(self) -> float:
        """Shown over computed squirt."""
        return self.calibrated.factor if self.calibrated else 1.0

    def headline(self) -> str:
        """Squirt with its uncertainty as one line."""
        squirt, error = self.squirt_text()
        distance, per = off_line(abs(self.squirt))
        where = f"at b/R {self.offset:.4g}, {offset_text(self.offset)}"
        if self.head_on:
            where += "; the stroke itself is head-on"
        return f"squirt {squirt.rstrip('°')} ± {error} ({where}): the ball is {distance} off line after {per}"

    def squirt_text(self) -> tuple[str, str]:
        """Squirt and its uncertainty as text: "1.82°" and "0.31°"."""
        squirt, error = abs(self.squirt), self.squirt_error
        decimals = 3 if error and to_display(error, "rad") < 0.01 else 2
        return with_unit(squirt, "rad", decimals=decimals), with_unit(error, "rad", decimals=decimals)

    def off_line_text(self) -> str:
        """How far off line the ball is, with the uncertainty: "30.9 ± 5.9 mm off line after 1 m"."""
        distance, per = off_line(abs(self.squirt), self.squirt_error)
        return f"{distance} off line after {per}"

    def reference_comparison(self) -> list[str]:
        """Squirt relative to the first reference cue as a sentence; empty without reference cues."""
        return [
            f"{squirt_difference(own['difference'], own['error'], own['distinct'])} a {first} shaft with the same tip."
            for first, own in [*self.references.items()][:1]
        ]

    def uncertainty_line(self) -> str:
        """The parts of the uncertainty as one line, with what a calibration rests on."""
        parts = {name: _percent(share) for name, share in self.uncertainty.items()}
        tip = "spring tip; " if self.uncertainty["model"] == SPRING_ERROR else ""
        note, shaft = miscue_note(self.miscues), shaft_word(self.scene)
        source, unmeasured, basis = f"{tip}from published squirt", f"{shaft} and tip", ""
        if self.calibrated:
            source, unmeasured, basis = f"calibrated on {self.calibrated.name}", shaft, f" {self.calibrated.basis()}"
        return (
            f"±: uncertainty (1σ): model {parts['model']} ({source}), unmeasured {unmeasured} {parts['inputs']}, "
            f"numerical {parts['computation']}; combined {parts['total']}.{basis} Of a difference between "
            f"two shafts: {_percent(SHAFT_ERROR)} of it (model) or that of their {shaft} if larger, and 1 % of squirt."
            f"{f' {note}' if note else ''}"
        )

    def by_part(self, notes: Sequence[Assumption]) -> list[Assumption]:
        """Assumptions by their part of the uncertainty, the largest first, with those inputs that none names.

        Of a scene without assumptions none.
        """
        if not notes:
            return []
        parts = [(self._part_of(note), note) for note in notes]
        named = {key for note in notes for key in INPUTS_OF.get(note.key, (note.key,))}
        parts += [
            (share, Assumption("", f"{PARAMETERS[key].label}, uncertain"))
            for key, share in self.inputs.items()
            if key not in named and share >= LEAST_PART
        ]
        parts.sort(key=lambda each: -each[0])  # stable: without a part in the order of the file
        return [
            replace(note, text=f"{note.text}: {100 * part:.1f} % of squirt") if part >= LEAST_PART else note
            for part, note in parts
        ]

    def _part_of(self, note: Assumption) -> float:
        """The part of an assumption in the relative uncertainty."""
        return math.hypot(*(self.inputs.get(key, 0.0) for key in INPUTS_OF.get(note.key, (note.key,))))

    def scale(self, name: str = "yours", others: Mapping[str, float | None] = MappingProxyType({})) -> list[ScaleRow]:
        """The cues by their squirt, the lowest first, the design with its uncertainty; none without reference cues.

        others: squirt, rad, of more cues by their names; None or nan if it has none. One with the name of a reference
        cue replaces it, as does a design of its name and squirt.
        """
        if not self.references:
            return []
        mine, error = abs(self.squirt), self.squirt_error
        squirts = {cue: abs(values["squirt"]) for cue, values in self.references.items()}
        first = next(iter(squirts))
        shown = {} if self.head_on else others
        squirts |= {cue: abs(squirt) for cue, squirt in shown.items() if squirt is not None and math.isfinite(squirt)}
        text, error_text = self.squirt_text()
        decimals = len(text.rstrip("°").partition(".")[2])
        part = 100 / (1.05 * max([mine + error, *squirts.values()]) or 1.0)
        interval = (part * max(0.0, mine - error), part * (mine + error))
        rows = [ScaleRow(name, text, f"± {error_text}", "own", part * mine, *interval)]
        for cue, own in squirts.items():
            if cue == name and with_unit(own, "rad", decimals=decimals) == text:
                continue  # the design is this reference cue
            ratio = round(100 * (own / squirts[first] - 1))
            more = f"{abs(ratio)} % {'less' if ratio < 0 else 'more'} than {first}" if ratio else f"as much as {first}"
            kind = "other" if cue in shown else ""
            row_text = with_unit(own, "rad", decimals=decimals)
            mark = CUES[cue].mark if cue in CUES else ""
            rows.append(ScaleRow(cue, row_text, more if cue != first else "", kind, *3 * (part * own,), mark))
        return sorted(rows, key=lambda row: row.at)

    def tables(self) -> list[Table | str]:
        """Headline, comparison, and the table of reference cues."""
        origin = [self.calibrated.origin(), *self.calibrated.warning_lines()] if self.calibrated else []
        text = [self.headline(), *self.reference_comparison(), *origin, ""]
        uncertainty = self.uncertainty_line()
        if not self.references:
            return [*text, uncertainty, ""]
        rows = self.scale()
        own = {i: "bold" for i, row in enumerate(rows) if row.kind == "own"}
        head = ("cue", "squirt", "less to more squirt", "")
        cells = tuple((f"{row.name}{row.mark}", row.text, _bar(row), row.difference) for row in rows)
        title = "Reference pool cues, with this tip, ball and stroke"
        marks = (INSIDE_ASSUMED,) if any(row.mark for row in rows) else ()
        return [*text, Table(title, head, cells, (*marks, uncertainty), (0, 2, 3), own)]


def verdict(
    scene: Solvable,
    references: Mapping[str, Cue] | None = None,
    calibration: Calibration | None = None,
) -> Verdict:
    """Squirt of a stroke with its uncertainty, compared with reference cues by the same stroke.

    Parameters
    ----------
    scene : Scene, or what `cuefem.solve` returns
        A stroke with a cue of segments or a lumped cue, or a solved one. A head-on stroke, which has no squirt, is
        computed at the game's default offset.
    references : mapping of str to Cue, optional
        The cues to compare with, the one of sentences first; by default the reference cues of pool.
    calibration : Calibration, optional
        Squirt that was measured on another shaft with the same tip.

    Returns
    -------
    Verdict
        Show it with ``print``, in a notebook, or by ``.save("verdict.html")``.

    Raises
    ------
    ValueError
        If the stroke is a miscue, the mass of the cue impossible, the calibration of another game or tip, or the stroke
        beyond the valid range of a law, such as an indentation too large for a leather tip.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> verdict = cf.verdict(scene)
    >>> 0.1 < verdict.squirt_error / verdict.squirt < 0.3, "plain maple" in verdict.references
    (True, True)
    """
    own = SolvedDesign.of(scene)
    return verdict_by(own, references, lambda struck: calibration.squirt(struck) if calibration else None)


def verdict_by(
    own: SolvedDesign, references: Mapping[str, Cue] | None, calibrated: Callable[[Scene], CalibratedSquirt | None]
) -> Verdict:
    """`verdict`; calibrated: the squirt of a stroke by a calibration, asked for once the stroke has a verdict."""
    struck = off_centre(own.scene)
    head_on = struck is not own.scene
    design = SolvedDesign.of(struck) if head_on else own
    outcome = design.strike()
    reject_no_verdict(struck, outcome)
    squirt = float(outcome.squirt)
    # at the resolution of the reference cues, since the outcome may be finer
    base = squirt if outcome.error is None else squirt_of(struck)
    changes = squirt_inputs(struck)
    inputs = {key: abs(change) for key, change in changes.of("squirt").items()}
    computation = NUMERICAL_ERROR if outcome.error is None else outcome.error
    uncertainty = Uncertainty(model_error(struck), math.hypot(*inputs.values()), computation)
    shaft = shaft_uncertainty(inputs)
    found = calibrated(struck)
    factor = found.factor if found else 1.0
    shares = found.uncertainty if found else uncertainty._asdict() | {"total": uncertainty.total}
    compared = reference_cues() if references is None else references
    rows = {name: _reference_row(struck, base, cue, shaft, factor) for name, cue in compared.items()}
    return Verdict(
        own.scene,
        offset=float(struck.stroke.offset),
        head_on=head_on,
        squirt=factor * squirt,
        uncertainty=shares,
        inputs=found.inputs if found else inputs,
        squirt_error=shares["total"] * abs(factor * squirt),
        references={name: row for name, row in rows.items() if row},
        miscues=changes.miscues,
        calibrated=found,
    )


def _reference_row(scene: Scene, squirt: float, cue: Cue, inputs: float, factor: float) -> Record | None:
    """Comparison with another cue at the same stroke; None if its strike fails or the signs of squirt differ.

    squirt: that of the scene, rad. inputs: relative uncertainty of squirt by the inputs of the scene's shaft; the
    same is assumed, independently, for the other shaft. factor: of a calibration; the difference does not depend on it.
    """
    struck = with_cue(scene, cue)
    try:
        other = squirt_of(struck)
    except (ValueError, RuntimeError):
        return None
    if not squirt * other > 0:
        return None
    return {"squirt": factor * other} | difference_record(squirt / other, model_share(scene, struck), inputs, inputs)


def with_cue(scene: Scene, cue: Cue) -> Scene:
    """The scene's ball, tip, stroke and effects with another cue.

    Effects that are part of the scene's own cue (a mass, a joint) or lie beyond the other's end are dropped. The other
    cue retains leather in its drawing only if the scene's own cue has it. A tip that does not fit the other's face is
    adapted (`cuefem.effects.leather_tip.LeatherTip.on_other_cue`).
    """
    has_leather = scene.lumped is None and scene.shaft.leather_height
    other = cue if has_leather else without_leather(cue)
    remaining = (
        e for e in scene.effects if e.at_tip or not (e.part_of_cue or any(x >= other.length for x in e.positions))
    )
    effects = remaining if scene.lumped else (e.on_other_cue(scene.shaft, other) for e in remaining)
    return replace(scene, cue=other, effects=tuple(effects))


def offset_text(offset: float) -> str:
    """The offset as a share of the radius: "3/10 of the way to the edge"."""
    tenths, percent = round(10 * abs(offset)), 100 * abs(offset)
    part = f"{tenths}/10" if abs(percent - 10 * tenths) < 0.5 else f"{percent:.0f} %"
    return f"{part} of the way to the edge"


def squirt_difference(difference: float, error: float, distinct: bool) -> str:
    """A difference of squirt, followed by the name of the other cue: "15.1 ± 8.2 % less squirt than"."""
    text = difference_text(abs(difference), error).lstrip("+")
    rounded, outside = text.split(maxsplit=1)
    if float(rounded):
        text = f"{text} {'more' if difference > 0 else 'less'} squirt than"
    else:
        text = f"as much squirt ({outside}) as"
    return text if distinct else f"not distinct: {text}"


def _percent(share: float) -> str:
    percent = 100 * share
    return "under 0.1 %" if percent < 0.1 else f"{percent:.1f} %" if percent < 1 else f"{percent:.0f} %"


def _bar(row: ScaleRow) -> ScaleCell:
    at, low, high = (round(BAR * each / 100) for each in (row.at, row.low, row.high))
    line = ["·"] * (BAR + 1)
    if row.kind == "own":
        line[low : high + 1] = ["━"] * len(line[low : high + 1])
    line[min(at, BAR)] = "●"
    return ScaleCell.of("".join(line), row.at, row.low, row.high)
