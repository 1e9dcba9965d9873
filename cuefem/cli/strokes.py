"""Ball, tip and stroke on the command line: the options, and the scene that they make of a file's cue or scene."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from cuefem.cue import Cue
    from cuefem.quantity import Quantity
    from cuefem.scene import Scene
    from cuefem.side.scene import SideStrike

Command = Callable[..., Any]


class Games(click.Choice[str]):
    """The names of the games; loaded only when a command needs them, for it is slow."""

    def __init__(self) -> None:
        self.case_sensitive = True

    @property
    def choices(self) -> tuple[str, ...]:  # type: ignore[override]
        """All names."""
        from cuefem.games import GAMES

        return (*GAMES,)


# The options of the leather tip and of the stroke: the field that each replaces, and its help.
OF_LEATHER = {
    "tip_height": ("height", "LENGTH", 'Height of the leather tip, e.g. "6 mm".'),
    "dome": ("dome_radius", "RADIUS", 'Radius of its dome: nickel, dime, flat or a length, e.g. "9.5 mm".'),
    "leather": ("E", "LEATHER", 'Its leather: soft, medium, hard, or its E, e.g. "140 MPa".'),
}
OF_STROKE = {
    "restitution": ("tip", "restitution", "E", "Coefficient of restitution of tip and ball, in [0, 1]."),
    "friction": ("tip", "friction", "MU", "Coefficient of friction of tip and ball."),
    "speed": ("stroke", "speed", "SPEED", 'Speed of the cue, e.g. "3 m/s".'),
    "offset": (
        "stroke",
        "offset",
        "B/R",
        'How far off centre the tip hits: in ball radii, in (-1, 1), or a length, e.g. "8 mm".',
    ),
}


def option(name: str) -> str:
    """An option as it is typed."""
    return f"--{name.replace('_', '-')}"


def stroke_options(*names: str) -> Callable[[Command], Command]:
    """Options of the stroke, by name."""

    def decorated(command: Command) -> Command:
        for name in reversed(names):
            *_, what, words = OF_STROKE[name]
            command = click.option(option(name), metavar=what, help=words)(command)
        return command

    return decorated


def tip_options(command: Command) -> Command:
    """The game, and the options of the leather tip."""
    for name, (_, what, words) in reversed(OF_LEATHER.items()):
        command = click.option(option(name), metavar=what, help=words)(command)
    return click.option(
        "--game", type=Games(), help="Whose usual ball, tip and stroke a cue without a scene gets; pool by default."
    )(command)


def blow_options(command: Command) -> Command:
    """The options that replace ball, tip and speed."""
    timed = click.option(
        "--contact-time",
        metavar="TIME",
        help='A spring as tip, without dome and shear, that touches the ball so long head on, e.g. "1 ms".',
    )
    ball = click.option("--ball", type=Games(), help="The ball; by default the scene's or the game's.")
    return tip_options(ball(stroke_options("restitution", "friction", "speed")(timed(command))))


def offset_option(command: Command) -> Command:
    """The option that replaces the stroke's offset."""
    return stroke_options("offset")(command)


def measured(file: Path, name: str, given: str, wanted: Quantity) -> float:
    """An option's text as a checked SI number."""
    from cuefem.io import InputError

    value: Any = given
    with suppress(ValueError):
        value = float(given) if wanted.unit == "" else value
    try:
        return wanted.read(value)
    except ValueError as error:
        raise InputError(file, name, str(error)) from None


def offset_of(file: Path, given: str, radius: float) -> float:
    """The b/R that --offset gives: a bare number, or a length, over the radius of the ball, m."""
    from cuefem.io import InputError
    from cuefem.quantity import Quantity
    from cuefem.units import number

    try:
        length = number(given, "m")
    except ValueError:
        try:
            return measured(file, "--offset", given, Quantity("", "(-1, 1)"))
        except InputError as error:
            if "bare number" not in error.problem:
                raise
            problem = error.problem.replace("; got", ', b/R, or a length such as "8 mm"; got', 1)
            raise InputError(file, "--offset", problem) from None
    if not abs(length) < radius:
        within = f"a length in (-{1e3 * radius:g}, {1e3 * radius:g}) mm, the radius of the ball"
        raise InputError(file, "--offset", f"must be b/R in (-1, 1) or {within}; got {given!r}")
    return length / radius


def with_body(found: Cue | Scene | SideStrike, file: Path, given: str) -> Any:
    """The cue or scene of a file with the mass behind its segments that --body-mass says."""
    from cuefem.cue import Cue
    from cuefem.io import InputError
    from cuefem.quantity import Quantity

    mass = measured(file, "--body-mass", given, Quantity("kg", "[0, inf)"))
    if isinstance(found, Cue):
        return replace(found, body_mass=mass)
    if not isinstance(found.cue, Cue):
        raise InputError(file, "--body-mass", "must be left out: a lumped cue is whole")
    return replace(found, cue=replace(found.cue, body_mass=mass))


def usual(cue: Cue, file: Path, given: dict[str, Any]) -> Scene:
    """The scene of a cue alone: the game's usual stroke, with a spring as tip where a contact time is given."""
    from cuefem.games import DEFAULT_GAME, GAMES, usual_scene, usual_tip
    from cuefem.io import InputError
    from cuefem.scene import Scene, Stroke, Tip

    game = given.get("game") or DEFAULT_GAME
    changed = _leather(file, given)
    if given.get("contact_time") is not None:
        for name in OF_LEATHER:
            if given.get(name) is not None:
                raise InputError(
                    file, option(name), "must be left out beside --contact-time, which takes a spring as tip"
                )
        known = GAMES[game]
        tip = Tip(known.restitution, known.friction)
        return with_options(Scene(cue, known.ball, tip, Stroke(known.speed, known.offset)), file, given)
    try:
        found = usual_scene(cue, game, tip=replace(usual_tip(cue, game), **changed))
    except ValueError as error:
        offered = [name for name in map(option, ("tip_height", "dome", "contact_time")) if name in map(option, given)]
        help_words = f" ({', '.join(offered)} {'change' if len(offered) > 1 else 'changes'} it)" if offered else ""
        raise InputError(file, "", f"{error}{help_words}") from None
    return with_options(found, file, given, drawn=False)


def with_options(scene: Scene, file: Path, given: dict[str, Any], *, drawn: bool = True) -> Scene:
    """The scene with the values that the command's options give.

    drawn: whether the scene is a file's own, so that a game is refused and the options of its leather tip count.
    """
    from cuefem.games import GAMES
    from cuefem.io import InputError
    from cuefem.quantity import CONTACT_TIME, quantities

    if given.get("ball") is not None:
        scene = replace(scene, ball=GAMES[given["ball"]].ball)
    for name, (part, field, *_) in OF_STROKE.items():
        if given.get(name) is not None:
            held = getattr(scene, part)
            marks = {known: mark for known, mark, *_ in quantities(type(held))}  # type: ignore[arg-type]
            value = (
                offset_of(file, given[name], float(scene.ball.radius))
                if name == "offset"
                else measured(file, option(name), given[name], marks[field])
            )
            scene = replace(scene, **{part: replace(held, **{field: value})})
    whole = scene.contact_terms.tip is not None
    if given.get("contact_time") is not None:
        time = measured(file, "--contact-time", given["contact_time"], CONTACT_TIME)
        if whole:
            raise InputError(
                file,
                "--contact-time",
                "must be left out beside LeatherTip, from which it follows (--leather changes it, and "
                "`cuefem tip --contact-time` finds the leather that has it)",
            )
        scene = replace(scene, tip=replace(scene.tip, contact_time=time, stiffness=None))
    if drawn:
        scene = _with_leather(scene, file, given, whole=whole)
    if given.get("body_mass") is not None:
        scene = with_body(scene, file, given["body_mass"])
    return scene


def _with_leather(scene: Scene, file: Path, given: dict[str, Any], *, whole: bool) -> Scene:
    from cuefem.io import InputError

    changed = _leather(file, given)
    if not changed:
        return scene
    if not whole:
        name = next(name for name in OF_LEATHER if given.get(name) is not None)
        raise InputError(file, option(name), "must be left out: the scene has no LeatherTip among its effects")
    leather = scene.leather
    effects = tuple(replace(leather, **changed) if each is leather else each for each in scene.effects)
    try:
        return replace(scene, effects=effects)
    except ValueError as error:
        raise InputError(file, "", str(error)) from None


def refuse_game(file: Path, given: dict[str, Any]) -> None:
    """A game is for a cue alone: a scene has ball, tip and stroke of its own."""
    from cuefem.io import InputError

    if given.get("game") is not None:
        problem = "must be left out: FILE is a scene, which has its own ball, tip and stroke"
        raise InputError(file, "--game", f"{problem} (--ball replaces the ball)")


def _leather(file: Path, given: dict[str, Any]) -> dict[str, Any]:
    """The fields of the leather tip that options give."""
    from cuefem.effects import LeatherTip
    from cuefem.materials import LEATHERS
    from cuefem.quantity import quantities

    marks = {name: mark for name, mark, *_ in quantities(LeatherTip)}
    marks["E"] = replace(marks["E"], words=tuple((name, leather.E) for name, leather in LEATHERS.items()))
    found: dict[str, Any] = {}
    for name, (field, *_) in OF_LEATHER.items():
        if given.get(name) is not None:
            found[field] = measured(file, option(name), given[name], marks[field])
    known = LEATHERS.get((given.get("leather") or "").strip().lower())
    return found | ({"nu": known.nu, "rho": known.rho} if known else {})
