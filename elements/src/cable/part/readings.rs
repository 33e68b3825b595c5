//! What a cable tells of itself at a place: tension, moment, twist and torque.

use super::CablePart;
use crate::cable::CableParams;
use crate::cable::flow::change;
use crate::cable::longitudinal::Longitudinal;
use crate::cable::output::{self, Reading, read};
use crate::cable::transmitted::{self, Unstressed};
use crate::cable::twisted::{self, Twisted};
use ropewalk_core::{At, Line, Quantity, V3};
use std::ops::Range;

/// With what the means of these elements count at a place of the mesh.
pub(super) fn means(of: Range<usize>, place: f64, mesh: &[f64]) -> [f64; 3] {
    let (mut middle, mut length) = ([0.0; 3], [0.0; 3]);
    for (i, k) in of.clone().enumerate() {
        let [a, b] = [mesh[k], mesh[k + 1]];
        (middle[i], length[i]) = (0.5 * (a + b) - place, b - a);
    }
    transmitted::weights(&middle[..of.len()], &length[..of.len()])
}

impl CablePart {
    /// The elastic force that element `k` of length `l` transmits [N].
    pub(super) fn transmits(&self, k: usize, l: f64, at: &At<'_>) -> Option<V3<f64>> {
        let (s, q) = (self.layout.section(k), self.dofs(k, at.q));
        let [ea, ei] = self.layout.stiffness(k);
        let params = CableParams { l, ea, ei, rho_a: s.mass };
        let mut points: Option<Vec<f64>> = None;
        for p in self.prestrain.iter().filter(|p| p.element == k) {
            let left = p.left(at.t).0;
            let sum = points.get_or_insert_with(|| vec![0.0; p.strain.len()]);
            sum.iter_mut().zip(&p.strain).for_each(|(sum, strain)| *sum += left * strain);
        }
        let shape = self.rest.as_ref().map(|r| &r[k]);
        let (strain, curvature) = (self.offset.0, if self.twisted.is_some() { 0.0 } else { self.offset.1 });
        let unstressed = Unstressed { shape, strain, curvature, points: points.as_deref() };
        let mut force = transmitted::force(self.model, &params, &q, unstressed).ok()?;
        if let Some(elastic) = self.layout.elastic(k, l, self.model) {
            let more = elastic.transmits(&q);
            (0..3).for_each(|i| force[i] += more[i]);
        }
        if let Some(twisted) = &self.twisted {
            let more = twisted.transmits(k, l, at.q, self.around(k));
            (0..3).for_each(|i| force[i] += more[i]);
        }
        Some(force)
    }

    /// The tension in element `k` at `xi` [N]: what the force in the cable has along it. `slope` is the curve's there, and
    /// `transmits` knows [`CablePart::transmits`] of an element of a length.
    pub(super) fn tension(
        &self,
        k: usize,
        xi: f64,
        slope: &V3<f64>,
        at: &At<'_>,
        transmits: &mut dyn FnMut(usize, f64) -> Option<V3<f64>>,
    ) -> Option<f64> {
        let mesh = self.material(at.q);
        // where elements are born and swallowed their means jump, and the strain at a point is kept
        if (0..2).any(|end| self.makes_elements(end)) {
            return self.by_strain(k, mesh[k + 1] - mesh[k], xi, at);
        }
        let size = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (smooth, place) = (self.smooth(k), mesh[k] + xi * (mesh[k + 1] - mesh[k]));
        let count = smooth.len();
        let mut along = [0.0; 3];
        for (along, k) in along.iter_mut().zip(smooth.clone()) {
            let force = transmits(k, mesh[k + 1] - mesh[k])?;
            *along = (0..3).map(|c| force[c] * slope[c]).sum::<f64>() / size;
        }
        let weights = means(smooth, place, &mesh);
        let tension: f64 = weights.iter().zip(along).map(|(w, t)| w * t).sum();
        if count > 1 {
            return Some(tension);
        }
        // one element has its strain to tell how the tension changes along it
        let there = |xi: f64| self.by_strain(k, mesh[k + 1] - mesh[k], xi, at);
        let [start, middle, end] = [there(0.0)?, there(0.5)?, there(1.0)?];
        Some(tension + there(xi)? - middle - 0.1 * (start - 2.0 * middle + end))
    }

    /// The elements around element `k` whose forces tell how the force changes along it: three, or fewer where it isn't
    /// smooth.
    pub(super) fn smooth(&self, k: usize) -> Range<usize> {
        let next = self.breaks.partition_point(|b| *b <= k);
        let (from, to) = (self.breaks[next - 1], self.breaks[next]);
        let count = (to - from).min(3);
        let first = k.saturating_sub(1).clamp(from, to - count);
        first..first + count
    }

    /// The tension in element `k` of length `l` at `xi` as its strain there has it [N].
    pub(super) fn by_strain(&self, k: usize, l: f64, xi: f64, at: &At<'_>) -> Option<f64> {
        let models = self.model.models().ok()?;
        let (strain, tension) =
            output::stretch(models, &self.params(k, l), &self.dofs(k, at.q), xi, self.rest_of(k));
        let tension = self.told_by(k, xi, strain, tension);
        Some(tension - self.layout.section(k).ea * (self.offset.0 + self.fading(k, xi, at.t)))
    }

    fn params(&self, k: usize, l: f64) -> CableParams {
        let s = self.layout.section(k);
        CableParams { l, ea: s.ea, ei: s.ei.across, rho_a: s.mass }
    }

    pub(super) fn rest_of(&self, k: usize) -> Option<&[f64; 12]> {
        self.rest.as_ref().map(|r| &r[k])
    }

    /// The tension of element `k` where a table tells the force of a strain, or else as it is.
    fn told_by(&self, k: usize, xi: f64, strain: f64, tension: f64) -> f64 {
        let force = self.layout.force(k, xi, strain);
        force.map_or(tension, |force| {
            force * self.model.models().map_or(1.0, |m| m.longitudinal.lever(strain))
        })
    }

    pub(super) fn reading(&self, k: usize, l: f64, xi: f64, at: &At<'_>) -> Option<Reading> {
        let (q, v) = (self.dofs(k, at.q), self.velocities(k, at.v));
        let mut r = read(self.model, &self.params(k, l), &q, &v, xi, self.rest_of(k)).ok()?;
        r.tension = self.told_by(k, xi, r.strain, r.tension);
        if let Some(moment) = self.layout.moment(k, xi, r.curvature) {
            r.moment = moment;
        }
        Some(r)
    }

    /// What is left of the strain of element `k` that fades out.
    fn fading(&self, k: usize, xi: f64, t: f64) -> f64 {
        let own = self.prestrain.iter().filter(|p| p.element == k);
        own.map(|p| match change::points(self.model) {
            Ok(points) => p.left(t).0 * change::interpolate(&points, &p.strain, xi),
            Err(_) => 0.0,
        })
        .sum()
    }

    /// Bending moment [N m], of which an element reads this much.
    pub(super) fn moment(&self, k: usize, l: f64, xi: f64, read: f64, at: &At<'_>) -> f64 {
        match &self.twisted {
            Some(twisted) if twisted.is_directed(k) => {
                let [_, moment] = twisted.bends(k, l, xi, at.q, self.around(k));
                moment[0].hypot(moment[1])
            }
            Some(_) => read,
            None => read - self.layout.section(k).ei.across * self.offset.1,
        }
    }

    /// What only a cable with torsion knows, at a place of element `k`.
    pub(super) fn twist(&self, what: Quantity, k: usize, l: f64, xi: f64, at: &At<'_>) -> Option<f64> {
        let twisted = self.twisted.as_ref()?;
        let bends = || twisted.bends(k, l, xi, at.q, self.around(k));
        Some(match what {
            Quantity::CurvatureNormal => bends()[0][0],
            Quantity::CurvatureAcross => bends()[0][1],
            Quantity::MomentNormal => bends()[1][0],
            Quantity::MomentAcross => bends()[1][1],
            Quantity::Twist => twisted.twist(k, l, at.q, self.around(k))[0],
            Quantity::Torque => twisted.twist(k, l, at.q, self.around(k))[1],
            Quantity::Angle => {
                let whole = self.turns_before(k, twisted, at.q);
                whole + xi * l * twisted.twist(k, l, at.q, self.around(k))[0]
            }
            Quantity::Spin => twisted::spin(at, [self.seats[k].1, self.seats[k + 1].1], xi),
            Quantity::Tension | Quantity::Strain | Quantity::Curvature | Quantity::Moment => return None,
        })
    }

    /// Angle by which the elements before element `k` are twisted in all [rad].
    pub(super) fn turns_before(&self, k: usize, twisted: &Twisted, q: &[f64]) -> f64 {
        let mesh = self.material(q);
        let own = |k: usize| {
            let l = mesh[k + 1] - mesh[k];
            l * twisted.twist(k, l, q, self.around(k))[0]
        };
        self.layout.elements().take_while(|before| *before < k).map(own).sum()
    }
}
