"""The towed hose with CableDyn: implicit steps of one size, without error control."""

import os
import tempfile

from common import Course, Stopwatch, main, size

import numpy as np
from cabledyn import CableDyn, ConvergenceError

DECK = """--- CableDyn Input File ---
towed hose
--- LINE TYPES ---
TypeName Diam MassDenInAir EA BA/-zeta EI Cd_n Cd_t Ca_n Ca_t
(-) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
hose {diameter} {mass} {ea} {damping} {ei} {cn} {ct} {ca} 0
--- POINTS ---
ID Type X Y Z Mass Vol CdA Ca
(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Coupled 0 0 {top} 0 0 0 0
2 Free {aside} 0 {bottom} {end_mass} 0 0 0
--- LINES ---
ID NodeA NodeB Outputs
(-) (-) (-) (-)
1 1 2 -
--- SECTIONS ---
LineID LineType Length NumSegs
(-) (-) (m) (-)
1 hose {length} {elements}
--- OPTIONS ---
{g} g
{density} rhoW
{depth} WtrDpth
1.0e5 kBot
1.0e4 cBot
{step} dtM
{duration} TMax
{rho_inf} rhoInf
none current
none waves
--- OUTPUTS ---
"FairTen1"
"Point2px"
"Point2pz"
--- need this line ---
"""


def solve(case):
    course = Course(case)
    top = -5.0
    text = DECK.format(top=top, bottom=top - 0.998 * case["length"], aside=0.03 * case["length"], **case)
    with tempfile.TemporaryDirectory() as folder:
        deck = os.path.join(folder, "hose.dat")
        with open(deck, "w") as file:
            file.write(text)
        model = CableDyn(deck)
    driven = model.host_dofs()
    start = model.get_coupled_motion()[0][driven]
    step = case["step"]
    steps, every = round(case["duration"] / step), round(case["interval"] / step)
    history, refused, iterations = [], 0, 0
    watch = Stopwatch()
    for k in range(1, steps + 1):
        q, v, a = model.get_coupled_motion()
        way, speed, rate = course.at(k * step)
        q[driven] = start + np.array([way, 0.0, 0.0])
        v[driven] = [speed, 0.0, 0.0]
        a[driven] = [rate, 0.0, 0.0]
        try:
            iterations += model.step(step, q, v, a)
        except ConvergenceError as e:
            # it goes on from its best iterate, and so does the run; the answer says how often
            iterations += e.n_iter
            refused += 1
        if k % every == 0:
            history.append([size(model.calc_output()[driven]), model.channel("FairTen1")])
    cpu = watch.read()
    return {
        "cpu": cpu,
        "reaction": [h[0] for h in history],
        "tension": [h[1] for h in history],
        "end": [model.channel("Point2px") - way, 0.0, model.channel("Point2pz") - top],
        "not_converged": refused,
        "iterations": iterations,
    }


main(solve)
