//! The node of a cable that can be twisted: where its section looks, and how that is carried along as it turns.
//!
//! Position `r`, slope `p = r'`, a reference director `u` normal to the tangent `t = p/|p|`, and an angle `θ`. The
//! section's directors are `d = cos θ u + sin θ t×u` and `e = t×d`. Increments and velocities are those of position and
//! slope, and the spin of the section about its own tangent.
//!
//! `u` rides with the tangent by the smallest rotation ([`carried`]), in every increment anew: parallel transport in time
//! (Bergou, Wardetzky, Robinson, Audoly & Grinspun, ACM Trans. Graph. 27(3), 2008). What `u` and `θ` are apart from each
//! other means nothing: to turn one forth and the other back changes no section ([`relabel`]).

use crate::algebra::lane::{V3, dot};
use crate::algebra::rotation::{M3, cross};
use std::f64::consts::TAU;

/// Coordinates and velocities of the node.
pub const COORDINATES: usize = 10;
/// Velocities of the node.
pub const VELOCITIES: usize = 7;
/// Coordinates and velocities of position and slope, which stand first: those of a cable without twist.
pub const PREFIX: usize = 6;

/// Cosine of the angle plus one below which one increment turns a tangent too far: its director can't be carried.
const LEAST: f64 = 0.1;
/// Angle between neighbouring reference directors from which on a line is relabelled [rad].
const RELABEL: f64 = 0.5;
/// Angle of a first node from which on whole turns are taken out [rad].
const MOST_SPUN: f64 = 4.0;
/// Most by which that angle may change from one accepted state to the next [rad]: a jump by a whole turn is more.
const MOST_CHANGE: f64 = 2.0;
/// What `1 + t₁·t₂` of the tangents of an element must not fall below, nor `1 + t₁·D + D·t₂ + t₁·t₂` with its chord `D`: where
/// they vanish its twist leaps by whole turns.
const LEAST_OPEN: [f64; 2] = [0.1, 0.2];

fn three(q: &[f64], from: usize) -> V3<f64> {
    [q[from], q[from + 1], q[from + 2]]
}

fn unit(x: &V3<f64>) -> V3<f64> {
    let size = dot(x, x).sqrt();
    x.map(|x| x / size)
}

/// The tangent of a node with these coordinates.
pub fn tangent(q: &[f64]) -> V3<f64> {
    unit(&three(q, 3))
}

/// A vector normal to the unit vector `from`, turned with it by the smallest rotation that takes it to the unit vector
/// `to`.
///
/// ```
/// use ropewalk_core::model::twist::carried;
/// // a vector normal to both stays as it is
/// let z = carried(&[0.0, 0.0, 1.0], &[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0]);
/// assert_eq!(z, [0.0, 0.0, 1.0]);
/// ```
pub fn carried(v: &V3<f64>, from: &V3<f64>, to: &V3<f64>) -> V3<f64> {
    let s = dot(v, to) / (1.0 + dot(from, to));
    std::array::from_fn(|i| v[i] - s * (from[i] + to[i]))
}

/// A vector without what it has along the unit vector `t`, at unit size.
pub fn across(v: &V3<f64>, t: &V3<f64>) -> V3<f64> {
    let s = dot(v, t);
    unit(&std::array::from_fn(|i| v[i] - s * t[i]))
}

/// The angle about `t2` by which `u2` is turned against `u1`, carried there from `t1` [rad]; in (-π, π].
pub fn between([t1, u1]: [&V3<f64>; 2], [t2, u2]: [&V3<f64>; 2]) -> f64 {
    let (w1, w2) = (cross(t1, u1), cross(t2, u2));
    2.0 * (dot(&w1, u2) - dot(u1, &w2)).atan2(1.0 + dot(u1, u2) + dot(&w1, &w2) + dot(t1, t2))
}

/// The section of a node with these coordinates: the matrix whose columns are its directors `d` and `e` and its tangent.
pub fn section(q: &[f64]) -> M3 {
    let (t, u) = (tangent(q), three(q, 6));
    let (w, (sin, cos)) = (cross(&t, &u), q[9].sin_cos());
    std::array::from_fn(|i| [cos * u[i] + sin * w[i], cos * w[i] - sin * u[i], t[i]])
}

/// Angular velocity in space of the section of a node with these coordinates and velocities [rad/s].
pub fn angular_velocity(q: &[f64], v: &[f64]) -> V3<f64> {
    Turned::new(q).spinning(v)[0]
}

/// The moment [N m] in space of generalised forces on the slope and the spin of a node with these coordinates.
pub fn moment(q: &[f64], on_slope: &V3<f64>, on_spin: f64) -> V3<f64> {
    let p = three(q, 3);
    let (t, turning) = (unit(&p), cross(&p, on_slope));
    std::array::from_fn(|i| turning[i] + on_spin * t[i])
}

/// The coordinates of a node at rest where it is laid, with a director in the direction of `u`, which needn't be a unit
/// vector nor normal to the slope, and an angle [rad].
pub fn laid(r: &V3<f64>, slope: &V3<f64>, u: &V3<f64>, theta: f64) -> [f64; COORDINATES] {
    let u = across(u, &unit(slope));
    [r[0], r[1], r[2], slope[0], slope[1], slope[2], u[0], u[1], u[2], theta]
}

/// `out = q ⊕ d`.
pub(crate) fn retract(q: &[f64], d: &[f64], out: &mut [f64]) {
    let from = tangent(q);
    for i in 0..PREFIX {
        out[i] = q[i] + d[i];
    }
    let to = tangent(out);
    // rounding adds up over many increments
    let u = across(&carried(&three(q, 6), &from, &to), &to);
    out[6..9].copy_from_slice(&u);
    out[9] = q[9] + d[6];
}

/// The increment between two states of a node.
pub(crate) fn difference(from: &[f64], to: &[f64], d: &mut [f64]) {
    for i in 0..PREFIX {
        d[i] = to[i] - from[i];
    }
    let (t1, t2) = (tangent(from), tangent(to));
    d[6] = to[9] - from[9] + between([&t1, &three(from, 6)], [&t2, &three(to, 6)]);
}

/// How a spin and the rate of an increment differ: `N = T·(p × p')` and `D = |p|² + |p| T·p` of the slope `p` after the
/// increment and the tangent `T` before it.
struct Apart {
    t: V3<f64>,
    p: V3<f64>,
    rate: V3<f64>,
    n: f64,
    d: f64,
}

impl Apart {
    fn new(q: &[f64], d: &[f64], rate: &[f64]) -> Self {
        let (t, rate) = (tangent(q), three(rate, 3));
        let p: V3<f64> = std::array::from_fn(|i| q[3 + i] + d[3 + i]);
        let square = dot(&p, &p);
        Apart { n: dot(&t, &cross(&p, &rate)), d: square + square.sqrt() * dot(&t, &p), t, p, rate }
    }
}

/// The velocity of the motion `q ⊕ d(t)`: `v` holds the rate of the increment, and gets the spin.
pub(crate) fn velocity(q: &[f64], d: &[f64], v: &mut [f64]) {
    let apart = Apart::new(q, d, v);
    v[6] -= apart.n / apart.d;
}

/// First and second derivatives of the increment: both hold velocities and accelerations.
pub(crate) fn rates(q: &[f64], d: &[f64], first: &mut [f64], second: &mut [f64]) {
    let Apart { t, p, rate, n, d } = Apart::new(q, d, first);
    let (size, along) = (dot(&p, &p).sqrt(), dot(&p, &rate));
    let d_rate = 2.0 * along + along * dot(&t, &p) / size + size * dot(&t, &rate);
    first[6] += n / d;
    second[6] += dot(&t, &cross(&p, &three(second, 3))) / d - n * d_rate / (d * d);
}

/// Whether an increment turns the tangent of a node too far for its director to be carried along.
pub(crate) fn flips(q: &[f64], d: &[f64]) -> bool {
    let to: V3<f64> = std::array::from_fn(|i| q[3 + i] + d[3 + i]);
    !(1.0 + dot(&tangent(q), &unit(&to)) >= LEAST)
}

/// Why the twist between two neighbouring nodes with these coordinates can't be told any more after these increments, if it
/// can't.
pub(crate) fn loses_count(q: [&[f64]; 2], d: [&[f64]; 2]) -> Option<&'static str> {
    let mut moved = [[0.0; COORDINATES]; 2];
    (0..2).for_each(|k| retract(q[k], d[k], &mut moved[k]));
    if folds([&moved[0], &moved[1]]) {
        return Some(FOLDS);
    }
    let angle = |q: [&[f64]; 2]| {
        let [(t1, u1), (t2, u2)] = q.map(|q| (tangent(q), three(q, 6)));
        between([&t1, &u1], [&t2, &u2])
    };
    let change = angle([&moved[0], &moved[1]]) - angle(q);
    (!(change.abs() <= MOST_CHANGE)).then_some("a cable with torsion turns too far in one step")
}

/// What is wrong with an element that [`folds`].
pub const FOLDS: &str = "an element of a cable with torsion is bent by nearly half a turn, so that its twist can't be told: take \
                         more `elements`, and let the cable touch itself where it forms loops (`line_contact`)";

/// Whether the element between two nodes with these coordinates is bent so far that its twist can't be told.
pub fn folds(q: [&[f64]; 2]) -> bool {
    let [t1, t2] = q.map(tangent);
    let chord: V3<f64> = std::array::from_fn(|i| q[1][i] - q[0][i]);
    let (chord, c) = (unit(&chord), dot(&t1, &t2));
    !(1.0 + c >= LEAST_OPEN[0] && 1.0 + dot(&t1, &chord) + dot(&chord, &t2) + c >= LEAST_OPEN[1])
}

/// Turns the reference directors of a line of nodes, at these places in the coordinates, such that each is that of the
/// one before carried along, and their angles back: the sections stay. Only where two neighbours are apart by more than
/// half a radian, before the angle between them can leave (-π, π]; and where the first has turned round several times, those turns
/// are taken out of all angles, so that rounding doesn't grow with them. Returns whether anything was to be done.
pub fn relabel(q: &mut [f64], line: &[usize]) -> bool {
    let first = q[line[0] + 9];
    let spun = first.abs() > MOST_SPUN;
    if spun {
        let turns = TAU * (first / TAU).round();
        line.iter().for_each(|k| q[k + 9] -= turns);
    }
    lay_anew(q, line) || spun
}

fn lay_anew(q: &mut [f64], line: &[usize]) -> bool {
    let reference = |q: &[f64], k: usize| (tangent(&q[k..]), three(q, k + 6));
    let apart = |q: &[f64], a: usize, b: usize| {
        let ((t1, u1), (t2, u2)) = (reference(q, a), reference(q, b));
        between([&t1, &u1], [&t2, &u2])
    };
    if !line.windows(2).any(|w| apart(q, w[0], w[1]).abs() > RELABEL) {
        return false;
    }
    let (mut before, mut turn) = (reference(q, line[0]), 0.0);
    for &k in &line[1..] {
        let (t, u) = reference(q, k);
        // the angles add up along the line, beyond half a turn too
        turn += between([&before.0, &before.1], [&t, &u]);
        before = (t, u);
        let (beside, (sin, cos)) = (cross(&t, &u), turn.sin_cos());
        let turned = across(&std::array::from_fn(|i| cos * u[i] - sin * beside[i]), &t);
        q[k + 6..k + 9].copy_from_slice(&turned);
        q[k + 9] += turn;
    }
    true
}

/// Changes of a vector `a` of the section along increments of its slope and spin, as it is seen from a vector `b` that
/// stays: what joints are made of. Increments turn the section by `exp(ω) exp(σ t)` with the vector
/// `ω = t×h/|p| - (t·h) t×h/|p|²` of the smallest rotation and the spin `σ`, up to third order.
pub(crate) struct Turned {
    t: V3<f64>,
    inverse: f64,
}

impl Turned {
    /// Of the section of a node with these coordinates.
    pub fn new(q: &[f64]) -> Self {
        let p = three(q, 3);
        let inverse = 1.0 / dot(&p, &p).sqrt();
        Turned { t: p.map(|x| inverse * x), inverse }
    }

    /// The derivative of `b·a` by the slope and the spin.
    pub fn slope(&self, a: &V3<f64>, b: &V3<f64>) -> [f64; 4] {
        let c = cross(a, b);
        let by_slope = cross(&c, &self.t).map(|x| self.inverse * x);
        [by_slope[0], by_slope[1], by_slope[2], dot(&self.t, &c)]
    }

    /// The second derivative of `b·a`, symmetric.
    pub fn second(&self, a: &V3<f64>, b: &V3<f64>) -> [[f64; 4]; 4] {
        let (t, i, ii) = (&self.t, self.inverse, self.inverse * self.inverse);
        let c = cross(&cross(a, b), t);
        let (at, bt, ab) = (cross(a, t), cross(b, t), dot(a, b));
        let beside = cross(&cross(&cross(t, a), b), t);
        let mut h = [[0.0; 4]; 4];
        for r in 0..3 {
            for k in 0..3 {
                let projector = if r == k { 1.0 } else { 0.0 } - t[r] * t[k];
                let smallest = 0.5 * (bt[r] * at[k] + at[r] * bt[k]) - projector * ab;
                h[r][k] = ii * (smallest - t[r] * c[k] - c[r] * t[k]);
            }
            h[r][3] = i * beside[r];
            h[3][r] = h[r][3];
        }
        h[3][3] = dot(a, t) * dot(b, t) - ab;
        h
    }

    /// Angular velocity of the section and its change while the velocities stay, from the velocities of the node.
    pub fn spinning(&self, v: &[f64]) -> [V3<f64>; 2] {
        let (t, rate, w) = (&self.t, three(v, 3), v[6]);
        let (along, side) = (dot(t, &rate), cross(t, &rate));
        let i = self.inverse;
        let omega = std::array::from_fn(|k| i * side[k] + w * t[k]);
        let change = std::array::from_fn(|k| i * (w * (rate[k] - along * t[k]) - 2.0 * i * along * side[k]));
        [omega, change]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::node::NodeKind::Twist;
    use crate::testing::{difference as derivative, second};

    const Q: [f64; 10] = {
        // u normal to the slope
        [0.3, -0.2, 0.5, 0.6, 0.0, 0.8, 0.8, 0.0, -0.6, 0.7]
    };
    const D: [f64; 7] = [0.1, 0.2, -0.3, 0.2, 0.5, -0.4, 0.9];
    const RATE: [f64; 7] = [1.0, 2.0, 3.0, -0.7, 0.8, 1.5, 0.6];

    fn moved(q: &[f64], d: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; 10];
        Twist.retract(q, d, &mut out);
        out
    }

    #[test]
    fn difference_undoes_retract_whatever_the_gauge() {
        let to = moved(&Q, &D);
        let mut back = [0.0; 7];
        Twist.difference(&Q, &to, &mut back);
        assert!(back.iter().zip(D).all(|(a, b)| (a - b).abs() < 1e-14), "{back:?}");
        // reference directors turned forth and angles back
        let gauge = |q: &[f64], chi: f64| {
            let (t, u) = (tangent(q), three(q, 6));
            let (w, (sin, cos)) = (cross(&t, &u), chi.sin_cos());
            let mut out = q.to_vec();
            (0..3).for_each(|i| out[6 + i] = cos * u[i] + sin * w[i]);
            out[9] -= chi;
            out
        };
        Twist.difference(&gauge(&Q, 0.4), &gauge(&to, -1.1), &mut back);
        assert!(back.iter().zip(D).all(|(a, b)| (a - b).abs() < 1e-14), "{back:?}");
    }

    #[test]
    fn velocity_is_the_derivative_of_the_motion_and_rates_undo_it() {
        let bend = [0.4, -0.3, 0.2, 0.7, 0.1, -0.5, 0.3];
        let path =
            |t: f64| -> [f64; 7] { std::array::from_fn(|i| D[i] + t * RATE[i] + 0.5 * t * t * bend[i]) };
        let velocity = |t: f64| {
            let rate: [f64; 7] = std::array::from_fn(|i| RATE[i] + t * bend[i]);
            let mut v = vec![0.0; 7];
            Twist.velocity(&Q, &path(t), &rate, &mut v);
            v
        };
        let now = moved(&Q, &D);
        let exact = derivative(|t| {
            let mut d = vec![0.0; 7];
            Twist.difference(&now, &moved(&Q, &path(t)), &mut d);
            d
        });
        let v = velocity(0.0);
        assert!(v.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-10), "{v:?} {exact:?}");
        assert!((v[6] - RATE[6]).abs() > 1e-2, "the spin is another thing than the rate of the angle");
        let (mut first, mut last) = ([0.0; 7], [0.0; 7]);
        Twist.rates(&Q, &D, &v, &derivative(velocity), &mut first, &mut last);
        assert!(first.iter().zip(RATE).all(|(a, b)| (a - b).abs() < 1e-12));
        assert!(last.iter().zip(bend).all(|(a, b)| (a - b).abs() < 1e-9), "{last:?}");
    }

    #[test]
    fn vectors_of_the_section_have_their_derivatives() {
        let (own, b) = ([0.3, -0.8, 0.5], [0.7, 0.2, -0.4]);
        let see = |q: &[f64]| dot(&b, &crate::algebra::rotation::times(&section(q), &own));
        let a = crate::algebra::rotation::times(&section(&Q), &own);
        let turned = Turned::new(&Q);
        let by = turned.slope(&a, &b);
        let h = turned.second(&a, &b);
        let unit =
            |i: usize, x: f64| -> [f64; 7] { std::array::from_fn(|k| if k == 3 + i { x } else { 0.0 }) };
        for i in 0..4 {
            let exact = derivative(|x| vec![see(&moved(&Q, &unit(i, x)))])[0];
            assert!((by[i] - exact).abs() < 1e-11, "{i}: {} {exact}", by[i]);
            for k in 0..4 {
                // along both, less each alone: twice the mixed derivative
                let along = |signs: [f64; 2]| {
                    second(|x| {
                        let mut d = unit(i, signs[0] * x);
                        d[3 + k] += signs[1] * x;
                        vec![see(&moved(&Q, &d))]
                    })[0]
                };
                let exact = 0.25 * (along([1.0, 1.0]) - along([1.0, -1.0]));
                assert!((h[i][k] - exact).abs() < 1e-8, "{i} {k}: {} {exact}", h[i][k]);
            }
        }
        // along a motion without acceleration
        let [omega, change] = turned.spinning(&RATE);
        let d = |x: f64| RATE.map(|r| x * r);
        let first = derivative(|x| vec![see(&moved(&Q, &d(x)))])[0];
        let last = second(|x| vec![see(&moved(&Q, &d(x)))])[0];
        let once = cross(&omega, &a);
        let twice = cross(&omega, &once);
        assert!((first - dot(&b, &once)).abs() < 1e-10);
        assert!((last - dot(&b, &cross(&change, &a)) - dot(&b, &twice)).abs() < 1e-7);
    }

    #[test]
    fn twist_is_told_as_long_as_an_element_is_open() {
        let node = |x: f64, angle: f64| {
            laid(&[x, 0.0, 0.0], &[angle.cos(), angle.sin(), 0.0], &[0.0, 0.0, 1.0], 0.0)
        };
        // an arc, its middle along x
        let bent = |angle: f64| [node(0.0, -0.5 * angle), node(1.0, 0.5 * angle)];
        for (angle, is) in [(0.0, false), (2.0, false), (2.65, false), (2.75, true), (3.1, true)] {
            let [a, b] = bent(angle);
            assert_eq!(folds([&a, &b]), is, "{angle}");
        }
        let (a, still) = (node(0.0, 0.0), [0.0; 7]);
        let mut turn = still;
        let mut told = |b: [f64; 10], angle: f64| {
            // the slope of a node that turns about z, and its section with it
            turn[3] = angle.cos() - 1.0;
            turn[4] = angle.sin();
            loses_count([&a, &b], [&still, &turn])
        };
        assert_eq!((told(node(1.0, 0.0), 1.0), told(node(1.0, 0.0), 2.9)), (None, Some(FOLDS)));
        assert!(told(node(1.0, 0.0), f64::NAN).is_some());
    }

    #[test]
    fn relabelling_changes_no_section() {
        // four nodes round a cone, each director turned by something
        let mut q: Vec<f64> = Vec::new();
        for k in 0..4 {
            let angle = 1.2 * f64::from(k);
            let p = [0.8 * angle.cos(), 0.8 * angle.sin(), 0.9];
            q.extend(laid(&[0.0; 3], &p, &[0.1, 0.9 - 0.8 * f64::from(k), 1.3], 0.4 * angle));
        }
        let (before, line) = (q.clone(), [0, 10, 20, 30]);
        assert!(relabel(&mut q, &line));
        for k in line {
            let (a, b) = (section(&before[k..]), section(&q[k..]));
            assert!(a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-14));
        }
        assert!(!relabel(&mut q, &line));
        assert!(before[9] == q[9] && before[19] != q[19]);
    }

    /// Neighbours are never far apart, but the last director has turned round more than once against the first.
    #[test]
    fn relabelling_counts_whole_turns() {
        let slope = [1.0, 0.0, 0.0];
        let node = |k: usize| {
            let (sin, cos) = (0.6 * k as f64).sin_cos();
            laid(&[k as f64, 0.0, 0.0], &slope, &[0.0, cos, sin], 0.1 * k as f64)
        };
        let mut q: Vec<f64> = (0..20).flat_map(node).collect();
        let line: Vec<usize> = (0..20).map(|k| 10 * k).collect();
        let twist = |q: &[f64], k: usize| {
            let mut d = [0.0; VELOCITIES];
            difference(&q[10 * k..], &q[10 * k + 10..], &mut d);
            d[6]
        };
        assert!(relabel(&mut q, &line));
        for k in 0..19 {
            assert!((twist(&q, k) - 0.7).abs() < 1e-13, "{k}: {}", twist(&q, k));
        }
        assert!((q[199] - 0.7 * 19.0).abs() < 1e-12, "{}", q[199]);
    }

    /// A shaft that has spun for long counts from anew: its sections stay, and so does its twist.
    #[test]
    fn turns_of_a_whole_line_are_taken_out() {
        let node = |k: f64| laid(&[k, 0.0, 0.0], &[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0], 200.0 + 0.3 * k);
        let mut q: Vec<f64> = (0..5).flat_map(|k| node(f64::from(k))).collect();
        let (before, line) = (q.clone(), [0, 10, 20, 30, 40]);
        assert!(relabel(&mut q, &line) && q[9].abs() < 3.2);
        for k in line {
            let (a, b) = (section(&before[k..]), section(&q[k..]));
            assert!(a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-13));
        }
        assert!(line.windows(2).all(|w| (q[w[1] + 9] - q[w[0] + 9] - 0.3).abs() < 1e-13));
        assert!(!relabel(&mut q, &line));
    }

    #[test]
    fn an_increment_that_turns_a_tangent_round_is_seen() {
        assert!(!flips(&Q, &D));
        let mut d = [0.0; 7];
        (0..3).for_each(|i| d[3 + i] = -2.0 * Q[3 + i] + 0.1 * D[3 + i]);
        assert!(flips(&Q, &d));
        assert!(flips(&Q, &[f64::NAN; 7]));
    }
}
