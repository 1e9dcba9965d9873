"""Commands on a cue: report, improve, modes, end-mass, strike, cost."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

import cuefem as cf
from cuefem.analysis.reduction import PAPER_CUE_ENDS, PAPER_TONE, cue_end_quantity
from cuefem.analysis.shop_changes import PARTS, Limits
from cuefem.analysis.strike_table import SPEEDS, StrikeTable
from cuefem.cli.output import Command, print_json
from cuefem.cli.progress import with_progress_bar
from cuefem.cli.request import Request, file_names, open_request
from cuefem.cli.scene_command import (
    Presentation,
    analysis_command,
    calibration_option,
    check_overwrite,
    force_option,
)
from cuefem.cli.scene_options import CueFile, file_label, option, option_value, typed_name
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.files import InputError, load_accuracy, save_changed
from cuefem.files.errors import as_input_error
from cuefem.files.shop import ShopLimits, order_of, shop_of
from cuefem.parameters.parts import main_material
from cuefem.parameters.scene_changes import with_parameters
from cuefem.quantity.fields import Quantity
from cuefem.scene import Scene

if TYPE_CHECKING:
    from cuefem.analysis.design_changes import DesignChanges
    from cuefem.measurements.calibration import Calibration
    from cuefem.show.analysis import Analysis


class WithDefinitions(Command):
    """A command whose help ends with the definitions of the end mass."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write name and meaning of every definition."""
        with formatter.section("Definitions of the end mass"):
            formatter.write_dl([(definition.name, definition.meaning) for definition in DEFINITIONS.values()])


@analysis_command()
@click.option("--sheet", is_flag=True, help="Write the page of -o as one printed sheet for a customer.")
@click.option("--customer", metavar="NAME", help="Customer on the sheet, instead of that of the file's [order].")
@click.option("--serial", metavar="TEXT", help="Serial number on the sheet.")
@click.option("--date", metavar="TEXT", help="Date on the sheet (default: today).")
@calibration_option
def report(
    request: Request,
    sheet: bool,
    customer: str | None,
    serial: str | None,
    date: str | None,
    output: Path | None,
    calibration: Calibration | None,
) -> Analysis:
    """Report the squirt of a cue with its uncertainty, then natural frequencies, end mass, pivot length and masses.

    Prints tables; -o FILE.html writes a page with figures. Assumptions are listed last, each with its option.

    --sheet -o FILE.html writes one page for the customer: drawing, numbers, and the ball's way on a table. The name of
    the shop is that of shop.toml beside the file, in a folder above it, or in the user's configuration folder:
    [shop] name, line, logo; [defaults] body_mass, ferrule, units; [defaults.limits] wall, keep, stiffness_loss.
    """
    has_page = output is not None and output.suffix.lower() == ".html"
    said = {name: text for name, text in (("customer", customer), ("serial", serial), ("date", date)) if text}
    if sheet:
        if not has_page:
            raise InputError(request.file, "--sheet", "requires -o FILE.html")
        return _customer_sheet(request, said, calibration)
    if said:
        raise InputError(request.file, option(next(iter(said))), "is for --sheet")
    details = has_page
    rtol = load_accuracy(request.file) if details else None
    answer = cf.report(
        request.scene,
        rtol,
        calibration=calibration,
        limits=shop_limits(request),
        details=details,
        progress=with_progress_bar,
    )
    if output is None and {"verdict", "modes"} <= {*answer.sections}:  # nothing of a lumped cue can be changed
        asked = shlex.join(["cuefem", "improve", typed_name(request.file)])
        request.hints.append(f"Design changes: {asked}, with the same options")
    return answer


def _customer_sheet(request: Request, said: dict[str, str], calibration: Calibration | None) -> Analysis:
    """The sheet of a cue, with its logo and order checked before the computation."""
    shop, order = shop_of(request.file), order_of(request.file)
    logo = shop.logo()
    for name, text in said.items():
        with as_input_error(request.file, option(name)):
            order = replace(order, **{name: text})
    answer = cf.report(request.scene, calibration=calibration, progress=with_progress_bar)
    return cf.customer_sheet(answer, shop.shop, order, logo=logo)


def shop_limits(request: Request) -> Limits:
    """The limits of design changes of the shop.toml of a file; the usual ones without it."""
    shop = shop_of(request.file)
    return _with_limits(Limits(), shop.defaults.limits, shop.path, "defaults.limits.{}".format)


def _with_limits(usual: Limits, texts: ShopLimits, file: Path, key: Callable[[str], str]) -> Limits:
    """The usual limits with those of some texts, each checked in its own name: key of a name in the file."""
    given: dict[str, Any] = {"keep": texts.keep} if texts.keep else {}
    if texts.wall is not None:
        given["wall"] = option_value(file, key("wall"), texts.wall, Quantity("m", "(0, 1]"))
    if texts.stiffness_loss is not None:
        given["stiffness_loss"] = _share(file, key("stiffness_loss"), texts.stiffness_loss)
    for name, value in given.items():
        with as_input_error(file, key(name)):
            Limits(**{name: value})
    return replace(usual, **given)


@analysis_command(formats=(".html", ".json", ".toml"))
@click.option(
    "--take",
    metavar="ROW|together",
    help="Save the cue of table row ROW (1 is the first), or of the best changes together, as the .toml of -o.",
)
@click.option("--wall", metavar="LENGTH", help='Least wall of a bore or tube, e.g. ".100 in" (default: wood 2.5 mm).')
@click.option(
    "--keep", metavar="PARTS", multiple=True, help=f"Parts that stay as they are, with commas: {', '.join(PARTS)}."
)
@click.option(
    "--stiffness-loss", metavar="SHARE", help='Largest loss of stiffness of changes together (default: "5 %").'
)
@click.option(
    "--like",
    metavar="CUE",
    type=CueFile(),
    help='Instead: the smallest change to the squirt of another cue, a file or a name such as "predator z2".',
)
@calibration_option
@force_option
def improve(
    request: Request,
    take: str | None,
    wall: str | None,
    keep: tuple[str, ...],
    stiffness_loss: str | None,
    like: Path | None,
    output: Path | None,
    calibration: Calibration | None,
    force: bool,
    as_json: bool,
) -> Analysis | None:
    """List design changes a maker can make, with squirt, stiffness, mass and first natural frequency of each.

    Each change is applied on its own and computed by the coupled strike. Rows are sorted by squirt, lowest first. Above
    them: the best two changes together, within the limits; sizes are those of a shop.
    """
    parts = tuple(part.strip().casefold() for text in keep for part in text.split(","))
    limits = _with_limits(shop_limits(request), ShopLimits(wall, parts, stiffness_loss), request.file, option)
    drawing = output if output is not None and output.suffix.lower() == ".toml" else None
    if take is None and drawing is not None:
        raise InputError(drawing, "--output", "a drawing (.toml) needs the row to save, such as --take 1")
    if take is not None and drawing is None:
        raise InputError(request.file, "--take", "requires -o FILE.toml")
    if drawing is not None:
        check_overwrite(drawing, force=force)
    asked: dict[str, Any] = {"limits": limits, "calibration": calibration, "progress": with_progress_bar}
    if like is None:
        answer = cf.design_changes(request.scene, **asked)
    else:
        other = open_request(like, request.given).scene
        answer = cf.plays_like(request.scene, other, name=file_label(like), **asked)
    if take is None or drawing is None:
        return answer
    _save_change(request, answer, take, drawing, as_json=as_json)
    return None


def _share(file: Path, name: str, text: str) -> float:
    """A share such as "5 %" or 0.05."""
    number, percent = text.strip().removesuffix("%"), text.strip().endswith("%")
    with as_input_error(file, name):
        try:
            return float(number) / (100 if percent else 1)
        except ValueError:
            raise ValueError(f'must be a share such as "5 %"; got {text!r}') from None


def _save_change(request: Request, answer: DesignChanges, take: str, output: Path, *, as_json: bool) -> None:
    """Save the cue of a row, and name the command that compares it."""
    file, rows = request.file, [*answer.changes]
    row = answer.together[-1] if take == "together" and answer.together else None
    if row is None and take.isdecimal() and 1 <= int(take) <= len(rows):
        row = rows[int(take) - 1]
    if row is None:
        none = "" if answer.together else " (no changes together were found)"
        raise InputError(file, "--take", f"must be a row of the table, 1 to {len(rows)}, or together{none}; got {take}")
    changed = with_parameters(request.scene, row.values)
    save_changed(changed, output, file)
    if as_json:
        print_json({"file": typed_name(file), "output_file": str(output), "change": row.change})
        return
    lines = [f"wrote {output}: {row.change}"]
    if not request.given:  # they would apply to both files
        one_wood = main_material(request.scene.shaft).E == main_material(changed.shaft).E
        same = ["--same-shaft"] if one_wood else []
        asked = shlex.join(["cuefem", "compare", typed_name(file), str(output), *same])
        lines.append(f"before and after: {asked}")
    click.echo("\n".join(lines))


@analysis_command(has_stroke=False)
@click.option(
    "--near", metavar="HERTZ", type=float, help="Show the modes nearest this frequency instead of the lowest."
)
@click.option("--count", type=click.IntRange(min=1), default=6, show_default=True, help="Number of modes.")
def modes(request: Request, near: float | None, count: int) -> Analysis:
    """Compute natural frequencies of bending, with period and tip amplitude of each mode.

    Of a drawing as drawn, like `cf.modes`; --game, or an option of the tip, adds the game's leather tip and effects.
    """
    if near is not None:
        _check_near(request, near, "[0, inf)")
    return cf.natural_frequencies(request.scene, count, near=near)


def _check_near(request: Request, near: float, bounds: str) -> None:
    """InputError for a frequency out of bounds, in the option's name."""
    with as_input_error(request.file, "--near"):
        Quantity("Hz", bounds).read(f"{near!r} Hz")


@analysis_command("end-mass", cls=WithDefinitions)
@click.option(
    "--near",
    metavar="HERTZ",
    type=float,
    default=PAPER_TONE,
    show_default=True,
    help="Show the modes nearest this frequency.",
)
@click.option(
    "--cue-end",
    "cue_ends",
    metavar="MASS",
    multiple=True,
    help="Compare with a two-part cue of this m_c too, such as 15 g; may be repeated.",
)
def end_mass(request: Request, near: float, cue_ends: tuple[str, ...]) -> Analysis:
    """Compute the effective end mass: the transverse inertia of the cue at its tip, by five definitions.

    Below them: modes near 250 Hz, m_c and ε of Kim's two-part cue beside his guess of 12 g, and the squirt of each.
    """
    _check_near(request, near, "(0, inf)")
    wanted = cue_end_quantity(request.scene)
    with as_input_error(request.file, "--cue-end"):
        typed = {f"two-part, m_c {text}": wanted.read(text) for text in cue_ends}
    compared = {**PAPER_CUE_ENDS, **typed} if typed else None
    return cf.end_masses(request.scene, with_reduction=True, near=near, cue_ends=compared)


@analysis_command(formats=(".html", ".json", ""))
@click.argument("others", metavar="[FILE ...]", nargs=-1, type=CueFile())
@click.option(
    "--format",
    "target",
    type=click.Choice(["table"]),
    help="Export for games: a table over cue speed and offset, of each FILE; -o FILE.json, or FOLDER, writes it.",
)
@click.option(
    "--speeds",
    nargs=2,
    metavar="LOW HIGH",
    help="Lowest and highest cue speed of the table (default: 0.2 and 10 m/s).",
)
@calibration_option
def strike(
    request: Request,
    others: tuple[Path, ...],
    target: str | None,
    speeds: tuple[str, str] | None,
    output: Path | None,
    calibration: Calibration | None,
    as_json: bool,
) -> Analysis | None:
    """Compute squirt, ball speed, spin and pivot length of one stroke, by the coupled strike and by simpler models.

    The numerical error target is the rtol of the file's [accuracy] table, if it has one.
    """
    folder = output if output is not None and not output.suffix else None
    if target is None:
        for name, value in (("--speeds", speeds), ("--calibration", calibration), ("FILE ...", others or folder)):
            if value:
                raise InputError(request.file, name, "applies to --format table")
        return cf.strike_models(request.scene, load_accuracy(request.file))
    tables = _TableOptions(_speeds(request, speeds), calibration)
    if folder is not None:
        _write_tables(request, others, tables, folder, as_json=as_json)
        return None
    if others:
        raise InputError(request.file, "FILE ...", f"{len(others) + 1} tables need -o FOLDER")
    if output is None or output.suffix.lower() != ".json":
        request.hints.append("-o table.json writes the whole table, with units, signs and an example")
    return tables.of(request.scene)


class _TableOptions(NamedTuple):
    """Speeds and calibration of tables for games."""

    speeds: tuple[float, float]
    calibration: Calibration | None

    def of(self, scene: Scene) -> StrikeTable:
        """The table of a scene."""
        return cf.strike_table(scene, self.speeds, calibration=self.calibration, progress=with_progress_bar)


def _speeds(request: Request, texts: tuple[str, str] | None) -> tuple[float, float]:
    """The lowest and the highest speed of a table."""
    for name in ("speed", "offset"):
        if name in request.given:
            raise InputError(request.file, f"--{name}", "does not apply to --format table, which has all; use --speeds")
    if texts is None:
        return SPEEDS
    low, high = (option_value(request.file, "--speeds", text, Quantity("m/s", "(0, inf)")) for text in texts)
    return low, high


def _write_tables(
    request: Request, others: Sequence[Path], tables: _TableOptions, folder: Path, *, as_json: bool
) -> None:
    """Write the table of each file into a folder, as soon as it is made."""
    files = [request.file, *others]
    requests = [request, *(open_request(file, request.given) for file in others)]
    scenes = [each.scene for each in requests]  # all are read before the first table
    folder.mkdir(exist_ok=True)
    written = []
    for name, own, scene in zip(file_names(files), requests, scenes, strict=True):
        path = folder / f"{name}.json"
        with own.errors():
            made = tables.of(scene)
        about = {"file": typed_name(own.file)}
        Presentation(made, name, about, partial(getattr, own, "assumptions")).write(path)
        written.append({"file": typed_name(own.file), "output_file": str(path)})
        if not as_json:
            click.echo(f"wrote {path}: {made.headline()}")
    if as_json:
        print_json({"tables": written})


@analysis_command()
@click.option(
    "--max-modes",
    type=click.IntRange(min=24),
    default=150,
    show_default=True,
    help="Refine up to this many modes; at least three levels (12, 24 and 48 modes or more) run.",
)
def cost(request: Request, max_modes: int) -> Analysis:
    """Run a convergence study and recommend a resolution: error against run time and degrees of freedom."""
    return cf.convergence_study(request.scene, max_modes, progress=with_progress_bar)
