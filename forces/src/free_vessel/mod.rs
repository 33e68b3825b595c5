//! Vessels and buoys that float freely: what water at rest and waves do to a rigid body, by linear coefficients.

mod inertia;
mod spec;

pub use inertia::VesselInertia;
pub use spec::{FreeVesselSpec, SixBySix};

use crate::bushing::frames::{Frames, Pose, Wrench, between};
use ropewalk_core::rotation::{matrix, times, transposed_times};
use ropewalk_core::{
    Assembly, At, BuildError, Column, Energy, Jet, Marker, Node, Pattern, Power, Shows, Term, Timed, V3,
    reach,
};
use ropewalk_sea::{MOTIONS, VesselResponse};

/// A matrix over surge, sway, heave, roll, pitch, yaw.
pub type Six = [[f64; MOTIONS]; MOTIONS];

/// Restoring, damping and wave loads of a floating body about its mean place (Cummins' equation without memory; Newman, *Marine
/// Hydrodynamics*, ch. 6).
///
/// With `ξ` the six motions from the mean place, as [`vessels`](ropewalk_sea::Responses) have them (`R = Rz(yaw) Ry(pitch) Rx(roll)`),
/// the energy is `½ ξ·Kξ`, and its gradient is taken whole: work along any way round adds up to nothing. Damping is `B ν + B₂ |ν| ν` of
/// the velocity `ν` in the axes of the vessel. Loads are in the axes of the mean heading.
pub struct FreeVessel {
    label: String,
    frames: Frames,
    stiffness: Six,
    damping: Six,
    quadratic: [f64; MOTIONS],
    mean_load: [f64; MOTIONS],
    /// Loads of the waves, and the shortest and the mean period of those [s].
    waves: Option<(VesselResponse, [f64; 2])>,
}

impl FreeVessel {
    /// A vessel without any effect: `mean` is its reference point and the axes of its heading in space, `marker` the same on
    /// the body. Add effects by [`FreeVessel::with`].
    ///
    /// # Errors
    /// A marker that isn't on a body.
    pub fn new(label: &str, nodes: &[Node], mean: Marker, marker: Marker) -> Result<Self, BuildError> {
        let frames = Frames::new(nodes, &[mean, marker], label)?;
        let (none, nothing) = ([[0.0; MOTIONS]; MOTIONS], [0.0; MOTIONS]);
        let label = label.to_string();
        Ok(FreeVessel {
            label,
            frames,
            stiffness: none,
            damping: none,
            quadratic: nothing,
            mean_load: nothing,
            waves: None,
        })
    }

    /// The same with stiffness (symmetric), linear and quadratic damping, and a constant load.
    #[must_use]
    pub fn with(mut self, stiffness: Six, damping: Six, quadratic: [f64; 6], mean_load: [f64; 6]) -> Self {
        (self.stiffness, self.damping) = (stiffness, damping);
        (self.quadratic, self.mean_load) = (quadratic, mean_load);
        self
    }

    /// The same with loads of waves, of which these are the shortest and the mean period [s].
    #[must_use]
    pub fn in_waves(mut self, response: VesselResponse, periods: [f64; 2]) -> Self {
        self.waves = Some((response, periods));
        self
    }

    /// Force and moment of waves and constant load, in the axes of the mean heading.
    fn load(&self, t: f64) -> [f64; MOTIONS] {
        let waves = self.waves.as_ref().map(|(waves, _)| waves.at(t));
        std::array::from_fn(|k| self.mean_load[k] + waves.map_or(0.0, |waves| waves[k][0]))
    }
}

/// A vessel at an instant.
struct Now<'a> {
    vessel: &'a FreeVessel,
    load: [f64; MOTIONS],
}

/// Six numbers, three of the place and three of the turn.
fn six<S: Copy>(a: V3<S>, b: V3<S>) -> [S; MOTIONS] {
    std::array::from_fn(|k| if k < 3 { a[k] } else { b[k - 3] })
}

fn product<S: Jet>(m: &Six, x: &[S; MOTIONS]) -> [S; MOTIONS] {
    std::array::from_fn(|i| {
        let mut sum = S::zero();
        for (m, x) in m[i].iter().zip(x) {
            sum += *x * *m;
        }
        sum
    })
}

/// The six motions from the mean frame to the present one, and the turn between them.
fn motions<S: Jet>(pose: &[Pose<S>; 2]) -> ([S; MOTIONS], [V3<S>; 3]) {
    let mean = matrix(&pose[0].axes);
    let moved = transposed_times(&mean, &std::array::from_fn(|i| pose[1].x[i] - pose[0].x[i]));
    let r = matrix(&between(pose));
    let level = (r[0][0] * r[0][0] + r[1][0] * r[1][0]).sqrt();
    let angles = [r[2][1].atan2(r[2][2]), (-r[2][0]).atan2(level), r[1][0].atan2(r[0][0])];
    (six(moved, angles), r)
}

/// Velocity in the axes of the vessel.
fn velocity<S: Jet>(pose: &Pose<S>) -> [S; MOTIONS] {
    let axes = matrix(&pose.axes);
    six(transposed_times(&axes, &pose.v), transposed_times(&axes, &pose.omega))
}

impl Now<'_> {
    /// The negative gradient of the energy, as force and moment in the axes of the mean heading.
    fn restoring<S: Jet>(&self, pose: &[Pose<S>; 2]) -> (V3<S>, V3<S>) {
        let (xi, r) = motions(pose);
        let q = product(&self.vessel.stiffness, &xi).map(|q| -q);
        // roll is about the vessel's x axis, pitch about the level axis across it, yaw about z
        let ([sp, cp], [sy, cy]) = ([xi[4].sin(), xi[4].cos()], [xi[5].sin(), xi[5].cos()]);
        debug_assert!((r[2][0] + sp).re().abs() < 1e-9);
        let ahead = (q[3] + q[5] * sp) / cp;
        ([q[0], q[1], q[2]], [ahead * cy - q[4] * sy, ahead * sy + q[4] * cy, q[5]])
    }

    /// Damping, as force and moment in the axes of the vessel.
    fn damping<S: Jet>(&self, nu: &[S; MOTIONS]) -> [S; MOTIONS] {
        let mut force = product(&self.vessel.damping, nu);
        for ((force, b), v) in force.iter_mut().zip(self.vessel.quadratic).zip(nu) {
            *force += *v * *v * (b * v.re().signum());
        }
        force.map(|f| -f)
    }
}

impl Wrench for Now<'_> {
    fn wrench<S: Jet>(&self, pose: &[Pose<S>; 2]) -> (V3<S>, V3<S>) {
        let (mut force, mut moment) = self.restoring(pose);
        for k in 0..3 {
            force[k] += self.load[k];
            moment[k] += self.load[3 + k];
        }
        let (mean, own) = (matrix(&pose[0].axes), matrix(&pose[1].axes));
        let damping = self.damping(&velocity(&pose[1]));
        let sum = |a: &V3<S>, b: [S; 3]| -> V3<S> {
            let (a, b) = (times(&mean, a), times(&own, &b));
            std::array::from_fn(|i| a[i] + b[i])
        };
        (
            sum(&force, [damping[0], damping[1], damping[2]]),
            sum(&moment, [damping[3], damping[4], damping[5]]),
        )
    }
}

impl Term for FreeVessel {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn acts(&self) -> Option<&'static str> {
        Some("vessel")
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.frames.dofs());
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        self.frames.add(&Now { vessel: self, load: self.load(at.t) }, at, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let (xi, _) = motions(&self.frames.now(at));
        let force = product(&self.stiffness, &xi);
        let potential = 0.5 * (0..MOTIONS).map(|k| xi[k] * force[k]).sum::<f64>();
        Energy { potential, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let (pose, load) = (self.frames.now(at), self.load(at.t));
        let nu = velocity(&pose[1]);
        let damping = Now { vessel: self, load }.damping(&nu);
        let mean = matrix(&pose[0].axes);
        let moving = six(transposed_times(&mean, &pose[1].v), transposed_times(&mean, &pose[1].omega));
        let work = |a: &[f64; MOTIONS], b: &[f64; MOTIONS]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        Power { dissipated: -work(&damping, &nu), supplied: work(&load, &moving), ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        self.waves.as_ref().map(|_| self as &dyn Timed)
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Timed for FreeVessel {
    fn reach(&self, _t: f64, h: f64) -> Option<f64> {
        Some(self.waves.as_ref().map_or(f64::INFINITY, |(_, [shortest, _])| reach::period(*shortest, h)))
    }
    fn period(&self, _t: f64) -> f64 {
        self.waves.as_ref().map_or(f64::INFINITY, |(_, [_, mean])| *mean)
    }
}

impl Shows for FreeVessel {
    fn columns(&self) -> Vec<Column> {
        let lengths = ["surge", "sway", "heave"].map(|name| Column::new(name, "m"));
        let angles = ["roll", "pitch", "yaw"].map(|name| Column::new(name, "rad"));
        let loads = ["fx", "fy", "fz"].map(|name| Column::new(format!("waves.{name}"), "N"));
        lengths.into_iter().chain(angles).chain(loads).collect()
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        out.extend(motions(&self.frames.now(at)).0);
        let load = self.load(at.t);
        out.extend((0..3).map(|k| load[k] - self.mean_load[k]));
    }
    fn remark(&self, at: &At<'_>) -> Option<String> {
        let xi = motions(&self.frames.now(at)).0;
        let tilt = xi[3].abs().max(xi[4].abs()).to_degrees();
        let turn = xi[5].abs().to_degrees();
        if tilt > 30.0 {
            return Some(format!(
                "`{}` ends {tilt:.0} deg from upright: its linear coefficients are for small angles",
                self.label
            ));
        }
        (self.waves.is_some() && turn > 30.0).then(|| {
            format!(
                "`{}` ends {turn:.0} deg from its mean heading, for which its wave loads are: give it another `heading`",
                self.label
            )
        })
    }
}
