"""Flexible multibody dynamics: cables, hoses and tethers, bodies, joints and water in one system of equations.

>>> import ropewalk as rw
>>> run = rw.run("pendulum", duration="0.5 s")
>>> run["cable.end.z"].shape == run.t.shape
True

A scene is a bundled one (`rw.list()`), a path, a dict, or built: see `Scene`. Numbers are in SI units, a text such as
"2 kn" brings its own; z is up.
"""

from ._errors import FunctionError, OutputError, RopewalkError, SceneError, SolverError
from ._fmu import export_fmu
from ._functions import function
from ._linearise import Linearised, linearise
from ._native import Stop, __version__
from ._objective import Objective, objective
from ._run import Run, load, run
from ._scene import AnyScene, Part, Scene
from ._shapes import Body, Line, Shapes
from ._simulation import Simulation
from ._studies import Certificate, Cost, Effects, certify, cost, effects
from ._sweep import Sweep, sweep
from ._tools import Checked, Modes, check, describe, list, modes, schemas

__all__ = [
    "AnyScene",
    "Body",
    "Certificate",
    "Checked",
    "Cost",
    "Effects",
    "FunctionError",
    "Line",
    "Linearised",
    "Modes",
    "Objective",
    "OutputError",
    "Part",
    "RopewalkError",
    "Run",
    "Scene",
    "SceneError",
    "Shapes",
    "Simulation",
    "SolverError",
    "Stop",
    "Sweep",
    "__version__",
    "certify",
    "check",
    "cost",
    "describe",
    "effects",
    "export_fmu",
    "function",
    "linearise",
    "list",
    "load",
    "modes",
    "objective",
    "run",
    "schemas",
    "sweep",
]
