//! Springs and dampers between two frames, on rigid bodies and on cables with torsion: bushings, and torsion springs.

pub(crate) mod frames;
mod rotational;
mod spec;

pub use rotational::RotationalSpring;
pub use spec::{BushingSpec, RotationalSpringSpec};

use crate::signals::{change, least, now, rate, reach};
use frames::{Frames, Pose, Wrench, between};
use ropewalk_core::error::not_negative;
use ropewalk_core::rotation::{cross, matrix, times, transposed_times};
use ropewalk_core::{
    Assembly, At, BuildError, Column, Energy, Foresees, Jet, Marker, Node, Pattern, Power, Shows, Signal,
    Term, Timed, V3, dot,
};

/// A spring and damper in all directions: of the second marker's place `d` and rotation vector `φ` as seen from the first
/// marker's axes, `F = -k d - c ḋ` and, from the energy `½ φ·κφ`, a moment that is `-κφ` for small angles.
///
/// The rotation vector is the shorter way round, so `|φ|` stays below π; a run that turns it farther ends there. Both
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
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
    fn foresees(&self) -> Option<&dyn Foresees> {
        let turns = self.rotational_stiffness.iter().any(|k| least(k) != 0.0 || change(std::iter::once(k)));
        if turns { Some(self) } else { None }
    }
}

impl Shows for Bushing {
    fn columns(&self) -> Vec<Column> {
        let of = |names: [&str; 3], unit: &'static str| names.map(|name| Column::new(name, unit));
        [of(["fx", "fy", "fz"], "N"), of(["mx", "my", "mz"], "N m")].concat()
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        let pose = self.frames.now(at);
        let (force, moment) = self.mount(at.t).wrench(&pose);
        let axes = matrix(&pose[0].axes);
        out.extend(transposed_times(&axes, &force).into_iter().chain(transposed_times(&axes, &moment)));
    }
}

impl Foresees for Bushing {
    fn step_limit(&self, _at: &At<'_>) -> f64 {
        f64::INFINITY
    }
    fn passes(&self, before: &At<'_>, after: &At<'_>) -> Option<String> {
        let [was, is] = [before, after].map(|at| seen(&self.frames.now(at)).phi);
        (dot(&was, &is) < -1.0).then(|| {
            format!(
                "`{}` is turned by more than half a turn, where it would be shorter the other way round: a bushing doesn't count \
                 turns. A `rotational_spring` beside a `revolute` joint does",
                self.label
            )
        })
    }
}

impl Timed for Bushing {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(reach(self.signals(), t, h))
    }
}
