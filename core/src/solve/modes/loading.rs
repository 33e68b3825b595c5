//! The path of equilibria under loads that grow together, and where the first direction gives way on it: by the law of
//! inertia, so that none is missed and none is believed that linear equations make up.

use super::krylov::dot;
use super::outcome::{Critical, ModesError};
use super::pencil::Pencil;
use crate::algebra::noise::Noise;
use crate::model::Model;
use crate::model::state::State;
use crate::solve::statics::Statics;

/// The smallest factor that is looked at.
const LEAST: f64 = 1.0 / Critical::MOST;
/// The first step of the factor, and steps at most.
const FIRST: f64 = 0.1;
const MOST_STEPS: usize = 400;
/// How far a step may go, in lengths of the model and radians; and how far from where its tangent leads it may end, in parts of
/// its way and besides: what ends farther off has leapt onto another path.
const LONG: f64 = 0.1;
const ASTRAY: [f64; 2] = [0.5, 1e-5];
/// Corrections by Newton's method at most, those of a step that may grow, and the size of the last one.
const MOST_CORRECTIONS: usize = 15;
const EASY: usize = 4;
const CLOSED: f64 = 1e-7;
/// How closely the factor is found.
const CLOSE: f64 = 1e-7;
/// At a limit of its loads a path goes on ever faster: so many times as fast there as where steps were of this size.
const FASTER: f64 = 10.0;
const SMALL: f64 = 1e-3;
/// What is left of the stiffness against a direction that is lost, in parts of the softest; and at a limit of the loads.
const REAL: f64 = 0.05;
const SOFT: f64 = 0.5;
/// Inverse iterations for a shape.
const ITERATIONS: usize = 6;

/// Equilibria of a model under its loads times a factor.
pub(super) struct Loading<'a, 's> {
    pub statics: &'a mut Statics<'s>,
    pub model: &'a Model,
    /// The matrix holds what moves freely by so much mass [1/s²].
    pub shift: f64,
    /// Stiffness against what is softest but not free, where the loads are as they are, by its mass [1/s²].
    pub softest: f64,
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
    /// Follows the path of a stable equilibrium up to where a direction is lost; of an unstable one down, to where none is lost
    /// yet. `None` where the solver can't count them.
    pub fn follow(&mut self, state: &State, stable: bool) -> Result<Option<Followed>, ModesError> {
        let Some(start) = self.place(state.clone(), 1.0).filter(|start| (start.lost == 0) == stable) else {
            return Ok(None);
        };
        let (mut here, behind, counted) = self.walk(start, stable)?;
        let Some(behind) = behind else { return Ok(Some(Followed { lost: None, safe: here.factor })) };
        let mut noise = Noise::default();
        let mut shape: Vec<f64> = (0..here.pencil.len()).map(|_| noise.draw()).collect();
        let mut at = here.factor;
        if counted {
            let before = (here.state.clone(), here.factor);
            here = self.between(here, behind, stable)?;
            at = self.unshifted(before, here.factor, behind, stable)?.unwrap_or(here.factor);
        } else {
            // it goes the way that the loads push it
            shape = here.pencil.towards(&self.statics.loads(&here.state).0).map_err(ModesError::Solver)?;
        }
        let left = stiffness(&mut here.pencil, &mut shape)?;
        // rounding of what moves freely may change the count where no direction is at its end, and Newton's method fail
        let real = match counted {
            true => (left + self.shift).abs() <= REAL * self.softest,
            false => left.abs() <= SOFT * self.softest,
        };
        let lost = (real && at > LEAST).then_some((at, shape));
        Ok(Some(Followed { lost, safe: at.max(LEAST) }))
    }

    /// The last place before a direction is lost or won.
    fn between(&mut self, mut here: Place, mut behind: f64, stable: bool) -> Result<Place, ModesError> {
        while (behind - here.factor).abs() > CLOSE * here.factor {
            let middle = 0.5 * (here.factor + behind);
            match self.step(&mut here, middle)? {
                Some((there, _)) if (there.lost == 0) == stable => here = there,
                _ => behind = middle,
            }
        }
        Ok(here)
    }

    /// The factor at which the direction is lost but for the mass that holds what moves freely: with a quarter of it it's lost
    /// nearer by, and its stiffness changes evenly.
    fn unshifted(
        &mut self,
        (state, factor): (State, f64),
        found: f64,
        behind: f64,
        stable: bool,
    ) -> Result<Option<f64>, ModesError> {
        if self.shift == 0.0 {
            return Ok(None);
        }
        let shift = self.shift;
        self.shift *= 0.25;
        let nearer = match self.place(state, factor) {
            Some(here) if (here.lost == 0) == stable => Some(self.between(here, behind, stable)?.factor),
            _ => None,
        };
        self.shift = shift;
        Ok(nearer.map(|nearer| nearer - (found - nearer) / 3.0))
    }

    /// Steps along the path until the count changes or it goes no farther: the last place before, the factor behind it, and
    /// whether that was counted.
    fn walk(&mut self, start: Place, stable: bool) -> Result<(Place, Option<f64>, bool), ModesError> {
        let (end, mut here, mut step) = (if stable { Critical::MOST } else { LEAST }, start, FIRST);
        let mut pace: Option<f64> = None;
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
                    if step > SMALL * here.factor {
                        pace = None;
                    }
                }
                None => {
                    if step <= SMALL * here.factor {
                        let (force, _) = self.statics.loads(&here.state);
                        // what is free may move as well, but loads do no work on it
                        let now = dot(&force, &self.direction(&mut here)?).abs();
                        let before = *pace.get_or_insert(now);
                        if step <= CLOSE * here.factor {
                            // it may also end where Newton's method does
                            let limit = (now > FASTER * before).then_some(to);
                            return Ok((here, limit, false));
                        }
                    }
                    step *= 0.5;
                }
            }
        }
        Ok((here, None, false))
    }

    /// Where the path goes from a place, per factor.
    fn direction(&mut self, from: &mut Place) -> Result<Vec<f64>, ModesError> {
        let (force, _) = self.statics.loads(&from.state);
        from.pencil.answer(&force).map_err(ModesError::Solver)
    }

    /// The equilibrium at another factor of the loads, and whether it was easy to find; `None` where it leads too far, and
    /// where there is none.
    fn step(&mut self, from: &mut Place, to: f64) -> Result<Option<(Place, bool)>, ModesError> {
        let (d, by) = (self.direction(from)?, to - from.factor);
        let way = by.abs() * size(self.model, &d[..self.model.velocities()]);
        if !(way <= LONG) {
            return Ok(None);
        }
        let mut state = from.state.clone();
        self.advance(&mut state, by, &d);
        // there is none where the matrix is singular
        let Ok(Some(corrections)) = self.close(&mut state, to, ASTRAY[0] * way + ASTRAY[1]) else {
            return Ok(None);
        };
        Ok(self.place(state, to).map(|place| (place, corrections <= EASY)))
    }

    /// `None` where the solver doesn't know how many directions are lost.
    fn place(&mut self, state: State, factor: f64) -> Option<Place> {
        let pencil = self.pencil(&state, factor).ok()?;
        pencil.below().map(|lost| Place { state, factor, pencil, lost })
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
