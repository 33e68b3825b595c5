"""What can go wrong. Everything is a RopewalkError; Ctrl-C stays a KeyboardInterrupt."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._run import Run


class RopewalkError(Exception):
    """Base of all errors of this package."""


class SceneError(RopewalkError, ValueError):
    """The scene or an argument is wrong; the text shows the place and what would be right."""


class OutputError(RopewalkError, OSError):
    """Results could not be written or read."""

    def __init__(self, message: str) -> None:
        super().__init__(message)


class SolverError(RopewalkError, RuntimeError):
    """The solver gave up. `run` holds what was computed until then, if anything was."""

    run: Run | None

    def __init__(self, message: str, run: Run | None = None) -> None:
        super().__init__(message)
        self.run = run

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.args[0], self.run)


class FunctionError(SolverError):
    """A force or motion written in Python raised an exception, which is the `__cause__` of this one, or gave no number."""
