//! The twist of an element: how far the section at its end is turned about the tangent against that at its start.
//!
//! Of the unit vectors `t₁`, `D`, `t₂` (both tangents and the chord) and the directors and angles of both nodes it is
//!
//! `Φ = θ₂ - θ₁ + m + A`
//!
//! with the angle `m` between the reference directors, the one carried to the other by the smallest rotation of the
//! tangent, and `A = 4 V/a`, `V = D·(t₁×t₂)`, `a = 1 + t₁·D + D·t₂ + t₁·t₂`: twice the area of the triangle of the three on
//! the unit sphere, which is to leading order that between the great circle and the way of the tangent of a cubic. So the
//! twist is that against a frame without spin (Bishop, Am. Math. Mon. 82, 1975), with an error of fourth order. It is a
//! function of directions alone: neither a rigid rotation nor a stretch changes it, nor does the numbering of the nodes.
//!
//! Second derivatives are the symmetric ones along `q ⊕ d`.

use super::reduced::M3;
use ropewalk_core::rotation::cross;
use ropewalk_core::{Real, V3, dot};

/// Coordinates and velocities of the two nodes of an element with torsion.
pub(super) const COORDINATES: usize = 20;
/// See [`COORDINATES`].
pub(super) const VELOCITIES: usize = 14;
/// First velocity of the second node.
pub(super) const SECOND: usize = 7;

/// Second derivatives by the slope of the start, the chord `Δ`, and the slope of the end, block by block.
pub(super) type Blocks<R> = [[M3<R>; 3]; 3];

/// Three numbers of a list.
#[inline(always)]
pub(super) fn three<R: Copy>(x: &[R], from: usize) -> V3<R> {
    [x[from], x[from + 1], x[from + 2]]
}

/// `s a`
#[inline(always)]
pub(super) fn times<R: Real>(s: R, a: &V3<R>) -> V3<R> {
    [s * a[0], s * a[1], s * a[2]]
}

/// `a + s b`
#[inline(always)]
pub(super) fn plus<R: Real>(a: &V3<R>, s: R, b: &V3<R>) -> V3<R> {
    [s.fma(b[0], a[0]), s.fma(b[1], a[1]), s.fma(b[2], a[2])]
}

/// `A + s a bᵀ`
#[inline(always)]
pub(super) fn add_outer<R: Real>(to: &mut M3<R>, s: R, a: &V3<R>, b: &V3<R>) {
    for r in 0..3 {
        let sa = s * a[r];
        for c in 0..3 {
            to[r][c] = sa.fma(b[c], to[r][c]);
        }
    }
}

/// `A + s [a]×`
#[inline(always)]
pub(super) fn add_skew<R: Real>(to: &mut M3<R>, s: R, a: &V3<R>) {
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        to[i][j] -= s * a[k];
        to[j][i] += s * a[k];
    }
}

/// `A + s I`
#[inline(always)]
pub(super) fn add_unit<R: Real>(to: &mut M3<R>, s: R) {
    for i in 0..3 {
        to[i][i] += s;
    }
}

#[inline(always)]
pub(super) fn nought<R: Real>() -> M3<R> {
    [[R::zero(); 3]; 3]
}

/// The holonomy of the great circle from one tangent to another: by how much the angle between two directors grows when
/// both ride with their tangents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Holonomy<R> {
    t: [V3<R>; 2],
    /// One over the length of either slope.
    inverse: [R; 2],
    /// `(t₁ × t₂)/(1 + t₁·t₂)`: its derivative by either tangent.
    pub b: V3<R>,
    /// `1/(1 + t₁·t₂)`
    i: R,
}

impl<R: Real> Holonomy<R> {
    #[inline(always)]
    pub fn new(t: [V3<R>; 2], inverse: [R; 2]) -> Self {
        let i = R::of(1.0) / (R::of(1.0) + dot(&t[0], &t[1]));
        Holonomy { t, inverse, b: times(i, &cross(&t[0], &t[1])), i }
    }

    /// Derivative by either slope.
    #[inline(always)]
    pub fn gradient(&self) -> [V3<R>; 2] {
        self.inverse.map(|i| times(i, &self.b))
    }

    /// Adds `x` times the second derivative by the slopes: both alike, and mixed.
    #[inline(always)]
    pub fn add_hessian(&self, x: R, own: [&mut M3<R>; 2], mixed: &mut M3<R>) {
        let (half, s) = (R::of(0.5) * x, plus(&self.t[0], R::of(1.0), &self.t[1]));
        for (k, own) in own.into_iter().enumerate() {
            let z = plus(&self.t[k], self.i, &s);
            let w = -half * self.inverse[k] * self.inverse[k];
            add_outer(own, w, &self.b, &z);
            add_outer(own, w, &z, &self.b);
        }
        let w = half * self.i * self.inverse[0] * self.inverse[1];
        add_skew(mixed, w, &s);
        add_outer(mixed, -w, &self.b, &s);
        add_outer(mixed, -w, &s, &self.b);
    }
}

/// The twist of an element with all that its derivatives need.
#[derive(Clone, Copy, Debug)]
pub(super) struct Twisting<R> {
    /// `t₁`, `D`, `t₂`.
    pub e: [V3<R>; 3],
    /// One over the lengths of the slopes and of `Δ`.
    pub inverse: [R; 3],
    pub holonomy: Holonomy<R>,
    /// `4 V/a`
    pub area: R,
    /// `Φ`
    pub twist: R,
    /// `1/a` and `V`
    ia: R,
    v: R,
    /// Derivatives of the area by the unit vectors, and what of them is normal to them.
    by: [V3<R>; 3],
    across: [V3<R>; 3],
}

impl<R: Real> Twisting<R> {
    /// Of an element with these coordinates; `il = 1/L`.
    #[inline(always)]
    pub fn new(q: &[R; COORDINATES], il: R) -> Self {
        let all = Twisting::derivatives(q, il);
        let ([t1, _, t2], u1, u2) = (&all.e, three(q, 6), three(q, 16));
        let (w1, w2) = (cross(t1, &u1), cross(t2, &u2));
        let sine = dot(&w1, &u2) - dot(&u1, &w2);
        let cosine = R::of(1.0) + dot(&u1, &u2) + dot(&w1, &w2) + dot(t1, t2);
        let angle = R::each(|l| 2.0 * sine.lane(l).atan2(cosine.lane(l)));
        Twisting { twist: q[19] - q[9] + angle + all.area, ..all }
    }

    /// All but the twist itself: what has to do with its rate needs no more.
    #[inline(always)]
    pub fn derivatives(q: &[R; COORDINATES], il: R) -> Self {
        let one = R::of(1.0);
        let delta = [il * (q[10] - q[0]), il * (q[11] - q[1]), il * (q[12] - q[2])];
        let p = [three(q, 3), delta, three(q, 13)];
        let inverse =
            [one / dot(&p[0], &p[0]).sqrt(), one / dot(&p[1], &p[1]).sqrt(), one / dot(&p[2], &p[2]).sqrt()];
        let e = [times(inverse[0], &p[0]), times(inverse[1], &p[1]), times(inverse[2], &p[2])];
        let ([t1, chord, t2], c) = (&e, dot(&e[0], &e[2]));
        let (across_12, across_2d, across_d1) = (cross(t1, t2), cross(t2, chord), cross(chord, t1));
        let v = dot(chord, &across_12);
        let ia = one / (one + dot(t1, chord) + dot(chord, t2) + c);
        let (four, vi) = (R::of(4.0) * ia, -(v * ia));
        let by = [
            times(four, &plus(&across_2d, vi, &plus(chord, one, t2))),
            times(four, &plus(&across_12, vi, &plus(t1, one, t2))),
            times(four, &plus(&across_d1, vi, &plus(chord, one, t1))),
        ];
        let mut across = by;
        for i in 0..3 {
            across[i] = plus(&by[i], -dot(&by[i], &e[i]), &e[i]);
        }
        let holonomy = Holonomy::new([*t1, *t2], [inverse[0], inverse[2]]);
        let area = four * v;
        Twisting { e, inverse, holonomy, area, twist: R::zero(), ia, v, by, across }
    }

    /// `x` times the derivative of `m` and `y` times that of `A` by both slopes and `Δ`.
    #[inline(always)]
    pub fn gradient(&self, x: R, y: R) -> [V3<R>; 3] {
        let mut g = self.across;
        for i in 0..3 {
            g[i] = times(y * self.inverse[i], &self.across[i]);
        }
        let [one, two] = self.holonomy.gradient();
        (g[0], g[2]) = (plus(&g[0], x, &one), plus(&g[2], x, &two));
        g
    }

    /// Adds `x` times the second derivative of `m` and `y` times that of `A`: the blocks on the diagonal and above it.
    #[inline(always)]
    pub fn add_hessian(&self, x: R, y: R, out: &mut Blocks<R>) {
        let (mut first, mut last, mut mixed) = (out[0][0], out[2][2], out[0][2]);
        self.holonomy.add_hessian(x, [&mut first, &mut last], &mut mixed);
        (out[0][0], out[2][2], out[0][2]) = (first, last, mixed);
        let ([t1, chord, t2], one) = (&self.e, R::of(1.0));
        let (ia, vi) = (self.ia * y, self.v * self.ia);
        let four = R::of(4.0) * ia;
        // `a` has these sums for derivatives, of which only what is normal to each direction counts
        let sums = [plus(chord, one, t2), plus(t1, one, t2), plus(chord, one, t1)];
        let mut s = sums;
        for i in 0..3 {
            s[i] = plus(&sums[i], -dot(&sums[i], &self.e[i]), &self.e[i]);
        }
        for (i, j, k) in [(0, 1, 2), (0, 2, 1), (1, 2, 0)] {
            let (a, b, w) = (&self.e[i], &self.e[j], self.inverse[i] * self.inverse[j]);
            let f = &mut out[i][j];
            add_outer(f, -(ia * w), &self.across[i], &s[j]);
            add_outer(f, -(ia * w), &s[i], &self.across[j]);
            // P_a ([c]x - V/a I) P_b, by two outer products
            let (sign, w) = (if k == 1 { -one } else { one }, w * four);
            let (c, d) = (&self.e[k], vi * w);
            let turned = sign * w;
            add_skew(f, turned, c);
            add_unit(f, -d);
            let (left, right) = (cross(a, c), cross(c, b));
            let right = plus(&times(turned, &right), -d, b);
            let both = dot(a, &right);
            let right = plus(&right, -both, a);
            add_outer(f, -one, a, &plus(&times(turned, &left), -d, a));
            add_outer(f, -one, &right, b);
        }
        for i in 0..3 {
            let (e, w) = (&self.e[i], self.inverse[i] * self.inverse[i]);
            let f = &mut out[i][i];
            let along = y * w * dot(&self.by[i], e);
            add_unit(f, -along);
            add_outer(f, along, e, e);
            let side = plus(&times(ia * w, &s[i]), y * w, e);
            add_outer(f, -one, &self.across[i], &side);
            add_outer(f, -one, &side, &self.across[i]);
        }
    }
}

/// Derivatives of the twist by the fourteen increments of the element.
#[inline(always)]
pub(super) fn on_dofs<R: Real>(g: &[V3<R>; 3], il: R) -> [R; VELOCITIES] {
    let mut out = [R::zero(); VELOCITIES];
    for c in 0..3 {
        (out[c], out[SECOND + c]) = (-(il * g[1][c]), il * g[1][c]);
        (out[3 + c], out[SECOND + 3 + c]) = (g[0][c], g[2][c]);
    }
    (out[6], out[SECOND + 6]) = (R::of(-1.0), R::of(1.0));
    out
}

/// Where the numbers that belong to both slopes and `Δ` stand among the increments, and whether they count less.
#[inline(always)]
fn places(block: usize) -> &'static [(usize, bool)] {
    match block {
        0 => &[(3, false)],
        1 => &[(0, true), (SECOND, false)],
        _ => &[(SECOND + 3, false)],
    }
}

/// Adds `w` times a symmetric matrix, of which blocks on the diagonal and above it are given, to rows of increments.
#[inline(always)]
pub(super) fn spread<R: Real, const N: usize>(h: &Blocks<R>, il: R, w: R, out: &mut [[R; N]; N]) {
    for i in 0..3 {
        for j in i..3 {
            let s = match (i, j) {
                (1, 1) => w * il * il,
                (1, _) | (_, 1) => w * il,
                _ => w,
            };
            for r in 0..3 {
                for c in 0..3 {
                    let x = s * h[i][j][r][c];
                    for &(row, less) in places(i) {
                        for &(column, too) in places(j) {
                            let x = if less == too { x } else { -x };
                            out[row + r][column + c] += x;
                            if i != j {
                                out[column + c][row + r] += x;
                            }
                        }
                    }
                }
            }
        }
    }
}

/// The same where all these rows and columns are still to be set.
#[inline(always)]
pub(super) fn set<R: Real>(h: &Blocks<R>, il: R, w: R, out: &mut [[R; VELOCITIES]; VELOCITIES]) {
    const P: usize = 3;
    const Q: usize = SECOND + 3;
    let (once, twice) = (w * il, w * il * il);
    for r in 0..3 {
        for c in 0..3 {
            (out[P + r][P + c], out[Q + r][Q + c]) = (w * h[0][0][r][c], w * h[2][2][r][c]);
            let x = w * h[0][2][r][c];
            (out[P + r][Q + c], out[Q + c][P + r]) = (x, x);
            let x = once * h[0][1][r][c];
            (out[P + r][c], out[c][P + r]) = (-x, -x);
            (out[P + r][SECOND + c], out[SECOND + c][P + r]) = (x, x);
            let x = once * h[1][2][r][c];
            (out[r][Q + c], out[Q + c][r]) = (-x, -x);
            (out[SECOND + r][Q + c], out[Q + c][SECOND + r]) = (x, x);
            let x = twice * h[1][1][r][c];
            (out[r][c], out[SECOND + r][SECOND + c]) = (x, x);
            (out[r][SECOND + c], out[SECOND + r][c]) = (-x, -x);
        }
    }
}
