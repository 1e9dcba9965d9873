"""Who takes part and how they are timed: each peer in its own process, in turns, so that load falls on all alike.

A peer is a file beside this one with VERSION and CONTESTANTS, {task: {label: call}}; it raises ImportError where its
package is missing. A call goes from the cone's numbers to the answer: mesh, assembly and solution are timed, imports
are not, and a package may keep whatever it wants from its first call on (tables, compiled code).
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from multiprocessing import get_context
from statistics import median
from time import process_time
from typing import Any

import numpy as np

from studies.accuracy.peers.cone import CASES, CONE

PEERS = ("ours", "scikit_fem", "ngsolve_line", "opensees", "ross_rotor", "calculix", "sfepy_line")
TARGETS = {"modes": 1e-6, "end_mass": 1e-4}
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
ROUNDS = 9
TURN = 0.03  # s: a turn repeats a quick call for so long, at most 20 times, and takes the median
STRIDE = 31  # from one case to the next: all cones and contact times come in the first turns
BUDGET = 3.0  # s for all the turns of one contestant, which has two at least


@dataclass
class Contestant:
    """One call of one peer: its relative error, the seconds of its first call and of its turns.

    error: of the modes; of end masses the median over all cones and contact times. high: that of 95 % of them.
    """

    peer: str
    task: str
    label: str
    error: float
    first: float
    high: float | None = None
    turns: list[float] = field(default_factory=list)

    @property
    def seconds(self) -> float:
        return median(self.turns)


@dataclass(frozen=True)
class Contest:
    """Who took part, the versions by peer, and why others did not."""

    contestants: list[Contestant]
    versions: dict[str, str]
    missing: dict[str, str]

    def find(self, task: str, label: str) -> Contestant | None:
        """The contestant of that name, if it took part."""
        return next((c for c in self.contestants if (c.task, c.label) == (task, label)), None)

    def quickest(self, task: str, peer: str) -> Contestant | None:
        """The quickest of a peer's contestants within the target."""
        within = [c for c in self.contestants if (c.task, c.peer) == (task, peer) and c.error <= TARGETS[task]]
        return min((c for c in within if not c.label.endswith("alone")), key=lambda c: c.seconds, default=None)


def errors(task: str, answer: Any, exact: Any) -> tuple[float, float | None]:
    """Relative errors: the largest of f3 to f5 and None; or the median and the 95 % of end masses."""
    off = np.abs(np.asarray(answer) / exact - 1)
    if task == "modes":
        return float(off[2:].max()), None
    return float(np.median(off)), float(np.quantile(off, 0.95))


def cases(task: str) -> tuple[tuple[int, float], ...]:
    """What a contestant answers: modes of the first cone, end masses of every cone at every contact time."""
    return CASES if task == "end_mass" else CASES[:1]


def load(peer: str) -> tuple[str, dict[str, list[str]]]:
    """(version, labels by task) of a peer; in its process."""
    module = import_module(f"studies.accuracy.peers.{peer}")
    return module.VERSION, {task: list(calls) for task, calls in module.CONTESTANTS.items()}


def call(peer: str, task: str, label: str, case: tuple[int, float] = CASES[0]) -> tuple[float, Any]:
    """(processor seconds, answer) of one call, with a cone of its own; in the peer's process."""
    work = import_module(f"studies.accuracy.peers.{peer}").CONTESTANTS[task][label]
    CONE.take(*case)
    start = clock()
    answer = work()
    return clock() - start, answer


def clock() -> float:
    """Processor seconds of this process and those that it ran: with one thread, the clock's on a machine at rest."""
    children = os.times()
    return process_time() + children.children_user + children.children_system


def answers(peer: str, task: str, label: str) -> tuple[float, list[Any]]:
    """(processor seconds of the first call, answers of all cases) of a contestant; in the peer's process."""
    found = [call(peer, task, label, case) for case in cases(task)]
    return found[0][0], [answer for _, answer in found]


def turn(peer: str, task: str, label: str, number: int = 0) -> float:
    """Median seconds of the calls of turn ``number``, which go on through the cases; in the peer's process."""
    seconds: list[float] = []
    while not seconds or (sum(seconds) < TURN and len(seconds) < 20):
        case = cases(task)[(STRIDE * (number + len(seconds))) % len(cases(task))]
        seconds.append(call(peer, task, label, case)[0])
    return median(seconds)


def _quiet() -> None:
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(nowhere, stream)


@contextmanager
def processes(peers: tuple[str, ...]) -> Iterator[dict[str, ProcessPoolExecutor]]:
    """A fresh process by peer, pinned to one thread."""
    os.environ.update(dict.fromkeys(THREADS, "1"))
    context = get_context("spawn")
    with ExitStack() as stack:
        yield {
            peer: stack.enter_context(ProcessPoolExecutor(1, mp_context=context, initializer=_quiet)) for peer in peers
        }


def hold(
    exact: dict[str, Any], peers: tuple[str, ...] = PEERS, say: Callable[[str], object] = lambda _: None
) -> Contest:
    """The contest: everyone's first call and error, then turns in rounds; ``say`` hears of peers that are not there."""
    contest = Contest([], {}, {})
    with processes(peers) as pools:
        for peer in peers:
            try:
                contest.versions[peer], labels = pools[peer].submit(load, peer).result()
            except (ImportError, OSError, RuntimeError, BrokenProcessPool) as why:
                word = "not installed here" if isinstance(why, ImportError) else "does not start here"
                contest.missing[peer] = f"{word}: {str(why).rstrip('.')}"
                say(f"{peer}: skipped, {contest.missing[peer]}")
                continue
            say(f"{peer} {contest.versions[peer]}")
            for task, label in ((name, label) for name, own in labels.items() for label in own):
                first, found = pools[peer].submit(answers, peer, task, label).result()
                middle, high = errors(task, found[0] if task == "modes" else found, exact[task])
                contest.contestants.append(Contestant(peer, task, label, middle, first, high))
        for number in range(ROUNDS):
            say(f"round {number + 1} of {ROUNDS}")
            for c in contest.contestants:
                if len(c.turns) < 2 or sum(c.turns) * (1 + 1 / len(c.turns)) < BUDGET:
                    c.turns.append(pools[c.peer].submit(turn, c.peer, c.task, c.label, number).result())
    return contest
