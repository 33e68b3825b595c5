//! Terms that act at points: tangents, power and limits.

use crate::random::{Random, rotate};
use ropewalk_core::testing::{check_tangent, dense};
use ropewalk_core::{At, DeadLoad, Marker, Node, NodeId, NodeKind, Term, Weights, Width};
use ropewalk_forces::{PointForce, PointMoment, Spring, TimeFunction};

/// A point, a cable node, a body and another cable node.
fn nodes() -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for kind in [
        NodeKind::Point,
        NodeKind::Slope,
        NodeKind::Frame,
        NodeKind::Slope,
        NodeKind::Scalars(1),
        NodeKind::Twist,
    ] {
        let (q, v) = all.last().map_or((0, 0), |n| (n.coords().end, n.dofs().end));
        all.push(Node { kind, q, v, shared: false });
    }
    all
}

struct Numbers {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl Numbers {
    fn new(seed: u64) -> Self {
        let mut r = Random(seed);
        let mut s = Numbers { q: r.list(33, 2.0), v: r.list(29, 2.0), a: r.list(29, 2.0) };
        let norm: f64 = s.q[12..16].iter().map(|x| x * x).sum::<f64>().sqrt();
        s.q[12..16].iter_mut().for_each(|x| *x /= norm);
        let three = |i: usize| [s.q[i], s.q[i + 1], s.q[i + 2]];
        let section = ropewalk_core::model::twist::laid(&three(23), &three(26), &three(29), s.q[32]);
        s.q[23..33].copy_from_slice(&section);
        s
    }
    fn at(&self) -> At<'_> {
        At { t: 0.3, q: &self.q, v: &self.v, a: &self.a, internal: &[], relaxed: None }
    }
}

const POINT: NodeId = NodeId(0);
const CABLE: NodeId = NodeId(1);
const BODY: NodeId = NodeId(2);
const OTHER: NodeId = NodeId(3);
const NUMBER: NodeId = NodeId(4);
const SECTION: NodeId = NodeId(5);

fn harmonic() -> TimeFunction {
    TimeFunction::Harmonic { mean: 1.0, amplitude: 0.5, frequency: 0.7, phase: 0.1 }
}

fn springs() -> Vec<Spring> {
    let (nodes, node) = (nodes(), Marker::node);
    let ground = Marker::ground([0.3, -4.0, 0.5]);
    let mut all = Vec::new();
    for pair in [
        [node(POINT), node(CABLE)],
        [node(OTHER), node(BODY)],
        [ground, node(CABLE)],
        [node(POINT), ground],
        [node(CABLE), Marker::beside(BODY, [0.3, -0.4, 0.6])],
    ] {
        for (damping, rest_length, tension_only) in
            [(0.0, 1.0, false), (7.0, 1.0, false), (7.0, 0.1, true), (7.0, 0.0, false)]
        {
            let mut s = Spring::new("spring", &nodes, pair, 100.0, rest_length).unwrap();
            (s.damping, s.tension_only) = (damping.into(), tension_only);
            all.push(s);
        }
    }
    all
}

fn terms() -> Vec<Box<dyn Term>> {
    let nodes = nodes();
    let force = [1.0, -2.0, 3.0];
    let mut all: Vec<Box<dyn Term>> = Vec::new();
    for node in [POINT, CABLE, BODY] {
        all.push(Box::new(PointForce::dead("f", &nodes, &Marker::node(node), force, harmonic()).unwrap()));
        let dead = DeadLoad::at_marker(&nodes, &Marker::node(node), force).unwrap();
        all.push(Box::new(DeadLoad::new("w", dead).unwrap()));
    }
    all.push(Box::new(PointMoment::along("m", &nodes, SECTION, 3.0, harmonic()).unwrap()));
    for node in [CABLE, OTHER, SECTION] {
        all.push(Box::new(PointForce::follower("f", &nodes, node, 12.0, harmonic()).unwrap()));
        all.push(Box::new(PointMoment::new("m", &nodes, node, force, harmonic()).unwrap()));
    }
    let beside = Marker::beside(BODY, [0.3, -0.4, 0.6]);
    all.push(Box::new(PointForce::dead("f", &nodes, &beside, force, harmonic()).unwrap()));
    all.push(Box::new(PointForce::on_body("f", &nodes, &beside, force, harmonic()).unwrap()));
    all.push(Box::new(PointMoment::new("m", &nodes, BODY, force, harmonic()).unwrap()));
    all.push(Box::new(PointMoment::on_body("m", &nodes, BODY, force, harmonic()).unwrap()));
    let held = ropewalk_core::held::Held::new(&nodes, &beside, "w").unwrap();
    all.push(Box::new(ropewalk_core::DeadPull { label: "w".into(), held, force }));
    all.extend(springs().into_iter().map(|s| Box::new(s) as Box<dyn Term>));
    all
}

/// The work rate of a term's residual on the velocities.
fn work(term: &dyn Term, at: &At<'_>) -> f64 {
    let (r, _) = dense(term, &nodes(), at, Weights::default(), Width::One);
    r.iter().zip(at.v).map(|(r, v)| r * v).sum()
}

#[test]
fn tangents_are_exact() {
    let mut worst = 0.0_f64;
    for seed in 1..=8 {
        let s = Numbers::new(seed);
        for term in terms() {
            for width in [Width::One, Width::Eight] {
                let error = check_tangent(&*term, &nodes(), &s.at(), width);
                assert!(error < 1e-7, "{} at state {seed}: {error}", term.label());
                worst = worst.max(error);
            }
        }
    }
    println!("tangents of terms: {worst:.1e}");
}

#[test]
fn energy_balances_power() {
    // dE/dt along v and a, less what is supplied and plus what is lost, is the work of the residual
    for seed in 1..=4 {
        let s = Numbers::new(seed);
        for term in terms() {
            let at = s.at();
            let rate = ropewalk_core::testing::difference(|h| {
                let mut q = s.q.clone();
                ropewalk_core::retract(
                    &nodes(),
                    &s.q,
                    &s.v.iter().map(|v| h * v).collect::<Vec<_>>(),
                    &mut q,
                );
                let v: Vec<f64> = s.v.iter().zip(&s.a).map(|(v, a)| v + h * a).collect();
                let e = term.energy(&At { q: &q, v: &v, ..at });
                vec![e.kinetic + e.potential]
            })[0];
            let p = term.power(&at);
            assert!(p.dissipated >= 0.0, "{}", term.label());
            let balance = rate + p.dissipated - p.supplied;
            let done = work(&*term, &at);
            assert!((balance - done).abs() < 1e-7 * (1.0 + done.abs()), "{}: {balance} {done}", term.label());
        }
    }
}

#[test]
fn moment_on_the_slope_does_the_work_of_a_turn() {
    // r' turning at ω takes up (m_normal)·ω
    let nodes = nodes();
    let mut s = Numbers::new(3);
    let omega = [0.3, -0.5, 0.9];
    let p = [s.q[6], s.q[7], s.q[8]];
    s.v[6..9].copy_from_slice(&[
        omega[1] * p[2] - omega[2] * p[1],
        omega[2] * p[0] - omega[0] * p[2],
        omega[0] * p[1] - omega[1] * p[0],
    ]);
    let m = [2.0, 1.0, -3.0];
    let term = PointMoment::new("m", &nodes, CABLE, m, TimeFunction::Constant).unwrap();
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let exact = dot(m, omega) - dot(m, p) * dot(omega, p) / dot(p, p);
    approx::assert_relative_eq!(term.power(&s.at()).supplied, exact, max_relative = 1e-12);
}

#[test]
fn springs_turn_with_their_ends_and_act_both_ways() {
    let turn = [0.4, 1.1, -0.7];
    for (k, spring) in springs().into_iter().enumerate().filter(|(k, _)| k / 4 < 2) {
        let s = Numbers::new(9 + k as u64);
        let mut turned = Numbers { q: s.q.clone(), v: s.v.clone(), a: s.a.clone() };
        for (q, v) in [(0, 0), (3, 3), (9, 9), (16, 15)] {
            let three = |x: &[f64], i: usize| rotate(turn, [x[i], x[i + 1], x[i + 2]]);
            turned.q[q..q + 3].copy_from_slice(&three(&s.q, q));
            turned.v[v..v + 3].copy_from_slice(&three(&s.v, v));
        }
        let residual = |s: &Numbers| dense(&spring, &nodes(), &s.at(), Weights::default(), Width::One).0;
        let (a, b) = (residual(&s), residual(&turned));
        let mut sum = [0.0; 3];
        for v in [0, 3, 9, 15] {
            let a = rotate(turn, [a[v], a[v + 1], a[v + 2]]);
            approx::assert_relative_eq!(a[..], b[v..v + 3], epsilon = 1e-11);
            (0..3).for_each(|i| sum[i] += b[v + i]);
        }
        approx::assert_relative_eq!(sum[..], [0.0; 3][..], epsilon = 1e-11);
    }
}

#[test]
fn rope_goes_slack_and_never_pushes() {
    let nodes = nodes();
    let ground = Marker::ground([0.0; 3]);
    let mut rope = Spring::new("rope", &nodes, [ground, Marker::node(POINT)], 100.0, 1.0).unwrap();
    (rope.damping, rope.tension_only) = (10.0.into(), true);
    let mut s = Numbers::new(1);
    let mut force = |length: f64, rate: f64| {
        s.q[..3].copy_from_slice(&[length, 0.0, 0.0]);
        s.v[..3].copy_from_slice(&[rate, 0.0, 0.0]);
        let p = rope.power(&s.at());
        (rope.force(&s.at()), rope.energy(&s.at()).potential, p.dissipated)
    };
    assert_eq!(force(1.5, 1.0), (60.0, 12.5, 10.0));
    assert_eq!(force(0.5, 1.0), (0.0, 0.0, 0.0));
    // released faster than the damper lets it shorten
    assert_eq!(force(1.5, -10.0), (0.0, 12.5, 500.0));
}

#[test]
fn nothing_breaks_at_rest_or_without_length() {
    let nodes = nodes();
    let s = Numbers { q: [0.0; 23].to_vec(), v: vec![0.0; 22], a: vec![0.0; 22] };
    let w = Weights { q: 1.0, v: 1.0, a: 1.0 };
    for term in springs() {
        let (r, k) = dense(&term, &nodes, &s.at(), w, Width::One);
        assert!(r.iter().chain(k.iter().flatten()).all(|x| x.is_finite()));
    }
}

#[test]
fn what_cannot_be_loaded_is_refused() {
    let nodes = nodes();
    let beside = Marker::beside(BODY, [1.0, 0.0, 0.0]);
    let constant = TimeFunction::Constant;
    let dead = |m: &Marker| PointForce::dead("f", &nodes, m, [1.0; 3], constant.clone());
    assert!(dead(&beside).is_ok());
    let local = |m: &Marker| PointForce::on_body("f", &nodes, m, [1.0; 3], constant.clone());
    assert!(local(&Marker::node(CABLE)).unwrap_err().to_string().contains("rigid body"));
    assert!(dead(&Marker::ground([0.0; 3])).is_err());
    assert!(dead(&Marker::node(NUMBER)).is_err());
    assert!(dead(&Marker::node(NodeId(77))).is_err());
    assert!(PointForce::follower("f", &nodes, POINT, 1.0, constant.clone()).is_err());
    assert!(PointMoment::along("m", &nodes, CABLE, 1.0, constant.clone()).is_err());
    assert!(PointMoment::new("m", &nodes, POINT, [1.0; 3], constant.clone()).is_err());
    let spring = |pair| Spring::new("s", &nodes, pair, 1.0, 1.0);
    assert!(spring([Marker::ground([0.0; 3]), Marker::ground([1.0; 3])]).is_err());
    assert!(spring([Marker::node(POINT), Marker::node(POINT)]).is_err());
    assert!(Spring::new("s", &nodes, [Marker::node(POINT), Marker::node(CABLE)], f64::NAN, 1.0).is_err());
}
