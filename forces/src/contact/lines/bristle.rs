//! The bristle between two lines that press each other, and how its force moves with all that moves either.
//!
//! It ties a place on the first, `x₁`, to one on the second, `x₂`. With `w = x₁ - x₂` and the directions `b₁`, `b₂` of both
//! lines there, `α_k = w·b_k` don't change as both turn together, so that forces that do work on nothing else are in balance,
//! and their moments too: the couple of two forces that are a diameter apart bends the lines. What changes of `α` since
//! the place took hold is the stretch `e` in components; with `A_kl = b_k·b_l` its square is `eᵀA⁻¹e`, and `h = -A⁻¹(k e + c ė)`
//! pulls on `x₁` with `Σ h_k b_k`.
//!
//! Lines that are nearly parallel can't take a couple about their common direction, since they don't know twist: they roll on
//! each other. There `A` is stiffened by `λ` towards the difference of both directions, and friction across fades.

use super::super::seat::minus;
use super::push::{BOTH, Pressed};
use ropewalk_core::held::{Held, MOST, Motion};
use ropewalk_core::{At, SpanLine, V3, Weights, dot};

/// How much `A` is stiffened between parallel lines, and the square of the cosine from which on it is: of 30°.
const ROLLS: f64 = 0.1;
const NEARLY: f64 = 0.75;
/// What a force may be beyond the limit and still be held: rounding of the limit itself.
const SLACK: f64 = 1e-7;

/// A direction along a line, with its motion.
struct Way {
    b: V3<f64>,
    rate: V3<f64>,
    by_q: [V3<f64>; MOST],
    v_by_q: [V3<f64>; MOST],
    /// On a body: both of its ends, and how far they are apart.
    ends: Option<([Motion; 2], f64)>,
}

impl Way {
    fn new(line: &SpanLine, xi: f64, at: &At<'_>) -> Self {
        match *line {
            SpanLine::Cubic { q, v, l } => {
                let (rest, s) = (1.0 - xi, 6.0 * xi * (1.0 - xi) / l);
                let weight = [-s, rest * (1.0 - 3.0 * xi), s, xi * (3.0 * xi - 2.0)];
                let Motion { x, v, by_q, v_by_q, .. } = Held::Between { q, v, weight }.motion(at);
                Way { b: x, rate: v, by_q, v_by_q, ends: None }
            }
            SpanLine::Straight { ends: [a, b], .. } => {
                let way = minus(&b, &a);
                let length = dot(&way, &way).sqrt();
                let ends = [0.0, 1.0].map(|xi| line.held(xi).motion(at));
                let by = |a: &V3<f64>, b: &V3<f64>| minus(b, a).map(|x| x / length);
                let [a, b] = &ends;
                Way {
                    b: by(&a.x, &b.x),
                    rate: by(&a.v, &b.v),
                    by_q: std::array::from_fn(|k| by(&a.by_q[k], &b.by_q[k])),
                    v_by_q: std::array::from_fn(|k| by(&a.v_by_q[k], &b.v_by_q[k])),
                    ends: Some((ends, length)),
                }
            }
        }
    }

    fn turning(&self, f: &V3<f64>) -> Option<[V3<f64>; 3]> {
        let ([a, b], length) = self.ends.as_ref()?;
        let (a, b) = (a.turning(f)?, b.turning(f)?);
        Some(std::array::from_fn(|i| std::array::from_fn(|j| (b[i][j] - a[i][j]) / length)))
    }
}

/// The stretch of a bristle, its rate, and what measures it.
pub(crate) struct Bristle {
    one: Motion,
    other: Motion,
    ways: [Way; 2],
    w: V3<f64>,
    w_rate: V3<f64>,
    /// `α` and its rate.
    pub alpha: [f64; 2],
    pub rate: [f64; 2],
    /// `A`, and `A` as it is stiffened.
    a: [f64; 3],
    stiff: [f64; 3],
}

/// What a bristle does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold {
    /// Force by component, and what it would be if it held however hard it is pulled.
    pub h: [f64; 2],
    trial: [f64; 2],
    /// What would pull it so: `-k e - c ė`.
    beta: [f64; 2],
    /// The size of what it would be, and the part of it that is there.
    size: f64,
    share: f64,
    pub slips: bool,
}

fn solve(a: &[f64; 3], x: [f64; 2]) -> [f64; 2] {
    let det = a[0] * a[2] - a[1] * a[1];
    [(a[2] * x[0] - a[1] * x[1]) / det, (a[0] * x[1] - a[1] * x[0]) / det]
}

fn times(a: &[f64; 3], x: [f64; 2]) -> [f64; 2] {
    [a[0] * x[0] + a[1] * x[1], a[1] * x[0] + a[2] * x[1]]
}

fn pair(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// How much is stiffened, and how that grows with the entries of `A`.
fn stiffened(a: &[f64; 3]) -> (f64, [f64; 3]) {
    let c = a[1] * a[1] / (a[0] * a[2]);
    let u = ((c - NEARLY) / (1.0 - NEARLY)).max(0.0);
    let slope = 2.0 * ROLLS * u / (1.0 - NEARLY);
    (ROLLS * u * u, [-slope * c / a[0], 2.0 * slope * a[1] / (a[0] * a[2]), -slope * c / a[2]])
}

impl Bristle {
    /// Between places of two lines.
    pub fn new(lines: [&SpanLine; 2], xi: [f64; 2], at: &At<'_>) -> Self {
        let [one, other] = [0, 1].map(|k| lines[k].held(xi[k]).motion(at));
        let ways = [0, 1].map(|k| Way::new(lines[k], xi[k], at));
        let (w, w_rate) = (minus(&one.x, &other.x), minus(&one.v, &other.v));
        let alpha = [0, 1].map(|k| dot(&w, &ways[k].b));
        let rate = [0, 1].map(|k| dot(&w_rate, &ways[k].b) + dot(&w, &ways[k].rate));
        let by = |k: usize, l: usize| dot(&ways[k].b, &ways[l].b);
        let a = [by(0, 0), by(0, 1), by(1, 1)];
        let half = 0.5 * stiffened(&a).0;
        let stiff = [a[0] + half, a[1] - half.copysign(a[1]), a[2] + half];
        Bristle { one, other, ways, w, w_rate, alpha, rate, a, stiff }
    }

    /// The size of a force that holds a stretch with this stiffness.
    pub fn size(&self, k: f64, stretch: [f64; 2]) -> f64 {
        k * pair(stretch, solve(&self.stiff, stretch)).max(0.0).sqrt()
    }

    /// The force that pulls with so much [N].
    pub fn force(&self, h: [f64; 2]) -> f64 {
        pair(h, times(&self.a, h)).max(0.0).sqrt()
    }

    /// What a bristle of this stiffness and damping does where at most `limit` can be held [N].
    pub fn hold(&self, [k, c]: [f64; 2], stretch: [f64; 2], limit: f64) -> Hold {
        let beta = [0, 1].map(|n| -k * stretch[n] - c * self.rate[n]);
        let trial = solve(&self.stiff, beta);
        let size = pair(trial, beta).max(0.0).sqrt();
        let slips = size > limit * (1.0 + SLACK);
        let share = if slips { limit / size } else { 1.0 };
        Hold { h: trial.map(|h| share * h), trial, beta, size, share, slips }
    }

    /// What it takes up [W].
    pub fn heat(&self, hold: &Hold) -> f64 {
        -pair(hold.h, self.rate)
    }

    /// Adds its force to the residual, and, where weights are given, its derivative; friction holds `mu` times what presses.
    /// `place` says which of the unknowns those of each piece are, `n` how many there are.
    pub fn add(
        &self,
        hold: &Hold,
        ([k, c], mu): ([f64; 2], f64),
        pressed: &Pressed,
        place: [&[usize]; 2],
        n: usize,
        w: Option<Weights>,
        sum: &mut super::push::Sum,
    ) {
        let zero = [[0.0; 3]; BOTH];
        // how the way between both places and the directions move, and their velocities
        let (mut w_q, mut w_vq, mut b_q, mut b_vq) = (zero, zero, [zero; 2], [zero; 2]);
        for (motion, way, side, sign) in
            [(&self.one, &self.ways[0], 0, 1.0), (&self.other, &self.ways[1], 1, -1.0)]
        {
            for (m, &p) in place[side].iter().enumerate() {
                for i in 0..3 {
                    w_q[p][i] += sign * motion.by_q[m][i];
                    w_vq[p][i] += sign * motion.v_by_q[m][i];
                    b_q[side][p][i] += way.by_q[m][i];
                    b_vq[side][p][i] += way.v_by_q[m][i];
                }
            }
        }
        let ways = &self.ways;
        let slope: [[f64; BOTH]; 2] = std::array::from_fn(|s| {
            std::array::from_fn(|p| dot(&w_q[p], &ways[s].b) + dot(&self.w, &b_q[s][p]))
        });
        let h = hold.h;
        for p in 0..n {
            sum.r[p] -= h[0] * slope[0][p] + h[1] * slope[1][p];
        }
        let Some(w) = w else { return };
        let (_, by_a) = stiffened(&self.a);
        let sign = 1.0_f64.copysign(self.a[1]);
        for q in 0..n {
            let turned = |s: usize| {
                dot(&w_vq[q], &ways[s].b)
                    + dot(&self.w_rate, &b_q[s][q])
                    + dot(&w_q[q], &ways[s].rate)
                    + dot(&self.w, &b_vq[s][q])
            };
            let by = |s: usize| -(w.q * (k * slope[s][q] + c * turned(s)) + w.v * c * slope[s][q]);
            let d_beta = [by(0), by(1)];
            let d_a = [
                2.0 * w.q * dot(&ways[0].b, &b_q[0][q]),
                w.q * (dot(&b_q[0][q], &ways[1].b) + dot(&ways[0].b, &b_q[1][q])),
                2.0 * w.q * dot(&ways[1].b, &b_q[1][q]),
            ];
            let half = 0.5 * (by_a[0] * d_a[0] + by_a[1] * d_a[1] + by_a[2] * d_a[2]);
            let d_stiff = [d_a[0] + half, d_a[1] - sign * half, d_a[2] + half];
            let moved = times(&d_stiff, hold.trial);
            let mut dh = solve(&self.stiff, [d_beta[0] - moved[0], d_beta[1] - moved[1]]);
            if hold.share < 1.0 {
                let grown = (pair(hold.trial, d_beta) - 0.5 * pair(hold.trial, moved)) / hold.size;
                let more = (mu * pressed.by[q] - hold.share * grown) / hold.size;
                dh = [0, 1].map(|s| hold.share * dh[s] + hold.trial[s] * more);
            }
            for p in 0..n {
                let bent = |s: usize| dot(&w_q[p], &b_q[s][q]) + dot(&b_q[s][p], &w_q[q]);
                sum.k[p][q] -=
                    dh[0] * slope[0][p] + dh[1] * slope[1][p] + w.q * (h[0] * bent(0) + h[1] * bent(1));
            }
        }
        self.add_turning(h, place, w, sum);
    }

    /// What the turning of a body makes of a constant force.
    fn add_turning(&self, h: [f64; 2], place: [&[usize]; 2], w: Weights, sum: &mut super::push::Sum) {
        let f: V3<f64> = std::array::from_fn(|i| h[0] * self.ways[0].b[i] + h[1] * self.ways[1].b[i]);
        for (motion, side, sign) in [(&self.one, 0, 1.0), (&self.other, 1, -1.0)] {
            let of_place = motion.turning(&f.map(|x| sign * x));
            let of_way = self.ways[side].turning(&self.w.map(|x| h[side] * x));
            for turning in [of_place, of_way].into_iter().flatten() {
                for i in 0..3 {
                    for j in 0..3 {
                        sum.k[place[side][3 + i]][place[side][3 + j]] -= w.q * turning[i][j];
                    }
                }
            }
        }
    }
}

impl Hold {
    /// Whether the force that it would have if it held has turned round since an iteration at which it was stretched at
    /// rates that were less by `by`, where the iteration moves places and velocities by these weights.
    pub fn turned(&self, [k, c]: [f64; 2], by: [f64; 2], w: Weights) -> bool {
        let more = k * w.q / w.v + c;
        pair(self.trial, self.beta) + more * pair(self.trial, by) < 0.0
    }

    /// Takes it for one that holds, however hard it is pulled.
    pub fn stick(&mut self) {
        (self.h, self.share) = (self.trial, 1.0);
    }
}
