//! Unwinding from a package with material flow in cable elements: steady balloons of another solver, held for two turns.

mod common;

use common::{data, number};
use ropewalk_constraints::motion::SpeedTableSpec;
use ropewalk_constraints::{LiftOffSpec, PackageSpec, SphericalSpec, WinchSpec};
use ropewalk_core::integrator::{Options, Scheme, Stepping};
use ropewalk_core::{End, Scene, Simulation, V3, Water};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_forces::{DragLaw, DragSpec};
use serde_json::Value;
use std::f64::consts::TAU;

/// A row of the reference: arc length, position, tension, curvature where it is given.
type Row = [f64; 6];

struct Case {
    params: Value,
    rows: Vec<Row>,
    kappa_lift: f64,
}

fn case(file: &str, name: &str) -> Case {
    let all = data(file);
    let case = all["cases"].as_array().expect("cases").iter().find(|c| c["name"] == name).expect(name);
    let rows = case["rows"].as_array().expect("rows").iter().map(|r| {
        let x: Vec<f64> = serde_json::from_value(r.clone()).expect("numbers");
        std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
    });
    Case {
        params: case["params"].clone(),
        rows: rows.collect(),
        kappa_lift: case["kappa_lift"].as_f64().unwrap_or(0.0),
    }
}

impl Case {
    fn get(&self, key: &str) -> f64 {
        self.params[key].as_f64().unwrap_or(0.0)
    }
    /// Lagrange's interpolation over eight rows: value and derivative by arc length of column `c`.
    fn at(&self, s: f64, c: usize) -> (f64, f64) {
        let rows = &self.rows;
        let k = rows.partition_point(|r| r[0] <= s).clamp(4, rows.len() - 4) - 4;
        let (mut value, mut slope) = (0.0, 0.0);
        for i in k..k + 8 {
            let (mut l, mut dl) = (1.0, 0.0);
            for j in (k..k + 8).filter(|&j| j != i) {
                let d = rows[i][0] - rows[j][0];
                dl = (dl * (s - rows[j][0]) + l) / d;
                l *= (s - rows[j][0]) / d;
            }
            value += l * rows[i][c];
            slope += dl * rows[i][c];
        }
        (value, slope)
    }
    fn length(&self) -> f64 {
        self.rows[self.rows.len() - 1][0]
    }
}

/// What is left of a balloon after some turns.
#[derive(Debug)]
struct Kept {
    /// Largest distance of a node from where it should be, over the radius.
    shape: f64,
    /// Relative error of the tension at the eyelet, as the mean over the second half.
    tension: f64,
    /// Relative error of the curvature at the lift-off point.
    curvature: f64,
    /// Angle between cable and wound layer there.
    kink: f64,
    said: Vec<String>,
}

#[derive(Default)]
struct Said(Vec<String>);
impl ropewalk_core::Observer for Said {
    fn event(&mut self, name: &str, _: f64) {
        self.0.push(name.to_string());
    }
}

fn balloon(c: &Case, n: usize, turns: f64, per_turn: usize, eta: f64) -> Kept {
    let [m, d, radius, v, spin, t0, ei] = ["m", "d", "R", "V", "Om", "T0", "EI"].map(|k| c.get(k));
    // stiff enough that the cable is as long as the inextensible one of the reference to 1e-4
    let ea = 1e4 * t0;
    let mut section = Section::new(m, ea, ei);
    (section.diameter, section.axial_damping) = (d, eta);
    let bent = ei > 0.0;
    // material per arc length, so that the cable has the reference's tension where it starts
    let steps = 4000;
    let mut p_of = vec![0.0];
    for k in 0..steps {
        let s = c.length() * (k as f64 + 0.5) / steps as f64;
        p_of.push(p_of[k] + c.length() / steps as f64 / (1.0 + c.at(s, 4).0 / ea));
    }
    let whole = p_of[steps];
    let place = |p: f64| -> f64 {
        let k = p_of.partition_point(|x| *x <= p).clamp(1, steps) - 1;
        c.length() * (k as f64 + (p - p_of[k]) / (p_of[k + 1] - p_of[k])) / steps as f64
    };
    let start = |s: f64| -> V3<f64> { [1, 2, 3].map(|i| c.at(s, i).0) };
    let mut scene = Scene::new();
    let mut package = PackageSpec::new(radius, 0.1, 1e-9);
    package.origin = [0.0, 0.0, start(c.length())[2]];
    let speed = |name: &str, v: f64| SpeedTableSpec {
        name: name.into(),
        direction: [1.0, 0.0, 0.0],
        file: None,
        t: vec![0.0, 1e6],
        v: vec![v; 2],
    };
    scene
        .element(CableSpec {
            length: Some(whole),
            ..CableSpec::straight("fibre", start(0.0), start(c.length()), n, section)
        })
        .motion(speed("draw", -v))
        .motion(speed("peel", v))
        .constraint(SphericalSpec::new("eyelet", "fibre.start", [0.0; 3]))
        .constraint(WinchSpec::motion("pull", "fibre.start", "draw"))
        .constraint(WinchSpec::motion("spool", "fibre.end", "peel"))
        .constraint(LiftOffSpec { name: "off".into(), marker: "fibre.end".into(), package, tangent: bent });
    if c.get("rho") > 0.0 {
        scene.water = Some(Water { density: c.get("rho"), ..Water::default() });
        let law = if c.params["model"] == "choo" { DragLaw::ChooCasarella } else { DragLaw::Constant };
        scene.force(DragSpec {
            normal: law,
            tangential: law,
            cn: c.get("Cn"),
            ct: c.get("Ct"),
            ..DragSpec::default()
        });
    }
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut state = model.state();
    let mut expected = Vec::new();
    for k in 0..=n {
        let s = place(whole * k as f64 / n as f64);
        let stretch = 1.0 + c.at(s, 4).0 / ea;
        for i in 0..3 {
            let (x, slope) = c.at(s, i + 1);
            (state.q[6 * k + i], state.q[6 * k + 3 + i]) = (x, slope * stretch);
        }
        let turning = |x: &[f64]| [-spin * x[1], spin * x[0], 0.0];
        for at in [6 * k, 6 * k + 3] {
            let v = turning(&state.q[at..at + 3]);
            state.v[at..at + 3].copy_from_slice(&v);
        }
        expected.push([0, 1, 2].map(|i| state.q[6 * k + i]));
    }
    (state.v[6 * (n + 1)], state.v[6 * (n + 1) + 1]) = (v, v);
    let turn = TAU / spin;
    let h = turn / per_turn as f64;
    let options = Options {
        stepping: Stepping::Fixed { h },
        scheme: Scheme::GeneralizedAlpha { rho_inf: 0.8 },
        ..Options::default()
    };
    let mut s = Simulation::from(model, state, &options, turns * turn).unwrap_or_else(|e| panic!("{e}"));
    let mut kept = Kept { shape: 0.0, tension: 0.0, curvature: 0.0, kink: 0.0, said: Vec::new() };
    let mut said = Said::default();
    let eyelet = s.model.constraints().iter().position(|c| c.name() == "pull").expect("the winch");
    let samples = 40;
    for k in 1..=samples {
        let t = turns * turn * f64::from(k) / f64::from(samples);
        let end = s.advance(t, f64::INFINITY, &mut said).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(end, End::Done);
        let (sin, cos) = (spin * t).sin_cos();
        for (k, e) in expected.iter().enumerate() {
            let x = &s.state.q[6 * k..6 * k + 3];
            let should = [cos * e[0] - sin * e[1], sin * e[0] + cos * e[1], e[2]];
            let off: f64 = (0..3).map(|i| (x[i] - should[i]).powi(2)).sum::<f64>().sqrt();
            kept.shape = kept.shape.max(off / radius);
        }
        if 2 * k > samples {
            let pull = s.state.lambda[s.model.rows_of(eyelet).start];
            kept.tension += 2.0 / f64::from(samples) * (pull / (1.0 + t0 / ea) / t0 - 1.0);
        }
    }
    if bent {
        let part = s.model.part("fibre").expect("fibre");
        let kappa = part
            .observe(ropewalk_core::Quantity::Curvature, part.length_now(&s.state.at()), &s.state.at())
            .expect("curvature");
        kept.curvature = kappa / c.kappa_lift - 1.0;
        let angle = spin * turns * turn;
        let layer = [-angle.sin(), angle.cos(), 0.0];
        let slope = &s.state.q[6 * n + 3..6 * n + 6];
        let size = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
        let along: f64 = (0..3).map(|i| layer[i] * slope[i] / size).sum();
        kept.kink = along.clamp(-1.0, 1.0).acos();
    }
    kept.said = said.0;
    kept
}

#[test]
fn steady_balloons_turn_on_as_they_are() {
    for (name, eta) in [("low_const_5kn_a", 0.0), ("low_choo_15kn_a", 0.0), ("flex_nodrag_5kn_T0.05", 2e-4)] {
        let c = case("flow/balloon.json", name);
        let mut shapes = Vec::new();
        for n in [5, 10] {
            let kept = balloon(&c, n, 2.0, 400, eta);
            eprintln!("{name} {n}: {kept:?}");
            shapes.push(kept.shape);
            if n == 10 {
                assert!(kept.tension.abs() < 1e-3, "{name}: {kept:?}");
                assert!(kept.shape < 1e-4, "{name}: {kept:?}");
            }
        }
    }
}

#[test]
fn steady_balloons_with_bending_stiffness_lie_along_the_wound_layer() {
    for name in ["low_bend_const_5kn_a", "bend_nodrag_15kn"] {
        let c = case("flow/balloon_bend.json", name);
        let kept = balloon(&c, 20, 2.0, 400, 1e-4);
        eprintln!("{name}: {kept:?}");
    }
}
