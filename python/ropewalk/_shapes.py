"""Shapes over time: what `field.npy` and `bodies.npy` of a run's folder hold, as arrays for each part."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import OutputError

Array = npt.NDArray[np.float64]

POINT = ("t", "s", "x", "y", "z", "vx", "vy", "vz")


@dataclass(frozen=True, eq=False)
class Line:
    """A cable or chain at the snapshots of a run: arrays (nt, ns), or (nt, ns, 3).

    Where there are fewer points than at other times, since a winch pays out or the part isn't there yet, the rest is NaN.
    """

    t: Array
    """Times of the snapshots [s]: (nt,)."""
    s: Array
    """Unstretched arc length of the points [m]: (nt, ns)."""
    position: Array
    """Places of the points [m]: (nt, ns, 3)."""
    velocity: Array
    """Velocities of the material there [m/s]: (nt, ns, 3)."""
    values: Mapping[str, Array]
    """All else that was recorded along it, by name: `tension`, `curvature`, `moment` and so on, each (nt, ns)."""

    @property
    def tension(self) -> Array:
        """Axial force [N]: (nt, ns)."""
        return self["tension"]

    @property
    def curvature(self) -> Array:
        """Curvature [1/m]: (nt, ns)."""
        return self["curvature"]

    def __getitem__(self, name: str) -> Array:
        """What was recorded under this name: (nt, ns)."""
        try:
            return self.values[name]
        except KeyError:
            raise KeyError(f"no {name!r} was recorded: there are {', '.join(self.values)}") from None

    def __repr__(self) -> str:
        return f"<Line: {self.s.shape[0]} snapshots of {self.s.shape[1]} points; {', '.join(self.values)}>"


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body, or a point that moves, at the snapshots of a run."""

    t: Array
    """Times of the snapshots [s]: (nt,)."""
    position: Array
    """Places [m]: (nt, 3)."""
    quaternion: Array
    """Attitude as unit quaternions w, x, y, z: (nt, 4)."""

    @property
    def attitude(self) -> Array:
        """Rotation matrices, whose columns are the body's axes in space: (nt, 3, 3)."""
        w, x, y, z = self.quaternion.T
        rows = [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
        return np.moveaxis(np.array(rows), 2, 0)

    def __repr__(self) -> str:
        return f"<Body: {len(self.t)} snapshots>"


class Shapes(Mapping[str, Line]):
    """The lines of a run by their names, and its bodies."""

    bodies: Mapping[str, Body]
    """Rigid bodies and points by their names."""

    def __init__(self, lines: Mapping[str, Line], bodies: Mapping[str, Body]) -> None:
        self._lines, self.bodies = lines, bodies

    def __getitem__(self, name: str) -> Line:
        if name not in self._lines:
            if name in self.bodies:
                raise KeyError(f"{name!r} is a body: it is in `shapes.bodies`")
            near = difflib.get_close_matches(name, self._lines, 1)
            remedy = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(self._lines) or 'none'}"
            raise KeyError(f"there is no line {name!r}: {remedy}")
        return self._lines[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._lines)

    def __len__(self) -> int:
        return len(self._lines)

    def __repr__(self) -> str:
        return f"<Shapes of {', '.join([*self._lines, *self.bodies]) or 'nothing'}>"


def read(folder: Path) -> Shapes:
    """Reads what a run left in a folder."""
    there = {name: folder / f"{name}.npy" for name in ("field", "bodies") if (folder / f"{name}.npy").exists()}
    if not there:
        raise OutputError(
            f"{folder} holds no `field.npy`: shapes are recorded with the page, unless that was left out"
        )
    try:
        tables = {name: np.load(path, allow_pickle=False) for name, path in there.items()}
        times = np.unique(np.concatenate([table["t"] for table in tables.values()]))
        lines = _parts(tables["field"], times, _line) if "field" in tables else {}
        bodies = _parts(tables["bodies"], times, _body) if "bodies" in tables else {}
    except (OSError, ValueError, KeyError, IndexError) as e:
        raise OutputError(f"the shapes in {folder} can't be read: {e}") from None
    return Shapes(lines, bodies)


def _parts(table: Any, times: Array, make: Any) -> dict[str, Any]:
    names = dict.fromkeys(table["part"].tolist())
    return {name: make(table[table["part"] == name], times) for name in names}


def _line(rows: Any, times: Array) -> Line:
    at = np.searchsorted(times, rows["t"])
    counts = np.bincount(at, minlength=len(times))
    # the points of a snapshot follow each other
    point = np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)
    ns = int(counts.max(initial=0))

    def spread(*names: str) -> Array:
        array = np.full((len(times), ns, len(names)), np.nan)
        array[at, point] = np.column_stack([rows[name] for name in names])
        return array

    values = {name: spread(name)[..., 0] for name in rows.dtype.names[1 + len(POINT) :]}
    # what none of its points has belongs to other lines
    values = {name: array for name, array in values.items() if not np.isnan(array).all()}
    return Line(times, spread("s")[..., 0], spread("x", "y", "z"), spread("vx", "vy", "vz"), values)


def _body(rows: Any, times: Array) -> Body:
    at = np.searchsorted(times, rows["t"])
    position, quaternion = np.full((len(times), 3), np.nan), np.full((len(times), 4), np.nan)
    position[at] = np.column_stack([rows[name] for name in "xyz"])
    quaternion[at] = np.column_stack([rows[f"q{name}"] for name in "wxyz"])
    return Body(times, position, quaternion)
