"""`cuefem study`: a sweep, a tolerance analysis (scatter) or an optimum."""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import nullcontext
from functools import partial
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

import cuefem as cf
from cuefem.cli.cluster import dask_executor
from cuefem.cli.output import command, json_option, output_option, print_json
from cuefem.cli.pending_warnings import print_pending_warnings
from cuefem.cli.progress import ProgressLines, progress_bar
from cuefem.cli.request import errors_name_file, print_warnings
from cuefem.cli.scene_command import Presentation, calibration_option, check_overwrite, force_option
from cuefem.designs.design_table import check_parquet
from cuefem.designs.many_designs import compute_designs
from cuefem.designs.optimum import Problem, Round
from cuefem.designs.store import SqliteStore
from cuefem.designs.study_file import base_assumptions, load_study, study_kind
from cuefem.designs.study_result import StudyResult
from cuefem.files import InputError
from cuefem.quantity.display import counted
from cuefem.quantity.display_units import with_unit
from cuefem.quantity.fields import quote
from cuefem.results.plausibility import plausibility_warnings

if TYPE_CHECKING:
    from cuefem.measurements.calibration import Calibration

Computed = TypeVar("Computed")


def read_part(context: click.Context, option: click.Parameter, text: str | None) -> slice | None:
    """The designs of part "K/N" of a study: every N-th from the K-th on, so that all parts take the same time."""
    if text is None:
        return None
    match = re.fullmatch(r"(\d{1,9})/(\d{1,9})", text)
    number, count = map(int, match.groups()) if match else (0, 0)
    if not 1 <= number <= count:
        raise click.BadParameter(f"must be K/N with 1 <= K <= N, such as 3/10; got {quote(text)}")
    return slice(number - 1, None, count)


@command()
@click.argument("file", metavar="STUDY", type=click.Path(path_type=Path))
@click.option(
    "--store",
    "stores",
    type=click.Path(path_type=Path),
    metavar="FILE",
    multiple=True,
    help="File of stored designs (default: STUDY.sqlite). Repeated: new designs go to the first, the others are read.",
)
@click.option(
    "--workers", type=click.IntRange(min=1), help="Number of worker processes (default: none, all in this one)."
)
@click.option("--scheduler", metavar="ADDRESS", help='Dask scheduler whose workers compute, such as "tcp://host:8786".')
@click.option("--part", metavar="K/N", callback=read_part, help="Compute and store only the K-th of N parts.")
@click.option(
    "--iterations",
    type=click.IntRange(min=1),
    default=60,
    show_default=True,
    help="Largest number of rounds of an optimum.",
)
@click.option("--front", is_flag=True, help="Write only the designs of the Pareto front into a table.")
@calibration_option
@output_option(".html", ".csv", ".parquet", ".json", ".toml", many=True)
@force_option
@json_option
def study(
    file: Path,
    output: tuple[Path, ...],
    force: bool,
    as_json: bool,
    iterations: int,
    stores: tuple[Path, ...],
    workers: int | None,
    scheduler: str | None,
    part: slice | None,
    front: bool,
    calibration: Calibration | None,
) -> None:
    """Compute the designs of STUDY (.toml), which lists parameters and responses (`cuefem guide study` has the format).

    With [objective]: an optimum, the best design within ranges and limits. With [tolerances]: a tolerance analysis
    (scatter), the spread of each response and the contribution of each parameter (Sobol indices). Otherwise: a sweep,
    the best designs, the main parameter of each response, and the trade-offs.

    Sweeps and tolerance analyses store their designs in a SQLite file. An interrupted run resumes with the same
    command; an edited study computes only its new designs. --workers computes in processes of this machine, --scheduler
    on a Dask cluster. -o FILE.toml writes the best design (of a sweep: by its first response).
    """
    kind = study_kind(file)
    if kind == "optimum" and (stores or workers or scheduler or part):
        raise click.UsageError(
            "--store, --workers, --scheduler and --part do not apply to an optimum, which runs in one process"
        )
    if part and output:
        raise click.UsageError("--output needs all designs, and --part computes some of them")
    if workers and scheduler:
        raise click.UsageError("--workers (of this machine) and --scheduler (of a cluster) cannot be combined")
    for path in output:
        if path.suffix.lower() == ".toml":
            if kind == "scatter":
                raise InputError(
                    path,
                    "--output",
                    "must end in .html, .csv, .parquet or .json: a tolerance analysis has no best design",
                )
            check_overwrite(path, force=force)
        if path.suffix.lower() == ".parquet":
            check_parquet()
    plan = load_study(file)
    basis = []
    if calibration is not None:
        with errors_name_file(file):
            found = calibration.squirt(plan.study.base)
        plan = plan.calibrated(found.factor)
        basis = [found.origin(), *found.warning_lines()]
    designs = plan.all_designs
    print_warnings(designs.base)
    print_pending_warnings()
    result: StudyResult
    database = None
    if isinstance(plan, Problem):
        with errors_name_file(file), progress_bar() as bar:
            task = bar.add_task("first round", total=iterations)

            def show_round(reached: Round) -> None:
                bar.update(task, completed=reached.number, description=round_text(plan, reached, iterations))

            result = cf.study(plan, rounds=iterations, progress=show_round)
    else:
        name = f".{part.start + 1}_of_{part.step}.sqlite" if part else ".sqlite"
        first, *others = stores or [file.with_suffix(name)]
        database = SqliteStore(first, designs, others)
        with dask_executor(scheduler) if scheduler else nullcontext(workers) as where:
            if part:
                compute_part = partial(compute_designs, designs, database, workers=where, part=part)
                _run_stored(file, database, len(range(designs.size)[part]), compute_part)
                if as_json:
                    print_json({"file": str(file), "store": str(first), "designs": database.done})
                else:
                    click.echo(f"{database.done} of {counted(designs.size, 'design')} in {first}")
                return
            run = partial(cf.study, plan, store=database, workers=where)
            result = _run_stored(file, database, designs.size, run)
    files: dict[str, Any] = {"file": str(file)}
    stored = []
    if database:
        files |= {"store": str(database.path), "evaluated": database.computed}
        before = database.done - database.computed
        more = f", {before} of them from before" if before else ""
        stored.append(f"{counted(database.done, 'design')} in {database.path}{more}")
    hints = [*basis, *stored, *(f"wrote {path}" for path in output)]
    shown = Presentation(
        result,
        file.name,
        files,
        lambda: base_assumptions(file, designs.base),
        lambda: plausibility_warnings(designs.base),
        hints,
    )
    for path in output:
        if path.suffix.lower() in (".html", ".json"):
            shown.write(path)
        else:
            result.save(path, front=front)
    shown.show(None, as_json=as_json)


def _run_stored(file: Path, designs: SqliteStore, count: int, run: Callable[..., Computed]) -> Computed:
    """The result of ``run`` for so many designs; an interrupted one prints which designs are stored."""
    with progress_bar() as bar, designs:
        task, lines = bar.add_task("designs", total=count), ProgressLines(count)

        def show(added: int) -> None:
            bar.update(task, advance=added)
            lines.add(added)

        try:
            with errors_name_file(file):
                return run(progress=show)
        except (KeyboardInterrupt, RuntimeError) as error:
            bar.stop()
            message = f"{designs.done} of {counted(count, 'design')} are stored in {designs.path}"
            if isinstance(error, RuntimeError):
                raise RuntimeError(f"{error}; {message}; run the same command to resume") from None
            click.echo(f"cuefem: interrupted; {message}; run the same command to resume", err=True)
            raise click.exceptions.Exit(130) from None


def round_text(problem: Problem, reached: Round, most: int) -> str:
    """A round of a search: "round 3 of at most 60, 45 designs, squirt slope 0.0412346 so far"."""
    choice = "".join(f"{value if isinstance(value, str) else f'{value:g}'}: " for value in reached.choice.values())
    best = f"{reached.objective.label} {with_unit(reached.best, reached.objective.display_key, 6)} so far"
    best = best if isfinite(reached.best) else "no design within the limits yet"
    return f"{choice}round {reached.number} of at most {most}, {counted(reached.evaluations, 'design')}, {best}"
