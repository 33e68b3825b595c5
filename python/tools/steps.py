"""What a step costs that Python asks for: a cable of 20 elements that swings, in steps of 1 ms, each by a call from here, beside
as many that one call lets Rust take. CPU time, in turns.

    python steps.py [STEPS] [--rounds 7]
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable

import ropewalk as rw


def swinging(duration: float) -> rw.Simulation:
    """A cable that is released from the horizontal."""
    scene = rw.Scene(title="A cable that swings")
    section = dict(mass="0.5 kg/m", ea="5 kN", ei="0.1 N m^2")
    line = scene.cable(name="line", points=[[0, 0, 0], ["2 m", 0, 0]], elements=20, section=section)
    scene.spherical(name="hook", marker=line.start)
    scene.gravity()
    scene.position(of=line.end)
    scene.set_solver(stepping={"fixed": {"h": "1 ms"}})
    scene.set_run(duration=duration)
    return rw.Simulation(scene)


def cpu(act: Callable[[], object]) -> float:
    begun = time.process_time()
    act()
    return time.process_time() - begun


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("steps", nargs="?", type=int, default=2000)
    words.add_argument("--rounds", type=int, default=7)
    given = words.parse_args()
    n, h = given.steps, 1e-3
    ratios, looked, alone = [], [], []
    for _ in range(given.rounds):
        rust, python, looks = (swinging(n * h) for _ in range(3))
        each = cpu(lambda: rust.advance(to=n * h))
        by_call = cpu(lambda: [python.advance(to=(k + 1) * h) for k in range(n)])
        with_look = cpu(lambda: [looks.advance(to=(k + 1) * h)["line.end"] for k in range(n)])
        assert rust.steps == python.steps == n
        ratios.append(by_call / each)
        looked.append(with_look / each)
        alone.append(1e6 * each / n)
    print(
        f"{n} steps of {h} s, medians of {given.rounds} rounds: {statistics.median(alone):.1f} µs each in Rust; "
        f"each called from Python {statistics.median(ratios):.3f} of that, with a look at a record {statistics.median(looked):.3f}"
    )


if __name__ == "__main__":
    main()
