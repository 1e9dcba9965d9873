"""How uncertain are a computed squirt and a ratio of two, by published measurements?

Four series are independent: the robot, whose 2.30 deg is the pivot length of that cue (12.7 in), the angles of 2007,
and two cues whose angle and pivot length are one number by TP B.1. Wood and tip of those cues were not measured either:
their contribution is subtracted, and the rest is the model error (`cuefem.results.uncertainty`). Data: squirt.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import cache, partial
from typing import NamedTuple

import numpy as np
from scipy.stats import chi2

from cuefem.results.uncertainty import RATIO_FLOOR
from studies import pages
from studies.measured.published import MODELS, PLAYERS, PREDATOR, STINGER, Row, mass_ratios, rows, series
from studies.pages import table


class Estimate(NamedTuple):
    """A root mean square of differences, and what their inputs do not explain: best, 16 and 84 % (chi-square)."""

    total: float
    inputs: float
    best: float
    low: float
    high: float


def unexplained(differences: Iterable[float], inputs: Iterable[float] = (0.0,)) -> Estimate:
    """The part of independent differences that their inputs do not explain."""
    found = list(differences)
    total, known, n = pages.rms(found), pages.rms(inputs), len(found)
    ends = (total * math.sqrt(n / chi2.ppf(p, n)) for p in (0.84, 0.16))
    best, low, high = (math.sqrt(max(each**2 - known**2, 0.0)) for each in (total, *ends))
    return Estimate(total, known, best, low, high)


def mean(some: Iterable[Row]) -> tuple[float, float]:
    """Mean difference of a series, and what the inputs leave open in it: they are the same in all of its rows."""
    found = list(some)
    names = {name for row in found for name in row.inputs}
    inputs = (float(np.mean([row.inputs.get(name, 0.0) for row in found])) for name in names)
    return float(np.mean([row.difference for row in found])), math.hypot(*inputs)


def model_error(model: str, without: str = "") -> Estimate:
    """The model's own error from all series, or from all but one."""
    found = [mean(some) for name, some in series(model).items() if name != without]
    return unexplained(*zip(*found, strict=True))


@cache
def shaft_pairs() -> tuple[tuple[str, Row, Row], ...]:
    """Pairs of shafts that were measured in the same way: way, and the two rows."""
    at = {(row.folder, row.pivot, row.offset): row for row in rows("whole")}
    low, maple, hard = ((PREDATOR, True, 0.375), (PLAYERS, True, 0.375), (STINGER, True, 0.267))
    return (
        ("pivot lengths", at[low], at[maple]),
        ("pivot lengths", at[hard], at[maple]),
        ("angles", at[PREDATOR, False, 0.453], at[PLAYERS, False, 0.453]),
    )


def pair_share(without: str = "") -> Estimate:
    """The error of the logarithm of a ratio of two shafts, inputs included; without: pairs of this way are left out."""
    found = [a.over(b) for way, a, b in shaft_pairs() if way != without]
    scale = pages.rms(ours for _, ours in found)
    return unexplained((measured - ours) / scale for measured, ours in found)


def pair_inputs() -> float:
    """What the inputs leave open in these logarithms, RMS, as a part of theirs."""
    found = [(a.over(b)[1], math.hypot(*a.inputs.values(), *b.inputs.values())) for _, a, b in shaft_pairs()]
    ours, inputs = zip(*found, strict=True)
    return pages.rms(inputs) / pages.rms(ours)


def mass_share(*masses: int) -> float:
    """The model's part of the logarithm of a ratio with a mass on the shaft, over all its places."""
    logs = [(math.log(a), math.log(b)) for (mass, _), (a, b) in mass_ratios().items() if mass in masses]
    return pages.rms(a - b for a, b in logs) / pages.rms(b for _, b in logs)


def ratio_errors() -> tuple[float, float]:
    """What `cuefem.results.uncertainty` takes: of two shafts the upper end, of masses the root mean square."""
    return pair_share().high, mass_share(3, 11)


def squirt_error(row: Row) -> float:
    """Uncertainty of a row by the other series: the model's upper end, and the row's own inputs."""
    return math.hypot(model_error("whole", row.series).high, *row.inputs.values())


def coverage() -> Iterator[tuple[str, int, int, float]]:
    """By series: rows, how many of them lie within the uncertainty, and the model's part of it from the others."""
    for name, some in series("whole").items():
        inside = sum(abs(row.difference) <= squirt_error(row) for row in some)
        yield f"squirt, {name}", len(some), inside, model_error("whole", name).high
    for way in ("pivot lengths", "angles"):
        own = pair_share(way).high
        pairs = [(*a.over(b), *a.inputs.values(), *b.inputs.values()) for each, a, b in shaft_pairs() if each == way]
        yield f"two shafts, {way}", len(pairs), sum(map(partial(within, own), pairs)), own
    for mass, other in ((11, 3), (3, 11)):
        own = mass_share(other)
        logs = [(math.log(a), math.log(b)) for (m, _), (a, b) in mass_ratios().items() if m == mass]
        yield f"{mass} g on a shaft", len(logs), sum(map(partial(within, own), logs)), own


def within(share: float, pair: tuple[float, ...]) -> bool:
    """Whether a measured logarithm lies within the uncertainty of the computed one; pair: both, and what inputs do."""
    measured, ours, *inputs = pair
    return abs(measured - ours) <= math.hypot(max(share * abs(ours), math.hypot(*inputs)), RATIO_FLOOR)


def squirt_table() -> str:
    """Every row beside its uncertainty."""
    made = []
    for row in rows("whole"):
        own = squirt_error(row)
        said = f"{100 * row.difference:+.0f} ± {100 * own:.0f} %"
        made.append([row.series, *row.told, said, "yes" if abs(row.difference) <= own else "no"])
    return table(["series", "b/R", "measured", "whole", "difference of logarithms, of squirt", "within"], made)


def error_table() -> str:
    """The model's own error, by model."""
    made = []
    for model in MODELS[::-1]:
        each = ", ".join(f"{100 * mean(some)[0]:+.0f}" for some in series(model).values())
        made.append([model, each, *(f"{100 * x:.0f} %" for x in model_error(model))])
    return table(["model", "the four series, %", "RMS", "inputs", "the model's own", "16 %", "84 %"], made)


def pair_table() -> str:
    """Ratios of two shafts."""
    made = []
    for way, a, b in shaft_pairs():
        x, y = a.over(b)
        made.append(
            [f"{a.name} over {b.name}, {way}", f"{math.exp(x):.2f}", f"{math.exp(y):.2f}", f"{abs(x / y - 1):.2f}"]
        )
    return table(["two shafts", "measured", "whole", "error of the logarithm as a part of it"], made)


def coverage_table() -> str:
    """How many published rows lie within the uncertainty."""
    found = [*coverage()]
    made = [[name, f"{inside} of {n}", f"{own:.2f}"] for name, n, inside, own in found]
    rows_, inside = (sum(each[i] for each in found) for i in (1, 2))
    return table(["rows", "within", "the model's error by the others"], [*made, ["all", f"{inside} of {rows_}", ""]])


def text() -> str:
    own, (shafts, masses) = model_error("whole"), ratio_errors()
    return pages.page(
        "Uncertainty of squirt",
        "How uncertain are a computed squirt and a ratio of two, by published measurements?",
        f"The model error is {100 * own.best:.0f} % of squirt (1σ), between {100 * own.low:.0f} and "
        f"{100 * own.high:.0f} %: four series differ from the model by {100 * own.total:.0f} % RMS, of which the "
        f"inputs explain {100 * own.inputs:.0f} %. The uncertainty of a scene combines its upper end with the scene's "
        f"inputs. The uncertainty of a ratio of two shafts is up to {shafts:.2f} of its logarithm, that of point "
        f"masses on one shaft {masses:.2f}.",
        "## Model error",
        error_table(),
        "A series counts once, by the mean of its rows. Errors of measurement were not published, and none is "
        "subtracted. Interval: chi-square with as many degrees of freedom as series. Inputs, by half the difference "
        "between plus and minus one standard deviation: E, G and density of the wood, waves in the butt, taper, bore, "
        "leather (a contact time known to 10 %, with the restitution that follows), restitution (0.71 to 0.75 of the "
        "whole cue), tangential loss, height and dome of the tip; of the bare-tip model its contact time.",
        "## Ratios of two shafts",
        pair_table(),
        f"Two shafts: RMS {pair_share().total:.2f} of the logarithm, upper end {shafts:.2f} (chi-square, three pairs "
        f"in two series; no other series has a second shaft). Their inputs alone contribute {pair_inputs():.2f}, so "
        "the model's part is between zero and the upper end: cuefem takes the upper end or a ratio's own inputs, "
        f"whichever is larger. Point masses of 3 and 11 g on one shaft: RMS {masses:.2f} over 31 positions.",
        "## Cross-validation",
        coverage_table(),
        "Each row is compared with a model error determined without its series, and its own inputs; 68 % should lie "
        "within. With 3 g the model fails ([squirt](squirt.md)).",
        squirt_table(),
    )


STUDY = pages.Study(__file__, text)

if __name__ == "__main__":
    STUDY.write()
