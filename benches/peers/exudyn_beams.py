"""The problems of beams.md with Exudyn's geometrically exact beam: tip positions and user CPU time of the solver.

    python benches/peers/exudyn_beams.py

It takes `exudyn` of requirements.txt.
"""

import math
import resource
import sys

# the module without range checks, which is the fast one
sys.exudynFast = True
import exudyn
import numpy as np
from exudyn import itemInterface as item
from exudyn.utilities import EulerParameters2RotationMatrix, GenericJoint, RotationMatrix2EulerParameters


def section(ea, ga, gj, ei, mass, polar):
    s = exudyn.BeamSection()
    s.stiffnessMatrix = np.diag([ea, ga, ga, gj, ei, ei])
    s.inertia = np.diag([polar, polar / 2, polar / 2])
    s.massPerLength = mass
    return s


def clamp(mbs, node, turn):
    ground = mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=mbs.AddObject(item.ObjectGround())))
    own = mbs.AddMarker(item.MarkerNodeRigid(nodeNumber=node))
    mbs.AddObject(GenericJoint(markerNumbers=[ground, own], rotationMarker0=turn, constrainedAxes=[1] * 6))


def settings():
    s = exudyn.SimulationSettings()
    s.solution.file.write = False
    s.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    s.parallel.numberOfThreads = 1
    return s


def timed(work):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
    work()
    return resource.getrusage(resource.RUSAGE_SELF).ru_utime - before


def tip(mbs, node):
    return [float(x) for x in mbs.GetNodeOutput(node, exudyn.OutputVariableType.Position)]


def bend(n):
    """An arc of 45 degrees and 100 m, bent out of its plane by 600 N in 24 steps of the load."""
    mbs = exudyn.SystemContainer().AddSystem()
    radius, ea, g = 100.0, 1e7, 5e6
    s = section(ea, g * 5 / 6, g / 6, ea / 12, 1.0, 1 / 6)
    nodes = []
    for k in range(n + 1):
        a = math.pi / 4 * k / n
        t, b = [math.sin(a), math.cos(a), 0], [0, 0, 1]
        turn = RotationMatrix2EulerParameters(np.array([t, np.cross(b, t), b]).T)
        x = [radius * (1 - math.cos(a)), radius * math.sin(a), 0]
        nodes.append(mbs.AddNode(item.NodeRigidBodyEP(referenceCoordinates=[*x, *turn])))
    piece = radius * math.pi / 4 / n
    for k in range(n):
        mbs.AddObject(item.ObjectBeamGeometricallyExact(nodeNumbers=nodes[k : k + 2], length=piece, sectionData=s))
    clamp(mbs, nodes[0], EulerParameters2RotationMatrix(mbs.GetNode(nodes[0])["referenceCoordinates"][3:]))
    end = mbs.AddMarker(item.MarkerNodeRigid(nodeNumber=nodes[-1]))
    mbs.AddLoad(item.Force(markerNumber=end, loadVector=[0, 0, 600]))
    mbs.Assemble()
    how = settings()
    how.staticSolver.numberOfLoadSteps = 24
    how.staticSolver.verboseMode = 0
    how.staticSolver.newton.relativeTolerance = 1e-10
    cpu = timed(lambda: mbs.SolveStatic(how))
    return tip(mbs, nodes[-1]), cpu


def swing(n, h):
    """A cable of 1 m, clamped at one end, laid level with one turn of twist, let go in gravity for 0.4 s."""
    mbs = exudyn.SystemContainer().AddSystem()
    s = section(5e3, 2e3, 0.08, 0.1, 0.5, 2.5e-5)
    nodes = []
    for k in range(n + 1):
        half = math.pi * k / n
        nodes.append(
            mbs.AddNode(
                item.NodeRigidBodyEP(
                    referenceCoordinates=[k / n, 0, 0, 1, 0, 0, 0],
                    initialCoordinates=[0, 0, 0, math.cos(half) - 1, math.sin(half), 0, 0],
                )
            )
        )
    for k in range(n):
        beam = item.ObjectBeamGeometricallyExact(nodeNumbers=nodes[k : k + 2], length=1 / n, sectionData=s)
        mass = mbs.AddMarker(item.MarkerBodyMass(bodyNumber=mbs.AddObject(beam)))
        mbs.AddLoad(item.LoadMassProportional(markerNumber=mass, loadVector=[0, 0, -9.81]))
    clamp(mbs, nodes[0], np.eye(3))
    mbs.Assemble()
    how = settings()
    time = how.timeIntegration
    time.numberOfSteps, time.endTime, time.verboseMode = round(0.4 / h), 0.4, 0
    time.generalizedAlpha.spectralRadius = 0.8
    time.newton.useModifiedNewton = True
    cpu = timed(lambda: mbs.SolveDynamic(how))
    return tip(mbs, nodes[-1]), cpu


if __name__ == "__main__":
    for n in [4, 8, 16, 32, 64]:
        print("bend", n, *bend(n), flush=True)
    for n, h in [(8, 2e-3), (16, 1e-3), (32, 5e-4), (64, 2.5e-4), (128, 1.25e-4)]:
        print("swing", n, h, *swing(n, h), flush=True)
