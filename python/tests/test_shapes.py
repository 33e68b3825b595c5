"""Shapes over time, as arrays."""

import pickle

import numpy as np
import pytest
import ropewalk as rw


def test_shapes_are_arrays_for_each_part(tmp_path, weight):
    weight.rigid_body(name="crate", position=[1, 2, 3], mass="2 kg", inertia=[0.1, 0.2, 0.3],
                      angular_velocity=[0, 0, "90 deg/s"])
    weight.set_run(snapshots=5)
    run = rw.run(weight, out=tmp_path / "run")
    line = run.shapes["line"]
    nt, ns = line.s.shape
    assert nt >= 5 and ns >= 9 and line.position.shape == line.velocity.shape == (nt, ns, 3)
    assert line.t[0] == 0.0 and line.t[-1] == 2.0 and (np.diff(line.s, axis=1) > 0).all()
    assert line.s[0, -1] == pytest.approx(10.0)
    # the end is where the record says, and the first point hangs
    assert line.position[-1, -1] == pytest.approx(run["weight"][-1], abs=1e-9)
    assert np.abs(line.position[:, 0]).max() < 1e-9
    # at the hook the line pulls as the reaction says
    force = np.linalg.norm([run.final[f"hook.f{i}"] for i in "xyz"])
    assert line.tension[-1, 0] == pytest.approx(force, rel=0.02)
    assert line["curvature"].shape == line.curvature.shape == (nt, ns)
    body = run.shapes.bodies["crate"]
    assert body.position.shape == (nt, 3) and body.attitude.shape == (nt, 3, 3)
    assert body.attitude[0] == pytest.approx(np.eye(3), abs=1e-12)
    # half a turn in two seconds
    assert body.attitude[-1][:2, :2] == pytest.approx(-np.eye(2), abs=1e-3)
    assert list(run.shapes) == ["line"] and "weight" in run.shapes.bodies
    again = pickle.loads(pickle.dumps(run)).shapes
    assert np.array_equal(again["line"].tension, line.tension)
    assert np.array_equal(rw.load(tmp_path / "run").shapes["line"].position, line.position)
    with pytest.raises(KeyError, match="did you mean 'line'"):
        run.shapes["lien"]
    with pytest.raises(KeyError, match=r"in `shapes\.bodies`"):
        run.shapes["crate"]
    with pytest.raises(KeyError, match="there are"):
        line["colour"]


def test_a_line_that_grows_is_filled_up_with_nothing(tmp_path):
    field = [("part", "<U4"), *[(name, "<f8") for name in ("t", "s", "x", "y", "z", "vx", "vy", "vz", "tension")]]
    rows = [("a", t, s, s, 0, t, 0, 0, 1, 5.0) for t in (0.0, 1.0) for s in range(2 + int(t))]
    rows[2:2] = [("b", 0.0, 0.0, 0, 0, 0, 0, 0, 0, np.nan)]
    np.save(tmp_path / "field.npy", np.array(rows, dtype=field))
    from ropewalk import _shapes

    shapes = _shapes.read(tmp_path)
    assert shapes["a"].position.shape == (2, 3, 3) and np.isnan(shapes["a"].s[0]).tolist() == [False, False, True]
    assert shapes["a"].position[1, 2].tolist() == [2, 0, 1]
    assert np.isnan(shapes["b"].s[1]).all() and not shapes["b"].values
    with pytest.raises(rw.OutputError, match=r"holds no `field\.npy`"):
        _shapes.read(tmp_path / "nothing")
    with pytest.raises(rw.OutputError, match="out="):
        rw.run("pendulum", duration="0.1 s").shapes
