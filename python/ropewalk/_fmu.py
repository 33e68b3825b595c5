"""Scenes as FMUs: with the shared library that comes with the wheel."""

from __future__ import annotations

import os
from pathlib import Path

from . import _functions, _native
from ._errors import SceneError
from ._scene import AnyScene, overrides, source

HERE = Path(__file__).parent


def library() -> Path | None:
    """The shared library that goes into an FMU, if the wheel was built with it."""
    found = [path for path in HERE.glob("*ropewalk_fmu.*") if path.suffix in (".so", ".dylib", ".dll")]
    return found[0] if found else None


def export_fmu(
    scene: AnyScene,
    path: str | os.PathLike[str] | None = None,
    *,
    library: str | os.PathLike[str] | None = None,
    **parameters: object,
) -> Path:
    """Writes a scene as an FMU for co-simulation by FMI 3.0, by default `SCENE.fmu`, and returns its path.

    Its inputs are those of the scene, its outputs the columns of the records, its parameters those of the scene, with
    these values at first. `library` is the shared library to take along, by default that of the wheel.
    """
    text = source(scene)
    written = ", ".join(f"`{name}`" for name in _functions.meanings(text.text))
    if written:
        raise SceneError(f"an FMU can't take along what is written in Python: {written}\n  = help: use built-in types")
    return Path(_native.export_fmu(text, overrides(parameters), path, library or _own()))


def _own() -> Path:
    found = library()
    if found is None:
        raise SceneError(
            "this build of the package has no library for FMUs\n"
            "  = help: build it by `python python/tools/wheel.py`, or name the library of the crate ropewalk-fmu by `library`"
        )
    return found
