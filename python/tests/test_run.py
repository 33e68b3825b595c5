import pickle
import threading
import time

import numpy as np
import pytest
import ropewalk as rw


def test_the_example_of_the_readme():
    run = rw.run("hose-turn", speed="15 kn", duration="30 s")
    z = run["hose.end.z"]
    assert isinstance(z, np.ndarray) and z.dtype == np.float64 and z.shape == run.t.shape == (301,)
    assert run["hose.end"].shape == (301, 3)
    assert np.array_equal(run["hose.end"][:, 2], z)
    assert run.units["hose.end.z"] == "m" and run.units["t"] == "s"
    assert run.final["hose.end.z"] == z[-1] == run.summary["final"]["hose.end.z"]
    assert run.status == "finished" and run.warnings == [] and run.folder is None
    assert "hose.end" in run and "hose.end.z" in run and "nothing" not in run


def test_a_wrong_name_is_told_with_what_there_is():
    run = rw.run("pendulum", duration="0.1 s")
    with pytest.raises(KeyError, match="did you mean 'cable.end.z'"):
        run["cable.end.zz"]


def test_a_folder_holds_the_same(tmp_path):
    run = rw.run("pendulum", duration="0.2 s", out=tmp_path / "p")
    again = rw.load(tmp_path / "p")
    bare = rw.run("pendulum", duration="0.2 s")
    assert again.folder == run.folder == tmp_path / "p"
    for name in run:
        assert np.array_equal(run[name], again[name]) and np.array_equal(run[name], bare[name])
    assert again.summary == run.summary and again.units == run.units and again.scene == run.scene == bare.scene
    assert bare.summary["counts"] == run.summary["counts"] and bare.summary["energy"] == run.summary["energy"]
    with pytest.raises(rw.OutputError, match="not empty"):
        rw.run("pendulum", out=tmp_path / "p")
    with pytest.raises(rw.OutputError):
        rw.load(tmp_path / "nothing")


def test_a_run_can_be_pickled():
    run = rw.run("pendulum", duration="0.1 s")
    again = pickle.loads(pickle.dumps(run))
    assert all(np.array_equal(run[name], again[name]) for name in run) and again.summary == run.summary


def test_pandas_has_units_and_time():
    pytest.importorskip("pandas")
    run = rw.run("pendulum", duration="0.1 s")
    frame = run.to_pandas()
    assert frame.index.name == "t" and frame.attrs["units"]["cable.end.z"] == "m"
    assert np.array_equal(frame["cable.end.z"], run["cable.end.z"])


def test_a_notebook_shows_summary_and_curves():
    text = rw.run("pendulum", duration="0.1 s")._repr_html_()
    assert "A flexible pendulum" in text and "finished" in text and "<polyline" in text and "nan" not in text


def test_statics_run_over_the_load_factor():
    run = rw.run("cantilever")
    assert next(iter(run)) == "load factor" and run.t[-1] == 1.0


def test_a_process_runs_too():
    run = rw.run("unwinding-paper", duration="0.02 s")
    assert run.status == "finished" and len(run.t) > 2


def test_others_compute_meanwhile():
    ticks = []
    stop = threading.Event()

    def tick():
        while not stop.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    rw.run("hose-turn")
    stop.set()
    thread.join()
    # a run that kept the interpreter would leave one long gap and no ticks
    assert len(ticks) > 20


def test_two_runs_at_a_time_are_the_same():
    runs = []
    threads = [threading.Thread(target=lambda: runs.append(rw.run("pendulum", duration="0.3 s"))) for _ in range(4)]
    [t.start() for t in threads]
    [t.join() for t in threads]
    assert len(runs) == 4 and all(np.array_equal(r["cable.end"], runs[0]["cable.end"]) for r in runs)


def test_plot_draws_by_unit():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    run = rw.run("pendulum", duration="0.1 s")
    axes = run.plot("cable.end")
    assert len(np.atleast_1d(axes).ravel()[0].lines) >= 2


def test_what_there_is():
    assert "hose-turn" in rw.list() and rw.list()["pendulum"].startswith("A flexible pendulum")
    assert "ei" in rw.describe("cable") and "speed" in rw.describe("hose-turn")
    with pytest.raises(rw.SceneError, match="did you mean"):
        rw.describe("cabel")


def test_check_tells_what_a_scene_consists_of():
    checked = rw.check("hose-turn", speed="3 kn")
    assert checked["unknowns"] > 60 and "hose" in str(checked) and checked["unused"] == []
    assert pickle.loads(pickle.dumps(checked)) == checked


def test_modes_of_a_string():
    # a taut string: f = n/2L sqrt(T/m)
    scene = rw.Scene(title="A string")
    section = dict(mass="0.1 kg/m", ea="1 MN", ei="1e-6 N m^2")
    string = scene.cable(name="string", points=[[0, 0, 0], [2, 0, 0]], tension="100 N", elements=32, section=section)
    scene.spherical(name="a", marker=string.start)
    scene.spherical(name="b", marker=string.end)
    modes = rw.modes(scene, count=4)
    expected = np.sqrt(100 / 0.1) / (2 * 2) * np.array([1, 1, 2, 2])
    assert modes.frequency == pytest.approx(expected, rel=1e-3)
    assert modes.shapes.shape == (4, 33, 3) and modes.rest.shape == (33, 3) and not modes.unstable
    for wrong in (dict(count=0), dict(count=-1), dict(at=float("nan"))):
        with pytest.raises(rw.SceneError):
            rw.modes(scene, **wrong)
