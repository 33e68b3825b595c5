//! An assembly of one's own: a slack line under water between a mooring and a buoy that heaves in the waves; from
//! the middle of the line hangs a second cable with a sinker at its end.
//!
//! `cargo run --release --example custom_assembly`

use ropewalk::constraints::motion::HarmonicSpec;
use ropewalk::constraints::{DrivingSpec, SphericalSpec};
use ropewalk::core::Quantity;
use ropewalk::core::integrator::Stepping;
use ropewalk::elements::{CableSpec, PointMassSpec, Section};
use ropewalk::forces::{AddedMassSpec, BuoyancySpec, DragSpec, GravitySpec};
use ropewalk::scene::records::{AlongSpec, EnergySpec, PositionSpec, RecordPlace};
use ropewalk::{Error, Scene, Water, simulate};

pub(crate) fn main() -> Result<(), Error> {
    // mass [kg/m], EA [N], EI [N m²]; what isn't said is zero, such as water inside
    let rope = Section { diameter: 0.02, axial_retardation_time: 0.01, ..Section::new(0.5, 2e5, 0.5) };
    let mut scene = Scene::new();
    scene.water = Some(Water { current: [0.3, 0.0, 0.0].map(Into::into), ..Water::default() });
    scene
        // laid straight, but 5 % longer than the way between its ends
        .element(CableSpec::straight("line", [0.0; 3], [12.0, 0.0, 0.0], 16, rope.clone()).unstretched(12.6))
        .element(CableSpec::straight("drop", [6.0, 0.0, 0.0], [6.0, 0.0, -3.0], 6, rope))
        .element(PointMassSpec {
            volume: 1e-3,
            drag_area: 0.02,
            ..PointMassSpec::new("sinker", "drop.end", 8.0)
        })
        // without a second marker it is held where it starts
        .constraint(SphericalSpec::pin("mooring", "line.start"))
        // a marker at any unstretched arc length; the line puts a node there
        .constraint(SphericalSpec::new("knot", "drop.start", "line@6.3m"))
        .constraint(DrivingSpec::new("buoy", "line.end", "waves"))
        .motion(HarmonicSpec {
            name: "waves".into(),
            amplitude: [0.0, 0.0, 0.4].map(Into::into),
            frequency: 0.25.into(),
            phase: 0.0,
            start: 0.0,
            ramp: 4.0, // rises smoothly, since no finite force follows a jump
        })
        // only what is named acts
        .force(GravitySpec::default())
        .force(BuoyancySpec::default())
        .force(DragSpec::default())
        .force(AddedMassSpec::default())
        .record(PositionSpec::new("sinker"))
        .record(AlongSpec::new("line", Quantity::Tension, RecordPlace::End))
        .record(EnergySpec::default());
    scene.run.duration = 20.0;
    scene.run.output = 0.05;
    scene.run.from_equilibrium = true;
    scene.solver.stepping = Stepping::Controlled { tolerance: 1e-3 };

    let history = simulate(&scene)?;
    let column = |name: &str| history.column(name).unwrap_or_else(|| panic!("there is no column {name}"));
    // the last period of the waves
    let from = history.times().partition_point(|t| *t < scene.run.duration - 4.0);
    let range = |name: &str| {
        column(name)[from..].iter().fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(*x), b.max(*x)])
    };

    let [low, high] = range("sinker.z");
    println!("the sinker hangs at z = {:.3} m before the waves come", column("sinker.z")[0]);
    println!("then it goes between z = {low:.3} m and {high:.3} m");
    let [slack, taut] = range("line.end.tension");
    println!("the tension at the buoy goes between {slack:.1} N and {taut:.1} N");
    println!("the balance of energy is off by {:.1e} J", history.audit.imbalance());
    Ok(())
}
