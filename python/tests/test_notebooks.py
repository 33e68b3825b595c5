"""The notebooks run from top to bottom, and are kept without outputs."""

import json
import signal
import sys
from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path, monkeypatch):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    for needed in ("ipykernel", "matplotlib", "scipy"):
        pytest.importorskip(needed)
    book = nbformat.read(path, as_version=4)
    code = [cell for cell in book.cells if cell.cell_type == "code"]
    assert code and not any(cell.outputs or cell.execution_count for cell in code), "strip the outputs"
    monkeypatch.setenv("MPLBACKEND", "agg")
    # a kernel of this very Python, whichever others are known
    kernel = tmp_path / "kernels" / "python3"
    kernel.mkdir(parents=True)
    argv = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    (kernel / "kernel.json").write_text(json.dumps({"argv": argv, "display_name": "here", "language": "python"}))
    monkeypatch.setenv("JUPYTER_PATH", str(tmp_path))
    client = nbclient.NotebookClient(book, timeout=120, resources={"metadata": {"path": str(tmp_path)}})
    # the client leaves a handler of its own where signals were ignored
    handler = signal.getsignal(signal.SIGINT)
    client.execute()
    signal.signal(signal.SIGINT, handler)
    shown = json.dumps([cell.get("outputs") for cell in book.cells])
    assert "Traceback" not in shown


def test_there_are_notebooks():
    assert len(NOTEBOOKS) == 5
