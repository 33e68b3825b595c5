"""Ropes over wheels: Ropewalk beside Exudyn's reeving springs and MuJoCo's spatial tendons, against closed forms and refined contact.

    python benches/peers/reeving.py target/release/ropewalk

It takes Python 3.11 with `exudyn`, `mujoco`, `numpy` and `scipy`. Numbers of the problems are in reeving.json, and of the wheel that
grips its rope in tests/data/reeving/chain_grip.json and tests/payout/grip.toml; values by refined contact come from
reeving_contact.py. What came out stands in reeving.md.
"""

import json
import math
import pathlib
import resource
import subprocess
import sys
import tempfile
import tomllib

import numpy as np
from scipy.optimize import brentq, fsolve

HERE = pathlib.Path(__file__).parent
TESTS = HERE.parents[1] / "tests"
P = json.loads((HERE / "reeving.json").read_text())
G = P["gravity"]
# a wheel that grips its rope: numbers, values by refined contact, and Ropewalk's scene
GRIP = json.loads((TESTS / "data/reeving/chain_grip.json").read_text())
SCENE = (TESTS / "payout/grip.toml").read_text()


def timed(work):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
    result = work()
    return result, resource.getrusage(resource.RUSAGE_SELF).ru_utime - before


# closed forms


def reeled():
    p = P["crane"]
    return p["speed"] * (p["time"] - p["ramp"] / 2)


def exact_atwood():
    """Way of the heavier weight: the rope doesn't stretch and turns the wheel, x'' = a + b x."""
    p = P["atwood"]
    light, heavy = p["masses"]
    moved = light + heavy + p["mass"] * p["length"] + p["inertia"] / p["radius"] ** 2
    b = 2 * p["mass"] * G / moved
    a = ((heavy - light) + p["mass"] * p["deeper"]) * G / moved
    return a / b * (math.cosh(math.sqrt(b) * p["time"]) - 1)


def exact_crane():
    """Tension at the winch and at the dead end while the tackle hoists steadily, at the end of the time.

    From the dead end on: a wheel multiplies what is beside it, a fall takes and gives its weight.
    """
    p = P["crane"]
    ratio, w = 1 / p["efficiency"], p["mass"] * G
    whole = p["head"] - p["block"]
    fall = whole - reeled() / 4

    def falls(dead):
        low, carried = dead - w * fall, 0.0
        for _ in range(2):
            up = low * ratio
            carried += low + up
            top = (up + w * fall) * ratio
            low = top - w * fall
        return carried - 2 * math.pi * p["radius"] * w, top - w * whole

    dead = brentq(lambda dead: falls(dead)[0] - p["load"], 0, p["load"], xtol=1e-10)
    return falls(dead)[1], dead


def exact_robot():
    """Place of the platform, and unstretched lengths of the ends that hang down behind the wheels.

    Catenaries with stretch (Irvine) that leave smooth wheels as tangents; on those T + T²/(2 EA) - w z is the same all along.
    """
    p = P["robot"]
    w, ea, r = p["mass"] * G, p["ea"], p["radius"]

    def ends(h, v, length):
        """Of a rope from its upper end, pulled there by h across and v up: how far across and down its lower end is."""
        low = v - w * length
        across = h * length / ea + h / w * (math.asinh(v / h) - math.asinh(low / h))
        down = (v**2 - low**2) / (2 * ea * w) + (math.hypot(h, v) - math.hypot(h, low)) / w
        return across, down

    def stretch(h, v, down):
        """On the wheel, by how far it is below the point where the rope leaves it."""
        tension = math.hypot(h, v)
        return np.sqrt((1 + tension / ea) ** 2 - 2 * w * down / ea)

    def place(wheel, side, h, v, length):
        # the rope leaves the wheel at an angle below the horizontal by which it hangs there
        angle = math.atan2(v, h)
        half = (angle + math.pi / 2) / 2
        points, weights = np.polynomial.legendre.leggauss(12)
        wrapped = weights @ (half * r / stretch(h, v, r * (math.cos(angle) - np.cos(angle - half * (1 - points)))))
        free = length - wrapped
        across, down = ends(h, v, free)
        top = [wheel[0] + side * r * math.sin(angle), wheel[1] + r * math.cos(angle)]
        return np.array([top[0] + side * across, top[1] - down]), v - w * free

    def off(x):
        h, v1, v2 = x
        a, low1 = place(p["wheels"][0], 1, h, v1, p["lengths"][0])
        b, low2 = place(p["wheels"][1], -1, h, v2, p["lengths"][1])
        return [*(a - b), (low1 + low2 - p["load"] * G) / 100]

    h, *v = fsolve(off, [215, 220, 250], xtol=1e-13)
    tails = [p["tail"] / stretch(h, x, r * math.cos(math.atan2(x, h))) for x in v]
    return place(p["wheels"][0], 1, h, v[0], p["lengths"][0])[0], tails


# Exudyn


class Exudyn:
    name = "Exudyn"

    def __init__(self):
        sys.exudynFast = True
        import exudyn
        from exudyn import itemInterface, utilities

        self.exu, self.item, self.util = exudyn, itemInterface, utilities

    def system(self):
        self.mbs = self.exu.SystemContainer().AddSystem()
        self.ground = self.mbs.AddObject(self.item.ObjectGround())
        return self.mbs

    def fixed(self, at):
        return self.mbs.AddMarker(self.item.MarkerBodyRigid(bodyNumber=self.ground, localPosition=at))

    def body(self, mass, at, free):
        """A body that moves along some axes of space and doesn't turn: its number, and its marker."""
        mbs, item = self.mbs, self.item
        inertia = self.util.RigidBodyInertia(mass, np.eye(3) * mass)
        made = mbs.CreateRigidBody(inertia=inertia, referencePosition=at, gravity=[0, 0, -G], returnDict=True)
        marker = mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=made["bodyNumber"]))
        held = [0 if k in free else 1 for k in range(3)] + [1] * 3
        mbs.AddObject(item.GenericJoint(markerNumbers=[self.fixed(at), marker], constrainedAxes=held))
        return made["nodeNumber"], marker

    def rope(self, markers, axes, radii, ea, damping, length, winch=None):
        mbs = self.mbs
        more = [winch, mbs.AddMarker(self.item.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(self.item.NodePointGround()), coordinate=0))] \
            if winch is not None else []
        return mbs.AddObject(
            self.item.ReevingSystemSprings(
                markerNumbers=[*markers, *more],
                hasCoordinateMarkers=winch is not None,
                coordinateFactors=[-1, 1],
                stiffnessPerLength=ea,
                dampingPerLength=damping,
                referenceLength=length,
                sheavesAxes=self.exu.Vector3DList(axes),
                sheavesRadii=radii,
            )
        )

    def solve(self, time, step, record=0.0):
        mbs = self.mbs
        mbs.Assemble()
        s = self.exu.SimulationSettings()
        s.solution.file.write = False
        s.solution.sensors.writePeriod = record or time
        s.parallel.numberOfThreads = 1
        s.timeIntegration.endTime = time
        s.timeIntegration.numberOfSteps = round(time / step)
        s.timeIntegration.generalizedAlpha.spectralRadius = 0.8
        mbs.SolveDynamic(s)

    def atwood(self):
        p = P["atwood"]
        half = (p["length"] - math.pi * p["radius"]) / 2
        low = [half - p["deeper"] / 2, half + p["deeper"] / 2]
        self.system()
        wheel = self.fixed([0, 0, 0])
        left, right = (self.body(m, [s * p["radius"], 0, -x], [2]) for m, s, x in zip(p["masses"], [-1, 1], low))
        self.rope([left[1], wheel, right[1]], [[0, 1, 0]] * 3, [0, p["radius"], 0], p["ea"], 1e3, p["length"])
        _, cpu = timed(lambda: self.solve(p["time"], 1e-3))
        at = self.mbs.GetNodeOutput(right[0], self.exu.OutputVariableType.Displacement)
        return -at[2], cpu

    def grip(self):
        p, item, mbs = GRIP["parameters"], self.item, self.system()
        left, right = (self.body(m, [x, 0, z], [0, 2]) for m, (x, _, z) in zip([p["m1"], p["m2"]], grip_start()))
        self.rope([left[1], self.fixed([0, 0, 0]), right[1]], [[0, 1, 0]] * 3, [0, p["R"], 0], p["EA"], grip_damping(), grip_rest())
        mbs.AddLoad(item.LoadForceVector(markerNumber=right[1], loadVectorUserFunction=lambda mbs, t, load: grip_force(t)))
        place = self.exu.OutputVariableType.Position
        sensors = [mbs.AddSensor(item.SensorNode(nodeNumber=n, outputVariableType=place, storeInternal=True)) for n, _ in (left, right)]
        _, cpu = timed(lambda: self.solve(1, 1e-3, 0.1))
        left, right = (mbs.GetSensorStoredData(s)[1:] for s in sensors)
        return {"m1_z": left[:, 3], "m2_x": right[:, 1], "m2_z": right[:, 3]}, cpu

    def crane(self):
        p = P["crane"]
        r, item = p["radius"], self.item
        self.system()
        mbs = self.mbs
        node, block = self.body(p["load"] / G, [0, 0, p["block"]], [2])
        head, top = self.fixed([0, 0, p["head"]]), self.fixed([-r, 0, p["head"]])
        length = 5 * (p["head"] - p["block"]) + 4 * math.pi * r
        # the winch: a coordinate that is led, whose value is added to the length
        coordinate = mbs.AddNode(item.NodeGenericODE2(referenceCoordinates=[0], initialCoordinates=[0], initialCoordinates_t=[0], numberOfODE2Coordinates=1))
        mbs.AddObject(item.ObjectGenericODE2(nodeNumbers=[coordinate], massMatrix=np.eye(1)))
        led = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=coordinate, coordinate=0))
        nothing = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(item.NodePointGround()), coordinate=0))

        def way(mbs, t, index, offset):
            t, ramp = max(t, 0), p["ramp"]
            s = t / ramp
            done = ramp * (s**6 - 3 * s**5 + 2.5 * s**4) if s < 1 else t - ramp / 2
            return p["speed"] * done

        mbs.AddObject(item.CoordinateConstraint(markerNumbers=[nothing, led], offsetUserFunction=way))
        markers = [self.fixed([-r, 0, p["block"]]), head, block, head, block, top]
        axes = [[0, 1, 0]] * 6
        tension = p["load"] / 4
        rope = self.rope(markers, axes, [0, r, r, r, r, 0], p["ea"], p["damping"], length / (1 + tension / p["ea"]), led)
        _, cpu = timed(lambda: self.solve(p["time"], 1e-3))
        rise = mbs.GetNodeOutput(node, self.exu.OutputVariableType.Displacement)[2]
        return float(mbs.GetObjectOutput(rope, self.exu.OutputVariableType.ForceLocal)), rise, cpu

    def robot(self, tails):
        p = P["robot"]
        self.system()
        x, z = p["start"]
        node, load = self.body(p["load"], [x, 0, z], [0, 2])
        for wheel, side, length, tail in zip(p["wheels"], [1, -1], p["lengths"], tails):
            hub = self.fixed([wheel[0], 0, wheel[1]])
            low = self.fixed([wheel[0] - side * p["radius"], 0, wheel[1] - p["tail"]])
            self.rope([low, hub, load], [[0, side, 0]] * 3, [0, p["radius"], 0], p["ea"], 100, length + tail)
        # its static solver doesn't find it: let it come to rest
        home = self.fixed([x, 0, z])
        self.mbs.AddObject(self.item.CartesianSpringDamper(markerNumbers=[home, load], damping=[300] * 3))
        _, cpu = timed(lambda: self.solve(20, 1e-2))
        at = self.mbs.GetNodeOutput(node, self.exu.OutputVariableType.Position)
        return np.array([at[0], at[2]]), cpu


# MuJoCo


class Mujoco:
    name = "MuJoCo"

    def __init__(self):
        import mujoco

        self.mj = mujoco

    def load(self, body, tendon, step):
        text = f"""<mujoco><option timestep="{step}" gravity="0 0 -{G}" integrator="implicitfast"/>
            <worldbody>{body}</worldbody><tendon>{tendon}</tendon></mujoco>"""
        self.m = self.mj.MjModel.from_xml_string(text)
        self.d = self.mj.MjData(self.m)

    @staticmethod
    def wheel(name, radius, size=0.02):
        return f'<geom name="{name}" type="cylinder" size="{radius} {size}" euler="90 0 0" contype="0" conaffinity="0" mass="0.001"/>'

    def atwood(self):
        p = P["atwood"]
        half = (p["length"] - math.pi * p["radius"]) / 2
        low = [half - p["deeper"] / 2, half + p["deeper"] / 2]
        body = self.wheel("w", p["radius"]) + f'<site name="top" pos="0 0 {2 * p["radius"]}"/>'
        for name, m, side, x in zip("lr", p["masses"], [-1, 1], low):
            body += f"""<body name="{name}" pos="{side * p["radius"]} 0 {-x}"><joint type="slide" axis="0 0 1"/>
                <geom type="sphere" size="0.01" mass="{m}" contype="0" conaffinity="0"/><site name="{name}"/></body>"""
        tendon = """<spatial limited="false"><site site="l"/><geom geom="w" sidesite="top"/><site site="r"/></spatial>"""
        self.load(body, tendon, 1e-3)
        # a rope of fixed length: a stiff spring takes smaller steps than these
        self.m.tendon_stiffness[0], self.m.tendon_damping[0] = 2.5e4, 25
        self.mj.mj_forward(self.m, self.d)
        self.m.tendon_lengthspring[0] = self.d.ten_length[0]
        _, cpu = timed(lambda: self.mj.mj_step(self.m, self.d, round(p["time"] / 1e-3)))
        return float(-self.d.qpos[1]), cpu

    def grip(self):
        p = GRIP["parameters"]
        body = self.wheel("w", p["R"]) + f'<site name="top" pos="0 0 {2 * p["R"]}"/>'
        for name, m, (x, _, z) in zip("lr", [p["m1"], p["m2"]], grip_start()):
            body += f"""<body name="{name}" pos="{x} 0 {z}"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
                <geom type="sphere" size="0.01" mass="{m}" contype="0" conaffinity="0"/><site name="{name}"/></body>"""
        tendon = """<spatial limited="false"><site site="l"/><geom geom="w" sidesite="top"/><site site="r"/></spatial>"""
        self.load(body, tendon, 1e-3)
        m, d, length = self.m, self.d, grip_rest()
        m.tendon_stiffness[0], m.tendon_damping[0], m.tendon_lengthspring[0] = p["EA"] / length, grip_damping() / length, length
        right = self.mj.mj_name2id(m, self.mj.mjtObj.mjOBJ_BODY, "r")

        def run():
            rows = []
            for n in range(1, 1001):
                d.xfrc_applied[right, :3] = grip_force(d.time)
                self.mj.mj_step(m, d)
                if n % 100 == 0:
                    rows.append(d.qpos.copy())
            return np.array(rows)

        moved, cpu = timed(run)
        (_, _, left), (x, _, z) = grip_start()
        return {"m1_z": left + moved[:, 1], "m2_x": x + moved[:, 2], "m2_z": z + moved[:, 3]}, cpu

    def crane(self):
        p = P["crane"]
        r, head, block = p["radius"], p["head"], p["block"]
        mass = p["load"] / G
        body = f'<body pos="0 0 {head}">' + "".join(self.wheel(f"h{k}", r) for k in (1, 2)) + "</body>"
        body += f'<site name="winch" pos="{-r} 0 {block}"/><site name="dead" pos="{-r} 0 {head}"/>'
        body += "".join(f'<site name="above{k}" pos="0 0 {head + 2 * r}"/>' for k in (1, 2))
        # sites between the wheels, in the middle of the falls, half on the block and half on the head
        side = {"f1": r, "f2": -r, "f3": r}
        inner = "".join(f'<site name="{n}" pos="{x} 0 {(head - block) / 2}"/>' for n, x in side.items())
        body += f"""<body name="block" pos="0 0 {block}"><joint type="slide" axis="0 0 1"/>
            {self.wheel("b1", r)}{self.wheel("b2", r)}<geom type="box" size="0.3 0.3 0.3" mass="{mass - 0.002}" contype="0" conaffinity="0"/>
            <site name="below" pos="0 0 {-2 * r}"/>{inner}</body>"""
        tendon = """<spatial><site site="winch"/><geom geom="h1" sidesite="above1"/><site site="f1"/>
            <geom geom="b1" sidesite="below"/><site site="f2"/><geom geom="h2" sidesite="above2"/><site site="f3"/>
            <geom geom="b2" sidesite="below"/><site site="dead"/></spatial>"""
        self.load(body, tendon, 1e-3)
        m, d = self.m, self.d
        self.mj.mj_forward(m, d)
        length = float(d.ten_length[0])
        m.tendon_stiffness[0], m.tendon_damping[0] = p["ea"] / length, p["damping"] / length
        rest = length - p["load"] / 4 / m.tendon_stiffness[0]

        def run():
            ramp, pulls = p["ramp"], []
            for _ in range(round(p["time"] / 1e-3)):
                s = d.time / ramp
                done = ramp * (s**6 - 3 * s**5 + 2.5 * s**4) if s < 1 else d.time - ramp / 2
                m.tendon_lengthspring[0] = rest - p["speed"] * done
                self.mj.mj_step(m, d)
                pulls.append(d.qfrc_passive[0] / 4)
            return float(np.mean(pulls[-1000:]))

        force, cpu = timed(run)
        return force, float(d.qpos[0]), cpu

    def robot(self, tails):
        p = P["robot"]
        x, z = p["start"]
        body, tendon = "", ""
        for k, (wheel, side) in enumerate(zip(p["wheels"], [1, -1])):
            body += f'<body pos="{wheel[0]} 0 {wheel[1]}">{self.wheel(f"w{k}", p["radius"])}</body>'
            body += f'<site name="t{k}" pos="{wheel[0]} 0 {wheel[1] + 2 * p["radius"]}"/>'
            body += f'<site name="a{k}" pos="{wheel[0] - side * p["radius"]} 0 {wheel[1] - p["tail"]}"/>'
            tendon += f'<spatial><site site="a{k}"/><geom geom="w{k}" sidesite="t{k}"/><site site="p"/></spatial>'
        body += f"""<body pos="{x} 0 {z}"><joint type="slide" axis="1 0 0" damping="300"/><joint type="slide" axis="0 0 1" damping="300"/>
            <geom type="sphere" size="0.1" mass="{p["load"]}" contype="0" conaffinity="0"/><site name="p"/></body>"""
        self.load(body, tendon, 1e-3)
        m, d = self.m, self.d
        for k, length in enumerate(np.add(p["lengths"], tails)):
            m.tendon_stiffness[k], m.tendon_lengthspring[k] = p["ea"] / length, length
        _, cpu = timed(lambda: self.mj.mj_step(m, d, 20_000))
        return np.array([x + d.qpos[0], z + d.qpos[1]]), cpu


# Ropewalk


class Ropewalk:
    name = "Ropewalk"

    def __init__(self, program):
        self.program = program

    def run(self, text):
        """Last row of the history, all rows of it, and CPU time of the run."""
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "scene.toml"
            scene.write_text(text)
            out = pathlib.Path(folder) / "out"
            done = subprocess.run([self.program, "run", scene, "--out", out], capture_output=True, text=True)
            if done.returncode != 0:
                raise RuntimeError(done.stdout + done.stderr)
            summary = json.loads(next(out.rglob("summary.json")).read_text())
            table = np.genfromtxt(next(out.rglob("history.csv")), delimiter=",", names=True, deletechars="")
            return np.atleast_1d(table), summary["cpu_s"]

    def atwood(self, friction=""):
        p = P["atwood"]
        half = (p["length"] - math.pi * p["radius"]) / 2
        low = [half - p["deeper"] / 2, half + p["deeper"] / 2]
        masses = "".join(
            f'[[elements]]\ntype = "point_mass"\nname = "{e}"\nmarker = "rope.{e}"\nmass = {m}\n'
            for e, m in zip(["start", "end"], p["masses"])
        )
        r = p["radius"]
        history, cpu = self.run(f"""
            run = {{ duration = {p["time"]}, output = {p["time"]} }}
            [[elements]]
            type = "cable"
            name = "rope"
            section = {{ mass = {p["mass"]}, ea = {p["ea"]} }}
            length = {p["length"]}
            elements = 1
            route = [{{ end = [{-r}, 0, {-low[0]}] }}, {{ over = "wheel" }}, {{ end = [{r}, 0, {-low[1]}] }}]
            {masses}
            [[constraints]]
            type = "sheave"
            name = "wheel"
            marker = [0, 0, 0]
            axis = [0, 1, 0]
            radius = {r}
            inertia = {p["inertia"]}
            {friction}
            [[forces]]
            type = "gravity"
            [[records]]
            type = "position"
            of = "rope.end"
            """)
        z = column(history, "rope.end.z")
        return z[0] - z[-1], cpu

    def grip(self):
        history, cpu = self.run(SCENE)
        names = {"m1_z": "rope.start.z", "m2_x": "rope.end.x", "m2_z": "rope.end.z", "wheel_angle": "wheel.angle"}
        return {key: np.interp(GRIP["reference"]["t"], column(history, "t"), column(history, name)) for key, name in names.items()}, cpu

    def crane(self, statics=False):
        p = P["crane"]
        r, head, block = p["radius"], p["head"], p["block"]
        hoists = 'equilibrium = "hoisting"' if statics else ""
        wheel = f"axis = [0, 1, 0]\nradius = {r}\nefficiency = {p['efficiency']}\n{hoists}\n"
        run = '{ analysis = "statics" }' if statics else f'{{ duration = {p["time"]}, output = 0.01, from_equilibrium = true }}'
        winch = f"speed = {-p['speed']}\nramp = {p['ramp']}\nstart = {100 if statics else 0}"
        z = block + reeled() / 4 if statics else block
        history, cpu = self.run(f"""
            run = {run}
            [[elements]]
            type = "rigid_body"
            name = "block"
            position = [0, 0, {z}]
            mass = {p["load"] / G}
            inertia = [100, 100, 100]
            [[elements]]
            type = "cable"
            name = "hoist"
            section = {{ mass = {p["mass"]}, ea = {p["ea"]}, axial_retardation_time = {p["damping"] / p["ea"]} }}
            elements = 1
            tension = {p["load"] / 4}
            route = [
                {{ end = [{-r}, 0, {block}] }}, {{ over = "h1" }}, {{ under = "b1" }}, {{ over = "h2" }}, {{ under = "b2" }},
                {{ end = [{-r}, 0, {head}] }},
            ]
            [[constraints]]
            type = "prismatic"
            name = "rail"
            marker = "block"
            to = [0, 0, 0]
            axis = [0, 0, 1]
            [[constraints]]
            type = "spherical"
            name = "fairlead"
            marker = "hoist.start"
            [[constraints]]
            type = "spherical"
            name = "dead_end"
            marker = "hoist.end"
            [[constraints]]
            type = "winch"
            name = "winch"
            marker = "hoist.start"
            {winch}
            """ + "".join(
            f'[[constraints]]\ntype = "sheave"\nname = "{name}"\nmarker = {marker}\n{wheel}'
            for name, marker in [("h1", [0, 0, head]), ("h2", [0, 0, head]), ("b1", '"block"'), ("b2", '"block"')]
        ) + """
            [[forces]]
            type = "gravity"
            [[records]]
            type = "position"
            of = "block"
            [[records]]
            type = "sheave"
            of = "h1"
            """)
        # at the winch it is less than at the first wheel by the weight in between
        lead = column(history, "h1.in.tension")[-100 if len(history) > 200 else -1:]
        z = column(history, "block.z")
        return float(np.mean(lead)) - p["mass"] * G * (head - block), z[-1] - z[0], cpu

    def robot(self, tails):
        p = P["robot"]
        x, z = p["start"]
        text = """
            run = { analysis = "statics" }
            """
        for name, wheel, side, length in zip("ab", p["wheels"], [1, -1], np.add(p["lengths"], tails)):
            text += f"""
            [[elements]]
            type = "cable"
            name = "{name}"
            section = {{ mass = {p["mass"]}, ea = {p["ea"]} }}
            length = {length}
            elements = 4
            route = [{{ end = [{wheel[0] - side * p["radius"]}, 0, {wheel[1] - p["tail"]}] }}, {{ over = "w{name}" }}, {{ end = [{x}, 0, {z}] }}]
            [[constraints]]
            type = "spherical"
            name = "{name} below"
            marker = "{name}.start"
            [[constraints]]
            type = "sheave"
            name = "w{name}"
            marker = [{wheel[0]}, 0, {wheel[1]}]
            axis = [0, 1, 0]
            radius = {p["radius"]}
            """
        history, cpu = self.run(text + f"""
            [[elements]]
            type = "point_mass"
            name = "platform"
            marker = "a.end"
            mass = {p["load"]}
            [[constraints]]
            type = "spherical"
            name = "join"
            marker = "b.end"
            to = "a.end"
            [[forces]]
            type = "gravity"
            [[records]]
            type = "position"
            of = "a.end"
            """)
        return np.array([column(history, f"a.end.{x}")[-1] for x in "xz"]), cpu


def column(history, name):
    return history[next(n for n in history.dtype.names if n.startswith(name))]


# the wheel that grips: what the others take for the rope and the force


def grip_start():
    return [end["end"] for end in tomllib.loads(SCENE)["elements"][0]["route"] if "end" in end]


def grip_rest():
    """Length of a rope without mass that holds both weights where they start."""
    p = GRIP["parameters"]
    return (math.pi * p["R"] - sum(z for _, _, z in grip_start())) / (1 + p["m1"] * G / p["EA"])


def grip_damping():
    p = GRIP["parameters"]
    return p["axial_damping_s"] * p["EA"]


def grip_force(t):
    u = min(max(t, 0) / 0.1, 1)
    return [x * u**3 * (10 - 15 * u + 6 * u * u) for x in GRIP["parameters"]["force"]]


def from_contact(got):
    """Error of the Atwood machine's way against the chain with contact on a wheel; nothing below what that is known to."""
    c = P["atwood"]["contact"]
    off, known = abs(got / c["way"] - 1), c["uncertainty"] / c["way"]
    return f"from contact {100 * off:.3f} %" if off > known else f"from contact less than {100 * known:.3f} %"


def main():
    way, (lead, dead), (place, tails) = exact_atwood(), exact_crane(), exact_robot()
    print(f"exact: {way:.5f} m; {lead:.1f} N at the winch, {dead:.1f} N at the dead end; platform at {place.round(5)} m")
    codes = [Exudyn(), Mujoco()] + [Ropewalk(x) for x in sys.argv[1:2]]
    for code in codes:
        got, cpu = code.atwood()
        print(f"{code.name}, atwood: {got:.5f} m, off by {100 * abs(got / way - 1):.2f} %, {from_contact(got)}, {1e3 * cpu:.1f} ms")
        if code.name == "Ropewalk":
            c = P["atwood"]["contact"]
            got, cpu = code.atwood(f"friction = {c['friction']}\nslip_speed = {c['slip_speed']}")
            print(f"{code.name}, atwood with the chain's friction: {got:.5f} m, {from_contact(got)}, {1e3 * cpu:.1f} ms")
        places, cpu = code.grip()
        off = {key: np.abs(x - GRIP["reference"][key]).max() for key, x in places.items()}
        wheel = f"its wheel {off.pop('wheel_angle'):.5f} rad" if "wheel_angle" in off else "its wheel doesn't turn"
        print(f"{code.name}, grip: {1e3 * max(off.values()):.2f} mm from contact, {wheel}, {1e3 * cpu:.1f} ms")
        force, rise, cpu = code.crane()
        print(
            f"{code.name}, crane: {force:.1f} N at the winch, off by {100 * abs(force / lead - 1):.2f} %, rise {rise:.4f} m for "
            f"{reeled() / 4:.4f} m, {1e3 * cpu:.1f} ms"
        )
        if code.name == "Ropewalk":
            force, _, cpu = code.crane(statics=True)
            print(f"{code.name}, crane by statics: {force:.1f} N, off by {100 * abs(force / lead - 1):.3f} %, {1e3 * cpu:.1f} ms")
        at, cpu = code.robot(tails)
        print(f"{code.name}, robot: {at.round(5)} m, off by {1e3 * np.linalg.norm(at - place):.4f} mm, {1e3 * cpu:.1f} ms")


if __name__ == "__main__":
    main()
