"""Methods that add parts to a scene, one for each type. Made by generate.py from the schemas: don't edit."""

# ruff: noqa: A002, E501
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Union

from ._part import Part

Number = Union[float, str]
"""A number in SI units, a text that brings its unit ("2 kn"), or a parameter ("$speed")."""
Integer = Union[int, str]
"""A whole number, or a parameter."""
Boolean = Union[bool, str]
"""True or False, or a parameter."""


class Parts:
    """A method for each type of part, `set_...` for each section, `add_...` for lists without types."""

    def _add(self, list: str, type: str, fields: Mapping[str, Any]) -> Part:
        raise NotImplementedError

    def _append(self, list: str, fields: Mapping[str, Any]) -> Part:
        raise NotImplementedError

    def _set(self, section: str, fields: Mapping[str, Any]) -> None:
        raise NotImplementedError

    def attachments(
        self,
        *,
        name: str,
        on: str,
        at: Number,
        mass: Number,
        spacing: Number | None = None,
        count: Integer | None = None,
        volume: Number | None = None,
        added_mass: Number | None = None,
        drag_area: Number | None = None,
    ) -> Part:
        """Clump weights, floats or other compact bodies on a cable, one or many at a regular spacing. The cable has a
        node at each.

        Each is a `point_mass` of the name of the whole with a number: `floats1`, `floats2`, …

        name: Name; the rest of the scene refers to each by it and its number, from 1.
        on: The cable that carries them, which must stand above in the scene.
        at: Unstretched length from the start of the cable to the first of them [m].
        mass: Mass of each [kg].
        spacing: Unstretched length from each to the next [m].
        count: How many there are. Default 1.
        volume: Displaced volume of each, for buoyancy [m³]. Default 0.0.
        added_mass: Added mass of each in water, the same in all directions [kg]. Default 0.0.
        drag_area: Drag coefficient times area of each [m²]. Default 0.0.
        """
        return self._add("elements", "attachments", {
            "name": name,
            "on": on,
            "at": at,
            "mass": mass,
            "spacing": spacing,
            "count": count,
            "volume": volume,
            "added_mass": added_mass,
            "drag_area": drag_area,
        })

    def cable(
        self,
        *,
        name: str,
        points: Sequence[Sequence[Number]] | None = None,
        radius: Number | None = None,
        curve: Sequence[Sequence[Number]] | None = None,
        start_direction: Sequence[Number] | None = None,
        end_direction: Sequence[Number] | None = None,
        route: Sequence[Mapping[str, Any]] | None = None,
        speed: Number | None = None,
        length: Number | None = None,
        tension: Number | None = None,
        elements: Integer | None = None,
        mesh: Union[Mapping[str, Any], Sequence[Number]] | None = None,
        section: Union[Mapping[str, Any], str] | None = None,
        sections: Sequence[Mapping[str, Any]] | None = None,
        longitudinal: Literal['L1', 'L1n', 'L2', 'L3', 'L4'] | None = None,
        transverse: Literal['T1', 'T2', 'T3'] | None = None,
        integration: Literal['full', 'locking-free'] | None = None,
        velocity: Sequence[Number] | None = None,
        stress_free: Literal['as-laid', 'straight'] | None = None,
        strain: Number | None = None,
        curvature: Number | None = None,
        normal: Sequence[Number] | None = None,
        twist: Number | None = None,
        laid_twist: Number | None = None,
        levers: Mapping[str, Any] | None = None,
    ) -> Part:
        """A cable, hose or tether with large displacements, stretch and bending, and torsion if its section has a
        torsional stiffness `gj`.

        It is a chain of ANCF elements with 6 velocities per node, with torsion 7. Markers: `name.start`, `name.end`,
        `name@12.5m`.

        name: Name; the rest of the scene refers to the part by it.
        points: Points of the path along which it is laid, from start to end [m], joined by straight lines. At
            corners, give a `radius`: a sharp corner would strain the cable.
        radius: Bend radius at the corners of `points` [m]. The arcs have elements of their own.
        curve: Points of a smooth path [m], instead of `points`: a cubic spline passes through them.
        start_direction: Direction of `curve` at its start. Default: follows from the first points.
        end_direction: Direction of `curve` at its end. Default: follows from the last points.
        route: What it runs over and through, from end to end, instead of `points`: `[{ end = "drum" }, { over =
            "head" }, { under = "block" }, { end = "jib.anchor" }]`. Sheaves and rings are constraints of their own.
            The cable is then several spans, `name.1`, `name.2`, …, each with `elements` elements, and runs freely
            from one to the next; its shape at the start is the shortest taut line. A route without ends is that of a
            closed belt: `[{ round = "driver" }, { round = "driven" }]`.
        speed: Speed with which a cable with a `route` runs along it at the start, from its start to its end [m/s].
        length: Unstretched length [m]. Default: the length of the path. Another length is strained uniformly to fit
            the path.
        tension: Initial tension [N], instead of `length`: the path is longer than the cable by the strain `tension /
            ea`.
        elements: Number of elements of equal length. Give `elements` or `mesh`.
        mesh: Elements of different lengths instead of `elements`: `{ elements = 24, last = "1 mm" }` grades them
            towards the end, `first` towards the start, both towards both; or a list with the length of each, from
            start to end [m]. Where the direction is held, elements should be shorter than the bending layer
            `√(EI/T)`. A graded end stays graded while a winch pays out there.
        section: Cross-section, `{ mass = …, ea = …, ei = … }`, with the fields that `ropewalk describe sections`
            tells; or the name of one of the scene's `sections`: `section = "chain"`. Give `section` or `sections`.
            mass: Structural mass per unstretched length [kg/m]; gravity acts on it. Required.
            ea: Axial stiffness EA [N]; or give `axial_force`.
            axial_force: Axial force over strain, instead of `ea`: `{ strain = [0, 0.01, 0.03], force = ["0 kN", "10
                kN", "60 kN"] }`. Between the points the force follows a smooth curve that never falls, beyond them a
                straight line. Needs L4.
            tension_only: Whether it only pulls: chains and ropes don't resist being pressed together. Needs L4.
            ei: Bending stiffness EI [N m²]. With 0, the first and last element keep 1 % of their weight times their
                length squared, so that free ends have a direction. Two numbers where it isn't the same in all
                directions, of a cable with torsion: about the `normal` of the section, and about the axis across it.
                Default 0.0.
            bending_moment: Bending moment over curvature, instead of `ei`: `{ curvature = [0, 0.01, 0.1], moment =
                ["0 N m", "50 N m", "80 N m"] }`, the same in all directions and without loss of energy. Needs T3.
            gj: Torsional stiffness GJ [N m²]. With it the cable can be twisted, and its ends are held against
                twisting where they are built in. Default: no torsion; but EI where the stress-free shape is curved.
            torque_tension: Coupling `C` of torque and tension in laid ropes and armoured cables [N m]: `N = EA ε + C
                φ'` and `M = C ε + GJ φ'`, with `ea` measured while the ends can't turn. Positive of a right-hand lay:
                such a rope unlays when it is pulled. A torque factor `c`, by which the torque of a held end is `c d
                T`, means `C = c d EA`. Needs L4.
            rotary_inertia: Polar moment of inertia of the section, per length [kg m], of a cable with torsion.
                Default: that of a solid round bar, `mass diameter²/8`.
            flooded: Mass of the water inside [kg/m]. It moves with the part and has no weight in water. Default 0.0.
            diameter: Hydrodynamic diameter, for drag and added mass; what rolls in a groove, by `fleet_twist` of a
                `sheave`, rolls by it too [m]. Default 0.0.
            displaced: Displaced volume per length, for buoyancy [m²]. Default: `π/4 diameter²`.
            axial_retardation_time: Retardation time of stretching (Kelvin–Voigt) [s]: the axial force is `EA (ε + τ
                ε̇)`. With a table EA is its largest slope here. Default 0.0.
            bending_retardation_time: Retardation time of bending (Kelvin–Voigt) [s]: the moment is `EI (κ + τ κ̇)`,
                with the largest slope of a table. The rate is that in axes of the section where the cable has
                torsion, `gj`, and no end feeds, so that a bent shaft that spins is damped; else that seen along the
                tangent. Default 0.0.
            torsional_retardation_time: Retardation time of twisting (Kelvin–Voigt) [s]: the torque is `GJ (φ' + τ
                dφ'/dt)`.
            gyroscopic: Whether the spin of a cable with torsion about its own axis turns it aside, as that of a top
                does: of shafts that turn fast. Ropes don't notice.
        sections: Several sections one after the other, from start to end: `[{ to = "200 m", section = "chain" }, {
            section = "wire" }]`. Sections that stretch differently are spliced: their tangents agree, and where one
            of them has no bending stiffness it can turn freely. Weight, buoyancy, drag and contact are those of the
            section at each place.
        longitudinal: Longitudinal stiffness model: L1, L1n, L2, L3 or L4. Default L4.
        transverse: Transverse stiffness model: T1, T2 or T3; T2 and T3 go with L3 and L4 only. Default T3.
        integration: Quadrature of the pointwise models. Default locking-free.
        velocity: Initial velocity of the whole cable [m/s]. Default [0.0, 0.0, 0.0].
        stress_free: Stress-free shape. Default straight.
        strain: Stress-free strain, added to that of `stress_free` [1]. Default 0.0.
        curvature: Stress-free curvature, added to that of `stress_free` [1/m]. Of a cable with torsion it is about
            the `normal` of the section; without, it has no direction, and the cable can curl to any side. Default
            0.0.
        normal: Direction in space of the first director of the section, at the start of the cable: the axis about
            which the first of two bending stiffnesses and `curvature` are. Along the cable it is laid without twist.
            Default: where a curved cable bends most, at right angles to the plane in which it does; else it doesn't
            matter.
        twist: Stress-free twist per length of a cable with torsion, added to that of `stress_free` [rad/m].
        laid_twist: Twist per length with which a cable with torsion is laid [rad/m]. What is wound on a drum at the
            start keeps it, whatever equilibrium the run begins with.
        levers: Points beside the axis of a cable with torsion, by name, that its sections carry along, such as the
            end of a crank: `levers.crank = { at = "end", offset = [0, 0, "10 cm"] }` gives a marker `name.crank`.
        """
        return self._add("elements", "cable", {
            "name": name,
            "points": points,
            "radius": radius,
            "curve": curve,
            "start_direction": start_direction,
            "end_direction": end_direction,
            "route": route,
            "speed": speed,
            "length": length,
            "tension": tension,
            "elements": elements,
            "mesh": mesh,
            "section": section,
            "sections": sections,
            "longitudinal": longitudinal,
            "transverse": transverse,
            "integration": integration,
            "velocity": velocity,
            "stress_free": stress_free,
            "strain": strain,
            "curvature": curvature,
            "normal": normal,
            "twist": twist,
            "laid_twist": laid_twist,
            "levers": levers,
        })

    def point_mass(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        mass: Number,
        volume: Number | None = None,
        added_mass: Number | None = None,
        drag_area: Number | None = None,
        velocity: Sequence[Number] | None = None,
    ) -> Part:
        """A compact body: a sinker, a buoy, the load at the end of a hose.

        On a cable it belongs to the node; at a point of a body or link it moves and turns with the body; with a
        position it is a free point. Marker: `name`.

        name: Name; the rest of the scene refers to the part by it.
        marker: Marker of an earlier element that carries it, such as `"hose.end"`, or its initial position [m].
        mass: Mass [kg].
        volume: Displaced volume, for buoyancy and the pressure of waves [m³]. Default 0.0.
        added_mass: Added mass in water, the same in all directions [kg]. Default 0.0.
        drag_area: Drag coefficient times area [m²]. Default 0.0.
        velocity: Initial velocity, of a free point only [m/s]. Default [0.0, 0.0, 0.0].
        """
        return self._add("elements", "point_mass", {
            "name": name,
            "marker": marker,
            "mass": mass,
            "volume": volume,
            "added_mass": added_mass,
            "drag_area": drag_area,
            "velocity": velocity,
        })

    def rigid_body(
        self,
        *,
        name: str,
        position: Sequence[Number],
        angles: Sequence[Number] | None = None,
        velocity: Sequence[Number] | None = None,
        angular_velocity: Sequence[Number] | None = None,
        mass: Number | None = None,
        density: Number | None = None,
        shape: Mapping[str, Any] | None = None,
        inertia: Sequence[Number] | None = None,
        products: Sequence[Number] | None = None,
        centre: Sequence[Number] | None = None,
        volume: Number | None = None,
        centre_of_volume: Sequence[Number] | None = None,
        hull: Mapping[str, Any] | None = None,
        added_mass: Number | None = None,
        drag_area: Number | None = None,
        drawn: Mapping[str, Any] | None = None,
        points: Mapping[str, Any] | None = None,
    ) -> Part:
        """A rigid body with full inertia.

        All its data are in the body's own frame, whose origin starts at `position`. Markers: `name` (that origin),
        `name.com` (the centre of mass), and the `points` that the scene names.

        name: Name; the rest of the scene refers to the part by it.
        position: Initial position of the origin of its frame [m].
        angles: Initial orientation as Bryant angles 1-2-3: turns about its x axis, its new y axis, its new z axis
            [rad]. Default [0.0, 0.0, 0.0].
        velocity: Initial velocity of the origin [m/s]. Default [0.0, 0.0, 0.0].
        angular_velocity: Initial angular velocity, in space [rad/s]. Default [0.0, 0.0, 0.0].
        mass: Mass [kg]. Default: from `shape` and `density`.
        density: Density of the `shape` [kg/m³].
        shape: Homogeneous shape; the moments of inertia follow from it.
        inertia: Moments of inertia `Jxx`, `Jyy`, `Jzz` about the centre of mass [kg m²], instead of a shape.
        products: Products of inertia `Jxy`, `Jxz`, `Jyz`: the off-diagonal entries of the inertia matrix [kg m²].
            Default [0.0, 0.0, 0.0].
        centre: Centre of mass [m]. Default [0.0, 0.0, 0.0].
        volume: Displaced volume, for buoyancy [m³]. Default 0.0.
        centre_of_volume: Centre of buoyancy [m]. Default: the centre of mass. If the water has a `level`, the volume
            of a body with a hull is distributed along the hull.
        hull: Cylinder for drag and added mass. Default: none; then the body is a ball of its `volume`, on which
            `drag_area`, `added_mass` and the pressure of waves act.
            from: One end of its axis [m]. Required.
            to: The other end [m]. Required.
            diameter: Diameter [m]. Required.
        added_mass: Added mass in water of a body without hull, the same in all directions, at the centre of its
            volume [kg].
        drag_area: Drag coefficient times area of a body without hull [m²].
        drawn: Cylinder that stands for it in pictures, if it has neither `hull` nor `shape`; nothing acts on it.
            from: One end of its axis [m]. Required.
            to: The other end [m]. Required.
            diameter: Diameter [m]. Required.
        points: Named points of the body [m]; each is a marker.
        """
        return self._add("elements", "rigid_body", {
            "name": name,
            "position": position,
            "angles": angles,
            "velocity": velocity,
            "angular_velocity": angular_velocity,
            "mass": mass,
            "density": density,
            "shape": shape,
            "inertia": inertia,
            "products": products,
            "centre": centre,
            "volume": volume,
            "centre_of_volume": centre_of_volume,
            "hull": hull,
            "added_mass": added_mass,
            "drag_area": drag_area,
            "drawn": drawn,
            "points": points,
        })

    def rigid_chain(
        self,
        *,
        name: str,
        links: Integer,
        section: Mapping[str, Any],
        length: Number | None = None,
        points: Sequence[Sequence[Number]] | None = None,
        curve: Sequence[Sequence[Number]] | None = None,
        spool: Mapping[str, Any] | None = None,
        stress_free: Literal['as-laid', 'straight'] | None = None,
        velocity: Sequence[Number] | None = None,
    ) -> Part:
        """A chain of rigid links of equal length with spherical joints: a hose, a tether, a chain.

        It starts at rest with the ends of all links on its path. Markers: `name.start`, `name.end`, `name@12.5m` (a
        point of a link), `name.link3` (the centre of the third). The joint between the third and the fourth link is
        the constraint `name/3`, so its reaction is the tension there.

        name: Name; the rest of the scene refers to the part by it.
        links: Number of links.
        section: Cross-section.
            mass: Structural mass per length [kg/m]; gravity acts on it. Required.
            flooded: Mass of the water inside [kg/m]. It moves with the part and has no weight in water. Default 0.0.
            diameter: Hydrodynamic diameter, for drag and added mass [m]; without one, neither acts. Default 0.0.
            displaced: Displaced volume per length, for buoyancy [m²]. Default: `π/4 diameter²`.
            gyration: Radius of gyration about a link's axis [m]. Default: that of a solid cylinder, 0.354 times the
                diameter.
            ei: Bending stiffness EI [N m²], as springs at the joints of moment `EI/l sin θ` about every axis: linear
                for small angles, 16 % less at a radian, and links fold where a moment exceeds `EI/l`. Default 0.0.
            joint_damping: Damping of the joints about every axis [N m s/rad]. Default 0.0.
        length: Length of the chain [m]. Default: the chain fills its path. A shorter chain ends on the path.
        points: Points of the path along which it is laid, from start to end [m], joined by straight lines.
        curve: Points of a smooth path [m], instead of `points`.
        spool: Spool that carries the rest of the chain, after the last of the points.
            centre: A point on the axis [m]. Required.
            axis: Direction of the axis. The turns follow it, right-handed about it. Required.
            pitch: Distance from turn to turn along the axis [m]; negative for turns that are left-handed about it.
                Required.
            turns: Number of turns. Default: as many as the `length` of the chain needs.
        stress_free: Shape in which its joints have no bending moment. Default straight.
        velocity: Initial velocity of the whole chain [m/s]. Default [0.0, 0.0, 0.0].
        """
        return self._add("elements", "rigid_chain", {
            "name": name,
            "links": links,
            "section": section,
            "length": length,
            "points": points,
            "curve": curve,
            "spool": spool,
            "stress_free": stress_free,
            "velocity": velocity,
        })

    def break_(
        self,
        *,
        name: str,
        constraint: str,
        force: Number,
    ) -> Part:
        """Breaks a constraint permanently once its force reaches a limit: a shear pin, a weak link. The event is located
        in time and reported.

        name: Name; the report of the event uses it.
        constraint: Name of the constraint that breaks. It must come earlier in the scene.
        force: Magnitude of the force at which the constraint breaks [N].
        """
        return self._add("constraints", "break", {
            "name": name,
            "constraint": constraint,
            "force": force,
        })

    def clamp(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
        direction: Sequence[Number] | None = None,
        twist: Boolean | None = None,
    ) -> Part:
        """Holds position and direction: a built-in end.

        On a cable it holds the point and the tangent; the stretch stays free, as the tension there needs. A cable
        with torsion can't twist there either, unless it is on a swivel (`twist = false`). On a rigid body or a link
        it holds all six degrees of freedom, as `weld` does. To hold the direction only, use `direction`; to hold the
        position only, `spherical`.

        name: Name; records refer to the reaction by it.
        marker: The marker that is held, on a cable or a rigid body.
        to: What holds it: a marker on a rigid body or a point in space. Default: the point where the marker starts.
        direction: Direction of the cable at the start, in space. Default: the direction in which the cable is laid.
        twist: Whether a cable with torsion (`section.gj`) is kept from turning about its own axis; `false` is a
            swivel. Default: it is.
        """
        return self._add("constraints", "clamp", {
            "name": name,
            "marker": marker,
            "to": to,
            "direction": direction,
            "twist": twist,
        })

    def coordinate(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        direction: Sequence[Number],
        motion: str | None = None,
    ) -> Part:
        """Holds or drives one coordinate of a marker along a direction. The other two are free.

        name: Name; records of the reaction refer to it.
        marker: The marker.
        direction: Direction of the coordinate, in space.
        motion: Name of a motion; its component along the direction drives the coordinate. Default: the coordinate is
            held.
        """
        return self._add("constraints", "coordinate", {
            "name": name,
            "marker": marker,
            "direction": direction,
            "motion": motion,
        })

    def cylindrical(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """Lets a body slide along an axis of another part or of space, and turn about it.

        name: Name; records of the reaction refer to it.
        marker: The marker that is held.
        axis: Direction of the axis in space at the start. The axis turns with the parts.
        to: The other marker, or a point in space. Default: the point where `marker` starts.
        """
        return self._add("constraints", "cylindrical", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "to": to,
        })

    def direction(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
        direction: Sequence[Number] | None = None,
        twist: Boolean | None = None,
    ) -> Part:
        """Holds the direction of a cable at a marker, in space or on a rigid body. Position and stretch stay free.

        Use it for a guide that a cable slides through, or beside a constraint that drives the position. To hold the
        position as well, use `clamp`. A cable with torsion can't twist there either, unless `twist` is `false`.

        name: Name; records of the reaction refer to it.
        marker: The marker on the cable.
        to: The rigid body that holds the direction. Default: space.
        direction: The direction in space at the start. Default: the direction in which the cable is laid.
        twist: Whether a cable with torsion (`section.gj`) is kept from turning about its own axis. Default: it is.
        """
        return self._add("constraints", "direction", {
            "name": name,
            "marker": marker,
            "to": to,
            "direction": direction,
            "twist": twist,
        })

    def distance(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str],
        length: Number | None = None,
    ) -> Part:
        """Keeps two points at a constant distance: a massless rod.

        name: Name; records of the reaction refer to it.
        marker: One marker.
        to: The other marker, or a point in space.
        length: Distance [m]. Default: the initial distance.
        """
        return self._add("constraints", "distance", {
            "name": name,
            "marker": marker,
            "to": to,
            "length": length,
        })

    def driving(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        motion: str,
    ) -> Part:
        """Moves a marker along a prescribed motion, starting at its initial position.

        name: Name; records of the reaction refer to it.
        marker: The marker that is driven.
        motion: Name of the motion.
        """
        return self._add("constraints", "driving", {
            "name": name,
            "marker": marker,
            "motion": motion,
        })

    def drum(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        radius: Number,
        speed: Union[Mapping[str, Any], Number] | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
        stop: Number | None = None,
        payout: Number | None = None,
        turn: str | None = None,
        torque: Union[Mapping[str, Any], Number] | None = None,
        brake: Union[Mapping[str, Any], Number] | None = None,
        slip_speed: Number | None = None,
        damping: Number | None = None,
        inertia: Number | None = None,
        wound: Number | None = None,
        wound_tension: Number | None = None,
        pitch: Number | None = None,
        width: Number | None = None,
        layer_height: Number | None = None,
        layers: Integer | None = None,
        fleet: Number | None = None,
    ) -> Part:
        """A drum on which an end of a cable is wound that names it in its `route`.

        The cable leaves it as a tangent, wherever it goes to, and is wound without slip. The drum pays out as it
        turns by the right-hand rule about its `axis`; so about [0, 1, 0] it leaves from the top towards x. Its
        `speed` or angle is prescribed, or it is turned by `torque`, its cable and `brake`. What is wound keeps the
        stretch with which it was wound, and the twist.

        name: Name; routes and records refer to it.
        marker: Its middle: a point in space, or of a rigid body, which stands above the cable in the scene.
        axis: Axis in space at the start; it turns with what carries the drum. Turning about it by the right-hand rule
            pays out.
        radius: Radius of the first layer, to the middle of the cable [m].
        speed: Rope speed on the layer of the start, after the ramp [m/s]; negative reels in. The drum turns so; a
            load that swings makes no slip. Of an input: the speed itself, without ramp, so the input needs `join =
            "linear"`.
        start: Start time [s].
        ramp: Time in which the speed rises, and falls again at the stop [s]. Default 1.0.
        stop: Time at which the speed begins to fall again [s]. Default: never.
        payout: Length paid out when it stops [m], with the sign of the speed, instead of `stop`.
        turn: Name of a motion whose x component is the angle of the drum [rad], instead of `speed`.
        torque: Moment of its motor, if the speed isn't prescribed, positive where it pays out [N m].
        brake: Moment of its brake, dry friction [N m].
        slip_speed: Speed of the cable below which the brake creeps instead of sticking [m/s]. Default 0.001.
        damping: Moment by angular velocity [N m s/rad].
        inertia: Moment of inertia about its axis, without cable: that of `wound` is added. Its mass, with the cable
            on it, belongs to what carries it [kg m²].
        wound: Length of cable on it at the start, as it lies [m]. The run ends when 3 turns are left. Default:
            unlimited, and without inertia.
        wound_tension: Tension with which that was wound [N], which tells its stretch; what is wound later keeps the
            tension that it has then. Default: the tension at the start, of the equilibrium if the run begins with
            one, or else at which the cable is laid.
        pitch: Way of the cable along the axis in a turn [m]; usually its diameter. It winds towards the axis first.
            Default: none, as behind a device that keeps it in the middle.
        width: Width between the flanges [m]: the cable is wound in layers. Goes with `pitch` and `wound`. Default:
            one layer of any width, which begins at `marker`.
        layer_height: Height of a layer on the one below [m]. Default: 0.866 `pitch`, that of cables that lie in the
            grooves of the layer below.
        layers: Number of layers; the run ends when they are full. Default: any.
        fleet: Angle against the plane of the drum from which on a cable winds badly, which is said once [rad].
            Default 0.026179938779914945.
        """
        return self._add("constraints", "drum", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "radius": radius,
            "speed": speed,
            "start": start,
            "ramp": ramp,
            "stop": stop,
            "payout": payout,
            "turn": turn,
            "torque": torque,
            "brake": brake,
            "slip_speed": slip_speed,
            "damping": damping,
            "inertia": inertia,
            "wound": wound,
            "wound_tension": wound_tension,
            "pitch": pitch,
            "width": width,
            "layer_height": layer_height,
            "layers": layers,
            "fleet": fleet,
        })

    def eyelet(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
        path: str | None = None,
        speed: Union[Mapping[str, Any], Number] | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
        stop: Number | None = None,
        motion: str | None = None,
        tension: Union[Mapping[str, Any], Number] | None = None,
        per_speed2: Union[Mapping[str, Any], Number] | None = None,
        reference_speed: str | None = None,
        damping: Union[Mapping[str, Any], Number] | None = None,
        grip: Number | None = None,
        shortest: Number | None = None,
        element_length: Number | None = None,
        fade: Number | None = None,
    ) -> Part:
        """An eyelet through which an end of a cable runs: a fixed or moving point, and what draws the cable there.

        It combines a `spherical` or `driving` constraint with a `winch`. The point stays where the end starts, moves
        with `to`, or along `path`. Give one of `speed`, `motion` and `tension`; the others are results. The
        constraint of the point has the name of the eyelet; the winch is called `name.feed`.

        name: Name; records and events refer to it.
        marker: The end of the cable: `fibre.start` or `fibre.end`.
        to: The marker that carries the eyelet, or a point in space. Default: the point where the end starts.
        path: Name of a motion of the eyelet, starting where the end starts, instead of `to`.
        speed: Speed at which cable enters through the eyelet after the ramp [m/s]; negative draws it out of the free
            cable.
        start: Time at which the speed begins to rise [s]. Default 0.0.
        ramp: Time in which the speed rises, and falls again at the stop [s]. Default 1.0.
        stop: Time at which the speed begins to fall again [s]. Default: never.
        motion: Name of a motion whose x component is the length that has entered, instead of `speed`.
        tension: Tension with which the cable is drawn [N], instead of a speed.
        per_speed2: Tension per speed squared, added to `tension` [kg/m]. Default 0.0.
        reference_speed: Name of a motion whose speed along x `per_speed2` refers to. Default: the speed of the cable
            here, which can be unstable.
        damping: Linear damping, added to `tension` [N s/m]. Default 0.0.
        grip: What keeps a cable with torsion from turning about its own axis in the eyelet: torque over the spin of
            its material [N m s]. With much of it, it takes its twist along when it leaves.
        shortest: Shortest length of the free cable [m]; the run ends there. Default: as for `winch`.
        element_length: Length of the elements that are added and removed at the eyelet [m]. Default: all elements
            grow and shrink together.
        fade: Fade time [s] of the strain that keeps the tension continuous when an element is added or removed.
            Default 0.1.
        """
        return self._add("constraints", "eyelet", {
            "name": name,
            "marker": marker,
            "to": to,
            "path": path,
            "speed": speed,
            "start": start,
            "ramp": ramp,
            "stop": stop,
            "motion": motion,
            "tension": tension,
            "per_speed2": per_speed2,
            "reference_speed": reference_speed,
            "damping": damping,
            "grip": grip,
            "shortest": shortest,
            "element_length": element_length,
            "fade": fade,
        })

    def lift_off(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        package: Mapping[str, Any],
        tangent: Boolean | None = None,
        adhesion_energy: Number | None = None,
        slip_speed: Number | None = None,
    ) -> Part:
        """The lift-off point of a cable from a package. It runs round the package as the cable unwinds.

        A `winch` at the same end drives the unwinding: by `speed` or `motion`, or by the `tension` at the package.
        Or, without a winch, the cable sticks to the package with `adhesion_energy`. The other end needs an `eyelet`.
        A cable with torsion leaves the layer as it lies there: each wrap that is pulled off over the end of the
        package brings it a turn. Events are reported on the way: a tension too low to keep the cable taut, contact
        with the package, too much bending.

        name: Name; records of the reaction refer to it.
        marker: The wound end of the cable: `fibre.end` or `fibre.start`.
        package: The package.
            radius: Radius of the first layer to unwind, to the middle of the cable [m]. Required.
            length: Wound length along the axis, the same for all layers [m]. Required.
            diameter: Diameter of the cable [m]; the radius changes by it from layer to layer. Required.
            origin: Origin of its axis: the centre of one end [m]. Default [0.0, 0.0, 0.0].
            axis: Direction of its axis, from the origin to the other end. Default [0.0, 0.0, 1.0].
            reference: Direction from the axis to the first lift-off point. Default: x, or y if the axis is along x.
            side: Side of the package from which the cable lifts off. Default inner.
            pitch: Distance along the axis per turn [m]. Default: the diameter of the cable, turns side by side.
            layers: Number of layers. Default 1.
            hand: Sense in which the lift-off point runs round the axis. Default right.
            traverse: Direction along the axis in which the first layer unwinds. Default forward.
            first: Position of the first lift-off point along the axis, from its origin [m]. Default: the end where a
                full first layer begins.
            min_bend_radius: Minimum bend radius of the cable [m]; below it the run reports an event. Default: no
                limit.
        tangent: Whether the cable is tangent to the wound layer at the lift-off point. Needs bending stiffness.
            Default False.
        adhesion_energy: Adhesion energy `Γ` per length [J/m], instead of a winch at this end. A `tangent` cable lifts
            off where `EI (κ - κ_w)²/2 = Γ`, with the curvature `κ_w` of the wound cable; another one at the angle `D`
            with `T (1 - cos D) = Γ`.
        slip_speed: Slip speed [m/s]: below it the adhesion creeps instead of sticking. Goes with `adhesion_energy`.
            Default 0.001.
        """
        return self._add("constraints", "lift_off", {
            "name": name,
            "marker": marker,
            "package": package,
            "tangent": tangent,
            "adhesion_energy": adhesion_energy,
            "slip_speed": slip_speed,
        })

    def perpendicular(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
        axis_to: Sequence[Number] | None = None,
        axis: Sequence[Number] | None = None,
    ) -> Part:
        """Keeps an axis of one part at right angles to an axis of another part or of space.

        name: Name; records of the reaction refer to it.
        marker: The marker that is held.
        to: The other marker, or a point in space. Default: the point where `marker` starts.
        axis_to: Axis of `to` in space at the start; it turns with `to`. Leave it out on a cable: there the axis is
            the tangent.
        axis: Axis of `marker` in space at the start; it turns with `marker`. Leave it out on a cable.
        """
        return self._add("constraints", "perpendicular", {
            "name": name,
            "marker": marker,
            "to": to,
            "axis_to": axis_to,
            "axis": axis,
        })

    def point_on_line(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """Keeps a point on a straight line that is fixed to another part or in space.

        name: Name; records of the reaction refer to it.
        marker: The marker that is held.
        axis: Direction of the line in space at the start. The line turns with `to`.
        to: The other marker, or a point in space. Default: the point where `marker` starts.
        """
        return self._add("constraints", "point_on_line", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "to": to,
        })

    def point_on_plane(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """Keeps a point in a plane that is fixed to another part or in space.

        name: Name; records of the reaction refer to it.
        marker: The marker that is held.
        axis: Normal of the plane in space at the start. The plane turns with `to`.
        to: The other marker, or a point in space. Default: the point where `marker` starts.
        """
        return self._add("constraints", "point_on_plane", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "to": to,
        })

    def prismatic(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """Lets a body slide along an axis of another part or of space. It can't turn.

        name: Name; records of the reaction refer to it.
        marker: The marker that is held.
        axis: Direction of the axis in space at the start. The axis turns with the parts.
        to: The other marker, or a point in space. Default: the point where `marker` starts.
        """
        return self._add("constraints", "prismatic", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "to": to,
        })

    def revolute(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """A hinge: holds two points together; only the rotation about an axis is free. The end of a cable swings in the
        plane normal to the axis.

        name: Name; records of the reaction refer to it.
        marker: The marker that is held.
        axis: Direction of the axis in space at the start. The axis turns with the parts.
        to: The other marker, or a point in space. Default: the point where `marker` starts.
        """
        return self._add("constraints", "revolute", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "to": to,
        })

    def ring(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        friction: Number | None = None,
        slip_speed: Number | None = None,
        equilibrium: Literal['hoisting', 'lowering', 'none', 'to_end', 'to_start'] | None = None,
    ) -> Part:
        """A ring through which a cable runs that names it in its `route`: a shackle, a fairlead, a thimble, small beside
        the spans. For a wheel whose size counts take a `sheave`.

        The cable turns sharply there; its bending stiffness doesn't resist that. A cable with torsion carries its
        twist through; its torque turns it out of the plane of the spans there, as far as its bending stiffness lets
        it, which it needs. With `friction` the tensions before and behind differ by the capstan equation with the
        angle of deflection.

        name: Name; routes and records refer to it.
        marker: Where it is: a point in space, or of a part that stands above the cable in the scene.
        friction: Coefficient of friction. Default: none.
        slip_speed: Speed of sliding below which friction fades, so that a held cable creeps at a part of it [m/s].
            Default 0.001.
        equilibrium: What friction does at equilibria, which aren't unique with it.
        """
        return self._add("constraints", "ring", {
            "name": name,
            "marker": marker,
            "friction": friction,
            "slip_speed": slip_speed,
            "equilibrium": equilibrium,
        })

    def rotation(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        motion: str,
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """Drives the angle between two parts about a common axis. Use it together with a `revolute` joint.

        name: Name; records of the reaction refer to it.
        marker: The marker that is driven, on a rigid body or a cable.
        axis: Direction of the axis in space at the start.
        motion: Name of the motion, whose x component is the angle [rad].
        to: The other marker, on a rigid body. Default: space.
        """
        return self._add("constraints", "rotation", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "motion": motion,
            "to": to,
        })

    def sheave(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        radius: Number,
        count: Integer | None = None,
        spacing: Number | None = None,
        friction: Number | None = None,
        inertia: Number | None = None,
        locked: Boolean | None = None,
        efficiency: Number | None = None,
        bearing: Mapping[str, Any] | None = None,
        torque: Union[Mapping[str, Any], Number] | None = None,
        slip_speed: Number | None = None,
        turns: Integer | None = None,
        fleet_twist: Number | None = None,
        flank_friction: Number | None = None,
        equilibrium: Literal['hoisting', 'lowering', 'none', 'to_end', 'to_start'] | None = None,
    ) -> Part:
        """A sheave: a wheel over which cables run that name it in their `route`.

        The cable is tangent to it on both sides, wherever it comes from and goes to; what lies on it stretches, has
        mass and weight. Without friction the tension is the same on both sides, but for what weight and acceleration
        of the piece on the wheel do. With `friction` the cable sticks, creeps and slips on the groove by the capstan
        equation, and turns a wheel with `inertia`. With `inertia` or `bearing` alone the wheel turns with the cable.
        `efficiency` is for tables of cranes.

        A cable may lift off from the wheel and come down on it again, which is told, but for one of several `turns`;
        what an impact takes counts in the balance of energy as a change of mesh.

        A cable with torsion (`section.gj`) rolls freely in the groove: its torque is the same before and behind, and
        its twist runs over the wheel with it. With `fleet_twist` one that comes from the side is twisted as it rolls
        down the flank of the groove.

        name: Name; routes and records refer to it.
        marker: Its centre: a point in space, or of a rigid body, which stands above the cable in the scene.
        axis: Axis in space at the start; it turns with what carries the sheave. `round` goes about it by the right-
            hand rule; for `over` and `under` its sign doesn't matter.
        radius: Radius to the middle of the cable: that of the groove and half a diameter of the cable [m].
        count: Number of sheaves side by side on one axle; routes name them `NAME.1`, `NAME.2`, …
        spacing: Distance from each of them to the next, along the axis [m].
        friction: Coefficient of friction between cable and groove, in a V-groove divided by the sine of half its
            angle. Needs `inertia`, or `locked`. Default: none.
        inertia: Moment of inertia of the wheel about its axis; its mass belongs to what carries it [kg m²].
        locked: Whether the wheel can't turn, such as a bollard or a worn-out sheave. Goes with `friction`.
        efficiency: Ratio of the tensions before and behind it that half a turn leaves, from 0 to 1: friction of the
            bearing and stiffness of the cable together, as in tables of cranes; typically 0.98 on roller bearings.
            Instead of the other ways to lose power.
        bearing: What resists the spin.
            friction: Coefficient of friction on its own radius, by the force of the cable on the axle. Default 0.0.
            radius: Radius at which that acts [m]. Default 0.0.
            torque: Constant moment [N m]. Default 0.0.
            damping: Moment by angular velocity [N m s/rad]. Default 0.0.
        torque: Moment that drives a wheel with `friction` and `inertia`, about its axis [N m].
        slip_speed: Speed of sliding below which friction fades, so that a held cable creeps at a part of it [m/s].
            Default 0.001.
        turns: Whole turns of the cable about it, besides the angle by which it turns there, as on a capstan or a
            bollard. They lie side by side, and are taken to come and go in one plane. The wrap may then become any
            angle. Default: none; a cable that wraps all round ends the run.
        fleet_twist: Share of pure rolling by which a cable that comes to its groove by a fleet angle `δ` is twisted
            as it goes down the flank to the bottom, from 0 to 1: `sin δ/(π diameter)` turns per length at 1, as long
            as friction on the flank holds its torque. For cables with `gj` and a `diameter`. Default: 0, the fleet
            angle doesn't twist it.
        flank_friction: Coefficient of friction on the flank, for `fleet_twist`: the torque that twists it is at most
            this times the tension, `sin δ` and half the diameter. Default: `friction`.
        equilibrium: What friction does at equilibria, which aren't unique with it.
        """
        return self._add("constraints", "sheave", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "radius": radius,
            "count": count,
            "spacing": spacing,
            "friction": friction,
            "inertia": inertia,
            "locked": locked,
            "efficiency": efficiency,
            "bearing": bearing,
            "torque": torque,
            "slip_speed": slip_speed,
            "turns": turns,
            "fleet_twist": fleet_twist,
            "flank_friction": flank_friction,
            "equilibrium": equilibrium,
        })

    def slide(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        motion: str,
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """Drives the displacement of a marker along an axis of another.

        name: Name; records of the reaction refer to it.
        marker: The marker that is driven.
        axis: Direction of the axis in space at the start. The axis turns with `to`.
        motion: Name of the motion, whose x component is the displacement along the axis.
        to: The other marker. Default: the point where `marker` starts.
        """
        return self._add("constraints", "slide", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "motion": motion,
            "to": to,
        })

    def spherical(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """Holds two points together, of two parts or of a part and space. All rotations are free.

        name: Name; records of the reaction refer to it.
        marker: The marker that is held.
        to: The other marker, or a point in space. Default: the point where `marker` starts.
        """
        return self._add("constraints", "spherical", {
            "name": name,
            "marker": marker,
            "to": to,
        })

    def universal(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
        axis_to: Sequence[Number] | None = None,
        axis: Sequence[Number] | None = None,
    ) -> Part:
        """A universal joint: holds two points together, and keeps an axis of one part at right angles to an axis of the
        other.

        name: Name; records of the reaction refer to it.
        marker: The marker that is held.
        to: The other marker, or a point in space. Default: the point where `marker` starts.
        axis_to: Axis of `to` in space at the start; it turns with `to`. Leave it out on a cable: there the axis is
            the tangent.
        axis: Axis of `marker` in space at the start; it turns with `marker`. Leave it out on a cable.
        """
        return self._add("constraints", "universal", {
            "name": name,
            "marker": marker,
            "to": to,
            "axis_to": axis_to,
            "axis": axis,
        })

    def vessel(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        heading: Number | None = None,
        rao: Mapping[str, Any] | None = None,
        file: str | None = None,
        ramp: Number | None = None,
    ) -> Part:
        """Moves a rigid body as a vessel, in all six degrees of freedom: by its responses to the waves of the scene
        (`rao`), or by a table of its motions over time (`file`).

        The marker is the vessel's reference point, and the body starts at rest as it lies in still water: let the
        waves rise (`ramp`). Surge, sway and heave are along the axes of the mean heading (x ahead, y to port, z up),
        then yaw, pitch (bow down) and roll (port up) turn it: `R = Rz(heading + yaw) Ry(pitch) Rx(roll)`. The
        reaction is what it takes to move it. What is fastened to the body's points moves along.

        name: Name; records of the reaction refer to it.
        marker: Reference point, on a rigid body.
        heading: Heading, from x to y [rad]. Default 0.0.
        rao: Responses to waves; the scene needs `[water.waves]`.
            headings: Directions that waves travel relative to the heading, ascending from 0 [rad]: 0 from astern, 90
                deg towards port, 180 deg a head sea. Between them, and round from the last to the first, responses
                are interpolated. Required.
            omegas: Angular frequencies, ascending [rad/s]. Beyond them responses are those at the ends. Required.
            amplitude: For each direction and frequency, per metre of wave amplitude. Motions: surge, sway, heave in
                metres, roll, pitch, yaw in degrees. Loads: forces in N along x, y, z, moments in N m about them.
                Required.
            lag: For each direction and frequency the lag of each behind the crest in degrees. Required.
            phase: Whether phases lag behind the crest, or lead it.
            waves: Whether `headings` are where waves travel to, or where they come from.
            per: Whether responses are per metre of amplitude, or of height from trough to crest.
            symmetry: Whether the table goes from 0 to 180 deg and holds for the other side of a symmetric vessel too.
            angles: Unit of amplitudes of roll, pitch and yaw.
        file: CSV file with the columns `t`, and any of `surge`, `sway`, `heave` (in m), `roll`, `pitch`, `yaw` (in
            rad unless their headings say deg): joined by cubic splines.
        ramp: Time from t = 0 in which the motions of a `file` grow from nothing, as `(1 - cos πt/ramp)/2` [s].
            Responses to waves grow with the waves. Default 0.0.
        """
        return self._add("constraints", "vessel", {
            "name": name,
            "marker": marker,
            "heading": heading,
            "rao": rao,
            "file": file,
            "ramp": ramp,
        })

    def weld(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """Joins two parts rigidly, as they stand at the start. Of a cable, point and tangent are held, and of one with
        torsion (`section.gj`) the twist; the stretch stays free.

        name: Name; records of the reaction refer to it.
        marker: The marker that is held.
        to: The other marker, or a point in space. Default: the point where `marker` starts.
        """
        return self._add("constraints", "weld", {
            "name": name,
            "marker": marker,
            "to": to,
        })

    def winch(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        speed: Union[Mapping[str, Any], Number] | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
        stop: Number | None = None,
        payout: Number | None = None,
        final_length: Number | None = None,
        motion: str | None = None,
        tension: Union[Mapping[str, Any], Number] | None = None,
        brake: Union[Mapping[str, Any], Number] | None = None,
        slip_speed: Number | None = None,
        damping: Union[Mapping[str, Any], Number] | None = None,
        per_speed2: Union[Mapping[str, Any], Number] | None = None,
        reference_speed: str | None = None,
        inertia: Number | None = None,
        wrap: Number | None = None,
        grip: Number | None = None,
        pile: Boolean | None = None,
        stored_length: Number | None = None,
        shortest: Number | None = None,
        element_length: Number | None = None,
        fade: Number | None = None,
    ) -> Part:
        """Pays out or reels in cable at one end. Mass, momentum and drag follow the changing length.

        Position that end with another constraint, such as `spherical` or `driving`. Prescribe the payout rate with
        `speed` or `motion`, or leave it free and give the resistance: `tension`, `brake`, `damping`, `inertia`. With
        `speed = 0` the winch has no effect.

        name: Name; records and events refer to it.
        marker: The end of the cable: `hose.start` or `hose.end`.
        speed: Payout rate after the ramp [m/s]; negative reels in. With `final_length` the sign may be left positive.
            Of an input: the rate itself, without ramp, so the input needs `join = "linear"`.
        start: Start time [s]. Default 0.0.
        ramp: Time in which the speed rises, and falls again at the stop [s]. Default 1.0.
        stop: Time at which the speed begins to fall again [s]. Default: never.
        payout: Length paid out when it stops [m], with the sign of the speed, instead of `stop`.
        final_length: Length of the cable when it stops [m], instead of `stop` and `payout`.
        motion: Name of a motion whose x component is the payout length, instead of `speed`.
        tension: Constant tension of the winch [N], if the speed isn't prescribed.
        brake: Dry friction of the brake [N]. Default 0.0.
        slip_speed: Slip speed of the brake [m/s]: below it the brake creeps instead of sticking. Default 0.001.
        damping: Linear damping: tension per payout rate [N s/m]. Default 0.0.
        per_speed2: Tension per speed squared, added to `tension` [kg/m]. Measurements at eyelets often follow this
            law. Default 0.0.
        reference_speed: Name of a motion whose speed along x `per_speed2` refers to. Default: the payout rate here. A
            tension that draws the cable and grows with its speed is unstable: then name a motion.
        inertia: Moment of inertia of the drum over its radius squared [kg]. Default 0.0.
        wrap: Length of a wrap of the coil over whose end the cable is pulled [m]: each brings it a turn of twist,
            which needs a cable with torsion (`section.gj`). Negative of coils of the other hand, whose turns are
            left-handed. Default: it comes off a drum that turns, untwisted. An end that is held against twisting
            (`clamp`) keeps the twist in.
        grip: What keeps a cable with torsion from turning about its own axis as it passes this end: torque over the
            spin of its material [N m s]. With much of it a cable that is reeled in takes its twist along; without, it
            can spin freely, unless the end is held (`clamp`): then only untwisted cable passes.
        pile: Whether the cable comes from a pile at rest instead of a turning drum. Default False.
        stored_length: Length stored on the spool at the start [m]. The run ends when it is paid out. Default:
            unlimited.
        shortest: Shortest length of the cable [m]; the run ends there. Default: 5 % of the initial length, at least
            two elements.
        element_length: Length of the elements that are added and removed at this end [m]. Default: all elements grow
            and shrink together. Smoother; suits length changes up to about tenfold.
        fade: Fade time [s] of the strain that keeps the tension continuous when an element is added or removed.
            Default 0.1.
        """
        return self._add("constraints", "winch", {
            "name": name,
            "marker": marker,
            "speed": speed,
            "start": start,
            "ramp": ramp,
            "stop": stop,
            "payout": payout,
            "final_length": final_length,
            "motion": motion,
            "tension": tension,
            "brake": brake,
            "slip_speed": slip_speed,
            "damping": damping,
            "per_speed2": per_speed2,
            "reference_speed": reference_speed,
            "inertia": inertia,
            "wrap": wrap,
            "grip": grip,
            "pile": pile,
            "stored_length": stored_length,
            "shortest": shortest,
            "element_length": element_length,
            "fade": fade,
        })

    def added_mass(
        self,
        *,
        ca: Number | None = None,
        ca_axial: Number | None = None,
        theory: Literal['energy', 'morison'] | None = None,
        tail: Number | None = None,
        on: Sequence[str] | None = None,
    ) -> Part:
        """Added mass of cables and hulls: inertia of the water, and its forces in flow along the body. In waves also the
        force of their pressure on the volume displaced (Froude-Krylov), in all directions.

        It follows from the kinetic energy of the water: a hull at an angle to the flow has Munk's moment, and flow
        along a cable acts like compression and can cause flutter. `theory = "morison"` keeps the inertia only, for
        comparison with codes that have no more. In waves `morison` takes the acceleration of the water at a fixed
        place, as most codes do; otherwise it is that along the path of the water, and a line as heavy as water goes
        with it.

        ca: Coefficient: added mass over the mass of water in a cylinder of the hydrodynamic diameter. Default 1.0.
        ca_axial: The same along the axis: 0 for smooth cables, about 0.1 for rough ropes, up to 0.5 for chains. At
            most `ca`. Default 0.0.
        theory: `energy` or `morison`. Default: `energy`.
        tail: Fraction of its momentum that the water returns at free ends of cables: 0 for cut ends, about 0.8 for
            tapered ends, 1 for an ideal tail. Default 0.0.
        on: Parts it acts on. Default: all.
        """
        return self._add("forces", "added_mass", {
            "ca": ca,
            "ca_axial": ca_axial,
            "theory": theory,
            "tail": tail,
            "on": on,
        })

    def bed(
        self,
        *,
        name: str | None = None,
        on: Sequence[str] | None = None,
        point: Sequence[Number] | None = None,
        slope: Number | None = None,
        rises: Sequence[Number] | None = None,
        grid: Mapping[str, Any] | None = None,
        stiffness: Number | None = None,
        damping: Number | None = None,
        friction: Union[Mapping[str, Any], Number] | None = None,
        radius: Number | None = None,
    ) -> Part:
        """The sea floor: a plane, level or sloping, or heights on a grid. It presses on cables all along where their
        surface is below it, on hulls and on point masses, brakes what comes down, and holds with dry friction, along
        and across, without creep.

        A cable lies with its axis half a diameter above the bed, less the sinkage `w/(stiffness d)` under its weight
        `w` per length: a small part of the water depth keeps tensions right. Records of type `touchdown` show where a
        line comes to lie.

        name: Name. Default bed.
        on: Parts that can lie on it. Default: all but clumps and floats that sit on a cable or a body, and have no
            size of their own.
        point: A point of the bed [m]; with a `grid`, what its lines and heights are counted from. Default: the
            origin. Default [0.0, 0.0, 0.0].
        slope: By what angle it slopes [rad].
        rises: Horizontal direction in which it rises. Default [1.0, 0.0].
        grid: Heights on a grid, instead of a plane.
            file: A CSV file with a row `x, y, z` [m] for each crossing of the grid; its path is relative to the scene
                file.
            x: Lines of the grid along x, ascending [m].
            y: Lines along y [m].
            z: Heights: for each `x` a row with one for each `y` [m].
        stiffness: Stiffness of the soil: pressure on the diameter of what lies on it, per depth [N/m³], such as `"100
            kN/m^3"`. Default 1000000.0.
        damping: Damping of what comes down, the same per speed [N s/m³]. What leaves isn't held back. Default 0.0.
        friction: Dry friction: a coefficient, or `{ mu, across, elastic_slip, equilibrium }`. Equilibria are those
            without it, unless `equilibrium` is `laid` or `pulled`.
        radius: Contact radius of the parts [m]. Default: half of the diameter of the cable or hull.
        """
        return self._add("forces", "bed", {
            "name": name,
            "on": on,
            "point": point,
            "slope": slope,
            "rises": rises,
            "grid": grid,
            "stiffness": stiffness,
            "damping": damping,
            "friction": friction,
            "radius": radius,
        })

    def buoyancy(
        self,
        *,
        on: Sequence[str] | None = None,
    ) -> Part:
        """Buoyancy of the displaced volume; if the water has a `level`, of the volume under water.

        At the surface, cables, hulls and chains are cylinders; other bodies and point masses are spheres. In waves it
        is that below the surface at each instant; what the pressure of the waves adds comes with `added_mass`.

        on: Parts it acts on. Default: all.
        """
        return self._add("forces", "buoyancy", {
            "on": on,
        })

    def bushing(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
        axis_x: Sequence[Number] | None = None,
        axis_y: Sequence[Number] | None = None,
        stiffness: Sequence[Union[Mapping[str, Any], Number]] | None = None,
        damping: Sequence[Union[Mapping[str, Any], Number]] | None = None,
        rotational_stiffness: Sequence[Union[Mapping[str, Any], Number]] | None = None,
        rotational_damping: Sequence[Union[Mapping[str, Any], Number]] | None = None,
    ) -> Part:
        """A spring and damper in all six directions between two rigid bodies, or a body and space: a rubber mount, a
        soft joint. There is no force in the initial position. Rotations up to half a turn are valid: a run ends
        there. A record of type `force` shows the force and the moment on `marker`.

        name: Name.
        marker: The marker that is held.
        to: The other marker, on a rigid body or a cable with torsion, or a point in space; its axes are those of the
            stiffnesses. Default: the point where `marker` starts.
        axis_x: Direction of the first axis in space at the start. Default, with `axis_y`: the axes of space.
        axis_y: Direction of the second axis in space at the start, at right angles to the first.
        stiffness: Stiffness along each axis [N/m]. Default [0.0, 0.0, 0.0].
        damping: Damping along each axis [N s/m]. Default [0.0, 0.0, 0.0].
        rotational_stiffness: Stiffness about each axis [N m/rad]. Default [0.0, 0.0, 0.0].
        rotational_damping: Damping about each axis [N m s/rad]. Default [0.0, 0.0, 0.0].
        """
        return self._add("forces", "bushing", {
            "name": name,
            "marker": marker,
            "to": to,
            "axis_x": axis_x,
            "axis_y": axis_y,
            "stiffness": stiffness,
            "damping": damping,
            "rotational_stiffness": rotational_stiffness,
            "rotational_damping": rotational_damping,
        })

    def contact(
        self,
        *,
        name: str,
        shape: Mapping[str, Any],
        on: Sequence[str] | None = None,
        points: Sequence[Union[Sequence[Number], str]] | None = None,
        marker: Union[Sequence[Number], str] | None = None,
        radius: Number | None = None,
        stiffness: Number | None = None,
        stiffness_per_length: Number | None = None,
        end_stiffness: Number | None = None,
        exponent: Number | None = None,
        damping: Union[Literal['none'], Mapping[str, Any]] | None = None,
        friction: Union[Mapping[str, Any], Number] | None = None,
        overlap: Literal['allow', 'refuse'] | None = None,
    ) -> Part:
        """Contact of cables and bodies with a shape, on the ground or on a rigid body. The body of the shape feels the
        opposite force.

        Cables, links and bodies with a hull are in contact anywhere along their length where the shape is nearer than
        their radius. Point masses and single points are spheres of the given `radius`. A record of type `force` shows
        the force.

        name: Name.
        shape: The shape.
        on: Parts in contact with the shape: cables, bodies with a hull, point masses. Default, without `points`: all
            except the shape's own body, and clumps and floats that sit on another part.
        points: Single points in contact, such as corners of bodies: markers, each a sphere of the `radius`.
        marker: Position of the shape: a point in space, or a marker on the rigid body that carries it. Default: the
            origin. Default [0.0, 0.0, 0.0].
        radius: Contact radius of the parts [m]. Default: half of the diameter of the cable or hull.
        stiffness: Contact stiffness of a point mass or point [N/m]; with an exponent `p` other than 1, at a depth of
            1 m. Default 0.0.
        stiffness_per_length: Contact stiffness per length of cables and hulls [N/m²]; with an exponent other than 1,
            at a depth of 1 m. Default 0.0.
        end_stiffness: Additional contact stiffness of the tips of cables and hulls [N/m]; with an exponent other than
            1, at a depth of 1 m. Default: that of a piece as long as its diameter.
        exponent: Exponent `p` of the elastic force `k d^p`. Default 1.0.
        damping: Damping law along the normal. Default none.
        friction: Dry friction: a coefficient, or `{ mu, across, elastic_slip, equilibrium }`. Equilibria are computed
            without it, since with friction they are not unique, unless `equilibrium` is `laid` or `pulled`.
        overlap: What to do with points that start deep in the shape. Default refuse.
        """
        return self._add("forces", "contact", {
            "name": name,
            "shape": shape,
            "on": on,
            "points": points,
            "marker": marker,
            "radius": radius,
            "stiffness": stiffness,
            "stiffness_per_length": stiffness_per_length,
            "end_stiffness": end_stiffness,
            "exponent": exponent,
            "damping": damping,
            "friction": friction,
            "overlap": overlap,
        })

    def drag(
        self,
        *,
        normal: Literal['choo-casarella', 'constant'] | None = None,
        tangential: Literal['choo-casarella', 'constant'] | None = None,
        cn: Number | None = None,
        ct: Number | None = None,
        end: Number | None = None,
        stretched: Boolean | None = None,
        blend: Number | None = None,
        on: Sequence[str] | None = None,
    ) -> Part:
        """Drag of water (and air, if the scene has it) on cables and hulls, with one law across and one along. In waves
        it goes by the velocity relative to current and waves together.

        normal: Law across the cable. Default constant.
        tangential: Law along the cable. Default constant.
        cn: Coefficient across, for the constant law, on the diameter. Default 1.2.
        ct: Coefficient along, for the constant law, on the circumference. Default 0.01.
        end: Form drag of each free end of cables, hulls and chains: coefficient on the area of the end face. Both
            ends of a long blunt cylinder have about 0.8 together. Default 0.0.
        stretched: Whether drag acts per stretched length instead of unstretched length. Default False.
        blend: Relative width in Reynolds number over which the branches of Choo and Casarella are blended. Default:
            they jump, as published.
        on: Cables it acts on. Default: all.
        """
        return self._add("forces", "drag", {
            "normal": normal,
            "tangential": tangential,
            "cn": cn,
            "ct": ct,
            "end": end,
            "stretched": stretched,
            "blend": blend,
            "on": on,
        })

    def free_vessel(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        stiffness: Union[Sequence[Number], Sequence[Sequence[Number]]],
        heading: Number | None = None,
        added_mass: Union[Sequence[Number], Sequence[Sequence[Number]]] | None = None,
        damping: Union[Sequence[Number], Sequence[Sequence[Number]]] | None = None,
        quadratic_damping: Sequence[Number] | None = None,
        mean_load: Sequence[Number] | None = None,
        loads: Mapping[str, Any] | None = None,
    ) -> Part:
        """A rigid body floats as a vessel or a buoy, by 6 x 6 matrices of stiffness, added mass and damping about its
        reference point, and loads of waves by frequency and direction.

        The matrices are over surge, sway, heave, roll, pitch, yaw, along axes ahead, to port and up: N/m, N and N m
        for what is per metre or radian, kg, kg m and kg m² for added mass, N s/m, N s and N m s for damping. The body
        starts where it floats in still water, and there its weight is carried; `stiffness` says how weight and
        buoyancy change from there, so that the body needs no `volume`. `mean_load` carries the lines. Motions are
        turned as those of `vessel`: `R = Rz(heading + yaw) Ry(pitch) Rx(roll)`. Wave loads and mean load are for the
        mean place and heading; damping and added mass turn with the body. Currents don't act on it, and second-order
        loads aren't in it: what they are on average goes into `mean_load`. A record of type `force` shows the six
        motions and the force of the waves.

        name: Name, by which records ask for it.
        marker: Reference point, on a rigid body: what all coefficients are about.
        stiffness: Stiffness: how weight and buoyancy change with the motions, and what holds the vessel beside its
            lines.
        heading: Mean heading, from x to y [rad]. Default 0.0.
        added_mass: Added mass. Default [0.0, 0.0, 0.0, 0.0, 0.0, 0.0].
        damping: Linear damping. Default [0.0, 0.0, 0.0, 0.0, 0.0, 0.0].
        quadratic_damping: Quadratic damping of each motion, `B |v| v`, in N s²/m² and N m s². Default [0.0, 0.0, 0.0,
            0.0, 0.0, 0.0].
        mean_load: Constant force in N and moment in N m on it at the reference point: what carries the lines, mean
            wind and drift. Default [0.0, 0.0, 0.0, 0.0, 0.0, 0.0].
        loads: Loads of waves, per metre of amplitude: forces in N, moments in N m; the scene needs `[water.waves]`.
            headings: Directions that waves travel relative to the heading, ascending from 0 [rad]: 0 from astern, 90
                deg towards port, 180 deg a head sea. Between them, and round from the last to the first, responses
                are interpolated. Required.
            omegas: Angular frequencies, ascending [rad/s]. Beyond them responses are those at the ends. Required.
            amplitude: For each direction and frequency, per metre of wave amplitude. Motions: surge, sway, heave in
                metres, roll, pitch, yaw in degrees. Loads: forces in N along x, y, z, moments in N m about them.
                Required.
            lag: For each direction and frequency the lag of each behind the crest in degrees. Required.
            phase: Whether phases lag behind the crest, or lead it.
            waves: Whether `headings` are where waves travel to, or where they come from.
            per: Whether responses are per metre of amplitude, or of height from trough to crest.
            symmetry: Whether the table goes from 0 to 180 deg and holds for the other side of a symmetric vessel too.
            angles: Unit of amplitudes of roll, pitch and yaw.
        """
        return self._add("forces", "free_vessel", {
            "name": name,
            "marker": marker,
            "stiffness": stiffness,
            "heading": heading,
            "added_mass": added_mass,
            "damping": damping,
            "quadratic_damping": quadratic_damping,
            "mean_load": mean_load,
            "loads": loads,
        })

    def function(
        self,
        *,
        function: Union[Callable[..., Any], str],
        name: str | None = None,
        marker: Union[Sequence[Number], str] | None = None,
        on: Sequence[str] | None = None,
        parameters: Mapping[str, Any] | None = None,
    ) -> Part:
        """A force that a function gives, which the program that runs the scene has written, such as a script in Python:
        at a `marker`, or along cables and what else carries distributed loads.

        To try things out: each call takes microseconds, and a step takes tens of calls, since derivatives are
        differences. What stays deserves a type of its own. All of its work counts as supplied from outside.

        function: Name of the function that was registered; in Python the function itself. `type = "name"` says the
            same, with its parameters beside it.
        name: Name, by which records ask for it. Default: that of the function.
        marker: The marker on which it acts. Default: it acts along cables.
        on: Cables, chains and hulls that it acts along, without a marker. Default: all.
        parameters: What the function is given besides the state, by name. A text that is a number with a unit becomes
            a number in SI units.
        """
        return self._add("forces", "function", {
            "function": function,
            "name": name,
            "marker": marker,
            "on": on,
            "parameters": parameters,
        })

    def gravity(
        self,
        *,
        on: Sequence[str] | None = None,
    ) -> Part:
        """Weight: the scene's `gravity` acts on the structural mass of every part.

        on: Parts it acts on. Default: all.
        """
        return self._add("forces", "gravity", {
            "on": on,
        })

    def internal_flow(
        self,
        *,
        cable: str,
        density: Number,
        bore: Number,
        speed: Union[Mapping[str, Any], Number],
        time: Union[Literal['constant'], Mapping[str, Any]] | None = None,
        nozzle: Number | None = None,
        outlet_pressure: Number | None = None,
        friction: Number | None = None,
        closed: Boolean | None = None,
        weight: Boolean | None = None,
    ) -> Part:
        """A fluid that flows through a cable: its mass, its weight, its Coriolis and centrifugal forces, and the thrust
        where it enters and leaves. A pipe held at both ends buckles where it flows too fast, one with a free outlet
        flutters.

        The bore is full and keeps its volume however the cable is stretched. Then the tension of the cable is the
        effective one, that of the wall less the inner pressure times the bore's area (plus the outer pressure times
        the outer area): pressure and the fluid's friction by themselves move nothing. Damping of the cable isn't part
        of it, nor is the fluid's mass in `section.mass`.

        cable: The cable that it flows through. Its length must not change.
        density: Density of the fluid [kg/m³].
        bore: Inner diameter of the unstretched cable [m].
        speed: Speed relative to the wall, towards the end of the cable [m/s]: the volume flow over the bore's area.
            Negative: towards its start. An input needs `join = "smooth"` or `"linear"`, since a flow that jumps would
            be a blow.
        time: Factor of the speed as a function of time. Default constant.
        nozzle: Diameter of the nozzle through which it leaves [m]. Default: that of the bore.
        outlet_pressure: Pressure that it meets where it leaves, above that of the surroundings [Pa]; in a closed loop
            that at the start. Only the record `wall_tension` asks for it. Default 0.0.
        friction: Darcy's friction factor, about 0.02 in a smooth hose. Only the record `wall_tension` asks for it.
            Default 0.0.
        closed: Whether the cable's end leads into its start, so that nothing enters or leaves. Default False.
        weight: Whether the fluid has weight, of the scene's `gravity`. Default True.
        """
        return self._add("forces", "internal_flow", {
            "cable": cable,
            "density": density,
            "bore": bore,
            "speed": speed,
            "time": time,
            "nozzle": nozzle,
            "outlet_pressure": outlet_pressure,
            "friction": friction,
            "closed": closed,
            "weight": weight,
        })

    def latch(
        self,
        *,
        name: str,
        on: Sequence[str],
        stiffness: Number,
        force: Number,
        to: Union[Sequence[Number], str] | None = None,
        damping: Number | None = None,
        direction: Sequence[Number] | None = None,
        fade: Number | None = None,
        floor: Mapping[str, Any] | None = None,
        stop: Boolean | None = None,
    ) -> Part:
        """Holds points at their initial positions, each by a spring and damper, until the force on one reaches a limit:
        that point is then released permanently. Each release is located in time and reported.

        Use it for a hose on its spool, a cable tied with tape, a load that is dropped. The record `released` counts
        the releases.

        name: Name; the reports of releases use it.
        on: What it holds: parts (every node or link of them) and single markers. A cable puts a node where a marker
            is.
        stiffness: Stiffness of a seat [N/m].
        force: Force of a seat at which the point is released [N].
        to: Marker on the rigid body that carries the seats. Default: fixed in space.
        damping: Damping of a seat [N s/m]. Default 0.0.
        direction: Direction in space; only the component along it counts. Default: the magnitude of the force.
        fade: Fade time of the force after a release [s]. Default 0.001.
        floor: A plane fixed in space that pushes released points back.
            point: A point of the plane [m]. Required.
            normal: Its normal, on the side where points may be. Required.
            stiffness: Contact stiffness [N/m]. Required.
        stop: Whether the run ends when the last point is released. Default False.
        """
        return self._add("forces", "latch", {
            "name": name,
            "on": on,
            "stiffness": stiffness,
            "force": force,
            "to": to,
            "damping": damping,
            "direction": direction,
            "fade": fade,
            "floor": floor,
            "stop": stop,
        })

    def line_contact(
        self,
        *,
        name: str,
        stiffness_per_length: Number,
        on: Sequence[str] | None = None,
        itself: Boolean | None = None,
        exponent: Number | None = None,
        damping: Union[Literal['none'], Mapping[str, Any]] | None = None,
        friction: Union[Mapping[str, Any], Number] | None = None,
        overlap: Literal['allow', 'refuse'] | None = None,
    ) -> Part:
        """Contact of cables and of bodies with a hull with each other, and of cables with themselves: lines that cross,
        coils, knots, a line that falls onto itself.

        They touch anywhere along their length where their middle lines are nearer than both radii; ends are round.
        With `friction` they hold on to each other. An end that starts in another line, more than half of the radius
        deep, is taken as tied to it, and both leave each other alone there. Along one line, what is nearer than 1.6
        diameters along it isn't looked at. A record of type `force` shows what presses, how deep and over which
        length, and with friction what holds and which part of what presses slips; a record `clearance` shows how near
        two lines are.

        name: Name.
        stiffness_per_length: Contact stiffness per length [N/m²]; with an exponent other than 1, at a depth of 1 m.
        on: The cables and bodies with a hull that touch one another. Default: all that have a diameter.
        itself: Whether each cable touches itself too. Default True.
        exponent: Exponent `p` of the elastic force `k d^p`. Default 1.0.
        damping: Damping law along the normal. Default none.
        friction: Dry friction: a coefficient, or `{ mu, elastic_slip, equilibrium }`; `elastic_slip` is how far it
            gives way where lines press a hundredth of their thickness into each other. Lines that cross at less than
            30° hold less across, down to nothing where they are parallel: they roll on each other. Equilibria are
            computed without friction unless `equilibrium` is `laid`.
        overlap: What to do with lines that start deep in each other. Default refuse.
        """
        return self._add("forces", "line_contact", {
            "name": name,
            "stiffness_per_length": stiffness_per_length,
            "on": on,
            "itself": itself,
            "exponent": exponent,
            "damping": damping,
            "friction": friction,
            "overlap": overlap,
        })

    def line_load(
        self,
        *,
        force: Sequence[Union[Mapping[str, Any], Number]],
        stretched: Boolean | None = None,
        time: Union[Literal['constant'], Mapping[str, Any]] | None = None,
        on: Sequence[str] | None = None,
    ) -> Part:
        """A distributed force in a constant direction.

        force: Force per length [N/m].
        stretched: Whether it acts per stretched length instead of unstretched length. Default False.
        time: Factor as a function of time. Default constant.
        on: Cables it acts on. Default: all.
        """
        return self._add("forces", "line_load", {
            "force": force,
            "stretched": stretched,
            "time": time,
            "on": on,
        })

    def point_force(
        self,
        *,
        marker: Union[Sequence[Number], str],
        force: Sequence[Union[Mapping[str, Any], Number]] | None = None,
        local: Boolean | None = None,
        follower: Union[Mapping[str, Any], Number] | None = None,
        time: Union[Literal['constant'], Mapping[str, Any]] | None = None,
    ) -> Part:
        """A force at a marker: in a constant direction, in the axes of a rigid body, or along a cable.

        marker: The marker on which it acts.
        force: Force in space [N]. Default [0.0, 0.0, 0.0].
        local: Whether `force` is given in the axes of the rigid body and turns with it. Default False.
        follower: Follower force along the cable, towards its end [N], instead of `force`. It turns with the cable.
        time: Factor as a function of time. Default constant.
        """
        return self._add("forces", "point_force", {
            "marker": marker,
            "force": force,
            "local": local,
            "follower": follower,
            "time": time,
        })

    def point_moment(
        self,
        *,
        marker: Union[Sequence[Number], str],
        moment: Sequence[Union[Mapping[str, Any], Number]] | None = None,
        torque: Union[Mapping[str, Any], Number] | None = None,
        local: Boolean | None = None,
        time: Union[Literal['constant'], Mapping[str, Any]] | None = None,
    ) -> Part:
        """A moment on a rigid body or a cable, in space or in the axes of the body. A component along a cable twists it
        if it has torsion (`section.gj`), else it has no effect.

        marker: The marker on which it acts.
        moment: Moment [N m].
        torque: Moment along a cable with torsion, towards its end [N m], instead of `moment`. It turns with the
            cable.
        local: Whether `moment` is given in the axes of the rigid body and turns with it. Default False.
        time: Factor as a function of time. Default constant.
        """
        return self._add("forces", "point_moment", {
            "marker": marker,
            "moment": moment,
            "torque": torque,
            "local": local,
            "time": time,
        })

    def rotational_spring(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        axis: Sequence[Number],
        to: Union[Sequence[Number], str] | None = None,
        stiffness: Union[Mapping[str, Any], Number] | None = None,
        damping: Union[Mapping[str, Any], Number] | None = None,
        angle: Union[Mapping[str, Any], Number] | None = None,
    ) -> Part:
        """A torsion spring and damper about an axis, used with a `revolute` joint, or at the end of a cable with torsion
        (`section.gj`), which may lie on a swivel. Whole turns count.

        name: Name.
        marker: The marker, on a rigid body or a cable with torsion.
        axis: Direction of the axis in space at the start.
        to: The other marker, on a rigid body or a cable with torsion. Default: space.
        stiffness: Stiffness [N m/rad]. Default 0.0.
        damping: Damping [N m s/rad]. Default 0.0.
        angle: Angle without moment, from the initial position [rad]. Default 0.0.
        """
        return self._add("forces", "rotational_spring", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "to": to,
            "stiffness": stiffness,
            "damping": damping,
            "angle": angle,
        })

    def spring(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str],
        stiffness: Union[Mapping[str, Any], Number],
        damping: Union[Mapping[str, Any], Number] | None = None,
        length: Union[Mapping[str, Any], Number] | None = None,
        tension_only: Boolean | None = None,
    ) -> Part:
        """A spring and damper between two markers, along the line between them.

        name: Name.
        marker: One end.
        to: The other end: a marker or a point in space.
        stiffness: Stiffness [N/m].
        damping: Damping [N s/m]. Default 0.0.
        length: Length without force [m]. Default: the initial length.
        tension_only: Whether it can only pull. Default False.
        """
        return self._add("forces", "spring", {
            "name": name,
            "marker": marker,
            "to": to,
            "stiffness": stiffness,
            "damping": damping,
            "length": length,
            "tension_only": tension_only,
        })

    def vortex_shedding(
        self,
        *,
        strouhal: Number | None = None,
        lift: Number | None = None,
        coupling: Number | None = None,
        epsilon: Number | None = None,
        strumming: Number | None = None,
        on: Sequence[str] | None = None,
    ) -> Part:
        """Lift of the vortices that cables, chains and hulls shed in water, as a wake oscillator at each station:
        vortex-induced vibration across the flow, with lock-in.

        The model and its numbers are those of Facchinetti, de Langre and Biolley (2004), with lift by the flow past
        the mean way of the line. Damping of the vibration by the water is that of `drag` (the paper has `cn` = 2),
        its inertia that of `added_mass`. It takes no part in equilibria; wakes begin with a small disturbance that
        differs from station to station, the same in each run. A step is at most a sixteenth of a period of shedding.
        A record of type `force` for `LINE: vortex shedding` shows the largest variable of a wake, amplitude and
        frequency along the line.

        strouhal: Strouhal number: frequency of shedding times diameter over speed. Default 0.2.
        lift: Amplitude of the lift coefficient of a cylinder at rest. Default 0.3.
        coupling: How strongly acceleration drives the wake, `A` of the paper. Default 12.0.
        epsilon: How fast wakes come to their own amplitude, `ε` of the paper. Default 0.3.
        strumming: Drag coefficient across of the line at rest: strumming adds `2.1 A/D` times it, with the amplitude
            `A` (Blevins 1990). Default: drag doesn't grow.
        on: Parts it acts on. Default: all that have a diameter along them.
        """
        return self._add("forces", "vortex_shedding", {
            "strouhal": strouhal,
            "lift": lift,
            "coupling": coupling,
            "epsilon": epsilon,
            "strumming": strumming,
            "on": on,
        })

    def circle(
        self,
        *,
        name: str,
        speed: Number,
        radius: Number,
        heading: Sequence[Number] | None = None,
        towards: Literal['port', 'starboard'] | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
    ) -> Part:
        """At rest, then on a circle from the first moment; the speed rises smoothly.

        name: Name; constraints refer to it.
        speed: Speed after the ramp [m/s].
        radius: Radius of the circle [m].
        heading: Direction of travel at the start, horizontal. Default [1.0, 0.0, 0.0].
        towards: Side to which it turns. Default port.
        start: Start time [s]. Default 0.0.
        ramp: Time in which the speed rises [s]. Default 5.0.
        """
        return self._add("motions", "circle", {
            "name": name,
            "speed": speed,
            "radius": radius,
            "heading": heading,
            "towards": towards,
            "start": start,
            "ramp": ramp,
        })

    def function_motion(
        self,
        *,
        name: str,
        function: Union[Callable[..., Any], str],
        parameters: Mapping[str, Any] | None = None,
    ) -> Part:
        """A motion that a function of time gives, which the program that runs the scene has written, such as a script in
        Python.

        To try things out: each call takes microseconds. A function that only knows the displacement has it
        differentiated, which takes five calls and costs digits; it should be smooth.

        name: Name; constraints refer to it.
        function: Name of the function that was registered; in Python the function itself. `type = "name"` says the
            same, with its parameters beside it.
        parameters: What the function is given besides the time, by name. A text that is a number with a unit becomes
            a number in SI units.
        """
        return self._add("motions", "function", {
            "name": name,
            "function": function,
            "parameters": parameters,
        })

    def harmonic(
        self,
        *,
        name: str,
        amplitude: Sequence[Union[Mapping[str, Any], Number]],
        frequency: Union[Mapping[str, Any], Number],
        phase: Number | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
    ) -> Part:
        """Oscillates harmonically.

        name: Name; constraints refer to it.
        amplitude: Amplitude [m]. Inputs that it reads need `join = "smooth"`: where an amplitude jumps or bends, the
            velocity jumps.
        frequency: Frequency [Hz]. The phase goes on where an input changes it, which needs `join = "linear"` or
            `"smooth"`, and counts from t = 0.
        phase: Phase [rad]. Default 0.0.
        start: Start time [s]. Default 0.0.
        ramp: Time in which the amplitude rises [s]; with 0 it oscillates from the first moment on and starts with
            that velocity. Default 5.0.
        """
        return self._add("motions", "harmonic", {
            "name": name,
            "amplitude": amplitude,
            "frequency": frequency,
            "phase": phase,
            "start": start,
            "ramp": ramp,
        })

    def input(
        self,
        *,
        name: str,
        speed: str,
        direction: Sequence[Number] | None = None,
    ) -> Part:
        """Straight ahead with a speed that is set while the run goes on: by a controller, or by the program that runs
        it.

        The distance is the integral of the speed. Speeds can't jump, so the input needs `join = "linear"`. `sum` puts
        several directions together.

        name: Name; constraints refer to it.
        speed: The input that the speed is read from, in m/s; of angles in rad/s.
        direction: Direction of travel. Default [1.0, 0.0, 0.0].
        """
        return self._add("motions", "input", {
            "name": name,
            "speed": speed,
            "direction": direction,
        })

    def rest(
        self,
        *,
        name: str,
    ) -> Part:
        """At rest.

        name: Name; constraints refer to it.
        """
        return self._add("motions", "rest", {
            "name": name,
        })

    def speed_table(
        self,
        *,
        name: str,
        direction: Sequence[Number] | None = None,
        file: str | None = None,
        t: Sequence[Number] | None = None,
        v: Sequence[Number] | None = None,
        join: Literal['cubic', 'linear', 'monotone'] | None = None,
    ) -> Part:
        """Straight ahead with the speeds of a table, in the scene or in a CSV file: a measured launch, the speed of a
        winch.

        The speed is piecewise linear, so the distance is the area under the table: 1 m from 0 to 1 m/s in 2 s. The
        acceleration jumps at the rows, and steps end there; `join = "monotone"` smooths the speed.

        name: Name; constraints refer to it.
        direction: Direction of travel. Default [1.0, 0.0, 0.0].
        file: A CSV file, its path as seen from the scene file. Its first line names the columns, `t` and `v`, with
            their units in brackets (`t [s],v [kn]`) or without in s and m/s; other columns are left alone.
        t: Times [s], ascending, instead of a file; the run must not go beyond the last.
        v: Speeds at these times [m/s].
        join: Interpolation of the speeds. Default linear.
        """
        return self._add("motions", "speed_table", {
            "name": name,
            "direction": direction,
            "file": file,
            "t": t,
            "v": v,
            "join": join,
        })

    def spin(
        self,
        *,
        name: str,
        rate: Number,
        start: Number | None = None,
        ramp: Number | None = None,
        rise: Literal['cycloidal', 'quintic'] | None = None,
    ) -> Part:
        """An angle for the constraint `rotation`: at rest, then at a constant rate, which rises smoothly.

        name: Name; constraints refer to it.
        rate: Rate after the ramp [rad/s].
        start: Start time [s]. Default 0.0.
        ramp: Time in which the rate rises [s]; with 0 it turns from the first moment on and starts with that
            velocity. Default 1.0.
        rise: Shape of the rise. Default quintic.
        """
        return self._add("motions", "spin", {
            "name": name,
            "rate": rate,
            "start": start,
            "ramp": ramp,
            "rise": rise,
        })

    def straight(
        self,
        *,
        name: str,
        speed: Number,
        direction: Sequence[Number] | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
    ) -> Part:
        """At rest, then straight ahead; the speed rises smoothly.

        name: Name; constraints refer to it.
        speed: Speed after the ramp [m/s].
        direction: Direction of travel. Default [1.0, 0.0, 0.0].
        start: Start time [s]. Default 0.0.
        ramp: Time in which the speed rises [s]. Default 5.0.
        """
        return self._add("motions", "straight", {
            "name": name,
            "speed": speed,
            "direction": direction,
            "start": start,
            "ramp": ramp,
        })

    def sum(
        self,
        *,
        name: str,
        motions: Sequence[str],
    ) -> Part:
        """The sum of motions: displacements, velocities and accelerations add. The motions may be of any type, also
        sums.

        name: Name; constraints refer to it.
        motions: Names of the motions to add: `motions = ["surge", "heave"]`.
        """
        return self._add("motions", "sum", {
            "name": name,
            "motions": motions,
        })

    def swing(
        self,
        *,
        name: str,
        amplitude: Union[Mapping[str, Any], Number],
        frequency: Union[Mapping[str, Any], Number],
        phase: Number | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
    ) -> Part:
        """An oscillating angle for the constraint `rotation`; the amplitude rises smoothly.

        name: Name; constraints refer to it.
        amplitude: Amplitude [rad]. An input that it reads needs `join = "smooth"`: where an amplitude jumps or bends,
            the velocity jumps.
        frequency: Frequency [Hz]. The phase goes on where an input changes it, which needs `join = "linear"` or
            `"smooth"`, and counts from t = 0.
        phase: Phase [rad]. Default 0.0.
        start: Start time [s]. Default 0.0.
        ramp: Time in which the amplitude rises [s]; with 0 it oscillates from the first moment on and starts with
            that velocity. Default 5.0.
        """
        return self._add("motions", "swing", {
            "name": name,
            "amplitude": amplitude,
            "frequency": frequency,
            "phase": phase,
            "start": start,
            "ramp": ramp,
        })

    def table(
        self,
        *,
        name: str,
        file: str | None = None,
        t: Sequence[Number] | None = None,
        x: Sequence[Number] | None = None,
        y: Sequence[Number] | None = None,
        z: Sequence[Number] | None = None,
        angle: Sequence[Number] | None = None,
        join: Literal['cubic', 'linear', 'monotone'] | None = None,
        ends: Literal['at-rest', 'from-rest', 'natural'] | None = None,
    ) -> Part:
        """Follows a table of displacements, in the scene or in a CSV file, or a table of angles for the constraint
        `rotation`.

        Between rows it never overshoots. The acceleration jumps at the rows, unless `join = "cubic"`: choose that for
        smooth records with many rows, such as the heave of a ship. For a table of speeds use `speed_table`.

        name: Name; constraints refer to it.
        file: A CSV file, its path as seen from the scene file. Its first line names the columns, `t` and any of `x`,
            `y`, `z`, or `angle`, with their units in brackets (`t [s],z [cm]`, `t [s],angle [deg]`) or without in s,
            m and rad; other columns are left alone.
        t: Times [s], ascending, instead of a file; the run must not go beyond the last.
        x: Displacements along x at these times [m]. Default: none.
        y: Displacements along y [m].
        z: Displacements along z [m].
        angle: Angles at these times, instead of displacements, for the constraint `rotation` [rad]. Degrees are
            written with their unit: `"90 deg"`.
        join: Interpolation between the rows. `linear` is accepted only if all rows lie on one line, since the
            velocity would jump. Default monotone.
        ends: Condition at its ends. Default natural.
        """
        return self._add("motions", "table", {
            "name": name,
            "file": file,
            "t": t,
            "x": x,
            "y": y,
            "z": z,
            "angle": angle,
            "join": join,
            "ends": ends,
        })

    def turn(
        self,
        *,
        name: str,
        speed: Number,
        radius: Number,
        heading: Sequence[Number] | None = None,
        towards: Literal['port', 'starboard'] | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
        turn_start: Number | None = None,
        turn_ramp: Number | None = None,
    ) -> Part:
        """Straight ahead, then a turn: the speed and, later, the yaw rate rise smoothly.

        name: Name; constraints refer to it.
        speed: Speed after the ramp [m/s].
        radius: Radius of the final circle [m].
        heading: Direction of travel at the start, horizontal. Default [1.0, 0.0, 0.0].
        towards: Side to which it turns. Default port.
        start: Start time [s]. Default 0.0.
        ramp: Time in which the speed rises [s]. Default 5.0.
        turn_start: Time at which the turn starts [s]. Default: `start`.
        turn_ramp: Time in which the yaw rate rises from 0 to speed over radius [s]. Default 5.0.
        """
        return self._add("motions", "turn", {
            "name": name,
            "speed": speed,
            "radius": radius,
            "heading": heading,
            "towards": towards,
            "start": start,
            "ramp": ramp,
            "turn_start": turn_start,
            "turn_ramp": turn_ramp,
        })

    def acceleration(
        self,
        *,
        of: str,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Acceleration of a point: columns `hose.end.ax`, `.ay` and `.az` in m/s². Along a cable that a winch feeds, of
        the material there.

        It satisfies the equations of motion at the given positions and velocities, and is less noisy than the
        integrator's own.

        of: The point: a marker like `hose.end`, or an arc length like `hose@12.5m`.
        name: Name in results. Default: that of the point and `.acceleration`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "acceleration", {
            "of": of,
            "name": name,
            "title": title,
        })

    def along(
        self,
        *,
        of: str,
        what: Literal['angle', 'curvature', 'curvature_across', 'curvature_normal', 'moment', 'moment_across', 'moment_normal', 'spin', 'strain', 'tension', 'torque', 'twist'],
        at: Number,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Tension, strain, curvature or bending moment of a cable at one place: column `hose.end.tension`. Of a cable
        with torsion (`section.gj`) its twist, torque, angle and spin too, and curvature and moment about either
        director of its section. Of a chain of rigid links its tension: what its joints carry, and between two joints
        what lies between.

        of: The cable, or the chain.
        what: Recorded quantity: tension [N], strain, curvature [1/m] or moment [N m]; of a cable with torsion twist
            [rad/m], torque [N m], angle from the start [rad] or spin [rad/s], and `curvature_normal`,
            `curvature_across`, `moment_normal` and `moment_across`, about the first director of the section and about
            the second.
        at: Where: `start`, `end`, an unstretched arc length from the start as it is now [m], or a share of the length
            like `50 %`.
        name: Name in results. Default: cable, place and quantity.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "along", {
            "of": of,
            "what": what,
            "at": at,
            "name": name,
            "title": title,
        })

    def angular_velocity(
        self,
        *,
        of: str,
        to: str | None = None,
        frame: Literal['body', 'space', 'to'] | None = None,
        axes: Sequence[Literal['x', 'y', 'z']] | None = None,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Angular velocity of a rigid body, or of the section of a cable with torsion: columns `crank.wx`, `.wy` and
        `.wz` in rad/s.

        of: The body, or a marker on it, such as `hose.link3`.
        to: The other body. Default: space. The relative angular velocity of a joint's two bodies is the speed of the
            joint.
        frame: Axes of the components: of `space`, of the `body`, or of the other body, `to`. Default space.
        axes: Recorded components. Default: all three. Default ['x', 'y', 'z'].
        name: Name in results. Default: that of the body and `.angular_velocity`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "angular_velocity", {
            "of": of,
            "to": to,
            "frame": frame,
            "axes": axes,
            "name": name,
            "title": title,
        })

    def clearance(
        self,
        *,
        between: Sequence[str],
        name: str | None = None,
    ) -> Part:
        """The least distance between the surfaces of two cables or bodies with a hull: columns `a-b.clearance` in m,
        below zero where they are in each other, and `a-b.first`, `a-b.second`, how far along each that is in m. They
        need not be in contact.

        between: Both.
        name: Name in results. Default: both names, joined by a hyphen.
        """
        return self._add("records", "clearance", {
            "between": between,
            "name": name,
        })

    def direction_record(
        self,
        *,
        of: str,
        at: Sequence[Number] | None = None,
        axis: Sequence[Number] | None = None,
        body: str | None = None,
        degrees: Boolean | None = None,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Direction of a line at places of it, from its start towards its end: columns `riser.start.declination`, the
        angle from upright (0 up, 90 level, 180 down), and `riser.start.azimuth`, from x to y, in rad. With an `axis`
        also `riser.start.angle`, between the line and that axis, such as that of the fitting that holds its end.

        of: The cable, or the chain.
        at: Where: as for `along`. Default: at both ends. Default ['start', 'end'].
        axis: A direction to which the angle is told. Default: none is told.
        body: The body that the axis turns with, in whose axes it is given. Default: it stands still.
        degrees: Whether the angles are in degrees. Default False.
        name: Name in results. Default: that of the cable.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "direction", {
            "of": of,
            "at": at,
            "axis": axis,
            "body": body,
            "degrees": degrees,
            "name": name,
            "title": title,
        })

    def drag_coefficient(
        self,
        *,
        of: str,
        at: Sequence[Number] | None = None,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Drag coefficient `Cn` of the flow across a cable at some places: columns `hose.cn@25%`, `hose.cn@50%`,
        `hose.cn@75%`.

        It is that of the `drag` which acts on the cable, taken between its stations on either side of the place;
        empty where hardly any water flows across, at Reynolds numbers below 1.

        of: The cable.
        at: Where: as for `along`. Default: at a quarter, half and three quarters of the length. Default ['25 %', '50
            %', '75 %'].
        name: Name in results. Default: that of the cable and `.cn`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "drag_coefficient", {
            "of": of,
            "at": at,
            "name": name,
            "title": title,
        })

    def driving_check(
        self,
        *,
        of: str,
        axes: Sequence[Literal['x', 'y', 'z']] | None = None,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """A driving constraint compared with its motion: columns `ship.imposed_x` and `ship.actual_x` in m, the same of
        velocities, `ship.imposed_vx` and `ship.actual_vx` in m/s, and `ship.difference`, the distance between where
        the marker is and where it should be, in m.

        of: Name of the driving constraint.
        axes: Recorded axes of space. Default: all three. Default ['x', 'y', 'z'].
        name: Name in results. Default: that of the constraint and `.check`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "driving_check", {
            "of": of,
            "axes": axes,
            "name": name,
            "title": title,
        })

    def drum_record(
        self,
        *,
        of: str,
        name: str | None = None,
    ) -> Part:
        """A drum and the cable on it: columns `drum.angle` in rad and `.spin` in rad/s, positive where it pays out;
        `.payout`, the length fed out, and `.wound`, that on the drum, in m of unstretched cable; `.layer` and
        `.radius` where the cable arrives; `.fleet`, its angle against the plane of the drum there, in rad; `.torque`,
        the moment of the cable about the axis in N m, positive where it would pay out. `.wound` counts from 0 if the
        drum has no `wound`.

        of: Name of the drum.
        name: Name in results. Default: that of the drum.
        """
        return self._add("records", "drum", {
            "of": of,
            "name": name,
        })

    def energy(
        self,
        *,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Balance of energy: columns `energy.kinetic`, `.potential`, `.supplied`, `.dissipated` and `.imbalance` in J.

        Work is counted from the start of the run. The imbalance is the energy gained by the integration (positive) or
        lost by its numerical damping (negative).

        name: Name in results. Default: `energy`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "energy", {
            "name": name,
            "title": title,
        })

    def force(
        self,
        *,
        of: str,
        name: str | None = None,
    ) -> Part:
        """Output of a force. Of a contact: columns `drum.fx`, `.fy` and `.fz`, the force of the shape on all that
        touches it in N, `.normal`, the sum of what presses in N, `.depth`, the deepest point in m, and `.points`, how
        many touch. Of a spring: `mooring.tension` in N. Of a bushing: `mount.fx`, `.fy`, `.fz` and `.mx`, `.my`,
        `.mz`, the force in N and the moment in N m on its `marker`, in the axes of the stiffnesses. Of a rotational
        spring: `closer.angle` from the initial position in rad, whole turns included, and `.moment`, that on its
        `marker` in N m.

        of: Name of the force.
        name: Name in results. Default: that of the force.
        """
        return self._add("records", "force", {
            "of": of,
            "name": name,
        })

    def input_record(
        self,
        *,
        of: str,
        name: str | None = None,
    ) -> Part:
        """Value of an input: one column of its name. At the instant at which it jumps, the value before.

        of: Name of the input.
        name: Name in results. Default: that of the input.
        """
        return self._add("records", "input", {
            "of": of,
            "name": name,
        })

    def length(
        self,
        *,
        of: str,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Unstretched length of a cable, including the payout of winches: column `hose.length` in m.

        of: The cable.
        name: Name in results. Default: that of the cable and `.length`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "length", {
            "of": of,
            "name": name,
            "title": title,
        })

    def momentum(
        self,
        *,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Momentum of the whole scene: columns `momentum.px`, `.py`, `.pz` in kg m/s, `.lx`, `.ly`, `.lz`, the angular
        momentum about the origin, in kg m²/s, and `.x`, `.y`, `.z`, the centre of mass, in m.

        Added mass is included.

        name: Name in results. Default: `momentum`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "momentum", {
            "name": name,
            "title": title,
        })

    def orientation(
        self,
        *,
        of: str,
        degrees: Boolean | None = None,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Orientation of a rigid body, or of the section of a cable with torsion (its two directors and its tangent), as
        Bryant angles 1-2-3, turns about its x axis, its new y axis, its new z axis: columns `crank.phi1`, `.phi2` and
        `.phi3` in rad. The first and the third jump from π to -π.

        of: The body, or a marker on it.
        degrees: Whether the angles are in degrees. Default False.
        name: Name in results. Default: that of the body and `.orientation`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "orientation", {
            "of": of,
            "degrees": degrees,
            "name": name,
            "title": title,
        })

    def payout(
        self,
        *,
        of: str,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Payout at an end of a cable: columns `hose.start.payout`, the length paid out in m, `.payout_rate` in m/s,
        and, where the speed is prescribed, `.pull`, the force of the winch in N.

        of: The end of the cable: `hose.start` or `hose.end`.
        name: Name in results. Default: that of the end.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "payout", {
            "of": of,
            "name": name,
            "title": title,
        })

    def position(
        self,
        *,
        of: str,
        axes: Sequence[Literal['x', 'y', 'z']] | None = None,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Position of a point: columns `hose.end.x`, `.y` and `.z` in m, or some of them.

        of: The point: a marker like `hose.end`, or an arc length like `hose@12.5m`.
        axes: Recorded axes of space. Default: all three. Default ['x', 'y', 'z'].
        name: Name in results. Default: that of the point.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "position", {
            "of": of,
            "axes": axes,
            "name": name,
            "title": title,
        })

    def reaction(
        self,
        *,
        of: str,
        what: Literal['all', 'force', 'magnitude', 'moment'] | None = None,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Force of a constraint on what it holds, its `marker`: columns `anchor.fx`, `.fy`, `.fz` and `.magnitude` in N.
        Where it holds the direction of a rigid body or of a cable with torsion too, its moment about the marker as
        well: `.mx`, `.my`, `.mz` in N m.

        A rope that hangs from its anchor is pulled upwards, so `fz` is its weight.

        of: Name of the constraint.
        what: What is recorded: `all`, `force`, `magnitude` or `moment`. Default all.
        name: Name in results. Default: that of the constraint and `.reaction`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "reaction", {
            "of": of,
            "what": what,
            "name": name,
            "title": title,
        })

    def released(
        self,
        *,
        of: str,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Number of released points of a `latch`, or whether a constraint with a `break` is broken: column
        `reel.released`.

        of: Name of the latch or break.
        name: Name in results. Default: that of the latch and `.released`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "released", {
            "of": of,
            "name": name,
            "title": title,
        })

    def sheave_record(
        self,
        *,
        of: str,
        name: str | None = None,
    ) -> Part:
        """The cable on a sheave: columns `wheel.wrap` in rad, `.length`, the unstretched length that lies on it in m,
        `.in.tension` and `.out.tension` where the cable comes and goes in N, `.speed` along the groove and `.slip`
        against it in m/s, and `.axle_force` in N. Of a cable with torsion also `.twist` per length in rad/m and
        `.torque` in N m, and where the flank rolls it (`fleet_twist`) `.in.roll` and `.out.roll`, the torques on it
        where it comes and goes in N m. Of a wheel with an angle of its own also `.angle` in rad and `.spin` in rad/s.
        Where several cables run over the wheel, `.1.wrap`, `.2.wrap` and so on.

        of: Name of the sheave; of several on one axle `NAME.1`.
        name: Name in results. Default: that of the sheave.
        """
        return self._add("records", "sheave", {
            "of": of,
            "name": name,
        })

    def stress(
        self,
        *,
        of: str,
        diameter: Number,
        inner_diameter: Number | None = None,
        points: Integer | None = None,
        reference: Sequence[Number] | None = None,
        at: Sequence[Number] | None = None,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Axial stress at points round the section of a pipe or cable, `σ = T_w/A + M c/I`: columns
        `riser.stress@50%.0deg`, `.45deg`, … in Pa, for fatigue too.

        The wall's tension is that of `wall_tension` where something presses on it, else the tension. Angles count
        from a direction that is carried along the line from its start without twist (parallel transport), towards the
        right hand about the tangent: of a cable without torsion the section knows no other; of a cable with torsion
        (`section.gj`) they count from the first director of its section.

        of: The cable.
        diameter: Outer diameter of what carries [m].
        inner_diameter: Its inner diameter [m]. Default: it is solid. Default 0.0.
        points: Number of points round the section. Default 8.
        reference: Direction in space from which angles count at the start of the line, without its part along the
            tangent. Default: z, or x where the line starts upright.
        at: Where: as for `along`. Default: in the middle. Default ['50 %'].
        name: Name in results. Default: that of the cable and `.stress`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "stress", {
            "of": of,
            "diameter": diameter,
            "inner_diameter": inner_diameter,
            "points": points,
            "reference": reference,
            "at": at,
            "name": name,
            "title": title,
        })

    def touchdown(
        self,
        *,
        of: str,
        on: str,
        name: str | None = None,
    ) -> Part:
        """Where a cable lies on a bed or another shape: columns `line.touchdown.s`, the unstretched arc length from its
        start at which it leaves the ground towards its higher end, in m, with `.x`, `.y` and `.z`, its axis there;
        `.grounded`, the length that lies, in m; `.uplift`, the angle in rad by which its lower end points up from the
        horizontal; and `.clearance`, its least distance from the ground in m, negative where it is pressed in. A
        cable that doesn't lie anywhere has no place: those columns are NaN.

        of: The cable.
        on: The bed or the contact.
        name: Name in results. Default: that of the cable.
        """
        return self._add("records", "touchdown", {
            "of": of,
            "on": on,
            "name": name,
        })

    def velocity(
        self,
        *,
        of: str,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Velocity of a point: columns `hose.end.vx`, `.vy` and `.vz` in m/s. Along a cable that a winch feeds, of the
        material there.

        of: The point: a marker like `hose.end`, or an arc length like `hose@12.5m`.
        name: Name in results. Default: that of the point and `.velocity`.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "velocity", {
            "of": of,
            "name": name,
            "title": title,
        })

    def wall_tension(
        self,
        *,
        of: str,
        at: Sequence[Number] | None = None,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """What the wall of a cable carries: columns `hose.wall_tension@50%` in N, and `hose.pressure@50%` in Pa if there
        is an `internal_flow`.

        The tension of a cable is the effective one; that of the wall is larger by inner pressure times the bore's
        area, less outer pressure times the outer one. Pressures are those above the air's. Inner ones come from the
        outlet, with the fluid's weight, acceleration and friction; water with a `level` presses from outside by its
        depth at rest, where `buoyancy` acts on the cable.

        of: The cable.
        at: Where: as for `along`. Default: at both ends and in the middle. Default ['0 %', '50 %', '100 %'].
        name: Name in results. Default: that of the cable.
        title: Title of its plots. Default: the quantity.
        """
        return self._add("records", "wall_tension", {
            "of": of,
            "at": at,
            "name": name,
            "title": title,
        })

    def expression(
        self,
        *,
        input: str,
        value: Union[Number, str],
        every: Number,
        name: str | None = None,
    ) -> Part:
        """Sets an input to a formula of records and of the time `t`, such as `-2 kN s/m * vessel.velocity.x`, at regular
        instants.

        A name is a column of a record; one with other signs than letters, digits, dots and underscores stands in
        braces, as in `{rope@50%.tension}`. Units are checked. The value is brought within the limits of the input.

        input: The input that it sets.
        value: The formula: `+ - * / ^`, `sqrt`, `abs`, `sign`, `min`, `max`, `clamp`, `exp`, `ln`, `tanh`, `sin`,
            `cos`, `tan`, `asin`, `acos`, `atan`, `atan2`, `floor`, `round`, `pi`, and numbers with units.
        every: Time from one instant to the next [s].
        name: Name in messages. Default: that of the input.
        """
        return self._add("controllers", "expression", {
            "input": input,
            "value": value,
            "every": every,
            "name": name,
        })

    def pid(
        self,
        *,
        input: str,
        measures: Union[Number, str],
        setpoint: Union[Number, str],
        every: Number,
        kp: Union[Number, str] | None = None,
        ki: Union[Number, str] | None = None,
        kd: Union[Number, str] | None = None,
        filter: Number | None = None,
        bias: Union[Number, str] | None = None,
        min: Union[Number, str] | None = None,
        max: Union[Number, str] | None = None,
        name: str | None = None,
    ) -> Part:
        """A PID controller: sets an input by what a record lacks of a setpoint, at regular instants.

        With the error `e = setpoint - measures` it is `u = bias + kp e + I + D`. The integral `I` grows by `ki e
        every`, but not further into a limit that `u` is at (anti-windup). `D` is `-kd` times the rate of what is
        measured, through a filter of first order (Åström and Hägglund, Advanced PID Control, 2006, ch. 13: backward
        differences). The first instant has no rate.

        input: The input that it sets.
        measures: What it measures: a column of a record such as `rope.start.tension`, or a formula of columns and of
            the time `t`; one with other signs than letters, digits, dots and underscores stands in braces.
        setpoint: What that is to be: a number, or a formula of columns and of the time `t`.
        every: Time from one instant to the next [s].
        kp: Proportional gain, in units of the input over those of what is measured: `"2 m/s / 1 kN"`. Default 0.0.
        ki: Integral gain, the same over seconds. Default 0.0.
        kd: Derivative gain, the same times seconds. Default 0.0.
        filter: Time constant of the filter of the rate [s]. Default 0.0.
        bias: What is added: a number, or a formula. Default 0.0.
        min: Least value that it sets. Default: the limit of the input.
        max: Largest value that it sets. Default: the limit of the input.
        name: Name in messages. Default: that of the input.
        """
        return self._add("controllers", "pid", {
            "input": input,
            "measures": measures,
            "setpoint": setpoint,
            "every": every,
            "kp": kp,
            "ki": ki,
            "kd": kd,
            "filter": filter,
            "bias": bias,
            "min": min,
            "max": max,
            "name": name,
        })

    def table_controller(
        self,
        *,
        input: str,
        over: Union[Number, str],
        at: Sequence[Union[Number, str]],
        value: Sequence[Union[Number, str]],
        every: Number,
        name: str | None = None,
    ) -> Part:
        """Sets an input by a table over a record, over time or over a formula of them, at regular instants: straight
        lines between its rows, constant before the first and after the last.

        input: The input that it sets.
        over: What the table is over: a column of a record, `t`, or a formula of them.
        at: Values of `over`, ascending: numbers in SI units, or texts with units.
        value: Values of the input there.
        every: Time from one instant to the next [s].
        name: Name in messages. Default: that of the input.
        """
        return self._add("controllers", "table", {
            "input": input,
            "over": over,
            "at": at,
            "value": value,
            "every": every,
            "name": name,
        })

    def unwound_cable(
        self,
        *,
        name: str,
        mass: Number,
        package: Mapping[str, Any],
        motion: str,
        rule: Mapping[str, Any],
        ei: Number | None = None,
        eyelet: Sequence[Number] | None = None,
        guided: Boolean | None = None,
        tangent: Boolean | None = None,
        points: Sequence[Sequence[Number]] | None = None,
        drag: Mapping[str, Any] | None = None,
        added_mass: Number | None = None,
        weight: Boolean | None = None,
        elements: Integer | None = None,
        h: Number | None = None,
        numerical_damping: Number | None = None,
        titles: Mapping[str, Any] | None = None,
    ) -> Part:
        """A cable that is drawn from a package through an eyelet, by finite differences: inextensible, with Newmark's
        method, and with the tension as a Lagrange multiplier. It shares no equation with the elements of type
        `cable`.

        name: Name; the columns of the history begin with it.
        mass: Mass per length [kg/m].
        package: The package, with the diameter of the cable and its minimum bend radius.
            radius: Radius of the first layer to unwind, to the middle of the cable [m]. Required.
            length: Wound length along the axis, the same for all layers [m]. Required.
            diameter: Diameter of the cable [m]; the radius changes by it from layer to layer. Required.
            origin: Origin of its axis: the centre of one end [m]. Default [0.0, 0.0, 0.0].
            axis: Direction of its axis, from the origin to the other end. Default [0.0, 0.0, 1.0].
            reference: Direction from the axis to the first lift-off point. Default: x, or y if the axis is along x.
            side: Side of the package from which the cable lifts off. Default inner.
            pitch: Distance along the axis per turn [m]. Default: the diameter of the cable, turns side by side.
            layers: Number of layers. Default 1.
            hand: Sense in which the lift-off point runs round the axis. Default right.
            traverse: Direction along the axis in which the first layer unwinds. Default forward.
            first: Position of the first lift-off point along the axis, from its origin [m]. Default: the end where a
                full first layer begins.
            min_bend_radius: Minimum bend radius of the cable [m]; below it the run reports an event. Default: no
                limit.
        motion: Name of the motion that draws the cable: its x component is the length drawn through the eyelet.
        rule: Condition that determines the lift-off point.
        ei: Bending stiffness [N m²]. Default: 0. Default 0.0.
        eyelet: Position of the eyelet [m]. Default [0.0, 0.0, 0.0].
        guided: Whether the eyelet holds the direction along the axis of the package. Has an effect only with bending
            stiffness. Default False.
        tangent: Whether the cable is tangent to the wound layer at the lift-off point. Needs bending stiffness.
            Default False.
        points: Initial shape, at rest: points from the eyelet to the lift-off point [m]. Default: the steady balloon
            of the initial speed and tension; without speed and weight, a straight line.
        drag: Drag of the water. Default: none.
            normal: Law across the cable. Default constant.
            tangential: Law along the cable. Default constant.
            cn: Coefficient across, for the constant law, on the diameter. Default 1.2.
            ct: Coefficient along, for the constant law, on the circumference. Default 0.01.
            end: Form drag of each free end of cables, hulls and chains: coefficient on the area of the end face. Both
                ends of a long blunt cylinder have about 0.8 together. Default 0.0.
            stretched: Whether drag acts per stretched length instead of unstretched length. Default False.
            blend: Relative width in Reynolds number over which the branches of Choo and Casarella are blended.
                Default: they jump, as published.
            on: Cables it acts on. Default: all.
        added_mass: Added-mass coefficient across the axis. Default 0.0.
        weight: Whether weight and buoyancy act. Default False.
        elements: Number of segments of the free cable. Default 40.
        h: Time step [s], or `auto`. Default: `auto`, which is 0.2 ms, or with bending stiffness and a given tension
            two segments over the wave speed. A longer step ends the run with an error, since the lift-off point would
            oscillate.
        numerical_damping: Numerical damping of Newmark's method. Default: 0.05 with bending stiffness, 0 without.
        titles: Titles of its pictures, by what they show: `tension`, `length`, `speed`, `lift`, `radius`, `centre`,
            `acceleration`, `drag`, `curvature`. Default: the quantity.
        """
        return self._add("processes", "unwound_cable", {
            "name": name,
            "mass": mass,
            "package": package,
            "motion": motion,
            "rule": rule,
            "ei": ei,
            "eyelet": eyelet,
            "guided": guided,
            "tangent": tangent,
            "points": points,
            "drag": drag,
            "added_mass": added_mass,
            "weight": weight,
            "elements": elements,
            "h": h,
            "numerical_damping": numerical_damping,
            "titles": titles,
        })

    def set_water(
        self,
        *,
        density: Number | None = None,
        viscosity: Number | None = None,
        level: Number | None = None,
        current: Sequence[Union[Mapping[str, Any], Number]] | None = None,
        profile: Sequence[Mapping[str, Any]] | None = None,
        profile_factor: Union[Mapping[str, Any], Number] | None = None,
        waves: Mapping[str, Any] | None = None,
    ) -> None:
        """The water around a scene. Drag, buoyancy and added mass need it.

        density: Density [kg/m³]. Default 1025.0.
        viscosity: Dynamic viscosity [Pa s]. Default 0.00108.
        level: Height of its surface, which is flat [m]. Default: water everywhere.
        current: Uniform velocity of the water [m/s]; inputs that it reads need `join = "hold"`. Default [0.0, 0.0,
            0.0].
        profile: Current profile over height, instead of `current`: piecewise linear, constant beyond the ends.
        profile_factor: Factor of the profile; an input that it reads needs `join = "hold"`. Default 1.0.
        waves: Waves on the water, whose `level` is then the surface when it is still. Default: still water.
            regular: One regular wave.
            jonswap: A wind sea with a sharp peak.
            pierson_moskowitz: A fully developed wind sea: JONSWAP with `gamma = 1`.
            white: The same energy at all frequencies of a band, for tests of response.
            components: Regular waves, one by one.
            measured: A sea as it was measured: the waves of a record of its elevation.
            direction: Direction that the waves travel towards, the mean if they spread: from x to y [rad]. Default
                0.0.
            spreading: How directions spread about the mean. Default: all waves have the same direction.
            count: Number of regular waves that make a spectrum, 10000 at most. Default 200.
            sampling: How their frequencies are chosen. Default equal-energy.
            seed: Seed of their random phases: the same seed gives the same sea on every machine. Default 1.
            depth: Depth of the water [m]. Default: deep water.
            ramp: Time from t = 0 in which the waves rise from still water, as `(1 - cos πt/ramp)/2` [s]. Default 0.0.
            stretching: What linear theory, which ends at still water, says between there and the surface. Default
                wheeler.
            doppler: Whether the current carries the waves: their periods are those seen from a fixed place, and their
                lengths change. Default: waves as in water at rest, and current, are added. Default False.
            evaluation: `exact`, the sum over all waves, or `lattice`, a table of it. Default: `lattice` for more than
                8 waves of one direction.
            lattice_error: Largest error of velocities from the lattice, in parts of their standard deviation at still
                water; checked when the scene is built. Default 0.001.
        """
        self._set("water", {
            "density": density,
            "viscosity": viscosity,
            "level": level,
            "current": current,
            "profile": profile,
            "profile_factor": profile_factor,
            "waves": waves,
        })

    def set_air(
        self,
        *,
        density: Number | None = None,
        viscosity: Number | None = None,
        wind: Sequence[Union[Mapping[str, Any], Number]] | None = None,
        profile: Sequence[Mapping[str, Any]] | None = None,
        profile_factor: Union[Mapping[str, Any], Number] | None = None,
    ) -> None:
        """The air above the water, or around a scene without water: only drag looks at it. Default: vacuum.

        density: Density [kg/m³]. Default 1.225.
        viscosity: Dynamic viscosity [Pa s]. Default 1.79e-05.
        wind: Velocity of the air, the same everywhere [m/s]; inputs that it reads need `join = "hold"`. Default [0.0,
            0.0, 0.0].
        profile: Velocity of the air by height, instead of `wind`: piecewise linear between the levels, constant
            beyond.
        profile_factor: Factor of the profile; an input that it reads needs `join = "hold"`. Default 1.0.
        """
        self._set("air", {
            "density": density,
            "viscosity": viscosity,
            "wind": wind,
            "profile": profile,
            "profile_factor": profile_factor,
        })

    def set_run(
        self,
        *,
        analysis: Literal['dynamics', 'statics'] | None = None,
        duration: Number | None = None,
        output: Number | None = None,
        frame: Mapping[str, Any] | None = None,
        from_equilibrium: Boolean | None = None,
        audit: Boolean | None = None,
        snapshots: Integer | None = None,
        field_snapshots: Integer | None = None,
        shape_titles: Mapping[str, Any] | None = None,
        tables: Sequence[Mapping[str, Any]] | None = None,
        ranges: Sequence[Mapping[str, Any]] | None = None,
        statistics: Sequence[Mapping[str, Any]] | None = None,
    ) -> None:
        """Analysis, duration and output.

        analysis: Type of analysis. Default dynamics.
        duration: Duration of the run [s]; in statics the final load factor. Default 1.0.
        output: Output interval of the history [s]; 0 means a thousandth of the duration. Default 0.0.
        frame: In statics: the moving frame in which the equilibrium is found, such as that of a ship towing steadily.
            Fixed points move with the frame.
            velocity: Velocity of the centre [m/s]. Default [0.0, 0.0, 0.0].
            omega: Angular velocity [rad/s]. Default [0.0, 0.0, 0.0].
            centre: A point on the axis of rotation [m]: in space, or of a motion's frame relative to where the motion
                starts. Default [0.0, 0.0, 0.0].
        from_equilibrium: Start a dynamic run from the equilibrium at t = 0 instead of the configuration as laid.
            Default False.
        audit: Whether energy and work are balanced at every step. Default True.
        snapshots: Number of snapshots in the plots of shapes. Default 9.
        field_snapshots: Number of snapshots in the field record of a single run: `field.npy`, and the motion in
            `report.html`. Rows of the history that come next are taken, so that there are at most as many. Default
            361.
        shape_titles: Titles of the plots of shapes. Default: the title of the scene.
            side: From the side: x and z.
            top: From above: x and y.
            end: From the end: y and z.
            space: In space, seen obliquely from above; drawn only if it has a title.
            radial: z over the distance from the z axis; drawn only if it has a title.
        tables: Tables of a few columns of the history, each a CSV file of its own.
        ranges: Range graphs of lines: between what tension, curvature and the like were along them.
        statistics: Statistics of records over a time, and the fatigue of their cycles.
        """
        self._set("run", {
            "analysis": analysis,
            "duration": duration,
            "output": output,
            "frame": frame,
            "from_equilibrium": from_equilibrium,
            "audit": audit,
            "snapshots": snapshots,
            "field_snapshots": field_snapshots,
            "shape_titles": shape_titles,
            "tables": tables,
            "ranges": ranges,
            "statistics": statistics,
        })

    def set_solver(
        self,
        *,
        scheme: Union[Literal['average-acceleration', 'central-difference', 'fox-goodwin', 'linear-acceleration', 'purely-explicit', 'radau-iia-5'], Mapping[str, Any]] | None = None,
        stepping: Mapping[str, Any] | None = None,
        newton: Literal['full', 'modified'] | None = None,
        constraints: Literal['ggl', 'positions'] | None = None,
        force_tolerance: Number | None = None,
        allow_unstable: Boolean | None = None,
        h_max: Number | None = None,
        h_min: Number | None = None,
        h_start: Number | None = None,
        horizon: Number | None = None,
        project: Boolean | None = None,
        filter_start: Boolean | None = None,
        max_iterations: Integer | None = None,
        newton_tolerance: Number | None = None,
        stopping: Union[Literal['relative'], Mapping[str, Any]] | None = None,
        scales: Union[Literal['axial', 'bending'], Mapping[str, Any]] | None = None,
    ) -> None:
        """Options of time integration. The defaults suit cables from 8 to 8192 elements.

        scheme: Time integration scheme. Default {'generalized-alpha': {'rho_inf': 0.8}}.
        stepping: Constant steps or error control. Default {'controlled': {'tolerance': 0.0001}}.
        newton: When Newton's method computes a new iteration matrix. Default modified.
        constraints: Form of the constraint equations. Radau IIA always satisfies positions and velocities. Default
            positions.
        force_tolerance: Error of tensions and reactions, relative to the largest in the same part; of what goes to
            and fro with a period of a motion, a load or waves also relative to its swing. Default 0.01.
        allow_unstable: Accept a scheme that is unstable for constrained systems, with a warning. Default False.
        h_max: Largest step [s]. Default: a twentieth of the run.
        h_min: Smallest step [s]; a run that needs a smaller one ends with an error. Default: 1e-12 of the run.
        h_start: First step of error control [s]. Default: from the motion at the start.
        horizon: Time over which step errors accumulate [s]. 0 means the whole run, without the time in which errors
            are negligible, or three times as long as the motion was measured to remember an error, if that is
            shorter. Default 0.0.
        project: Project an inconsistent start onto the constraints, however far away it is. Default False.
        filter_start: Filter the initial accelerations by the stiffness, which fine meshes need, and start the
            scheme's own acceleration variable ahead of them, which its order needs. `false` is for textbook
            comparisons of the bare scheme. Default True.
        max_iterations: Most Newton iterations of a step before it is repeated with a smaller size. Radau IIA takes at
            most 10. Default 20.
        newton_tolerance: Newton tolerance as a multiple of the default: smaller is stricter. Default 1.0.
        stopping: Stopping test of Newton's method. Default relative.
        scales: Scales that make the equations dimensionless before they are solved. With the `relative` stopping test
            they change nothing but rounding.
        """
        self._set("solver", {
            "scheme": scheme,
            "stepping": stepping,
            "newton": newton,
            "constraints": constraints,
            "force_tolerance": force_tolerance,
            "allow_unstable": allow_unstable,
            "h_max": h_max,
            "h_min": h_min,
            "h_start": h_start,
            "horizon": horizon,
            "project": project,
            "filter_start": filter_start,
            "max_iterations": max_iterations,
            "newton_tolerance": newton_tolerance,
            "stopping": stopping,
            "scales": scales,
        })

    def set_statics(
        self,
        *,
        steps: Integer | None = None,
        max_iterations: Integer | None = None,
        stable: Boolean | None = None,
        tolerance: Number | None = None,
    ) -> None:
        """Options of the search for equilibria.

        steps: Number of load steps from t = 0 to the end of the run. Default 10.
        max_iterations: Most Newton iterations per equilibrium. Default 60.
        stable: Reject unstable or folded equilibria and search for a stable one. Default True.
        tolerance: Tolerance of positions, relative to the length of the longest cable (without cables: the size of
            the scene). Default 1e-09.
        """
        self._set("statics", {
            "steps": steps,
            "max_iterations": max_iterations,
            "stable": stable,
            "tolerance": tolerance,
        })

    def add_input(
        self,
        *,
        name: str,
        unit: str | None = None,
        default: Union[Number, str] | None = None,
        min: Union[Number, str] | None = None,
        max: Union[Number, str] | None = None,
        join: Literal['hold', 'linear', 'smooth'] | None = None,
    ) -> Part:
        """A channel that is set while a run goes on: by a controller of the scene, or from Rust, Python or another
        program between steps. A field reads it by `{ input = "name" }` instead of a number.

        name: Name, by which fields, controllers and programs refer to it.
        unit: SI unit of its values, such as `m/s`. Default: plain numbers.
        default: Value until it is set: a number in its unit, or a text with a unit. Default 0.0.
        min: Least value. Default: no limit.
        max: Largest value. Default: no limit.
        join: How values are joined: `hold` jumps when it is set, `linear` reaches the value at the end of the next
            advance, or of a controller's interval, and `smooth` does that without a kink. Speeds that are prescribed
            can't jump and need `linear`; amplitudes of motions need `smooth`. Default hold.
        """
        return self._append("inputs", {
            "name": name,
            "unit": unit,
            "default": default,
            "min": min,
            "max": max,
            "join": join,
        })

    def add_section(
        self,
        *,
        name: str | None = None,
        file: str | None = None,
        mass: Number | None = None,
        ea: Number | None = None,
        axial_force: Mapping[str, Any] | None = None,
        tension_only: Boolean | None = None,
        ei: Union[Number, Sequence[Number]] | None = None,
        bending_moment: Mapping[str, Any] | None = None,
        gj: Number | None = None,
        torque_tension: Number | None = None,
        rotary_inertia: Number | None = None,
        flooded: Number | None = None,
        diameter: Number | None = None,
        displaced: Number | None = None,
        axial_retardation_time: Number | None = None,
        bending_retardation_time: Number | None = None,
        torsional_retardation_time: Number | None = None,
        gyroscopic: Boolean | None = None,
    ) -> Part:
        """A library of sections with names, for cables of this scene. What a cable is made of is then a name: `section =
        "chain"`. Sections of a file are read together with those of the scene.

        name: Name, by which cables ask for it: `section = "chain"`.
        file: Instead of all else: a `.toml` or `.json` file with more `[[sections]]`, relative to the scene.
        mass: Structural mass per unstretched length [kg/m]; gravity acts on it.
        ea: Axial stiffness EA [N]; or give `axial_force`.
        axial_force: Axial force over strain, instead of `ea`: `{ strain = [0, 0.01, 0.03], force = ["0 kN", "10 kN",
            "60 kN"] }`. Between the points the force follows a smooth curve that never falls, beyond them a straight
            line. Needs L4.
            strain: Engineering strains, ascending, 0 among them [1]. Required.
            force: The force at each of them [N], 0 at strain 0; it mustn't fall. Required.
        tension_only: Whether it only pulls: chains and ropes don't resist being pressed together. Needs L4.
        ei: Bending stiffness EI [N m²]. With 0, the first and last element keep 1 % of their weight times their
            length squared, so that free ends have a direction. Two numbers where it isn't the same in all directions,
            of a cable with torsion: about the `normal` of the section, and about the axis across it. Default 0.0.
        bending_moment: Bending moment over curvature, instead of `ei`: `{ curvature = [0, 0.01, 0.1], moment = ["0 N
            m", "50 N m", "80 N m"] }`, the same in all directions and without loss of energy. Needs T3.
            curvature: Curvatures from 0 on, ascending [1/m]. Required.
            moment: The moment at each of them [N m], from 0 on; it mustn't fall. Required.
        gj: Torsional stiffness GJ [N m²]. With it the cable can be twisted, and its ends are held against twisting
            where they are built in. Default: no torsion; but EI where the stress-free shape is curved.
        torque_tension: Coupling `C` of torque and tension in laid ropes and armoured cables [N m]: `N = EA ε + C φ'`
            and `M = C ε + GJ φ'`, with `ea` measured while the ends can't turn. Positive of a right-hand lay: such a
            rope unlays when it is pulled. A torque factor `c`, by which the torque of a held end is `c d T`, means `C
            = c d EA`. Needs L4.
        rotary_inertia: Polar moment of inertia of the section, per length [kg m], of a cable with torsion. Default:
            that of a solid round bar, `mass diameter²/8`.
        flooded: Mass of the water inside [kg/m]. It moves with the part and has no weight in water. Default 0.0.
        diameter: Hydrodynamic diameter, for drag and added mass; what rolls in a groove, by `fleet_twist` of a
            `sheave`, rolls by it too [m]. Default 0.0.
        displaced: Displaced volume per length, for buoyancy [m²]. Default: `π/4 diameter²`.
        axial_retardation_time: Retardation time of stretching (Kelvin–Voigt) [s]: the axial force is `EA (ε + τ ε̇)`.
            With a table EA is its largest slope here. Default 0.0.
        bending_retardation_time: Retardation time of bending (Kelvin–Voigt) [s]: the moment is `EI (κ + τ κ̇)`, with
            the largest slope of a table. The rate is that in axes of the section where the cable has torsion, `gj`,
            and no end feeds, so that a bent shaft that spins is damped; else that seen along the tangent. Default
            0.0.
        torsional_retardation_time: Retardation time of twisting (Kelvin–Voigt) [s]: the torque is `GJ (φ' + τ
            dφ'/dt)`.
        gyroscopic: Whether the spin of a cable with torsion about its own axis turns it aside, as that of a top does:
            of shafts that turn fast. Ropes don't notice.
        """
        return self._append("sections", {
            "name": name,
            "file": file,
            "mass": mass,
            "ea": ea,
            "axial_force": axial_force,
            "tension_only": tension_only,
            "ei": ei,
            "bending_moment": bending_moment,
            "gj": gj,
            "torque_tension": torque_tension,
            "rotary_inertia": rotary_inertia,
            "flooded": flooded,
            "diameter": diameter,
            "displaced": displaced,
            "axial_retardation_time": axial_retardation_time,
            "bending_retardation_time": bending_retardation_time,
            "torsional_retardation_time": torsional_retardation_time,
            "gyroscopic": gyroscopic,
        })
