"""`cuefem sweep`: a study's table, in one go or in several."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import remark
from cuefem.cli.printing import assumed_lines, print_all, print_json
from cuefem.cli.progress import bar
from cuefem.design import Pool, processes
from cuefem.design import dask as cluster
from cuefem.design import sweep as run
from cuefem.io import InputError, check_place, save_page, write_whole
from cuefem.io.database import Database, export_path, write_csv, write_parquet
from cuefem.io.study import assumed_base, load_study
from cuefem.report.study import Table, study_record, study_tables, table_of_study
from cuefem.report.study_page import study_page


@click.command()
@click.argument("study", type=click.Path(path_type=Path))
@click.option("--output", type=click.Path(path_type=Path), help="The database; by default STUDY.sqlite.")
@click.option("--workers", type=click.IntRange(min=1), help="Number of worker processes; by default none is started.")
@click.option("--dask", metavar="ADDRESS", help='A Dask scheduler to work on, e.g. "tcp://host:8786".')
@click.option("--export", type=click.Path(path_type=Path), help="Also write the table as .csv or .parquet.")
@click.option(
    "-o", "--page", type=click.Path(path_type=Path), metavar="PAGE.html", help="Also draw the designs on a page."
)
@click.option("--json", "as_json", is_flag=True, help="Say as JSON what was done, with the summary.")
def sweep(
    study: Path, output: Path | None, export: Path | None, page: Path | None, as_json: bool, **where: Any
) -> None:
    """Compute every design of STUDY (.toml), store the results in an SQLite database, and sum them up.

    The summary names the best designs, what drives each result, and where two results trade off. If it is
    interrupted, even by kill -9, the same command goes on where it stopped. Numbers are SI.
    """
    wanted = load_study(study)
    notes = assumed_base(study, wanted.base)
    goal = None if export is None else export_path(export)
    if goal is not None:
        check_place(goal)
    check_page(page)
    remark(wanted.base)
    with ExitStack() as open_things:
        progress = open_things.enter_context(bar(wanted.size))
        pool = open_things.enter_context(opened(**where))
        database = open_things.enter_context(Database(output or study.with_suffix(".sqlite"), wanted))
        before = database.held()
        progress.begin(before)
        for first, what in database.damaged.items():
            again = f"{first} to {min(first + wanted.block, wanted.size) - 1}"
            click.echo(f"damaged: {database.path}: {what}; designs {again} are computed again", err=True)
        run(wanted, database, pool=pool, progress=progress)
        progress.end()
        if goal is not None:
            _export(database, goal)
        count = len(wanted.vary)
        rows = ((design, row[:count], row[count:-1]) for design, *row in database.rows())
        _tell(database, before, goal, as_json, table_of_study(wanted, rows), page, notes)


def check_page(page: Path | None) -> None:
    """Refuse, before anything is computed, a page that cannot be written."""
    if page is not None:
        if page.suffix != ".html":
            raise InputError(page, "--page", f"must end in .html; got {page.suffix!r}")
        check_place(page)


@contextmanager
def opened(workers: int | None, dask: str | None) -> Iterator[Pool | None]:
    """The processes or the cluster to work on; None for this process."""
    if workers and dask:
        raise click.UsageError("--workers is for this machine, --dask for a cluster: give one")
    if dask:
        with cluster(dask) as pool:
            yield pool
    else:
        yield processes(workers) if workers else None


def _export(database: Database, goal: Path) -> None:
    write = write_csv if goal.suffix == ".csv" else write_parquet
    write_whole(goal, lambda temporary: write(database, temporary))


def _tell(
    database: Database,
    before: int,
    goal: Path | None,
    as_json: bool,
    table: Table | None,
    page: Path | None,
    notes: Sequence[str],
) -> None:
    designs, failed = database.count()
    first = database.first_failure()
    if page is not None:
        if table is None:
            raise InputError(page, "--page", "needs at least two designs with an answer; got fewer")

        facts = [f"{designs} designs of {database.path.name}" + (f", {failed} without an answer" if failed else "")]
        save_page(study_page(database.path.stem, table, facts), page)
    if as_json:
        found: dict[str, Any] = {"database": str(database.path), "export": goal and str(goal), "designs": designs}
        found |= {"evaluated": designs - before, "failed": failed, "resolution": vars(database.study.resolution)}
        found |= {"first_failure": first and first[1], "summary": table and study_record(table)}
        print_json(found | {"page": page and str(page), "assumed": notes})
        return
    words = [f"{designs} designs in {database.path}"]
    words += [f"{before} of them from before"] if before else []
    words += [f"exported to {goal}"] if goal else []
    words += [f"drawn on {page}"] if page else []
    click.echo(", ".join(words))
    if first:
        click.echo(f"{failed} failed, the first of them design {first[0]}: {first[1]}")
    print_all(assumed_lines(notes))
    if table is not None:
        print_all(["", *study_tables(table)])
