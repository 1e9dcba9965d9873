"""The commands: from a cue's file to its modes, end mass and squirt."""

from __future__ import annotations

import os
import sys
import warnings
from contextlib import suppress
from typing import Any, NoReturn

import click

from cuefem.cli.designer import designer
from cuefem.cli.files import convert, materials, schema
from cuefem.cli.guide import guide
from cuefem.cli.handover import animate, handover
from cuefem.cli.measured import compare, estimate
from cuefem.cli.optimize import optimize
from cuefem.cli.scatter import scatter
from cuefem.cli.scene import cost, effects, end_mass, modes, report, strike
from cuefem.cli.side import side
from cuefem.cli.sweep import sweep
from cuefem.cli.tap import tap
from cuefem.cli.tip import tip
from cuefem.cli.validate import validate
from cuefem.cli.weigh import weigh
from cuefem.slips import Unusual

# Before NumPy is loaded: small dense matrices gain nothing from BLAS threads, and two of them on a busy machine can be
# a hundred times slower than one.
for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")


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
        except (ValueError, RuntimeError) as error:
            if isinstance(error, click.exceptions.Exit | click.exceptions.Abort):
                raise
            click.echo(f"cuefem: {' '.join(str(error).split())}", err=True)
            raise click.exceptions.Exit(2 if isinstance(error, ValueError) else 1) from None


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


def _version(ctx: click.Context, _: click.Parameter, asked: bool) -> None:
    if not asked or ctx.resilient_parsing:
        return
    from importlib.metadata import version

    from cuefem.contact.kernel import described

    click.echo(f"cuefem, version {version('cuefem')}\ncontact: {described()}")
    ctx.exit()


@click.group(cls=_OneLine, context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--version", is_flag=True, expose_value=False, is_eager=True, callback=_version, help="Show the version.")
def main() -> None:
    """From a cue shaft's drawing to its effective end mass and squirt.

    FILE is a cue or a scene (.toml), a lathe profile (.csv), a mesh (.vtk, .vtu) or a CAD surface (.stl, .ply, .obj).
    """


for _command in (
    modes,
    end_mass,
    strike,
    side,
    effects,
    cost,
    report,
    handover,
    animate,
    convert,
    schema,
    validate,
    materials,
    sweep,
    scatter,
    optimize,
    designer,
    tap,
    tip,
    compare,
    estimate,
    weigh,
    guide,
):
    main.add_command(_command)
