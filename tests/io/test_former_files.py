"""Files that an earlier version saved still load, and what they say in vain is told."""

from __future__ import annotations

from pathlib import Path

import pytest

import cuefem as cf
from cuefem.quantity.slips import FormerFile
from tests.helpers.command_line import call
from tests.helpers.leather_scenes import leather_scene

SAID = "effects[0].partial_slip says nothing any more: the patch always holds, slides and lets go ring by ring"


@pytest.mark.parametrize("value", ["true", "false"])
def test_a_tip_that_names_how_its_patch_lets_go(value: str, tmp_path: Path) -> None:
    file = tmp_path / "former.toml"
    cf.save(leather_scene(), file)
    file.write_text(file.read_text().replace('type = "LeatherTip"', f'type = "LeatherTip"\npartial_slip = {value}'))
    with pytest.warns(FormerFile) as told:
        scene = cf.load(file)
    assert scene == leather_scene()
    assert [str(each.message) for each in told] == [f"{file}: {SAID}"]
    status, _, err = call("strike", file, "--json")
    assert status == 0
    assert f"cuefem: {file}: {SAID}" in err.splitlines()
