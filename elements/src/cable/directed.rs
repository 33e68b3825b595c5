//! Cables that are bent when free of stress, with sections that know which way: directors, and twist between them.
//!
//! A curvature has a direction, and material keeps it: bent out of the plane of its natural arc, a cable is held by
//! its bending stiffness only as far as its sections can't turn about its axis instead. No function of the centre line
//! of an element alone tells how they have turned (with nothing that holds the twist the best is `|κ| - κ₀`, and that
//! has no stiffness out of the plane), so each node gets a director `D`, a vector of which the part normal to the
//! tangent counts. With the directions `d`, `e = t × d` of a section, carried from both nodes of an element to its points
//! by the smallest rotation of the tangent and blended, the energy is
//!
//! `½ EI ∫ |K - K₀|² dx + ½ GJ (Φ - Φ₀)²/L`, `K = (k·d, k·e)`, `k = r' × r''/|r'|²`.
//!
//! `Φ` is the twist of the element: the angle between its directors, and the solid angle that the tangent sweeps between
//! the chord and both ends. Both are functions of directions alone: a rigid rotation changes neither, and the shape as
//! laid is free of energy and force. `GJ` is the torsional stiffness; as it goes to zero only `|κ| - κ₀` is left. What `D`
//! has along the tangent, and its length, are held by springs that are free of force in equilibrium. Sections turn with
//! the inertia `ρJ |Ḋ|²/2`.

use super::quadrature::{MOST, Point, Points, Quadrature};
use super::shape::{Natural, combine, second};
use ropewalk_core::rotation::cross;
use ropewalk_core::{Batch, Dual, Element, Energy, Local, Real, Share, V3, Weights, dot};

/// Chord, slopes and directors of an element: what its energy depends on.
type Variables<R> = [R; VARIABLES];
const VARIABLES: usize = 15;
/// Twelve dofs of the cable and both directors.
const DOFS: usize = 18;

/// The stress-free curvature of a cable element whose sections know which way they look, and its torsion.
///
/// Its unknowns are the twelve dofs of the element and then the directors of both nodes. It adds to the energy of the
/// elastic element, which bends with T3, what makes that of a straight one into the one above.
#[derive(Clone, Copy, Debug)]
pub struct Directed {
    /// What it is made of.
    pub params: DirectedParams,
    /// Stress-free curvature about both directors at the quadrature points [1/m].
    kappa0: [[f64; 2]; MOST],
    /// Stress-free twist [rad].
    twist0: f64,
    /// Where the curvature is taken.
    rule: Points,
}

/// What a directed element is made of; over lanes with `R` other than `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectedParams<R = f64> {
    /// Unstretched length [m].
    pub l: R,
    /// Bending stiffness [N m²].
    pub ei: R,
    /// Torsional stiffness [N m²].
    pub gj: R,
    /// Polar moment of inertia per length [kg m].
    pub rho_j: R,
}

/// The numbers of an element over lanes.
#[derive(Clone, Copy, Debug)]
pub struct DirectedLanes<R> {
    params: DirectedParams<R>,
    kappa0: [[R; 2]; MOST],
    twist0: R,
    rule: Points,
}

impl<R: Real> DirectedLanes<R> {
    fn lift(&self) -> DirectedLanes<Dual<R>> {
        let c = Dual::constant;
        let DirectedParams { l, ei, gj, rho_j } = self.params;
        DirectedLanes {
            params: DirectedParams { l: c(l), ei: c(ei), gj: c(gj), rho_j: c(rho_j) },
            kappa0: self.kappa0.map(|k| k.map(c)),
            twist0: c(self.twist0),
            rule: self.rule,
        }
    }
}

fn three<R: Real>(x: &Variables<R>, block: usize) -> V3<R> {
    [x[3 * block], x[3 * block + 1], x[3 * block + 2]]
}

fn scaled<R: Real>(s: R, x: &V3<R>) -> V3<R> {
    x.map(|x| s * x)
}

fn plus<R: Real>(a: &V3<R>, b: &V3<R>) -> V3<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn unit<R: Real>(x: &V3<R>) -> V3<R> {
    scaled(R::of(1.0) / dot(x, x).sqrt(), x)
}

/// A vector normal to the unit vector `from`, turned with it by the smallest rotation that takes it to `to`.
pub(crate) fn carry<R: Real>(v: &V3<R>, from: &V3<R>, to: &V3<R>) -> V3<R> {
    let s = dot(v, to) / (R::of(1.0) + dot(from, to));
    let both = plus(from, to);
    [v[0] - s * both[0], v[1] - s * both[1], v[2] - s * both[2]]
}

/// What of a vector is normal to a unit vector, at unit size.
pub(crate) fn normal<R: Real>(v: &V3<R>, t: &V3<R>) -> V3<R> {
    let s = dot(v, t);
    unit(&[v[0] - s * t[0], v[1] - s * t[1], v[2] - s * t[2]])
}

/// Tangents and directions at both nodes, and the chord.
struct Frames<R> {
    t: [V3<R>; 2],
    d: [V3<R>; 2],
    chord: V3<R>,
}

impl<R: Real> Frames<R> {
    fn new(x: &Variables<R>) -> Self {
        let t = [unit(&three(x, 1)), unit(&three(x, 2))];
        let d = [normal(&three(x, 3), &t[0]), normal(&three(x, 4), &t[1])];
        Frames { t, d, chord: unit(&three(x, 0)) }
    }

    /// The twist: `2 tan` of half the angle between the directors, which for small angles is that angle, and twice the
    /// area of the triangle of both tangents and the chord on the unit sphere.
    fn twist(&self) -> R {
        let ([t1, t2], [d1, d2]) = (&self.t, &self.d);
        let (e1, e2) = (cross(t1, d1), cross(t2, d2));
        let (one, c) = (R::of(1.0), dot(t1, t2));
        let angle = (dot(&e1, d2) - dot(d1, &e2)) / (one + dot(d1, d2) + dot(&e1, &e2) + c);
        let area = dot(&self.chord, &cross(t1, t2)) / (one + dot(t1, &self.chord) + dot(&self.chord, t2) + c);
        R::of(2.0) * angle + R::of(4.0) * area
    }

    /// Curvature about both directions of the section at a point.
    fn curvature(&self, nat: &Natural<R>, at: &Point, il: R) -> [R; 2] {
        let (p, q) = (combine(&at.phi, nat), second(&at.psi, il, nat));
        let square = dot(&p, &p);
        let t = scaled(R::of(1.0) / square.sqrt(), &p);
        let ends = [carry(&self.d[0], &self.t[0], &t), carry(&self.d[1], &self.t[1], &t)];
        let d = unit(&plus(&scaled(R::of(1.0 - at.xi), &ends[0]), &scaled(R::of(at.xi), &ends[1])));
        let k = scaled(R::of(1.0) / square, &cross(&p, &q));
        [dot(&k, &d), dot(&k, &cross(&t, &d))]
    }
}

fn natural_of<R: Real>(x: &Variables<R>) -> Natural<R> {
    let chord = three(x, 0);
    let minus = scaled(R::of(-1.0), &chord);
    [chord, plus(&three(x, 1), &minus), plus(&three(x, 2), &minus)]
}

/// What makes the energy of the elastic element that of this one.
fn potential<R: Real>(p: &DirectedLanes<R>, x: &Variables<R>) -> R {
    let DirectedParams { l, ei, gj, .. } = p.params;
    let (half, il, frames, nat) = (R::of(0.5), R::of(1.0) / l, Frames::new(x), natural_of(x));
    let twist = frames.twist() - p.twist0;
    let mut gauge = R::zero();
    for i in 0..2 {
        let director = three(x, 3 + i);
        let (along, long) = (dot(&director, &frames.t[i]), dot(&director, &director) - R::of(1.0));
        gauge += along * along + R::of(0.25) * long * long;
    }
    let mut sum = half * gj * il * (twist * twist + gauge);
    for (at, k0) in p.rule.points().iter().zip(&p.kappa0) {
        let k = frames.curvature(&nat, at, il);
        let w = ei * l * R::of(at.w);
        for i in 0..2 {
            sum += w * k0[i] * (half * k0[i] - k[i]);
        }
    }
    sum
}

/// The variables of the dofs.
fn variables<R: Real>(q: &[R; DOFS], il: R) -> Variables<R> {
    let mut x = [R::zero(); VARIABLES];
    for c in 0..3 {
        x[c] = il * (q[6 + c] - q[c]);
        (x[3 + c], x[6 + c]) = (q[3 + c], q[9 + c]);
        (x[9 + c], x[12 + c]) = (q[12 + c], q[15 + c]);
    }
    x
}

/// The dofs that a variable is made of, with their shares.
#[inline(always)]
fn dofs<R: Real>(variable: usize, il: R) -> [(usize, R); 2] {
    let one = |dof| [(dof, R::of(1.0)), (dof, R::zero())];
    match variable {
        c @ 0..3 => [(c, -il), (6 + c, il)],
        c @ 3..6 => one(c),
        c @ 6..9 => one(3 + c),
        c => one(3 + c),
    }
}

impl Directed {
    /// An element that is free of stress at this shape, its twelve dofs, with these directors of its nodes.
    pub fn at_shape(
        params: DirectedParams,
        shape: &[f64; 12],
        directors: [V3<f64>; 2],
        rule: impl Quadrature,
    ) -> Self {
        let mut kappa0 = [[0.0; 2]; MOST];
        let (x, il) = (laid(shape, directors, params.l), 1.0 / params.l);
        let (frames, nat) = (Frames::new(&x), natural_of(&x));
        for (kappa0, at) in kappa0.iter_mut().zip(rule.points()) {
            *kappa0 = frames.curvature(&nat, at, il);
        }
        Directed { params, kappa0, twist0: frames.twist(), rule: Points::of(rule) }
    }

    /// Its numbers for one lane.
    pub fn to_lanes(&self) -> DirectedLanes<f64> {
        DirectedLanes { params: self.params, kappa0: self.kappa0, twist0: self.twist0, rule: self.rule }
    }
}

fn laid(shape: &[f64; 12], directors: [V3<f64>; 2], l: f64) -> Variables<f64> {
    let all: [f64; DOFS] =
        std::array::from_fn(|i| if i < 12 { shape[i] } else { directors[(i - 12) / 3][i % 3] });
    variables(&all, 1.0 / l)
}

/// Curvature of an element about both directions of its section at `xi` [1/m].
pub(crate) fn curvature(shape: &[f64; 12], directors: [V3<f64>; 2], l: f64, xi: f64) -> [f64; 2] {
    let x = laid(shape, directors, l);
    Frames::new(&x).curvature(&natural_of(&x), &Point::new(xi, 1.0), 1.0 / l)
}

/// Directors of a cable that is laid with these slopes at its nodes: free of twist from the first, which is normal to the
/// plane in which the cable bends most. `None` where it is straight.
pub(crate) fn directors(shapes: &[[f64; 12]], mesh: &[f64]) -> Option<Vec<V3<f64>>> {
    let tangent = |e: &[f64; 12], at: usize| unit(&[e[at], e[at + 1], e[at + 2]]);
    let mut tangents: Vec<V3<f64>> = shapes.iter().map(|e| tangent(e, 3)).collect();
    tangents.push(tangent(shapes.last()?, 9));
    let mut most = (0.0, [0.0; 3], 0);
    for (k, shape) in shapes.iter().enumerate() {
        let l = mesh[k + 1] - mesh[k];
        let nat = super::shape::natural(shape, 1.0 / l);
        for xi in [0.0, 0.5, 1.0] {
            let at = Point::new(xi, 1.0);
            let turn = cross(&combine(&at.phi, &nat), &second(&at.psi, 1.0 / l, &nat));
            let size = dot(&turn, &turn).sqrt() * l;
            if size > most.0 {
                most = (size, turn, k);
            }
        }
    }
    let (size, turn, k) = most;
    if !(size > super::rest::STRAIGHT) {
        return None;
    }
    let mut all = vec![[0.0; 3]; tangents.len()];
    all[k] = normal(&turn, &tangents[k]);
    for i in k + 1..all.len() {
        all[i] = normal(&carry(&all[i - 1], &tangents[i - 1], &tangents[i]), &tangents[i]);
    }
    for i in (0..k).rev() {
        all[i] = normal(&carry(&all[i + 1], &tangents[i + 1], &tangents[i]), &tangents[i]);
    }
    Some(all)
}

impl Element<DOFS, DOFS> for Directed {
    type Lanes<R: Real> = DirectedLanes<R>;
    const WIDE: bool = false;

    fn label(&self) -> String {
        format!("stress-free curvature with its direction {}", self.rule.label())
    }
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> DirectedLanes<R> {
        let mut kappa0 = [[R::zero(); 2]; MOST];
        for (k, kappa0) in kappa0.iter_mut().enumerate() {
            *kappa0 = [batch.get(|e| e.kappa0[k][0]), batch.get(|e| e.kappa0[k][1])];
        }
        DirectedLanes {
            params: DirectedParams {
                l: batch.get(|e| e.params.l),
                ei: batch.get(|e| e.params.ei),
                gj: batch.get(|e| e.params.gj),
                rho_j: batch.get(|e| e.params.rho_j),
            },
            kappa0,
            twist0: batch.get(|e| e.twist0),
            rule: batch.first().rule,
        }
    }
    fn add<R: Real, const TANGENT: bool>(
        p: &DirectedLanes<R>,
        x: &Local<R, DOFS, DOFS>,
        w: &Weights,
        out: &mut Share<R, DOFS>,
    ) {
        let il = R::of(1.0) / p.params.l;
        let (x0, once) = (variables(&x.q, il), p.lift());
        let twice = once.lift();
        for i in 0..VARIABLES {
            let mut at = Dual::constants(&x0);
            at[i].eps = R::of(1.0);
            let slope = potential::<Dual<R>>(&once, &at).eps;
            for (dof, share) in dofs(i, il) {
                out.r[dof] += share * slope;
            }
            if !TANGENT {
                continue;
            }
            for j in 0..=i {
                let mut at = Dual::constants(&at);
                at[j].eps = Dual::constant(R::of(1.0));
                let second = R::of(w.q) * potential::<Dual<Dual<R>>>(&twice, &at).eps.eps;
                for (row, by_row) in dofs(i, il) {
                    for (column, by_column) in dofs(j, il) {
                        let k = by_row * by_column * second;
                        out.k[row][column] += k;
                        if i != j {
                            out.k[column][row] += k;
                        }
                    }
                }
            }
        }
        let mass = R::of(0.5) * p.params.rho_j * p.params.l;
        for i in 12..DOFS {
            out.r[i] += mass * x.a[i];
            if TANGENT {
                out.k[i][i] += R::of(w.a) * mass;
            }
        }
    }
    fn energy<R: Real>(p: &DirectedLanes<R>, x: &Local<R, DOFS, DOFS>) -> Energy<R> {
        let mut square = R::zero();
        for i in 12..DOFS {
            square = x.v[i].fma(x.v[i], square);
        }
        let kinetic = R::of(0.25) * p.params.rho_j * p.params.l * square;
        Energy { kinetic, potential: potential::<R>(p, &variables(&x.q, R::of(1.0) / p.params.l)) }
    }
}
