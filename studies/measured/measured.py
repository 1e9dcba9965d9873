"""Does the model give the squirt that was measured on real cues, with nothing fitted?

What: the measured squirt of data/measured_squirt.csv beside the coupled strike of a maple, a hollow and a break shaft
before a pool ball, bare, with the tip's dome (9.5 mm), with its shear (Mindlin's ratio 0.75), with both; T = 1.1 ms
(break shaft 0.9), e = 0.73, mu = 0.7. Of the measured shafts only the tip's diameter is published. So 48 points of a
Halton sequence vary wood, leather, ferrule, taper, bore and stroke within the ranges of measured_shafts.py, which were
fixed before the first run, and the band holds 90 % of them. Then: how much each unknown changes squirt; squirt against
contact time and speed, on which measured squirt does not depend; leather whose shear is counted twice; and the claims
of an earlier prototype, each checked. Equations: handbook: The strike, Effects; PowerLawTip (its shear a constant
spring) and RollingContact for the speed. Contact times (0.8 ms phenolic and fast, 1 to 2 ms most, 2 to 3 ms soft and
slow) and "no practical effect" of hardness: billiards.colostate.edu, FAQ, cue tip.

Last the whole stroke (LeatherTip 6 mm high, dome 9.5 mm, nu 0.4, E 140 MPa, with waves along the cue and thrust on the
bent shaft; the tip's own restitution) at 2 m/s on the same shafts beside the patchwork of dome and
shear at 1.1 ms. Its band is over 24 of the 48 draws: moduli of the leather stand in the place of contact times (45 to
210 MPa), Poisson's ratio in that of the shear ratio. The break cue's tip has the E that makes its contact 0.9 ms long.
The bore of the hollow shaft follows from its measured static stiffness (data/static_stiffness.csv). Takes about 100 s.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

from cuefem import AxialWaves, PowerLawTip, RollingContact, Stroke, TipShear, leather_modulus
from studies import pages, strokes
from studies.measured import measured_shafts as shafts
from studies.measured import pool

MODELS = pool.MODELS
BOTH, MODERN = "dome + shear", pool.MODERN
TIMES = (0.7e-3, 0.8e-3, 1.0e-3, 1.2e-3, 1.4e-3, 1.7e-3, 2.0e-3)
ENDS = (TIMES[0], TIMES[-1])
MPH = 0.44704
SPEEDS = (3.6, 7.8)  # mph, of the robot's series
HERTZ = "T of Hertz's power"
LAWS = (HERTZ, "power law", "turning", "power law and turning")
SERIES = (2.34, 2.54)  # deg, what it measured there
WORDS = ("bare", "with the dome", "with shear", "with both")


@cache
def usual(row: shafts.Measurement, model: str) -> float:
    """Squirt with the usual values, deg."""
    return _squirt(shafts.struck(row, model, shafts.USUAL), model)


def _squirt(struck: pool.Scene, model: str) -> float:
    return pool.leather_strike(struck)[0] if model == MODERN else pool.squirt(struck)


def band(row: shafts.Measurement, model: str) -> tuple[float, float]:
    """Range of 90 % of the draws, deg; of the whole stroke over fewer of them."""
    return _band(row._replace(cue="", squirt=0.0), model)


@cache
def _band(row: shafts.Measurement, model: str) -> tuple[float, float]:
    draws = shafts.draws()[: DRAWS if model == MODERN else None]
    squirts = [_squirt(shafts.struck(row, model, values), model) for values in draws]
    low, high = np.quantile(squirts, (0.05, 0.95))
    return float(low), float(high)


@cache
def worth(name: str) -> tuple[float, float]:
    """Squirt of the first robot row with one unknown at its low and its high value, dome + shear, deg."""
    row = shafts.robot()
    low, _, high = shafts.UNKNOWN[name]
    return tuple(pool.squirt(shafts.struck(row, BOTH, {**shafts.USUAL, name: v})) for v in (low, high))  # type: ignore[return-value]


@cache
def at_time(model: str, time: float, offset: float = pool.OFFSET, *, wooden: bool = False) -> float:
    """Squirt of pool_maple, deg; wooden: maple in place of its leather."""
    cue = strokes.cue("pool_maple")
    cue = pool.wooden_tip(cue) if wooden else cue
    return pool.squirt(pool.scene(cue, time, offset, effects=MODELS[model]))


def exponent(model: str, *, wooden: bool = False) -> float:
    """Exponent of squirt in contact time, 0.7 to 2 ms."""
    return pages.slope(TIMES, [at_time(model, T, wooden=wooden) for T in TIMES])


def spread(model: str, offset: float = pool.OFFSET) -> float:
    """Largest over smallest squirt between 0.7 and 2 ms, minus 1."""
    found = [at_time(model, T, offset) for T in TIMES]
    return max(found) / min(found) - 1


@cache
def at_speed(model: str, mph: float, law: str) -> float:
    """Squirt at a speed, deg, by one of LAWS; the contact lasts 1.1 ms at 5.7 mph, the middle of the series."""
    middle = sum(SPEEDS) / 2
    if law == HERTZ:
        return at_time(model, pool.TIME * (middle / mph) ** 0.2)
    power, turning = PowerLawTip(1.5, speed=middle * MPH), RollingContact()
    more = {"power law": (power,), "turning": (turning,), "power law and turning": (power, turning)}[law]
    found = pool.scene(strokes.cue("pool_maple"), effects=(*MODELS[model], *more))
    return pool.squirt(replace(found, stroke=Stroke(mph * MPH, pool.OFFSET)))


def speed_change(model: str, law: str) -> float:
    """Relative change of squirt over the robot's series of speeds."""
    low, high = (at_speed(model, mph, law) for mph in SPEEDS)
    return high / low - 1


def miss(model: str) -> float:
    """Root mean square of the relative errors of the usual values over all measurements."""
    return float(np.sqrt(np.mean([(usual(row, model) / row.squirt - 1) ** 2 for row in shafts.measurements()])))


@cache
def everything(*names: str) -> float:
    """Squirt at b/R 0.375 and 5.7 mph, deg, with dome and shear and, by name, what else the package knows."""
    middle = sum(SPEEDS) / 2 * MPH
    more = {"power law": PowerLawTip(1.5, speed=middle), "turning": RollingContact(), "axial waves": AxialWaves()}
    effects = (*MODELS[BOTH], *(more[name] for name in names))
    found = pool.scene(strokes.cue("pool_maple"), effects=effects)
    return pool.squirt(replace(found, stroke=Stroke(middle, pool.OFFSET)))


def level_table() -> str:
    """Measured squirt beside the models."""
    columns = ["cue", "b/R", "measured", *(x for model in MODELS for x in (model, "its band"))]
    rows = []
    for row in shafts.measurements():
        cells = []
        for model in MODELS:
            low, high = band(row, model)
            cells += [f"{usual(row, model):.2f}", f"{low:.2f} to {high:.2f}"]
        rows.append([row.cue, f"{row.offset:.3f}", f"{row.squirt:.2f}", *cells])
    return pages.table(columns, rows)


def worth_table() -> str:
    """What the unknowns are worth."""
    base = usual(shafts.robot(), BOTH)
    rows = []
    for name, (low, _, high) in shafts.UNKNOWN.items():
        if name != "bore's diameter, m":
            cells = [f"{100 * (s / base - 1):+.1f} %" for s in worth(name)]
            rows.append([name, f"{low:.4g}", f"{high:.4g}", *cells])
    return pages.table(["unknown", "low", "high", "squirt at low", "squirt at high"], rows)


def time_table() -> str:
    """Squirt against contact time."""
    columns = ["model", "tip segment", *(f"{1e3 * T:g} ms" for T in TIMES), "exponent"]
    rows = []
    for model in MODELS:
        for wooden in (False, True):
            found = [f"{at_time(model, T, wooden=wooden):.2f}" for T in TIMES]
            rows.append([model, "maple" if wooden else "leather", *found, f"{exponent(model, wooden=wooden):+.2f}"])
    return pages.table(columns, rows)


def speed_table() -> str:
    """Change of squirt over the robot's speeds."""
    rows = [[model, *(f"{100 * speed_change(model, law):+.1f} %" for law in LAWS)] for model in MODELS]
    return pages.table(["model", *LAWS], rows)


def claims_table() -> str:
    """The claims of an earlier prototype, one by one."""
    both = [at_time(BOTH, T) for T in (1.0e-3, 1.2e-3)]
    without = [at_time(model, T) for model in ("bare", "shear") for T in (1.0e-3, 1.2e-3)]
    soft = [_far(ratio, T) for ratio in (0.3, 0.75) for T in TIMES]
    hollow = ratio(BOTH, pool.BORES[1])
    rows = [
        ["dome + shear, b/R 0.375, 1.0 to 1.2 ms", "2.2°", _span(both), "a little more; within what was measured"],
        ["without the dome", "1.2 to 1.9°", _span(without), "refined: bare 2.1 to 2.2, sheared 1.4 to 1.5"],
        [
            "hollow over maple, b/R 0.453",
            "0.8 to 0.85",
            f"{hollow:.2f}",
            "less, with the bore that its stiffness asks for",
        ],
        ["b/R 0.453, ratio 0.3 to 0.75, 0.7 to 2 ms", "2.2 to 2.5°", _span(soft), "more, and a wider range"],
        ["bare squirt against T", "T^0.5", f"T^{exponent('bare'):.2f}", "refined: less on a pool shaft"],
    ]
    return pages.table(["claim", "prototype", "here", "verdict"], rows)


@cache
def _far(ratio: float, time: float) -> float:
    effects = (pool.DOME, TipShear(ratio))
    return pool.squirt(pool.scene(strokes.cue("pool_maple"), time, 0.453, effects=effects))


def _span(found: list[float]) -> str:
    return f"{min(found):.2f} to {max(found):.2f}°"


def told(row: Any, model: str) -> str:
    """A squirt and its band in words."""
    low, high = band(row, model)
    return f"{usual(row, model):.2f}° ({low:.2f} to {high:.2f}°)"


def agreement() -> str:
    """What agrees."""
    robot, baseline = shafts.robot(), shafts.baseline()
    bare, dome, shear, both = (told(robot, model) for model in MODELS)
    return (
        f"What agrees. At b/R 0.375 dome and shear with textbook values give {both}; the robot measured "
        f"{baseline.squirt:.2f} and {robot.squirt:.2f}°. Nothing was fitted. No other model has both values in its "
        f"band. But the bare beam, {bare}, and the dome alone, {dome}, miss them by less than an error of 1.5 mm in "
        f"the offset would explain; shear alone, {shear}, is excluded. Dome and shear nearly cancel: over the seven "
        f"measured values the bare model is off by {100 * miss('bare'):.0f} % and the model with both by "
        f"{100 * miss('dome + shear'):.0f} % (root mean square), so the size of squirt does not tell which model is "
        f"right. More effects do not help: the turning contact makes it {everything('turning'):.2f}°, waves along the "
        f"cue {everything('axial waves'):.2f}°, and both with the power law "
        f"{everything('power law', 'turning', 'axial waves'):.2f}°."
    )


def indifference() -> str:
    """What contact time and speed say."""
    grown = ", ".join(f"{100 * spread(m):.0f} % {w}" for m, w in zip(MODELS, WORDS, strict=True))
    return (
        "The contact time tells which model is right. It runs from 0.8 ms for a phenolic tip to 2 ms and more for a "
        f"soft one. From 0.7 to 2 ms squirt at b/R 0.375 grows by {grown}. Players see no such growth (Alciatore's "
        "FAQ: the hardness of the tip has no practical effect), and only dome and shear together change so little."
    )


def speed() -> str:
    """What the speed says."""
    shorter = 100 * (1 - (SPEEDS[0] / SPEEDS[1]) ** 0.2)
    both, whole = BOTH, LAWS[-1]
    hertz, power, turning, net = (f"{100 * speed_change(both, law):+.1f} %" for law in LAWS)
    return (
        f"The speed tells less. Over the robot's {SPEEDS[0]} to {SPEEDS[1]} mph, where the measured values scatter by "
        f"{100 * (SERIES[1] / SERIES[0] - 1):.0f} %, a tip with Hertz's power 3/2 shortens the contact by "
        f"{shorter:.0f} %. Bare squirt then changes by {100 * speed_change('bare', HERTZ):+.1f} %, squirt with dome "
        f"and shear by {hertz} ({power} if the shear of the leather does not stiffen with it). The turning contact "
        f"adds {turning}, which grows with speed. All together change squirt by {net}, from "
        f"{at_speed(both, SPEEDS[0], whole):.2f} to {at_speed(both, SPEEDS[1], whole):.2f}°."
    )


def failure() -> str:
    """What does not agree."""
    (first, predator), stinger, both = shafts.far(), shafts.measurements()[-1], BOTH
    series, between = shafts.series(), shafts.series_at(pool.OFFSET)
    least, most = (100 * (row.squirt / between - 1) for row in (shafts.baseline(), shafts.robot()))
    grown = {m: usual(first, m) / usual(series[1], m) for m in ("bare", both)}
    return (
        f"What does not agree. The two series of measurements do not agree with each other: at b/R 0.375 the series of "
        f"2007 has {between:.2f}° between its points, and the robot of 2008 measured {least:.0f} to {most:.0f} % more "
        "with the same cue. A value of 2007 over one of 2008 (2.5/2.43 = 1.03) says nothing, and has no weight here. "
        f"The series of 2007 has {series[0].squirt}, {series[1].squirt} and {first.squirt}° at b/R 0.187, 0.320 and "
        f"0.453; dome and shear give {', '.join(told(row, both) for row in series)}: too much everywhere, most near "
        f"the middle. From b/R 0.320 to 0.453 measured squirt grows by {first.squirt / series[1].squirt:.2f}, more "
        f"than the offset (1.42); the model's by {grown[both]:.2f} (bare {grown['bare']:.2f}). An error of 1.8 mm in "
        "the zero of that series would explain most of it (below). The low-deflection shaft, bored as its "
        f"stiffness asks for, gives {told(predator, both)}, measured {predator.squirt:.1f}°; its ratio to the regular "
        f"shaft is {ratio(both, pool.BORES[1]):.2f} (bare {ratio('bare', pool.BORES[1]):.2f}), measured "
        f"{predator.squirt / first.squirt:.2f}. The break cue gives {told(stinger, both)} at b/R 0.267, measured "
        f"{stinger.squirt:.1f}°: a pool shaft one size wider with a hard tip is not that cue."
    )


def double_count() -> str:
    """What the leather segment's own shear is worth."""
    wood = [at_time(m, pool.TIME, wooden=True) / at_time(m, pool.TIME) - 1 for m in MODELS]
    changes = ", ".join(f"{100 * w:+.0f} % {model}" for w, model in zip(wood, WORDS, strict=True))
    return (
        "Is shear counted twice? The leather segment also gives way sideways by itself: with maple in its place "
        f"squirt at 1.1 ms changes by {changes}. Counting it twice therefore hardly changes the size of squirt. It "
        "matters with a dome and no shear, because a slender leather takes up the couple of the dome (and needs more "
        "modes than the default, which is 2 % off here: dome.md)."
    )


def report() -> str:
    """The committed table."""
    parts = ["# Measured squirt, nothing fitted", agreement(), indifference(), speed(), failure(), double_count()]
    parts += [
        "## Squirt, degrees",
        "The usual values, and the range that holds 90 % of 48 random draws of the unknowns.",
        level_table(),
    ]
    parts += [
        "## How much each unknown changes squirt",
        "pool_maple, b/R 0.375, dome + shear, one at a time.",
        worth_table(),
    ]
    parts += ["## Squirt against contact time, degrees, b/R 0.375", time_table()]
    parts += [f"## Change of squirt from {SPEEDS[0]} to {SPEEDS[1]} mph", speed_table()]
    parts += ["## Claims of an earlier prototype", claims_table()]
    return pages.paragraphs(*parts)


def draw(panels: Any) -> None:
    """Bands, and squirt against the contact time."""
    left, right = panels
    for j, row in enumerate(shafts.measurements()):
        for i, model in enumerate((*MODELS, MODERN)):
            low, high = band(row, model)
            x = j + 0.15 * (i - 2)
            left.plot([x, x], [low, high], color=f"C{i}", lw=6, alpha=0.35, solid_capstyle="butt")
            left.plot(x, usual(row, model), "_", color=f"C{i}", ms=8, mew=2, label=model if j == 0 else None)
        left.plot([j - 0.4, j + 0.4], [row.squirt] * 2, "k-", lw=1.2, label="measured" if j == 0 else None)
    cues = ("Players\n0.453", "Players\n0.320", "Players\n0.187", "robot\n0.375", "robot\n0.375", "Predator\n0.453")
    names = (*cues, "Stinger\n0.267")
    left.set_xticks(range(len(names)), names, fontsize=8)
    left.set(ylabel="squirt, degrees", ylim=(0, 4.9), title="Usual values and 90 % of the unknowns")
    left.legend(fontsize=8, ncols=3, loc="upper center")
    for i, model in enumerate(MODELS):
        ms = 1e3 * np.array(TIMES)
        right.plot(ms, [at_time(model, T) for T in TIMES], color=f"C{i}", label=model)
        right.plot(ms, [at_time(model, T, wooden=True) for T in TIMES], "--", color=f"C{i}", lw=1)
    found = [lasting(T) for T in LEATHER_TIMES]
    right.plot(1e3 * np.array(LEATHER_TIMES), found, color=f"C{len(MODELS)}", lw=2.4, label=MODERN)
    right.axhspan(*SERIES, color="0.5", alpha=0.25, lw=0, label="robot, 3.6 to 7.8 mph")
    right.set(xlabel="contact time T, ms", ylabel="squirt, degrees", ylim=(0, 3.7))
    right.set(title="pool_maple, b/R 0.375 (dashed: wooden tip)")
    right.legend(fontsize=8, ncols=2, loc="lower right")


# What the whole stroke should say, from the article, written down before it was run here. Not to be changed.
PREDICTED = {
    "b/R 0.187, deg": "1.1",
    "b/R 0.320, deg": "1.89",
    "b/R 0.375, deg": "2.22",
    "b/R 0.453, deg": "2.75",
    "growth from b/R 0.320 to 0.453": "1.45",
    "growth from b/R 0.375 to 0.453": "1.24",
    "rms miss of the 2007 series as told": "27 %",
    "rms miss of the 2007 series, offsets 1.8 mm less": "8 %",
    "low-deflection shaft, bore 8.5 mm, b/R 0.453, deg": "1.95",
    "that over maple": "0.71",
    "that over maple, bore 7.4 mm": "0.74",
    "that over maple, bore 10.2 mm": "0.67",
    "break cue, b/R 0.267, deg": "1.9",
    "squirt from 0.8 to 2 ms of contact": "within 20 %",
    "squirt from 3.6 to 7.8 mph": "within 3 %",
    "rms miss over the seven values": "20 %",
}
DRAWS = 24
SCATTER = 0.05  # deg, assumed of a value of the series of 2007
ZERO = 1.8e-3  # m, what the contact of the series of 2007 may have been nearer the middle than told
OFFSETS = (0.08, 0.14, 0.20, 0.26, 0.32, 0.39, 0.46)
LEATHER_TIMES = (0.8e-3, 1.0e-3, 1.2e-3, 1.4e-3, 1.7e-3, 2.0e-3)
MPH, LEATHER_SPEEDS = 0.44704, (3.6, 5.7, 7.8)
DEPTHS = (0.127, 8 * pool.INCH - 0.019)  # m: 5 in, and to the end of the 8 in behind leather and ferrule


@cache
def curve(model: str) -> Callable[[float], float]:
    """Squirt of the maple shaft against offset, deg; odd, through OFFSETS."""
    first = shafts.series()[0]
    squirts = [usual(first._replace(offset=b), model) for b in OFFSETS]
    return CubicSpline([-b for b in OFFSETS[::-1]] + [0.0, *OFFSETS], [-s for s in squirts[::-1]] + [0.0, *squirts])


def series_miss(model: str, zero: float) -> float:
    """Root mean square of the relative errors over the series of 2007, its offsets less by ``zero``, m."""
    off = [curve(model)(row.offset - zero / pool.BALL.radius) / row.squirt - 1 for row in shafts.series()]
    return float(np.sqrt(np.mean(np.square(off))))


def best_zero(model: str) -> float:
    """The error of the offset, m, with which the series of 2007 fits the model best."""
    return float(minimize_scalar(lambda zero: series_miss(model, zero), bounds=(0, 5e-3), method="bounded").x)


def grown(model: str) -> float:
    """Growth of squirt between the last two offsets of the series of 2007, less by ZERO."""
    middle, last = (curve(model)(row.offset - ZERO / pool.BALL.radius) for row in shafts.series()[1:])
    return float(last / middle)


def ratio(model: str, bore: float) -> float:
    """Squirt of the hollow shaft over that of the maple one at b/R 0.453."""
    solid, hollow = shafts.far()
    drilled = {**shafts.USUAL, "bore's diameter, m": bore}
    return _squirt(shafts.struck(hollow, model, drilled), model) / usual(solid, model)


@cache
def lasting(time: float, offset: float = pool.OFFSET) -> float:
    """Squirt of the maple shaft, deg, with the leather whose head-on contact takes ``time``, s."""
    struck = pool.leather_scene(strokes.cue("pool_maple"), offset)
    E = leather_modulus(struck, time)
    return pool.leather_strike(replace(struck, effects=(replace(pool.LEATHER, E=E), *pool.WHOLE)))[0]


@cache
def at_mph(mph: float) -> float:
    """Squirt of the maple shaft at b/R 0.375 and a speed, deg."""
    return pool.leather_strike(pool.leather_scene(strokes.cue("pool_maple"), speed=mph * MPH))[0]


def same_within(found: list[float]) -> str:
    """Largest over smallest, in words."""
    return f"within {100 * (max(found) / min(found) - 1):.1f} %"


def leather_found() -> dict[str, str]:
    """What was found, by the names of PREDICTED."""
    series, robot, stinger = shafts.series(), shafts.robot(), shafts.measurements()[-1]
    hollow = shafts.far()[1]
    squirt = {row: usual(row, MODERN) for row in (*series, robot, hollow, stinger)}
    numbers = (
        *(f"{squirt[row]:.2f}" for row in (series[0], series[1], robot, series[2])),
        f"{squirt[series[2]] / squirt[series[1]]:.2f}",
        f"{squirt[series[2]] / squirt[robot]:.2f}",
        f"{100 * series_miss(MODERN, 0.0):.0f} %",
        f"{100 * series_miss(MODERN, ZERO):.0f} %",
        f"{squirt[hollow]:.2f}",
        *(f"{ratio(MODERN, bore):.2f}" for bore in (pool.BORES[1], pool.BORES[0], pool.BORES[2])),
        f"{squirt[stinger]:.2f}",
        same_within([lasting(T) for T in LEATHER_TIMES]),
        same_within([at_mph(mph) for mph in LEATHER_SPEEDS]),
        f"{100 * miss(MODERN):.0f} %",
    )
    return dict(zip(PREDICTED, numbers, strict=True))


def leather_told() -> dict[str, str]:
    """What was measured, by the names of PREDICTED."""
    series, (solid, hollow) = shafts.series(), shafts.far()
    ratio_told = f"{hollow.squirt / solid.squirt:.2f}"
    numbers = (
        *(f"{series[0].squirt:.2f} (0.55 to 1.13)", f"{series[1].squirt:.2f}", "2.30, 2.43", f"{solid.squirt:.2f}"),
        f"{solid.squirt / series[1].squirt:.2f}",
        *("", "", "", f"{hollow.squirt:.2f}", ratio_told, ratio_told, ratio_told),
        f"{shafts.measurements()[-1].squirt:.2f}",
        *("no practical effect", "9 % of scatter", ""),
    )
    return dict(zip(PREDICTED, numbers, strict=True))


def leather_level_table() -> str:
    """Measured squirt beside the models."""
    rows = []
    for row in shafts.measurements():
        low, high = band(row, MODERN)
        cells = (f"{usual(row, model):.2f}" for model in ("bare", BOTH, MODERN))
        rows.append([row.cue, f"{row.offset:.3f}", f"{row.squirt:.2f}", *cells, f"{low:.2f} to {high:.2f}"])
    rows.append(
        ["rms of the relative differences", "", "", *(f"{100 * miss(m):.0f} %" for m in ("bare", BOTH, MODERN)), ""]
    )
    return pages.table(["cue", "b/R", "measured", "bare", "patchwork", MODERN, "its band"], rows)


def series_table() -> str:
    """The series of 2007, its offsets as told and less by ZERO."""
    rows = []
    for row in shafts.series():
        less = row.offset - ZERO / pool.BALL.radius
        cells = [f"{curve(model)(b):.2f}" for b in (row.offset, less) for model in (BOTH, MODERN)]
        rows.append([f"{row.offset:.3f}", f"{row.squirt:.2f}", *cells[:2], f"{less:.3f}", *cells[2:]])
    off = [f"{100 * series_miss(model, zero):.0f} %" for zero in (0.0, ZERO) for model in (BOTH, MODERN)]
    rows.append(["rms of the relative differences", "", *off[:2], "", *off[2:]])
    columns = ["b/R as told", "measured", "patchwork", MODERN, "b/R with 1.8 mm less", "patchwork", MODERN]
    return pages.table(columns, rows)


def rms_table() -> str:
    """How far each model is off, a series at a time."""
    every = shafts.measurements()
    kinds = {
        "2007, maple cue": shafts.series(),
        "robot of 2008, maple cue": every[3:5],
        "low-deflection shaft": every[5:6],
        "break cue": every[6:],
    }
    rows = []
    for name, some in kinds.items():
        off = [np.sqrt(np.mean([(usual(r, m) / r.squirt - 1) ** 2 for r in some])) for m in ("bare", BOTH, MODERN)]
        rows.append([name, str(len(some)), *(f"{100 * x:.0f} %" for x in off)])
    return pages.table(["series", "values", "bare", "patchwork", MODERN], rows)


RMS_WORDS = (
    "Root mean square of the relative differences, a series at a time. All three fail in the series of 2007. The bare "
    "beam fails most for the low-deflection shaft, and changes most with the speed. The patchwork fails for the break "
    "cue, and must be told its contact time. The whole stroke fails most for the break cue too, and changes with the "
    "leather."
)


@cache
def tried() -> dict[str, tuple[float, float]]:
    """What was tried on the series of 2007 with the whole stroke: the best value of each, and the chi-square left."""
    told = np.array([row.squirt for row in shafts.series()])
    offsets = np.array([row.offset for row in shafts.series()])
    there = curve(MODERN)

    def left(squirts: np.ndarray) -> float:
        return float(np.sum(((squirts - told) / SCATTER) ** 2))

    whole = there(offsets)
    angle, scale = float(np.mean(told - whole)), float(told @ whole / (whole @ whole))
    zero = minimize_scalar(lambda z: left(there(offsets - z / pool.BALL.radius)), bounds=(0, 5e-3), method="bounded")
    return {
        "nothing": (0.0, left(whole)),
        "zero of the angle, deg": (angle, left(whole + angle)),
        "zero of the offset, mm": (-1e3 * float(zero.x), float(zero.fun)),
        "scale of the angle": (scale, left(scale * whole)),
    }


def tried_table() -> str:
    """What was tried on the series of 2007."""
    rows = [[name, f"{x:.2f}" if x else "", f"{chi:.0f}"] for name, (x, chi) in tried().items()]
    return pages.table(["tried", "best value", "chi-square of three values"], rows)


@cache
def slippery(friction: float) -> float:
    """Squirt of the maple shaft at the last offset of the series of 2007 with another friction, deg."""
    struck = shafts.struck(shafts.series()[2], MODERN, {**shafts.USUAL, "mu": friction})
    return pool.leather_strike(struck)[0]


def tried_words() -> str:
    """What would reconcile the two series."""
    angle, offset, scale = list(tried().values())[1:]
    return (
        f"What would make that series the robot's? One number was fitted at a time, with {SCATTER}° for the scatter of "
        "each value (our guess: the article shows 0.55 to 1.13° at the least offset). An angle read from a wrong zero, "
        f"{angle[0]:+.2f}°, fits best, then an offset, {offset[0]:+.1f} mm, then a scale of {scale[0]:.2f}; none fits "
        "to the scatter assumed, so three values do not say which it was, or whether it was one of them. Chalk does "
        f"not do it: with a friction of 0.6 in place of 0.7 squirt at b/R 0.453 is {slippery(0.6):.2f}° in place of "
        f"{slippery(0.7):.2f}°, farther from the 2.5° measured. Swerve of the ball on its way was not computed here."
    )


def bore_table() -> str:
    """The bore that the stiffness of the last 8 in asks for."""
    rows = []
    for E in shafts.UNKNOWN["maple's E, Pa"]:
        bores = [shafts.asked_bore(E, depth) for depth in DEPTHS]
        whole = shafts.stiffness(shafts.bored(bores[0], E, DEPTHS[0]))
        rows.append([f"{E / 1e9:.1f} GPa", *(f"{1e3 * bore:.1f} mm" for bore in bores), f"{whole:.0f} N/m"])
    return pages.table(["E of the wood", "bored 5 in deep", "bored 7.25 in deep", "stiffness of the whole"], rows)


def ratio_table() -> str:
    """Hollow over maple by bore."""
    rows = [[f"{1e3 * b:g} mm", *(f"{ratio(m, b):.2f}" for m in ("bare", BOTH, MODERN))] for b in (6e-3, *pool.BORES)]
    return pages.table(["bore", "bare", "patchwork", MODERN], rows)


def leather_time_table() -> str:
    """Squirt against contact time, which the leather makes."""
    rows = [[f"{b:.3f}", *(f"{lasting(T, b):.2f}" for T in LEATHER_TIMES)] for b in (pool.OFFSET, 0.453)]
    return pages.table(["b/R", *(f"{1e3 * T:g} ms" for T in LEATHER_TIMES)], rows)


def leather_right() -> str:
    """What the whole stroke gets right."""
    robot, ratios = usual(shafts.robot(), MODERN), [ratio(MODERN, bore) for bore in pool.BORES]
    times = same_within([lasting(T) for T in LEATHER_TIMES])
    speeds = same_within([at_mph(mph) for mph in LEATHER_SPEEDS])
    return (
        "What the whole stroke (LeatherTip, waves along the cue, thrust on the bent shaft) gets right, with nothing "
        f"fitted. At b/R 0.375 it gives {robot:.2f}° (measured 2.30 and 2.43), and it is the same {speeds} over the "
        "robot's speeds. Over contacts of 0.8 to 2 ms, which the leather makes, it is the same only "
        f"{times}, more than players say. The patchwork changes as little over the speed because it is told a contact "
        "time. Its numbers are 2 to 3 % below those "
        "of leather_tip.md: here the modes are solved once for all models and ended by a tail that knows no dome, "
        "there for each stroke with its dome (and for the leather's contact of 1.14 ms, not 1.1: 0.1 % of the "
        "patchwork's squirt, 1.3 % of the bare tip's). With bores of 7.4 to 10.2 mm, which the stiffness of its last 8 "
        "in asks for (the table has 7.1 to 10.8, by the wood and the depth), the low-deflection shaft has "
        f"{ratios[0]:.2f} to {ratios[-1]:.2f} of the regular shaft's squirt, measured 0.72; with the bore of 6 mm that "
        f"meshes/pool_hollow.toml guesses it is {ratio(MODERN, 6e-3):.2f}. The whole shaft's 388 N/m ask for stiffer "
        "wood, or a stouter taper behind the front, than we drew, so the bore is known no better than that."
    )


def leather_wrong() -> str:
    """Where the whole stroke fails."""
    first, hollow, stinger = shafts.series()[2], shafts.far()[1], shafts.measurements()[-1]
    zeros = ", ".join(f"{name} {1e3 * best_zero(m):.1f}" for name, m in (("patchwork", BOTH), (MODERN, MODERN)))
    return (
        f"Where it fails. At b/R 0.453 it gives {usual(first, MODERN):.2f}° (measured 2.5), at 0.320 "
        f"{usual(shafts.series()[1], MODERN):.2f}° (1.43), at 0.187 {usual(shafts.series()[0], MODERN):.2f}° (0.55 to "
        f"1.13, mean 0.84): too much everywhere in the series of 2007, by {100 * series_miss(MODERN, 0):.0f} % (root "
        f"mean square; patchwork {100 * series_miss(BOTH, 0):.0f} %), and with too little growth. If the contacts of "
        "that series lay 1.8 mm nearer the middle than told, the differences would be "
        f"{100 * series_miss(MODERN, ZERO):.0f} and {100 * series_miss(BOTH, ZERO):.0f} %; the zero that fits best, in "
        f"mm, is: {zeros}. Even then squirt grows by {grown(MODERN):.2f} (patchwork {grown(BOTH):.2f}) between the "
        "last two offsets, where 1.75 was measured: an error of the zero explains a part of the slope. Nothing but "
        f"this fit shows that there was one. The low-deflection shaft's own squirt is {usual(hollow, MODERN):.2f}° "
        f"(1.8), the break cue's {usual(stinger, MODERN):.2f}° (2.4). Over all seven values it is off by "
        f"{100 * miss(MODERN):.0f} %, the patchwork by {100 * miss(BOTH):.0f} %, the bare beam by "
        f"{100 * miss('bare'):.0f} %: these values hardly favour a model. Most predictions below were read off "
        "the numbers of the article, so that they came true says little."
    )


def leather_report() -> str:
    """The end of the page."""
    parts = [
        "## LeatherTip beside the patchwork",
        leather_right(),
        leather_wrong(),
        "Squirt, deg.",
        leather_level_table(),
        RMS_WORDS,
        rms_table(),
    ]
    parts += ["## The series of 2007 and its zero", series_table(), tried_words(), tried_table()]
    parts += ["## The bore that 3480 N/m over the last 8 in ask for (388 N/m the whole)", bore_table()]
    parts += ["## Hollow over maple at b/R 0.453, measured 0.72", ratio_table()]
    parts += ["## LeatherTip: squirt, deg, by head-on contact time", leather_time_table()]
    parts += [pages.predictions(PREDICTED, leather_found(), leather_told())]
    return pages.paragraphs(*parts)


STUDY = pages.Study(
    __file__,
    lambda: pages.paragraphs(report(), leather_report()),
    {"measured.svg": pages.Figure(draw, (1, 2), (11.5, 4.6))},
    again={
        "page": pages.Again(lambda: pages.paragraphs(report(), leather_report())),
        "how far each model is off": pages.Again(rms_table, left_out=None, heavy=False),
        "what was tried on the series of 2007": pages.Again(tried_table, left_out=None, heavy=False),
        "the bore that the stiffness asks for": pages.Again(bore_table, left_out=None, heavy=False),
    },
    predicted=PREDICTED,
)


if __name__ == "__main__":
    STUDY.write()
