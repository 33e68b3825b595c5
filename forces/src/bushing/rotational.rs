//! Torsion springs between two frames that share an axis, whole turns included.

use super::frames::{Frames, Pose, Wrench};
use crate::signals::{change, least, rate, reach};
use ropewalk_core::error::{finite, not_negative};
use ropewalk_core::rotation::matrix;
use ropewalk_core::{
    Assembly, At, BuildError, Column, Energy, Jet, Marker, Node, Pattern, Power, Remembers, Shows, Signal,
    Term, Timed, V3,
};
use std::f64::consts::{PI, TAU};

/// A spring and damper about an axis: `M = -κ (φ - φ_0) - c φ̇` about the first marker's third axis.
///
/// `φ` is the angle from the first marker's first axis to the second's, as seen along that axis, whole turns included
/// where they are [counted](RotationalSpring::counting). It is meant beside a hinge, whose axis both markers share; the axis
/// moves with the first marker. Use it for: torsion springs, the friction of a bearing.
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
    /// The internal variable that holds the angle at the last step, if turns are counted.
    memory: Option<usize>,
    frames: Frames,
}

/// A turn in one step beyond which whole turns can't be counted for certain [rad].
const MOST_CHANGE: f64 = 0.95 * PI;

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
        Ok(RotationalSpring { label, stiffness, damping: 0.0.into(), rest, memory: None, frames })
    }

    /// Counts whole turns from the angle 0 on, in an internal variable. Without, `φ` is taken within half a turn of `φ_0`.
    pub fn counting(mut self, memory: usize) -> Self {
        self.memory = Some(memory);
        self
    }

    fn signals(&self) -> [&Signal; 3] {
        [&self.stiffness, &self.damping, &self.rest]
    }

    /// The angle at the last step, if turns are counted.
    fn last(&self, memory: &[f64]) -> Option<f64> {
        self.memory.map(|place| memory.get(place).copied().unwrap_or(0.0))
    }

    fn torsion(&self, at: &At<'_>) -> Torsion {
        let [stiffness, damping, rest] = self.signals().map(|s| s.at(at.t));
        Torsion { stiffness, damping, rest, near: self.last(at.internal).unwrap_or(rest) }
    }

    /// The angle, with the turns that are counted.
    fn angle(&self, at: &At<'_>) -> f64 {
        let torsion = self.torsion(at);
        torsion.turn(&self.frames.now(at)).0 + torsion.rest
    }
}

/// A torsion spring at an instant.
struct Torsion {
    stiffness: f64,
    damping: f64,
    rest: f64,
    /// Within half a turn of which it is [rad].
    near: f64,
}

impl Torsion {
    /// Angle from that without moment, and its rate.
    fn turn<S: Jet>(&self, pose: &[Pose<S>; 2]) -> (S, S) {
        let axes = pose.each_ref().map(|p| matrix(&p.axes));
        let column = |k: usize, j: usize| -> V3<S> { std::array::from_fn(|i| axes[k][i][j]) };
        let along = |a: &V3<S>, b: &V3<S>| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let first = column(1, 0);
        let (cosine, sine) = (along(&column(0, 0), &first), along(&column(0, 1), &first));
        let angle = sine.atan2(cosine);
        let angle = angle - ((angle.re() - self.near + PI) / TAU).floor() * TAU - self.rest;
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
        self.frames.add(&self.torsion(at), at, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let torsion = self.torsion(at);
        let (angle, _) = torsion.turn(&self.frames.now(at));
        Energy { potential: 0.5 * torsion.stiffness * angle * angle, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let torsion = self.torsion(at);
        let (angle, spin) = torsion.turn(&self.frames.now(at));
        // whoever changes stiffness and angle works on the moment
        let supplied = 0.5 * rate(&self.stiffness, at.t) * angle * angle
            - torsion.stiffness * angle * rate(&self.rest, at.t);
        Power { dissipated: torsion.damping * spin * spin, supplied, ..Power::default() }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
    fn remembers(&self) -> Option<&dyn Remembers> {
        if self.memory.is_some() { Some(self) } else { None }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if change(self.signals().into_iter()) { Some(self) } else { None }
    }
}

impl Shows for RotationalSpring {
    fn columns(&self) -> Vec<Column> {
        vec![Column::new("angle", "rad"), Column::new("moment", "N m")]
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        let torsion = self.torsion(at);
        let (turn, rate) = torsion.turn(&self.frames.now(at));
        out.extend([turn + torsion.rest, -torsion.stiffness * turn - torsion.damping * rate]);
    }
}

impl Remembers for RotationalSpring {
    fn remember(&self, at: &At<'_>, memory: &mut [f64]) {
        let now = self.angle(&At { internal: memory, ..*at });
        if let Some(x) = self.memory.and_then(|place| memory.get_mut(place)) {
            *x = now;
        }
    }
    fn rests(&self) -> bool {
        true
    }
    fn settle(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        self.remember(at, memory);
        false
    }
    fn lost(&self, at: &At<'_>) -> Option<String> {
        let change = self.angle(at) - self.last(at.internal)?;
        (!(change.abs() <= MOST_CHANGE)).then(|| {
            format!(
                "`{}` is turned so far at once that its turns can't be counted: take smaller steps, or let what turns it grow with the \
                 load",
                self.label
            )
        })
    }
}

impl Timed for RotationalSpring {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(reach(self.signals().into_iter(), t, h))
    }
}
