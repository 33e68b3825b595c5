//! Latches, bushings and torsion springs: tangents, energies, momentum.

use crate::random::Random;
use ropewalk_core::held::Held;
use ropewalk_core::rotation::{IDENTITY, cross, matrix, times};
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{At, Marker, Node, NodeId, NodeKind, Signal, Term, V3, Weights, Width, retract};
use ropewalk_forces::{Bushing, Floor, Latch, RotationalSpring, Seat};

/// Two rigid bodies and a point.
fn nodes() -> Vec<Node> {
    let frame = |q, v| Node { kind: NodeKind::Frame, q, v, shared: false };
    vec![frame(0, 0), frame(7, 6), Node { kind: NodeKind::Point, q: 14, v: 12, shared: false }]
}

const A: NodeId = NodeId(0);
const B: NodeId = NodeId(1);

struct Numbers {
    q: Vec<f64>,
    v: Vec<f64>,
    internal: Vec<f64>,
    t: f64,
}

impl Numbers {
    fn new(seed: u64) -> Self {
        let mut r = Random(seed);
        let mut s =
            Numbers { q: r.list(17, 1.0), v: r.list(15, 1.0), internal: vec![0.0, 0.2, 0.05], t: 0.3 };
        for k in [3, 10] {
            let norm: f64 = s.q[k..k + 4].iter().map(|x| x * x).sum::<f64>().sqrt();
            s.q[k..k + 4].iter_mut().for_each(|x| *x /= norm);
        }
        s
    }
    fn at(&self) -> At<'_> {
        At { t: self.t, q: &self.q, v: &self.v, a: &[0.0; 15], internal: &self.internal, relaxed: None }
    }
}

fn frames() -> [Marker; 2] {
    let tilted = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];
    [
        Marker::Node { node: A, point: [0.3, -0.4, 0.2], axes: tilted },
        Marker::Node { node: B, point: [-0.1, 0.5, 0.7], axes: IDENTITY },
    ]
}

fn bushings() -> Vec<Bushing> {
    let [a, b] = frames();
    let ground =
        Marker::Ground { point: [0.2, 0.1, -0.3], axes: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]] };
    [[a, b], [ground, b], [a, ground]]
        .map(|pair| {
            let mut bushing = Bushing::new("mount", &nodes(), pair).unwrap();
            bushing.stiffness = [100.0, 200.0, 50.0].map(Signal::from);
            bushing.rotational_stiffness = [10.0, 30.0, 20.0].map(Signal::from);
            bushing
        })
        .to_vec()
}

/// Two points held in space and one on a body: one latched, one that lets go, one long gone.
fn latches() -> Vec<Latch> {
    let point = Held::Moves { q: 14, v: 12 };
    let body = Held::Moves { q: 7, v: 6 };
    let ground = Held::Ground([0.1, 0.2, -0.4]);
    let on = Held::Beside { q: 0, v: 0, arm: [0.2, 0.1, -0.3] };
    let floor = Floor { point: [0.0, 0.0, 3.0], normal: [0.0, 0.6, 0.8], stiffness: 300.0 };
    let seats = |ends: [[Held; 2]; 3]| {
        (0..3).map(|variable| Seat { ends: ends[variable], variable }).collect::<Vec<_>>()
    };
    let mut all = Vec::new();
    for seats in [
        seats([[ground, point], [on, point], [ground, body]]),
        seats([[on, body], [ground, body], [on, point]]),
    ] {
        for floor in [None, Some(floor)] {
            all.push(Latch {
                label: "latch".into(),
                stiffness: 200.0,
                damping: 5.0,
                hold: 20.0,
                direction: None,
                fade: 0.2,
                floor,
                seats: seats.clone(),
            });
        }
    }
    all
}

#[test]
fn tangents_are_exact() {
    for seed in 1..=8 {
        let s = Numbers::new(seed);
        let mut terms: Vec<Box<dyn Term>> = Vec::new();
        for mut bushing in bushings() {
            terms.push(Box::new(bushing.clone()));
            (bushing.damping, bushing.rotational_damping) =
                ([5.0, 7.0, 1.0].map(Signal::from), [2.0, 0.5, 3.0].map(Signal::from));
            terms.push(Box::new(bushing));
        }
        let mut spring = RotationalSpring::new("spring", &nodes(), frames(), 30.0, 0.4).unwrap();
        spring.damping = 2.0.into();
        terms.push(Box::new(spring));
        terms.extend(latches().into_iter().map(|l| Box::new(l) as Box<dyn Term>));
        for (k, term) in terms.iter().enumerate() {
            let error = check_tangent(&**term, &nodes(), &s.at(), Width::One);
            assert!(error < 1e-7, "{} ({k}) at state {seed}: {error}", term.label());
        }
    }
}

/// The rate of a term's energy along the motion.
fn energy_rate(term: &dyn Term, s: &Numbers) -> f64 {
    let energy = |dt: f64| {
        let (mut q, step) = (s.q.clone(), s.v.iter().map(|v| v * dt).collect::<Vec<_>>());
        retract(&nodes(), &s.q, &step, &mut q);
        vec![term.energy(&At { t: s.t + dt, q: &q, ..s.at() }).potential]
    };
    difference(energy)[0]
}

/// What a term takes out of the motion.
fn taken(term: &dyn Term, s: &Numbers) -> f64 {
    let (r, _) = dense(term, &nodes(), &s.at(), Weights::default(), Width::One);
    r.iter().zip(&s.v).map(|(r, v)| r * v).sum()
}

#[test]
fn what_is_taken_is_stored_or_dissipated() {
    for seed in 1..=8 {
        let s = Numbers::new(seed);
        let mut terms: Vec<Box<dyn Term>> = Vec::new();
        for mut bushing in bushings() {
            (bushing.damping, bushing.rotational_damping) =
                ([5.0, 7.0, 1.0].map(Signal::from), [2.0, 0.5, 3.0].map(Signal::from));
            terms.push(Box::new(bushing));
        }
        terms.extend(latches().into_iter().map(|l| Box::new(l) as Box<dyn Term>));
        for (k, term) in terms.iter().enumerate() {
            let (taken, stored) = (taken(&**term, &s), energy_rate(&**term, &s));
            let lost = term.power(&s.at()).dissipated;
            let size = taken.abs() + stored.abs() + lost.abs();
            assert!(
                (taken - stored - lost).abs() < 1e-7 * size,
                "{} ({k}): {taken} {stored} {lost}",
                term.label()
            );
        }
    }
}

#[test]
fn what_a_latch_gives_away_is_known_however_long_the_step() {
    for seed in 1..=8 {
        let s = Numbers::new(seed);
        for mut latch in latches() {
            // what dampers lose changes with the motion alone, and the floor sets in at a kink
            latch.damping = 0.0;
            latch.floor =
                latch.floor.map(|floor| Floor { stiffness: 30.0, point: [0.0, 0.0, 30.0], ..floor });
            latch.seats.retain(|seat| !seat.ends.iter().any(|end| matches!(end, Held::Beside { .. })));
            // along a straight motion what is at stake follows a parabola; steps begin and end before, in and after the fading
            for [from, to] in [[0.1, 0.5], [0.21, 0.3], [0.3, 0.9], [0.04, 0.06], [0.22, 0.26]] {
                let lost = |t: f64| {
                    let mut q = s.q.clone();
                    let step: Vec<f64> = s.v.iter().map(|v| v * (t - s.t)).collect();
                    retract(&nodes(), &s.q, &step, &mut q);
                    (q, t)
                };
                let at = |(q, t): &(Vec<f64>, f64)| latch.power(&At { t: *t, q, ..s.at() }).dissipated;
                let n = 4000;
                let h = (to - from) / f64::from(n);
                let all: f64 = (0..n).map(|k| h * at(&lost(from + (f64::from(k) + 0.5) * h))).sum();
                let [before, after] = [lost(from), lost(to)];
                let rough = 0.5 * (to - from) * (at(&before) + at(&after));
                let [first, last] = [&before, &after].map(|(q, t)| At { t: *t, q, ..s.at() });
                let missed = latch.foresees().unwrap().missed(&first, &last).dissipated;
                let size = all.abs().max(rough.abs()).max(1e-3);
                assert!(
                    (rough + missed - all).abs() < 1e-5 * size,
                    "{rough} + {missed}, not {all}, {from} to {to}"
                );
            }
        }
    }
}

#[test]
fn a_bushing_between_bodies_keeps_momentum_and_angular_momentum() {
    let s = Numbers::new(3);
    let mut bushing = bushings().remove(0);
    (bushing.damping, bushing.rotational_damping) =
        ([5.0, 7.0, 1.0].map(Signal::from), [2.0, 0.5, 3.0].map(Signal::from));
    let (r, _) = dense(&bushing, &nodes(), &s.at(), Weights::default(), Width::One);
    let mut force = [0.0; 3];
    let mut moment = [0.0; 3];
    for (q, v) in [(0, 0), (7, 6)] {
        let f: V3<f64> = [r[v], r[v + 1], r[v + 2]];
        let turn = matrix(&[s.q[q + 3], s.q[q + 4], s.q[q + 5], s.q[q + 6]]);
        let own = times(&turn, &[r[v + 3], r[v + 4], r[v + 5]]);
        let lever = cross(&[s.q[q], s.q[q + 1], s.q[q + 2]], &f);
        for i in 0..3 {
            force[i] += f[i];
            moment[i] += own[i] + lever[i];
        }
    }
    let size = r.iter().map(|x| x.abs()).fold(0.0, f64::max);
    assert!(force.iter().chain(&moment).all(|x| x.abs() < 1e-13 * size), "{force:?} {moment:?}");
}

#[test]
fn a_torsion_spring_pulls_the_shorter_way_back() {
    let ground = Marker::ground([0.0; 3]);
    let spring = RotationalSpring::new("s", &nodes(), [ground, Marker::node(B)], 10.0, 0.0).unwrap();
    let mut s = Numbers::new(1);
    s.v.fill(0.0);
    for (angle, moment) in [(0.3, -3.0), (-2.0, 20.0), (3.5, -10.0 * (3.5 - std::f64::consts::TAU))] {
        let half: f64 = 0.5 * angle;
        s.q[10..14].copy_from_slice(&[half.cos(), 0.0, 0.0, half.sin()]);
        let (r, _) = dense(&spring, &nodes(), &s.at(), Weights::default(), Width::One);
        approx::assert_relative_eq!(-r[11], moment, max_relative = 1e-12);
    }
}

#[test]
fn bushings_need_two_bodies() {
    let [a, b] = frames();
    let nodes = nodes();
    assert!(Bushing::new("m", &nodes, [a, a]).unwrap_err().message.contains("two different bodies"));
    let point = Marker::node(NodeId(2));
    assert!(Bushing::new("m", &nodes, [a, point]).unwrap_err().message.contains("`spring`"));
    let mut bushing = Bushing::new("m", &nodes, [a, b]).unwrap();
    bushing.damping = [0.0, -1.0, 0.0].map(Signal::from);
    assert!(bushing.check().unwrap_err().message.contains("`damping` must not be negative"));
}
