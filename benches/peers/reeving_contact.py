"""Reference values for reeving.py by refined contact: the rope is a chain of masses and springs that lies on a real wheel.

    python benches/peers/reeving_contact.py atwood 800 1600 3200
    python benches/peers/reeving_contact.py grip 400 800 1600

Numbers are those of springs; below each come the values, and by how much they differ from those before. Nothing in here knows of ropes
over wheels: a mass that is inside the wheel is pushed out by a stiff spring and rubbed by dry friction, which turns the wheel. Steps
are explicit. It takes `numpy`. The problems are those of reeving.json (atwood) and of tests/data/reeving/chain_grip.json (grip), whose
values another program of this kind made.
"""

import json
import math
import pathlib
import sys
import time

import numpy as np

HERE = pathlib.Path(__file__).parent
GRIP = HERE.parents[1] / "tests/data/reeving/chain_grip.json"


def swing(p, v, turned, start, h, steps, mass, weight, pull, ramp, spring, wheel, friction):
    """Takes steps of Euler and Cromer. Places and velocities are complex, x across and z up, with the wheel's centre at 0."""
    rest, stiff, viscous = spring
    radius, inertia, firm, calm = wheel
    coefficient, slip = friction
    angle, speed = turned
    for k in range(steps):
        u = min((start + k * h) / ramp, 1)
        force = -1j * weight
        force[-1] += pull * u**3 * (10 - 15 * u + 6 * u * u)
        d = np.diff(p)
        length = np.sqrt(d.real**2 + d.imag**2)
        d /= length
        tension = stiff * (length - rest)
        if viscous:
            tension += viscous * dot(d, np.diff(v))
        d *= tension
        force[:-1] += d
        force[1:] -= d
        # the wheel turns clockwise
        on = np.flatnonzero(p.real**2 + p.imag**2 < radius**2)
        far = np.abs(p[on])
        out = p[on] / far
        along = -1j * out
        push = np.maximum(firm * (radius - far - calm * dot(out, v[on])), 0)
        slide = speed * radius - dot(along, v[on])
        rub = coefficient * push * slide / np.hypot(slide, slip)
        force[on] += push * out + rub * along
        v += h / mass * force
        p += h * v
        speed -= h * radius * rub.sum() / inertia
        angle += h * speed
    return angle, speed


def dot(a, b):
    return a.real * b.real + a.imag * b.imag


def line(s, radius):
    """Points on a wheel and straight down on both sides of it, by the length from its top to the right."""
    over = np.clip(s / radius, -math.pi / 2, math.pi / 2)
    return radius * np.sin(over) + 1j * (radius * np.cos(over) - np.abs(s - radius * over))


def balanced(nodes, radius, end, mass, ea, g):
    """Lengths from the top of the wheel for a rope that rests there, smoothly, with equal weights at its ends.

    All along it T + T²/(2 EA) - m g z is the same. `nodes` are unstretched lengths from its middle.
    """
    s, low = nodes, end * g
    for _ in range(50):
        z = line(s, radius).imag
        energy = low + low**2 / (2 * ea) + mass * g * (z - z[-1])
        stretch = np.sqrt(1 + 2 * energy / ea)
        s = np.concatenate([[0], np.cumsum((stretch[1:] + stretch[:-1]) / 2 * np.diff(nodes))])
        s -= s[len(s) // 2]
    return s


def atwood(springs):
    """Let go unstretched, as the others' rope is."""
    problems = json.loads((HERE / "reeving.json").read_text())
    p, c = problems["atwood"], problems["atwood"]["contact"]
    s = np.linspace(-p["length"] / 2, p["length"] / 2, springs + 1) + p["deeper"] / 2
    return run(
        place=line(s, p["radius"]),
        length=p["length"],
        density=p["mass"],
        ends=p["masses"],
        g=problems["gravity"],
        ea=p["ea"],
        retardation=0.0,
        wheel=(p["radius"], p["inertia"]),
        friction=(c["friction"], c["slip_speed"]),
        firm=c["stiffness"],
        times=[p["time"]],
    )


def grip(springs):
    """Balanced at first, then pulled down and aside at the right."""
    data = json.loads(GRIP.read_text())
    p = data["parameters"]
    assert p["m1"] == p["m2"], "unequal weights aren't balanced"
    nodes = np.linspace(-p["L"] / 2, p["L"] / 2, springs + 1)
    return run(
        place=line(balanced(nodes, p["R"], p["m1"], p["mass"], p["EA"], p["g"]), p["R"]),
        length=p["L"],
        density=p["mass"],
        ends=[p["m1"], p["m2"]],
        g=p["g"],
        ea=p["EA"],
        retardation=p["axial_damping_s"],
        wheel=(p["R"], p["J"]),
        friction=(p["mu"], p["slip_speed"]),
        firm=2e5,
        times=data["reference"]["t"],
        pull=complex(p["force"][0], p["force"][2]),
        ramp=0.1,
    )


def run(place, length, density, ends, g, ea, retardation, wheel, friction, firm, times, pull=0j, ramp=1.0):
    """What NAMES says, a row for each of the times. `firm` is the stiffness of contact of one mass with the wheel, N/m."""
    p, v, turned, now = place.copy(), np.zeros_like(place), (0.0, 0.0), 0.0
    rest = length / (len(p) - 1)
    light, stiff = density * rest, ea / rest
    mass = np.full(len(p), light)
    mass[[0, -1]] = light / 2 + np.array(ends)
    # no vibration is faster than this; contact is damped by a tenth of its critical damping
    touch = math.sqrt(firm / light)
    fast = 2 * math.sqrt(stiff / light) + touch
    longest = 1 / (2 * fast + retardation * fast**2)
    spring, wheel = (rest, stiff, retardation * stiff), (*wheel, firm, 0.2 / touch)
    rows = []
    for t in times:
        steps = math.ceil((t - now) / longest)
        turned = swing(p, v, turned, now, (t - now) / steps, steps, mass, mass * g, pull, ramp, spring, wheel, friction)
        rows.append([t, p[0].imag, p[-1].real, p[-1].imag, place[-1].imag - p[-1].imag, *turned])
        now = t
    return np.array(rows)


NAMES = ["t [s]", "left z [m]", "right x", "right z", "way down", "wheel [rad]", "[rad/s]"]


def main():
    problem = {"atwood": atwood, "grip": grip}[sys.argv[1]]
    found = []
    for springs in map(int, sys.argv[2:]):
        before = time.process_time()
        found.append(problem(springs))
        print(f"{springs} springs, {time.process_time() - before:.0f} s of CPU time")
        print("".join(f"{name:>13}" for name in NAMES))
        for row in found[-1]:
            print("".join(f"{x:13.6f}" for x in row), flush=True)
        if len(found) > 1:
            off = np.abs(found[-1] - found[-2]).max(axis=0)
            print("   differs by" + "".join(f"{x:13.6f}" for x in off[1:]), flush=True)


if __name__ == "__main__":
    main()
