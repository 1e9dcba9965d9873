"""What commands share: a file and its options to a scene; tables for people, --json for programs."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from cuefem.cue import Cue
    from cuefem.quantity import Quantity
    from cuefem.scene import Scene
    from cuefem.side.scene import SideStrike

DEFAULT_OFFSET = 0.3  # of a bare cue file, b/R
# Mass, kg, and radius, m, of the balls that people play with; sources: studies/scenes (pool 2.25 in and at most 6 oz,
# carom UMB 61.5 mm, snooker WPBSA 52.5 mm and what sets are sold at).
BALLS = {"pool": (0.170, 0.028575), "carom": (0.210, 0.03075), "snooker": (0.142, 0.02625)}


def file_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The file argument, and the options of every command on a file."""
    return click.argument("file", type=click.Path(path_type=Path))(cue_options(command))


def cue_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options for what a cue's file may leave out, and --json."""
    return click.option("--json", "as_json", is_flag=True, help="SI numbers as JSON.")(shape_options(command))


def shape_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options for what a file that holds only a shape leaves out: mass, material and unit."""
    for option in (
        click.option("--body-mass", metavar="MASS", help='Mass of the cue behind FILE\'s segments, e.g. "420 g".'),
        click.option(
            "--material", metavar="NAME", help="Material of a .csv or a CAD surface (see `cuefem materials`)."
        ),
        click.option("--length-unit", metavar="UNIT", help="Unit of a .stl, .ply or .obj surface; mm by default."),
    ):
        command = option(command)
    return command


def blow_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options that replace the scene's ball and contact time."""
    ball = click.option(
        "--ball", type=click.Choice(tuple(BALLS)), help="The ball; by default the scene's, carom for a bare cue."
    )
    return ball(
        click.option("--contact-time", metavar="TIME", help='How long the tip touches the ball head on, e.g. "1 ms".')(
            command
        )
    )


def offset_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """The option that replaces the stroke's offset."""
    return click.option("--offset", metavar="B/R", help="How far off centre the tip hits, in ball radii, in (-1, 1).")(
        command
    )


def force_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """The option of every command that writes a drawing."""
    return click.option("--force", is_flag=True, help="Replace a drawing that exists already.")(command)


def check_free(drawing: Path, *, force: bool) -> None:
    """Refuse to replace a drawing without --force, for it is somebody's work; pages and figures can be made again."""
    from cuefem.io import InputError, check_place

    if drawing.exists() and not drawing.is_dir() and not force:
        raise InputError(drawing, "", "is there already: --force replaces it")
    check_place(drawing)


@contextmanager
def blaming(file: Path) -> Iterator[None]:
    """Name the file in errors that appear only while computing, such as an effect that lies off the cue."""
    from cuefem.io import InputError

    try:
        yield
    except ValueError as error:
        raise InputError(file, "", str(error)) from None


def measured(file: Path, option: str, given: str, wanted: Quantity) -> float:
    """An option's text as a checked SI number."""
    from cuefem.io import InputError
    from cuefem.io.units import quantity

    value: Any = given
    with suppress(ValueError):
        value = float(given) if wanted.unit == "" else value
    try:
        return quantity(wanted, value)
    except ValueError as error:
        raise InputError(file, option, str(error)) from None


class Definitions(click.Choice[str]):
    """The names of the end-mass definitions, and ``more``; loaded only when a command needs them, for it is slow."""

    def __init__(self, *more: str) -> None:
        self.more, self.case_sensitive = more, True

    @property
    def choices(self) -> tuple[str, ...]:  # type: ignore[override]
        """All names."""
        from cuefem.endmass.drives import DEFINITIONS

        return (*self.more, *DEFINITIONS)


class WithDefinitions(click.Command):
    """A command whose help ends with the definitions of the end mass."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write name and meaning of every definition."""
        from cuefem.endmass.drives import DEFINITIONS

        with formatter.section("Definitions of the end mass"):
            formatter.write_dl([(one.name, one.meaning) for one in DEFINITIONS.values()])


def scene_of(file: Path, given: dict[str, Any], *, blow: bool = True) -> tuple[Scene, list[str]]:
    """The scene that a command computes, and what was assumed because neither file nor options say it.

    blow: whether ball, tip and stroke matter to the command, so that what is assumed of them is told too.
    """
    from cuefem.io import load_stroke
    from cuefem.io.assumed import assumed, assumed_blow
    from cuefem.scene import Scene, Stroke

    found = load_stroke(file, material=given["material"], length_unit=given.get("length_unit"))
    said = {name for name, value in given.items() if value is not None}
    notes = assumed(file, said, offered=given, blow=blow)
    if not isinstance(found, Scene):
        found = Scene(found, stroke=Stroke(offset=DEFAULT_OFFSET))
        notes += assumed_blow({}, said, offered=given, offset=DEFAULT_OFFSET) if blow else []
    scene = _with_options(found, file, given)
    remark(scene)
    return scene, notes


def remark(scene: Scene) -> None:
    """Say on stderr which numbers are unusual; a wrong unit is the most common reason."""
    from cuefem.report.unusual import unusual

    for line in unusual(scene):
        click.echo(f"unusual: {line}", err=True)


def _with_options(scene: Scene, file: Path, given: dict[str, Any]) -> Scene:
    """The scene with the values that the command's options give."""
    from cuefem.quantity import CONTACT_TIME, Quantity
    from cuefem.scene import Ball

    if given.get("ball") is not None:
        scene = replace(scene, ball=Ball(*BALLS[given["ball"]]))
    if given.get("offset") is not None:
        offset = measured(file, "--offset", given["offset"], Quantity("", "(-1, 1)"))
        scene = replace(scene, stroke=replace(scene.stroke, offset=offset))
    if given.get("contact_time") is not None:
        time = measured(file, "--contact-time", given["contact_time"], CONTACT_TIME)
        scene = replace(scene, tip=replace(scene.tip, contact_time=time, stiffness=None))
    if given["body_mass"] is not None:
        scene = with_body(scene, file, given["body_mass"])
    return scene


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


def show(
    file: Path,
    given: dict[str, Any],
    results: Callable[[Scene], Any],
    tables: Callable[..., Any],
    *,
    blow: bool = True,
    change: Callable[[Scene], Scene] | None = None,
) -> None:
    """Compute all of it first, then print it all: as JSON, or as a heading and tables.

    blow: see `scene_of`. change: what the command's own options make of the scene.
    """
    from cuefem.report.quantities import UNITS
    from cuefem.report.record import plain, scene_record
    from cuefem.report.unusual import unusual
    from cuefem.report.words import cue_line, effect_words

    scene, notes = scene_of(file, given, blow=blow)
    with blaming(file):
        scene = scene if change is None else change(scene)
        about, found = scene_record(scene), results(scene)
    if given["as_json"]:
        said = {"file": str(file), "assumed": notes, "unusual": unusual(scene)}
        print_json({**said, "scene": about, **found, "units": UNITS})
        return
    lines = [f"{file.name}: {cue_line(plain(about['cue']))}"]
    if scene.effects:
        lines.append(f"effects: {', '.join(map(effect_words, scene.effects))}")
    if notes:
        lines.append(f"assumed: {'; '.join(notes)}")
    print_all([*lines, "", *tables(found, about)])


def print_json(record: Any) -> None:
    """Print a record for programs."""
    from cuefem.report.record import plain

    click.echo(json.dumps(plain(record), indent=2, allow_nan=False, ensure_ascii=False))


def print_all(things: Sequence[Any]) -> None:
    """Print lines and tables for people."""
    from rich.console import Console

    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = 120  # files and pipes have no width: do not cut tables
    for thing in things:
        console.print(thing, markup=False) if isinstance(thing, str) else console.print(thing, crop=False)


def followed(work: Sequence[Any]) -> Iterable[Any]:
    """The work, with a progress bar if stderr is a terminal."""
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True)
    return track(work, "computing", console=console, transient=True) if console.is_terminal else work
