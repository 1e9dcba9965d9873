"""The verdict for people: a line with the squirt and its uncertainty, sentences, and rows of a scale."""

from __future__ import annotations

import math
from typing import NamedTuple

from cuefem.contact.strike import strike_modes
from cuefem.io.ready import ready_cues
from cuefem.report.scene_words import listed
from cuefem.results.quantities import scaled, signed, with_unit
from cuefem.results.records import Record, Sheet
from cuefem.results.uncertainty import SHAFTS
from cuefem.results.verdict import verdict_record
from cuefem.scene import Scene
from cuefem.tip_modes import Solved

SAME = 0.005  # differences between reference cues below this are told as "as much"


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


def than_words(difference: float) -> str:
    """A relative difference in words: "17 % less"."""
    if abs(difference) < SAME:
        return "as much"
    return f"{100 * abs(difference):.0f} % {'less' if difference < 0 else 'more'}"


def beside_words(difference: float, other: str) -> str:
    """A relative difference and of what it is: "17 % less than plain maple"."""
    words = than_words(difference)
    return f"{words} {'as' if abs(difference) < SAME else 'than'} {other}"


def standing(record: Record) -> list[str]:
    """Squirt relative to the reference cues, in sentences; none without a reference cue."""
    among = record["among"]
    if not among:
        return []
    first, *others = among
    own = among[first]
    size, error = 100 * own["difference"], 100 * own["difference_error"]
    if own["distinct"]:
        more = "more" if size > 0 else "less"
        said = f"{abs(size):.0f} ± {error:.0f} % {more} squirt than a {first} shaft with the same tip."
    else:
        told = signed(size, 0, f"± {error:.0f} %")
        said = f"Squirt is not distinct from that of a {first} shaft with the same tip: {told}."
    ratios = {name: among[name]["squirt"] / among[first]["squirt"] - 1 for name in others}
    rest = [f"{name} has {than_words(ratio)} squirt" for name, ratio in ratios.items()]
    return [said, f"Reference pool cues with the same tip and stroke: {listed(rest)} than {first}."] if rest else [said]


def uncertainty_line(record: Record) -> str:
    """What the uncertainty is made of, in a line."""
    parts = {name: _percent(share) for name, share in record["uncertainty"].items()}
    return (
        f"±: uncertainty (1σ): model {parts['model']} (from published squirt), unmeasured wood and tip "
        f"{parts['inputs']}, numerical {parts['computation']}; combined {parts['total']}. A difference between two "
        f"shafts: model {_percent(SHAFTS)} of the difference, their wood, and 1 % of squirt."
    )


def _percent(share: float) -> str:
    percent = 100 * share
    return "under 0.1 %" if percent < 0.1 else f"{percent:.1f} %" if percent < 1 else f"{percent:.0f} %"


class ScaleRow(NamedTuple):
    """A cue on the scale: name, squirt, whether it is the design itself, and its position in per cent of the scale."""

    name: str
    text: str
    beside: str
    own: bool
    at: float
    low: float
    high: float


def scale(record: Record, name: str = "yours") -> list[ScaleRow]:
    """The cues by their squirt, the least first, one's own with its uncertainty; per cent are of the scale's length."""
    mine, error = abs(record["squirt"]), record["squirt_error"]
    others = {name: abs(beside["squirt"]) for name, beside in record["among"].items()}
    most = 1.05 * max([mine + error, *others.values()]) or 1.0
    text, off = squirt_words(record)
    decimals = len(text.rstrip("°").partition(".")[2])

    def row(name: str, squirt: float, error: float, words: str, beside: str) -> ScaleRow:
        places = (100 * each / most for each in (squirt, max(0.0, squirt - error), squirt + error))
        return ScaleRow(name, words, beside, bool(error), *places)

    first = next(iter(others), "")
    rows = [
        row(
            name,
            squirt,
            0.0,
            with_unit(squirt, "rad", decimals=decimals),
            "" if name == first else beside_words(squirt / others[first] - 1, first),
        )
        for name, squirt in others.items()
    ]
    return sorted([*rows, row(name, mine, error, text, f"± {off}")], key=lambda each: each.at)


def verdict_things(record: Record) -> list[Sheet | str]:
    """The verdict in the terminal."""
    scale_sheet = scale(record)
    rows = tuple((row.name, row.text, _bar(row), row.beside) for row in scale_sheet)
    own = {i: "bold" for i, row in enumerate(scale_sheet) if row.own}
    head = ("cue", "squirt", "less to more squirt", "")
    table = Sheet(
        "Reference pool cues, with the same tip and stroke", head, rows, (uncertainty_line(record),), (0, 2, 3), own
    )
    return [headline(record), *standing(record), "", table]


BAR = 32  # characters of the scale in a terminal


def _bar(row: ScaleRow) -> str:
    at, low, high = (round(BAR * each / 100) for each in (row.at, row.low, row.high))
    line = ["·"] * (BAR + 1)
    if row.own:
        line[low : high + 1] = ["━"] * len(line[low : high + 1])
    line[min(at, BAR)] = "●"
    return "".join(line)
