"""The verdict for people: a line with the squirt and its uncertainty, sentences, and rows of a scale."""

from __future__ import annotations

import math
from typing import NamedTuple

from cuefem.contact.strike import strike_modes
from cuefem.io.ready import ready_cues
from cuefem.results.quantities import scaled, signed, with_unit
from cuefem.results.records import Record, Sheet
from cuefem.results.uncertainty import SHAFTS
from cuefem.results.verdict import verdict_record
from cuefem.scene import Scene
from cuefem.scene.solved_scene import Solved


def verdict(scene: Scene) -> Record:
    """Squirt of a stroke with its uncertainty, beside the reference cues struck the same way.

    Parameters
    ----------
    scene : Scene
        A stroke with a cue of segments or a lumped cue. A central stroke is taken at the game's usual offset.

    Returns
    -------
    dict
        "squirt", rad, and "squirt_error", its uncertainty (1 sigma); "offset", b/R; "uncertainty", its relative
        parts (model, inputs, computation, and their total in quadrature); "inputs", what each uncertain parameter adds;
        "among", for each reference cue its squirt, the relative "difference" of the scene's, the error of that, and
        whether the two are "distinct", which is a difference larger than its error.

    Raises
    ------
    ValueError
        If the stroke is beyond a law's range, such as a leather tip that is pressed too far.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> found = cf.verdict(scene)
    >>> 0.1 < found["squirt_error"] / found["squirt"] < 0.3, "plain maple" in found["among"]
    (True, True)
    """
    solved = Solved(scene)
    return verdict_record(scene, strike_modes(scene, solved.tip), ready_cues(), solved=solved)


def squirt_words(record: Record) -> tuple[str, str]:
    """The squirt as tables have it, and its uncertainty: "1.82°" and "0.31°"."""
    squirt, error = abs(record["squirt"]), record["squirt_error"]
    decimals = 3 if error and scaled(error, "rad") < 0.01 else 2
    return with_unit(squirt, "rad", decimals=decimals), with_unit(error, "rad", decimals=decimals)


def headline(record: Record) -> str:
    """The squirt with its uncertainty in a line."""
    squirt, error = squirt_words(record)
    aside = with_unit(math.tan(abs(record["squirt"])), "m", decimals=0)
    where = f"at b/R {record['offset']:.4g}, {way_out(record['offset'])}" + (
        "; the stroke itself is head-on" if record["head_on"] else ""
    )
    return f"squirt {squirt.rstrip('°')} ± {error} ({where}): the ball is {aside} off line after 1 m"


def way_out(offset: float) -> str:
    """How far out the ball is struck: "3/10 of the way to the edge"."""
    tenths, percent = round(10 * abs(offset)), 100 * abs(offset)
    part = f"{tenths}/10" if abs(percent - 10 * tenths) < 0.5 else f"{percent:.0f} %"
    return f"{part} of the way to the edge"


def difference_words(difference: float, error: float) -> str:
    """A relative difference with its uncertainty: "−3 ± 8 %"."""
    digits = 0 if error >= 0.02 else 1 if error >= 0.002 else 2
    return signed(100 * difference, digits, f"± {100 * error:.{digits}f} %")


def squirt_difference(difference: float, error: float, distinct: bool) -> str:
    """The same of squirt, to stand before what it is compared with: "15 ± 8 % less squirt than"."""
    words = difference_words(difference, error)
    more = "more" if difference > 0 else "less"
    return f"{words[1:]} {more} squirt than" if distinct else f"{words} squirt, not distinct from"


def standing(record: Record) -> list[str]:
    """Squirt relative to the first reference cue, in a sentence; none without a reference cue."""
    return [
        f"{squirt_difference(own['difference'], own['difference_error'], own['distinct'])} a {first} shaft with the "
        "same tip."
        for first, own in [*record["among"].items()][:1]
    ]


def uncertainty_line(record: Record) -> str:
    """What the uncertainty is made of, in a line."""
    parts = {name: _percent(share) for name, share in record["uncertainty"].items()}
    return (
        f"±: uncertainty (1σ): model {parts['model']} (from published squirt), unmeasured wood and tip "
        f"{parts['inputs']}, numerical {parts['computation']}; combined {parts['total']}. Of a difference between "
        f"two shafts: {_percent(SHAFTS)} of it (model) or that of their wood if larger, and 1 % of squirt."
    )


def _percent(share: float) -> str:
    percent = 100 * share
    return "under 0.1 %" if percent < 0.1 else f"{percent:.1f} %" if percent < 1 else f"{percent:.0f} %"


class ScaleRow(NamedTuple):
    """A cue on the scale: its name, its squirt in words, how it differs, "own" or "other" if it is the design or the
    one beside it, and its position and range in per cent of the scale."""

    name: str
    text: str
    beside: str
    kind: str
    at: float
    low: float
    high: float


def scale(record: Record, name: str = "yours", other: tuple[str, float | None] | None = None) -> list[ScaleRow]:
    """The cues by their squirt, the least first, one's own with its uncertainty; other: name and squirt of one more."""
    mine, error = abs(record["squirt"]), record["squirt_error"]
    squirts = {each: abs(beside["squirt"]) for each, beside in record["among"].items()}
    first = next(iter(squirts), "")
    beside, squirt = other or ("", None)
    if squirt is not None and not record["head_on"]:
        squirts.setdefault(beside, abs(squirt))
    text, off = squirt_words(record)
    decimals = len(text.rstrip("°").partition(".")[2])
    part = 100 / (1.05 * max([mine + error, *squirts.values()]) or 1.0)
    rows = [ScaleRow(name, text, f"± {off}", "own", part * mine, part * max(0.0, mine - error), part * (mine + error))]
    for each, own in squirts.items():
        ratio = round(100 * (own / squirts[first] - 1)) if first else 0
        words = f"{abs(ratio)} % {'less' if ratio < 0 else 'more'} than {first}" if ratio else f"as much as {first}"
        told, kind = with_unit(own, "rad", decimals=decimals), "other" if each == beside else ""
        rows.append(ScaleRow(each, told, words if each != first else "", kind, *3 * (part * own,)))
    return sorted(rows, key=lambda row: row.at)


def verdict_things(record: Record) -> list[Sheet | str]:
    """The verdict in the terminal."""
    rows = scale(record)
    own = {i: "bold" for i, row in enumerate(rows) if row.kind == "own"}
    head = ("cue", "squirt", "less to more squirt", "")
    cells = tuple((row.name, row.text, _bar(row), row.beside) for row in rows)
    title = "Reference pool cues, with the same tip and stroke"
    table = Sheet(title, head, cells, (uncertainty_line(record),), (0, 2, 3), own)
    return [headline(record), *standing(record), "", table]


BAR = 32  # characters of the scale in a terminal


def _bar(row: ScaleRow) -> str:
    at, low, high = (round(BAR * each / 100) for each in (row.at, row.low, row.high))
    line = ["·"] * (BAR + 1)
    if row.kind == "own":
        line[low : high + 1] = ["━"] * len(line[low : high + 1])
    line[min(at, BAR)] = "●"
    return "".join(line)
