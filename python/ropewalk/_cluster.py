"""Work on the workers of a Dask cluster: so much at a time that the scheduler's memory stays small, and again if the
scheduler was lost."""

from __future__ import annotations

import asyncio
import collections
import contextlib
import functools
import itertools
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from . import _native
from ._errors import RopewalkError

T = TypeVar("T")
R = TypeVar("R")

LOOK = 0.5
"""How often a worker looks whether a task is still wanted [s]."""
EACH, LARGEST = 8, 50
"""Batches for each thread of the cluster, if that doesn't make them too large: a few to share them out evenly."""
AHEAD = 4
"""Batches for each thread of the cluster that the scheduler knows at the same time."""


def each(
    client: Any,
    work: Callable[[Sequence[T]], R],
    items: Sequence[T],
    done: Callable[[R], None],
    *,
    batch: int | None,
    retries: int,
    patience: float = 60.0,
) -> None:
    """Calls `work` with all items, `batch` at a time or as many as seems fit, on the workers of a `distributed.Client`, and
    `done` here with each result.

    What a worker had begun when it was lost is done by another one; what several workers in a row were lost with is tried
    again in halves, `retries` times. If the scheduler is lost, it may come back with
    workers within `patience` seconds, `retries` times: what had no result by then is begun anew.
    """
    if batch is None:
        batch = max(1, min(LARGEST, len(items) // (EACH * (sum(client.nthreads().values()) or 1))))
    batches = [items[k : k + batch] for k in range(0, len(items), batch)]
    for attempt in range(retries + 1):
        batches = _submit(client, work, batches, done, retries)
        if not batches:
            return
        if attempt < retries:
            _wait_for_workers(client, patience)
    raise RopewalkError("the scheduler was lost too often: the same call, with a new client, goes on")


def _submit(
    client: Any, work: Callable[[Sequence[T]], R], batches: Sequence[Sequence[T]], done: Callable[[R], None], retries: int
) -> list[Sequence[T]]:
    """Those that have no result because the scheduler was lost."""
    from concurrent.futures import CancelledError

    from distributed import KilledWorker, as_completed
    from distributed.comm.core import CommClosedError

    # asyncio's is another one
    lost_errors = (CancelledError, asyncio.CancelledError, CommClosedError, ConnectionError, TimeoutError)
    left = dict(enumerate(batches))
    waiting = collections.deque(left)
    going: dict[Any, int] = {}
    numbers = itertools.count()
    # how often the scheduler gave up a batch since several workers in a row were lost with it
    given_up = dict.fromkeys(left, 0)

    def submit() -> Any:
        if not waiting:
            return None
        k = waiting.popleft()
        future = client.submit(work, left[k], retries=retries, pure=False)
        going[future] = k
        return future

    def again(k: int) -> None:
        """In halves, so that what kills a worker, if it isn't chance, stands alone in the end."""
        some, times = left.pop(k), given_up.pop(k) + 1
        middle = (len(some) + 1) // 2
        for half in (some[:middle], some[middle:]):
            if half:
                new = len(batches) + next(numbers)
                left[new], given_up[new] = half, times
                waiting.append(new)

    try:
        try:
            ahead = max(AHEAD * sum(client.nthreads().values()), AHEAD)
            first = [future for _ in range(min(ahead, len(left))) if (future := submit()) is not None]
            completed = as_completed(first, loop=client.loop)
            for future in completed:
                if future.status in ("cancelled", "lost"):
                    return list(left.values())
                k = going.pop(future)
                if isinstance(future.exception(), KilledWorker) and given_up[k] < retries:
                    again(k)
                else:
                    done(future.result())
                    del left[k]
                # the scheduler forgets it, so that its memory stays as it is
                future.release()
                while len(going) < ahead and (more := submit()) is not None:
                    completed.add(more)
        except lost_errors:
            pass
        return list(left.values())
    except BaseException:
        try:
            client.cancel(list(going), force=True)
        except Exception:  # a cluster that is gone has nothing to cancel
            pass
        raise


def _wait_for_workers(client: Any, patience: float) -> None:
    end = time.monotonic() + patience
    while time.monotonic() < end:
        try:
            if client.status == "running" and client.nthreads():
                return
            if client.status in ("closed", "closing"):
                break
        except Exception:  # not yet
            pass
        time.sleep(0.1)
    raise RopewalkError(f"no scheduler with workers for {patience:g} s: the same call, with a new client, goes on")


@contextlib.contextmanager
def stopped_with_its_task() -> Iterator[_native.Stop]:
    """Stops what a worker computes when nobody wants it any more; the worker itself would let it go on to its end."""
    stop, over = _native.Stop(), threading.Event()
    try:
        from distributed import get_worker

        worker = get_worker()
        tasks, key = worker.state.tasks, worker.get_current_task()
    except (ImportError, ValueError, AttributeError):
        # no worker
        yield stop
        return

    def watch() -> None:
        while not over.wait(LOOK):
            task = tasks.get(key)
            if task is None or task.state == "cancelled":
                stop.set()
                return

    watcher = threading.Thread(target=watch, daemon=True, name="ropewalk")
    watcher.start()
    try:
        yield stop
    finally:
        over.set()


@functools.lru_cache(maxsize=4)
def _shared(words: tuple[str, ...]) -> _native.SharedSweep:
    return _native.SharedSweep(list(words))


def share(words: tuple[str, ...], runs: Sequence[int]) -> tuple[int, int]:
    """Computes runs of a sweep of the command line, on a worker: how many are complete, and how many failed."""
    try:
        with stopped_with_its_task() as stop:
            return _shared(words).compute(list(runs), stop)
    except SystemExit:
        raise RopewalkError(f"this worker can't read the sweep: {' '.join(words)}") from None


class Stopped(BaseException):
    """A signal came."""


def _listen(on: bool) -> None:
    """Lets SIGTERM and SIGHUP end the command as Ctrl-C does, or leaves all of them to what follows."""

    def stop(number: int, _: Any) -> None:
        raise Stopped(number)

    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        # `nohup` ignores a hangup
        if number is not None and (signal.getsignal(number) is not signal.SIG_IGN or name == "SIGINT"):
            signal.signal(number, stop if on else signal.SIG_DFL)


def command(arguments: list[str]) -> int:
    """`ropewalk sweep … --dask ADDRESS`: the runs on the workers, what is missing after that and the table here."""
    try:
        from distributed import Client
    except ImportError:
        print("error: --dask needs Dask\n  = help: pip install distributed", file=sys.stderr)
        return 2
    sweep = _native.SharedSweep(arguments)
    quiet = "--quiet" in arguments or "-q" in arguments
    _listen(True)
    try:
        _, runs, missing, words = sweep.plan()
        if missing:
            there, told = runs - len(missing), time.monotonic()

            def done(result: tuple[int, int]) -> None:
                nonlocal there, told
                there += result[0]
                if not quiet and time.monotonic() > told + 5.0:
                    told = time.monotonic()
                    print(f"{there} of {runs} runs are complete", file=sys.stderr)

            client: Any
            with Client(sweep.address, set_as_default=False) as client:
                work = functools.partial(share, tuple(words))
                each(client, work, missing, done, batch=None, retries=3)
    except Stopped as e:
        name = {2: "Ctrl-C", 15: "SIGTERM"}.get(e.args[0], "SIGHUP")
        print(f"stopped by {name}: the same command computes what is missing", file=sys.stderr)
        return 128 + e.args[0]
    except RopewalkError as e:
        print(f"error: {e}", file=sys.stderr)
        return 2
    except OSError as e:
        print(f"error: the cluster at {sweep.address} can't be reached: {e}", file=sys.stderr)
        return 2
    _listen(False)
    return _native.main("ropewalk", *without_dask(arguments))


def without_dask(arguments: list[str]) -> list[str]:
    """Arguments without `--dask ADDRESS`, and without `--fresh`, which has been done."""
    rest, skip = [], False
    for word in arguments:
        if not skip and word != "--dask" and not word.startswith("--dask=") and word != "--fresh":
            rest.append(word)
        skip = not skip and word == "--dask"
    return rest
