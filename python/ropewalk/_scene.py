"""Scenes: built in Python, or handed over as a name, a path or a dict."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import Any, Union

import numpy as np

from ._errors import SceneError
from ._functions import Held
from ._native import Source
from ._part import Part
from ._parts import Parts

LISTS = ("motions", "elements", "constraints", "forces", "records", "processes")


class Scene(Parts):
    """A scene that is built part by part, with a method for each type:

    >>> scene = Scene(title="A weight on a line")
    >>> rope = dict(mass="0.4 kg/m", ea="50 kN", ei=0.5, diameter="20 mm")
    >>> line = scene.cable(name="line", points=[[0, 0, 0], [0, 0, "-10 m"]], elements=16, section=rope)
    >>> hook = scene.spherical(name="hook", marker=line.start)
    >>> weight = scene.point_mass(name="weight", marker=line.end, mass="8 kg")
    >>> _ = scene.gravity(), scene.position(of=weight)
    >>> scene.set_run(duration="5 s")

    Whatever is wrong is said when the scene is checked or run, with its place.
    """

    def __init__(
        self,
        title: str = "",
        *,
        description: str = "",
        gravity: Sequence[float | str] | None = None,
        folder: str | os.PathLike[str] | None = None,
    ) -> None:
        """`gravity` is the acceleration [m/s²], by default 9.81 downwards; it acts where there is a `gravity()`. Files
        that the scene names are looked for in `folder`."""
        self._scene: dict[str, Any] = {}
        self._functions = Held()
        if title:
            self._scene["title"] = title
        if description:
            self._scene["description"] = description
        if gravity is not None:
            self._scene["gravity"] = list(gravity)
        self.folder = folder

    def parameter(self, name: str, default: Any, description: str = "") -> str:
        """Declares a parameter, which runs and sweeps may set, and returns what stands for it in the scene."""
        entry = {"default": plain(default, self._functions)} | ({"description": description} if description else {})
        self._scene.setdefault("parameters", {})[name] = entry
        return f"${name}"

    def add(self, list: str, type: str, name: str | None = None, /, **fields: Any) -> Part:
        """Adds a part of any type; the methods named after types do the same with their fields checked by editors."""
        if list not in LISTS:
            raise SceneError(f"there is no list {list!r} in a scene\n  = note: the lists are {', '.join(LISTS)}")
        named = {"name": name} if name is not None else {}
        return self._add(list, type, named | fields)

    def _add(self, list: str, type: str, fields: Mapping[str, Any]) -> Part:
        given = {key: plain(value, self._functions) for key, value in fields.items() if value is not None}
        self._scene.setdefault(list, []).append({"type": type} | given)
        return Part(str(given.get("name", type)))

    def _append(self, list: str, fields: Mapping[str, Any]) -> Part:
        given = {key: plain(value, self._functions) for key, value in fields.items() if value is not None}
        self._scene.setdefault(list, []).append(given)
        return Part(str(given.get("name", list)))

    def _set(self, section: str, fields: Mapping[str, Any]) -> None:
        given = {key: plain(value, self._functions) for key, value in fields.items() if value is not None}
        self._scene.setdefault(section, {}).update(given)

    def to_dict(self) -> dict[str, Any]:
        """The scene as it is written in JSON."""
        return json.loads(json.dumps(self._scene))

    def to_toml(self, **parameters: Any) -> str:
        """The scene as a TOML file, with its parameters put in."""
        return source(self).toml(overrides(parameters))

    def __repr__(self) -> str:
        parts = sum(len(self._scene.get(key, [])) for key in LISTS)
        return f"<Scene {self._scene.get('title', '')!r}: {parts} parts>"


AnyScene = Union[str, "os.PathLike[str]", Mapping[str, Any], Scene]
"""A bundled name, the path of a .toml or .json file, a dict, or a `Scene`."""


def plain(value: Any, functions: Held | None = None) -> Any:
    """A value as JSON has it; `functions` keep what it holds of them, which else has to be held by the value."""
    if isinstance(value, Part):
        return str(value)
    if isinstance(value, np.ndarray):
        return value.tolist()
    if callable(value) and not isinstance(value, type):
        return (Held() if functions is None else functions).name_of(value)
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Mapping):
        return {str(key): plain(entry, functions) for key, entry in value.items()}
    if isinstance(value, (list, tuple, range)):
        return [plain(entry, functions) for entry in value]
    return value


def source(scene: AnyScene | Source) -> Source:
    """The text of a scene."""
    if isinstance(scene, Source):
        return scene
    if isinstance(scene, (Scene, Mapping)):
        data, folder = (scene._scene, scene.folder) if isinstance(scene, Scene) else (plain(scene), None)
        try:
            text = json.dumps(data, indent=1, allow_nan=False)
        except (TypeError, ValueError) as e:
            raise SceneError(f"the scene can't be written as JSON: {e}") from None
        return Source.parse("scene", text, True, None if folder is None else os.fspath(folder))
    try:
        return Source.open_scene(os.fspath(scene))
    except TypeError:
        raise SceneError(f"a scene is a name, a path, a dict or a Scene, not {type(scene).__name__}") from None


def overrides(parameters: Mapping[str, Any]) -> list[str]:
    """Parameters as `--set` takes them."""
    return [f"{name}={_toml(plain(value), True)}" for name, value in parameters.items()]


def _toml(value: Any, outermost: bool = False) -> str:
    if isinstance(value, str):
        return value if outermost else json.dumps(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, list):
        return "[" + ", ".join(_toml(entry) for entry in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {_toml(entry)}" for key, entry in value.items()) + "}"
    raise SceneError(f"a parameter is a number, a text, a list or a dict, not {type(value).__name__}")
