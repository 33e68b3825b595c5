"""The programs of the README, the examples and the docstrings must run."""

import doctest
import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

PYTHON = Path(__file__).parents[1]


def test_the_readme_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (PYTHON / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 8
    names: dict = {}
    for block in blocks:
        lines = [line for line in block.splitlines() if ".plot(" not in line]
        exec("\n".join(lines), names)
    assert names["sim"].done and len(names["rows"]) == 3
    assert not names["certificate"].sensitive and len(names["some"]) == 4 and names["reach"].calls == 1
    assert names["rows"]["weight.x"][0] < names["rows"]["weight.x"][2]


def test_the_example_runs(tmp_path):
    done = subprocess.run([sys.executable, PYTHON / "examples" / "towing.py", tmp_path], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    deep = [float(x) for x in re.findall(r"kn: +([\d.]+) m deep", done.stdout)]
    # the faster the ship, the higher the weight
    assert len(deep) == 4 and deep == sorted(deep, reverse=True)


@pytest.mark.parametrize("name", ["ropewalk", "ropewalk._functions", "ropewalk._objective", "ropewalk._scene", "ropewalk._simulation"])
def test_docstrings_run(name):
    module = importlib.import_module(name)
    import ropewalk

    assert doctest.testmod(module, extraglobs={"rw": ropewalk, "Scene": ropewalk.Scene}).failed == 0
