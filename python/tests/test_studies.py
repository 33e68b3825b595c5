"""Costs, effects, certificates, objectives."""

import math
import pickle

import numpy as np
import pytest
import ropewalk as rw


def test_a_run_is_certified(weight):
    every = rw.certify(weight)
    assert not every.sensitive and "certified" in every.text and every.holds == (
        not every.failures and all((r["step"] or 0) + (r["mesh"] or 0) <= every.tolerance for r in every.records)
    )
    assert {"weight", "hook.reaction"} <= {r["record"] for r in every.records}
    one = rw.certify(weight, "weight@1s", speed="1 kn")
    assert [r["record"] for r in one.records] == ["weight@1s"] and 0 <= one.records[0]["step"] < 1e-3
    with pytest.raises(rw.SceneError, match="did you mean|choose one of"):
        rw.certify(weight, "waight")


def test_effects_are_told_apart(weight):
    found = rw.effects(weight, "weight")
    # the current does nothing without drag: the weight stays where it hangs
    assert found.without["drag"] > 0.1 and found.record == "weight"
    assert sum(c["share"] for c in found.costs) == pytest.approx(1, abs=0.05)
    assert all(x is None or x < 1e-2 for name, x in found.without.items() if name in found.can_be_left_out)
    assert len(found.to_pandas()) == len(found.without) + len(found.added)


def test_what_accuracy_costs(tmp_path):
    found = rw.cost("pendulum", "cable.end@0.4s", budget="6 s", out=tmp_path / "cost", duration="0.4 s")
    assert found.runs and 0 < found.uncertainty < 1e-2
    best = found.cheapest(1e-2)
    assert best["error"] <= 1e-2 and "tolerance" in found.scenes[0.01]
    # what it advises is as good as it says, against the settings for the least error
    exact = [a["accuracy"] for a in found.advice if a["error"] is not None][-1]
    (tmp_path / "a.toml").write_text(found.scenes[0.01])
    (tmp_path / "b.toml").write_text(found.scenes[exact])
    a, b = (rw.run(tmp_path / f"{name}.toml")["cable.end"][-1] for name in "ab")
    assert np.linalg.norm(a - b) <= 3e-2 * np.linalg.norm(b)
    with pytest.raises(rw.SceneError, match="no length of time"):
        rw.cost("pendulum", "cable.end", budget="soon")


def test_an_objective_is_a_function_of_numbers():
    # half the swing of a mass on a spring from rest is its period: it depends on mass and stiffness alone
    scene = rw.Scene()
    mass = scene.parameter("mass", "1 kg")
    scene.point_mass(name="a", marker=[1, 0, 0], mass=mass)
    scene.spring(name="s", marker="a", to=[0, 0, 0], stiffness=10, length=0.8)
    scene.position(of="a")
    scene.set_run(duration="1 s", output="0.01 s")
    scene.set_solver(stepping={"controlled": {"tolerance": 1e-8}})

    def exact(m: float) -> float:
        return 0.8 + 0.2 * math.cos(math.sqrt(10 / m))

    f = rw.objective(scene, {"mass": "kg"}, "a.x")
    assert f([2.0]) == pytest.approx(exact(2.0), abs=1e-6) and f(2.0) == f([2.0]) and f.calls == 1
    assert f.parameters([2]) == {"mass": "2.0 kg"} and f.run([2.0]).final["a.x"] == f([2.0])
    several = rw.objective(scene, ["mass"], lambda run: run["a.x"][[0, -1]] - [1.0, exact(1.5)])
    assert several([1.5]) == pytest.approx([0, 0], abs=1e-6) and several.best[1] < 1e-10
    scipy = pytest.importorskip("scipy.optimize")
    g = rw.objective(scene, ["mass"], "a.x", failed=1e9)
    least = scipy.minimize_scalar(lambda m: g([m]), bounds=(0.5, 1.5), method="bounded", options={"xatol": 1e-6})
    assert least.x == pytest.approx(10 / math.pi**2, abs=1e-3) and g.best[1] == pytest.approx(0.6, abs=1e-6)
    assert g([-1.0]) == 1e9
    with pytest.raises(rw.SceneError):
        rw.objective(scene, ["mass"], "a.x")([-1.0])
    with pytest.raises(rw.SceneError, match="2 numbers for 1 unknowns"):
        f([1, 2])
    with pytest.raises(rw.SceneError, match="both unknown and set"):
        rw.objective(scene, ["mass"], "a.x", mass=1)


def test_a_notebook_shows_the_page_of_a_run(tmp_path):
    run = rw.run("pendulum", out=tmp_path / "run", duration="0.1 s")
    (tmp_path / "run" / "report.html").unlink(missing_ok=True)
    assert "<svg" in run._repr_html_() and "iframe" not in run._repr_html_()
    (tmp_path / "run" / "report.html").write_text('<html><p title="a">&amp;</p></html>')
    shown = run._repr_html_()
    assert "srcdoc=" in shown and "title=&quot;a&quot;&gt;&amp;amp;" in shown
    assert pickle.loads(pickle.dumps(run))._repr_html_() == shown
