//! Whether the forces at an equilibrium have a potential: the tangent is its own mirror image then.
//!
//! It need not be that on the whole. Forces that the constraints would take up anyway, `Gᵀ s(q)`, may come without a
//! potential, as those of a rope on a wheel do: they leave `Gᵀ ds` in the tangent, of which no motion that the
//! constraints allow feels anything. So where entries don't mirror each other, motions are asked.

use super::problem::Statics;
use crate::algebra::noise::Noise;
use crate::model::node::NodeKind;
use crate::solve::linear::SolveError;

/// Difference of entries that mirror each other, as part of their diagonals, up to which a tangent is symmetric.
const MIRRORED: f64 = 1e-11;
/// The same of the moments on one body, whose rotations don't commute: what is left of the moment on it stands in its
/// tangent without a mirror image, and is no property of a load.
const TURNED: f64 = 1e-6;
/// What motions may feel of entries that don't mirror each other, as part of these.
const UNFELT: f64 = 1e-9;
/// How many motions without pattern are asked.
const ASKED: usize = 4;

impl Statics<'_> {
    /// Makes the assembled tangent the mean of itself and its mirror image if the motions that the constraints allow feel no
    /// difference; whether that is so.
    pub(super) fn mirror_if_unfelt(&mut self) -> bool {
        let unfelt = self.is_mirrored() || self.model.multipliers() > 0 && self.is_unfelt().unwrap_or(false);
        if unfelt {
            self.system.values = self.mirrored();
        }
        unfelt
    }

    /// The mean of the assembled tangent and its mirror image.
    pub(super) fn mirrored(&self) -> Vec<f64> {
        let (s, values) = (&self.structure, &self.system.values);
        let mut mean = values.clone();
        if !s.symmetric {
            for (r, columns, at) in s.rows() {
                for (k, p) in at.enumerate() {
                    mean[p] = 0.5 * (values[p] + s.entry(values, columns.get(k), r));
                }
            }
        }
        mean
    }

    /// Entries above the diagonal that aren't those below: row, column, difference, and what rounding may make of it.
    fn unlike(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let (s, values) = (&self.structure, &self.system.values);
        let mut body = vec![u32::MAX; s.n];
        for (k, n) in self.model.nodes().iter().enumerate().filter(|(_, n)| n.kind == NodeKind::Frame) {
            for i in 3..6 {
                body[s.position[n.v + i]] = k as u32;
            }
        }
        let w = self.weights();
        let rows = s.rows().filter(|(r, ..)| !s.is_multiplier[*r]);
        rows.flat_map(move |(r, columns, at)| {
            let (w, body) = (&w, &body);
            let unlike = move |(k, p): (usize, usize)| {
                let c = columns.get(k);
                if c <= r || s.is_multiplier[c] {
                    return None;
                }
                let same = body[r] != u32::MAX && body[r] == body[c];
                let allowed = if same { TURNED } else { MIRRORED };
                let off = values[p] - s.entry(values, c, r);
                let rounding = (allowed * (w[r] * w[c]).sqrt()).max(f64::EPSILON * (w[r] + w[c]));
                (!(off.abs() <= rounding)).then_some((r, c, off))
            };
            at.enumerate().filter_map(unlike).collect::<Vec<_>>()
        })
    }

    /// Whether the assembled tangent is its own mirror image, to rounding.
    pub(super) fn is_mirrored(&self) -> bool {
        self.unlike().next().is_none()
    }

    /// Whether motions that the constraints allow feel nothing of what isn't its own mirror image.
    fn is_unfelt(&mut self) -> Result<bool, SolveError> {
        let unlike: Vec<(usize, usize, f64)> = self.unlike().collect();
        let motions = self.motions(2 * ASKED)?;
        Ok(motions.chunks(2).all(|pair| {
            let (a, b) = (&pair[0], &pair[1]);
            let (mut felt, mut there) = (0.0, 0.0);
            for &(r, c, off) in &unlike {
                let (to, fro) = (a[r] * b[c], a[c] * b[r]);
                felt += off * (to - fro);
                there += off.abs() * (to.abs() + fro.abs());
            }
            felt.abs() <= UNFELT * there
        }))
    }

    /// Motions without pattern that the constraints in the assembled tangent allow, in elimination order. Leaves the
    /// solver with other factors.
    fn motions(&mut self, count: usize) -> Result<Vec<Vec<f64>>, SolveError> {
        let (s, w) = (&self.structure, self.weights());
        // [W, Gᵀ; G, 0]
        let mut values = self.system.values.clone();
        for (r, columns, at) in s.rows() {
            for (k, p) in at.enumerate() {
                let c = columns.get(k);
                if !s.is_multiplier[r] && !s.is_multiplier[c] {
                    values[p] = if r == c { w[r] } else { 0.0 };
                }
            }
        }
        if let Some(softening) = &self.softening {
            softening.apply(&mut values);
        }
        self.solver.factor(s, &values)?;
        let mut noise = Noise::default();
        let motion = |_| {
            let mut x: Vec<f64> = w.iter().map(|w| noise.draw() * w.sqrt()).collect();
            x.iter_mut().zip(&s.is_multiplier).filter(|(_, m)| **m).for_each(|(x, _)| *x = 0.0);
            self.solver.solve(s, &values, &mut x)?;
            Ok(x)
        };
        (0..count).map(motion).collect()
    }
}
