//! `type = "drum"`: what a scene says about a drum on which a cable is wound.

use super::events::{Watch, What};
use super::layers::{self, Layers};
use super::locked::{Locked, Loosens};
use super::shaft::{Drive, Free, Shaft};
use super::torsion::Untwists;
use super::winding::{Winding, Winds};
use crate::check::unit;
use crate::reeving::events::Short;
use crate::reeving::fleet::Fleet;
use crate::reeving::seat::Seat;
use crate::reeving::tangent;
use crate::winch::{self, WinchSpec, resisting};
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::model::twist::section;
use ropewalk_core::rotation::{around, cross};
use ropewalk_core::{BuildError, Marker, Motion, Moving, NodeKind, Solid, V3, dot};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Builder, ConstraintSpec, Guide, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Turns that stay on a drum when it is empty.
const DEAD: f64 = 3.0;

/// A drum on which an end of a cable is wound that names it in its `route`.
///
/// The cable leaves it as a tangent, wherever it goes to, and is wound without slip. The drum pays out as it turns by the
/// right-hand rule about its `axis`; so about [0, 1, 0] it leaves from the top towards x. Its `speed` or angle is prescribed,
/// or it is turned by `torque`, its cable and `brake`. What is wound keeps the stretch with which it was wound, and the twist.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrumSpec {
    /// Name; routes and records refer to it.
    pub name: String,
    /// Its middle: a point in space, or of a rigid body, which stands above the cable in the scene.
    pub marker: MarkerRef,
    /// Axis in space at the start; it turns with what carries the drum. Turning about it by the right-hand rule pays out.
    pub axis: V3<f64>,
    /// Radius of the first layer, to the middle of the cable [m].
    #[serde(deserialize_with = "quantity::length")]
    pub radius: f64,
    /// Rope speed on the layer of the start, after the ramp [m/s]; negative reels in. The drum turns so; a load that swings
    /// makes no slip. Of an input: the speed itself, without ramp, so the input needs `join = "linear"`.
    #[serde(
        default,
        deserialize_with = "quantity::setting::optional::speed",
        skip_serializing_if = "Option::is_none"
    )]
    pub speed: Option<Setting>,
    /// Start time [s].
    #[serde(default, deserialize_with = "quantity::time", skip_serializing_if = "is_nought")]
    pub start: f64,
    /// Time in which the speed rises, and falls again at the stop [s].
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub ramp: f64,
    /// Time at which the speed begins to fall again [s]. Default: never.
    #[serde(default, deserialize_with = "quantity::optional::time", skip_serializing_if = "Option::is_none")]
    pub stop: Option<f64>,
    /// Length paid out when it stops [m], with the sign of the speed, instead of `stop`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub payout: Option<f64>,
    /// Name of a motion whose x component is the angle of the drum [rad], instead of `speed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn: Option<String>,
    /// Moment of its motor, if the speed isn't prescribed, positive where it pays out [N m].
    #[serde(
        default,
        deserialize_with = "quantity::setting::optional::moment",
        skip_serializing_if = "Option::is_none"
    )]
    pub torque: Option<Setting>,
    /// Moment of its brake, dry friction [N m].
    #[serde(default, deserialize_with = "quantity::setting::moment", skip_serializing_if = "is_none")]
    pub brake: Setting,
    /// Speed of the cable below which the brake creeps instead of sticking [m/s].
    #[serde(default = "slip_speed", deserialize_with = "quantity::speed")]
    pub slip_speed: f64,
    /// Moment by angular velocity [N m s/rad].
    #[serde(default, deserialize_with = "quantity::rotational_damping", skip_serializing_if = "is_nought")]
    pub damping: f64,
    /// Moment of inertia about its axis, without cable: that of `wound` is added. Its mass, with the cable on it, belongs to
    /// what carries it [kg m²].
    #[serde(default, deserialize_with = "quantity::inertia", skip_serializing_if = "is_nought")]
    pub inertia: f64,
    /// Length of cable on it at the start, as it lies [m]. The run ends when 3 turns are left. Default: unlimited, and
    /// without inertia.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub wound: Option<f64>,
    /// Tension with which that was wound [N], which tells its stretch; what is wound later keeps the tension that it has then.
    /// Default: the tension at the start, of the equilibrium if the run begins with one, or else at which the cable is laid.
    #[serde(
        default,
        deserialize_with = "quantity::optional::force",
        skip_serializing_if = "Option::is_none"
    )]
    pub wound_tension: Option<f64>,
    /// Way of the cable along the axis in a turn [m]; usually its diameter. It winds towards the axis first. Default: none,
    /// as behind a device that keeps it in the middle.
    #[serde(default, deserialize_with = "quantity::length", skip_serializing_if = "is_nought")]
    pub pitch: f64,
    /// Width between the flanges [m]: the cable is wound in layers. Goes with `pitch` and `wound`. Default: one layer of any
    /// width, which begins at `marker`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub width: Option<f64>,
    /// Height of a layer on the one below [m]. Default: 0.866 `pitch`, that of cables that lie in the grooves of the layer
    /// below.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub layer_height: Option<f64>,
    /// Number of layers; the run ends when they are full. Default: any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layers: Option<usize>,
    /// Angle against the plane of the drum from which on a cable winds badly, which is said once [rad].
    #[serde(default = "fleet", deserialize_with = "quantity::angle")]
    pub fleet: f64,
}
register_spec!(Constraint, "drum", DrumSpec);

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}
fn is_none(x: &Setting) -> bool {
    x.is(0.0)
}
fn ramp() -> f64 {
    1.0
}
fn slip_speed() -> f64 {
    1e-3
}
fn fleet() -> f64 {
    1.5_f64.to_radians()
}

/// The name of its equations.
pub(super) fn rope(drum: &str) -> String {
    format!("{drum}.rope")
}

/// A motion whose first component is divided by a radius.
#[derive(Clone, Debug)]
struct Geared {
    motion: Arc<dyn Motion>,
    radius: f64,
}

impl Motion for Geared {
    fn at(&self, t: f64) -> Moving {
        let now = self.motion.at(t);
        let by = |x: V3<f64>| [x[0] / self.radius, 0.0, 0.0];
        Moving { x: by(now.x), v: by(now.v), a: by(now.a) }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.motion.reach(t, h)
    }
    fn period(&self, t: f64) -> f64 {
        self.motion.period(t)
    }
    fn range(&self) -> (f64, f64) {
        self.motion.range()
    }
}

impl DrumSpec {
    fn helix(&self) -> Layers {
        let rise = self.layer_height.unwrap_or(0.75_f64.sqrt() * self.pitch);
        Layers { radius: self.radius, pitch: self.pitch, rise, turns: self.width.map(|w| w / self.pitch) }
    }

    /// Angle wound at the start.
    fn angle(&self) -> f64 {
        self.helix().angle(self.wound.unwrap_or(0.0))
    }

    /// How far the marker is from where the cable is wound at the start, if nothing ends that.
    fn beside(&self) -> f64 {
        if self.width.is_some() { self.helix().at(self.angle()).x } else { 0.0 }
    }

    fn check(&self) -> Result<(), BuildError> {
        positive("radius", self.radius)?;
        unit("axis", self.axis)?;
        not_negative("inertia", self.inertia)?;
        not_negative("damping", self.damping)?;
        positive("slip_speed", self.slip_speed)?;
        not_negative("wound_tension", self.wound_tension.unwrap_or(0.0))?;
        not_negative("layer_height", self.layer_height.unwrap_or(0.0))?;
        positive("fleet", self.fleet)?;
        finite("pitch", &[self.pitch])?;
        positive("wound", self.wound.unwrap_or(1.0))?;
        let turns = self.width.map_or(1.0, |w| w / self.pitch);
        let free = self.torque.is_some() || !self.brake.is(0.0) || self.damping > 0.0 || self.inertia > 0.0;
        let given = self.speed.is_some() || self.turn.is_some();
        let wrong = [
            ("turn", self.speed.is_some() && self.turn.is_some(), "give `speed` or `turn`, not both"),
            (
                if self.torque.is_some() { "torque" } else { "speed" },
                given && free,
                "how this drum turns is prescribed, so its moment is a result: leave out `torque`, `brake`, `damping` and \
                 `inertia`, or `speed` and `turn`",
            ),
            (
                "name",
                !given && !free,
                "a drum needs `speed` or `turn`, or what turns and resists: `torque`, `brake`, `damping`, `inertia`. \
                 `speed = 0` locks it",
            ),
            (
                if self.stop.is_some() { "stop" } else { "payout" },
                self.speed.is_none() && (self.stop.is_some() || self.payout.is_some()),
                "it says when a `speed` ends, and this drum has none",
            ),
            (
                "width",
                self.width.is_some() && !(turns >= 1.0 && turns.is_finite()),
                "a layer has at least one turn: give the `pitch`, usually the diameter of the cable, and a `width` above it",
            ),
            (
                "width",
                self.width.is_some() && self.wound.is_none(),
                "in which layer it begins follows from the length of cable on it: give `wound`",
            ),
            (
                "layers",
                self.layers.is_some() && self.width.is_none(),
                "layers end at flanges: give the `width` between them",
            ),
            ("layers", self.layers == Some(0), "a drum has at least one layer"),
        ];
        if let Some((field, _, message)) = wrong.into_iter().find(|(_, is, _)| *is) {
            return Err(BuildError::at(field, message));
        }
        if self.wound.is_some() {
            let angle = self.angle();
            if angle <= DEAD * TAU {
                let least = self.helix().at(DEAD * TAU).length;
                let message = format!(
                    "{DEAD} turns stay on an empty drum, {least:.3} m: it needs more on it at the start"
                );
                return Err(BuildError::at("wound", message));
            }
            let number = self.helix().number(angle) + 1.0;
            if number >= layers::MOST || self.layers.is_some_and(|most| number > most as f64) {
                let message = format!("this length lies in {number} layers, which the drum doesn't have");
                return Err(BuildError::at("wound", message));
            }
        }
        Ok(())
    }

    /// The angle of the drum in time, if it is prescribed.
    fn given(&self, b: &Builder, radius: f64) -> Result<Option<Arc<dyn Motion>>, BuildError> {
        let (field, motion) = match (&self.speed, &self.turn) {
            (None, None) => return Ok(None),
            (_, Some(turn)) => ("turn", b.motion(turn).map_err(|e| e.of("turn"))?),
            (Some(_), None) => {
                let winch = WinchSpec {
                    speed: self.speed.clone(),
                    start: self.start,
                    ramp: self.ramp,
                    stop: self.stop,
                    payout: self.payout,
                    ..WinchSpec::new(&self.name, self.marker.clone())
                };
                match winch.drive(b, 0.0)? {
                    winch::Drive::Motion(motion) => {
                        ("speed", Arc::new(Geared { motion, radius }) as Arc<dyn Motion>)
                    }
                    winch::Drive::Held => return Ok(None),
                }
            }
        };
        let start = motion.at(0.0);
        if start.x[0] != 0.0 || start.v[0] != 0.0 {
            let message = "a drum starts at rest and at the angle 0: let its speed rise from 0";
            return Err(BuildError::at(field, message));
        }
        Ok(Some(motion))
    }
}

#[typetag::serde(name = "drum")]
impl ConstraintSpec for DrumSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn guides(&self) -> Vec<Guide> {
        // what is wrong with its numbers is said when it is built
        let sound = self.check().is_ok();
        let angle = if sound { self.angle() } else { 0.0 };
        vec![Guide {
            name: self.name.clone(),
            marker: self.marker.clone(),
            beside: if sound { self.beside() } else { 0.0 },
            axis: self.axis,
            radius: if sound { self.helix().at(angle).radius } else { self.radius },
            turns: 0.0,
            winds: true,
        }]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        self.check()?;
        let windings = b.windings(&self.name);
        let [end] = windings.as_slice() else {
            let message = match windings.len() {
                0 => format!(
                    "no cable is wound on `{0}`: let the `route` of one begin or end with `{{ wound = \"{0}\" }}`",
                    self.name
                ),
                n => format!("{n} cables are wound on `{}`: give each a drum of its own", self.name),
            };
            return Err(BuildError::at("name", message));
        };
        let axis = unit("axis", self.axis)?;
        let (helix, wound, boundary) = (self.helix(), self.angle(), end.boundary);
        let lies = helix.at(wound);
        let marker = end.marker.with_axes(b.nodes(), b.coordinates(), around(axis));
        let (on, own) = match &marker {
            Marker::Ground { axes, .. } => (None, axes[2]),
            Marker::Node { node, axes, .. } => {
                let n = b.nodes()[node.0 as usize];
                match n.kind {
                    NodeKind::Frame => (Some((n.q, n.v)), axes[2]),
                    NodeKind::Point => (None, axes[2]),
                    _ => {
                        let message = "a drum is on a rigid body, or at a point in space";
                        return Err(BuildError::at("marker", message));
                    }
                }
            }
        };
        let start = b.place(&marker);
        let foot = b.place(&Marker::node(boundary.end)).x;
        let d: V3<f64> = std::array::from_fn(|i| foot[i] - start.x[i]);
        let [x, _, z] = start.axes;
        let phi = dot(&d, &cross(&z, &x)).atan2(dot(&d, &x));
        let strand = end.strand;
        let stretch = self.wound_tension.map_or(end.stretch, |tension| 1.0 + tension / strand.ea);
        let memory = b.memory(&format!("{}: stretch", self.name), Locked::memory());
        let locked = Locked::new(memory, stretch, PI * self.radius);
        let motion = self.given(b, lies.radius)?;
        let mut markers = vec![tangent::end(b.nodes(), boundary.end), marker, Marker::node(boundary.node)];
        let drive = match &motion {
            Some(motion) => Drive::Given(motion.clone()),
            None => {
                let none = Setting::Number(0.0);
                let torque = b.signal("torque", self.torque.as_ref().unwrap_or(&none), &kind::MOMENT)?;
                let brake = resisting("brake", b.signal("brake", &self.brake, &kind::MOMENT)?)?;
                let node = b.node(NodeKind::Scalars(1), &[0.0], &[0.0])?;
                b.share(node);
                markers.push(Marker::node(node));
                let n = b.nodes()[node.0 as usize];
                Drive::Free(Free {
                    place: (n.q, n.v),
                    inertia: self.inertia,
                    torque,
                    brake,
                    creep: self.slip_speed / lies.radius,
                    damping: self.damping,
                })
            }
        };
        let winding = Winding {
            // one layer of any width begins at the marker
            offset: if self.width.is_some() { 0.0 } else { lies.x },
            layers: helix,
            wound,
            phi,
            home: boundary.home,
            sign: boundary.sign,
            locked,
            motion,
            twist: self.twist(b, end, start.axes[2], d)?,
        };
        let twist = winding.twist;
        b.constraint(Winds::new(rope(&self.name), winding, markers))?;
        let seat = Seat::new(b.nodes(), &marker)?;
        b.term(Box::new(Fleet { name: self.name.clone(), boundary, seat, strand, mode: None }));
        b.term(Box::new(Loosens {
            name: self.name.clone(),
            boundary,
            locked,
            ea: strand.ea,
            settles: self.wound_tension.is_none(),
        }));
        if let (Some((_, locked)), Some(torsion)) = (twist, strand.torsion) {
            let span = b.parts(std::slice::from_ref(&end.span))?[0].1.clone();
            b.term(Box::new(Untwists { name: self.name.clone(), boundary, span, locked, torsion }));
        }
        let shaft = Shaft {
            name: self.name.clone(),
            boundary,
            layers: helix,
            wound,
            locked,
            mass: if self.wound.is_some() { strand.mass } else { 0.0 },
            on,
            axis: own,
            drive,
            solid: self.drawn(&marker, b),
        };
        let shared = Arc::new(shaft.clone());
        let empty = self.wound.map(|_| What::Empty(DEAD * TAU));
        let full = self.layers.zip(helix.turns).map(|(n, turns)| What::Full(TAU * turns * n as f64));
        for what in [empty, full, Some(What::Fleet(self.fleet))].into_iter().flatten() {
            b.event(Watch { what, drum: shared.clone() });
        }
        let free = b.parts(std::slice::from_ref(&end.span))?[0].1.length();
        b.event(Short {
            span: end.span.clone(),
            length: (0.05 * free).max(0.5 * self.radius).min(0.5 * free),
        });
        b.term(Box::new(shaft));
        Ok(())
    }
}

impl DrumSpec {
    /// How the section of a cable with torsion stands to the drum at its tangent point `d` from the middle, and the twist of what
    /// is wound.
    fn twist(
        &self,
        b: &mut Builder,
        end: &ropewalk_scene::Winding,
        axis: V3<f64>,
        d: V3<f64>,
    ) -> Result<Option<(f64, Locked)>, BuildError> {
        if end.strand.torsion.is_none() {
            return Ok(None);
        }
        let beside = dot(&d, &axis);
        let flat: V3<f64> = std::array::from_fn(|i| d[i] - beside * axis[i]);
        let own = section(&b.coordinates()[end.boundary.end_q..end.boundary.end_q + 10]);
        let seen = |c: usize| (0..3).map(|i| flat[i] * own[i][c]).sum::<f64>();
        let memory = b.memory(&format!("{}: twist", self.name), Locked::memory());
        Ok(Some((seen(0).atan2(seen(1)), Locked::new(memory, end.twist, PI * self.radius))))
    }

    /// What it looks like: a cylinder up to the middle of the first layer.
    fn drawn(&self, marker: &Marker, b: &Builder) -> Solid {
        let (carrier, point, axis) = match marker {
            Marker::Ground { point, axes } => (None, *point, axes[2]),
            Marker::Node { node, point, axes } => (Some(b.nodes()[node.0 as usize].q), *point, axes[2]),
        };
        let half = 0.5 * self.width.unwrap_or(self.radius);
        let ends = [-half, half].map(|x| std::array::from_fn(|i| point[i] + x * axis[i]));
        Solid::between(&self.name, carrier, ends, 2.0 * self.radius)
    }
}
