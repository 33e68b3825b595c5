//! Contact: distances, tangents, energies.

use crate::random::Random;
use ropewalk_core::held::Held;
use ropewalk_core::rotation::{around, exp, from_bryant, matrix, times};
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{
    At, ContactPoint, ContactSpan, Foresees, Marker, Node, NodeId, NodeKind, Remembers, Shows, SpanLine,
    Term, V3, Weights, Width, dot,
};
use ropewalk_forces::contact::{
    Contact, ContactLaw, Damping, Friction, Grip, Leaving, Mesh, Shape, Soup, Stiffness,
};
use std::sync::Arc;

const RADIUS: f64 = 0.4;
const STIFF: Stiffness = Stiffness { point: 80.0, per_length: 60.0, end: None, area: None };

/// A point, two nodes of a cable, a body that touches and one that carries the shape.
fn nodes() -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for kind in [NodeKind::Point, NodeKind::Slope, NodeKind::Slope, NodeKind::Frame, NodeKind::Frame] {
        let (q, v) = all.last().map_or((0, 0), |n| (n.coords().end, n.dofs().end));
        all.push(Node { kind, q, v, shared: false });
    }
    all
}

const SEAT: usize = 4;

struct Numbers {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl Numbers {
    fn new(r: &mut Random) -> Self {
        let nodes = nodes();
        let (n, m) = (nodes[SEAT].coords().end, nodes[SEAT].dofs().end);
        let mut s = Numbers { q: r.list(n, 1.0), v: r.list(m, 1.0), a: r.list(m, 1.0) };
        for k in [3, 4] {
            s.q[nodes[k].q + 3..nodes[k].q + 7].copy_from_slice(&exp(r.vector(2.0)));
        }
        s
    }
    fn at(&self) -> At<'_> {
        At { t: 0.0, q: &self.q, v: &self.v, a: &self.a, internal: &[], relaxed: None }
    }
    fn axes(&self) -> [V3<f64>; 3] {
        let q = nodes()[SEAT].q;
        matrix(&[self.q[q + 3], self.q[q + 4], self.q[q + 5], self.q[q + 6]])
    }
}

fn cube() -> Shape {
    let corner = |k: u32| [0, 1, 2].map(|i| if k >> i & 1 == 1 { 0.6 } else { -0.6 });
    Shape::Mesh(Arc::new(Mesh::hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()))
}

fn shapes() -> Vec<Shape> {
    vec![
        Shape::Plane,
        Shape::Ball { radius: 0.7 },
        Shape::Cylinder { radius: 0.7, half: f64::INFINITY },
        Shape::Cylinder { radius: 0.7, half: 0.5 },
        Shape::Tube { radius: 0.9, half: f64::INFINITY },
        Shape::Tube { radius: 0.9, half: 0.5 },
        Shape::Cuboid { half: [0.5, 0.6, 0.7] },
        cube(),
    ]
}

/// A point that is as far from the shape as asked for, found by going along the normal.
fn near(shape: &Shape, distance: f64, r: &mut Random) -> V3<f64> {
    let mut x = r.vector(1.2);
    for _ in 0..50 {
        let gap = shape.gap(&x, f64::INFINITY).unwrap();
        let left = distance - gap.distance;
        (0..3).for_each(|i| x[i] += left * gap.normal[i]);
    }
    x
}

/// The balls that touch, one at a time, and the vectors of coordinates that move with them.
fn balls(r: &mut Random) -> Vec<(ContactPoint, Vec<usize>)> {
    let nodes = nodes();
    let point = |held| ContactPoint { held, radius: RADIUS };
    let [a, b] = [nodes[1], nodes[2]];
    let between = Held::Between {
        q: [a.q, a.q + 3, b.q, b.q + 3],
        v: [a.v, a.v + 3, b.v, b.v + 3],
        weight: [0.7, 0.2, 0.3, -0.1],
    };
    let beside = Held::Beside { q: nodes[3].q, v: nodes[3].v, arm: r.vector(0.5) };
    vec![
        (point(Held::Moves { q: 0, v: 0 }), vec![0]),
        (point(between), vec![a.q, b.q]),
        (point(beside), vec![nodes[3].q]),
    ]
}

/// Every shape, on the ground and on a body, touched by every ball, with the state in which it is.
fn scenes(law: ContactLaw, mut see: impl FnMut(&Contact, &Numbers, &str)) {
    let nodes = nodes();
    let mut r = Random(7);
    for shape in shapes() {
        for body in [false, true] {
            let (origin, axes) = (r.vector(0.5), around(r.vector(1.0)));
            let marker = if body {
                Marker::Node { node: NodeId(SEAT as u32), point: origin, axes }
            } else {
                Marker::Ground { point: origin, axes }
            };
            for (ball, moves) in balls(&mut r) {
                let mut s = Numbers::new(&mut r);
                let y = near(&shape, 0.6 * RADIUS, &mut r);
                // from the shape's axes to space
                let local: V3<f64> =
                    std::array::from_fn(|i| origin[i] + (0..3).map(|k| axes[k][i] * y[k]).sum::<f64>());
                let seat = nodes[SEAT].q;
                let x = if body {
                    let turned = times(&s.axes(), &local);
                    std::array::from_fn(|i| s.q[seat + i] + turned[i])
                } else {
                    local
                };
                let now = ball.held.x(&s.at());
                for q in &moves {
                    (0..3).for_each(|i| s.q[q + i] += x[i] - now[i]);
                }
                let contact =
                    Contact::new("c", &nodes, shape.clone(), &marker, (&[ball], &[]), STIFF, law).unwrap();
                let depth = contact.depths(&s.at()).next().unwrap().expect("touches");
                assert!((depth - 0.4 * RADIUS).abs() < 1e-9, "{shape:?}: {depth}");
                let what = format!("{shape:?}, on a body: {body}, {:?}, {law:?}", ball.held);
                see(&contact, &s, &what);
            }
        }
    }
}

fn laws() -> Vec<ContactLaw> {
    let plain = ContactLaw::default();
    vec![
        plain,
        ContactLaw { exponent: 1.5, ..plain },
        ContactLaw { damping: Damping::HuntCrossley(0.2), ..plain },
        ContactLaw {
            damping: Damping::KelvinVoigt { retardation_time: 0.05, until: Leaving::Depth },
            ..plain
        },
        ContactLaw { exponent: 1.5, damping: Damping::HuntCrossley(0.2), ..plain },
    ]
}

#[test]
fn tangents_are_exact_for_every_shape_ball_and_law() {
    for law in laws() {
        scenes(law, |contact, s, what| {
            let error = check_tangent(contact, &nodes(), &s.at(), Width::One);
            assert!(error < 1e-7, "{error:e}: {what}");
        });
    }
}

#[test]
fn distances_have_unit_gradients_and_the_curvature_that_they_say() {
    let mut r = Random(3);
    for shape in shapes() {
        for _ in 0..200 {
            let x = r.vector(1.3);
            let Some(gap) = shape.gap(&x, f64::INFINITY) else { panic!("{shape:?}") };
            let moved = |i: usize, h: f64| {
                let mut x = x;
                x[i] += h;
                shape.gap(&x, f64::INFINITY).unwrap()
            };
            // a kink of the distance between two sides is no place for differences
            let kink = (0..3).any(|i| {
                let (a, b) = (moved(i, -1e-3), moved(i, 1e-3));
                a.bends.map(|k| k.0 == 0.0) != b.bends.map(|k| k.0 == 0.0)
                    || (0..3).any(|k| (a.normal[k] - b.normal[k]).abs() > 0.1)
            });
            if kink {
                continue;
            }
            for i in 0..3 {
                let by = difference(|h| {
                    let g = moved(i, h);
                    vec![g.distance, g.normal[0], g.normal[1], g.normal[2]]
                });
                let mut e = [0.0; 3];
                e[i] = 1.0;
                let turn = gap.turn(&e);
                assert!((by[0] - gap.normal[i]).abs() < 1e-8, "{shape:?} at {x:?}: {by:?}, {gap:?}");
                for k in 0..3 {
                    assert!((by[1 + k] - turn[k]).abs() < 1e-6, "{shape:?} at {x:?}: {by:?}, {turn:?}");
                }
            }
        }
    }
}

#[test]
fn a_hull_is_the_cuboid_that_it_encloses() {
    let (hull, cuboid) = (cube(), Shape::Cuboid { half: [0.6; 3] });
    let mut r = Random(5);
    for _ in 0..500 {
        let x = r.list(3, 1.2);
        let x = [x[0], x[1], x[2]];
        let (a, b) = (hull.gap(&x, f64::INFINITY).unwrap(), cuboid.gap(&x, f64::INFINITY).unwrap());
        assert!((a.distance - b.distance).abs() < 1e-12, "{x:?}: {a:?}, {b:?}");
        for i in 0..3 {
            assert!((a.normal[i] - b.normal[i]).abs() < 1e-9, "{x:?}: {a:?}, {b:?}");
        }
    }
}

#[test]
fn power_and_energy_add_up_to_what_the_force_does() {
    // the generalised force times the velocities is the loss of the energy stored and what is dissipated
    for law in laws() {
        scenes(law, |contact, s, what| {
            let nodes = nodes();
            let at = s.at();
            let (r, _) = dense(contact, &nodes, &at, Weights::default(), Width::One);
            let work: f64 = r.iter().zip(&s.v).map(|(r, v)| r * v).sum();
            let stored = difference(|h| {
                let mut q = s.q.clone();
                let d: Vec<f64> = s.v.iter().map(|v| h * v).collect();
                ropewalk_core::retract(&nodes, &s.q, &d, &mut q);
                vec![contact.energy(&At { q: &q, ..at }).potential]
            })[0];
            let lost = contact.power(&at).dissipated;
            let size = work.abs().max(stored.abs()).max(1.0);
            assert!((work - stored - lost).abs() < 1e-8 * size, "{work} is not {stored} + {lost}: {what}");
        });
    }
}

/// The same with bristles that have taken hold: the contact, the numbers before and after what touches has moved by
/// about `way`, and what the bristles remember.
fn rough(way: f64, mut see: impl FnMut(&Contact, &Numbers, &[f64], &str)) {
    let friction = Friction { across: Some(0.25), ..Friction::new(0.4) };
    let law = ContactLaw { friction: Some(friction), ..ContactLaw::default() };
    let grip = Grip { stiffness: 1e3, damping: 10.0, brake: None };
    let mut r = Random(41);
    scenes(law, |contact, s, what| {
        let contact = contact.clone().with_grips(&[grip], 0);
        let mut memory = vec![0.0; Contact::memory(1, 0)];
        contact.remember(&s.at(), &mut memory);
        assert!(memory[0] == 1.0, "{what}");
        let d = r.list(s.v.len(), way);
        let v = s.v.iter().map(|v| way * v).collect();
        let mut moved = Numbers { q: s.q.clone(), v, a: s.a.clone() };
        ropewalk_core::retract(&nodes(), &s.q, &d, &mut moved.q);
        see(&contact, &moved, &memory, what);
    });
}

#[test]
fn tangents_of_friction_are_exact_while_it_holds_and_while_it_slips() {
    for (way, bent) in [(1e-3, 0.05), (3e-2, 0.6)] {
        let (mut worst, mut slip, mut hold) = (0.0_f64, 0, 0);
        rough(way, |contact, s, memory, what| {
            let at = At { internal: memory, ..s.at() };
            let mut shown = Vec::new();
            contact.observe(&at, &mut shown);
            if shown[3] == 0.0 {
                return;
            }
            if shown[7] > 0.0 {
                slip += 1
            } else {
                hold += 1
            }
            let error = check_tangent(contact, &nodes(), &at, Width::One);
            // left out is how the normal turns the directions in which a stretch counts: small as the stretch is
            let most = if what.starts_with("Plane") && !what.contains("Beside") { 1e-5 } else { bent };
            assert!(error < most, "{error:e}: {what}");
            worst = worst.max(error);
        });
        println!("{way}: {worst:.1e}, {slip} slip, {hold} hold");
    }
}

#[test]
fn what_friction_takes_up_is_told() {
    rough(0.02, |contact, s, memory, what| {
        let nodes = nodes();
        let at = At { internal: memory, ..s.at() };
        let mut shown = Vec::new();
        contact.observe(&at, &mut shown);
        if shown[3] == 0.0 {
            return;
        }
        let (r, _) = dense(contact, &nodes, &at, Weights::default(), Width::One);
        let work: f64 = r.iter().zip(&s.v).map(|(r, v)| r * v).sum();
        let stored = difference(|h| {
            let mut q = s.q.clone();
            let d: Vec<f64> = s.v.iter().map(|v| h * v).collect();
            ropewalk_core::retract(&nodes, &s.q, &d, &mut q);
            vec![contact.energy(&At { q: &q, ..at }).potential]
        })[0];
        let lost = contact.power(&at).dissipated;
        let size = work.abs().max(stored.abs()).max(0.1);
        assert!((work - stored - lost).abs() < 1e-6 * size, "{work} is not {stored} + {lost}: {what}");
    });
}

#[test]
fn both_sides_get_opposite_forces_and_moments() {
    rough(0.05, |contact, s, memory, what| {
        let nodes = nodes();
        let at = At { internal: memory, ..s.at() };
        if contact.depths(&at).next().unwrap().is_none() {
            return;
        }
        let (r, _) = dense(contact, &nodes, &at, Weights::default(), Width::One);
        let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
        for n in &nodes {
            let f = [r[n.v], r[n.v + 1], r[n.v + 2]];
            let arm = [s.q[n.q], s.q[n.q + 1], s.q[n.q + 2]];
            let lever = ropewalk_core::held::cross(&arm, &f);
            let own: V3<f64> = match n.kind {
                NodeKind::Frame => {
                    let q = &s.q[n.q + 3..n.q + 7];
                    times(&matrix(&[q[0], q[1], q[2], q[3]]), &[r[n.v + 3], r[n.v + 4], r[n.v + 5]])
                }
                NodeKind::Slope => {
                    let slope = [s.q[n.q + 3], s.q[n.q + 4], s.q[n.q + 5]];
                    ropewalk_core::held::cross(&slope, &[r[n.v + 3], r[n.v + 4], r[n.v + 5]])
                }
                _ => [0.0; 3],
            };
            for i in 0..3 {
                force[i] += f[i];
                moment[i] += lever[i] + own[i];
            }
        }
        if what.contains("on a body: true") {
            assert!(force.iter().chain(&moment).all(|x| x.abs() < 1e-10), "{force:?} {moment:?} {what}");
        } else {
            assert!(force.iter().any(|x| x.abs() > 1.0), "{what}");
        }
    });
}

#[test]
fn a_ball_that_flies_towards_a_shape_sees_it_in_time() {
    // a point at rest in space before a cuboid that comes closer and turns
    let mut r = Random(11);
    let nodes = nodes();
    for shape in shapes() {
        for _ in 0..20 {
            let mut s = Numbers::new(&mut r);
            let marker = Marker::Node {
                node: NodeId(SEAT as u32),
                point: [0.0; 3],
                axes: matrix(&from_bryant([0.0; 3])),
            };
            let y = near(&shape, if matches!(shape, Shape::Tube { .. }) { 0.7 } else { 2.0 }, &mut r);
            let x = times(&s.axes(), &y);
            let seat = nodes[SEAT];
            (0..3).for_each(|i| s.q[i] = s.q[seat.q + i] + x[i]);
            let ball = ContactPoint { held: Held::Moves { q: 0, v: 0 }, radius: 0.05 };
            let law = ContactLaw::default();
            let c = Contact::new("c", &nodes, shape.clone(), &marker, (&[ball], &[]), STIFF, law).unwrap();
            let h = c.step_limit(&s.at());
            if !h.is_finite() {
                continue;
            }
            // along the motion with constant accelerations it isn't touched before
            for k in 1..100 {
                let t = 0.99 * h.min(0.2) * k as f64 / 100.0;
                let mut q = s.q.clone();
                let d: Vec<f64> = s.v.iter().zip(&s.a).map(|(v, a)| v * t + 0.5 * a * t * t).collect();
                ropewalk_core::retract(&nodes, &s.q, &d, &mut q);
                let depth = c.depths(&At { q: &q, ..s.at() }).next().unwrap().unwrap_or(0.0);
                assert!(depth < 0.5 * 0.05, "{shape:?}: {depth} after {t} of {h}");
            }
        }
    }
}

/// A block with a valley along its top, which is no convex solid.
fn valley() -> Shape {
    let profile = [[-1.5, 0.5], [0.0, 0.0], [1.5, 0.5], [1.5, -1.5], [-1.5, -1.5]];
    let ring = |y: f64| profile.map(|[x, z]| [x, y, z]);
    let corners = [ring(-1.5), ring(1.5)].concat();
    let mut triangles = Vec::new();
    for k in 0..5 {
        let l = (k + 1) % 5;
        triangles.extend([[k, l, l + 5], [k, l + 5, k + 5]]);
    }
    for [a, b, c] in [[1, 0, 4], [1, 4, 3], [1, 3, 2]] {
        triangles.extend([[a, b, c], [a + 5, c + 5, b + 5]]);
    }
    let mut soup = Soup { corners, triangles };
    if Mesh::new(soup.clone(), false).is_err() {
        soup.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    }
    Shape::Mesh(Arc::new(Mesh::new(soup, false).unwrap()))
}

/// The slender pieces that touch: an element of a cable, and a hull.
fn spans(r: &mut Random) -> Vec<(ContactSpan, Vec<usize>)> {
    let nodes = nodes();
    let ([a, b], body) = ([nodes[1], nodes[2]], nodes[3]);
    let span =
        |line| ContactSpan { line, radius: RADIUS, length: 1.1, s: 0.0, tips: [false, true], flow: None };
    let cubic = SpanLine::Cubic { q: [a.q, a.q + 3, b.q, b.q + 3], v: [a.v, a.v + 3, b.v, b.v + 3], l: 1.1 };
    let (from, along) = (r.vector(0.5), around(r.vector(1.0))[2]);
    let to = std::array::from_fn(|i| from[i] + 1.3 * along[i]);
    let straight = SpanLine::Straight { q: body.q, v: body.v, ends: [from, to], along };
    vec![(span(cubic), vec![a.q, b.q]), (span(straight), vec![body.q])]
}

/// Every shape, on the ground and on a body, touched by slender pieces somewhere along them.
fn slender(law: ContactLaw, mut see: impl FnMut(&Contact, &Numbers, &str)) {
    let nodes = nodes();
    let mut r = Random(23);
    let mut shapes = shapes();
    shapes.push(valley());
    for shape in shapes {
        for body in [false, true] {
            let (origin, axes) = (r.vector(0.5), around(r.vector(1.0)));
            let marker = if body {
                Marker::Node { node: NodeId(SEAT as u32), point: origin, axes }
            } else {
                Marker::Ground { point: origin, axes }
            };
            for (span, moves) in spans(&mut r) {
                let mut s = Numbers::new(&mut r);
                if let [a, b] = moves[..] {
                    // a curve without loops, about as long as it should be
                    let way = around(r.vector(1.0))[2];
                    for i in 0..3 {
                        s.q[b + i] = s.q[a + i] + 1.1 * way[i] + 0.1 * (s.q[b + i] - 0.5);
                        s.q[a + 3 + i] = way[i] + 0.3 * s.q[a + 3 + i];
                        s.q[b + 3 + i] = way[i] + 0.3 * s.q[b + 3 + i];
                    }
                }
                let y = near(&shape, 0.7 * RADIUS, &mut r);
                let local: V3<f64> =
                    std::array::from_fn(|i| origin[i] + (0..3).map(|k| axes[k][i] * y[k]).sum::<f64>());
                let seat = nodes[SEAT].q;
                let x = if body {
                    let turned = times(&s.axes(), &local);
                    std::array::from_fn(|i| s.q[seat + i] + turned[i])
                } else {
                    local
                };
                let now = span.line.held(0.37).x(&s.at());
                for q in &moves {
                    (0..3).for_each(|i| s.q[q + i] += x[i] - now[i]);
                }
                let contact =
                    Contact::new("c", &nodes, shape.clone(), &marker, (&[], &[span]), STIFF, law).unwrap();
                let what = format!("{shape:?}, on a body: {body}, {:?}, {law:?}", span.line);
                assert!(contact.depths(&s.at()).next().unwrap().is_some_and(|d| d > 0.29 * RADIUS), "{what}");
                see(&contact, &s, &what);
            }
        }
    }
}

/// What quadrature may leave of forces and tangents: nothing on planes, little on curved shapes even as small as these,
/// more where the curvature jumps at an edge within the contact.
fn left(what: &str, law: ContactLaw) -> f64 {
    if what.contains("Plane") && law == ContactLaw::default() {
        1e-7
    } else if what.contains("Ball") || what.contains("Plane") || what.contains("half: inf") {
        if law.exponent == 1.0 { 3e-3 } else { 0.2 }
    } else {
        0.2
    }
}

#[test]
fn forces_on_slender_pieces_are_the_gradient_of_their_energy() {
    // what quadrature leaves: nothing on planes, little on curved shapes
    let (mut worst, mut count) = (0.0_f64, 0);
    let law = ContactLaw::default();
    slender(law, |contact, s, what| {
        let nodes = nodes();
        let at = s.at();
        let (force, _) = dense(contact, &nodes, &at, Weights::default(), Width::One);
        let size = force.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for k in 0..force.len() {
            let by = difference(|h| {
                let (mut q, mut d) = (s.q.clone(), vec![0.0; s.v.len()]);
                d[k] = h;
                ropewalk_core::retract(&nodes, &s.q, &d, &mut q);
                vec![contact.energy(&At { q: &q, ..at }).potential]
            })[0];
            let error = (by - force[k]).abs() / size;
            assert!(error < left(what, law), "{error:e} of unknown {k}: {what}");
            worst = worst.max(error);
        }
        count += 1;
    });
    println!("worst of {count}: {worst:.1e}");
}

#[test]
fn tangents_of_slender_pieces_are_those_of_their_forces() {
    for law in laws() {
        let mut worst = 0.0_f64;
        slender(law, |contact, s, what| {
            let error = check_tangent(contact, &nodes(), &s.at(), Width::One);
            // ends of contact move; what they leave out is zero but for the quadrature. The force of a linear damper jumps
            // there
            let jumps = matches!(law.damping, Damping::KelvinVoigt { .. });
            assert!(jumps || error < left(what, law), "{error:e}: {what}");
            worst = worst.max(error);
        });
        println!("{worst:.1e} {law:?}");
    }
}

#[test]
fn the_tangent_under_a_bar_is_exact_but_for_quadrature() {
    // proportions of a real one: a bar ten times as thick as the cable, a fifth of its radius deep
    let nodes = nodes();
    let (bar, radius, l) = (0.05, 0.005, 0.25);
    let [a, b] = [nodes[1], nodes[2]];
    let line = SpanLine::Cubic { q: [a.q, a.q + 3, b.q, b.q + 3], v: [a.v, a.v + 3, b.v, b.v + 3], l };
    let span = ContactSpan { line, radius, length: l, s: 0.0, tips: [false; 2], flow: None };
    let stiff = Stiffness { per_length: 1e6, ..STIFF };
    let mut s = Numbers::new(&mut Random(5));
    for height in [0.0545, 0.054, 0.053] {
        let place = [
            [-0.1, 0.01, height - 0.01],
            [1.0, 0.0, 0.1],
            [0.149, -0.01, height - 0.012],
            [0.99, -0.05, -0.15],
        ];
        for (at, x) in [a.q, a.q + 3, b.q, b.q + 3].into_iter().zip(place) {
            s.q[at..at + 3].copy_from_slice(&x);
        }
        let axes = around([0.0, 1.0, 0.0]);
        let shape = Shape::Cylinder { radius: bar, half: f64::INFINITY };
        let marker = Marker::Ground { point: [0.0; 3], axes };
        let law = ContactLaw::default();
        let c = Contact::new("c", &nodes, shape, &marker, (&[], &[span]), stiff, law).unwrap();
        println!("{:?} m deep", c.depths(&s.at()).next().unwrap());
        assert!(c.depths(&s.at()).next().unwrap().is_some());
        let error = check_tangent(&c, &nodes, &s.at(), Width::One);
        assert!(error < 1e-4, "{error:e} at {height}");
    }
}

/// A curve that may touch a shape at the origin.
fn on_the_ground(shape: &Shape, span: ContactSpan) -> Contact {
    let marker = Marker::Ground { point: [0.0; 3], axes: matrix(&from_bryant([0.0; 3])) };
    let law = ContactLaw::default();
    Contact::new("c", &nodes(), shape.clone(), &marker, (&[], &[span]), STIFF, law).unwrap()
}

/// The length of a curve of length 1 that touches a shape on the ground is that of its samples: that length, and how often they
/// change between touching and not.
fn compare_with_samples(contact: &Contact, shape: &Shape, span: &ContactSpan, s: &Numbers) -> (f64, usize) {
    let mut shown = Vec::new();
    contact.observe(&s.at(), &mut shown);
    let n = 4000;
    let touches = |k: usize| {
        let x = span.line.held((k as f64 + 0.5) / n as f64).x(&s.at());
        shape.gap(&x, span.radius).is_some()
    };
    let inside: Vec<bool> = (0..n).map(touches).collect();
    let length = inside.iter().filter(|i| **i).count() as f64 / n as f64;
    let changes = inside.windows(2).filter(|w| w[0] != w[1]).count();
    assert!(
        (shown[6] - length).abs() <= (changes as f64 + 1.0) / n as f64 + 1e-6,
        "{} instead of {length}: {shape:?}, radius {}, {:?}",
        shown[6],
        span.radius,
        span.line.place(&s.at())
    );
    (length, changes)
}

/// Curves that follow the surface of what is round, nearly: their depth changes by next to nothing beside how they bend.
#[test]
fn what_lies_around_something_round_touches_where_samples_show() {
    let mut r = Random(37);
    let nodes = nodes();
    let round = [
        Shape::Ball { radius: 1.0 },
        Shape::Cylinder { radius: 1.0, half: 0.4 },
        Shape::Cylinder { radius: 1.0, half: f64::INFINITY },
        Shape::Tube { radius: 1.0, half: 0.4 },
        Shape::Tube { radius: 1.0, half: f64::INFINITY },
    ];
    let (mut whole, mut partly) = (0, 0);
    for shape in round {
        let out = if let Shape::Tube { .. } = shape { -1.0 } else { 1.0 };
        for _ in 0..400 {
            let mut s = Numbers::new(&mut r);
            let (span, _) = spans(&mut r).swap_remove(0);
            let [a, b] = [nodes[1].q, nodes[2].q];
            // an arc that climbs a little, about as deep as a rope is on a drum
            let [draw, tilt, off] = [r.vector(1.0), r.vector(0.3), r.vector(1.0)];
            let (turn, radius, depth) = (1.2 * draw[0].abs(), 0.02 + 0.1 * draw[1].abs(), 1e-3 * draw[2]);
            for (at, angle, off) in [(a, 0.0, off[0]), (b, turn, off[1])] {
                let rho = 1.0 + out * (radius - depth * (1.0 + 0.5 * off));
                let (sin, cos) = f64::sin_cos(angle);
                s.q[at..at + 3].copy_from_slice(&[rho * cos, rho * sin, tilt[0] + tilt[1] * angle]);
                let slope = [-rho * sin, rho * cos, tilt[1]];
                (0..3).for_each(|i| s.q[at + 3 + i] = turn * slope[i] / 1.1);
            }
            let span = ContactSpan { radius, tips: [false; 2], length: 1.0, ..span };
            let contact = on_the_ground(&shape, span);
            let (length, changes) = compare_with_samples(&contact, &shape, &span, &s);
            whole += usize::from(length == 1.0);
            partly += usize::from(changes > 0);
        }
    }
    assert!(whole > 300 && partly > 100, "{whole} {partly}");
}

/// A line along a flank that isn't pressed on it is off by rounding all along: it touches as a whole or not at all.
#[test]
fn what_lies_along_a_flank_is_no_dust_of_contacts() {
    let nodes = nodes();
    for shape in [Shape::Cylinder { radius: 0.3, half: 9.0 }, Shape::Tube { radius: 0.7, half: 9.0 }] {
        let rho = if let Shape::Tube { .. } = shape { 0.6 } else { 0.4 };
        for k in 0..200 {
            let mut r = Random(43);
            let mut s = Numbers::new(&mut r);
            let (span, _) = spans(&mut r).swap_remove(0);
            let (sin, cos) = (0.1 + 0.37 * f64::from(k)).sin_cos();
            // to and fro by rounding
            for (at, z, off) in [(nodes[1].q, 0.1, 1.0), (nodes[2].q, 1.1, -1.0)] {
                let (rho, lean) = (rho * (1.0 + 2.0 * off * f64::EPSILON), 8.0 * off * f64::EPSILON);
                s.q[at..at + 3].copy_from_slice(&[rho * cos, rho * sin, z]);
                s.q[at + 3..at + 6].copy_from_slice(&[lean * cos, lean * sin, 1.0]);
            }
            let span = ContactSpan { radius: 0.1, tips: [false; 2], length: 1.0, ..span };
            let mut shown = Vec::new();
            on_the_ground(&shape, span).observe(&s.at(), &mut shown);
            assert!(shown[6] == 0.0 || shown[6] == 1.0, "{shape:?}, {k}: {}", shown[6]);
        }
    }
}

/// What goes in on one side of a shape and out on the other in a step is told, and nothing is told of what stays outside.
#[test]
fn what_passes_through_a_shape_is_seen_and_nothing_else() {
    let mut r = Random(41);
    let nodes = nodes();
    let (mut through, mut outside) = (0, 0);
    for shape in shapes().into_iter().filter(|shape| !matches!(shape, Shape::Plane | Shape::Tube { .. })) {
        for k in 0..400 {
            let mut s = Numbers::new(&mut r);
            let (span, _) = spans(&mut r).swap_remove(0);
            let span = ContactSpan { radius: 0.05, tips: [false; 2], length: 1.0, ..span };
            let [a, b] = [nodes[1].q, nodes[2].q];
            for at in [a, a + 3, b, b + 3] {
                s.q[at..at + 3].copy_from_slice(&r.vector(if at == a || at == b { 2.5 } else { 0.5 }));
            }
            // every other time it goes along rather than about
            let way = r.vector(if k % 2 == 0 { 4.0 } else { 0.3 });
            let mut after = s.q.clone();
            for at in [a, b] {
                (0..3).for_each(|i| after[at + i] += way[i]);
            }
            let (before, after) = (s.at(), At { q: &after, ..s.at() });
            let contact = on_the_ground(&shape, span);
            let told = contact.passes(&before, &after).is_some();
            // the way of a point that is looked at by itself, in small steps
            let sides = |xi: f64| {
                let [x, y] = [&before, &after].map(|at| span.line.held(xi).x(at));
                let on_way = |t: f64| std::array::from_fn(|i| x[i] + t * (y[i] - x[i]));
                let seen = (0..=400).filter_map(|n| shape.gap(&on_way(f64::from(n) / 400.0), span.radius));
                seen.map(|gap| gap.normal).collect::<Vec<V3<f64>>>()
            };
            let crosses = |xi: f64| match &sides(xi)[..] {
                [first, .., last] => dot(first, last) < -0.05,
                _ => false,
            };
            let near = |k: u32| !sides(f64::from(k) / 40.0).is_empty();
            if [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().any(crosses) {
                assert!(told, "{shape:?}: {:?} by {way:?}", span.line.place(&before));
                through += 1;
            } else if !(0..=40).any(near) {
                assert!(!told, "{shape:?}: {:?} by {way:?}", span.line.place(&before));
                outside += 1;
            }
        }
    }
    assert!(through > 50 && outside > 50, "{through} {outside}");
}

#[test]
fn places_of_contact_are_those_that_samples_show() {
    let mut r = Random(29);
    let nodes = nodes();
    let mut shapes = shapes();
    shapes.push(valley());
    let (mut touching, mut several) = (0, 0);
    for shape in shapes {
        for _ in 0..300 {
            let mut s = Numbers::new(&mut r);
            let (span, _) = spans(&mut r).swap_remove(0);
            let size = if matches!(shape, Shape::Tube { .. }) { 0.8 } else { 1.6 };
            let [a, b] = [nodes[1].q, nodes[2].q];
            for at in [a, a + 3, b, b + 3] {
                s.q[at..at + 3].copy_from_slice(&r.vector(size));
            }
            let radius = 0.02 + 0.3 * r.vector(1.0)[0].abs();
            let span = ContactSpan { radius, tips: [false; 2], length: 1.0, ..span };
            let contact = on_the_ground(&shape, span);
            let (length, changes) = compare_with_samples(&contact, &shape, &span, &s);
            touching += usize::from(length > 0.0);
            several += usize::from(changes > 2);
        }
    }
    println!("{touching} touch, {several} at several places");
    assert!(touching > 500 && several > 20, "{touching} {several}");
}

#[test]
fn a_curve_that_flies_towards_a_shape_sees_it_in_time() {
    let mut r = Random(31);
    let nodes = nodes();
    let mut shapes = shapes();
    shapes.push(valley());
    let mut finite = 0;
    for shape in shapes {
        for k in 0..80 {
            let mut s = Numbers::new(&mut r);
            let axes = matrix(&from_bryant([0.0; 3]));
            let on_body = k % 2 == 0;
            let marker = if on_body {
                Marker::Node { node: NodeId(SEAT as u32), point: [0.0; 3], axes }
            } else {
                Marker::Ground { point: [0.0; 3], axes }
            };
            let (mut span, _) = spans(&mut r).swap_remove(0);
            (span.radius, span.tips) = (0.05, [false; 2]);
            let inside = matches!(shape, Shape::Tube { .. });
            let y = near(&shape, if inside { 0.7 } else { 2.0 }, &mut r);
            let (seat, [a, b]) = (nodes[SEAT].q, [nodes[1].q, nodes[2].q]);
            let turned = times(&s.axes(), &y);
            let x = if on_body { std::array::from_fn(|i| s.q[seat + i] + turned[i]) } else { y };
            let way = r.vector(if inside { 0.2 } else { 1.0 });
            for i in 0..3 {
                s.q[a + i] = x[i] - 0.5 * way[i];
                s.q[b + i] = s.q[a + i] + way[i];
                s.q[a + 3 + i] *= 0.2;
                s.q[b + 3 + i] *= 0.2;
            }
            let law = ContactLaw::default();
            let c = Contact::new("c", &nodes, shape.clone(), &marker, (&[], &[span]), STIFF, law).unwrap();
            if c.depths(&s.at()).next().unwrap().is_some() {
                continue;
            }
            let h = c.step_limit(&s.at());
            finite += usize::from(h < 0.2);
            for k in 1..100 {
                let t = 0.99 * h.min(0.2) * k as f64 / 100.0;
                let mut q = s.q.clone();
                let d: Vec<f64> = s.v.iter().zip(&s.a).map(|(v, a)| v * t + 0.5 * a * t * t).collect();
                ropewalk_core::retract(&nodes, &s.q, &d, &mut q);
                let depth = c.depths(&At { q: &q, ..s.at() }).next().unwrap().unwrap_or(0.0);
                assert!(depth < 0.5 * 0.05, "{shape:?}: {depth} after {t} of {h}");
            }
        }
    }
    assert!(finite > 30, "{finite}");
}
