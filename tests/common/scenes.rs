//! What the integration tests share: reference data and scenes that several of them use.
#![allow(dead_code)]

use ropewalk_constraints::motion::StraightSpec;
use ropewalk_constraints::{DirectionSpec, DrivingSpec, SphericalSpec};
use ropewalk_core::{Model, State};
use ropewalk_elements::cable::{Integration, LongitudinalModel, TransverseModel};
use ropewalk_elements::{CableSpec, PointMassSpec, Section};
use ropewalk_forces::{
    AddedMassSpec, BuoyancySpec, DragLaw, DragSpec, GravitySpec, PointForceSpec, SpringSpec, Theory,
    TimeFunction,
};
use ropewalk_scene::{Scene, Water};
use serde_json::Value;

/// A file of `tests/data`.
pub fn data(name: &str) -> Value {
    let path = format!("{}/tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// A number, written as a number or as a string of more digits.
pub fn number(v: &Value) -> f64 {
    v.as_f64()
        .or_else(|| v.as_str().and_then(|s| s.parse().ok()))
        .unwrap_or_else(|| panic!("{v} is no number"))
}

/// A ramp of a load over the load factor 0 … 1, linear so that load steps are equal.
pub fn linear() -> TimeFunction {
    TimeFunction::table(vec![0.0, 1.0], vec![0.0, 1.0])
}

pub type Models = (LongitudinalModel, TransverseModel, Integration);

/// The models of a variant as the reference files name it, such as `L4(lob3)+T3(2)`.
pub fn models(name: &str) -> Option<Models> {
    use Integration::{Full, LockingFree};
    use LongitudinalModel::{L1, L1n, L2, L3, L4};
    use TransverseModel::{T1, T2, T3};
    let (l, t) = name.split_once('+')?;
    let (l, rule) = match l {
        "L1" => (L1, Full),
        "L1n" => (L1n, Full),
        "L2" => (L2, Full),
        "L3" => (L3, Full),
        "L4" => (L4, Full),
        "L3(lob3)" => (L3, LockingFree),
        "L4(lob3)" => (L4, LockingFree),
        _ => return None,
    };
    let t = match (t, rule) {
        ("T1", _) => T1,
        ("T2", Full) | ("T2(2)", LockingFree) => T2,
        ("T3", Full) | ("T3(2)", LockingFree) => T3,
        _ => return None,
    };
    ropewalk_elements::cable::legal(l, t).ok()?;
    Some((l, t, rule))
}

/// A cantilever of length 1 and EI = 1 along x with a load at its tip that grows with the load factor.
pub fn cantilever(n: usize, ea: f64, force: f64, (l, t, rule): Models) -> Scene {
    let mut scene = Scene::new();
    let cable = CableSpec::straight("beam", [0.0; 3], [1.0, 0.0, 0.0], n, Section::new(1.0, ea, 1.0));
    scene
        .element(cable.models(l, t, rule))
        .constraint(SphericalSpec::pin("root", "beam.start"))
        .constraint(DirectionSpec::new("clamp", "beam.start"))
        .force(PointForceSpec::new("beam.end", [0.0, force, 0.0], linear()));
    scene
}

/// A cable hung by its start, laid along x, in the gravity of the reference (along -y).
pub fn pendulum(n: usize, length: f64, section: Section, (l, t, rule): Models, g: f64) -> Scene {
    let mut scene = Scene::new();
    let cable = CableSpec::straight("cable", [0.0; 3], [length, 0.0, 0.0], n, section);
    scene
        .element(cable.models(l, t, rule))
        .constraint(SphericalSpec::pin("pin", "cable.start"))
        .set_gravity([0.0, -g, 0.0])
        .force(GravitySpec::default());
    scene
}

/// Where a marker of a cable is.
pub fn place(model: &Model, state: &State, part: &str, s: f64) -> [f64; 3] {
    model.part(part).and_then(|p| p.point(s, &state.at())).unwrap_or_else(|| panic!("{part} at {s}")).0
}

/// Force of a constraint on the node at an end of a cable [N].
pub fn reaction(model: &Model, state: &State, constraint: &str) -> [f64; 3] {
    let c = model.constraints().iter().position(|c| c.name() == constraint).expect(constraint);
    let node = model.constraints()[c].nodes()[0];
    let r = model.reaction(c, node, &state.at(), &state.lambda);
    [r[0], r[1], r[2]]
}

pub fn size(x: [f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The hose of the towing references: 30 m, free at its end, with the stiffness given.
pub fn hose(ea: f64, ei: f64) -> Section {
    Section {
        flooded: 0.361,
        diameter: 0.023,
        displaced: Some((0.5 - 4.271 / 9.81) / 1025.0),
        ..Section::new(0.5, ea, ei)
    }
}

/// The drag law of a towing reference.
pub fn law(name: &Value) -> DragLaw {
    if name == "choo" { DragLaw::ChooCasarella } else { DragLaw::Constant }
}

/// A hose in water, laid straight between two points and pinned at its start.
pub fn towed(from: [f64; 3], to: [f64; 3], n: usize, section: Section, law: DragLaw) -> Scene {
    let mut scene = Scene::new();
    scene.water = Some(Water::default());
    scene
        .element(CableSpec::straight("hose", from, to, n, section).unstretched(30.0))
        .force(GravitySpec::default())
        .force(BuoyancySpec::default())
        .force(DragSpec { normal: law, tangential: law, ..DragSpec::default() })
        // as the references have it
        .force(AddedMassSpec { theory: Some(Theory::Morison), ..AddedMassSpec::default() });
    scene
}

/// A quantity of a verification case.
#[derive(serde::Deserialize)]
pub struct Reference {
    pub quantity: String,
    pub value: Value,
    /// How far off its first number may be.
    #[serde(deserialize_with = "first")]
    pub tolerance: f64,
}

fn first<'de, D: serde::Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let value: Value = serde::Deserialize::deserialize(d)?;
    Ok(number(value.get(0).unwrap_or(&value)))
}

impl Reference {
    pub fn number(&self) -> f64 {
        number(&self.value)
    }
    pub fn numbers(&self) -> Vec<f64> {
        self.value.as_array().expect("array").iter().map(number).collect()
    }
}

/// The references of a case of the verification suite, which itself runs it in one way.
pub fn case(name: &str) -> Vec<Reference> {
    let all = data(&format!("../../studies/verification/{name}.json"));
    let runs = all["runs"].as_array().expect("runs");
    let quantities = runs.iter().flat_map(|r| r["quantities"].as_array().expect("quantities"));
    quantities.map(|q| serde_json::from_value(q.clone()).expect(name)).collect()
}

/// A cable in water, sprung, with a mass: everything that takes or brings energy.
pub fn everything() -> Scene {
    let section = Section {
        diameter: 0.03,
        axial_retardation_time: 1e-3,
        bending_retardation_time: 1e-2,
        ..Section::new(2.0, 1e5, 1.0)
    };
    let mut scene = Scene::new();
    scene.water = Some(Water::default());
    scene
        .element(CableSpec::straight("cable", [0.0; 3], [2.0, 0.0, 0.0], 8, section))
        .element(PointMassSpec::new("bob", "cable.end", 1.0))
        .constraint(SphericalSpec::pin("pin", "cable.start"))
        .force(GravitySpec::default())
        .force(DragSpec::default())
        .force(SpringSpec {
            name: "spring".into(),
            marker: "cable@1.0".into(),
            to: [1.0, 0.5, 0.0].into(),
            stiffness: 50.0.into(),
            damping: 2.0.into(),
            length: Some(0.3.into()),
            tension_only: false,
        });
    scene
}

/// A hose that hangs at rest and is then towed away at 15 knots.
pub fn tow_start() -> Scene {
    let mut scene = towed([0.0; 3], [0.0, 0.0, -30.0], 10, hose(1e6, 2.0), DragLaw::Constant);
    scene.motion(StraightSpec {
        name: "course".into(),
        speed: 15.0 * 1852.0 / 3600.0,
        direction: [1.0, 0.0, 0.0],
        start: 0.0,
        ramp: 5.0,
    });
    scene.constraint(DrivingSpec::new("ship", "hose.start", "course"));
    scene
}
