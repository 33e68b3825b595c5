"""Runs and what they leave: arrays by name, with units."""

from __future__ import annotations

import difflib
import functools
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _native, _shapes, _show
from ._errors import OutputError, SolverError
from ._scene import AnyScene, overrides, source
from ._shapes import Shapes

if TYPE_CHECKING:
    import pandas as pd

Array = npt.NDArray[np.float64]


def unpack(data: bytearray, columns: int) -> Array:
    """Columns that were handed over as bytes."""
    return np.frombuffer(data, dtype=np.float64).reshape(columns, -1)


class Columns(Mapping[str, Array]):
    """Named columns of numbers, each with a unit.

    `columns["hose.end.z"]` is one of them, `columns["hose.end"]` are the x, y and z of a point as an array (n, 3), or
    all columns whose names begin so.
    """

    units: dict[str, str]
    """Unit of each column; empty for plain numbers."""

    def __init__(self, data: Array, heads: Sequence[Sequence[str]]) -> None:
        self._data = data
        self.units = {name: unit for name, unit in heads}
        self._index = {name: k for k, name in enumerate(self.units)}

    def __getitem__(self, name: str) -> Array:
        if name in self._index:
            return self._data[self._index[name]]
        group = [self._index[f"{name}.{axis}"] for axis in "xyz" if f"{name}.{axis}" in self._index]
        if len(group) < 2:
            group = [k for column, k in self._index.items() if column.startswith(f"{name}.")]
        if not group:
            near = difflib.get_close_matches(name, self._index, 1)
            remedy = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(self._index)}"
            raise KeyError(f"there is no record {name!r}: {remedy}")
        return self._data[group].T

    def __iter__(self) -> Iterator[str]:
        return iter(self._index)

    def __len__(self) -> int:
        return len(self._index)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and (name in self._index or any(c.startswith(f"{name}.") for c in self._index))

    def __eq__(self, other: object) -> bool:
        return self is other

    def __hash__(self) -> int:
        return id(self)

    def to_pandas(self) -> pd.DataFrame:
        """All columns as a pandas table, with their units in its `attrs`; time is the index if it is the first."""
        import pandas as pd

        frame = pd.DataFrame(dict(self.items()))
        frame.attrs["units"] = self.units
        first = next(iter(self))
        return frame.set_index(first) if first in ("t", "load factor") else frame


class Run(Columns):
    """What a run computed: its records over time, or over the load factor in statics. Can be pickled."""

    title: str
    summary: dict[str, Any]
    """How it ended: status, warnings, events, final values, counts, energy, times."""
    scene: str
    """The scene with its parameters put in, as TOML."""
    folder: Path | None
    """The folder with all results, if it was run into one."""

    def __init__(self, data: Array, about: Mapping[str, Any]) -> None:
        super().__init__(data, about["columns"])
        self.title = about["title"]
        self.summary = about["summary"]
        self.scene = about["scene"]
        self.folder = Path(about["folder"]) if about.get("folder") else None

    @property
    def t(self) -> Array:
        """Times of the rows [s], or load factors."""
        return self._data[0]

    @property
    def final(self) -> dict[str, float]:
        """The last value of every column."""
        return {name: float(values[-1]) for name, values in self.items() if len(values)}

    @property
    def status(self) -> str:
        """`finished`, `stopped` (by an event), `interrupted` or `failed`."""
        return self.summary["status"]

    @property
    def warnings(self) -> list[str]:
        """What one should know although the run went on."""
        return self.summary.get("warnings", [])

    @functools.cached_property
    def shapes(self) -> Shapes:
        """Shapes of its lines and bodies over time: `run.shapes["hose"].position` is (times, points, 3), beside
        `velocity`, `tension` and `curvature`; `run.shapes.bodies["ship"]` has `position` and `attitude`. They are in the
        folder of a run: give `out`."""
        if self.folder is None:
            raise OutputError("the shapes of a run are in its folder\n  = help: run it with `out=\"runs/name\"`")
        return _shapes.read(self.folder)

    def plot(self, *names: str, ax: Any = None, **options: Any) -> Any:
        """Draws columns over time by matplotlib; without names all records, one picture for each unit. Returns the axes."""
        return _show.plot(self, names, ax, options)

    def __repr__(self) -> str:
        return f"<Run {self.title!r}: {self.status}, {len(self.t)} rows, {len(self)} columns>"

    def _repr_html_(self) -> str:
        return _show.html(self)


def run(
    scene: AnyScene,
    *,
    out: str | os.PathLike[str] | None = None,
    stop: _native.Stop | None = None,
    **parameters: Any,
) -> Run:
    """Runs a scene, in memory or into a new folder `out`. Other keywords are parameters of the scene.

    Ctrl-C ends it within some hundredths of a second; what was computed until then is the `run` of the exception. For
    runs in other threads, which Python sends no Ctrl-C, `stop` is a `Stop` to be set from elsewhere: such a run ends with
    the status "interrupted".

    Raises SceneError, OutputError, or SolverError, which has what was computed in its `run`.
    """
    data, text, exception = _native.run(source(scene), overrides(parameters), out, stop)
    about = json.loads(text)
    done = Run(unpack(data, len(about["columns"])), about)
    if exception is not None:
        exception.run = done  # type: ignore[attr-defined]
        raise exception
    if about["failed"]:
        raise SolverError(done.summary["message"], done)
    return done


def load(folder: str | os.PathLike[str]) -> Run:
    """Reads what a run left in a folder, whichever way it ended."""
    path = Path(folder)
    data, heads = _native.read_history(path / "history.csv")
    try:
        manifest = json.loads((path / "manifest.json").read_text(encoding="utf-8"))
        scene = (path / "scene.toml").read_text(encoding="utf-8")
        ended = path / "summary.json"
        # a run that goes on, or was killed, has none
        summary = json.loads(ended.read_text(encoding="utf-8")) if ended.exists() else {"status": "unfinished"}
    except (OSError, ValueError) as e:
        raise OutputError(f"{path} is no folder of a run: {e}") from None
    columns = json.loads(heads)
    about = {"title": manifest["title"], "columns": columns, "summary": summary, "scene": scene, "folder": str(path)}
    return Run(unpack(data, len(columns)), about)
