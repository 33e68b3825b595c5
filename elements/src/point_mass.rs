//! A compact body at the end of a line.

use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::held::{Held, MOST};
use ropewalk_core::{
    Assembly, At, Attitude, BuildError, ContactPoint, DeadEntry, DeadLoad, DeadPull, Energy, Marker, Node,
    NodeId, NodeKind, Part, Pattern, Per, Power, Solid, Spot, Surface, Term, Timed, V3, dot,
};
use ropewalk_scene::{
    Builder, Current, ElementSpec, MarkerRef, Sea, Swell, ball_below, quantity, register_spec,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::sync::Arc;

/// A point mass on a node or at a point of a rigid body, with added mass and drag that are the same in all directions.
///
/// Use it for: sinkers, buoys, tow bodies, clump weights. Inertia is `(m + m_a) a` of its point, drag
/// `-½ ρ CdA |v - u| (v - u)`; on a body beside its centre of mass both turn it. Waves push with `(ρ V + m_a) Du/Dt`, the
/// acceleration of the water along its path (Taylor, 1928): what is as heavy as water goes with it. Weight and buoyancy are dead loads, see
/// [`DeadPull`]. As with added mass after Morison the water's kinetic energy isn't counted: added mass takes and gives
/// power.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMass {
    /// A name, such as `tow body`.
    pub label: String,
    /// Mass [kg].
    pub mass: f64,
    /// Added mass [kg].
    pub added_mass: f64,
    /// Density of the fluid [kg/m³].
    pub density: f64,
    /// Drag coefficient times area [m²].
    pub drag_area: f64,
    /// Velocity of the fluid.
    pub current: Current,
    /// Waves, whose velocity adds to it, and the volume that feels their pressure [m³].
    pub sea: Option<(Arc<Sea>, f64)>,
    /// The surface of the fluid, if it has one.
    pub surface: Option<Across>,
    /// Where it is.
    pub held: Held,
}

/// A ball that may lie across the surface of a fluid: drag and added mass go by the share of its volume below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    /// Height of the surface without waves [m].
    pub level: f64,
    /// Radius of the ball [m].
    pub radius: f64,
}

impl PointMass {
    /// A mass [kg] at a marker, in a vacuum.
    ///
    /// # Errors
    /// A marker without position; a negative or infinite mass.
    pub fn new(
        label: impl Into<String>,
        nodes: &[Node],
        marker: &Marker,
        mass: f64,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        not_negative(&format!("{label}: mass"), mass)?;
        let held = Held::new(nodes, marker, &label)?;
        let (added_mass, density, drag_area) = (0.0, 0.0, 0.0);
        Ok(PointMass {
            label,
            mass,
            added_mass,
            density,
            drag_area,
            current: Current::Still,
            sea: None,
            surface: None,
            held,
        })
    }

    /// Puts it into a fluid of this density [kg/m³]: added mass [kg], drag coefficient times area [m²], current.
    ///
    /// # Errors
    /// Negative or infinite numbers, a bad current.
    pub fn in_fluid(
        mut self,
        density: f64,
        added_mass: f64,
        drag_area: f64,
        current: Current,
    ) -> Result<Self, BuildError> {
        not_negative(&format!("{}: density of the fluid", self.label), density)?;
        not_negative(&format!("{}: added mass", self.label), added_mass)?;
        not_negative(&format!("{}: drag area", self.label), drag_area)?;
        current.check()?;
        (self.density, self.added_mass, self.drag_area, self.current) =
            (density, added_mass, drag_area, current);
        Ok(self)
    }

    /// Its weight less its buoyancy, `(m - ρ volume) gravity`, with the volume that it displaces [m³] and the vector of
    /// gravity [m/s²].
    ///
    /// # Errors
    /// A negative or infinite volume, a gravity that isn't finite.
    pub fn weight(&self, volume: f64, gravity: V3<f64>) -> Result<DeadPull, BuildError> {
        not_negative(&format!("{}: volume", self.label), volume)?;
        ropewalk_core::error::finite("gravity", &gravity)?;
        let heavy = self.mass - self.density * volume;
        Ok(DeadPull {
            label: format!("{}: weight", self.label),
            held: self.held,
            force: gravity.map(|g| heavy * g),
        })
    }

    /// Where its velocity begins, if inertia in space is all that it has.
    fn plain(&self) -> Option<usize> {
        let dry = self.added_mass == 0.0 && self.drag_area == 0.0 && self.sea.is_none();
        match self.held {
            Held::Moves { v, .. } if dry => Some(v),
            _ => None,
        }
    }

    /// The waves at its place.
    fn swell(&self, at: &At<'_>) -> Option<Swell<f64>> {
        self.sea.as_ref().map(|(sea, _)| sea.at(at.t, &self.held.x(at)))
    }

    /// The share of it in the fluid, and what it changes by with height [1/m].
    fn share(&self, at: &At<'_>, swell: Option<&Swell<f64>>) -> (f64, f64) {
        let z = self.held.x(at)[2] - swell.map_or(0.0, |swell| swell.top.elevation);
        self.surface.map_or((1.0, 0.0), |s| ball_below(s.level, z, s.radius))
    }

    /// Velocity relative to the water, its magnitude, the current's gradient, and `½ ρ CdA`.
    fn flow(&self, at: &At<'_>, swell: Option<&Swell<f64>>) -> (V3<f64>, f64, V3<f64>, f64) {
        let (u, du) = self.current.at(self.held.x(at)[2]);
        let own = self.held.velocity(at);
        let mut v: V3<f64> = std::array::from_fn(|i| own[i] - u[i]);
        if let Some(swell) = swell {
            (0..3).for_each(|i| v[i] -= swell.u[i]);
        }
        (v, dot(&v, &v).sqrt(), du, 0.5 * self.density * self.drag_area)
    }

    /// The force of waves if all of it is in the water, and what that changes by with the place, but for the change of the
    /// gradient of velocity.
    fn pushed(&self, at: &At<'_>, swell: Option<&Swell<f64>>) -> (V3<f64>, [V3<f64>; 3]) {
        let (Some(swell), Some((_, volume))) = (swell, &self.sea) else { return ([0.0; 3], [[0.0; 3]; 3]) };
        let mass = self.density * volume + self.added_mass;
        let (a, mut by_x, by_z) = swell.along_path(&self.current, self.held.x(at)[2]);
        (0..3).for_each(|i| by_x[i][2] += by_z[i]);
        (a.map(|a| mass * a), by_x.map(|row| row.map(|x| mass * x)))
    }
}

impl Term for PointMass {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.held.dofs());
    }
    fn symmetric(&self) -> bool {
        // the inertia of what turns with a body isn't
        let turns = matches!(self.held, Held::Beside { .. } | Held::Lever { .. });
        let drags = self.density * self.drag_area > 0.0;
        let emerges = self.surface.is_some() && (drags || self.added_mass > 0.0);
        !turns && !emerges && self.sea.is_none() && (self.current.is_uniform() || !drags)
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        if let Some(v) = self.plain() {
            (v..v + 3).for_each(|i| out.add(i, self.mass * at.a[i]));
            if out.wants_tangent() {
                let mass = out.weights().a * self.mass;
                out.add_block(0, 3, |i, j| if i == j { mass } else { 0.0 });
            }
            return;
        }
        let swell = self.swell(at);
        let (v, speed, du, whole) = self.flow(at, swell.as_ref());
        let (share, by_z) = self.share(at, swell.as_ref());
        let (pushed, pushed_by) = self.pushed(at, swell.as_ref());
        let (inertia, c) = (self.mass + share * self.added_mass, share * whole);
        let (motion, swing) = (self.held.motion(at), self.held.acceleration(at));
        let mut force: V3<f64> = std::array::from_fn(|i| inertia * swing.a[i] + c * speed * v[i]);
        if swell.is_some() {
            (0..3).for_each(|i| force[i] -= share * pushed[i]);
        }
        for k in 0..motion.n {
            out.add(motion.dof[k], motion.carry(k, &force));
        }
        if !out.wants_tangent() {
            return;
        }
        let w = out.weights();
        let inverse = if speed > 0.0 { 1.0 / speed } else { 0.0 };
        let damping = |x: &V3<f64>| -> V3<f64> {
            let along = dot(&v, x) * inverse;
            std::array::from_fn(|i| c * (speed * x[i] + v[i] * along))
        };
        let shear = damping(&du);
        // what more of it in the fluid adds
        let mut met: V3<f64> =
            std::array::from_fn(|i| by_z * (self.added_mass * swing.a[i] + whole * speed * v[i]));
        (0..3).for_each(|i| met[i] -= by_z * pushed[i]);
        // what waves change by from place to place
        let waves = |x: &V3<f64>| -> V3<f64> {
            let Some(swell) = &swell else { return [0.0; 3] };
            let drag = damping(&swell.by_x.map(|row| dot(&row, x)));
            let risen = swell.top.slope[0] * x[0] + swell.top.slope[1] * x[1];
            std::array::from_fn(|i| -drag[i] - share * dot(&pushed_by[i], x) - met[i] * risen)
        };
        let by: [V3<f64>; MOST] = std::array::from_fn(|k| {
            let (x, turn) = (&motion.by_q[k], damping(&motion.v_by_q[k]));
            let (rate, waved) = (damping(x), waves(x));
            std::array::from_fn(|i| {
                w.a * inertia * x[i]
                    + w.v * (rate[i] + inertia * swing.by_v[k][i])
                    + w.q * (turn[i] + inertia * swing.by_q[k][i] + (met[i] - shear[i]) * x[2])
                    + w.q * waved[i]
            })
        });
        // the force stays in space while the body turns under it
        let turning = motion.second(&force);
        out.add_block(0, motion.n, |i, j| {
            let turn = turning.filter(|_| i >= 3 && j >= 3).map_or(0.0, |t| t[i - 3][j - 3]);
            motion.carry(i, &by[j]) + w.q * turn
        });
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let v = self.held.velocity(at);
        Energy { kinetic: 0.5 * self.mass * dot(&v, &v), ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        if self.plain().is_some() {
            return Power::default();
        }
        let swell = self.swell(at);
        let (relative, speed, _, whole) = self.flow(at, swell.as_ref());
        let share = self.share(at, swell.as_ref()).0;
        let pushed = self.pushed(at, swell.as_ref()).0;
        let c = share * whole;
        let (v, a) = (self.held.velocity(at), self.held.acceleration(at).a);
        let dissipated = c * speed * speed * speed;
        // drag gives f·v in all, of which the current brings in f·u = f·v + dissipated
        let drag = -c * speed * dot(&relative, &v);
        Power {
            dissipated,
            supplied: drag + dissipated - share * self.added_mass * dot(&a, &v) + share * dot(&pushed, &v),
            carried: 0.0,
        }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        self.sea.as_ref().map(|_| self as &dyn Timed)
    }
}

impl Timed for PointMass {
    fn reach(&self, _t: f64, h: f64) -> Option<f64> {
        Some(self.sea.as_ref().map_or(h, |(sea, _)| sea.reach(h)))
    }
    fn period(&self, _t: f64) -> f64 {
        self.sea.as_ref().map_or(f64::INFINITY, |(sea, _)| sea.period())
    }
}

/// A compact body: a sinker, a buoy, the load at the end of a hose.
///
/// On a cable it belongs to the node; at a point of a body or link it moves and turns with the body; with a position
/// it is a free point. Marker: `name`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointMassSpec {
    /// Name; the rest of the scene refers to the part by it.
    pub name: String,
    /// Marker of an earlier element that carries it, such as `"hose.end"`, or its initial position [m].
    pub marker: MarkerRef,
    /// Mass [kg].
    #[serde(deserialize_with = "quantity::mass")]
    pub mass: f64,
    /// Displaced volume, for buoyancy and the pressure of waves [m³].
    #[serde(default, deserialize_with = "quantity::volume")]
    pub volume: f64,
    /// Added mass in water, the same in all directions [kg].
    #[serde(default, deserialize_with = "quantity::mass")]
    pub added_mass: f64,
    /// Drag coefficient times area [m²].
    #[serde(default, deserialize_with = "quantity::area")]
    pub drag_area: f64,
    /// Initial velocity, of a free point only [m/s].
    #[serde(default, deserialize_with = "quantity::vec3::speed")]
    pub velocity: V3<f64>,
}
register_spec!(Element, "point_mass", PointMassSpec);

impl PointMassSpec {
    /// A mass at a marker or a point.
    pub fn new(name: &str, marker: impl Into<MarkerRef>, mass: f64) -> Self {
        PointMassSpec {
            name: name.into(),
            marker: marker.into(),
            mass,
            volume: 0.0,
            added_mass: 0.0,
            drag_area: 0.0,
            velocity: [0.0; 3],
        }
    }
}

impl PointMassSpec {
    /// What water does to it.
    fn as_ball(&self) -> Ball {
        Ball { volume: self.volume, added_mass: self.added_mass, drag_area: self.drag_area }
    }
}

/// A compact body as the water meets it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    /// Displaced volume [m³].
    pub volume: f64,
    /// Added mass [kg].
    pub added_mass: f64,
    /// Drag coefficient times area [m²].
    pub drag_area: f64,
}

impl Ball {
    /// The term of a mass [kg] at a marker with what the water of the scene does to it; `None` if that is nothing.
    pub(crate) fn in_water(
        &self,
        b: &Builder,
        label: String,
        marker: &Marker,
        mass: f64,
    ) -> Result<Option<PointMass>, BuildError> {
        let waves = self.volume > 0.0 && b.water().is_ok_and(|water| water.sea.is_some());
        if !(self.added_mass > 0.0 || self.drag_area > 0.0 || waves) {
            return Ok(None);
        }
        let water = b.water()?.clone();
        let mut ball = PointMass::new(label, b.nodes(), marker, mass)?.in_fluid(
            water.density,
            self.added_mass,
            self.drag_area,
            water.current()?,
        )?;
        ball.sea = water.sea.clone().map(|sea| (sea, self.volume));
        ball.surface = water.level.map(|level| Across { level, radius: self.radius(water.density) });
        Ok(Some(ball))
    }

    /// The radius of the ball that displaces its volume, or else has its drag area, or its added mass of half a ball of
    /// fluid.
    fn radius(&self, density: f64) -> f64 {
        let of = |volume: f64| (0.75 * volume / PI).cbrt();
        match (self.volume, self.drag_area) {
            (volume, _) if volume > 0.0 => of(volume),
            (_, area) if area > 0.0 => (area / PI).sqrt(),
            _ => of(2.0 * self.added_mass / density),
        }
    }
}

#[typetag::serde(name = "point_mass")]
impl ElementSpec for PointMassSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        positive("mass", self.mass)?;
        for (name, x) in
            [("volume", self.volume), ("added_mass", self.added_mass), ("drag_area", self.drag_area)]
        {
            not_negative(name, x)?;
        }
        finite("velocity", &self.velocity)?;
        let (marker, own) = match &self.marker {
            MarkerRef::Point(x) => (Marker::node(b.node(NodeKind::Point, x, &self.velocity)?), true),
            MarkerRef::Name(_) if self.velocity != [0.0; 3] => {
                return Err(BuildError::at(
                    "velocity",
                    "a mass on a marker moves with it: leave `velocity` out",
                ));
            }
            name @ MarkerRef::Name(_) => (b.marker("marker", name)?, false),
        };
        let Some(node) = marker.on() else {
            return Err(BuildError::at("marker", "a mass needs a marker on a part, or a position"));
        };
        let mass = match self.as_ball().in_water(b, self.name.clone(), &marker, self.mass)? {
            Some(mass) => mass,
            None => PointMass::new(&self.name, b.nodes(), &marker, self.mass)?,
        };
        let (seat, held) = (b.nodes()[node.0 as usize], mass.held);
        b.term(Box::new(mass));
        b.part(Arc::new(Body { spec: self.clone(), marker, held, node, own, q: seat.q, v: seat.v }))
    }
}

/// A point mass as a part of a model.
struct Body {
    spec: PointMassSpec,
    marker: Marker,
    held: Held,
    node: NodeId,
    /// Whether the node is its own.
    own: bool,
    q: usize,
    v: usize,
}

impl Part for Body {
    fn name(&self) -> &str {
        &self.spec.name
    }
    fn kind(&self) -> &'static str {
        "point_mass"
    }
    fn mass(&self) -> f64 {
        self.spec.mass
    }
    fn marker(&self, spot: &Spot) -> Result<Marker, String> {
        match spot {
            Spot::Named(n) if n.is_empty() => Ok(self.marker),
            _ => Err(format!("a point mass has only one place: `{}`", self.spec.name)),
        }
    }
    fn contact_points(&self) -> Vec<ContactPoint> {
        vec![ContactPoint { held: self.held, radius: 0.0 }]
    }
    fn dead_load(&self, per: Per, load: V3<f64>) -> Option<Box<dyn Term>> {
        let (what, amount) = match per {
            Per::Mass => ("weight", self.spec.mass),
            Per::Volume => ("buoyancy", self.spec.volume),
        };
        if amount == 0.0 {
            return None;
        }
        let (label, force) = (format!("{}: {what}", self.spec.name), load.map(|x| amount * x));
        match self.held {
            // on a node of its own it is constant
            Held::Moves { q, v } => {
                let entries = (0..3)
                    .filter(|&i| force[i] != 0.0)
                    .map(|i| DeadEntry { dof: v + i, coordinate: q + i, value: force[i] })
                    .collect();
                DeadLoad::new(label, entries).ok().map(|load| Box::new(load) as Box<dyn Term>)
            }
            held => Some(Box::new(DeadPull { label, held, force })),
        }
    }
    fn ball(&self) -> Option<(Held, f64)> {
        Some((self.held, self.spec.volume))
    }
    fn point(&self, _: f64, at: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        Some((self.held.x(at), self.held.velocity(at)))
    }
    fn attitude(&self, at: &At<'_>) -> Option<Attitude> {
        Some(Attitude { x: self.held.x(at), turn: [1.0, 0.0, 0.0, 0.0] })
    }
    /// The ball that displaces its volume, or has its drag area.
    fn solids(&self) -> Vec<Solid> {
        let radius = self.spec.as_ball().radius(0.0);
        if !(radius > 0.0 && radius.is_finite()) {
            return Vec::new();
        }
        let (surface, seat) =
            (Surface::Ball { radius }, Attitude { x: [0.0; 3], turn: [1.0, 0.0, 0.0, 0.0] });
        vec![Solid { name: self.spec.name.clone(), surface, carrier: None, seat }]
    }
    fn length(&self) -> f64 {
        0.0
    }
    fn place_of(&self, node: NodeId) -> Option<String> {
        (self.own && node == self.node).then(String::new)
    }
    fn seats(&self) -> Vec<(usize, usize)> {
        if self.own { vec![(self.q, self.v)] } else { Vec::new() }
    }
    fn carry(&self, nodes: &[Node], old: &dyn Part, at: &At<'_>, q: &mut [f64], v: &mut [f64]) {
        if let (true, Some((x, dx))) = (self.own, old.point(0.0, at)) {
            let node = &nodes[self.node.0 as usize];
            q[node.q..node.q + 3].copy_from_slice(&x);
            v[node.v..node.v + 3].copy_from_slice(&dx);
        }
    }
}
