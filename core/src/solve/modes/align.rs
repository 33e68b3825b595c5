//! Shapes of one frequency, of which any mixture is a mode too: each is turned to move along one direction as far as
//! possible, so that a picture is easy to read and no rounding chooses it.

use super::krylov::dot;
use super::outcome::{Raw, direction};
use super::pencil::Pencil;
use crate::model::Model;
use faer::{Mat, Side, c64};

/// Of each unknown in elimination order, along which of [`directions`](super::Mode::directions) it moves.
pub(super) fn kinds(model: &Model, pencil: &Pencil) -> Vec<usize> {
    let mut kinds = vec![0; pencil.len()];
    for node in model.nodes() {
        for (i, dof) in node.dofs().enumerate() {
            kinds[pencil.structure().position[dof]] = direction(node, i).unwrap_or(0);
        }
    }
    kinds
}

/// Turns shapes of the same rate, which follow each other; `same` is how far rates may differ, relative to their size.
pub(super) fn align(p: &Pencil, kinds: &[usize], all: &mut [Raw], same: f64) {
    let mut first = 0;
    while first < all.len() {
        let [re, im] = all[first].rate;
        let alike = |m: &Raw| match (m.rigid, all[first].rigid) {
            (false, false) => (m.rate[0] - re).hypot(m.rate[1] - im) <= same * re.hypot(im),
            (a, b) => a && b,
        };
        let end = (first + 1..all.len()).find(|&k| !alike(&all[k])).unwrap_or(all.len());
        if end - first > 1 {
            turn(p, kinds, &mut all[first..end]);
        }
        first = end;
    }
}

/// Diagonalises the energy weighted by direction.
fn turn(p: &Pencil, kinds: &[usize], all: &mut [Raw]) {
    let real = all.iter().all(|m| m.shape[1].is_empty());
    let full = |m: &Raw| {
        let imaginary = (0..p.len()).map(|i| m.shape[1].get(i).copied().unwrap_or(0.0));
        m.shape[0].iter().zip(imaginary).map(|(re, im)| c64::new(*re, im)).collect()
    };
    let Some(basis) = orthonormal(p, all.iter().map(full).collect()) else { return };
    let scaled: Vec<Vec<c64>> = basis
        .iter()
        .map(|z| weighed(p, z).iter().zip(kinds).map(|(y, k)| y * (1 + k) as f64).collect())
        .collect();
    let n = all.len();
    let h = Mat::from_fn(n, n, |i, j| {
        0.5 * (product(&basis[i], &scaled[j]) + product(&basis[j], &scaled[i]).conj())
    });
    let Ok(eigen) = h.self_adjoint_eigen(Side::Lower) else { return };
    for (k, mode) in all.iter_mut().enumerate() {
        let mut x = vec![c64::new(0.0, 0.0); p.len()];
        for (i, z) in basis.iter().enumerate() {
            let part = eigen.U()[(i, k)];
            x.iter_mut().zip(z).for_each(|(x, z)| *x += part * z);
        }
        let [re, im] = in_phase(p, [|z: &c64| z.re, |z: &c64| z.im].map(|f| x.iter().map(f).collect()));
        mode.shape = [re, if real { Vec::new() } else { im }];
    }
}

/// Brings a shape to unit size in the norm of the mass, and to the phase in which its real part is largest.
pub(super) fn in_phase(p: &Pencil, [re, im]: [Vec<f64>; 2]) -> [Vec<f64>; 2] {
    let mut y = vec![0.0; p.len()];
    let mut product = |a: &[f64], b: &[f64]| {
        p.mass(b, &mut y);
        dot(a, &y)
    };
    let (rr, ii, ri) = (product(&re, &re), product(&im, &im), product(&re, &im));
    let (mass, turn) = (rr + ii, 0.5 * (2.0 * ri).atan2(rr - ii));
    let (cos, sin) = (turn.cos() / mass.sqrt(), turn.sin() / mass.sqrt());
    let both = || re.iter().zip(&im);
    [both().map(|(r, i)| cos * r + sin * i).collect(), both().map(|(r, i)| cos * i - sin * r).collect()]
}

/// `M z`.
fn weighed(p: &Pencil, z: &[c64]) -> Vec<c64> {
    let [re, im] = [|z: &c64| z.re, |z: &c64| z.im].map(|f| {
        let (x, mut y): (Vec<f64>, _) = (z.iter().map(f).collect(), vec![0.0; z.len()]);
        p.mass(&x, &mut y);
        y
    });
    re.into_iter().zip(im).map(|(re, im)| c64::new(re, im)).collect()
}

/// `aᴴ b`.
fn product(a: &[c64], b: &[c64]) -> c64 {
    a.iter().zip(b).fold(c64::new(0.0, 0.0), |sum, (a, b)| sum + a.conj() * b)
}

/// An orthonormal basis in the norm of the mass of what the vectors span; `None` if one depends on others.
fn orthonormal(p: &Pencil, mut all: Vec<Vec<c64>>) -> Option<Vec<Vec<c64>>> {
    for k in 0..all.len() {
        let (before, rest) = all.split_at_mut(k);
        let z = &mut rest[0];
        let size = |z: &[c64]| product(z, &weighed(p, z)).re.max(0.0).sqrt();
        let whole = size(z);
        // twice is enough
        for b in before.iter().chain(before.iter()) {
            let along = product(b, &weighed(p, z));
            z.iter_mut().zip(b).for_each(|(z, b)| *z -= along * b);
        }
        let left = size(z);
        if !(left > 1e-3 * whole) {
            return None;
        }
        z.iter_mut().for_each(|z| *z *= 1.0 / left);
    }
    Some(all)
}
