"""Ropewalk beside MoorDyn and CableDyn on public moorings: see README.md, "Moorings".

    python moorings.py ROPEWALK [CASE ...]      with the packages `moordyn`, `cabledyn` and `numpy`; prints tables

Each code runs on meshes of growing fineness. Its error is the root mean square of the difference of the upper end's tension to what
the same code gives on a much finer mesh with much shorter steps, within the times that count, in parts of the deviation of that:
what is left of mesh and steps, with no share of what two codes take for physics. How far that refined solution is from the independent
one in moorings.json is told beside it. CPU time is user time: of Ropewalk and CableDyn that of the whole process, of MoorDyn that of its
steps alone, and in brackets that of its search for the first equilibrium; of each the least of three runs.
"""

from __future__ import annotations

import csv
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

CASES = json.loads((Path(__file__).parent / "moorings.json").read_text())["cases"]


def spent(who: int) -> float:
    """CPU time so far; of a run of milliseconds only the sum is told, not what of it is the system's."""
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


def fade(t: float, over: float) -> tuple[float, float, float]:
    """The quintic smooth step, with two derivatives."""
    u = t / over
    if u >= 1.0:
        return 1.0, 0.0, 0.0
    return (
        u**3 * (6 * u * u - 15 * u + 10),
        30 * u * u * (u - 1) ** 2 / over,
        (60 * u - 180 * u * u + 120 * u**3) / over**2,
    )


def place(case: dict, t: float) -> tuple[list, list, list]:
    """Position, velocity and acceleration of the upper end."""
    x, v, a = list(case["upper"]), [0.0] * 3, [0.0] * 3
    if move := case["motion"]:
        (f, df, ddf), w = fade(t, move["ramp"]), 2 * math.pi / move["period"]
        s, c, size, i = math.sin(w * t), math.cos(w * t), move["amplitude"], move["axis"]
        x[i] += size * f * s
        v[i] = size * (df * s + f * w * c)
        a[i] = size * (ddf * s + 2 * df * w * c - f * w * w * s)
    return x, v, a


def ropewalk(program: str, case: dict, elements: int, stepping: str = "") -> tuple[np.ndarray, float]:
    """Times and tensions of the upper end, and the CPU time; `stepping` is the scene's section `[solver]`."""
    line = case["line"]
    retarded = line["damping"] / line["EA"]
    drive, water, bed = "", "", ""
    if move := case["motion"]:
        amplitude = [0.0] * 3
        amplitude[move["axis"]] = move["amplitude"]
        drive = f"""
[[motions]]
type = "harmonic"
name = "top"
amplitude = {amplitude}
frequency = {1 / move["period"]}
ramp = {move["ramp"]}
"""
    if wave := case["waves"]:
        water = f"""
[water.waves]
regular = {{ height = {2 * wave["amplitude"]}, period = {wave["period"]}, phase = "{wave["phase"]} deg" }}
direction = "{wave["direction"]} deg"
depth = {case["depth"]}
stretching = "none"
ramp = {wave["period"]}
"""
    if soil := case["bed"]:
        bed = f"""
[[forces]]
type = "bed"
name = "bed"
point = [0, 0, {-case["depth"] - 0.5 * line["diameter"]}]
stiffness = {soil["stiffness"]}
damping = {soil["damping"]}
"""
    limp = "tension_only = true" if line["EI"] == 0 else f"ei = {line['EI']}"
    scene = f"""
gravity = [0, 0, {-case["g"]}]
{stepping}
[run]
duration = {case["end"]}
output = 0.2
from_equilibrium = true
[water]
density = {case["rho"]}
level = 0
{water}
[[elements]]
type = "cable"
name = "line"
points = [{case["lower"]}, {case["upper"]}]
length = {case["length"]}
elements = {elements}
section = {{ mass = {line["mass"]}, ea = {line["EA"]}, diameter = {line["diameter"]}, axial_retardation_time = {retarded}, {limp} }}
[[constraints]]
type = "spherical"
name = "lower"
marker = "line.start"
{drive}
[[constraints]]
type = "{"driving" if drive else "spherical"}"
name = "upper"
marker = "line.end"
{'motion = "top"' if drive else ""}
[[forces]]
type = "gravity"
[[forces]]
type = "buoyancy"
[[forces]]
type = "drag"
cn = {line["Cd"]}
ct = {line["CdAx"]}
[[forces]]
type = "added_mass"
ca = {line["Ca"]}
theory = "morison"
{bed}
[[records]]
type = "reaction"
of = "upper"
what = "magnitude"
"""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mooring.toml"
        path.write_text(scene)
        before = spent(resource.RUSAGE_CHILDREN)
        command = [program, "run", str(path), "--out", f"{folder}/out", "--no-report", "--no-plots"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(done.stderr)
        cpu = spent(resource.RUSAGE_CHILDREN) - before
        rows = list(csv.reader((Path(folder) / "out" / "history.csv").open()))
        table = np.array([[float(x) for x in row] for row in rows[1:]])
    return table[:, :2], cpu


def moordyn(case: dict, segments: int, dt: float = 0.05, cfl: float = 0.1) -> tuple[np.ndarray, float, float]:
    """Times and tensions of the upper end, and the CPU times of the steps and of the start."""
    # it tells of every step of its start
    told, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    sys.stdout.flush()
    os.dup2(nowhere, 1)
    try:
        return moordyn_telling(case, segments, dt, cfl)
    finally:
        os.dup2(told, 1)
        os.close(told)
        os.close(nowhere)


def moordyn_telling(case: dict, segments: int, dt: float, cfl: float) -> tuple[np.ndarray, float, float]:
    import moordyn as md

    c, wave = case["line"], case["waves"]
    bed = case["bed"] or {"stiffness": 3e6, "damping": 3e5}
    steps = "midpoint5 tScheme\n0.001 dtM" if c["EI"] else f"{cfl} cfl"
    # as the deck has it, in parts of the critical damping of a segment: of a fixed number of N s its explicit steps fail
    damping = -c["damping"] / (case["length"] / case["segments"] * math.sqrt(c["EA"] * c["mass"]))
    deck = f"""--- MoorDyn Input File ---
--- LINE TYPES ---
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (-) (-) (-) (-) (-) (-)
line {c["diameter"]} {c["mass"]} {c["EA"]} {damping} {c["EI"]} {c["Cd"]} {c["Ca"]} {c["CdAx"]} 0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)
1 Fixed {" ".join(map(str, case["lower"]))} 0 0 0 0
2 Coupled {" ".join(map(str, case["upper"]))} 0 0 0 0
--- LINES ---
ID Type A B Length NumSegs Out
(#) (-) (#) (#) (m) (-) (-)
1 line 1 2 {case["length"]} {segments} -
--- OPTIONS ---
0 writeLog
{steps}
{case["g"]} gravity
{bed["stiffness"]} kBot
{bed["damping"]} cBot
{case["rho"]} WtrDnsty
{case["depth"]} WtrDpth
1.0 dtIC
100 TmaxIC
1e-4 threshIC
0 FrictionCoefficient
{1 if wave else 0} WaveKin
1 disableOutTime
--- need this line ---
"""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "deck.txt"
        path.write_text(deck)
        system = md.Create(str(path))
        md.SetVerbosity(system, 0)
        before = spent(resource.RUSAGE_SELF)
        md.Init(system, case["upper"], [0.0] * 3)
        start, cpu = spent(resource.RUSAGE_SELF) - before, 0.0
        rows = []
        if wave:
            md.ExternalWaveKinInit(system)
        for k in range(round(case["end"] / dt)):
            at, then = place(case, k * dt)[0], place(case, (k + 1) * dt)[0]
            if wave:
                points = np.array(md.ExternalWaveKinGetCoordinates(system)).reshape(-1, 3)
                u, du = airy(case, points, (k + 0.5) * dt)
                md.ExternalWaveKinSet(system, u.tolist(), du.tolist(), (k + 0.5) * dt)
            before = spent(resource.RUSAGE_SELF)
            md.Step(system, at, [(b - a) / dt for a, b in zip(at, then)], k * dt, dt)
            cpu += spent(resource.RUSAGE_SELF) - before
            if c["EI"]:
                pull = math.hypot(*md.GetLineNodeForce(md.GetLine(system, 1), segments))
            else:
                flat, up, *_ = md.GetFASTtens(system, 1)
                pull = math.hypot(flat[0], up[0])
            rows.append(((k + 1) * dt, pull))
        md.Close(system)
    return np.array(rows), cpu, start


def airy(case: dict, x: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Velocities and accelerations of the water."""
    wave, depth = case["waves"], case["depth"]
    w, way = 2 * math.pi / wave["period"], math.radians(wave["direction"])
    k = w * w / case["g"]
    for _ in range(50):
        k = w * w / (case["g"] * math.tanh(k * depth))
    cos, sin = math.cos(way), math.sin(way)
    theta = k * (x[:, 0] * cos + x[:, 1] * sin) - w * t + math.radians(wave["phase"])
    a, z = wave["amplitude"], x[:, 2] + depth
    flat, up = np.cosh(k * z) / math.sinh(k * depth), np.sinh(k * z) / math.sinh(k * depth)
    u, du = a * w * flat * np.cos(theta), a * w * w * flat * np.sin(theta)
    v, dv = a * w * up * np.sin(theta), -a * w * w * up * np.cos(theta)
    return np.stack([u * cos, u * sin, v], 1), np.stack([du * cos, du * sin, dv], 1)


def cabledyn(case: dict, segments: int, dt: float) -> tuple[np.ndarray, float]:
    """Times and tensions of the upper end, and the CPU time."""
    import cabledyn as cd

    c, bed, wave = case["line"], case["bed"], case["waves"]
    # its waves have a crest at the origin at t = 0
    late = wave["phase"] / 360 * wave["period"] if wave else 0.0
    end = case["end"] + (wave["period"] if wave else 0.0)
    soil = f"{bed['stiffness']} kBot\n{bed['damping']} cBot\nnone frictionMu" if bed else ""
    sea = f"airy {2 * wave['amplitude']} {wave['period']} {wave['direction']} waves\n0 WaterKin" if wave else "none waves\n0 WaterKin"
    deck = f"""--- CableDyn Input File ---
mooring
--- LINE TYPES ---
TypeName Diam MassDenInAir EA BA EI Cd_n Cd_t Ca_n Ca_t
(-) (m) (kg/m) (N) (-) (N-m2) (-) (-) (-) (-)
line {c["diameter"]} {c["mass"]} {c["EA"]} {c["damping"]} {c["EI"]} {c["Cd"]} {c["CdAx"]} {c["Ca"]} 0
--- POINTS ---
ID Type X Y Z
(-) (-) (m) (m) (m)
1 Coupled {" ".join(map(str, case["upper"]))}
2 Fixed {" ".join(map(str, case["lower"]))}
--- LINES ---
ID NodeA NodeB Outputs
(-) (-) (-) (-)
1 1 2 -
--- SECTIONS ---
LineID LineType Length NumSegs
(-) (-) (m) (-)
1 line {case["length"]} {segments}
--- OPTIONS ---
{case["g"]} g
{case["rho"]} rhoW
{case["depth"]} WtrDpth
{soil}
0.4 rhoInf
{dt} dtM
{end} TMax
motion.txt motionFile
none current
{sea}
--- OUTPUTS ---
"FairTen1"
--- need this line ---
"""
    program = Path(cd.__file__).parent / "bin" / "cabledyn"
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "deck.dat").write_text(deck)
        rows = ["# time point x y z vx vy vz ax ay az"]
        for k in range(round(end / dt) + 1):
            numbers = [f"{x:.10e}" for three in place(case, k * dt) for x in three]
            rows.append(f"{k * dt:.8f} 1 {' '.join(numbers)}")
        (Path(folder) / "motion.txt").write_text("\n".join(rows) + "\n")
        before = spent(resource.RUSAGE_CHILDREN)
        one = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")
        command = [str(program), f"{folder}/deck.dat", f"{folder}/out"]
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder, env=one)
        if done.returncode:
            raise RuntimeError(done.stdout[-500:] + done.stderr[-500:])
        cpu = (spent(resource.RUSAGE_CHILDREN) - before) * case["end"] / end
        table = []
        for row in (Path(folder) / "out.out").read_text().splitlines():
            try:
                table.append([float(x) for x in row.split()])
            except ValueError:
                continue
    table = np.array([row for row in table if len(row) == 2])
    table[:, 0] += late - (wave["period"] if wave else 0.0)
    return table, cpu


def sampled(case: dict, table: np.ndarray) -> np.ndarray:
    """Tension at the times of the trace, every 0.2 s: all codes have steps or outputs there."""
    return np.interp([row[0] for row in case["trace"]], table[:, 0], table[:, 1])


def off(found: np.ndarray, right: np.ndarray) -> tuple[float, float]:
    """By how much a tension is off, as a root mean square and at its maximum, in parts of the deviation."""
    return (
        float(np.sqrt(np.mean((found - right) ** 2)) / right.std()),
        float(abs(found.max() - right.max()) / right.std()),
    )


def least(runs: list[tuple[float, float]], error: float) -> float | None:
    """CPU time that a code takes for an error, by a power law between its runs with more and less; `None` beyond them."""
    enough = [cpu for far, cpu in runs if far <= error]
    if not enough:
        return None
    best = min(enough)
    for far, cpu in runs:
        for better, dearer in runs:
            if better <= error < far and cpu < dearer:
                share = math.log(far / error) / math.log(far / better)
                best = min(best, cpu * (dearer / cpu) ** share)
    return best


def quickest(run: Callable[[], tuple], times: int = 3) -> tuple:
    """What a run gives, with the least of each of its times in some runs."""
    first, *rest = [run() for _ in range(times)]
    return first[0], *(min(same) for same in zip(first[1:], *(other[1:] for other in rest)))


def main() -> None:
    program, wanted = sys.argv[1], sys.argv[2:]
    def within(tolerance: float) -> str:
        return f"[solver]\nstepping = {{ controlled = {{ tolerance = {tolerance} }} }}\n"

    fine = within(1e-6) + "force_tolerance = 1e-4"
    for case in CASES:
        name, n = case["name"], case["segments"]
        if wanted and name not in wanted:
            continue
        independent = np.array([row[1] for row in case["trace"]])
        stiff = case["line"]["EI"] > 0
        most = 1 if stiff else 2
        codes = {
            "Ropewalk": (
                lambda: ropewalk(program, case, 160, fine),
                [(f"{k} elements", lambda k=k: ropewalk(program, case, k)) for k in (2, 3, 4, 6, 8, 10, 15, 20, 30, 40, 55, 80)]
                + [
                    (f"{k} elements, tolerance {e}", lambda k=k, e=e: ropewalk(program, case, k, within(e)))
                    for k, e in ((30, 3e-5), (40, 3e-5), (80, 1e-5))
                ],
            ),
            "CableDyn": (
                lambda: cabledyn(case, 4 * n, 0.01),
                [
                    (f"{k} segments, {dt} s", lambda k=k, dt=dt: cabledyn(case, k, dt))
                    for k, dt in ((n // 4, 0.05), (n // 2, 0.05), (n, 0.05), (n, 0.02), (2 * n, 0.02))[: 3 + most]
                ],
            ),
            "MoorDyn": (
                lambda: moordyn(case, 2 * most * n, 0.01),
                [(f"{k} segments", lambda k=k: moordyn(case, k)) for k in (n // 2, n, 2 * n)[: 1 + most]],
            ),
        }
        # at default settings, and with tighter tolerances too
        own: list[tuple[float, float]] = []
        every: list[tuple[float, float]] = []
        print("| case | code | mesh | error | at the maximum | CPU time [s] | times Ropewalk's |\n| --- | --- | --- | --- | --- | --- | --- |")
        for code, (finest, runs) in codes.items():
            try:
                right = sampled(case, finest()[0])
            except RuntimeError as why:
                print(f"| {name} | {code} | refined | fails: {str(why)[-80:]!r} | | | |", flush=True)
                continue
            far, top = off(right, independent)
            row = f"| {name} | {code} | refined, to the independent one | {100 * far:.2f} % | {100 * top:.2f} % | | |"
            print(row, flush=True)
            for mesh, run in runs:
                try:
                    table, *times = quickest(run)
                except RuntimeError:
                    print(f"| {name} | {code} | {mesh} | its steps fail | | | |", flush=True)
                    continue
                far, top = off(sampled(case, table), right)
                cpu = f"{times[0]:.3f}" + (f" ({times[1]:.3f})" if len(times) > 1 else "")
                if code == "Ropewalk":
                    every.append((far, times[0]))
                    if "tolerance" not in mesh:
                        own.append((far, times[0]))
                    factor = ""
                else:
                    same, tighter = least(own, far), least(every, far)
                    factor = f"{sum(times) / same:.1f}" if same else "-"
                    if tighter and tighter != same:
                        factor += f" ({sum(times) / tighter:.1f})"
                print(f"| {name} | {code} | {mesh} | {100 * far:.2f} % | {100 * top:.2f} % | {cpu} | {factor} |", flush=True)
        print(flush=True)


if __name__ == "__main__":
    main()
