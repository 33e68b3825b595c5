//! The state of the free cable on its grid, and what is prescribed at an instant.

use super::problem::Unwinding;
use ropewalk_constraints::package::Lay;
use ropewalk_core::V3;

/// The free cable at an instant: `N + 1` nodes at fixed shares `ζ = s/L(t)` of its length, from the eyelet to the
/// lift-off point. Velocities and accelerations are those of the nodes; the material runs through them.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Time [s].
    pub t: f64,
    /// Positions of the nodes [m].
    pub x: Vec<V3<f64>>,
    /// Velocities of the nodes [m/s].
    pub v: Vec<V3<f64>>,
    /// Accelerations of the nodes [m/s²].
    pub a: Vec<V3<f64>>,
    /// Multiplier `λ` of inextensibility in each segment [N]: the tension less `EI κ²`.
    pub lambda: Vec<f64>,
    /// Length peeled from the package, with its first two rates.
    pub peeled: [f64; 3],
    /// Free length, with its first two rates.
    pub length: [f64; 3],
}

impl State {
    /// How many segments there are.
    pub fn segments(&self) -> usize {
        self.lambda.len()
    }
    /// Position of the node nearest to a share of the length.
    pub fn at(&self, zeta: f64) -> usize {
        (zeta * self.segments() as f64).round() as usize
    }
}

/// What the grid needs to know beside the state: speed, and where and how the cable is held.
#[derive(Clone, Copy, Debug)]
pub(super) struct Now {
    pub t: f64,
    /// Speed through the eyelet and its rate.
    pub speed: [f64; 2],
    pub lay: Lay,
    /// Direction of the cable where it is held at the lift-off point.
    pub clamp: V3<f64>,
}

/// How velocities and accelerations change with what is solved for: `δx = x δ`, `δv = v δ`, `δa = a δ`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates {
    pub x: f64,
    pub v: M3,
    pub a: M3,
}

pub(super) type M3 = [V3<f64>; 3];

pub(super) fn identity(scale: f64) -> M3 {
    [[scale, 0.0, 0.0], [0.0, scale, 0.0], [0.0, 0.0, scale]]
}
pub(super) fn times(m: &M3, x: &V3<f64>) -> V3<f64> {
    [0, 1, 2].map(|i| m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2])
}
pub(super) fn product(a: &M3, b: &M3) -> M3 {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}
/// `a + f b`
pub(super) fn plus(a: &V3<f64>, f: f64, b: &V3<f64>) -> V3<f64> {
    [a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]]
}
pub(super) fn minus(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
pub(super) fn length(a: &V3<f64>) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

impl Rates {
    /// The change of a residual's block `[by x, by v, by a]` with what is solved for.
    pub fn apply(&self, block: &[M3; 3]) -> M3 {
        let (v, a) = (product(&block[1], &self.v), product(&block[2], &self.a));
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| self.x * block[0][i][j] + v[i][j] + a[i][j]))
    }
}

/// How the length, the lift-off point and the clamp change with the one scalar unknown, if there is one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Column {
    pub length: [f64; 3],
    /// Position, velocity and acceleration of the last node.
    pub end: [V3<f64>; 3],
    pub clamp: V3<f64>,
}

impl Unwinding {
    /// What is prescribed at time `t` with a length `sigma` peeled; nothing when the package is empty.
    pub(super) fn now(&self, t: f64, sigma: f64) -> Option<Now> {
        let lay = self.path.at(sigma)?;
        let clamp = self.path.clamp(&lay);
        Some(Now { t, speed: self.speed(t), lay, clamp })
    }
}

impl Now {
    /// Puts the last node where the lift-off point is, with its velocity and acceleration.
    pub fn hold(&self, y: &mut State) {
        let [_, rate, rise] = y.peeled;
        let n = y.segments();
        y.x[n] = self.lay.x;
        y.v[n] = self.lay.tangent.map(|d| rate * d);
        y.a[n] = [0, 1, 2].map(|i| rise * self.lay.tangent[i] + rate * rate * self.lay.curvature[i]);
    }

    /// How all that changes with the peeled length, whose rates change by `v` and `a` times as much. The third
    /// derivative of the path is left out beside `1/h²`.
    pub fn by_peeled(&self, y: &State, x: f64, v: f64, a: f64) -> Column {
        let [_, rate, rise] = y.peeled;
        let (d, dd) = (&self.lay.tangent, &self.lay.curvature);
        let velocity = [0, 1, 2].map(|i| x * rate * dd[i] + v * d[i]);
        let acceleration = [0, 1, 2].map(|i| (x * rise + 2.0 * v * rate) * dd[i] + a * d[i]);
        Column {
            length: [x, v, a],
            end: [d.map(|d| x * d), velocity, acceleration],
            clamp: dd.map(|d| x * d),
        }
    }
}
