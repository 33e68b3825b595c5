//! Condition numbers of the matrix that Newton's method solves with, in several forms of the same equations.

use crate::error::Error;
use nalgebra::{DMatrix, DVector};
use ropewalk_core::integrator::{Options, Scales, StepError, Units, Workspace};
use ropewalk_core::{Model, State, Weights};
use serde::Serialize;

/// In which form equations are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// In SI units.
    Si,
    /// In SI units with unknowns and equations scaled by `β h²`, as Ropewalk solves them (Bottasso, Bauchau & Cardona
    /// 2007, SIAM J. Sci. Comput. 29: 397).
    Scaled,
    /// Without dimensions, by the time of bending.
    Bending,
    /// Without dimensions, by the time of sound.
    Axial,
}

impl Form {
    /// All of them.
    pub const ALL: [Form; 4] = [Form::Si, Form::Scaled, Form::Bending, Form::Axial];

    /// The scales that it stands for.
    pub fn scales(self) -> Option<Scales> {
        match self {
            Form::Si | Form::Scaled => None,
            Form::Bending => Some(Scales::Bending),
            Form::Axial => Some(Scales::Axial),
        }
    }

    /// What tables and pictures call it.
    pub fn label(self) -> &'static str {
        match self {
            Form::Si => "SI",
            Form::Scaled => "SI, scaled by β h²",
            Form::Bending => "bending",
            Form::Axial => "axial",
        }
    }
}

/// Condition number, in the 2-norm, of `[M/(β h²) + γ/(β h) C + K, Gᵀ; G, 0]` for steps `h` of a scheme; where the form
/// is [`Form::Scaled`], of `[M + γ h C + β h² K, Gᵀ; G, 0]`.
///
/// # Errors
/// Scales that the model doesn't have; not enough memory.
pub fn condition(model: &Model, state: &State, options: &Options, h: f64, form: Form) -> Result<f64, Error> {
    let c = options.scheme.coefficients().map_err(StepError::Options)?;
    let weights = Weights { q: c.beta * h * h, v: c.gamma * h, a: c.mass() };
    let units = form.scales().map_or(Ok(Units::SI), |s| Units::of(s, model)).map_err(StepError::Options)?;
    let (s, nv) = (model.structure(), model.velocities());
    let mut work = Workspace::new(model).map_err(|source| StepError::Linear {
        t: 0.0,
        source,
        unknown: "the matrix of the iteration".into(),
    })?;
    model.assemble(&state.at(), &state.lambda, Some(weights), &mut work.system);

    let unknowns = units.unknowns(model);
    let mut scale = vec![1.0; s.n];
    for (i, &p) in s.position.iter().enumerate() {
        scale[p] = unknowns[i];
    }
    // positions instead of accelerations as unknowns
    let time = h / units.time;
    let by = if form == Form::Scaled { 1.0 } else { c.beta * time * time };
    let velocity: Vec<bool> = {
        let mut all = vec![false; s.n];
        s.position[..nv].iter().for_each(|&p| all[p] = true);
        all
    };
    let mut matrix = DMatrix::zeros(s.n, s.n);
    for (row, columns, values) in s.rows() {
        for (k, value) in values.enumerate() {
            let column = columns.get(k);
            let both = velocity[row] && velocity[column];
            let x = work.system.values[value] * scale[row] * scale[column] / units.square();
            let x = if both { x / by } else { x };
            matrix[(row, column)] = x;
            if s.symmetric {
                matrix[(column, row)] = x;
            }
        }
    }
    let (lu, transposed) = (matrix.clone().lu(), matrix.transpose().lu());
    let largest = growth(s.n, |x| Some(matrix.tr_mul(&(&matrix * x))));
    let smallest = growth(s.n, |x| lu.solve(&transposed.solve(x)?));
    Ok(smallest.map_or(f64::INFINITY, |x| x.sqrt()) * largest.map_or(f64::NAN, |x| x.sqrt()))
}

/// The largest eigenvalue of a symmetric product by the power method: elimination resolves what is far beyond the
/// rounding of singular values where only the units are to blame. `None` where it can't be applied.
fn growth(n: usize, apply: impl Fn(&DVector<f64>) -> Option<DVector<f64>>) -> Option<f64> {
    const ITERATIONS: usize = 60;
    let mut x = DVector::from_fn(n, |i, _| 1.0 + (1.7 * i as f64).sin());
    let mut size = x.norm();
    for _ in 0..ITERATIONS {
        x = apply(&(x / size))?;
        size = x.norm();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
    }
    Some(size)
}
