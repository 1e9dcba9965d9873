"""The pendulum test of the end mass."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import blaming, scene_of, shape_options
from cuefem.cli.printing import assumed_lines, json_option, page_option, tell
from cuefem.cli.strokes import game_option, measured, offset_of, offset_option
from cuefem.games import GAMES
from cuefem.io import InputError
from cuefem.io.fittings import FITTINGS
from cuefem.measured.pendulum import WAYS as KNOWN
from cuefem.measured.pendulum import Bounces, PendulumTest, Told, Weighed, lumped_squirt, pressed_time, squirt_told
from cuefem.quantity.fields import Quantity
from cuefem.report.pendulum_table import plan_record, plan_sheets, weigh_record, weigh_sheets
from cuefem.results.quantities import UNITS as QUANTITIES
from cuefem.scene import Stroke, Tip

NAME = Path("weigh")  # what error messages name in the place of a file
MASSES = ("error", "interval_68", "interval_95", "drawn_end_mass")
ANGLES = ("lumped_squirt", "before", "before_error", "after", "after_error")
UNITS = QUANTITIES | dict.fromkeys(MASSES, "kg") | dict.fromkeys(ANGLES, "rad") | {"impact_speed": "m/s"}
UNITS |= dict.fromkeys(("swing", "thread", "pressed"), "m") | {"ball_mass": "kg"}
WAYS = ("swing", "height", "speed", "frames")


@click.command()
@click.option("--plan", is_flag=True, help="Show how to choose ball and thread, instead.")
@click.option("--end-mass", metavar="MASS", help='The end mass to --plan for; "7 g" by default.')
@click.option("--ball-mass", metavar="MASS", help='Of the light ball, e.g. "8.0 g".')
@click.option("--ball-mass-error", metavar="MASS", default="0.1 g", show_default=True, help="Its error.")
@click.option("--read", type=click.Choice(WAYS), default="swing", show_default=True, help="What the readings are.")
@click.option("--before", multiple=True, metavar="READING", help='Let go from, e.g. "200 mm"; once, or one a bounce.')
@click.option("--after", multiple=True, metavar="READING", help='Came back to; negative: went on, "-34 mm". Repeat it.')
@click.option("--held-before", multiple=True, metavar="READING", help="The same for the shaft held firm; as --before.")
@click.option("--held-after", multiple=True, metavar="READING", help="Off the shaft held firm. Repeat it.")
@click.option("--reading-error", metavar="READING", help='Of one reading; "1 mm", or half a frame by default.')
@click.option("--thread", metavar="LENGTH", help='Of the pendulum, which swings need, e.g. "1 m".')
@click.option("--restitution", metavar="E", help="In the place of --held-after, if it is known.")
@click.option("--restitution-error", metavar="E", default="0.01", show_default=True, help="Its error.")
@click.option("--contact-time", metavar="TIME", help='On the shaft held firm, e.g. "1 ms"; or')
@click.option("--press", metavar="FORCE", help='a force that presses the ball into the ferrule, e.g. "20 N", and')
@click.option("--press-depth", metavar="LENGTH", help='how far, e.g. "0.5 mm" (Hertz\'s law).')
@click.option("--contact-time-error", metavar="TIME", help="A tenth of the time by default.")
@click.option("--scene", "file", type=click.Path(path_type=Path), metavar="FILE", help="The shaft: cue or scene.")
@click.option(
    "--position", metavar="LENGTH", default="10 mm", show_default=True, help="Of the blow, from the tip's end."
)
@page_option
@json_option
@game_option("--ball", "The cue ball, for squirt; by default the scene's.")
@shape_options
@offset_option
def weigh(
    plan: bool, end_mass: str | None, file: Path | None, as_json: bool, output: Path | None, **options: Any
) -> None:
    """Weigh a shaft's end: a light ball on a thread hits the side of the tip end of the shaft, which hangs free.

    Give how far the ball swings before and after the blow (or its height, its speed, or the frames of a film over one
    distance), off the free shaft and off the shaft held firm. --plan says which ball and thread to take; the drawing
    with all the steps stands in the handbook, Measuring a cue (`cuefem guide measuring`).
    """
    if plan:
        plan_of_test = plan_record() if end_mass is None else plan_record(_read("--end-mass", end_mass, "kg"))
        tell(as_json, plan_of_test | {"units": UNITS}, plan_sheets(plan_of_test), output)
        return
    test = _test(options)
    with blaming(NAME):
        weighed = test.weighed()
    told, lumped, notes = _squirt(test, weighed, file, options)
    record = weigh_record(weighed, told, lumped)
    whole = {"assumed": notes, **record, "units": UNITS}
    tell(as_json, whole, [*assumed_lines(notes), *weigh_sheets(record)], output)


def _read(option: str, text: str, unit: str, bounds: str = "(0, inf)") -> float:
    return measured(NAME, option, text, Quantity(unit, bounds))


def _test(options: dict[str, Any]) -> PendulumTest:
    """The test that the options tell of."""
    for name in ("ball_mass", "before", "after"):
        if not options[name]:
            raise InputError(NAME, f"--{name.replace('_', '-')}", "must be given (or --plan); got nothing")
    mass = _read("--ball-mass", options["ball_mass"], "kg")
    free = _bounces(options, "")
    wall = _bounces(options, "held_") if options["held_after"] else None
    e = options["restitution"]
    if (wall is None) == (e is None):
        got = "neither" if wall is None else "both"
        raise InputError(NAME, "--held-after", f"or --restitution must be given; got {got}")
    restitution = None if e is None else _read("--restitution", e, "", "(0, 1]")
    if options["contact_time"] is not None:
        time = _read("--contact-time", options["contact_time"], "s", "[1e-6, 10]")
    elif options["press"] is not None and options["press_depth"] is not None:
        speed = free.impact_speed
        if speed is None:
            raise InputError(
                NAME, "--press", "must go with readings that tell a speed; got frames: give --contact-time"
            )
        force, depth = _read("--press", options["press"], "N"), _read("--press-depth", options["press_depth"], "m")
        back = restitution if wall is None else min(max(wall.ratio[0], 0.01), 1.0)
        assert back is not None
        time = pressed_time(force, depth, mass, speed, back)
    else:
        raise InputError(NAME, "--contact-time", "must be given, or --press and --press-depth; got nothing")
    later = options["contact_time_error"]
    about: dict[str, Any] = {
        "restitution": restitution,
        "restitution_error": 0.0
        if e is None
        else _read("--restitution-error", options["restitution_error"], "", "[0, 1)"),
        "contact_time_error": time / 10 if later is None else _read("--contact-time-error", later, "s", "[0, inf)"),
    }
    error = _read("--ball-mass-error", options["ball_mass_error"], "kg", "[0, inf)")
    with blaming(NAME):
        return PendulumTest(mass, error, free, contact_time=time, wall=wall, **about)


def _bounces(options: dict[str, Any], grip: str) -> Bounces:
    """The readings of the bounces off the free shaft; with grip "held_", off the shaft that is held firm."""
    way = options["read"]
    unit = KNOWN[way].unit
    names = f"{grip}before", f"{grip}after"
    before, after = (
        tuple(_read(f"--{name.replace('_', '-')}", text, unit, "(-inf, inf)") for text in options[name])
        for name in names
    )
    before = before or tuple(_read("--before", text, unit, "(-inf, inf)") for text in options["before"][:1])
    usual = {"m": "1 mm", "m/s": "0.01 m/s", "": "0.5"}[unit]
    error = _read("--reading-error", options["reading_error"] or usual, unit)
    thread = {} if options["thread"] is None else {"thread": _read("--thread", options["thread"], "m")}
    with blaming(NAME):
        return Bounces(way, before, after, error, **thread)


def _squirt(
    test: PendulumTest, weighed: Weighed, file: Path | None, options: dict[str, Any]
) -> tuple[Told | None, float | None, list[str]]:
    """What the end mass says about squirt: through the drawing, or as a lumped cue's; and what was assumed."""
    if file is None:
        for name in FITTINGS:
            if options[name] is not None:
                option = f"--{name.replace('_', '-')}"
                raise InputError(NAME, option, "must go with --scene, whose shape it is for; got no --scene")
        ball = GAMES[options["ball"] or "pool"].ball
        offset = 0.3 if options["offset"] is None else offset_of(NAME, options["offset"], float(ball.radius))
        cue, kind = 0.54, options["ball"] or "pool"
        body = options["body_mass"]
        mass = cue if body is None else _read("--body-mass", body, "kg")
        notes = [f"{kind} ball", f"offset b/R {offset:g}", f"cue {1e3 * mass:.4g} g", f"e {Tip().restitution:g}"]
        return None, lumped_squirt(weighed.end_mass, mass, ball, Tip(), Stroke(1.0, offset)), notes
    scene, notes = scene_of(file, {**options, "contact_time": None})
    if scene.lumped is not None:
        raise InputError(file, "", "must hold a cue of segments, which can be weighed; got a lumped cue")
    position = _read("--position", options["position"], "m", "[0, inf)")
    with blaming(file):
        return squirt_told(test, weighed, scene, position), None, notes
