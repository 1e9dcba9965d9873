"""Many coupled strikes at once: scenes in, arrays out, on as many threads as are asked for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from cuefem.contact.strike import strike_modes
from cuefem.contact.turns import Turns
from cuefem.cue import Cue
from cuefem.quantity import check_count, check_kind, shown
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.tip_modes import Solved, default_resolution, turning

# Strikes of one cue that a thread takes at a time.
CHUNK = 16
NUMBERS = ("squirt", "ball_velocity", "ball_speed", "spin", "cue_speed", "impulse", "duration", "regime", "jam")


def batch_strike(scenes: Sequence[Scene], at: Resolution | None = None, *, threads: int = 1) -> Outcome:
    """Strike many balls with vibrating cues: the numbers of `cuefem.strike`, as arrays.

    Parameters
    ----------
    scenes
        One scene a strike, of any cues and effects. The modes of scenes that differ in ball, tip and stroke alone are
        solved once, as long as the same resolution is meant for them.
    at
        As in `cuefem.strike`, for all; by default each scene's own.
    threads
        How many threads strike. The compiled kernel lets them run beside each other; without it they take turns. The
        numbers do not depend on it.

    Returns
    -------
    Outcome
        Every field an array with one entry a scene, vectors (scenes, 2). ``energy`` has every name that a scene has,
        zero where another one has none. ``phases`` and ``history`` are left out, ``unknowns`` is the largest.

    Raises
    ------
    TypeError
        If ``scenes`` is not a sequence of scenes.
    ValueError, RuntimeError
        As `cuefem.strike`, with the number of the scene in front, from 0 on.

    Notes
    -----
    What a strike costs beside its modes is in studies/speed_seconds.md.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scenes = [cf.Scene(cue, stroke=cf.Stroke(2.0, offset)) for offset in (0.1, 0.2, 0.3)]
    >>> outcome = cf.batch_strike(scenes, cf.Resolution(2, 10, 10), threads=2)
    >>> outcome.squirt.shape, bool(outcome.squirt[2] > outcome.squirt[1])
    ((3,), True)
    """
    check_count("batch_strike threads", threads, 1)
    if isinstance(scenes, Scene) or not isinstance(scenes, Iterable):
        got = "one Scene: write [scene], or cuefem.strike(scene)" if isinstance(scenes, Scene) else shown(scenes)
        raise TypeError(f"batch_strike scenes must be a sequence of Scene; got {got}")
    scenes = tuple(scenes)
    for scene in scenes:
        check_kind("batch_strike scenes", scene, Scene)
    if not scenes:
        raise ValueError("batch_strike takes one scene or more; got none")
    found: list[dict[str, Any]] = [{}] * len(scenes)
    jobs = _jobs(scenes, at)
    if threads == 1:
        _put(found, map(_struck, jobs))
    else:
        with ThreadPoolExecutor(threads) as executor:
            _put(found, executor.map(_struck, jobs))
    return _together(found)


class _Shared(Solved):
    """A cue that strikes share: its modes, and how they turn."""

    @cached_property
    def turns(self) -> Turns:
        """Of a strike's modes."""
        return Turns(self.tip)


class _Job(NamedTuple):
    """Strikes with the same modes: the scenes by their numbers, and what they share."""

    shared: _Shared
    scenes: tuple[tuple[int, Scene], ...]


def _jobs(scenes: tuple[Scene, ...], at: Resolution | None) -> Iterator[_Job]:
    groups: dict[Any, list[int]] = {}
    resolutions: dict[tuple[Cue, float], Resolution] = {}
    for i, scene in enumerate(scenes):
        with _Numbered(i):
            groups.setdefault(_modes_of(scene, at, resolutions), []).append(i)
    for rows in groups.values():
        shared = _Shared(scenes[rows[0]], at)
        if len(rows) > CHUNK:
            with _Numbered(rows[0]):
                shared.turns  # noqa: B018  # solved here: threads would all begin to
        for start in range(0, len(rows), CHUNK):
            yield _Job(shared, tuple((i, scenes[i]) for i in rows[start : start + CHUNK]))


def _modes_of(scene: Scene, at: Resolution | None, resolutions: dict[tuple[Cue, float], Resolution]) -> tuple[Any, ...]:
    """What the tip modes of a scene depend on; resolutions: the default ones known so far."""
    if scene.lumped is not None:
        return (scene.lumped,)
    resolution = at
    if resolution is None:
        timed = scene.shaft, float(scene.contact_time)
        resolution = resolutions.get(timed) or resolutions.setdefault(timed, default_resolution(scene))
    return scene.cue, scene.cue_effects, float(scene.axial_mass), turning(scene), resolution


class _Numbered:
    """Errors of a scene, with its number in front."""

    def __init__(self, number: int) -> None:
        self.number = number

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: Any, error: BaseException | None, trace: Any) -> None:
        if isinstance(error, ValueError | RuntimeError):
            raised = ValueError if isinstance(error, ValueError) else RuntimeError
            raise raised(f"scene {self.number}: {error}") from error


def _struck(job: _Job) -> list[tuple[int, dict[str, Any]]]:
    """The numbers of each strike; histories are dropped at once."""
    found = []
    for i, scene in job.scenes:
        with _Numbered(i):
            outcome = strike_modes(scene, job.shared.tip, job.shared.turns)
            numbers = {name: getattr(outcome, name) for name in (*NUMBERS, "energy", "unknowns", "kernel")}
        found.append((i, numbers))
    return found


def _put(found: list[dict[str, Any]], done: Iterator[list[tuple[int, dict[str, Any]]]]) -> None:
    for part in done:
        for i, numbers in part:
            found[i] = numbers


def _together(found: list[dict[str, Any]]) -> Outcome:
    names = dict.fromkeys(name for numbers in found for name in numbers["energy"])
    energy = {name: np.array([numbers["energy"].get(name, 0.0) for numbers in found]) for name in names}
    columns = {name: np.array([numbers[name] for numbers in found]) for name in NUMBERS}
    ran = " and ".join(sorted({numbers["kernel"] for numbers in found}))
    unknowns = max(numbers["unknowns"] for numbers in found)
    return Outcome(**columns, phases=(), energy=energy, unknowns=unknowns, kernel=ran)  # type: ignore[arg-type]
