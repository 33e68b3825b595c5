import signal

import pytest
import ropewalk as rw

ROPE = dict(mass="0.4 kg/m", ea="50 kN", ei=0.5, diameter="20 mm")


@pytest.fixture
def weight() -> rw.Scene:
    """A weight on a line in a current."""
    scene = rw.Scene(title="A weight on a line")
    speed = scene.parameter("speed", "2 kn", "current")
    line = scene.cable(name="line", points=[[0, 0, 0], [0, 0, "-10 m"]], elements=8, section=ROPE)
    body = scene.point_mass(name="weight", marker=line.end, mass="8 kg", volume="0.001 m^3")
    scene.spherical(name="hook", marker=line.start)
    scene.gravity()
    scene.buoyancy()
    scene.drag()
    scene.position(of=body)
    scene.reaction(of="hook")
    scene.set_run(duration="2 s", output="0.1 s")
    scene.set_water(current=[speed, 0, 0])
    return scene


@pytest.fixture
def long() -> dict:
    """A run that would take a minute or more."""
    return {"scene": "hose-turn", "tolerance": 1e-9}


@pytest.fixture(autouse=True)
def python_keeps_its_handler():
    handler = signal.getsignal(signal.SIGINT)
    yield
    assert signal.getsignal(signal.SIGINT) is handler
