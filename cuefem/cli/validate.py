"""`cuefem validate`: every claim of every study."""

from __future__ import annotations

import importlib.util
import sys
from collections import Counter
from pathlib import Path

import click

from cuefem.cli.printing import json_option, page_option, tell
from cuefem.io import InputError, studies_with
from cuefem.report import claims_record, claims_sheet
from cuefem.report.claims import VERDICT_WORDS
from cuefem.validation import Claim


@click.command()
@click.option("--studies", type=click.Path(path_type=Path), default=Path("studies"), show_default=True)
@page_option
@json_option
def validate(studies: Path, as_json: bool, output: Path | None) -> None:
    """Check every claim of the sources against what follows from their equations; needs a clone of the repository."""
    record = claims_record(_claims(studies))
    counts = Counter(claim["verdict"] for claim in record)
    totals = ", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items()))
    tell(as_json, {"claims": record}, [claims_sheet(record), totals, VERDICT_WORDS], output)


def _claims(folder: Path) -> list[tuple[str, Claim]]:
    """The claims of every study in a folder that defines claims(), with the study's name."""
    clone = "they are in a clone of cuefem's repository: run there, or name their folder with --studies"
    if not folder.is_dir():
        raise InputError(folder, "", f"cannot be read: no such folder of studies; {clone}")
    files = studies_with(folder, "claims")
    if not files:
        raise InputError(folder, "", f"must hold studies (.py) that define claims(), got none; {clone}")
    if (above := str(folder.resolve().parent)) not in sys.path:
        sys.path.insert(0, above)  # studies import one another as studies.SUBJECT.NAME
    claims = []
    for file in files:
        name = ".".join((folder.resolve().name, *file.relative_to(folder).with_suffix("").parts))
        spec = importlib.util.spec_from_file_location(name, file)
        assert spec is not None and spec.loader is not None  # noqa: PT018
        study = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = study  # dataclasses look their module up
        spec.loader.exec_module(study)
        claims += [(file.stem, claim) for claim in study.claims()]
    return claims
