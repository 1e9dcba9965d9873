"""The table of commands, each loaded when called, and one-line errors."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

import click
from click.shell_completion import CompletionItem

from cuefem.analysis import asked_questions
from cuefem.cli.pending_warnings import print_pending_warnings, warn
from cuefem.contact.kernel import KernelError
from cuefem.quantity.display import one_line
from cuefem.quantity.encoding import spell_lacking_characters
from cuefem.quantity.unit_checks import FLOAT_ERRORS, DrawingWarning, PlausibilityWarning

# Before NumPy is loaded: small dense matrices gain nothing from BLAS threads, and two of them on a busy machine can be
# a hundred times slower than one.
for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

# Every command with options of its own, by its name: its file and function, its group, and its line in `cuefem --help`.
CUE, VERIFICATION, STUDIES, FILES, PAGE = "Cue", "Verification", "Studies", "Files and parts", "Designer"
COMMANDS = {
    "report": ("cuefem.cli.cue_commands:report", CUE, "Squirt with its uncertainty, and all other numbers of a cue."),
    "improve": ("cuefem.cli.cue_commands:improve", CUE, "Design changes, each with its squirt, stiffness and mass."),
    "modes": ("cuefem.cli.cue_commands:modes", CUE, "Natural frequencies of bending, and tip amplitudes."),
    "end-mass": ("cuefem.cli.cue_commands:end_mass", CUE, "Effective end mass, by five definitions."),
    "strike": (
        "cuefem.cli.cue_commands:strike",
        CUE,
        "Squirt, ball speed, spin and pivot length of one stroke; tables for games.",
    ),
    "compare": ("cuefem.cli.compare_command:compare", CUE, "Compare cues, or computed and measured values."),
    "cost": ("cuefem.cli.cue_commands:cost", VERIFICATION, "Convergence study, and the resolution it recommends."),
    "study": (
        "cuefem.cli.study_command:study",
        STUDIES,
        "Sweep, tolerance analysis or optimum of a STUDY (.toml).",
    ),
    "parts": ("cuefem.cli.file_commands:parts", FILES, "Catalogue of shafts, materials and tips, with sources."),
    "convert": ("cuefem.cli.file_commands:convert", FILES, "Convert a drawing to .toml or .vtu."),
    "guide": ("cuefem.cli.guide_command:guide", FILES, "Handbook: pages for makers, physics, glossary."),
    "designer": (
        "cuefem.cli.designer_command:designer",
        PAGE,
        "Browser page with sliders: squirt updates as they move.",
    ),
}


def listed_commands() -> dict[str, tuple[str, str]]:
    """Group and line in `cuefem --help` of every command: those of `COMMANDS` and of registered questions."""
    own = {name: (group, words) for name, (_, group, words) in COMMANDS.items()}
    asked = {name: (question.group, question.help) for name, question in asked_questions().items()}
    together = own | asked
    groups = [group for group, _ in together.values()]
    return dict(sorted(together.items(), key=lambda item: groups.index(item[1][0])))


class _Commands(click.Group):
    """The listed commands: a command's file is loaded when the command is called, not for a list of them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """All names, in the order of their groups."""
        return list(listed_commands())

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Load the command of that name, or None."""
        asked = asked_questions()
        if name in asked:
            make: Callable[..., click.Command] = import_module("cuefem.cli.scene_command").question_command
            return make(name, asked[name])
        if name not in COMMANDS:
            return None
        module, _, attribute = COMMANDS[name][0].partition(":")
        command: click.Command = getattr(import_module(module), attribute)
        return command

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        """The called command; for an unknown one an error with the nearest name."""
        listed = listed_commands()
        near = get_close_matches(args[0], listed, 1) if args[0] not in listed and args[0][0] != "-" else []
        if near:
            ctx.fail(f"No such command {args[0]!r}; did you mean {near[0]!r}?")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the table, a group under each heading."""
        listed = listed_commands()
        width = max(map(len, listed))
        for group in dict.fromkeys(group for group, _ in listed.values()):
            with formatter.section(group):
                formatter.write_dl([(f"{n:{width}}", words) for n, (g, words) in listed.items() if g == group])

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """The commands with that prefix, then click's completion."""
        listed = listed_commands()
        names = [name for name in listed if name.startswith(incomplete)]
        options = click.Command.shell_complete(self, ctx, incomplete)
        return [*(CompletionItem(name, help=listed[name][1]) for name in names), *options]


class _OneLine(_Commands):
    """Invalid input: a one-line error on stderr, status 2; a numerical failure: one line, status 1; no tracebacks."""

    def main(self, *arguments: Any, **options: Any) -> Any:
        spell_lacking_characters()
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
            _exit_with_usage_error(error)

    def invoke(self, ctx: click.Context) -> Any:
        import numpy as np  # not for --help

        try:
            with np.errstate(**FLOAT_ERRORS), warnings.catch_warnings():
                # commands print their own warnings of a scene; those of a drawing's file are known where it is read
                warnings.filterwarnings("ignore", category=PlausibilityWarning)
                warnings.filterwarnings("always", category=DrawingWarning)
                warnings.showwarning = _print_warning
                result = super().invoke(ctx)
            print_pending_warnings()
            return result
        except click.exceptions.Exit:
            print_pending_warnings()
            raise
        except click.UsageError as error:
            _exit_with_usage_error(error)
        except (ArithmeticError, MemoryError) as error:
            what = "numerical overflow: check the units of sizes, masses and times"
            if isinstance(error, MemoryError):
                what = "out of memory: request less, or check the units of sizes, masses and times"
            click.echo(f"cuefem: {what} ({type(error).__name__})", err=True)
            raise click.exceptions.Exit(2) from None
        except (ValueError, RuntimeError, KernelError) as error:
            if isinstance(error, click.exceptions.Abort):
                raise
            click.echo(f"cuefem: {_error_text(error)}", err=True)
            raise click.exceptions.Exit(2 if isinstance(error, ValueError | KernelError) else 1) from None


def _error_text(error: Exception) -> str:
    """An error in one line; a cue that was given by its name keeps it."""
    file = getattr(error, "file", None)
    if file is None:
        return one_line(str(error))
    from cuefem.files.cue_names import cue_name  # not for --help

    name = cue_name(Path(file))
    return str(error).replace(file, name, 1) if name else str(error)  # an InputError is one line already


def _print_warning(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
    """Print a warning as one line on stderr, as commands do."""
    warn(one_line(str(message)))


def _exit_with_usage_error(error: click.UsageError) -> NoReturn:
    """Print a one-line usage error with the help command; a request for help passes."""
    if type(error).__name__ == "NoArgsIsHelpError":
        raise error
    text = one_line(error.format_message()).rstrip(".")
    listed = "commands" if text.startswith("No such command") else "options"
    hint = "" if error.ctx is None else f" (`{error.ctx.command_path} --help` lists the {listed})"
    click.echo(f"cuefem: {text}{hint}", err=True)
    sys.exit(2)


def _forget_output() -> None:
    """Discard pending stdout, so that Python does not fail on it again at exit."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())


@click.group(cls=_OneLine, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="cuefem", prog_name="cuefem", help="Show the version.")
def main() -> None:
    """Compute natural frequencies, effective end mass and squirt of a billiard cue from its drawing.

    FILE is a cue or a scene (.toml), a lathe profile (.csv), a CAD surface (.stl, .ply, .obj), or a cue's name, such as
    "plain maple" (`cuefem parts` lists the names).
    """
