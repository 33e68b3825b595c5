"""Linearised equations as NumPy and SciPy see them."""

import numpy as np
import pytest

import ropewalk as rw

OSCILLATOR = {
    "run": {"duration": 1, "output": 0.1},
    "gravity": [0, 0, 0],
    "inputs": [{"name": "push", "unit": "N"}],
    "elements": [{"type": "point_mass", "name": "ball", "marker": [1, 0, 0], "mass": 2}],
    "forces": [
        {"type": "spring", "name": "s", "marker": "ball", "to": [0, 0, 0], "stiffness": 50, "damping": 3, "length": 1},
        {"type": "point_force", "marker": "ball", "force": [{"input": "push"}, 0, 0]},
    ],
    "records": [{"type": "position", "of": "ball"}],
}


def test_an_oscillator_has_its_matrices():
    l = rw.linearise(OSCILLATOR, at="start")
    x = l.unknowns.index(next(u for u in l.unknowns if u.endswith("x")))
    assert l.M.toarray()[x, x] == pytest.approx(2) and l.C.toarray()[x, x] == pytest.approx(3)
    assert l.K.toarray()[x, x] == pytest.approx(50) and l.B.toarray()[x, 0] == pytest.approx(1)
    assert l.inputs == {"push": "N"} and list(l.outputs) == ["ball.x", "ball.y", "ball.z"]
    assert l.Yq.toarray()[0, x] == pytest.approx(1)


def test_frequencies_are_those_of_the_modes():
    scene, count = "pendulum", 4
    l = rw.linearise(scene)
    basis = l.null_space()
    mass, stiffness = (basis.T @ m.toarray() @ basis for m in (l.M, l.K))
    omega2 = np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)
    found = np.sqrt(np.unique(np.round(omega2[: 4 * count], 6))) / (2 * np.pi)
    for f in rw.modes(scene, count=count).frequency:
        assert np.min(np.abs(found / f - 1)) < 1e-4, f


def test_a_prescribed_speed_carries_what_hangs_on_it_along():
    mass, stiffness, damping = 2.0, 50.0, 3.0
    scene = rw.Scene(title="A mass behind a cart whose speed is an input", gravity=[0, 0, 0])
    scene.add_input(name="speed", unit="m/s", join="linear")
    cart = scene.point_mass(name="cart", marker=[0, 0, 0], mass="1 kg")
    ball = scene.point_mass(name="ball", marker=[-1, 0, 0], mass=mass)
    scene.input(name="run", speed="speed")
    scene.driving(name="drive", marker=cart, motion="run")
    scene.spring(name="s", marker=ball, to=cart, stiffness=stiffness, damping=damping, length=1)
    scene.position(of=ball)
    scene.set_run(duration="2 s")
    l = rw.linearise(scene, at="start")
    r = l.reduced()
    assert r.Z.shape == (6, 3) and l.G.shape == (3, 6)
    x = {name: l.unknowns.index(f"`{name}`, position x") for name in ("cart", "ball")}
    # the cart goes where its speed leads, and is no unknown any more
    assert r.V[x["cart"], 0] == pytest.approx(1) and np.abs(r.Z[x["cart"]]).max() < 1e-12
    # m x'' + c x' + k x = c u + k ∫u: what the ball does at any complex frequency
    for s in (0.3 + 1j, 2j, 5.5j, -0.4 + 9j):
        w = np.linalg.solve(r.M * s**2 + r.C * s + r.K, (r.B + r.rate * s + r.integral / s)[:, 0])
        found = (r.Z @ w + r.V[:, 0] / s)[x["ball"]]
        exact = (damping * s + stiffness) / (s * (mass * s**2 + damping * s + stiffness))
        assert abs(found - exact) < 1e-8 * abs(exact), s
    # and in the simulation: at rest, then up to 0.01 m/s within a second, and on
    sim = rw.Simulation(scene)
    sim.set_input("speed", 0.01).advance(1.0)
    sim.advance(1.0)
    ramp = lambda t: np.where(t < 1, 0.005 * t * t, 0.01 * t - 0.005)
    rate = lambda t: np.where(t < 1, 0.01 * t, 0.01)
    n, h = 20000, 1e-4
    state = np.zeros(2)
    push = lambda t, y: np.array([y[1], (damping * (rate(t) - y[1]) + stiffness * (ramp(t) - y[0])) / mass])
    for k in range(n):
        t = k * h
        a = push(t, state)
        b = push(t + h / 2, state + h / 2 * a)
        c = push(t + h / 2, state + h / 2 * b)
        state = state + h / 6 * (a + 2 * b + 2 * c + push(t + h, state + h * c))
    assert sim["ball.x"] + 1 == pytest.approx(state[0], rel=1e-3)


def test_what_can_not_be_is_said():
    with pytest.raises(rw.SceneError, match="not 'end'"):
        rw.linearise("pendulum", at="end")
