"""A weight towed on a line: how the tension at the ship depends on its speed, by steps and by a sweep.

    python towing.py [FOLDER]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import ropewalk as rw


def towed() -> rw.Scene:
    """A ship that gathers speed with 30 m of line and a weight at its end."""
    scene = rw.Scene(title="A towed weight")
    speed = scene.parameter("speed", "4 kn", "of the ship")
    rope = dict(mass="0.4 kg/m", ea="50 kN", ei=0.5, diameter="20 mm")
    line = scene.cable(name="line", points=[[0, 0, 0], [0, 0, "-30 m"]], elements=12, section=rope)
    weight = scene.point_mass(name="weight", marker=line.end, mass="40 kg", volume="0.005 m^3", drag_area="0.05 m^2")
    course = scene.straight(name="course", speed=speed, ramp="10 s")
    scene.driving(name="ship", marker=line.start, motion=course)
    scene.gravity()
    scene.buoyancy()
    scene.drag()
    scene.position(of=weight)
    scene.along(of=line, what="tension", at="start")
    scene.set_run(duration="60 s")
    scene.set_water()
    return scene


def main(folder: Path) -> None:
    scene = towed()
    print(rw.check(scene))

    # %% one run, looked at on the way: when does the weight begin to rise?
    sim = rw.Simulation(scene)
    while not sim.done and sim["weight.z"] <= sim.advance(0.5)["weight.z"] + 1e-6:
        pass
    print(f"after {sim.t} s the weight is at {np.round(sim['weight'], 2)} m")

    # %% many runs
    rows = rw.sweep(scene, {"speed": ["2 kn", "4 kn", "6 kn", "8 kn"]}, out=folder / "speeds")
    for row in rows:
        print(f"{row['speed']:>5}: {-row['weight.z']:6.2f} m deep, {row['line.start.tension']:7.1f} N at the ship")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(Path(folder))
