"""Commands on studies: sweep, scatter, optimize."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from itertools import count
from math import isfinite
from pathlib import Path
from typing import Any

import click
from rich.console import Console

from cuefem.cli.common import blaming, check_free, force_option, remark
from cuefem.cli.printing import assumed_lines, json_option, output_option, page_option, print_all, print_json, tell
from cuefem.cli.progress import bar
from cuefem.design import Pool, processes
from cuefem.design import dask as cluster
from cuefem.design import sweep as run
from cuefem.design.optimum import Problem, optimum
from cuefem.design.scatter import drivers
from cuefem.io import InputError, check_place, save, save_page, write_whole
from cuefem.io.store import Store, export_path, write_table
from cuefem.io.study_files import assumed_base, load_optimum, load_scatter, load_study
from cuefem.quantity.units import text
from cuefem.report.scatter_table import cause_sheet, scatter_record, scatter_sheets, scatter_words, spread_sheet
from cuefem.report.study_page import Scattered, study_page
from cuefem.report.study_table import (
    StudyTable,
    column_label,
    study_record,
    study_sheets,
    table_of_study,
    varied_lines,
    varied_pieces,
)
from cuefem.scene import Scene
from cuefem.vary import replaced, value_at


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
            so_far = f"{designs.count()} of {wanted.size} designs are kept in {designs.path}: the same command goes on"
            if isinstance(error, RuntimeError):
                raise RuntimeError(f"{error}; {so_far}") from None
            click.echo(f"cuefem: interrupted; {so_far}", err=True)
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
        varied = varied_pieces(store.study.vary, store.study.base)
        record: dict[str, Any] = {"database": str(store.path), "export": goal and str(goal), "designs": designs}
        record |= {"evaluated": store.computed, "failed": failed, "resolution": vars(store.study.resolution)}
        record |= {"first_failure": first and first[1], "summary": table and study_record(table)}
        print_json(record | {"page": output and str(output), "assumed": notes, "varied": varied})
        return
    words = [f"{designs} designs in {store.path}"]
    words += [f"{designs - store.computed} of them from before"] if designs > store.computed else []
    words += [f"exported to {goal}"] if goal else []
    words += [f"drawn on {output}"] if output else []
    click.echo(", ".join(words))
    if first:
        click.echo(f"{failed} failed, the first of them design {first[0]}: {first[1]}")
    print_all([*assumed_lines(notes), *varied_lines(store.study.vary, store.study.base)])
    if table is not None:
        print_all(["", *study_sheets(table)])


@click.command()
@click.argument("study", type=click.Path(path_type=Path))
@pool_options
@page_option
@json_option
def scatter(study: Path, output: Path | None, as_json: bool, **where: Any) -> None:
    """Show how much the responses of STUDY (.toml) scatter with wood, turning and stroke, and which cause matters most.

    STUDY is the study of a sweep with [sample]; it may have correlations and groups. Shares are Sobol indices.
    """
    wanted, sample = load_scatter(study)
    notes = assumed_base(study, wanted.study.base)
    remark(wanted.study.base)
    total = (len(wanted.causes) + 2) * sample.count
    with opened(**where) as pool, bar(total) as progress, blaming(study):
        progress.begin(0)
        drivers_of_spread = drivers(wanted, sample.count, seed=sample.seed, pool=pool, progress=progress)
    if output is not None:
        table = table_of_study(
            wanted.study,
            zip(count(), drivers_of_spread.spread.values, drivers_of_spread.spread.responses, strict=False),
        )
        assert table is not None
        facts = [f"{len(drivers_of_spread.spread.values)} designs, as wood, turning and strokes scatter"]
        scattered = Scattered(spread_sheet(wanted, drivers_of_spread), cause_sheet(wanted, drivers_of_spread))
        save_page(study_page(study.stem, table, facts, scattered=scattered), output)
    varied = varied_pieces(wanted.study.vary, wanted.study.base)
    about = {"file": str(study), "assumed": notes, "varied": varied, "count": sample.count, "seed": sample.seed}
    written = [f"wrote {output}"] if output else []
    lines = [
        *assumed_lines(notes),
        *varied_lines(wanted.study.vary, wanted.study.base),
        *scatter_sheets(wanted, drivers_of_spread),
        *scatter_words(wanted, drivers_of_spread),
        *written,
    ]
    tell(as_json, about | {"responses": scatter_record(wanted, drivers_of_spread)}, lines)


@click.command()
@click.argument("study", type=click.Path(path_type=Path))
@output_option(".html", ".toml", many=True)
@click.option(
    "--iterations", type=click.IntRange(min=1), default=60, show_default=True, help="Largest number of steps."
)
@click.option("--seed", type=click.IntRange(min=0), default=0, help="Random seed, used only without exact gradients.")
@json_option
@force_option
def optimize(study: Path, output: tuple[Path, ...], iterations: int, seed: int, as_json: bool, force: bool) -> None:
    """Find the design of STUDY (.toml) with the smallest or largest objective within its ranges and limits.

    STUDY has the [[vary]] tables of a sweep, an [objective] and [[limit]] tables. Where exact gradients exist (a bare
    cue, its dimensions and materials) it takes tens of evaluations, otherwise thousands.
    """
    wanted = load_optimum(study)
    notes = assumed_base(study, wanted.base)
    drawing, page = (next((path for path in output if path.suffix == kind), None) for kind in (".toml", ".html"))
    if drawing is not None:
        check_free(drawing, force=force)
    remark(wanted.base)
    with blaming(study), _counter() as progress:
        best = optimum(wanted, iterations=iterations, seed=seed, progress=progress)
    if drawing is not None:
        save(_rounded(best.scene, wanted), drawing)
    aim = "maximize" if wanted.largest else "minimize"
    units = dict(zip(wanted.study.columns, wanted.study.units, strict=True))
    way = "by exact gradients" if best.exact else "by differential evolution"
    labels = {response.name: response.label for response in wanted.study.responses}
    lines = [f"{aim} {wanted.objective.label}: {best.evaluations} evaluations {way}", ""]
    both = {**best.numbers, **best.values}
    words = {name: labels.get(name) or column_label(name) for name in both}
    width = max(map(len, words.values()))
    lines += [f"{words[name]:{width}}  {_short(value, units[name])}" for name, value in both.items()]
    limits = (limit.rsplit(" ", 2) for limit in best.active)
    held_by = [f"{words[name]} {sign} {_short(float(bound), units[name])}" for name, sign, bound in limits]
    lines += ["", f"held by: {', '.join(held_by) or 'nothing'}"]
    if best.unfinished:
        lines.append(f"not finished: {best.unfinished}; more --iterations may find a better design")
    varied = varied_pieces(wanted.vary, wanted.base)
    about = {"file": str(study), "assumed": notes, "varied": varied, "written": drawing and str(drawing)}
    numbers = {"value": best.value, "numbers": best.numbers, "values": best.values, "active": best.active}
    search = {"evaluations": best.evaluations, "exact_gradients": best.exact, "unfinished": best.unfinished}
    record = about | {"objective": {aim: wanted.objective.name}} | numbers | search
    pieces = varied_lines(wanted.vary, wanted.base)
    said = [*lines, "", *pieces, *assumed_lines(notes), *([f"wrote {drawing}"] if drawing else [])]
    tell(as_json, record | {"resolution": vars(wanted.study.resolution), "units": units}, said, page)


def _short(value: float, unit: str) -> str:
    """A number to six digits, in the unit in which scene files are written: "204.493 mm"."""
    return text(float(f"{value:.6g}"), unit) if unit else f"{value:.6g}"


def _rounded(scene: Scene, wanted: Problem) -> Scene:
    """The scene with the numbers that varied to nine digits, far within the tolerance of the limits."""
    moved = {path for vary in wanted.vary for path in (*vary.fields(scene), *vary.givers(scene))}
    return replaced(scene, {path: float(f"{value_at(scene, path):.9g}") for path in moved})


@contextmanager
def _counter() -> Iterator[Callable[[int, float], object]]:
    """The number of evaluations and the best value on stderr, if a person looks on."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda count, best: None
        return
    with console.status("computing") as status:
        yield lambda count, best: status.update(_progress(count, best))


def _progress(count: int, best: float) -> str:
    return f"{count} evaluations, " + (f"{best:.6g}" if isfinite(best) else "no design within the limits yet")
