"""How uncertain are a computed squirt and a ratio of two, by published measurements?

Four series are independent: the robot, whose 2.30 deg is the pivot length of that cue (12.7 in), the angles of 2007,
and two cues whose angle and pivot length are one number by TP B.1. Wood and tip of those cues were not measured either:
their contribution is subtracted, and the rest is the model error (`cuefem.results.uncertainty`). Data: squirt.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cache, partial
from typing import NamedTuple

import numpy as np
from scipy.stats import chi2

import cuefem as cf
from cuefem.results.uncertainty import RATIO_FLOOR
from studies import pages
from studies.measured.published import MODELS, PLAYERS, PREDATOR, STINGER, Row, mass_ratios, rows, series
from studies.pages import table
from studies.strokes import INCH, cue, full_model

SPEED_OFFSET, N_BUTTS = 0.375, 24


class Estimate(NamedTuple):
    """RMS of differences, and the part that their inputs do not explain: best, 16 and 84 % (chi-square)."""

    total: float
    inputs: float
    best: float
    low: float
    high: float


def unexplained(differences: Iterable[float], inputs: Iterable[float] = (0.0,)) -> Estimate:
    """The part of independent differences that their inputs do not explain."""
    values = list(differences)
    total, explained, n = pages.rms(values), pages.rms(inputs), len(values)
    ends = (total * math.sqrt(n / chi2.ppf(p, n)) for p in (0.84, 0.16))
    best, low, high = (math.sqrt(max(each**2 - explained**2, 0.0)) for each in (total, *ends))
    return Estimate(total, explained, best, low, high)


def mean(series: Iterable[Row]) -> tuple[float, float]:
    """Mean difference of a series, and what the inputs leave open in it: they are the same in all of its rows."""
    series = list(series)
    names = {name for row in series for name in row.inputs}
    inputs = (float(np.mean([row.inputs.get(name, 0.0) for row in series])) for name in names)
    return float(np.mean([row.difference for row in series])), math.hypot(*inputs)


def model_error(model: str, without: str = "") -> Estimate:
    """The model's own error from all series, or from all but one."""
    means = [mean(group) for name, group in series(model).items() if name != without]
    return unexplained(*zip(*means, strict=True))


@cache
def shaft_pairs() -> tuple[tuple[str, Row, Row], ...]:
    """Pairs of shafts that were measured in the same way: way, and the two rows."""
    by_key = {(row.folder, row.pivot, row.offset): row for row in rows("full model")}
    low, maple, hard = ((PREDATOR, True, 0.375), (PLAYERS, True, 0.375), (STINGER, True, 0.267))
    return (
        ("pivot lengths", by_key[low], by_key[maple]),
        ("pivot lengths", by_key[hard], by_key[maple]),
        ("angles", by_key[PREDATOR, False, 0.453], by_key[PLAYERS, False, 0.453]),
    )


def pair_share(without: str = "") -> Estimate:
    """The error of the logarithm of a ratio of two shafts, inputs included; without: a method to omit."""
    logs = [a.over(b) for method, a, b in shaft_pairs() if method != without]
    scale = pages.rms(computed for _, computed in logs)
    return unexplained((measured - computed) / scale for measured, computed in logs)


def pair_inputs() -> float:
    """What the inputs leave open in these logarithms, RMS, as a part of theirs."""
    parts = [(a.over(b)[1], math.hypot(*a.inputs.values(), *b.inputs.values())) for _, a, b in shaft_pairs()]
    logs, inputs = zip(*parts, strict=True)
    return pages.rms(inputs) / pages.rms(logs)


def mass_share(*masses: int) -> float:
    """The model's part of the logarithm of a ratio with a mass on the shaft, over all its positions."""
    logs = [(math.log(a), math.log(b)) for (mass, _), (a, b) in mass_ratios().items() if mass in masses]
    return pages.rms(a - b for a, b in logs) / pages.rms(b for _, b in logs)


def ratio_errors() -> tuple[float, float]:
    """What `cuefem.results.uncertainty` takes: of two shafts the upper end, of masses the root mean square."""
    return pair_share().high, mass_share(3, 11)


def squirt_error(row: Row) -> float:
    """Uncertainty of a row by the other series: the model's upper end, and the row's own inputs."""
    return math.hypot(model_error("full model", row.series).high, *row.inputs.values())


def coverage() -> Iterator[tuple[str, int, int, float]]:
    """By series: rows, how many of them lie within the uncertainty, and the model's part of it from the others."""
    for name, group in series("full model").items():
        inside = sum(abs(row.difference) <= squirt_error(row) for row in group)
        yield f"squirt, {name}", len(group), inside, model_error("full model", name).high
    for method in ("pivot lengths", "angles"):
        share = pair_share(method).high
        pairs = [(*a.over(b), *a.inputs.values(), *b.inputs.values()) for each, a, b in shaft_pairs() if each == method]
        yield f"two shafts, {method}", len(pairs), sum(map(partial(within, share), pairs)), share
    for mass, other in ((11, 3), (3, 11)):
        share = mass_share(other)
        logs = [(math.log(a), math.log(b)) for (m, _), (a, b) in mass_ratios().items() if m == mass]
        yield f"{mass} g on a shaft", len(logs), sum(map(partial(within, share), logs)), share


def within(share: float, pair: tuple[float, ...]) -> bool:
    """Whether a measured logarithm lies within the uncertainty of the computed one; pair: both, and what inputs do."""
    measured, computed, *inputs = pair
    return abs(measured - computed) <= math.hypot(max(share * abs(computed), math.hypot(*inputs)), RATIO_FLOOR)


def squirt_table() -> str:
    """Every row beside its uncertainty."""
    lines = []
    for row in rows("full model"):
        error = squirt_error(row)
        text = f"{100 * row.difference:+.0f} ± {100 * error:.0f} %"
        lines.append([row.series, *row.texts, text, "yes" if abs(row.difference) <= error else "no"])
    return table(["series", "b/R", "measured", "full model", "difference of logarithms, of squirt", "within"], lines)


def error_table() -> str:
    """The model's own error, by model."""
    lines = []
    for model in MODELS[::-1]:
        each = ", ".join(f"{100 * mean(group)[0]:+.0f}" for group in series(model).values())
        lines.append([model, each, *(f"{100 * x:.0f} %" for x in model_error(model))])
    return table(["model", "the four series, %", "RMS", "inputs", "the model's own", "16 %", "84 %"], lines)


def pair_table() -> str:
    """Ratios of two shafts."""
    lines = []
    for method, a, b in shaft_pairs():
        x, y = a.over(b)
        lines.append(
            [f"{a.name} over {b.name}, {method}", f"{math.exp(x):.2f}", f"{math.exp(y):.2f}", f"{abs(x / y - 1):.2f}"]
        )
    return table(["two shafts", "measured", "full model", "error of the logarithm as a part of it"], lines)


def coverage_table() -> str:
    """How many published rows lie within the uncertainty."""
    groups = [*coverage()]
    lines = [[name, f"{inside} of {n}", f"{share:.2f}"] for name, n, inside, share in groups]
    rows_, inside = (sum(each[i] for each in groups) for i in (1, 2))
    return table(["rows", "within", "the model's error by the others"], [*lines, ["all", f"{inside} of {rows_}", ""]])


# Of levels that were judged outside this repository: a statement, not a result of this program.
HELD_OUT = (
    "Seven published levels of other cues were held out; this repository does not have them. Four are within 1σ, "
    "measured squirt is 15 % above the computed one on average, and with them the model error is 14 to 28 %, of "
    "which "
    "18 % is the middle."
)


def denser(struck: cf.Scene, factor: float) -> cf.Scene:
    """The scene with all wood of its shaft denser by a factor."""

    def changed(material: cf.Material | None) -> cf.Material | None:
        return replace(material, rho=factor * material.rho) if material and material.E > 5e9 else material

    pieces = (replace(s, material=changed(s.material), core=changed(s.core)) for s in struck.shaft.segments)
    return replace(struck, cue=replace(struck.shaft, segments=tuple(pieces)))


def density_exponent(struck: cf.Scene) -> float:
    """Exponent of squirt in the density of the wood."""
    light, dense = (float(cf.strike(denser(struck, factor)).squirt) for factor in (0.95, 1.05))
    return math.log(dense / light) / math.log(1.05 / 0.95)


@cache
def butts(speed: float) -> list[cf.Scene]:
    """The maple shaft's default stroke at a speed, m/s, on drawn butts: waves, length and diameter."""
    base, draw = full_model(cue("pool_maple"), SPEED_OFFSET, speed), np.random.default_rng(1)
    scenes = []
    for _ in range(N_BUTTS):
        butt = {
            "wave_speed": 4430 * draw.normal(1.0, 0.12),
            "cue_length": INCH * draw.normal(58.0, 0.5),
            "butt_diameter": draw.normal(31.0e-3, 1.0e-3),
        }
        effects = (replace(e, **butt) if isinstance(e, cf.AxialWaves) else e for e in base.effects)
        scenes.append(replace(base, effects=tuple(effects)))
    return scenes


def butt_table() -> str:
    """Exponent of the density and scatter of squirt over drawn butts, by speed."""
    rows = []
    for speed in (1.0, 2.0, 3.5, 5.0, 7.0):
        base = full_model(cue("pool_maple"), SPEED_OFFSET, speed)
        rigid = replace(base, effects=tuple(e for e in base.effects if not isinstance(e, cf.AxialWaves)))
        drawn = [density_exponent(scene) for scene in butts(speed)]
        low, middle, high = np.percentile(drawn, [2.5, 50, 97.5])
        logs = np.log(cf.batch_strike(butts(speed)).squirt)
        exponents = (f"{density_exponent(scene):.2f}" for scene in (base, rigid))
        rows.append(
            [f"{speed:g}", *exponents, f"{middle:.2f}", f"{low:.2f} to {high:.2f}", f"{100 * np.std(logs):.1f} %"]
        )
    columns = ["speed, m/s", "default butt", "no axial waves", f"{N_BUTTS} drawn butts, median", "95 %", "squirt, 1σ"]
    return table(columns, rows)


def text() -> str:
    error, (shafts, masses) = model_error("full model"), ratio_errors()
    return pages.page(
        "Uncertainty of squirt",
        "How uncertain are a computed squirt and a ratio of two, by published measurements?",
        f"The model error is {100 * error.best:.0f} % of squirt (1σ), between {100 * error.low:.0f} and "
        f"{100 * error.high:.0f} %: four series differ from the model by {100 * error.total:.0f} % RMS, of which the "
        f"inputs explain {100 * error.inputs:.0f} %. The uncertainty of a scene combines its upper end with the "
        f"scene's inputs. The uncertainty of a ratio of two shafts is up to {shafts:.2f} of its logarithm, that of "
        f"point masses on one shaft {masses:.2f}.",
        "## Model error",
        error_table(),
        "A series counts once, by the mean of its rows. Errors of measurement were not published, and none is "
        "subtracted. Interval: chi-square with as many degrees of freedom as series. Inputs, by half the difference "
        "between plus and minus one standard deviation: E, G and density of the wood, waves in the butt, taper, "
        "bore, "
        "leather (a contact time known to 10 %, with the restitution that follows), restitution (0.71 to 0.75 of the "
        "whole cue), friction, tangential loss, height and dome of the tip; of the bare-tip model its contact time "
        "and "
        "friction.",
        "## Ratios of two shafts",
        pair_table(),
        f"Two shafts: RMS {pair_share().total:.2f} of the logarithm, upper end {shafts:.2f} (chi-square, three pairs "
        f"in two series; no other series has a second shaft). Their inputs alone contribute {pair_inputs():.2f}, so "
        "the model's part is between zero and the upper end: cuefem takes the upper end or a ratio's own inputs, "
        f"whichever is larger. Point masses of 3 and 11 g on one shaft: RMS {masses:.2f} over 31 positions.",
        "## Density of the wood, and the butt",
        f"Exponent of squirt in the density of a maple shaft's wood, b/R {SPEED_OFFSET:g}. The echo of axial waves "
        f"from the end of an "
        "assumed butt reaches the contact while it lasts, so that the exponent swings with speed; 10 % of density "
        "is 2 to 8 % of squirt.",
        butt_table(),
        "Drawn butts: waves of 4430 m/s ± 12 %, 58 ± 0.5 in long, 31 ± 1 mm wide (1σ, estimates). The uncertainty "
        "of a default stroke "
        "already contains the speed of the waves in the butt; length and width add little. It stays as it is: last "
        "column against a model "
        "error of 18 %. Two shafts on one butt share it.",
        "## Cross-validation",
        coverage_table(),
        "Each row is compared with a model error determined without its series, and its own inputs; 68 % should lie "
        "within. With 3 g the model fails ([squirt](squirt.md)).",
        HELD_OUT,
        squirt_table(),
    )


EXAMPLE = """\
from math import degrees
import cuefem as cf

verdict = cf.verdict(cf.load_scene("meshes/pool_maple.toml"))
print(f"{degrees(verdict.squirt):.2f} ± {degrees(verdict.squirt_error):.2f} degrees")
for name, part in verdict.uncertainty.items():
    print(f"{name:12}{100 * part:4.1f} %")
"""
STUDY = pages.Study(__file__, text, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
