"""What is asked of many runs of one scene: what accuracy costs, what its effects do, how far a run can be trusted."""

from __future__ import annotations

import csv
import json
import math
import os
import re
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _native
from ._errors import SceneError
from ._scene import AnyScene, overrides, source

if TYPE_CHECKING:
    import pandas as pd


def seconds(time: float | str) -> float:
    """A length of time [s], of a number or a text such as "10 min"."""
    units = {"ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}
    if isinstance(time, str):
        found = re.fullmatch(r"\s*([-+.\deE]+)\s*(ms|s|min|h)\s*", time)
        try:
            value = float(found[1]) * units[found[2]] if found else math.nan
        except ValueError:
            value = math.nan
    else:
        value = float(time)
    if not 0.0 < value < math.inf:
        raise SceneError(f"{time!r} is no length of time\n  = help: write seconds, or a text such as '10 min'")
    return value


def _number(cell: str) -> Any:
    try:
        return float(cell)
    except ValueError:
        return cell


class Cost:
    """What the accuracy of a record costs in a scene."""

    advice: Sequence[Mapping[str, Any]]
    """The cheapest settings for relative errors from 1 % to 1e-6: accuracy, settings, recipe, error, cpu_s; None where none
    were found."""
    uncertainty: float
    """How far the reference may be from the truth, relative to the size of the record; NaN without a reference."""
    runs: Sequence[Mapping[str, Any]]
    """All runs that were timed: elements, models, step or tolerance, scheme, CPU time, steps, error."""
    scenes: Mapping[float, str]
    """The scene with the settings for each accuracy, as TOML."""
    report: str
    """All of it for people."""

    def __init__(self, record: str, about: Mapping[str, Any], folder: Path) -> None:
        self.record = record
        self.advice, self.report = about["advice"], about["report"]
        self.uncertainty = math.nan if about["uncertainty"] is None else about["uncertainty"]
        self.runs = []
        if (folder / "table.csv").exists():
            with open(folder / "table.csv", encoding="utf-8", newline="") as file:
                self.runs = [{key: _number(cell) for key, cell in row.items()} for row in csv.DictReader(file)]
        files = sorted((folder / "advice").glob("*.toml"))
        self.scenes = {float(file.stem): file.read_text(encoding="utf-8") for file in files}

    def cheapest(self, accuracy: float) -> Mapping[str, Any]:
        """The cheapest settings whose error is at most this."""
        good = [a for a in self.advice if a["error"] is not None and a["accuracy"] <= accuracy * (1 + 1e-9)]
        if not good:
            raise ValueError(f"no settings were found for an error of {accuracy:g} of {self.record}")
        return min(good, key=lambda a: a["cpu_s"])

    def to_pandas(self) -> pd.DataFrame:
        """The runs as a pandas table."""
        import pandas as pd

        return pd.DataFrame(self.runs)

    def plot(self, ax: Any = None) -> Any:
        """Draws errors over CPU time by matplotlib."""
        from ._show import pyplot

        if ax is None:
            _, ax = pyplot().subplots(layout="constrained")
        points = [(run["cpu [s]"], run["error"]) for run in self.runs]
        points = [p for p in points if all(isinstance(x, float) and x > 0 for x in p)]
        if points:
            ax.loglog(*zip(*points), "o")
        ax.set_xlabel("CPU time [s]")
        ax.set_ylabel(f"relative error of {self.record}")
        return ax

    def __repr__(self) -> str:
        return f"<Cost of {self.record}: {len(self.runs)} runs, uncertainty {self.uncertainty:.1e}>"


def cost(
    scene: AnyScene,
    of: str,
    *,
    budget: float | str = "10 min",
    out: str | os.PathLike[str] | None = None,
    fresh: bool = False,
    **parameters: Any,
) -> Cost:
    """What the accuracy of a record costs: the cheapest mesh, models, scheme and step for errors from 1 % to 1e-6.

    `of` is a record, or one of its columns, over the whole run, or `"height@60s"` at one time. The search ends after the
    wall time `budget`; with a folder `out` the same call goes on. Runs are timed one after the other: leave the machine
    to them.
    """
    given, spend = overrides(parameters), seconds(budget)
    if out is not None:
        folder = Path(out)
        return Cost(of, json.loads(_native.cost(source(scene), given, of, spend, folder, fresh)), folder)
    with tempfile.TemporaryDirectory(prefix="ropewalk-") as name:
        folder = Path(name) / "cost"
        return Cost(of, json.loads(_native.cost(source(scene), given, of, spend, folder, fresh)), folder)


class Effects:
    """What each effect of a scene costs and does, and what others would add."""

    costs: Sequence[Mapping[str, Any]]
    """Where the time of the run went: terms, constraints, solver, the rest."""
    work: Sequence[Mapping[str, Any]]
    """Work that each effect does on the motion [J], and its largest force [N]."""
    without: Mapping[str, float | None]
    """How far the record changes without each effect, relative to its largest size; None where that doesn't run."""
    added: Mapping[str, float | None]
    """How far it changes with each effect that the scene lacks and that could be tried."""
    can_be_left_out: Sequence[str]
    """Effects that together change the record by less than the accuracy."""
    own_error: float | None
    """How far finer steps change the record: smaller changes can't be told."""

    def __init__(self, about: Mapping[str, Any]) -> None:
        def change(trial: Mapping[str, Any]) -> float | None:
            return trial["verdict"].get("ran", {}).get("change")

        self.ledger = about
        self.record, self.costs, self.work, self.own_error = (about[k] for k in ("record", "costs", "work", "own_error"))
        self.without = {trial["name"]: change(trial) for trial in about["without"]}
        self.added = {trial["name"]: change(trial) for trial in about["with"]}
        self.can_be_left_out = about["advice"]["names"] if about["advice"] else []

    def to_pandas(self) -> pd.DataFrame:
        """All trials as a pandas table."""
        import pandas as pd

        trials = [("without", self.without), ("with", self.added)]
        rows = [{"effect": name, "trial": kind, "change": x} for kind, all in trials for name, x in all.items()]
        return pd.DataFrame(rows)

    def __repr__(self) -> str:
        return f"<Effects on {self.record}: {len(self.without)} present, {len(self.added)} others tried>"


def effects(scene: AnyScene, of: str, *, accuracy: float = 1e-2, **parameters: Any) -> Effects:
    """What each effect of a scene costs and does, what its absence would change in the record `of`, and what absent
    effects would add. Changes below `accuracy`, relative to the record's largest size, don't matter."""
    return Effects(json.loads(_native.effects(source(scene), overrides(parameters), of, accuracy)))


class Certificate:
    """How far a run can be trusted: what tighter steps and a finer mesh change in it."""

    records: Sequence[Mapping[str, Any]]
    """For each record: size, unit, and its relative change by tighter steps (`step`) and by the finer mesh (`mesh`)."""
    tolerance: float
    """What the changes are held against."""
    holds: bool
    """Whether all records are known to the tolerance."""
    sensitive: bool
    """Whether small changes make large ones, as in chaotic motion."""
    cause: str | None
    """What the error hangs on: `newton`, `steps`, `mesh` or `motion`."""
    text: str
    """All of it for people."""

    def __init__(self, about: Mapping[str, Any]) -> None:
        self.records, self.tolerance, self.holds = about["records"], about["tolerance"], about["holds"]
        self.sensitive, self.cause, self.text = about["sensitive"], about.get("cause"), about["text"]
        self.settings: str = about["settings"]
        self.failures: Sequence[str] = about["failures"]

    def __repr__(self) -> str:
        return f"<Certificate: {'holds' if self.holds else 'does not hold'} to {self.tolerance:g}>\n{self.text}"


def certify(scene: AnyScene, of: str | None = None, **parameters: Any) -> Certificate:
    """Runs a scene again with steps ten times tighter, and with three times as many elements, and says what that changes:
    in the record `of`, such as `"hose.end"` or `"height@60s"`, or in all."""
    return Certificate(json.loads(_native.certify(source(scene), overrides(parameters), of)))


__all__ = ["Certificate", "Cost", "Effects", "certify", "cost", "effects"]
