"""The record of a claim, its table, and the comparison of tables, which must be able to fail."""

import pytest

from studies.pages import disagreements, number
from studies.paper.claims import Claim, markdown, read_markdown

CLAIMS = [
    Claim("I, eq. a", "speed after", -0.26, 0.51, "m/s", "slip", "breaks momentum"),
    Claim("II", "not a number", None, 1 / 3, "", "not derivable", "no figure given"),
    Claim("III", "same", 2.0, 2.0 + 1e-12),
]


def test_a_table_reads_back_as_the_claims_it_shows():
    back = read_markdown("# Title\n\ntext\n\n" + markdown(CLAIMS))
    assert [(c.source, c.what, c.unit, c.verdict, c.cause) for c in back] == [
        (c.source, c.what, c.unit, c.verdict, c.cause) for c in CLAIMS
    ]
    assert back[0] == CLAIMS[0]
    assert back[1].printed is None
    assert back[1].derived == pytest.approx(1 / 3, rel=1e-7)


def test_difference_is_relative_to_the_derived_value():
    assert CLAIMS[0].difference == pytest.approx(-0.77 / 0.51, rel=1e-14)
    assert CLAIMS[1].difference is None
    assert Claim("a", "b", 1.0, 0.0, verdict="slip").difference is None
    assert "| < 1e-09 |" in markdown(CLAIMS)


def test_numbers_that_are_not_there_are_a_dash():
    assert number(None) == "–"
    assert number(1 / 3, 3) == "0.333"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"verdict": "wrong"}, "Claim.verdict must be one of agrees, rounding, slip, not derivable; got 'wrong'"),
        ({"cause": "a | b"}, "Claim.cause must hold no"),
        ({"derived": float("nan")}, "Claim.derived must be finite or None; got nan"),
    ],
)
def test_bad_claims_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        Claim(**({"source": "a", "what": "b", "printed": 1.0, "derived": 1.0} | change))


@pytest.mark.parametrize(
    ("ours", "near", "far"),
    [
        ("a 1.2345 b", "a 1.2346 b", "a 1.2347 b"),
        ("a 1.2345 b", "a 1.2344 b", "a -1.2345 b"),
        ("| 4.1e-05 |", "| 4.2e-05 |", "| 4.3e-05 |"),
        ("| 4.1e-05 |", "| 4.0e-05 |", "| 4.1e-04 |"),
        ("x 120 Hz, -3", "x 121 Hz, -3", "y 120 Hz, -3"),
        ("12.5\n7", "12.5\n7", "12.5"),
        ("1 2", "1 2", "1"),
    ],
)
def test_tables_agree_to_one_in_the_last_printed_place_and_no_farther(ours, near, far):
    assert disagreements(ours, near) == []
    assert disagreements(ours, far)
