"""What the studies of the papers claim: kim.py, kim_tone.py and miscue.py."""

import math
import runpy
from collections import Counter

import numpy as np
import pytest

from studies.pages import STUDIES
from studies.paper import kim, miscue
from studies.paper.claims import read_markdown


def test_the_readme_counts_the_verdicts():
    count = Counter(claim.verdict for claim in kim.claims())
    said = (
        f"Of {count.total()} claims {count['agrees']} agree, {count['rounding']} are roundings, {count['slip']} slips, "
    )
    assert said + f"{count['not derivable']} cannot" in (STUDIES / "README.md").read_text(encoding="utf-8")


def test_the_package_of_studies_prints_them(capsys):
    runpy.run_module("studies.paper", run_name="__main__")
    printed = capsys.readouterr().out
    assert "136 agrees" in printed
    assert "V, tone: 250 Hz as mode 2" in printed


def test_the_committed_table_reads_back_as_the_claims():
    ours, theirs = kim.claims(), read_markdown(kim.STUDY.committed)
    assert [(c.source, c.what, c.unit, c.verdict) for c in ours] == [
        (c.source, c.what, c.unit, c.verdict) for c in theirs
    ]


def test_verdicts_follow_from_the_numbers():
    """What agrees is close, and says nothing it does not mean; what slips is apart and says why."""
    for claim in kim.claims():
        gap = claim.difference
        if claim.verdict == "agrees" and gap is not None:
            assert abs(gap) < 0.1 if claim.cause else abs(gap) < 0.02, claim
        if claim.verdict == "slip" and gap is not None and abs(gap) < 1e-3:
            assert claim.cause, claim
        if claim.verdict in ("rounding", "not derivable"):
            assert claim.cause, claim


@pytest.mark.parametrize(
    ("what", "printed", "derived", "digits"),
    [
        ("V_cue/U, head on", -0.26, 0.51, 1e-12),
        ("squirt of a rigid cue, Q0 = 3, b/R = 0.5", 16, 14.4, 0.05),
        ("squirt of a rigid cue as Q0 -> 0, b/R = 0.5", 0, 1.6, 0.05),
        ("b/R at which squirt is 1 deg, m_c/M = 0.1", 0.55, 0.244, 5e-4),
        ("p_s/p_c at mu = 0.6, slip 'disappears almost instantaneously'", 0, 0.325, 5e-4),
        ("psi/epsilon", 0.3952100057, 0.3952100057, 5e-11),
        ("r_c/l", 0.5, 0.520, 5e-4),
        ("radius of a carom ball", 36.9, 30.75, 1e-12),
    ],
)
def test_known_findings_stand_in_the_table(what, printed, derived, digits):
    (claim,) = [c for c in kim.claims() if c.what == what]
    assert claim.printed == pytest.approx(printed, abs=1e-10)
    assert claim.derived == pytest.approx(derived, abs=digits)


# Every labelled equation of the paper that states a result, by its label in the paper's source. Left out: definitions
# and Newton's laws as they stand (Ri, Newton2, impulse, v0, friction:p, e*, W:Ui, eom4, rot4, ...).
LABELS = """
rc, P:conserv, Rot, Rot:ball, vrel, dv:FF, dvdv, beta:r, gamma:beta, domega dOmega, mu:cond1, sliding, v:v0, ps:v,
ps:v5, p parallel ps, cond:pp, mu:cond, cond:stick, lower, W:p, W perp ps, stick:eom, dv+, p II:stick, pc, pc2,
v perp 0, Wpc, W pc, ps/pc, vf:pf, W:rest, p II f, e* 1, pf/pc, v perp e, G, pfpc2, pc:ui, G:res, bound1, vf:egv,
pf parl, theta f, cue end, dW, gamma:', G:res2, muc:', pfpc3, pf parl2, V0 after, Omega0 after, V:angle, squirt:psi,
epsilon0 1, muc gamma, G 0th, psi=0, theta f: 1, psi squirt, Vf: 0, ROmega: 0, Omega max, Vf: cue
"""


def test_every_result_of_the_paper_with_a_label_is_there():
    labels = {" ".join(label.split()) for label in LABELS.split(",")}
    found = {claim.source.split("eq. ")[1].split(", line")[0] for claim in kim.claims() if "eq. " in claim.source}
    assert labels - found == set()


def test_the_general_solver_miscues_where_the_condition_says():
    for cue in miscue.CUES:
        for friction in (0.1, 0.6, 1.2):
            edge = miscue.by_regime(cue, friction)
            assert edge == pytest.approx(float(miscue.miscue(cue, friction)), rel=1e-10)


def test_the_map_of_the_rigid_cue_reaches_45_degrees_where_it_says():
    ratio = miscue.turning_ratio(math.radians(45))
    assert float(miscue.compression_limit(miscue.rigid(ratio), 0.6)) == pytest.approx(np.sin(np.pi / 4), rel=1e-12)
