//! Rigid bodies: tangents, stations, energies, mass properties, and the shapes that no body has.

use ropewalk_core::rotation::{cross, matrix, times};
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{
    At, FieldTerm, Gives, Laws, Load, Node, NodeId, NodeKind, Pool, Real, Station, StationPool, Term,
    Weights, Width, retract,
};
use ropewalk_elements::rigid_body::{Hull, Inertia, Shape, inertia};
use std::sync::Arc;

const NODES: usize = 9;

fn nodes() -> Vec<Node> {
    (0..NODES).map(|k| Node { kind: NodeKind::Frame, q: 7 * k, v: 6 * k, shared: false }).collect()
}

struct Numbers {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

fn numbers() -> Numbers {
    let mut x = 7u64;
    let mut list = |n: usize| -> Vec<f64> {
        (0..n)
            .map(|_| {
                x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
            })
            .collect()
    };
    let mut s = Numbers { q: list(7 * NODES), v: list(6 * NODES), a: list(6 * NODES) };
    for q in s.q.chunks_mut(7) {
        let norm: f64 = q[3..].iter().map(|x| x * x).sum::<f64>().sqrt();
        q[3..].iter_mut().for_each(|x| *x /= norm);
    }
    s
}

impl Numbers {
    fn at(&self) -> At<'_> {
        At { t: 0.4, q: &self.q, v: &self.v, a: &self.a, internal: &[], relaxed: None }
    }
}

fn pool() -> Pool<Inertia, 7, 6> {
    let mut pool = Pool::new();
    for k in 0..NODES {
        let j = inertia([1.0 + 0.1 * k as f64, 2.0, 2.4], [0.1, -0.2, 0.05 * k as f64]).unwrap();
        assert!(pool.push(&nodes(), Inertia { mass: 1.5 + k as f64, inertia: j }, &[NodeId(k as u32)]));
    }
    pool
}

/// A law that depends on everything that a station says.
#[derive(Clone)]
struct Everything;
impl ropewalk_core::Law for Everything {
    fn label(&self) -> String {
        "everything".into()
    }
    fn load<R: Real, const TANGENT: bool>(&self, _: f64, at: &Station<R>, out: &mut Load<R>) {
        let m = [[0.3, -0.5, 0.7], [0.9, 0.2, -0.4], [-0.6, 0.8, 0.1]].map(|row| row.map(R::of));
        for i in 0..3 {
            for j in 0..3 {
                let k = (i + j) % 3;
                out.f[i] += m[i][j] * at.x[j] * at.slope[k] + m[j][i] * at.v[j] * at.v[k] - m[i][j] * at.a[j];
                out.d_x[i][j] += m[i][j] * at.slope[k];
                out.d_slope[i][k] += m[i][j] * at.x[j];
                out.d_v[i][j] += m[j][i] * at.v[k];
                out.d_v[i][k] += m[j][i] * at.v[j];
                out.d_a[i][j] -= m[i][j];
                out.f[i] += m[i][k] * at.slope_rate[j];
                out.d_rate[i][j] += m[i][k];
                out.g[i] += m[i][j] * at.x[j] * at.slope[k] + m[j][i] * at.v[j];
                out.g_x[i][j] += m[i][j] * at.slope[k];
                out.g_slope[i][k] += m[i][j] * at.x[j];
                out.g_v[i][j] += m[j][i];
            }
        }
    }
}

fn stations() -> FieldTerm {
    let mut pool = StationPool::<Hull, 7, 6, 4>::new();
    for k in 0..NODES {
        let axis = [0.8, -0.3, 0.1 * k as f64];
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let hull = Hull { from: [-0.3, 0.2, 0.1], axis, length, s0: 0.0, diameter: 0.2, area: 0.03 };
        assert!(pool.push(&nodes(), hull, &[NodeId(k as u32)]));
    }
    let mut laws = Laws::default();
    laws.push(Everything);
    assert_eq!(ropewalk_core::Law::gives(&Everything), Gives::ALL);
    FieldTerm { part: "body".into(), stations: Arc::new(pool), laws }
}

#[test]
fn tangents_are_exact_over_all_lanes() {
    let s = numbers();
    for (name, term) in [("inertia", &pool() as &dyn Term), ("stations", &stations())] {
        for width in [Width::One, Width::best()] {
            let error = check_tangent(term, &nodes(), &s.at(), width);
            println!("{name}, {width:?}: {error:.1e}");
            assert!(error < 1e-8, "{name}, {width:?}: {error}");
        }
    }
}

#[test]
fn inertia_does_the_work_of_the_kinetic_energy() {
    let (s, pool) = (numbers(), pool());
    let (r, _) = dense(&pool, &nodes(), &s.at(), Weights::default(), Width::One);
    let work: f64 = r.iter().zip(&s.v).map(|(r, v)| r * v).sum();
    let rate = difference(|h| {
        let v: Vec<f64> = s.v.iter().zip(&s.a).map(|(v, a)| v + h * a).collect();
        vec![pool.energy(&At { v: &v, ..s.at() }).kinetic]
    })[0];
    assert!((work - rate).abs() < 1e-9 * rate.abs().max(1.0), "{work} {rate}");
}

/// Velocities and accelerations of stations are the derivatives of their places.
#[test]
fn stations_move_with_their_body() {
    let (s, term) = (numbers(), stations());
    let see = |at: &At<'_>| {
        let mut all = Vec::new();
        term.stations.each(at, &mut |s| all.push(*s));
        all
    };
    let moved = |h: f64| {
        let d: Vec<f64> = s.v.iter().zip(&s.a).map(|(v, a)| h * v + 0.5 * h * h * a).collect();
        let mut q = s.q.clone();
        retract(&nodes(), &s.q, &d, &mut q);
        let places = see(&At { q: &q, ..s.at() });
        places.iter().flat_map(|s| s.x).collect::<Vec<f64>>()
    };
    let (v, a) = (difference(moved), ropewalk_core::testing::second(moved));
    for (k, station) in see(&s.at()).iter().enumerate() {
        for i in 0..3 {
            assert!((station.v[i] - v[3 * k + i]).abs() < 1e-9);
            assert!((station.a[i] - a[3 * k + i]).abs() < 1e-6);
        }
    }
}

/// A force on the stations has the resultant and the moment of the load.
#[test]
fn loads_come_back_as_force_and_moment() {
    let (s, term) = (numbers(), stations());
    let (r, _) = dense(&term, &nodes(), &s.at(), Weights::default(), Width::One);
    let (mut force, mut moment, mut k) = ([0.0; 3], [0.0; 3], 0);
    let x0 = [s.q[0], s.q[1], s.q[2]];
    term.stations.each(&s.at(), &mut |station| {
        if k < 4 {
            let mut load = Load::zero();
            ropewalk_core::Law::load::<f64, false>(&Everything, 0.4, station, &mut load);
            let f = load.f.map(|f| station.weight * f);
            let arm = std::array::from_fn(|i| station.x[i] - x0[i]);
            (0..3).for_each(|i| force[i] += f[i]);
            let (m, turn) = (cross(&arm, &f), cross(&station.slope, &load.g.map(|g| station.weight * g)));
            (0..3).for_each(|i| moment[i] += m[i] + turn[i]);
        }
        k += 1;
    });
    let own = times(&matrix(&[s.q[3], s.q[4], s.q[5], s.q[6]]), &[r[3], r[4], r[5]]);
    for i in 0..3 {
        assert!((r[i] + force[i]).abs() < 1e-13);
        assert!((own[i] + moment[i]).abs() < 1e-13);
    }
}

#[test]
fn shapes_have_the_moments_of_the_tables() {
    // a thin rod, a disc, a ball, a tube, a plate (Beer & Johnston, inside cover)
    let (volume, j) = Shape::Cylinder { length: 2.0, radius: 1e-4, inner: 0.0 }.properties().unwrap();
    assert!((volume - 2.0 * std::f64::consts::PI * 1e-8).abs() < 1e-20 && (j[1] - 4.0 / 12.0).abs() < 1e-8);
    let (_, j) = Shape::Cylinder { length: 1e-9, radius: 2.0, inner: 0.0 }.properties().unwrap();
    assert!((j[0] - 2.0).abs() < 1e-12 && (j[1] - 1.0).abs() < 1e-12);
    let (_, j) = Shape::Cylinder { length: 1e-9, radius: 2.0, inner: 2.0 - 1e-9 }.properties().unwrap();
    assert!((j[0] - 4.0).abs() < 1e-8);
    let (_, j) = Shape::Sphere { radius: 3.0 }.properties().unwrap();
    assert!(j.iter().all(|j| (j - 3.6).abs() < 1e-14));
    let (volume, j) = Shape::Cuboid { edges: [6.0, 2.0, 4.0] }.properties().unwrap();
    assert_eq!(volume, 48.0);
    assert!(j.iter().zip([20.0, 52.0, 40.0]).all(|(j, x)| (j - x / 12.0).abs() < 1e-14));
}

#[test]
fn what_no_body_can_have_is_refused() {
    for (moments, products, says) in [
        ([1.0, 1.0, 2.1], [0.0; 3], "exceeds the sum"),
        ([0.0, 1.0, 1.0], [0.0; 3], "must be positive"),
        ([1.0, 1.0, f64::NAN], [0.0; 3], "not a finite number"),
        ([1.0, 1.0, 1.0], [1.1, 0.0, 0.0], "must be positive"),
        ([1.0, 1.0, 1.0], [0.9, 0.0, 0.0], "exceeds the sum"),
    ] {
        let message = inertia(moments, products).unwrap_err().to_string();
        assert!(message.contains(says), "{message}");
    }
    // a plate without thickness is the limit
    assert!(inertia([1.0, 2.0, 3.0], [0.0; 3]).is_ok());
    assert!(Shape::Cylinder { length: 1.0, radius: 1.0, inner: 1.0 }.properties().is_err());
    assert!(Shape::Sphere { radius: -1.0 }.properties().is_err());
}
