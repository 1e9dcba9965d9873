"""How much a design's numbers scatter and what drives them: a record for programs, tables for people."""

from __future__ import annotations

from typing import Any

from cuefem.design.scatter import Drivers, Scatter
from cuefem.report.quantities import TRADE, significant
from cuefem.report.table import table_of, with_caption

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)

DRIVERS = "What drives the spread: share of the variance, in per cent"


def scatter_record(wanted: Scatter, found: Drivers) -> dict[str, Any]:
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


def scatter_tables(wanted: Scatter, found: Drivers) -> list[Any]:
    """The spread of every response, and what drives it."""
    count = len(found.spread.values)
    spreads = table_of("Spread", ["response", "mean", "sd", *(f"{100 * share:g} %" for share in SHARES)])
    shares = table_of(DRIVERS, ["response, cause", "alone", "in all"])
    for k, response in enumerate(wanted.study.responses):
        scale, unit = TRADE.get(response.unit, (1, response.unit))
        numbers = [found.spread.mean[k], found.spread.sd[k], *found.spread.quantiles(SHARES)[:, k]]
        name = f"{response.name}, {unit}" if unit else response.name
        spreads.add_row(name, *(significant(scale * value) for value in numbers))
        shares.add_row(response.name, "", "", style="bold")
        for i in found.total[:, k].argsort()[::-1]:
            both = ((found.first, found.first_interval), (found.total, found.total_interval))
            shares.add_row(f"  {found.causes[i]}", *(_share(value[i, k], ends[:, i, k]) for value, ends in both))
    drawn = f"{count} designs; a column headed 5 %: 5 % of them lie below its value; sd: standard deviation"
    words = (
        "alone: the part of the variance that goes away if this cause is known; in all: the part that stays if all "
        "other causes are known",
    )
    grouped = [f"{c}: {', '.join(n)}" for c, n in wanted.groups.items()]
    intervals = "in brackets 95 % intervals, bootstrapped"
    return [with_caption(spreads, drawn), with_caption(shares, *words, intervals, *grouped)]


def _share(value: float, ends: Any) -> str:
    low, high = (100 * float(end) for end in ends)
    return f"{100 * value:.1f} ({low:.1f} to {high:.1f})"
