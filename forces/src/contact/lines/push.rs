//! The force between a place of one piece and the nearest point of another, and its derivative by all that moves either.
//!
//! With the unknowns `z` of both, the way `w = x₁(ξ) - x₂(t)`, its derivative `S = ∂w/∂z` at a fixed `t`, the normal
//! `n = w/d`, `P = (1 - n nᵀ)/d` and `b = ∂x₂/∂t`: `∂d/∂z = Sᵀn`, and the nearest point moves by `δt = -c·δz/h` with
//! `c = -SᵀP b - (∂b/∂z)ᵀn` and `h = b·P b - n·∂b/∂t`, so that `∂²d/∂z² = SᵀP S - c cᵀ/h`. Where the point is held at a tip
//! the second part is missing.

use super::super::law::{ContactLaw, Normal};
use super::super::seat::minus;
use super::curve::size;
use super::facing::Nearest;
use ropewalk_core::held::{Held, MOST, Motion, three};
use ropewalk_core::rotation::around;
use ropewalk_core::{At, SpanLine, V3, Weights, dot};

/// More unknowns than two pieces have.
pub(crate) const BOTH: usize = 2 * MOST;

/// A place that touches.
pub(crate) struct Push {
    /// Motion of the place, of the nearest point, and of the derivative of that by `t`.
    one: Motion,
    other: Motion,
    along: Along,
    normal: V3<f64>,
    distance: f64,
    free: bool,
    /// `h`
    steep: f64,
    force: Normal,
    pub depth: f64,
    pub rate: f64,
    /// Where it is along both.
    pub xi: [f64; 2],
}

/// What presses a cell of one piece on another.
#[derive(Clone, Copy)]
pub(crate) struct Pressed {
    /// Normal force [N].
    pub normal: f64,
    /// The same times the place on each.
    at: [f64; 2],
    /// Its weighted derivative by the unknowns of both.
    pub by: [f64; BOTH],
}

impl Pressed {
    pub const NONE: Pressed = Pressed { normal: 0.0, at: [0.0; 2], by: [0.0; BOTH] };

    pub fn add(&mut self, push: &Push) {
        self.normal += push.force.force;
        (0..2).for_each(|k| self.at[k] += push.force.force * push.xi[k]);
    }
    /// Where it presses in the mean, if anything does.
    pub fn place(&self) -> Option<[f64; 2]> {
        (self.normal > 0.0).then(|| self.at.map(|x| x / self.normal))
    }
}

/// How the derivative of a point by its place moves.
struct Along {
    b: V3<f64>,
    rate: V3<f64>,
    by_q: [V3<f64>; MOST],
}

/// What is added to the equations of two pieces.
pub(crate) struct Sum {
    pub r: [f64; BOTH],
    pub k: [[f64; BOTH]; BOTH],
    pub touched: bool,
}

impl Default for Sum {
    fn default() -> Self {
        Sum { r: [0.0; BOTH], k: [[0.0; BOTH]; BOTH], touched: false }
    }
}

impl Sum {
    /// Empty again, of the first unknowns.
    pub fn clear(&mut self, n: usize) {
        if self.touched {
            self.r = [0.0; BOTH];
            self.k[..n].iter_mut().for_each(|row| row[..n].fill(0.0));
            self.touched = false;
        }
    }
}

/// `∂x/∂ξ` of a line, with how that moves.
fn along(line: &SpanLine, t: f64, at: &At<'_>) -> Along {
    match *line {
        SpanLine::Cubic { q, v, l } => {
            let (rest, s) = (1.0 - t, 6.0 * t * (1.0 - t));
            let weight = [-s, l * rest * (1.0 - 3.0 * t), s, l * t * (3.0 * t - 2.0)];
            let held = Held::Between { q, v, weight };
            let mut by_q = [[0.0; 3]; MOST];
            (0..12).for_each(|k| by_q[k][k % 3] = weight[k / 3]);
            Along { b: held.x(at), rate: held.velocity(at), by_q }
        }
        SpanLine::Straight { .. } => {
            let [a, b] = [line.held(0.0).motion(at), line.held(1.0).motion(at)];
            let by_q = std::array::from_fn(|k| minus(&b.by_q[k], &a.by_q[k]));
            Along { b: minus(&b.x, &a.x), rate: minus(&b.v, &a.v), by_q }
        }
    }
}

/// `∂²x/∂ξ²` of a line.
fn second(line: &SpanLine, t: f64, at: &At<'_>) -> V3<f64> {
    let SpanLine::Cubic { q, l, .. } = line else { return [0.0; 3] };
    let s = 12.0 * t - 6.0;
    let weight = [s, l * (6.0 * t - 4.0), -s, l * (6.0 * t - 2.0)];
    std::array::from_fn(|i| (0..4).map(|n| weight[n] * three(at.q, q[n])[i]).sum())
}

impl Push {
    /// The force at `ξ` of a line whose nearest point on another is known; nothing if they don't touch.
    pub fn new(
        law: &ContactLaw,
        [one, other]: [&SpanLine; 2],
        (xi, nearest): (f64, Nearest),
        thick: f64,
        k: f64,
        at: &At<'_>,
    ) -> Option<Self> {
        let own = one.held(xi);
        let near = other.held(nearest.t);
        let way = minus(&own.x(at), &near.x(at));
        let distance = size(&way);
        let depth = thick - distance;
        if !(depth > 0.0) {
            return None;
        }
        let along = along(other, nearest.t, at);
        // where both middle lines meet any direction leads out
        let normal = if distance > 0.0 { way.map(|w| w / distance) } else { around(along.b)[1] };
        let (one, near) = (own.motion(at), near.motion(at));
        let rate = -dot(&normal, &minus(&one.v, &near.v));
        let force = law.normal(k, depth, rate);
        let across = dot(&along.b, &along.b) - dot(&normal, &along.b).powi(2);
        let steep = across / distance - dot(&normal, &second(other, nearest.t, at));
        let free = nearest.free && steep > 0.0 && distance > 0.0;
        Some(Push {
            one,
            other: near,
            along,
            normal,
            distance,
            free,
            steep,
            force,
            depth,
            rate,
            xi: [xi, nearest.t],
        })
    }

    /// The force [N], and its elastic part.
    pub fn normal(&self) -> (f64, f64) {
        (self.force.force, self.force.elastic)
    }

    /// Adds it to the residual, and its derivative to the tangent where weights are given. `place` says which of the
    /// unknowns those of each piece are, `n` how many there are; `pressed` is what it presses.
    pub fn add(
        &self,
        place: [&[usize]; 2],
        n: usize,
        w: Option<Weights>,
        sum: &mut Sum,
        pressed: Option<&mut Pressed>,
    ) {
        let Push { one, other, along, normal, force, .. } = self;
        sum.touched = true;
        let zero = [[0.0; 3]; BOTH];
        let (mut s, mut s_t, mut v_q) = (zero, zero, zero);
        for (motion, place, sign) in [(one, place[0], 1.0), (other, place[1], -1.0)] {
            for (k, &p) in place.iter().enumerate() {
                for i in 0..3 {
                    s[p][i] += sign * motion.by_q[k][i];
                    v_q[p][i] += sign * motion.v_by_q[k][i];
                }
            }
        }
        let s_n: [f64; BOTH] = std::array::from_fn(|a| dot(&s[a], normal));
        for a in 0..n {
            sum.r[a] -= force.force * s_n[a];
        }
        let Some(w) = w else { return };
        for (k, &p) in place[1].iter().enumerate() {
            (0..3).for_each(|i| s_t[p][i] -= along.by_q[k][i]);
        }
        // P b, and the shares of the nearest point's own motion
        let inverse = if self.distance > 0.0 { 1.0 / self.distance } else { 0.0 };
        let across = |x: &V3<f64>| -> V3<f64> {
            let n = dot(x, normal);
            std::array::from_fn(|i| inverse * (x[i] - n * normal[i]))
        };
        let p_b = across(&along.b);
        let c: [f64; BOTH] =
            std::array::from_fn(|a| if self.free { dot(&s_t[a], normal) - dot(&s[a], &p_b) } else { 0.0 });
        let per = if self.free { 1.0 / self.steep } else { 0.0 };
        let slip = minus(&one.v, &other.v);
        let p_slip = across(&slip);
        let turned = dot(&p_b, &slip) + dot(normal, &along.rate);
        let mut by_all = pressed.map(|p| &mut p.by);
        for b in 0..n {
            let by_q = -force.by_depth * s_n[b]
                - force.by_rate * (dot(&s[b], &p_slip) + dot(normal, &v_q[b]) + turned * per * c[b]);
            let by = w.q * by_q - w.v * force.by_rate * s_n[b];
            if let Some(all) = &mut by_all {
                all[b] += by;
            }
            let bent = across(&s[b]);
            let share = per * c[b];
            for a in 0..n {
                let curved = dot(&s[a], &bent) - c[a] * share;
                sum.k[a][b] -= by * s_n[a] + w.q * force.force * curved;
            }
        }
        for (motion, place, sign) in [(one, place[0], 1.0), (other, place[1], -1.0)] {
            let f = normal.map(|x| sign * force.force * x);
            let Some(turning) = motion.turning(&f) else { continue };
            for i in 0..3 {
                for j in 0..3 {
                    sum.k[place[3 + i]][place[3 + j]] -= w.q * turning[i][j];
                }
            }
        }
    }
}
