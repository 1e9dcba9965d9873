"""The designer in its own process, and a headless browser; no tests."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
COMMAND = "import sys; from cuefem.cli import main; main()"
PATIENCE = 90_000  # ms, on a busy machine


def browser_marks() -> list[pytest.MarkDecorator]:
    """The marks of browser tests; skips the file where NiceGUI or playwright is not installed."""
    pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install playwright")
    pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
    return [pytest.mark.heavy, pytest.mark.skipif(BROWSER is None, reason="needs Chromium: apt-get install chromium")]


@contextmanager
def open_browser() -> Iterator[Any]:
    """A headless browser."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        yield browser
        browser.close()


@contextmanager
def designer_process(folder: Path) -> Iterator[tuple[str, int]]:
    """The address of a designer that runs in a folder, and the number of its process.

    It must print nothing on stderr and write no file there.
    """
    command = [sys.executable, "-W", "error", "-c", COMMAND, "designer", "--no-open", "--port", "0"]
    errors = folder / "stderr"
    with errors.open("w") as err:
        process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=err,
            text=True,
            cwd=folder,
            env={name: value for name, value in os.environ.items() if not name.startswith("PYTEST")},
        )
        try:
            assert process.stdout is not None
            address = process.stdout.readline().strip()
            assert address.startswith("http://127.0.0.1:"), errors.read_text()
            wait_for_port(int(address.rstrip("/").rsplit(":", 1)[1]))
            yield address, process.pid
        finally:
            process.terminate()
            process.wait(timeout=30)
            process.stdout.close()
    assert errors.read_text() == ""
    assert [path.name for path in folder.iterdir()] == ["stderr"]


def wait_for_port(port: int) -> None:
    """Return when the server listens, shortly after it prints its address."""
    for _ in range(PATIENCE // 50):
        with suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
            return
        time.sleep(0.05)


@contextmanager
def empty_page(browser: Any, address: str = "", *, width: int = 1280, scheme: str = "light") -> Iterator[Any]:
    """An empty page; console messages, errors and requests to other addresses fail the test."""
    size = {"width": width, "height": 900 if width > 600 else 844}
    context = browser.new_context(viewport=size, color_scheme=scheme, accept_downloads=True)
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    messages: list[str] = []
    page.on("console", lambda message: messages.append(message.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on("request", lambda request: None if _own(request.url, address) else messages.append(request.url))
    yield page
    context.close()
    assert messages == []


@contextmanager
def designer_page(browser: Any, address: str, **how: Any) -> Iterator[Any]:
    """A page on the designer, loaded completely."""
    with empty_page(browser, address, **how) as page:
        page.goto(address)
        wait_until_idle(page)
        yield page


def violations(page: Any, **options: Any) -> list[dict[str, Any]]:
    """The violated rules of accessibility."""
    axe = pytest.importorskip(
        "axe_playwright_python.sync_playwright", reason="needs axe: pip install axe-playwright-python"
    )
    return list(axe.Axe().run(page, options=options).response["violations"])


def _own(url: str, address: str) -> bool:
    address = address.partition("#")[0]  # a link contains a design after #
    return url.startswith((address, address.replace("http", "ws"), "data:", f"blob:{address}"))


def wait_until_idle(page: Any) -> None:
    """Wait until the designer has computed every change."""
    page.wait_for_timeout(150)  # the message that marks the page as busy is in transit
    page.wait_for_function("() => document.querySelector('[data-busy]')?.dataset.busy === 'false'")


def resident_memory(process: int) -> int:
    """The resident memory of a process, kB; Linux alone has it."""
    status = Path(f"/proc/{process}/status")
    if not status.exists():
        pytest.skip("needs /proc")
    line = next(line for line in status.read_text().splitlines() if line.startswith("VmRSS"))
    return int(line.split()[1])


def displayed_number(page: Any, name: str, whose: str = "own") -> float:
    """A number of the first screen in SI, of the design or of the compared one."""
    return float(page.locator(f'[data-number="{name}"][data-of="{whose}"]').first.get_attribute("data-value"))


def type_value(page: Any, label: str, text: str) -> None:
    """Type a value into a field, and wait for its results."""
    field = page.get_by_label(label, exact=True).first
    field.fill(text)
    field.press("Enter")
    wait_until_idle(page)


def pick_option(page: Any, label: str, option: str) -> None:
    """Pick an option of a list, and wait for its results."""
    page.get_by_role("combobox", name=label, exact=True).first.click()
    page.get_by_role("option", name=option, exact=True).click()
    wait_until_idle(page)


def download(page: Any, button: str, folder: Path) -> Path:
    """The file that a button downloads, saved in the folder."""
    with page.expect_download() as waiting:
        page.get_by_role("button", name=button).click()
    path = folder / str(waiting.value.suggested_filename)
    waiting.value.save_as(path)
    return path
