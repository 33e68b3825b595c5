//! `(λ² M + λ C + K) x + Gᵀμ = 0`, `G x = 0`: with damping or in a frame that turns, by the shift-inverted Arnoldi method
//! for displacements and velocities together.

use super::align::{align, in_phase};
use super::krylov::{Arnoldi, Operator, Ritz, dot};
use super::outcome::{Found, ModesError, Raw, Watch};
use super::pencil::Pencil;
use super::undamped::shift;
use crate::solve::linear::SolveError;

/// `(A - σ B)⁻¹ B` of `λ x = v`, `λ M v = -K x - C v - Gᵀμ`, for vectors of displacements over velocities.
struct Inverse<'a> {
    p: &'a mut Pencil,
    /// The shift σ [1/s].
    shift: f64,
    /// Weight of displacements against velocities in the inner product [1/s²].
    weight: f64,
    scratch: Vec<f64>,
}

impl Operator for Inverse<'_> {
    fn len(&self) -> usize {
        2 * self.p.len()
    }
    fn apply(&mut self, z: &[f64], out: &mut [f64]) -> Result<(), SolveError> {
        let n = self.p.len();
        let ((x, v), (y, w)) = (z.split_at(n), out.split_at_mut(n));
        // (K + σ C + σ² M) y = -(M v + C x + σ M x), w = x + σ y
        self.scratch.resize(n, 0.0);
        let sum: Vec<f64> = x.iter().zip(v).map(|(x, v)| v + self.shift * x).collect();
        self.p.mass(&sum, y);
        self.p.damping(x, &mut self.scratch);
        y.iter_mut().zip(&self.scratch).for_each(|(y, c)| *y = -*y - c);
        self.p.solve(y)?;
        for i in 0..n {
            w[i] = x[i] + self.shift * y[i];
        }
        Ok(())
    }
    fn weigh(&mut self, z: &[f64], out: &mut [f64]) {
        let n = self.p.len();
        let ((x, v), (y, w)) = (z.split_at(n), out.split_at_mut(n));
        self.p.mass(x, y);
        y.iter_mut().for_each(|y| *y *= self.weight);
        self.p.mass(v, w);
    }
    fn restrict(&mut self, z: &mut [f64]) -> Result<(), SolveError> {
        self.p.factor(0.0, self.p.fastest)?;
        let (x, v) = z.split_at_mut(self.p.len());
        self.p.restrict(x)?;
        self.p.restrict(v)?;
        // displacements against velocities as their weight asks
        x.iter_mut().for_each(|x| *x /= self.weight.sqrt().max(f64::MIN_POSITIVE));
        self.p.factor(self.shift, self.shift * self.shift)
    }
}

/// Start vectors: of what occurs more often, those that are added find the rest.
const STARTS: usize = 2;
/// What is left of an approximation, in parts of it, that is no eigenvalue to be: where eigenvectors aren't orthogonal,
/// the first few products of a start vector have values of their own.
const ROUGH: f64 = 1e-3;
/// The frequency that rounding gives a double real eigenvalue, in parts of it.
const SPLIT: f64 = 1e-6;

/// The `count` modes with the smallest `|λ|`, or all if there are fewer. `kinds` says of each unknown along which
/// direction it moves.
pub(super) fn find(
    p: &mut Pencil,
    count: usize,
    kinds: &[usize],
    watch: &mut Watch<'_>,
) -> Result<Found, ModesError> {
    let weight = shift(p)?;
    let sigma = 0.5 * weight.sqrt();
    p.factor(sigma, sigma * sigma).map_err(ModesError::Solver)?;
    let mut op = Inverse { p, shift: sigma, weight, scratch: Vec::new() };
    let mut space = Arnoldi::default();
    let mut closed = false;
    for _ in 0..STARTS {
        closed |= !space.start(&mut op).map_err(ModesError::Solver)?;
    }
    let (mut next_look, mut tried) = ((4 * count).min(60), None::<Vec<[f64; 2]>>);
    // turns at which all of the wanted were first there, and from which the latest start vector has come so far, two thirds
    // of what the first ones took, that none of the wanted is rough any more
    let (mut starts, mut first, mut deep) = (STARTS, None, usize::MAX);
    // displacements and velocities of all motions; what a larger space holds is rounding
    let whole = 2 * op.p.motions;
    let all = loop {
        while space.turns() < next_look.min(whole) && !space.is_closed() {
            space.step(&mut op).map_err(ModesError::Solver)?;
        }
        if space.is_closed() && !closed {
            closed = !space.start(&mut op).map_err(ModesError::Solver)?;
            continue;
        }
        closed = closed && space.is_closed() || space.turns() >= whole;
        let mut all = space.ritz(false, 2 * count + 8).ok_or(ModesError::Eigen)?;
        let rough = if space.turns() >= deep { ROUGH } else { f64::INFINITY };
        all.retain(|r| r.size() > 0.0 && r.residual <= rough * r.size());
        all.sort_by(|a, b| size(rate(a, sigma)).total_cmp(&size(rate(b, sigma))));
        let good = all.iter().take_while(|r| r.residual <= 1e-9 * r.size()).count();
        watch.look(good.min(count), count, space.turns())?;
        if closed {
            break all;
        }
        if good < count.min(all.len()) || all.len() < count {
            // a look costs as much as some dozens of turns, and a space that is a third too large little more
            next_look = space.turns() + (space.turns() / 3).max(16);
            if space.turns() > 20 * count + 400 {
                return Err(ModesError::NotFound { found: good, wanted: count });
            }
            continue;
        }
        // no law of inertia here: another start vector shows what the first ones held too little of
        let now: Vec<[f64; 2]> = all.iter().take(count).map(|r| rate(r, sigma)).collect();
        if tried.is_some_and(|old| same(&old, &now, sigma)) {
            break all;
        }
        // they take turns
        starts += 1;
        deep = space.turns() + starts * *first.get_or_insert(space.turns()) / 3;
        tried = Some(now);
        closed |= !space.start(&mut op).map_err(ModesError::Solver)?;
        next_look = space.turns() + 8;
    };
    let mut modes = collect(op.p, &all, &space, count, [sigma, weight.sqrt()])?;
    align(op.p, kinds, &mut modes, 1e-8);
    let of = closed.then_some(modes.len());
    Ok(Found { modes, missing: None, of })
}

/// Whether the lowest eigenvalues are those of an earlier look.
fn same(old: &[[f64; 2]], now: &[[f64; 2]], sigma: f64) -> bool {
    let near =
        |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) <= 1e-6 * (size(*a) + 1e-3 * sigma);
    old.len() == now.len() && old.iter().zip(now).all(|(a, b)| near(a, b))
}

/// The first `count` modes among the eigenvalues of the space.
fn collect(
    p: &mut Pencil,
    all: &[Ritz],
    space: &Arnoldi,
    count: usize,
    [sigma, scale]: [f64; 2],
) -> Result<Vec<Raw>, ModesError> {
    let mut modes: Vec<Raw> = Vec::new();
    for ritz in all {
        if modes.len() == count {
            break;
        }
        let mode = raw(p, rate(ritz, sigma), scale, space.vector(&ritz.vector))?;
        // rounding of what has no finite rate, in a space that holds everything
        if !(mode.residual <= 1e-3) {
            continue;
        }
        if !mode.rigid {
            apart(p, mode, &mut modes);
            continue;
        }
        // rest and steady motion of a rigid mode are two eigenvalues with one shape; a pair may hold two shapes
        for part in &mode.shape {
            if let Some(x) = unit(p, part).filter(|_| modes.len() < count) {
                let new = Raw { shape: [x, Vec::new()], ..mode };
                if !is_known(p, &new, &modes) {
                    modes.push(new);
                }
            }
        }
    }
    modes.truncate(count);
    Ok(modes)
}

/// Adds a mode: two that go one way only, where rounding made a pair of what are two real eigenvalues of one value.
fn apart(p: &Pencil, mode: Raw, modes: &mut Vec<Raw>) {
    let [growth, omega] = mode.rate;
    if omega == 0.0 || omega > SPLIT * growth.abs() {
        modes.push(mode);
        return;
    }
    let shapes = mode.shape.iter().filter_map(|part| unit(p, part)).collect::<Vec<_>>();
    modes.extend(shapes.into_iter().map(|x| Raw { rate: [growth, 0.0], shape: [x, Vec::new()], ..mode }));
}

/// `λ = σ + 1/θ`.
fn rate(r: &Ritz, sigma: f64) -> [f64; 2] {
    let [re, im] = r.value;
    let square = re * re + im * im;
    [sigma + re / square, (im / square).abs()]
}

fn size([re, im]: [f64; 2]) -> f64 {
    re.hypot(im)
}

/// A mode with this eigenvalue; its shape stands in the first half of the vector, which is brought to the phase in
/// which the real part is largest. `scale` is the size of the lowest eigenvalues that aren't zero.
fn raw(p: &mut Pencil, rate: [f64; 2], scale: f64, vector: [Vec<f64>; 2]) -> Result<Raw, ModesError> {
    let n = p.len();
    let half = |x: &Vec<f64>| if x.is_empty() { vec![0.0; n] } else { x[..n].to_vec() };
    // 1/θ with θ in the upper half plane lies in the lower one: the conjugate belongs to what is reported
    let (re, im): (Vec<f64>, Vec<f64>) = (half(&vector[0]), half(&vector[1]).iter().map(|x| -x).collect());
    let [a, b] = in_phase(p, [re, im]);
    let mut y = vec![0.0; n];
    // rounding moves a double zero by its root
    let [(k_a, n_a), (k_b, n_b)] = [p.energy(&a), p.energy(&b)];
    // entries that cancel leave more than their own rounding: what would swing slower than a zero rate is free too
    let (slow, noise) = (1e-6 * scale, super::ZERO * (n_a + n_b));
    let free = k_a.abs() + k_b.abs() <= noise + slow * slow;
    // of what hardly has a mass, such as the spin of a cable, that root is large
    let rigid = free && size(rate) <= slow.max(noise.sqrt().min(0.1 * scale));

    // what is left of the equations, as a displacement against the shape
    let (l_re, l_im) = (rate[0], rate[1]);
    let (s_re, s_im) = (l_re * l_re - l_im * l_im, 2.0 * l_re * l_im);
    let mut over = [vec![0.0; n], vec![0.0; n]];
    for (k, x) in [&a, &b].into_iter().enumerate() {
        let other = 1 - k;
        // i² = -1
        let sign = if k == 0 { 1.0 } else { -1.0 };
        for (matrix, same, cross) in [(0, 1.0, 0.0), (1, l_re, l_im), (2, s_re, s_im)] {
            match matrix {
                0 => p.stiffness(x, &mut y),
                1 => p.damping(x, &mut y),
                _ => p.mass(x, &mut y),
            }
            over[k].iter_mut().zip(&y).for_each(|(l, y)| *l += same * y);
            over[other].iter_mut().zip(&y).for_each(|(l, y)| *l += sign * cross * y);
        }
    }
    let mut residual = 0.0;
    for l in &mut over {
        p.solve(l).map_err(ModesError::Solver)?;
        p.mass(l, &mut y);
        residual += dot(l, &y).max(0.0);
    }
    let rate = if rigid { [0.0, 0.0] } else { rate };
    let left = (k_a.abs() + k_b.abs()) * f64::EPSILON / (n_a + n_b);
    Ok(Raw { rate, rigid, shape: [a, b], residual: residual.sqrt(), left })
}

/// The vector at unit size in the norm of the mass; `None` of rounding.
fn unit(p: &Pencil, x: &[f64]) -> Option<Vec<f64>> {
    let mut y = vec![0.0; x.len()];
    p.mass(x, &mut y);
    let size = dot(x, &y).max(0.0).sqrt();
    (size > 1e-3).then(|| x.iter().map(|x| x / size).collect())
}

/// Whether a rigid shape lies in the span of those found before.
fn is_known(p: &Pencil, new: &Raw, before: &[Raw]) -> bool {
    let mut y = vec![0.0; p.len()];
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut left = 1.0;
    for mode in before.iter().filter(|m| m.rigid).chain([new]) {
        let mut v = mode.shape[0].clone();
        for b in &basis {
            p.mass(b, &mut y);
            let along = dot(&v, &y);
            v.iter_mut().zip(b).for_each(|(v, b)| *v -= along * b);
        }
        p.mass(&v, &mut y);
        left = dot(&v, &y).max(0.0).sqrt();
        v.iter_mut().for_each(|v| *v /= left);
        basis.push(v);
    }
    left <= 1e-3
}
