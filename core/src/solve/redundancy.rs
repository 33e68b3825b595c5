//! Constraints that say what others have said, and how equations with them are solved.
//!
//! A door on two hinges, a planar loop in space: the Jacobian `G` of the constraints loses rank, and the multipliers
//! are no longer unique. The matrix gets a small negative diagonal, `[A, Gᵀ; G, -E]`, with which it is regular. As long
//! as the right-hand side is consistent, repeated solution converges to that of the true system, with the multipliers
//! of least norm (in the metric `E`): the iteration of Newton's method does that by itself.

use crate::algebra::noise::Noise;
use crate::algebra::scalar::Scalar;
use crate::error::BuildError;
use crate::model::Model;
use crate::model::redundancy::Redundancy;
use crate::model::state::At;
use crate::model::structure::Structure;
use crate::solve::linear::{Guard, SolveError};
use std::collections::BTreeSet;

/// Diagonal of the multipliers relative to the size of `G A⁻¹ Gᵀ`, equation by equation. Larger ones get in the way
/// where a mechanism passes a singular position: a four-bar linkage stops at 1e-6.
const SOFT: f64 = 1e-12;
/// The same where an iteration starts next to a singular position: directions that the constraints hardly determine
/// (by less than a thousandth of what they could) wait until the others are right.
const BLUNT: f64 = 1e-6;
/// The same where only the rank is asked for.
const RANK: f64 = 1e-12;
/// The same where a mechanism seems to be stuck: what the constraints hold by less than a thousandth counts as lost.
const STUCK: f64 = 1e-6;
/// Entries of a vector that the constraints can't resist, relative to those of the vector that it is projected from;
/// below, it is taken for rounding.
const NOTHING: f64 = 1e-3;

/// Energy of a motion that constraints leave, in parts of that of the one that it is projected from; below, none is left.
const FREE: f64 = 1e-12;
/// What a motion bends by in the time in which it goes as far as the model is long, in parts of that; below, it is straight.
const STRAIGHT: f64 = 1e-9;

/// How far a motion has gone, in parts of the model, when it is said to have just begun.
const BEGUN: [f64; 2] = [1e-6, 1e-4];
/// How far motions may have gone, in parts of the model, for the constraints to be redundant as at the start, nearly.
const MOVED: f64 = 1e-2;

/// Where the entries of the constraints stand in the matrix.
#[derive(Clone, Default)]
pub(crate) struct Softening {
    rows: Vec<Row>,
}

#[derive(Clone)]
struct Row {
    /// The diagonal entry of the multiplier.
    own: usize,
    /// Entries of the Jacobian, each with the diagonal entry of its velocity.
    entries: Vec<(usize, usize)>,
}

impl Softening {
    pub fn new(model: &Model, s: &Structure) -> Self {
        let mut rows = Vec::with_capacity(model.multipliers());
        for (c, constraint) in model.constraints().iter().enumerate() {
            for row in model.rows_of(c) {
                let p = s.position[model.velocities() + row];
                let dofs = constraint.nodes().iter().flat_map(|&k| model.node(k).dofs());
                let entries = dofs.map(|d| (s.slot(p, s.position[d]), s.diagonal[d] as usize)).collect();
                rows.push(Row { own: s.diagonal_at[p] as usize, entries });
            }
        }
        Softening { rows }
    }

    /// Subtracts the small diagonal from an assembled matrix.
    pub fn apply<T: Scalar>(&self, values: &mut [T]) {
        self.apply_scaled(values, SOFT);
    }

    /// Subtracts a diagonal that keeps corrections small next to a singular position.
    pub fn blunt<T: Scalar>(&self, values: &mut [T]) {
        self.apply_scaled(values, BLUNT);
    }

    fn apply_scaled<T: Scalar>(&self, values: &mut [T], scale: f64) {
        for row in &self.rows {
            let sum: f64 = row
                .entries
                .iter()
                .map(|&(g, a)| (values[g].size().powi(2), values[a].size()))
                .filter(|(g, _)| *g > 0.0)
                .map(|(g, a)| g / a.max(f64::MIN_POSITIVE))
                .sum();
            if sum > 0.0 && sum.is_finite() {
                values[row.own] -= T::from(scale * sum);
            }
        }
    }

    /// Multiplies multipliers by `E`, as the matrix holds it.
    pub fn times(&self, values: &[f64], lambda: &mut [f64]) {
        for (l, row) in lambda.iter_mut().zip(&self.rows) {
            // positive entries are those of constraints that have let go
            *l *= (-values[row.own]).max(0.0);
        }
    }
}

/// Finds redundant constraints where a model starts, by projecting random vectors onto what the constraints can't
/// resist.
///
/// # Errors
/// A constraint that isn't defined or holds nothing at the start; constraints that contradict each other.
pub fn find_redundancy(model: &Model) -> Result<Option<Redundancy>, BuildError> {
    if model.multipliers() == 0 {
        return Ok(None);
    }
    let (state, still) = (model.state(), vec![0.0; model.velocities()]);
    let at = At { v: &still, ..state.at() };
    let mut unresisted = Unresisted::new(model, &at, RANK)?;
    let (equations, rows) = unresisted.rank()?;
    if equations == 0 {
        return Ok(None);
    }
    unresisted.check_start(&at)?;
    unresisted.check_motions(at)?;
    let constraints =
        model.constraints_where(|r| rows.contains(&r)).into_iter().map(str::to_string).collect();
    let dead_point = unresisted.is_dead_point(&at)?;
    Ok(Some(Redundancy { equations, constraints, dead_point }))
}

/// Names of the constraints that nearly follow from each other where a model has got to, as at a dead point, or at the end of the
/// way that they leave; empty if there are none.
pub fn stuck<'a>(model: &'a Model, at: &At<'_>) -> Vec<&'a str> {
    let rank = Unresisted::new(model, at, STUCK).and_then(|mut unresisted| unresisted.rank());
    rank.map_or(Vec::new(), |(_, rows)| model.constraints_where(|r| rows.contains(&r)))
}

/// Projects vectors of the size of the multipliers onto what no motion of the model changes.
struct Unresisted<'a> {
    model: &'a Model,
    /// `[A, Gᵀ; G, -E]` with unit masses, and its factors.
    values: Vec<f64>,
    solver: Guard,
    softening: Softening,
    x: Vec<f64>,
    /// Values of the constraints at the start.
    g: Vec<f64>,
}

impl<'a> Unresisted<'a> {
    fn new(model: &'a Model, at: &At<'_>, soft: f64) -> Result<Self, BuildError> {
        let s = model.structure();
        let (mut values, mut g) = (vec![0.0; s.entries()], vec![0.0; model.multipliers()]);
        for (d, weight) in weights(model).enumerate() {
            values[s.diagonal[d] as usize] = weight;
        }
        for c in 0..model.constraints().len() {
            differentiate(model, c, at, &mut g, &mut values)?;
        }
        let softening = Softening::new(model, s);
        softening.apply_scaled(&mut values, soft);
        let mut solver = Guard::new(s).map_err(not_finite)?;
        solver.factor(s, &values).map_err(not_finite)?;
        Ok(Unresisted { model, values, solver, softening, x: vec![0.0; s.n], g })
    }

    /// The part of a vector that no motion of the model changes: `E (G A⁻¹ Gᵀ + E)⁻¹ z`.
    fn of(&mut self, z: &[f64]) -> Result<Vec<f64>, BuildError> {
        let (s, nv) = (self.model.structure(), self.model.velocities());
        let mut rhs = vec![0.0; s.n];
        rhs[nv..].copy_from_slice(z);
        s.order(&rhs, &mut self.x);
        self.solver.solve(s, &self.values, &mut self.x).map_err(not_finite)?;
        s.restore(&self.x, &mut rhs);
        let mut part = rhs.split_off(nv);
        self.softening.times(&self.values, &mut part);
        Ok(part.into_iter().map(|x| -x).collect())
    }

    /// The number of equations that follow from others, and the rows that take part in that.
    fn rank(&mut self) -> Result<(usize, BTreeSet<usize>), BuildError> {
        let m = self.model.multipliers();
        let (mut basis, mut rows) = (Vec::<Vec<f64>>::new(), BTreeSet::new());
        let mut seed = 1u64;
        while basis.len() < m {
            let z: Vec<f64> = (0..m)
                .map(|_| {
                    seed =
                        seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    0.5 + (seed >> 11) as f64 / (1_u64 << 53) as f64
                })
                .collect();
            let mut y = self.of(&z)?;
            if y.iter().all(|y| y.abs() <= NOTHING) {
                break;
            }
            let size = norm(&y);
            for b in &basis {
                let along: f64 = b.iter().zip(&y).map(|(b, y)| b * y).sum();
                y.iter_mut().zip(b).for_each(|(y, b)| *y -= along * b);
            }
            let new = norm(&y);
            if new <= 1e-4 * size {
                break;
            }
            y.iter_mut().for_each(|y| *y /= new);
            rows.extend((0..m).filter(|&r| y[r].abs() > NOTHING));
            basis.push(y);
        }
        Ok((basis.len(), rows))
    }

    /// Whether some constraint follows from others only here, as at a dead point: what they let go to first order they resist to
    /// second order, so that along a motion `v` with `G v = 0` no acceleration meets `G a = -(∂(G v)/∂q) v`.
    fn is_dead_point(&mut self, at: &At<'_>) -> Result<bool, BuildError> {
        let (model, s) = (self.model, self.model.structure());
        let (m, nv) = (model.multipliers(), model.velocities());
        let mut noise = Noise::default();
        let mut v: Vec<f64> = weights(model).map(|w| w.sqrt() * noise.draw()).collect();
        let size = |v: &[f64], power: i32| {
            v.iter().zip(weights(model)).map(|(v, w)| v * v * w.powi(power)).sum::<f64>()
        };
        let before = size(&v, -1);
        v.resize(s.n, 0.0);
        s.order(&v, &mut self.x);
        self.solver.solve(s, &self.values, &mut self.x).map_err(not_finite)?;
        s.restore(&self.x, &mut v);
        v.truncate(nv);
        if !(size(&v, 1) > FREE * before) {
            return Ok(false);
        }
        let (mut rate, mut still, mut moving) = (vec![0.0; m], vec![0.0; m], vec![0.0; m]);
        model.rates(at, &mut rate, &mut still);
        model.rates(&At { v: &v, ..*at }, &mut rate, &mut moving);
        let bend: Vec<f64> = moving.iter().zip(&still).map(|(moving, still)| moving - still).collect();
        let conflict = self.of(&bend)?;
        // straight motions bend by rounding alone
        let bent = STRAIGHT * size(&v, 1) / model.length();
        let resists = |(x, scale): (&f64, f64)| x.abs() > (NOTHING * largest(&bend)).max(bent * scale);
        Ok(conflict.iter().zip(model.row_scale()).any(resists))
    }

    /// Checks that redundant constraints ask for the same at the start.
    fn check_start(&mut self, at: &At<'_>) -> Result<(), BuildError> {
        let (model, m) = (self.model, self.model.multipliers());
        let (mut rate, mut bias) = (vec![0.0; m], vec![0.0; m]);
        model.rates(at, &mut rate, &mut bias);
        for (what, values, limit) in [
            ("ask for different positions", &self.g.clone(), 1e-5 * model.length()),
            ("prescribe different velocities", &rate, 1e-6 * largest(&rate)),
            ("prescribe different accelerations", &bias, 1e-6 * largest(&bias)),
        ] {
            let conflict = self.of(values)?;
            let who = model.constraints_where(|r| conflict[r].abs() > limit);
            if !who.is_empty() {
                return Err(contradiction(&who, what));
            }
        }
        Ok(())
    }

    /// Checks that redundant constraints ask for the same velocities later on.
    fn check_motions(&mut self, at: At<'_>) -> Result<(), BuildError> {
        let (model, m) = (self.model, self.model.multipliers());
        let (mut rate, mut bias) = (vec![0.0; m], vec![0.0; m]);
        let ahead = Ahead { model, at, g: self.g.clone() };
        for (t, moved) in ahead.times() {
            model.rates(&At { t, ..at }, &mut rate, &mut bias);
            let largest = largest(&rate);
            let conflict = if largest > 0.0 { self.of(&rate)? } else { continue };
            let differ =
                |share: f64| (0..m).filter(|&r| conflict[r].abs() > share * largest).collect::<BTreeSet<_>>();
            // what is linear stays redundant for ever, anything else as long as it has hardly moved
            let linear = Some(differ(1e-6)).filter(|rows| rows.iter().all(|&r| model.linear_row(r)));
            let rows = linear.unwrap_or_else(|| if moved < MOVED { differ(0.05) } else { BTreeSet::new() });
            if !rows.is_empty() {
                let who = model.constraints_where(|r| rows.contains(&r));
                return Err(contradiction(&who, &format!("prescribe different velocities at t = {t:.3} s")));
            }
        }
        Ok(())
    }
}

/// What each velocity weighs: translations one, turns the square of the model's size.
fn weights(model: &Model) -> impl Iterator<Item = f64> {
    let square = model.length().powi(2);
    model
        .nodes()
        .iter()
        .flat_map(move |n| n.dofs().enumerate().map(move |(k, _)| if k < 3 { 1.0 } else { square }))
}

/// Adds the Jacobian of one constraint to the matrix, and its values to `g`.
fn differentiate(
    model: &Model,
    c: usize,
    at: &At<'_>,
    g: &mut [f64],
    values: &mut [f64],
) -> Result<(), BuildError> {
    let (constraint, s, nv) = (&model.constraints()[c], model.structure(), model.velocities());
    let dofs: Vec<usize> = constraint.nodes().iter().flat_map(|&k| model.node(k).dofs()).collect();
    let (rows, n) = (model.rows_of(c), dofs.len());
    let mut jac = vec![0.0; rows.len() * n];
    constraint.jacobian(model.nodes(), at, &mut g[rows.clone()], &mut jac);
    if jac.iter().chain(&g[rows.clone()]).any(|x| !x.is_finite()) {
        let message = format!(
            "constraint `{}` is not defined where the scene starts (two of its points coincide?)",
            constraint.name()
        );
        return Err(BuildError::at(constraint.name(), message));
    }
    for (r, row) in rows.enumerate() {
        if jac[r * n..(r + 1) * n].iter().all(|&x| x == 0.0) {
            let message = format!(
                "equation {} of constraint `{}` holds nothing where the scene starts: it is singular there",
                r + 1,
                constraint.name()
            );
            return Err(BuildError::at(constraint.name(), message));
        }
        let p = s.position[nv + row];
        for (j, &d) in dofs.iter().enumerate() {
            values[s.slot(p, s.position[d])] = jac[r * n + j];
        }
        if !s.symmetric {
            for (j, &d) in dofs.iter().enumerate() {
                values[s.slot(s.position[d], p)] = jac[r * n + j];
            }
        }
    }
    Ok(())
}

fn not_finite(_: SolveError) -> BuildError {
    BuildError::new("the constraints can't be analysed: their equations are not finite")
}

fn contradiction(names: &[&str], what: &str) -> BuildError {
    let message = format!(
        "the constraints {} contradict each other: they hold the same parts twice and {what}. Remove one of them or \
         correct it",
        names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
    );
    BuildError::at(names.last().copied().unwrap_or_default(), message)
}

/// Motions as they are at later times, while the model stays where it starts.
struct Ahead<'a> {
    model: &'a Model,
    at: At<'a>,
    /// Values of the constraints at the start.
    g: Vec<f64>,
}

impl Ahead<'_> {
    /// Times at which motions are worth comparing, each with how far they have gone by then, in parts of the model: over
    /// the whole time for which they are defined, and those at which each of them has just begun.
    fn times(&self) -> Vec<(f64, f64)> {
        let moving = || self.model.moving_constraints();
        if moving().next().is_none() {
            return Vec::new();
        }
        let last = self.model.range().1.min(1e6);
        let grid = std::iter::successors(Some(1e-2), |t| Some(1.5 * t)).take_while(|t| *t < last);
        let grid: Vec<f64> = grid.collect();
        let mut all = Vec::new();
        for (c, _) in moving() {
            let Some(k) = grid.iter().position(|&t| self.gone(c, t) > BEGUN[1]) else { continue };
            let (mut low, mut high) = (if k == 0 { 0.0 } else { grid[k - 1] }, grid[k]);
            for _ in 0..60 {
                let t = 0.5 * (low + high);
                match self.gone(c, t) {
                    x if x < BEGUN[0] => low = t,
                    x if x > BEGUN[1] => high = t,
                    _ => {
                        all.push(t);
                        break;
                    }
                }
            }
        }
        all.sort_by(f64::total_cmp);
        all.extend(grid);
        let farthest = |t: f64| moving().map(|(c, _)| self.gone(c, t)).fold(0.0, f64::max);
        all.into_iter().map(|t| (t, farthest(t))).collect()
    }

    /// How far a constraint has moved at a time, in parts of the model's length.
    fn gone(&self, c: usize, t: f64) -> f64 {
        let (model, constraint) = (self.model, &self.model.constraints()[c]);
        let n: usize = constraint.nodes().iter().map(|&k| model.node(k).kind.velocities()).sum();
        let rows = model.rows_of(c);
        let mut g = vec![0.0; rows.len()];
        constraint.jacobian(model.nodes(), &At { t, ..self.at }, &mut g, &mut vec![0.0; n * rows.len()]);
        let scales = model.lengthlike().skip(rows.start).map(|is| if is { model.length() } else { 1.0 });
        let gone = g.iter().zip(&self.g[rows.clone()]).zip(scales);
        gone.map(|((g, before), scale)| (g - before).abs() / scale).fold(0.0, f64::max)
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}
