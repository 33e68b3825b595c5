//! The equations of motion linearised about a state, with what inputs do to them and what records see of it: for control,
//! frequency responses and other programs.

use crate::algebra::rotation::cross;
use crate::model::Model;
use crate::model::assembly::System;
use crate::model::column::Column;
use crate::model::motion::SteadyFrame;
use crate::model::node::NodeKind;
use crate::model::state::{At, State};
use crate::model::structure::Structure;
use crate::model::term::Weights;
use crate::simulation::audit::Audit;
use crate::simulation::record::{Record, Sample};
use crate::solve::linear::SolveError;
use crate::solve::statics::{Statics, StaticsOptions};
use faer::Mat;
use faer::sparse::{SparseColMat, Triplet};

/// A matrix by compressed columns, as `scipy.sparse.csc_array` has it.
pub type Sparse = SparseColMat<usize, f64>;

/// Step of differences, in parts of the size of what is moved: the third root of rounding.
const STEP: f64 = 6e-6;
/// What is less than this part of the largest entry of a row of outputs is what differences leave of nothing.
const NOTHING: f64 = 1e-9;
/// A pivot of the constraints below this part of the largest is none.
const RANK: f64 = 1e-10;

/// The equations of small motions about a state, in SI units:
///
/// `M δa + C δv + K δq + Gᵀ δλ = B δu`, `G δv = D δu` (where constraints hold), `δq̇ = δv + N δq`,
/// `δy = Yq δq + Yv δv + Ya δa + Yλ δλ + Yu δu`.
///
/// `δq` are increments of the coordinates, of orientations along the body's own axes; `N` isn't zero where bodies turn.
/// About a state that moves the equations hold for as long as it stays near.
#[derive(Clone, Debug)]
pub struct Linearised {
    /// Time [s].
    pub t: f64,
    /// What the unknowns `δq` are called: rows and columns of the square matrices.
    pub unknowns: Vec<String>,
    /// The equations of constraints that hold: rows of `G`.
    pub constraints: Vec<String>,
    /// The inputs with their units.
    pub inputs: Vec<Column>,
    /// The columns of records with their units.
    pub outputs: Vec<Column>,
    /// Mass `M = ∂r/∂a`.
    pub mass: Sparse,
    /// `C = ∂r/∂v`: damping, and what turns bodies or a frame sideways.
    pub damping: Sparse,
    /// The skew part of `C`, which does no work about a state at rest: gyroscopic and Coriolis forces.
    pub gyroscopic: Sparse,
    /// Stiffness `K = ∂(r + Gᵀλ)/∂q`, with that of stresses and of the forces of constraints.
    pub stiffness: Sparse,
    /// Jacobian `G` of the constraints.
    pub jacobian: Sparse,
    /// `N`.
    pub kinematic: Sparse,
    /// `B`: generalised force per unit of each input.
    pub forces: Sparse,
    /// `D`: rate of each constraint per unit of each input that prescribes a speed.
    pub drives: Sparse,
    /// `Yq`, `Yv`, `Ya`, `Yλ`, by differences.
    pub output: [Sparse; 4],
    /// `Yu`: what outputs see of the inputs at once.
    pub feedthrough: Sparse,
}

/// Why equations can't be linearised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LineariseError {
    /// The state is that of another model.
    #[error("the state belongs to another model: {0}")]
    Foreign(String),
    /// A matrix has entries that are no numbers, or there is not enough memory.
    #[error("the equations can't be linearised: {0}")]
    Solver(#[from] SolveError),
    /// Material runs in the frame otherwise than steadily.
    #[error("{0}")]
    Unsteady(String),
}

/// Collects the entries of a matrix.
struct Entries {
    size: (usize, usize),
    all: Vec<Triplet<usize, usize, f64>>,
}

impl Entries {
    fn new(rows: usize, columns: usize) -> Self {
        Entries { size: (rows, columns), all: Vec::new() }
    }
    fn add(&mut self, row: usize, col: usize, val: f64) {
        if val != 0.0 {
            self.all.push(Triplet { row, col, val });
        }
    }
    fn done(self) -> Result<Sparse, SolveError> {
        if self.all.iter().any(|e| !e.val.is_finite()) {
            return Err(SolveError::NotFinite);
        }
        let (rows, columns) = self.size;
        Sparse::try_new_from_triplets(rows, columns, &self.all).map_err(|_| SolveError::Memory)
    }
}

/// Stored values of matrices with the structure that they have.
struct Stored {
    structure: Structure,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    mass: Vec<f64>,
}

/// Linearises a model about a state whose accelerations and multipliers belong to it: an equilibrium, or the state of a
/// [`Simulation`](crate::Simulation). With a `frame` about an equilibrium relative to it, as [`Statics::relative`] finds it.
///
/// Inputs are moved and put back on the way: nobody else may use the model meanwhile.
///
/// # Errors
/// A state of another model, or matrices with entries that are no numbers.
pub fn linearise(
    model: &Model,
    state: &State,
    records: &[Box<dyn Record>],
    frame: Option<(SteadyFrame, &StaticsOptions)>,
) -> Result<Linearised, LineariseError> {
    model.check(state).map_err(LineariseError::Foreign)?;
    let mut state = state.clone();
    let renewed = model.renewed(&state.at(), true);
    let model = renewed.as_ref().unwrap_or(model);
    let stored = stored(model, &mut state, frame)?;
    let nv = model.velocities();
    let holding: Vec<usize> = (0..model.constraints().len())
        .filter(|&c| model.holds(c, &state.internal))
        .flat_map(|c| model.rows_of(c))
        .collect();
    let row_of = |multiplier: usize| holding.binary_search(&multiplier).ok();

    let mut unknown = vec![0; stored.structure.n];
    for (k, &p) in stored.structure.position.iter().enumerate() {
        unknown[p] = k;
    }
    let mut square = [(); 3].map(|()| Entries::new(nv, nv));
    let (mut skew, mut jacobian) = (Entries::new(nv, nv), Entries::new(holding.len(), nv));
    let symmetric = stored.structure.symmetric;
    for (r, columns, at) in stored.structure.rows() {
        for (k, p) in at.enumerate() {
            let (i, j) = (unknown[r], unknown[columns.get(k)]);
            let values = [stored.mass[p], stored.damping[p], stored.stiffness[p]];
            match (i < nv, j < nv) {
                (true, true) => {
                    for (to, value) in square.iter_mut().zip(values) {
                        to.add(i, j, value);
                        if symmetric && i != j {
                            to.add(j, i, value);
                        }
                    }
                    if !symmetric {
                        skew.add(i, j, 0.5 * values[1]);
                        skew.add(j, i, -0.5 * values[1]);
                    }
                }
                // the Jacobian stands in the rows of the constraints, and of what is symmetric in one triangle only
                (false, true) => row_of(i - nv).into_iter().for_each(|row| jacobian.add(row, j, values[2])),
                (true, false) if symmetric => {
                    row_of(j - nv).into_iter().for_each(|row| jacobian.add(row, i, values[2]));
                }
                _ => {}
            }
        }
    }
    let [mass, damping, stiffness] = square;
    let (forces, drives) = of_inputs(model, &state, &holding)?;
    let (outputs, output, feedthrough) = of_records(model, &state, records, &stored, &holding)?;
    let name = |k: &usize| model.unknown_name(nv + k);
    let unit = |unit: &str| if unit.is_empty() { "1".into() } else { unit.to_string() };
    Ok(Linearised {
        t: state.t,
        unknowns: (0..nv).map(|k| model.unknown_name(k)).collect(),
        constraints: holding.iter().map(name).collect(),
        inputs: model.inputs().iter().map(|i| Column::new(i.name(), unit(i.unit()))).collect(),
        outputs,
        mass: mass.done()?,
        damping: damping.done()?,
        gyroscopic: skew.done()?,
        stiffness: stiffness.done()?,
        jacobian: jacobian.done()?,
        kinematic: kinematic(model, &state)?,
        forces,
        drives,
        output,
        feedthrough,
    })
}

fn stored(
    model: &Model,
    state: &mut State,
    frame: Option<(SteadyFrame, &StaticsOptions)>,
) -> Result<Stored, LineariseError> {
    if let Some((frame, options)) = frame {
        let mut statics = Statics::relative(model, options, Some(frame))?;
        statics.run_material(state).map_err(|e| LineariseError::Unsteady(e.to_string()))?;
        statics.ride(state);
        let l = statics.linearise(state);
        return Ok(Stored {
            structure: l.structure,
            stiffness: l.stiffness,
            damping: l.damping,
            mass: l.mass,
        });
    }
    let structure = model.unsymmetric_structure();
    let values = |q: f64, v: f64, a: f64| {
        let mut system = System::default();
        model.assemble_in(&structure, &state.at(), &state.lambda, Some(Weights { q, v, a }), &mut system);
        system.values
    };
    let (stiffness, damping, mass) = (values(1.0, 0.0, 0.0), values(0.0, 1.0, 0.0), values(0.0, 0.0, 1.0));
    Ok(Stored { structure, stiffness, damping, mass })
}

/// What turning bodies make of increments along their own axes: `δθ̇ = δω - ω × δθ`.
fn kinematic(model: &Model, state: &State) -> Result<Sparse, SolveError> {
    let mut n = Entries::new(model.velocities(), model.velocities());
    for node in model.nodes().iter().filter(|n| n.kind.turns()) {
        let k = node.v + 3;
        if node.kind == NodeKind::Twist {
            // of a section about its tangent: δθ̇ = δw - t·(ṫ × δt)
            let p = &state.q[node.q + 3..node.q + 6];
            let p = [p[0], p[1], p[2]];
            let by = cross(&p, &[state.v[k], state.v[k + 1], state.v[k + 2]]);
            let size = p.iter().map(|x| x * x).sum::<f64>().powf(1.5);
            (0..3).for_each(|i| n.add(k + 3, k + i, -by[i] / size));
            continue;
        }
        let w = [state.v[k], state.v[k + 1], state.v[k + 2]];
        for (i, j, x) in
            [(0, 1, w[2]), (0, 2, -w[1]), (1, 0, -w[2]), (1, 2, w[0]), (2, 0, w[1]), (2, 1, -w[0])]
        {
            n.add(k + i, k + j, x);
        }
    }
    n.done()
}

/// Calls with each input moved to both sides of what it is, and by how much altogether; then it is what it was.
fn with_inputs_moved(model: &Model, t: f64, mut see: impl FnMut(usize, f64)) {
    for (k, input) in model.inputs().iter().enumerate() {
        let course = input.course();
        let [least, most] = input.limits();
        // loads are linear in their inputs, so that no step is too long
        let step = if (most - least).is_finite() && most > least { 0.25 * (most - least) } else { 1.0 };
        for by in [step, -step] {
            input.follow(course.moved(t, by));
            see(k, 2.0 * by);
        }
        input.follow(course);
    }
}

/// `B` and `D`.
fn of_inputs(model: &Model, state: &State, holding: &[usize]) -> Result<(Sparse, Sparse), SolveError> {
    let (nv, count) = (model.velocities(), model.inputs().len());
    let mut system = System::default();
    let (mut rate, mut bias) = (vec![0.0; model.multipliers()], vec![0.0; model.multipliers()]);
    let (mut b, mut d) = (vec![vec![0.0; nv]; count], vec![vec![0.0; holding.len()]; count]);
    with_inputs_moved(model, state.t, |k, by| {
        model.assemble(&state.at(), &state.lambda, None, &mut system);
        model.rates(&state.at(), &mut rate, &mut bias);
        b[k].iter_mut().zip(&system.residual).for_each(|(b, r)| *b -= r / by);
        d[k].iter_mut().zip(holding).for_each(|(d, &row)| *d -= rate[row] / by);
    });
    let sparse = |columns: &[Vec<f64>], rows: usize| {
        let mut all = Entries::new(rows, count);
        for (k, column) in columns.iter().enumerate() {
            let largest = column.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let kept = column.iter().enumerate().filter(|(_, x)| !(x.abs() <= 1e-12 * largest));
            kept.for_each(|(i, x)| all.add(i, k, *x));
        }
        all.done()
    };
    Ok((sparse(&b, nv)?, sparse(&d, holding.len())?))
}

/// The columns of records, what they see of the unknowns by central differences, and of the inputs.
fn of_records(
    model: &Model,
    state: &State,
    records: &[Box<dyn Record>],
    stored: &Stored,
    holding: &[usize],
) -> Result<(Vec<Column>, [Sparse; 4], Sparse), SolveError> {
    let outputs: Vec<Column> = records.iter().flat_map(|r| r.columns()).collect();
    let (nv, ny) = (model.velocities(), outputs.len());
    let look = |at: At<'_>, lambda: &[f64]| {
        let audit = Audit::start(model.energy(&at));
        let mut row = Vec::with_capacity(ny);
        records.iter().for_each(|r| r.sample(&Sample { model, at, lambda, audit: &audit }, &mut row));
        row
    };
    let mut all = [nv, nv, nv, holding.len()].map(|n| vec![Vec::new(); if ny == 0 { 0 } else { n }]);
    let difference = |high: Vec<f64>, low: Vec<f64>, by: f64| -> Vec<f64> {
        high.iter().zip(&low).map(|(h, l)| (h - l) / by).collect()
    };
    // the fastest that the mesh can resolve gives velocities and accelerations their sizes
    let s = &stored.structure;
    let ratio = |p: u32| stored.stiffness[p as usize].abs() / stored.mass[p as usize];
    let fastest =
        s.diagonal[..nv].iter().map(|&p| ratio(p)).filter(|x| x.is_finite() && *x > 0.0).fold(0.0, f64::max);
    let fastest = if fastest > 0.0 { fastest.sqrt() } else { 1.0 };
    let forces = records.iter().any(|r| r.needs_forces());
    let mut q = state.q.clone();
    for node in model.nodes().iter().filter(|_| ny > 0) {
        for (i, dof) in node.dofs().enumerate() {
            let long = i < 3 && node.kind.has_position() || matches!(node.kind, NodeKind::Scalars(_));
            let step = STEP * if long { model.length() } else { 1.0 };
            let mut both = [step, -step].into_iter().map(|by| {
                let mut d = vec![0.0; nv];
                d[dof] = by;
                model.retract(&state.q, &d, &mut q);
                look(At { q: &q, ..state.at() }, &state.lambda)
            });
            if let (Some(high), Some(low)) = (both.next(), both.next()) {
                all[0][dof] = difference(high, low, 2.0 * step);
            }
            let moved = |x: &[f64], by: f64| {
                let mut x = x.to_vec();
                x[dof] += by;
                x
            };
            let by = step * fastest;
            let [high, low] =
                [by, -by].map(|by| look(At { v: &moved(&state.v, by), ..state.at() }, &state.lambda));
            all[1][dof] = difference(high, low, 2.0 * by);
            if forces {
                let by = by * fastest;
                let [high, low] =
                    [by, -by].map(|by| look(At { a: &moved(&state.a, by), ..state.at() }, &state.lambda));
                all[2][dof] = difference(high, low, 2.0 * by);
            }
        }
    }
    let size = state.lambda.iter().fold(0.0_f64, |m, x| m.max(x.abs())).max(f64::MIN_POSITIVE.sqrt());
    for (k, &row) in holding.iter().enumerate().filter(|_| forces) {
        let [high, low] = [size, -size].map(|by| {
            let mut lambda = state.lambda.clone();
            lambda[row] += by;
            look(state.at(), &lambda)
        });
        all[3][k] = difference(high, low, 2.0 * size);
    }
    let mut of_u = vec![vec![0.0; ny]; if ny == 0 { 0 } else { model.inputs().len() }];
    if ny > 0 {
        with_inputs_moved(model, state.t, |k, by| {
            of_u[k].iter_mut().zip(look(state.at(), &state.lambda)).for_each(|(sum, y)| *sum += y / by);
        });
    }
    let sparse = |columns: &[Vec<f64>], n: usize| {
        let mut largest = vec![0.0_f64; ny];
        for column in columns {
            largest.iter_mut().zip(column).for_each(|(m, x)| *m = m.max(x.abs()));
        }
        let mut entries = Entries::new(ny, n);
        for (k, column) in columns.iter().enumerate() {
            let kept = column.iter().enumerate().filter(|(i, x)| !(x.abs() <= NOTHING * largest[*i]));
            kept.for_each(|(i, x)| entries.add(i, k, *x));
        }
        entries.done()
    };
    let [yq, yv, ya, yl] = all.each_ref();
    let output = [sparse(yq, nv)?, sparse(yv, nv)?, sparse(ya, nv)?, sparse(yl, holding.len())?];
    Ok((outputs, output, sparse(&of_u, model.inputs().len())?))
}

impl Linearised {
    /// An orthonormal basis of the motions that the constraints leave: `G Z = 0`, by a pivoted QR decomposition of `Gᵀ`.
    /// Dense, and the work grows with the square of the unknowns.
    pub fn null_space(&self) -> Mat<f64> {
        let n = self.unknowns.len();
        if self.constraints.is_empty() {
            return Mat::identity(n, n);
        }
        let qr = self.jacobian.to_dense().transpose().col_piv_qr();
        let r = qr.thin_R();
        let pivot = |k: usize| r[(k, k)].abs();
        let rank = (0..r.nrows().min(r.ncols())).take_while(|&k| pivot(k) > RANK * pivot(0)).count();
        let q = qr.compute_Q();
        q.subcols(rank, n - rank).to_owned()
    }

    /// Mass, damping, stiffness and forces of the inputs in the coordinates `w` of `δq = Z w`, with `Z` from
    /// [`Linearised::null_space`]: dense equations without constraints. What inputs that prescribe speeds do to them tells
    /// [`Linearised::carried`].
    pub fn reduced(&self) -> [Mat<f64>; 5] {
        let z = self.null_space();
        let project = |a: &Sparse| z.transpose() * (a * &z);
        [
            project(&self.mass),
            project(&self.damping),
            project(&self.stiffness),
            z.transpose() * self.forces.to_dense(),
            z,
        ]
    }

    /// What inputs that prescribe speeds carry along: `δv = Z ẇ + V u`, where `V` is the smallest motion with `G V = D`. Since
    /// then `δq = Z w + V ∫u`, the equations of [`Linearised::reduced`] become
    ///
    /// `M_w ẅ + C_w ẇ + K_w w = B_w u + P_0 ∫u + P_1 u + P_2 u̇`.
    ///
    /// Returns `[P_0, P_1, P_2, V]`, dense; without such inputs all are zero.
    ///
    /// # Errors
    /// A matrix with entries that are no numbers.
    pub fn carried(&self) -> Result<[Mat<f64>; 4], LineariseError> {
        let (z, n) = (self.null_space(), self.unknowns.len());
        let mut v = Mat::zeros(n, self.inputs.len());
        if !self.constraints.is_empty() {
            let g = self.jacobian.to_dense();
            let svd = g.thin_svd().map_err(|_| SolveError::NotFinite)?;
            let (sizes, along) = (svd.S(), svd.U().transpose() * self.drives.to_dense());
            let largest = (0..sizes.dim()).fold(0.0_f64, |m, k| m.max(sizes[k]));
            let scaled = Mat::from_fn(along.nrows(), along.ncols(), |k, j| {
                if sizes[k] > RANK * largest { along[(k, j)] / sizes[k] } else { 0.0 }
            });
            v = svd.V() * scaled;
        }
        let part = |a: &Sparse| -(z.transpose() * (a * &v));
        Ok([part(&self.stiffness), part(&self.damping), part(&self.mass), v])
    }
}
