"""The glossary on a page: buttons of terms open definitions; the text is unchanged (properties)."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cuefem.show.glossary import entries, with_term_buttons

WORDS = [word for entry in entries() for word in entry.words]
TAGS = re.compile(r"<[^>]*>")


def buttons(markup: str) -> list[tuple[str, str]]:
    """Id of the definition that each button opens, and its text."""
    return re.findall(r'<button type="button" class="term" popovertarget="([^"]*)">([^<]*)</button>', markup)


@pytest.mark.parametrize("tag", ["svg", "h1", "title", "button", "summary", "code", "label"])
def test_terms_in_headings_and_controls_have_no_button(tag: str) -> None:
    markup = f"<{tag}>squirt <b>spin</b></{tag}>"
    inside = f"<head>{markup}</head>" if tag == "title" else markup
    assert with_term_buttons(inside) == inside
    assert len(buttons(with_term_buttons(f"{inside}<p>squirt</p>"))) == 1


def test_names_of_cues_have_no_button() -> None:
    named = "<p>low deflection &amp; spin, squirt</p>"
    assert buttons(with_term_buttons(named, ["low deflection & spin", "deflection"])) == [("w-squirt", "squirt")]


@given(st.lists(st.sampled_from([*WORDS, "<p>", "</p>", "<b>", "</b>", " ", ", ", "the", "&amp;", "3 mm"])))
def test_term_buttons_preserve_text(parts: list[str]) -> None:
    markup = "".join(parts)
    assert TAGS.sub("", with_term_buttons(markup)) == TAGS.sub("", markup)


def test_term_has_one_button_in_a_section() -> None:
    """A section's tables and figures repeat its words: each was a stop of the Tab key, 125 on a report's page."""
    section = "<section><p>squirt</p><figure>Squirt</figure><table><td>squirt</td></table></section>"
    assert buttons(with_term_buttons(2 * section)) == 2 * [("w-squirt", "squirt")]
