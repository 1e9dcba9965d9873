"""The commands: one table of them, each loaded when it is called, and one-line errors."""

from __future__ import annotations

import os
import sys
import warnings
from contextlib import suppress
from importlib import import_module
from typing import Any, NoReturn

import click
from click.shell_completion import CompletionItem

from cuefem.contact.kernel import KernelError
from cuefem.quantity.slips import Unusual

# Before NumPy is loaded: small dense matrices gain nothing from BLAS threads, and two of them on a busy machine can be
# a hundred times slower than one.
for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

# Every command by its name: the file and function that it is, and what `cuefem --help` says of it.
COMMANDS = {
    "check": ("cuefem.cli.how_sure:check", "How far beam theory is off for a shaft: beam beside solid."),
    "compare": ("cuefem.cli.measured:compare", "A documented cue: measured and computed, side by side."),
    "convert": ("cuefem.cli.files:convert", "Convert FILE to .toml, .vtk or .vtu."),
    "cost": ("cuefem.cli.how_sure:cost", "What accuracy costs, and which resolution to take."),
    "designer": ("cuefem.cli.designer:designer", "Change a cue with sliders on a page and see the effect."),
    "effects": ("cuefem.cli.how_sure:effects", "What each effect changes, left out or added."),
    "end-mass": ("cuefem.cli.cues:end_mass", "The effective end mass, by every definition."),
    "estimate": ("cuefem.cli.measured:estimate", "Wood, bore and tip from everything measured on a cue together."),
    "guide": ("cuefem.cli.guide:guide", "Open the handbook: physics, glossary, and every effect."),
    "improve": ("cuefem.cli.improve:improve", "What to change: squirt, stiffness and weight of each change."),
    "modes": ("cuefem.cli.tones:modes", "How the cue rings: its bending frequencies."),
    "optimize": ("cuefem.cli.studies:optimize", "Find the best design of a STUDY (.toml) within its limits."),
    "parts": ("cuefem.cli.files:parts", "Shafts, materials and tips by name."),
    "report": ("cuefem.cli.reporting:report", "Everything about a cue, as tables or as a page."),
    "scatter": ("cuefem.cli.studies:scatter", "How much a design's numbers scatter, and why."),
    "strike": ("cuefem.cli.cues:strike", "One stroke: squirt, speed, spin and pivot length."),
    "sweep": ("cuefem.cli.studies:sweep", "Compute every design of a STUDY (.toml)."),
}


class _Commands(click.Group):
    """The commands of `COMMANDS`: a command's file is loaded when the command is called, not for a list of them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """All names, in the order of the alphabet."""
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """The command of that name, its file loaded; None if there is none."""
        if name not in COMMANDS:
            return None
        module, _, attribute = COMMANDS[name][0].partition(":")
        command: click.Command = getattr(import_module(module), attribute)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the table."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, COMMANDS[name][1]) for name in self.list_commands(ctx)])

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """The commands that begin so, and then as for every command."""
        names = [name for name in self.list_commands(ctx) if name.startswith(incomplete)]
        options = click.Command.shell_complete(self, ctx, incomplete)
        return [*(CompletionItem(name, help=COMMANDS[name][1]) for name in names), *options]


class _OneLine(_Commands):
    """Bad input ends in one line on stderr and status 2, a numerical failure in one and status 1; no tracebacks."""

    def main(self, *arguments: Any, **options: Any) -> Any:
        try:
            return super().main(*arguments, **options)
        except OSError as error:  # what could not be printed, onto a full disk for one; click ends broken pipes itself
            _forget_output()
            with suppress(OSError):
                click.echo(f"cuefem: {error.filename or 'cannot write'}: {error.strerror or error}", err=True)
            sys.exit(1)

    def make_context(self, *arguments: Any, **options: Any) -> click.Context:
        try:
            return super().make_context(*arguments, **options)
        except click.UsageError as error:
            _refuse_usage(error)

    def invoke(self, ctx: click.Context) -> Any:
        import numpy as np  # not for --help

        try:
            with np.errstate(over="raise", divide="raise", invalid="raise"), warnings.catch_warnings():
                warnings.filterwarnings("ignore", category=Unusual)  # commands say it in their own words: `remark`
                return super().invoke(ctx)
        except click.UsageError as error:
            _refuse_usage(error)
        except (ArithmeticError, MemoryError) as error:
            what = "sizes, masses or times are out of all proportion, so that numbers overflow"
            if isinstance(error, MemoryError):
                what = "this needs more memory than there is: ask for less, or check sizes, masses and times"
            click.echo(f"cuefem: {what} ({type(error).__name__})", err=True)
            raise click.exceptions.Exit(2) from None
        except (ValueError, RuntimeError, KernelError) as error:
            if isinstance(error, click.exceptions.Exit | click.exceptions.Abort):
                raise
            click.echo(f"cuefem: {' '.join(str(error).split())}", err=True)
            raise click.exceptions.Exit(2 if isinstance(error, ValueError | KernelError) else 1) from None


def _refuse_usage(error: click.UsageError) -> NoReturn:
    """Say in one line what is wrong with a command line, and where its help is; help that was asked for passes."""
    if type(error).__name__ == "NoArgsIsHelpError":
        raise error
    words = " ".join(error.format_message().split()).rstrip(".")
    more = "" if error.ctx is None else f" (`{error.ctx.command_path} --help` lists the options)"
    click.echo(f"cuefem: {words}{more}", err=True)
    sys.exit(2)


def _forget_output() -> None:
    """Let what is left for stdout go nowhere, so that Python does not fail on it once more when it ends."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())


@click.group(cls=_OneLine, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="cuefem", prog_name="cuefem", help="Show the version.")
def main() -> None:
    """From a cue shaft's drawing to its effective end mass and squirt.

    FILE is a cue or a scene (.toml), a lathe profile (.csv), a mesh (.vtk, .vtu) or a CAD surface (.stl, .ply, .obj).
    """
