//! How far all loads may grow until the equilibrium tips over: by following it, where directions that fall over can be
//! counted, and else by linear buckling.
//!
//! With the loads at `p` times what they are, `p` near 1, the equilibrium moves by `(p - 1) x'` and its stiffness is
//! `K + (p - 1) K'`; the critical factor makes that singular. Both derivatives are taken at the equilibrium itself: `x'`
//! by one solution, `K'` along it by central differences. For a straight column that is Euler's problem; where shape
//! or forces don't change in proportion to the loads it is an estimate, the better the closer the factor is to 1.

use super::krylov::{Arnoldi, Operator, Ritz};
use super::loading::{Followed, Loading, size, stiffness};
use super::outcome::{Critical, Mode, ModesError, Raw, finish};
use super::pencil::Pencil;
use crate::model::Model;
use crate::model::state::State;
use crate::solve::linear::SolveError;
use crate::solve::statics::Statics;

/// What holds that which moves freely where directions are counted, in parts of the softest stiffness; at most; and in roundings
/// of the stiffest.
const HELD: f64 = 1e-2;
const MOST_HELD: f64 = 0.1;
const NOISE: f64 = 256.0;
/// Size of the differences by which `K'` is found, in lengths of the model and radians.
const DIFFERENCE: f64 = 1e-3;
/// Inverse of the largest factor, less 1, that is looked for.
const LEAST: f64 = 1.0 / Critical::MOST;
/// Start vectors, as round columns tip over in two ways at once.
const STARTS: usize = 4;
const MOST_TURNS: usize = 200;
/// How near to a critical factor the stiffness is looked at, by the loads that are added until then; stages on the way there.
const NEAR: f64 = 0.9;
const STAGES: usize = 4;
/// What is left of it there at most: a tenth, if it falls with the loads.
const GONE: f64 = 0.5;

/// `-K⁻¹ K'`, whose eigenvalues are `1/(p - 1)`.
struct Growth<'a> {
    p: &'a mut Pencil,
    by_load: Vec<f64>,
    shift: f64,
}

impl Operator for Growth<'_> {
    fn len(&self) -> usize {
        self.p.len()
    }
    fn apply(&mut self, x: &[f64], y: &mut [f64]) -> Result<(), SolveError> {
        self.p.structure().multiply(&self.by_load, x, y);
        self.p.load(y);
        y.iter_mut().for_each(|y| *y = -*y);
        self.p.solve(y)
    }
    fn weigh(&mut self, x: &[f64], y: &mut [f64]) {
        self.p.mass(x, y);
    }
    fn restrict(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        self.p.factor(0.0, self.p.fastest)?;
        self.p.restrict(x)?;
        self.p.factor(0.0, self.shift)
    }
}

/// The critical factor of the loads about the equilibrium in `state`, of which these modes are known; `None` without
/// loads, and where nothing resists them.
pub(super) fn critical(
    statics: &mut Statics<'_>,
    model: &Model,
    state: &State,
    pencil: &mut Pencil,
    modes: &[Mode],
) -> Result<Option<Critical>, ModesError> {
    let (force, own) = statics.loads(state);
    let loads: Vec<String> = {
        let all = model.terms().iter().filter(|t| t.is_load());
        all.filter(|t| model.share_of(t.as_ref(), &state.at()).iter().any(|r| *r != 0.0))
            .map(|t| t.label())
            .collect()
    };
    let square = |m: &Mode| m.growth * m.growth + m.omega * m.omega;
    let softest = modes.iter().filter(|m| !m.rigid).map(square).fold(f64::INFINITY, f64::min);
    if loads.is_empty() || softest.is_infinite() || force.iter().any(|r| !r.is_finite()) {
        return Ok(None);
    }
    // what moves freely is held by hardly anything, but by more than rounding, so that it isn't taken for what falls over
    let free = modes.iter().any(|m| m.rigid);
    let noise = NOISE * f64::EPSILON * pencil.fastest;
    let shift = if free { (HELD * softest).max(noise) } else { 0.0 };
    let mut loading = Loading { statics, model, shift, softest };
    let stable = !modes.iter().any(Mode::is_unstable);
    let followed = if shift <= MOST_HELD * softest { loading.follow(state, stable)? } else { None };
    let (found, safe) = match followed {
        Some(Followed { lost, safe }) => (lost, Some(safe)),
        None => {
            loading.shift = if free { 1e-9 * softest } else { 0.0 };
            (linear(&mut loading, state, pencil, (&force, own), stable)?, None)
        }
    };
    let (factor, shape) = match found {
        None => (None, None),
        Some((factor, x)) => {
            let raw = Raw { rate: [0.0; 2], rigid: false, shape: [x, Vec::new()], residual: 0.0, left: 1.0 };
            (Some(factor), Some(finish(model, pencil, raw)))
        }
    };
    Ok(Some(Critical { loads, factor, shape, safe }))
}

/// The factor and the shape by linear buckling, for matrices in whose pivots nothing is counted; the loads as residual and
/// stiffness.
fn linear(
    loading: &mut Loading<'_, '_>,
    state: &State,
    pencil: &mut Pencil,
    (force, own): (&[f64], Vec<f64>),
    stable: bool,
) -> Result<Option<(f64, Vec<f64>)>, ModesError> {
    pencil.factor(0.0, loading.shift).map_err(ModesError::Solver)?;
    let d = pencil.answer(force).map_err(ModesError::Solver)?;
    let by_load = stiffness_by_load(loading.statics, loading.model, state, &d, own);
    if by_load.iter().any(|x| !x.is_finite()) {
        return Ok(None);
    }
    let found = search(&mut Growth { p: pencil, by_load, shift: loading.shift }, stable)?;
    match found {
        Some(found) if gives_way(loading, state, &d, &found)? => Ok(Some(found)),
        _ => Ok(None),
    }
}

/// Whether the stiffness against a shape is all but gone shortly before the loads reach a factor. That of the linear equations may
/// be none: where what is stiff turns, as along a bent cable, `K + (p - 1) K'` is singular after a turn by the root of how much
/// stiffer it is.
fn gives_way(
    loading: &mut Loading<'_, '_>,
    state: &State,
    d: &[f64],
    (factor, shape): &(f64, Vec<f64>),
) -> Result<bool, ModesError> {
    let (mut there, mut at) = (state.clone(), 1.0);
    let before = stiffness(&mut loading.pencil(state, at)?, &mut shape.clone())?;
    for k in 1..=STAGES {
        let to = 1.0 + NEAR * (factor - 1.0) * k as f64 / STAGES as f64;
        loading.advance(&mut there, to - at, d);
        at = to;
        // it may be lost before
        if loading.close(&mut there, at, f64::INFINITY)?.is_none() {
            return Ok(true);
        }
    }
    let after = stiffness(&mut loading.pencil(&there, at)?, &mut shape.clone())?;
    Ok(after.abs() < GONE * before.abs())
}

/// `K'`: its change along the path of equilibria, whose direction is `d`, and the loads' own part.
fn stiffness_by_load(
    statics: &mut Statics<'_>,
    model: &Model,
    state: &State,
    d: &[f64],
    own: Vec<f64>,
) -> Vec<f64> {
    let (moves, multipliers) = d.split_at(model.velocities());
    let size = size(model, moves);
    let step = if size > DIFFERENCE { DIFFERENCE / size } else { 1.0 };
    let mut at = |step: f64| {
        let mut there = state.clone();
        let d: Vec<f64> = moves.iter().map(|x| step * x).collect();
        model.retract(&state.q, &d, &mut there.q);
        there.lambda.iter_mut().zip(multipliers).for_each(|(l, m)| *l += step * m);
        statics.linearise(&there).stiffness
    };
    let (ahead, behind) = (at(step), at(-step));
    let mut sum = own;
    for ((sum, a), b) in sum.iter_mut().zip(&ahead).zip(&behind) {
        *sum += (a - b) / (2.0 * step);
    }
    sum
}

/// The factor and the shape that goes with it.
fn search(growth: &mut Growth<'_>, stable: bool) -> Result<Option<(f64, Vec<f64>)>, ModesError> {
    let mut space = Arnoldi::default();
    let mut closed = false;
    for _ in 0..STARTS {
        closed |= !space.start(growth).map_err(ModesError::Solver)?;
    }
    let (mut next_look, mut before) = (6 * STARTS, None);
    loop {
        while space.turns() < next_look && !space.is_closed() {
            space.step(growth).map_err(ModesError::Solver)?;
        }
        if space.is_closed() && !closed {
            closed = !space.start(growth).map_err(ModesError::Solver)?;
            continue;
        }
        closed &= space.is_closed();
        let all = space.ritz(false, 64).ok_or(ModesError::Eigen)?;
        let factor = |r: &Ritz| 1.0 + 1.0 / r.value[0];
        let real = |r: &&Ritz| r.value[1].abs() <= 1e-6 * r.size();
        let counts = |r: &&Ritz| match stable {
            true => r.value[0] > LEAST,
            false => r.value[0] > LEAST || r.value[0] < -1.0 - LEAST,
        };
        let first = all.iter().filter(real).filter(counts).min_by(|a, b| factor(a).total_cmp(&factor(b)));
        let fine = |r: &Ritz| r.residual <= 1e-8 * r.size();
        // all that may come before the first are known as well
        let known = first.is_none_or(|first| {
            all.iter().filter(counts).all(|r| fine(r) || factor(r) > factor(first)) && fine(first)
        });
        let now = first.map(factor);
        let same = before.is_some_and(|old: Option<f64>| match (old, now) {
            (Some(a), Some(b)) => (a - b).abs() <= 1e-9 * a.abs(),
            (a, b) => a == b,
        });
        if closed || (known && same) {
            return Ok(first.map(|r| (factor(r), space.vector(&r.vector)[0].clone())));
        }
        if space.turns() >= MOST_TURNS {
            return Ok(None);
        }
        before = known.then_some(now);
        next_look = space.turns() + 3 * STARTS;
    }
}
