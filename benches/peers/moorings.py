"""Ropewalk beside MoorDyn and CableDyn on two moorings of MoorDyn's own tests, whose fairlead heaves by 5 m in 10 s.

    python moorings.py ROPEWALK          with the packages `moordyn`, `cabledyn` and `numpy`; prints a table

The error is the root mean square of the difference of the fairlead's tension to the refined solution in moorings.json, from 10 s to
30 s, in parts of the deviation of that. CPU time is user time: of Ropewalk and CableDyn that of the whole process, of MoorDyn that of
its steps, and in brackets that of its search for the first equilibrium.
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
from pathlib import Path

import numpy as np

CASES = json.loads((Path(__file__).parent / "moorings.json").read_text())["cases"]
END = 30.0


def user(who: int) -> float:
    return resource.getrusage(who).ru_utime


def fade(t: float) -> tuple[float, float, float]:
    """The quintic smooth step over a second, with two derivatives."""
    u = min(t, 1.0)
    if t >= 1.0:
        return 1.0, 0.0, 0.0
    return u**3 * (6 * u * u - 15 * u + 10), 30 * u * u * (u - 1) ** 2, 60 * u - 180 * u * u + 120 * u**3


def heave(case: dict, t: float) -> tuple[float, float, float]:
    (f, df, ddf), w = fade(t), 2 * math.pi / case["period"]
    s, c, a = math.sin(w * t), math.cos(w * t), case["amplitude"]
    return a * f * s, a * (df * s + f * w * c), a * (ddf * s + 2 * df * w * c - f * w * w * s)


def error(case: dict, t, tension) -> float:
    trace = np.array(case["trace"])
    trace = trace[trace[:, 0] < END - 0.2]
    off = np.interp(trace[:, 0], t, tension) - trace[:, 1]
    return float(np.sqrt(np.mean(off**2)) / trace[:, 1].std())


def ropewalk(program: str, case: dict, elements: int) -> tuple[float, float]:
    chain = case["chain"]
    # the deck's damping ratio is that of its own segments
    damping = case["length"] / case["segments"] * math.sqrt(chain["mass"] / chain["EA"])
    scene = f"""
gravity = [0, 0, {-case["g"]}]
run = {{ duration = {END}, output = 0.05, from_equilibrium = true }}
water = {{ density = {case["rho"]}, level = 0 }}
[[elements]]
type = "cable"
name = "line"
points = [{case["anchor"]}, {case["fairlead"]}]
length = {case["length"]}
elements = {elements}
section = {{ mass = {chain["mass"]}, ea = {chain["EA"]}, diameter = {chain["diameter"]}, axial_retardation_time = {damping}, tension_only = true }}
[[constraints]]
type = "spherical"
name = "anchor"
marker = "line.start"
[[motions]]
type = "harmonic"
name = "top"
amplitude = [0, 0, {case["amplitude"]}]
frequency = {1 / case["period"]}
ramp = 1
[[constraints]]
type = "driving"
name = "fairlead"
marker = "line.end"
motion = "top"
[[forces]]
type = "gravity"
[[forces]]
type = "buoyancy"
[[forces]]
type = "drag"
cn = {chain["Cd"]}
ct = {chain["CdAx"]}
[[forces]]
type = "added_mass"
ca = {chain["Ca"]}
[[forces]]
type = "bed"
name = "bed"
point = [0, 0, {-case["depth"] - 0.5 * chain["diameter"]}]
stiffness = {case["k_bed"]}
damping = {case["c_bed"]}
[[records]]
type = "along"
of = "line"
what = "tension"
at = "end"
"""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mooring.toml"
        path.write_text(scene)
        before = user(resource.RUSAGE_CHILDREN)
        command = [program, "run", str(path), "--out", f"{folder}/out", "--no-report", "--no-plots"]
        subprocess.run(command, check=True, capture_output=True)
        cpu = user(resource.RUSAGE_CHILDREN) - before
        rows = list(csv.reader((Path(folder) / "out" / "history.csv").open()))
        table = np.array([[float(x) for x in row] for row in rows[1:]])
    return error(case, table[:, 0], table[:, 1]), cpu


def moordyn(case: dict, segments: int) -> tuple[float, float, float]:
    import moordyn as md

    c = case["chain"]
    x, y, z = case["anchor"]
    deck = f"""--- MoorDyn Input File ---
--- LINE TYPES ---
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (-) (-) (-) (-) (-) (-)
chain {c["diameter"]} {c["mass"]} {c["EA"]} {-c["damping_ratio_per_segment"]} 0 {c["Cd"]} {c["Ca"]} {c["CdAx"]} 0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)
1 Fixed {x} {y} {z} 0 0 0 0
2 Vessel 0 0 0 0 0 0 0
--- LINES ---
ID Type A B Length NumSegs Out
(#) (-) (#) (#) (m) (-) (-)
1 chain 1 2 {case["length"]} {segments} -
--- OPTIONS ---
0 writeLog
0.1 cfl
{case["g"]} gravity
{case["k_bed"]} kBot
{case["c_bed"]} cBot
{case["rho"]} WtrDnsty
{case["depth"]} WtrDpth
1.0 dtIC
100 TmaxIC
1e-4 threshIC
0 FrictionCoefficient
1 disableOutTime
--- need this line ---
"""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "deck.txt"
        path.write_text(deck)
        system = md.Create(str(path))
        md.SetVerbosity(system, 0)
        before = user(resource.RUSAGE_SELF)
        md.Init(system, [0.0] * 3, [0.0] * 3)
        start, before = user(resource.RUSAGE_SELF) - before, user(resource.RUSAGE_SELF)
        dt, times, tension = 0.05, [], []
        for k in range(round(END / dt)):
            at, then = heave(case, k * dt)[0], heave(case, (k + 1) * dt)[0]
            md.Step(system, [0.0, 0.0, at], [0.0, 0.0, (then - at) / dt], k * dt, dt)
            flat, up, *_ = md.GetFASTtens(system, 1)
            times.append((k + 1) * dt)
            tension.append(math.hypot(flat[0], up[0]))
        cpu = user(resource.RUSAGE_SELF) - before
        md.Close(system)
    return error(case, times, tension), cpu, start


def cabledyn(case: dict, segments: int, dt: float) -> tuple[float, float]:
    import cabledyn as cd

    c = case["chain"]
    x, y, z = case["anchor"]
    deck = f"""--- CableDyn Input File ---
mooring
--- LINE TYPES ---
TypeName Diam MassDenInAir EA BA EI Cd_n Cd_t Ca_n Ca_t
(-) (m) (kg/m) (N) (-) (N-m2) (-) (-) (-) (-)
chain {c["diameter"]} {c["mass"]} {c["EA"]} {-c["damping_ratio_per_segment"]} 0 {c["Cd"]} {c["CdAx"]} {c["Ca"]} 0
--- POINTS ---
ID Type X Y Z
(-) (-) (m) (m) (m)
1 Coupled 0 0 0
2 Fixed {x} {y} {z}
--- LINES ---
ID NodeA NodeB Outputs
(-) (-) (-) (-)
1 1 2 -
--- SECTIONS ---
LineID LineType Length NumSegs
(-) (-) (m) (-)
1 chain {case["length"]} {segments}
--- OPTIONS ---
{case["g"]} g
{case["rho"]} rhoW
{case["depth"]} WtrDpth
{case["k_bed"]} kBot
{case["c_bed"]} cBot
0.4 rhoInf
{dt} dtM
{END} TMax
none frictionMu
motion.txt motionFile
none current
none waves
0 WaterKin
--- OUTPUTS ---
"FairTen1"
--- need this line ---
"""
    program = Path(cd.__file__).parent / "bin" / "cabledyn"
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "deck.dat").write_text(deck)
        rows = ["# time point x y z vx vy vz ax ay az"]
        for k in range(round(END / dt) + 1):
            x, v, a = heave(case, k * dt)
            rows.append(f"{k * dt:.8f} 1 0 0 {x:.10e} 0 0 {v:.10e} 0 0 {a:.10e}")
        (Path(folder) / "motion.txt").write_text("\n".join(rows) + "\n")
        before = user(resource.RUSAGE_CHILDREN)
        one = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")
        command = [str(program), f"{folder}/deck.dat", f"{folder}/out"]
        subprocess.run(command, check=True, capture_output=True, cwd=folder, env=one)
        cpu = user(resource.RUSAGE_CHILDREN) - before
        table = []
        for line in (Path(folder) / "out.out").read_text().splitlines():
            try:
                table.append([float(x) for x in line.split()])
            except ValueError:
                continue
    table = np.array([row for row in table if len(row) == 2])
    return error(case, table[:, 0], table[:, 1]), cpu


def main() -> None:
    program = sys.argv[1]
    print("| mooring | code | mesh | error | CPU time [s] |\n| --- | --- | --- | --- | --- |")
    for case in CASES:
        name, fine = case["name"][:6], case["segments"]
        row = lambda code, mesh, off, cpu: print(f"| {name} | {code} | {mesh} | {100 * off:.2f} % | {cpu} |", flush=True)
        for elements in (10, 20, 40, 80):
            off, cpu = ropewalk(program, case, elements)
            row("Ropewalk, defaults", f"{elements} elements", off, f"{cpu:.2f}")
        for segments in (fine // 2, fine, 2 * fine):
            try:
                off, cpu, start = moordyn(case, segments)
            except RuntimeError:
                print(f"| {name} | MoorDyn | {segments} segments | its steps fail | |")
                continue
            row("MoorDyn", f"{segments} segments", off, f"{cpu:.2f} ({start:.2f})")
        for segments, dt in ((fine // 2, 0.05), (fine, 0.05), (fine, 0.02), (2 * fine, 0.02)):
            off, cpu = cabledyn(case, segments, dt)
            row("CableDyn", f"{segments} segments, {dt} s", off, f"{cpu:.2f}")


if __name__ == "__main__":
    main()
