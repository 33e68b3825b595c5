//! Kinematics of the element: Hermite shape functions and the natural variables Δ, α, β.
//!
//! The curve of an element is the cubic through its end positions with its end slopes,
//! `r(ξ) = S₁ r₁ + S₂ r₁' + S₃ r₂ + S₄ r₂'` with `ξ = x/L` (Berzeri & Shabana, J. Sound Vib. 235, 2000). The twelve
//! dofs are ordered `e = [r₁, r₁', r₂, r₂']`.
//!
//! Elastic forces don't depend on where the element is, so the kernels work with nine numbers instead of twelve:
//! the mean slope `Δ = (r₂ - r₁)/L` and how much the end slopes differ from it, `α = r₁' - Δ` and `β = r₂' - Δ`.
//! The position enters through `r₂ - r₁` alone: far from the origin nothing is lost but the rounding of `r` itself.

use ropewalk_core::{Real, V3};

/// The natural variables `[Δ, α, β]`, their rates, or forces conjugate to them.
pub type Natural<R> = [V3<R>; 3];

/// Shape functions `S₁ … S₄` at `xi` of an element of length `l`.
#[inline(always)]
pub fn hermite<R: Real>(xi: f64, l: R) -> [R; 4] {
    let (s2, s4) = (xi * (1.0 - xi) * (1.0 - xi), xi * xi * (xi - 1.0));
    let s3 = xi * xi * (3.0 - 2.0 * xi);
    [R::of(1.0 - s3), l * R::of(s2), R::of(s3), l * R::of(s4)]
}

/// Their derivatives by arc length, `S₁' … S₄'`; `il = 1/L`.
#[inline(always)]
pub fn hermite_slope<R: Real>(xi: f64, il: R) -> [R; 4] {
    let s = il * R::of(6.0 * xi * (1.0 - xi));
    [-s, R::of((1.0 - xi) * (1.0 - 3.0 * xi)), s, R::of(xi * (3.0 * xi - 2.0))]
}

/// `[Δ, α, β]` of the twelve dofs, or their rates if `e` holds velocities; `il = 1/L`.
#[inline(always)]
pub fn natural<R: Real>(e: &[R; 12], il: R) -> Natural<R> {
    let mut q = [[R::zero(); 3]; 3];
    for c in 0..3 {
        q[0][c] = (e[6 + c] - e[c]) * il;
        q[1][c] = e[3 + c] - q[0][c];
        q[2][c] = e[9 + c] - q[0][c];
    }
    q
}

/// `Σ c_i q_i`: the slope `r'` for `c = phi`.
#[inline(always)]
pub fn combine<R: Real>(c: &[f64; 3], q: &Natural<R>) -> V3<R> {
    let mut p = q[0];
    for i in 0..3 {
        p[i] = R::of(c[0]).fma(q[0][i], R::of(c[1]).fma(q[1][i], R::of(c[2]) * q[2][i]));
    }
    p
}

/// Second derivative `r'' = (ψ₁ α + ψ₂ β)/L`.
#[inline(always)]
pub fn second<R: Real>(psi: &[f64; 2], il: R, q: &Natural<R>) -> V3<R> {
    let mut d = q[1];
    for i in 0..3 {
        d[i] = il * R::of(psi[0]).fma(q[1][i], R::of(psi[1]) * q[2][i]);
    }
    d
}

/// Scalar product over all nine natural variables.
#[inline(always)]
pub fn dot9<R: Real>(a: &Natural<R>, b: &Natural<R>) -> R {
    let mut sum = R::zero();
    for i in 0..3 {
        for c in 0..3 {
            sum = a[i][c].fma(b[i][c], sum);
        }
    }
    sum
}
