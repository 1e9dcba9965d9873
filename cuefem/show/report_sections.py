"""The report of a cue: its record, and its tables in their order for the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from cuefem.contact.geometric_stiffness import SlopeOutOfRange
from cuefem.contact.strike import strike_modes
from cuefem.effects.force_law import IndentationOutOfRange
from cuefem.io.reference_cues import reference_cues
from cuefem.results.quantities import format_value
from cuefem.results.records import Record, Table, tabulate_values, value_rows
from cuefem.results.solved_design import OFFSETS, SolvedDesign, listed_results
from cuefem.results.verdict import NoVerdict, verdict_record
from cuefem.scene import Outcome, Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.end_mass_table import SQUIRT_END_MASS, end_mass_record
from cuefem.show.impact_table import impact_record, tabulate_impacts
from cuefem.show.modes_table import modes_record, tabulate_modes
from cuefem.show.scene_summary import assumptions
from cuefem.show.squirt_table import squirt_record, tabulate_squirt
from cuefem.show.strike_table import regime_warning
from cuefem.show.verdict_table import tabulate_verdict


def report_record(
    scene: Scene,
    *,
    count: int = 6,
    offsets: Sequence[float] = OFFSETS,
    solved: SolvedScene | None = None,
    outcome: Outcome | None = None,
) -> Record:
    """Verdict, modes, end masses, squirt curve, leather tip, all results by name, and the contact state of a stroke.

    Beyond the valid range of the force law or of the geometric stiffness: the modes, and the reason as "no_contact". Of
    a miscue: no verdict and no squirt of its own, and the reason as "no_squirt".
    offsets: of the squirt curve; solved, outcome: the scene's modes and its strike, if already computed.
    """
    solved = solved or SolvedScene(scene)
    record: Record = {"modes": modes_record(scene, count=count, near=None)} if scene.cue.segments else {}
    try:
        scene.contact_time  # noqa: B018
        squirt = squirt_record(scene, offsets, solved=solved)
        squirts = {"end_masses": end_mass_record(scene, solved=solved), "squirt": squirt}
        outcome = outcome or strike_modes(scene, solved.tip)
    except (IndentationOutOfRange, SlopeOutOfRange) as error:
        return record | {"no_contact": str(error)}
    record |= squirts | ({} if scene.contact_terms.tip is None else {"tip": impact_record(scene)})
    numbers = listed_results(SolvedDesign(solved, outcome))
    record |= {"numbers": numbers, "regime": outcome.regime}
    try:
        return record | {"verdict": verdict_record(scene, outcome, reference_cues(), solved=solved)}
    except NoVerdict as error:
        return record | {"no_squirt": str(error)}


def tabulate_report(record: Record, scene: Record) -> list[Table | str]:
    """The tables of a report: the verdict first, the assumptions last."""
    frequencies: list[Table | str] = [tabulate_modes(record["modes"])] if "modes" in record else []
    if "no_contact" in record:
        return [f"no end mass and no squirt: {record['no_contact']}", "", *frequencies]
    warning = regime_warning(record["regime"])
    first: list[Table | str]
    if "no_squirt" in record:
        first = [record["no_squirt"], ""]
    else:
        first = [*([warning, ""] if warning else []), *tabulate_verdict(record["verdict"])]
    title = f"Cue, and stroke at offset b/R {scene['stroke']['offset']:.4g}"
    end_mass = (SQUIRT_END_MASS, format_value("mass", record["end_masses"]["definitions"]["squirt"]["end_mass"]))
    numbers = tabulate_values(title, [end_mass, *value_rows(record["numbers"])], assumptions(scene))
    return [
        *first,
        *frequencies,
        tabulate_squirt(record["squirt"], scene),
        *([tabulate_impacts(record["tip"])] if "tip" in record else []),
        numbers,
    ]
