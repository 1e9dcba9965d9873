"""The customer's sheet: one page, one date, escaped texts, the shop's defaults, and refused shop files."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.command_line import as_json, call, stdout_of
from tests.helpers.invalid_input import assert_refused, rejected, stored_rows
from tests.test_golden_files import assert_golden, drawing_text, page_text, rounded

PROFILE = "x (in),diameter (in)\n0,.505\n14,.520\n29,.845\n"
SHOP = """[shop]
name = "Cues <b>& Co.</b>"
line = "12 Main Street"
logo = "logo.svg"
[defaults]
body_mass = "15 oz"
ferrule = "1 in melamine"
units = "us"
[defaults.limits]
wall = ".120 in"
"""
LOGO = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"><circle r="1"/></svg>'


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    """A shaft of a shop, one folder below its shop.toml."""
    (tmp_path / "shop.toml").write_text(SHOP)
    (tmp_path / "logo.svg").write_text(LOGO)
    (tmp_path / "shafts").mkdir()
    made = tmp_path / "shafts" / "pro.csv"
    made.write_text(PROFILE)
    return made


def test_sheet_of_a_csv_equals_golden_files(
    drawing: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    """In both units; with the shop, the order and one date."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1795859200")
    page = drawing.with_name("0142.html")
    given = ("--customer", "A <i>Player</i>", "--serial", "0142")
    assert call("report", drawing, "--sheet", *given, "-o", page)[0] == 0
    text = page.read_text(encoding="utf-8")
    assert_golden("sheet_us.txt", rounded(page_text(text) + drawing_text(text)), request)
    assert ("<b>& Co." in text, "<i>Player" in text, "data:image/svg+xml;base64," in text) == (False, False, True)
    assert call("report", drawing, "--sheet", "--date", "Monday", "--units", "metric", "-o", page)[0] == 0
    text = page.read_text(encoding="utf-8")
    assert_golden("sheet_metric.txt", rounded(page_text(text) + drawing_text(text)), request)


def test_order_of_a_cue_is_on_its_sheet_and_in_no_record(drawing: Path) -> None:
    cue = drawing.with_suffix(".toml")
    assert call("convert", drawing, cue)[0] == 0
    cue.write_text(cue.read_text() + '\n[order]\ncustomer = "B. Player"\nserial = "7"\ndate = 2026-03-01\n')
    page = drawing.with_name("7.html")
    assert call("report", cue, "--sheet", "-o", page)[0] == 0
    said = page.read_text(encoding="utf-8")
    assert ("B. Player" in said, "2026-03-01" in said) == (True, True)
    assert "Player" not in stdout_of("report", cue, "--json")
    copied = drawing.with_name("copied.toml")
    assert call("convert", cue, copied, "--body-mass", "16 oz")[0] == 0
    assert copied.read_text().endswith(cue.read_text().partition("[order]")[2])


def test_defaults_of_a_shop_fill_what_a_file_leaves_open(drawing: Path) -> None:
    """As options do, and below them; each is said among the assumptions."""
    filled = as_json("strike", drawing)
    (drawing.parents[1] / "shop.toml").unlink()
    typed = as_json("strike", drawing, "--body-mass", "15 oz", "--ferrule", "1 in melamine")
    assert [filled.pop(key) != typed.pop(key) for key in ("assumptions",)] == [True]
    assert filled == typed
    (drawing.parents[1] / "shop.toml").write_text(SHOP)
    assert "body mass 15 oz, the default of shop.toml (--body-mass)" in stdout_of("strike", drawing)
    answer = cf.strike_models(cf.load_scene(drawing))
    assert "body mass 15 oz, the default of shop.toml" in [each.text for each in answer.assumptions]
    assert cf.load_scene(drawing, body_mass="16 oz").shaft.body_mass == pytest.approx(0.4536, rel=1e-4)


@pytest.mark.heavy
def test_limits_of_a_shop_are_those_of_improve(drawing: Path) -> None:
    assert "Limits: wall .096 in or more" in stdout_of("improve", drawing, "--wall", ".096 in", "--keep", "wood")


def test_shop_file_or_logo_of_another_kind_is_refused(drawing: Path, request: pytest.FixtureRequest) -> None:
    """Each row: a command, what is replaced in the shop's file, its replacement."""
    shop, messages = drawing.parents[1], {}
    (shop / "large.png").write_bytes(bytes(1_000_001))
    for row in stored_rows("shop_files"):
        command, change = row.replace("LONG", 81 * "x").split(" | ")
        (shop / "shop.toml").write_text(SHOP.replace(*change.split(" -> ")))
        messages[row] = rejected(shop, *command.split(), drawing, "-o", drawing.with_name("0142.html"))
    assert_refused("shop_files", messages, request)


@pytest.mark.heavy
@pytest.mark.parametrize("paper", ["letter", "A4"])
def test_sheet_prints_on_one_page(paper: str, drawing: Path) -> None:
    """With the longest texts that it takes, in either paper size."""
    chromium, pdfinfo = shutil.which("chromium"), shutil.which("pdfinfo")
    if chromium is None or pdfinfo is None:
        pytest.skip("needs chromium and pdfinfo")
    page = drawing.with_name("long.html")
    (drawing.parents[1] / "shop.toml").write_text(SHOP.replace("12 Main Street", 16 * "long "))
    call("report", drawing, "--sheet", "--customer", 16 * "long ", "--serial", 16 * "long ", "-o", page)
    text = page.read_text(encoding="utf-8")
    page.write_text(text.replace("@page { margin", f"@page {{ size: {paper}; margin"), encoding="utf-8")
    printed = page.with_suffix(".pdf")
    asked = [chromium, "--headless", "--no-sandbox", "--no-pdf-header-footer", f"--print-to-pdf={printed}"]
    subprocess.run([*asked, page.as_uri()], check=True, capture_output=True)
    about = subprocess.run([pdfinfo, printed], check=True, capture_output=True, text=True).stdout
    assert re.search(r"Pages: +1\n", about)
