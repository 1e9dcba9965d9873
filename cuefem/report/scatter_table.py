"""How much a design's numbers scatter and what drives them: a record for programs, sheets for people."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from cuefem.design.scatter import Drivers, Scatter
from cuefem.report.study_table import shown
from cuefem.results.quantities import TRADE
from cuefem.results.records import Sheet

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
LEAST_NAMED = 0.01  # share of a cause that is named among the strongest

DRIVERS = "What drives the spread: share of the variance, in per cent"


def scatter_record(wanted: Scatter, drivers: Drivers) -> dict[str, Any]:
    """A record of every response by its name."""
    quantiles = drivers.spread.quantiles(SHARES)
    return {
        response.name: {
            "unit": response.unit,
            "mean": drivers.spread.mean[k],
            "sd": drivers.spread.sd[k],
            "quantiles": {str(share): value for share, value in zip(SHARES, quantiles[:, k], strict=True)},
            "causes": {
                cause: {
                    "first": drivers.first[i, k],
                    "first_interval": drivers.first_interval[:, i, k],
                    "total": drivers.total[i, k],
                    "total_interval": drivers.total_interval[:, i, k],
                }
                for i, cause in enumerate(drivers.causes)
            },
        }
        for k, response in enumerate(wanted.study.responses)
    }


def scatter_sheets(wanted: Scatter, drivers: Drivers) -> list[Sheet]:
    """The spread of every response, and what drives it."""
    rows, bold = list[tuple[str, ...]](), dict[int, str]()
    for k, response in enumerate(wanted.study.responses):
        bold[len(rows)] = "bold"
        rows.append((response.label, "", ""))
        for i in drivers.total[:, k].argsort()[::-1]:
            both = ((drivers.first, drivers.first_interval), (drivers.total, drivers.total_interval))
            rows.append((f"  {drivers.causes[i]}", *(_share(value[i, k], ends[:, i, k]) for value, ends in both)))
    notes = (
        "alone: the part of the variance that goes away if this cause is known; in all: the part that stays if all "
        "other causes are known",
        "in brackets 95 % intervals, bootstrapped",
        *(f"{cause}: {', '.join(names)}" for cause, names in wanted.groups.items()),
    )
    drawn = (
        f"{len(drivers.spread.values)} designs; a column headed 5 %: 5 % of them lie below its value; sd: standard "
        "deviation"
    )
    return [
        replace(spread_sheet(wanted, drivers), notes=(drawn,)),
        Sheet(DRIVERS, ("response, cause", "alone", "in all"), tuple(rows), notes, styles=bold),
    ]


def spread_sheet(wanted: Scatter, drivers: Drivers) -> Sheet:
    """The distribution of every response."""
    rows = []
    for k, response in enumerate(wanted.study.responses):
        numbers = [drivers.spread.mean[k], drivers.spread.sd[k], *drivers.spread.quantiles(SHARES)[:, k]]
        rows.append((response.heading, *(shown(value, response.unit) for value in numbers)))
    return Sheet("Spread", ("response", "mean", "sd", *(f"{100 * share:g} %" for share in SHARES)), tuple(rows))


def cause_sheet(wanted: Scatter, drivers: Drivers) -> Sheet:
    """The shares of every cause in a row, the strongest first, a column a response: alone, and in brackets in all."""
    names = [response.label for response in wanted.study.responses]
    rows = (
        (
            drivers.causes[i],
            *(
                f"{100 * max(drivers.first[i, k], 0.0):.0f} % ({100 * drivers.total[i, k]:.0f} %)"
                for k in range(len(names))
            ),
        )
        for i in drivers.total.max(axis=1).argsort()[::-1]
    )
    return Sheet("What drives the results", ("cause", *names), tuple(rows))


def scatter_words(wanted: Scatter, drivers: Drivers) -> list[str]:
    """The result in a sentence for each response."""
    lines = []
    for k, response in enumerate(wanted.study.responses):
        unit = TRADE.get(response.unit, (1, response.unit))[1]
        low, high = (shown(value, response.unit) for value in drivers.spread.quantiles((0.05, 0.95))[:, k])
        total = np.clip(drivers.total[:, k], 0.0, 1.0)  # an estimate may lie beyond
        most = [i for i in total.argsort()[::-1][:2] if total[i] >= LEAST_NAMED]
        named = " and ".join(f"{drivers.causes[i]} ({100 * total[i]:.0f} %)" for i in most)
        named = f"the strongest cause{'s are' if len(most) > 1 else ' is'} {named}" if most else "no cause stands out"
        lines.append(f"{response.label}: nine in ten lie from {low} to {high} {unit}".rstrip() + f"; {named}")
    return lines


def _share(value: float, ends: Any) -> str:
    low, high = (100 * float(end) for end in ends)
    return f"{100 * value:.1f} ({low:.1f} to {high:.1f})"
