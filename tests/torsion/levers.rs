//! Levers on cables with torsion, against closed forms and against bodies that are welded there.

use super::{apart, last, place, run};
use ropewalk::core::model::twist::laid;
use ropewalk::core::testing::{check_tangent, dense, difference};
use ropewalk::core::{At, Marker, Node, NodeId, NodeKind, Term, Weights, Width, retract};
use ropewalk::elements::PointMass;
use ropewalk::forces::{PointForce, Spring, TimeFunction};

/// A rod along x, clamped at its start, with a crank at its end that a force or something else pulls at.
fn rod(analysis: &str, crank: &str, more: &str) -> String {
    format!(
        r#"
        [run]
        {analysis}
        [[elements]]
        type = "cable"
        name = "rod"
        points = [[0, 0, 0], [1.6, 0, 0]]
        elements = 6
        section = {{ mass = 1, ea = 1e4, ei = 2.0, gj = 0.8, rotary_inertia = 0.01 }}
        {crank}
        [[constraints]]
        type = "clamp"
        name = "root"
        marker = "rod.start"
        {more}
        [[records]]
        type = "position"
        of = "rod.end"
        [[records]]
        type = "reaction"
        of = "root"
        [[records]]
        type = "along"
        of = "rod"
        what = "torque"
        at = "end"
        [[records]]
        type = "along"
        of = "rod"
        what = "angle"
        at = "end"
        "#
    )
}

const STATICS: &str = "analysis = \"statics\"";
const SLOWLY: &str = "time = { table = { t = [0, 1], value = [0, 1] } }";

#[track_caller]
fn close(what: &str, found: f64, exact: f64, off: f64) {
    println!("{what}: {found}, exact {exact}");
    assert!((found - exact).abs() <= off, "{what}: {found} instead of {exact}");
}

/// Two forces at two cranks on either side are a couple that turns by less as they turn: `2 F a cos φ = GJ φ/L`.
#[test]
fn two_forces_at_cranks_twist_a_rod() {
    let cranks = "[elements.levers]\nleft = { at = \"end\", offset = [0, \"20 cm\", 0] }\nright = { at = \"100 %\", offset = [0, -0.2, 0] }";
    let force = |at: &str, f: f64| {
        format!("[[forces]]\ntype = \"point_force\"\nmarker = \"rod.{at}\"\nforce = [0, 0, {f}]\n{SLOWLY}")
    };
    let more = format!(
        "{}\n{}\n[[records]]\ntype = \"position\"\nof = \"rod.left\"",
        force("left", 3.0),
        force("right", -3.0)
    );
    let h = run(&rod(STATICS, cranks, &more), &[]);
    let mut angle = 1.0_f64;
    for _ in 0..50 {
        let (off, slope) = (1.2 * angle.cos() - 0.5 * angle, -1.2 * angle.sin() - 0.5);
        angle -= off / slope;
    }
    close("angle", last(&h, "rod.end.angle"), angle, 1e-9);
    close("torque", last(&h, "rod.end.torque"), 0.5 * angle, 1e-9);
    let at = place(&h, "rod.left");
    assert!(apart(at, [1.6, 0.2 * angle.cos(), 0.2 * angle.sin()]) <= 1e-9, "{at:?}");
}

/// A crank of nothing but its place, and a body without mass that is welded to the end.
fn both(analysis: &str, pulled: impl Fn(&str) -> String, tolerance: f64) {
    let crank = "levers.crank = { at = \"end\", offset = [0.05, 0.2, -0.1] }";
    let body = r#"
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [1.6, 0, 0]
        mass = 1e-9
        inertia = [1e-12, 1e-12, 1e-12]
        points = { crank = [0.05, 0.2, -0.1] }
        [[constraints]]
        type = "weld"
        name = "joint"
        marker = "rod.end"
        to = "block"
    "#;
    let own = run(&rod(analysis, crank, &pulled("rod.crank")), &[]);
    let with_body = run(&rod(analysis, "", &format!("{body}\n{}", pulled("block.crank"))), &[]);
    for name in ["rod.end.angle", "rod.end.torque", "rod.end.x", "rod.end.y", "rod.end.z"]
        .into_iter()
        .map(String::from)
        .chain(["x", "y", "z"].map(|i| format!("root.f{i}")))
        .chain(["x", "y", "z"].map(|i| format!("root.m{i}")))
    {
        close(&name, last(&own, &name), last(&with_body, &name), tolerance);
    }
    let moved = apart(place(&own, "rod.end"), [1.6, 0.0, 0.0]);
    assert!(moved > 0.05, "it moved by {moved} m only");
}

#[test]
fn a_force_at_a_lever_is_one_on_a_body_that_is_welded_there() {
    let force = |at: &str| {
        format!("[[forces]]\ntype = \"point_force\"\nmarker = \"{at}\"\nforce = [-0.4, 0.9, 1.3]\n{SLOWLY}")
    };
    both(STATICS, force, 1e-8);
}

#[test]
fn a_spring_at_a_lever_is_one_on_a_body_that_is_welded_there() {
    let spring = |at: &str| {
        format!(
            "[[forces]]\ntype = \"spring\"\nname = \"spring\"\nmarker = \"{at}\"\nto = [1.2, 0.9, 1.1]\nstiffness = 2\nlength = 0.1"
        )
    };
    both(STATICS, spring, 1e-8);
}

#[test]
fn a_joint_at_a_lever_holds_as_one_on_a_body_that_is_welded_there() {
    let pin = |at: &str| {
        format!(
            r#"
            [[constraints]]
            type = "spherical"
            name = "pin"
            marker = "{at}"
            to = [1.65, 0.2, -0.1]
            [[forces]]
            type = "point_force"
            marker = "rod@50%"
            force = [0.3, 2.5, 4.0]
            {SLOWLY}
            "#
        )
    };
    both(STATICS, pin, 1e-8);
}

/// A mass on a lever swings the rod as one on a body without mass does.
#[test]
fn a_mass_on_a_lever_swings_as_on_a_body_without_mass() {
    let run_for = "duration = 0.6\noutput = 0.1\n[solver]\nscheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-9 } }\nforce_tolerance = 1e-5";
    let mass = |at: &str| {
        format!(
            r#"
            [[elements]]
            type = "point_mass"
            name = "bob"
            marker = "{at}"
            mass = 0.5
            [[forces]]
            type = "gravity"
            "#
        )
    };
    both(run_for, mass, 2e-5);
}

#[test]
fn levers_that_cannot_be_are_refused() {
    let says = |crank: &str, what: &str| {
        let text = rod(STATICS, crank, "");
        let file = ropewalk_scene::SceneFile::parse(&text, "scene", ropewalk_scene::Format::Toml, &[]);
        let error = match file {
            Ok(file) => file.into_scene().build().err().map(|e| e.to_string()),
            Err(e) => Some(e.to_string()),
        };
        let error = error.unwrap_or_default();
        assert!(error.contains(what), "{crank}: {error}");
    };
    says("levers.crank = { at = \"2 m\", offset = [0, 0, 1] }", "goes from 0 to 1.6 m");
    says("levers.crank = { at = \"middle\", offset = [0, 0, 1] }", "at a length or share");
    says("levers.end = { at = \"end\", offset = [0, 0, 1] }", "can't name a lever");
}

/// Forces, springs with damping and masses on a lever: tangents against differences, and a mass's power against its energy.
#[test]
fn what_acts_on_a_lever_has_exact_tangents() {
    let node = |kind, q, v| Node { kind, q, v, shared: false };
    let nodes = [node(NodeKind::Twist, 0, 0), node(NodeKind::Twist, 10, 7)];
    let numbers =
        |n: usize, seed: f64| -> Vec<f64> { (1..=n).map(|k| 2.0 * (seed * (k * k) as f64).sin()).collect() };
    let lever = Marker::beside(NodeId(0), [0.3, -0.7, 0.4]);
    let other = Marker::beside(NodeId(1), [-0.2, 0.1, 0.5]);
    let mut spring = Spring::new("spring", &nodes, [lever, other], 3.0, 0.5).expect("spring");
    spring.damping = 0.7.into();
    let force = PointForce::dead("force", &nodes, &lever, [1.0, -2.0, 0.5], TimeFunction::default());
    let mass = PointMass::new("mass", &nodes, &lever, 1.3).expect("mass");
    for seed in [0.3, 0.7, 1.1, 1.9] {
        let x = numbers(20, seed);
        let end = |x: &[f64]| laid(&[x[0], x[1], x[2]], &[x[3], x[4], x[5]], &[x[6], x[7], x[8]], x[9]);
        let q: Vec<f64> = [end(&x[..10]), end(&x[10..])].concat();
        let (v, a) = (numbers(14, seed + 0.1), numbers(14, seed + 0.2));
        let at = At { t: 0.0, q: &q, v: &v, a: &a, internal: &[], relaxed: None };
        let still = At { a: &[0.0; 14], ..at };
        for term in [&spring as &dyn Term, force.as_ref().expect("force"), &mass] {
            let error = check_tangent(term, &nodes, &still, Width::One);
            assert!(error <= 1e-7, "{} at {seed}: {error:e}", term.label());
        }
        // with accelerations too, of which the tangent leaves out the same
        let of_q = Weights { q: 1.0, ..Weights::default() };
        let (r, k) = dense(&mass, &nodes, &at, of_q, Width::One);
        let p = [q[3], q[4], q[5]];
        let size = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        for j in 0..7 {
            let mut numeric = difference(|h| {
                let (mut step, mut turned) = (vec![0.0; 14], q.clone());
                step[j] = h;
                retract(&nodes, &q, &step, &mut turned);
                dense(&mass, &nodes, &At { q: &turned, ..at }, Weights::default(), Width::One).0
            });
            for (i, l, m) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
                let left_out = 0.5 * r[6] * p[m] / size.powi(3);
                if j == 3 + l {
                    numeric[3 + i] += left_out;
                }
                if j == 3 + i {
                    numeric[3 + l] -= left_out;
                }
            }
            let most = numeric.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            for i in 0..7 {
                let off = (k[i][j] - numeric[i]).abs() / most;
                assert!(off <= 1e-7, "{i} {j} at {seed}: {} {}", k[i][j], numeric[i]);
            }
        }
        let rate = difference(|h| {
            let v: Vec<f64> = v.iter().zip(&a).map(|(v, a)| v + h * a).collect();
            let step: Vec<f64> = at.v.iter().map(|v| h * v).collect();
            let mut turned = q.clone();
            retract(&nodes, &q, &step, &mut turned);
            vec![mass.energy(&At { q: &turned, v: &v, ..at }).kinetic]
        })[0];
        let (r, _) = dense(&mass, &nodes, &at, Weights::default(), Width::One);
        let work: f64 = r.iter().zip(&v).map(|(r, v)| r * v).sum();
        assert!((rate - work).abs() <= 1e-7 * work.abs(), "{rate} {work}");
    }
}
