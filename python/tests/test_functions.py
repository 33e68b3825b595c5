"""Forces and motions written in Python, against the built-in types that do the same."""

import copy
import gc
import json
import pickle
import subprocess
import sys
import threading
import time
import traceback
import weakref

import numpy as np
import pytest
import ropewalk as rw

ROPE = dict(mass="0.4 kg/m", ea="50 kN", ei=0.5, diameter="20 mm")


def same(a: rw.Run, b: rw.Run, *names: str) -> None:
    """Equal to a millionth of what moves."""
    for name in names:
        assert np.abs(a[name] - b[name]).max() < 1e-6 * max(np.ptp(b[name]), 1e-3), name


def bob(force) -> rw.Scene:
    """A mass that swings about a point."""
    scene = rw.Scene(title="A bob")
    mass = scene.point_mass(name="bob", marker=["1 m", 0, 0], mass="2 kg", velocity=[0, "1 m/s", 0])
    scene.gravity()
    force(scene, mass)
    scene.position(of=mass)
    scene.set_solver(stepping={"fixed": {"h": 2e-3}})
    scene.set_run(duration="1.5 s", output="0.05 s")
    return scene


def test_a_spring_is_a_spring():
    def spring(position, velocity, stiffness, length=0.5):
        far = np.linalg.norm(position)
        along = position / far
        return -(stiffness * (far - length) + 1.5 * along @ velocity) * along

    def ours(scene, mass):
        scene.function(function=spring, marker=mass, parameters=dict(stiffness="80 N/m"), name="spring")
        scene.force(of="spring")

    def theirs(scene, mass):
        scene.spring(name="spring", marker=mass, to=[0, 0, 0], stiffness="80 N/m", damping=1.5, length="0.5 m")

    a, b = rw.run(bob(ours)), rw.run(bob(theirs))
    same(a, b, "bob.x", "bob.y", "bob.z")
    # Newton's method finds it as well as with the exact derivatives
    assert a.summary["counts"]["newton_iterations"] < 1.1 * b.summary["counts"]["newton_iterations"] + 5
    assert a["spring.fx"][0] == pytest.approx(-80 * 0.5)
    # all of its work is accounted for
    energy = a.summary["energy"]
    assert abs(energy["imbalance"]) < 1e-4 * abs(energy["supplied"]) and energy["supplied"] != 0


def test_resistance_along_a_cable_is_drag():
    density, cn, ct = 1025.0, 1.1, 0.02

    def drag(velocity, slope, diameter):
        stretch = np.linalg.norm(slope, axis=1, keepdims=True)
        t = slope / stretch
        along = (velocity * t).sum(axis=1, keepdims=True)
        across = velocity - along * t
        d = diameter[:, None]
        normal = 0.5 * density * cn * d * np.linalg.norm(across, axis=1, keepdims=True) * across
        return -normal - 0.5 * density * np.pi * ct * d * abs(along) * along * t

    def scene(force) -> rw.Scene:
        scene = rw.Scene(title="A rope that falls in water")
        line = scene.cable(name="line", points=[[0, 0, 0], ["5 m", 0, 0]], elements=8, section=ROPE)
        scene.spherical(name="hook", marker=line.start)
        scene.gravity()
        force(scene)
        scene.position(of=line.end)
        scene.set_water(density=density)
        scene.set_solver(stepping={"fixed": {"h": 2e-3}})
        scene.set_run(duration="1 s", output="0.1 s")
        return scene

    ours = scene(lambda scene: scene.function(function=drag, on=["line"]))
    theirs = scene(lambda scene: scene.drag(cn=cn, ct=ct))
    a, b = rw.run(ours), rw.run(theirs)
    same(a, b, "line.end.x", "line.end.z")
    assert a.summary["counts"]["newton_iterations"] < 1.2 * b.summary["counts"]["newton_iterations"] + 5


@pytest.mark.parametrize("derivatives", [0, 1, 2])
def test_a_motion_is_a_motion(derivatives):
    amplitude, w = np.array([0.2, 0.0, 0.05]), 2 * np.pi * 0.8

    def sway(t):
        x, v, a = amplitude * np.sin(w * t), w * amplitude * np.cos(w * t), -(w**2) * amplitude * np.sin(w * t)
        return [x, (x, v), (x, v, a)][derivatives]

    def scene(motion) -> rw.Scene:
        scene = rw.Scene(title="A pendulum on a shaken hook")
        rod = scene.cable(name="rod", points=[[0, 0, 0], [0, 0, "-1 m"]], elements=2, section=ROPE,
                          velocity=(w * amplitude).tolist())
        motion(scene)
        scene.driving(name="hook", marker=rod.start, motion="sway")
        scene.gravity()
        scene.position(of=rod.end)
        scene.reaction(of="hook")
        scene.set_solver(stepping={"fixed": {"h": 2e-3}})
        scene.set_run(duration="2 s", output="0.1 s")
        return scene

    a = rw.run(scene(lambda scene: scene.function_motion(name="sway", function=sway)))
    b = rw.run(scene(lambda scene: scene.harmonic(name="sway", amplitude=amplitude, frequency="0.8 Hz", ramp=0)))
    same(a, b, "rod.end.x", "rod.end.z")
    assert a["hook.fz"] == pytest.approx(b["hook.fz"], rel=1e-4, abs=1e-3)
    assert a.summary["energy"]["supplied"] == pytest.approx(b.summary["energy"]["supplied"], rel=1e-5)


def test_a_body_is_pushed_and_turned_in_its_own_axes():
    force, arm = np.array([3.0, -1.0, 2.0]), "thruster"

    def thrust(attitude, angular_velocity):
        return attitude @ force, -0.4 * angular_velocity

    def scene(forces) -> rw.Scene:
        scene = rw.Scene(title="A drone")
        body = scene.rigid_body(
            name="drone", position=[0, 0, 0], mass="3 kg", inertia=[0.2, 0.3, 0.4], points={arm: [0.5, 0.1, 0]},
            angular_velocity=[0.5, 1.0, -0.5],
        )
        forces(scene, body)
        scene.position(of=body)
        scene.set_solver(stepping={"fixed": {"h": 2e-3}})
        scene.set_run(duration="1 s", output="0.1 s")
        return scene

    def theirs(scene, body):
        scene.point_force(marker=body.point(arm), force=force, local=True)
        # the same slowing as a moment that is set from outside doesn't exist: without it
        scene.function(function=lambda angular_velocity: ([0, 0, 0], -0.4 * angular_velocity), marker=body)

    a = rw.run(scene(lambda scene, body: scene.function(function=thrust, marker=body.point(arm))))
    same(a, rw.run(scene(theirs)), "drone.x", "drone.y", "drone.z")


@rw.function("tug-of-test")
def tug(position, stiffness=30.0):
    return [0, 0, -stiffness * position[2]]


def test_a_registered_function_is_a_type(tmp_path):
    def scene(force) -> dict:
        return {
            "title": "A bob",
            "elements": [{"type": "point_mass", "name": "bob", "marker": [0, 0, 1], "mass": 2}],
            "forces": [force],
            "records": [{"type": "position", "of": "bob"}],
            "run": {"duration": 1},
        }

    a = rw.run(scene({"type": "tug-of-test", "marker": "bob", "stiffness": "40 N/m"}))
    same(a, rw.run(scene({"type": "spring", "name": "s", "marker": "bob", "to": [0, 0, 0], "stiffness": 40,
                          "length": 0})), "bob.z")
    file = tmp_path / "scene.toml"
    file.write_text(a.scene)
    assert 'function = "tug-of-test"' in a.scene and rw.run(file).final == a.final
    with pytest.raises(rw.SceneError, match="has no parameter `stifness`; did you mean `stiffness`"):
        rw.run(scene({"type": "tug-of-test", "marker": "bob", "stifness": 1}))
    # in another process nobody knows it
    for command in (["-m", "ropewalk", "check", str(file)], ["-c", f"import ropewalk; ropewalk.run({str(file)!r})"]):
        other = subprocess.run([sys.executable, *command], capture_output=True, text=True)
        assert other.returncode != 0 and "no function `tug-of-test` in this process" in other.stderr, other.stderr
        assert "scene.toml" in other.stderr


def failing(t, position):
    if t > 0.3:
        raise ZeroDivisionError("no wind left")
    return [0, 0, 2 * 9.81]


def test_an_exception_ends_the_run_and_is_its_cause(tmp_path):
    scene = bob(lambda scene, mass: scene.function(function=failing, marker=mass))
    for more in ({}, {"out": tmp_path / "run"}):
        with pytest.raises(rw.FunctionError) as e:
            rw.run(scene, **more)
        assert isinstance(e.value, rw.SolverError) and isinstance(e.value.__cause__, ZeroDivisionError)
        text = "".join(traceback.format_exception(e.value))
        assert "no wind left" in text and "in failing" in text and "test_functions.py" in text
        assert "the function `failing` raised ZeroDivisionError: no wind left, in line" in str(e.value)
        run = e.value.run
        assert run is not None and run.status == "failed" and 0.2 < run.t[-1] <= 0.3
    assert rw.load(tmp_path / "run").status == "failed"
    again = pickle.loads(pickle.dumps(e.value))
    assert type(again) is rw.FunctionError and str(again) == str(e.value)

    sim = rw.Simulation(scene).advance(to=0.25)
    for _ in range(2):
        with pytest.raises(rw.FunctionError):
            sim.advance(to=1.0)
        # the state is that of the last good step
        assert 0.25 <= sim.t <= 0.3 and np.isfinite(sim["bob"]).all()
    scene.set_run(analysis="statics")
    with pytest.raises(rw.FunctionError):
        rw.run(bob(lambda scene, mass: scene.function(function=lambda position: 1 / 0, marker=mass)))


def test_what_is_no_number_is_refused_with_name_and_time():
    def gone(t):
        return [0, 0, np.nan if t > 0.3 else 1.0]

    scene = bob(lambda scene, mass: scene.function(function=gone, marker=mass))
    with pytest.raises(rw.FunctionError, match=r"at t = 0\.3\d+ s the function `gone` gave what is no finite number"):
        rw.run(scene)
    for wrong, words in [
        (lambda t: None, "returned None"),
        (lambda t: "up", "numbers are expected"),
        (lambda t: [1.0, 2.0], "a force has 3 numbers"),
        (lambda s: [0, 0, 0], "there is no `s` here"),
    ]:
        with pytest.raises(rw.FunctionError, match=words):
            rw.run(bob(lambda scene, mass: scene.function(function=wrong, marker=mass)))
    with pytest.raises(rw.SceneError, match="only bodies have"):
        rw.run(bob(lambda scene, mass: scene.function(function=lambda attitude: [0, 0, 0], marker=mass)))
    with pytest.raises(rw.SceneError, match="needs the parameter `k`"):
        rw.run(bob(lambda scene, mass: scene.function(function=lambda position, k: [0, 0, 0], marker=mass)))
    with pytest.raises(TypeError, match="name each argument"):
        rw.function("all")(lambda *a: [0, 0, 0])


def test_ctrl_c_inside_a_function_is_ctrl_c():
    def stop(t):
        if t > 0.3:
            raise KeyboardInterrupt
        return [0, 0, 0]

    scene = bob(lambda scene, mass: scene.function(function=stop, marker=mass))
    with pytest.raises(KeyboardInterrupt) as e:
        rw.run(scene)
    assert e.value.run.t[-1] > 0.2
    with pytest.raises(KeyboardInterrupt):
        rw.Simulation(scene).advance(to=1.0)


def test_other_threads_go_on_and_several_runs_share_a_function(tmp_path):
    def slow(position, stiffness=10.0):
        time.sleep(1e-4)
        return -stiffness * position

    scene = bob(lambda scene, mass: scene.function(function=slow, marker=mass, parameters={"stiffness": "$k"}))
    scene.parameter("k", 10.0)
    counted, over = [0], threading.Event()

    def count():
        while not over.is_set():
            counted[0] += 1
            time.sleep(1e-3)

    thread = threading.Thread(target=count)
    thread.start()
    rows = rw.sweep(scene, {"k": [5.0, 10.0, 20.0, 40.0]}, out=tmp_path / "sweep", jobs=2)
    over.set()
    thread.join()
    assert not rows.failed and counted[0] > 50
    for row in rows:
        assert row["bob.z"] == rw.run(scene, k=row["k"]).final["bob.z"]


def test_a_sweep_tells_functions_of_one_name_apart(tmp_path):
    def sweep(factor: float):
        @rw.function("pull-of-test")
        def pull(position, k):
            return -factor * k * position

        scene = bob(lambda scene, mass: scene.add("forces", "pull-of-test", marker=mass, k="$k"))
        scene.parameter("k", 10.0)
        return rw.sweep(scene, {"k": [5.0, 10.0]}, out=tmp_path / "sweep")["bob.z"]

    first = sweep(1.0)
    assert (sweep(1.0) == first).all() and (sweep(2.0) != first).all()


class Big:
    """Something that one wants to get rid of."""


def held(pull) -> rw.Scene:
    return bob(lambda scene, mass: scene.function(function=pull, marker=mass, name="pull"))


def test_a_function_is_forgotten_with_what_holds_it():
    def make(thing):
        def pull(position):
            return -10.0 * position if thing else [0, 0, 0]

        return pull

    finals, gone = set(), []
    for k in range(20):
        thing = Big()
        gone.append(weakref.ref(thing))
        scene = held(make(thing))
        other = copy.deepcopy(scene)
        del scene, thing
        gc.collect()
        # the copy holds it still, by its own name: that of the one before is free again
        assert gone[-1]() is not None and '"function": "pull"' in json.dumps(other.to_dict())
        sim = rw.Simulation(other).advance(0.1)
        finals.add(rw.run(other).final["bob.z"])
        del other
        # a simulation keeps what it was built with
        finals.add(sim.advance(to=1.5)["bob"][2])
        del sim
        gc.collect()
    assert all(thing() is None for thing in gone) and len(finals) <= 2
    with pytest.raises(rw.SceneError, match="no function `pull` in this process"):
        rw.run(bob(lambda scene, mass: scene.add("forces", "function", function="pull", marker=mass)))
    # of a dict the dict holds it; a method is held as well
    class Puller(Big):
        def pull(self, position):
            return -10.0 * position

    puller = Puller()
    gone.append(weakref.ref(puller))
    data = held(puller.pull).to_dict()
    del data["forces"][-1]
    data["forces"].append({"type": "function", "function": puller.pull, "marker": "bob"})
    assert rw.run(data).final["bob.z"] in finals
    del data, puller
    gc.collect()
    assert gone[-1]() is None
    # a scene that was sent elsewhere has the names alone
    scene = held(make(Big()))
    assert pickle.loads(pickle.dumps(scene)).to_dict() == scene.to_dict()


def test_a_function_that_refers_to_its_own_simulation_goes_with_it():
    def run() -> tuple[weakref.ref, weakref.ref]:
        mine: list[rw.Simulation] = []

        def pull(t, position):
            return -10.0 * (position if not mine or mine[0].t >= 0.0 else 0.0 * position)

        sim = rw.Simulation(held(pull))
        # the scene is gone: the simulation alone keeps the function
        gc.collect()
        assert sim.advance(0.1)["bob"].shape == (3,)
        mine.append(sim)
        return weakref.ref(sim), weakref.ref(pull)

    gone = run()
    gc.collect()
    assert all(thing() is None for thing in gone)


def test_functions_that_come_and_go_in_threads_are_not_mixed_up():
    def one(factor: float) -> None:
        for _ in range(5):
            scene = held(lambda position: -factor * position)
            assert rw.run(scene).final["bob.z"] == expected[factor]
            del scene

    factors = [5.0, 10.0, 20.0]
    expected = {factor: rw.run(held(lambda position: -factor * position)).final["bob.z"] for factor in factors}
    failed = []

    def guarded(factor: float) -> None:
        try:
            one(factor)
        except BaseException as e:
            failed.append(e)

    threads = [threading.Thread(target=guarded, args=[factor]) for factor in factors]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed, failed
