"""The equations of a scene linearised about a state."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _native
from ._errors import SceneError
from ._scene import AnyScene, overrides, source

try:
    from scipy import sparse
except ImportError:  # dense arrays do where there is no SciPy
    sparse = None


@dataclass(frozen=True)
class Reduced:
    """Small motions in the coordinates that constraints leave: `M w'' + C w' + K w = B u + rate u' + integral ∫u`, with
    `q = Z w + V ∫u`. The last ones are there where inputs prescribe speeds; `u` is all inputs."""

    M: Any
    C: Any
    K: Any
    B: Any
    rate: Any
    integral: Any
    Z: Any
    V: Any


@dataclass(frozen=True)
class Linearised:
    """Small motions about a state, in SI units:

    `M a + C v + K q + G.T @ l = B u`, with `G v = D u` and `q' = v + N q`; what records see is
    `y = Yq q + Yv v + Ya a + Yl l + Yu u`.

    All matrices are `scipy.sparse.csc_array`, or arrays of NumPy where there is no SciPy. `Gyro` is the skew part of `C`.
    """

    t: float
    """Time of the state [s]."""
    unknowns: list[str]
    """What the coordinates `q` are called."""
    constraints: list[str]
    """The rows of `G`."""
    inputs: dict[str, str]
    """The inputs and their units."""
    outputs: dict[str, str]
    """The columns of the records and their units."""
    M: Any
    C: Any
    Gyro: Any
    K: Any
    G: Any
    N: Any
    B: Any
    D: Any
    Yq: Any
    Yv: Any
    Ya: Any
    Yl: Any
    Yu: Any

    def null_space(self) -> Any:
        """Orthonormal motions that the constraints allow, as columns of a dense array."""
        g = self.G.toarray() if hasattr(self.G, "toarray") else self.G
        if g.shape[0] == 0:
            return np.eye(g.shape[1])
        _, sizes, rows = np.linalg.svd(g)
        rank = int(np.sum(sizes > 1e-10 * max(sizes.max(initial=0.0), 1e-300)))
        return rows[rank:].T

    def reduced(self) -> Reduced:
        """The equations without constraints, dense: what inputs that prescribe speeds carry along included."""
        z, dense = self.null_space(), lambda a: a.toarray() if hasattr(a, "toarray") else a
        v = np.zeros((len(self.unknowns), len(self.inputs)))
        if self.constraints:
            v = np.linalg.pinv(dense(self.G), rcond=1e-10) @ dense(self.D)
        m, c, k = (dense(a) for a in (self.M, self.C, self.K))
        b = z.T @ (dense(self.B) - c @ v)
        return Reduced(z.T @ m @ z, z.T @ c @ z, z.T @ k @ z, b, -z.T @ m @ v, -z.T @ k @ v, z, v)

    def __repr__(self) -> str:
        n, m = len(self.unknowns), len(self.constraints)
        return f"<Linearised at t = {self.t} s: {n} unknowns, {m} constraints, {len(self.inputs)} inputs, {len(self.outputs)} outputs>"


def linearise(scene: AnyScene, at: str | float = "equilibrium", **parameters: Any) -> Linearised:
    """Linearises a scene about its `"equilibrium"`, its `"start"`, or where its run is at a time [s].

    >>> l = linearise("pendulum")
    >>> l.M.shape == l.K.shape == (len(l.unknowns), len(l.unknowns))
    True
    """
    if isinstance(at, str) and at not in ("equilibrium", "start"):
        raise SceneError(f"equations are linearised about 'equilibrium', 'start' or a time, not {at!r}")
    time = None if isinstance(at, str) else float(at)
    matrices, about = _native.linearise(source(scene), overrides(parameters), at == "start", time)
    said = json.loads(about)
    return Linearised(
        t=said["t"],
        unknowns=said["unknowns"],
        constraints=said["constraints"],
        inputs=dict(said["inputs"]),
        outputs=dict(said["outputs"]),
        **{matrix[0]: _matrix(*matrix[1:]) for matrix in matrices},
    )


def _matrix(rows: int, columns: int, data: bytearray, indices: bytearray, pointers: bytearray) -> Any:
    values = np.frombuffer(data)
    row, start = np.frombuffer(indices, dtype=np.int64), np.frombuffer(pointers, dtype=np.int64)
    if sparse is not None:
        return sparse.csc_array((values, row, start), shape=(rows, columns))
    dense = np.zeros((rows, columns))
    for k in range(columns):
        dense[row[start[k] : start[k + 1]], k] = values[start[k] : start[k + 1]]
    return dense
