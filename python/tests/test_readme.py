"""The Python lines of the README, of the package's own and of the book run as they stand there."""

import re
from pathlib import Path

import matplotlib
import pytest
from conftest import ROOT

matplotlib.use("Agg")
PAGES = [ROOT / "README.md", ROOT / "python" / "README.md", ROOT / "docs" / "book" / "python.md"]


@pytest.mark.parametrize("path", PAGES, ids=["root", "package", "book"])
def test_lines(path: Path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", path.read_text(), re.S)
    assert blocks
    names: dict = {}
    for block in blocks:
        exec(compile(block, str(path), "exec"), names)
    assert (tmp_path / "lacuna-out" / "report.html").exists()
    assert names["found"].causes[0].effect == "coulomb_friction"
