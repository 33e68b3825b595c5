//! A stress-free strain that fades out, of an element that was born while the run went on.

use super::embedding::Embedding;
use crate::cable::longitudinal::{Longitudinal, Strain};
use crate::cable::model::{CableModel, ChosenModels};
use crate::cable::shape::natural;
use ropewalk_core::{Assembly, At, Dual, Energy, Pattern, Power, Prestrain, Real, Term};

/// Adds the energy `EA ∫ (½ ε₀² - ε₀ ε) dx` of one element, `ε₀` fading with time. Elements that have one are few and
/// have it for a moment, so that all derivatives come from forward differentiation.
pub(crate) struct Fading {
    /// `hose: prestrain`.
    label: String,
    strain: Prestrain,
    ea: f64,
    /// Places of the twelve dofs and of the boundaries.
    q: Vec<usize>,
    v: Vec<usize>,
    by: Embedding<2>,
    /// An open end and the boundary there: 0 or 1, and its number.
    end: Option<(usize, usize)>,
    models: ChosenModels,
}

/// Where a fading strain acts.
pub(crate) struct Place {
    pub label: String,
    pub ea: f64,
    pub q: Vec<usize>,
    pub v: Vec<usize>,
    pub by: Embedding<2>,
    pub end: Option<(usize, usize)>,
}

/// The term of a fading strain.
pub(crate) fn fading(model: CableModel, strain: Prestrain, place: Place) -> Result<Box<dyn Term>, String> {
    let (models, Place { label, ea, q, v, by, end }) = (model.models()?, place);
    Ok(Box::new(Fading { label, strain, ea, q, v, by, end, models }))
}

impl Fading {
    fn length<R: Real>(&self, x: &[R]) -> R {
        let mut l = R::of(self.by.fixed[1] - self.by.fixed[0]);
        for k in 0..x.len() - 12 {
            l += R::of(self.by.by[k][1] - self.by.by[k][0]) * x[12 + k];
        }
        l
    }

    /// Energy with a part `left` of the strain, and energy per length at the open end.
    fn energies<R: Real>(&self, x: &[R], left: R) -> (R, R) {
        let (l, mut e) = (self.length(x), [R::zero(); 12]);
        e.copy_from_slice(&x[..12]);
        let q = natural(&e, R::of(1.0) / l);
        let (mut sum, mut there) = (R::zero(), R::zero());
        let points = self.models.points();
        for (k, (at, &strain)) in points.iter().zip(&self.strain.strain).enumerate() {
            let rest = left * R::of(strain);
            let density =
                R::of(self.ea) * rest * (R::of(0.5) * rest - self.models.longitudinal.strain(&q, at).eps());
            sum += R::of(at.w) * density;
            let own = match self.end {
                Some((0, _)) => k == 0,
                Some(_) => k + 1 == points.len(),
                None => false,
            };
            if own {
                there = density;
            }
        }
        (l * sum, there)
    }

    fn state(&self, at: &At<'_>) -> Vec<f64> {
        self.q.iter().map(|&i| at.q[i]).collect()
    }

    /// Sign with which the energy at the open end acts on its boundary.
    fn sign(&self) -> f64 {
        if matches!(self.end, Some((0, _))) { 1.0 } else { -1.0 }
    }
}

impl Term for Fading {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.v.iter().copied());
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let left = self.strain.left(at.t).0;
        if left == 0.0 {
            return;
        }
        let (x, n, w) = (self.state(at), self.q.len(), out.weights().q);
        let row = self.end.map(|(_, boundary)| 12 + boundary);
        let mut k = vec![0.0; n * n];
        for i in 0..n {
            let once = |j: usize, d: f64| {
                Dual::new(Dual::new(x[j], if i == j { 1.0 } else { 0.0 }), Dual::constant(d))
            };
            let mut all: Vec<Dual<Dual<f64>>> = (0..n).map(|j| once(j, 0.0)).collect();
            let (energy, _) = self.energies(&all, Dual::of(left));
            out.add(self.v[i], energy.re.eps);
            if !out.wants_tangent() {
                continue;
            }
            for j in 0..=i {
                all[j].eps.re = 1.0;
                let (energy, there) = self.energies(&all, Dual::of(left));
                all[j].eps.re = 0.0;
                k[i * n + j] += w * energy.eps.eps;
                if i != j {
                    k[j * n + i] += w * energy.eps.eps;
                }
                if let Some(row) = row
                    && i == n - 1
                {
                    k[row * n + j] += w * self.sign() * there.eps.re;
                }
            }
        }
        if let Some(row) = row {
            let constants: Vec<f64> = x;
            out.add(self.v[row], self.sign() * self.energies(&constants, left).1);
        }
        out.add_block(0, n, |i, j| k[i * n + j]);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        Energy { potential: self.energies(&self.state(at), self.strain.left(at.t).0).0, ..Energy::default() }
    }
    /// What fades does work; and what flows over an open end takes its share along.
    fn power(&self, at: &At<'_>) -> Power {
        let (left, rate) = self.strain.left(at.t);
        let x: Vec<Dual<f64>> = self.state(at).into_iter().map(Dual::constant).collect();
        let (energy, there) = self.energies(&x, Dual::new(left, rate));
        let carried = match self.end {
            Some((_, boundary)) => -self.sign() * there.re * at.v[self.v[12 + boundary]],
            None => 0.0,
        };
        Power { supplied: energy.eps, carried, ..Power::default() }
    }
}
