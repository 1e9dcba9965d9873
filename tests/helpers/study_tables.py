"""Tables of a study's page, read back; no tests."""

from __future__ import annotations


def rows(page: str) -> list[list[str]]:
    """Cells of all lines of the tables of a page, heads with them."""
    lines = (line for line in page.splitlines() if line.startswith("| "))
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines]


def row(page: str, *starts: str) -> list[str]:
    """Cells of the one row that starts so."""
    (cells,) = [cells for cells in rows(page) if tuple(cells[: len(starts)]) == starts]
    return cells


def after(page: str, heading: str) -> str:
    """The part of a page from a heading on."""
    return page[page.index(f"\n{heading}") :]
