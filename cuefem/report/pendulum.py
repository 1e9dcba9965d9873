"""What a pendulum test tells: the end mass, its error budget, what it says about squirt, and how to plan the test."""

from __future__ import annotations

from typing import Any

from cuefem.measured.outliers import HOLDS_95
from cuefem.measured.pendulum import (
    GRAVITY,
    PRESSED,
    TIMES,
    USUAL,
    Told,
    Weighed,
    choices,
    softness,
)
from cuefem.report.documented import text_of, value_record
from cuefem.report.record import Record
from cuefem.report.table import table_of, with_caption

THREAD, SWINGS = 1.0, (0.1, 0.2, 0.3)  # m, of the plan
PLAN_ERROR = 0.01  # of a ratio of speeds: 1 mm in a swing of 0.2 m, both ways, three times


def weigh_record(weighed: Weighed, told: Told | None, lumped: float | None) -> Record:
    """The end mass, where its error comes from, and what it says about squirt."""
    test = weighed.test
    found: Record = {
        "end_mass": weighed.end_mass,
        "error": weighed.relative_error * weighed.end_mass,
        "interval_68": list(weighed.interval()),
        "interval_95": list(weighed.interval(HOLDS_95)),
        "contact_time": test.contact_time,
        "ball_mass": test.ball_mass,
        "bounce": weighed.bounce,
        "restitution": weighed.restitution,
        "impact_speed": test.free.impact_speed,
        "budget": weighed.budget,
        "remarks": remarks(weighed),
        "lumped_squirt": lumped,
        "squirt": None,
    }
    if told is not None:
        found["squirt"] = {
            "offset": told.offset,
            "drawn_end_mass": told.drawn,
            "before": told.before[0],
            "before_error": told.before[1],
            "after": told.after[0],
            "after_error": told.after[1],
            "unknowns": [value_record(value) for value in told.estimate.values],
        }
    return found


def remarks(weighed: Weighed) -> list[str]:
    """What could be done better."""
    test, said = weighed.test, []
    worst = max(weighed.budget, key=lambda name: weighed.budget[name])
    if weighed.budget[worst]:
        said.append(f"the reading that counts most: {worst}")
    if not TIMES[0] <= test.contact_time <= TIMES[1]:
        soft = "softer" if test.contact_time < TIMES[0] else "harder"
        said.append(
            f"the contact of {1e3 * test.contact_time:.3g} ms is no stroke's, 0.5 to 2 ms: take a {soft} ball, since "
            "the end mass depends on it"
        )
    ratio = test.ball_mass / weighed.end_mass
    if not 1 / 3 < ratio < 3:
        said.append(f"a ball near {1e3 * weighed.end_mass:.2g} g, as heavy as the end mass, would tell more")
    if weighed.relative_error > 0.1:
        said.append("errors over a tenth: repeat the bounces, or swing wider")
    return said


def weigh_tables(record: Record) -> list[Any]:
    """For people."""
    low, high = (text_of(end, None, "kg") for end in record["interval_95"])
    first = [
        f"end mass {text_of(record['end_mass'], record['error'], 'kg')} for a contact of "
        f"{1e3 * record['contact_time']:.3g} ms (95 %: {low} to {high})",
        f"the ball of {text_of(record['ball_mass'], None, 'kg')} came back with {record['bounce']:+.3f} of its speed, "
        f"from the shaft held firm with {record['restitution']:.3f}",
    ]
    budget = table_of("Where the error comes from", ["reading", "error of the end mass", "share"])
    whole = sum(x**2 for x in record["budget"].values()) or 1.0
    for name, error in sorted(record["budget"].items(), key=lambda item: -item[1]):
        budget.add_row(name, f"{100 * error:.2f} %", f"{100 * error**2 / whole:.0f} %")
    made: list[Any] = [*first, "", budget, *record["remarks"]]
    squirt = record["squirt"]
    if squirt is not None:
        drawn = text_of(squirt["drawn_end_mass"], None, "kg")
        before, after = (text_of(squirt[key], squirt[f"{key}_error"], "rad") for key in ("before", "after"))
        made += [
            "",
            f"the drawing has {drawn} in this test",
            f"squirt at b/R {squirt['offset']:g}: by the drawing alone {before}, with this end mass {after}",
            "(of the coupled strike with its own contact time, dome and tip; what stays open, and a tenth for the "
            "model, count as error)",
        ]
    elif record["lumped_squirt"] is not None:
        made += [
            "",
            f"a lumped cue with this end mass and a flat tip squirts {text_of(record['lumped_squirt'], None, 'rad')}; "
            "a domed tip adds to that: with --scene the drawing's tip counts",
        ]
    return made


def plan_record(end_mass: float = USUAL, restitution: float = 0.8) -> Record:
    """How to choose ball and thread."""
    speeds = [2 * (GRAVITY * THREAD) ** 0.5 * (1 - (1 - (d / THREAD) ** 2) ** 0.5) ** 0.5 / 2**0.5 for d in SWINGS]
    return {
        "end_mass": end_mass,
        "restitution": restitution,
        "balls": [choice._asdict() for choice in choices(end_mass, restitution, PLAN_ERROR)],
        "swings": [{"swing": d, "speed": v} for d, v in zip(SWINGS, speeds, strict=True)],
        "thread": THREAD,
        "softness": [one._asdict() for one in softness(end_mass, speeds[1], restitution)],
        "pressed": PRESSED,
    }


def plan_tables(record: Record) -> list[Any]:
    """For people."""
    balls = table_of("The ball", ["mass", "comes back with", "error of the end mass"], text_columns=0)
    for one in record["balls"]:
        balls.add_row(text_of(one["ball_mass"], None, "kg"), f"{one['bounce']:+.2f}", f"{100 * one['error']:.1f} %")
    about = text_of(record["end_mass"], None, "kg")
    soft = table_of("How soft", ["contact time", "pressed 0.5 mm into the ferrule by"], text_columns=0)
    for one in record["softness"]:
        soft.add_row(text_of(one["contact_time"], None, "s"), f"{one['force']:.0f} N ({one['force'] / 9.81:.1f} kg)")
    swings = table_of("The thread", ["swing aside", "speed of the blow"], text_columns=0)
    for one in record["swings"]:
        swings.add_row(text_of(one["swing"], None, "m"), f"{one['speed']:.2f} m/s")
    return [
        with_caption(
            balls,
            f"For an end mass of {about}, a restitution of {record['restitution']:g} and ratios of speeds good to "
            f"{100 * PLAN_ERROR:g} %.",
            "A ball as heavy as the end mass tells most; a lighter one comes back (+), a heavier one goes on (-).",
        ),
        with_caption(
            soft,
            "By Hertz's law, for a ball as heavy as the end mass and a swing of 0.2 m. A stroke lasts 0.5 to 2 ms.",
            "Press the ball on the ferrule, on a kitchen scale, and give --press and --press-depth.",
        ),
        with_caption(
            swings,
            f"A thread of {record['thread']:g} m. Read how far aside the ball swings, not how high: "
            "of a swing of 200 mm, 1 mm is 0.5 % of the speed; of its height of 20 mm, 2.5 %.",
        ),
    ]
