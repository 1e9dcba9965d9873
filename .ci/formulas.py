"""Store the handbook's formulas as MathML for pages and as plain text for terminals (needs the extra [docs]).

.venv/bin/python .ci/formulas.py
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import latex2mathml.converter

from cuefem.handbook import chapters
from cuefem.handbook.formulas import FENCE, key

STORED = Path(__file__).parents[1] / "cuefem/handbook/formulas.json"
OPERATORS = {sign: f" {sign} " for sign in "=+±×<≤≥"}
OPERATORS |= {"−": " - ", "*": " * ", ",": ", ", ":": ": ", "∫": "∫ ", "∑": "Σ"}
LETTERS = str.maketrans({"′": "'", "⋅": "·", "\xa0": " "})
RAISED = str.maketrans("0123456789Tn", "⁰¹²³⁴⁵⁶⁷⁸⁹ᵀⁿ")
ACCENTS = {"˙": "\u0307", "¯": "\u0304"}


def stored_formulas() -> dict[str, dict[str, str]]:
    """Every formula of the handbook by its key."""
    sources = [latex for chapter in chapters() for latex in FENCE.findall(chapter.text)]
    return {key(latex): {"text": plain_text(latex), "mathml": as_mathml(latex)} for latex in sources}


def as_mathml(latex: str) -> str:
    """A formula in LaTeX as a block of MathML."""
    return latex2mathml.converter.convert(latex, display="block")


def plain_text(latex: str) -> str:
    """A formula in LaTeX as plain text: a line for each of its rows, aligned."""
    tree = fromstring(as_mathml(latex))
    for element in tree.iter():
        element.tag = element.tag.rpartition("}")[2]
    table = tree.find(".//mtable")
    if table is None:
        return line_of(tree)
    rows = [[line_of(cell) for cell in row] for row in table]
    columns = max(len(row) for row in rows)
    widths = [max(len(row[i]) for row in rows if i < len(row)) for i in range(columns)]
    lines = [aligned(row, widths) for row in rows]
    return "\n".join(line.rstrip() for line in lines)


def aligned(cells: list[str], widths: list[int]) -> str:
    """A row: its odd columns end and its even ones begin at the operator."""
    sides = [
        cell.ljust(width) if i % 2 else cell.rjust(width)
        for i, (cell, width) in enumerate(zip(cells, widths, strict=False))
    ]
    return "   ".join(" ".join(sides[i : i + 2]) for i in range(0, len(sides), 2))


def line_of(element: Element) -> str:
    """An element as one line."""
    line = re.sub(r"(^|[(=,:]) *([±-]) *", r"\1 \2", text_of(element))  # a sign, not a difference
    return re.sub(r" +(?=[ ,)])|(?<=\() +", "", line).strip()


def text_of(element: Element) -> str:
    """An element as text; an operator has its spaces."""
    text = (element.text or "").translate(LETTERS)
    parts = [line_of(part) for part in element]
    match element.tag:
        case "mi" | "mn" | "mtext":
            return text
        case "mo":
            return OPERATORS.get(text, text)
        case "mspace":
            return " "
        case "mfrac":
            return fraction(*parts)
        case "msqrt":
            return f"√{grouped(joined(element))}"
        case "mover":
            return parts[0] + ACCENTS[parts[1]]
        case "msup":
            return parts[0] + raised(parts[1])
        case "msub" | "munder":
            return f"{parts[0]}_{parts[1]}"
        case "msubsup":
            return f"{parts[0]}_{parts[1]}{raised(parts[2])}"
        case _:
            return joined(element)


def joined(element: Element) -> str:
    """The parts of an element beside each other."""
    text = ""
    before = None
    for part in element:
        added = text_of(part)
        if before is not None and needs_space(before, part, text[-1:], added[:1]):
            text += " "
        text += added
        before = part
    return text


def needs_space(before: Element, part: Element, last: str, first: str) -> bool:
    """Whether a space keeps two parts apart: about functions and sums, after a bracket, an index or a fraction."""
    follows_operand = before.tag != "mo" or last == ")"
    if is_function(part) or first in "∫Σ":
        return follows_operand
    if is_function(before):
        return first != "("
    ends_operand = before.tag in ("mfrac", "msub", "msubsup", "munder")
    if first == "(":
        return ends_operand and before.tag != "msub"
    return part.tag != "mo" and (ends_operand or last == ")")


def is_function(element: Element) -> bool:
    """Whether an element is the name of a function, or its power."""
    name = element[0] if element.tag == "msup" else element
    return name.tag in ("mi", "mo", "mtext") and re.fullmatch(r"[a-z]{2,}2?", name.text or "") is not None


def fraction(above: str, below: str) -> str:
    """A fraction in one line."""
    if (above, below) == ("1", "2"):
        return "½"
    is_sum = re.search(r" [+-] |/", re.sub(r"\([^()]*\)", "", above)) is not None
    if is_sum:
        return f"({above})/{grouped(below)}"
    return f"{above} / {grouped(below)}" if " " in above else f"{above}/{grouped(below)}"


def grouped(text: str) -> str:
    """A text in brackets, unless it is one factor."""
    return text if re.fullmatch(r"\d+|[^\W\d][\w'*⁰-⁹²³]*|∂\w+|√\([^()]*\)|√\w|\w?\([^()]*\)", text) else f"({text})"


def raised(text: str) -> str:
    """An exponent."""
    if text[0] in "'*":
        return text[0] + raised(text[1:]) if text[1:] else text
    return text.translate(RAISED) if re.fullmatch(r"[0-9Tn]+", text) else f"^{grouped(text)}"


if __name__ == "__main__":
    STORED.write_text(json.dumps(stored_formulas(), ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
