//! Lines that touch each other: force and tangent against differences of the energy, closed forms, what is left out.

use crate::random::Random;
use ropewalk_core::rotation::{cross, exp, matrix, times};
use ropewalk_core::testing::{dense, difference};
use ropewalk_core::{
    At, ContactSpan, Couples, Foresees, Node, NodeKind, Shows, SpanLine, Term, V3, Weights, Width, dot,
    retract,
};
use ropewalk_forces::contact::{ContactLaw, Damping, Friction, LineContact, Touching, nearest_points};
use serde_json::Value;
use std::f64::consts::PI;

const THICK: f64 = 0.02;
const K: f64 = 1e6;

/// Lines of cable elements, and bodies, with their numbers.
#[derive(Default)]
struct World {
    nodes: Vec<Node>,
    q: Vec<f64>,
    v: Vec<f64>,
    lines: Vec<Touching>,
}

impl World {
    fn node(&mut self, kind: NodeKind, q: &[f64]) -> (usize, usize) {
        let (at_q, at_v) = self.nodes.last().map_or((0, 0), |n| (n.coords().end, n.dofs().end));
        self.nodes.push(Node { kind, q: at_q, v: at_v, shared: false });
        self.q.extend(q);
        self.v.resize(at_v + kind.velocities(), 0.0);
        (at_q, at_v)
    }

    /// A cable through these nodes, of position and slope, with elements of this length.
    fn cable(&mut self, l: f64, places: &[[V3<f64>; 2]]) -> &mut Self {
        let seats: Vec<_> = places.iter().map(|p| self.node(NodeKind::Slope, &p.concat())).collect();
        let last = seats.len() - 2;
        let spans = (0..=last).map(|k| {
            let ((p, v), (q, w)) = (seats[k], seats[k + 1]);
            let line = SpanLine::Cubic { q: [p, p + 3, q, q + 3], v: [v, v + 3, w, w + 3], l };
            let tips = [k == 0, k == last];
            ContactSpan { line, radius: 0.5 * THICK, length: l, s: l * k as f64, tips, flow: None }
        });
        let spans = spans.collect();
        self.line(spans)
    }

    /// A straight cable from a point in a direction.
    fn straight(&mut self, from: V3<f64>, along: V3<f64>, l: f64, elements: usize) -> &mut Self {
        let place = |k: usize| [std::array::from_fn(|i| from[i] + l * k as f64 * along[i]), along];
        let places: Vec<_> = (0..=elements).map(place).collect();
        self.cable(l, &places)
    }

    /// A hull along x of a body.
    fn hull(&mut self, at: V3<f64>, turned: V3<f64>, length: f64) -> &mut Self {
        let q: Vec<f64> = at.into_iter().chain(exp(turned)).collect();
        let (q, v) = self.node(NodeKind::Frame, &q);
        let half = 0.5 * length;
        let line = SpanLine::Straight {
            q,
            v,
            ends: [[-half, 0.01, 0.0], [half, 0.01, 0.0]],
            along: [1.0, 0.0, 0.0],
        };
        self.line(vec![ContactSpan {
            line,
            radius: 0.5 * THICK,
            length,
            s: 0.0,
            tips: [true; 2],
            flow: None,
        }])
    }

    fn line(&mut self, spans: Vec<ContactSpan>) -> &mut Self {
        self.lines.push(Touching { name: format!("line {}", self.lines.len()), spans });
        self
    }

    fn shake(&mut self, r: &mut Random, size: f64) -> &mut Self {
        let shaken = r.list(self.q.len(), size);
        let bodies: Vec<_> = self.nodes.iter().filter(|n| n.kind == NodeKind::Frame).map(|n| n.q).collect();
        let still = |k: usize| bodies.iter().any(|b| (b + 3..b + 7).contains(&k));
        for (k, d) in shaken.into_iter().enumerate().filter(|(k, _)| !still(*k)) {
            self.q[k] += d;
        }
        self.v = r.list(self.v.len(), 0.5);
        self
    }

    fn at<'a>(&'a self, q: &'a [f64], zero: &'a [f64]) -> At<'a> {
        At { t: 0.0, q, v: &self.v, a: zero, internal: &[], relaxed: None }
    }

    fn contact(&self, law: ContactLaw) -> LineContact {
        let zero = vec![0.0; self.v.len()];
        let made = LineContact::new("lines", &self.lines, true, K, law, &self.at(&self.q, &zero));
        made.unwrap_or_else(|e| panic!("{e}"))
    }

    fn shown(&self, contact: &LineContact) -> [f64; 3] {
        let mut out = Vec::new();
        contact.observe(&self.at(&self.q, &vec![0.0; self.v.len()]), &mut out);
        out.try_into().unwrap()
    }
}

/// The worst error of force against differences of the energy, relative to the largest.
fn force_error(world: &World, contact: &LineContact) -> f64 {
    let zero = vec![0.0; world.v.len()];
    let (r, _) = dense(contact, &world.nodes, &world.at(&world.q, &zero), Weights::default(), Width::One);
    let size = r.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    assert!(size > 0.0, "nothing touches");
    let slope = |k: usize| {
        difference(|h| {
            let mut q = world.q.clone();
            // differences reach further than what touches is deep
            q[k] += 1e-2 * h;
            vec![contact.energy(&world.at(&q, &zero)).potential * 1e2]
        })[0]
    };
    (0..zero.len()).map(|k| (r[k] - slope(k)).abs() / size).fold(0.0, f64::max)
}

/// A bent piece, and a straight one that leads over it at this angle.
fn crossing(angle: f64, depth: f64) -> World {
    let mut w = World::default();
    w.cable(1.0, &[[[0.0; 3], [1.0, 0.05, 0.01]], [[1.0, 0.0, 0.0], [1.0, -0.05, 0.0]]]);
    let t = [angle.cos(), angle.sin(), 0.0];
    let end = |sign: f64| [0.5 + 0.5 * sign * t[0], 0.01 + 0.5 * sign * t[1], THICK - depth];
    w.cable(1.0, &[[end(-1.0), t], [end(1.0), [t[0], t[1], 0.02]]]);
    w
}

#[test]
fn the_force_follows_from_the_energy_at_every_angle() {
    let mut r = Random(3);
    for degrees in [90.0, 45.0, 10.0, 2.0, 0.0_f64] {
        for depth in [2e-3, 5e-3] {
            let mut w = crossing(degrees * PI / 180.0, depth);
            w.shake(&mut r, 1e-4);
            let contact = w.contact(ContactLaw::default());
            let (force, tangent) = (force_error(&w, &contact), tangent_error(&w, &contact));
            println!("{degrees}° {depth} m: force {force:.1e}, tangent {tangent:.1e}");
            assert!(force < 3e-4 && tangent < 1e-3, "{degrees}°: {force:.1e}, {tangent:.1e}");
        }
    }
}

/// As `check_tangent`, with differences short enough for thin lines: positions in units of a hundredth.
fn tangent_error(world: &World, contact: &LineContact) -> f64 {
    let zero = vec![0.0; world.v.len()];
    let at = world.at(&world.q, &zero);
    let w = Weights { q: 1.0, v: 0.0, a: 0.0 };
    let (_, k) = dense(contact, &world.nodes, &at, w, Width::One);
    let size = k.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut worst = 0.0_f64;
    for j in 0..zero.len() {
        let column = difference(|h| {
            let mut q = world.q.clone();
            q[j] += 1e-2 * h;
            let r = dense(contact, &world.nodes, &world.at(&q, &zero), Weights::default(), Width::One).0;
            r.into_iter().map(|r| 1e2 * r).collect()
        });
        for (i, x) in column.iter().enumerate() {
            worst = worst.max((k[i][j] - x).abs() / size).max((k[i][j] - k[j][i]).abs() / size);
        }
    }
    worst
}

#[test]
fn forces_and_moments_are_in_balance() {
    let mut r = Random(5);
    for degrees in [90.0, 20.0, 0.0_f64] {
        let mut w = crossing(degrees * PI / 180.0, 3e-3);
        w.shake(&mut r, 1e-4);
        let contact = w.contact(ContactLaw::default());
        let zero = vec![0.0; w.v.len()];
        let (f, _) = dense(&contact, &w.nodes, &w.at(&w.q, &zero), Weights::default(), Width::One);
        let (mut sum, mut moment, mut size) = ([0.0; 3], [0.0; 3], 0.0_f64);
        for n in &w.nodes {
            let three = |x: &[f64], k: usize| [x[k], x[k + 1], x[k + 2]];
            let (force, of_slope) = (three(&f, n.v), three(&f, n.v + 3));
            let turn = [cross(&three(&w.q, n.q), &force), cross(&three(&w.q, n.q + 3), &of_slope)];
            for i in 0..3 {
                sum[i] += force[i];
                moment[i] += turn[0][i] + turn[1][i];
                size = size.max(force[i].abs());
            }
        }
        let off = dot(&sum, &sum).sqrt().max(dot(&moment, &moment).sqrt()) / size;
        println!("{degrees}°: {off:.1e} of {size:.1} N");
        assert!(off < 1e-13, "{degrees}°: {off:.1e}");
    }
}

#[test]
fn damped_lines_and_hulls_have_exact_tangents() {
    let mut r = Random(11);
    for damping in [Damping::None, Damping::HuntCrossley(0.3)] {
        for hull in [false, true] {
            let mut w = crossing(0.9, 1e-3);
            if hull {
                w.hull([0.4, 0.0, -0.018], [0.1, 0.02, 0.7], 0.9);
            }
            w.shake(&mut r, 1e-4);
            let contact = w.contact(ContactLaw { damping, ..ContactLaw::default() });
            let error = check_by_increments(&contact, &w);
            println!("{damping:?}, hull {hull}: {error:.1e}");
            assert!(error < 1e-3, "{damping:?}, hull {hull}: {error:.1e}");
        }
    }
}

/// Stiffness and damping against differences along increments, bodies turned in their own axes.
fn check_by_increments(contact: &LineContact, w: &World) -> f64 {
    let n = w.v.len();
    let zero = vec![0.0; n];
    let residual = |q: &[f64], v: &[f64]| {
        let at = At { t: 0.0, q, v, a: &zero, internal: &[], relaxed: None };
        dense(contact, &w.nodes, &at, Weights::default(), Width::One).0
    };
    let mut worst = 0.0_f64;
    for (kind, weights) in
        [Weights { q: 1.0, v: 0.0, a: 0.0 }, Weights { q: 0.0, v: 1.0, a: 0.0 }].into_iter().enumerate()
    {
        let (_, k) = dense(contact, &w.nodes, &w.at(&w.q, &zero), weights, Width::One);
        let size = k.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        for j in 0..n {
            let column = difference(|h| {
                let mut d = vec![0.0; n];
                d[j] = 1e-2 * h;
                let (mut q, mut v) = (w.q.clone(), w.v.clone());
                if kind == 0 {
                    retract(&w.nodes, &w.q, &d, &mut q);
                } else {
                    v[j] += 1e-2 * h;
                }
                residual(&q, &v).into_iter().map(|r| 1e2 * r).collect()
            });
            for (i, x) in column.iter().enumerate() {
                worst = worst.max((k[i][j] - x).abs() / size.max(f64::MIN_POSITIVE));
            }
        }
    }
    worst
}

#[test]
fn crossing_lines_press_as_the_closed_form_says() {
    // δ(s) = D - √(g² + s² sin²θ): N = (4√2/3) k δ^{3/2} √D / sin θ for small depths; the integral here
    let (d, depth) = (THICK, 2e-4);
    let g = d - depth;
    for degrees in [90.0, 30.0, 5.0_f64] {
        let sin = (degrees * PI / 180.0).sin();
        let half = (d * d - g * g).sqrt() / sin;
        let steps = 20_000;
        let exact: f64 = (0..steps)
            .map(|i| {
                let s = half * (2.0 * (i as f64 + 0.5) / steps as f64 - 1.0);
                let distance = g.hypot(s * sin);
                K * (d - distance) * g / distance * 2.0 * half / steps as f64
            })
            .sum();
        let small = 4.0 * 2.0_f64.sqrt() / 3.0 * K * depth.powf(1.5) * d.sqrt() / sin;
        for (elements, off) in [(1, 0.0), (4, 0.0), (4, 0.013), (7, 0.0)] {
            let mut w = World::default();
            let t = degrees * PI / 180.0;
            let l = 4.0 / elements as f64;
            let dir = [t.cos(), t.sin(), 0.0];
            w.straight([-2.0 + off, 0.0, 0.0], [1.0, 0.0, 0.0], l, elements).straight(
                [-2.0 * dir[0], -2.0 * dir[1], g],
                dir,
                l,
                elements,
            );
            let contact = w.contact(ContactLaw::default());
            let zero = vec![0.0; w.v.len()];
            let (r, _) = dense(&contact, &w.nodes, &w.at(&w.q, &zero), Weights::default(), Width::One);
            let first: f64 = w.nodes.iter().take(elements + 1).map(|n| r[n.v + 2]).sum();
            let [normal, deepest, length] = w.shown(&contact);
            println!(
                "{degrees}°, {elements} elements: {:.1e} off, small depth {:.1e}, {normal:.4} N over {length:.4} m",
                first / exact - 1.0,
                first / small - 1.0
            );
            assert!((first / exact - 1.0).abs() < 1e-6, "{degrees}°, {elements}: {first} instead of {exact}");
            assert!((deepest - depth).abs() < 1e-9 && (length / (2.0 * half) - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn parallel_lines_press_along_all_of_their_length_wherever_their_nodes_are() {
    let depth = 1e-4;
    for (elements, other) in [(1, 1), (3, 3), (3, 4), (5, 2)] {
        let mut w = World::default();
        let dir = [0.6, 0.8, 0.0];
        w.straight([0.0; 3], dir, 3.0 / elements as f64, elements).straight(
            [0.0, 0.0, THICK - depth],
            dir,
            3.0 / other as f64,
            other,
        );
        let contact = w.contact(ContactLaw::default());
        let [normal, deepest, length] = w.shown(&contact);
        println!("{elements}, {other}: {normal:.6} N over {length:.6} m");
        assert!((normal / (K * depth * 3.0) - 1.0).abs() < 1e-9, "{normal}");
        assert!((deepest / depth - 1.0).abs() < 1e-9 && (length / 3.0 - 1.0).abs() < 1e-9);
    }
}

/// A helix of one line with this rise per turn: neighbouring turns are that far apart.
fn helix(radius: f64, rise: f64, turns: f64, elements: usize) -> World {
    let angle = 2.0 * PI * turns / elements as f64;
    let speed = radius.hypot(rise / (2.0 * PI));
    let place = |k: usize| {
        let phi = angle * k as f64;
        let slope = [-radius * phi.sin(), radius * phi.cos(), rise / (2.0 * PI)].map(|x| x / speed);
        [[radius * phi.cos(), radius * phi.sin(), rise / (2.0 * PI) * phi], slope]
    };
    let places: Vec<_> = (0..=elements).map(place).collect();
    let mut w = World::default();
    w.cable(speed * angle, &places);
    w
}

#[test]
fn a_coil_touches_itself_turn_by_turn_and_nowhere_else() {
    let rise = THICK - 1e-4;
    let depth = |w: &World| {
        let contact = w.contact(ContactLaw::default());
        (w.shown(&contact), contact.pairs().count())
    };
    // neighbouring turns are nearest along the normal of the helix
    let radius = 0.3;
    let (mut w, turns) = (helix(radius, rise, 3.0, 60), 3.0);
    let ([normal, deepest, length], pairs) = depth(&w);
    let slant = (rise / (2.0 * PI * radius)).atan().cos();
    println!("{normal:.4} N, {deepest:.3e} m, {length:.4} m, {pairs} pairs");
    let wanted = 2.0 * PI * radius.hypot(rise / (2.0 * PI)) * (turns - 1.0);
    assert!((length / wanted - 1.0).abs() < 2e-3, "{length} instead of {wanted}");
    assert!((deepest / (THICK - rise * slant) - 1.0).abs() < 2e-2, "{deepest}");
    // force and tangent of what a line does to itself
    let mut r = Random(2);
    w.shake(&mut r, 1e-6);
    let contact = w.contact(ContactLaw::default());
    let force = force_error(&w, &contact);
    println!("force {force:.1e}");
    assert!(force < 1e-4, "{force:.1e}");
    // turns that are apart, and a tight ring, which is as bent as it can be without touching itself across
    assert_eq!(depth(&helix(0.3, 1.1 * THICK, 3.0, 60)).0, [0.0; 3]);
    assert_eq!(depth(&helix(0.6 * THICK, 1.2 * THICK, 1.5, 24)).0, [0.0; 3]);
    // nothing of a straight line is near itself, whatever its mesh
    for elements in [1, 4, 40, 400] {
        let mut w = World::default();
        w.straight([0.0; 3], [1.0, 0.0, 0.0], 2.0 / elements as f64, elements);
        assert_eq!(depth(&w), ([0.0; 3], 0), "{elements} elements");
    }
}

#[test]
fn what_is_near_is_listed_anew_as_it_moves() {
    let mut w = World::default();
    w.straight([-2.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5, 8).straight([0.0, -2.0, 1.0], [0.0, 1.0, 0.0], 0.5, 8);
    let contact = w.contact(ContactLaw::default());
    let zero = vec![0.0; w.v.len()];
    assert_eq!(contact.pairs().count(), 0);
    // both move alike: nothing has changed
    let mut q = w.q.clone();
    w.nodes.iter().for_each(|n| q[n.q] += 5.0);
    assert!(contact.renewed(&w.at(&q, &zero), false).is_none());
    // one comes down
    w.nodes.iter().skip(9).for_each(|n| q[n.q + 2] -= 0.97);
    assert!(contact.renewed(&w.at(&q, &zero), false).is_some());
    let other = {
        let mut there =
            World { nodes: w.nodes.clone(), q: q.clone(), v: zero.clone(), lines: w.lines.clone() };
        there.q.clone_from(&q);
        there.contact(ContactLaw::default())
    };
    assert!(other.pairs().count() >= 1);
    // through the other within one step
    let mut below = q.clone();
    w.nodes.iter().skip(9).for_each(|n| below[n.q + 2] -= 0.06);
    assert!(other.passes(&w.at(&q, &zero), &w.at(&below, &zero)).is_some());
    // a step ends before that
    let mut falling = World { nodes: w.nodes.clone(), q, v: zero.clone(), lines: w.lines.clone() };
    w.nodes.iter().skip(9).for_each(|n| falling.v[n.v + 2] = -10.0);
    let limit = other.step_limit(&falling.at(&falling.q, &zero));
    assert!(limit < 1.5e-3 && limit > 1e-4, "{limit}");
}

#[test]
fn the_nearest_points_of_two_curves_are_found() {
    let data: Value = serde_json::from_str(include_str!("../data/closest.json")).unwrap();
    let number = |v: &Value| v.as_f64().unwrap();
    let point = |v: &Value| -> V3<f64> { std::array::from_fn(|i| number(&v[i])) };
    let curve = |v: &Value| -> [V3<f64>; 4] { std::array::from_fn(|k| point(&v[k])) };
    let cases = data["cases"].as_array().unwrap();
    assert!(cases.len() > 4);
    for case in cases {
        let (distance, xi) = nearest_points(&curve(&case["one"]), &curve(&case["other"]));
        let off = (distance - number(&case["distance"])).abs();
        println!("{distance:.9} m, off by {off:.1e}");
        assert!(off < 1e-9, "{distance} at {xi:?} instead of {case}");
    }
}

/// The same places with friction, as they have taken hold where they are now; and what they remember.
fn rubbing(w: &World, law: ContactLaw) -> (LineContact, Vec<f64>) {
    let contact = w.contact(law);
    let size = contact.memory();
    let contact = contact.with_friction(&vec![0.3; w.lines.len()], 0).unwrap_or_else(|e| panic!("{e}"));
    let (mut memory, zero) = (vec![0.0; size], vec![0.0; w.v.len()]);
    contact.remembers().unwrap().remember(&w.at(&w.q, &zero), &mut memory);
    (contact, memory)
}

fn rough(mu: f64, damping: Damping) -> ContactLaw {
    ContactLaw { friction: Some(Friction::new(mu)), damping, ..ContactLaw::default() }
}

#[test]
fn friction_has_exact_tangents_and_moves_nothing_as_a_whole() {
    let mut r = Random(17);
    // pulled a little, and far beyond what holds; steep, shallow and parallel crossings; a hull below
    for (far, slipping) in [(1e-5, 0.0), (2e-3, 1.0)] {
        for (angle, hull) in [(1.2_f64, false), (2.4, false), (0.3, false), (0.0, false), (0.9, true)] {
            let mut w = crossing(angle, 5e-4);
            if hull {
                w.hull([0.4, 0.0, -0.019], [0.1, 0.0, 0.7], 0.9);
            }
            w.shake(&mut r, 1e-5);
            let (contact, memory) = rubbing(&w, rough(0.4, Damping::HuntCrossley(0.3)));
            let held: Vec<f64> = w.q.clone();
            // the second line is drawn along and across
            for n in w.nodes[2..4].iter().filter(|n| n.kind == NodeKind::Slope) {
                w.q[n.q] += far;
                w.q[n.q + 1] += 0.7 * far;
            }
            assert!(w.q != held);
            w.v.iter_mut().for_each(|v| *v *= 1e-2 * far / 2e-3);
            let shown = {
                let mut out = Vec::new();
                let zero = vec![0.0; w.v.len()];
                contact.observe(&At { internal: &memory, ..w.at(&w.q, &zero) }, &mut out);
                out
            };
            println!("{angle}, hull {hull}, {far}: {shown:?}");
            assert!(shown[3] > 0.0, "nothing holds: {shown:?}");
            assert!((shown[4] - slipping).abs() <= if slipping > 0.0 { 0.5 } else { 0.0 }, "{shown:?}");
            let error = remembered_error(&contact, &w, &memory);
            let off = unbalanced(&contact, &w, &memory);
            println!("  tangent {error:.1e}, balance {off:.1e}");
            assert!(error <= 2e-3, "{angle}, {far}: {error:.1e}");
            assert!(off <= 1e-12, "{angle}, {far}: {off:.1e}");
        }
    }
}

/// Stiffness and damping against differences along increments.
fn remembered_error(contact: &LineContact, w: &World, memory: &[f64]) -> f64 {
    let n = w.v.len();
    let zero = vec![0.0; n];
    let residual = |q: &[f64], v: &[f64]| {
        let at = At { t: 0.0, q, v, a: &zero, internal: memory, relaxed: None };
        dense(contact, &w.nodes, &at, Weights::default(), Width::One).0
    };
    let mut worst = 0.0_f64;
    let kinds = [Weights { q: 1.0, v: 0.0, a: 0.0 }, Weights { q: 0.0, v: 1.0, a: 0.0 }];
    for (kind, weights) in kinds.into_iter().enumerate() {
        let at = At { internal: memory, ..w.at(&w.q, &zero) };
        let (_, k) = dense(contact, &w.nodes, &at, weights, Width::One);
        let size = k.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        assert!(size > 0.0);
        for j in 0..n {
            let scale = if kind == 0 { 1e-3 } else { 1e-1 };
            let column = difference(|h| {
                let mut d = vec![0.0; n];
                d[j] = scale * h;
                let (mut q, mut v) = (w.q.clone(), w.v.clone());
                if kind == 0 {
                    retract(&w.nodes, &w.q, &d, &mut q);
                } else {
                    v[j] += scale * h;
                }
                residual(&q, &v).into_iter().map(|r| r / scale).collect()
            });
            for (i, x) in column.iter().enumerate() {
                let off = (k[i][j] - x).abs() / size;
                assert!(off.is_finite());
                worst = worst.max(off);
            }
        }
    }
    worst
}

/// The sum of forces and moments, in parts of the largest force.
fn unbalanced(contact: &LineContact, w: &World, memory: &[f64]) -> f64 {
    let zero = vec![0.0; w.v.len()];
    let at = At { internal: memory, ..w.at(&w.q, &zero) };
    let (f, _) = dense(contact, &w.nodes, &at, Weights::default(), Width::One);
    let (mut sum, mut moment, mut size) = ([0.0; 3], [0.0; 3], 0.0_f64);
    for n in &w.nodes {
        let three = |x: &[f64], k: usize| [x[k], x[k + 1], x[k + 2]];
        let (force, second) = (three(&f, n.v), three(&f, n.v + 3));
        let of_second = match n.kind {
            NodeKind::Frame => {
                times(&matrix(&[w.q[n.q + 3], w.q[n.q + 4], w.q[n.q + 5], w.q[n.q + 6]]), &second)
            }
            _ => cross(&three(&w.q, n.q + 3), &second),
        };
        let turn = cross(&three(&w.q, n.q), &force);
        for i in 0..3 {
            sum[i] += force[i];
            moment[i] += turn[i] + of_second[i];
            size = size.max(force[i].abs());
        }
    }
    (dot(&sum, &sum) + dot(&moment, &moment)).sqrt() / size
}

#[test]
fn friction_turns_with_what_it_holds() {
    let mut r = Random(23);
    let mut w = crossing(1.1, 5e-4);
    w.shake(&mut r, 1e-5);
    let (contact, memory) = rubbing(&w, rough(0.4, Damping::None));
    w.nodes[2..4].iter().for_each(|n| w.q[n.q] += 1e-3);
    w.v.fill(0.0);
    let zero = vec![0.0; w.v.len()];
    let force = |w: &World, contact: &LineContact| {
        dense(
            contact,
            &w.nodes,
            &At { internal: &memory, ..w.at(&w.q, &zero) },
            Weights::default(),
            Width::One,
        )
        .0
    };
    let before = force(&w, &contact);
    let r = matrix(&exp([0.4, -1.1, 0.7]));
    let turned =
        |x: &[f64]| -> Vec<f64> { x.chunks_exact(3).flat_map(|x| times(&r, &[x[0], x[1], x[2]])).collect() };
    w.q = turned(&w.q);
    w.nodes.iter().for_each(|n| (0..3).for_each(|i| w.q[n.q + i] += [3.0, -2.0, 1.0][i]));
    let (wanted, got) = (turned(&before), force(&w, &contact));
    let size = before.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (a, b) in got.iter().zip(&wanted) {
        // depths are differences of places that are farther away now
        assert!((a - b).abs() <= 1e-8 * size, "{a} instead of {b}");
    }
}

#[test]
fn slip_is_held_by_coulombs_limit_and_no_more() {
    // two lines that cross: one is drawn along itself, along the other, and askew
    for way in [[1.0, 0.0], [0.0, 1.0], [0.6, -0.8_f64]] {
        let mut w = World::default();
        w.straight([-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], 0.25, 4).straight(
            [0.013, -0.5, THICK - 2e-4],
            [0.0, 1.0, 0.0],
            0.25,
            4,
        );
        let (contact, memory) = rubbing(&w, rough(0.3, Damping::None));
        let upper = w.nodes[5..].to_vec();
        let k = 1e-3;
        upper.iter().for_each(|n| (0..2).for_each(|i| w.q[n.q + i] += k * way[i]));
        let zero = vec![0.0; w.v.len()];
        let (f, _) = dense(
            &contact,
            &w.nodes,
            &At { internal: &memory, ..w.at(&w.q, &zero) },
            Weights::default(),
            Width::One,
        );
        let total: V3<f64> = std::array::from_fn(|i| upper.iter().map(|n| f[n.v + i]).sum());
        // the residual pulls back; what presses is counted place by place, each along its own normal
        let mut out = Vec::new();
        contact.observe(&At { internal: &memory, ..w.at(&w.q, &zero) }, &mut out);
        let (normal, along) = (out[0], total[0] * way[0] + total[1] * way[1]);
        assert!((out[3] / (0.3 * normal) - 1.0).abs() <= 1e-12 && out[4] == 1.0, "{out:?}");
        assert!((-total[2] / normal - 1.0).abs() <= 3e-3, "{total:?}");
        let across = total[0] * way[1] - total[1] * way[0];
        println!("{way:?}: {:.3e} off, {across:.1e} N", along / (0.3 * normal) - 1.0);
        assert!(normal > 0.5 && (along / (0.3 * normal) - 1.0).abs() <= 1e-9, "{along} N of {normal} N");
        assert!(across.abs() <= 1e-9 * normal, "{across} N");
    }
}

/// A chain of two links that meet at the origin, each of half a metre, from the first of these places and to the second.
fn corner(ends: [V3<f64>; 2]) -> World {
    let mut w = World::default();
    let spans = ends.iter().enumerate().map(|(k, end)| {
        let way: V3<f64> = if k == 0 { end.map(|x| -x) } else { *end };
        // turned from the x axis into the way
        let axis = cross(&[1.0, 0.0, 0.0], &way.map(|x| 2.0 * x));
        let sine = dot(&axis, &axis).sqrt();
        let angle = sine.atan2(2.0 * way[0]);
        let turned = exp(if sine > 0.0 { axis.map(|a| a * angle / sine) } else { [0.0; 3] });
        let q: Vec<f64> = end.map(|x| 0.5 * x).into_iter().chain(turned).collect();
        let (q, v) = w.node(NodeKind::Frame, &q);
        let line =
            SpanLine::Straight { q, v, ends: [[-0.25, 0.0, 0.0], [0.25, 0.0, 0.0]], along: [1.0, 0.0, 0.0] };
        let tips = [k == 0, k == 1];
        ContactSpan { line, radius: 0.5 * THICK, length: 0.5, s: 0.5 * k as f64, tips, flow: None }
    });
    let spans = spans.collect();
    w.line(spans);
    w
}

#[test]
fn the_force_on_a_chain_follows_from_its_energy_around_corners_too() {
    let half = |x: f64, y: f64| [0.5 * x, 0.5 * y, 0.0].map(|c: f64| c / x.hypot(y));
    for (bend, along) in [(0.5_f64, [0.2, 1.0]), (0.5, [1.0, 0.1]), (-0.4, [1.0, 0.0]), (0.0, [1.0, 0.05])] {
        let mut w = corner([half(-1.0, bend), half(1.0, bend)]);
        let t = [along[0], along[1], 0.01];
        let length = dot(&t, &t).sqrt();
        let t = t.map(|x| x / length);
        let place = |s: f64| [s * t[0] + 0.004, s * t[1] + 0.003, s * t[2] + THICK - 6e-4];
        w.cable(0.8, &[[place(-0.4), t], [place(0.4), t]]);
        let contact = w.contact(ContactLaw::default());
        let zero = vec![0.0; w.v.len()];
        let (r, k) =
            dense(&contact, &w.nodes, &w.at(&w.q, &zero), Weights { q: 1.0, v: 0.0, a: 0.0 }, Width::One);
        let size = r.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        assert!(size > 0.1, "nothing touches");
        // the links stay together: both move, or one turns around the joint
        let mut moves = Vec::new();
        for axis in 0..3 {
            let e: V3<f64> = std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
            let mut all = vec![0.0; zero.len()];
            for n in &w.nodes[..2] {
                all[n.v + axis] = 1.0;
            }
            moves.push(all);
            for n in &w.nodes[..2] {
                let at = |k: usize| w.q[n.q + k];
                let shift = cross(&e, &[at(0), at(1), at(2)]);
                let turn = matrix(&[at(3), at(4), at(5), at(6)]);
                let mut all = vec![0.0; zero.len()];
                for i in 0..3 {
                    all[n.v + i] = shift[i];
                    all[n.v + 3 + i] = (0..3).map(|j| turn[j][i] * e[j]).sum();
                }
                moves.push(all);
            }
        }
        for k in 12..24 {
            moves.push((0..24).map(|i| if i == k { 1.0 } else { 0.0 }).collect());
        }
        let mut worst = 0.0_f64;
        for way in &moves {
            let scale = 1e-3;
            let moved = |h: f64| {
                let d: Vec<f64> = way.iter().map(|x| scale * h * x).collect();
                let mut q = w.q.clone();
                retract(&w.nodes, &w.q, &d, &mut q);
                q
            };
            let of = |h: f64| vec![contact.energy(&w.at(&moved(h), &zero)).potential / scale];
            let (slope, work) = (difference(of)[0], way.iter().zip(&r).map(|(a, b)| a * b).sum::<f64>());
            assert!(slope.is_finite());
            worst = worst.max((slope - work).abs() / size);
            // where a border between links moves, both have the same there: the tangent along such moves is right too
            let residual = |h: f64| {
                let r = dense(&contact, &w.nodes, &w.at(&moved(h), &zero), Weights::default(), Width::One).0;
                vec![
                    moves[9..].iter().map(|m| m.iter().zip(&r).map(|(a, b)| a * b).sum::<f64>()).sum::<f64>()
                        / scale,
                ]
            };
            let by: f64 = moves[9..]
                .iter()
                .map(|m| (0..24).map(|i| m[i] * (0..24).map(|j| k[i][j] * way[j]).sum::<f64>()).sum::<f64>())
                .sum();
            let off = (difference(residual)[0] - by).abs()
                / k.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
            assert!(off <= 2e-3, "{bend}, {along:?}: tangent {off:.1e}");
        }
        println!("{bend}, {along:?}: {size:.2} N, force {worst:.1e}, {:?}", w.shown(&contact));
        assert!(worst <= 3e-4, "{bend}, {along:?}: {worst:.1e}");
    }
}
