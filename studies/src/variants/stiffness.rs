//! The stiffness models of cables, each pair measured in the same way.

use crate::bench::measure::VariantMeter;
use crate::error::Error;
use ropewalk_constraints::{DirectionSpec, SphericalSpec};
use ropewalk_core::integrator::Options;
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_core::{Model, Quantity, Simulation, State, V3, Width};
use ropewalk_elements::cable::{CableModel, LongitudinalModel, TransverseModel, legal};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_forces::{GravitySpec, PointForceSpec, PointMomentSpec, TimeFunction};
use ropewalk_scene::Scene;
use serde::Serialize;
use std::f64::consts::TAU;
use std::time::Duration;

/// Meshes of the cantilever.
pub const CANTILEVER: [usize; 6] = [1, 2, 4, 8, 16, 32];
/// Meshes of the pendulum.
pub const PENDULUM: [usize; 4] = [2, 4, 8, 16];

/// Meshes of the helix.
pub const HELIX: [usize; 3] = [8, 16, 32];

/// Deflection of the tip under `F L²/EI = 3`, by integration of the elastica: without extension, and with
/// `EA L²/EI = 1.6e5`, where the material stretches by Green's strain.
const ELASTICA: f64 = 0.603_253_441_130;
const EXTENSIBLE: f64 = 0.603_264_433_707;
/// Its stiffness `EA L²/EI`, and one for locking.
const SLENDER: f64 = 1.6e5;
const SLENDEREST: f64 = 1.6e9;
/// Tip of the stiff pendulum of Escalona, Hussien & Shabana (1998) at 0.4 s: 64 elements L4+T3 without locking,
/// integrated to rounding after the hinge was eliminated [m].
const TIP: [f64; 2] = [0.753_529, -0.828_886];
const FALL: f64 = 0.4;
const ROD: f64 = 1.2;

/// What is known of a pair of models.
#[derive(Clone, Debug, Serialize)]
pub struct Stiffness {
    /// What its pool is called.
    pub label: String,
    /// The models and the quadrature.
    pub models: CableModel,
    /// Force and inertia [µs per element].
    pub force_us: f64,
    /// The same with the exact tangent and mass [µs per element].
    pub tangent_us: f64,
    /// Relative error of the cantilever's deflection, by mesh: [`CANTILEVER`]. NaN where there is no equilibrium.
    pub cantilever: Vec<f64>,
    /// How much larger the error of 8 elements becomes when `EA L²/EI` grows ten thousandfold: 1 without locking.
    pub locking: f64,
    /// Error of the tip of a rod with torsion that a couple at its end, fixed in space, winds to one turn of a helix, in
    /// parts of its length, by mesh: [`HELIX`]. NaN where there is no equilibrium.
    pub helix: Vec<f64>,
    /// Error of the pendulum's tip at 0.4 s in parts of its length, by mesh: [`PENDULUM`]. Models with T1 or T2 are
    /// those of a slightly other material, which is 5e-5 away.
    pub pendulum: Vec<f64>,
    /// What the balance of energy of the pendulum with 8 elements misses, in parts of its largest term.
    pub energy: f64,
    /// Largest difference between the tangent and its transpose, in parts of the largest entry.
    pub asymmetry: f64,
    /// Largest strain of 4 elements bent by one radian with a pure moment, which doesn't stretch a beam.
    pub moment_strain: f64,
}

/// A pair of models that don't go together.
#[derive(Clone, Debug, Serialize)]
pub struct Forbidden {
    /// Longitudinal model.
    pub longitudinal: LongitudinalModel,
    /// Transverse model.
    pub transverse: TransverseModel,
    /// Why not.
    pub why: String,
}

/// The pairs that don't go together, with the reason.
pub fn forbidden() -> Vec<Forbidden> {
    use LongitudinalModel::{L1, L1n, L2, L3, L4};
    use TransverseModel::{T1, T2, T3};
    let pairs = [L1, L1n, L2, L3, L4].into_iter().flat_map(|l| [T1, T2, T3].map(|t| (l, t)));
    let why = |(longitudinal, transverse)| {
        let why = legal(longitudinal, transverse).err()?;
        Some(Forbidden { longitudinal, transverse, why })
    };
    pairs.filter_map(why).collect()
}

/// Everything about a pair but its cost.
///
/// # Errors
/// A model that can't be built, or a pendulum that can't be moved.
pub fn measure(models: CableModel) -> Result<Stiffness, Error> {
    let deflection = |n, ea, exact: f64| {
        let tip = cantilever(models, n, ea, Load::Force).map(|(_, q)| q[1] / exact - 1.0);
        tip.unwrap_or(f64::NAN)
    };
    let errors: Vec<f64> = CANTILEVER.iter().map(|&n| deflection(n, SLENDER, EXTENSIBLE)).collect();
    let mut pendulum = Vec::new();
    let mut energy = f64::NAN;
    for n in PENDULUM {
        let (tip, imbalance) = fall(models, n)?;
        pendulum.push((tip[0] - TIP[0]).hypot(tip[1] - TIP[1]) / ROD);
        if n == 8 {
            energy = imbalance;
        }
    }
    let (label, asymmetry) = asymmetry(models)?;
    Ok(Stiffness {
        label,
        models,
        force_us: f64::NAN,
        tangent_us: f64::NAN,
        locking: (deflection(8, SLENDEREST, ELASTICA) / errors[3]).abs(),
        cantilever: errors,
        helix: HELIX.iter().map(|&n| helix(models, n).unwrap_or(f64::NAN)).collect(),
        pendulum,
        energy,
        asymmetry,
        moment_strain: cantilever(models, 4, 1e6, Load::Moment).map_or(f64::NAN, |(strain, _)| strain),
    })
}

/// Costs of pairs, measured in turns for about this time in all.
///
/// # Errors
/// A model that can't be built.
pub fn time(all: &mut [Stiffness], budget: Duration, tick: &dyn Fn()) -> Result<(), Error> {
    const ROUNDS: u32 = 3;
    const MESH: usize = 512;
    let meters = all.iter().map(|s| VariantMeter::new(s.models, MESH, Width::best()));
    let mut meters = meters.collect::<Result<Vec<_>, _>>()?;
    let each = budget / (ROUNDS * meters.len().max(1) as u32);
    for _ in 0..ROUNDS {
        for meter in &mut meters {
            meter.round(each)?;
            tick();
        }
    }
    for (s, meter) in all.iter_mut().zip(&meters) {
        let cost = meter.cost();
        (s.force_us, s.tangent_us) = (cost.force, cost.tangent);
    }
    Ok(())
}

fn cable(models: CableModel, n: usize, length: f64, section: Section) -> CableSpec {
    let straight = CableSpec::straight("rod", [0.0; 3], [length, 0.0, 0.0], n, section);
    straight.models(models.longitudinal, models.transverse, models.integration)
}

#[derive(Clone, Copy, PartialEq)]
enum Load {
    Force,
    Moment,
}

/// A cantilever of 1 m and EI = 1 N m² under a force of 3 N or a moment of 1 N m: its largest strain and its tip.
/// `None` where no equilibrium was found.
fn cantilever(models: CableModel, n: usize, ea: f64, load: Load) -> Option<(f64, V3<f64>)> {
    let mut scene = Scene::new();
    scene
        .element(cable(models, n, 1.0, Section::new(1.0, ea, 1.0)))
        .constraint(SphericalSpec::pin("root", "rod.start"))
        .constraint(DirectionSpec::new("clamp", "rod.start"));
    match load {
        Load::Force => scene.force(PointForceSpec::new("rod.end", [0.0, 3.0, 0.0], grows())),
        Load::Moment => scene.force(moment([0.0, 0.0, 1.0])),
    };
    let (model, state) = loaded(&scene, 10)?;
    let part = model.part("rod")?;
    let places = (0..=200).map(|k| f64::from(k) / 200.0);
    let strain = places.filter_map(|s| part.observe(Quantity::Strain, s, &state.at()));
    Some((
        strain.fold(0.0, |a, e| if e.abs() > a || e.is_nan() { e.abs() } else { a }),
        tip(&model, &state, 1.0),
    ))
}

/// Grows from nothing to its full size over the load steps.
fn grows() -> TimeFunction {
    TimeFunction::table(vec![0.0, 1.0], vec![0.0, 1.0])
}

/// A moment at the free end that keeps its direction.
fn moment(moment: V3<f64>) -> PointMomentSpec {
    let moment = moment.map(Into::into);
    PointMomentSpec { marker: "rod.end".into(), local: false, moment, torque: None, time: grows() }
}

/// The equilibrium under the whole load. `None` where none was found.
fn loaded(scene: &Scene, steps: u32) -> Option<(Model, State)> {
    let model = scene.build().ok()?;
    // what fails is told by NaN; whether the shape is stable is another question
    let options = StaticsOptions { stable: false, ..StaticsOptions::default() };
    let mut statics = Statics::new(&model, &options).ok()?;
    let mut state = model.state();
    for k in 1..=steps {
        statics.follow(&mut state, f64::from(k) / f64::from(steps)).ok()?;
    }
    drop(statics);
    Some((model, state))
}

/// How far the tip of a helix is from the exact one (Kirchhoff 1859; Love 1927, art. 270): a rod of 1 m with
/// `EA L²/EI = 1e5` and `GJ/EI = 0.7` under a couple of `2π EI/L` at its end, at an angle to it whose tangent is 3/4.
fn helix(models: CableModel, n: usize) -> Option<f64> {
    let mut section = Section::new(1.0, 1e5, 1.0);
    section.gj = Some(0.7);
    let mut scene = Scene::new();
    scene
        .element(cable(models, n, 1.0, section))
        .constraint(SphericalSpec::pin("root", "rod.start"))
        .constraint(DirectionSpec::new("clamp", "rod.start"))
        .force(moment([0.8 * TAU, 0.0, 0.6 * TAU]));
    let (model, state) = loaded(&scene, 40)?;
    // the tip lies on the axis of the couple again after one turn
    let (x, exact) = (tip(&model, &state, 1.0), [0.64, 0.0, 0.48]);
    Some((0..3).map(|i| (x[i] - exact[i]).powi(2)).sum::<f64>().sqrt())
}

fn tip(model: &Model, state: &State, s: f64) -> V3<f64> {
    model.part("rod").and_then(|p| p.point(s, &state.at())).map_or([f64::NAN; 3], |p| p.0)
}

/// The stiff pendulum released from the horizontal: its tip at 0.4 s, and what its balance of energy misses.
fn fall(models: CableModel, n: usize) -> Result<(V3<f64>, f64), Error> {
    let section = Section::new(9.972, 126_000.0, 0.8505);
    let mut scene = Scene::new();
    scene
        .element(cable(models, n, ROD, section))
        .constraint(SphericalSpec::pin("hinge", "rod.start"))
        .set_gravity([0.0, -9.81, 0.0])
        .force(GravitySpec::default());
    let mut options = Options { newton_tolerance: 1e-2, ..Options::default() };
    options.stepping = ropewalk_core::integrator::Stepping::Controlled { tolerance: 1e-6 };
    let mut s = Simulation::new(scene.build()?, &options, FALL)?;
    s.advance(FALL, f64::INFINITY, &mut ())?;
    Ok((tip(&s.model, &s.state, ROD), s.audit.imbalance().abs() / s.audit.scale))
}

/// What the pool of the models is called, and how far the matrix of two bent elements is from its transpose, by central
/// differences of their forces.
fn asymmetry(models: CableModel) -> Result<(String, f64), Error> {
    let mut scene = Scene::new();
    scene.element(cable(models, 2, 1.0, Section::new(1.0, 100.0, 1.0)));
    let model = scene.build()?;
    let mut state = model.state();
    // bent, stretched and uneven
    for (k, q) in state.q.iter_mut().enumerate() {
        *q += 0.05 * (1.7 * (k as f64 + 1.0)).sin();
    }
    let n = model.velocities();
    let mut system = ropewalk_core::System::default();
    let mut force = |state: &State| {
        model.assemble(&state.at(), &state.lambda, None, &mut system);
        system.residual[..n].to_vec()
    };
    let h = 1e-5;
    let mut k = vec![vec![0.0; n]; n];
    for j in 0..n {
        let mut moved = state.clone();
        moved.q[j] += h;
        let ahead = force(&moved);
        moved.q[j] -= 2.0 * h;
        let behind = force(&moved);
        for i in 0..n {
            k[i][j] = (ahead[i] - behind[i]) / (2.0 * h);
        }
    }
    let largest = |f: &dyn Fn(usize, usize) -> f64| {
        (0..n * n).map(|m| f(m / n, m % n).abs()).fold(0.0, |a, x| if x > a || x.is_nan() { x } else { a })
    };
    Ok((model.terms()[0].label(), largest(&|i, j| k[i][j] - k[j][i]) / largest(&|i, j| k[i][j])))
}
