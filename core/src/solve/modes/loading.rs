//! The path of equilibria under loads that grow together, and where the first direction gives way on it: by the law of
//! inertia, so that none is missed and none is believed that linear equations make up.

use super::krylov::dot;
use super::outcome::ModesError;
use super::pencil::Pencil;
use crate::algebra::noise::Noise;
use crate::model::Model;
use crate::model::state::State;
use crate::solve::statics::Statics;

/// The largest factor that is looked at, and the inverse of the smallest.
const MOST: f64 = 1e4;
/// The first step of the factor, and steps at most.
const FIRST: f64 = 0.1;
const MOST_STEPS: usize = 400;
/// How far a step may go, and how far from there it may end, in lengths of the model and radians: what ends farther off
/// has leapt onto another path.
const LONG: f64 = 0.1;
const ASTRAY: f64 = 0.05;
/// Corrections by Newton's method at most, those of a step that may grow, and the size of the last one.
const MOST_CORRECTIONS: usize = 15;
const EASY: usize = 4;
const CLOSED: f64 = 1e-7;
/// How closely the factor is found.
const CLOSE: f64 = 1e-7;
/// What is left at most of the stiffness that goes, where the path ends at a limit of its loads.
const GONE: f64 = 0.1;
/// Inverse iterations for a shape.
const ITERATIONS: usize = 6;

/// Equilibria of a model under its loads times a factor.
pub(super) struct Loading<'a, 's> {
    pub statics: &'a mut Statics<'s>,
    pub model: &'a Model,
    /// The matrix holds what moves freely by so much mass [1/s²].
    pub shift: f64,
}

/// An equilibrium on the path.
struct Place {
    state: State,
    factor: f64,
    /// Its equations, factored.
    pencil: Pencil,
    /// Directions in which it falls over.
    lost: usize,
}

/// What is known of a path.
pub(super) struct Followed {
    /// The factor at which the first direction is lost, and the shape that goes with it.
    pub lost: Option<(f64, Vec<f64>)>,
    /// The factor up to which none is.
    pub safe: f64,
}

impl Loading<'_, '_> {
    /// Follows the path up to where a direction is lost; of an unstable equilibrium down, to where none is lost yet.
    /// `None` where the solver can't count them.
    pub fn follow(&mut self, state: &State) -> Result<Option<Followed>, ModesError> {
        let Some(mut start) = self.place(state.clone(), 1.0)? else { return Ok(None) };
        let stable = start.lost == 0;
        let mut noise = Noise::default();
        let mut shape: Vec<f64> = (0..start.pencil.len()).map(|_| noise.draw()).collect();
        let before = stiffness(&mut start.pencil, &mut shape)?;
        let (mut here, behind, counted) = self.walk(start, stable)?;
        let Some(mut behind) = behind else {
            return Ok(Some(Followed { lost: None, safe: here.factor }));
        };
        while (behind - here.factor).abs() > CLOSE * here.factor {
            let middle = 0.5 * (here.factor + behind);
            match self.step(&mut here, middle)? {
                Some((there, _)) if (there.lost == 0) == stable => here = there,
                _ => behind = middle,
            }
        }
        let after = stiffness(&mut here.pencil, &mut shape)?;
        // a path may also end where Newton's method does
        let gone = counted || after.abs() < GONE * before.abs();
        let lost = gone.then_some((here.factor, shape));
        Ok(Some(Followed { lost, safe: here.factor }))
    }

    /// Steps along the path until the count changes or it goes no farther: the last place before, the factor behind it,
    /// and whether that one was counted.
    fn walk(&mut self, start: Place, stable: bool) -> Result<(Place, Option<f64>, bool), ModesError> {
        let (end, mut here, mut step) = (if stable { MOST } else { 1.0 / MOST }, start, FIRST);
        for _ in 0..MOST_STEPS {
            let left: f64 = end - here.factor;
            if left == 0.0 {
                break;
            }
            let to = if left.abs() <= step { end } else { here.factor + step.copysign(left) };
            match self.step(&mut here, to)? {
                Some((there, _)) if (there.lost == 0) != stable => return Ok((here, Some(to), true)),
                Some((there, easy)) => {
                    here = there;
                    step = if easy { 2.0 * step } else { step };
                }
                None if step <= CLOSE * here.factor => return Ok((here, Some(to), false)),
                None => step *= 0.5,
            }
        }
        Ok((here, None, false))
    }

    /// The equilibrium at another factor of the loads, and whether it was easy to find; `None` where it leads too far, and
    /// where there is none.
    fn step(&mut self, from: &mut Place, to: f64) -> Result<Option<(Place, bool)>, ModesError> {
        let (force, _) = self.statics.loads(&from.state);
        let d = from.pencil.answer(&force).map_err(ModesError::Solver)?;
        let by = to - from.factor;
        if !(by.abs() * size(self.model, &d[..self.model.velocities()]) <= LONG) {
            return Ok(None);
        }
        let mut state = from.state.clone();
        self.advance(&mut state, by, &d);
        let Some(corrections) = self.close(&mut state, to, ASTRAY)? else { return Ok(None) };
        Ok(self.place(state, to)?.map(|place| (place, corrections <= EASY)))
    }

    /// `None` where the solver doesn't know how many directions are lost.
    fn place(&mut self, state: State, factor: f64) -> Result<Option<Place>, ModesError> {
        let pencil = self.pencil(&state, factor)?;
        Ok(pencil.below().map(|lost| Place { state, factor, pencil, lost }))
    }

    /// The equations under the loads times a factor, factored.
    pub fn pencil(&mut self, state: &State, factor: f64) -> Result<Pencil, ModesError> {
        let ((force, own), more) = (self.statics.loads(state), factor - 1.0);
        let mut linear = self.statics.linearise(state);
        for values in [&mut linear.stiffness, &mut linear.braced] {
            values.iter_mut().zip(&own).for_each(|(k, own)| *k += more * own);
        }
        linear.braced_residual.iter_mut().zip(&force).for_each(|(r, force)| *r += more * force);
        let mut pencil = Pencil::new(self.model, &state.internal, linear)?;
        pencil.factor(0.0, self.shift).map_err(ModesError::Solver)?;
        Ok(pencil)
    }

    /// Moves a state by a part of displacements and multipliers.
    pub fn advance(&self, state: &mut State, part: f64, d: &[f64]) {
        let (moves, multipliers) = d.split_at(self.model.velocities());
        let (moves, before): (Vec<f64>, _) = (moves.iter().map(|x| part * x).collect(), state.q.clone());
        self.model.retract(&before, &moves, &mut state.q);
        state.lambda.iter_mut().zip(multipliers).for_each(|(l, m)| *l += part * m);
    }

    /// Closes in on the equilibrium by Newton's method: how many corrections it took; `None` where it doesn't, or only
    /// farther away than that.
    pub fn close(&mut self, state: &mut State, factor: f64, far: f64) -> Result<Option<usize>, ModesError> {
        let mut moved = 0.0;
        for corrections in 1..=MOST_CORRECTIONS {
            let mut pencil = self.pencil(state, factor)?;
            let d = pencil.correction().map_err(ModesError::Solver)?;
            let size = size(self.model, &d[..self.model.velocities()]);
            moved += size;
            if !(moved <= far) {
                return Ok(None);
            }
            self.advance(state, 1.0, &d);
            if size <= CLOSED {
                return Ok(Some(corrections));
            }
        }
        Ok(None)
    }
}

/// The smallest `xᵀKx / xᵀMx`, to which a few inverse iterations bring a shape, with the factored matrix.
pub(super) fn stiffness(pencil: &mut Pencil, shape: &mut Vec<f64>) -> Result<f64, ModesError> {
    let mut y = vec![0.0; shape.len()];
    for _ in 0..ITERATIONS {
        pencil.mass(shape, &mut y);
        pencil.solve(&mut y).map_err(ModesError::Solver)?;
        let largest = y.iter().fold(0.0, |m: f64, y| m.max(y.abs()));
        y.iter_mut().for_each(|y| *y /= largest);
        std::mem::swap(shape, &mut y);
    }
    pencil.mass(shape, &mut y);
    let mass = dot(shape, &y);
    pencil.stiffness(shape, &mut y);
    Ok(dot(shape, &y) / mass)
}

/// Size of an increment, in lengths of the model and radians.
pub(super) fn size(model: &Model, moves: &[f64]) -> f64 {
    let mut size = 0.0_f64;
    for n in model.nodes() {
        for (k, x) in moves[n.dofs()].iter().enumerate() {
            let x = if k < 3 && n.kind.has_position() { x.abs() / model.length() } else { x.abs() };
            // a NaN stays
            size = if x <= size { size } else { x };
        }
    }
    size
}
