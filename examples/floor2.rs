use ropewalk_constraints::SphericalSpec;
use ropewalk_core::integrator::{NewtonPolicy, Options, Stepping};
use ropewalk_core::{Scene, Simulation};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_forces::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: usize = a[1].parse().unwrap();
    let newton = if a[2] == "full" { NewtonPolicy::Full } else { NewtonPolicy::Modified };
    let steps: usize = a[3].parse().unwrap();
    let reps: usize = a[4].parse().unwrap();
    let mut best = f64::MAX;
    for _ in 0..reps {
        let mut scene = Scene::new();
        scene
            .element(CableSpec::straight("c", [0.0; 3], [1.0, 0.0, 0.0], n, Section::new(0.5, 5000.0, 0.1)))
            .constraint(SphericalSpec::pin("pin", "c.start"))
            .force(GravitySpec { g: [0.0, -9.81, 0.0], ..Default::default() });
        let options = Options { stepping: Stepping::Fixed { h: 1e-3 }, newton, ..Options::default() };
        let mut s = Simulation::new(scene.build().unwrap(), &options, 1.0).unwrap();
        s.keep_audit(false);
        let t = cpu_time::ThreadTime::now();
        s.advance(steps as f64 * 1e-3, 10.0, &mut ()).unwrap();
        let e = t.elapsed().as_secs_f64() * 1e6 / n as f64 / steps as f64;
        if e < best {
            best = e;
            println!("{e:.3} µs/step/el {:?}", s.work.counts);
        }
    }
}
