"""A scene as a function of some parameters, for optimisers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from ._errors import SceneError, SolverError
from ._run import Run, run
from ._scene import AnyScene, plain

Measured = Union[float, npt.NDArray[np.float64]]

KEPT = 256
"""Points whose values are kept: optimisers ask for some of them again."""


class Objective:
    """A function of numbers: see `objective`."""

    calls: int
    """Runs so far."""
    best: tuple[npt.NDArray[np.float64], float] | None
    """The least value so far, or the least sum of squares of several, and where it was."""

    def __init__(
        self,
        scene: AnyScene,
        unknowns: Sequence[str] | Mapping[str, str],
        measure: str | Callable[[Run], Any],
        failed: Measured | None,
        fixed: Mapping[str, Any],
    ) -> None:
        units = unknowns if isinstance(unknowns, Mapping) else {name: "" for name in unknowns}
        if isinstance(unknowns, str) or not units:
            raise SceneError("name the parameters that are unknown\n  = help: as in `['ei']` or `{'speed': 'kn'}`")
        both = [name for name in units if name in fixed]
        if both:
            raise SceneError(f"`{both[0]}` is both unknown and set\n  = help: leave away one of them")
        self.scene, self.units, self.measure, self.failed, self.fixed = scene, dict(units), measure, failed, dict(fixed)
        self.calls, self.best = 0, None
        self._kept: dict[tuple[float, ...], Measured] = {}

    def parameters(self, x: Any) -> dict[str, Any]:
        """The parameters of the scene at a point, as `rw.run` takes them."""
        values = [float(v) for v in np.atleast_1d(np.asarray(x, dtype=np.float64)).ravel()]
        if len(values) != len(self.units):
            raise SceneError(f"{len(values)} numbers for {len(self.units)} unknowns: {', '.join(self.units)}")
        return {n: f"{v!r} {unit}" if unit else v for (n, unit), v in zip(self.units.items(), values)} | self.fixed

    def run(self, x: Any) -> Run:
        """The run at a point."""
        return run(self.scene, **self.parameters(x))  # type: ignore[arg-type]

    def __call__(self, x: Any) -> Measured:
        """The value at a point."""
        point = tuple(np.atleast_1d(np.asarray(x, dtype=np.float64)).ravel().tolist())
        if point in self._kept:
            return self._kept[point]
        self.calls += 1
        try:
            done = self.run(x)
            found = done[self.measure][-1] if isinstance(self.measure, str) else self.measure(done)
            value = np.asarray(plain(found), dtype=np.float64)
        except (SolverError, SceneError):
            # before the first value it is the scene or the call that is wrong
            if self.failed is None or not self._kept:
                raise
            value = np.asarray(self.failed, dtype=np.float64)
        result: Measured = float(value) if value.ndim == 0 else value
        if len(self._kept) >= KEPT:
            self._kept.pop(next(iter(self._kept)))
        self._kept[point] = result
        size = result if isinstance(result, float) else float(np.sum(result**2))
        if self.best is None or size < self.best[1]:
            self.best = (np.array(point), size)
        return result

    def __repr__(self) -> str:
        return f"<Objective of {', '.join(self.units)}: {self.calls} runs>"


def objective(
    scene: AnyScene,
    unknowns: Sequence[str] | Mapping[str, str],
    measure: str | Callable[[Run], Any],
    *,
    failed: Measured | None = None,
    **fixed: Any,
) -> Objective:
    """A function of some parameters of a scene, as `scipy.optimize` and others take it.

    `unknowns` are the parameters, with their units if they are a dict: `{"speed": "kn"}`. `measure` is a record, whose last
    value counts, or a function of the run that returns a number, or an array such as residuals for `least_squares`. Where
    a run fails the value is `failed`, and without it the error is raised. Other keywords are parameters that stay.

    >>> import ropewalk as rw
    >>> f = rw.objective("pendulum", ["duration"], lambda run: run["cable.end.z"].min())
    >>> f([0.2]) < f([0.1])
    True
    """
    return Objective(scene, unknowns, measure, failed, fixed)


__all__ = ["Objective", "objective"]
