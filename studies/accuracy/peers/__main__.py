"""The contest of all peers that are installed, some ten minutes: writes peers.md and peers.png.

They are written beside this file if every peer took part; otherwise into the current folder, so that no committed row
is lost.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl

from studies.accuracy.peers.contest import hold
from studies.accuracy.peers.ours import reference
from studies.accuracy.peers.report import draw, text

HERE = Path(__file__).parent


def main() -> None:
    """Hold the contest and write what came of it."""
    mpl.use("Agg")
    contest = hold(reference(), say=lambda word: print(word, flush=True))
    folder = Path() if contest.missing else HERE
    (folder / "peers.md").write_text(text(contest), encoding="utf-8")
    draw(contest, folder / "peers.png")
    print(f"wrote {folder / 'peers.md'}")


if __name__ == "__main__":
    main()
