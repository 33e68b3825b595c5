import pickle
import threading

import numpy as np
import pytest
import ropewalk as rw


def test_steps_come_to_where_a_run_ends(weight):
    weight.set_solver(stepping={"fixed": {"h": 0.01}})
    run, sim = rw.run(weight), rw.Simulation(weight)
    for k in range(1, 21):
        sim.advance(to=0.1 * k)
        # Newton's method stops elsewhere, since it predicts from other steps
        assert sim["weight"] == pytest.approx(run["weight"][k], abs=1e-6)
    assert sim.done and sim.stopped_by is None and sim.t == 2.0
    assert sim.values["weight.x"] == sim["weight.x"] and sim.units["weight.x"] == "m"
    assert sim["hook.fz"] == pytest.approx(run["hook.fz"][-1], rel=1e-4)


def test_one_step_is_one_step_of_the_solver(weight):
    sim = rw.Simulation(weight)
    for k in range(1, 6):
        before = sim.t
        assert sim.step().t > before and sim.steps == k
    while not sim.done:
        sim.step()
    assert sim.t == 2.0 and sim.step().t == 2.0


def test_advance_goes_to_the_end_and_not_beyond(weight):
    sim = rw.Simulation(weight)
    while not sim.done:
        sim.advance(0.3)
    assert sim.t == 2.0 and sim.advance(1.0).t == 2.0


@pytest.mark.parametrize("wrong", [dict(dt=-1), dict(dt=float("nan")), dict(to=float("inf")), dict(to=0.1), dict(to=9)])
def test_times_that_make_no_sense_are_refused(weight, wrong):
    sim = rw.Simulation(weight).advance(0.5)
    with pytest.raises(rw.SceneError):
        sim.advance(**wrong)
    with pytest.raises(TypeError):
        sim.advance()
    with pytest.raises(KeyError):
        sim["nothing"]
    assert sim.t == 0.5


@pytest.mark.parametrize("scene", ["hose-turn", "pendulum"])
def test_a_state_goes_on_to_the_last_bit(scene):
    sim = rw.Simulation(scene).advance(0.2)
    state = pickle.loads(pickle.dumps(sim.state()))
    assert state.t == sim.t
    first = [tuple(sim.advance(0.05).values.values()) for _ in range(8)]
    again = [tuple(sim.advance(0.05).values.values()) for _ in range(8) if sim.restore(state) or True][:1]
    assert again[0] == first[0]
    sim.restore(state)
    assert [tuple(sim.advance(0.05).values.values()) for _ in range(8)] == first
    other = rw.Simulation(scene).restore(state)
    assert [tuple(other.advance(0.05).values.values()) for _ in range(8)] == first


def test_looking_changes_nothing(weight):
    silent, looked = rw.Simulation(weight), rw.Simulation(weight)
    for _ in range(10):
        silent.advance(0.1)
        looked.advance(0.1)
        looked.values
        looked["weight"]
    assert silent.values == looked.values


def test_states_of_others_are_refused(weight):
    state = rw.Simulation(weight).state()
    sim = rw.Simulation("pendulum")
    with pytest.raises(rw.SceneError, match="another model"):
        sim.restore(state)
    with pytest.raises(rw.SceneError, match="no state"):
        sim.restore(type(state)(0.0, b"nonsense"))
    assert sim.advance(0.01).t == 0.01


def test_events_stop_it():
    scene = rw.Scene(title="run out")
    line = scene.cable(name="line", points=[[0, 0, 0], [0, 0, -4]], elements=4, section=dict(mass=1, ea=1e4, ei=0.1))
    scene.spherical(name="hook", marker=line.start)
    scene.winch(name="winch", marker=line.start, speed="0.5 m/s", stored_length="1 m")
    scene.gravity()
    scene.length(of=line)
    scene.set_run(duration="20 s")
    run, sim = rw.run(scene), rw.Simulation(scene)
    while not sim.done:
        sim.advance(0.5)
    assert run.status == "stopped" and run.summary["message"] == f"stopped by {sim.stopped_by}"
    assert sim.t == pytest.approx(run.t[-1], abs=1e-3) and sim.t < 5
    before = sim.t
    assert sim.advance(1.0).t == before


def test_a_winch_changes_the_mesh_while_it_is_looked_at():
    run = rw.run("hose-straight", duration="60 s", winding="0.5 m/s")
    sim = rw.Simulation("hose-straight", duration="60 s", winding="0.5 m/s")
    state = None
    while not sim.done:
        sim.advance(5.0)
        state = sim.state() if state is None and sim.t > 30 else state
    assert sim["hose.end.z"] == pytest.approx(run["hose.end.z"][-1], abs=0.05)
    end = sim.values
    sim.restore(state)
    while not sim.done:
        sim.advance(5.0)
    assert sim.values == end


def test_what_is_no_run_in_time_has_no_steps():
    with pytest.raises(rw.SceneError, match="no run in time"):
        rw.Simulation("cantilever")


def test_a_process_reads_inputs():
    package = dict(radius="60 mm", length="0.1 m", diameter="1 mm", origin=[0, 0, "0.1 m"])
    scene = rw.Scene(title="A cable drawn off a package")
    scene.add_input(name="speed", unit="m/s", join="linear")
    scene.input(name="draw", speed="speed")
    scene.unwound_cable(name="c", mass="1 g/m", motion="draw", rule={"tension": {"tension": "1 N"}}, package=package)
    scene.set_run(duration="50 ms", output="5 ms")
    sim = rw.Simulation(scene)
    assert sim.inputs == {"speed": 0.0}
    wound = sim["c.length.free"]
    sim.set_input("speed", 0.4).advance(0.01)
    assert sim.t == 0.01 and sim["c.speed.drawn"] == pytest.approx(0.4, abs=1e-12)
    while not sim.done:
        sim.advance(0.015)
    way = 0.4 * (0.005 + 0.04)
    assert sim["c.length.peeled"] == pytest.approx(way + sim["c.length.free"] - wound, abs=1e-9)
    assert sim.steps > 100
    with pytest.raises(rw.SceneError, match="keeps no state"):
        sim.state()


def test_many_go_on_in_threads():
    sims = [rw.Simulation("pendulum") for _ in range(3)]
    threads = [threading.Thread(target=lambda s=s: [s.advance(0.01) for _ in range(20)]) for s in sims]
    [t.start() for t in threads]
    [t.join() for t in threads]
    assert sims[0].values == sims[1].values == sims[2].values


def test_one_simulation_in_two_threads_is_whole():
    sim = rw.Simulation("pendulum")
    threads = [threading.Thread(target=lambda: [sim.advance(0.001) or sim["cable.end.z"] for _ in range(50)]) for _ in "ab"]
    [t.start() for t in threads]
    [t.join() for t in threads]
    assert 0.05 <= sim.t <= 0.101 and np.isfinite(sim["cable.end"]).all()
