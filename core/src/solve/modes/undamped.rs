//! `(K - ω² M) x + Gᵀμ = 0`, `G x = 0`: without forces that depend on velocity, by the shift-inverted Lanczos method.

use super::align::align;
use super::krylov::{Arnoldi, Operator, Ritz, dot};
use super::outcome::{Found, ModesError, Raw, Watch};
use super::pencil::Pencil;
use crate::solve::linear::SolveError;

/// `(K + m M)⁻¹ M`, in the inner product of the mass, with the shift `m`.
struct Inverse<'a>(&'a mut Pencil, f64);

impl Operator for Inverse<'_> {
    fn len(&self) -> usize {
        self.0.len()
    }
    fn apply(&mut self, x: &[f64], y: &mut [f64]) -> Result<(), SolveError> {
        self.0.mass(x, y);
        self.0.solve(y)
    }
    fn weigh(&mut self, x: &[f64], y: &mut [f64]) {
        self.0.mass(x, y);
    }
    fn restrict(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        self.0.factor(0.0, self.0.fastest)?;
        self.0.restrict(x)?;
        self.0.factor(0.0, self.1)
    }
}

/// How many start vectors: bending of a straight cable in space has all its frequencies twice.
const STARTS: usize = 4;
/// How far a shift goes aside from where the matrix is singular, and how often.
const ASIDE: f64 = 1.37;
const MOST_ASIDE: usize = 4;
/// How near to an eigenvalue a shift is beside it, in parts of the shift.
const BESIDE: f64 = 0.1;

/// A shift `m` [1/s²] near the lowest eigenvalue that isn't zero: above zero, so that free parts don't make the matrix
/// singular, and not far above the eigenvalues that are asked for. Leaves `K + m M` factored.
pub(super) fn shift(p: &mut Pencil) -> Result<f64, ModesError> {
    let (mut m, mut lowered, mut aside) = (guess(p).ok().flatten().unwrap_or(1e-6 * p.fastest), 0, 0);
    for _ in 0..12 {
        let seen = p.factor(0.0, m).map_err(ModesError::Solver).and_then(|()| lowest(p, m));
        // an unstable mode grows at just this rate, and would drown all others
        if aside < MOST_ASIDE && matches!(seen, Err(ModesError::Solver(_)) | Ok((_, true))) {
            (m, aside) = (ASIDE * m, aside + 1);
            continue;
        }
        let (lowest, _) = seen?;
        if lowest.is_finite() {
            if (0.1 * m..=10.0 * m).contains(&lowest) {
                break;
            }
            m = lowest.max(1e-20 * p.fastest);
        } else if lowered < 3 {
            (m, lowered) = (1e-4 * m, lowered + 1);
        } else {
            break;
        }
    }
    p.factor(0.0, m).map_err(ModesError::Solver)?;
    Ok(m)
}

/// About the lowest eigenvalue, by inverse iteration on a single vector with hardly any shift; nothing where that finds what has
/// next to none, such as free parts, or nothing that can be solved for.
fn guess(p: &mut Pencil) -> Result<Option<f64>, SolveError> {
    let m = 1e-12 * p.fastest;
    let mut space = Arnoldi::default();
    if !space.start(&mut Inverse(p, m))? {
        return Ok(None);
    }
    let [mut x, _] = space.vector(&[vec![1.0], Vec::new()]);
    let mut y = vec![0.0; x.len()];
    for _ in 0..3 {
        Inverse(p, m).apply(&x, &mut y)?;
        let size = dot(&y, &y).sqrt();
        x.iter_mut().zip(&y).for_each(|(x, y)| *x = y / size);
    }
    p.mass(&x, &mut y);
    let k = (p.energy(&x).0 / dot(&x, &y)).abs();
    Ok((k > 10.0 * m && k.is_finite()).then_some(k))
}

/// The lowest stiffness seen with the factored shift `m` that isn't zero beside it, infinite if there is none; and whether the shift
/// lies beside an eigenvalue.
fn lowest(p: &mut Pencil, m: f64) -> Result<(f64, bool), ModesError> {
    let mut space = Arnoldi::default();
    for _ in 0..STARTS {
        space.start(&mut Inverse(p, m)).map_err(ModesError::Solver)?;
    }
    loop {
        for _ in 0..2 * STARTS {
            if !space.is_closed() {
                space.step(&mut Inverse(p, m)).map_err(ModesError::Solver)?;
            }
        }
        let (mut lowest, mut beside) = (f64::INFINITY, false);
        let found = space.ritz(p.symmetric, 64).ok_or(ModesError::Eigen)?;
        for ritz in found.iter().filter(|r| r.residual <= 1e-4 * r.size()) {
            let parts = space.vector(&ritz.vector);
            let k: f64 = parts.iter().filter(|x| !x.is_empty()).map(|x| p.energy(x).0).sum();
            if k.abs() > 1e-6 * m {
                lowest = lowest.min(k.abs());
                beside |= (k + m).abs() < BESIDE * m;
            }
        }
        if lowest.is_finite() || space.is_closed() || space.turns() >= 80 {
            return Ok((lowest, beside));
        }
    }
}

/// The `count` lowest modes, or all if there are fewer. `kinds` says of each unknown along which direction it moves.
pub(super) fn find(
    p: &mut Pencil,
    count: usize,
    kinds: &[usize],
    watch: &mut Watch<'_>,
) -> Result<Found, ModesError> {
    let m = shift(p)?;
    let below = p.below().unwrap_or(0);
    let mut space = Arnoldi::default();
    let mut closed = false;
    for _ in 0..STARTS {
        closed |= !space.start(&mut Inverse(p, m)).map_err(ModesError::Solver)?;
    }
    let (mut next_look, mut tries, mut missing) = (count.min(40), 0, None);
    let (taken, ritz) = loop {
        while space.turns() < next_look && !space.is_closed() {
            space.step(&mut Inverse(p, m)).map_err(ModesError::Solver)?;
        }
        if space.is_closed() && !closed {
            closed = !space.start(&mut Inverse(p, m)).map_err(ModesError::Solver)?;
            continue;
        }
        closed &= space.is_closed();
        let mut all = space.ritz(true, 64).ok_or(ModesError::Eigen)?;
        // beyond this the projection shows what it doesn't hold yet
        all.retain(|r| r.value[0] != 0.0);
        all.sort_by(|a, b| square(a, m).total_cmp(&square(b, m)));
        let (taken, good) = settled(&all, count, below, m, closed);
        watch.look(taken.unwrap_or(good).min(count), count, space.turns())?;
        let Some(taken) = taken else {
            next_look = space.turns() + (space.turns() / 5).max(8);
            if space.turns() > 20 * count + 400 {
                return Err(ModesError::NotFound { found: good, wanted: count });
            }
            continue;
        };
        let Some(ahead) = all.get(taken) else { break (taken, all) };
        // Sylvester's law counts what lies below: whatever the start vectors held too little of shows
        let (last, ahead) = (square(&all[taken - 1], m), square(ahead, m));
        let between = 0.5 * (last + ahead.min(last + 0.01 * (last.abs() + m)));
        let there = p.factor(0.0, -between).map(|()| p.below());
        p.factor(0.0, m).map_err(ModesError::Solver)?;
        missing = match there {
            Ok(Some(n)) => Some(n.abs_diff(taken)),
            _ => None,
        };
        if missing.is_none_or(|n| n == 0) || tries >= 5 || closed {
            break (taken, all);
        }
        tries += 1;
        for _ in 0..missing.unwrap_or(0).min(2 * STARTS) {
            closed |= !space.start(&mut Inverse(p, m)).map_err(ModesError::Solver)?;
        }
        next_look = space.turns() + 2 * STARTS;
    };
    let all = ritz.len();
    let take = taken.min(count);
    let modes = ritz[..take].iter().map(|r| raw(p, space.vector(&r.vector)[0].clone()));
    let mut modes = modes.collect::<Result<Vec<_>, _>>()?;
    align(p, kinds, &mut modes, 5e-7);
    let of = closed.then_some(all);
    Ok(Found { modes, missing, of })
}

/// `ω²` of an eigenvalue `1 / (ω² + m)`.
fn square(r: &Ritz, m: f64) -> f64 {
    1.0 / r.value[0] - m
}

/// How many of the lowest are to be taken: `count` and what is equal to the last of them, once all of these are exact
/// enough; and how many are exact enough.
fn settled(all: &[Ritz], count: usize, below: usize, m: f64, closed: bool) -> (Option<usize>, usize) {
    let fine = |r: &Ritz| r.residual <= 1e-8 * r.size();
    if closed {
        return (Some(all.len().min(count.max(1))), all.len());
    }
    // far below the shift eigenvalues come last, from the other side
    let negative = all.iter().filter(|r| r.value[0] < 0.0).count();
    let good = all.iter().take_while(|r| fine(r)).count();
    if negative < below.min(count) || all.len() <= count {
        return (None, good);
    }
    let mut taken = count;
    while taken < all.len() {
        let (last, next) = (square(&all[taken - 1], m), square(&all[taken], m));
        if next - last > 1e-4 * (last.abs() + 1e-6 * m) {
            break;
        }
        taken += 1;
    }
    (((taken <= good) && taken < all.len()).then_some(taken), good)
}

/// A mode of this shape, with its frequency as Rayleigh's quotient.
fn raw(p: &mut Pencil, x: Vec<f64>) -> Result<Raw, ModesError> {
    let mut mx = vec![0.0; x.len()];
    p.mass(&x, &mut mx);
    let mass = dot(&x, &mx);
    let (k, noise) = p.energy(&x);
    let square = k / mass;
    let rigid = k.abs() <= super::ZERO * noise;
    let rate = match () {
        () if rigid => [0.0, 0.0],
        () if square < 0.0 => [(-square).sqrt(), 0.0],
        () => [0.0, square.sqrt()],
    };
    // what is left of the equations, as a displacement against the shape
    let mut over = vec![0.0; x.len()];
    p.stiffness(&x, &mut over);
    over.iter_mut().zip(&mx).for_each(|(r, mx)| *r -= square * mx);
    p.solve(&mut over).map_err(ModesError::Solver)?;
    let mut weighed = vec![0.0; x.len()];
    p.mass(&over, &mut weighed);
    let residual = (dot(&over, &weighed).max(0.0) / mass).sqrt();
    let left = k.abs() * f64::EPSILON / noise;
    Ok(Raw { rate, rigid, shape: [x, Vec::new()], residual, left })
}
