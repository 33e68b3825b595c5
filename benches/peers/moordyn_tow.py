"""The towed hose with MoorDyn: lumped masses, explicit steps within the limit of stability that it finds itself."""

import os
import tempfile

from common import Course, Stopwatch, main, size

import moordyn

DECK = """--- MoorDyn Input File ---
{title}
--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
hose {diameter} {mass} {ea} {damping} {ei} {cn} {ca} {ct} 0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Coupled 0 0 {top} 0 0 0 0
2 Free 0 0 {bottom} {end_mass} 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (-) (#) (#) (m) (-) (-)
1 hose 1 2 {length} {elements} -
--- OPTIONS ---
{scheme} tScheme
{step}
{density} rho
{depth} WtrDpth
{g} g
0 writeLog
1 disableOutput
1 disableOutTime
3.0e6 kBot
3.0e5 cBot
1.0 dtIC
{relax} TmaxIC
1e-6 threshIC
--- end ---
"""


def solve(case):
    course = Course(case)
    top = -5.0
    step = f"{case['step']} dtM" if "step" in case else f"{case['cfl']} cfl"
    text = DECK.format(
        title="towed hose",
        top=top,
        bottom=top - case["length"],
        **{**case, "step": step},
    )
    with tempfile.TemporaryDirectory() as folder:
        deck = os.path.join(folder, "hose.txt")
        with open(deck, "w") as file:
            file.write(text)
        system = moordyn.Create(deck)
        moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
        moordyn.Init(system, [0.0, 0.0, top], [0.0, 0.0, 0.0])
        line = moordyn.GetLine(system, 1)
        end = moordyn.GetPoint(system, 2)

        coupling = case["coupling"]
        steps = round(case["duration"] / coupling)
        every = round(case["interval"] / coupling)
        x, history, force = 0.0, [], None
        watch = Stopwatch()
        for k in range(1, steps + 1):
            # a coupling step has one velocity: the one that ends where the ship is
            ahead = course.at(k * coupling)[0]
            force = moordyn.Step(
                system, [x, 0.0, top], [(ahead - x) / coupling, 0.0, 0.0], (k - 1) * coupling, coupling
            )
            x = ahead
            if k % every == 0:
                history.append([size(force), size(moordyn.GetLineNodeTen(line, 0))])
        cpu = watch.read()
        at = moordyn.GetPointPos(end)
        return {
            "cpu": cpu,
            "reaction": [h[0] for h in history],
            "tension": [h[1] for h in history],
            "end": [at[0] - x, at[1], at[2] - top],
            "step": moordyn.GetDt(system),
        }


main(solve)
