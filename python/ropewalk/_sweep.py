"""Many runs of one scene: in threads of this machine, or on a cluster."""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import re
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from ._errors import OutputError, RopewalkError, SceneError, SolverError
from ._run import Run, run
from ._scene import AnyScene, Scene, plain, source
from ._tools import check

if TYPE_CHECKING:
    import pandas as pd

COMPLETE = ("finished", "stopped")
Row = dict[str, Any]
Measure = Callable[[Run], Mapping[str, float]]


class Sweep(Sequence[Row]):
    """Rows of a sweep, one for each combination: parameters, status, message, final values, what was measured."""

    def __init__(self, rows: list[Row], folder: Path) -> None:
        self.rows = rows
        self.folder = folder

    def __getitem__(self, key: Any) -> Any:
        """A row by its number, or a column by its name as an array; NaN where a run has no such value."""
        if not isinstance(key, str):
            return self.rows[key]
        if not any(key in row for row in self.rows):
            there = dict.fromkeys(k for row in self.rows for k in row)
            raise KeyError(f"there is no column {key!r}: there are {', '.join(there)}")
        column = [row.get(key) for row in self.rows]
        if all(x is None or isinstance(x, (int, float)) for x in column):
            return np.array([np.nan if x is None else x for x in column], dtype=np.float64)
        return np.array(column, dtype=object)

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    @property
    def failed(self) -> list[Row]:
        """Rows of runs that didn't come to an end."""
        return [row for row in self.rows if row["status"] not in COMPLETE]

    def to_pandas(self) -> pd.DataFrame:
        """The rows as a pandas table."""
        import pandas as pd

        return pd.DataFrame(self.rows)

    def __repr__(self) -> str:
        return f"<Sweep: {len(self)} runs, {len(self.failed)} failed, in {self.folder}>"


def _meaning(measure: Measure | None) -> list[str]:
    """What tells one function from another. Where in doubt they differ, and runs are computed again."""
    if measure is None:
        return []
    code = getattr(measure, "__code__", None)
    if code is None:
        return [repr(measure)]
    inside = [cell.cell_contents for cell in getattr(measure, "__closure__", None) or ()]
    what = (code.co_code, code.co_consts, code.co_names, getattr(measure, "__defaults__", None), inside)
    return [repr(part) for part in what]


class Job:
    """One scene for all workers: its text, so that it needs no file, and the folder of the rows."""

    def __init__(self, scene: AnyScene, fixed: Mapping[str, Any], folder: Path, measure: Measure | None) -> None:
        text = source(scene)
        self.name, self.text, self.fixed, self.folder, self.measure = text.name, text.text, dict(fixed), folder, measure
        self.files: str | None = None
        if isinstance(scene, Scene):
            self.json, self.files = True, None if scene.folder is None else os.fspath(scene.folder)
        elif isinstance(scene, Mapping):
            self.json = True
        else:
            path = Path(scene)
            self.json = path.suffix.lower() == ".json"
            self.files = str(path.absolute().parent) if path.suffix else None
        self.measured = [_meaning(measure), self.files_in(self.text)]

    def files_in(self, text: str) -> dict[str, str]:
        """Files that a text names, with what is in them: the scene is another one if they change."""
        folder = Path(self.files or ".")
        found = {}
        for name in set(re.findall(r'"([^"\n]+)"|\'([^\'\n]+)\'', text)):
            path = folder / (name[0] or name[1])
            try:
                if path.is_file():
                    found[str(path)] = hashlib.sha256(path.read_bytes()).hexdigest()
            except (OSError, ValueError):
                pass  # no name of a file
        return found

    def source(self) -> _native.Source:
        return _native.Source.parse(self.name, self.text, self.json, self.files)

    def path(self, parameters: Mapping[str, Any]) -> Path:
        """Where the row of a combination is: the same scene, version and parameters have the same."""
        given = plain(self.fixed | dict(parameters))
        what = [_native.__version__, self.text, given, self.measured, self.files_in(json.dumps(given))]
        key = hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()
        return self.folder / f"{key[:24]}.json"

    def row(self, parameters: Mapping[str, Any]) -> Row | None:
        """The row of a combination that is complete."""
        try:
            row = json.loads(self.path(parameters).read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None
        except ValueError:
            return None
        return row if row.get("status") in COMPLETE else None

    def run(self, parameters: Mapping[str, Any], stop: _native.Stop | None = None) -> None:
        """Runs one combination. Its row is written last and whole: a row that is there is a run that is done."""
        row: Row = dict(plain(dict(parameters)))
        try:
            done = run(self.source(), stop=stop, **(self.fixed | dict(parameters)))  # type: ignore[arg-type]
            if done.status not in COMPLETE:
                return
            measured = dict(self.measure(done)) if self.measure else {}
            row |= {"status": done.status, "message": done.summary.get("message"), "warnings": len(done.warnings)}
            row |= done.final | plain(measured)
        except SolverError as e:
            row |= {"status": "failed", "message": str(e)}
        except SceneError as e:
            row |= {"status": "refused", "message": str(e)}
        path = self.path(parameters)
        # two that compute the same write the same; neither sees half of the other's
        part = path.with_suffix(f".{os.getpid()}-{threading.get_ident()}.part")
        try:
            part.write_text(json.dumps(row), encoding="utf-8")
            os.replace(part, path)
        except OSError as e:
            raise OutputError(f"{path} can't be written: {e}") from None

    def run_all(self, batch: Sequence[Mapping[str, Any]]) -> int:
        """Runs several; what another worker has done meanwhile is left as it is."""
        for parameters in batch:
            if self.row(parameters) is None:
                self.run(parameters)
        return len(batch)


def sweep(
    scene: AnyScene,
    vary: Mapping[str, Sequence[Any]],
    *,
    out: str | os.PathLike[str],
    client: Any = None,
    jobs: int | None = None,
    batch: int = 1,
    retries: int = 3,
    measure: Measure | None = None,
    **fixed: Any,
) -> Sweep:
    """Runs all combinations of the values in `vary`; other keywords are parameters that all of them have.

    They run in `jobs` threads of this machine, by default one for each core, or on the workers of a
    `dask.distributed.Client`, `batch` runs at a time: workers should be processes with one thread, and see the folder
    `out`. `measure(run)` adds numbers of one's own to the rows.

    The rows are in `out/rows`. What is there is not computed again, whoever computed it and whatever killed it: the same
    call goes on. Runs that failed are tried again.
    """
    names = list(vary)
    both = [name for name in names if name in fixed]
    if both:
        raise SceneError(f"`{both[0]}` is both varied and set\n  = help: leave away one of them")
    for name, values in vary.items():
        if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
            raise SceneError(f"the values of `{name}` are no list: {values!r}\n  = help: write `[{values!r}]`")
    if jobs is not None and jobs < 1 or batch < 1:
        raise SceneError("`jobs` and `batch` are at least 1")
    grid = [dict(zip(names, values)) for values in itertools.product(*vary.values())]
    if not grid:
        empty = [name for name, values in vary.items() if not list(values)]
        raise SceneError(f"`{empty[0]}` has no values\n  = help: give those that it is to have")
    folder = Path(out).absolute()
    try:
        (folder / "rows").mkdir(parents=True, exist_ok=True)
    except OSError as e:
        raise OutputError(f"can't create {folder / 'rows'}: {e}") from None
    job = Job(scene, fixed, folder / "rows", measure)
    left = [parameters for parameters in grid if job.row(parameters) is None]
    if left:
        # what is wrong with the scene or a name is said once, before anything runs
        check(job.source(), **(fixed | left[0]))  # type: ignore[arg-type]
    if client is None:
        _in_threads(job, left, jobs or _cores())
    else:
        _on_cluster(job, left, client, batch, retries)
    rows = [json.loads(job.path(p).read_text(encoding="utf-8")) for p in grid]
    return Sweep(rows, folder)


def _cores() -> int:
    """Cores that this process may use."""
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _in_threads(job: Job, left: Sequence[Mapping[str, Any]], jobs: int) -> None:
    stop = _native.Stop()
    waiting = iter(left)
    with ThreadPoolExecutor(jobs, "ropewalk") as pool:
        try:
            going = {pool.submit(job.run, p, stop) for p in itertools.islice(waiting, 2 * jobs)}
            while going:
                # a wait without end would keep Ctrl-C waiting on some systems
                done, going = wait(going, timeout=0.05, return_when=FIRST_COMPLETED)
                for future in done:
                    future.result()
                going |= {pool.submit(job.run, p, stop) for p in itertools.islice(waiting, len(done))}
        except BaseException:
            stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _on_cluster(job: Job, left: Sequence[Mapping[str, Any]], client: Any, batch: int, retries: int) -> None:
    from distributed import as_completed

    batches = [left[k : k + batch] for k in range(0, len(left), batch)]
    futures = client.map(job.run_all, batches, retries=retries, pure=False)
    try:
        for future in as_completed(futures):
            future.result()
            # the scheduler forgets it, so that its memory stays as it is
            future.release()
    except BaseException:
        client.cancel(futures)
        raise


__all__ = ["RopewalkError", "Sweep", "sweep"]
