//! What the fluid does at the ends of slender bodies.

mod end_drag;
mod feeding;
mod wake;

pub use end_drag::EndDrag;
pub use feeding::FeedingEnd;
pub use wake::BluntEnd;

use ropewalk_core::held::{Held, three};
use ropewalk_core::rotation::{cross, matrix, times};
use ropewalk_core::{Assembly, At, Dual, Node, NodeKind, Pattern, Power, Real, Term, Timed, Tip, V3, dot};
use ropewalk_scene::Sea;

/// A force of a fluid on an end of a slender body, by how the end moves; it takes energy from the motion relative to the fluid.
pub trait TipLaw: Send + Sync + 'static {
    /// What it is called in manifests and profiles.
    fn label(&self) -> &'static str;
    /// The waves of the fluid, if it has some.
    fn sea(&self) -> Option<&Sea>;
    /// Velocity of the fluid at a place [m/s].
    fn fluid<R: Real>(&self, t: f64, x: &V3<R>) -> V3<R>;
    /// The force on the end at `x`, with velocity `v` and the slope of the axis there; over single numbers.
    fn force<R: Real>(&self, t: f64, x: &V3<R>, v: &V3<R>, slope: &V3<R>) -> V3<R>;
}

/// A [`TipLaw`] on a part of a model.
struct AtTip<L> {
    label: String,
    law: L,
    held: Held,
    slope: Slope,
}

/// Where the slope at an end comes from.
enum Slope {
    /// The coordinates of a cable, and its first velocity.
    Node { q: usize, v: usize },
    /// The axis of a rigid body, in its own axes, and the body's first coordinate.
    Axis { axis: V3<f64>, q: usize },
}

/// The term of a law at an end of a part. `None` where there is no slope.
pub fn at_tip(law: impl TipLaw, part: &str, nodes: &[Node], tip: &Tip) -> Option<Box<dyn Term>> {
    let node = nodes.get(tip.marker.on()?.0 as usize)?;
    let slope = match node.kind {
        NodeKind::Slope | NodeKind::Twist => Slope::Node { q: node.q + 3, v: node.v + 3 },
        NodeKind::Frame => Slope::Axis { axis: tip.axis, q: node.q },
        _ => return None,
    };
    let label = format!("{part}: {}", law.label());
    let held = Held::new(nodes, &tip.marker, &label).ok()?;
    Some(Box::new(AtTip { label, law, held, slope }))
}

impl<L: TipLaw> AtTip<L> {
    fn slope(&self, at: &At<'_>) -> V3<f64> {
        match self.slope {
            Slope::Node { q, .. } => three(at.q, q),
            Slope::Axis { axis, q } => times(&frame(at, q), &axis),
        }
    }
    fn force(&self, at: &At<'_>) -> V3<f64> {
        self.law.force(at.t, &self.held.x(at), &self.held.velocity(at), &self.slope(at))
    }
    /// How the force changes with place, velocity and slope.
    fn by(&self, at: &At<'_>, dx: &V3<f64>, dv: &V3<f64>, ds: &V3<f64>) -> V3<f64> {
        let (x, v, s) = (self.held.x(at), self.held.velocity(at), self.slope(at));
        let both = |x: &V3<f64>, d: &V3<f64>| std::array::from_fn(|i| Dual::new(x[i], d[i]));
        self.law.force(at.t, &both(&x, dx), &both(&v, dv), &both(&s, ds)).map(|f| f.eps)
    }
}

fn frame(at: &At<'_>, q: usize) -> [V3<f64>; 3] {
    matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]])
}

impl<L: TipLaw> Term for AtTip<L> {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn acts(&self) -> Option<&'static str> {
        Some("drag")
    }
    fn pattern(&self, p: &mut Pattern) {
        match self.slope {
            Slope::Node { v, .. } => p.clique(v - 3..v + 3),
            Slope::Axis { .. } => {
                let first = self.held.dof(0);
                p.clique(first..first + 6);
            }
        }
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (motion, force) = (self.held.motion(at), self.force(at));
        for k in 0..motion.n {
            out.add(motion.dof[k], -motion.carry(k, &force));
        }
        if !out.wants_tangent() {
            return;
        }
        let w = out.weights();
        let nought = [0.0; 3];
        let by: [V3<f64>; 6] = std::array::from_fn(|k| {
            let unit: V3<f64> = std::array::from_fn(|i| if i == k % 3 { 1.0 } else { 0.0 });
            let mut ds = nought;
            if k >= 3 {
                ds = match self.slope {
                    Slope::Node { .. } => unit,
                    Slope::Axis { axis, q } => times(&frame(at, q), &cross(&unit, &axis)),
                };
            }
            let (x, turn) = if k < motion.n { (motion.by_q[k], motion.v_by_q[k]) } else { (nought, nought) };
            let dv = std::array::from_fn(|i| w.v * x[i] + w.q * turn[i]);
            self.by(at, &x.map(|x| w.q * x), &dv, &ds.map(|d| w.q * d))
        });
        let turning = motion.turning(&force);
        out.add_block(0, 6, |i, j| {
            if i >= motion.n {
                return 0.0;
            }
            let turn = turning.filter(|_| i >= 3 && j >= 3).map_or(0.0, |t| t[i - 3][j - 3]);
            -(motion.carry(i, &by[j]) + w.q * turn)
        });
    }
    fn power(&self, at: &At<'_>) -> Power {
        let (f, v) = (self.force(at), self.held.velocity(at));
        let u = self.law.fluid(at.t, &self.held.x(at));
        let supplied = dot(&f, &u);
        Power { dissipated: supplied - dot(&f, &v), supplied, carried: 0.0 }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        self.law.sea().map(|_| self as &dyn Timed)
    }
}

impl<L: TipLaw> Timed for AtTip<L> {
    fn reach(&self, _t: f64, h: f64) -> Option<f64> {
        Some(self.law.sea().map_or(h, |sea| sea.reach(h)))
    }
    fn period(&self, _t: f64) -> f64 {
        self.law.sea().map_or(f64::INFINITY, |sea| sea.period())
    }
}
