//! Vessels that float freely: tangents, energies, the two forms of a wave's load.

use crate::random::Random;
use ropewalk_core::rotation::around;
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{At, Marker, Node, NodeId, NodeKind, Term, Weights, Width, retract};
use ropewalk_forces::{FreeVessel, VesselInertia};

fn nodes() -> Vec<Node> {
    vec![Node { kind: NodeKind::Frame, q: 0, v: 0, shared: false }]
}

struct Numbers {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl Numbers {
    /// Turned by up to about a radian, so that it is far from where pitch is a right angle.
    fn new(seed: u64) -> Self {
        let mut r = Random(seed);
        let mut q = r.list(7, 0.4);
        q[3] = 1.0;
        let size: f64 = q[3..].iter().map(|x| x * x).sum::<f64>().sqrt();
        q[3..].iter_mut().for_each(|x| *x /= size);
        Numbers { q, v: r.list(6, 1.0), a: r.list(6, 1.0) }
    }
    fn at(&self) -> At<'_> {
        At { t: 0.3, q: &self.q, v: &self.v, a: &self.a, internal: &[], relaxed: None }
    }
}

/// `XᵀX`: symmetric and positive.
fn positive(seed: u64) -> [[f64; 6]; 6] {
    let x = Random(seed).list(36, 1.0);
    std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| x[6 * k + i] * x[6 * k + j]).sum()))
}

fn vessel(damped: bool) -> FreeVessel {
    let mean = Marker::Ground { point: [0.2, -0.1, 0.3], axes: around([0.1, 0.2, 1.0]) };
    let on = Marker::Node { node: NodeId(0), point: [0.3, -0.2, 0.5], axes: around([0.2, 0.1, 1.0]) };
    let vessel = FreeVessel::new("ship", &nodes(), mean, on).expect("a vessel");
    let nothing = [0.0; 6];
    if damped {
        let mut damping = positive(7);
        // gyroscopic terms do no work
        (damping[0][5], damping[5][0]) = (damping[0][5] + 1.0, damping[5][0] - 1.0);
        vessel.with(positive(5), damping, [1.0, 2.0, 0.5, 1.5, 3.0, 0.7], [1.0, -2.0, 0.5, 0.3, 0.2, -0.4])
    } else {
        vessel.with(positive(5), [[0.0; 6]; 6], nothing, nothing)
    }
}

fn inertia() -> VesselInertia {
    VesselInertia::new("ship", [0, 0], [0.3, -0.2, 0.5], around([0.2, 0.1, 1.0]), &positive(9))
}

#[test]
fn tangents_are_exact() {
    for seed in 1..=8 {
        let s = Numbers::new(seed);
        for term in [&vessel(false) as &dyn Term, &vessel(true), &inertia()] {
            let error = check_tangent(term, &nodes(), &s.at(), Width::One);
            assert!(error < 1e-7, "{} at state {seed}: {error}", term.label());
        }
    }
}

fn taken(term: &dyn Term, s: &Numbers) -> f64 {
    let (r, _) = dense(term, &nodes(), &s.at(), Weights::default(), Width::One);
    r.iter().zip(&s.v).map(|(r, v)| r * v).sum()
}

/// What is taken from the motion is stored, dissipated or supplied; that holds for the energy of the water too, whatever the matrix.
#[test]
fn work_is_energy() {
    for seed in 1..=8 {
        let s = Numbers::new(seed);
        for term in [&vessel(false) as &dyn Term, &vessel(true), &inertia()] {
            let energy = |dt: f64| {
                let (mut q, step) = (s.q.clone(), s.v.iter().map(|v| v * dt).collect::<Vec<_>>());
                retract(&nodes(), &s.q, &step, &mut q);
                let v: Vec<f64> = s.v.iter().zip(&s.a).map(|(v, a)| v + a * dt).collect();
                let e = term.energy(&At { q: &q, v: &v, ..s.at() });
                vec![e.kinetic + e.potential]
            };
            let (taken, stored, power) = (taken(term, &s), difference(energy)[0], term.power(&s.at()));
            let size = taken.abs() + stored.abs() + power.dissipated.abs();
            let apart = taken - stored - power.dissipated + power.supplied;
            assert!(apart.abs() <= 1e-7 * size, "{} at state {seed}: {apart} of {size}", term.label());
            assert!(power.dissipated >= 0.0);
        }
    }
}
