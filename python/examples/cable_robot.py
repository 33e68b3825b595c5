"""A platform on eight cables goes round a circle: its drums turn by tables, or by a controller that sees the platform.

    python cable_robot.py
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

import ropewalk as rw

Vector = npt.NDArray[np.float64]

RADIUS = 0.05  # of the drums [m]
CENTRE, CIRCLE = np.array([0.0, 0.0, 1.5]), 0.5
EVERY = 0.02  # time between two looks at the platform [s]
CORNERS = [(1, 1), (-1, 1), (-1, -1), (1, -1)]

# upper cables come from above to the lower edges of the platform, lower ones from below to the upper edges
RINGS = np.array([[3 * x, 2 * y, z] for z in (3.0, 0.2) for x, y in CORNERS])
POINTS = np.array([[0.3 * x, 0.15 * y, -0.2] for x, y in CORNERS] + [[0.15 * x, 0.3 * y, 0.2] for x, y in CORNERS])
DRUMS = np.array([[3.6 * x, 2 * y, z] for z in (1.0, 0.2) for x, y in CORNERS])


def wanted(t: float) -> Vector:
    """Where the platform is to be: once round the circle in 8 s, from 0.5 s on."""
    x = min(max((t - 0.5) / 8, 0.0), 1.0)
    angle = 2 * math.pi * x**3 * (10 - 15 * x + 6 * x * x)
    return CENTRE + CIRCLE * np.array([math.cos(angle), math.sin(angle), 0.0])


def robot(load: str, controlled: bool) -> rw.Scene:
    """The platform, its cables and drums, which turn by inputs if they are `controlled`, else by tables."""
    scene = rw.Scene(title="A platform on eight cables")
    names = [f"p{k}" for k in range(1, 9)]
    platform = scene.rigid_body(
        name="platform",
        position=wanted(0).tolist(),
        mass=load,
        inertia=[1.5, 1.5, 1.8],
        points=dict(zip(names, POINTS.tolist())),
    )
    section = dict(mass="20 g/m", ea="400 kN", diameter="4 mm", axial_retardation_time="5 ms")
    times = np.arange(0, 9.01, 0.5)
    for k, (ring, point, drum) in enumerate(zip(RINGS, POINTS, DRUMS)):
        cable, eye, winch = f"c{k + 1}", f"e{k + 1}", f"w{k + 1}"
        route = [{"wound": winch}, {"through": eye}, {"end": f"platform.p{k + 1}"}]
        scene.cable(name=cable, section=section, elements=1, tension="320 N" if k < 4 else "200 N", route=route)
        scene.ring(name=eye, marker=ring.tolist())
        side = math.copysign(1.0, drum[0]) * (1 if k < 4 else -1)
        how = {"speed": {"input": winch}} if controlled else {"turn": f"t{k + 1}"}
        scene.drum(name=winch, marker=drum.tolist(), axis=[0, side, 0], radius=RADIUS, **how)
        if controlled:
            scene.add_input(name=winch, unit="m/s", join="linear")
        else:
            lengths = np.array([np.linalg.norm(wanted(t) + point - ring) for t in times])
            scene.table(name=f"t{k + 1}", t=times.tolist(), angle=((lengths - lengths[0]) / RADIUS).tolist(), join="cubic", ends="at-rest")
    scene.gravity()
    scene.position(of=platform)
    scene.orientation(of=platform)
    scene.set_run(duration="9 s", output="50 ms", from_equilibrium=True)
    return scene


def turned(angles: Vector) -> Vector:
    """The matrix of Bryant angles 1-2-3 [rad]."""
    (s1, s2, s3), (c1, c2, c3) = np.sin(angles), np.cos(angles)
    x = np.array([[1, 0, 0], [0, c1, -s1], [0, s1, c1]])
    y = np.array([[c2, 0, s2], [0, 1, 0], [-s2, 0, c2]])
    z = np.array([[c3, -s3, 0], [s3, c3, 0], [0, 0, 1]])
    return np.asarray(x @ y @ z)


def control(sim: rw.Simulation) -> None:
    """Sets the speed of each drum: what its cable needs along the path, and what the platform lacks in place and in turn."""
    place = np.array(sim["platform"])
    angles = np.array([sim[f"platform.orientation.phi{i}"] for i in (1, 2, 3)])
    arms = POINTS @ turned(angles).T
    along = place + arms - RINGS
    along /= np.linalg.norm(along, axis=1)[:, None]
    velocity = (wanted(sim.t + EVERY) - wanted(sim.t)) / EVERY + 4.0 * (wanted(sim.t) - place)
    # for small turns
    spin = -4.0 * angles
    for k, speed in enumerate(np.einsum("ij,ij->i", along, velocity + np.cross(spin, arms))):
        sim.set_input(f"w{k + 1}", float(speed))


def furthest(load: str, controlled: bool) -> float:
    """How far the platform is from where it is to be, at most, once it has set off [m]."""
    sim, worst = rw.Simulation(robot(load, controlled)), 0.0
    while not sim.done:
        if controlled:
            control(sim)
        sim.advance(EVERY)
        if sim.t > 1.5:
            worst = max(worst, float(np.linalg.norm(np.array(sim["platform"]) - wanted(sim.t))))
    return worst


def main() -> None:
    for load in ("30 kg", "90 kg"):
        tables, seen = (1000 * furthest(load, controlled) for controlled in (False, True))
        print(f"{load}: off by {tables:.2f} mm by tables, by {seen:.2f} mm under control")


if __name__ == "__main__":
    main()
