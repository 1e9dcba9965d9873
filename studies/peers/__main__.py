"""The contest of all peers that are installed: writes peers.md and peers.png beside itself; about two minutes."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl

from studies.peers.contest import hold
from studies.peers.ours import reference
from studies.peers.report import draw, text

HERE = Path(__file__).parent


def main() -> None:
    """Hold the contest and write what came of it."""
    mpl.use("Agg")
    contest = hold(reference(), say=lambda word: print(word, flush=True))
    (HERE / "peers.md").write_text(text(contest), encoding="utf-8")
    draw(contest, HERE / "peers.png")


if __name__ == "__main__":
    main()
