//! Bending with a direction: sections that resist it otherwise about one axis than about the other, and material that is
//! bent when free of stress.
//!
//! With the directors `d` and `e = t × d` of the section at a point the curvature `k = r' × r''/|r'|²` has the components
//! `K_d = k·d` and `K_e = k·e`, about either, and the energy per length is `½ EI_d (K_d - K_d0)² + ½ EI_e (K_e - K_e0)²`.
//! The section is that of the first node, carried along by the smallest rotation of the tangent and turned by
//!
//! `φ = θ₁ + ψ ξ + A (ξ - ξ³) + 4 ξ (1 - ξ) β`, `ψ = Φ - A`,
//!
//! with the twist `Φ` of the element and its area `A` ([`Twisting`](super::twisting)). The bubble `β`, an angle of the
//! element's own, lets the twist vary along it: without, an element is of second order where it does, with it of fourth. It
//! costs `8/3 GJ/L β²`.
//!
//! A small motion of the centre line and the angles changes `K_d` by `d·δk + K_e δσ` and `K_e` by `e·δk - K_d δσ`, where
//! `δσ` is the spin of the section about its own tangent: that is all that derivatives are made of.

use super::quadrature::{MOST, Point, Points, Quadrature};
use super::reduced::M3;
use super::twisting::{
    Blocks, Holonomy, SECOND, Twisting, add_outer, add_skew, add_unit, nought, plus, three, times,
};
use ropewalk_core::rotation::cross;
use ropewalk_core::{Batch, Element, Energy, Local, Power, Real, Share, V3, Weights, dot};

/// Two nodes with torsion and the bubble.
pub(super) const COORDINATES: usize = 21;
pub(super) const VELOCITIES: usize = 15;
/// What the energy depends on: both slopes with `Δ` between them, both angles, the bubble.
pub(super) const VARIABLES: usize = 12;
pub(super) const ANGLES: usize = 9;
pub(super) const BUBBLE: usize = 11;
/// Energy of the bubble over `GJ/L β²`.
pub(super) const BUBBLE_ENERGY: f64 = 8.0 / 3.0;
/// Inertia of the bubble, and of it and a node together, over `ρJ L`.
pub(super) const BUBBLE_MASS: [f64; 2] = [8.0 / 15.0, 1.0 / 3.0];

/// What makes the bending of a cable element, which resists it by `EI_e` in every direction, one with a direction: with the
/// elastic element and its torsion the energy is the one above.
#[derive(Clone, Copy, Debug)]
pub struct Directed {
    /// What it is made of.
    pub params: DirectedParams,
    /// Stress-free curvature about both directors at the quadrature points [1/m].
    pub kappa0: [[f64; 2]; MOST],
    /// Where the curvature is taken.
    pub rule: Points,
}

/// What a directed element is made of; over lanes with `R` other than `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectedParams<R = f64> {
    /// Unstretched length [m].
    pub l: R,
    /// Bending stiffness about the first director [N m²].
    pub ei_d: R,
    /// Bending stiffness about the second, which the elastic element has [N m²].
    pub ei_e: R,
    /// Torsional stiffness [N m²].
    pub gj: R,
    /// Its damping of twist, `η GJ` [N m² s].
    pub eta_gj: R,
    /// Polar moment of inertia per length [kg m].
    pub rho_j: R,
}

/// The numbers of an element over lanes.
#[derive(Clone, Copy, Debug)]
pub struct DirectedLanes<R> {
    params: DirectedParams<R>,
    kappa0: [[R; 2]; MOST],
    rule: Points,
}

/// The curve and its section at a point.
pub(super) struct Section<R> {
    /// Shares of the slopes and of `Δ` in `r'`, and in `L r''`.
    first: [R; 3],
    second: [R; 3],
    /// `r'` and `r''`
    p: V3<R>,
    q: V3<R>,
    /// Both directors.
    d: V3<R>,
    e: V3<R>,
    /// Curvature about both.
    pub k: [R; 2],
    /// From the tangent of the first node to this one.
    holonomy: Holonomy<R>,
    /// Shares of `m`, `A` and the bubble in the angle.
    angle: [R; 3],
    xi: R,
    inverse: R,
}

/// Shares of `m`, `A` and the bubble in the angle of a section.
#[inline(always)]
fn angle<R: Real>(at: &Point) -> [R; 3] {
    let xi = at.xi;
    [R::of(xi), R::of(xi - xi * xi * xi), R::of(4.0 * xi * (1.0 - xi))]
}

impl<R: Real> Section<R> {
    #[inline(always)]
    pub fn new(x: &[R; COORDINATES], twisting: &Twisting<R>, at: &Point, il: R) -> Self {
        let [by_twist, by_area, by_bubble] = angle::<R>(at);
        let turn = by_twist
            .fma(twisting.twist - twisting.area, by_area.fma(twisting.area, by_bubble.fma(x[20], x[9])));
        Section::turned(x, twisting, at, il, Some(turn))
    }

    /// The same of a section that is turned by an angle from the reference director of the first node; without one with the
    /// directors that aren't turned, which do as well where all directions are alike.
    #[inline(always)]
    pub fn turned(x: &[R; COORDINATES], twisting: &Twisting<R>, at: &Point, il: R, turn: Option<R>) -> Self {
        let [f0, f1, f2] = at.phi;
        let [s1, s2] = at.psi;
        let first = [R::of(f1), R::of(f0 - f1 - f2), R::of(f2)];
        let second = [R::of(s1), R::of(-s1 - s2), R::of(s2)];
        let delta = [il * (x[10] - x[0]), il * (x[11] - x[1]), il * (x[12] - x[2])];
        let nodes = [three(x, 3), delta, three(x, 13)];
        let (mut p, mut q) = ([R::zero(); 3], [R::zero(); 3]);
        for i in 0..3 {
            p = plus(&p, first[i], &nodes[i]);
            q = plus(&q, il * second[i], &nodes[i]);
        }
        let a = dot(&p, &p);
        let inverse = R::of(1.0) / a.sqrt();
        let (t, t1, u) = (times(inverse, &p), twisting.e[0], three(x, 6));
        let own = match turn {
            None => u,
            Some(turn) => plus(&times(turn.map(f64::cos), &u), turn.map(f64::sin), &cross(&t1, &u)),
        };
        let holonomy = Holonomy::new([t1, t], [twisting.inverse[0], inverse]);
        let along = dot(&own, &t) / (R::of(1.0) + dot(&t1, &t));
        let d = plus(&own, -along, &plus(&t1, R::of(1.0), &t));
        let e = cross(&t, &d);
        let curvature = times(inverse * inverse, &cross(&p, &q));
        let k = [dot(&curvature, &d), dot(&curvature, &e)];
        Section { first, second, p, q, d, e, k, holonomy, angle: angle(at), xi: R::of(at.xi), inverse }
    }

    /// How the spin of the section changes.
    #[inline(always)]
    fn spin(&self, twisting: &Twisting<R>) -> [R; VARIABLES] {
        let mut out = [R::zero(); VARIABLES];
        let own = twisting.gradient(self.angle[0], self.angle[1]);
        let [one, here] = self.holonomy.gradient();
        for c in 0..3 {
            for i in 0..3 {
                out[3 * i + c] = own[i][c] - self.first[i] * here[c];
            }
            out[c] -= one[c];
        }
        out[ANGLES] = R::of(1.0) - self.xi;
        out[ANGLES + 1] = self.xi;
        out[BUBBLE] = self.angle[2];
        out
    }

    /// How `m·k` changes with the centre line while the vector `m`, normal to the tangent, stays: by `r'` and by `r''`.
    #[inline(always)]
    fn bends(&self, m: &V3<R>, mk: R) -> [V3<R>; 2] {
        let ia = self.inverse * self.inverse;
        let by_p = plus(&times(ia, &cross(&self.q, m)), R::of(-2.0) * mk * ia, &self.p);
        [by_p, times(ia, &cross(m, &self.p))]
    }

    /// The same by the variables.
    #[inline(always)]
    fn lift(&self, [by_p, by_q]: &[V3<R>; 2], il: R) -> [R; VARIABLES] {
        let mut out = [R::zero(); VARIABLES];
        for i in 0..3 {
            for c in 0..3 {
                out[3 * i + c] = self.first[i].fma(by_p[c], il * self.second[i] * by_q[c]);
            }
        }
        out
    }

    /// How the curvature about either director changes with the variables.
    #[inline(always)]
    pub fn gradients(&self, twisting: &Twisting<R>, il: R) -> [[R; VARIABLES]; 2] {
        let ([kd, ke], spin) = (self.k, self.spin(twisting));
        let mut by = [self.lift(&self.bends(&self.d, kd), il), self.lift(&self.bends(&self.e, ke), il)];
        for i in 0..VARIABLES {
            by[0][i] = ke.fma(spin[i], by[0][i]);
            by[1][i] = (-kd).fma(spin[i], by[1][i]);
        }
        by
    }

    /// Adds `s` times a force, with the moments `m` about both directors, to `f`; and `s` times its derivative to `h`,
    /// moments that stay and those of the stiffness `stiff` about the first director.
    #[inline(always)]
    pub fn add<const TANGENT: bool>(
        &self,
        twisting: &Twisting<R>,
        s: R,
        m: [R; 2],
        stiff: R,
        il: R,
        f: &mut [R; VARIABLES],
        h: &mut [[R; VARIABLES]; VARIABLES],
    ) {
        let [kd, ke] = self.k;
        let moment = plus(&times(m[0], &self.d), m[1], &self.e);
        let mk = m[0].fma(kd, m[1] * ke);
        // the moment that turns the section about its own tangent
        let torque = m[0].fma(ke, -(m[1] * kd));
        let spin = self.spin(twisting);
        let bends = self.bends(&moment, mk);
        let by = self.lift(&bends, il);
        for i in 0..VARIABLES {
            f[i] = s.fma(by[i] + torque * spin[i], f[i]);
        }
        if !TANGENT {
            return;
        }
        let beside = plus(&times(m[0], &self.e), -m[1], &self.d);
        let beside = self.lift(&self.bends(&beside, m[0] * ke - m[1] * kd), il);
        let bent = self.lift(&self.bends(&self.d, kd), il);
        let mut own = [R::zero(); VARIABLES];
        for i in 0..VARIABLES {
            own[i] = ke.fma(spin[i], bent[i]);
        }
        for i in 0..VARIABLES {
            let (x, y, z) = (s * spin[i], s * (beside[i] - mk * spin[i]), s * stiff * own[i]);
            for j in 0..VARIABLES {
                h[i][j] += x.fma(beside[j], y.fma(spin[j], z * own[j]));
            }
        }
        self.add_curve(s, &moment, mk, torque, il, h);
        let mut blocks: Blocks<R> = [[nought(); 3]; 3];
        let st = s * torque;
        twisting.add_hessian(st * self.angle[0], st * self.angle[1], &mut blocks);
        for i in 0..3 {
            for j in i..3 {
                add_block(h, i, j, R::of(1.0), &blocks[i][j]);
            }
        }
    }

    /// Adds what the second derivatives of the curvature and of the way to the section make.
    #[inline(always)]
    fn add_curve(&self, s: R, m: &V3<R>, mk: R, torque: R, il: R, h: &mut [[R; VARIABLES]; VARIABLES]) {
        let ia = self.inverse * self.inverse;
        let (half, two) = (R::of(0.5) * ia, R::of(-2.0) * ia * ia);
        let k = plus(&times(self.k[0], &self.d), self.k[1], &self.e);
        let (qm, mp) = (cross(&self.q, m), cross(m, &self.p));
        let (mut pp, mut pq, mut first, mut mixed) = (nought(), nought(), nought(), nought());
        add_outer(&mut pp, half, &k, m);
        add_outer(&mut pp, half, m, &k);
        add_outer(&mut pp, two, &self.p, &qm);
        add_outer(&mut pp, two, &qm, &self.p);
        add_outer(&mut pp, R::of(8.0) * mk * ia * ia, &self.p, &self.p);
        add_unit(&mut pp, R::of(-2.0) * mk * ia);
        add_skew(&mut pq, -ia, m);
        add_outer(&mut pq, two, &self.p, &mp);
        self.holonomy.add_hessian(-torque, [&mut first, &mut pp], &mut mixed);
        for i in 0..3 {
            for j in i..3 {
                let (ci, cj) = (self.first[i], self.first[j]);
                let (di, dj) = (il * self.second[i], il * self.second[j]);
                let mut block = nought();
                for r in 0..3 {
                    for c in 0..3 {
                        let mut x = ci * cj * pp[r][c] + ci * dj * pq[r][c] + di * cj * pq[c][r];
                        if i == 0 {
                            x += cj * mixed[r][c];
                        }
                        if j == 0 {
                            x += ci * mixed[c][r] + first[r][c];
                        }
                        block[r][c] = x;
                    }
                }
                add_block(h, i, j, s, &block);
            }
        }
    }
}

/// Adds a block above the diagonal, and its mirror image.
#[inline(always)]
fn add_block<R: Real>(h: &mut [[R; VARIABLES]; VARIABLES], i: usize, j: usize, s: R, block: &M3<R>) {
    for r in 0..3 {
        for c in 0..3 {
            let x = s * block[r][c];
            h[3 * i + r][3 * j + c] += x;
            if i != j {
                h[3 * j + c][3 * i + r] += x;
            }
        }
    }
}

/// The increments that a variable is made of, with their shares.
#[inline(always)]
pub(super) fn dofs<R: Real>(variable: usize, il: R) -> [(usize, R); 2] {
    let one = |dof| [(dof, R::of(1.0)), (dof, R::zero())];
    match variable {
        c @ 0..3 => one(3 + c),
        c @ 3..6 => [(c - 3, -il), (SECOND + c - 3, il)],
        c @ 6..9 => one(SECOND + c - 3),
        ANGLES => one(6),
        BUBBLE => one(14),
        _ => one(SECOND + 6),
    }
}

/// How many of them count.
#[inline(always)]
pub(super) fn count(variable: usize) -> usize {
    if (3..6).contains(&variable) { 2 } else { 1 }
}

pub(super) fn twisting<R: Real>(x: &[R; COORDINATES], il: R) -> Twisting<R> {
    Twisting::new(&pair(x), il)
}

/// The same but for the twist itself.
#[inline(always)]
pub(super) fn derivatives<R: Real>(x: &[R; COORDINATES], il: R) -> Twisting<R> {
    Twisting::derivatives(&pair(x), il)
}

#[inline(always)]
fn pair<R: Real>(x: &[R; COORDINATES]) -> [R; 20] {
    let mut nodes = [R::zero(); 20];
    nodes.copy_from_slice(&x[..20]);
    nodes
}

/// Curvature about both directors of the section at a point of an element with these coordinates and bubble [1/m].
pub(crate) fn curvature(x: &[f64; COORDINATES], l: f64, at: &Point) -> [f64; 2] {
    Section::new(x, &twisting(x, 1.0 / l), at, 1.0 / l).k
}

impl Directed {
    /// An element with this curvature about both directors when free of stress [1/m], at each of the points of the rule.
    pub fn new(params: DirectedParams, kappa0: [[f64; 2]; MOST], rule: impl Quadrature) -> Self {
        Directed { params, kappa0, rule: Points::of(rule) }
    }

    /// The curvature about both directors that an element has at each of the points of a rule [1/m].
    pub fn curvature(x: &[f64; COORDINATES], l: f64, rule: impl Quadrature) -> [[f64; 2]; MOST] {
        let mut all = [[0.0; 2]; MOST];
        for (k, at) in all.iter_mut().zip(rule.points()) {
            *k = curvature(x, l, at);
        }
        all
    }
}

impl Element<COORDINATES, VELOCITIES> for Directed {
    type Lanes<R: Real> = DirectedLanes<R>;
    // its code is long, and wide copies of it take longer to compile than they save
    const WIDE: bool = false;

    fn label(&self) -> String {
        format!("bending with a direction {}", self.rule.label())
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> DirectedLanes<R> {
        let mut kappa0 = [[R::zero(); 2]; MOST];
        for (k, kappa0) in kappa0.iter_mut().enumerate() {
            *kappa0 = [batch.get(|e| e.kappa0[k][0]), batch.get(|e| e.kappa0[k][1])];
        }
        DirectedLanes {
            params: DirectedParams {
                l: batch.get(|e| e.params.l),
                ei_d: batch.get(|e| e.params.ei_d),
                ei_e: batch.get(|e| e.params.ei_e),
                gj: batch.get(|e| e.params.gj),
                eta_gj: batch.get(|e| e.params.eta_gj),
                rho_j: batch.get(|e| e.params.rho_j),
            },
            kappa0,
            rule: batch.first().rule,
        }
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        DirectedLanes { params: p, kappa0, rule }: &DirectedLanes<R>,
        x: &Local<R, COORDINATES, VELOCITIES>,
        w: &Weights,
        out: &mut Share<R, VELOCITIES>,
    ) {
        let il = R::of(1.0) / p.l;
        let twisting = twisting(&x.q, il);
        let more = p.ei_d - p.ei_e;
        let (mut f, mut h) = ([R::zero(); VARIABLES], [[R::zero(); VARIABLES]; VARIABLES]);
        for (at, k0) in rule.points().iter().zip(kappa0) {
            let section = Section::new(&x.q, &twisting, at, il);
            let m = [more * section.k[0] - p.ei_d * k0[0], -(p.ei_e * k0[1])];
            let s = R::of(at.w) * p.l;
            section.add::<TANGENT>(&twisting, s, m, more, il, &mut f, &mut h);
        }
        let stiff = R::of(2.0 * BUBBLE_ENERGY) * p.gj * il;
        let damping = R::of(2.0 * BUBBLE_ENERGY) * p.eta_gj * il;
        f[BUBBLE] += stiff * x.q[20] + damping * x.v[14];
        h[BUBBLE][BUBBLE] += stiff;
        let (wq, wv, wa) = (R::of(w.q), R::of(w.v), R::of(w.a));
        for i in 0..VARIABLES {
            for &(row, by_row) in &dofs(i, il)[..count(i)] {
                out.r[row] = by_row.fma(f[i], out.r[row]);
                if !TANGENT {
                    continue;
                }
                for j in 0..VARIABLES {
                    for &(column, by_column) in &dofs(j, il)[..count(j)] {
                        out.k[row][column] += wq * by_row * by_column * h[i][j];
                    }
                }
            }
        }
        let [own, with] = BUBBLE_MASS.map(|m| R::of(m) * p.rho_j * p.l);
        let (a, b) = (x.a[6] + x.a[SECOND + 6], x.a[14]);
        out.r[14] += own * b + with * a;
        out.r[6] += with * b;
        out.r[SECOND + 6] += with * b;
        if TANGENT {
            out.k[14][14] += wa * own + wv * damping;
            for i in [6, SECOND + 6] {
                out.k[14][i] += wa * with;
                out.k[i][14] += wa * with;
            }
        }
    }
    #[inline(always)]
    fn energy<R: Real>(
        DirectedLanes { params: p, kappa0, rule }: &DirectedLanes<R>,
        x: &Local<R, COORDINATES, VELOCITIES>,
    ) -> Energy<R> {
        let (il, half) = (R::of(1.0) / p.l, R::of(0.5));
        let twisting = twisting(&x.q, il);
        let mut potential = R::of(BUBBLE_ENERGY) * p.gj * il * x.q[20] * x.q[20];
        for (at, k0) in rule.points().iter().zip(kappa0) {
            let [kd, ke] = Section::new(&x.q, &twisting, at, il).k;
            let more = half * (p.ei_d - p.ei_e) * kd * kd;
            let laid = p.ei_d * k0[0] * (half * k0[0] - kd) + p.ei_e * k0[1] * (half * k0[1] - ke);
            potential += R::of(at.w) * p.l * (more + laid);
        }
        let [own, with] = BUBBLE_MASS.map(|m| R::of(m) * p.rho_j * p.l);
        let b = x.v[14];
        Energy { kinetic: b * (half * own * b + with * (x.v[6] + x.v[SECOND + 6])), potential }
    }
    #[inline(always)]
    fn power<R: Real>(
        DirectedLanes { params: p, .. }: &DirectedLanes<R>,
        x: &Local<R, COORDINATES, VELOCITIES>,
    ) -> Power<R> {
        let damping = R::of(2.0 * BUBBLE_ENERGY) * p.eta_gj / p.l;
        Power { dissipated: damping * x.v[14] * x.v[14], ..Power::zero() }
    }
}
