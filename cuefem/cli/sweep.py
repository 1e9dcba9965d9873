"""`cuefem sweep`: a study's table, in one go or in several."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cuefem.cli.common import remark

if TYPE_CHECKING:
    from cuefem.design import Pool, Row
    from cuefem.io.database import Database


@click.command(short_help="Compute every design of a STUDY (.toml).")
@click.argument("study", type=click.Path(path_type=Path))
@click.option("--output", type=click.Path(path_type=Path), help="The database; by default STUDY.sqlite.")
@click.option("--workers", type=click.IntRange(min=1), help="Number of worker processes; by default none is started.")
@click.option("--dask", metavar="ADDRESS", help='A Dask scheduler to work on, e.g. "tcp://host:8786".')
@click.option("--export", type=click.Path(path_type=Path), help="Also write the table as .csv or .parquet.")
@click.option("--json", "as_json", is_flag=True, help="Say as JSON what was done.")
def sweep(study: Path, output: Path | None, export: Path | None, as_json: bool, **where: Any) -> None:
    """Compute every design of STUDY (.toml) and store the results in an SQLite database.

    If it is interrupted, even by kill -9, the same command goes on where it stopped. Numbers are SI.
    """
    from cuefem.design import sweep as run
    from cuefem.io import check_place
    from cuefem.io.database import Database, export_path
    from cuefem.io.study import load_study

    wanted = load_study(study)
    goal = None if export is None else export_path(export)
    if goal is not None:
        check_place(goal)
    remark(wanted.base)
    with ExitStack() as open_things:
        pool = open_things.enter_context(opened(**where))
        database = open_things.enter_context(Database(output or study.with_suffix(".sqlite"), wanted))
        before = database.held()
        for first, what in database.damaged.items():
            again = f"{first} to {min(first + wanted.block, wanted.size) - 1}"
            click.echo(f"damaged: {database.path}: {what}; designs {again} are computed again", err=True)
        with bar(wanted.size, before) as progress:
            run(wanted, database, pool=pool, progress=progress)
        if goal is not None:
            _export(database, goal)
        _tell(database, before, goal, as_json)


@contextmanager
def opened(workers: int | None, dask: str | None) -> Iterator[Pool | None]:
    """The processes or the cluster to work on; None for this process."""
    from cuefem.design import dask as cluster
    from cuefem.design import processes

    if workers and dask:
        raise click.UsageError("--workers is for this machine, --dask for a cluster: give one")
    if dask:
        with cluster(dask) as pool:
            yield pool
    else:
        yield processes(workers) if workers else None


@contextmanager
def bar(total: int, done: int) -> Iterator[Callable[[list[Row]], object]]:
    """A progress bar with rate and time left, if stderr is a terminal."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda rows: None
        return
    columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[rate]}"), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=total, completed=done, rate="")

        def progress(rows: list[Row]) -> None:
            speed = bar.tasks[0].speed
            bar.update(task, advance=len(rows), rate=f"{speed:.3g} designs/s" if speed else "")

        yield progress


def _export(database: Database, goal: Path) -> None:
    from cuefem.io import write_whole
    from cuefem.io.database import write_csv, write_parquet

    write = write_csv if goal.suffix == ".csv" else write_parquet
    write_whole(goal, lambda temporary: write(database, temporary))


def _tell(database: Database, before: int, goal: Path | None, as_json: bool) -> None:
    designs, failed = database.count()
    first = database.first_failure()
    if as_json:
        found: dict[str, Any] = {"database": str(database.path), "export": goal and str(goal), "designs": designs}
        found |= {"evaluated": designs - before, "failed": failed, "resolution": vars(database.study.resolution)}
        click.echo(json.dumps(found | {"first_failure": first and first[1]}, indent=2))
        return
    words = [f"{designs} designs in {database.path}"]
    words += [f"{before} of them from before"] if before else []
    words += [f"exported to {goal}"] if goal else []
    click.echo(", ".join(words))
    if first:
        click.echo(f"{failed} failed, the first of them design {first[0]}: {first[1]}")
