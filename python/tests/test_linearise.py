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


def test_what_can_not_be_is_said():
    with pytest.raises(rw.SceneError, match="not 'end'"):
        rw.linearise("pendulum", at="end")
