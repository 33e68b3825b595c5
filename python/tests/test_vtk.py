"""Files for ParaView, read by VTK's own package."""

import subprocess
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest

# the reader alone, which needs no display
io = pytest.importorskip("vtkmodules.vtkIOXML", exc_type=ImportError)
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402

# what the files call the columns of field.npy, and how far single precision is off
COLUMNS = {"s [m]": "s", "tension [N]": "tension", "curvature [1/m]": "curvature", "speed [m/s]": "speed"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("vtk") / "run"
    command = [sys.executable, "-m", "ropewalk", "run", "pendulum", "--set", "duration=0.3 s", "--vtk", "--quiet"]
    said = subprocess.run([*command, "--out", str(out)], capture_output=True, text=True)
    assert said.returncode == 0, said.stderr
    return out


def test_every_snapshot_is_that_of_the_field_record(folder):
    field, forces = np.load(folder / "field.npy"), np.load(folder / "forces.npy")
    assert set(forces["name"]) == {"reaction: hinge", "weight: cable"}
    sets = ET.parse(folder / "vtk.pvd").getroot().iter("DataSet")
    files = [(float(s.get("timestep")), folder / s.get("file")) for s in sets]
    assert [t for t, _ in files] == sorted(set(field["t"]))
    reader = io.vtkXMLPolyDataReader()
    for t, path in files:
        reader.SetFileName(str(path))
        reader.Update()
        got, expected = reader.GetOutput(), field[field["t"] == t]
        # behind the points of the line come those where forces act
        count, acting = len(expected), forces[forces["t"] == t]
        assert got.GetNumberOfLines() == 1 and got.GetNumberOfPoints() == count + len(acting)
        places = np.concatenate([np.stack([part[x] for x in "xyz"], axis=1) for part in (expected, acting)])
        assert np.allclose(vtk_to_numpy(got.GetPoints().GetData()), places, rtol=1e-6, atol=1e-9)
        vectors = vtk_to_numpy(got.GetPointData().GetArray("force [N]"))
        arrows = np.stack([acting[x] for x in ("fx", "fy", "fz")], axis=1)
        assert np.allclose(vectors[count:], arrows, rtol=1e-6) and not vectors[:count].any()
        velocities = np.stack([expected[x] for x in ("vx", "vy", "vz")], axis=1)
        assert np.allclose(vtk_to_numpy(got.GetPointData().GetArray("velocity [m/s]"))[:count], velocities, rtol=1e-6)
        for name, column in COLUMNS.items():
            values = vtk_to_numpy(got.GetPointData().GetArray(name))[:count]
            size = max(np.abs(expected[column]).max(), 1e-30)
            assert np.allclose(values, expected[column], rtol=1e-6, atol=1e-6 * size), name


def test_histories_and_field_agree(folder):
    import ropewalk as rw

    run, field = rw.load(folder), np.load(folder / "field.npy")
    ends = {row["t"]: row for row in field[field["s"] == field["s"].max()]}
    common = [k for k, t in enumerate(run.t) if t in ends]
    assert len(common) > 3
    for k in common:
        assert run["cable.end.z"][k] == pytest.approx(ends[run.t[k]]["z"], abs=1e-9)
