//! What can be read off a cable element at any of its points.

use super::element::CableParams;
use super::longitudinal::{Longitudinal, Strain};
use super::model::{CableModel, ChosenModels, TransverseModel};
use super::quadrature::Point;
use super::shape::{combine, hermite, natural};
use super::transverse::Curve;
use ropewalk_core::V3;

/// Motion and internal forces at a point of a cable element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Position [m].
    pub position: V3<f64>,
    /// Velocity [m/s].
    pub velocity: V3<f64>,
    /// Slope r'; its length is the stretch.
    pub slope: V3<f64>,
    /// Axial strain, in the model's own measure.
    pub strain: f64,
    /// Axial force [N], tension positive: the true one along the tangent, whatever the measure.
    pub tension: f64,
    /// Curvature, in the model's own measure [1/m].
    pub curvature: f64,
    /// Bending moment, conjugate to that curvature [N m].
    pub moment: f64,
}

/// Axial strain at `xi`.
///
/// With fewer than five points the strain is interpolated between the quadrature points: only there does the
/// element control it. In between, the cubic of a bent element stretches by about `(κL)⁴`, which no force answers
/// to, and which `EA` would turn into a tension that isn't there.
fn strain_at(models: ChosenModels, e: &[f64; 12], l: f64, xi: f64) -> f64 {
    let q = natural(e, 1.0 / l);
    let (points, model) = (models.points(), models.longitudinal);
    if points.len() >= 5 {
        return model.strain(&q, &Point::new(xi, 1.0)).eps();
    }
    if let Some(at) = points.iter().find(|p| p.xi == xi) {
        return model.strain(&q, at).eps();
    }
    let lagrange = |k: usize| -> f64 {
        let others = points.iter().enumerate().filter(|(j, _)| *j != k);
        others.map(|(_, p)| (xi - p.xi) / (points[k].xi - p.xi)).product()
    };
    points.iter().enumerate().map(|(k, at)| lagrange(k) * model.strain(&q, at).eps()).sum()
}

/// Axial strain, in the model's own measure, and tension at `xi` [N]: of [`read`] what the shape alone tells.
pub(super) fn stretch(
    models: ChosenModels,
    CableParams { l, ea, .. }: &CableParams,
    q: &[f64; 12],
    xi: f64,
    rest: Option<&[f64; 12]>,
) -> (f64, f64) {
    let strain = strain_at(models, q, *l, xi);
    let eps0 = rest.map_or(0.0, |e| strain_at(models, e, *l, xi));
    (strain, ea * (strain - eps0) * models.longitudinal.lever(strain))
}

/// Curvature at `xi`, directly: interpolated magnitudes would be wrong around a change of sign.
fn curvature_at(model: TransverseModel, e: &[f64; 12], l: f64, xi: f64) -> f64 {
    Curve::new(model, &natural(e, 1.0 / l), &Point::new(xi, 1.0), 1.0 / l).square.value.sqrt()
}

/// Reads an element at `xi` of its length, 0 at its start and 1 at its end: `q` and `v` are its twelve dofs and their
/// rates, `rest` the shape at which it is free of stress unless that is straight.
///
/// With T1 and T2 the force along the tangent has a small share of the bending moment besides; it is left out.
pub fn read(
    model: CableModel,
    params: &CableParams,
    q: &[f64; 12],
    v: &[f64; 12],
    xi: f64,
    rest: Option<&[f64; 12]>,
) -> Result<Reading, String> {
    let (models, &CableParams { l, ei, .. }) = (model.models()?, params);
    let s = hermite(xi, l);
    let at = |e: &[f64; 12]| std::array::from_fn(|c| (0..4).map(|i| s[i] * e[3 * i + c]).sum());
    let curvature_at = |e| curvature_at(models.transverse, e, l, xi);
    let (strain, tension) = stretch(models, params, q, xi, rest);
    let curvature = curvature_at(q);
    let kappa0 = rest.map_or(0.0, curvature_at);
    Ok(Reading {
        position: at(q),
        velocity: at(v),
        slope: combine(&Point::new(xi, 1.0).phi, &natural(q, 1.0 / l)),
        strain,
        tension,
        curvature,
        moment: ei * (curvature - kappa0),
    })
}
