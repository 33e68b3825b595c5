//! Springs and dampers between two frames, on rigid bodies and on cables with torsion: bushings, and torsion springs.

pub(crate) mod frames;
mod spec;

pub use spec::{BushingSpec, RotationalSpringSpec};

use crate::signals::{change, least, now, rate, reach};
use frames::{Frames, Pose, Wrench, between};
use ropewalk_core::error::{finite, not_negative};
use ropewalk_core::rotation::{cross, matrix, times, transposed_times};
use ropewalk_core::{
    Assembly, At, BuildError, Energy, Jet, Marker, Node, Pattern, Power, Signal, Term, Timed, V3,
};
use std::f64::consts::{PI, TAU};

/// A spring and damper in all directions: of the second marker's place `d` and rotation vector `φ` as seen from the first
/// marker's axes, `F = -k d - c ḋ` and, from the energy `½ φ·κφ`, a moment that is `-κφ` for small angles.
///
/// The rotation vector is the shorter way round, so `|φ|` stays below π; beyond, the moment jumps to the other side. Both
/// bodies feel the force at the second marker's point, so momentum and angular momentum are kept whatever the distance.
/// Use it for: rubber mounts, soft joints, a weld that gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Bushing {
    /// A name, such as `mount`.
    pub label: String,
    /// Stiffness by axis of the first marker [N/m].
    pub stiffness: [Signal; 3],
    /// Damping by axis [N s/m].
    pub damping: [Signal; 3],
    /// Rotational stiffness by axis [N m/rad].
    pub rotational_stiffness: [Signal; 3],
    /// Rotational damping by axis [N m s/rad].
    pub rotational_damping: [Signal; 3],
    frames: Frames,
}

impl Bushing {
    /// A bushing without stiffness between two markers; set the other fields afterwards.
    ///
    /// # Errors
    /// Markers on the same body, or on what has no axes.
    pub fn new(label: impl Into<String>, nodes: &[Node], markers: [Marker; 2]) -> Result<Self, BuildError> {
        let label = label.into();
        let frames = Frames::new(nodes, &markers, &label)?;
        let none = || [0.0; 3].map(Signal::from);
        let [stiffness, damping, rotational_stiffness, rotational_damping] = [(); 4].map(|()| none());
        Ok(Bushing { label, stiffness, damping, rotational_stiffness, rotational_damping, frames })
    }

    /// What is wrong with the numbers, if anything.
    ///
    /// # Errors
    /// A stiffness or damping that is negative or not finite.
    pub fn check(&self) -> Result<(), BuildError> {
        for (name, all) in [
            ("stiffness", &self.stiffness),
            ("damping", &self.damping),
            ("rotational_stiffness", &self.rotational_stiffness),
            ("rotational_damping", &self.rotational_damping),
        ] {
            for x in all {
                not_negative(name, least(x))?;
            }
        }
        Ok(())
    }

    fn signals(&self) -> impl Iterator<Item = &Signal> {
        let all = [&self.stiffness, &self.damping, &self.rotational_stiffness, &self.rotational_damping];
        all.into_iter().flatten()
    }

    fn mount(&self, t: f64) -> Mount {
        Mount {
            stiffness: now(&self.stiffness, t),
            damping: now(&self.damping, t),
            rotational_stiffness: now(&self.rotational_stiffness, t),
            rotational_damping: now(&self.rotational_damping, t),
        }
    }
}

/// A bushing at an instant.
struct Mount {
    stiffness: V3<f64>,
    damping: V3<f64>,
    rotational_stiffness: V3<f64>,
    rotational_damping: V3<f64>,
}

/// The second frame as seen from the first: place, its rate, rotation vector, relative angular velocity.
struct Seen<S> {
    d: V3<S>,
    rate: V3<S>,
    phi: V3<S>,
    spin: V3<S>,
}

fn seen<S: Jet>(pose: &[Pose<S>; 2]) -> Seen<S> {
    let [a, b] = pose;
    let minus = |x: &V3<S>, y: &V3<S>| -> V3<S> { std::array::from_fn(|i| x[i] - y[i]) };
    let r = matrix(&a.axes);
    let far = minus(&b.x, &a.x);
    let carried = cross(&a.omega, &far);
    let relative = minus(&minus(&b.v, &a.v), &carried);
    Seen {
        d: transposed_times(&r, &far),
        rate: transposed_times(&r, &relative),
        phi: rotation_vector(&between(pose)),
        spin: transposed_times(&r, &minus(&b.omega, &a.omega)),
    }
}

/// The vector of a unit quaternion's rotation, the shorter way round.
fn rotation_vector<S: Jet>(q: &[S; 4]) -> V3<S> {
    let sign = if q[0].re() < 0.0 { -1.0 } else { 1.0 };
    let w = q[0] * sign;
    let u = [q[1] * sign, q[2] * sign, q[3] * sign];
    let square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    let scale = if square.re() < 1e-6 {
        // 2 atan(s/w)/s by its series
        let x = square / (w * w);
        (-x / 3.0 + x * x / 5.0 - x * x * x / 7.0 + 1.0) * 2.0 / w
    } else {
        let s = square.sqrt();
        s.atan2(w) * 2.0 / s
    };
    u.map(|u| u * scale)
}

/// `J⁻ᵀ(φ) g`: what the gradient `g` by the rotation vector is as a moment in the axes of the first frame. `J` is the
/// left Jacobian of the rotation (Bullo and Murray 1995).
fn as_moment<S: Jet>(phi: &V3<S>, g: &V3<S>) -> V3<S> {
    let square = phi[0] * phi[0] + phi[1] * phi[1] + phi[2] * phi[2];
    let c = if square.re() < 1e-2 {
        square * (square * (square / 1_209_600.0 + 1.0 / 30_240.0) + 1.0 / 720.0) + 1.0 / 12.0
    } else {
        let angle = square.sqrt();
        square.recip() - (angle.cos() + 1.0) / (angle * angle.sin() * 2.0)
    };
    let once = cross(phi, g);
    let twice = cross(phi, &once);
    std::array::from_fn(|i| g[i] + once[i] * 0.5 + twice[i] * c)
}

impl Wrench for Mount {
    fn wrench<S: Jet>(&self, pose: &[Pose<S>; 2]) -> (V3<S>, V3<S>) {
        let s = seen(pose);
        let force: V3<S> =
            std::array::from_fn(|i| -(s.d[i] * self.stiffness[i]) - s.rate[i] * self.damping[i]);
        let gradient: V3<S> = std::array::from_fn(|i| s.phi[i] * self.rotational_stiffness[i]);
        let elastic = as_moment(&s.phi, &gradient);
        let moment: V3<S> = std::array::from_fn(|i| -elastic[i] - s.spin[i] * self.rotational_damping[i]);
        let r = matrix(&pose[0].axes);
        (times(&r, &force), times(&r, &moment))
    }
}

impl Term for Bushing {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn acts(&self) -> Option<&'static str> {
        Some("bushing")
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.frames.dofs());
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        self.frames.add(&self.mount(at.t), at, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let (s, m) = (seen(&self.frames.now(at)), self.mount(at.t));
        let stored = |k: &V3<f64>, x: &V3<f64>| -> f64 { (0..3).map(|i| 0.5 * k[i] * x[i] * x[i]).sum() };
        let potential = stored(&m.stiffness, &s.d) + stored(&m.rotational_stiffness, &s.phi);
        Energy { potential, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let (s, m) = (seen(&self.frames.now(at)), self.mount(at.t));
        let lost = |c: &V3<f64>, x: &V3<f64>| -> f64 { (0..3).map(|i| c[i] * x[i] * x[i]).sum() };
        let dissipated = lost(&m.damping, &s.rate) + lost(&m.rotational_damping, &s.spin);
        // whoever changes a stiffness works on what is strained
        let change = |k: &[Signal; 3], x: &V3<f64>| -> f64 {
            (0..3).map(|i| 0.5 * rate(&k[i], at.t) * x[i] * x[i]).sum()
        };
        let supplied = change(&self.stiffness, &s.d) + change(&self.rotational_stiffness, &s.phi);
        Power { dissipated, supplied, ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if change(self.signals()) { Some(self) } else { None }
    }
}

impl Timed for Bushing {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(reach(self.signals(), t, h))
    }
}

/// A spring and damper about an axis: `M = -κ (φ - φ_0) - c φ̇` about the first marker's third axis.
///
/// `φ` is the angle from the first marker's first axis to the second's, as seen along that axis. It isn't counted beyond
/// half a turn from `φ_0`: there the moment jumps to the other side. It is meant beside a hinge, whose axis both markers
/// share; the axis moves with the first marker. Use it for: torsion springs, the friction of a bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct RotationalSpring {
    /// A name, such as `spring of the door`.
    pub label: String,
    /// Stiffness `κ` [N m/rad].
    pub stiffness: Signal,
    /// Damping `c` [N m s/rad].
    pub damping: Signal,
    /// Angle without moment `φ_0` [rad].
    pub rest: Signal,
    frames: Frames,
}

impl RotationalSpring {
    /// A spring between two markers; set the damping afterwards.
    ///
    /// # Errors
    /// Markers on the same body, or on what has no axes; numbers that are negative or not finite.
    pub fn new(
        label: impl Into<String>,
        nodes: &[Node],
        markers: [Marker; 2],
        stiffness: impl Into<Signal>,
        rest: impl Into<Signal>,
    ) -> Result<Self, BuildError> {
        let (label, stiffness, rest) = (label.into(), stiffness.into(), rest.into());
        not_negative("stiffness", least(&stiffness))?;
        finite("angle", &[rest.at(0.0)])?;
        let frames = Frames::new(nodes, &markers, &label)?;
        Ok(RotationalSpring { label, stiffness, damping: 0.0.into(), rest, frames })
    }

    fn signals(&self) -> [&Signal; 3] {
        [&self.stiffness, &self.damping, &self.rest]
    }

    fn torsion(&self, t: f64) -> Torsion {
        let [stiffness, damping, rest] = self.signals().map(|s| s.at(t));
        Torsion { stiffness, damping, rest }
    }
}

/// A torsion spring at an instant.
struct Torsion {
    stiffness: f64,
    damping: f64,
    rest: f64,
}

impl Torsion {
    /// Angle from that without moment, and its rate.
    fn turn<S: Jet>(&self, pose: &[Pose<S>; 2]) -> (S, S) {
        let axes = pose.each_ref().map(|p| matrix(&p.axes));
        let column = |k: usize, j: usize| -> V3<S> { std::array::from_fn(|i| axes[k][i][j]) };
        let along = |a: &V3<S>, b: &V3<S>| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let first = column(1, 0);
        let (cosine, sine) = (along(&column(0, 0), &first), along(&column(0, 1), &first));
        let angle = sine.atan2(cosine) - self.rest;
        let angle = angle - ((angle.re() + PI) / TAU).floor() * TAU;
        let spin: V3<S> = std::array::from_fn(|i| pose[1].omega[i] - pose[0].omega[i]);
        (angle, along(&column(0, 2), &spin))
    }
}

impl Wrench for Torsion {
    fn wrench<S: Jet>(&self, pose: &[Pose<S>; 2]) -> (V3<S>, V3<S>) {
        let (angle, rate) = self.turn(pose);
        let moment = -(angle * self.stiffness) - rate * self.damping;
        let r = matrix(&pose[0].axes);
        ([S::zero(); 3], std::array::from_fn(|i| r[i][2] * moment))
    }
}

impl Term for RotationalSpring {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.frames.dofs());
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        self.frames.add(&self.torsion(at.t), at, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let torsion = self.torsion(at.t);
        let (angle, _) = torsion.turn(&self.frames.now(at));
        Energy { potential: 0.5 * torsion.stiffness * angle * angle, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let torsion = self.torsion(at.t);
        let (angle, spin) = torsion.turn(&self.frames.now(at));
        // whoever changes stiffness and angle works on the moment
        let supplied = 0.5 * rate(&self.stiffness, at.t) * angle * angle
            - torsion.stiffness * angle * rate(&self.rest, at.t);
        Power { dissipated: torsion.damping * spin * spin, supplied, ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if change(self.signals().into_iter()) { Some(self) } else { None }
    }
}

impl Timed for RotationalSpring {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(reach(self.signals().into_iter(), t, h))
    }
}
