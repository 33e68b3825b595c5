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

from . import _cluster, _functions, _native
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

    @property
    def columns(self) -> list[str]:
        """Names of all columns: parameters, status, message, warnings, final values, what was measured."""
        return list(dict.fromkeys(key for row in self.rows for key in row))

    def to_pandas(self) -> pd.DataFrame:
        """The rows as a pandas table."""
        import pandas as pd

        return pd.DataFrame(self.rows)

    def to_parquet(self, path: str | os.PathLike[str] | None = None) -> Path:
        """Writes the rows as a Parquet file, by default `table.parquet` in the folder, all or nothing; needs pyarrow.

        A column is of numbers where all its values are, and of text else; what a run doesn't have is null."""
        try:
            import pyarrow as pa
            import pyarrow.parquet as pq
        except ImportError:
            raise ImportError("Parquet files need pyarrow: pip install pyarrow") from None
        path = self.folder / "table.parquet" if path is None else Path(path)
        table = pa.table({name: pa.array(*_parquet([row.get(name) for row in self.rows])) for name in self.columns})
        about = {"ropewalk": _native.__version__, "folder": str(self.folder)}
        part = path.with_name(f".{path.name}.{os.getpid()}.part")
        try:
            pq.write_table(table.replace_schema_metadata(about), part)
            os.replace(part, path)
        except OSError as e:
            part.unlink(missing_ok=True)
            raise OutputError(f"{path} can't be written: {e}") from None
        return path

    def __repr__(self) -> str:
        return f"<Sweep: {len(self)} runs, {len(self.failed)} failed, in {self.folder}>"


def _parquet(values: list[Any]) -> tuple[list[Any], str]:
    """Values of a column as one type, and its name."""
    there = [x for x in values if x is not None]
    if all(isinstance(x, bool) for x in there) and there:
        return values, "bool_"
    if all(isinstance(x, int) and abs(x) < 2**63 for x in there) and there:
        return values, "int64"
    if all(isinstance(x, (int, float)) for x in there):
        return [None if x is None else float(x) for x in values], "float64"
    return [x if x is None or isinstance(x, str) else json.dumps(x) for x in values], "string"


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
        what = [_native.__version__, self.text, _functions.meaning(measure), self.files_in(self.text)]
        # as it was before there were any
        what += [functions] if (functions := _functions.meanings(self.text)) else []
        self.key = hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()

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
        what = [self.key, given, self.files_in(json.dumps(given))]
        key = hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()
        return self.folder / f"{key[:24]}.json"

    def row(self, parameters: Mapping[str, Any]) -> Row | None:
        """The row of a combination that is complete."""
        try:
            row = json.loads(self.path(parameters).read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError):
            return None
        return row if row.get("status") in COMPLETE else None

    def run(self, parameters: Mapping[str, Any], stop: _native.Stop | None = None) -> None:
        """Runs one combination. Its row is written last and whole: a row that is there is a run that is done."""
        text = self.compute(parameters, stop)
        if text is not None:
            self.write(self.path(parameters), text)

    def compute(self, parameters: Mapping[str, Any], stop: _native.Stop | None = None) -> str | None:
        """The row of one combination as it is kept; none if it was stopped."""
        row: Row = dict(plain(dict(parameters)))
        try:
            done = run(self.source(), stop=stop, **(self.fixed | dict(parameters)))  # type: ignore[arg-type]
            if done.status not in COMPLETE:
                return None
            measured = dict(self.measure(done)) if self.measure else {}
            row |= {"status": done.status, "message": done.summary.get("message"), "warnings": len(done.warnings)}
            row |= done.final | plain(measured)
        except SolverError as e:
            row |= {"status": "failed", "message": str(e)}
        except SceneError as e:
            row |= {"status": "refused", "message": str(e)}
        return json.dumps(row)

    def write(self, path: Path, text: str) -> None:
        """Keeps a row. Two that compute the same write the same; neither sees half of the other's."""
        part = path.with_suffix(f".{os.getpid()}-{threading.get_ident()}.part")
        try:
            part.write_text(text, encoding="utf-8")
            os.replace(part, path)
        except OSError as e:
            try:
                part.unlink(missing_ok=True)
            except OSError:
                pass  # what can't be deleted does no harm
            raise OutputError(f"{path} can't be written: {e}") from None

    def run_all(self, batch: Sequence[Mapping[str, Any]]) -> list[tuple[str, str]]:
        """Runs several on a worker; what another one has done meanwhile is left as it is. Rows that couldn't be written
        here, with the names of their files: whoever asked may have more room."""
        unwritten = []
        with _cluster.stopped_with_its_task() as stop:
            for parameters in batch:
                if self.row(parameters) is not None:
                    continue
                text = self.compute(parameters, stop)
                if text is None:
                    continue
                path = self.path(parameters)
                try:
                    self.write(path, text)
                except OutputError:
                    unwritten.append((path.name, text))
        return unwritten

    def write_all(self, rows: Sequence[tuple[str, str]]) -> None:
        """Keeps what a worker couldn't write."""
        for name, text in rows:
            self.write(self.folder / name, text)


def _drawn(values: Sequence[str]) -> list[Any]:
    """Numbers without units as such."""

    def number(text: str) -> Any:
        try:
            return int(text)
        except ValueError:
            return float(text)

    try:
        return [number(text) for text in values]
    except ValueError:
        return list(values)


def combinations(
    vary: Mapping[str, Sequence[Any] | str], samples: int | None, seed: int, latin: bool
) -> list[dict[str, Any]]:
    """The parameters of all runs, the last one changing fastest; those that are drawn change together, faster still."""
    if samples is not None and samples < 1:
        raise SceneError("`samples` is at least 1")
    drawn: dict[str, list[Any]] = {}
    for name, values in vary.items():
        if isinstance(values, str):
            found = _native.samples(name, values, samples or 1, seed, latin)
            if found is None:
                raise SceneError(f"the values of `{name}` are no list: {values!r}\n  = help: write `[{values!r}]`")
            if samples is None:
                raise SceneError(f"`{name}` is a range to draw from\n  = help: say how often, as in `samples=100`")
            drawn[name] = _drawn(found)
        elif isinstance(values, bytes) or not isinstance(values, Iterable):
            raise SceneError(f"the values of `{name}` are no list: {values!r}\n  = help: write `[{values!r}]`")
    if samples is not None and not drawn:
        raise SceneError("there is no range to draw samples from\n  = help: give one, as in `{'speed': '5..25 kn'}`")
    listed = {name: values for name, values in vary.items() if name not in drawn}
    grid = []
    for values in itertools.product(*listed.values()):
        for k in range(samples or 1):
            some = dict(zip(listed, values)) | {name: all[k] for name, all in drawn.items()}
            grid.append({name: some[name] for name in vary})
    return grid


def sweep(
    scene: AnyScene,
    vary: Mapping[str, Sequence[Any] | str],
    *,
    out: str | os.PathLike[str],
    samples: int | None = None,
    seed: int = 1,
    latin: bool = False,
    client: Any = None,
    jobs: int | None = None,
    batch: int | None = None,
    retries: int = 3,
    measure: Measure | None = None,
    **fixed: Any,
) -> Sweep:
    """Runs all combinations of the values in `vary`; other keywords are parameters that all of them have.

    With `samples` values may be ranges such as `"5..25 kn"`, or `"4..64:1"` for whole numbers, from which so many are
    drawn at random, the same ones on every machine for the same `seed`; `latin` spreads them evenly (Latin hypercube).

    They run in `jobs` threads of this machine, by default one for each core, or on the workers of a
    `dask.distributed.Client`, `batch` runs at a time (by default what seems fit): workers should be processes with one
    thread, and see the folder `out`. A worker that is killed loses nothing, nor does one whose disk is full; a scheduler that is lost may come back
    within a minute, `retries` times. `measure(run)` adds numbers of one's own to the rows.

    The rows are in `out/rows`. What is there is not computed again, whoever computed it and whatever killed it: the same
    call goes on. Runs that failed are tried again.
    """
    names = list(vary)
    both = [name for name in names if name in fixed]
    if both:
        raise SceneError(f"`{both[0]}` is both varied and set\n  = help: leave away one of them")
    if jobs is not None and jobs < 1 or batch is not None and batch < 1:
        raise SceneError("`jobs` and `batch` are at least 1")
    grid = combinations(vary, samples, seed, latin)
    if not grid:
        empty = [name for name, values in vary.items() if not list(values)]
        raise SceneError(f"`{empty[0]}` has no values\n  = help: give those that it is to have")
    folder = Path(out).absolute()
    try:
        (folder / "rows").mkdir(parents=True, exist_ok=True)
    except OSError as e:
        raise OutputError(f"can't create {folder / 'rows'}: {e}") from None
    job = Job(scene, fixed, folder / "rows", measure)
    rows = [job.row(parameters) for parameters in grid]
    left = [parameters for parameters, row in zip(grid, rows) if row is None]
    if left:
        # what is wrong with the scene or a name is said once, before anything runs
        check(job.source(), **(fixed | left[0]))  # type: ignore[arg-type]
    if client is None:
        _in_threads(job, left, jobs or _cores())
    else:
        _cluster.each(client, job.run_all, left, job.write_all, batch=batch, retries=retries)
    there = [row or json.loads(job.path(p).read_text(encoding="utf-8")) for p, row in zip(grid, rows)]
    return Sweep(there, folder)


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


__all__ = ["RopewalkError", "Sweep", "sweep"]
