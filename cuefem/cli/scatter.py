"""`cuefem scatter`: how much a design's numbers scatter, and what drives them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import blaming, print_all, print_json, remark
from cuefem.cli.sweep import bar, opened


@click.command(short_help="How much a design's numbers scatter, and why.")
@click.argument("study", type=click.Path(path_type=Path))
@click.option("--workers", type=click.IntRange(min=1), help="Number of worker processes; by default none is started.")
@click.option("--dask", metavar="ADDRESS", help='A Dask scheduler to work on, e.g. "tcp://host:8786".')
@click.option("--json", "as_json", is_flag=True, help="SI numbers as JSON.")
def scatter(study: Path, as_json: bool, **where: Any) -> None:
    """Show how much the responses of STUDY (.toml) scatter with wood, turning and stroke, and which cause matters most.

    STUDY is the study of a sweep with [sample]; it may have correlations and groups. Shares are Sobol indices.
    """
    from cuefem.design.scatter import drivers
    from cuefem.io.study import load_scatter
    from cuefem.report.scatter import scatter_record, scatter_tables

    wanted, sample = load_scatter(study)
    remark(wanted.study.base)
    with opened(**where) as pool, bar((len(wanted.causes) + 2) * sample.count, 0) as progress, blaming(study):
        found = drivers(wanted, sample.count, seed=sample.seed, pool=pool, progress=progress)
    if as_json:
        print_json(
            {"file": str(study), "count": sample.count, "seed": sample.seed, "responses": scatter_record(wanted, found)}
        )
        return
    print_all(scatter_tables(wanted, found))
