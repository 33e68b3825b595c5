//! The towed hose as a scene, and as the peers' scripts want it.

use crate::job::Answer;
use crate::own;
use crate::problem::{Steady, SteadyCase, Tow};
use ropewalk::constraints::DrivingSpec;
use ropewalk::core::BuildError;
use ropewalk::core::integrator::{Options, StepReport};
use ropewalk::core::{Motion, Moving, Observer};
use ropewalk::elements::{CableSpec, PointMassSpec, Section};
use ropewalk::forces::{AddedMassSpec, BuoyancySpec, DragSpec, GravitySpec, Theory};
use ropewalk::scene::MotionSpec;
use ropewalk::{Model, Scene, State, Water};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

const KNOT: f64 = 1852.0 / 3600.0;

/// A tow: what is the same for all codes.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub speed_kn: f64,
    pub ea: f64,
    pub end_mass: f64,
    pub duration: f64,
    /// Between the instants at which tensions are compared [s].
    pub interval: f64,
}

impl Case {
    pub fn steady(s: &Steady, c: &SteadyCase) -> Self {
        let &Steady { duration, interval, .. } = s;
        Case { speed_kn: c.speed_kn, ea: c.ea, end_mass: 0.0, duration, interval }
    }

    /// As a script wants it; the peer's own settings win.
    pub fn json(&self, tow: &Tow, elements: usize, settings: &[&Map<String, Value>]) -> Value {
        let mut all = tow.hose.clone();
        all.extend(tow.water.clone());
        for (name, x) in [
            ("ramp", tow.ramp),
            ("speed_kn", self.speed_kn),
            ("ea", self.ea),
            ("end_mass", self.end_mass),
            ("duration", self.duration),
            ("interval", self.interval),
        ] {
            all.insert(name.into(), x.into());
        }
        all.insert("elements".into(), elements.into());
        settings.iter().for_each(|s| all.extend((*s).clone()));
        Value::Object(all)
    }

    /// Runs it from its equilibrium at rest.
    pub fn run(&self, tow: &Tow, elements: usize, options: &Options) -> Result<Answer, String> {
        let mut pull = Pull::default();
        let run = own::run(&self.scene(tow, elements)?, options, self.duration, true, &mut pull)?;
        let count = (self.duration / self.interval).round() as usize;
        let reaction = (1..=count).map(|k| pull.at(k as f64 * self.interval)).collect();
        Ok(Answer { reaction, ..Answer::of(&run) })
    }

    fn scene(&self, tow: &Tow, elements: usize) -> Result<Scene, String> {
        let of = |map: &Map<String, Value>, name: &str| {
            map.get(name).and_then(Value::as_f64).ok_or_else(|| format!("tow.json: {name} is missing"))
        };
        let (hose, water) = (|name| of(&tow.hose, name), |name| of(&tow.water, name));
        let section =
            Section { diameter: hose("diameter")?, ..Section::new(hose("mass")?, self.ea, hose("ei")?) };
        let (length, g) = (hose("length")?, [0.0, 0.0, -water("g")?]);
        let mut scene = Scene::new();
        scene.water = Some(Water { density: water("density")?, ..Water::default() });
        scene.element(CableSpec::straight("hose", [0.0; 3], [0.0, 0.0, -length], elements, section));
        if self.end_mass > 0.0 {
            scene.element(PointMassSpec::new("end", "hose.end", self.end_mass));
        }
        scene
            .set_gravity(g)
            .force(GravitySpec::default())
            .force(BuoyancySpec::default())
            .force(DragSpec { cn: hose("cn")?, ct: hose("ct")?, ..DragSpec::default() })
            .force(AddedMassSpec {
                ca: hose("ca")?,
                theory: Some(Theory::Morison),
                ..AddedMassSpec::default()
            })
            .motion(CubicRamp { name: "course".into(), speed: self.speed_kn * KNOT, ramp: tow.ramp })
            .constraint(DrivingSpec::new("ship", "hose.start", "course"));
        Ok(scene)
    }

    /// Tension of the straight line that a hose without bending stiffness settles at [N].
    pub fn steady_tension(&self, tow: &Tow) -> f64 {
        let hose = |name: &str| tow.hose.get(name).and_then(Value::as_f64).unwrap_or(f64::NAN);
        let water = |name: &str| tow.water.get(name).and_then(Value::as_f64).unwrap_or(f64::NAN);
        let (d, rho, v) = (hose("diameter"), water("density"), self.speed_kn * KNOT);
        let weight = (hose("mass") - rho * PI * d * d / 4.0) * water("g");
        let b = weight / (0.5 * rho * hose("cn") * d * v * v);
        let cos = 0.5 * ((b * b + 4.0).sqrt() - b);
        let along = 0.5 * rho * PI * d * hose("ct") * (v * cos).powi(2);
        hose("length") * (along + weight * (1.0 - cos * cos).sqrt())
    }
}

/// From rest to a speed along x as `u² (3 - 2u)`, which is what the peers were given.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct CubicRamp {
    name: String,
    /// [m/s]
    speed: f64,
    /// [s]
    ramp: f64,
}

impl Motion for CubicRamp {
    fn at(&self, t: f64) -> Moving {
        let u = (t / self.ramp).clamp(0.0, 1.0);
        let way = self.ramp * u.powi(3) * (1.0 - 0.5 * u) + (t - self.ramp).max(0.0);
        let along = |x: f64| [self.speed * x, 0.0, 0.0];
        Moving { x: along(way), v: along(u * u * (3.0 - 2.0 * u)), a: along(6.0 * u * (1.0 - u) / self.ramp) }
    }
}

#[typetag::serde(name = "cubic_ramp_of_the_benchmark")]
impl MotionSpec for CubicRamp {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(self.clone()))
    }
}

/// The force that the ship pulls with, at the end of every step.
#[derive(Default)]
struct Pull {
    history: Vec<(f64, f64)>,
}

impl Observer for Pull {
    fn step(&mut self, model: &Model, state: &State, _: &StepReport) -> ControlFlow<()> {
        let node = model.constraints()[0].nodes()[0];
        let r = model.reaction(0, node, &state.at(), &state.lambda);
        self.history.push((state.t, r[..3].iter().map(|r| r * r).sum::<f64>().sqrt()));
        ControlFlow::Continue(())
    }
}

impl Pull {
    /// Between steps as a straight line.
    fn at(&self, t: f64) -> f64 {
        let k = self.history.partition_point(|(s, _)| *s < t).clamp(1, self.history.len() - 1);
        let [(t0, f0), (t1, f1)] = [self.history[k - 1], self.history[k]];
        f0 + (f1 - f0) * (t - t0) / (t1 - t0)
    }
}
