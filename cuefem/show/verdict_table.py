"""Verdict on a cue: squirt with its uncertainty in one line, and a scale of reference cues."""

from __future__ import annotations

import math
from typing import NamedTuple

from cuefem.contact.strike import strike_modes
from cuefem.files.reference_cues import reference_cues
from cuefem.results.quantities import format_change, to_display, with_unit
from cuefem.results.records import Record, Table
from cuefem.results.uncertainty import SHAFT_ERROR, SPRING_ERROR
from cuefem.results.verdict import verdict_record
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene


def verdict(scene: Scene) -> Record:
    """Squirt of a stroke with its uncertainty, compared with reference cues by the same stroke.

    Parameters
    ----------
    scene : Scene
        A stroke with a cue of segments or a lumped cue. A head-on stroke is computed at the game's default offset.

    Returns
    -------
    dict
        "squirt", rad, and "squirt_error", its uncertainty (1 sigma), rad; "offset", b/R; "uncertainty", its relative
        parts (model, inputs, computation, and their total in quadrature); "inputs", the relative part of each uncertain
        parameter; "references", for each reference cue its squirt, the relative "difference" of the scene's, its error,
        and whether the two are "distinct": the difference is larger than its error.

    Raises
    ------
    ValueError
        If the stroke is beyond the valid range of a law, such as an indentation too large for a leather tip.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> record = cf.verdict(scene)
    >>> 0.1 < record["squirt_error"] / record["squirt"] < 0.3, "plain maple" in record["references"]
    (True, True)
    """
    solved = SolvedScene(scene)
    return verdict_record(scene, strike_modes(scene, solved.tip), reference_cues(), solved=solved)


def squirt_text(record: Record) -> tuple[str, str]:
    """Squirt and its uncertainty as text: "1.82°" and "0.31°"."""
    squirt, error = abs(record["squirt"]), record["squirt_error"]
    decimals = 3 if error and to_display(error, "rad") < 0.01 else 2
    return with_unit(squirt, "rad", decimals=decimals), with_unit(error, "rad", decimals=decimals)


def headline(record: Record) -> str:
    """Squirt with its uncertainty as one line."""
    squirt, error = squirt_text(record)
    off_line = with_unit(math.tan(abs(record["squirt"])), "m", decimals=0)
    where = f"at b/R {record['offset']:.4g}, {offset_text(record['offset'])}" + (
        "; the stroke itself is head-on" if record["head_on"] else ""
    )
    return f"squirt {squirt.rstrip('°')} ± {error} ({where}): the ball is {off_line} off line after 1 m"


def offset_text(offset: float) -> str:
    """The offset as a share of the radius: "3/10 of the way to the edge"."""
    tenths, percent = round(10 * abs(offset)), 100 * abs(offset)
    part = f"{tenths}/10" if abs(percent - 10 * tenths) < 0.5 else f"{percent:.0f} %"
    return f"{part} of the way to the edge"


def difference_text(difference: float, error: float) -> str:
    """A relative difference with its uncertainty: "−3.2 ± 8.1 %"."""
    digits = 0 if error >= 0.1 else 1 if error >= 0.002 else 2
    return format_change(100 * difference, digits, f"± {100 * error:.{digits}f} %")


def squirt_difference(difference: float, error: float, distinct: bool) -> str:
    """A difference of squirt, followed by the name of the other cue: "15.1 ± 8.2 % less squirt than"."""
    text, more = difference_text(abs(difference), error).lstrip("+"), "more" if difference > 0 else "less"
    return f"{'' if distinct else 'not distinct: '}{text} {more} squirt than"


def reference_comparison(record: Record) -> list[str]:
    """Squirt relative to the first reference cue as a sentence; empty without reference cues."""
    return [
        f"{squirt_difference(own['difference'], own['error'], own['distinct'])} a {first} shaft with the same tip."
        for first, own in [*record["references"].items()][:1]
    ]


def uncertainty_line(record: Record) -> str:
    """The parts of the uncertainty as one line."""
    parts = {name: _percent(share) for name, share in record["uncertainty"].items()}
    tip = "spring tip; " if record["uncertainty"]["model"] == SPRING_ERROR else ""
    return (
        f"±: uncertainty (1σ): model {parts['model']} ({tip}from published squirt), unmeasured wood and tip "
        f"{parts['inputs']}, numerical {parts['computation']}; combined {parts['total']}. Of a difference between "
        f"two shafts: {_percent(SHAFT_ERROR)} of it (model) or that of their wood if larger, and 1 % of squirt."
    )


def _percent(share: float) -> str:
    percent = 100 * share
    return "under 0.1 %" if percent < 0.1 else f"{percent:.1f} %" if percent < 1 else f"{percent:.0f} %"


class ScaleRow(NamedTuple):
    """A cue on the scale: name, squirt and difference as text; kind "own" for the design, "other" for the compared one;
    position and interval (1σ), per cent of the scale."""

    name: str
    text: str
    difference: str
    kind: str
    at: float
    low: float
    high: float


def reference_scale(
    record: Record, name: str = "yours", other: tuple[str, float | None] | None = None
) -> list[ScaleRow]:
    """The cues by their squirt, the lowest first, the design with its uncertainty; none without reference cues. other:
    name and squirt, rad, of one more cue."""
    if not record["references"]:
        return []
    mine, error = abs(record["squirt"]), record["squirt_error"]
    squirts = {cue: abs(values["squirt"]) for cue, values in record["references"].items()}
    first = next(iter(squirts))
    compared, squirt = other or ("", None)
    if squirt is not None and not record["head_on"]:
        squirts.setdefault(compared, abs(squirt))
    text, error_text = squirt_text(record)
    decimals = len(text.rstrip("°").partition(".")[2])
    part = 100 / (1.05 * max([mine + error, *squirts.values()]) or 1.0)
    interval = (part * max(0.0, mine - error), part * (mine + error))
    rows = [ScaleRow(name, text, f"± {error_text}", "own", part * mine, *interval)]
    for cue, own in squirts.items():
        ratio = round(100 * (own / squirts[first] - 1))
        more = f"{abs(ratio)} % {'less' if ratio < 0 else 'more'} than {first}" if ratio else f"as much as {first}"
        text, kind = with_unit(own, "rad", decimals=decimals), "other" if cue == compared else ""
        rows.append(ScaleRow(cue, text, more if cue != first else "", kind, *3 * (part * own,)))
    return sorted(rows, key=lambda row: row.at)


def tabulate_verdict(record: Record) -> list[Table | str]:
    """The verdict for the terminal: headline, comparison, and the table of reference cues."""
    text, uncertainty = [headline(record), *reference_comparison(record), ""], uncertainty_line(record)
    if not record["references"]:
        return [*text, uncertainty, ""]
    rows = reference_scale(record)
    own = {i: "bold" for i, row in enumerate(rows) if row.kind == "own"}
    head = ("cue", "squirt", "less to more squirt", "")
    cells = tuple((row.name, row.text, _bar(row), row.difference) for row in rows)
    title = "Reference pool cues, with this tip, ball and stroke"
    return [*text, Table(title, head, cells, (uncertainty,), (0, 2, 3), own)]


BAR = 32  # characters of the scale in a terminal


def _bar(row: ScaleRow) -> str:
    at, low, high = (round(BAR * each / 100) for each in (row.at, row.low, row.high))
    line = ["·"] * (BAR + 1)
    if row.kind == "own":
        line[low : high + 1] = ["━"] * len(line[low : high + 1])
    line[min(at, BAR)] = "●"
    return "".join(line)
