"""A scene that is moved step by step."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _native
from ._errors import SceneError
from ._functions import named
from ._run import Array
from ._scene import AnyScene, overrides, source


@dataclass(frozen=True)
class State:
    """All that a simulation needs to go on as if nothing had happened. Can be pickled and compared."""

    t: float
    data: bytes

    def __repr__(self) -> str:
        return f"<State at t = {self.t} s, {len(self.data)} bytes>"


class Simulation:
    """A scene in motion, from its start at t = 0:

    >>> sim = Simulation("pendulum")
    >>> while not sim.done:
    ...     sim = sim.advance(0.1)
    >>> sim.t, sim["cable.end"].shape
    (1.2, (3,))
    """

    def __init__(self, scene: AnyScene, **parameters: Any) -> None:
        """Builds the scene and brings it to its start; keywords are parameters of the scene."""
        text, given = source(scene), overrides(parameters)
        self._functions = named("\n".join([text.text, *given]))
        self._native = _native.Simulation(text, given)
        columns = self._native.columns()
        self._index = {name: k for k, (name, _) in enumerate(columns)}
        self.units = dict(columns)
        """Unit of each record's columns; empty for plain numbers."""
        self._duration = self._native.duration

    def advance(self, dt: float | None = None, *, to: float | None = None) -> Simulation:
        """Moves on by `dt` [s], or to the time `to`; not beyond the `duration` of the scene or an event that stops it.

        Ctrl-C ends it after a step: the state is good, and it can go on."""
        if to is None and dt is not None:
            if not 0.0 <= dt < math.inf:
                raise SceneError(f"a time step is a positive time, not {dt} s")
            self._native.advance_by(dt)
            return self
        if to is None or dt is not None:
            raise TypeError("give either a time step `dt` or a time `to`")
        if self._duration < to < math.inf:
            raise SceneError(f"the run ends at {self._duration} s, before {to} s\n  = help: raise the `duration` of [run]")
        if to == math.inf or not self._native.advance_to(to, False):
            raise SceneError(f"the simulation is at t = {self._native.t} s and can't go on to {to} s")
        return self

    def step(self) -> Simulation:
        """Takes one step of the solver, as long as it likes."""
        self._native.advance_to(self._duration, True)
        return self

    @property
    def t(self) -> float:
        """The time [s]."""
        return self._native.t

    @property
    def done(self) -> bool:
        """Whether it has come to the `duration` of the scene, or an event has stopped it."""
        return self._native.stopped_by is not None or self._native.t >= self._duration

    @property
    def stopped_by(self) -> str | None:
        """The event that stopped it."""
        return self._native.stopped_by

    @property
    def warnings(self) -> list[str]:
        """What one should know although it goes on."""
        return self._native.warnings

    @property
    def steps(self) -> int:
        """Steps of the solver so far."""
        return self._native.steps[0]

    @property
    def values(self) -> Mapping[str, float]:
        """All records at the present time."""
        return dict(zip(self._index, np.frombuffer(self._native.values()).tolist()))

    def __getitem__(self, name: str) -> float | Array:
        """A column at the present time, or the x, y and z of a point as an array."""
        k = self._index.get(name)
        if k is not None:
            return self._native.value(k)
        group = [self._index[f"{name}.{axis}"] for axis in "xyz" if f"{name}.{axis}" in self._index]
        if not group:
            raise KeyError(f"there is no record {name!r}: there are {', '.join(self._index)}")
        return np.frombuffer(self._native.values())[group]

    @property
    def inputs(self) -> Mapping[str, float]:
        """The inputs of the scene and their present values."""
        return {name: value for name, _, value, _, _ in self._native.inputs()}

    def set_input(self, name: str, value: float) -> Simulation:
        """Sets an input of the scene from here on, in the unit that the scene gives it: one that holds jumps now, one that
        is joined by lines reaches the value at the end of the next advance."""
        self._native.set_input(name, float(value))
        return self

    def state(self) -> State:
        """The complete state. Whatever it is restored to goes on as this simulation does, to the last bit."""
        return State(self._native.t, self._native.state())

    def restore(self, state: State) -> Simulation:
        """Goes back, or on, to a state of this scene."""
        if not isinstance(state, State):
            raise TypeError(f"a state is what `state()` returned, not {type(state).__name__}")
        self._native.restore(state.data)
        return self

    def __repr__(self) -> str:
        return f"<Simulation {self._native.title!r} at t = {self.t} s>"
