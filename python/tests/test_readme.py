"""The Python lines of the README and of the package's own run as they stand there."""

import re
from pathlib import Path

import matplotlib
import pytest
from conftest import ROOT

matplotlib.use("Agg")


@pytest.mark.parametrize("path", [ROOT / "README.md", ROOT / "python" / "README.md"], ids=["root", "package"])
def test_lines(path: Path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", path.read_text(), re.S)
    assert blocks
    names: dict = {}
    for block in blocks:
        exec(compile(block, str(path), "exec"), names)
    assert (tmp_path / "lacuna-out" / "report.html").exists()
    assert names["found"].causes[0].effect == "coulomb_friction"
