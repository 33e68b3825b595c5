"""Forces and motions written in Python: what makes arrays of the state, and numbers of what functions give."""

from __future__ import annotations

import difflib
import inspect
import json
import threading
import traceback
import weakref
from collections import deque
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Any, TypeVar, overload

import numpy as np

from . import _native

Callback = Callable[..., Any]
F = TypeVar("F", bound=Callback)

STATE = ("t", "position", "velocity", "slope", "attitude", "angular_velocity")
"""What functions may ask for by the names of their arguments, and what tells whether derivatives are zero."""
BESIDES = ("s", "diameter")
"""What they may ask for along cables besides."""

_lock = threading.Lock()
_registered: dict[str, Callback] = {}
"""Those that `function` has made known: for good."""
_held: dict[str, weakref.ref[Callback]] = {}
"""Those that scenes hold: as long as one does."""
_gone: deque[str] = deque()
"""Names of held functions that nobody holds any more, until they are forgotten."""


@overload
def function(name: F, /) -> F: ...
@overload
def function(name: str, /) -> Callable[[F], F]: ...
def function(name: Any, /) -> Any:
    """Makes a function known to the scenes of this process as a type of force or motion, under its own name or another:

    >>> import ropewalk as rw
    >>> @rw.function("tug")
    ... def tug(position, stiffness=30.0):
    ...     return [0, 0, -stiffness * position[2]]

    From here on `[[forces]]` may say `type = "tug"`, `marker = "line.end"`, `stiffness = "40 N/m"`. A scene that is built
    in Python, or a dict, may hold the function itself: `scene.function(function=tug, marker=line.end)`.

    Arguments named `t`, `position`, `velocity`, `attitude` (a rotation matrix) and `angular_velocity` are those of the
    marker; all others are parameters that the scene sets. It returns a force, or a force and a moment on a body, in space.
    Without `marker` it acts along cables: `s`, `position`, `velocity`, `slope` and `diameter` are arrays over all stations of
    a cable, and it returns forces per unstretched length, (n, 3); that at one station may only depend on what is there.
    A motion is a function of `t`: it returns the displacement, or (displacement, velocity[, acceleration]).

    Derivatives are differences, and only taken for what a function asks for. This is slow, and to try things out. What it
    raises ends the run with a `FunctionError`, whose `__cause__` it is; numbers that aren't finite end it too if smaller
    steps don't help. What is made known here stays so, and in this process: the command line doesn't know it, nor do workers
    elsewhere that don't register it by themselves. A function that a scene holds is forgotten with the scene.
    """
    if isinstance(name, str):

        def register(f: Any) -> Any:
            _register(name, f)
            return f

        return register
    if not callable(name):
        raise TypeError(f"a function is expected, or a name for one, not {type(name).__name__}")
    _register(getattr(name, "__name__", type(name).__name__), name)
    return name


def _register(name: str, f: Callback) -> None:
    binding = Binding(name, f, lambda: f)
    with _lock:
        _held.pop(name, None)
        _registered[name] = f
        _native.register(name, binding)
    _clean()


class Held(dict[str, Callback]):
    """The functions of a scene by their names: what keeps them known. A copy of the scene holds the same ones, one that was
    sent to another process none."""

    def __deepcopy__(self, _: Any) -> Held:
        return Held(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return Held, ()

    def name_of(self, f: Callback) -> str:
        """The name of a function in scenes; it is known from here on, as long as this or another one holds it."""
        _clean()
        for name, known in _known():
            if known is f:
                self[name] = f
                return name
        own = getattr(f, "__name__", type(f).__name__).replace("<lambda>", "lambda")
        try:
            held = weakref.ref(f)
        except TypeError:
            raise TypeError(f"{f!r} can't be held by a scene: write a function in Python around it") from None
        binding = Binding(own, f, held)
        with _lock:
            name, k = own, 1
            while name in _registered or name in _held:
                name, k = f"{own}-{k + 1}", k + 1
            binding.name = name
            _held[name] = held
            _native.register(name, binding)
        weakref.finalize(f, _forget, name).atexit = False
        self[name] = f
        return name


def _known() -> list[tuple[str, Callback]]:
    """All functions of this process."""
    with _lock:
        held = [(name, f()) for name, f in _held.items()]
        return [*_registered.items(), *((name, f) for name, f in held if f is not None)]


def _forget(name: str) -> None:
    """Nobody holds the function of this name any more. Python may say so at any moment, even while another is registered."""
    _gone.append(name)
    _clean()


def _clean() -> None:
    """Forgets what is gone, unless the lists are in use: then it is done with the next one."""
    while _gone and _lock.acquire(blocking=False):
        try:
            name = _gone.popleft() if _gone else ""
            held = _held.get(name)
            if held is not None and held() is None:
                del _held[name]
                _native.forget(name)
        finally:
            _lock.release()


def named(text: str) -> dict[str, Callback]:
    """The functions that a scene names."""
    return {name: f for name, f in sorted(_known(), key=lambda known: known[0]) if f'"{name}"' in text or f"'{name}'" in text}


def meanings(text: str) -> dict[str, list[str]]:
    """What tells the functions that a scene names from others of these names."""
    return {name: meaning(f) for name, f in named(text).items()}


def meaning(f: Callback | None) -> list[str]:
    """What tells one function from another. Where in doubt they differ."""
    if f is None:
        return []
    code = getattr(f, "__code__", None)
    if code is None:
        return [repr(f)]
    inside = [cell.cell_contents for cell in getattr(f, "__closure__", None) or ()]
    what = (code.co_code, code.co_consts, code.co_names, getattr(f, "__defaults__", None), inside)
    return [repr(part) for part in what]


class Binding:
    """A function that waits for its parameters."""

    def __init__(self, name: str, f: Callback, found: Callable[[], Callback | None]) -> None:
        """`found` gives the function as long as it is there."""
        self.name, self.found = name, found
        try:
            arguments = inspect.signature(f).parameters.values()
        except (TypeError, ValueError):
            raise TypeError(f"the arguments of {f!r} can't be seen: write a function in Python around it") from None
        for a in arguments:
            if a.kind in (a.POSITIONAL_ONLY, a.VAR_POSITIONAL, a.VAR_KEYWORD):
                raise TypeError(f"`{name}` takes `{a}`: name each argument, since they are given by their names")
        self.arguments = {a.name: a.default is not a.empty for a in arguments}

    def __call__(self, text: str) -> Bound:
        given = {key: _si(value) for key, value in json.loads(text).items()}
        own = [a for a in self.arguments if a not in (*STATE, *BESIDES)]
        for key in given:
            if key not in own:
                near = difflib.get_close_matches(key, own, 1)
                remedy = f"did you mean `{near[0]}`?" if near else f"those that it has are {', '.join(own) or 'none'}"
                raise ValueError(f"the function `{self.name}` has no parameter `{key}`; {remedy}")
        for a in own:
            if a not in given and not self.arguments[a]:
                raise ValueError(f"the function `{self.name}` needs the parameter `{a}`")
        return Bound(self, [a for a in self.arguments if a in (*STATE, *BESIDES)], given)


def _si(value: Any) -> Any:
    """Texts that are numbers with a unit as numbers in SI units."""
    if isinstance(value, str):
        number = _native.si(value)
        return value if number is None else number
    if isinstance(value, list):
        return [_si(entry) for entry in value]
    return value


class Bound:
    """A function with its parameters; what it gets and gives are bytes of numbers. It doesn't keep the function: who runs
    the scene does, so that Python sees where a function refers to what it is part of, and frees both."""

    def __init__(self, binding: Binding, asks: list[str], given: Mapping[str, Any]) -> None:
        self.binding, self.asks, self.given = binding, asks, dict(given)
        self.reads = [name in asks for name in STATE]
        self.function()

    def function(self) -> Callback:
        f = self.binding.found()
        if f is None:
            raise ValueError(f"the function `{self.binding.name}` is gone with the scene that held it")
        return f

    def _call(self, **state: Any) -> Any:
        for name in self.asks:
            if name not in state:
                raise TypeError(f"there is no `{name}` here: this function sees {', '.join(state)}")
        return self.function()(**{name: state[name] for name in self.asks}, **self.given)

    def force(self, t: float, state: bytes) -> bytes:
        x = np.frombuffer(state)
        given = self._call(
            t=t, position=x[0:3], velocity=x[3:6], attitude=x[6:15].reshape(3, 3), angular_velocity=x[15:18]
        )
        f = numbers(given)
        if f.shape not in ((3,), (6,), (2, 3)):
            raise ValueError(f"a force has 3 numbers, and with a moment (2, 3), not {f.shape}")
        both = np.zeros(6)
        both[: f.size] = f.ravel()
        return both.tobytes()

    def load(self, t: float, state: bytes) -> bytes:
        x = np.frombuffer(state).reshape(-1, 11)
        given = self._call(
            t=t, s=x[:, 0], diameter=x[:, 1], position=x[:, 2:5], velocity=x[:, 5:8], slope=x[:, 8:11]
        )
        f = numbers(given)
        if f.shape == (3,):
            f = np.broadcast_to(f, (len(x), 3))
        if f.shape != (len(x), 3):
            raise ValueError(f"forces along a cable with {len(x)} stations are ({len(x)}, 3), not {f.shape}")
        return np.ascontiguousarray(f).tobytes()

    def motion(self, t: float, _: bytes) -> bytes:
        given = self._call(t=t)
        x = numbers(given)
        if x.ndim == 0:
            x = np.array([float(x), 0.0, 0.0])
        if x.shape not in ((3,), (1, 3), (2, 3), (3, 3)):
            raise ValueError(
                "a motion is a displacement of 3 numbers, or (displacement, velocity[, acceleration]) of 3 numbers each, "
                f"not {x.shape}"
            )
        return np.ascontiguousarray(x).tobytes()


def numbers(given: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    """What a function gave."""
    if given is None:
        raise TypeError("it returned None: is a `return` missing?")
    try:
        return np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise TypeError(f"numbers are expected, not {given!r:.80}") from None


def said(e: BaseException, where: TracebackType | None = None) -> str:
    """An exception as the end of a sentence about a function."""
    frames = [f for f in traceback.extract_tb(where or e.__traceback__) if f.filename != __file__]
    place = f", in line {frames[-1].lineno} of {frames[-1].filename}" if frames else ""
    text = f": {e}" if str(e) else ""
    return f"raised {type(e).__name__}{text}{place}"
