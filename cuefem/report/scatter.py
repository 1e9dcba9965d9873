"""How much a design's numbers scatter and what drives them: a record for programs, tables for people."""

from __future__ import annotations

import math
from typing import Any

from cuefem.design.scatter import Drivers, Scatter
from cuefem.report.table import table_of, with_caption
from cuefem.report.words import significant

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
TRADE = {"kg": (1e3, "g"), "m": (1e3, "mm"), "rad": (math.degrees(1), "°"), "N/m": (1, "N/m"), "": (1, "")}


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
