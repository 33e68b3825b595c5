use ropewalk_constraints::motion::*;
use ropewalk_core::{Motion, Moving, V3};
use ropewalk_forces::*;
use ropewalk_models::unwinding::*;
use std::sync::Arc;
#[derive(Debug)]
struct Steady(f64);
impl Motion for Steady {
    fn at(&self, t: f64) -> Moving {
        Moving { x: [self.0 * t, 0., 0.], v: [self.0, 0., 0.], a: [0.; 3] }
    }
}
fn case(file: &str, name: &str, n: usize) -> (Unwinding, serde_json::Value) {
    let text = std::fs::read_to_string(format!("tests/data/{file}.json")).unwrap();
    let all: serde_json::Value = serde_json::from_str(&text).unwrap();
    let c = all["cases"].as_array().unwrap().iter().find(|c| c["name"] == name).unwrap().clone();
    let p = &c["params"];
    let f = |k: &str| p[k].as_f64().unwrap_or(0.0);
    let cable = Cable { mass: f("m"), diameter: f("d"), bending: f("EI"), curvature_limit: 1e9 };
    let ring = Ring {
        radius: f("R"),
        height: f("h"),
        climb: p["tL"][2].as_f64().unwrap_or(0.0).asin(),
        inner: true,
    };
    let mut u = Unwinding::new(
        cable,
        Arc::new(ring),
        Arc::new(Steady(f("V"))),
        Rule::Tension(Pull::constant(f("T0"))),
        n,
    );
    if f("rho") > 0.0 {
        let choo = p["model"] == "choo";
        let (a, b) = if choo {
            (NormalLaw::ChooCasarella, TangentialLaw::ChooCasarella)
        } else {
            (NormalLaw::Constant(f("Cn")), TangentialLaw::Quadratic(f("Ct")))
        };
        u.drag = Some(Drag::new(f("rho"), 1.08e-3, a, b).unwrap());
    }
    if f("EI") > 0.0 {
        u.lift_off = LiftOff::Tangent;
    }
    (u, c)
}
fn points(c: &serde_json::Value) -> Vec<V3<f64>> {
    c["rows"].as_array().unwrap().iter().map(|r| [1, 2, 3].map(|i| r[i].as_f64().unwrap())).collect()
}
#[test]
fn steady() {
    for (file, name) in [
        ("balloon", "flex_nodrag_15kn_T0.5"),
        ("balloon", "flex_nodrag_15kn_T0.34"),
        ("balloon", "flex_water_15kn_b"),
        ("balloon", "low_const_5kn_a"),
        ("balloon", "low_choo_15kn_b"),
        ("balloon_bend", "bend_nodrag_15kn"),
        ("balloon_bend", "low_bend_const_5kn_a"),
        ("balloon_bend", "bend_water_5kn_a"),
    ] {
        for n in [20, 40, 80] {
            let (u, c) = case(file, name, n);
            let f = |k: &str| c[k].as_f64().unwrap();
            let t = std::time::Instant::now();
            match u.steady(c["params"]["V"].as_f64().unwrap(), f("T_eyelet"), 0.0) {
                Ok(b) => println!(
                    "{name} {n}: L {:.3e} Tl {:.3e} ({}) kL {} vs {}  {:?}",
                    b.shape.length / f("L") - 1.0,
                    b.lift_tension - f("T_lift"),
                    f("T_lift"),
                    b.shape.curvature[n],
                    c["kappa_lift"],
                    t.elapsed()
                ),
                Err(e) => println!("{name} {n}: {e} {:?}", t.elapsed()),
            }
        }
    }
    let (u, _) = case("balloon", "flex_nodrag_15kn_T0.5", 40);
    println!("{:?}", u.steady(7.716666666666667, 0.25, 0.0).err());
}
#[test]
fn turns() {
    for (file, name) in [
        ("balloon", "low_const_5kn_a"),
        ("balloon_bend", "low_bend_const_5kn_a"),
        ("balloon_bend", "bend_nodrag_15kn"),
        ("balloon_bend", "bend_water_5kn_a"),
    ] {
        for rule in ["length", "tension"] {
            for (n, d) in [(20, 0.0), (40, 0.0), (40, 0.05)] {
                let (mut u, c) = case(file, name, n);
                let f = |k: &str| c[k].as_f64().unwrap();
                let om = c["params"]["Om"].as_f64().unwrap();
                let r = c["params"]["R"].as_f64().unwrap();
                let turn = 2.0 * std::f64::consts::PI / om;
                if rule == "length" {
                    u.rule = Rule::Length;
                }
                let pts = points(&c);
                let y = match u.start(&pts, om, 0.0) {
                    Ok(y) => y,
                    Err(e) => {
                        println!("{name} {rule} {n}: {e}");
                        continue;
                    }
                };
                let x0 = y.x.clone();
                let t = std::time::Instant::now();
                let h = turn / 400.0;
                let plan = Plan {
                    t_end: 2.0 * turn,
                    every: turn / 100.0,
                    shapes: (1..=8).map(|k| k as f64 * turn / 4.0).collect(),
                };
                let hist = u.run(y, Stepping { damping: d, ..Stepping::new(h) }, &plan).unwrap();
                let mut dev = 0.0f64;
                for s in &hist.shapes {
                    let (sn, cs) = (om * s.t).sin_cos();
                    for (j, x) in s.x.iter().enumerate() {
                        let p = x0[j];
                        let q = [cs * p[0] - sn * p[1], sn * p[0] + cs * p[1], p[2]];
                        dev = dev.max((0..3).map(|i| (q[i] - x[i]).powi(2)).sum::<f64>().sqrt());
                    }
                }
                let (lo, hi) =
                    hist.rows.iter().fold((9e9f64, -9e9f64), |a, r| (a.0.min(r.tension), a.1.max(r.tension)));
                let l = hist.rows.last().unwrap();
                println!(
                    "{name} {rule} {n} {d}: dev/R {:.3e} T0 {:.5}..{:.5} last {:.6} vs {} L {:.3e} (start {:.3e}) Tl {:.5} vs {} kL {:.3} march {:.2e} it {} halv {} {:?} {:?}",
                    dev / r,
                    lo,
                    hi,
                    l.tension,
                    f("T_eyelet"),
                    l.length / f("L") - 1.0,
                    hist.rows[0].length / f("L") - 1.,
                    l.lift_tension,
                    f("T_lift"),
                    l.lift_curvature,
                    l.marching,
                    hist.iterations,
                    hist.halvings,
                    hist.stopped.map(|s| s.to_string()),
                    t.elapsed()
                );
                for c in hist.conditions.iter().take(4) {
                    println!("     {c}");
                }
            }
        }
    }
}
#[test]
fn debug_bend() {
    let (mut u, c) = case("balloon_bend", "bend_water_5kn_a", 40);
    let om = c["params"]["Om"].as_f64().unwrap();
    let turn = 2.0 * std::f64::consts::PI / om;
    u.rule = Rule::Length;
    let y = u.start(&points(&c), om, 0.0).unwrap();
    let plan = Plan { t_end: 0.1 * turn, every: turn / 100.0, shapes: vec![] };
    let hist = u.run(y, Stepping::new(turn / 400.0), &plan).unwrap();
    println!("halv {} it {}", hist.halvings, hist.iterations);
}
