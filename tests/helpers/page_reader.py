"""Parses a page as a browser does, and fails for tags that do not close in order; no tests."""

import re
from collections import Counter
from html.parser import HTMLParser

VOID = {"meta", "link", "br", "hr", "input"}


class PageReader(HTMLParser):
    """Tags, attributes and text of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: Counter[str] = Counter()
        self.attributes: list[tuple[str, str]] = []
        self.text: list[str] = []
        self.within = False  # inside or just after the button of a glossary term
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags[tag] += 1
        self.attributes += [(name, value or "") for name, value in attrs]
        self.within = tag == "button"
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert tag in VOID or self.open.pop() == tag
        self.within = tag == "button"

    def handle_data(self, data: str) -> None:
        if not {"style", "script"} & set(self.open):
            self.text[-1:] = ["".join([*self.text[-1:], data])] if self.within else [*self.text[-1:], data]

    def values(self, *names: str) -> list[str]:
        """The values of these attributes, in their order on the page."""
        return [value for name, value in self.attributes if name in names]


def assert_valid(text: str) -> PageReader:
    """A page of valid HTML without external resources, nan and None."""
    reader = PageReader(text)
    assert reader.open == []
    titles_of_curves = text.count("</title></path>")
    assert reader.tags["html"] == reader.tags["h1"] == reader.tags["title"] - titles_of_curves == 1
    assert (reader.tags["script"], reader.tags["img"], reader.tags["iframe"]) == (1, 0, 0)
    assert reader.values("href", "src", "xlink:href") == ["data:,"]
    assert re.findall(r"url\((?!#)|@import|https?:", text) == []
    ids = reader.values("id")
    assert len(ids) == len(set(ids))
    assert {*re.findall(r"url\(#([^)]*)\)", text), *reader.values("popovertarget")} == set(ids)
    texts = " ".join(reader.text)
    assert not re.search(r"\b(nan|inf|None|Undefined)\b", texts)
    assert not re.search(r"\bnan\b", text)
    return reader
