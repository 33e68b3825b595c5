"""Sweeps `hose-turn` on a Dask cluster of processes whose workers are killed at random, and in threads: the two tables have to be
equal to the last bit.

    python killed.py [RUNS] [--duration 0.2] [--workers 2] [--every 3] [--seed 1]

1000 runs by default. The runs of the scene are as long as `--duration` says (seconds); 25 is all of it.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np
import ropewalk as rw


class Workers:
    """Workers as processes of their own, of which one is killed every now and then and another one started."""

    def __init__(self, address: str, count: int, every: float, folder: Path, seed: int) -> None:
        self.address, self.folder, self.every = address, folder, every
        self.random, self.killed, self.over = random.Random(seed), 0, threading.Event()
        self.processes = [self.start() for _ in range(count)]
        self.killer = threading.Thread(target=self.kill)

    def start(self) -> subprocess.Popen[bytes]:
        options = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(self.folder)]
        command = [sys.executable, "-m", "distributed.cli.dask_worker", self.address, *options]
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def kill(self) -> None:
        while not self.over.wait(self.random.expovariate(1.0 / self.every)):
            k = self.random.randrange(len(self.processes))
            self.processes[k].kill()
            self.processes[k].wait()
            self.killed += 1
            self.processes[k] = self.start()

    def close(self) -> None:
        self.over.set()
        self.killer.join()
        for process in self.processes:
            process.kill()
            process.wait()


def main() -> int:
    from distributed import Client, LocalCluster

    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("runs", nargs="?", type=int, default=1000)
    words.add_argument("--duration", type=float, default=0.2)
    words.add_argument("--workers", type=int, default=2)
    words.add_argument("--every", type=float, default=3.0, help="mean time between kills [s]")
    words.add_argument("--seed", type=int, default=1)
    given = words.parse_args()
    speeds = np.linspace(5.0, 25.0, -(-given.runs // 2))
    vary = {"speed": [f"{v:.6f} kn" for v in speeds], "elements": [4, 6]}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        begun = time.monotonic()
        with LocalCluster(n_workers=0, dashboard_address=None) as cluster, Client(cluster) as client:
            workers = Workers(cluster.scheduler_address, given.workers, given.every, folder / "scratch", given.seed)
            try:
                client.wait_for_workers(given.workers, timeout=60)
                workers.killer.start()
                # a batch may be lost as often as there are workers to lose
                rows = rw.sweep(
                    "hose-turn", vary, out=folder / "cluster", client=client, retries=1000, duration=given.duration
                )
            finally:
                workers.close()
        middle = time.monotonic()
        here = rw.sweep("hose-turn", vary, out=folder / "threads", duration=given.duration)
        end = time.monotonic()
    differ = [k for k, (a, b) in enumerate(zip(rows, here)) if json.dumps(a, sort_keys=True) != json.dumps(b, sort_keys=True)]
    print(
        f"{len(rows)} runs, {workers.killed} workers killed, {len(rows.failed)} failed, {len(differ)} rows differ from those "
        f"of threads; {middle - begun:.0f} s on the cluster, {end - middle:.0f} s in threads"
    )
    return int(bool(differ or rows.failed or len(rows) != len(here) or not workers.killed))


if __name__ == "__main__":
    sys.exit(main())
