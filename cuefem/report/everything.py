"""The report of a cue: its record, and its tables in their order for the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from cuefem.contact.geometric_stiffness import BentTooFar
from cuefem.contact.strike import strike_modes
from cuefem.effects.force_law import TooDeep
from cuefem.io.ready import ready_cues
from cuefem.report.end_mass import SQUIRT_END_MASS, end_mass_record
from cuefem.report.modes_table import modes_record, modes_sheet
from cuefem.report.scene_words import assumptions
from cuefem.report.squirt import squirt_record, squirt_sheet
from cuefem.report.strike_table import regime_warning
from cuefem.report.tip_table import tip_record, tip_sheet
from cuefem.report.verdict_table import verdict_things
from cuefem.results.quantities import written
from cuefem.results.records import Record, Sheet, value_rows, values_sheet
from cuefem.results.solved_design import OFFSETS, SolvedDesign, listed
from cuefem.results.verdict import verdict_record
from cuefem.scene import Outcome, Scene
from cuefem.scene.solved_scene import Solved


def report_record(
    scene: Scene,
    *,
    count: int = 6,
    offsets: Sequence[float] = OFFSETS,
    solved: Solved | None = None,
    outcome: Outcome | None = None,
) -> Record:
    """Verdict, modes, end masses, squirt curve, leather tip, all results by name, and the contact state of a stroke.

    Beyond the valid range of the force law or of the geometric stiffness: the modes, and the reason as "no_contact".
    offsets: of the squirt curve; solved, outcome: the scene's modes and its strike, if already computed.
    """
    solved = solved or Solved(scene)
    record: Record = {"modes": modes_record(scene, count=count, near=None)} if scene.cue.segments else {}
    try:
        scene.contact_time  # noqa: B018
        squirt = squirt_record(scene, offsets, solved=solved)
        squirts = {"end_masses": end_mass_record(scene, solved=solved), "squirt": squirt}
        outcome = outcome or strike_modes(scene, solved.tip)
    except (TooDeep, BentTooFar) as error:
        return record | {"no_contact": str(error)}
    record |= squirts | ({} if scene.contact_terms.tip is None else {"tip": tip_record(scene)})
    numbers = listed(SolvedDesign(solved, outcome))
    verdict = verdict_record(scene, outcome, ready_cues(), solved=solved)
    return record | {"verdict": verdict, "numbers": numbers, "regime": outcome.regime}


def report_sheets(record: Record, scene: Record) -> list[Sheet | str]:
    """The tables of a report: the verdict first, the assumptions last."""
    frequencies: list[Sheet | str] = [modes_sheet(record["modes"])] if "modes" in record else []
    if "no_contact" in record:
        return [*frequencies, f"no end mass and no squirt: {record['no_contact']}"]
    warning = regime_warning(record["regime"])
    first: list[Sheet | str] = [warning, ""] if warning else []
    first += verdict_things(record["verdict"])
    first += [record["model_error"]["summary"], ""] if "model_error" in record else []
    title = f"Cue, and stroke at offset b/R = {scene['stroke']['offset']:.4g}"
    end_mass = (SQUIRT_END_MASS, written("mass", record["end_masses"]["drives"]["squirt"]["end_mass"]))
    numbers = values_sheet(title, [end_mass, *value_rows(record["numbers"])], assumptions(scene))
    return [
        *first,
        *frequencies,
        squirt_sheet(record["squirt"], scene),
        *([tip_sheet(record["tip"])] if "tip" in record else []),
        numbers,
    ]
