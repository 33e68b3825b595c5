"""Scenes as FMUs, driven by a client that knows nothing of Ropewalk."""

import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
import pytest

import ropewalk as rw

fmpy = pytest.importorskip("fmpy")
from fmpy.fmi3 import FMU3Slave  # noqa: E402

ROOT = pathlib.Path(__file__).parents[2]
LIBRARY = pathlib.Path(os.environ.get("ROPEWALK_FMU", ROOT / "target/release/libropewalk_fmu.so"))

# a ball that a force pushes
BALL = """
[parameters]
mass = { default = "2 kg", description = "mass of the ball" }
[[inputs]]
name = "push"
unit = "N"
join = "linear"
[run]
duration = "10 s"
output = "0.1 s"
[solver]
stepping = { controlled = { tolerance = 1e-8 } }
[[elements]]
type = "point_mass"
name = "ball"
marker = [1, 0, 0]
mass = "$mass"
[[forces]]
type = "point_force"
marker = "ball"
force = [{ input = "push" }, 0, 0]
[[records]]
type = "position"
of = "ball"
[[records]]
type = "velocity"
of = "ball"
"""


def export(tmp_path: pathlib.Path, scene: str, *more: str) -> pathlib.Path:
    out = tmp_path / "scene.fmu"
    command = [sys.executable, "-m", "ropewalk", "export-fmu", scene, "--out", str(out), "--library", str(LIBRARY)]
    said = subprocess.run([*command, *more], cwd=tmp_path, capture_output=True, text=True)
    assert said.returncode == 0, said.stderr
    return out


def test_the_wheel_brings_the_library(tmp_path):
    from ropewalk import _fmu

    if _fmu.library() is None:
        pytest.skip("this wheel was built without: python python/tools/wheel.py")
    made = rw.export_fmu("pendulum", tmp_path / "p.fmu", duration="0.5 s")
    assert made == tmp_path / "p.fmu" and fmpy.read_model_description(str(made)).modelName
    command = [sys.executable, "-m", "ropewalk", "export-fmu", "pendulum", "--out", str(tmp_path / "q.fmu")]
    said = subprocess.run(command, capture_output=True, text=True)
    assert said.returncode == 0 and (tmp_path / "q.fmu").exists(), said.stderr


def test_functions_stay_here(tmp_path):
    scene = rw.Scene(title="A ball that Python pushes")
    ball = scene.point_mass(name="ball", marker=[0, 0, 0], mass=1)
    scene.function(function=lambda t: [t, 0, 0], marker=ball)
    with pytest.raises(rw.SceneError, match="can't take along"):
        rw.export_fmu(scene, tmp_path / "p.fmu", library=__file__)


@pytest.fixture
def ball(tmp_path):
    if not LIBRARY.exists():
        pytest.skip(f"{LIBRARY} is not built: cargo build --release -p ropewalk-fmu")
    (tmp_path / "ball.toml").write_text(BALL)
    return export(tmp_path, "ball.toml")


class Instance:
    """An instance by the names of its variables."""

    def __init__(self, path, inputs=None, **parameters):
        about = fmpy.read_model_description(str(path), validate=True)
        self.folder = fmpy.extract(str(path))
        self.number = {v.name: v.valueReference for v in about.modelVariables}
        self.fmu = FMU3Slave(
            guid=about.guid,
            unzipDirectory=self.folder,
            modelIdentifier=about.coSimulation.modelIdentifier,
            instanceName="one",
        )
        self.fmu.instantiate()
        for name, value in parameters.items():
            self.fmu.setString([self.number[name]], [value])
        for name, value in (inputs or {}).items():
            self.fmu.setFloat64([self.number[name]], [value])
        self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()
        self.t = 0.0

    def __getitem__(self, name):
        return self.fmu.getFloat64([self.number[name]])[0]

    def __setitem__(self, name, value):
        self.fmu.setFloat64([self.number[name]], [value])

    def step(self, h):
        self.fmu.doStep(currentCommunicationPoint=self.t, communicationStepSize=h)
        self.t += h

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder)


def test_the_client_finds_nothing_wrong(ball):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(ball)) == []
    about = fmpy.read_model_description(str(ball))
    kinds = {v.name: (v.causality, v.unit) for v in about.modelVariables}
    assert kinds["push"] == ("input", "N") and kinds["ball.x"] == ("output", "m")
    assert kinds["mass"][0] == "parameter" and kinds["time"] == ("independent", "s")


def test_a_run_by_the_client_is_that_of_the_program(ball, tmp_path):
    sim = rw.Simulation(str(tmp_path / "ball.toml"), mass="3 kg")
    one = Instance(ball, mass="3 kg")
    for k in range(50):
        push = float(np.sin(0.3 * k))
        sim.set_input("push", push)
        one["push"] = push
        one.step(0.1)
        sim.advance(to=one.t)
    assert one["ball.x"] == sim["ball.x"] and one["ball.vx"] == sim["ball.vx"]
    assert one["time"] == pytest.approx(5.0)
    one.close()


def test_a_state_leads_back(ball):
    one = Instance(ball)
    one["push"] = 1.0
    one.step(1.0)
    state = one.fmu.getFMUState()
    data = one.fmu.serializeFMUState(state)
    one["push"] = -1.0
    one.step(1.0)
    after = one["ball.x"]
    for saved in (state, one.fmu.deserializeFMUState(data)):
        one.fmu.setFMUState(saved)
        one.t = 1.0
        one["push"] = -1.0
        one.step(1.0)
        assert one["ball.x"] == after
        one.fmu.freeFMUState(saved)
    one.close()


def energy_error(ball, h):
    """A spring between two masses, one in the FMU, one here: energy that a coupling by iterated steps makes or loses."""
    stiffness, mass, other = 8.0, 2.0, 1.0
    x, v = 0.0, 0.0  # the other mass; at rest the spring is 0.5 m long, and the ball is at x = 1 m
    pull = stiffness * (1.0 - x - 0.5)
    one = Instance(ball, inputs={"push": -pull})

    def energy():
        spring = 0.5 * stiffness * (one["ball.x"] - x - 0.5) ** 2
        return spring + 0.5 * mass * one["ball.vx"] ** 2 + 0.5 * other * v**2

    first, worst = energy(), 0.0
    for _ in range(round(4.0 / h)):
        state, t = one.fmu.getFMUState(), one.t
        new = pull
        for _ in range(8):
            one.fmu.setFMUState(state)
            one.t = t
            one["push"] = -new
            one.step(h)
            # the other mass under a force that is linear in time
            x1 = x + h * v + h * h * (pull / 3 + new / 6) / other
            v1 = v + h * (pull + new) / 2 / other
            new = stiffness * (one["ball.x"] - x1 - 0.5)
        one.fmu.freeFMUState(state)
        x, v, pull = x1, v1, new
        worst = max(worst, abs(energy() - first))
    one.close()
    return worst / first


def test_a_coupled_spring_and_mass_keep_their_energy_to_second_order(ball):
    coarse, fine = energy_error(ball, 0.1), energy_error(ball, 0.05)
    assert coarse < 0.02
    assert 3.0 < coarse / fine < 5.5


def test_what_is_wrong_is_said(ball, tmp_path):
    one = Instance(ball)
    with pytest.raises(Exception):
        one.fmu.doStep(currentCommunicationPoint=3.0, communicationStepSize=0.1)
    one.close()
    with pytest.raises(Exception):
        Instance(ball, mass="-2 kg")
