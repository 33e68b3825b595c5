//! A point beside the axis of a cable with torsion, that its section carries along: a lever.

use crate::algebra::jet::Jet;
use crate::algebra::lane::{V3, dot};
use crate::algebra::rotation::{along, cross, times};
use crate::model::twist::{Turned, section};
use num_dual::Dual64;

/// The arm of a lever in space, with how the section that it stands on turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lever {
    /// The arm in space [m].
    pub arm: V3<f64>,
    t: V3<f64>,
    /// One over the length of the slope.
    inverse: f64,
    /// Coordinates of the node.
    q: [f64; 10],
}

/// How a section turns: its tangent, one over the length of its slope, its arm, and rates of slope and spin.
struct Swing<S> {
    t: V3<S>,
    inverse: S,
    arm: V3<S>,
    rate: V3<S>,
    spin: S,
    second: V3<S>,
    third: S,
}

fn plus<S: Jet>(a: V3<S>, s: S, b: &V3<S>) -> V3<S> {
    std::array::from_fn(|i| a[i] + s * b[i])
}

impl<S: Jet> Swing<S> {
    fn omega(&self) -> V3<S> {
        let side = cross(&self.t, &self.rate);
        plus(side.map(|x| x * self.inverse), self.spin, &self.t)
    }
    /// `ω × a`
    fn velocity(&self) -> V3<S> {
        cross(&self.omega(), &self.arm)
    }
    /// `ω̇ × a + ω × (ω × a)`
    fn acceleration(&self) -> V3<S> {
        let (along, side, i) = (along(&self.t, &self.rate), cross(&self.t, &self.rate), self.inverse);
        let turned = cross(&self.t, &self.second);
        let mut alpha = plus(turned.map(|x| x * i), self.third, &self.t);
        alpha = plus(alpha, i * self.spin, &plus(self.rate, -along, &self.t));
        alpha = plus(alpha, i * i * along * -2.0, &side);
        let (omega, first) = (self.omega(), cross(&alpha, &self.arm));
        plus(first, S::one(), &cross(&omega, &self.velocity()))
    }
}

impl Lever {
    /// Of the node whose coordinates begin here, with this arm in the axes of its section.
    pub fn new(q: &[f64], arm: &V3<f64>) -> Self {
        let q: [f64; 10] = std::array::from_fn(|i| q[i]);
        let p = [q[3], q[4], q[5]];
        let inverse = 1.0 / dot(&p, &p).sqrt();
        Lever { arm: times(&section(&q), arm), t: p.map(|x| inverse * x), inverse, q }
    }

    /// Where the point is [m].
    pub fn x(&self) -> V3<f64> {
        std::array::from_fn(|i| self.q[i] + self.arm[i])
    }

    /// How it moves by the slope and the spin.
    pub fn by(&self) -> [V3<f64>; 4] {
        let unit = |k: usize| -> V3<f64> { std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 }) };
        std::array::from_fn(|k| {
            let turn = if k < 3 { cross(&self.t, &unit(k)).map(|x| self.inverse * x) } else { self.t };
            cross(&turn, &self.arm)
        })
    }

    /// The second derivative of `f · x` by the slope and the spin, symmetric.
    pub fn second(&self, f: &V3<f64>) -> [[f64; 4]; 4] {
        Turned::new(&self.q).second(&self.arm, f)
    }

    /// The swing with velocities and accelerations of its node, as it changes with number `k` of slope and spin if `moved`, of
    /// their rates else.
    fn swing(&self, v: &[f64], a: &[f64], by: Option<(usize, bool)>) -> Swing<Dual64> {
        let with = |x: f64, d: f64| Dual64::new(x, d);
        let of = |x: &[f64], from: usize, d: Option<usize>| -> V3<Dual64> {
            std::array::from_fn(|i| with(x[from + i], if d == Some(i) { 1.0 } else { 0.0 }))
        };
        let (moved, rated) = match by {
            Some((k, true)) => (Some(k), None),
            Some((k, false)) => (None, Some(k)),
            None => (None, None),
        };
        let along_t = |k: usize| if k < 3 { self.t[k] } else { 0.0 };
        let slid = |i: usize| match moved {
            Some(k) if k < 3 => self.inverse * (if i == k { 1.0 } else { 0.0 } - self.t[i] * self.t[k]),
            _ => 0.0,
        };
        let turned = moved.map_or([0.0; 3], |k| self.by()[k]);
        let shrunk = moved.map_or(0.0, |k| -self.inverse * self.inverse * along_t(k));
        Swing {
            t: std::array::from_fn(|i| with(self.t[i], slid(i))),
            inverse: with(self.inverse, shrunk),
            arm: std::array::from_fn(|i| with(self.arm[i], turned[i])),
            rate: of(v, 3, rated),
            spin: with(v[6], if rated == Some(3) { 1.0 } else { 0.0 }),
            second: of(a, 3, None),
            third: Dual64::from(a[6]),
        }
    }

    /// Velocity relative to its node, and what it changes by with slope and angle [m/s].
    pub fn velocity(&self, v: &[f64]) -> (V3<f64>, [V3<f64>; 4]) {
        let none = [0.0; 7];
        let of = |by| self.swing(v, &none, by).velocity();
        (of(None).map(|x| x.re), std::array::from_fn(|k| of(Some((k, true))).map(|x| x.eps)))
    }

    /// Acceleration relative to its node [m/s²], and what it changes by with the rates of slope and spin, and with themselves.
    pub fn acceleration(&self, v: &[f64], a: &[f64]) -> (V3<f64>, [[V3<f64>; 4]; 2]) {
        let of = |by| self.swing(v, a, by).acceleration();
        let by = [false, true].map(|moved| std::array::from_fn(|k| of(Some((k, moved))).map(|x| x.eps)));
        (of(None).map(|x| x.re), by)
    }
}
