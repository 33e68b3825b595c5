"""What else is asked of scenes: whether they are right, how they vibrate, what there is."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from . import _native
from ._errors import SceneError
from ._run import Array, Columns, unpack
from ._scene import AnyScene, overrides, source


class Checked(dict[str, Any]):
    """What a scene consists of; its text is what `ropewalk check` shows."""

    def __init__(self, about: Mapping[str, Any], text: str) -> None:
        super().__init__(about)
        self._text = text

    def __str__(self) -> str:
        return self._text

    def __reduce__(self) -> tuple[Any, ...]:
        return Checked, (dict(self), self._text)


def check(scene: AnyScene, **parameters: Any) -> Checked:
    """Builds a scene without running it: its parts, terms, constraints, records and unknowns. Raises SceneError with the
    place of what is wrong."""
    about, text = _native.check(source(scene), overrides(parameters))
    return Checked(json.loads(about), text)


class Modes(Columns):
    """Vibration modes, lowest first: columns such as `frequency`, `damping ratio`, `growth` and `share.x`."""

    shapes: Array
    """Moves of all nodes in each mode: (modes, nodes, 3)."""
    rest: Array
    """Places of the nodes in equilibrium [m]: (nodes, 3)."""
    unstable: bool
    """Whether the equilibrium is unstable: then these are the modes that grow."""
    critical: float | None
    """How far the loads may grow until it tips over."""
    warnings: Sequence[str]

    def __init__(self, data: Array, shapes: Array, about: Mapping[str, Any]) -> None:
        super().__init__(data, about["columns"])
        self.title: str = about["title"]
        self.rest, self.shapes = shapes[0], shapes[1:]
        self.unstable, self.critical, self.warnings = about["unstable"], about["critical"], about["warnings"]

    @property
    def frequency(self) -> Array:
        """Frequencies [Hz]."""
        return self["frequency"]

    def __repr__(self) -> str:
        return f"<Modes {self.title!r}: {len(self.frequency)} from {self.frequency.min(initial=float('inf')):.4g} Hz>"


def modes(scene: AnyScene, count: int = 20, *, at: float | None = None, **parameters: Any) -> Modes:
    """The `count` lowest vibration modes about the equilibrium of a scene, with its loads and motions at the time `at`."""
    if count < 1:
        raise SceneError(f"the number of modes must be at least 1, not {count}")
    data, shapes, text = _native.modes(source(scene), overrides(parameters), count, at)
    about = json.loads(text)
    return Modes(unpack(data, len(about["columns"])), unpack(shapes, 1).reshape(-1, about["nodes"], 3), about)


def list() -> dict[str, str]:
    """The bundled scenes and their titles."""
    return dict(_native.bundled())


def describe(what: str) -> str:
    """Explains a scene, a type such as "cable", or a section such as "solver": fields with units and defaults."""
    return _native.describe(what)


def schemas() -> dict[str, dict[str, Any]]:
    """JSON schemas of all types, by list and type ("elements.cable"), of sections ("run"), and of lists without types
    ("inputs[]"). They describe values after parameters are put in, without the `type` of a part."""
    every = json.loads(_native.schemas())
    return {s.get("section") or f"{s['list']}.{s['type']}": s["schema"] for s in every}
