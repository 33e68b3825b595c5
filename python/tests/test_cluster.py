"""Sweeps on a cluster of processes, of which things break in the middle: what comes out is the same to the last bit."""

import contextlib
import csv
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
import ropewalk as rw

distributed = pytest.importorskip("distributed")

VARY = {"speed": [f"{5 + k} kn" for k in range(20)], "elements": [4, 6]}
FIXED = {"duration": "1 s"}


def same(a, b):
    return [json.dumps(r, sort_keys=True) for r in a] == [json.dumps(r, sort_keys=True) for r in b]


@pytest.fixture(scope="module")
def here(tmp_path_factory):
    """What threads of this process make of it."""
    return rw.sweep("hose-turn", VARY, out=tmp_path_factory.mktemp("here"), **FIXED)


def free_port() -> int:
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    """A scheduler and workers, each a process of its own, as `dask scheduler` and `dask worker` start them."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.port = folder, free_port()
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.processes: list[subprocess.Popen] = []
        self.scheduler = self.start_scheduler()
        self.workers = [self.start_worker() for _ in range(2)]

    def start(self, *arguments: str) -> subprocess.Popen:
        environment = os.environ | {"DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "10s"}
        command = [sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]]
        out = open(self.folder / f"{arguments[0]}.log", "a")
        process = subprocess.Popen(command, stdout=out, stderr=out, env=environment, cwd=self.folder)
        self.processes.append(process)
        return process

    def start_scheduler(self) -> subprocess.Popen:
        return self.start("dask_scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard")

    def start_worker(self) -> subprocess.Popen:
        where = str(self.folder / "scratch")
        options = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", where]
        return self.start("dask_worker", self.address, *options)

    def close(self) -> None:
        for process in self.processes:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path):
    made = Cluster(tmp_path)
    yield made
    made.close()


def when(happened, then) -> threading.Thread:
    """Does something as soon as something has happened."""

    def watch():
        deadline = time.monotonic() + 60
        while not happened() and time.monotonic() < deadline:
            time.sleep(0.002)
        then()

    thread = threading.Thread(target=watch)
    thread.start()
    return thread


def rows(folder: Path) -> int:
    return len(list((folder / "rows").glob("*.json")))


def test_a_worker_is_killed(cluster, tmp_path, here):
    out = tmp_path / "out"
    with distributed.Client(cluster.address, timeout="30s") as client:
        client.wait_for_workers(2, timeout=30)
        there_then = []
        killer = when(lambda: rows(out) >= 5, lambda: there_then.append(rows(out)) or cluster.workers[0].kill())
        there = rw.sweep("hose-turn", VARY, out=out, client=client, **FIXED)
        killer.join()
    assert cluster.workers[0].wait(10) == -signal.SIGKILL and there_then[0] < 40
    assert same(there, here)


def test_the_scheduler_is_killed_and_comes_back(cluster, tmp_path, here):
    out = tmp_path / "out"

    there_then = []

    def restart():
        there_then.append(rows(out))
        cluster.scheduler.kill()
        cluster.scheduler.wait()
        # workers that lose their scheduler end; whoever looks after them starts others
        for worker in cluster.workers:
            worker.kill()
        cluster.start_scheduler()
        cluster.start_worker()

    with distributed.Client(cluster.address, timeout="30s") as client:
        client.wait_for_workers(2, timeout=30)
        killer = when(lambda: rows(out) >= 5, restart)
        there = rw.sweep("hose-turn", VARY, out=out, client=client, **FIXED)
        killer.join()
    assert there_then[0] < 40 and same(there, here)


def fill_disk(client) -> None:
    """From now on one of the workers can't write a byte into any file."""

    # what is inside a function goes to the workers as it is: they don't know this module
    def full() -> None:
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))

    client.run(full, workers=list(client.nthreads())[:1])


def test_the_disk_of_a_worker_is_full(cluster, tmp_path, here):
    out = tmp_path / "out"
    with distributed.Client(cluster.address, timeout="30s") as client:
        client.wait_for_workers(2, timeout=30)
        fill_disk(client)
        there = rw.sweep("hose-turn", VARY, out=out, client=client, **FIXED)
        assert same(there, here)
    assert not list((out / "rows").glob("*.part"))


def test_the_command_of_the_wheel_computes_on_a_cluster(cluster, tmp_path):
    vary = ["--vary", "speed=5:24:1kn", "--vary", "elements=4,6", "--set", "duration=1s", "--quiet"]

    def command(*more: str):
        words = [sys.executable, "-m", "ropewalk", "sweep", "hose-turn", *vary, *more]
        return subprocess.Popen(words, cwd=tmp_path, stderr=subprocess.PIPE, text=True)

    with distributed.Client(cluster.address, timeout="30s") as client:
        client.wait_for_workers(2, timeout=30)
        fill_disk(client)
    there = command("--dask", cluster.address, "--out", "there")
    here = command("--out", "here")
    for process in (there, here):
        said = process.communicate(timeout=120)[1]
        assert said == "" and process.returncode == 0, said

    def table(name: str):
        lines = list(csv.reader((tmp_path / name / "table.csv").read_text().splitlines()))
        clock = lines[0].index("cpu [s]")
        return [[cell for k, cell in enumerate(line) if k != clock] for line in lines]

    assert len(table("here")) == 41 and table("there") == table("here")
    for run in (tmp_path / "here" / "runs").iterdir():
        other = tmp_path / "there" / "runs" / run.name
        assert (run / "history.csv").read_bytes() == (other / "history.csv").read_bytes()
    assert len(list((tmp_path / "there" / "runs").iterdir())) == 40


def test_sigterm_ends_the_command_and_it_goes_on(cluster, tmp_path):
    # short runs are complete when the signal comes, long ones are not
    words = [sys.executable, "-m", "ropewalk", "sweep", "hose-turn", "--vary", "duration=0.2,0.3,0.4,175", "--out", "out"]
    words += ["--set", "tolerance=1e-9", "--quiet", "--dask", cluster.address]
    process = subprocess.Popen(words, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    runs = tmp_path / "out" / "runs"
    long = runs / "duration=175"

    def end():
        # until the worker has taken the long one
        time.sleep(0.5)
        process.send_signal(signal.SIGTERM)

    killer = when(lambda: len(list(runs.glob("duration*/summary.json"))) == 3, end)
    said = process.communicate(timeout=90)[1]
    killer.join()
    assert process.returncode == 143 and "stopped by SIGTERM: the same command" in said, said
    # the worker lets go of what nobody wants any more, and with it of the folder
    fcntl = pytest.importorskip("fcntl")
    deadline = time.monotonic() + 20
    with open(tmp_path / "out" / ".lock") as lock:
        while True:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                assert time.monotonic() < deadline
                time.sleep(0.1)
    assert json.loads((long / "summary.json").read_text())["status"] == "interrupted" and len(list(runs.glob("*/summary.json"))) == 4


def test_a_cluster_that_is_not_there_is_said(tmp_path):
    words = ["sweep", "hose-turn", "--vary", "speed=5kn", "--out", str(tmp_path / "a")]
    wrong = [sys.executable, "-m", "ropewalk", *words, "--dask", "tcp://127.0.0.1:1"]
    environment = os.environ | {"DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "1s"}
    done = subprocess.run(wrong, capture_output=True, text=True, env=environment)
    assert done.returncode == 2 and done.stderr.splitlines()[-1].startswith("error: the cluster at tcp://127.0.0.1:1")
