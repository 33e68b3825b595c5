import json
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import ropewalk as rw

VARY = {"speed": ["5 kn", "10 kn", "15 kn"], "elements": [4, 6]}
FIXED = {"duration": "1 s"}


def same(a, b):
    return [json.dumps(r, sort_keys=True) for r in a] == [json.dumps(r, sort_keys=True) for r in b]


def test_all_combinations_in_their_order(tmp_path):
    rows = rw.sweep("hose-turn", VARY, out=tmp_path, **FIXED)
    assert [(r["speed"], r["elements"]) for r in rows][:3] == [("5 kn", 4), ("5 kn", 6), ("10 kn", 4)]
    assert len(rows) == 6 and not rows.failed and rows["hose.end.z"].shape == (6,)
    run = rw.run("hose-turn", speed="10 kn", elements=4, **FIXED)
    assert rows[2]["hose.end.z"] == run.final["hose.end.z"]
    with pytest.raises(KeyError):
        rows["nothing"]


def test_what_is_there_is_not_computed_again(tmp_path):
    first = rw.sweep("hose-turn", VARY, out=tmp_path, **FIXED)
    files = {p: p.stat().st_mtime_ns for p in (tmp_path / "rows").iterdir()}
    assert len(files) == 6
    gone, cut = sorted(files)[:2]
    gone.unlink()
    cut.write_text("{")
    again = rw.sweep("hose-turn", VARY, out=tmp_path, **FIXED)
    assert same(first, again)
    assert {p for p, t in files.items() if p.stat().st_mtime_ns != t} == {gone, cut}
    # another version of the scene is another run
    rw.sweep("hose-turn", VARY, out=tmp_path, duration="1.1 s")
    assert len(list((tmp_path / "rows").iterdir())) == 12


def test_measures_of_ones_own(tmp_path):
    rows = rw.sweep(
        "hose-turn", {"speed": ["5 kn"]}, out=tmp_path, measure=lambda run: {"deepest": run["hose.end.z"].min()}, **FIXED
    )
    assert rows[0]["deepest"] <= rows[0]["hose.end.z"]


def test_another_measure_or_file_is_another_run(tmp_path):
    vary = {"speed": ["5 kn"]}
    for factor in (1, 2):
        rows = rw.sweep("hose-turn", vary, out=tmp_path, measure=lambda run: {"x": factor * run["hose.end.x"][-1]}, **FIXED)
        assert rows[0]["x"] == factor * rows[0]["hose.end.x"]
    first = rw.sweep("hose-turn", vary, out=tmp_path, measure=lambda run: {"x": 1.0}, **FIXED)
    other = rw.sweep("hose-turn", vary, out=tmp_path, measure=lambda run: {"x": 2.0}, **FIXED)
    assert (first[0]["x"], other[0]["x"]) == (1, 2)


def test_a_run_that_can_not_begin_is_a_row(tmp_path):
    rows = rw.sweep("hose-turn", {"elements": [4, -1]}, out=tmp_path, **FIXED)
    assert rows["status"].tolist() == ["finished", "refused"] and "elements" in rows[1]["message"]
    assert len(rows.failed) == 1 and np.isnan(rows["hose.end.z"][1])


def test_what_is_wrong_from_the_start_is_said_once(tmp_path):
    for wrong in ({"sped": [1]}, {"speed": ["1 kg"]}, {"speed": []}):
        with pytest.raises(rw.SceneError):
            rw.sweep("hose-turn", wrong, out=tmp_path)
    with pytest.raises(rw.SceneError, match="both varied and set"):
        rw.sweep("hose-turn", {"speed": [1]}, out=tmp_path, speed=2)
    with pytest.raises(rw.SceneError, match="no list"):
        rw.sweep("hose-turn", {"speed": "12 kn"}, out=tmp_path)  # type: ignore[dict-item]
    with pytest.raises(rw.SceneError, match="at least 1"):
        rw.sweep("hose-turn", {"speed": [1]}, out=tmp_path, jobs=0)
    with pytest.raises(rw.OutputError):
        rw.sweep("hose-turn", {"speed": [1]}, out=__file__)


def test_ctrl_c_ends_all_threads(tmp_path):
    timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        rw.sweep("hose-turn", {"speed": ["5 kn", "10 kn"]}, out=tmp_path, tolerance=1e-9)
    timer.join()
    assert time.monotonic() - start < 10 and not list((tmp_path / "rows").iterdir())
    assert threading.active_count() == 1


def test_files_of_a_scene_are_found(tmp_path):
    (tmp_path / "speeds.csv").write_text("t [s],v [m/s]\n0,0\n1,1\n2,2\n")
    scene = tmp_path / "scene.toml"
    scene.write_text(
        """
parameters = { mass = 1 }
run = { duration = "1 s" }
elements = [{ type = "point_mass", name = "a", marker = [0, 0, 0], mass = "$mass" }]
motions = [{ type = "speed_table", name = "m", file = "speeds.csv" }]
constraints = [{ type = "driving", name = "d", marker = "a", motion = "m" }]
records = [{ type = "position", of = "a" }]
"""
    )
    rows = rw.sweep(scene, {"mass": [1, 2]}, out=tmp_path / "sweep")
    assert rows["a.x"] == pytest.approx([0.5, 0.5], abs=1e-3)
    (tmp_path / "speeds.csv").write_text("t [s],v [m/s]\n0,0\n1,2\n2,4\n")
    rows = rw.sweep(scene, {"mass": [1, 2]}, out=tmp_path / "sweep")
    assert rows["a.x"] == pytest.approx([1.0, 1.0], abs=1e-3)


KILLED = """
import sys, ropewalk as rw
rw.sweep("hose-turn", {"speed": [f"{5 + k} kn" for k in range(40)]}, out=sys.argv[1], duration="2 s")
"""


def test_a_sweep_that_was_killed_goes_on(tmp_path):
    process = subprocess.Popen([sys.executable, "-c", KILLED, str(tmp_path / "a")])
    deadline = time.monotonic() + 30
    while len(list((tmp_path / "a").glob("rows/*.json"))) < 2 and time.monotonic() < deadline:
        time.sleep(0.005)
    process.kill()
    process.wait()
    vary = {"speed": [f"{5 + k} kn" for k in range(40)]}
    assert 0 < len(list((tmp_path / "a").glob("rows/*.json")))
    assert same(
        rw.sweep("hose-turn", vary, out=tmp_path / "a", duration="2 s"),
        rw.sweep("hose-turn", vary, out=tmp_path / "b", duration="2 s"),
    )


def test_samples_are_those_of_the_command_line(tmp_path):
    vary = {"speed": "5..25 kn", "drag": ["choo-casarella", "constant"], "elements": "4..8:1"}
    rows = rw.sweep("hose-turn", vary, out=tmp_path / "a", samples=3, seed=2, latin=True, **FIXED)
    command = [sys.executable, "-m", "ropewalk", "sweep", "hose-turn", "--vary", "speed=5..25 kn", "--vary"]
    command += ["drag=choo-casarella,constant", "--vary", "elements=4..8:1", "--samples", "3", "--seed", "2", "--latin"]
    subprocess.run([*command, "--set", "duration=1s", "--plan", "--quiet", "--out", "b"], cwd=tmp_path, check=True)
    lines = [line.split(",") for line in (tmp_path / "b" / "plan.csv").read_text().splitlines()]
    assert lines[0][2:] == ["speed [kn]", "drag", "elements"]
    assert [[f"{float(s)!r} kn", d, int(n)] for *_, s, d, n in lines[1:]] == [
        [f"{float(r['speed'].split()[0])!r} kn", r["drag"], r["elements"]] for r in rows
    ]
    assert not rows.failed and len(rows) == 6
    for wrong, match in (({"speed": "5..25 kn"}, "samples=100"), ({"speed": "25..5 kn"}, "ends before")):
        with pytest.raises(rw.SceneError, match=match):
            rw.sweep("hose-turn", wrong, out=tmp_path)
    with pytest.raises(rw.SceneError, match="no range"):
        rw.sweep("hose-turn", {"speed": [5]}, samples=3, out=tmp_path)


def test_rows_as_parquet(tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    rows = rw.sweep("hose-turn", {"speed": ["5 kn", 7], "elements": [4, -1]}, out=tmp_path, **FIXED)
    path = rows.to_parquet()
    assert path == tmp_path / "table.parquet" and not list(tmp_path.glob(".*"))
    there = pandas.read_parquet(path)
    assert list(there.columns) == rows.columns and there["status"].tolist() == rows["status"].tolist()
    assert there["speed"].tolist() == ["5 kn", "5 kn", "7", "7"] and there["elements"].tolist() == [4, -1, 4, -1]
    # to the last bit, and nothing where there is nothing
    assert np.array_equal(there["hose.end.z"].to_numpy(), rows["hose.end.z"], equal_nan=True)
    assert there["hose.end.z"].isna().tolist() == [False, True, False, True]
    with pytest.raises(rw.OutputError):
        rows.to_parquet(tmp_path / "no" / "folder")
