"""The cable pendulum with Exudyn: ANCF cables, one coordinate constraint for each direction at the pin."""

import sys

from common import Stopwatch, main

# the module without range checks, which is the fast one
sys.exudynFast = True
import exudyn
from exudyn import itemInterface as item


def build(case):
    mbs = exudyn.SystemContainer().AddSystem()
    n = case["elements"]
    piece = case["length"] / n
    nodes = [
        mbs.AddNode(item.NodePointSlope1(referenceCoordinates=[k * piece, 0, 0, 1, 0, 0]))
        for k in range(n + 1)
    ]
    for k in range(n):
        cable = mbs.AddObject(
            item.ObjectANCFCable(
                length=piece,
                massPerLength=case["mass"],
                axialStiffness=case["ea"],
                bendingStiffness=case["ei"],
                nodeNumbers=nodes[k : k + 2],
            )
        )
        body = mbs.AddMarker(item.MarkerBodyMass(bodyNumber=cable))
        mbs.AddLoad(item.LoadMassProportional(markerNumber=body, loadVector=[0, -case["g"], 0]))
    ground = mbs.AddNode(item.NodePointGround())
    fixed = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for axis in range(3):
        moving = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=axis))
        mbs.AddObject(item.ObjectConnectorCoordinate(markerNumbers=[fixed, moving]))
    mbs.Assemble()
    return mbs, nodes[-1]


def settings(case):
    s = exudyn.SimulationSettings()
    s.solution.file.write = False
    s.solution.sensors.active = False
    s.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    s.parallel.numberOfThreads = 1
    time = s.timeIntegration
    time.verboseMode = 0
    time.numberOfSteps = case["steps"]
    time.endTime = case["steps"] * case["h"]
    time.adaptiveStep = False
    time.newton.useModifiedNewton = case["newton"] == "modified"
    time.newton.relativeTolerance = case["relative_tolerance"]
    time.newton.absoluteTolerance = case["absolute_tolerance"]
    # 1: by the size of the increment instead of the residual
    time.newton.residualMode = case.get("residual_mode", 0)
    time.generalizedAlpha.spectralRadius = case["rho_inf"]
    time.generalizedAlpha.computeInitialAccelerations = case["initial_accelerations"]
    return s


def solve(case):
    system, tip = build(case)
    kind = exudyn.DynamicSolverType
    scheme = {"generalized-alpha": kind.GeneralizedAlpha, "trapezoidal": kind.TrapezoidalIndex2}
    options = settings(case)
    watch = Stopwatch()
    done = system.SolveDynamic(options, solverType=scheme[case["scheme"]])
    cpu = watch.read()
    if not done:
        raise RuntimeError("the solver gave up")
    count = system.sys["dynamicSolver"].it
    return {
        "cpu": cpu,
        "tip": [float(x) for x in system.GetNodeOutput(tip, exudyn.OutputVariableType.Position)],
        "steps": case["steps"],
        "iterations": count.newtonStepsCount,
        "factorizations": count.newtonJacobiCount,
    }


main(solve)
