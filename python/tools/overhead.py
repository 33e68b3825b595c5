"""What a sweep costs beside its runs: 10 000 short ones in threads, the same by the command line, and on a cluster of this
machine with the memory of its scheduler.

    python overhead.py [RUNS] [--cluster] [--command]
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import ropewalk as rw


def short() -> rw.Scene:
    """A mass that falls for a moment."""
    scene = rw.Scene(title="A mass falls")
    height = scene.parameter("height", "1 m")
    scene.point_mass(name="a", marker=[0, 0, height], mass=1)
    scene.gravity()
    scene.position(of="a")
    scene.set_run(duration="0.1 s", output="0.1 s")
    return scene


def memory(dask_scheduler: Any = None) -> float:
    """Resident memory of a process [MB]."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def main() -> None:
    numbers = [int(word) for word in sys.argv[1:] if word.isdigit()]
    runs = numbers[0] if numbers else 10_000
    scene = short()
    heights: list[Any] = [f"{1 + 1e-3 * k} m" for k in range(runs)]
    few = heights[: min(500, runs)]
    start, cpu = time.perf_counter(), time.process_time()
    for height in few:
        rw.run(scene, height=height)
    wall, alone = ((clock - begun) / len(few) for clock, begun in ((time.perf_counter(), start), (time.process_time(), cpu)))
    print(f"a run alone {1e3 * wall:.2f} ms, of CPU {1e3 * alone:.2f} ms")
    for jobs in (1, os.cpu_count() or 1):
        with tempfile.TemporaryDirectory() as folder:
            start, cpu = time.perf_counter(), time.process_time()
            rows = rw.sweep(scene, {"height": heights}, out=folder, jobs=jobs)
            each, spent = (time.perf_counter() - start) / runs, (time.process_time() - cpu) / runs
            assert len(rows) == runs and not rows.failed
            start = time.perf_counter()
            rw.sweep(scene, {"height": heights}, out=folder)
            again = time.perf_counter() - start
        print(f"{runs} runs, {jobs} at a time: {1e3 * each:.2f} ms each, of CPU {1e3 * spent:.2f} ms, {1e3 * (spent - alone):.2f} ms")
        print(f"  of them beside the run; the same call again {again:.1f} s")
    if "--cluster" in sys.argv:
        from distributed import Client
        from distributed.deploy.subprocess import SubprocessCluster

        workers = os.cpu_count() or 1
        options = {"n_workers": workers, "worker_kwargs": {"nthreads": 1}}
        with tempfile.TemporaryDirectory() as folder, SubprocessCluster(**options) as cluster, Client(cluster) as client:
            before = client.run_on_scheduler(memory)
            for batch in (1, 20):
                start = time.perf_counter()
                rw.sweep(scene, {"height": heights}, out=Path(folder) / str(batch), client=client, batch=batch)
                each = (time.perf_counter() - start) / runs
                after = client.run_on_scheduler(memory)
                print(f"{runs} runs on a cluster, {batch} at a time: {1e3 * each:.2f} ms each; its scheduler has")
                print(f"  {after:.0f} MB after {before:.0f} MB")
    if "--command" in sys.argv:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "falls.json").write_text(json.dumps(scene.to_dict()))
            rest = ["--quiet", "--out", "out", "--vary", f"height=1:{1 + 1e-3 * (runs - 1)!r}:0.001 m"]
            start = time.perf_counter()
            command = [sys.executable, "-m", "ropewalk", "sweep", "falls.json", *rest]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
            each = (time.perf_counter() - start) / runs
            print(f"{runs} runs by the command, each into its folder: {1e3 * each:.2f} ms each {done.stderr}")


if __name__ == "__main__":
    main()
