"""Ctrl-C ends the designer without a word (regression)."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import urllib.request

import pytest

from tests.helpers.designer_browser import await_listening

pytest.importorskip("nicegui")


@pytest.mark.heavy
@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends Ctrl-C to whole groups of processes")
def test_ctrl_c_ends_it_quietly() -> None:
    command = [sys.executable, "-m", "cuefem", "designer", "--no-open", "--port", "0"]
    outside = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=outside)
    try:
        assert running.stdout is not None
        address = running.stdout.readline().strip()
        await_listening(int(address.rstrip("/").rsplit(":", 1)[1]))
        with urllib.request.urlopen(address, timeout=90) as answer:
            assert answer.status == 200
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=90)
    finally:
        running.kill()
        running.communicate()
    assert (running.returncode, out, err) == (0, "", "")
