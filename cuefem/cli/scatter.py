"""`cuefem scatter`: how much a design's numbers scatter, and what drives them."""

from __future__ import annotations

from itertools import count
from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import blaming, remark
from cuefem.cli.printing import assumed_lines, json_option, page_option, tell
from cuefem.cli.progress import bar
from cuefem.cli.sweep import opened, pool_options
from cuefem.design.scatter import drivers
from cuefem.io import save_page
from cuefem.io.study_files import assumed_base, load_scatter
from cuefem.report.scatter_table import cause_sheet, scatter_record, scatter_sheets, scatter_words, spread_sheet
from cuefem.report.study_page import Scattered, study_page
from cuefem.report.study_table import table_of_study


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
        found = drivers(wanted, sample.count, seed=sample.seed, pool=pool, progress=progress)
    if output is not None:
        table = table_of_study(wanted.study, zip(count(), found.spread.values, found.spread.responses, strict=False))
        assert table is not None
        facts = [f"{len(found.spread.values)} designs, as wood, turning and strokes scatter"]
        scattered = Scattered(spread_sheet(wanted, found), cause_sheet(wanted, found))
        save_page(study_page(study.stem, table, facts, scattered=scattered), output)
    about = {"file": str(study), "assumed": notes, "count": sample.count, "seed": sample.seed}
    written = [f"wrote {output}"] if output else []
    lines = [*assumed_lines(notes), *scatter_sheets(wanted, found), *scatter_words(wanted, found), *written]
    tell(as_json, about | {"responses": scatter_record(wanted, found)}, lines)
