"""The commands: from a cue's file to its modes, end mass and squirt; tables for people, --json for programs."""

from __future__ import annotations

import importlib.util
import json
import os
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cuefem.sweep_command import sweep

if TYPE_CHECKING:
    from cuefem.quantity import Quantity
    from cuefem.scene import Scene
    from cuefem.validation import Claim

# Before NumPy is loaded: small dense matrices gain nothing from BLAS threads, and two of them on a busy machine can be
# a hundred times slower than one.
for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

DEFAULT_OFFSET = 0.3  # of a bare cue file, b/R


class _OneLine(click.Group):
    """Bad input ends in one line on stderr and status 2, a numerical failure in one and status 1; no tracebacks."""

    def main(self, *arguments: Any, **options: Any) -> Any:
        try:
            return super().main(*arguments, **options)
        except OSError as error:  # what could not be printed, onto a full disk for one; click ends broken pipes itself
            _forget_output()
            with suppress(OSError):
                click.echo(f"cuefem: {error.filename or 'cannot write'}: {error.strerror or error}", err=True)
            sys.exit(1)

    def invoke(self, ctx: click.Context) -> Any:
        import numpy as np  # not for --help

        try:
            with np.errstate(over="raise", divide="raise", invalid="raise"):
                return super().invoke(ctx)
        except (ArithmeticError, MemoryError) as error:
            what = "sizes, masses or times are out of all proportion"
            click.echo(f"cuefem: {what}, so that numbers overflow ({type(error).__name__})", err=True)
            raise click.exceptions.Exit(2) from None
        except (ValueError, RuntimeError) as error:
            if isinstance(error, click.exceptions.Exit | click.exceptions.Abort):
                raise
            click.echo(f"cuefem: {' '.join(str(error).split())}", err=True)
            raise click.exceptions.Exit(2 if isinstance(error, ValueError) else 1) from None


def _forget_output() -> None:
    """Let what is left for stdout go nowhere, so that Python does not fail on it once more when it ends."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())


@click.group(cls=_OneLine, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="cuefem")
def main() -> None:
    """From a cue shaft's drawing to its effective end mass and squirt.

    FILE is a cue or a scene (.toml), a lathe profile (.csv) or a mesh (.vtk, .vtu).
    """


def _options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The file and what every command on a file takes."""
    for option in (
        click.option("--json", "as_json", is_flag=True, help="SI numbers as JSON."),
        click.option("--body-mass", metavar="MASS", help='Mass of the cue behind FILE\'s segments, e.g. "420 g".'),
        click.option("--material", metavar="NAME", help="Material of a .csv profile (see `cuefem materials`)."),
        click.argument("file", type=click.Path(path_type=Path)),
    ):
        command = option(command)
    return command


def _contact_time_option(command: Callable[..., Any]) -> Callable[..., Any]:
    return click.option("--contact-time", metavar="TIME", help='Head-on contact time, e.g. "2 ms".')(command)


def _measured(file: Path, option: str, given: str, wanted: Quantity) -> float:
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


def _scene(file: Path, given: dict[str, Any]) -> tuple[Scene, list[str]]:
    """The scene that a command computes, and what was assumed because nobody said it."""
    from cuefem.cue import Cue
    from cuefem.io import load
    from cuefem.io.assumed import assumed, unusual
    from cuefem.scene import Scene, Stroke

    found = load(file, material=given["material"])
    said = {name for name, value in given.items() if value is not None}
    notes = assumed(file, said)
    if isinstance(found, Cue):
        found = Scene(found, stroke=Stroke(offset=DEFAULT_OFFSET))
        offset = "" if "offset" in said else f", offset b/R {DEFAULT_OFFSET:g}"
        notes.append(f"default ball and tip{offset}")
    scene = _with_options(found, file, given)
    for line in unusual(scene):
        click.echo(f"unusual: {line}", err=True)
    return scene, notes


def _with_options(scene: Scene, file: Path, given: dict[str, Any]) -> Scene:
    """The scene with what the command's options replace."""
    from cuefem.cue import Cue
    from cuefem.io import InputError
    from cuefem.quantity import Quantity

    if given.get("offset") is not None:
        offset = _measured(file, "--offset", given["offset"], Quantity("", "(-1, 1)"))
        scene = replace(scene, stroke=replace(scene.stroke, offset=offset))
    if given.get("contact_time") is not None:
        time = _measured(file, "--contact-time", given["contact_time"], Quantity("s", "(0, inf)"))
        scene = replace(scene, tip=replace(scene.tip, contact_time=time, stiffness=None))
    if given["body_mass"] is not None:
        mass = _measured(file, "--body-mass", given["body_mass"], Quantity("kg", "[0, inf)"))
        if not isinstance(scene.cue, Cue):
            raise InputError(file, "--body-mass", "must be left out: a lumped cue is whole")
        scene = replace(scene, cue=replace(scene.cue, body_mass=mass))
    return scene


def _show(file: Path, given: dict[str, Any], results: Callable[[Scene], Any], tables: Callable[..., Any]) -> None:
    """Compute all of it first, then print it all: as JSON, or as a heading and tables."""
    from cuefem.io import InputError
    from cuefem.report.records import UNITS, plain, scene_record
    from cuefem.report.tables import cue_line, effect_words

    scene, notes = _scene(file, given)
    try:
        about, found = scene_record(scene), results(scene)
    except ValueError as error:  # what only shows when it is computed, such as an effect off the cue
        raise InputError(file, "", str(error)) from None
    if given["as_json"]:
        _print_json({"file": str(file), "assumed": notes, "scene": about, **found, "units": UNITS})
        return
    lines = [f"{file.name}: {cue_line(plain(about['cue']))}"]
    if scene.effects:
        lines.append(f"effects: {', '.join(map(effect_words, scene.effects))}")
    if notes:
        lines.append(f"assumed: {'; '.join(notes)}")
    _print([*lines, "", *tables(found, about)])


def _print_json(record: Any) -> None:
    from cuefem.report.records import plain

    click.echo(json.dumps(plain(record), indent=2, allow_nan=False, ensure_ascii=False))


def _print(things: Sequence[Any]) -> None:
    from rich.console import Console

    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = 120  # files and pipes have no width: do not cut tables
    for thing in things:
        console.print(thing, markup=False) if isinstance(thing, str) else console.print(thing)


@main.command()
@_options
@click.option("--near", metavar="HERTZ", help="Those nearest this frequency, instead of the lowest.")
@click.option("--count", type=click.IntRange(min=1), default=6, show_default=True, help="How many modes.")
def modes(file: Path, near: str | None, count: int, **given: Any) -> None:
    """How it rings: bending frequencies and tip amplitudes."""
    from cuefem.quantity import Quantity
    from cuefem.report import modes_record, modes_table

    def results(scene: Scene) -> Any:
        return modes_record(scene, count=count, near=hertz)

    hertz = None
    if near is not None:
        with suppress(ValueError):
            near = f"{float(near)} Hz"
        hertz = _measured(file, "--near", near, Quantity("Hz", "[0, inf)"))
    _show(file, given, results, lambda found, about: [modes_table(found)])


@main.command("end-mass")
@_options
@_contact_time_option
def end_mass(file: Path, **given: Any) -> None:
    """How much mass the ball feels across the cue at its tip."""
    from cuefem.report import end_mass_record, end_mass_table

    _show(file, given, end_mass_record, lambda found, about: [end_mass_table(found, about)])


@main.command()
@_options
@_contact_time_option
@click.option("--offset", metavar="B/R", help="Offset over ball radius, in (-1, 1).")
def strike(file: Path, **given: Any) -> None:
    """One stroke: squirt, speed, spin and pivot length; to the file's [accuracy] rtol, where it has one."""
    from cuefem.accuracy import resolve
    from cuefem.io import load_accuracy
    from cuefem.report import strike_record, strike_table

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return strike_record(scene, None if rtol is None else resolve(scene, rtol))

    _show(file, given, results, lambda found, about: [strike_table(found, about)])


@main.command()
@_options
@_contact_time_option
@click.option("--offset", metavar="B/R", help="Offset over ball radius, in (-1, 1).")
def effects(file: Path, **given: Any) -> None:
    """What each effect is worth: each one listed dropped, each other one added.

    The tolerance is the file's [accuracy] rtol, 1e-2 without it.
    """
    from cuefem.io import load_accuracy
    from cuefem.report import DEFAULT_RTOL, effects_record, effects_table

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return effects_record(scene, rtol=DEFAULT_RTOL if rtol is None else rtol, track=_followed)

    _show(file, given, results, lambda found, about: [effects_table(found, about)])


@main.command()
@_options
@_contact_time_option
@click.option("--offset", metavar="B/R", help="Offset over ball radius, in (-1, 1).")
@click.option("--most", type=click.IntRange(min=24), default=150, show_default=True, help="Modes at most.")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FIGURE", help="Draw it too: .png or .svg.")
def cost(file: Path, most: int, output: Path | None, **given: Any) -> None:
    """What accuracy costs: error against seconds and unknowns for this scene, and the resolution to take."""
    from cuefem.io import FIGURES, InputError, save_figure
    from cuefem.report.cost import cost_figure, cost_record, cost_tables

    if output is not None and output.suffix not in FIGURES:
        raise InputError(output, "--output", f"must end in .png or .svg; got {output.suffix!r}")

    def results(scene: Scene) -> Any:
        found = cost_record(scene, most=most, track=_followed)
        if output is not None:
            save_figure(cost_figure(found, f"{file.name}: what accuracy costs", output.suffix[1:]), output)
        return found

    _show(file, given, results, lambda found, about: cost_tables(found))


def _followed(work: Sequence[Any]) -> Iterable[Any]:
    """The work, with a bar on stderr where a person looks on."""
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True)
    return track(work, "computing", console=console, transient=True) if console.is_terminal else work


@main.command()
@_options
@_contact_time_option
@click.option("--offset", metavar="B/R", help="Offset over ball radius, in (-1, 1).")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="PAGE.html", help="Write a page instead.")
def report(file: Path, output: Path | None, **given: Any) -> None:
    """All of it: modes, end masses, squirt and pivot length against offset; as tables, or as a page with figures."""
    from cuefem.report import end_mass_table, modes_table, pivot_table, report_record, squirt_table

    def tables(found: Any, about: Any) -> list[Any]:
        first = [modes_table(found["modes"])] if "modes" in found else []
        masses, squirt = found["end_masses"], found["squirt"]
        return [*first, end_mass_table(masses, about), squirt_table(squirt, about), pivot_table(squirt)]

    if output is None:
        _show(file, given, report_record, tables)
    else:
        _write_page(file, output, given)


def _write_page(file: Path, output: Path, given: dict[str, Any]) -> None:
    from cuefem.io import InputError, load_accuracy, save_page
    from cuefem.report.page import page

    if given["as_json"]:
        raise InputError(output, "--output", "must be left out with --json: a page is no JSON")
    scene, notes = _scene(file, given)
    try:
        text = page(file.name, scene, rtol=load_accuracy(file), notes=notes, track=_followed)
    except ValueError as error:
        raise InputError(file, "", str(error)) from None
    save_page(text, output)
    click.echo(f"wrote {output}")


@main.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.argument("output", type=click.Path(path_type=Path))
@click.option("--material", metavar="NAME", help="Material of a .csv profile (see `cuefem materials`).")
def convert(file: Path, output: Path, material: str | None) -> None:
    """Write FILE as another kind of file: OUTPUT ends in .toml, .vtk or .vtu."""
    from cuefem.io import DEFAULT_MATERIAL, load, save

    save(load(file, material=material), output)
    if file.suffix == ".csv" and material is None:
        click.echo(f"assumed: material {DEFAULT_MATERIAL} (choose with --material)")


@main.command()
@click.option("--json", "as_json", is_flag=True, help="The same: the schema is JSON.")
def schema(as_json: bool) -> None:
    """JSON schema of cue and scene files, for editors."""
    from cuefem.io.export import json_schema

    click.echo(json.dumps(json_schema(), indent=2, allow_nan=False, ensure_ascii=False))


@main.command()
@click.option("--studies", type=click.Path(path_type=Path), default=Path("studies"), show_default=True)
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def validate(studies: Path, as_json: bool) -> None:
    """What the sources print beside what follows: every claim of every study, in a clone of the repository."""
    from cuefem.report import claims_record, claims_table
    from cuefem.report.tables import VERDICT_WORDS

    found = claims_record(_claims(studies))
    if as_json:
        _print_json({"claims": found})
        return
    counts = Counter(claim["verdict"] for claim in found)
    totals = ", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items()))
    _print([claims_table(found), totals, VERDICT_WORDS])


def _claims(folder: Path) -> list[tuple[str, Claim]]:
    """The claims of every study in a folder that defines claims(), with the study's name."""
    from cuefem.io import InputError, studies_with

    clone = "they are in a clone of cuefem's repository: run there, or name their folder with --studies"
    if not folder.is_dir():
        raise InputError(folder, "", f"cannot be read: no such folder of studies; {clone}")
    files = studies_with(folder, "claims")
    if not files:
        raise InputError(folder, "", f"must hold studies (.py) that define claims(), got none; {clone}")
    if (above := str(folder.resolve().parent)) not in sys.path:
        sys.path.insert(0, above)  # studies import one another as studies.NAME
    found = []
    for file in files:
        spec = importlib.util.spec_from_file_location(f"{folder.resolve().name}.{file.stem}", file)
        assert spec is not None and spec.loader is not None  # noqa: PT018
        study = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = study  # dataclasses look their module up
        spec.loader.exec_module(study)
        found += [(file.stem, claim) for claim in study.claims()]
    return found


@main.command()
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def materials(as_json: bool) -> None:
    """The materials that a file can name, with their sources."""
    from cuefem.report import materials_record, materials_table

    found = materials_record()
    if as_json:
        _print_json(found)
    else:
        _print([materials_table(found)])


main.add_command(sweep)
