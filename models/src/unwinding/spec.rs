//! What a scene says about unwinding.

use super::history::Running;
use super::newmark::{Stepping, Stopped};
use super::problem::{Cable, Eyelet, LiftOff, Pull, Rule, Unwinding};
use super::steady::SteadyError;
use ropewalk_constraints::package::{Package, PackageSpec};
use ropewalk_core::error::positive;
use ropewalk_core::integrator::Counts;
use ropewalk_core::{BuildError, Column, Solid, V3, dot};
use ropewalk_forces::{AddedMass, DragSpec, TimeFunction};
use ropewalk_scene::{Channel, Process, ProcessSpec, Surroundings, Water, quantity, register_spec};
use schemars::JsonSchema;
use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt;
use std::sync::Arc;

/// What finds the lift-off point while the cable is drawn at a given speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum RuleSpec {
    /// The tension at the eyelet is given; the lift-off point follows.
    Tension {
        /// Tension at rest [N].
        #[serde(deserialize_with = "quantity::force")]
        tension: f64,
        /// Tension per speed squared [kg/m].
        #[serde(default, deserialize_with = "quantity::mass_per_length")]
        per_speed2: f64,
        /// Factor of `tension` as a function of time.
        #[serde(default)]
        time: TimeFunction,
    },
    /// The free length is constant; the tension is a result.
    Length {
        /// Tension at the eyelet of the initial steady balloon [N].
        #[serde(deserialize_with = "quantity::force")]
        tension: f64,
    },
    /// The cable sticks to the package with a given adhesion energy.
    Adhesion {
        /// Adhesion energy per length [J/m]: `EI |κ - κ_w|²/2` at the lift-off point, with the curvatures of the free
        /// and the wound cable.
        #[serde(deserialize_with = "quantity::force")]
        adhesion_energy: f64,
        /// Tension at the eyelet of the initial steady balloon [N].
        #[serde(deserialize_with = "quantity::force")]
        tension: f64,
    },
}

/// What it records.
const CHANNELS: [&str; 9] =
    ["tension", "length", "speed", "lift", "radius", "centre", "acceleration", "drag", "curvature"];

fn elements() -> usize {
    40
}
/// Reads a time step, or `auto`, which is none.
fn chosen<'de, D: Deserializer<'de>>(d: D) -> Result<Option<f64>, D::Error> {
    struct Step;
    impl Visitor<'_> for Step {
        type Value = Option<f64>;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "a time like `0.1 ms`, or `auto`")
        }
        fn visit_str<E: de::Error>(self, text: &str) -> Result<Option<f64>, E> {
            match text.trim() {
                "auto" => Ok(None),
                text => quantity::kind::TIME.parse(text).map(Some).map_err(E::custom),
            }
        }
        fn visit_f64<E: de::Error>(self, h: f64) -> Result<Option<f64>, E> {
            Ok(Some(h))
        }
        fn visit_i64<E: de::Error>(self, h: i64) -> Result<Option<f64>, E> {
            Ok(Some(h as f64))
        }
        fn visit_u64<E: de::Error>(self, h: u64) -> Result<Option<f64>, E> {
            Ok(Some(h as f64))
        }
    }
    d.deserialize_any(Step)
}

/// Time step where the mesh allows it [s].
const STEP: f64 = 2e-4;

/// A cable that is drawn from a package through an eyelet, by finite differences: inextensible, with Newmark's
/// method, and with the tension as a Lagrange multiplier. It shares no equation with the elements of type `cable`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UnwindingSpec {
    /// Name; the columns of the history begin with it.
    pub name: String,
    /// Mass per length [kg/m].
    #[serde(deserialize_with = "quantity::mass_per_length")]
    pub mass: f64,
    /// Bending stiffness [N m²]. Default: 0.
    #[serde(default, deserialize_with = "quantity::bending_stiffness")]
    pub ei: f64,
    /// The package, with the diameter of the cable and its minimum bend radius.
    pub package: PackageSpec,
    /// Position of the eyelet [m].
    #[serde(default, deserialize_with = "quantity::vec3::length")]
    pub eyelet: V3<f64>,
    /// Whether the eyelet holds the direction along the axis of the package. Has an effect only with bending
    /// stiffness.
    #[serde(default)]
    pub guided: bool,
    /// Whether the cable is tangent to the wound layer at the lift-off point. Needs bending stiffness.
    #[serde(default)]
    pub tangent: bool,
    /// Name of the motion that draws the cable: its x component is the length drawn through the eyelet.
    pub motion: String,
    /// Condition that determines the lift-off point.
    pub rule: RuleSpec,
    /// Initial shape, at rest: points from the eyelet to the lift-off point [m]. Default: the steady balloon of the
    /// initial speed and tension; without speed and weight, a straight line.
    #[serde(default, deserialize_with = "quantity::points", skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<V3<f64>>,
    /// Drag of the water. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag: Option<DragSpec>,
    /// Added-mass coefficient across the axis.
    #[serde(default, deserialize_with = "quantity::number")]
    pub added_mass: f64,
    /// Whether weight and buoyancy act.
    #[serde(default)]
    pub weight: bool,
    /// Number of segments of the free cable.
    #[serde(default = "elements")]
    pub elements: usize,
    /// Time step [s], or `auto`. Default: `auto`, which is 0.2 ms, or with bending stiffness and a given tension two
    /// segments over the wave speed. A longer step ends the run with an error, since the lift-off point would
    /// oscillate.
    #[serde(default, deserialize_with = "chosen", skip_serializing_if = "Option::is_none")]
    pub h: Option<f64>,
    /// Numerical damping of Newmark's method. Default: 0.05 with bending stiffness, 0 without.
    #[serde(default, deserialize_with = "quantity::optional::number")]
    pub numerical_damping: Option<f64>,
    /// Titles of its pictures, by what they show: `tension`, `length`, `speed`, `lift`, `radius`, `centre`,
    /// `acceleration`, `drag`, `curvature`. Default: the quantity.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub titles: BTreeMap<String, String>,
}
register_spec!(Process, "unwound_cable", UnwindingSpec);

impl UnwindingSpec {
    /// The problem.
    ///
    /// # Errors
    /// Data that make no sense.
    pub fn problem(&self, around: &Surroundings) -> Result<Unwinding, BuildError> {
        let package = Package::new(&self.package).map_err(|e| match e.field.as_deref() {
            // the number stands in the package as well
            Some("pitch") if self.package.pitch.is_none() => e.of("diameter"),
            _ => e,
        })?;
        let (axis, diameter) = (package.axis(), self.package.diameter);
        let limit = self.package.min_bend_radius.filter(|r| *r > 0.0).map_or(f64::INFINITY, |r| 1.0 / r);
        positive("mass", self.mass)?;
        let cable = Cable { mass: self.mass, diameter, ei: self.ei, curvature_limit: limit };
        let feed = around.motion("motion", &self.motion)?;
        let rule = match &self.rule {
            RuleSpec::Tension { tension, per_speed2, time } => {
                time.check()?;
                Rule::Tension(Pull { rest: *tension, time: time.clone(), per_speed2: *per_speed2 })
            }
            RuleSpec::Length { .. } => Rule::Length,
            RuleSpec::Adhesion { adhesion_energy, .. } => Rule::Peel(*adhesion_energy),
        };
        let towards =
            [0, 1, 2].map(|i| self.package.origin[i] + 0.5 * self.package.length * axis[i] - self.eyelet[i]);
        let mut p = Unwinding::new(cable, Arc::new(package), feed, rule, self.elements);
        p.eyelet = self.eyelet;
        if self.guided {
            let sign = if dot(&towards, &axis) < 0.0 { -1.0 } else { 1.0 };
            p.through = Eyelet::Guided(axis.map(|a| sign * a));
        }
        if self.tangent {
            p.lift_off = LiftOff::Tangent;
        }
        let water = || {
            let message = "drag, added mass and buoyancy need a [water] section in the scene";
            around.water.as_ref().ok_or_else(|| BuildError::new(message))
        };
        if let Some(drag) = &self.drag {
            if !drag.on.is_empty() {
                return Err(BuildError::at("on", "there is one cable only: leave `on` out"));
            }
            p.drag = Some(drag.law(water()?)?);
        }
        if self.added_mass != 0.0 {
            p.added_mass = Some(AddedMass::new(water()?.density, self.added_mass)?);
        }
        let displaced =
            around.water.as_ref().map_or(0.0, |w: &Water| w.density * PI / 4.0 * diameter * diameter);
        if self.weight {
            p.weight = around.gravity.map(|g| (self.mass - displaced) * g);
        }
        p.check()?;
        Ok(p)
    }

    /// The numbers of the time stepping.
    pub fn stepping(&self) -> Stepping {
        let damping = self.numerical_damping.unwrap_or(if self.ei > 0.0 { 0.05 } else { 0.0 });
        Stepping {
            numerical_damping: damping,
            follows: self.h.is_none(),
            ..Stepping::new(self.h.unwrap_or(STEP))
        }
    }

    /// Names of the channels with title, labels of the columns and their unit.
    fn outputs(&self) -> Vec<(&'static str, &'static str, &'static [&'static str], &'static str)> {
        let mut all: Vec<(_, _, &'static [&'static str], _)> = vec![
            ("tension", "Tension at the ends", &["eyelet", "lift"], "N"),
            ("length", "Free length and length peeled", &["free", "peeled"], "m"),
            ("speed", "Speed of drawing and of peeling", &["drawn", "peeled"], "m/s"),
            ("lift", "Lift-off point", &["x", "y", "z"], "m"),
            ("radius", "Largest distance from the axis", &["radius"], "m"),
            ("centre", "Centre node", &["x", "y", "z"], "m"),
            ("acceleration", "Acceleration of the centre node", &["x", "y", "z"], "m/s^2"),
        ];
        if self.drag.is_some() {
            all.push((
                "drag",
                "Drag coefficient along the cable",
                &["quarter", "half", "three_quarters"],
                "1",
            ));
        }
        if self.ei > 0.0 {
            all.push(("curvature", "Curvature at the lift-off point", &["lift"], "1/m"));
        }
        all
    }
}

#[typetag::serde(name = "unwound_cable")]
impl ProcessSpec for UnwindingSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn channels(&self) -> Vec<Channel> {
        let name = &self.name;
        let channel = |(what, title, labels, unit): (&str, &str, &[&str], &str)| Channel {
            title: self.titles.get(what).map_or(title, String::as_str).to_string(),
            name: format!("{name}.{what}"),
            columns: labels.iter().map(|l| Column::new(format!("{name}.{what}.{l}"), unit)).collect(),
        };
        self.outputs().into_iter().map(channel).collect()
    }
    fn unknowns(&self) -> usize {
        4 * self.elements - 3 + usize::from(!matches!(self.rule, RuleSpec::Length { .. }))
    }
    fn build(&self, around: &Surroundings) -> Result<Box<dyn Process>, BuildError> {
        if let Some(what) = self.titles.keys().find(|what| !CHANNELS.contains(&what.as_str())) {
            let known = CHANNELS.map(|c| format!("`{c}`")).join(", ");
            let message = format!("there is no picture `{what}` to give a title to; there are {known}");
            return Err(BuildError::at("titles", message));
        }
        let problem = self.problem(around)?;
        let [speed, _] = problem.speed(0.0);
        let start = if self.points.is_empty() {
            let tension = match (&self.rule, &problem.rule) {
                (_, Rule::Tension(pull)) => pull.at(0.0, speed),
                (RuleSpec::Length { tension } | RuleSpec::Adhesion { tension, .. }, _) => *tension,
                (RuleSpec::Tension { .. }, _) => 0.0,
            };
            let balloon = problem.steady(speed, tension, 0.0).map_err(|e| match e {
                SteadyError::Input(e) => e,
                e => BuildError::at("rule", format!("at the start: {e}")),
            })?;
            problem.start_steady(&balloon)?
        } else {
            problem.start(&self.points, 0.0, 0.0)?
        };
        let running = Running::new(problem, start, self.stepping(), around.duration)
            .map_err(|e| if e.field.as_deref() == Some("feed") { e.of("motion") } else { e })?;
        let package = Package::new(&self.package)?.solid("package");
        Ok(Box::new(Unwound { running, drag: self.drag.is_some(), bending: self.ei > 0.0, package }))
    }
}

struct Unwound {
    running: Running,
    drag: bool,
    bending: bool,
    /// What it looks like.
    package: Solid,
}

impl Process for Unwound {
    fn t(&self) -> f64 {
        self.running.t()
    }
    fn advance(&mut self, t: f64) -> Result<Option<String>, String> {
        match self.running.advance(t) {
            Ok(()) => Ok(None),
            Err(Stopped::Empty { .. }) => Ok(Some("the package: it is empty".into())),
            Err(e) => Err(e.to_string()),
        }
    }
    fn sample(&self, out: &mut Vec<f64>) {
        let r = self.running.row();
        out.extend([r.tension, r.lift_tension, r.length, r.peeled, r.speed, r.peel_speed]);
        out.extend(r.lift_off);
        out.push(r.radius);
        out.extend(r.centre[0]);
        out.extend(r.centre[2]);
        if self.drag {
            out.extend(r.drag);
        }
        if self.bending {
            out.push(r.lift_curvature);
        }
    }
    fn line(&self) -> Vec<V3<f64>> {
        self.running.shape().x
    }
    fn tensions(&self) -> Vec<f64> {
        self.running.tensions()
    }
    fn curvatures(&self) -> Vec<f64> {
        self.running.curvatures()
    }
    fn solids(&self) -> Vec<Solid> {
        vec![self.package.clone()]
    }
    fn counts(&self) -> Counts {
        let [steps, newton_iterations, rejected] = self.running.work();
        Counts { steps, newton_iterations, rejected, factorizations: newton_iterations, ..Counts::default() }
    }
    fn warnings(&self) -> Vec<String> {
        self.running.conditions().iter().map(ToString::to_string).collect()
    }
}
