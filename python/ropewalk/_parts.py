"""Methods that add parts to a scene, one for each type. Made by generate.py from the schemas: don't edit."""

# ruff: noqa: A002, E501
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Union

from ._part import Part

Number = Union[float, str]
"""A number in SI units, a text that brings its unit ("2 kn"), or a parameter ("$speed")."""
Integer = Union[int, str]
"""A whole number, or a parameter."""
Boolean = Union[bool, str]
"""True or False, or a parameter."""


class Parts:
    """A method for each type of part, and `set_...` for each section."""

    def _add(self, list: str, type: str, fields: Mapping[str, Any]) -> Part:
        raise NotImplementedError

    def _set(self, section: str, fields: Mapping[str, Any]) -> None:
        raise NotImplementedError

    def cable(
        self,
        *,
        name: str,
        section: Mapping[str, Any],
        points: Sequence[Sequence[Number]] | None = None,
        radius: Number | None = None,
        curve: Sequence[Sequence[Number]] | None = None,
        start_direction: Sequence[Number] | None = None,
        end_direction: Sequence[Number] | None = None,
        length: Number | None = None,
        tension: Number | None = None,
        elements: Integer | None = None,
        mesh: Union[Mapping[str, Any], Sequence[Number]] | None = None,
        longitudinal: Literal['L1', 'L1n', 'L2', 'L3', 'L4'] | None = None,
        transverse: Literal['T1', 'T2', 'T3'] | None = None,
        integration: Literal['full', 'locking-free'] | None = None,
        velocity: Sequence[Number] | None = None,
        stress_free: Literal['as-laid', 'straight'] | None = None,
        strain: Number | None = None,
        curvature: Number | None = None,
    ) -> Part:
        """A cable, hose or tether: stretches and bends however far it likes. It doesn't twist, unless it is laid bent
        and free of stress.

        It is a chain of ANCF elements with 6 coordinates per node. Markers: `name.start`, `name.end`, `name@12.5m`.

        name: Name by which the rest of the scene refers to it.
        section: What it is made of.
            mass: Mass of the structure per unstretched length [kg/m]; what gravity pulls at. Required.
            ea: Axial stiffness EA [N]. Required.
            ei: Bending stiffness EI [N m²]. Of a limp cable (0) the first and last element have a little, a hundredth
                of their weight times the square of their length, so that free ends have a direction. Default 0.0.
            gj: Torsional stiffness GJ [N m²] of a cable that is bent when free of stress; left out, EI. Others don't
                know twist.
            flooded: Mass of water inside that moves along but has no weight in water [kg/m]. Default 0.0.
            diameter: Hydrodynamic diameter, for drag and added mass [m]. Default 0.0.
            displaced: Displaced volume per length, for buoyancy [m²]; left out, that of the full diameter.
            axial_damping: Kelvin–Voigt damping of stretching: stress grows by this time times the rate of strain [s].
                Default 0.0.
            bending_damping: Kelvin–Voigt damping of bending [s]. Default 0.0.
        points: Points along which it is laid, from start to end [m]: straight lines between them. Where they meet at
            an angle, give a `radius`: a cable that is laid round a sharp corner would be strained there.
        radius: Bend radius at the corners of `points` [m]. The arcs cut the corners, and get elements of their own.
        curve: Points of a smooth curve along which it is laid [m], instead of `points`: a cubic spline through them.
        start_direction: Direction of `curve` at its start; left out, it is as curved there as its first points say.
        end_direction: Direction of `curve` at its end, towards which it goes on; left out, it is as curved there as
            its last points say.
        length: Unstretched length [m]; left out, that of the path. A different length is spread evenly over the path.
        tension: Tension with which it is laid [N], instead of `length`: the path is longer than the cable by the
            strain `tension / ea`.
        elements: Number of elements of equal length. Give it, or `mesh`.
        mesh: Elements of different lengths instead of `elements`: `{ elements = 24, last = "1 mm" }` grades them
            towards the end, `first` towards the start, both towards both; or a list with the length of each, from
            start to end [m]. Where the cable's direction is held, elements should be shorter than its bending layer
            `√(EI/T)`. A graded end stays graded while a winch feeds there.
        longitudinal: Longitudinal stiffness model: L1, L1n, L2, L3 or L4. Default L4.
        transverse: Transverse stiffness model: T1, T2 or T3; T2 and T3 go with L3 and L4 only. Default T3.
        integration: Quadrature of the pointwise models. Default locking-free.
        velocity: Velocity of the whole cable at the start [m/s]. Default [0.0, 0.0, 0.0].
        stress_free: The shape in which it is free of stress. Default straight.
        strain: Strain at which it is free of stress, on top of `stress_free` [1]. Default 0.0.
        curvature: Curvature at which it is free of stress, on top of `stress_free` [1/m]. A scalar without direction,
            of a cable that turns about its axis as it likes: it curls to any side. One with a direction is laid bent,
            `stress_free = "as-laid"`. Default 0.0.
        """
        return self._add("elements", "cable", {
            "name": name,
            "section": section,
            "points": points,
            "radius": radius,
            "curve": curve,
            "start_direction": start_direction,
            "end_direction": end_direction,
            "length": length,
            "tension": tension,
            "elements": elements,
            "mesh": mesh,
            "longitudinal": longitudinal,
            "transverse": transverse,
            "integration": integration,
            "velocity": velocity,
            "stress_free": stress_free,
            "strain": strain,
            "curvature": curvature,
        })

    def point_mass(
        self,
        *,
        name: str,
        at: Union[Sequence[Number], str],
        mass: Number,
        volume: Number | None = None,
        added_mass: Number | None = None,
        drag_area: Number | None = None,
        velocity: Sequence[Number] | None = None,
    ) -> Part:
        """A compact body: a sinker, a buoy, the load at the end of a hose.

        On a marker of a cable it is part of that node; at a named point of a body or a link it moves and turns with
        it; with a position it is a point of its own. Marker: `name`.

        name: Name by which the rest of the scene refers to it.
        at: Marker of an earlier element that it sits on, such as `"hose.end"`, or the point where it starts [m].
        mass: Mass [kg].
        volume: Displaced volume, for buoyancy [m³]. Default 0.0.
        added_mass: Added mass in water, the same in all directions [kg]. Default 0.0.
        drag_area: Drag coefficient times area [m²]. Default 0.0.
        velocity: Velocity at the start, of a point of its own [m/s]. Default [0.0, 0.0, 0.0].
        """
        return self._add("elements", "point_mass", {
            "name": name,
            "at": at,
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
        points: Mapping[str, Any] | None = None,
    ) -> Part:
        """A rigid body with full inertia.

        Everything on it is given in its own frame, whose origin stands at `position`. Markers: `name` (that origin),
        `name.com` (the centre of mass), and the `points` that the scene names.

        name: Name by which the rest of the scene refers to it.
        position: Where the origin of its frame starts [m].
        angles: Orientation at the start as Bryant angles 1-2-3: turns about its x axis, its new y axis, its new z
            axis [rad]. Default [0.0, 0.0, 0.0].
        velocity: Velocity of the origin at the start [m/s]. Default [0.0, 0.0, 0.0].
        angular_velocity: Angular velocity at the start, in space [rad/s]. Default [0.0, 0.0, 0.0].
        mass: Mass [kg]; left out, that of the `shape` with its `density`.
        density: Density of the `shape` [kg/m³].
        shape: Homogeneous shape, from which the moments of inertia follow.
        inertia: Moments of inertia `Jxx`, `Jyy`, `Jzz` about the centre of mass [kg m²], instead of a shape.
        products: Products of inertia `Jxy`, `Jxz`, `Jyz`: the other entries of the inertia matrix [kg m²]. Default
            [0.0, 0.0, 0.0].
        centre: Centre of mass [m]. Default [0.0, 0.0, 0.0].
        volume: Displaced volume, for buoyancy [m³]. Default 0.0.
        centre_of_volume: Centre of the displaced volume [m]; left out, the centre of mass. Where the water has a
            `level`, the volume of a body with a hull lies along the hull.
        hull: Cylinder along which drag and added mass act; left out, they don't.
            from: One end of its axis [m]. Required.
            to: The other end [m]. Required.
            diameter: Diameter [m]. Required.
        points: Points by which the rest of the scene can hold it, each with its name [m].
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
        """A chain of rigid links with spherical joints, all of one length: a hose, a tether, a chain.

        It lies at rest along its path, the ends of all links on it. Markers: `name.start`, `name.end`, `name@12.5m`
        (a point of a link), `name.link3` (the centre of the third). The joint between the third and the fourth link
        is the constraint `name/3`, so its reaction is the tension there.

        name: Name by which the rest of the scene refers to it.
        links: Number of links.
        section: What it is made of.
            mass: Mass of the structure per length [kg/m]; what gravity pulls at. Required.
            flooded: Mass of water inside that moves along but has no weight in water [kg/m]. Default 0.0.
            diameter: Hydrodynamic diameter, for drag and added mass [m]; without one, neither acts. Default 0.0.
            displaced: Displaced volume per length, for buoyancy [m²]; left out, that of the full diameter.
            gyration: Radius of gyration about a link's axis [m]; left out, that of a solid cylinder, 0.354 times the
                diameter.
            ei: Bending stiffness EI, as springs EI/l at the joints [N m²]. Default 0.0.
            joint_damping: Damping of the joints about every axis [N m s/rad]. Default 0.0.
        length: Length of the chain [m]; left out, such that it fills its path. Shorter, it ends on the path where it
            ends.
        points: Points along which it is laid, from start to end [m]: straight lines between them.
        curve: Points of a smooth curve along which it is laid [m], instead of `points`.
        spool: The spool on which it goes on after the last of the points.
            centre: A point on the axis [m]. Required.
            axis: Direction of the axis, in which turn follows turn, right-handed about it. Required.
            pitch: Distance from turn to turn along the axis [m]; negative for turns that are left-handed about it.
                Required.
            turns: Number of turns; left out, as many as the `length` of the chain takes.
        stress_free: The shape in which its joints are free of bending moment. Default straight.
        velocity: Velocity of the whole chain at the start [m/s]. Default [0.0, 0.0, 0.0].
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
        of: str,
        force: Number,
    ) -> Part:
        """Breaks a connection for good once its force reaches a limit: a shear pin, a weak link. The moment is located
        in time and reported.

        name: Name, by which the event is reported.
        of: Name of the constraint, which stands above.
        force: Magnitude of its force at which it breaks [N].
        """
        return self._add("constraints", "break", {
            "name": name,
            "of": of,
            "force": force,
        })

    def clamp(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
        direction: Sequence[Number] | None = None,
    ) -> Part:
        """Holds the direction of a cable at a marker, in space or on a rigid body; its stretch stays free. With
        `spherical` a built-in end. A cable that is bent when free of stress can't twist there either.

        name: Name, by which records ask for its reaction.
        marker: The marker on a cable.
        to: The rigid body that holds the direction; left out, it is held in space.
        direction: The direction in space at the start; left out, that which the cable has there.
        """
        return self._add("constraints", "clamp", {
            "name": name,
            "marker": marker,
            "to": to,
            "direction": direction,
        })

    def coordinate(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        direction: Sequence[Number],
        motion: str | None = None,
    ) -> Part:
        """Holds or drives one coordinate of a marker, along a direction, and leaves the other two free.

        name: Name, by which records ask for its reaction.
        marker: The marker.
        direction: The direction of the coordinate.
        motion: Name of a motion, of which the part along the direction is followed; left out, the coordinate stays.
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
        """Lets a body slide along an axis of another part, or of space, and turn about it.

        name: Name, by which records ask for its reaction.
        marker: The marker that is held.
        axis: The axis in space at the start; it turns with the parts.
        to: What holds it: another marker or a point in space; left out, the point where the marker starts.
        """
        return self._add("constraints", "cylindrical", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "to": to,
        })

    def distance(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str],
        length: Number | None = None,
    ) -> Part:
        """Keeps two points at a constant distance: a rod without mass.

        name: Name, by which records ask for its reaction.
        marker: One marker.
        to: The other marker, or a point in space.
        length: Distance [m]; left out, that at the start.
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
        """Makes a marker follow a prescribed motion from where it starts.

        name: Name, by which records ask for its reaction.
        marker: The marker that is driven.
        motion: Name of the motion.
        """
        return self._add("constraints", "driving", {
            "name": name,
            "marker": marker,
            "motion": motion,
        })

    def eyelet(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
        path: str | None = None,
        speed: Number | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
        stop: Number | None = None,
        motion: str | None = None,
        tension: Number | None = None,
        per_speed2: Number | None = None,
        pace: str | None = None,
        damping: Number | None = None,
        shortest: Number | None = None,
        element: Number | None = None,
        release: Number | None = None,
    ) -> Part:
        """An eyelet that an end of a cable runs through: a fixed or moving point, and what draws the cable there.

        It is a `spherical` or `driving` constraint and a `winch` in one. The point stays where the end starts, or
        goes with `to`, or along `path`. Give one of `speed`, `motion` and `tension`: what isn't given is a result.
        The constraint of the point has the name of the eyelet, by which records ask for its reaction; what draws is
        called `name.feed`.

        name: Name, by which records and events refer to it.
        marker: The end of the cable: `fibre.start` or `fibre.end`.
        to: What the eyelet is on: a marker of a part or a point in space; left out, the point where the end starts.
        path: Name of a motion along which the eyelet moves from where the end starts, instead of `to`.
        speed: Speed at which cable comes in through the eyelet after the ramp [m/s]; negative draws it out of the
            free cable.
        start: Time at which the speed begins to rise [s]. Default 0.0.
        ramp: Time in which the speed rises, and falls at the stop [s]. Default 1.0.
        stop: Time at which the speed begins to fall again [s]; left out, it goes on.
        motion: Name of a motion whose x component is the length that has come in, instead of `speed`.
        tension: Tension with which the cable is drawn [N], instead of a speed.
        per_speed2: Tension by the square of the speed, besides `tension` [kg/m]. Default 0.0.
        pace: Name of a motion along x whose speed `per_speed2` goes by; left out, the speed at which the cable runs
            here, which then drives itself.
        damping: Resistance per speed, besides `tension` [N s/m]. Default 0.0.
        shortest: Shortest length of the free cable [m], where the run ends; left out, as for `winch`.
        element: Length of elements [m] that are born and swallowed at the eyelet; left out, all elements grow and
            shrink together.
        release: Time in which the strain fades that keeps the tension from jumping when an element is born or
            swallowed [s]. Default 0.1.
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
            "pace": pace,
            "damping": damping,
            "shortest": shortest,
            "element": element,
            "release": release,
        })

    def lift_off(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        package: Mapping[str, Any],
        tangent: Boolean | None = None,
        peel: Number | None = None,
        slip: Number | None = None,
    ) -> Part:
        """Lets an end of a cable lift off from a package: the lift-off point runs round the package as cable is peeled.

        A `winch` at the same end says what peels it: `speed` or `motion`, or `tension` for what the package holds it
        back with. Or `peel` says, without a winch, at which energy it comes off a package to which it sticks. Where
        the cable goes to is told by an eyelet at the other end: a `spherical` constraint and a winch of its own.
        Reports what happens on the way: a tension below what keeps the cable taut, contact with the package, too much
        bending.

        name: Name, by which records ask for its reaction.
        marker: The end of the cable that is wound: `fibre.end` or `fibre.start`.
        package: The package.
            radius: Radius of the layer that unwinds first, to the middle of the cable [m]. Required.
            length: Length along the axis that is wound, the same for all layers [m]. Required.
            diameter: Diameter of the cable: the radius changes by it from layer to layer [m]. Required.
            origin: Where its axis begins: the centre of one end [m]. Default [0.0, 0.0, 0.0].
            axis: Direction of its axis, from that end to the other. Default [0.0, 0.0, 1.0].
            reference: Direction from the axis in which the first lift-off point lies; left out, that of x, or of y if
                the axis is along x.
            side: Whether the cable lifts off inside or outside. Default inner.
            pitch: Way along the axis per turn [m]; left out, the diameter of the cable: turn beside turn.
            layers: How many layers there are. Default 1.
            hand: Which way the lift-off point runs round the axis. Default right.
            traverse: Which way along the axis the first layer unwinds. Default forward.
            first: Where along the axis, from its origin, the first lift-off point lies [m]; left out, at the end of
                the package where a full first layer begins.
            bend_limit: Smallest radius to which the cable may be bent [m]; left out, any.
        tangent: Whether the cable is tangent to the wound layer where it lifts off; needs bending stiffness. Default
            False.
        peel: Energy per length that it takes to peel the cable off [J/m], instead of a winch at this end. The cable
            then lifts off at a curvature with `EI (κ - κ_w)²/2 = peel`, `κ_w` being that of the wound cable, or if it
            isn't `tangent`, at an angle `D` with `T (1 - cos D) = peel`.
        slip: Speed below which a cable that sticks creeps [m/s], with `peel`. Default 0.001.
        """
        return self._add("constraints", "lift_off", {
            "name": name,
            "marker": marker,
            "package": package,
            "tangent": tangent,
            "peel": peel,
            "slip": slip,
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
        """Keeps an axis of one part at right angles to an axis of another, or of space.

        name: Name, by which records ask for its reaction.
        marker: The marker that is held.
        to: What holds it: another marker or a point in space; left out, the point where the marker starts.
        axis_to: The axis of `to` in space at the start; it turns with it. Left out on a cable, which has only its own
            direction.
        axis: The axis of `marker` in space at the start; it turns with it. Left out on a cable.
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
        """Keeps a point on a straight line through another part, or through space.

        name: Name, by which records ask for its reaction.
        marker: The marker that is held.
        axis: The direction of the line in space at the start; it turns with `to`.
        to: What holds it: another marker or a point in space; left out, the point where the marker starts.
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
        """Keeps a point in a plane of another part, or of space.

        name: Name, by which records ask for its reaction.
        marker: The marker that is held.
        axis: The normal of the plane in space at the start; it turns with `to`.
        to: What holds it: another marker or a point in space; left out, the point where the marker starts.
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
        """Lets a body slide along an axis of another part, or of space, without turning.

        name: Name, by which records ask for its reaction.
        marker: The marker that is held.
        axis: The axis in space at the start; it turns with the parts.
        to: What holds it: another marker or a point in space; left out, the point where the marker starts.
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
        """A hinge: holds two points together and leaves only the rotation about an axis. The end of a cable swings in
        the plane normal to it.

        name: Name, by which records ask for its reaction.
        marker: The marker that is held.
        axis: The axis in space at the start; it turns with the parts.
        to: What holds it: another marker or a point in space; left out, the point where the marker starts.
        """
        return self._add("constraints", "revolute", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "to": to,
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
        """Drives an angle: the rotation of a part against another, about a common axis. Put it beside a `revolute`
        joint.

        name: Name, by which records ask for its reaction.
        marker: The marker that is driven, on a rigid body or a cable.
        axis: The axis in space at the start.
        motion: Name of the motion, whose x component is the angle [rad].
        to: The marker that it is driven against, on a rigid body; left out, space.
        """
        return self._add("constraints", "rotation", {
            "name": name,
            "marker": marker,
            "axis": axis,
            "motion": motion,
            "to": to,
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
        """Drives a length: the place of a marker along an axis of another.

        name: Name, by which records ask for its reaction.
        marker: The marker that is driven.
        axis: The axis in space at the start; it turns with `to`.
        motion: Name of the motion, whose x component is the displacement along the axis.
        to: The marker that it is driven against; left out, the point where it starts.
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
        """Holds two points together: of two parts, or of a part and space. Leaves every rotation free.

        name: Name, by which records ask for its reaction.
        marker: The marker that is held.
        to: What holds it: another marker or a point in space; left out, the point where the marker starts.
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
        """A universal joint: holds two points together, and an axis of one part at right angles to an axis of the other.

        name: Name, by which records ask for its reaction.
        marker: The marker that is held.
        to: What holds it: another marker or a point in space; left out, the point where the marker starts.
        axis_to: The axis of `to` in space at the start; it turns with it. Left out on a cable, which has only its own
            direction.
        axis: The axis of `marker` in space at the start; it turns with it. Left out on a cable.
        """
        return self._add("constraints", "universal", {
            "name": name,
            "marker": marker,
            "to": to,
            "axis_to": axis_to,
            "axis": axis,
        })

    def weld(
        self,
        *,
        name: str,
        marker: Union[Sequence[Number], str],
        to: Union[Sequence[Number], str] | None = None,
    ) -> Part:
        """Joins two parts rigidly, as they stand at the start. The direction of a cable's end is held; its stretch stays
        free.

        name: Name, by which records ask for its reaction.
        marker: The marker that is held.
        to: What holds it: another marker or a point in space; left out, the point where the marker starts.
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
        speed: Number | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
        stop: Number | None = None,
        total: Number | None = None,
        final_length: Number | None = None,
        motion: str | None = None,
        tension: Number | None = None,
        brake: Number | None = None,
        slip: Number | None = None,
        damping: Number | None = None,
        per_speed2: Number | None = None,
        pace: str | None = None,
        inertia: Number | None = None,
        pile: Boolean | None = None,
        stock: Number | None = None,
        shortest: Number | None = None,
        element: Number | None = None,
        release: Number | None = None,
    ) -> Part:
        """Feeds out and reels in cable at one of its ends: the cable's length changes, with the right mass, momentum and
        drag.

        Where that end is in space is told by another constraint, such as `spherical` or `driving`. Prescribe the
        speed by `speed` or by `motion`; or leave the end free and give what holds it back: `tension`, `brake`,
        `damping`, `inertia`. A winch whose `speed` is 0 is no winch: the cable is as it would be without.

        name: Name, by which records and events refer to it.
        marker: The end of the cable: `hose.start` or `hose.end`.
        speed: Speed at which it feeds out after the ramp [m/s]; negative reels in. Where `final_length` says which of
            the two it is, it may be positive for both.
        start: Time at which it starts [s]. Default 0.0.
        ramp: Time in which the speed rises, and falls at the stop [s]. Default 1.0.
        stop: Time at which it begins to slow down again [s]; left out, it goes on.
        total: Length that it feeds out in all before it stops [m], with the sign of the speed, instead of `stop`.
        final_length: Length of the cable at which it stops [m], instead of `stop` and `total`.
        motion: Name of a motion whose x component is the length fed out, instead of `speed`.
        tension: Tension that holds the end back where the speed isn't prescribed [N].
        brake: Dry friction of a brake [N]. Default 0.0.
        slip: Speed below which the brake creeps instead of sticking [m/s]. Default 0.001.
        damping: Resistance per speed [N s/m]. Default 0.0.
        per_speed2: Tension by the square of the speed, besides `tension` [kg/m]: what is measured at an eyelet often
            goes by it. Default 0.0.
        pace: Name of a motion along x whose speed `per_speed2` goes by; left out, the speed at which the cable runs
            here. A tension that draws, and grows with the speed to which it draws, drives itself: then name the
            motion that is meant.
        inertia: Inertia of the drum over the square of its radius [kg]. Default 0.0.
        pile: Whether cable is picked up from a pile at rest, and not from a drum that turns with it. Default False.
        stock: Length on the spool at the start [m]: once it is fed out, the run ends. Left out, there is always more.
        shortest: Shortest length that the cable is reeled in to [m], where the run ends; left out, a twentieth of its
            length at the start, or two elements.
        element: Length of elements [m] that are born and swallowed at this end; left out, all elements of the cable
            grow and shrink together, which is smoother and does for a change of length up to ten times or so.
        release: Time in which the strain fades that keeps the tension from jumping when an element is born or
            swallowed [s]. Default 0.1.
        """
        return self._add("constraints", "winch", {
            "name": name,
            "marker": marker,
            "speed": speed,
            "start": start,
            "ramp": ramp,
            "stop": stop,
            "total": total,
            "final_length": final_length,
            "motion": motion,
            "tension": tension,
            "brake": brake,
            "slip": slip,
            "damping": damping,
            "per_speed2": per_speed2,
            "pace": pace,
            "inertia": inertia,
            "pile": pile,
            "stock": stock,
            "shortest": shortest,
            "element": element,
            "release": release,
        })

    def added_mass(
        self,
        *,
        ca: Number | None = None,
        theory: Literal['energy', 'morison'] | None = None,
        tail: Number | None = None,
        on: Sequence[str] | None = None,
    ) -> Part:
        """Water that a cable or a hull pushes aside: its inertia, and what it does in flow along the body.

        It has the kinetic energy of the water, so a hull at an angle to the flow is turned (Munk's moment), and flow
        along a cable acts like compression and can make it flutter. `theory = "morison"` leaves inertia alone, for
        comparison with codes that have only that.

        ca: Coefficient: mass over that of the water in a circle of the hydrodynamic diameter. Default 1.0.
        theory: `energy` or `morison`; left out, `energy`.
        tail: Share of its momentum that the water gives back at the free ends of cables: 0 for ends that are cut off,
            about 0.8 for ends that taper, 1 for a perfect tail. Default 0.0.
        on: Parts that it acts on; left out, all.
        """
        return self._add("forces", "added_mass", {
            "ca": ca,
            "theory": theory,
            "tail": tail,
            "on": on,
        })

    def buoyancy(
        self,
        *,
        on: Sequence[str] | None = None,
    ) -> Part:
        """Buoyancy of the displaced volume: of all of it, or, where the water has a `level`, of what is under water.

        Cables, hulls and chains are cylinders there, other bodies and point masses balls.

        on: Parts that it lifts; left out, all.
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
        stiffness: Sequence[Number] | None = None,
        damping: Sequence[Number] | None = None,
        rotational_stiffness: Sequence[Number] | None = None,
        rotational_damping: Sequence[Number] | None = None,
    ) -> Part:
        """A spring and damper in all directions between two rigid bodies, or one and space: a rubber mount, a soft
        joint. Without force as the bodies stand at the start; rotations count up to half a turn.

        name: Name.
        marker: The marker that is held.
        to: What holds it, whose axes the numbers belong to: a marker on a rigid body, or a point in space; left out,
            the point where the marker starts.
        axis_x: Direction in space at the start of the first of these axes; left out, with `axis_y`, the axes of
            space.
        axis_y: Direction in space at the start of the second, at right angles to the first.
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
        at: Sequence[Union[Sequence[Number], str]] | None = None,
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
        """Contact of cables and bodies with a shape on the ground or on a rigid body, which feels the opposite force.

        Cables, links and bodies with a hull touch all along, wherever the shape is nearer than their radius, point
        masses and single points of bodies by a ball of the `radius` given. A record of type `force` shows the force.

        name: Name.
        shape: The shape.
        on: What touches it: cables, bodies with a hull, point masses; left out and without `at`, all of them that are
            not the shape's own body.
        at: Single points that touch it, such as corners of bodies, as balls of the `radius`.
        marker: Where the shape is: a point in space, or a marker on a rigid body that it is part of; left out, the
            origin. Default [0.0, 0.0, 0.0].
        radius: Radius of what touches [m]; left out, half of the diameter of the cable or hull.
        stiffness: Stiffness of a ball that stands for a whole point mass or point [N/m]; with an exponent `p` other
            than 1, that at a depth of 1 m. Default 0.0.
        stiffness_per_length: Stiffness per length of cables and hulls [N/m²]; with an exponent other than 1, that at
            a depth of 1 m. Default 0.0.
        end_stiffness: Stiffness of the tips of cables and hulls, in addition [N/m]; with an exponent other than 1,
            that at a depth of 1 m. Left out, that of a length as long as they are thick; 0 without.
        exponent: Exponent `p` of the elastic force `k d^p`. Default 1.0.
        damping: What it loses along the normal. Default none.
        friction: Dry friction: a coefficient, or `{ mu, across, elastic_slip }`. Equilibria are found without it:
            those with it are many.
        overlap: What is done about points that start deep in the shape. Default refuse.
        """
        return self._add("forces", "contact", {
            "name": name,
            "shape": shape,
            "on": on,
            "at": at,
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
        """Drag of the water, and of the air if the scene has some, on cables and hulls, across and along, each by its
        own law.

        normal: Law across the cable. Default constant.
        tangential: Law along the cable. Default constant.
        cn: Coefficient across, for the constant law, on the diameter. Default 1.2.
        ct: Coefficient along, for the constant law, on the circumference. Default 0.01.
        end: Form drag of each free end of cables, hulls and chains in flow along it: coefficient on the area of its
            face. Left out, none; both ends of a long blunt cylinder have about 0.8 together. Default 0.0.
        stretched: Whether drag is per stretched length instead of unstretched. Default False.
        blend: Relative width in Reynolds number over which the branches of Choo and Casarella are blended; left out,
            they jump as published.
        on: Cables that it acts on; left out, all.
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

    def gravity(
        self,
        *,
        on: Sequence[str] | None = None,
    ) -> Part:
        """Weight: the scene's `gravity` pulls at the structural mass of every part.

        on: Parts that it pulls at; left out, all.
        """
        return self._add("forces", "gravity", {
            "on": on,
        })

    def latch(
        self,
        *,
        name: str,
        of: Sequence[str],
        stiffness: Number,
        hold: Number,
        to: Union[Sequence[Number], str] | None = None,
        damping: Number | None = None,
        direction: Sequence[Number] | None = None,
        fade: Number | None = None,
        floor: Mapping[str, Any] | None = None,
        stop: Boolean | None = None,
    ) -> Part:
        """Holds points where they start by a spring and damper each, until the pull on one reaches a limit: then it lets
        go for good. Each release is located in time and reported.

        A hose on its spool, a cable tied up with tape, a load that is dropped. Records: `released` counts.

        name: Name, by which releases are reported.
        of: What is held: parts, of which every node or link is held, and single markers.
        stiffness: Stiffness of a seat [N/m].
        hold: Force of a seat at which it lets go [N].
        to: Where the seats are: on this rigid body, as it stands at the start; left out, fixed in space.
        damping: Damping of a seat [N s/m]. Default 0.0.
        direction: Direction in space: only the pull in it counts; left out, the magnitude of the force.
        fade: Time in which the force fades after the release [s]. Default 0.001.
        floor: A plane, fixed in space, behind which released points are pushed back.
            point: A point of the plane [m]. Required.
            normal: Its normal, on the side where points may be. Required.
            stiffness: Force by depth [N/m]. Required.
        stop: Whether the run ends once the last one has let go. Default False.
        """
        return self._add("forces", "latch", {
            "name": name,
            "of": of,
            "stiffness": stiffness,
            "hold": hold,
            "to": to,
            "damping": damping,
            "direction": direction,
            "fade": fade,
            "floor": floor,
            "stop": stop,
        })

    def line_load(
        self,
        *,
        force: Sequence[Number],
        stretched: Boolean | None = None,
        time: Union[Literal['constant'], Mapping[str, Any]] | None = None,
        on: Sequence[str] | None = None,
    ) -> Part:
        """A force per length in a constant direction.

        force: Force per length [N/m].
        stretched: Whether it is per stretched length instead of unstretched. Default False.
        time: Factor that changes with time. Default constant.
        on: Cables that it acts on; left out, all.
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
        force: Sequence[Number] | None = None,
        local: Boolean | None = None,
        follower: Number | None = None,
        time: Union[Literal['constant'], Mapping[str, Any]] | None = None,
    ) -> Part:
        """A force at a marker: in a constant direction, in the axes of a rigid body, or along a cable.

        marker: Where it acts.
        force: Force in space [N]. Default [0.0, 0.0, 0.0].
        local: Whether `force` is in the axes of the rigid body that it acts on, and turns with it. Default False.
        follower: Instead: force along the cable at the marker, towards its end [N]. It turns with the cable.
        time: Factor that changes with time. Default constant.
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
        moment: Sequence[Number],
        local: Boolean | None = None,
        time: Union[Literal['constant'], Mapping[str, Any]] | None = None,
    ) -> Part:
        """A moment on a rigid body or at a marker on a cable, with an axis fixed in space or, on a body, in its axes.
        Its part along a cable is lost: a cable doesn't know twist.

        marker: Where it acts.
        moment: Moment [N m].
        local: Whether it is in the axes of the rigid body that it acts on, and turns with it. Default False.
        time: Factor that changes with time. Default constant.
        """
        return self._add("forces", "point_moment", {
            "marker": marker,
            "moment": moment,
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
        stiffness: Number | None = None,
        damping: Number | None = None,
        angle: Number | None = None,
    ) -> Part:
        """A torsion spring and damper about an axis, beside a `revolute` joint; angles count up to half a turn from the
        one without moment.

        name: Name.
        marker: The marker on the body that is turned.
        axis: The axis in space at the start.
        to: The body that it is turned against; left out, space.
        stiffness: Stiffness [N m/rad]. Default 0.0.
        damping: Damping [N m s/rad]. Default 0.0.
        angle: Angle without moment, from where the bodies stand at the start [rad]. Default 0.0.
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
        stiffness: Number,
        damping: Number | None = None,
        length: Number | None = None,
        tension_only: Boolean | None = None,
    ) -> Part:
        """A spring and damper between two markers, along the line between them.

        name: Name.
        marker: One end.
        to: The other end: a marker or a point in space.
        stiffness: Stiffness [N/m].
        damping: Damping [N s/m]. Default 0.0.
        length: Length without force [m]; left out, that at the start.
        tension_only: Whether it pulls only. Default False.
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
        """Rests, then runs on a circle from the first moment; the speed rises smoothly.

        name: Name, by which constraints refer to it.
        speed: Speed after the ramp [m/s].
        radius: Radius of the circle [m].
        heading: Direction of travel at the start, horizontal. Default [1.0, 0.0, 0.0].
        towards: Which way it turns. Default port.
        start: Time at which it starts [s]. Default 0.0.
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

    def harmonic(
        self,
        *,
        name: str,
        amplitude: Sequence[Number],
        frequency: Number,
        phase: Number | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
    ) -> Part:
        """Goes to and fro.

        name: Name, by which constraints refer to it.
        amplitude: Amplitude [m].
        frequency: Frequency [Hz].
        phase: Phase [rad]. Default 0.0.
        start: Time at which it starts [s]. Default 0.0.
        ramp: Time in which the amplitude rises [s]; 0 for what swings from the first moment on and starts with that
            velocity. Default 5.0.
        """
        return self._add("motions", "harmonic", {
            "name": name,
            "amplitude": amplitude,
            "frequency": frequency,
            "phase": phase,
            "start": start,
            "ramp": ramp,
        })

    def rest(
        self,
        *,
        name: str,
    ) -> Part:
        """Stays where it is.

        name: Name, by which constraints refer to it.
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
        """Runs straight ahead with the speeds of a table, in the scene or in a CSV file: a measured launch, the course
        of a winch.

        The speed goes straight from row to row, so that the way is the area under the table: 1 m from 0 to 1 m/s in 2
        s. The acceleration jumps at the rows, where steps end; `join = "monotone"` rounds the speed off.

        name: Name, by which constraints refer to it.
        direction: Direction of travel. Default [1.0, 0.0, 0.0].
        file: A CSV file, its path as seen from the scene file. Its first line names the columns, `t` and `v`, with
            their units in brackets (`t [s],v [kn]`) or without in s and m/s; other columns are left alone.
        t: Times [s], ascending, instead of a file; the run must not go beyond the last.
        v: Speeds at these times [m/s].
        join: How the speeds are joined. Default linear.
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
        """An angle for the constraint `rotation`: rests, then turns at a steady rate, which rises smoothly.

        name: Name, by which constraints refer to it.
        rate: Rate after the ramp [rad/s].
        start: Time at which it starts [s]. Default 0.0.
        ramp: Time in which the rate rises [s]; 0 for what turns from the first moment on and starts with that
            velocity. Default 1.0.
        rise: How it rises meanwhile. Default quintic.
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
        """Rests, then runs straight ahead; the speed rises smoothly.

        name: Name, by which constraints refer to it.
        speed: Speed after the ramp [m/s].
        direction: Direction of travel. Default [1.0, 0.0, 0.0].
        start: Time at which it starts [s]. Default 0.0.
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
        of: Sequence[str],
    ) -> Part:
        """Adds motions up: displacements, velocities and accelerations. The parts may be of any type, a sum as well.

        name: Name, by which constraints refer to it.
        of: Names of the motions that it is the sum of: `of = ["surge", "heave"]`.
        """
        return self._add("motions", "sum", {
            "name": name,
            "of": of,
        })

    def swing(
        self,
        *,
        name: str,
        amplitude: Number,
        frequency: Number,
        phase: Number | None = None,
        start: Number | None = None,
        ramp: Number | None = None,
    ) -> Part:
        """An angle for the constraint `rotation` that goes to and fro, faded in smoothly.

        name: Name, by which constraints refer to it.
        amplitude: Amplitude [rad].
        frequency: Frequency [Hz].
        phase: Phase [rad]. Default 0.0.
        start: Time at which it starts [s]. Default 0.0.
        ramp: Time in which the amplitude rises [s]; 0 for what swings from the first moment on and starts with that
            velocity. Default 5.0.
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

        Between the rows it never overshoots. Its acceleration jumps there, unless `join = "cubic"`, which is the
        better choice for records of smooth motions with many rows, such as the heave of a ship. A table of speeds is
        a `speed_table`.

        name: Name, by which constraints refer to it.
        file: A CSV file, its path as seen from the scene file. Its first line names the columns, `t` and any of `x`,
            `y`, `z`, or `angle`, with their units in brackets (`t [s],z [cm]`, `t [s],angle [deg]`) or without in s,
            m and rad; other columns are left alone.
        t: Times [s], ascending, instead of a file; the run must not go beyond the last.
        x: Displacements along x at these times [m]; left out, none.
        y: Displacements along y [m].
        z: Displacements along z [m].
        angle: Angles at these times, instead of displacements, for the constraint `rotation` [rad]. Degrees are
            written with their unit: `"90 deg"`.
        join: How the rows are joined. By straight lines only where all lie on one: the velocity would jump. Default
            monotone.
        ends: What it does at its ends. Default natural.
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
        """Runs straight and then turns: speed and, later, yaw rate rise smoothly.

        name: Name, by which constraints refer to it.
        speed: Speed after the ramp [m/s].
        radius: Radius of the final circle [m].
        heading: Direction of travel at the start, horizontal. Default [1.0, 0.0, 0.0].
        towards: Which way it turns. Default port.
        start: Time at which it starts to run [s]. Default 0.0.
        ramp: Time in which the speed rises [s]. Default 5.0.
        turn_start: Time at which it starts to turn [s]; left out, when it starts to run.
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
        """Acceleration of a point: columns `hose.end.ax`, `.ay` and `.az` in m/s².

        It is the one that fits positions and velocities by the equations of motion, less noisy than the integrator's
        own.

        of: The point: a named place like `hose.end`, or any arc length like `hose@12.5m`.
        name: Name in results; left out, that of the point and `.acceleration`.
        title: Title of its pictures; left out, what it is.
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
        what: Literal['curvature', 'moment', 'strain', 'tension'],
        at: Number,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Tension, strain, curvature or bending moment of a cable at one place: column `hose.end.tension`.

        of: The cable.
        what: What is recorded: tension [N], strain, curvature [1/m] or moment [N m].
        at: Where: `start`, `end`, an unstretched arc length from the start as it is now [m], or a share of the length
            like `50 %`.
        name: Name in results; left out, cable, place and quantity.
        title: Title of its pictures; left out, what it is.
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
        """Angular velocity of a rigid body: columns `crank.wx`, `.wy` and `.wz` in rad/s.

        of: The body, or any point on it, such as `hose.link3`.
        to: The body that it is relative to; left out, space. The relative angular velocity of a joint's two bodies is
            the speed of the joint.
        frame: The axes that it is given in: of `space`, of the `body`, or of the body `to` which it is relative.
            Default space.
        axes: The components that are recorded; left out, all three. Default ['x', 'y', 'z'].
        name: Name in results; left out, that of the body and `.angular_velocity`.
        title: Title of its pictures; left out, what it is.
        """
        return self._add("records", "angular_velocity", {
            "of": of,
            "to": to,
            "frame": frame,
            "axes": axes,
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
        at: Where: as for `along`; left out, at a quarter, half and three quarters of the length. Default ['25 %', '50
            %', '75 %'].
        name: Name in results; left out, that of the cable and `.cn`.
        title: Title of its pictures; left out, what it is.
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
        """A driving constraint against the motion that it imposes: columns `ship.imposed_x` and `ship.actual_x` in m,
        the same of velocities, `ship.imposed_vx` and `ship.actual_vx` in m/s, and `ship.difference`, the distance
        between where the marker is and where it should be, in m.

        of: Name of the driving constraint.
        axes: The axes of space that are recorded; left out, all three. Default ['x', 'y', 'z'].
        name: Name in results; left out, that of the constraint and `.check`.
        title: Title of its pictures; left out, what it is.
        """
        return self._add("records", "driving_check", {
            "of": of,
            "axes": axes,
            "name": name,
            "title": title,
        })

    def energy(
        self,
        *,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Balance of energy: columns `energy.kinetic`, `.potential`, `.supplied`, `.dissipated` and `.imbalance` in J.

        Work is counted from the start of the run. The imbalance is what the integration gained (positive) or, by its
        numerical damping, lost (negative).

        name: Name in results; left out, `energy`.
        title: Title of its pictures; left out, what it is.
        """
        return self._add("records", "energy", {
            "name": name,
            "title": title,
        })

    def feeding(
        self,
        *,
        of: str,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Feeding at an end of a cable: columns `hose.start.fed`, the length fed out in m, `.speed` in m/s, and where
        the speed is prescribed `.pull`, what the winch pulls with in N.

        of: The end of the cable: `hose.start` or `hose.end`.
        name: Name in results; left out, that of the end.
        title: Title of its pictures; left out, what it is.
        """
        return self._add("records", "feeding", {
            "of": of,
            "name": name,
            "title": title,
        })

    def force(
        self,
        *,
        of: str,
        name: str | None = None,
    ) -> Part:
        """What a force has to show. Of a contact: columns `drum.fx`, `.fy` and `.fz`, the force of the shape on all that
        touches it in N, `.normal`, the sum of what presses in N, `.depth`, the deepest point in m, and `.points`, how
        many touch. Of a spring: `mooring.tension` in N.

        of: Name of the force.
        name: Name in results; left out, that of the force.
        """
        return self._add("records", "force", {
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
        """Unstretched length of a cable, with what winches have fed out and reeled in: column `hose.length` in m.

        of: The cable.
        name: Name in results; left out, that of the cable and `.length`.
        title: Title of its pictures; left out, what it is.
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

        Water that is carried along as added mass counts.

        name: Name in results; left out, `momentum`.
        title: Title of its pictures; left out, what it is.
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
        """Orientation of a rigid body as Bryant angles 1-2-3, turns about its x axis, its new y axis, its new z axis:
        columns `crank.phi1`, `.phi2` and `.phi3` in rad. The first and the third jump from π to -π.

        of: The body, or any point on it.
        degrees: Whether angles are in degrees. Default False.
        name: Name in results; left out, that of the body and `.orientation`.
        title: Title of its pictures; left out, what it is.
        """
        return self._add("records", "orientation", {
            "of": of,
            "degrees": degrees,
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

        of: The point: a named place like `hose.end`, or any arc length like `hose@12.5m`.
        axes: The axes of space that are recorded; left out, all three. Default ['x', 'y', 'z'].
        name: Name in results; left out, that of the point.
        title: Title of its pictures; left out, what it is.
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
        Where it holds the direction of a rigid body too, its moment about the marker as well: `.mx`, `.my`, `.mz` in
        N m.

        A rope that hangs from its anchor is pulled upwards, so `fz` is its weight.

        of: Name of the constraint.
        what: Only some of it: `force`, `magnitude` or `moment`. Default all.
        name: Name in results; left out, that of the constraint and `.reaction`.
        title: Title of its pictures; left out, what it is.
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
        """How many latches of a `latch`, or whether a connection that can `break`, have let go: column `reel.released`.

        of: Name of the latch or break.
        name: Name in results; left out, that of the latch and `.released`.
        title: Title of its pictures; left out, what it is.
        """
        return self._add("records", "released", {
            "of": of,
            "name": name,
            "title": title,
        })

    def velocity(
        self,
        *,
        of: str,
        name: str | None = None,
        title: str | None = None,
    ) -> Part:
        """Velocity of a point: columns `hose.end.vx`, `.vy` and `.vz` in m/s.

        of: The point: a named place like `hose.end`, or any arc length like `hose@12.5m`.
        name: Name in results; left out, that of the point and `.velocity`.
        title: Title of its pictures; left out, what it is.
        """
        return self._add("records", "velocity", {
            "of": of,
            "name": name,
            "title": title,
        })

    def unwound_cable(
        self,
        *,
        name: str,
        mass: Number,
        package: Mapping[str, Any],
        motion: str,
        rule: Mapping[str, Any],
        bending: Number | None = None,
        eyelet: Sequence[Number] | None = None,
        guided: Boolean | None = None,
        tangent: Boolean | None = None,
        points: Sequence[Sequence[Number]] | None = None,
        drag: Mapping[str, Any] | None = None,
        added_mass: Number | None = None,
        weight: Boolean | None = None,
        segments: Integer | None = None,
        step: Number | None = None,
        damping: Number | None = None,
        titles: Mapping[str, Any] | None = None,
    ) -> Part:
        """A cable that is drawn from a package through an eyelet, by finite differences: an inextensible cable,
        Newmark's method and a tension that comes from the constraint. It shares no equation with the elements of type
        `cable`.

        name: Name, with which the columns of the history begin.
        mass: Mass per length [kg/m].
        package: The package that it is wound on, with its diameter and the radius to which it may be bent.
            radius: Radius of the layer that unwinds first, to the middle of the cable [m]. Required.
            length: Length along the axis that is wound, the same for all layers [m]. Required.
            diameter: Diameter of the cable: the radius changes by it from layer to layer [m]. Required.
            origin: Where its axis begins: the centre of one end [m]. Default [0.0, 0.0, 0.0].
            axis: Direction of its axis, from that end to the other. Default [0.0, 0.0, 1.0].
            reference: Direction from the axis in which the first lift-off point lies; left out, that of x, or of y if
                the axis is along x.
            side: Whether the cable lifts off inside or outside. Default inner.
            pitch: Way along the axis per turn [m]; left out, the diameter of the cable: turn beside turn.
            layers: How many layers there are. Default 1.
            hand: Which way the lift-off point runs round the axis. Default right.
            traverse: Which way along the axis the first layer unwinds. Default forward.
            first: Where along the axis, from its origin, the first lift-off point lies [m]; left out, at the end of
                the package where a full first layer begins.
            bend_limit: Smallest radius to which the cable may be bent [m]; left out, any.
        motion: Motion that draws the cable: its way along x is the length drawn through the eyelet.
        rule: What finds the lift-off point.
        bending: Bending stiffness [N m^2]; left out, the cable is flexible. Default 0.0.
        eyelet: Position of the eyelet [m]. Default [0.0, 0.0, 0.0].
        guided: Whether the eyelet holds the cable along the axis of the package; needs bending stiffness to matter.
            Default False.
        tangent: Whether the cable is tangent to the wound layer where it lifts off; needs bending stiffness. Default
            False.
        points: Shape at the start, at rest: points from the eyelet to the lift-off point [m]. Left out, the steady
            balloon of the speed and the tension at the start; without speed and weight, a straight line.
        drag: Drag of the water; left out, none.
            normal: Law across the cable. Default constant.
            tangential: Law along the cable. Default constant.
            cn: Coefficient across, for the constant law, on the diameter. Default 1.2.
            ct: Coefficient along, for the constant law, on the circumference. Default 0.01.
            end: Form drag of each free end of cables, hulls and chains in flow along it: coefficient on the area of
                its face. Left out, none; both ends of a long blunt cylinder have about 0.8 together. Default 0.0.
            stretched: Whether drag is per stretched length instead of unstretched. Default False.
            blend: Relative width in Reynolds number over which the branches of Choo and Casarella are blended; left
                out, they jump as published.
            on: Cables that it acts on; left out, all.
        added_mass: Coefficient of the water that the cable carries along across its axis; left out, 0. Default 0.0.
        weight: Whether the scene's gravity pulls at it, less the buoyancy of its volume. Default False.
        segments: Into how many segments the free cable is divided. Default 40.
        step: Time step [s]; `auto` or left out, 0.2 ms, or with bending stiffness and a given tension what the
            segments allow: two of them over the speed of waves. A longer one ends the run there with an error, since
            the lift-off point would tremble.
        damping: Numerical damping of Newmark's method; left out, 0.05 with bending stiffness and 0 without.
        titles: Titles of its pictures, by what they show: `tension`, `length`, `speed`, `lift`, `radius`, `centre`,
            `acceleration`, `drag`, `curvature`; left out, what it is.
        """
        return self._add("processes", "unwound_cable", {
            "name": name,
            "mass": mass,
            "package": package,
            "motion": motion,
            "rule": rule,
            "bending": bending,
            "eyelet": eyelet,
            "guided": guided,
            "tangent": tangent,
            "points": points,
            "drag": drag,
            "added_mass": added_mass,
            "weight": weight,
            "segments": segments,
            "step": step,
            "damping": damping,
            "titles": titles,
        })

    def set_water(
        self,
        *,
        density: Number | None = None,
        viscosity: Number | None = None,
        level: Number | None = None,
        current: Sequence[Number] | None = None,
        profile: Sequence[Mapping[str, Any]] | None = None,
    ) -> None:
        """The water around a scene. Drag, buoyancy and added mass need it; nothing else looks at it.

        density: Density [kg/m³]. Default 1025.0.
        viscosity: Dynamic viscosity [Pa s]. Default 0.00108.
        level: Height of its surface, which is at rest [m]; left out, there is water everywhere.
        current: Velocity of the water, the same everywhere [m/s]. Default [0.0, 0.0, 0.0].
        profile: Velocity of the water by height, instead of `current`: piecewise linear between the levels, constant
            beyond.
        """
        self._set("water", {
            "density": density,
            "viscosity": viscosity,
            "level": level,
            "current": current,
            "profile": profile,
        })

    def set_air(
        self,
        *,
        density: Number | None = None,
        viscosity: Number | None = None,
        wind: Sequence[Number] | None = None,
        profile: Sequence[Mapping[str, Any]] | None = None,
    ) -> None:
        """The air above the water, or around a scene without water: only drag looks at it. Left out, there is nothing.

        density: Density [kg/m³]. Default 1.225.
        viscosity: Dynamic viscosity [Pa s]. Default 1.79e-05.
        wind: Velocity of the air, the same everywhere [m/s]. Default [0.0, 0.0, 0.0].
        profile: Velocity of the air by height, instead of `wind`: piecewise linear between the levels, constant
            beyond.
        """
        self._set("air", {
            "density": density,
            "viscosity": viscosity,
            "wind": wind,
            "profile": profile,
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
        shape_titles: Mapping[str, Any] | None = None,
        tables: Sequence[Mapping[str, Any]] | None = None,
    ) -> None:
        """What is run and how long.

        analysis: What is computed. Default dynamics.
        duration: Length of the run [s]; in statics the end of the load factor. Default 1.0.
        output: Interval of the history [s]; 0 takes a thousandth of the duration. Default 0.0.
        frame: In statics: the frame that the equilibrium is relative to, such as that of a ship that tows steadily.
            What is held fixed then moves with the frame.
            velocity: Velocity of the centre [m/s]. Default [0.0, 0.0, 0.0].
            omega: Angular velocity [rad/s]. Default [0.0, 0.0, 0.0].
            centre: A point on the axis of rotation [m]: in space, or of a motion's frame relative to where the motion
                starts. Default [0.0, 0.0, 0.0].
        from_equilibrium: Start a dynamic run from the equilibrium at t = 0 instead of the configuration as laid.
            Default False.
        audit: Keep account of energy and work at every step. Default True.
        snapshots: Number of snapshots in the pictures of shapes. Default 9.
        shape_titles: Titles of the pictures of shapes; left out, that of the scene.
            side: From the side: x and z.
            top: From above: x and y.
            end: From the end: y and z.
            space: In space, seen obliquely from above; drawn only if it has a title.
            radial: z over the distance from the z axis; drawn only if it has a title.
        tables: Tables of a few columns of the history, each a CSV file of its own.
        """
        self._set("run", {
            "analysis": analysis,
            "duration": duration,
            "output": output,
            "frame": frame,
            "from_equilibrium": from_equilibrium,
            "audit": audit,
            "snapshots": snapshots,
            "shape_titles": shape_titles,
            "tables": tables,
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

        scheme: The scheme. Default {'generalized-alpha': {'rho_inf': 0.8}}.
        stepping: How the step size is chosen. Default {'controlled': {'tolerance': 0.0001}}.
        newton: When the iteration matrix is computed anew. Default modified.
        constraints: In which form constraints are met; Radau IIA meets both positions and velocities in any case.
            Default positions.
        force_tolerance: Error of tensions and reactions, relative to the largest in their part. Default 0.01.
        allow_unstable: Accept a scheme that is unstable on constrained systems, with a warning. Default False.
        h_max: Largest step [s]; if not given, a twentieth of the run.
        h_min: Smallest step before the run gives up [s]; if not given, 1e-12 of the run.
        h_start: First step of error control [s]; if not given, it follows from the motion at the start.
        horizon: Time over which errors add up [s]; 0 takes the length of the run, but for time in which steps err by
            next to nothing. Default 0.0.
        project: Move an inconsistent start onto the constraints however far away it is. Default False.
        filter_start: Filter the accelerations of the start by the stiffness, as fine meshes need, and let the
            scheme's own begin ahead of them, as its order needs; only a textbook comparison of the bare scheme wants
            them raw. Default True.
        max_iterations: Most Newton iterations of a step before it is repeated smaller; Radau IIA takes at most 10.
            Default 20.
        newton_tolerance: Newton tolerance as a fraction of the default; smaller is tighter. Default 1.0.
        stopping: When Newton's method stops. Default relative.
        scales: Makes the equations dimensionless before they are solved. With the `relative` stopping test that
            changes nothing but rounding.
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
        """How equilibria are found.

        steps: Number of load steps from t = 0 to the end of the run. Default 10.
        max_iterations: Most Newton iterations per equilibrium. Default 60.
        stable: Refuse equilibria that are unstable or folded, and look for the true one. Default True.
        tolerance: Tolerance of positions, relative to the reference length. Default 1e-09.
        """
        self._set("statics", {
            "steps": steps,
            "max_iterations": max_iterations,
            "stable": stable,
            "tolerance": tolerance,
        })
