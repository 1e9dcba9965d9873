"""`cuefem scatter`: how much a design's numbers scatter, and what drives them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cuefem.cli.common import blaming, print_all, print_json, remark
from cuefem.cli.sweep import bar, opened

if TYPE_CHECKING:
    from cuefem.scatter import Drivers, Scatter

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
TRADE = {"kg": (1e3, "g"), "m": (1e3, "mm"), "rad": (math.degrees(1), "°"), "N/m": (1, "N/m"), "": (1, "")}


@click.command(short_help="How much a design's numbers scatter, and what drives it.")
@click.argument("study", type=click.Path(path_type=Path))
@click.option("--workers", type=click.IntRange(min=1), help="Processes; left out, this one works alone.")
@click.option("--dask", metavar="ADDRESS", help='A Dask scheduler to work on, e.g. "tcp://host:8786".')
@click.option("--json", "as_json", is_flag=True, help="SI numbers as JSON.")
def scatter(study: Path, as_json: bool, **where: Any) -> None:
    """Scatter of wood, turning and strokes: the distribution of STUDY's (.toml) responses, and what drives it.

    STUDY is that of a sweep, with [sample], and with correlations and groups. Shares are Sobol indices.
    """
    from cuefem.io.study import load_scatter
    from cuefem.scatter import drivers

    wanted, sample = load_scatter(study)
    remark(wanted.study.base)
    with opened(**where) as pool, bar((len(wanted.causes) + 2) * sample.count, 0) as progress, blaming(study):
        found = drivers(wanted, sample.count, seed=sample.seed, pool=pool, progress=progress)
    if as_json:
        print_json(
            {"file": str(study), "count": sample.count, "seed": sample.seed, "responses": _record(wanted, found)}
        )
        return
    print_all(_tables(wanted, found))


def _record(wanted: Scatter, found: Drivers) -> dict[str, Any]:
    """A record of every response by its name."""
    quantiles = found.spread.quantiles(SHARES)
    return {
        response.name: {
            "unit": response.unit,
            "mean": found.spread.mean[k],
            "sd": found.spread.sd[k],
            "quantiles": {str(share): value for share, value in zip(SHARES, quantiles[:, k], strict=True)},
            "causes": {
                cause: {
                    "first": found.first[i, k],
                    "first_interval": found.first_interval[:, i, k],
                    "total": found.total[i, k],
                    "total_interval": found.total_interval[:, i, k],
                }
                for i, cause in enumerate(found.causes)
            },
        }
        for k, response in enumerate(wanted.study.responses)
    }


def _tables(wanted: Scatter, found: Drivers) -> list[Any]:
    from cuefem.report.tables import significant, table_of, with_caption

    count = len(found.spread.values)
    spreads = table_of("Spread", ["response", "mean", "sd", *(f"{100 * share:g} %" for share in SHARES)])
    shares = table_of("What drives it: share of the variance, in per cent", ["response, cause", "alone", "in all"])
    for k, response in enumerate(wanted.study.responses):
        scale, unit = TRADE.get(response.unit, (1, response.unit))
        numbers = [found.spread.mean[k], found.spread.sd[k], *found.spread.quantiles(SHARES)[:, k]]
        name = f"{response.name}, {unit}" if unit else response.name
        spreads.add_row(name, *(significant(scale * value) for value in numbers))
        shares.add_row(response.name, "", "", style="bold")
        for i in found.total[:, k].argsort()[::-1]:
            both = ((found.first, found.first_interval), (found.total, found.total_interval))
            shares.add_row(f"  {found.causes[i]}", *(_share(value[i, k], ends[:, i, k]) for value, ends in both))
    drawn = f"{count} designs; of them so many lie below the value"
    words = ("alone: what would go, were the cause known; in all: what would stay, were all others known",)
    grouped = [f"{c}: {', '.join(n)}" for c, n in wanted.groups.items()]
    intervals = "in brackets 95 % intervals, bootstrapped"
    return [with_caption(spreads, drawn), with_caption(shares, *words, intervals, *grouped)]


def _share(value: float, ends: Any) -> str:
    low, high = (100 * float(end) for end in ends)
    return f"{100 * value:.1f} ({low:.1f} to {high:.1f})"
