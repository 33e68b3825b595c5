//! scratch measure
use ropewalk_constraints::SphericalSpec;
use ropewalk_core::integrator::{NewtonPolicy, Options, Stepping, Workspace};
use ropewalk_core::{Guard, Scene, Simulation, System, Weights};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_forces::*;
use std::time::Instant;

fn best(n: usize, mut f: impl FnMut()) -> f64 {
    let mut b = f64::MAX;
    let reps = (4000 / n).max(1);
    let end = Instant::now();
    while end.elapsed().as_secs_f64() < 0.4 {
        let t = cpu_time::ThreadTime::now();
        for _ in 0..reps {
            f();
        }
        b = b.min(t.elapsed().as_secs_f64() / reps as f64);
    }
    b * 1e6 / n as f64
}

fn main() {
    let wet = std::env::args().any(|a| a == "wet");
    for n in [8usize, 32, 512, 8192] {
        let mut section = Section::new(0.5, 5000.0, 0.1);
        section.diameter = 0.02;
        let mut scene = Scene::new();

        scene
            .element(CableSpec::straight("c", [0.0; 3], [1.0, 0.0, 0.0], n, section))
            .constraint(SphericalSpec::pin("pin", "c.start"))
            .force(GravitySpec { g: [0.0, -9.81, 0.0], ..Default::default() });
        if wet {
            scene.water = Some(Default::default());
            scene.force(BuoyancySpec::default()).force(DragSpec::default()).force(AddedMassSpec::default());
        }
        let mut last = String::new();
        for policy in [NewtonPolicy::Full, NewtonPolicy::Modified] {
            let model = scene.build().unwrap();
            let options =
                Options { stepping: Stepping::Fixed { h: 1e-3 }, newton: policy, ..Options::default() };
            let mut s = Simulation::new(model, &options, 1.0).unwrap();
            s.keep_audit(false);
            s.advance(0.02, 1.0, &mut ()).unwrap();
            let c0 = s.work.counts;
            let steps = (200_000 / n).clamp(40, 980);
            let t = cpu_time::ThreadTime::now();
            s.advance(0.02 + steps as f64 * 1e-3, 10.0, &mut ()).unwrap();
            let e = t.elapsed().as_secs_f64() * 1e6 / n as f64;
            let c = s.work.counts;
            let (st, it, fa) = (
                c.steps - c0.steps,
                c.newton_iterations - c0.newton_iterations,
                c.factorizations - c0.factorizations,
            );
            last += &format!(
                " | {policy:?}: {:.3}/step {:.3}/it ({:.2} it {:.2} fac)",
                e / st as f64,
                e / it as f64,
                it as f64 / st as f64,
                fa as f64 / st as f64
            );
            if policy == NewtonPolicy::Full {
                let (model, state) = (s.model.clone(), s.state.clone());
                let mut sys = System::default();
                let w = Weights { q: 3e-7, v: 6e-4, a: 1.2 };
                let at = state.at();
                let r = best(n, || model.assemble(&at, &state.lambda, None, &mut sys));
                if std::env::args().any(|a| a == "konly") && n == 512 {
                    for _ in 0..20000 {
                        model.assemble(&at, &state.lambda, Some(w), &mut sys);
                    }
                    return;
                }
                let k = best(n, || model.assemble(&at, &state.lambda, Some(w), &mut sys));
                let mut g = Guard::new(model.structure()).unwrap();
                let f = best(n, || g.factor(model.structure(), &sys.values).unwrap());
                let mut x = vec![1e-3; model.structure().n];
                let c = best(n, || {
                    g.factor(model.structure(), &sys.values).unwrap();
                    x.fill(1e-3);
                    g.solve(model.structure(), &sys.values, &mut x).unwrap()
                }) - f;
                let so = best(n, || {
                    x.fill(1e-3);
                    g.solve(model.structure(), &sys.values, &mut x).unwrap()
                });
                print!(
                    "n {n}: r {r:.3} r+K {k:.3} factor {f:.3} checked solve {c:.3} solve {so:.3} {}",
                    g.name()
                );
            }
            let _ = Workspace::new(&s.model);
        }
        println!("{last}");
    }
}
