import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import ropewalk as rw
from ropewalk import _scene

PYTHON = Path(__file__).parents[1]


def test_a_scene_that_is_built_is_the_same_as_a_dict_and_a_file(weight, tmp_path):
    run = rw.run(weight, speed="1 kn")
    assert rw.run(weight.to_dict(), speed="1 kn")["weight"].tobytes() == run["weight"].tobytes()
    file = tmp_path / "weight.toml"
    file.write_text(weight.to_toml(speed="1 kn"))
    assert np.array_equal(rw.run(file)["weight"], run["weight"])
    assert np.array_equal(rw.run(str(file))["weight"], run["weight"])
    # the current drags the weight along
    assert run["weight.x"][-1] > 0 and run.units["hook.fz"] == "N"


def test_arrays_and_numbers_of_numpy_are_taken():
    scene = rw.Scene()
    points = np.array([[0, 0, 0], [1, 0, 0]])
    line = scene.cable(name="line", points=points.tolist(), elements=4, section=dict(mass=np.float64(0.4), ea=1e4, ei=0.1))
    scene.add("constraints", "spherical", "hook", marker=line.at("50 %"))
    scene.add("forces", "gravity")
    rw.check({**scene.to_dict(), "gravity": np.array([0, 0, -1.0])})


@pytest.mark.parametrize(
    "scene, message",
    [
        ("pendulm", "did you mean `pendulum`"),
        ("nowhere/scene.toml", "there is no file"),
        ({"elements": [{"type": "cable", "name": "a", "lenght": 3}]}, "lenght"),
        ({"elements": [{"type": "cabel"}]}, "cabel"),
        ({"run": {"duration": "3 kg"}}, '"3 kg" is a mass'),
        ({"run": {"duration": float("nan")}}, "JSON"),
        ({"run": object()}, "JSON"),
        ({}, "is empty"),
        (17, "a scene is a name, a path, a dict or a Scene, not int"),
    ],
)
def test_what_is_wrong_with_a_scene_is_told(scene, message):
    with pytest.raises(rw.SceneError, match=message) as e:
        rw.run(scene)
    assert isinstance(e.value, ValueError) and isinstance(e.value, rw.RopewalkError)
    with pytest.raises(rw.SceneError):
        rw.Simulation(scene)
    with pytest.raises(rw.SceneError):
        rw.check(scene)


def test_errors_show_the_place():
    with pytest.raises(rw.SceneError, match=r"scene:\d+:\d+"):
        rw.run({"elements": [{"type": "cable", "name": "a", "lenght": 3}]})
    # what only building finds out has its place as well
    with pytest.raises(rw.SceneError, match=r"scene:\d+"):
        rw.run({"run": {"duration": -1}, "elements": [{"type": "point_mass", "name": "a", "at": [0, 0, 0], "mass": 1}]})


def test_wrong_parameters_are_told():
    with pytest.raises(rw.SceneError, match="sped"):
        rw.run("hose-turn", sped="15 kn")
    with pytest.raises(rw.SceneError):
        rw.run("hose-turn", speed=object())


def test_misspelt_fields_are_no_keywords():
    with pytest.raises(TypeError, match="lenght"):
        rw.Scene().cable(name="a", elements=3, section={}, lenght=3)  # type: ignore[call-arg]


def test_the_methods_are_those_of_the_schemas():
    done = subprocess.run([sys.executable, PYTHON / "tools" / "generate.py", "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def parts(scene: dict):
    """Parts and sections of a scene, each with its schema."""
    schemas = rw.schemas()
    for key, schema in schemas.items():
        list, _, type = key.partition(".")
        if not type and key in scene:
            yield key, scene[key], schema
        for part in scene.get(list, []) if type else []:
            if part["type"] == type:
                yield key, {k: v for k, v in part.items() if k != "type"}, schema


@pytest.mark.parametrize("name", sorted(rw.list()))
def test_bundled_scenes_are_right_by_their_schemas(name):
    jsonschema = pytest.importorskip("jsonschema")
    tomllib = pytest.importorskip("tomllib")
    scene = tomllib.loads(_scene.source(name).toml([]))
    count = 0
    for key, value, schema in parts(scene):
        jsonschema.Draft202012Validator.check_schema(schema)
        errors = [e.message for e in jsonschema.Draft202012Validator(schema).iter_errors(value)]
        assert not errors, f"{key}: {json.dumps(value)}\n{errors}"
        count += 1
    assert count > 2


def test_schemas_refuse_what_the_reader_refuses():
    jsonschema = pytest.importorskip("jsonschema")
    right = {"name": "a", "points": [[0, 0, "-3 m"]], "elements": 3, "section": {"mass": "1 kg/m", "ea": 1e4, "ei": 0}}
    schema = rw.schemas()["elements.cable"]
    jsonschema.validate(right, schema)
    for wrong in ({"elements": "many"}, {"lenght": 3}, {"points": 3}, {"section": {"mass": True}}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(right | wrong, schema)
