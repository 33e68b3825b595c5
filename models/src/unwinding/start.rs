//! Consistent starts: a shape divided into segments of equal length, with velocities and accelerations.

use super::problem::{Rule, Unwinding};
use super::state::{Now, State, length, minus, plus};
use ropewalk_core::error::finite;
use ropewalk_core::{BuildError, V3, dot};

impl Unwinding {
    /// The state in which the free cable begins: along the given points, from the eyelet to the lift-off point, which
    /// are joined smoothly. It rests, or turns at `spin` [rad/s] about the axis; `peeled` [m] have been peeled before.
    ///
    /// The points are divided so that all segments are equally long; the free length is the sum of the segments.
    ///
    /// # Errors
    /// Data that make no sense; points that don't begin at the eyelet and end at the lift-off point; velocities at the
    /// lift-off point that don't fit the speed at the start (a jump of the speed); a shape without definite tension.
    pub fn start(&self, points: &[V3<f64>], spin: f64, peeled: f64) -> Result<State, BuildError> {
        self.start_at(0.0, points, spin, peeled)
    }

    /// As [`Unwinding::start`], at a time [s].
    ///
    /// # Errors
    /// See there.
    pub fn start_at(&self, t: f64, points: &[V3<f64>], spin: f64, peeled: f64) -> Result<State, BuildError> {
        self.check()?;
        points.iter().try_for_each(|x| finite("points", x))?;
        let Some(now) = self.now(t, peeled) else {
            let message =
                format!("{peeled} m can't have been peeled: only {} m are wound", self.path.wound());
            return Err(BuildError::at("peeled", message));
        };
        let n = self.elements;
        let (x, ell) = equal(points, n)?;
        let total = n as f64 * ell;
        for (what, k, place) in [("eyelet", 0, self.eyelet), ("lift-off point", n, now.lay.x)] {
            let away = length(&minus(&x[k], &place));
            if !(away < 1e-4 * total) {
                let message =
                    format!("the shape at the start ends {away} m away from the {what} at {place:?}");
                return Err(BuildError::at("points", message));
            }
        }
        let distance = length(&minus(&now.lay.x, &self.eyelet));
        if self.rule == Rule::Length && !(total > distance * (1.0 + 1e-9)) {
            let message = "a straight cable of fixed length between its ends has no definite tension: start from a \
                           slack or curved shape, or let the tension at the eyelet be given";
            return Err(BuildError::at("points", message));
        }
        let speed = now.speed[0];
        let axis = self.path.axis();
        let around = |x: &V3<f64>| cross(&axis, &minus(x, &self.eyelet)).map(|d| spin * d);
        let mut y = State {
            t,
            v: x.iter().map(around).collect(),
            a: vec![[0.0; 3]; n + 1],
            lambda: vec![0.0; n],
            peeled: [peeled, speed, now.speed[1]],
            length: [total, 0.0, 0.0],
            x,
        };
        let jump = length(&plus(&y.v[n], -speed, &now.lay.tangent));
        // a guide has no lift-off point that moves
        let moves = length(&now.lay.tangent) > 0.0;
        if moves && !(jump <= 2e-2 * speed.abs() + 1e-9) {
            let message = format!(
                "the cable is drawn at {speed} m/s from the first moment on, but it starts with {jump} m/s less: let \
                 the speed rise from 0, or start from a steady balloon"
            );
            return Err(BuildError::at("feed", message));
        }
        y.x[0] = self.eyelet;
        self.consistent(&mut y, &now)?;
        self.accelerate(&mut y, &now, 0.0)?;
        Ok(y)
    }

    /// As [`Unwinding::start`], with velocities of the nodes of one's own, which are made to fit the constraint.
    ///
    /// # Errors
    /// See there.
    pub fn start_moving(
        &self,
        points: &[V3<f64>],
        velocity: impl Fn(&V3<f64>) -> V3<f64>,
        peeled: f64,
    ) -> Result<State, BuildError> {
        self.check()?;
        let Some(now) = self.now(0.0, peeled) else {
            return Err(BuildError::at("peeled", format!("{peeled} m can't have been peeled")));
        };
        let (x, ell) = equal(points, self.elements)?;
        let n = self.elements;
        let mut y = State {
            t: 0.0,
            v: x.iter().map(velocity).collect(),
            a: vec![[0.0; 3]; n + 1],
            lambda: vec![0.0; n],
            peeled: [peeled, now.speed[0], now.speed[1]],
            length: [n as f64 * ell, 0.0, 0.0],
            x,
        };
        self.consistent(&mut y, &now)?;
        self.accelerate(&mut y, &now, 0.0)?;
        Ok(y)
    }

    /// Puts the ends where they are held, and the velocities where segments keep their lengths.
    fn consistent(&self, y: &mut State, now: &Now) -> Result<(), BuildError> {
        now.hold(y);
        let n = self.elements;
        // the least change of the velocities: v += Gᵀμ, G Gᵀ μ = -g'; rates of the free length are left to the start of
        // the motion, where the lift-off point peels as fast as the cable is drawn
        let d: Vec<V3<f64>> = (0..n).map(|j| minus(&y.x[j + 1], &y.x[j])).collect();
        let free = |j: usize| if j == 0 || j == n { 0.0 } else { 1.0 };
        let mut diagonal: Vec<f64> = (0..n).map(|j| (free(j) + free(j + 1)) * dot(&d[j], &d[j])).collect();
        let beside: Vec<f64> = (1..n).map(|j| -dot(&d[j - 1], &d[j])).collect();
        let mut rhs: Vec<f64> = (0..n).map(|j| -dot(&d[j], &minus(&y.v[j + 1], &y.v[j]))).collect();
        let scale = dot(&d[0], &d[0]);
        let wrong = rhs.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
        let fastest = y.v.iter().fold(0.0_f64, |m, v| m.max(length(v)));
        if wrong <= 1e-12 * scale.sqrt() * fastest {
            return Ok(());
        }
        for j in 1..n {
            let f = beside[j - 1] / diagonal[j - 1];
            diagonal[j] -= f * beside[j - 1];
            rhs[j] -= f * rhs[j - 1];
        }
        // of a straight cable the last pivot is nothing: its velocities must fit by themselves
        if !(diagonal[n - 1] > 1e-9 * scale) {
            diagonal[n - 1] = f64::INFINITY;
        }
        for j in (0..n).rev() {
            let next = if j + 1 < n { beside[j] * rhs[j + 1] } else { 0.0 };
            rhs[j] = (rhs[j] - next) / diagonal[j];
        }
        for j in 1..n {
            for i in 0..3 {
                y.v[j][i] += rhs[j - 1] * d[j - 1][i] - rhs[j] * d[j][i];
            }
        }
        Ok(())
    }
}

pub(super) fn cross(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Divides a curve through points into `n` equally long segments: their ends, and their length.
pub(super) fn equal(points: &[V3<f64>], n: usize) -> Result<(Vec<V3<f64>>, f64), BuildError> {
    let curve = Curve::new(points)?;
    let end = curve.end();
    // the last node misses the end by an amount that falls with the length of the segments
    let march = |ell: f64| -> (Vec<f64>, f64) {
        let mut at = vec![0.0];
        for _ in 0..n {
            at.push(curve.ahead(at[at.len() - 1], ell));
        }
        let miss = at[n] - end;
        (at, miss)
    };
    let (mut long, mut short) = (end / n as f64 * 1.0001, end / n as f64 * 0.5);
    let mut ell = end / n as f64;
    for _ in 0..100 {
        let (_, miss) = march(ell);
        if miss.abs() <= 1e-15 * end {
            break;
        }
        if miss > 0.0 {
            long = ell
        } else {
            short = ell
        }
        let next = ell - miss / n as f64;
        let next = if next > short && next < long { next } else { 0.5 * (short + long) };
        if next == ell || long - short < 1e-16 * end {
            break;
        }
        ell = next;
    }
    let (at, _) = march(ell);
    let mut x: Vec<V3<f64>> = at.iter().map(|s| curve.at(*s)).collect();
    x[n] = points[points.len() - 1];
    Ok((x, ell))
}

/// A curve through points, of fifth degree through the six nearest, over the length of the chords.
struct Curve<'a> {
    points: &'a [V3<f64>],
    s: Vec<f64>,
}

impl<'a> Curve<'a> {
    fn new(points: &'a [V3<f64>]) -> Result<Self, BuildError> {
        if points.len() < 2 {
            return Err(BuildError::at("points", "a shape needs two points or more"));
        }
        let mut s = vec![0.0];
        for k in 1..points.len() {
            let chord = length(&minus(&points[k], &points[k - 1]));
            if !(chord > 0.0 && chord.is_finite()) {
                return Err(BuildError::at("points", format!("points {k} and {} coincide", k + 1)));
            }
            s.push(s[k - 1] + chord);
        }
        Ok(Curve { points, s })
    }
    fn end(&self) -> f64 {
        self.s[self.s.len() - 1]
    }
    fn at(&self, s: f64) -> V3<f64> {
        let (n, k) = (self.s.len(), self.s.partition_point(|x| *x <= s));
        let from = k.saturating_sub(3).min(n.saturating_sub(6));
        let range = from..n.min(from + 6);
        let mut x = [0.0; 3];
        for a in range.clone() {
            let others = range.clone().filter(|b| *b != a);
            let w: f64 = others.map(|b| (s - self.s[b]) / (self.s[a] - self.s[b])).product();
            x = plus(&x, w, &self.points[a]);
        }
        x
    }
    /// Where a chord of length `ell` from `s` ends.
    fn ahead(&self, s: f64, ell: f64) -> f64 {
        let p = self.at(s);
        let miss = |u: f64| length(&minus(&self.at(u), &p)) - ell;
        let (mut u, mut v) = (s + ell, s + 1.001 * ell);
        let (mut fu, mut fv) = (miss(u), miss(v));
        for _ in 0..30 {
            if fv == fu || fv.abs() < 1e-16 * ell {
                break;
            }
            let w = v - fv * (v - u) / (fv - fu);
            (u, fu, v) = (v, fv, w);
            fv = miss(v);
        }
        v
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_are_equal_and_on_the_curve() {
        let helix = |a: f64| [0.06 * a.cos(), 0.06 * a.sin(), 0.02 * a];
        let points: Vec<V3<f64>> = (0..41).map(|k| helix(0.05 * k as f64)).collect();
        let (x, ell) = equal(&points, 17).unwrap();
        for w in x.windows(2) {
            assert!((length(&minus(&w[1], &w[0])) / ell - 1.0).abs() < 1e-12);
        }
        for p in &x {
            let on = helix(p[2] / 0.02);
            assert!(length(&minus(p, &on)) < 1e-9);
        }
    }

    #[test]
    fn a_straight_line_is_divided_evenly() {
        let (x, ell) = equal(&[[0.0; 3], [0.3, 0.0, 0.4]], 10).unwrap();
        assert!((ell - 0.05).abs() < 1e-15);
        assert!((x[5][0] - 0.15).abs() < 1e-15);
    }
}
