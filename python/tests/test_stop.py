"""Ctrl-C, and solvers that give up."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import ropewalk as rw


def interrupt(after: float) -> threading.Timer:
    timer = threading.Timer(after, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    return timer


def test_ctrl_c_ends_a_run_and_works_again(long):
    for _ in range(2):
        timer = interrupt(0.3)
        start = time.monotonic()
        with pytest.raises(KeyboardInterrupt) as e:
            rw.run(**long)
        # it would take a minute; how fast it was is no matter of a test on a busy machine
        assert time.monotonic() - start < 10
        timer.join()
        assert e.value.run.status == "interrupted" and len(e.value.run.t) >= 1
    assert rw.run("pendulum", duration="0.1 s").status == "finished"


def test_ctrl_c_ends_a_run_into_a_folder(long, tmp_path):
    timer = interrupt(0.3)
    with pytest.raises(KeyboardInterrupt):
        rw.run(**long, out=tmp_path / "run")
    timer.join()
    assert rw.load(tmp_path / "run").status == "interrupted"
    # the process is as it was
    assert rw.run("pendulum", duration="0.1 s", out=tmp_path / "next").status == "finished"


def test_ctrl_c_leaves_a_simulation_good(long):
    sim = rw.Simulation(**long)
    timer = interrupt(0.3)
    with pytest.raises(KeyboardInterrupt):
        sim.advance(100)
    timer.join()
    t = sim.t
    assert 0 < t < 100 and not sim.done
    assert sim.step().t > t


def test_own_handlers_are_asked(long):
    class Enough(Exception):
        pass

    def enough(*_):
        raise Enough

    before = signal.signal(signal.SIGINT, enough)
    try:
        timer = interrupt(0.3)
        with pytest.raises(Enough):
            rw.run(**long)
        timer.join()
    finally:
        signal.signal(signal.SIGINT, before)


def test_ctrl_c_ends_a_search_for_an_equilibrium():
    # a long limp cable with many elements takes long to settle
    scene = rw.Scene(title="settles for long")
    section = dict(mass="1 kg/m", ea="1 GN", ei="1e-3 N m^2")
    line = scene.cable(name="line", points=[[0, 0, 0], [900, 0, 0]], length="1000 m", elements=1500, section=section)
    scene.spherical(name="a", marker=line.start)
    scene.spherical(name="b", marker=line.end)
    scene.gravity()
    scene.position(of=line.at("50%"))
    for more in (dict(analysis="statics"), dict(from_equilibrium=True)):
        scene.set_run(duration="1 s", **more)
        timer = interrupt(0.05)
        with pytest.raises(KeyboardInterrupt):
            while True:
                rw.run(scene)
        timer.join()


def test_a_run_in_another_thread_is_stopped_by_a_flag(long):
    stop, runs = rw.Stop(), []
    thread = threading.Thread(target=lambda: runs.append(rw.run(**long, stop=stop)))
    thread.start()
    time.sleep(0.3)
    stop.set()
    thread.join(10)
    assert runs[0].status == "interrupted" and stop.is_set


def failing() -> rw.Scene:
    """Two rods in a row that are pulled longer than they are."""
    scene = rw.Scene(title="pulled apart")
    scene.point_mass(name="elbow", marker=[0.8, 0.6, 0], mass=1)
    scene.point_mass(name="hand", marker=[1.6, 0, 0], mass=1)
    scene.distance(name="upper", marker="elbow", to=[0, 0, 0])
    scene.distance(name="lower", marker="hand", to="elbow")
    scene.straight(name="away", speed="1 m/s", direction=[1, 0, 0], ramp="0.1 s")
    scene.driving(name="pull", marker="hand", motion="away")
    scene.position(of="elbow")
    scene.set_run(duration="5 s", output="0.05 s")
    return scene


def test_what_was_computed_is_kept_when_the_solver_gives_up(tmp_path):
    with pytest.raises(rw.SolverError) as e:
        rw.run(failing())
    run = e.value.run
    assert isinstance(e.value, RuntimeError) and run.status == "failed"
    assert 0 < run.t[-1] < 5 and np.isfinite(run["elbow"]).all() and run.summary["message"] == str(e.value)
    again = pickle.loads(pickle.dumps(e.value))
    assert str(again) == str(e.value) and np.array_equal(again.run["elbow"], run["elbow"])
    with pytest.raises(rw.SolverError):
        rw.run(failing(), out=tmp_path / "failed")
    assert np.array_equal(rw.load(tmp_path / "failed")["elbow"], run["elbow"])


@pytest.mark.parametrize("error", [rw.SceneError("wrong"), rw.OutputError("full"), rw.SolverError("gave up")])
def test_errors_can_be_pickled(error):
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error) and str(again) == str(error)


def test_the_command_line_comes_with_it(tmp_path):
    def command(*arguments: str):
        return subprocess.run([sys.executable, "-m", "ropewalk", *arguments], capture_output=True, text=True)

    assert command("check", "hose-turn").returncode == 0
    wrong = command("run", "nothing")
    assert wrong.returncode == 2 and wrong.stderr.startswith("error: ")
    assert command("--version").stdout.split() == ["ropewalk", rw.__version__]
    assert command("run", "pendulum", "--quiet", "--out", str(tmp_path / "p")).returncode == 0
    assert rw.load(tmp_path / "p").status == "finished"


def test_ctrl_c_ends_the_command_line(tmp_path):
    out = tmp_path / "h"
    arguments = ["-m", "ropewalk", "run", "hose-turn", "--set", "tolerance=1e-9", "--quiet", "--out", str(out)]
    process = subprocess.Popen([sys.executable, *arguments])
    deadline = time.monotonic() + 30
    while not (out / "history.csv").exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    assert process.wait(30) == 130
    assert rw.load(out).status == "interrupted"
