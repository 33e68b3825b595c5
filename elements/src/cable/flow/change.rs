//! Splitting and merging elements of a line while it runs.
//!
//! A split keeps shape, velocity, momentum and kinetic energy exactly. A merge takes the nearest shape and velocity in
//! the sense of their slopes. Neither keeps the tension, since an element filters the ripple of its strain: the new ones
//! get a stress-free strain, point by point, that keeps it, and that fades out.

use super::turning::Sections;
use crate::cable::longitudinal::{Longitudinal, Strain};
use crate::cable::model::CableModel;
use crate::cable::quadrature::Gauss5;
use crate::cable::shape::{hermite, hermite_slope, natural, second};
use ropewalk_core::V3;

/// The mesh of a line at an instant, node by node.
#[derive(Clone, Debug)]
pub(crate) struct Snapshot {
    /// Material coordinates and their rates.
    pub p: Vec<f64>,
    pub pd: Vec<f64>,
    /// Position and slope.
    pub r: Vec<V3<f64>>,
    pub s: Vec<V3<f64>>,
    /// Their rates at the node.
    pub rd: Vec<V3<f64>>,
    pub sd: Vec<V3<f64>>,
    /// Stress at the quadrature points of each element over its axial stiffness, prestrain included.
    pub stress: Vec<Vec<f64>>,
    /// The sections, of a cable with torsion.
    pub sections: Option<Sections>,
}

/// What there was at a point of a piece: weight, place in the new element, slope of shape and of velocity.
struct Was {
    weight: f64,
    xi: f64,
    slope: V3<f64>,
    rate: V3<f64>,
}

fn mix<const N: usize>(c: [f64; N], x: [V3<f64>; N]) -> V3<f64> {
    std::array::from_fn(|i| (0..N).map(|n| c[n] * x[n][i]).sum())
}

impl Snapshot {
    /// Length of element `k` [m].
    pub fn l(&self, k: usize) -> f64 {
        self.p[k + 1] - self.p[k]
    }
    /// Dofs of element `k`.
    pub fn dofs(&self, k: usize) -> [f64; 12] {
        let all = [self.r[k], self.s[k], self.r[k + 1], self.s[k + 1]];
        std::array::from_fn(|i| all[i / 3][i % 3])
    }
    /// Second derivative of the curve at the start and at the end of element `k`.
    fn bends(&self, k: usize) -> [V3<f64>; 2] {
        let il = 1.0 / self.l(k);
        let q = natural(&self.dofs(k), il);
        [second(&[-4.0, -2.0], il, &q), second(&[2.0, 4.0], il, &q)]
    }
    /// Velocity of the material of element `k`: value and slope at both its ends.
    fn material(&self, k: usize) -> [V3<f64>; 4] {
        let bends = self.bends(k);
        let at = |i: usize, bend: V3<f64>| {
            let v = std::array::from_fn(|c| self.rd[i][c] - self.pd[i] * self.s[i][c]);
            [v, std::array::from_fn(|c| self.sd[i][c] - self.pd[i] * bend[c])]
        };
        let ([a, b], [c, d]) = (at(k, bends[0]), at(k + 1, bends[1]));
        [a, b, c, d]
    }

    /// Splits element `k` at a material coordinate.
    pub fn split(&mut self, k: usize, p: f64, model: CableModel) -> Result<[Vec<f64>; 2], String> {
        let (l, e) = (self.l(k), [self.r[k], self.s[k], self.r[k + 1], self.s[k + 1]]);
        let xi = (p - self.p[k]) / l;
        let (v, turning) = (self.material(k), self.turning(k));
        let (shape, slope) = (hermite(xi, l), hermite_slope(xi, 1.0 / l));
        let at = k + 1;
        let old = self.stress[k].clone();
        self.p.insert(at, p);
        self.pd.insert(at, 0.0);
        self.r.insert(at, mix(shape, e));
        self.s.insert(at, mix(slope, e));
        self.rd.insert(at, mix(shape, v));
        self.sd.insert(at, mix(slope, v));
        let points = points(model)?;
        let piece = |from: f64, to: f64| -> Vec<f64> {
            points.iter().map(|x| interpolate(&points, &old, from + (to - from) * x)).collect()
        };
        let both = [piece(0.0, xi), piece(xi, 1.0)];
        self.stress[k].clone_from(&both[0]);
        self.stress.insert(at, both[1].clone());
        if let Some(turning) = turning {
            self.split_twist(k, xi, turning);
        }
        Ok(both)
    }

    /// Takes node `k` out of the mesh, between two elements; `boundary` is the end of the new element, 0 or 1, whose node
    /// follows a boundary and gets a slope and a rate of slope anew.
    pub fn merge(&mut self, k: usize, boundary: usize, model: CableModel) -> Result<Vec<f64>, String> {
        let (p, l) = ([self.p[k - 1], self.p[k], self.p[k + 1]], self.p[k + 1] - self.p[k - 1]);
        let pieces = [k - 1, k];
        // slopes and velocity slopes of what there was, at points of both pieces
        let mut samples = Vec::new();
        for &piece in &pieces {
            let (own, e, v) = (self.l(piece), self.dofs(piece), self.material(piece));
            let e: [V3<f64>; 4] = std::array::from_fn(|n| [e[3 * n], e[3 * n + 1], e[3 * n + 2]]);
            for at in Gauss5::POINTS {
                let slope = hermite_slope(at.xi, 1.0 / own);
                let there = self.p[piece] + at.xi * own;
                let (weight, xi) = (at.w * own, (there - p[0]) / l);
                samples.push(Was { weight, xi, slope: mix(slope, e), rate: mix(slope, v) });
            }
        }
        let old = [self.material(k - 1), self.material(k)];
        let stress = self.merged_stress(k, model)?;
        let turning = self.turning(k - 1).zip(self.turning(k));
        let tangents = [self.node_tangent(k - 1), self.node_tangent(k + 1)];
        for list in [&mut self.r, &mut self.s, &mut self.rd, &mut self.sd] {
            list.remove(k);
        }
        for list in [&mut self.p, &mut self.pd] {
            list.remove(k);
        }
        let (a, b) = (k - 1, k);
        // the nearest slope at the boundary: least squares of r', of which it makes φ
        let own = if boundary == 0 { 1 } else { 3 };
        let fit = |mut nodes: [V3<f64>; 4], pick: fn(&Was) -> V3<f64>| {
            nodes[own] = [0.0; 3];
            let (mut sum, mut square) = ([0.0; 3], 0.0);
            for sample in &samples {
                let slope = hermite_slope(sample.xi, 1.0 / l);
                let (rest, there) = (mix(slope, nodes), pick(sample));
                for c in 0..3 {
                    sum[c] += sample.weight * slope[own] * (there[c] - rest[c]);
                }
                square += sample.weight * slope[own] * slope[own];
            }
            sum.map(|x| x / square)
        };
        let node = if boundary == 0 { a } else { b };
        self.s[node] = fit([self.r[a], self.s[a], self.r[b], self.s[b]], |s| s.slope);
        let nu = [old[0][0], old[0][1], old[1][2], old[1][3]];
        let slope = fit(nu, |s| s.rate);
        let bend = {
            let il = 1.0 / l;
            let e: [V3<f64>; 4] = [self.r[a], self.s[a], self.r[b], self.s[b]];
            let q = natural(&std::array::from_fn(|i| e[i / 3][i % 3]), il);
            second(if boundary == 0 { &[-4.0, -2.0] } else { &[2.0, 4.0] }, il, &q)
        };
        self.sd[node] = std::array::from_fn(|c| slope[c] + self.pd[node] * bend[c]);
        self.stress.remove(k);
        self.stress[k - 1].clone_from(&stress);
        if let Some((first, second)) = turning {
            self.merge_twist(k, (p[1] - p[0]) / l, [first, second], tangents)?;
        }
        Ok(stress)
    }

    /// Stress of a merged element: the ends' values and the mean are kept.
    fn merged_stress(&self, k: usize, model: CableModel) -> Result<Vec<f64>, String> {
        let points = points(model)?;
        let (a, b) = (&self.stress[k - 1], &self.stress[k]);
        let mean = |x: &[f64]| -> f64 {
            Gauss5::POINTS.iter().map(|at| at.w * interpolate(&points, x, at.xi)).sum()
        };
        let (la, lb) = (self.l(k - 1), self.l(k));
        let all = (la * mean(a) + lb * mean(b)) / (la + lb);
        let ends = [interpolate(&points, a, 0.0), interpolate(&points, b, 1.0)];
        let middle = (6.0 * all - ends[0] - ends[1]) / 4.0;
        let parabola = |x: f64| {
            ends[0] * (1.0 - x) * (1.0 - 2.0 * x)
                + middle * 4.0 * x * (1.0 - x)
                + ends[1] * x * (2.0 * x - 1.0)
        };
        Ok(if points.len() == 1 { vec![all] } else { points.iter().map(|&x| parabola(x)).collect() })
    }

    /// The stress-free strain with which element `k` has the stress that is asked for.
    pub fn prestrain(&self, k: usize, stress: &[f64], model: CableModel) -> Result<Vec<f64>, String> {
        let strain = strains(model, &self.dofs(k), self.l(k))?;
        Ok(strain.iter().zip(stress).map(|(e, n)| e - n).collect())
    }
}

/// Lagrange's interpolation between the quadrature points of a model.
pub(crate) fn interpolate(points: &[f64], values: &[f64], x: f64) -> f64 {
    let lagrange = |k: usize| -> f64 {
        let others = points.iter().enumerate().filter(|(j, _)| *j != k);
        others.map(|(_, p)| (x - p) / (points[k] - p)).product()
    };
    values.iter().enumerate().map(|(k, v)| lagrange(k) * v).sum()
}

/// Where a model takes its strain.
pub(crate) fn points(model: CableModel) -> Result<Vec<f64>, String> {
    Ok(model.models()?.points().iter().map(|p| p.xi).collect())
}

/// The strain there.
pub(crate) fn strains(model: CableModel, e: &[f64; 12], l: f64) -> Result<Vec<f64>, String> {
    let (models, q) = (model.models()?, natural(e, 1.0 / l));
    Ok(models.points().iter().map(|at| models.longitudinal.strain(&q, at).eps()).collect())
}
