//! The force that a cable element transmits, and the tension along the cable that follows from it.
//!
//! An element with a displacement `S₃(ξ) δr` of its end only does the work `F·δr`, with the elastic force `F` on that end. By
//! the equilibrium of its nodes this `F` is a mean of the force in the cable's cross section, `∫ 6ξ(1-ξ) F(ξ) dξ`, however
//! coarse the mesh: the strain at a point feels the bending of a layer shorter than the element, times `EA/EI`, and `F`
//! doesn't. So the force at any place is the polynomial with the means of the elements around, and the tension its part
//! along the tangent.

use super::element::CableParams;
use super::longitudinal::{Longitudinal, Strain, add_axial};
use super::model::{CableModel, Models};
use super::quadrature::{MOST, Rule};
use super::reduced::Reduced;
use super::rest::BendingRest;
use super::shape::natural;
use super::transverse::Transverse;
use ropewalk_core::{Element, Local, Share, V3, Weights};

/// What an element is free of stress at besides being straight and unstretched.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Unstressed<'a> {
    /// The shape in which it is as long as when free of stress.
    pub shape: Option<&'a [f64; 12]>,
    /// Strain on top, everywhere.
    pub strain: f64,
    /// Curvature on top, without direction [1/m].
    pub curvature: f64,
    /// Strain on top, at each of the points of the model.
    pub points: Option<&'a [f64]>,
}

/// The elastic force that an element with the dofs `q` transmits [N], tension along the cable positive.
pub(super) fn force(
    model: CableModel,
    params: &CableParams,
    q: &[f64; 12],
    unstressed: Unstressed<'_>,
) -> Result<V3<f64>, String> {
    let models = model.models()?;
    let Models { longitudinal, transverse, rule } = models;
    let (&CableParams { l, ea, ei, .. }, Unstressed { shape, strain, curvature, points }) =
        (params, unstressed);
    let (il, dofs) = (1.0 / l, q);
    let q = natural(dofs, il);
    let mut local = Reduced::zero();
    add_axial::<_, _, f64, false>(longitudinal, rule.axial(), ea * l, &q, &mut local);
    transverse.add::<_, f64, false>(rule.bending(), ei, l, il, &q, &mut local);
    let laid = shape.map(|e| natural(e, il));
    if laid.is_some() || strain != 0.0 || points.is_some() {
        for (k, at) in models.points().iter().enumerate() {
            let eps0 = laid.map_or(0.0, |laid| longitudinal.strain(&laid, at).eps())
                + strain
                + points.and_then(|p| p.get(k)).copied().unwrap_or(0.0);
            local.add_force(-(ea * l * at.w * eps0), &longitudinal.strain(&q, at).gradient());
        }
    }
    let mut out = Share::<f64, 12>::zero();
    local.spread_force::<false>(il, &mut out);
    if curvature != 0.0 && ei > 0.0 {
        let x = Local { q: *dofs, v: [0.0; 12], a: [0.0; 12], last: [0.0; 12], relaxed: None };
        let rest = BendingRest::new(l, ei, [curvature; MOST], transverse, rule.bending());
        let w = Weights { q: 0.0, v: 0.0, a: 0.0 };
        BendingRest::add::<f64, false>(&rest.to_lanes(), &x, &w, &mut out);
    }
    Ok([out.r[6], out.r[7], out.r[8]])
}

/// Variance of the weight `6ξ(1-ξ)`.
const VARIANCE: f64 = 0.05;

/// With what the means of up to three neighbours count in the value at a place: that of the polynomial which has these
/// means. `middle` are their middles as seen from the place, `length` their lengths.
pub fn weights(middle: &[f64], length: &[f64]) -> [f64; 3] {
    match *middle {
        [_] => [1.0, 0.0, 0.0],
        [a, b] => [b / (b - a), a / (a - b), 0.0],
        [a, b, c] => {
            let square = |k: usize| middle[k] * middle[k] + VARIANCE * length[k] * length[k];
            let (p, q, r) = (square(0), square(1), square(2));
            // normal to the means of s and of s²
            let w = [b * r - c * q, c * p - a * r, a * q - b * p];
            let sum: f64 = w.iter().sum();
            w.map(|w| w / sum)
        }
        _ => [0.0; 3],
    }
}
