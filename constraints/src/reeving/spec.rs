//! `type = "sheave"`: what a scene says about a wheel that cables run over.

use super::arc::{Arc, Grip};
use super::at_rest::Sliding;
use super::events::{Short, Watch, What};
use super::fleet::Fleet;
use super::hold::Hold;
use super::piece::Stiff;
use super::seat::Seat;
use super::sheave::{Angle, Groove, Sheave};
use super::torsion::{self, ArcTorsion, Rolls};
use super::turns::Unwound;
use super::twist::Twist;
use crate::check::unit;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::rotation::around;
use ropewalk_core::{BuildError, Marker, NodeKind, Signal, Solid, V3, dot};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Builder, ConstraintSpec, Guide, MarkerRef, Passage, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// More wheels than any block has.
const MOST: usize = 100;

/// A sheave: a wheel over which cables run that name it in their `route`.
///
/// The cable is tangent to it on both sides, wherever it comes from and goes to; what lies on it stretches, has mass and
/// weight. Without friction the tension is the same on both sides, but for what weight and acceleration of the piece on the
/// wheel do. With `friction` the cable sticks, creeps and slips on the groove by the capstan equation, and turns a wheel with
/// `inertia`. With `inertia` or `bearing` alone the wheel turns with the cable. `efficiency` is for tables of cranes.
///
/// A cable may lift off from the wheel and come down on it again, which is told, but for one of several `turns`; what an impact
/// takes counts in the balance of energy as a change of mesh.
///
/// A cable with torsion (`section.gj`) rolls freely in the groove: its torque is the same before and behind, and its twist runs over the
/// wheel with it. With `fleet_twist` one that comes from the side is twisted as it rolls down the flank of the groove.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SheaveSpec {
    /// Name; routes and records refer to it.
    pub name: String,
    /// Its centre: a point in space, or of a rigid body, which stands above the cable in the scene.
    pub marker: MarkerRef,
    /// Axis in space at the start; it turns with what carries the sheave. `round` goes about it by the right-hand rule;
    /// for `over` and `under` its sign doesn't matter.
    pub axis: V3<f64>,
    /// Radius to the middle of the cable: that of the groove and half a diameter of the cable [m].
    #[serde(deserialize_with = "quantity::length")]
    pub radius: f64,
    /// Number of sheaves side by side on one axle; routes name them `NAME.1`, `NAME.2`, …
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Distance from each of them to the next, along the axis [m].
    #[serde(default, deserialize_with = "quantity::length", skip_serializing_if = "is_nought")]
    pub spacing: f64,
    /// Coefficient of friction between cable and groove, in a V-groove divided by the sine of half its angle. Needs
    /// `inertia`, or `locked`. Default: none.
    #[serde(
        default,
        deserialize_with = "quantity::optional::number",
        skip_serializing_if = "Option::is_none"
    )]
    pub friction: Option<f64>,
    /// Moment of inertia of the wheel about its axis; its mass belongs to what carries it [kg m²].
    #[serde(default, deserialize_with = "quantity::inertia", skip_serializing_if = "is_nought")]
    pub inertia: f64,
    /// Whether the wheel can't turn, such as a bollard or a worn-out sheave. Goes with `friction`.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub locked: bool,
    /// Ratio of the tensions before and behind it that half a turn leaves, from 0 to 1: friction of the bearing and
    /// stiffness of the cable together, as in tables of cranes; typically 0.98 on roller bearings. Instead of the other
    /// ways to lose power.
    #[serde(
        default,
        deserialize_with = "quantity::optional::number",
        skip_serializing_if = "Option::is_none"
    )]
    pub efficiency: Option<f64>,
    /// What resists the spin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bearing: Option<BearingSpec>,
    /// Moment that drives a wheel with `friction` and `inertia`, about its axis [N m].
    #[serde(default, deserialize_with = "quantity::setting::moment", skip_serializing_if = "is_no_torque")]
    pub torque: Setting,
    /// Speed of sliding below which friction fades, so that a held cable creeps at a part of it [m/s].
    #[serde(default = "slip_speed", deserialize_with = "quantity::speed")]
    pub slip_speed: f64,
    /// Whole turns of the cable about it, besides the angle by which it turns there, as on a capstan or a bollard. They lie
    /// side by side, and are taken to come and go in one plane. The wrap may then become any angle. Default: none; a
    /// cable that wraps all round ends the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turns: Option<u32>,
    /// Share of pure rolling by which a cable that comes to its groove by a fleet angle `δ` is twisted as it goes down the flank
    /// to the bottom, from 0 to 1: `sin δ/(π diameter)` turns per length at 1, as long as friction on the flank holds its torque. For
    /// cables with `gj` and a `diameter`. Default: 0, the fleet angle doesn't twist it.
    #[serde(default, deserialize_with = "quantity::number", skip_serializing_if = "is_nought")]
    pub fleet_twist: f64,
    /// Coefficient of friction on the flank, for `fleet_twist`: the torque that twists it is at most this times the tension,
    /// `sin δ` and half the diameter. Default: `friction`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::number",
        skip_serializing_if = "Option::is_none"
    )]
    pub flank_friction: Option<f64>,
    /// What friction does at equilibria, which aren't unique with it.
    #[serde(default, skip_serializing_if = "Sliding::is_none")]
    pub equilibrium: Sliding,
}
register_spec!(Constraint, "sheave", SheaveSpec);

/// Friction of a bearing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BearingSpec {
    /// Coefficient of friction on its own radius, by the force of the cable on the axle.
    #[serde(default, deserialize_with = "quantity::number")]
    pub friction: f64,
    /// Radius at which that acts [m].
    #[serde(default, deserialize_with = "quantity::length")]
    pub radius: f64,
    /// Constant moment [N m].
    #[serde(default, deserialize_with = "quantity::moment")]
    pub torque: f64,
    /// Moment by angular velocity [N m s/rad].
    #[serde(default, deserialize_with = "quantity::rotational_damping")]
    pub damping: f64,
}

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

fn is_no_torque(x: &Setting) -> bool {
    x.is(0.0)
}

fn slip_speed() -> f64 {
    1e-3
}

/// Shortest length of a span, as a share of that at the start, and of the radius of its wheel.
const SHORT: [f64; 2] = [0.05, 0.5];

impl SheaveSpec {
    /// Names of the wheels, and how far each is beside the marker.
    fn wheels(&self) -> Vec<(String, f64)> {
        let Some(count) = self.count else { return vec![(self.name.clone(), 0.0)] };
        let count = count.clamp(1, MOST);
        let beside = |k: usize| (k as f64 - 0.5 * (count as f64 - 1.0)) * self.spacing;
        (0..count).map(|k| (format!("{}.{}", self.name, k + 1), beside(k))).collect()
    }

    fn bearing(&self) -> Result<[f64; 3], BuildError> {
        let Some(b) = self.bearing else { return Ok([0.0; 3]) };
        for (field, x) in
            [("friction", b.friction), ("radius", b.radius), ("torque", b.torque), ("damping", b.damping)]
        {
            not_negative(field, x).map_err(|e| e.of(format!("bearing.{field}")))?;
        }
        Ok([b.torque, b.friction * b.radius, b.damping])
    }

    fn check(&self, wheels: &[Vec<Passage>]) -> Result<(), BuildError> {
        positive("radius", self.radius)?;
        unit("axis", self.axis)?;
        not_negative("inertia", self.inertia)?;
        positive("slip_speed", self.slip_speed)?;
        not_negative("friction", self.friction.unwrap_or(0.0))?;
        self.check_flank()?;
        if self.count.is_some_and(|count| !(1..=MOST).contains(&count)) {
            return Err(BuildError::at("count", format!("`count` must be between 1 and {MOST}")));
        }
        if self.efficiency.is_some_and(|eta| !(eta > 0.0 && eta <= 1.0)) {
            return Err(BuildError::at("efficiency", "an efficiency is between 0 and 1"));
        }
        let losses = self.friction.is_some() || self.bearing.is_some() || self.inertia > 0.0 || self.locked;
        let slides = self.friction.is_some_and(|mu| mu > 0.0);
        let wrong = [
            (
                "efficiency",
                self.efficiency.is_some() && losses,
                "it tells all losses of the sheave: leave out `friction`, `bearing`, `inertia` and `locked`, or it",
            ),
            (
                "friction",
                slides && self.inertia == 0.0 && !self.locked,
                "a wheel without inertia would just turn with the cable: give its `inertia`, or hold it by `locked = true`",
            ),
            ("locked", self.locked && !slides, "a wheel that can't turn matters only with `friction`"),
            (
                "locked",
                self.locked && (self.inertia > 0.0 || self.bearing.is_some()),
                "a wheel that can't turn has no use for `inertia` and `bearing`",
            ),
            (
                "torque",
                !self.torque.is(0.0) && (!slides || self.inertia == 0.0),
                "a wheel is driven against its cable by `friction`, and needs an `inertia`",
            ),
        ];
        let rubs = self.bearing.is_some_and(|b| b.torque > 0.0 || b.friction * b.radius > 0.0);
        let resists = slides && self.locked || self.efficiency.is_some() || rubs;
        if self.equilibrium != Sliding::None && !resists {
            let message = "it says what friction does, and this wheel turns without: give its `efficiency`, a dry `bearing`, or \
                           `friction` and `locked = true`";
            return Err(BuildError::at("equilibrium", message));
        }
        if self.turns.is_some_and(|turns| turns > MOST as u32) {
            return Err(BuildError::at("turns", format!("`turns` must be at most {MOST}")));
        }
        if let Some((field, _, message)) = wrong.into_iter().find(|(_, is, _)| *is) {
            return Err(BuildError::at(field, message));
        }
        if wheels.iter().all(Vec::is_empty) {
            let message = format!(
                "no cable runs over `{}`: name it in the `route` of one, as `{{ over = \"{}\" }}`",
                self.name,
                self.wheels()[0].0
            );
            return Err(BuildError::at("name", message));
        }
        Ok(())
    }

    /// One of its wheels, with the cables that pass it.
    fn wheel(
        &self,
        b: &mut Builder,
        name: &str,
        passages: &[Passage],
        beside: f64,
    ) -> Result<(), BuildError> {
        let axis = unit("axis", self.axis)?;
        let marker = b.marker("marker", &self.marker)?.with_axes(b.nodes(), b.coordinates(), around(axis));
        let marker = aside(marker, beside);
        let seat = Seat::new(b.nodes(), &marker)?;
        let bearing = self.bearing()?;
        let slides = self.friction.filter(|mu| *mu > 0.0);
        let turns = slides.is_none() && (self.inertia > 0.0 || self.bearing.is_some());
        let grip = match (slides, self.efficiency) {
            (Some(mu), _) => Grip::Slides(mu),
            (None, Some(eta)) => Grip::Slides(-eta.ln() / PI),
            (None, None) if turns => Grip::Turns(self.inertia / self.radius.powi(2)),
            (None, None) => Grip::Slides(0.0),
        };
        let flanks = passages.iter().map(|p| self.flank(p)).collect::<Result<Vec<_>, _>>()?;
        let mut grooves = Vec::new();
        for (k, passage) in passages.iter().enumerate() {
            let number = if k == 0 { String::new() } else { format!(".{}", k + 1) };
            let mode = b.internal_variable(format!("{name}{number}: mode"));
            let ends = passage.boundaries.map(|end| end.end);
            b.constraint(Hold::new(format!("{name}{number}"), b.nodes(), ends, marker, self.radius, mode))?;
            for (&boundary, which) in passage.boundaries.iter().zip(["in", "out"]) {
                let (name, strand) = (format!("{name}{number}.{which}"), passage.strand);
                b.term(Box::new(Fleet { name, boundary, seat, strand, mode: Some(mode) }));
            }
            let (strand, gravity) = (passage.strand, b.gravity());
            let share = |x: f64| if k == 0 { x } else { 0.0 };
            let grip = match grip {
                Grip::Turns(mass) => Grip::Turns(share(mass)),
                slides => slides,
            };
            let arc = Arc {
                radius: self.radius,
                strand,
                gravity: if strand.weighs { gravity } else { [0.0; 3] },
                grip,
                slip_speed: self.slip_speed,
                sliding: 0.0,
                near: None,
                stress: None,
                pull: 0.0,
                bearing: [share(bearing[0]), bearing[1], share(bearing[2])],
            };
            let back = dot(&passage.axis, &axis) < 0.0;
            if strand.ei > 0.0 {
                let (ends, name) = (passage.boundaries, format!("{name}{number}"));
                b.term(Box::new(Stiff { name, mode, ends, ei: strand.ei, radius: self.radius }));
            }
            let turns = self.turns.map(|_| (passage.wrap, b.memory(&format!("{name}{number}: wrap"), 1)));
            let twist = strand.torsion.map(|torsion| Twist {
                torsion,
                laid: [passage.twist, 0.0],
                memory: b.memory(&torsion::label(&format!("{name}{number}")), 2),
            });
            let way = self.equilibrium.way(passage)?;
            grooves.push(Groove {
                way,
                turns,
                twist,
                ..Groove::new(arc, passage.stored, passage.boundaries, back, mode)
            });
        }
        let rests = (self.equilibrium != Sliding::None).then(|| b.memory(&format!("{name}: equilibrium"), 1));
        if turns && passages.len() > 1 {
            let message = format!(
                "{} cables on `{name}` would be held together by a wheel that turns with them: give its `friction`",
                passages.len()
            );
            return Err(BuildError::at("inertia", message));
        }
        let angle = match slides {
            Some(_) if !self.locked => {
                let node = b.node(NodeKind::Scalars(1), &[0.0], &[0.0])?;
                b.share(node);
                let own = b.nodes()[node.0 as usize];
                let torque: Signal = b.signal("torque", &self.torque, &kind::MOMENT)?;
                Some(Angle { place: (own.q, own.v), inertia: self.inertia, torque })
            }
            _ => None,
        };
        let spans = passages.iter().flat_map(|p| p.spans.clone());
        let mut lengths = Vec::new();
        for span in spans {
            let length = b.parts(std::slice::from_ref(&span))?[0].1.length();
            lengths.push((span, (SHORT[0] * length).max(SHORT[1] * self.radius).min(0.5 * length)));
        }
        let solid = drawn(name, &marker, b, self.radius);
        let mut sheave =
            Sheave { name: name.into(), seat, grooves, angle, at_rest: (self.equilibrium, rests), solid };
        for k in 0..sheave.grooves.len() {
            let own = ArcTorsion { sheave: std::sync::Arc::new(sheave.clone()), groove: k };
            if let Some(twist) = &mut sheave.grooves[k].twist {
                // a closed belt has the twist that its way gives it
                twist.laid = own.starts(twist.laid[0], b.coordinates());
            }
        }
        let shared = std::sync::Arc::new(sheave.clone());
        for groove in (0..shared.grooves.len()).filter(|&k| shared.grooves[k].twist.is_some()) {
            b.term(Box::new(ArcTorsion { sheave: shared.clone(), groove }));
            if let Some(flank) = flanks[groove] {
                b.term(Box::new(Rolls { torsion: ArcTorsion { sheave: shared.clone(), groove }, flank }));
            }
        }
        for groove in 0..shared.grooves.len() {
            let watched: &[What] = match shared.grooves[groove].turns {
                None => &What::ALL,
                Some(_) => {
                    b.event(Unwound { sheave: shared.clone(), groove });
                    &[What::Slack, What::Flung]
                }
            };
            for &what in watched {
                b.event(Watch { what, sheave: shared.clone(), groove });
            }
        }
        for (span, length) in lengths {
            b.event(Short { span, length });
        }
        b.term(Box::new(sheave));
        Ok(())
    }
}

/// A marker moved along its third axis.
fn aside(marker: Marker, by: f64) -> Marker {
    let moved = |point: V3<f64>, axis: &V3<f64>| std::array::from_fn(|i| point[i] + by * axis[i]);
    match marker {
        Marker::Ground { point, axes } => Marker::Ground { point: moved(point, &axes[2]), axes },
        Marker::Node { node, point, axes } => Marker::Node { node, point: moved(point, &axes[2]), axes },
    }
}

/// What it looks like: a disc up to the middle of the cable.
fn drawn(name: &str, marker: &Marker, b: &Builder, radius: f64) -> Solid {
    let (carrier, point, axis) = match marker {
        Marker::Ground { point, axes } => (None, *point, axes[2]),
        Marker::Node { node, point, axes } => (Some(b.nodes()[node.0 as usize].q), *point, axes[2]),
    };
    let ends = [-0.1, 0.1].map(|x| std::array::from_fn(|i| point[i] + x * radius * axis[i]));
    Solid::between(name, carrier, ends, 2.0 * radius)
}

#[typetag::serde(name = "sheave")]
impl ConstraintSpec for SheaveSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn guides(&self) -> Vec<Guide> {
        let guide = |(name, beside)| Guide {
            name,
            marker: self.marker.clone(),
            beside,
            axis: self.axis,
            radius: self.radius,
            turns: f64::from(self.turns.unwrap_or(0)),
            winds: false,
        };
        self.wheels().into_iter().map(guide).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let wheels = self.wheels();
        let passages: Vec<Vec<Passage>> = wheels.iter().map(|(name, _)| b.passages(name)).collect();
        self.check(&passages)?;
        for ((name, beside), passages) in wheels.iter().zip(&passages) {
            if !passages.is_empty() {
                self.wheel(b, name, passages, *beside)?;
            }
        }
        Ok(())
    }
}
