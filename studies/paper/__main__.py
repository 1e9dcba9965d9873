"""`python -m studies.paper` prints every claim of Kim's paper with what follows from its equations."""

from collections import Counter

from rich.console import Console

from cuefem.results.records import tabulate
from cuefem.show.renderers import terminal
from studies.pages import number
from studies.paper.claims import Claim, gap
from studies.paper.kim import claims

COLUMNS = {
    "source: what, unit": lambda claim: f"{claim.source}: {', '.join(filter(None, (claim.what, claim.unit)))}",
    "verdict": lambda claim: claim.verdict,
    "printed": lambda claim: number(claim.printed, 6),
    "derived": lambda claim: number(claim.derived, 6),
    "difference": gap,
}


def main() -> None:
    """Print the table, and how many claims have each verdict."""
    listed: list[Claim] = claims()
    console = Console(highlight=False)
    console.width = console.width if console.is_terminal else 120
    console.print(terminal(tabulate("Claims of [Kim], checked", COLUMNS, listed, texts=(0, 1))), crop=False)
    counts = Counter(claim.verdict for claim in listed)
    print(", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items())))
    print("`cuefem guide accuracy` explains the verdicts, studies/paper/kim.md gives the causes.")


if __name__ == "__main__":
    main()
