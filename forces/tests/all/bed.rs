//! Beds: heights on a grid against brute force and differences, damping of what comes down, friction that a pull uses up.

use crate::random::Random;
use ropewalk_core::testing::check_tangent;
use ropewalk_core::{
    At, ContactSpan, Marker, Node, NodeKind, Remembers, Shows, SpanLine, Term, V3, Width, dot,
};
use ropewalk_forces::contact::{
    AtRest, Brake, Contact, ContactLaw, Damping, Friction, Grip, Heights, Shape, Stiffness,
};
use std::sync::Arc;

fn bumps(x: f64, y: f64) -> f64 {
    0.6 * (0.4 * x).sin() + 0.5 * (0.3 * y + 0.5).cos() + 0.05 * x
}

fn grid(of: impl Fn(f64, f64) -> f64) -> Shape {
    let lines: Vec<f64> = (0..21).map(|k| -10.0 + f64::from(k) + 0.2 * f64::from(k % 2)).collect();
    let z: Vec<Vec<f64>> = lines.iter().map(|x| lines.iter().map(|y| of(*x, *y)).collect()).collect();
    Shape::Heights(Arc::new(Heights::new(lines.clone(), lines, &z).expect("grid")))
}

#[test]
fn a_plane_on_a_grid_is_a_plane_also_beyond_its_borders() {
    let (a, b) = (0.3, -0.2);
    let shape = grid(|x, y| a * x + b * y + 1.0);
    let norm = (1.0 + a * a + b * b).sqrt();
    for x in [[0.3, 0.7, 2.0], [5.5, -3.2, 0.1], [14.0, 2.0, 6.0], [-13.0, 15.0, -7.0]] {
        let gap = shape.gap(&x, f64::INFINITY).expect("gap");
        let right = (x[2] - a * x[0] - b * x[1] - 1.0) / norm;
        assert!((gap.distance - right).abs() < 1e-12, "{x:?}: {} instead of {right}", gap.distance);
        assert!((gap.normal[2] - 1.0 / norm).abs() < 1e-12);
        assert!(gap.bends.iter().all(|(k, _)| k.abs() < 1e-12));
    }
}

#[test]
fn the_distance_of_heights_is_the_least_and_has_the_normal_and_curvature_as_derivatives() {
    let shape = grid(bumps);
    let far = |x: &V3<f64>| shape.gap(x, f64::INFINITY).expect("gap");
    let mut r = Random(3);
    for _ in 0..60 {
        let mut x = r.vector(8.0);
        x[2] = bumps(x[0], x[1]) + 0.6 * x[2] / 8.0;
        let gap = far(&x);
        // the foot of the perpendicular is on the surface, and nothing around it is nearer
        let foot: V3<f64> = std::array::from_fn(|i| x[i] - gap.distance * gap.normal[i]);
        assert!(far(&foot).distance.abs() < 1e-10);
        let h = 1e-5;
        for i in 0..3 {
            let moved = |d: f64| {
                let mut y = x;
                y[i] += d;
                far(&y)
            };
            let (up, down) = (moved(h), moved(-h));
            let slope = (up.distance - down.distance) / (2.0 * h);
            assert!((slope - gap.normal[i]).abs() < 1e-7, "{slope} instead of {}", gap.normal[i]);
            let mut way = [0.0; 3];
            way[i] = 1.0;
            let turned = gap.turn(&way);
            for j in 0..3 {
                let turn = (up.normal[j] - down.normal[j]) / (2.0 * h);
                // curvature is continuous but for the lines of the grid
                assert!((turn - turned[j]).abs() < 2e-2, "{turn} instead of {}", turned[j]);
            }
        }
        let least = (0..400)
            .map(|k| {
                let (a, b) = (0.05 * f64::from(k % 20 - 10), 0.05 * f64::from(k / 20 - 10));
                let p = [foot[0] + a, foot[1] + b];
                let up = [p[0], p[1], 50.0];
                // the height there: where the vertical meets the surface
                let z = (0..60).fold(up, |y, _| [y[0], y[1], y[2] - 0.7 * far(&y).distance])[2];
                let d = [x[0] - p[0], x[1] - p[1], x[2] - z];
                dot(&d, &d).sqrt()
            })
            .fold(f64::INFINITY, f64::min);
        assert!(least >= gap.distance.abs() - 1e-6, "{least} is nearer than {}", gap.distance);
    }
}

#[test]
fn grids_that_make_no_surface_are_refused() {
    let z = vec![vec![0.0; 2]; 3];
    assert!(Heights::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0], &z).is_ok());
    let said = |x: &[f64], y: &[f64], z: &[Vec<f64>]| {
        Heights::new(x.to_vec(), y.to_vec(), z).expect_err("refused").message
    };
    assert!(said(&[0.0, 1.0, 1.0], &[0.0, 1.0], &z).contains("ascending"));
    assert!(said(&[0.0, 1.0], &[0.0, 1.0], &z).contains("a row for each of the 2 lines `x`"));
    assert!(said(&[0.0, 1.0, 2.0], &[0.0], &z).contains("two lines or more"));
    let hole = vec![vec![0.0, f64::NAN], vec![0.0, 0.0], vec![0.0, 0.0]];
    assert!(said(&[0.0, 1.0, 2.0], &[0.0, 1.0], &hole).contains("z"));
}

const L: f64 = 2.0;

/// Two nodes of a cable that lies on a shape, a little bent and stretched.
fn lying(shape: Shape, law: ContactLaw, stretch: f64) -> (Vec<Node>, Vec<f64>, Contact) {
    let nodes: Vec<Node> = [0, 6].map(|k| Node { kind: NodeKind::Slope, q: k, v: k, shared: false }).to_vec();
    let e = 1.0 + stretch;
    let q = vec![0.0, 0.1, 0.02, e, 0.05, -0.01, L * e, 0.2, 0.03, e, 0.08, 0.02];
    let line = SpanLine::Cubic { q: [0, 3, 6, 9], v: [0, 3, 6, 9], l: L };
    let span = ContactSpan { line, radius: 0.1, length: L, s: 0.0, tips: [false; 2], flow: None };
    let stiffness = Stiffness { point: 0.0, per_length: 0.0, end: Some(0.0), area: Some(5e3) };
    let marker = Marker::Ground { point: [0.0; 3], axes: ropewalk_core::rotation::IDENTITY };
    let contact =
        Contact::new("bed", &nodes, shape, &marker, (&[], &[span]), stiffness, law).expect("contact");
    (nodes, q, contact)
}

#[test]
fn tangents_on_heights_and_of_damping_on_approach_are_exact() {
    let law = ContactLaw {
        damping: Damping::Approach { retardation_time: 0.3, over: 0.04 },
        ..ContactLaw::default()
    };
    let hills = grid(|x, y| 0.02 * (0.5 * x).sin() + 0.01 * (0.4 * y).cos());
    for (shape, most) in [(Shape::Plane, 1e-7), (hills, 1e-5)] {
        for down in [-1.0, 1.0] {
            let (nodes, q, contact) = lying(shape.clone(), law, 0.01);
            let v: Vec<f64> = (0..12).map(|k| if k % 3 == 2 { -down * 0.4 } else { 0.1 }).collect();
            let at = At { t: 0.0, q: &q, v: &v, a: &v, internal: &[], relaxed: None };
            let error = check_tangent(&contact, &nodes, &at, Width::One);
            println!("{shape:?} {down}: {error:.1e}");
            assert!(error < most, "{shape:?}: {error:e}");
            // what comes down is braked, what goes up isn't
            assert_eq!(contact.power(&at).dissipated > 0.0, down > 0.0);
        }
    }
}

/// A line that lies along a plane but for rounding touches it nowhere: in search of where, millions of places were looked at.
#[test]
fn what_lies_along_a_plane_but_for_rounding_does_not_touch_it() {
    let (long, marker) = (61.7, Marker::Ground { point: [0.0; 3], axes: ropewalk_core::rotation::IDENTITY });
    for k in 1..=8 {
        let (from, radius) = (25.3 * f64::from(k), 0.0137 * f64::from(k));
        let q = [from, 3.0, radius, 1.0, 0.0, 0.0, from + long, 3.0, radius, 1.0, 0.0, 0.0];
        let (nodes, ..) = lying(Shape::Plane, ContactLaw::default(), 0.0);
        let line = SpanLine::Cubic { q: [0, 3, 6, 9], v: [0, 3, 6, 9], l: long };
        let span = ContactSpan { line, radius, length: long, s: 0.0, tips: [false; 2], flow: None };
        let stiffness = Stiffness { point: 0.0, per_length: 1e4, end: Some(0.0), area: None };
        let all: (&[_], &[_]) = (&[], &[span]);
        let contact =
            Contact::new("bed", &nodes, Shape::Plane, &marker, all, stiffness, ContactLaw::default())
                .expect("contact");
        let still = [0.0; 12];
        let at = At { t: 0.0, q: &q, v: &still, a: &still, internal: &[], relaxed: None };
        assert_eq!(contact.depths(&at).collect::<Vec<_>>(), [None], "{radius}");
    }
}

/// A flat with a ridge across it: what lies along the flat but for rounding touches it nowhere, and the ridge is found where it is.
#[test]
fn what_touches_a_ridge_on_a_flat_is_found_where_looking_everywhere_finds_it() {
    let shape = grid(|x, _| 0.8 * (-(x - 4.0) * (x - 4.0)).exp() * if x > 2.5 { 1.0 } else { 0.0 });
    let marker = Marker::Ground { point: [0.0; 3], axes: ropewalk_core::rotation::IDENTITY };
    let (nodes, ..) = lying(shape.clone(), ContactLaw::default(), 0.0);
    let radius = 0.0137;
    let touching = |long: f64, q: &[f64; 12]| {
        let line = SpanLine::Cubic { q: [0, 3, 6, 9], v: [0, 3, 6, 9], l: long };
        let span = ContactSpan { line, radius, length: long, s: 0.0, tips: [false; 2], flow: None };
        let stiffness = Stiffness { point: 0.0, per_length: 1e4, end: Some(0.0), area: None };
        let all: (&[_], &[_]) = (&[], &[span]);
        let contact =
            Contact::new("bed", &nodes, shape.clone(), &marker, all, stiffness, ContactLaw::default())
                .expect("contact");
        let still = [0.0; 12];
        let (at, mut shown) =
            (At { t: 0.0, q, v: &still, a: &still, internal: &[], relaxed: None }, Vec::new());
        contact.observe(&at, &mut shown);
        let column = contact.columns().iter().position(|c| c.name == "length").expect("a length");
        shown[column]
    };
    let level = |from: f64| [from, 3.0, radius, 1.0, 0.0, 0.0, from + 9.0, 3.0, radius, 1.0, 0.0, 0.0];
    assert_eq!(touching(9.0, &level(-9.7)), 0.0);
    let long = 17.0;
    let mut r = Random(7);
    let mut met = 0;
    for _ in 0..60 {
        let mut q = [0.0; 12];
        for (k, x) in q.iter_mut().enumerate() {
            *x = match k {
                0 => -9.0 + r.number(1.0),
                6 => 8.0 + r.number(1.0),
                2 | 8 => radius + r.number(0.2),
                3 | 9 => 1.0,
                _ => r.number(0.1),
            };
        }
        const LOOKS: usize = 20_000;
        let deep = |k: usize| {
            let xi = (k as f64 + 0.5) / LOOKS as f64;
            let (s, rest) = (xi * xi * (3.0 - 2.0 * xi), 1.0 - xi);
            let [a, b] = [long * xi * rest * rest, -long * xi * xi * rest];
            let x: V3<f64> =
                std::array::from_fn(|i| (1.0 - s) * q[i] + a * q[3 + i] + s * q[6 + i] + b * q[9 + i]);
            shape.gap(&x, f64::INFINITY).is_some_and(|gap| gap.distance < radius)
        };
        let (found, right) =
            (touching(long, &q), long * (0..LOOKS).filter(|k| deep(*k)).count() as f64 / LOOKS as f64);
        met += usize::from(right > 0.0);
        assert!((found - right).abs() < 4.0 * long / LOOKS as f64, "{found} instead of {right}: {q:?}");
    }
    assert!(met > 40, "{met} touched");
}

/// What lies level all along goes a way of its own, which has to be that of any shape.
#[test]
fn a_plane_is_what_heights_are_that_make_a_plane() {
    let friction = Friction::new(0.6);
    let law = ContactLaw {
        damping: Damping::Approach { retardation_time: 0.3, over: 0.04 },
        friction: Some(friction),
        ..ContactLaw::default()
    };
    // all of it lies, half of it does, nothing does; it sticks or slips
    for (up, lean) in [(0.0, 0.0), (0.05, 0.02), (0.2, 0.0)] {
        for slip in [0.01, 0.5] {
            let [one, other] = [Shape::Plane, grid(|_, _| 0.0)].map(|shape| {
                let (nodes, mut q, contact) = lying(shape, law, 0.01);
                for (k, x) in q.iter_mut().enumerate().filter(|(k, _)| k % 3 == 2) {
                    *x += if k % 6 == 2 { up + lean * (k as f64 - 5.0) } else { 0.0 };
                }
                let grip = Grip { stiffness: 1e3, damping: 10.0, brake: None };
                let contact = contact.with_grips(&[grip], 0);
                let mut memory = vec![0.0; Contact::memory(0, 1)];
                let still = vec![0.0; 12];
                let before: Vec<f64> =
                    q.iter().enumerate().map(|(k, x)| if k % 6 == 1 { x - slip } else { *x }).collect();
                let at = At { t: 0.0, q: &before, v: &still, a: &still, internal: &[], relaxed: None };
                contact.remember(&At { internal: &memory.clone(), ..at }, &mut memory);
                let v: Vec<f64> = (0..12).map(|k| 0.1 * (k as f64).sin()).collect();
                let at = At { q: &q, v: &v, internal: &memory, ..at };
                let (force, tangent) =
                    ropewalk_core::testing::dense(&contact, &nodes, &at, Default::default(), Width::One);
                (force, tangent.concat(), contact.energy(&at), contact.power(&at).dissipated)
            });
            let size = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let apart = |a: &[f64], b: &[f64]| {
                assert!(a.iter().chain(b).all(|x| x.is_finite()) && a.len() == b.len());
                a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
                    / size(a).max(f64::MIN_POSITIVE)
            };
            assert_eq!(size(&one.0) > 0.0, up < 0.1);
            println!("{up} {slip}: {:e} {:e}", apart(&one.0, &other.0), apart(&one.1, &other.1));
            assert!(apart(&one.0, &other.0) < 1e-9 && apart(&one.1, &other.1) < 1e-9);
            assert!(apart(&[one.2.potential], &[other.2.potential]) < 1e-9);
            assert!(apart(&[one.3], &[other.3]) < 1e-9);
        }
    }
}

#[test]
fn tangents_of_friction_that_a_pull_uses_up_are_exact() {
    let friction = Friction { equilibrium: AtRest::Pulled, ..Friction::new(0.6) };
    let law = ContactLaw { friction: Some(friction), ..ContactLaw::default() };
    for (strain, way) in [(0.002, 1.0), (0.02, 1.0), (0.05, -1.0), (-0.005, 1.0)] {
        for up in [[0.0, 0.0, 1.0], [-0.2, 0.1, 0.97]] {
            let (nodes, q, contact) = lying(Shape::Plane, law, strain);
            let grip = Grip { stiffness: 1e3, damping: 10.0, brake: None };
            let size = Contact::memory(0, 1);
            let contact = contact
                .with_grips(&[grip], 0)
                .with_brakes(&[Some(Brake { way, strain: 0.03, up })])
                .with_rest(Some(up), size);
            let mut memory = vec![0.0; size + 1];
            let still = vec![0.0; 12];
            // where it lay
            let laid: Vec<f64> =
                q.iter().enumerate().map(|(k, x)| if k == 1 || k == 7 { x - 0.02 } else { *x }).collect();
            let at = At { t: 0.0, q: &laid, v: &still, a: &still, internal: &[], relaxed: None };
            assert!(contact.settle(&at, &mut memory), "the first equilibrium is one without friction");
            assert!(!contact.settle(&at, &mut memory.clone()));
            let at = At { q: &q, internal: &memory, ..at };
            let error = check_tangent(&contact, &nodes, &at, Width::One);
            println!("{strain} {way} {up:?}: {error:.1e}");
            // left out is how the line's direction turns that in which it lay sideways
            assert!(error < 0.03, "{error:e}");
        }
    }
}

/// What lies on a slope is borne upright, as far as friction could; bristles take that over.
#[test]
fn ground_that_slopes_bears_upright() {
    for (tilt, mu, across) in [(0.2, 0.6, None), (0.2, 0.6, Some(0.9)), (0.5, 0.3, None)] {
        let friction = Friction { equilibrium: AtRest::Laid, across, ..Friction::new(mu) };
        let law = ContactLaw { friction: Some(friction), ..ContactLaw::default() };
        // the bed is level, and gravity leans along the line and across it
        let up = [-0.8 * f64::sin(tilt), 0.6 * f64::sin(tilt), f64::cos(tilt)];
        let (nodes, q, contact) = lying(Shape::Plane, law, 0.01);
        let (size, still) = (Contact::memory(0, 1), vec![0.0; 12]);
        let grip = Grip { stiffness: 1e4, damping: 0.0, brake: None };
        let contact = contact.with_grips(&[grip], 0).with_rest(Some(up), size);
        let mut memory = vec![0.0; size + 1];
        let at = At { t: 0.0, q: &q, v: &still, a: &still, internal: &[], relaxed: None };
        let force = |memory: &[f64]| -> [f64; 3] {
            let at = At { internal: memory, ..at };
            let all = ropewalk_core::testing::dense(&contact, &nodes, &at, Default::default(), Width::One).0;
            std::array::from_fn(|i| -all[i] - all[6 + i])
        };
        let bare = force(&memory);
        assert!(bare[0].abs() + bare[1].abs() < 1e-12 * bare[2], "nothing holds before it is asked to");
        contact.let_go(&mut memory);
        let error = check_tangent(&contact, &nodes, &At { internal: &memory, ..at }, Width::One);
        let borne = force(&memory);
        println!("{tilt}: {borne:?}, tangent {error:.1e}");
        assert!(error < 1e-6, "{error:e}");
        assert!((borne[2] / bare[2] - 1.0).abs() < 1e-12, "the ground pushes as before");
        let share = f64::min(1.0, mu / f64::tan(tilt));
        for i in 0..2 {
            let right = share * bare[2] * up[i] / up[2];
            assert!((borne[i] - right).abs() < 1e-9 * bare[2], "{} instead of {right}", borne[i]);
        }
        assert!(contact.settle(&at, &mut memory) && !contact.settle(&at, &mut memory.clone()), "once");
        let held = force(&memory);
        for i in 0..3 {
            assert!((held[i] - borne[i]).abs() < 1e-6 * bare[2], "{held:?} takes over {borne:?}");
        }
        // a search anew knows nothing of that
        contact.let_go(&mut memory);
        assert_eq!(force(&memory), borne);
    }
}

#[test]
fn time_takes_over_the_friction_of_an_equilibrium() {
    let friction = Friction { equilibrium: AtRest::Pulled, ..Friction::new(0.6) };
    let law = ContactLaw { friction: Some(friction), ..ContactLaw::default() };
    let (nodes, q, contact) = lying(Shape::Plane, law, 0.05);
    let size = Contact::memory(0, 1);
    let brake = Brake { way: 1.0, strain: 0.03, up: [0.0, 0.0, 1.0] };
    let grip = Grip { stiffness: 1e4, damping: 0.0, brake: None };
    let contact = contact.with_grips(&[grip], 0).with_brakes(&[Some(brake)]).with_rest(Some(brake.up), size);
    let (mut memory, still) = (vec![0.0; size + 1], vec![0.0; 12]);
    let at = At { t: 0.0, q: &q, v: &still, a: &still, internal: &[], relaxed: None };
    let forces = |memory: &[f64]| {
        let at = At { internal: memory, ..at };
        ropewalk_core::testing::dense(&contact, &nodes, &at, Default::default(), Width::One).0
    };
    contact.settle(&at, &mut memory);
    let before = forces(&memory);
    contact.remember(&at, &mut memory);
    let after = forces(&memory);
    let size = before.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (a, b) in before.iter().zip(&after) {
        // but for what isn't in the plane
        assert!((a - b).abs() < 0.02 * size, "{a} becomes {b}");
    }
}
