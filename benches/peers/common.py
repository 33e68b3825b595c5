"""What the peers' scripts share: a case comes in as JSON, its answer goes out as JSON, user CPU time in between."""

import json
import os
import resource
import sys

KNOT = 1852.0 / 3600.0

# only the answer reaches standard output, whatever a library prints; hence this comes before the peer's import
ANSWER = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)

# a peer that doesn't come to an end is stopped [s of CPU time]
LIMIT = 300


class Stopwatch:
    """User CPU time of this process since it was made [s]."""

    def __init__(self):
        self.start = self.now()

    @staticmethod
    def now():
        return resource.getrusage(resource.RUSAGE_SELF).ru_utime

    def read(self):
        return self.now() - self.start


def main(solve):
    """Solves the case on standard input."""
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
    json.dump(solve(json.load(sys.stdin)), ANSWER)
    ANSWER.flush()
    # the answer is there: nothing that a library does at its end may spoil it
    os._exit(0)


class Course:
    """The ship: from rest to its speed along x, as `u² (3 - 2u)` over the ramp."""

    def __init__(self, case):
        self.speed = case["speed_kn"] * KNOT
        self.ramp = case["ramp"]

    def at(self, t):
        """Way, velocity and acceleration."""
        if t >= self.ramp:
            return self.speed * (t - 0.5 * self.ramp), self.speed, 0.0
        u = t / self.ramp
        return (
            self.speed * self.ramp * u**3 * (1.0 - 0.5 * u),
            self.speed * u * u * (3.0 - 2.0 * u),
            self.speed / self.ramp * 6.0 * u * (1.0 - u),
        )


def size(force):
    return sum(f * f for f in force) ** 0.5
