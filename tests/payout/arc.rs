//! Cables on wheels: what lies on the wheel, against Lagrange's equations and closed forms.

use approx::assert_relative_eq;
use ropewalk_constraints::reeving::{
    Arc, End, Grip, Hold, Instant, Mode, Piece, Residual, Tangency, Tangent, Wheel,
};
use ropewalk_core::rotation::{around, cross};
use ropewalk_core::testing::{check_constraint, difference};
use ropewalk_core::{At, Constraint, Marker, Node, NodeId, NodeKind, Related, V3, dot};
use ropewalk_scene::Strand;

const RADIUS: f64 = 0.25;
const STORED: f64 = 0.4;

fn arc(grip: Grip) -> Arc {
    let strand =
        Strand { mass: 1.3, ea: 2e3, ei: 0.7, damping: 3.0, diameter: 0.0, weighs: true, torsion: None };
    let bearing = [0.2, 0.003, 0.05];
    Arc {
        radius: RADIUS,
        strand,
        gravity: [0.3, -0.2, -9.81],
        grip,
        slip_speed: 0.01,
        sliding: 0.0,
        near: None,
        stress: None,
        pull: 0.0,
        bearing,
    }
}

fn plus(a: &V3<f64>, x: f64, b: &V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] + x * b[i])
}

/// Angles of the tangent points, material coordinates, centre and axis of a wheel that moves, at time `t`. With `steady`
/// the cable runs at the same speed along all of the arc.
fn moving(t: f64, steady: bool) -> ([f64; 2], [f64; 2], V3<f64>, V3<f64>) {
    let angles = [-1.1 + 0.4 * t + 0.3 * t * t, 1.2 - 0.5 * t + 0.2 * t * t];
    let first = 0.02 - 0.6 * t + 0.4 * t * t;
    // the same stretch all the time is the same speed at both ends
    let stretch = RADIUS * 2.3 / (STORED + 0.11);
    let last = if steady {
        RADIUS * (angles[1] - angles[0]) / stretch - STORED + first
    } else {
        0.13 - 0.5 * t - 0.3 * t * t
    };
    (angles, [first, last], [0.1 + 0.5 * t - t * t, 0.3 * t, 0.2 - 0.7 * t + 0.2 * t * t], [0.1, 0.97, -0.2])
}

/// All of that with velocities and accelerations by differences.
fn local(t: f64, steady: bool) -> ([End<f64>; 2], Wheel<f64>) {
    let state = |t: f64| -> Vec<f64> {
        let (angles, p, c, axis) = moving(t, steady);
        let [x, y, _] = around(axis);
        let mut all = Vec::new();
        for k in 0..2 {
            // about the axis x cross y
            let (sin, cos) = angles[k].sin_cos();
            all.extend(plus(&plus(&c, RADIUS * cos, &x), RADIUS * sin, &y));
            all.push(p[k]);
        }
        all.extend(c);
        all
    };
    let now = state(t);
    let v = difference(|h| state(t + h));
    let a = ropewalk_core::testing::second(|h| state(t + h));
    let three = |x: &[f64], i: usize| [x[i], x[i + 1], x[i + 2]];
    let ends = [0, 4].map(|i| End {
        r: [three(&now, i), three(&v, i), three(&a, i)],
        p: [now[i + 3], v[i + 3], a[i + 3]],
    });
    let [.., axis] = around(moving(t, steady).3);
    let c = [three(&now, 8), three(&v, 8), three(&a, 8)];
    (ends, Wheel { c, axis, spin: 1.7, carrier: 0.3 })
}

fn eval(arc: &Arc, t: f64, steady: bool) -> (Residual<f64>, Instant<f64>) {
    let (ends, wheel) = local(t, steady);
    arc.eval(STORED, &ends, &wheel)
}

/// Power of minus the residual: what the arc takes from all that moves it.
fn taken(arc: &Arc, t: f64, steady: bool) -> f64 {
    let ((ends, wheel), (out, _)) = (local(t, steady), eval(arc, t, steady));
    let of_ends: f64 = (0..2).map(|k| dot(&out.r[k], &ends[k].r[1]) + out.p[k] * ends[k].p[1]).sum();
    let spin = if matches!(arc.grip, Grip::Slides(_)) { wheel.spin } else { wheel.carrier };
    of_ends + dot(&out.centre, &wheel.c[1]) + out.groove * spin
}

/// Kinetic energy and weight of the material that comes on to the arc at its ends, by time: the spans beside it lose that.
fn carried(arc: &Arc, t: f64, steady: bool) -> f64 {
    let ((ends, wheel), (_, now)) = (local(t, steady), eval(arc, t, steady));
    let [c, cd, _] = wheel.c;
    (0..2)
        .map(|k| {
            let along = cross(&wheel.axis, &plus(&ends[k].r[0], -1.0, &c)).map(|x| x / RADIUS);
            let v = plus(&cd, now.speed[k], &along);
            let density = 0.5 * dot(&v, &v) - dot(&arc.gravity, &ends[k].r[0]);
            let rate = if k == 0 { -ends[k].p[1] } else { ends[k].p[1] };
            arc.strand.mass * density * rate
        })
        .sum()
}

#[test]
fn what_an_arc_takes_it_stores_or_turns_into_heat() {
    for grip in [Grip::Slides(0.0), Grip::Slides(0.4), Grip::Turns(0.8)] {
        // with a stretch that changes, the motion along the arc is linear but for its own rate: 2e-3 of tension and speed
        for (steady, tolerance) in [(true, 1e-6), (false, 2e-3)] {
            let (arc, t) = (arc(grip), 0.05);
            let energy = |t: f64| eval(&arc, t, steady).1.energy.iter().sum::<f64>();
            let stored = difference(|h| vec![energy(t + h)])[0];
            let lost = eval(&arc, t, steady).1.dissipated;
            assert!(grip == Grip::Slides(0.0) || lost > 0.0);
            let scale = eval(&arc, t, steady).1.tension;
            assert!(scale > 100.0);
            let off = (taken(&arc, t, steady) + carried(&arc, t, steady) - stored - lost).abs() / scale;
            assert!(off < tolerance, "{grip:?}, steady {steady}: {off}");
        }
    }
}

#[test]
fn at_rest_an_arc_without_friction_has_a_potential_also_where_its_ends_are_not_on_the_wheel() {
    let mut arc = arc(Grip::Slides(0.0));
    arc.strand.weighs = false;
    arc.gravity = [0.0; 3];
    let (ends, wheel) = local(0.05, true);
    let none = [0.0; 3];
    // places of both ends and of the centre, coordinates of the material
    let mut x: Vec<f64> = [ends[0].r[0], ends[1].r[0], wheel.c[0]].concat();
    x.extend(ends.map(|end| end.p[0]));
    for (k, x) in x[..9].iter_mut().enumerate() {
        *x += 0.02 * (1.7 * k as f64).sin();
    }
    let force = |x: &[f64]| -> Vec<f64> {
        let three = |i: usize| [x[i], x[i + 1], x[i + 2]];
        let wheel = Wheel { c: [three(6), none, none], ..wheel };
        let ends = [0, 1].map(|k| End { r: [three(3 * k), none, none], p: [x[9 + k], 0.0, 0.0] });
        let (out, _) = arc.eval(STORED, &ends, &wheel);
        [out.r[0].to_vec(), out.r[1].to_vec(), out.centre.to_vec(), out.p.to_vec()].concat()
    };
    let columns: Vec<Vec<f64>> = (0..x.len())
        .map(|j| {
            difference(|h| {
                let mut moved = x.clone();
                moved[j] += h;
                force(&moved)
            })
        })
        .collect();
    let largest = columns.concat().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for i in 0..x.len() {
        for j in 0..i {
            let off = columns[j][i] - columns[i][j];
            assert!(off.abs() < 1e-7 * largest, "{i} {j}: {off} of {largest}");
        }
    }
}

#[test]
fn sliding_at_a_speed_follows_the_capstan_equation_to_the_last_digit() {
    // (T2 - m v²) = (T1 - m v²) exp(mu theta), reference capstan_speed: T1 = 100 N, mu = 0.2, half a turn
    let strand =
        Strand { mass: 1.0, ea: 1e6, ei: 0.0, damping: 0.0, diameter: 0.0, weighs: false, torsion: None };
    let (radius, mu, wrap) = (0.1, 0.2, std::f64::consts::PI);
    let exact = [
        (0.01, 187.44552131292505),
        (2.0, 183.94778440819246),
        (5.0, 165.58420656890036),
        (8.0, 131.48041915307218),
        (9.9, 101.74016761429482),
    ];
    for (speed, out) in exact {
        let grip = Grip::Slides(mu);
        let arc = Arc {
            radius,
            strand,
            gravity: [0.0; 3],
            grip,
            slip_speed: 1e-9,
            sliding: 0.0,
            near: None,
            stress: None,
            pull: 0.0,
            bearing: [0.0; 3],
        };
        // the speed that turns the momentum is in space, the mass per stretched length: m v²/λ with λ of the arc
        let inner = |stretch: f64| 100.0 - strand.mass * speed * speed / stretch;
        let mut stretch = 1.0;
        for _ in 0..50 {
            let tension = inner(stretch) * (mu * wrap / 2.0).exp() + 100.0 - inner(stretch);
            stretch = 1.0 + tension / strand.ea;
        }
        let stored = radius * wrap / stretch;
        let ends = [[-radius, 0.0, 0.0], [radius, 0.0, 0.0]]
            .map(|r| End { r: [r, [0.0; 3], [0.0; 3]], p: [0.0, -speed / stretch, 0.0] });
        let wheel = Wheel { c: [[0.0; 3]; 3], axis: [0.0, 1.0, 0.0], spin: 0.0, carrier: 0.0 };
        let (_, instant) = arc.eval(stored, &ends, &wheel);
        assert_relative_eq!(instant.wrap, wrap, max_relative = 1e-14);
        assert_relative_eq!(instant.beside[0], 100.0, max_relative = 1e-9);
        // the reference counts m per stretched length
        assert_relative_eq!(instant.beside[1], out, max_relative = 2e-4);
        let presses = instant.beside[1] - instant.lift[1];
        assert_relative_eq!(presses / (100.0 - instant.lift[0]), (mu * wrap).exp(), max_relative = 1e-9);
        // the axle carries T1 + T2 - 2 m v²
        assert_relative_eq!(
            instant.axle[2],
            -(100.0 + instant.beside[1] - 2.0 * instant.lift[0]),
            max_relative = 1e-9
        );
    }
}

#[test]
fn uniform_motion_of_an_arc_has_the_energy_of_its_mass() {
    let mut arc = arc(Grip::Slides(0.0));
    arc.gravity = [0.0; 3];
    let (ends, mut wheel) = local(0.0, true);
    let v = [0.3, -0.4, 1.2];
    let still = ends.map(|end| End { r: [end.r[0], v, [0.0; 3]], p: [end.p[0], 0.0, 0.0] });
    wheel.c[1] = v;
    let (_, instant) = arc.eval(STORED, &still, &wheel);
    assert_relative_eq!(instant.energy[0], 0.5 * 1.3 * instant.length * dot(&v, &v), max_relative = 1e-12);
}

#[test]
fn derivatives_of_tangency_are_those_of_its_equations() {
    let nodes = [
        Node { kind: NodeKind::Slope, q: 0, v: 0, shared: false },
        Node { kind: NodeKind::Frame, q: 6, v: 6, shared: false },
    ];
    let q = [0.3, 0.1, 0.4, 0.6, 0.5, -0.7, 0.1, -0.2, 0.3, 0.8, 0.36, 0.48, 0.0];
    let v = [0.1, -0.2, 0.3, 0.4, -0.5, 0.6, 0.3, 0.2, -0.4, 0.7, -0.6, 0.5];
    let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 12], internal: &[], relaxed: None };
    let point = Node { kind: NodeKind::Point, q: 6, v: 6, shared: false };
    let on_body = Marker::beside(NodeId(1), [0.05, 0.1, -0.2]);
    let in_space = Marker::Ground { point: [0.1, -0.2, 0.3], axes: [[0.0; 3], [0.0; 3], [0.48, 0.6, 0.64]] };
    for (nodes, wheel) in [(nodes, on_body), (nodes, in_space), ([nodes[0], point], on_body)] {
        let related = Related::new("tangent", Tangent { radius: 0.5 }, vec![Marker::node(NodeId(0)), wheel]);
        let closed = Tangency::new("tangent", NodeId(0), wheel, 0.5);
        for way in [&related as &dyn Constraint, &closed] {
            assert!(check_constraint(way, &nodes, &at) < 1e-7);
        }
        // and one by automatic differentiation as the other in closed form, for each equation by itself
        let n = related.nodes().iter().map(|k| nodes[k.0 as usize].kind.velocities()).sum::<usize>();
        for row in 0..3 {
            let mut lambda = [0.0; 3];
            lambda[row] = 1.0;
            let [one, other] = [&related as &dyn Constraint, &closed].map(|way| {
                let (mut g, mut jacobian, mut bends) = (vec![0.0; 3], vec![0.0; 3 * n], vec![0.0; n * n]);
                way.jacobian(&nodes, &at, &mut g, &mut jacobian);
                way.geometric(&nodes, &at, &lambda, &mut bends);
                [g, jacobian, bends].concat()
            });
            let off = one.iter().zip(&other).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
            assert!(off < 1e-13, "{row}: {off}");
        }
    }
}

#[test]
fn derivatives_of_all_ways_to_hold_a_cable_are_those_of_their_equations() {
    let nodes = [
        Node { kind: NodeKind::Slope, q: 0, v: 0, shared: false },
        Node { kind: NodeKind::Slope, q: 6, v: 6, shared: false },
        Node { kind: NodeKind::Frame, q: 12, v: 12, shared: false },
    ];
    let q =
        [0.3, 0.1, 0.4, 0.6, 0.5, -0.7, 0.5, 0.15, 0.3, 0.7, 0.3, -0.6, 0.1, -0.2, 0.3, 0.8, 0.36, 0.48, 0.0];
    let v: Vec<f64> = (0..18).map(|k| (1.7 * f64::from(k)).sin()).collect();
    let wheel = Marker::beside(NodeId(2), [0.05, 0.1, -0.2]);
    let hold = Hold::new("hold", &nodes, [NodeId(0), NodeId(1)], wheel, 0.5, 0);
    for mode in [Mode::Wraps, Mode::Touches, Mode::Off] {
        let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 18], internal: &[mode.value()], relaxed: None };
        let off = check_constraint(&hold, &nodes, &at);
        assert!(off < 1e-6, "{mode:?}: {off}");
    }
}

#[test]
fn what_a_straight_piece_takes_it_stores_or_turns_into_heat() {
    let strand =
        Strand { mass: 1.3, ea: 2e3, ei: 0.0, damping: 3.0, diameter: 0.0, weighs: true, torsion: None };
    let piece = Piece { strand, gravity: [0.3, -0.2, -9.81] };
    let state = |t: f64| {
        let first = [0.1 + 0.5 * t - t * t, 0.3 * t, 0.2 - 0.7 * t + 0.2 * t * t];
        let last = plus(&first, 1.0, &[0.5 + 0.1 * t * t, 0.1 - 0.3 * t, -0.2 + 0.4 * t]);
        let mut all: Vec<f64> = first.to_vec();
        all.push(0.02 - 0.6 * t + 0.4 * t * t);
        all.extend(last);
        all.push(0.13 - 0.5 * t - 0.3 * t * t);
        all
    };
    let eval = |t: f64| {
        let (now, v) = (state(t), difference(|h| state(t + h)));
        let a = ropewalk_core::testing::second(|h| state(t + h));
        let three = |x: &[f64], i: usize| [x[i], x[i + 1], x[i + 2]];
        let ends = [0, 4].map(|i| End {
            r: [three(&now, i), three(&v, i), three(&a, i)],
            p: [now[i + 3], v[i + 3], a[i + 3]],
        });
        (ends, piece.eval(STORED, &ends))
    };
    let t = 0.05;
    let (ends, (out, now)) = eval(t);
    let taken: f64 = (0..2).map(|k| dot(&out.r[k], &ends[k].r[1]) + out.p[k] * ends[k].p[1]).sum();
    let slope: V3<f64> = std::array::from_fn(|i| (ends[1].r[0][i] - ends[0].r[0][i]) / now.length);
    let carried: f64 = (0..2)
        .map(|k| {
            let v = plus(&ends[k].r[1], -ends[k].p[1], &slope);
            let rate = if k == 0 { -ends[k].p[1] } else { ends[k].p[1] };
            strand.mass * rate * (0.5 * dot(&v, &v) - dot(&piece.gravity, &ends[k].r[0]))
        })
        .sum();
    let stored = difference(|h| vec![eval(t + h).1.1.energy.iter().sum::<f64>()])[0];
    assert!(now.dissipated > 0.1 && now.tension > 50.0);
    let off = (taken + carried - stored - now.dissipated).abs() / now.tension;
    assert!(off < 1e-6, "{off}");
}
