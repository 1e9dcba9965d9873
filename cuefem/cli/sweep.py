"""`cuefem sweep`: a study's table, in one go or in several."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import remark
from cuefem.cli.printing import assumed_lines, json_option, page_option, print_all, print_json
from cuefem.cli.progress import bar
from cuefem.design import Pool, processes
from cuefem.design import dask as cluster
from cuefem.design import sweep as run
from cuefem.io import InputError, check_place, save_page, write_whole
from cuefem.io.store import Store, export_path, write_table
from cuefem.io.study_files import assumed_base, load_study
from cuefem.report.study_page import study_page
from cuefem.report.study_table import StudyTable, study_record, study_sheets, table_of_study


def pool_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Processes or a cluster to work on."""
    workers = "Number of worker processes; by default none is started."
    dask = click.option("--dask", metavar="ADDRESS", help='A Dask scheduler to work on, e.g. "tcp://host:8786".')
    return click.option("--workers", type=click.IntRange(min=1), help=workers)(dask(command))


@click.command()
@click.argument("study", type=click.Path(path_type=Path))
@click.option(
    "--store", type=click.Path(path_type=Path), metavar="FILE", help="Where designs are kept; by default STUDY.sqlite."
)
@pool_options
@click.option("--export", type=click.Path(path_type=Path), help="Also write the table as .csv or .parquet.")
@page_option
@json_option
def sweep(
    study: Path, store: Path | None, export: Path | None, output: Path | None, as_json: bool, **where: Any
) -> None:
    """Compute every design of STUDY (.toml), keep the results in a file (SQLite), and sum them up.

    The summary names the best designs, what drives each result, and where two results trade off. If it is
    interrupted, even by kill -9, the same command goes on where it stopped; if the study was changed, it computes only
    what is new. Several sweeps may share a file and its work. Numbers are SI.
    """
    wanted = load_study(study)
    notes = assumed_base(study, wanted.base)
    goal = None if export is None else export_path(export)
    if goal is not None:
        check_place(goal)
    remark(wanted.base)
    with ExitStack() as open_things:
        progress = open_things.enter_context(bar(wanted.size))
        pool = open_things.enter_context(opened(**where))
        designs = open_things.enter_context(Store(store or study.with_suffix(".sqlite"), wanted, study.stem))
        for line in designs.changes:
            click.echo(f"{designs.path}: {line}", err=True)
        progress.begin(0)
        try:
            run(wanted, designs, pool=pool, progress=lambda rows: progress.to(designs.done))
        except (KeyboardInterrupt, RuntimeError) as error:
            progress.end()
            kept = f"{designs.count()} of {wanted.size} designs are kept in {designs.path}: the same command goes on"
            if isinstance(error, RuntimeError):
                raise RuntimeError(f"{error}; {kept}") from None
            click.echo(f"cuefem: interrupted; {kept}", err=True)
            raise click.exceptions.Exit(130) from None
        progress.end()
        for line in designs.damaged:
            click.echo(f"damaged: {designs.path}: {line}", err=True)
        if goal is not None:
            write_whole(goal, lambda temporary: write_table(designs, temporary))
        count, failures = len(wanted.vary), list[tuple[int, str]]()

        def rows() -> Iterator[tuple[int, Any, Any]]:
            for design, *row, failure in designs.rows():
                if failure:
                    failures.append((design, failure))
                yield design, row[:count], row[count:]

        table = table_of_study(wanted, rows())
        _tell(designs, failures, goal, as_json, table, output, notes)


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


def _tell(
    store: Store,
    failures: Sequence[tuple[int, str]],
    goal: Path | None,
    as_json: bool,
    table: StudyTable | None,
    output: Path | None,
    notes: Sequence[str],
) -> None:
    designs, failed, first = store.count(), len(failures), failures[0] if failures else None
    if output is not None:
        if table is None:
            raise InputError(output, "--output", "needs at least two designs with an answer; got fewer")

        facts = [f"{designs} designs of {store.path.name}" + (f", {failed} without an answer" if failed else "")]
        save_page(study_page(store.path.stem, table, facts), output)
    if as_json:
        found: dict[str, Any] = {"database": str(store.path), "export": goal and str(goal), "designs": designs}
        found |= {"evaluated": store.computed, "failed": failed, "resolution": vars(store.study.resolution)}
        found |= {"first_failure": first and first[1], "summary": table and study_record(table)}
        print_json(found | {"page": output and str(output), "assumed": notes})
        return
    words = [f"{designs} designs in {store.path}"]
    words += [f"{designs - store.computed} of them from before"] if designs > store.computed else []
    words += [f"exported to {goal}"] if goal else []
    words += [f"drawn on {output}"] if output else []
    click.echo(", ".join(words))
    if first:
        click.echo(f"{failed} failed, the first of them design {first[0]}: {first[1]}")
    print_all(assumed_lines(notes))
    if table is not None:
        print_all(["", *study_sheets(table)])
